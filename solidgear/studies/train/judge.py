"""Shaft of a train that needs the solid, and from which frequency on: every mix of models against
both shafts solid.

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
from solidgear.scene.train import SIDES
from solidgear.studies.train.local import local_lines
from solidgear.studies.train.meshes import mesh_bars
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.naming import driven, mode_names
from solidgear.studies.train.pairing import BEYOND, partners, seen_modes
from solidgear.studies.train.respond import Drive, TrainResponse, respond
from solidgear.studies.train.shaft import JUDGE, LUMPED, checked_rung
from solidgear.studies.train.slips import slips

#: models of one shaft that are mixed, cheapest first
MIXED = (*LADDER.of(BEAM), JUDGE)
#: mixes that a chart of the verdict shows; more would hide one another
DRAWN = (
    (JUDGE, JUDGE),
    (MIXED[-2], JUDGE),
    (JUDGE, MIXED[-2]),
    (MIXED[0], MIXED[0]),
    (LUMPED[0], LUMPED[0]),
    (LUMPED[-1], LUMPED[-1]),
)
#: a shaft put back to the solid must carry a mix this much further to be the cause alone
FURTHER = 1.05
#: lumped models: the one with an assumption less, and that assumption
RELAXED = {
    "lumped-old": ("lumped-bending", "bending mass"),
    "lumped-bending": ("lumped", "axial mass"),
    "lumped-matched": ("lumped", "axial mass"),
    "lumped": ("", ""),
}


@dataclass(frozen=True)
class Departure:
    """Frequencies at which one mix leaves the judge.

    Attributes
    ----------
    unknowns : int
        Of both bodies.
    seconds : float
        To build and reduce them.
    modes_to_hz : float or None
        Frequency of the judge's first mode that is missed; None for none.
    mode, error : str, float or None
        That mode, and by how much it is off, relative; None where it has no counterpart.
    force_to_hz : float or None
        Where the mesh force leaves its band in decibels; None for nowhere.
    close_to_hz : float or None
        Where the mesh force is off by more than the tolerance, which any peak or dip that moves a
        little makes it.
    cause : str
        The shaft, ``both``, or the assumption of a lumped model; empty for none.
    """

    pinion: str
    gear: str
    unknowns: int
    seconds: float
    modes_to_hz: float | None
    mode: str
    error: float | None
    force_to_hz: float | None
    close_to_hz: float | None
    cause: str

    @property
    def to_hz(self) -> float:
        """Up to where both bands hold, infinite for everywhere."""
        ends = [hz for hz in (self.modes_to_hz, self.force_to_hz) if hz is not None]
        return min(ends, default=np.inf)

    @property
    def label(self) -> str:
        """As in charts."""
        return f"pinion {self.pinion}, gear {self.gear}"


@dataclass(frozen=True, eq=False)
class Verdict:
    """Mixes of models of a train, judged.

    Attributes
    ----------
    mixes : tuple of Departure
        Cheapest first, by unknowns; the judge is the last.
    judge_bar : float or None
        Largest relative error that the judge's meshes leave in its frequencies, by local problems;
        None where teeth drive families of two waves and more.
    responses : tuple of TrainResponse
        The judge's and those of the mixes that were told apart from it, for a chart.
    """

    train: str
    highest_hz: float
    tolerance: float
    decibels: float
    mixes: tuple[Departure, ...]
    judge_bar: float | None
    responses: tuple[TrainResponse, ...]
    unpublished: dict[str, str]
    cautions: tuple[str, ...]

    @property
    def cheapest(self) -> Departure:
        """The first mix that holds up to the frequency asked for; at the worst, the judge."""
        return next(mix for mix in self.mixes if mix.to_hz >= self.highest_hz)

    def of(self, pinion: str, gear: str) -> Departure:
        """One of the mixes."""
        return next(m for m in self.mixes if (m.pinion, m.gear) == (pinion, gear))

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
            "cheapest": {"pinion": best.pinion, "gear": best.gear},
            "mixes": [asdict(mix) for mix in self.mixes],
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
        out = [f"Judge: both shafts as {LADDER[JUDGE].title}s; {sure}."]
        for side in SIDES:
            ends = {}
            for rung in MIXED[:-1]:
                pair = (rung, JUDGE) if side == "pinion" else (JUDGE, rung)
                ends[rung] = self.of(*pair).to_hz
            best = max(ends, key=lambda rung: ends[rung])
            if ends[best] >= self.highest_hz:
                out.append(f"The {side} may be a beam ({best}) up to {self.highest_hz:g} Hz.")
            else:
                out.append(
                    f"The {side} needs the solid from {ends[best]:.0f} Hz on ({best} until there)."
                )
        mix = self.cheapest
        words = "both shafts solid" if mix is self.mixes[-1] else mix.label
        out.append(
            f"Cheapest within {100 * self.tolerance:g} % and {self.decibels:g} dB "
            f"up to {self.highest_hz:g} Hz: {words}."
        )
        return out


def judge_train(
    workshop: Workshop,
    highest_hz: float | None = None,
    more: Sequence[tuple[str, str]] = (),
    progress: Callable[[str], None] = lambda text: None,
) -> Verdict:
    """Every mix of beams and solids, and the lumped models, against both shafts solid.

    Parameters
    ----------
    highest_hz : float, optional
        That of the file by default.
    more : sequence of (str, str)
        Further mixes, (pinion, gear).
    progress : callable, optional
        Told of every stage.

    Raises
    ------
    SolidgearError
        For a frequency beyond what the reduction resolves, or unknown models.
    """
    ask = workshop.train.ask
    highest = highest_hz or ask.max_frequency
    mixes = [(p, g) for p in MIXED for g in MIXED if (p, g) != (JUDGE, JUDGE)]
    mixes += [(name, name) for name in LUMPED if _can_be_made(workshop, name)]
    mixes += [mix for mix in more if mix not in mixes]
    for pair in mixes:
        for rung in pair:
            checked_rung(rung)
    progress(f"judge: both shafts {JUDGE}")
    judge = _Judge(workshop, highest)
    found = {}
    for mix in mixes:
        progress(f"pinion {mix[0]}, gear {mix[1]}")
        found[mix] = judge.departure(*mix)
    told = [_with_cause(found, mix) for mix in mixes]
    own = judge.departure(JUDGE, JUDGE)
    progress("how sure the judge's meshes are")
    ordered = sorted(told, key=lambda m: (m.unknowns, m.seconds))
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
            *workshop.cautions,
            *local_lines(workshop, judge.system),
        ),
    )


def _can_be_made(workshop: Workshop, name: str) -> bool:
    """Mode-matched masses need not exist."""
    try:
        for side in SIDES:
            workshop.shaft(side, name)
    except SolidgearError:
        return False
    return True


def _with_cause(found: dict[tuple[str, str], Departure], mix: tuple[str, str]) -> Departure:
    """The shaft to blame, by putting one at a time back to the solid."""
    own = found[mix]
    if not np.isfinite(own.to_hz):
        return own
    pinion, gear = mix
    if pinion == gear and pinion in RELAXED:
        if "torsion" in own.mode:
            return replace(own, cause="rigid twist")
        milder, words = RELAXED[pinion]
        further = (milder, milder) in found and _further(found[milder, milder], own)
        return replace(own, cause=words if further else "six motions")
    if pinion == JUDGE or gear == JUDGE:
        return replace(own, cause="gear" if pinion == JUDGE else "pinion")
    swapped = {"pinion": (JUDGE, gear), "gear": (pinion, JUDGE)}
    better = [s for s, other in swapped.items() if other in found and _further(found[other], own)]
    return replace(own, cause=better[0] if len(better) == 1 else "both")


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
        self.system = workshop.system(JUDGE, JUDGE)
        self.found, self.seen = seen_modes(workshop, self.system, highest)
        self.names = mode_names(workshop, self.system, self.found)
        self.driven = driven(self.system, self.found)[1:]
        self.drive = Drive(workshop, JUDGE, JUDGE)
        self.grid = self.drive.grid(highest)
        self.responses = {
            (JUDGE, JUDGE): respond(workshop, JUDGE, JUDGE, highest, frequency_hz=self.grid)
        }

    def departure(self, pinion: str, gear: str) -> Departure:
        """Of one mix."""
        modes_to, mode, error = self._first_mode(pinion, gear)
        unknowns = sum(
            self.workshop.shaft(side, rung).unknowns for side, rung in zip(SIDES, (pinion, gear))
        )
        seconds = self.workshop.seconds(pinion, gear)
        force_to, close_to = self._force(pinion, gear)
        return Departure(
            pinion, gear, unknowns, seconds, modes_to, mode, error, force_to, close_to, ""
        )

    def _first_mode(self, pinion: str, gear: str):
        system = self.workshop.system(pinion, gear)
        other, seen = seen_modes(self.workshop, system, self.highest * BEYOND)
        its_hz = other.frequency_hz[1:]
        pair = partners(self.found.frequency_hz[1:], self.seen, its_hz, seen)
        for k, hz in enumerate(self.found.frequency_hz[1:]):
            name = self.names[k + 1]
            if not self.driven[k]:  # moves no port: nothing could tell it from another
                continue
            if k not in pair:
                return float(hz), name, None
            error = float(its_hz[pair[k]] / hz - 1)
            if abs(error) > self.workshop.train.ask.tolerance:
                return float(hz), name, error
        return None, "", None

    def _force(self, pinion: str, gear: str) -> tuple[float | None, float | None]:
        drive = Drive(self.workshop, pinion, gear)
        grid = np.union1d(self.grid, drive.grid(self.highest))
        other = np.abs(drive.mesh(grid)[1])
        self.responses.setdefault(
            (pinion, gear),
            respond(self.workshop, pinion, gear, self.highest, frequency_hz=grid),
        )
        ratio = other / np.abs(self.drive.mesh(grid)[1])
        ask = self.workshop.train.ask
        beyond = np.flatnonzero(np.abs(20 * np.log10(ratio)) > ask.decibels)
        apart = np.flatnonzero(np.abs(ratio - 1) > ask.tolerance)
        first = [float(grid[k[0]]) if len(k) else None for k in (beyond, apart)]
        return first[0], first[1]

    def bar(self) -> float | None:
        """Largest relative error that the judge's meshes may leave in its frequencies."""
        count = len(self.found.frequency_hz) - self.found.rigid
        bars = mesh_bars(self.workshop, self.system, dict.fromkeys(SIDES, JUDGE), count)
        return None if bars is None else float(bars.max())
