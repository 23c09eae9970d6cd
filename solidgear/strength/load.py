"""Loads of a shaft alone: those of its scene in a case, torques among them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from solidgear.core import DOF_NAMES, Scene, SolidgearError, nearest
from solidgear.core.scene import ShaftLoad
from solidgear.core.scene.acting import (
    ROUNDING,
    ActingLoad,
    acting_loads,
    carriers,
    loads_of,
    own_weight,
    weights_of_masses,
)
from solidgear.core.scene.load_rules import ONLY, named_case
from solidgear.show.units import Units
from solidgear.trains.assembly.components import FORCE_UNITS
from solidgear.trains.file.operation import OperatingPoint, ShaftCase
from solidgear.trains.file.train import ALONE, Train

#: a shaft alone in the first case of its loads
AT_REST = ShaftCase()
#: name of the weight of a shaft
WEIGHT = "weight"
#: loads that a sentence names one by one
NAMED = 3


@dataclass(frozen=True)
class LoadsAlone:
    """Loads of a shaft alone in one case."""

    plain_names = ("port", "case", "load", ("loads", "acting"), "assumed")

    port: str  #: main lumped point
    place: float  #: of that, m
    case: str  #: name; empty of a scene without cases
    acting: tuple[ActingLoad, ...]
    assumed: tuple[str, ...]  #: sentences on what words of loads leave open

    @property
    def load(self) -> np.ndarray:
        """(6,) resultant of all loads about the main lumped point, N and N m."""
        return sum((load.about(self.place) for load in self.acting), np.zeros(6))

    def words(self, units: Units) -> str:
        """Return the loads in words, such as ``Under z 2000 N at pinion``."""
        case = f"In the case {self.case}, under" if self.case else "Under"
        named = [load for load in self.acting if load.name != ROUNDING]
        if len(named) > NAMED:
            together = _components(self.load, units)
            return f"{case} {len(named)} loads, together {together} at {self.port}"
        return f"{case} " + ", and ".join(
            f"{_components(load.six, units)} at {load.station}" for load in named
        )

    @property
    def is_one_at_port(self) -> bool:
        """True for one load at the main point, as [load] gives it."""
        return [load.name for load in self.acting] == [ONLY]


def _components(six: np.ndarray, units: Units) -> str:
    """Return the components of a load in words."""
    size = np.abs(six).max()
    parts = [
        f"{name} {units.text(float(value), si, 4)}"
        for name, value, si in zip(DOF_NAMES, six, FORCE_UNITS)
        if abs(value) > 1e-12 * size
    ]
    return ", ".join(parts) or "no force"


def loads_alone(train: Train, point: OperatingPoint = AT_REST) -> LoadsAlone | None:
    """Return the loads of a shaft alone in the case of a point; None for a train, whose loads are
    those of its operating point. A shaft without load is refused.
    """
    if not train.is_one_shaft:
        return None
    scene = train.shafts[ALONE].scene
    if not scene.is_loaded:
        raise SolidgearError(
            'there is no load; write [load] with forces at the port, such as z = "2 kN", or give '
            "`load`"
        )
    case = named_case(scene.cases, point.name or None)
    acting = acting_loads(scene, case) + tuple(_weights(scene))
    names = {load.name for load in acting}
    assumed = [
        sentence for load in loads_of(scene) if load.name in names for sentence in load.assumed
    ]
    name = case.name if scene.cases else ""
    return LoadsAlone(scene.port.name, scene.port.y, name, acting, tuple(assumed))


def _weights(scene: Scene) -> Iterator[ActingLoad]:
    """Yield the weight of a shaft, and those of the masses on it."""
    if scene.weight is None:
        return
    six, y = own_weight(scene)
    yield ActingLoad(WEIGHT, "its centre", y, six)
    places = {station.name: station.y for station in scene.stations}
    for name, load in weights_of_masses(scene).items():
        yield ActingLoad(f"weight on {name}", name, places[name], load)


def driven(scene: Scene, drive: Mapping[str, float]) -> Scene:
    """Return a scene with torques, N m, that enter at stations and leave where the file says, by
    default at the main lumped point.
    """
    leaves = scene.torque_at or scene.port.name
    for name in drive:
        if name not in (places := carriers(scene)):
            raise SolidgearError(
                f'`drive` "{name}": the shaft has no such place{nearest(name, places)}; it has '
                f"{', '.join(places)}"
            )
        if name == leaves:
            raise SolidgearError(
                f'the torque at "{name}" enters where the gear takes it out; name the bearing, mass '
                "or point of the coupling or spline"
            )
    torques = [
        ShaftLoad(name=f"drive at {name}", on=name, torque=torque) for name, torque in drive.items()
    ]
    cases = tuple(
        case
        if case.loads is None
        else case.with_changes(loads=(*case.loads, *(load.name for load in torques)))
        for case in scene.cases
    )
    loads = (*loads_of(scene), *torques)
    return scene.with_changes(load=None, loads=loads, cases=cases, torque_at=leaves)
