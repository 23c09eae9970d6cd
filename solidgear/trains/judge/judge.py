"""Shaft of a train that needs the solid, and from which frequency on: mixes of models against all
shafts solid.

Mixes are those in which two shafts at most are no solids, all shafts alike, and each by the
cheapest model that holds alone: of two shafts these are all there are, of n no more than grows with
the square of n.

A mix leaves the tolerance of the modes at the first mode of the judge that it moves by more than the
tolerance, or has no counterpart of; modes are paired by the motions of all ports, not by number.
It leaves the tolerance of the mesh force where the force differs by more than some decibels, at the same
frequency.  The cause is the shaft whose model, put back to the solid alone, carries the mix
furthest.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from solidgear.core import BEAM, LADDER, Scene, SolidgearError
from solidgear.core.ladder import solid_of
from solidgear.core.plain import plain
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.meshes import mesh_bars
from solidgear.trains.assembly.shaft import JUDGE, LUMPED, checked_model, ladder_place, mix_label
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.file.planetary import error_of
from solidgear.trains.modes.naming import driven, mode_names
from solidgear.trains.modes.pairing import BEYOND, modes_and_motions, partners
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.respond import respond
from solidgear.trains.response.response import TrainResponse

#: models of one shaft that are mixed, cheapest first
MIXED = (*LADDER.of(BEAM), JUDGE)
#: a shaft put back to the solid must carry a mix this much further to be the cause alone
FURTHER = 1.05
#: lumped models: the one with an assumption less, and that assumption
RELAXED = {
    "lumped-old": ("lumped-bending", "bending mass"),
    "lumped-bending": ("lumped", "axial mass"),
    "lumped-matched": ("lumped", "axial mass"),
    "lumped": ("", ""),
}


def charted_mixes(shafts: int) -> list[tuple[str, ...]]:
    """Return the mixes of so many shafts that a chart of the verdict shows; more would hide one
    another.
    """
    equal = [(model,) * shafts for model in (JUDGE, MIXED[0], LUMPED[0], LUMPED[-1])]
    return equal + [with_model((JUDGE,) * shafts, k, MIXED[-2]) for k in range(shafts)]


def with_model(mix: tuple[str, ...], k: int, model: str) -> tuple[str, ...]:
    """Return a mix with the model of shaft number k replaced."""
    return (*mix[:k], model, *mix[k + 1 :])


def mixes_of(shafts: int) -> list[tuple[str, ...]]:
    """Return the mixes of so many shafts without the judge's: up to two of them no solids, and all
    alike.
    """
    judge = (JUDGE,) * shafts
    partial = [
        with_model(with_model(judge, j, model_j), k, model_k)
        for j in range(shafts)
        for k in range(j, shafts)
        for model_j in MIXED
        for model_k in MIXED
    ]
    mixes = dict.fromkeys([*partial, *((model,) * shafts for model in MIXED)])
    return sorted((mix for mix in mixes if mix != judge), key=lambda m: [*map(MIXED.index, m)])


@dataclass(frozen=True)
class Departure:
    """Frequencies at which a mix leaves the judge."""

    models: dict[str, str]  #: by shaft
    unknowns: int  #: of all bodies
    seconds: float  #: to build and reduce them
    modes_to_hz: float | None  #: frequency of the judge's first mode that is missed; None for none
    #: mode, error: that mode, and by how much it is off, relative; None where it has no counterpart
    mode: str
    error: float | None
    force_to_hz: float | None  #: where the mesh force leaves its band in decibels; None for nowhere
    #: where the mesh force is off by more than the tolerance, which any peak or dip that moves a
    #: little makes it
    close_to_hz: float | None
    #: the shaft, ``both`` or ``several``, or the assumption of a lumped model; empty for none
    cause: str

    @property
    def to_hz(self) -> float:
        """Frequency up to which modes and force hold, Hz, infinite for everywhere."""
        return min(_end(self.modes_to_hz), _end(self.force_to_hz))

    @property
    def mix(self) -> tuple[str, ...]:
        """Models in the sequence of the shafts."""
        return tuple(self.models.values())

    @property
    def label(self) -> str:
        """Models by shaft, as in charts."""
        return mix_label(self.models)

    def as_dict(self) -> dict:
        """Return plain data for JSON."""
        out = plain(self)
        return out.pop("models") | out


@dataclass(frozen=True, eq=False)
class Verdict:
    """Mixes of models of a train, judged."""

    train: str
    highest_hz: float
    tolerance: float
    decibels: float
    #: cheapest first, by unknowns and then in the sequence of the ladder; the judge is the last
    mixes: tuple[Departure, ...]
    #: largest relative error that the judge's meshes leave in its frequencies, by local problems;
    #: None where teeth drive families of two waves and more
    judge_bar: float | None
    #: the judge's and those of the mixes compared with it, for a chart
    responses: tuple[TrainResponse, ...]
    unpublished: dict[str, str]
    cautions: tuple[str, ...]

    @property
    def cheapest(self) -> Departure:
        """First mix that holds up to the frequency of the request; at the worst, the judge."""
        return next(mix for mix in self.mixes if mix.to_hz >= self.highest_hz)

    def departure(self, *models: str) -> Departure:
        """One of the mixes."""
        return next(m for m in self.mixes if m.mix == models)

    @property
    def every(self) -> str:
        """All shafts, in a word before the noun."""
        count = len(self.mixes[0].models)
        return "both" if count == 2 else f"all {count}"

    def as_dict(self) -> dict:
        """Return plain data for JSON."""
        best = self.cheapest
        return {
            "train": self.train,
            "highest_hz": self.highest_hz,
            "tolerance": self.tolerance,
            "decibels": self.decibels,
            "judge": JUDGE,
            "judge_title": LADDER[JUDGE].title,
            "judge_bar": self.judge_bar,
            "cheapest": best.models,
            "mixes": [mix.as_dict() for mix in self.mixes],
            "unpublished": self.unpublished,
            "cautions": list(self.cautions),
        }

    def sentences(self) -> list[str]:
        """Return conclusions from the table."""
        bar_text = (
            "with local harmonics their meshes have no error bars"
            if self.judge_bar is None
            else f"their meshes leave errors up to {100 * self.judge_bar:.2g} % in frequency"
        )
        out = [f"Judge: {self.every} shafts as {LADDER[JUDGE].title}s; {bar_text}."]
        judge = self.mixes[-1]
        for k, side in enumerate(judge.models):
            ends = {
                model: self.departure(*with_model(judge.mix, k, model)).to_hz
                for model in MIXED[:-1]
            }
            best = max(ends, key=lambda model: ends[model])
            if ends[best] >= self.highest_hz:
                out.append(f"The {side} may be a beam ({best}) up to {self.highest_hz:g} Hz.")
            else:
                out.append(
                    f"The {side} needs the solid from {ends[best]:.0f} Hz on ({best} until there)."
                )
        mix = self.cheapest
        words = f"{self.every} shafts solid" if mix is self.mixes[-1] else mix.label
        out.append(
            f"Cheapest within {100 * self.tolerance:g} % and {self.decibels:g} dB "
            f"up to {self.highest_hz:g} Hz: {words}."
        )
        return out


def _refuse_cuts(side: str, scene: Scene) -> None:
    """Refuse a shaft with cuts, which beams and the judge of mixes cannot model."""
    cuts = LADDER[JUDGE].left_out(scene)
    if cuts:
        raise SolidgearError(
            f"mixes are compared with {LADDER[JUDGE].title}s, and shaft {side!r} has {cuts}, which "
            f"these cannot model; run solidgear system-modes, response and deflect, which take "
            f"{solid_of(scene)} for it, or take the cuts out of its file to compare mixes"
        )


def judge_train(
    assembly: Assembly,
    highest_hz: float | None = None,
    more: Sequence[tuple[str, ...]] = (),
    progress: Callable[[str], None] = lambda text: None,
) -> Verdict:
    """Judge mixes of beams and solids, the lumped models and further mixes against all shafts
    solid, up to a frequency, Hz, by default that of the file.
    """
    for side, shaft in assembly.train.shafts.items():
        _refuse_cuts(side, shaft.scene)
    ask = assembly.train.ask
    highest = highest_hz or ask.max_frequency
    sides = [*assembly.train.shafts]
    mixes = mixes_of(len(sides))
    mixes += [(name,) * len(sides) for name in LUMPED if _can_be_made(assembly, name)]
    further = [tuple(assembly.models_by_shaft(mix).values()) for mix in more]
    mixes += [mix for mix in dict.fromkeys(further) if mix not in mixes]
    for mix in mixes:
        for model in mix:
            checked_model(model)
    for driver in assembly.train.drivers:
        error_of(driver)  # refused before anything is solved
    progress(f"judge: {assembly.train.every} shafts {JUDGE}")
    judge = _Judge(assembly, highest)
    departures: dict[tuple[str, ...], Departure] = {}
    all_solid = (JUDGE,) * len(sides)

    def add(mix: tuple[str, ...]) -> None:
        if mix not in departures and mix != all_solid:
            progress(mix_label(assembly.models_by_shaft(mix)))
            departures[mix] = judge.departure(*mix)

    for mix in mixes:
        add(mix)
    add(tuple(_cheapest(departures, all_solid, k, highest) for k in range(len(sides))))
    judged = [_with_cause(departures, mix) for mix in departures]
    reference = judge.departure(*all_solid)
    progress("error bars of the judge's meshes")
    # wall seconds would order by noise where bodies are the same
    ordered = sorted(judged, key=lambda m: (m.unknowns, [*map(ladder_place, m.mix)]))
    return Verdict(
        train=assembly.train.called,
        highest_hz=highest,
        tolerance=ask.tolerance,
        decibels=ask.decibels,
        mixes=(*ordered, reference),
        judge_bar=judge.bar(),
        responses=tuple(judge.responses.values()),
        unpublished=assembly.train.unpublished(),
        cautions=(
            *unit_slips(assembly),
            *judge.responses[all_solid].cautions,
        ),
    )


def _can_be_made(assembly: Assembly, name: str) -> bool:
    """Check whether a model exists of every shaft: mode-matched masses need not."""
    try:
        for side in assembly.scenes:
            assembly.shaft_model(side, name)
    except SolidgearError:
        return False
    return True


def _cheapest(
    departures: dict[tuple[str, ...], Departure], solid: tuple[str, ...], k: int, highest: float
) -> str:
    """Return the cheapest model of shaft k that holds where all others are solids."""
    return next(
        (model for model in MIXED[:-1] if departures[with_model(solid, k, model)].to_hz >= highest),
        JUDGE,
    )


def _with_cause(departures: dict[tuple[str, ...], Departure], mix: tuple[str, ...]) -> Departure:
    """Return a departure with the shaft to blame, by putting one at a time back to the solid."""
    departure = departures[mix]
    if not np.isfinite(departure.to_hz):
        return departure
    if len({*mix}) == 1 and mix[0] in RELAXED:
        if "torsion" in departure.mode:
            return replace(departure, cause="rigid twist")
        milder, words = RELAXED[mix[0]]
        milder_mix = (milder,) * len(mix)
        further = milder_mix in departures and _further(departures[milder_mix], departure)
        return replace(departure, cause=words if further else "six motions")
    swapped = {
        s: with_model(mix, k, JUDGE) for k, s in enumerate(departure.models) if mix[k] != JUDGE
    }
    if len(swapped) == 1:
        return replace(departure, cause=next(iter(swapped)))
    better = [
        s
        for s, swapped_mix in swapped.items()
        if swapped_mix in departures and _further(departures[swapped_mix], departure)
    ]
    several = "both" if len(mix) == 2 else "several"
    return replace(departure, cause=better[0] if len(better) == 1 else several)


def _further(a: Departure, b: Departure) -> bool:
    """Check whether mix a holds clearly further than b, in modes or in force."""
    modes = _end(a.modes_to_hz) > FURTHER * _end(b.modes_to_hz)
    return modes or _end(a.force_to_hz) > FURTHER * _end(b.force_to_hz)


def _end(hz: float | None) -> float:
    """Return a frequency up to which a mix holds, infinite for everywhere."""
    return np.inf if hz is None else hz


class _Judge:
    """The reference of a train, and the departures of mixes from it."""

    def __init__(self, assembly: Assembly, highest: float):
        self.assembly, self.highest = assembly, highest
        assembly.follow(JUDGE, highest_hz=highest)
        self.system = assembly.system(JUDGE)
        self.found, self.seen = modes_and_motions(assembly, self.system, highest)
        self.names = mode_names(assembly, self.system, self.found)
        self.driven = driven(self.system, self.found)[self.found.rigid :]
        drives = [Drive(assembly, JUDGE, mesh=mesh.name) for mesh in assembly.train.drivers]
        self.drives = [(drive, drive.grid(highest)) for drive in drives]
        solid, grid = (JUDGE,) * len(assembly.scenes), self.drives[0][1]
        self.responses = {solid: respond(assembly, *solid, highest_hz=highest, frequency_hz=grid)}

    def departure(self, *models: str) -> Departure:
        """Return the departure of a mix."""
        modes_to, mode, error = self._first_mode(*models)
        by_shaft = self.assembly.models_by_shaft(models)
        bodies = [self.assembly.shaft_model(*shaft) for shaft in by_shaft.items()]
        force_to, close_to = self._force(*models)
        return Departure(
            models=by_shaft,
            unknowns=sum(body.unknowns for body in bodies),
            seconds=self.assembly.build_seconds(*models),
            modes_to_hz=modes_to,
            mode=mode,
            error=error,
            force_to_hz=force_to,
            close_to_hz=close_to,
            cause="",
        )

    def _first_mode(self, *models: str) -> tuple[float | None, str, float | None]:
        """Return the first mode that a mix misses: frequency, name, and relative error if it has a
        counterpart.
        """
        system = self.assembly.system(*models)
        modes, motions = modes_and_motions(self.assembly, system, self.highest * BEYOND)
        mix_hz, judge_hz = (solved.frequency_hz[solved.rigid :] for solved in (modes, self.found))
        partner = partners(judge_hz, self.seen, mix_hz, motions)
        for k, hz in enumerate(judge_hz):
            name = self.names[self.found.rigid + k]
            if not self.driven[k]:  # moves no port: nothing distinguishes it from another
                continue
            if k not in partner:
                return float(hz), name, None
            error = float(mix_hz[partner[k]] / hz - 1)
            if abs(error) > self.assembly.train.ask.tolerance:
                return float(hz), name, error
        return None, "", None

    def _force(self, *models: str) -> tuple[float | None, float | None]:
        """Return the frequencies at which the mesh force leaves the decibels, and the tolerance;
        the lowest over the errors of all meshes.
        """
        ends: tuple[list[float], list[float]] = ([], [])
        ask = self.assembly.train.ask
        for judge, judge_grid in self.drives:
            drive = Drive(self.assembly, *models, mesh=judge.pair.name)
            grid = np.union1d(judge_grid, drive.grid(self.highest))
            force = np.abs(drive.mesh(grid)[1])
            if models not in self.responses:
                self.responses[models] = respond(
                    self.assembly, *models, highest_hz=self.highest, frequency_hz=grid
                )
            ratio = force / np.abs(judge.mesh(grid)[1])
            too_far = np.abs(20 * np.log10(ratio)) > ask.decibels
            for exceeding, out in zip((too_far, np.abs(ratio - 1) > ask.tolerance), ends):
                out += grid[exceeding][:1].tolist()
        force_to, close_to = (min(hz, default=None) for hz in ends)
        return force_to, close_to

    def bar(self) -> float | None:
        """Return the largest relative error that the judge's meshes may leave in the frequencies."""
        count = len(self.found.frequency_hz) - self.found.rigid
        bars = mesh_bars(
            self.assembly, self.system, dict.fromkeys(self.assembly.scenes, JUDGE), count
        )
        return None if bars is None else float(bars.max())
