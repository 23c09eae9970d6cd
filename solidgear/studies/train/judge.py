"""Shaft of a train that needs the solid, and from which frequency on: mixes of models against all
shafts solid.

Mixes are those in which two shafts at most are no solids, all shafts alike, and each by the
cheapest model that holds alone: of two shafts these are all there are, of n no more than grows with
the square of n.

A mix leaves the band of the modes at the first mode of the judge that it moves by more than the
tolerance, or has no counterpart of; modes are paired by the motions of all ports, not by number.
It leaves that of the mesh force where the force differs by more than some decibels, at the same
frequency.  The cause is the shaft whose model, put back to the solid alone, carries the mix
furthest.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.ladder.model import BEAM
from solidgear.ladder.registry import LADDER
from solidgear.scene.planetary import error_of
from solidgear.studies.train.meshes import mesh_bars
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.naming import driven, mode_names
from solidgear.studies.train.pairing import BEYOND, partners, seen_modes
from solidgear.studies.train.respond import Drive, respond
from solidgear.studies.train.response import TrainResponse
from solidgear.studies.train.shaft import JUDGE, LUMPED, checked_rung, ladder_place, told_mix
from solidgear.studies.train.slips import slips

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


def drawn(shafts: int) -> list[tuple[str, ...]]:
    """Mixes of so many shafts that a chart of the verdict shows; more would hide one another."""
    alike = [(rung,) * shafts for rung in (JUDGE, MIXED[0], LUMPED[0], LUMPED[-1])]
    return alike + [put((JUDGE,) * shafts, k, MIXED[-2]) for k in range(shafts)]


def put(mix: tuple[str, ...], k: int, rung: str) -> tuple[str, ...]:
    """A mix with the model of one shaft replaced."""
    return (*mix[:k], rung, *mix[k + 1 :])


def mixes_of(shafts: int) -> list[tuple[str, ...]]:
    """Mixes of so many shafts but the judge's: up to two of them no solids, and all alike."""
    judge = (JUDGE,) * shafts
    few = [
        put(put(judge, j, one), k, other)
        for j in range(shafts)
        for k in range(j, shafts)
        for one in MIXED
        for other in MIXED
    ]
    every = dict.fromkeys([*few, *((rung,) * shafts for rung in MIXED)])
    return sorted((mix for mix in every if mix != judge), key=lambda m: [*map(MIXED.index, m)])


@dataclass(frozen=True)
class Departure:
    """Frequencies at which one mix leaves the judge."""

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
        """Up to where both bands hold, infinite for everywhere."""
        ends = [hz for hz in (self.modes_to_hz, self.force_to_hz) if hz is not None]
        return min(ends, default=np.inf)

    @property
    def mix(self) -> tuple[str, ...]:
        """Models in the sequence of the shafts."""
        return tuple(self.models.values())

    @property
    def label(self) -> str:
        """As in charts."""
        return told_mix(self.models)

    def as_dict(self) -> dict:
        """Plain data that JSON can hold."""
        out = asdict(self)
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
    #: the judge's and those of the mixes that were told apart from it, for a chart
    responses: tuple[TrainResponse, ...]
    unpublished: dict[str, str]
    cautions: tuple[str, ...]

    @property
    def cheapest(self) -> Departure:
        """The first mix that holds up to the frequency asked for; at the worst, the judge."""
        return next(mix for mix in self.mixes if mix.to_hz >= self.highest_hz)

    def of(self, *models: str) -> Departure:
        """One of the mixes."""
        return next(m for m in self.mixes if m.mix == models)

    @property
    def every(self) -> str:
        """All shafts, in a word before the noun."""
        count = len(self.mixes[0].models)
        return "both" if count == 2 else f"all {count}"

    def as_dict(self) -> dict:
        """Plain data that JSON can hold."""
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
        """Conclusions from the table."""
        sure = (
            "how sure their meshes are is not told with local harmonics"
            if self.judge_bar is None
            else f"their meshes leave {100 * self.judge_bar:.2g} % of a frequency at most"
        )
        out = [f"Judge: {self.every} shafts as {LADDER[JUDGE].title}s; {sure}."]
        judge = self.mixes[-1]
        for k, side in enumerate(judge.models):
            ends = {rung: self.of(*put(judge.mix, k, rung)).to_hz for rung in MIXED[:-1]}
            best = max(ends, key=lambda rung: ends[rung])
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


