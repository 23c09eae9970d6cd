"""A train with backlash while the speed rises or falls evenly, compared with the steady motions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from solidgear.backlash.periodic import Backlash, Largest, Range, range_of
from solidgear.backlash.solver.run_up import FEWEST_CYCLES, MOST_CYCLES, RunUp, run_up
from solidgear.core import SolidgearError


@dataclass(frozen=True, eq=False)
class SpeedRun:
    """A run through the range of a branch, described for one mesh."""

    ramp: float  #: of the mesh frequency, Hz/s; negative as the speed falls
    run: RunUp = field(repr=False)
    backlash: Backlash = field(repr=False)

    @property
    def meshes(self) -> tuple[SpeedRun, ...]:
        """The same described for each mesh with a law, that which drives the train first."""
        meshes = zip((self.run, *self.run.other_links), self.backlash.meshes)
        return tuple(SpeedRun(self.ramp, run, backlash) for run, backlash in meshes)

    @property
    def way(self) -> str:
        """Direction in a word."""
        return "up" if self.ramp > 0 else "down"

    @cached_property
    def frequency_hz(self) -> np.ndarray:
        """Frequency (c,) in the middle of each mesh cycle."""
        return self.run.omega / (2 * np.pi)

    @property
    def force(self) -> np.ndarray:
        """Dynamic mesh force (c,): half of the swing within each cycle, N."""
        return self.run.swing

    @property
    def loudest(self) -> Largest:
        """The largest dynamic mesh force."""
        k = int(self.force.argmax())
        return Largest(float(self.frequency_hz[k]), float(self.force[k]))

    @cached_property
    def parted(self) -> np.ndarray:
        """Whether the teeth part within each cycle (c,)."""
        half = self.backlash.teeth.half_gap
        return (self.run.least < half) & (half > 0)

    @property
    def lost(self) -> Range | None:
        """Range from the lowest to the highest frequency at which they do; None where they never
        do.
        """
        hz = self.frequency_hz[self.parted]
        return range_of(hz) if len(hz) else None

    @cached_property
    def steady_force(self) -> np.ndarray:
        """Dynamic mesh force (c,) of the stable steady motion nearest to that of each cycle, N; NaN
        where there is none.
        """
        out = np.full(len(self.force), np.nan)
        for numbers, force in self.backlash.interpolate(self.frequency_hz, self.backlash.force):
            distance = np.abs(out[numbers] - self.force[numbers])
            nearer = ~(distance <= np.abs(force - self.force[numbers]))
            out[numbers[nearer]] = force[nearer]
        return out

    def followed(self, tolerance: float) -> float:
        """Return the share of the cycles whose force is within a relative tolerance of a steady
        motion's.
        """
        return float(np.mean(np.abs(self.force / self.steady_force - 1) <= tolerance))


def ramp_of(rpm: float, teeth: float, low: float, high: float) -> float:
    """Return the ramp of the mesh frequency, Hz/s, from one of the pinion in rpm/s, through a range
    in Hz; refused for a run of too few or too many mesh cycles.
    """
    cycles = (high**2 - low**2) / 2 * 60 / teeth  # times the ramp in rpm/s
    least, most = cycles / MOST_CYCLES, cycles / FEWEST_CYCLES
    if not least <= abs(rpm) <= most:
        raise SolidgearError(
            f"`run_up` {rpm:g}: give {float(f'{1.05 * least:.2g}'):g} to "
            f"{float(f'{0.95 * most:.2g}'):g} rpm/s, or so much below 0; from {low:g} to {high:g} Hz "
            f"that is {MOST_CYCLES} to {FEWEST_CYCLES} mesh cycles"
        )
    return rpm * teeth / 60


def speed_run(
    backlash: Backlash, ramp: float, progress: Callable[[str], None] = lambda text: None
) -> SpeedRun:
    """Integrate a run from one end of a branch to the other in time, by a ramp of the mesh
    frequency, Hz/s; below zero it falls from the highest.
    """
    ends = backlash.branch.omega[[0, -1]]
    begin, end = ends.tolist() if ramp > 0 else ends[::-1].tolist()
    point = backlash.points[0 if ramp > 0 else -1]

    word, tenth = ("up" if ramp > 0 else "down"), -1

    def share(fraction: float) -> None:
        nonlocal tenth
        if int(10 * fraction) > tenth:
            tenth = int(10 * fraction)
            progress(f"run {word}, {10 * tenth} %")

    run = run_up(
        backlash.remainder, begin, end, 2 * np.pi * abs(ramp), state=point.state(), progress=share
    )
    return SpeedRun(ramp, run, backlash)
