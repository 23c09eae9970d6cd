"""Stress of the shafts of a train at rest, or of a shaft alone, under the loads of their equilibrium.

A shaft of a train is free but for the loads on its ports: teeth, springs, bearings, the weight of a
wheel on it. A shaft alone has a load at the port and the reactions of the bearings. Both settle as the
cheapest solids that model all of each shaft; where the bearings of a shaft alone resist each motion once,
reactions follow from statics, whatever the shaft is like. A model that is named settles its plain part
where it does not hold cuts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, NamedTuple

import numpy as np

from solidgear.bearings.bearing_life import left_open
from solidgear.bearings.solved import AS_STATED, Choice
from solidgear.core import Scene, Sheeted, SolidgearError, listed
from solidgear.core.plain import plain
from solidgear.core.scene.filleted import filleted
from solidgear.parts.body_file import BodyFile
from solidgear.strength.load import AT_REST, LoadsAlone, loads_alone
from solidgear.strength.stress.cases import CaseStress, case_stress, rated_under
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.drawn import LITTLE, DrawnStress
from solidgear.strength.stress.duty import DutyForces, cycles_of
from solidgear.strength.stress.norm.steels import strength_of
from solidgear.strength.stress.notch import ENOUGH
from solidgear.strength.stress.rating import Kind, Rating
from solidgear.strength.stress.section_forces import COMPONENTS, SectionForces, forces_of
from solidgear.strength.stress.shaft import (
    Notch,
    ShaftStress,
    check_tolerance,
    local_under,
    shaft_stress,
)
from solidgear.strength.stress.solid_notches import FINEST_LOCAL, SolidNotch, solid_notches
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import mix_label
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import ALONE, Train
from solidgear.trains.load.operation import Operating
from solidgear.trains.load.state import OperatingState

#: word for reactions that hang on no model
STATICS = "statics"
#: model that such reactions are computed by, the cheapest
BEAM = "euler"
#: of the largest stiffness of a bearing that is rounding
ROUNDING = 1e-12
#: caution on the results without an error bar
WITHOUT_BAR = "form factors have error bars; reactions and section forces come from one mesh"

Progress = Callable[[str], None]


@dataclass(frozen=True)
class ShaftLoads:
    """Loads on a shaft, and gravity."""

    loads: dict[str, np.ndarray]  #: by port, N and N m
    gravity: np.ndarray | None = None  #: (3,) m/s^2, in the axes of its scene

    def add(self, port: str, load: np.ndarray) -> None:
        """Add one more load (6,) on a port."""
        self.loads[port] = self.loads.get(port, np.zeros(6)) + load


@dataclass(frozen=True)
class StressedShaft:
    """Stress of one shaft, alone or of a train."""

    name: str
    scene: Scene = field(repr=False)
    acting: ShaftLoads
    found: ShaftStress
    #: least and largest of the largest bending moment, N m, over the open data of bearings; None if
    #: none are open
    open_moment: tuple[float, float] | None
    open: Mapping[str, tuple[float, float]]  #: the same of the amplitude on each fillet, Pa
    #: the same of the least safety of all notches; None of a duty table, or without ratings
    open_safety: tuple[float, float] | None = None
    solids: tuple[SolidNotch, ...] = ()  #: grooves, and keyways and cross holes where asked for
    #: sentences on features that no solid gives stress to
    without_solid: tuple[str, ...] = ()

    @property
    def weak(self) -> tuple[str, ...]:
        """Segments with a notch whose material has no strength."""
        segments = [self.scene.segments[notch.found.corner.owner] for notch in self.found.notches]
        names = {drawn.segment for drawn in self.found.drawn}
        segments += [segment for segment in self.scene.segments if segment.name in names]
        return tuple(dict.fromkeys(s.name for s in segments if strength_of(s) is None))


class LeastSafety(NamedTuple):
    """The least safety of one kind."""

    value: float
    shaft: StressedShaft
    notch: Notch | DrawnStress


def least_safety(shafts: Sequence[StressedShaft], kind: Kind) -> LeastSafety | None:
    """Return the least safety of a kind over all notches of some shafts; None where none has one."""
    rated = [
        LeastSafety(notch.rating.safeties[kind], shaft, notch)
        for shaft in shafts
        for notch in shaft.found.worst
        if notch.rating is not None and kind in notch.rating.safeties
    ]
    return min(rated, key=lambda least: least.value, default=None)


def lesser_elsewhere(
    shafts: Sequence[StressedShaft], worst: Rating
) -> Iterator[tuple[Kind, LeastSafety]]:
    """Yield the kinds of which another notch has less than that of the least against fatigue has."""
    for kind, value in worst.safeties.items():
        least = least_safety(shafts, kind)
        if least is not None and least.value < (1 - LITTLE) * value:
            yield kind, least


@dataclass(frozen=True)
class StressSettings:
    """Tolerance of form factors, which some mesh must reach, and conditions of the rating."""

    tolerance: float = ENOUGH  #: relative error bar of form factors at which their meshes stop
    conditions: Conditions = Conditions()  #: of the rating by DIN 743
    duty: bool = False  #: whether ratings are over the duty table
    #: the same of 3D solids at keyways and cross holes; None for no such solids
    local: float | None = None
    #: whether grooves and other features get the stress on their surface, by solids that no rating uses
    surfaces: bool = True

    def __post_init__(self) -> None:
        check_tolerance(self.tolerance)
        if self.local is not None and not FINEST_LOCAL <= self.local < 1:
            raise SolidgearError(
                f"local = {self.local}: give a relative error bar of 3D solids from {FINEST_LOCAL:g} to 1"
            )


@dataclass(frozen=True)
class AtPoint:
    """Operating point of a train, and the mesh force there."""

    point: OperatingPoint
    mesh_force: float  #: N


@dataclass(frozen=True, repr=False)
class StressAtRest(Sheeted):
    """Stress of a shaft under its load, or of all shafts of a train at an operating point."""

    sheeted: ClassVar[str] = "strength.stress.sheet:sheet"

    title: str
    model: str  #: on which shafts and bearings settled
    under: LoadsAlone | AtPoint
    asked: StressSettings
    shafts: tuple[StressedShaft, ...]
    open_by: str  #: open data of bearings, in words; empty if none
    cautions: tuple[str, ...] = ()  #: beside the remarks of each shaft
    #: labels of the points of the duty table that ratings are over; empty where they are of the loads
    duty: tuple[str, ...] = ()
    #: of a shaft alone with several cases of its loads
    cases: tuple[CaseStress, ...] = ()

    @property
    def reached(self) -> bool:
        """Return whether the error bars of all form factors are within the tolerance."""
        notches = [notch for shaft in self.shafts for notch in shaft.found.notches]
        solids = [notch for shaft in self.shafts for notch in shaft.solids]
        of_fillets = all(notch.found.widest <= self.asked.tolerance for notch in notches)
        return of_fillets and all(notch.reached for notch in solids)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI that JSON can hold."""
        data = plain(self) | {"components": list(COMPONENTS), "shafts": {}}
        data["why_without_bar"] = WITHOUT_BAR
        data["asked"]["conditions"] = self.asked.conditions.model_dump(mode="json")
        for shaft in self.shafts:
            worst = [notch.name for notch in shaft.found.worst]
            data["shafts"][shaft.name] = plain(shaft) | {"worst": worst[0] if worst else None}
        return data


