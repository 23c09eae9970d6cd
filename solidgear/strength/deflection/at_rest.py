"""Deflection of the shafts of a train at an operating point, or of a shaft under its load, by any
model, with the error bars of :mod:`solidgear.trains.load.static_errors`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from solidgear.bearings.bearing_life import left_open
from solidgear.bearings.solved import Choice
from solidgear.core import (
    DOF_NAMES,
    LADDER,
    WITHIN,
    Sheeted,
    SolidgearError,
    gap_verdict,
    listed,
    pinned,
)
from solidgear.core.plain import plain
from solidgear.core.scene.acting import holders
from solidgear.strength.deflection.face_load import FaceLoad, face_loads
from solidgear.strength.deflection.leading import leading_bearing
from solidgear.strength.deflection.misalignment import Measure, misalignment
from solidgear.strength.deflection.shaft import ShaftDeflection, shaft_deflection
from solidgear.strength.load import AT_REST, LoadsAlone, loads_alone
from solidgear.strength.statics import Statics, statics
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.components import FORCE_UNITS
from solidgear.trains.assembly.housing import BOX, housing_motion, mount_rows
from solidgear.trains.assembly.layout import senses
from solidgear.trains.assembly.shaft import JUDGE, LUMPED, RIGID, mix_label
from solidgear.trains.assembly.turn import StageTurn, over_a_turn
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import ALONE, Train
from solidgear.trains.load.meshes_at_rest import MeshesAtRest
from solidgear.trains.load.operation import Operating
from solidgear.trains.load.state import OperatingState
from solidgear.trains.load.static_errors import StaticErrors
from solidgear.trains.load.twist import still_station

#: of the largest motion or load of all places; less is rounding
ROUNDING = 1e-8
#: models that a deflection is solved with before the solids that judge, the cheapest first
CHEAPER = (RIGID, "euler", "timoshenko")
MOVED = ("m moved",) * 3 + ("rad moved",) * 3
#: why numbers of a shaft alone have no error bar
WITHOUT_BAR = f"they come with a solid, such as {JUDGE}, which is not among the models"


@dataclass(frozen=True)
class Measured:
    """A number of deflected shafts, with error bar and range over open data."""

    plain_names = ("value", "bar", "open", ("unit", "si_unit"))

    name: str
    unit: str
    meaning: str
    value: float  #: SI
    bar: float | None  #: largest error by the meshes, SI; None without a harmonic solid
    #: least and largest value over open data of bearings; None where none are open
    open: tuple[float, float] | None = None
    #: of a misalignment where there are several meshes: its name at the end of `name`
    mesh: str = ""
    face: float | None = None  #: width that a meaning over the face is of, m

    @property
    def si_unit(self) -> str:
        """Unit in SI."""
        return self.unit.split()[0]


@dataclass(frozen=True, eq=False)
class Deflection:
    """A train at rest at one operating point, or a shaft alone, by one model of each shaft."""

    point: OperatingPoint
    load: LoadsAlone | None  #: of a shaft alone
    models: dict[str, str]  #: by shaft
    mesh_forces: dict[str, float]  #: N, along the line of action, by mesh
    misalignment: tuple[Measured, ...]
    #: of every lumped point, by its shaft, or of one with several gears by shaft and point, six
    #: components; rotations about the axis are against the port of the engine's spring. With a
    #: housing also of its centre of mass, in the axes of the train. Of a shaft alone, of all its
    #: places.
    displacement: dict[str, tuple[Measured, ...]]
    shafts: tuple[ShaftDeflection, ...]
    notes: tuple[str, ...]
    seconds: float  #: to settle, once bodies are there
    #: load (6) of the housing on each mount, N and N m
    mounts: dict[str, tuple[Measured, ...]] = field(default_factory=dict)
    turns: tuple[StageTurn, ...] = ()  #: of planetary stages
    face_loads: tuple[FaceLoad, ...] = ()  #: by the norm, of meshes whose teeth are known
    #: sentence on the one bearing whose inside leaves most of what is open; empty where there is none
    led: str = ""
    statics: Statics | None = None  #: of a shaft alone
    lumped: tuple[str, ...] = ()  #: names of the lumped points of a shaft alone
    still: str = (
        ""  #: station of a twisted shaft alone that does not turn; empty where bearings hold it
    )
    why_without_bar: str = (
        ""  #: reason why its solids have no bars; empty where they have, or are none
    )

    @property
    def model(self) -> str:
        """The model of all shafts, or of each."""
        equal = len({*self.models.values()}) == 1
        return next(iter(self.models.values())) if equal else mix_label(self.models)

    @cached_property
    def largest(self) -> tuple[np.ndarray, np.ndarray]:
        """Sizes (6,) beside which a motion, m and rad, and a load, N and N m, may be rounding: those of
        all places, where a rotation moves as far as the length of its shaft, and so a moment.
        """
        length = max(shaft.stations[-1] for shaft in self.shafts)
        moved = [six for shaft in self.shafts for six in (*shaft.line, *shaft.ports.values())]
        loads = [b.load for shaft in self.shafts for b in shaft.bearings]
        loads += [np.array([force, 0, 0, 0, 0, 0]) for force in self.mesh_forces.values()]
        if self.load is not None:
            loads += [np.asarray(load.six) for load in self.load.acting]
        return _sizes(moved, length), _sizes(loads, 1 / length)

    def largest_beside(self, measure: Measured) -> float:
        """Return the size beside which a number of motion may be rounding."""
        return float(self.largest[0][3 if measure.si_unit == "rad" else 0])

    @property
    def compared(self) -> tuple[Measured, ...]:
        """Numbers by which models are compared: the misalignment, or the motion of the lumped point
        of a shaft alone.
        """
        return self.misalignment if self.load is None else self.displacement[self.load.port]

    @property
    def barred(self) -> bool:
        """Whether the meshes of the model have error bars."""
        return any(m.bar is not None for m in self.compared)

    @property
    def bars_by(self) -> str:
        """Where the error bars of the meshes come from, in words."""
        models = [LADDER[m] for m in self.models.values() if m in LADDER]
        return (
            listed(dict.fromkeys(m.bars_by for m in models if m.bars_by)) or LADDER[JUDGE].bars_by
        )

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        by_place = {place: _by_name(six) for place, six in self.displacement.items()}
        solved = {"notes": self.notes, "seconds": self.seconds}
        if self.load is not None:
            solved |= {"case": self.load.case, "statics": self.statics}
            return plain(self.shafts[0]) | plain({"displacement": by_place, **solved})
        data = {
            "point": self.point,
            **self.models,
            "mesh_force": next(iter(self.mesh_forces.values())),
            "mesh_forces": self.mesh_forces,
            "misalignment": _by_name(self.misalignment),
            "face_load_norm": {load.mesh: load for load in self.face_loads},
            "displacement": by_place,
            "shafts": {shaft.name: shaft for shaft in self.shafts},
            "turns": {turn.stage: turn for turn in self.turns},
            **solved,
        }
        if self.mounts:
            data["mounts"] = {place: _by_name(six) for place, six in self.mounts.items()}
        return plain(data)


def _sizes(sixes: Sequence[np.ndarray], lever: float) -> np.ndarray:
    """Return the largest of the first three components and of `lever` times the others, and that over
    `lever` for the others.
    """
    largest = np.abs(np.reshape(sixes, (-1, 2, 3))).max(axis=(0, 2), initial=0.0)
    size = max(largest[0], lever * largest[1])
    return np.repeat([size, size / lever], 3)


def _by_name(measures: Sequence[Measured]) -> dict[str, Measured]:
    return {measure.name: measure for measure in measures}


@dataclass(frozen=True)
class Standing:
    """A model of all shafts against the judge, for the numbers that are compared."""

    model: str
    verdict: str  #: ``within``, ``open`` or ``beyond`` the tolerance
    worst: str  #: number that is farthest off, relative to the size of its kind
    gap: float  #: by so much, relative


@dataclass(frozen=True, eq=False, repr=False)
class Deflections(Sheeted):
    """A train at one operating point, or a shaft under its load, by several models."""

    sheeted: ClassVar[str] = "strength.deflection.sheet:sheet"

    title: str
    tolerance: float  #: of the numbers that are compared, relative
    solutions: tuple[Deflection, ...]  #: the judge last
    standings: tuple[Standing, ...]
    cautions: tuple[str, ...]
    senses: dict[str, str]  #: in which each shaft turns, ``+y`` or ``-y`` of its scene
    points: tuple[Deflection, ...] = ()
    planets: tuple[str, ...] = ()  #: meshes that stand for one of each planet

    @property
    def judge(self) -> Deflection:
        """The finest model that was solved."""
        return self.solutions[-1]

    @property
    def load(self) -> LoadsAlone | None:
        """Load of a shaft alone; None for a train."""
        return self.judge.load

    @property
    def cheapest(self) -> Standing | None:
        """The cheapest model within the tolerance; None where only the judge is."""
        return next((standing for standing in self.standings if standing.verdict == WITHIN), None)

    @property
    def why_without_bar(self) -> str:
        """Reason why no number has an error bar; empty where some have one."""
        if any(solution.barred for solution in self.solutions):
            return ""
        return self.judge.why_without_bar or WITHOUT_BAR

    def verdict(self) -> str:
        """Return a sentence on the cheapest model for the misalignment, or for the motion of the
        lumped point of a shaft alone.
        """
        if not self.judge.compared:
            return "No gears mesh, whose misalignment could judge the models."
        if not self.standings:
            return "One model was solved, so that none is judged."
        demand = f"{100 * self.tolerance:g} % of the "
        if self.load is None:
            demand += f"misalignment at {self.judge.point.label}"
        else:
            demand += f"motion of {self.load.port}"
        if self.cheapest is None:
            near = min(self.standings, key=lambda standing: abs(standing.gap))
            return (
                f"No cheaper model was shown to be within {demand}: use {self.judge.model}. The "
                f"nearest, {near.model}, is {100 * abs(near.gap):.2g} % off ({near.worst})."
            )
        standing = self.cheapest
        return (
            f"Cheapest model within {demand}: {standing.model} ({100 * standing.gap:.2g} % off: "
            f"{standing.worst})."
        )

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        data: dict[str, Any] = {"train": self.title}
        if self.load is not None:
            data = {"scene": self.title, **plain(self.load)}
            data["why_without_bar"] = self.why_without_bar
        return data | {
            "tolerance": self.tolerance,
            "verdict": self.verdict(),
            "models": {solution.model: solution.as_dict() for solution in self.solutions},
            "standings": plain(self.standings),
            "cautions": list(self.cautions),
            "senses": self.senses,
            "points": [solution.as_dict() for solution in self.points],
        }


def deflect(
    assembly: Assembly,
    point: OperatingPoint = AT_REST,
    models: Sequence[str] = (),
    progress: Callable[[str], None] = lambda text: None,
    every: bool = False,
) -> Deflections:
    """Compute deflection and misalignment of a train at an operating point, or the deflection of a
    shaft under the [load] of its scene, by several models of all shafts, the finest last, and by
    that at every operating point if `every`; lumped models have no bearings of their own and are
    refused, and bearings of catalogue data need no stiffness yet. By default the last are the solids
    that model all of each shaft, and those before are of revolution, of the plain parts of shafts with
    cuts.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_straddle.toml"))
    >>> found = deflect(assembly, OperatingPoint(torque=200.0), ("euler", "timoshenko"))
    >>> [m.name for m in found.judge.misalignment], len(found.judge.shafts[0].bearings)
    (['E', 'P', 'G', 'shaft angle'], 3)
    >>> shaft = Assembly.of(sg.load("geometry/gearbox_catalogue.toml"))
    >>> bearings = deflect(shaft, models=["timoshenko"]).judge.shafts[0].bearings
    >>> round(sum(float(bearing.load[2]) for bearing in bearings), 6)
    1400.0
    """
    asked: list[tuple[Assembly, tuple[str, ...]]] = [(assembly, (model,)) for model in models]
    left_out: list[str] = []
    if not models:
        assembly, plain_parts = assembly.at_ports(), assembly.settling(CHEAPER[-1])
        asked = [(plain_parts, (model,)) for model in CHEAPER]
        asked.append((assembly, assembly.solids))
        left_out += (
            f"{cuts}: {listed(CHEAPER)} leave it out, since they are of revolution; what is shown last "
            "has it"
            for cuts in assembly.left_out(CHEAPER[-1])
        )
    train, solutions = assembly.train, []
    for shafts, names in asked:
        progress(_in_words(names))
        solutions.append(deflection(shafts, point, *names))
    progress("what the data of bearings leave open")
    solutions[-1] = with_ranges(assembly, solutions[-1])
    standings = tuple(
        _against_judge(solution, solutions[-1], train.ask.tolerance) for solution in solutions[:-1]
    )
    points: list[Deflection] = []
    if every:
        progress(f"{len(train.operation)} operating points")
        points = deflections(assembly, train.operation, *asked[-1][1])
    at_point = assembly.at(point)
    return Deflections(
        title=train.title or train.name,
        tolerance=train.ask.tolerance,
        solutions=tuple(solutions),
        standings=standings,
        cautions=(*at_point.cautions_at_rest(*asked[-1][1]), *left_out),
        senses={} if train.is_one_shaft else senses(train, at_point.contacts, point.coast),
        points=tuple(points),
        planets=tuple(stage.name for stage in train.stages),
    )


def _in_words(models: Sequence[str]) -> str:
    return models[0] if len(models) == 1 else ", ".join(models)


def deflection(assembly: Assembly, point: OperatingPoint, *models: str) -> Deflection:
    """Compute the deflection of a train at an operating point by one model of each shaft, as
    :func:`deflections`.
    """
    return deflections(assembly, [point], *models)[0]


@pinned
def deflections(
    assembly: Assembly, points: Sequence[OperatingPoint], *models: str
) -> list[Deflection]:
    """Compute the deflection of a train at several operating points, each begun at the one before,
    by one model of each shaft.
    """
    by_shaft = assembly.models_by_shaft(models)
    loads = [loads_alone(assembly.train, point) for point in points]
    for model in by_shaft.values():
        if model.partition("/")[0] in LUMPED:
            raise SolidgearError(
                f"a {model} shaft has its bearings condensed into it; use one of "
                f"{', '.join((*CHEAPER, JUDGE))}"
            )
    MeshesAtRest(assembly, models).begin()
    for side, model in by_shaft.items():
        assembly.shaft_model(side, model)  # no settling to be timed
    operating = Operating(assembly, *models)
    state: OperatingState | None = None
    out = []
    for point, load in zip(points, loads):
        start = perf_counter()
        state = operating.at(point, state)
        out.append(_solution(assembly, state, load, perf_counter() - start))
    return out


def _solution(
    assembly: Assembly, state: OperatingState, load: LoadsAlone | None, seconds: float
) -> Deflection:
    """Return the deflection of a train at rest."""
    train, system, by_shaft = assembly.train, state.system, state.models
    errors = StaticErrors(assembly, state)

    def measured(measures: Sequence[Measure]) -> tuple[Measured, ...]:
        return tuple(_measured(measure, state, errors) for measure in measures)

    housed = {
        side: housing_motion(system, assembly.places[side], state.coordinates)
        for side in train.housed
    }
    shafts = tuple(
        shaft_deflection(
            side,
            model,
            assembly.scenes[side],
            system,
            state.equilibrium,
            None if model.partition("/")[0] == RIGID else assembly.shaft_model(side, model).body,
            state.bearings,
            housed.get(side),
        )
        for side, model in by_shaft.items()
    )
    askew = misalignment(state.assembly, system)
    notes = [*state.notes, *(note for shaft in shafts for note in shaft.notes)]
    if housed:
        notes.append(f"deflection lines of {listed(housed)} are relative to the housing")
    displacement = {
        name: measured(_six(f"of {end}", MOVED, system.motion(end)))
        for name, end in _places(train).items()
    }
    if train.housing is not None:
        displacement[HOUSING] = measured(_six("of its centre", MOVED, system.motion(BOX)))
        if train.stages:
            notes.append("forces over a turn of a carrier are not computed with a housing")
    mounts = {
        name: measured(_six("on it", FORCE_UNITS, rows))
        for name, rows in mount_rows(train, system).items()
    }
    return Deflection(
        point=state.point,
        load=load,
        models=by_shaft,
        mesh_forces=state.mesh_forces,
        misalignment=measured(askew),
        displacement=displacement,
        shafts=shafts,
        notes=tuple(notes),
        seconds=seconds,
        mounts=mounts,
        turns=over_a_turn(assembly, state, by_shaft),
        face_loads=face_loads(state, errors, askew),
        statics=_statics(assembly, load, shafts),
        lumped=() if load is None else tuple(p.name for p in assembly.scenes[ALONE].ports),
        still=_still(assembly, load),
        why_without_bar=errors.why_none,
    )


def _statics(
    assembly: Assembly, load: LoadsAlone | None, shafts: Sequence[ShaftDeflection]
) -> Statics | None:
    """Return the statics of a shaft alone."""
    if load is None:
        return None
    carried = {bearing.name: bearing.load for bearing in shafts[0].bearings}
    return statics(assembly.scenes[ALONE], load, carried)


def _still(assembly: Assembly, load: LoadsAlone | None) -> str:
    """Return the station that a twisted shaft alone turns against; empty where bearings hold it."""
    if load is None or not any(acting.six[4] for acting in load.acting):
        return ""
    scene = assembly.scenes[ALONE]
    return "" if holders(scene.bearings) else still_station(scene)


def _measured(measure: Measure, state: OperatingState, errors: StaticErrors) -> Measured:
    """Return the value of a measure at rest with its error bar."""
    return Measured(
        measure.name,
        measure.unit,
        measure.meaning,
        float(measure.row @ state.coordinates),
        errors.error_bar(measure.row),
        mesh=measure.mesh,
        face=measure.face,
    )


def _places(train: Train) -> dict[str, str]:
    """Return the ports whose motion is shown, by name: lumped points, and of a shaft alone all."""
    if train.is_one_shaft:
        stations = train.shafts[ALONE].scene.stations
        return {station.name: f"{ALONE}.{station.name}" for station in stations}
    return {
        side if len(shaft.gears) == 1 else f"{side}.{port}": f"{side}.{port}"
        for side, shaft in train.shafts.items()
        for port in shaft.gears
    }


def _six(meaning: str, units: Sequence[str], rows: np.ndarray) -> list[Measure]:
    """Return the motion of a place, or the load on it, as six components."""
    return [Measure(name, unit, meaning, row) for name, unit, row in zip(DOF_NAMES, units, rows)]


def with_ranges(assembly: Assembly, solution: Deflection) -> Deflection:
    """Return the same with the ranges of the numbers that are compared over estimated insides and
    clearance classes.
    """
    middle = np.array([m.value for m in solution.compared])
    _, choices = left_open(shaft.scene for shaft in assembly.train.shafts.values())
    if not choices:
        return solution

    def values_at(choice: Choice) -> np.ndarray:
        operating = Operating(assembly, *solution.models.values(), choice=choice)
        state = operating.at(solution.point)
        if solution.load is None:
            measures = misalignment(state.assembly, state.system)
            return np.array([float(m.row @ state.coordinates) for m in measures])
        return np.array(state.motion(f"{ALONE}.{solution.load.port}"))

    values = np.array([middle, *map(values_at, choices)])
    low, high = values.min(axis=0), values.max(axis=0)
    measured = tuple(
        replace(m, open=(float(a), float(b))) for m, a, b in zip(solution.compared, low, high)
    )
    led = leading_bearing(assembly.train, measured, values_at)
    if solution.load is None:
        return replace(solution, misalignment=measured, led=led)
    displacement = solution.displacement | {solution.load.port: measured}
    return replace(solution, displacement=displacement, led=led)


def _against_judge(solution: Deflection, judge: Deflection, tolerance: float) -> Standing:
    """Compare a model with the judge: lengths against the largest length, angles against the
    largest angle, and none that is rounding, as of a shaft that is alike about its middle.
    """
    worst, gap, bar = "", 0.0, 0.0
    for unit in dict.fromkeys(m.unit for m in judge.compared):
        pairs = [(m, j) for m, j in zip(solution.compared, judge.compared) if j.unit == unit]
        scale = float(np.linalg.norm([j.value for _, j in pairs]))
        if scale <= ROUNDING * judge.largest_beside(pairs[0][1]):
            scale = 0.0
        for measure, reference in pairs:
            error = (measure.value - reference.value) / scale if scale else 0.0
            if abs(error) >= abs(gap):
                worst, gap, bar = measure.name, error, (reference.bar or 0.0) / (scale or 1.0)
    return Standing(solution.model, gap_verdict(gap, bar, tolerance), worst, gap)
