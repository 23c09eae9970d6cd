r"""Branches apart from one that was followed: isolas, and motions of two periods of the excitation.

Newton's method of the harmonic balance begins at motions of one order with many amplitudes and
phases, at some speeds. A motion that it arrives at and that lies on no branch known so far is
followed both ways, until it is back where it began, merges or leaves the range. It finds unstable
motions as well as stable ones: an isola is met anywhere between both ends, not just where it is
stable.

No number of starts shows that there are no others.  Motions of two periods that come off a branch
where the period doubles are followed from there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from solidgear.backlash.solver.balance import Balance, as_complex, as_real
from solidgear.backlash.solver.continuation import Branch, Follower, Point, cut, fitted, walked
from solidgear.backlash.solver.motion import departure
from solidgear.backlash.solver.stability import multipliers
from solidgear.core import SolidgearError, pinned

#: starts at a speed of one and of two periods, orders of the excitation that they balance, and steps
#: of Newton's method that they may take
STARTS, SEEDED, STEPS = {1: 16, 2: 8, 3: 8}, 5, 8
#: amplitudes of starts, of the gap and the penetration by the mean force, and above which a
#: trial is given up
AMPLITUDES, FAR = (0.4, 1.6), 30.0
#: shares of 1 by which amplitudes and phases of starts advance: evenly spread, whatever their number
SPREAD = (0.7548776662466927, 0.5698402909980532)
#: relative changes that end Newton's method, and that separate motions of one balance, and of two
CLOSE, APART, OTHER = 1e-9, 1e-5, 1e-2
#: half orders over the scale of motions below which two periods are one, and the first step away from
#: where a period doubles
MERGED, AWAY = 1e-3, 0.01
#: of the swing, how far off a period in time may be of a motion that is believed
BELIEVED = 1e-2


@dataclass(frozen=True, eq=False)
class SeparateBranch:
    """Branch that hangs together with none known before."""

    branch: Branch = field(repr=False)
    #: of the excitation after which motions repeat themselves; the branch has their frequencies
    periods: int
    end: str  #: back where it began, cut by the range of speeds, or of one period again


@dataclass(frozen=True, eq=False)
class Search:
    """Search for branches apart: starts, and motions found."""

    omega: np.ndarray = field(repr=False)  #: (n,) speeds of starts, rad/s
    starts: int  #: at all of them
    branches: tuple[SeparateBranch, ...]
    lost: tuple[float, ...] = ()  #: speeds of further motions that could not be followed, rad/s


@pinned
def search(branch: Branch, omegas: Sequence[float], step: float = 0.02) -> Search:
    """Return motions that are on no branch, from many starts at some speeds, each followed; speeds
    are in rad/s, within the range of the known branch, and `step` is the longest of
    :func:`solidgear.backlash.solver.continuation.follow`.
    """
    remainder = branch.points[0].balance.remainder
    ends = float(branch.omega.min()), float(branch.omega.max())
    branches: list[SeparateBranch] = []
    lost: list[float] = []
    count = 0
    for periods, starts in STARTS.items():
        excited = remainder if periods == 1 else remainder.slower(periods)
        balance = Balance(excited, SEEDED * periods)
        size, width = branch.scale
        for number, omega in enumerate(omegas):
            walk = Follower(balance, size, width / periods, periods)
            known_branches = [
                branch,
                *(separate.branch for separate in branches if separate.periods == 1),
            ]
            if periods > 1:
                known_branches = [
                    separate.branch for separate in branches if separate.periods == periods
                ]
            met = [
                m
                for followed in known_branches
                for m in _across(followed, omega / periods, balance)
            ]
            for seed in _seeds(balance, omega / periods, periods, number * starts, starts):
                count += 1
                motion = _arrived(balance, seed, omega / periods)
                if motion is None or any(_agree(motion, m, walk, APART) for m in met):
                    continue
                met.append(motion)
                if periods > 1 and _parts(motion, excited.rows, periods) < MERGED * size:
                    continue
                try:
                    separate = _followed(
                        Follower(balance, size, width / periods, periods),
                        motion,
                        omega / periods,
                        known_branches,
                        step,
                        ends,
                    )
                except (SolidgearError, np.linalg.LinAlgError):
                    lost.append(float(omega))
                    continue
                if separate is not None:
                    branches.append(separate)
                    known_branches.append(separate.branch)
                    met += _across(separate.branch, omega / periods, balance)
    return Search(np.array(omegas, float), count, tuple(branches), tuple(lost))


def flip(point: Point) -> float:
    """Return one plus the most negative real multiplier: below zero where the period doubles."""
    values = multipliers(point)
    real = values.real[np.abs(values.imag) < 1e-9 * np.abs(values[0]) + 1e-12]
    return 1.0 + float(real.min(initial=0.0))


@pinned
def period_doubled_branches(branch: Branch, step: float = 0.02) -> list[Branch]:
    """Return the motions of two periods, from every place of a branch at which the period doubles.

    Each branch ends where the motions have one period again, or at the end of the range;
    frequencies are those of two periods, half of the excitation. A branch that ends where another
    began is returned once.
    """
    out: list[Branch] = []
    met: list[float] = []
    for begin in branch.crossings(flip):
        if any(abs(begin.omega / end - 1) < MERGED for end in met):
            continue
        doubled = _doubled_branch(begin, branch, step)
        out.append(doubled)
        met.append(2 * doubled.points[-1].omega)
    return out


def _doubled_branch(begin: Point, branch: Branch, step: float) -> Branch:
    size, width = branch.scale
    m = begin.balance.remainder.rows
    remainder = begin.balance.remainder.slower(2)
    harmonics = np.zeros((2 * begin.balance.count + 1, m), complex)
    harmonics[::2] = begin.harmonics
    balance = Balance(remainder, 2 * begin.balance.count)
    motion = as_real(harmonics).ravel()
    residual = balance.residual(motion, begin.omega / 2)
    along = np.append(np.linalg.svd(residual.jacobian)[2][-1], 0.0)
    walk = Follower(balance, size, width / 2)
    first = Point(begin.omega / 2, motion, balance, along, 0.0)
    low, high = branch.omega.min() / 2, branch.omega.max() / 2

    def ended(point: Point) -> bool:
        return _parts(point.motion, m, 2) < MERGED * size or not low <= point.omega <= high

    near = walk.correct(first, AWAY)
    if near is None:
        raise SolidgearError(
            f"the motion of two periods at {begin.omega:g} rad/s cannot be followed"
        )
    points, turning = walked(walk, near[0], step, False, ended)
    return Branch((first, *points), tuple(k + 1 for k in turning), (size, width / 2))


def _followed(
    walk: Follower,
    motion: np.ndarray,
    omega: float,
    known_branches: Sequence[Branch],
    step: float,
    ends: tuple[float, float],
) -> SeparateBranch | None:
    """Return the branch through a motion; None where it is one of those known, or motion in time
    does not confirm it.
    """
    low, high = (end / walk.periods for end in ends)
    first = walk.point(motion, omega, np.append(np.zeros(motion.size), 1.0))
    first = fitted(walk, first)
    if _lies_on(first, known_branches, walk) or not departure(first) <= BELIEVED:
        return None
    ahead = _Way(first, walk, step, low, high)
    points, turning = walked(walk, first, step, True, ahead.ended)
    ahead.trim(points)
    if ahead.end != "closed":
        walk.balance = first.balance
        begin = _turned(first)
        back = _Way(begin, walk, step, low, high)
        points_back, turned = walked(walk, begin, step, True, back.ended)
        back.trim(points_back)
        count = len(points_back) - 1
        points = [_turned(point) for point in points_back[:0:-1]] + points
        turning = [count - k for k in reversed(turned)] + [count + k for k in turning]
    branch = Branch(tuple(points), tuple(turning), (walk.size, walk.width))
    middle = [branch.points[len(points) * k // 4] for k in (1, 2, 3)]
    if all(_lies_on(point, known_branches, walk) for point in middle):
        return None
    return SeparateBranch(branch, walk.periods, ahead.end)


def _turned(point: Point) -> Point:
    """Return the point with the branch run through the other way."""
    return replace(point, tangent=-point.tangent, sign=-point.sign)


class _Way:
    """One way along a branch, and why it ends."""

    def __init__(self, first: Point, walk: Follower, step: float, low: float, high: float):
        self.first, self.walk, self.step, self.low, self.high = first, walk, step, low, high
        self.end, self._before = "", 1.0

    def ended(self, point: Point) -> bool:
        """Return whether a point ends the way."""
        rows, size = point.balance.remainder.rows, self.walk.size
        if not self.low <= point.omega <= self.high:
            self.end = "range"
        elif (
            self.walk.periods > 1 and _parts(point.motion, rows, self.walk.periods) < MERGED * size
        ):
            self.end = "merged"
        else:
            _, begun = self.first.balance.resized(self.first.motion, point.balance.count)
            _, tangent = self.first.balance.resized(self.first.tangent[:-1], point.balance.count)
            away = (point.motion - begun) / size
            faster = (point.omega - self.first.omega) / self.walk.width
            along = float(away @ tangent + faster * self.first.tangent[-1])
            near = np.hypot(np.linalg.norm(away), faster) < 2 * self.step
            if near and self._before < 0 <= along:
                self.end = "closed"
            self._before = along
        return bool(self.end)

    def trim(self, points: list[Point]) -> None:
        """Put the last point where the way ends."""
        if self.end == "closed":
            points[-1] = self.first
        elif self.end == "range":
            cut(points, self.walk, self.low, self.high)


def _lies_on(point: Point, branches: Sequence[Branch], walk: Follower) -> bool:
    """Return whether a motion lies on one of some branches, whose truncation may differ."""
    for branch in branches:
        for neighbour in branch.at(point.omega):
            _, motion = neighbour.balance.resized(neighbour.motion, point.balance.count)
            if _agree(point.motion, motion, walk, OTHER):
                return True
    return False


def _seeds(
    balance: Balance, omega: float, periods: int, first: int, count: int
) -> Iterator[np.ndarray]:
    """Yield linear motions with another amplitude and phase of the slowest order of the driven
    link.
    """
    remainder = balance.remainder
    _, rows = remainder.laws[0]
    start = balance.start(omega).reshape(-1, remainder.rows)
    scale = abs(start[0, rows.start])
    low, high = AMPLITUDES
    for k in range(first, first + count):
        shares = [((k + 1) * advance) % 1.0 for advance in SPREAD]
        amplitude = scale * (low + (high - low) * shares[0])
        out = start.copy()
        out[1, rows.start] = amplitude * np.cos(2 * np.pi * shares[1])
        out[1 + balance.count, rows.start] = amplitude * np.sin(2 * np.pi * shares[1])
        yield out.ravel()


def _arrived(balance: Balance, motion: np.ndarray, omega: float) -> np.ndarray | None:
    """Return the motion at which a few steps of Newton's method arrive; None where they do not."""
    try:
        return balance.solve(motion, omega, steps=STEPS, close=CLOSE, far=FAR)
    except (SolidgearError, np.linalg.LinAlgError):
        return None