def stress_at_rest(
    assembly: Assembly,
    point: OperatingPoint = AT_REST,
    model: str = "",
    asked: StressSettings = StressSettings(),
    progress: Progress = lambda text: None,
) -> StressAtRest:
    """Compute the stress of all shafts of a train at an operating point, or of a shaft under the
    loads of its scene; shafts and bearings settle on a model, no lumped one, which has no places, by
    default on what models all of each shaft. Bearings of catalogue data need no stiffness yet.
    """
    load = loads_alone(assembly.train, point)
    rounded = {
        side: shaft.with_changes(scene=filleted(shaft.scene))
        for side, shaft in assembly.asked_train.shafts.items()
    }
    train = assembly.asked_train.with_changes(shafts=rounded)
    train = train.with_solved_meshes(assembly.teeth.solved)
    settling, models, label = _settled_by(replace(assembly, train=train), model)
    progress(label)
    usual = Operating(settling, *models).at(point)

    def acting(choice: Choice) -> dict[str, ShaftLoads]:
        as_stated = choice == AS_STATED
        state = usual if as_stated else Operating(settling, *models, choice=choice).at(point)
        return _on_shafts(settling, state)

    duty = _duty(train, settling, models, asked) if asked.duty else {}
    several = train.is_one_shaft and len(train.operation) > 1
    at_points = _at_points(train, settling, models) if several and not asked.duty else []
    shafts, open_by = _shafts(train, acting, asked, duty, progress)
    files = {side: shaft.scene.body for side, shaft in assembly.train.shafts.items()}
    left_out = [text for k in files for text in _file_cautions(files[k], train.shafts[k].scene)]
    torque = _torque_cautions(train) if load is None else _load_cautions(train, load)
    return StressAtRest(
        title=train.title or train.name,
        model=label,
        under=load or AtPoint(point, usual.mesh_force),
        asked=asked,
        shafts=shafts,
        open_by=open_by,
        cautions=(*left_out, *usual.notes, *usual.assembly.cautions_at_rest(*models), *torque),
        duty=tuple(each.label for each in train.operation) if asked.duty else (),
        cases=tuple(_cases(train.operation, at_points, shafts[0], asked.conditions)),
    )


