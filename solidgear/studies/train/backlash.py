"""Teeth with backlash over speed: what a branch of periodic motions says of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from solidgear.nonlinear.apart import Search
from solidgear.nonlinear.balance import Balance
from solidgear.nonlinear.continuation import Branch, Point
from solidgear.nonlinear.model import Remainder
from solidgear.nonlinear.motion import departure
from solidgear.nonlinear.stability import ON
from solidgear.studies.train.shaft import told_mix

#: points at which the linear answer is told
LINEAR = 1500
#: imaginary part of a multiplier that is rounding
REAL = 1e-6


@dataclass(frozen=True)
class Teeth:
    """Teeth of a train, beside their stiffness."""

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
    def every(self) -> tuple[Teeth, ...]:
        """These, and those of the other meshes."""
        return (self, *self.others)

    @property
    def harmonics(self) -> tuple[complex, ...]:
        """Transmission error by orders, ``Re(e exp(i n x angle))``, m."""
        phases = self.phases or (0.0,) * len(self.errors)
        return tuple(complex(e * np.exp(1j * p)) for e, p in zip(self.errors, phases))

    @property
    def varies(self) -> bool:
        """True if the mesh varies over its cycle, and the linear answer with constant teeth with it."""
        return self.turns or bool(self.cycle)


@dataclass(frozen=True)
class Range:
    """Frequencies from one to another, Hz."""

    low: float
    high: float


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
    """Periodic motion of a train by models of its shafts, over frequency, told of one mesh."""

    models: dict[str, str]  #: by shaft
    teeth: Teeth
    remainder: Remainder = field(repr=False)
    branch: Branch = field(repr=False)  #: in order; more than one point may lie at one frequency
    multiplier: np.ndarray = field(repr=False)
    seconds: float  #: processor time, of the branch and its stability
    #: number of the law whose mesh is told: 0 for that whose transmission error drives the train
    law: int = 0
    periods: int = 1  #: of the driven mesh after which motions repeat themselves
    end: str = ""  #: of a branch apart, as :class:`solidgear.nonlinear.apart.SeparateBranch` says
    #: for branches apart; None where they were not looked for
    search: Search | None = field(default=None, repr=False)
    apart: tuple[Backlash, ...] = ()  #: those that were found

    @property
    def label(self) -> str:
        """Of all models."""
        first, *others = self.models.values()
        if any(one != first for one in others):
            return told_mix(self.models)
        count = len(self.models)
        return f"{'both' if count == 2 else f'all {count}'} {first}"

    @cached_property
    def every(self) -> tuple[Backlash, ...]:
        """The same told of each mesh with a law, that which drives the train first."""
        others = enumerate(self.teeth.others, start=1)
        return (self, *(self._told_of(teeth, k) for k, teeth in others))

    def _told_of(self, teeth: Teeth, law: int) -> Backlash:
        apart = tuple(one._told_of(teeth, law) for one in self.apart)
        return replace(self, teeth=teeth, law=law, apart=apart)

    @property
    def row(self) -> int:
        """Of the stretch of this mesh."""
        return self.remainder.laws[self.law][1].start

    @property
    def points(self) -> tuple[Point, ...]:
        """Of the branch."""
        return self.branch.points

    @cached_property
    def frequency_hz(self) -> np.ndarray:
        """(p,) mesh frequency."""
        return self.periods * self.branch.omega / (2 * np.pi)

    @cached_property
    def _waves(self) -> list[np.ndarray]:
        return [point.forces()[:, self.row] for point in self.points]

    @cached_property
    def stretch(self) -> list[np.ndarray]:
        """Of the teeth over a cycle, at every point, m."""
        return [point.along(self.law) for point in self.points]

    @cached_property
    def force(self) -> np.ndarray:
        """(p,) dynamic mesh force: half of its swing over a cycle, N."""
        return np.array([np.ptp(wave) / 2 for wave in self._waves])

    @cached_property
    def highest(self) -> np.ndarray:
        """(p,) largest mesh force, mean included, N."""
        return np.array([wave.max() for wave in self._waves])

    @cached_property
    def driving(self) -> np.ndarray:
        """(p,) share of the cycle in which the flank that carries the mean touches."""
        return np.array([np.mean(s > self.teeth.half_gap) for s in self.stretch])

    @cached_property
    def backside(self) -> np.ndarray:
        """(p,) share of the cycle in which the other flank touches."""
        return np.array([np.mean(s < -self.teeth.half_gap) for s in self.stretch])

    @cached_property
    def stable(self) -> np.ndarray:
        """(p,) bool."""
        return np.abs(self.multiplier) <= 1 + ON

    def over(self, hz: np.ndarray, values: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Mask of the frequencies (n,) that lie between two stable neighbours of the branch, and what
        values of its points (p,) are there; once for every such pair.
        """
        own, good = self.frequency_hz, self.stable
        for a, b in zip(range(len(own) - 1), range(1, len(own))):
            low, high = sorted((own[a], own[b]))
            at = np.flatnonzero((hz >= low) & (hz <= high))
            if good[a] and good[b] and low < high and len(at):
                share = (hz[at] - own[a]) / (own[b] - own[a])
                yield at, values[a] + share * (values[b] - values[a])

    @cached_property
    def _unbounded(self) -> tuple[np.ndarray, list[tuple[np.ndarray, np.ndarray]]]:
        """Frequencies, and stretches and rates there of the same train without backlash."""
        ends = self.frequency_hz.min(), self.frequency_hz.max()
        hz = np.concatenate([np.geomspace(*ends, LINEAR), self.remainder.omega / (2 * np.pi)])
        hz = np.unique(hz[(hz >= ends[0]) & (hz <= ends[1])])
        return hz, [self._linear(f) for f in hz]

    def _linear(self, hz: float) -> tuple[np.ndarray, np.ndarray]:
        balance = Balance(self.remainder, len(self.remainder.error))
        s, v = balance.stretch(balance.linear(2 * np.pi * hz), 2 * np.pi * hz)
        return s[:, self.row], v[:, self.row]

    def _swing(self, s: np.ndarray, v: np.ndarray) -> float:
        stiffness, damper = self.remainder.stiffness, self.remainder.damper
        return float(np.ptp(stiffness[self.row, self.row] * s + damper[self.row, self.row] * v) / 2)

    def _released(self, s: np.ndarray) -> float:
        """Largest force that a linear motion takes off the teeth, N; a damper has no part in it."""
        return float(self.remainder.stiffness[self.row, self.row] * (s.mean() - s.min()))

    @cached_property
    def linear(self) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies and dynamic mesh force of the same train without backlash."""
        return self._unbounded[0], np.array([self._swing(*one) for one in self._unbounded[1]])

    @property
    def returns(self) -> float | None:
        """Highest frequency of a branch that leaves the range where it began, Hz."""
        hz = self.frequency_hz
        return float(hz.max()) if np.isclose(hz[0], hz[-1], rtol=1e-9) else None

    @cached_property
    def loudest(self) -> tuple[float, float]:
        """Frequency and size of the largest dynamic mesh force of its stable motions."""
        size = np.where(self.stable, self.force, 0.0)
        return float(self.frequency_hz[size.argmax()]), float(size.max())

    @property
    def worst(self) -> Backlash:
        """That of this branch and those apart which has the largest force."""
        return max((self, *self.apart), key=lambda one: one.loudest[1])

    @property
    def calm(self) -> Range | None:
        """From the lowest to the highest frequency of stable motions; None where there are none."""
        hz = self.frequency_hz[self.stable]
        return Range(float(hz.min()), float(hz.max())) if len(hz) else None

    @cached_property
    def departs(self) -> float:
        """Distance of a period in time where its force is largest, of the swing of the teeth."""
        return departure(self.points[int(np.where(self.stable, self.force, 0.0).argmax())])

    def along(self, omega: float) -> list[Point]:
        """Motions of this branch and those apart at a frequency of the driven mesh, rad/s."""
        every = (self, *self.apart)
        return [point for one in every for point in one.branch.at(omega / one.periods)]

    @cached_property
    def linear_loudest(self) -> tuple[float, float]:
        """The same of the linear answer."""
        hz, size = self.linear
        return float(hz[size.argmax()]), float(size.max())

    @cached_property
    def holding(self) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies, and the mean force of the mesh that drives the train below which teeth of some
        mesh part, all mean forces in the ratio of the torques.
        """
        apart = [one for one in self.every if one.teeth.half_gap > 0] or [self]
        sizes = [
            [one._released(wave) / one.teeth.mean_force for wave, _ in one._unbounded[1]]
            for one in apart
        ]
        return self.linear[0], self.teeth.mean_force * np.max(sizes, axis=0)

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """Turning points, in order."""
        out = []
        for k in self.branch.turning:
            rising = bool(self.branch.points[k - 1].tangent[-1] > 0)
            out.append(Jump(float(self.frequency_hz[k]), rising, float(self.force[k])))
        return tuple(out)

    @cached_property
    def lost(self) -> tuple[Range, ...]:
        """Frequencies at which the teeth part for some of the cycle; nowhere without a gap."""
        half = self.teeth.half_gap
        if half == 0:
            return ()
        gone = self.driving < 1
        ends = self.branch.crossings(lambda p: float(p.along(self.law).min()) - half)
        return _ranges(self.frequency_hz, gone, [p.omega / (2 * np.pi) for p in ends])

    @cached_property
    def both_flanks(self) -> tuple[Range, ...]:
        """Frequencies at which the other flank touches as well."""
        return _ranges(self.frequency_hz, self.backside > 0, [])

    @cached_property
    def wandering(self) -> tuple[tuple[str, Range], ...]:
        """Frequencies of unstable periodic motions not between turning points, and how."""
        kinds = np.full(len(self.points), "", dtype=object)
        loose = ~self.stable
        kinds[loose & (np.abs(self.multiplier.imag) > REAL)] = "a second frequency"
        real = loose & (np.abs(self.multiplier.imag) <= REAL)
        kinds[real & (self.multiplier.real < 0)] = "a motion of two mesh periods"
        found = {
            kind: kinds == kind for kind in ("a second frequency", "a motion of two mesh periods")
        }
        return tuple(
            (kind, one)
            for kind, where in found.items()
            for one in _ranges(self.frequency_hz, where, [])
        )

    def off(self, decibels: float) -> tuple[tuple[Range, float], ...]:
        """Frequencies at which the linear answer is off by some decibels, and how much at most;
        above is positive.
        """
        size = np.array([self._swing(*self._linear(f)) for f in self.frequency_hz])
        error = 20 * np.log10(size / self.force)
        far = self.stable & (np.abs(error) > decibels)
        out = []
        for one in _ranges(self.frequency_hz, far, []):
            inside = far & (self.frequency_hz >= one.low) & (self.frequency_hz <= one.high)
            out.append((one, float(error[inside][np.abs(error[inside]).argmax()])))
        return tuple(out)

    def spectrum(self) -> np.ndarray:
        """(o,) amplitudes of the mesh force by orders of the mesh from 1, where it is largest, N."""
        k = int(np.where(self.stable, self.force, 0.0).argmax())
        wave = self._waves[k]
        return 2 * np.abs(np.fft.rfft(wave))[1 : self.points[k].balance.count + 1] / len(wave)


def _ranges(hz: np.ndarray, inside: np.ndarray, ends: Sequence[float]) -> tuple[Range, ...]:
    """Ranges of neighbours that are inside, widened to the ends found between points, those that
    overlap as one.
    """
    found = []
    edges = np.flatnonzero(np.diff(np.r_[False, inside, False].astype(int)))
    for first, after in edges.reshape(-1, 2):
        own = hz[first:after].tolist()
        for k in (first, after):
            if 0 < k < len(hz):
                beside = sorted((hz[k - 1], hz[k]))
                own += [end for end in ends if beside[0] <= end <= beside[1]]
        found.append(Range(float(min(own)), float(max(own))))
    out: list[Range] = []
    for one in sorted(found, key=lambda r: r.low):
        if out and one.low <= out[-1].high:
            out[-1] = Range(out[-1].low, max(one.high, out[-1].high))
        else:
            out.append(one)
    return tuple(out)
