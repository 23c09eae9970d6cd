"""Deflection and misalignment of a train at an operating point, by any model, with error bars."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter

import numpy as np

from solidgear.errors import SolidgearError, listed
from solidgear.frames import DOF_NAMES
from solidgear.judge.deviations import WITHIN, gap_verdict
from solidgear.machine.threads import pinned
from solidgear.scene.operation import OperatingPoint
from solidgear.scene.train_housing import HOUSING
from solidgear.studies.bearing_life import left_open
from solidgear.studies.deflection import ShaftDeflection, shaft_deflection
from solidgear.studies.train.components import FORCE_UNITS
from solidgear.studies.train.housing import BOX, carried_by, mount_rows
from solidgear.studies.train.layout import senses
from solidgear.studies.train.measured import Measured
from solidgear.studies.train.misalignment import misalignment
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.operation import Operating, OperatingState
from solidgear.studies.train.shaft import JUDGE, LUMPED, RIGID, told_mix
from solidgear.studies.train.static_bars import StaticBars
from solidgear.studies.train.turn import StageTurn, over_a_turn

#: models that a deflection is solved with, the cheapest first
MODELS = (RIGID, "euler", "timoshenko", JUDGE)
MOVED = ("m moved",) * 3 + ("rad moved",) * 3


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
        """That of the first mesh, N."""
        return next(iter(self.mesh_forces.values()))

    @property
    def model(self) -> str:
        """The model of all shafts, or of each."""
        alike = len({*self.models.values()}) == 1
        return next(iter(self.models.values())) if alike else told_mix(self.models)

    def as_dict(self) -> dict:
        """Plain data in SI that JSON can hold."""
        told = {
            "point": self.point.model_dump(mode="json"),
            **self.models,
            "mesh_force": self.mesh_force,
            "mesh_forces": self.mesh_forces,
            "misalignment": {m.name: m.as_dict() for m in self.misalignment},
            "displacement": _each(self.displacement),
            "shafts": {shaft.name: shaft.as_dict() for shaft in self.shafts},
            "turns": {one.stage: one.as_dict() for one in self.turns},
            "notes": list(self.notes),
            "seconds": self.seconds,
        }
        return told | ({"mounts": _each(self.mounts)} if self.mounts else {})


def _each(places: dict[str, tuple[Measured, ...]]) -> dict:
    return {place: {m.name: m.as_dict() for m in six} for place, six in places.items()}


@dataclass(frozen=True)
class Standing:
    """A model of both shafts against the judge, for the misalignment."""

    model: str
    verdict: str  #: ``within``, ``open`` or ``beyond`` the tolerance
    worst: str  #: number that is farthest off, relative to the size of its kind
    gap: float  #: by so much, relative


@dataclass(frozen=True, eq=False)
class Deflections:
    """A train at one operating point, by several models."""

    title: str
    tolerance: float  #: of the misalignment, relative
    found: tuple[TrainDeflection, ...]  #: the judge last
    standings: tuple[Standing, ...]
    cautions: tuple[str, ...]
    senses: dict[str, str]  #: in which each shaft turns, ``+y`` or ``-y`` of its scene
    points: tuple[TrainDeflection, ...] = ()

    @property
    def judge(self) -> TrainDeflection:
        """The finest model that was solved."""
        return self.found[-1]

    @property
    def cheapest(self) -> Standing | None:
        """The cheapest model within the tolerance; None where none but the judge is."""
        return next((one for one in self.standings if one.verdict == WITHIN), None)

    def verdict(self) -> str:
        """Sentence on the cheapest model for the misalignment."""
        if not self.judge.misalignment:
            return "No gears of two shafts mesh, by whose misalignment models are judged."
        if not self.standings:
            return "One model was solved: which is enough is not judged."
        asked = f"{100 * self.tolerance:g} % of the misalignment at {self.judge.point.label}"
        if self.cheapest is None:
            near = min(self.standings, key=lambda one: abs(one.gap))
            return (
                f"No cheaper model is known to hold {asked}: use {self.judge.model}. The nearest, "
                f"{near.model}, is {100 * abs(near.gap):.2g} % off in {near.worst}."
            )
        one = self.cheapest
        return (
            f"Cheapest model that holds {asked}: {one.model} "
            f"({100 * one.gap:.2g} % off in {one.worst})."
        )

    def as_dict(self) -> dict:
        """Plain data in SI that JSON can hold."""
        return {
            "train": self.title,
            "tolerance": self.tolerance,
            "verdict": self.verdict(),
            "models": {one.model: one.as_dict() for one in self.found},
            "standings": [vars(one) for one in self.standings],
            "cautions": list(self.cautions),
            "senses": self.senses,
            "points": [one.as_dict() for one in self.points],
        }


def deflect_train(
    workshop: Workshop,
    point: OperatingPoint,
    models: Sequence[str] = MODELS,
    progress: Callable[[str], None] = lambda text: None,
    every: bool = False,
) -> Deflections:
    """Deflection and misalignment of a train at an operating point by several models.

    Parameters
    ----------
    models : sequence of str
        Of both shafts, the finest last.
    progress : callable, optional
        Told each model.
    every : bool
        Also at every operating point of the train, by the last model.

    Raises
    ------
    SolidgearError
        For a lumped model, which has no bearings of its own, or a shaft that nothing holds.

    Examples
    --------
    >>> import solidgear as sg
    >>> shop = Workshop(sg.load_train("geometry/axle_straddle.toml"))
    >>> found = deflect_train(shop, OperatingPoint(torque=200.0), ("euler", "timoshenko"))
    >>> [m.name for m in found.judge.misalignment], len(found.judge.shafts[0].bearings)
    (['E', 'P', 'G', 'shaft angle'], 3)
    """
    found = []
    for model in models:
        progress(model)
        found.append(deflection(workshop, point, model))
    progress("what the data of bearings leave open")
    found[-1] = with_ranges(workshop, found[-1])
    standings = tuple(_standing(one, found[-1], workshop.train.ask.tolerance) for one in found[:-1])
    points: list[TrainDeflection] = []
    if every:
        progress(f"{len(workshop.train.operation)} operating points")
        points = deflections(workshop, workshop.train.operation, models[-1])
    title = workshop.train.title or workshop.train.name
    return Deflections(
        title,
        workshop.train.ask.tolerance,
        tuple(found),
        standings,
        workshop.odd,
        senses(workshop.train, workshop.on_flank(point.coast).contacts, point.coast),
        tuple(points),
    )


def deflection(workshop: Workshop, point: OperatingPoint, *models: str) -> TrainDeflection:
    """Deflection of a train at an operating point by one model of each shaft, as
    :func:`deflections`.
    """
    return deflections(workshop, [point], *models)[0]


@pinned
def deflections(
    workshop: Workshop, points: Sequence[OperatingPoint], *models: str
) -> list[TrainDeflection]:
    """Deflection of a train at several operating points by one model of each shaft.

    Parameters
    ----------
    points : sequence of OperatingPoint
        Each is begun at the one before.

    Raises
    ------
    SolidgearError
        As :func:`deflect_train`.
    """
    rungs = workshop.mix(models)
    for rung in rungs.values():
        if rung.partition("/")[0] in LUMPED:
            raise SolidgearError(
                f"a {rung} shaft has its bearings condensed into it, and no places of their own; "
                f"use one of {', '.join(MODELS)}"
            )
    for side, rung in rungs.items():
        workshop.shaft(side, rung)  # no settling to be timed
    operating = Operating(workshop, *models)
    state: OperatingState | None = None
    out = []
    for point in points:
        start = perf_counter()
        state = operating.at(point, state)
        out.append(_told(workshop, state, rungs, perf_counter() - start))
    return out


def _told(
    workshop: Workshop, state: OperatingState, rungs: dict[str, str], seconds: float
) -> TrainDeflection:
    """Deflection of a train at rest."""
    point, system = state.point, state.system
    bars = StaticBars(workshop, state, rungs)
    measures = misalignment(workshop.on_flank(point.coast), system)
    told = tuple(
        Measured(
            m.name,
            m.unit,
            m.meaning,
            float(m.row @ state.coordinates),
            bars.of(m.row),
            mesh=m.mesh,
            face=m.face,
        )
        for m in measures
    )
    housed = {
        side: carried_by(system, workshop.places[side], state.coordinates)
        for side in workshop.train.housed
    }
    shafts = tuple(
        shaft_deflection(
            side,
            rung,
            workshop.scenes[side],
            system,
            state.equilibrium,
            None if rung.partition("/")[0] == RIGID else workshop.shaft(side, rung).body,
            state.made,
            housed.get(side),
        )
        for side, rung in rungs.items()
    )
    notes = [*state.notes, *(note for shaft in shafts for note in shaft.notes)]
    if housed:
        notes.append(f"deflection lines of {listed(housed)} are told against the housing")
    moved = {}
    for side, shaft in workshop.train.shafts.items():
        for port in shaft.gears:
            end = f"{side}.{port}"
            told_as = side if len(shaft.gears) == 1 else end
            moved[told_as] = _six(f"of {end}", MOVED, system.motion(end), state, bars)
    if workshop.train.housing is not None:
        moved[HOUSING] = _six("of its centre", MOVED, system.motion(BOX), state, bars)
        if workshop.train.stages:
            notes.append("forces over a turn of a carrier are not told beside a housing")
    mounts = {
        name: _six("on it", FORCE_UNITS, rows, state, bars)
        for name, rows in mount_rows(workshop.train, system).items()
    }
    return TrainDeflection(
        point,
        state.models,
        state.mesh_forces,
        told,
        moved,
        shafts,
        tuple(notes),
        seconds,
        mounts,
        over_a_turn(workshop, state, rungs),
    )


def with_ranges(workshop: Workshop, found: TrainDeflection) -> TrainDeflection:
    """The same with the ranges of its misalignment over estimated insides and clearance classes."""
    values = [[m.value for m in found.misalignment]]
    _, choices = left_open(own.scene for own in workshop.train.shafts.values())
    for choice in choices:
        state = Operating(workshop, *found.models.values(), choice=choice).at(found.point)
        measures = misalignment(workshop.on_flank(found.point.coast), state.system)
        values.append([float(m.row @ state.coordinates) for m in measures])
    if len(values) == 1:
        return found
    low, high = np.min(values, axis=0), np.max(values, axis=0)
    told = [replace(m, open=(float(a), float(b))) for m, a, b in zip(found.misalignment, low, high)]
    return replace(found, misalignment=tuple(told))


def _six(
    meaning: str, units: Sequence[str], rows: np.ndarray, state: OperatingState, bars: StaticBars
) -> tuple[Measured, ...]:
    """Motion of a place or load on one, six components."""
    return tuple(
        Measured(name, unit, meaning, float(row @ state.coordinates), bars.of(row))
        for name, unit, row in zip(DOF_NAMES, units, rows)
    )


def _standing(one: TrainDeflection, judge: TrainDeflection, tolerance: float) -> Standing:
    """A model against the judge: lengths against the largest length, angles against the largest."""
    worst, gap, bar = "", 0.0, 0.0
    for unit in dict.fromkeys(m.unit for m in judge.misalignment):
        pairs = [(m, j) for m, j in zip(one.misalignment, judge.misalignment) if j.unit == unit]
        scale = float(np.linalg.norm([j.value for _, j in pairs]))
        for mine, theirs in pairs:
            off = (mine.value - theirs.value) / scale if scale else 0.0
            if abs(off) >= abs(gap):
                worst, gap, bar = mine.name, off, (theirs.bar or 0.0) / (scale or 1.0)
    return Standing(one.model, gap_verdict(gap, bar, tolerance), worst, gap)