def _settled_by(assembly: Assembly, model: str) -> tuple[Assembly, tuple[str, ...], str]:
    """Return the shafts on which bearings settle, their models, and these in words."""
    if model:
        return assembly.settling(model), (model,), model
    if assembly.left_out(BEAM) and assembly.train.is_one_shaft:
        if _is_determinate(assembly.scenes[ALONE]):
            return assembly.settling(BEAM), (BEAM,), STATICS
    models = assembly.solids
    label = models[0] if len(models) == 1 else mix_label(assembly.models_by_shaft(models))
    return assembly.at_ports(), models, label


def _is_determinate(scene: Scene) -> bool:
    """Return whether bearings of a shaft resist each of its motions once at most, so that their loads
    follow from equilibrium: with the turning about the axis for itself.
    """
    across = [0, 1, 2, 3, 5]
    count, turning = 0, 0
    for bearing in scene.bearings:
        if bearing.catalogue is not None or bearing.matrix is None:
            return False
        stiffness = np.array(bearing.stiffness)
        least = ROUNDING * np.abs(stiffness).max(initial=0.0)
        count += int(np.linalg.matrix_rank(stiffness[np.ix_(across, across)], tol=least))
        turning += int(stiffness[4, 4] > 0)
    return count <= len(across) and turning <= 1


def _duty(
    train: Train, settling: Assembly, models: Sequence[str], asked: StressSettings
) -> dict[str, list[DutyForces]]:
    """Return section forces and turns of every shaft over the points of the duty table."""
    turns = cycles_of(train, asked.conditions)
    out: dict[str, list[DutyForces]] = {side: [] for side in turns}
    for k, (point, by_side) in enumerate(zip(train.operation, _at_points(train, settling, models))):
        for side, forces in by_side.items():
            out[side].append(DutyForces(point.label, forces, turns[side][k]))
    return out


def _at_points(
    train: Train, settling: Assembly, models: Sequence[str]
) -> list[dict[str, SectionForces]]:
    """Return section forces of every shaft at all points of a train, or in all cases of a shaft."""
    operating = Operating(settling, *models)
    out, state = [], None
    for point in train.operation:
        state = operating.at(point, state)
        acting = _on_shafts(settling, state)
        out.append(
            {
                side: forces_of(train.shaft(side), loads.loads, loads.gravity)
                for side, loads in acting.items()
            }
        )
    return out


def _cases(
    points: Sequence[OperatingPoint],
    at_points: Sequence[dict[str, SectionForces]],
    shaft: StressedShaft,
    conditions: Conditions,
) -> Iterator[CaseStress]:
    """Yield the stress of a shaft alone in all of its cases."""
    for point, by_side in zip(points, at_points):
        yield case_stress(point.label, shaft.scene, shaft.found, by_side[ALONE], conditions)


def _file_cautions(file: BodyFile | None, scene: Scene) -> Iterator[str]:
    """Yield sentences on parts of a file that the round part leaves out, whose fillets are those of
    a scene.
    """
    if file is None:
        return
    if file.uneven:
        stretches = listed(f"{1e3 * lo:.6g} to {1e3 * hi:.6g}" for lo, hi in file.uneven)
        yield (
            f"{file.name} is not round from y = {stretches} mm: sections there have no nominal "
            "stress, and cuts in it are no notches here; solve them as a 3D solid, or rate them as "
            "[[feature]] of a shaft of segments"
        )
    if cones := len(file.tori) - len(scene.blends):
        yield (
            f"{cones} of {len(file.tori)} arcs of {file.name} are modelled as short cones, so "
            "they have no stress; only quarter-circle fillets at a shoulder, outside seats, have "
            "one"
        )


