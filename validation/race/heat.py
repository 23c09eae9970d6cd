"""Lanes, run in turns, and what their times say about one another."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from validation.race.process import PeerError, spent

#: fact of a lane: how far its answer is from a reference of high order, relative
ERROR = "off the reference"


@dataclass
class Sample:
    """One run: wall seconds by stage (their sum is what counts), processor seconds, what came out,
    and more that is to be told.
    """

    stages: dict[str, float]
    cpu: float
    answer: Any = None
    facts: dict[str, Any] = field(default_factory=dict)

    def seconds(self, stages: Sequence[str] | None = None) -> float:
        """Sum of some stages, or of all."""
        return sum(v for k, v in self.stages.items() if stages is None or k in stages)


class Clock:
    """Seconds of one run, stage by stage."""

    def __init__(self) -> None:
        self.stages: dict[str, float] = {}
        self._cpu = spent()

    def stage(self, name: str, work: Callable[[], Any]) -> Any:
        """Do some work as a stage."""
        start = time.perf_counter()
        out = work()
        self.stages[name] = time.perf_counter() - start
        return out

    def sample(self, answer: Any = None, **facts: Any) -> Sample:
        """What was clocked."""
        return Sample(self.stages, spent() - self._cpu, answer, facts)


@dataclass(frozen=True)
class Check:
    """A comparison of answers.

    Attributes
    ----------
    what : str
    gap : callable
        Of an answer: how far it is from what it should be.
    allowed : float
        Above it times mean nothing; none for what is only told.
    why : str
        Reason of what is allowed.
    """

    what: str
    gap: Callable[[Any], float]
    allowed: float | None = None
    why: str = ""


@dataclass
class Lane:
    """One contestant.

    Attributes
    ----------
    who : str
    run : callable
        A Sample, or an answer, which is clocked as one stage. PeerError is a failure that is
        reported, not one that ends the race.
    prepare : callable, optional
        What is done once before, and not clocked.
    checks : sequence of Check
        Of the first answer.
    counted : sequence of str, optional
        Stages the comparison is about; all by default.
    repeats : int
        Runs in a row, for what is quick beside others.
    enough : float
        Processor seconds after which it is not run again.
    within : float, optional
        Seconds asked for.
    facts : dict
        More that is to be told.
    note : str
    """

    who: str
    run: Callable[[], Any]
    prepare: Callable[[], Any] | None = None
    checks: Sequence[Check] = ()
    counted: Sequence[str] | None = None
    repeats: int = 1
    enough: float = math.inf
    within: float | None = None
    facts: dict[str, Any] = field(default_factory=dict)
    note: str = ""
    error: str = ""
    samples: list[Sample] = field(default_factory=list)

    @property
    def answer(self) -> Any:
        """What came out of the first run."""
        return self.samples[0].answer

    def times(self, stages: Sequence[str] | None = None) -> list[float]:
        """Seconds that count, of every round the median."""
        seconds = [s.seconds(stages or self.counted) for s in self.samples]
        starts = range(0, len(seconds), self.repeats)
        return [statistics.median(seconds[k : k + self.repeats]) for k in starts]

    def cpu(self) -> float:
        """Median processor seconds of a run, all stages."""
        return statistics.median(s.cpu for s in self.samples)

    def row(self) -> dict[str, Any]:
        """For the table and the record."""
        row: dict[str, Any] = {"lane": self.who, **self.facts}
        if self.samples:
            times = self.times()
            row |= {"median s": statistics.median(times), "min s": min(times), "max s": max(times)}
            row |= {"runs": len(self.samples), "cpu s": self.cpu()}
            stages = self.samples[0].stages
            if len(stages) > 1:
                row |= {f"{name} s": self._median("stages", name) for name in stages}
            row |= {name: self._median("facts", name) for name in self.samples[0].facts}
        if self.within is not None:
            met = bool(self.samples) and row["median s"] <= self.within
            row |= {"asked s": self.within, "met": "yes" if met else "NO"}
        return row | {"note": self.note, "error": self.error}

    def _median(self, kind: str, name: str) -> Any:
        """Of numbers the median of all runs, of words those of the first."""
        values = [getattr(sample, kind)[name] for sample in self.samples]
        return values[0] if isinstance(values[0], str | None) else statistics.median(values)


@dataclass
class Ratio:
    """How many times one lane takes another: the fastest of some over one.

    Attributes
    ----------
    what : str
    slow : sequence of Lane
        Variants, of which the fastest counts.
    fast : Lane
    asked : float, optional
    stages : sequence of str, optional
        Of the fast lane that count; the lane's own choice by default.
    """

    what: str
    slow: Sequence[Lane]
    fast: Lane
    asked: float | None = None
    stages: Sequence[str] | None = None

    def row(self) -> dict[str, Any]:
        """Ratio of medians, its spread over the rounds, and whether it met what was asked."""
        ran = [lane for lane in self.slow if lane.samples]
        if not ran or not self.fast.samples:
            missing = self.fast if ran else self.slow[0]
            reason = f"not compared: {missing.error or 'not run'}"
            return {"ratio": self.what, "asked": self.asked, "measured": None, "met": reason}
        best = min(ran, key=lambda lane: statistics.median(lane.times()))
        # Rounds both took part in: an interrupted last one would set different spells of the
        # machine against each other.
        slow, fast = zip(*zip(best.times(), self.fast.times(self.stages)))
        ratio = statistics.median(slow) / statistics.median(fast)
        each = [a / b for a, b in zip(slow, fast)]
        met = "" if self.asked is None else "yes" if ratio >= self.asked else "NO"
        row = {"ratio": self.what, "asked": self.asked, "measured": ratio, "met": met}
        row["over rounds"] = f"{min(each):.3g} to {max(each):.3g}"
        if not (self.stages or best.counted or self.fast.counted):
            # the steadier one on a busy machine
            row["of processor seconds"] = best.cpu() / self.fast.cpu()
        return row


@dataclass
class Heat:
    """Lanes of one question, run in turns, so that a noisy spell of the machine hits all alike.

    Attributes
    ----------
    quick : bool
        Small meshes: does it work, not how fast.
    limit : float
        Seconds that a process may take.
    settings : dict of str to float
        What can be set for the race.
    against : Path, optional
        Another checkout, which takes turns with this one.
    scenes : tuple of Path
        Further scene files.
    """

    quick: bool = False
    limit: float = 900.0
    settings: dict[str, float] = field(default_factory=dict)
    against: Path | None = None
    scenes: tuple[Path, ...] = ()
    lanes: list[Lane] = field(default_factory=list)
    ratios: list[Ratio] = field(default_factory=list)
    answers: list[dict[str, Any]] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)
    versions: dict[str, str] = field(default_factory=dict)

    def add(self, who: str, run: Callable[[], Any], **more: Any) -> Lane:
        """Enter a lane."""
        self.lanes.append(Lane(who, run, **more))
        return self.lanes[-1]

    def ratio(
        self, what: str, slow: Lane | Sequence[Lane], fast: Lane, asked=None, stages=None
    ) -> None:
        """Ask for a ratio."""
        several = [slow] if isinstance(slow, Lane) else slow
        self.ratios.append(Ratio(what, several, fast, asked, stages))

    def say(self, text: str) -> None:
        """A line for whoever watches."""
        print(text, flush=True)

    def skip(self, text: str) -> None:
        """Note what is not raced, and say so."""
        self.skipped.append(text)
        self.say(f"not raced: {text}")

    def run(self, rounds: int, kept: Callable[[], None] = lambda: None) -> None:
        """Every lane once a round; rows are kept after each."""
        for k in range(rounds):
            for lane in self.lanes:
                before = len(lane.samples), lane.error
                self._run(lane)
                if (len(lane.samples), lane.error) != before:
                    said = lane.error or f"{lane.times()[-1]:.3g} s"
                    self.say(f"round {k + 1}: {lane.who}: {said}")
                    kept()

    def _run(self, lane: Lane) -> None:
        if lane.error or sum(s.cpu for s in lane.samples) >= lane.enough:
            return
        try:
            if lane.prepare and not lane.samples:
                lane.prepare()
            for _ in range(lane.repeats):
                clock = Clock()
                found = clock.stage("all", lane.run)
                sample = found if isinstance(found, Sample) else clock.sample(found)
                if not lane.samples:
                    self._compare(lane, sample.answer)
                lane.samples.append(sample)
        except PeerError as error:
            lane.error = str(error)

    def _compare(self, lane: Lane, answer: Any) -> None:
        for check in lane.checks:
            gap = float(check.gap(answer))
            good = check.allowed is None or gap <= check.allowed
            row = {"answers of": lane.who, "compared": check.what, "largest difference": gap}
            row |= {"allowed": check.allowed, "agree": "yes" if good else "NO"}
            self.answers.append(row | {"because": check.why})
            if not good:
                raise PeerError(
                    f"{check.what} differ from ours by {gap:.1e}, allowed is {check.allowed:g}"
                )

    def record(self) -> dict[str, Any]:
        """All that was found, as plain data."""
        ran = [lane.row() for lane in self.lanes if lane.samples or lane.error]
        return {
            "lanes": ran,
            "answers": self.answers,
            "ratios": [ratio.row() for ratio in self.ratios],
            "skipped": self.skipped,
            "versions": self.versions,
        }
