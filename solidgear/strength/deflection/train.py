r"""Deflection and misalignment of a train at an operating point, by any model, with error bars.

A quantity a'q of the state at rest has an error bar where a shaft is a harmonic solid: the flexibility at
the ports lies between F and F + M (:mod:`solidgear.core.bounds.harmonic`), so that with the forces f on
the ports at rest, and those, g, which a unit load on the quantity would bring about on the bearings'
tangents,

    |error| <= sqrt(f'M f) sqrt(g'M g),      summed over the shafts

(Cauchy and Schwarz in the energy of the local problems; second order in M is left out).  Beams are
exact in their theory and have no error bar; the harmonic solid shows what their theory leaves out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Any

import numpy as np

from solidgear.bearings.bearing_life import left_open
from solidgear.core import DOF_NAMES, SolidgearError, System, coned, listed, pinned
from solidgear.core.bounds.harmonic import HarmonicBounds, harmonic_bounds, with_tail
from solidgear.core.bounds.safety import LOCAL
from solidgear.core.judge.deviations import WITHIN, gap_verdict
from solidgear.core.system.system import port_forces
from solidgear.strength.deflection.misalignment import misalignment
from solidgear.strength.deflection.shaft import ShaftDeflection, shaft_deflection
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.components import FORCE_UNITS
from solidgear.trains.assembly.housing import BOX, housing_motion, mount_rows
from solidgear.trains.assembly.layout import senses
from solidgear.trains.assembly.shaft import JUDGE, LUMPED, RIGID, mix_label
from solidgear.trains.assembly.turn import StageTurn, over_a_turn
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.load.operation import Operating, OperatingState, with_settled_bearings

#: models that a deflection is solved with, the cheapest first
MODELS = (RIGID, "euler", "timoshenko", JUDGE)
MOVED = ("m moved",) * 3 + ("rad moved",) * 3


@dataclass(frozen=True)
class Measured:
    """A number of a deflected train, with error bar and range over open data."""

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

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        unit = self.unit.split()[0]
        return {"value": self.value, "bar": self.bar, "open": self.open, "unit": unit}


@dataclass(frozen=True, eq=False)
class TrainDeflection:
    """A train at rest at one operating point, by one model of each shaft."""

    point: OperatingPoint
    models: dict[str, str]  #: by shaft
    mesh_forces: dict[str, float]  #: N, along the line of action, by mesh
    misalignment: tuple[Measured, ...]
    #: of every lumped point, by its shaft, or of one with several gears by shaft and point, six
    #: components; rotations about the axis are against the port of the engine's spring. With a
    #: housing also of its centre of mass, in the axes of the train.
    displacement: dict[str, tuple[Measured, ...]]
    shafts: tuple[ShaftDeflection, ...]
    notes: tuple[str, ...]
    seconds: float  #: to settle, once bodies are there
    #: load (6) of the housing on each mount, N and N m
    mounts: dict[str, tuple[Measured, ...]] = field(default_factory=dict)
    turns: tuple[StageTurn, ...] = ()  #: of planetary stages

    @property
    def mesh_force(self) -> float:
        """Force of the first mesh, N."""
        return next(iter(self.mesh_forces.values()))

    @property
    def model(self) -> str:
        """The model of all shafts, or of each."""
        equal = len({*self.models.values()}) == 1
        return next(iter(self.models.values())) if equal else mix_label(self.models)

    def as_dict(self) -> dict:
        """Return plain data in SI for JSON."""
        data = {
            "point": self.point.model_dump(mode="json"),
            **self.models,
            "mesh_force": self.mesh_force,
            "mesh_forces": self.mesh_forces,
            "misalignment": {m.name: m.as_dict() for m in self.misalignment},
            "displacement": _components_as_dict(self.displacement),
            "shafts": {shaft.name: shaft.as_dict() for shaft in self.shafts},
            "turns": {turn.stage: turn.as_dict() for turn in self.turns},
            "notes": list(self.notes),
            "seconds": self.seconds,
        }
        return data | ({"mounts": _components_as_dict(self.mounts)} if self.mounts else {})


def _components_as_dict(places: dict[str, tuple[Measured, ...]]) -> dict:
    return {
        place: {m.name: m.as_dict() for m in components} for place, components in places.items()
    }


@dataclass(frozen=True)
class Standing:
    """A model of all shafts against the judge, for the misalignment."""

    model: str
    verdict: str  #: ``within``, ``open`` or ``beyond`` the tolerance
    worst: str  #: number that is farthest off, relative to the size of its kind
    gap: float  #: by so much, relative


@dataclass(frozen=True, eq=False)
class Deflections:
    """A train at one operating point, by several models."""

    title: str
    tolerance: float  #: of the misalignment, relative
    solutions: tuple[TrainDeflection, ...]  #: the judge last
    standings: tuple[Standing, ...]
    cautions: tuple[str, ...]
    senses: dict[str, str]  #: in which each shaft turns, ``+y`` or ``-y`` of its scene
    points: tuple[TrainDeflection, ...] = ()
    planets: tuple[str, ...] = ()  #: meshes that stand for one of each planet

    @property
    def judge(self) -> TrainDeflection:
        """The finest model that was solved."""
        return self.solutions[-1]

    @property
    def cheapest(self) -> Standing | None:
        """The cheapest model within the tolerance; None where only the judge is."""
        return next((standing for standing in self.standings if standing.verdict == WITHIN), None)

    def verdict(self) -> str:
        """Return a sentence on the cheapest model for the misalignment."""
        if not self.judge.misalignment:
            return "No gears mesh, whose misalignment could judge the models."
        if not self.standings:
            return "One model was solved, so that none is judged."
        demand = f"{100 * self.tolerance:g} % of the misalignment at {self.judge.point.label}"
        if self.cheapest is None:
            near = min(self.standings, key=lambda standing: abs(standing.gap))
            return (
                f"No cheaper model was shown to be within {demand}: use {self.judge.model}. The "
                f"nearest, {near.model}, is {100 * abs(near.gap):.2g} % off in {near.worst}."
            )
        standing = self.cheapest
        return (
            f"Cheapest model within {demand}: {standing.model} ({100 * standing.gap:.2g} % off in "
            f"{standing.worst})."
        )

    def as_dict(self) -> dict:
        """Return plain data in SI for JSON."""
        return {
            "train": self.title,
            "tolerance": self.tolerance,
            "verdict": self.verdict(),
            "models": {solution.model: solution.as_dict() for solution in self.solutions},
            "standings": [vars(standing) for standing in self.standings],
            "cautions": list(self.cautions),
            "senses": self.senses,
            "points": [solution.as_dict() for solution in self.points],
        }


def deflect_train(
    assembly: Assembly,
    point: OperatingPoint,
    models: Sequence[str] = MODELS,
    progress: Callable[[str], None] = lambda text: None,
    every: bool = False,
) -> Deflections:
    """Compute deflection and misalignment of a train at an operating point by several models of all
    shafts, the finest last, and by that at every operating point if `every`; lumped models have
    no bearings of their own and are refused.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_straddle.toml"))
    >>> found = deflect_train(assembly, OperatingPoint(torque=200.0), ("euler", "timoshenko"))
    >>> [m.name for m in found.judge.misalignment], len(found.judge.shafts[0].bearings)
    (['E', 'P', 'G', 'shaft angle'], 3)
    """
    solutions = []
    for model in models:
        progress(model)
        solutions.append(deflection(assembly, point, model))
    progress("what the data of bearings leave open")
    solutions[-1] = with_ranges(assembly, solutions[-1])
    standings = tuple(
        _against_judge(solution, solutions[-1], assembly.train.ask.tolerance)
        for solution in solutions[:-1]
    )
    points: list[TrainDeflection] = []
    if every:
        progress(f"{len(assembly.train.operation)} operating points")
        points = deflections(assembly, assembly.train.operation, models[-1])
    title = assembly.train.title or assembly.train.name
    return Deflections(
        title=title,
        tolerance=assembly.train.ask.tolerance,
        solutions=tuple(solutions),
        standings=standings,
        cautions=assembly.data_cautions,
        senses=senses(assembly.train, assembly.on_flank(point.coast).contacts, point.coast),
        points=tuple(points),
        planets=tuple(stage.name for stage in assembly.train.stages),
    )


def deflection(assembly: Assembly, point: OperatingPoint, *models: str) -> TrainDeflection:
    """Compute the deflection of a train at an operating point by one model of each shaft, as
    :func:`deflections`.
    """
    return deflections(assembly, [point], *models)[0]


@pinned
def deflections(
    assembly: Assembly, points: Sequence[OperatingPoint], *models: str
) -> list[TrainDeflection]:
    """Compute the deflection of a train at several operating points, each begun at the one before,
    by one model of each shaft.
    """
    by_shaft = assembly.models_by_shaft(models)
    for model in by_shaft.values():
        if model.partition("/")[0] in LUMPED:
            raise SolidgearError(
                f"a {model} shaft has its bearings condensed into it; use one of {', '.join(MODELS)}"
            )
    for side, model in by_shaft.items():
        assembly.shaft_model(side, model)  # no settling to be timed
    operating = Operating(assembly, *models)
    state: OperatingState | None = None
    out = []
    for point in points:
        start = perf_counter()
        state = operating.at(point, state)
        out.append(_solution(assembly, state, by_shaft, perf_counter() - start))
    return out


def _solution(
    assembly: Assembly, state: OperatingState, by_shaft: dict[str, str], seconds: float
) -> TrainDeflection:
    """Return the deflection of a train at rest."""
    point, system = state.point, state.system
    bars = StaticBars(assembly, state, by_shaft)
    measures = misalignment(assembly.on_flank(point.coast), system)
    measured = tuple(
        Measured(
            m.name,
            m.unit,
            m.meaning,
            float(m.row @ state.coordinates),
            bars.error_bar(m.row),
            mesh=m.mesh,
            face=m.face,
        )
        for m in measures
    )
    housed = {
        side: housing_motion(system, assembly.places[side], state.coordinates)
        for side in assembly.train.housed
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
    notes = [*state.notes, *(note for shaft in shafts for note in shaft.notes)]
    if housed:
        notes.append(f"deflection lines of {listed(housed)} are relative to the housing")
    displacement = {}
    for side, shaft in assembly.train.shafts.items():
        for port in shaft.gears:
            end = f"{side}.{port}"
            name = side if len(shaft.gears) == 1 else end
            displacement[name] = _six_measures(f"of {end}", MOVED, system.motion(end), state, bars)
    if assembly.train.housing is not None:
        displacement[HOUSING] = _six_measures(
            "of its centre", MOVED, system.motion(BOX), state, bars
        )
        if assembly.train.stages:
            notes.append("forces over a turn of a carrier are not computed with a housing")
    mounts = {
        name: _six_measures("on it", FORCE_UNITS, rows, state, bars)
        for name, rows in mount_rows(assembly.train, system).items()
    }
    return TrainDeflection(
        point=point,
        models=state.models,
        mesh_forces=state.mesh_forces,
        misalignment=measured,
        displacement=displacement,
        shafts=shafts,
        notes=tuple(notes),
        seconds=seconds,
        mounts=mounts,
        turns=over_a_turn(assembly, state, by_shaft),
    )


def with_ranges(assembly: Assembly, solution: TrainDeflection) -> TrainDeflection:
    """Return the same with the ranges of the misalignment over estimated insides and clearance
    classes.
    """
    values = [[m.value for m in solution.misalignment]]
    _, choices = left_open(shaft.scene for shaft in assembly.train.shafts.values())
    for choice in choices:
        operating = Operating(assembly, *solution.models.values(), choice=choice)
        state = operating.at(solution.point)
        measures = misalignment(assembly.on_flank(solution.point.coast), state.system)
        values.append([float(m.row @ state.coordinates) for m in measures])
    if len(values) == 1:
        return solution
    low, high = np.min(values, axis=0), np.max(values, axis=0)
    measured = [
        replace(m, open=(float(a), float(b))) for m, a, b in zip(solution.misalignment, low, high)
    ]
    return replace(solution, misalignment=tuple(measured))


def _six_measures(
    meaning: str, units: Sequence[str], rows: np.ndarray, state: OperatingState, bars: StaticBars
) -> tuple[Measured, ...]:
    """Return the motion of a place, or the load on it, as six components."""
    return tuple(
        Measured(name, unit, meaning, float(row @ state.coordinates), bars.error_bar(row))
        for name, unit, row in zip(DOF_NAMES, units, rows)
    )


def _against_judge(solution: TrainDeflection, judge: TrainDeflection, tolerance: float) -> Standing:
    """Compare a model with the judge: lengths against the largest length, angles against the
    largest angle.
    """
    worst, gap, bar = "", 0.0, 0.0
    for unit in dict.fromkeys(m.unit for m in judge.misalignment):
        pairs = [
            (m, j) for m, j in zip(solution.misalignment, judge.misalignment) if j.unit == unit
        ]
        scale = float(np.linalg.norm([j.value for _, j in pairs]))
        for measure, reference in pairs:
            error = (measure.value - reference.value) / scale if scale else 0.0
            if abs(error) >= abs(gap):
                worst, gap, bar = measure.name, error, (reference.bar or 0.0) / (scale or 1.0)
    return Standing(solution.model, gap_verdict(gap, bar, tolerance), worst, gap)


class StaticBars:
    """Error bars that meshes of harmonic shafts leave in linear numbers of a state at rest."""

    def __init__(self, assembly: Assembly, state: OperatingState, models: dict[str, str]):
        self.assembly, self.state = assembly, state
        self.sides = [side for side, model in models.items() if model == JUDGE]
        self.bounds: dict[str, HarmonicBounds] = {}
        if not self.sides or any(mesh.local_harmonics for mesh in assembly.train.meshes):
            return
        settled = assembly.with_train(with_settled_bearings(assembly.train, state))
        self.tangent: System = settled.system(*models.values())
        for side in self.sides:
            body = assembly.shaft_model(side, JUDGE).body
            self.bounds[side] = harmonic_bounds(coned(assembly.scenes[side]), body, statics=True)
        self.rest = self._ports(state.forces())

    def _ports(self, forces: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Return (6 p,) forces on the ports of every harmonic shaft."""
        out = {}
        for side, bounds in self.bounds.items():
            out[side] = np.zeros(6 * len(bounds.body.ports))
            for end, force in forces.items():
                part, _, port = end.partition(".")
                if part == side:
                    start = 6 * bounds.body.port_index(port)
                    out[side][start : start + 6] += force
        return out

    def error_bar(self, row: np.ndarray) -> float | None:
        """Return the error bar of ``row @ coordinates``; None without a harmonic shaft, and where
        the number grows as the train turns.
        """
        if not self.bounds:
            return None
        turns = np.abs(row @ self.tangent.free).max(initial=0.0)
        if turns > 1e-9 * np.linalg.norm(row):
            return None
        adjoint = port_forces(self.tangent, self.tangent.static(row))
        parts = [*self.assembly.scenes]
        if self.assembly.train.housing is not None:
            parts.append(HOUSING)
        unit_forces = self._ports(_add_unit_load(adjoint, self.tangent, row, parts))
        total = 0.0
        for side, bounds in self.bounds.items():
            f, g = self.rest[side], unit_forces[side]
            double, single = (
                float(np.sqrt(max(f @ m @ f, 0.0) * max(g @ m @ g, 0.0)))
                for m in (bounds.more, bounds.less)
            )
            total += LOCAL * with_tail(double, single)
        return total


def _add_unit_load(
    forces: dict[str, np.ndarray], system: System, row: np.ndarray, parts: list[str]
) -> dict[str, np.ndarray]:
    """Add to forces of links the unit load that a row of coordinates stands for, on the ports that
    it is made of.
    """
    total = dict(forces)
    ends = [f"{side}.{port}" for side in parts for port in system.parts[side].ports]
    rows = np.vstack([system.motion(end) for end in ends])
    loads, *_ = np.linalg.lstsq(rows.T, row, rcond=1e-12)
    for end, force in zip(ends, loads.reshape(-1, 6)):
        total[end] = total.get(end, np.zeros(6)) + force
    return total