def _load_cautions(train: Train, load: LoadsAlone) -> Iterator[str]:
    """Yield sentences on loads that do not act on a shaft alone, and perhaps should."""
    yield from load.assumed
    if not any(acting.six[4] for acting in load.acting):
        yield "no torque runs along the shaft; a [[load]] with a torque, or --drive, says where one is"
    loaded = {acting.station: None for acting in load.acting}
    for point in train.shafts[ALONE].scene.further_ports:
        if point.name not in loaded:
            yield f'nothing acts at the point "{point.name}"; loads act at {listed([*loaded])}'


def _on_shafts(assembly: Assembly, state: OperatingState) -> dict[str, ShaftLoads]:
    """Return all loads that act on the shafts of a train at rest."""
    out = {}
    for side, scene in assembly.scenes.items():
        turned = state.system.port(f"{side}.{scene.port.name}").axes.T
        gravity = turned @ np.array(state.point.gravity)
        out[side] = ShaftLoads({}, gravity if state.point.weight else None)
        for end, head in assembly.train.heads(side).values():
            out[side].add(end.partition(".")[2], head.mass * np.r_[gravity, np.zeros(3)])
    for end, six in state.forces().items():
        side, _, port = end.partition(".")
        if side in out:  # an engine and a load only turn
            out[side].add(port, six)
    return out


def _torque_cautions(train: Train) -> Iterator[str]:
    """Yield sentences on shafts whose torque enters where the teeth take it out."""
    for name, rotor in train.rotors.items():
        side, port = rotor.shaft, train.spring_port(name)
        if [*train.shafts[side].gears] == [port]:
            yield (
                f"no torque runs along the {side}, since {name}.spring is at the teeth (at = "
                f'"{port}"); put it where the torque enters'
            )


def _shafts(
    train: Train,
    acting: Callable[[Choice], dict[str, ShaftLoads]],
    asked: StressSettings,
    duty: Mapping[str, Sequence[DutyForces]],
    progress: Progress,
) -> tuple[tuple[StressedShaft, ...], str]:
    """Return the stress of every shaft, and in words which data of bearings are open."""
    scenes = {side: train.shaft(side) for side in train.shafts}
    usual = acting(AS_STATED)
    open_by, choices = left_open(scenes.values())
    if choices:
        progress("what the data of bearings leave open")
    variants = [acting(choice) for choice in choices]
    shafts = []
    for side, scene in scenes.items():
        shaft_loads = usual[side]
        stress = shaft_stress(
            scene,
            shaft_loads.loads,
            gravity=shaft_loads.gravity,
            tolerance=asked.tolerance,
            conditions=asked.conditions,
            duty=duty.get(side, ()),
            progress=progress,
        )
        further = [forces_of(scene, loads[side].loads, loads[side].gravity) for loads in variants]
        name = scene.name if train.is_one_shaft else side
        solids: tuple[tuple[SolidNotch, ...], tuple[str, ...]] = (), ()
        if asked.surfaces:
            solids = solid_notches(scene, stress, asked.tolerance, asked.local, progress)
        safety = None if asked.duty else _open_safety(scene, stress, further, asked.conditions)
        ranges = _ranges(stress, further)
        shafts.append(StressedShaft(name, scene, shaft_loads, stress, *ranges, safety, *solids))
    return tuple(shafts), open_by


def _open_safety(
    scene: Scene, stress: ShaftStress, variants: Sequence[SectionForces], conditions: Conditions
) -> tuple[float, float] | None:
    """Return the range of the least safety over the section forces solved and the variants."""
    usual = min((rating.worst for rating in stress.ratings), default=None)
    if not variants or usual is None:
        return None
    others = (rated_under(scene, stress, forces, conditions) for forces in variants)
    safeties = [usual, *(min(notch.rating.worst for notch in rated) for rated in others)]
    return min(safeties), max(safeties)


def _ranges(
    stress: ShaftStress, variants: Sequence[SectionForces]
) -> tuple[tuple[float, float] | None, dict[str, tuple[float, float]]]:
    """Return ranges of the largest bending moment, N m, and of the amplitude on each fillet, Pa,
    over the section forces that were solved and the variants.
    """
    if not variants:
        return None, {}
    moments = [forces.largest_moment for forces in (stress.forces, *variants)]
    amplitudes = {
        notch.name: [
            notch.local.amplitude,
            *(local_under(notch, forces).amplitude for forces in variants),
        ]
        for notch in stress.notches
    }
    return (min(moments), max(moments)), {k: (min(v), max(v)) for k, v in amplitudes.items()}
