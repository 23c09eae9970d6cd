"""Lanes of a race: who runs, run in turns, and what the times say about one another."""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from validation.peers.process import PeerError


@dataclass
class Sample:
    """Wall seconds by stage (their sum is what counts) and processor seconds of one run."""

    stages: dict[str, float]
    cpu: float

    def seconds(self, stages=None) -> float:
        """Sum of some stages, or of all."""
        return sum(v for k, v in self.stages.items() if stages is None or k in stages)


@dataclass
class Lane:
    """One contestant.

    Attributes
    ----------
    heat, who : str
    call : callable
        Returns a Sample; PeerError is a failure that is reported, not one that ends the race.
    counted : tuple of str, optional
        Stages the comparison is about; all by default.
    """

    heat: str
    who: str
    call: Callable[[], Sample]
    unknowns: int | None = None
    counted: tuple[str, ...] | None = None
    note: str = ""
    error: str = ""
    samples: list[Sample] = field(default_factory=list)

    def run(self) -> None:
        """One more sample, unless the lane has failed before."""
        if self.error:
            return
        try:
            self.samples.append(self.call())
        except PeerError as error:
            self.error = str(error)

    def times(self, stages=None) -> list[float]:
        """Seconds of every run that count."""
        return [s.seconds(stages or self.counted) for s in self.samples]

    def row(self) -> dict:
        """For the table."""
        t = self.times() or [float("nan")]
        row = {
            "heat": self.heat,
            "lane": self.who,
            "unknowns": self.unknowns,
            "median s": statistics.median(t),
            "min s": min(t),
            "max s": max(t),
        }
        row |= {
            "runs": len(self.samples),
            "cpu s": statistics.median([s.cpu for s in self.samples]) if self.samples else None,
        }
        names = self.samples[0].stages if self.samples else {}
        row |= {
            f"{name} s": statistics.median([s.stages[name] for s in self.samples])
            for name in names
            if len(names) > 1
        }
        return row | {"note": self.error or self.note}


@dataclass
class Figure:
    """A ratio, asked for or not: the fastest of some lanes over one of ours.

    Attributes
    ----------
    slow : Lane or list of Lane
        Variants of a peer, of which the fastest counts.
    fast : Lane
    asked : float, optional
    stages : tuple of str, optional
        Of the fast lane that count; the lane's own choice by default.
    """

    what: str
    slow: Lane | list[Lane]
    fast: Lane
    asked: float | None = None
    stages: tuple[str, ...] | None = None

    def fastest(self) -> Lane:
        """The slow lane that counts; one that did not run only if none did."""
        lanes = self.slow if isinstance(self.slow, list) else [self.slow]
        return min(
            lanes,
            key=lambda lane: statistics.median(lane.times()) if lane.samples else float("inf"),
        )

    def row(self) -> dict:
        """Ratio of medians, its spread over the rounds, and whether it met what was asked."""
        row: dict = {
            "ratio": self.what,
            "asked": self.asked,
            "measured": None,
            "over rounds": "",
            "met": "",
        }
        slow = self.fastest()
        if not slow.samples or not self.fast.samples:
            missing = self.fast if slow.samples else slow
            return row | {"met": f"not compared: {missing.error or 'not run'}"}
        # Rounds both took part in: an interrupted last one would set different spells of the
        # machine against each other.
        slow, fast = zip(*zip(slow.times(), self.fast.times(self.stages)))
        ratio = statistics.median(slow) / statistics.median(fast)
        each = [a / b for a, b in zip(slow, fast)]
        row |= {"measured": ratio, "over rounds": f"{min(each):.3g} to {max(each):.3g}"}
        return row | {"met": "" if self.asked is None else "yes" if ratio >= self.asked else "NO"}


def paired(frequency, multiplicity) -> np.ndarray:
    """Single frequencies brought to distinct ones: root mean square over each group of as many as
    ``multiplicity`` says.

    A mesh without symmetry splits a pair by its own error; our results give the pair, a peer gives
    both.
    """
    cuts = np.cumsum([0, *multiplicity])
    return np.array(
        [
            np.sqrt(np.mean(np.square(frequency[a:b])))
            for a, b in zip(cuts, cuts[1:])
            if b <= len(frequency)
        ]
    )


def frequency_gap(frequency, modes) -> float:
    """Largest relative difference of a peer's frequencies from a ModeSet's elastic ones."""
    elastic = [m for m in modes.modes if m.frequency_hz > 0]
    theirs = paired(np.sort(frequency), [m.multiplicity for m in elastic])
    mine = np.array([m.frequency_hz for m in elastic])[: len(theirs)]
    return float(np.abs(theirs / mine - 1).max())


def compliance_gap(theirs, ours) -> float:
    """Largest difference of two 6x6 compliances, entries scaled by the diagonal."""
    d = np.sqrt(np.diag(ours))
    return float((np.abs(theirs - ours) / np.outer(d, d)).max())