def judge_train(
    workshop: Workshop,
    highest_hz: float | None = None,
    more: Sequence[tuple[str, ...]] = (),
    progress: Callable[[str], None] = lambda text: None,
) -> Verdict:
    """Mixes of beams and solids, and the lumped models, against all shafts solid.

    Parameters
    ----------
    highest_hz : float, optional
        That of the file by default.
    more : sequence of tuple of str
        Further mixes, a model for each shaft.
    progress : callable, optional
        Told of every stage.

    Raises
    ------
    SolidgearError
        For a frequency beyond what the reduction resolves, or unknown models.
    """
    ask = workshop.train.ask
    highest = highest_hz or ask.max_frequency
    sides = [*workshop.train.shafts]
    mixes = mixes_of(len(sides))
    mixes += [(name,) * len(sides) for name in LUMPED if _can_be_made(workshop, name)]
    further = [tuple(workshop.mix(mix).values()) for mix in more]
    mixes += [mix for mix in dict.fromkeys(further) if mix not in mixes]
    for mix in mixes:
        for rung in mix:
            checked_rung(rung)
    for driver in workshop.train.drivers:
        error_of(driver)  # refused before anything is solved
    progress(f"judge: {workshop.train.every} shafts {JUDGE}")
    judge = _Judge(workshop, highest)
    found: dict[tuple[str, ...], Departure] = {}
    all_solid = (JUDGE,) * len(sides)

    def look(mix: tuple[str, ...]) -> None:
        if mix not in found and mix != all_solid:
            progress(told_mix(workshop.mix(mix)))
            found[mix] = judge.departure(*mix)

    for mix in mixes:
        look(mix)
    look(tuple(_cheapest(found, all_solid, k, highest) for k in range(len(sides))))
    told = [_with_cause(found, mix) for mix in found]
    own = judge.departure(*all_solid)
    progress("how sure the judge's meshes are")
    # wall seconds would order by noise what has the same body beneath
    ordered = sorted(told, key=lambda m: (m.unknowns, [*map(ladder_place, m.mix)]))
    return Verdict(
        workshop.train.called,
        highest,
        ask.tolerance,
        ask.decibels,
        (*ordered, own),
        judge.bar(),
        tuple(judge.responses.values()),
        workshop.train.unpublished(),
        (
            *slips(workshop),
            *judge.responses[all_solid].cautions,
        ),
    )


def _can_be_made(workshop: Workshop, name: str) -> bool:
    """Mode-matched masses need not exist."""
    try:
        for side in workshop.scenes:
            workshop.shaft(side, name)
    except SolidgearError:
        return False
    return True


def _cheapest(
    found: dict[tuple[str, ...], Departure], solid: tuple[str, ...], k: int, highest: float
) -> str:
    """The cheapest model of a shaft that holds where all others are solids."""
    return next((rung for rung in MIXED[:-1] if found[put(solid, k, rung)].to_hz >= highest), JUDGE)


def _with_cause(found: dict[tuple[str, ...], Departure], mix: tuple[str, ...]) -> Departure:
    """The shaft to blame, by putting one at a time back to the solid."""
    own = found[mix]
    if not np.isfinite(own.to_hz):
        return own
    if len({*mix}) == 1 and mix[0] in RELAXED:
        if "torsion" in own.mode:
            return replace(own, cause="rigid twist")
        milder, words = RELAXED[mix[0]]
        like = (milder,) * len(mix)
        further = like in found and _further(found[like], own)
        return replace(own, cause=words if further else "six motions")
    swapped = {s: put(mix, k, JUDGE) for k, s in enumerate(own.models) if mix[k] != JUDGE}
    if len(swapped) == 1:
        return replace(own, cause=next(iter(swapped)))
    better = [s for s, other in swapped.items() if other in found and _further(found[other], own)]
    several = "both" if len(mix) == 2 else "several"
    return replace(own, cause=better[0] if len(better) == 1 else several)


