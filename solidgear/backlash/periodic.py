"""Teeth with backlash over speed, as a branch of periodic motions shows them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from solidgear.backlash.solver.apart import Search
from solidgear.backlash.solver.balance import Balance
from solidgear.backlash.solver.continuation import TAIL, Branch, Point
from solidgear.backlash.solver.model import Remainder
from solidgear.backlash.solver.motion import departure
from solidgear.backlash.solver.stability import ON
from solidgear.trains.assembly.shaft import mix_label

#: points at which the linear answer is solved
LINEAR = 1500
#: imaginary part of a multiplier that is rounding
REAL = 1e-6


@dataclass(frozen=True)
class Teeth:
    """Teeth of a train, but for their stiffness."""

    half_gap: float
    mean_force: float  #: N, along the line of action
    errors: tuple[float, ...]  #: unloaded transmission error by orders of the mesh, m
    source: str  #: of the mean force
    #: how the stiffness varies over a mesh cycle, of its mean, by orders: cosine and sine parts
    cycle: tuple[tuple[float, float], ...] = ()
    #: of the transmission error by orders, rad; none where the file gives none
    phases: tuple[float, ...] = ()
    turns: bool = False  #: the line of action varies over the cycle
    #: where a damper in contact alone has the loss factor of the mesh
    contact_loss_hz: float | None = None
    mesh: str = "mesh"  #: its name
    #: of other meshes, which nothing but their motion excites; no gap where they have no backlash
    others: tuple[Teeth, ...] = ()

    @property
    def meshes(self) -> tuple[Teeth, ...]:
        """These, and those of the other meshes."""
        return (self, *self.others)

    @property
    def harmonics(self) -> tuple[complex, ...]:
        """Transmission error by orders, ``Re(e exp(i n x angle))``, m."""
        phases = self.phases or (0.0,) * len(self.errors)
        return tuple(complex(e * np.exp(1j * p)) for e, p in zip(self.errors, phases))

    @property
    def highest_order(self) -> int:
        """The highest order of the mesh that excites it, of those that motions are followed to."""
        sizes = [np.abs(self.errors), np.hypot(*np.reshape(self.cycle, (-1, 2)).T)]
        orders = [np.flatnonzero(size > TAIL * size.max(initial=0.0)) + 1 for size in sizes]
        return int(np.concatenate([[1], *orders]).max())

    @property
    def varies(self) -> bool:
        """True if the mesh varies over the cycle, and the linear answer with constant teeth with
        it.
        """
        return self.turns or bool(self.cycle)


@dataclass(frozen=True)
class Range:
    """Frequencies from low to high, Hz."""

    low: float
    high: float


def range_of(hz: np.ndarray) -> Range:
    """Return the range from the lowest to the highest frequency."""
    return Range(float(hz.min()), float(hz.max()))


class Largest(NamedTuple):
    """The largest dynamic mesh force."""

    frequency_hz: float  #: of the mesh
    force: float  #: N


@dataclass(frozen=True)
class Jump:
    """A turning point of the branch, where a sweep falls off it."""

    frequency_hz: float
    rising: bool  #: whether it is met as the speed rises
    force: float  #: dynamic mesh force just before, N


@dataclass(frozen=True)
class AtForce:
    """Jumps at another mean force of the teeth."""

    mean_force: float  #: N
    jumps_hz: tuple[tuple[float, bool], ...]  #: each with whether the speed rises
    largest: float  #: largest dynamic mesh force of any periodic motion, N


@dataclass(frozen=True, eq=False)
class Backlash:
    """Periodic motion of a train by models of the shafts, over frequency, described for one mesh."""

    models: dict[str, str]  #: by shaft
    teeth: Teeth
    remainder: Remainder = field(repr=False)
    branch: Branch = field(repr=False)  #: in order; more than one point may lie at one frequency
    multiplier: np.ndarray = field(repr=False)
    seconds: float  #: processor time, of the branch and its stability
    #: orders of the mesh reach it, and modes from the second on are springs, Hz; None where orders meet
    #: all modes that they reach
    unmet_hz: tuple[float, float] | None = None
    #: number of the law whose mesh is described: 0 for the mesh whose transmission error drives the train
    law: int = 0
    periods: int = 1  #: of the driven mesh after which motions repeat themselves
    end: str = (
        ""  #: of a branch apart, as of :class:`solidgear.backlash.solver.apart.SeparateBranch`
    )
    #: for branches apart; None where they were not looked for
    search: Search | None = field(default=None, repr=False)
    branches_apart: tuple[Backlash, ...] = ()  #: those that were found

    @property
    def label(self) -> str:
        """Models in words."""
        first, *further = self.models.values()
        if any(model != first for model in further):
            return mix_label(self.models)
        count = len(self.models)
        return f"{'both' if count == 2 else f'all {count}'} {first}"

    @cached_property
    def meshes(self) -> tuple[Backlash, ...]:
        """The same described for each mesh with a law, that which drives the train first."""
        numbered = enumerate(self.teeth.others, start=1)
        return (self, *(self._of_mesh(teeth, k) for k, teeth in numbered))

    def _of_mesh(self, teeth: Teeth, law: int) -> Backlash:
        branches_apart = tuple(branch._of_mesh(teeth, law) for branch in self.branches_apart)
        return replace(self, teeth=teeth, law=law, branches_apart=branches_apart)

    @property
    def row(self) -> int:
        """Row of the stretch of this mesh."""
        return self.remainder.laws[self.law][1].start

    @property
    def points(self) -> tuple[Point, ...]:
        """Points of the branch."""
        return self.branch.points

    @cached_property
    def frequency_hz(self) -> np.ndarray:
        """Mesh frequency (p,)."""
        return self.periods * self.branch.omega / (2 * np.pi)

    @cached_property
    def _waves(self) -> list[np.ndarray]:
        return [point.forces()[:, self.row] for point in self.points]

    @cached_property
    def stretch(self) -> list[np.ndarray]:
        """Stretch of the teeth over a cycle, at every point, m."""
        return [point.along(self.law) for point in self.points]

    @cached_property
    def force(self) -> np.ndarray:
        """Dynamic mesh force (p,): half of the swing over a cycle, N."""
        return np.array([np.ptp(wave) / 2 for wave in self._waves])

    @cached_property
    def highest(self) -> np.ndarray:
        """Largest mesh force (p,), mean included, N."""
        return np.array([wave.max() for wave in self._waves])

    @cached_property
    def driving(self) -> np.ndarray:
        """Share (p,) of the cycle in which the flank that carries the mean touches."""
        return np.array([np.mean(s > self.teeth.half_gap) for s in self.stretch])

    @cached_property
    def backside(self) -> np.ndarray:
        """Share (p,) of the cycle in which the other flank touches."""
        return np.array([np.mean(s < -self.teeth.half_gap) for s in self.stretch])

    @cached_property
    def stable(self) -> np.ndarray:
        """Whether each motion (p,) is stable."""
        return np.abs(self.multiplier) <= 1 + ON

    def interpolate(
        self, hz: np.ndarray, values: np.ndarray
    ) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield for every two stable neighbours of the branch the numbers of the frequencies (n,)
        that lie between them, and values of the points (p,) interpolated there.
        """
        frequency, stable = self.frequency_hz, self.stable
        for a, b in zip(range(len(frequency) - 1), range(1, len(frequency))):
            low, high = sorted((frequency[a], frequency[b]))
            inside = np.flatnonzero((hz >= low) & (hz <= high))
            if stable[a] and stable[b] and low < high and len(inside):
                share = (hz[inside] - frequency[a]) / (frequency[b] - frequency[a])
                yield inside, values[a] + share * (values[b] - values[a])

    @cached_property
    def _unbounded(self) -> tuple[np.ndarray, list[tuple[np.ndarray, np.ndarray]]]:
        """Frequencies, and stretches and rates there of the same train without backlash."""
        low, high = self.frequency_hz.min(), self.frequency_hz.max()
        hz = np.concatenate([np.geomspace(low, high, LINEAR), self.remainder.omega / (2 * np.pi)])
        hz = np.unique(hz[(hz >= low) & (hz <= high)])
        return hz, [self._linear(f) for f in hz]

    def _linear(self, hz: float) -> tuple[np.ndarray, np.ndarray]:
        balance = Balance(self.remainder, len(self.remainder.error))
        s, v = balance.stretch(balance.linear(2 * np.pi * hz), 2 * np.pi * hz)
        return s[:, self.row], v[:, self.row]

    def _swing(self, s: np.ndarray, v: np.ndarray) -> float:
        stiffness, damper = self.remainder.stiffness, self.remainder.damper
        return float(np.ptp(stiffness[self.row, self.row] * s + damper[self.row, self.row] * v) / 2)

    def _released(self, s: np.ndarray) -> float:
        """Return the largest force that a linear motion takes off the teeth, N; a damper has no
        part in it.
        """
        return float(self.remainder.stiffness[self.row, self.row] * (s.mean() - s.min()))

    @cached_property
    def linear(self) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies and dynamic mesh force of the same train without backlash."""
        return self._unbounded[0], np.array([self._swing(s, v) for s, v in self._unbounded[1]])

    @property
    def returns(self) -> float | None:
        """Highest frequency of a branch that leaves the range where it began, Hz."""
        hz = self.frequency_hz
        return float(hz.max()) if np.isclose(hz[0], hz[-1], rtol=1e-9) else None

    @cached_property
    def _loudest_point(self) -> int:
        """Number of the point with the largest dynamic mesh force of stable motions."""
        return int(np.where(self.stable, self.force, 0.0).argmax())

    @cached_property
    def loudest(self) -> Largest:
        """The largest dynamic mesh force of stable motions."""
        k = self._loudest_point
        force = float(self.force[k]) if self.stable[k] else 0.0
        return Largest(float(self.frequency_hz[k]), force)

    @property
    def worst(self) -> Backlash:
        """The branch, this one or those apart, with the largest force."""
        return max((self, *self.branches_apart), key=lambda branch: branch.loudest.force)

    @property
    def calm(self) -> Range | None:
        """Range from the lowest to the highest frequency of stable motions; None where there are
        none.
        """
        hz = self.frequency_hz[self.stable]
        return range_of(hz) if len(hz) else None

    @cached_property
    def departs(self) -> float:
        """Distance of a period in time where the force is largest, relative to the swing of the
        teeth.
        """
        return departure(self.points[self._loudest_point])

    def motions_at(self, omega: float) -> list[Point]:
        """Return motions of this branch and those apart at a frequency of the driven mesh, rad/s."""
        branches = (self, *self.branches_apart)
        return [point for branch in branches for point in branch.branch.at(omega / branch.periods)]

    @cached_property
    def linear_loudest(self) -> Largest:
        """The largest force of the linear answer."""
        hz, size = self.linear
        return Largest(float(hz[size.argmax()]), float(size.max()))

    @cached_property
    def holding(self) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies, and the mean force of the mesh that drives the train below which teeth of
        some mesh part, all mean forces in the ratio of the torques.
        """
        gapped = [mesh for mesh in self.meshes if mesh.teeth.half_gap > 0] or [self]
        sizes = [
            [mesh._released(wave) / mesh.teeth.mean_force for wave, _ in mesh._unbounded[1]]
            for mesh in gapped
        ]
        return self.linear[0], self.teeth.mean_force * np.max(sizes, axis=0)

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """Turning points, in order."""
        return tuple(
            Jump(
                frequency_hz=float(self.frequency_hz[k]),
                rising=bool(self.points[k - 1].tangent[-1] > 0),
                force=float(self.force[k]),
            )
            for k in self.branch.turning
        )

    @cached_property
    def lost(self) -> tuple[Range, ...]:
        """Frequencies at which the teeth part for some of the cycle; nowhere without a gap."""
        half = self.teeth.half_gap
        if half == 0:
            return ()
        parted = self.driving < 1
        ends = self.branch.crossings(lambda p: float(p.along(self.law).min()) - half)
        return _ranges(self.frequency_hz, parted, [p.omega / (2 * np.pi) for p in ends])

    @cached_property
    def both_flanks(self) -> tuple[Range, ...]:
        """Frequencies at which the other flank touches as well."""
        return _ranges(self.frequency_hz, self.backside > 0)

    @cached_property
    def wandering(self) -> tuple[tuple[str, Range], ...]:
        """Frequencies of unstable periodic motions not between turning points, each with the kind
        of instability.
        """
        loose, turns = ~self.stable, np.abs(self.multiplier.imag)
        doubles = (turns <= REAL) & (self.multiplier.real < 0)
        kinds = {
            "a second frequency": loose & (turns > REAL),
            "a motion of two mesh periods": loose & doubles,
        }
        return tuple(
            (kind, span)
            for kind, mask in kinds.items()
            for span in _ranges(self.frequency_hz, mask)
        )

    def linear_errors(self, decibels: float) -> tuple[tuple[Range, float], ...]:
        """Return the ranges in which the linear answer is wrong by more than some decibels, and the
        largest error in each; too high is positive.
        """
        waves = [self._linear(hz) for hz in self.frequency_hz]
        size = np.array([self._swing(s, v) for s, v in waves])
        error = 20 * np.log10(size / self.force)
        far = self.stable & (np.abs(error) > decibels)
        out = []
        for span in _ranges(self.frequency_hz, far):
            inside = far & (self.frequency_hz >= span.low) & (self.frequency_hz <= span.high)
            out.append((span, float(error[inside][np.abs(error[inside]).argmax()])))
        return tuple(out)

    def spectrum(self) -> np.ndarray:
        """Return the (o,) amplitudes of the mesh force by orders of the mesh from 1, where it is
        largest, N.
        """
        k = self._loudest_point
        wave = self._waves[k]
        return 2 * np.abs(np.fft.rfft(wave))[1 : self.points[k].balance.count + 1] / len(wave)


def runs_of(mask: np.ndarray) -> np.ndarray:
    """Return (n, 2) first and after the last of each run of True."""
    return np.flatnonzero(np.diff(np.r_[False, mask, False].astype(int))).reshape(-1, 2)


def _ranges(hz: np.ndarray, inside: np.ndarray, ends: Sequence[float] = ()) -> tuple[Range, ...]:
    """Return ranges of neighbours that are inside, widened to the ends found between points,
    overlapping ones merged.
    """
    ranges = []
    for first, last in runs_of(inside):
        values = hz[first:last].tolist()
        for k in (first, last):
            if 0 < k < len(hz):
                neighbours = sorted((hz[k - 1], hz[k]))
                values += [end for end in ends if neighbours[0] <= end <= neighbours[1]]
        ranges.append(Range(float(min(values)), float(max(values))))
    out: list[Range] = []
    for span in sorted(ranges, key=lambda r: r.low):
        if out and span.low <= out[-1].high:
            out[-1] = Range(out[-1].low, max(span.high, out[-1].high))
        else:
            out.append(span)
    return tuple(out)
