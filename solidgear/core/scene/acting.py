"""Loads of a shaft in one of its cases: what acts where, and what takes the torque that is left.

A shaft turns freely about its axis, so that its torques add up to zero, unless a bearing holds it there,
or the file names the place where the rest leaves (``torque_at``).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import fsum
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.errors import SceneError, listed, show
from solidgear.core.frames import shift
from solidgear.core.scene.gravity import acceleration
from solidgear.core.scene.load_case import LoadCase
from solidgear.core.scene.load_rules import ALL, all_loads, named_case
from solidgear.core.scene.own_mass import own_mass
from solidgear.core.scene.shaft_load import ShaftLoad
from solidgear.core.scene.units import TYPED

if TYPE_CHECKING:
    from solidgear.core.scene.model import Scene
    from solidgear.core.scene.stations import Bearing

#: name of what typed numbers leave of torques
ROUNDING = "rounding"
#: sum of torques over the sum of their sizes that is none
EXACT = 1e-13


@dataclass(frozen=True)
class ActingLoad:
    """A load as it acts in a case."""

    plain_names = ("name", "station", "y", "six", "factor")

    name: str
    station: str
    y: float  #: of the station, m
    six: np.ndarray  #: (6,) on the axis there, N and N m
    factor: float = 1.0  #: of the case

    def about(self, y: float) -> np.ndarray:
        """Return the load (6,) about another place on the axis, m."""
        return shift([0.0, self.y - y, 0.0]).T @ self.six


def acting_loads(scene: Scene, case: LoadCase | None = None) -> tuple[ActingLoad, ...]:
    """Return the loads of a scene in a case, by default the first, with the torque that leaves where
    the file says so; torques that nothing takes are refused.
    """
    case = named_case(scene.cases) if case is None else case
    out = []
    for k, load in enumerate(loads_of(scene)):
        if factor := case.factor(load.name):
            y = _place(load.station, scene)
            try:
                six = load.six(factor, turning(scene.turns), case.speed)
            except SceneError as error:
                raise error.located(None, prefix=("load", k)) from None
            out.append(ActingLoad(load.name, load.station, y, six, factor))
    remainder = fsum(load.six[4] for load in out)
    if abs(remainder) <= EXACT * fsum(abs(load.six[4]) for load in out):
        return tuple(out)
    if scene.torque_at is not None:
        out.append(_torque(f"torque at {scene.torque_at}", scene.torque_at, -remainder, scene))
    elif not holders(scene.bearings):
        _refuse_torques(out, case.name)
        largest = max(out, key=lambda load: abs(load.six[4]))
        out.append(_torque(ROUNDING, largest.station, -remainder, scene))
    return tuple(out)


def holders(bearings: Sequence[Bearing]) -> list[str]:
    """Return names of the bearings that hold a shaft against turning about y."""
    return [b.name for b in bearings if b.matrix is not None and b.matrix[4][4] > 0]


def _torque(name: str, station: str, torque: float, scene: Scene) -> ActingLoad:
    return ActingLoad(name, station, _place(station, scene), torque * np.eye(6)[4])


def carriers(scene: Scene) -> dict[str, str]:
    """Return stations by the names of all that carry loads: a mass may sit on another station."""
    return {s.name: s.name for s in scene.stations} | {m.name: m.station for m in scene.masses}


def _place(name: str, scene: Scene) -> float:
    """Return the place of what carries a load, m."""
    station = carriers(scene)[name]
    return next(s.y for s in scene.stations if s.name == station)


def loads_of(scene: Scene) -> tuple[ShaftLoad, ...]:
    """Return all loads of a scene, a [load] at the main point among them."""
    return all_loads(scene.load, scene.loads, "" if scene.load is None else scene.port.name)


def station_loads(scene: Scene, case: LoadCase | None = None) -> dict[str, np.ndarray]:
    """Return the load (6,) on every loaded station of a scene in a case, N and N m."""
    by_name, out = carriers(scene), dict[str, np.ndarray]()
    for load in acting_loads(scene, case):
        name = by_name[load.station]
        out[name] = out.get(name, np.zeros(6)) + load.six
    return out


def turning(turns: str | None) -> float:
    """Return 1 for a shaft that turns about +y, -1 for one about -y."""
    return -1.0 if turns == "-y" else 1.0


def torque_problems(scene: Scene) -> Iterator[SceneError]:
    """Yield the first problem of torques that do not add up to zero in a case, where nothing takes
    them.
    """
    for case in scene.cases or [named_case(scene.cases)]:
        try:
            acting_loads(scene, case)
        except SceneError as error:
            yield error
            return


def _refuse_torques(loads: Sequence[ActingLoad], case: str) -> None:
    """Refuse torques that do not add up to zero but for the rounding of typed numbers."""
    torques = {load.name: float(load.six[4]) for load in loads if load.six[4]}
    remainder = fsum(torques.values())
    if abs(remainder) > TYPED * fsum(map(abs, torques.values())):
        place = "" if case == ALL else f" in the case {show(case)}"
        parts = listed([f"{torque:.6g} N m of {name}" for name, torque in torques.items()])
        raise SceneError(
            f"the torques do not add up to zero{place}: {parts} leave {remainder:.6g} N m; give the load that "
            f'takes {-remainder:.6g} N m, write torque_at = "NAME" of the point where the rest leaves the '
            "shaft, or hold a bearing there (kthy)",
            path=("torque_at",),
        )


def own_weight(scene: Scene) -> tuple[np.ndarray, float]:
    """Return the weight (6,) of a shaft without the masses on it, N, and the place of its centre, m: on
    the axis, since what is beside it turns with the shaft.
    """
    shaft = own_mass(scene)
    return np.r_[shaft.mass * acceleration(scene.weight), np.zeros(3)], shaft.centre[1]


def weights_of_masses(scene: Scene) -> dict[str, np.ndarray]:
    """Return the weight (6,) of the masses on a shaft by the stations that carry them, N and N m."""
    g, out = acceleration(scene.weight), dict[str, np.ndarray]()
    for point in scene.masses:
        six = shift(point.offset).T @ np.r_[point.mass * g, np.zeros(3)]
        out[point.station] = out.get(point.station, np.zeros(6)) + six
    return out