def _further(other: Departure, own: Departure) -> bool:
    """Tell whether a mix holds clearly further, in its modes or in the force."""

    def end(hz):
        return np.inf if hz is None else hz

    modes = end(other.modes_to_hz) > FURTHER * end(own.modes_to_hz)
    return modes or end(other.force_to_hz) > FURTHER * end(own.force_to_hz)


class _Judge:
    """The reference of a train, and what is compared with it."""

    def __init__(self, workshop: Workshop, highest: float):
        self.workshop, self.highest = workshop, highest
        self.system = workshop.system(JUDGE)
        self.found, self.seen = seen_modes(workshop, self.system, highest)
        self.names = mode_names(workshop, self.system, self.found)
        self.driven = driven(self.system, self.found)[self.found.rigid :]
        drives = [Drive(workshop, JUDGE, mesh=one.name) for one in workshop.train.drivers]
        self.drives = [(drive, drive.grid(highest)) for drive in drives]
        solid, grid = (JUDGE,) * len(workshop.scenes), self.drives[0][1]
        self.responses = {solid: respond(workshop, *solid, highest_hz=highest, frequency_hz=grid)}

    def departure(self, *models: str) -> Departure:
        """Of one mix."""
        modes_to, mode, error = self._first_mode(*models)
        rungs = self.workshop.mix(models)
        unknowns = sum(self.workshop.shaft(*one).unknowns for one in rungs.items())
        seconds = self.workshop.seconds(*models)
        force_to, close_to = self._force(*models)
        return Departure(rungs, unknowns, seconds, modes_to, mode, error, force_to, close_to, "")

    def _first_mode(self, *models: str):
        system = self.workshop.system(*models)
        other, seen = seen_modes(self.workshop, system, self.highest * BEYOND)
        its_hz, own_hz = (found.frequency_hz[found.rigid :] for found in (other, self.found))
        pair = partners(own_hz, self.seen, its_hz, seen)
        for k, hz in enumerate(own_hz):
            name = self.names[self.found.rigid + k]
            if not self.driven[k]:  # moves no port: nothing could tell it from another
                continue
            if k not in pair:
                return float(hz), name, None
            error = float(its_hz[pair[k]] / hz - 1)
            if abs(error) > self.workshop.train.ask.tolerance:
                return float(hz), name, error
        return None, "", None

    def _force(self, *models: str) -> tuple[float | None, float | None]:
        """Ends of the bands of the mesh force, the nearest over the errors of all meshes."""
        ends: tuple[list[float], list[float]] = ([], [])
        ask = self.workshop.train.ask
        for judge, own in self.drives:
            drive = Drive(self.workshop, *models, mesh=judge.pair.name)
            grid = np.union1d(own, drive.grid(self.highest))
            other = np.abs(drive.mesh(grid)[1])
            if models not in self.responses:
                self.responses[models] = respond(
                    self.workshop, *models, highest_hz=self.highest, frequency_hz=grid
                )
            ratio = other / np.abs(judge.mesh(grid)[1])
            beyond = np.abs(20 * np.log10(ratio)) > ask.decibels
            for found, out in zip((beyond, np.abs(ratio - 1) > ask.tolerance), ends):
                out += grid[found][:1].tolist()
        force_to, close_to = (min(found, default=None) for found in ends)
        return force_to, close_to

    def bar(self) -> float | None:
        """Largest relative error that the judge's meshes may leave in its frequencies."""
        count = len(self.found.frequency_hz) - self.found.rigid
        bars = mesh_bars(
            self.workshop, self.system, dict.fromkeys(self.workshop.scenes, JUDGE), count
        )
        return None if bars is None else float(bars.max())