def _across(branch: Branch, omega: float, balance: Balance) -> list[np.ndarray]:
    """Return the motions of a branch at a speed, in another balance."""
    out = []
    for before, after in zip(branch.points, branch.points[1:]):
        low, high = sorted((before.omega, after.omega))
        if low <= omega <= high and low < high:
            share = (omega - before.omega) / (after.omega - before.omega)
            ends = [
                point.balance.resized(point.motion, balance.count)[1] for point in (before, after)
            ]
            motion = _arrived(balance, ends[0] + share * (ends[1] - ends[0]), omega)
            out += [] if motion is None else [motion]
    return out


def _agree(motion: np.ndarray, reference: np.ndarray, walk: Follower, tolerance: float) -> bool:
    """Return whether two motions differ by less than a tolerance, or are one begun periods apart."""
    rows = walk.balance.remainder.rows
    first, second = (as_complex(m.reshape(-1, rows)) for m in (motion, reference))
    turn = np.exp(2j * np.pi / walk.periods * np.arange(len(second)))[:, None]
    least = min(np.abs(first - second * turn**k).max() for k in range(walk.periods))
    return bool(least < tolerance * np.abs(second).max())


def _parts(motion: np.ndarray, rows: int, periods: int) -> float:
    """Return the size of the orders that a motion of one period has not."""
    size = np.abs(as_complex(motion.reshape(-1, rows))).max(axis=1)
    return float(size[np.arange(len(size)) % periods > 0].max())
