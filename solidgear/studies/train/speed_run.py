"""A train with backlash while its speed rises or falls evenly, beside its steady motions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.nonlinear.run_up import FEWEST_CYCLES, MOST_CYCLES, RunUp, run_up
from solidgear.studies.train.backlash import Backlash, Range


@dataclass(frozen=True, eq=False)
class SpeedRun:
    """A run through the range of a branch, told of one mesh."""

    ramp: float  #: of the mesh frequency, Hz/s; negative as the speed falls
    run: RunUp = field(repr=False)
    found: Backlash = field(repr=False)

    @property
    def every(self) -> tuple[SpeedRun, ...]:
        """The same told of each mesh with a law, that which drives the train first."""
        meshes = zip((self.run, *self.run.other_links), self.found.every)
        return tuple(SpeedRun(self.ramp, run, found) for run, found in meshes)

    @cached_property
    def frequency_hz(self) -> np.ndarray:
        """(c,) in the middle of each mesh cycle."""
        return self.run.omega / (2 * np.pi)

    @property
    def force(self) -> np.ndarray:
        """(c,) dynamic mesh force: half of its swing within each cycle, N."""
        return self.run.swing

    @property
    def loudest(self) -> tuple[float, float]:
        """Frequency and size of the largest dynamic mesh force."""
        k = int(self.force.argmax())
        return float(self.frequency_hz[k]), float(self.force[k])

    @cached_property
    def apart(self) -> np.ndarray:
        """(c,) bool, whether the teeth part within each cycle."""
        half = self.found.teeth.half_gap
        return (self.run.least < half) & (half > 0)

    @property
    def lost(self) -> Range | None:
        """From the lowest to the highest frequency at which they do; None where they never do."""
        at = self.frequency_hz[self.apart]
        return Range(float(at.min()), float(at.max())) if len(at) else None

    @cached_property
    def steady_force(self) -> np.ndarray:
        """(c,) dynamic mesh force of the stable steady motion nearest to that of each cycle, N; NaN
        where there is none.
        """
        out = np.full(len(self.force), np.nan)
        for at, own in self.found.over(self.frequency_hz, self.found.force):
            before = np.abs(out[at] - self.force[at])
            nearer = ~(before <= np.abs(own - self.force[at]))
            out[at[nearer]] = own[nearer]
        return out

    def followed(self, tolerance: float) -> float:
        """Share of the cycles whose force is within a relative tolerance of a steady motion's."""
        return float(np.mean(np.abs(self.force / self.steady_force - 1) <= tolerance))


def ramp_of(rpm: float, teeth: float, low: float, high: float) -> float:
    """Ramp of the mesh frequency, Hz/s, from one of the pinion in rpm/s, through a range in Hz.

    Raises
    ------
    SolidgearError
        For one that stands still, passes in a few mesh cycles, or takes very many.
    """
    cycles = (high**2 - low**2) / 2 * 60 / teeth  # times the ramp in rpm/s
    least, most = cycles / MOST_CYCLES, cycles / FEWEST_CYCLES
    if not least <= abs(rpm) <= most:
        raise SolidgearError(
            f"--run-up {rpm:g}: give {float(f'{1.05 * least:.2g}'):g} to "
            f"{float(f'{0.95 * most:.2g}'):g} rpm/s, or so much below 0; from {low:g} to {high:g} Hz "
            f"that is {MOST_CYCLES} to {FEWEST_CYCLES} mesh cycles"
        )
    return rpm * teeth / 60


def speed_run(found: Backlash, ramp: float, told: Callable[[str], None] | None = None) -> SpeedRun:
    """A run from one end of a branch to the other by integration in time.

    Parameters
    ----------
    ramp : float
        Of the mesh frequency, Hz/s; below zero it falls from the highest.
    """
    ends = found.branch.omega[[0, -1]]
    begin, end = ends.tolist() if ramp > 0 else ends[::-1].tolist()
    point = found.points[0 if ramp > 0 else -1]

    way, tenth = "up" if ramp > 0 else "down", -1

    def share(done: float) -> None:
        nonlocal tenth
        if told and int(10 * done) > tenth:
            tenth = int(10 * done)
            told(f"run {way}, {10 * tenth} %")

    own = run_up(
        found.remainder, begin, end, 2 * np.pi * abs(ramp), state=point.state(), progress=share
    )
    return SpeedRun(ramp, own, found)
