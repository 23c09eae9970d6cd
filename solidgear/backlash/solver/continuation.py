r"""Branches of periodic motion over speed, through turning points, by pseudo-arclength.

A step is a tangent of the branch and Newton's method across it. Along one branch the determinant of
the Jacobian bordered by the tangent keeps the sign (Allgower and Georg 2003, chapter 2): a step
after which it differs has turned back on itself, or leapt to another branch, and is halved. A
branch is complete when it leaves the range of speeds; it may leave where it began only with another
motion than it began with, or it has gone back the way it came.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from solidgear.backlash.solver.balance import ITERATIONS, Balance, as_complex
from solidgear.backlash.solver.model import Remainder
from solidgear.core import SolidgearError, pinned

#: change of a trial motion, relative, that ends Newton's method across a step
CLOSE = 1e-9
#: iterations that a good step takes, and cosine of the angle of tangents at most
EASY, STRAIGHT = 4, 0.9
#: steps: shortest relative to longest; how a step grows
SHORTEST, GROWTH = 1e-6, 1.4
#: times that steps are halved for a branch that came back the way it went
SHORTER = 6
#: points of a branch at most
MOST_POINTS = 5_000
#: the highest harmonics over the largest above which there are more, and far below which fewer
TAIL, SHORT_TAIL = 1e-4, 1e-7
LEAST_HARMONICS, MOST_HARMONICS = 3, 25
#: how near a place within a step is found, of its length, and looks that may take
NEAR, LOOKS = 1e-7, 40
#: motions that differ by less, relative, are the same
SAME = 1e-6


@dataclass(frozen=True, eq=False)
class Point:
    """Periodic motion."""

    omega: float  #: of the excitation, rad/s
    motion: np.ndarray = field(repr=False)  #: (n,) coefficients of the balance
    balance: Balance = field(repr=False)
    #: (n + 1,) of the branch, in scaled unknowns; its last entry is that of the speed
    tangent: np.ndarray = field(repr=False)
    sign: float  #: of the bordered determinant; 0 where branches cross

    @property
    def harmonics(self) -> np.ndarray:
        """Return the complex harmonics (H+1, m) of the stretches."""
        return as_complex(self.motion.reshape(-1, self.balance.remainder.rows))

    def waves(self) -> tuple[np.ndarray, np.ndarray]:
        """Return stretches and rates (T, m) over a period."""
        return self.balance.stretch(self.motion, self.omega)

    @property
    def rms(self) -> np.ndarray:
        """Return the root mean square (m,) of the stretches about their mean."""
        return np.sqrt((np.abs(self.harmonics[1:]) ** 2).sum(axis=0) / 2)

    def state(self) -> np.ndarray:
        """Return the modal state (2r,) ``(omega q, q')`` at the beginning of a period."""
        remainder, count = self.balance.remainder, self.balance.count
        excess, _ = remainder.excess(
            *self.waves(), self.balance.factor, self.balance.line(self.omega)
        )
        push = np.fft.rfft(excess.value, axis=0)[: count + 1] / len(excess.value)
        push[1:] *= 2
        n = 1j * self.omega * np.arange(count + 1)
        orders = min(count, len(remainder.error))
        error = remainder.error[:orders]
        push[1 : orders + 1] += error @ remainder.stiffness + n[1 : orders + 1, None] * (
            error @ remainder.drag
        )
        stiff = np.diag(remainder.omega**2) + n[:, None, None] * remainder.losses
        stiff = stiff + n[:, None, None] ** 2 * np.eye(len(remainder.omega))
        modal = push @ remainder.shapes
        modal[1 : orders + 1] += remainder.growth(self.omega) * remainder.push[:orders]
        q = np.linalg.solve(stiff, modal[..., None])[..., 0]
        return np.concatenate(
            [remainder.omega * q.sum(axis=0).real, (n[:, None] * q).sum(axis=0).real]
        )

    def forces(self) -> np.ndarray:
        """Return forces (T, m) of the laws over a period, those of their dampers among them."""
        remainder, line = self.balance.remainder, self.balance.line(self.omega)
        return remainder.forces(*self.waves(), self.balance.factor, line).value

    def along(self, law: int = 0) -> np.ndarray:
        """Return the stretch (T,) over a period of a link with a law, along the line of action."""
        line, rows = self.balance.line(self.omega), self.balance.remainder.laws[law][1]
        if line is not None and rows in line.links:
            return line.along(rows, self.waves()[0])
        return self.waves()[0][:, rows.start]


@dataclass(frozen=True, eq=False)
class Branch:
    """Points in order, and which of them turn."""

    points: tuple[Point, ...]  #: turning points among them
    turning: tuple[int, ...]  #: where the speed turns round
    #: of motions and of speeds, in tangents and steps
    scale: tuple[float, float] = field(repr=False)

    @property
    def omega(self) -> np.ndarray:
        """Return the frequencies (p,), rad/s."""
        return np.array([point.omega for point in self.points])

    def at(self, omega: float) -> list[Point]:
        """Return all motions of the branch at a speed, rad/s, in order."""
        out = []
        for before, after in zip(self.points, self.points[1:]):
            low, high = sorted((before.omega, after.omega))
            if low <= omega < high or (omega == high and after is self.points[-1]):
                out.append(self._sign_change(before, after, lambda point: point.omega - omega))
        return out

    def crossings(self, value: Callable[[Point], float]) -> list[Point]:
        """Return motions at which a value of a motion changes sign, in order."""
        out = []
        values = [value(point) for point in self.points]
        for k, (before, after) in enumerate(zip(values, values[1:])):
            if before * after < 0:
                out.append(self._sign_change(self.points[k], self.points[k + 1], value))
        return out

    def _sign_change(self, before: Point, after: Point, value: Callable[[Point], float]) -> Point:
        """Return the motion between two neighbours at which a value changes sign."""
        walk = Follower(before.balance, *self.scale)
        if after.balance.count > before.balance.count:
            before = walk.refit(before, after.balance.count)
        end = after.balance.resized(after.motion, before.balance.count)[1]
        away = np.append(
            (end - before.motion) / walk.size, (after.omega - before.omega) / walk.width
        )
        crossing = walk.sign_change(before, float(away @ before.tangent), value)
        return before if crossing is None else crossing


class Follower:
    """Walk along a branch, of motions of so many periods of the excitation."""

    def __init__(self, balance: Balance, size: float, width: float, periods: int = 1):
        self.balance, self.size, self.width, self.periods = balance, size, width, periods

    def bordered(self, residual, row: np.ndarray) -> np.ndarray:
        n = len(residual.value)
        out = np.empty((n + 1, n + 1))
        out[:n, :n] = residual.jacobian
        out[:n, n] = residual.by_omega * self.width / self.size
        out[n] = row
        return out

    def point(self, motion: np.ndarray, omega: float, along: np.ndarray, residual=None) -> Point:
        """Return a converged motion with the tangent, on the side of `along`."""
        residual = residual or self.balance.residual(motion, omega)
        matrix = self.bordered(residual, along)
        right = np.zeros(len(along))
        right[-1] = 1.0
        tangent = np.linalg.solve(matrix, right)
        tangent /= np.linalg.norm(tangent)
        sign = float(np.linalg.slogdet(self.bordered(residual, tangent))[0])
        return Point(omega, motion, self.balance, tangent, sign)

    def correct(self, from_: Point, step: float) -> tuple[Point, int] | None:
        """Return the point a step further, and the iterations it took; None where it fails."""
        motion = from_.motion + step * self.size * from_.tangent[:-1]
        omega = from_.omega + step * self.width * from_.tangent[-1]
        for iteration in range(1, ITERATIONS + 1):
            if not omega > 0:
                return None
            residual = self.balance.residual(motion, omega)
            if not residual.carries:  # singular: back off
                return None
            right = np.append(-residual.value / self.size, 0.0)
            try:
                change = np.linalg.solve(self.bordered(residual, from_.tangent), right)
            except np.linalg.LinAlgError:
                return None
            motion = motion + self.size * change[:-1]
            omega = omega + self.width * change[-1]
            if np.abs(change).max() <= CLOSE:
                return self.point(motion, omega, from_.tangent, residual), iteration
        return None

    def refit(self, point: Point, count: int) -> Point:
        """Return the same point with another number of harmonics."""
        balance, motion = point.balance.resized(point.motion, count)
        self.balance = balance
        along = np.append(balance.resized(point.tangent[:-1], count)[1], point.tangent[-1])
        along /= np.linalg.norm(along)
        try:
            return self.point(balance.solve(motion, point.omega), point.omega, along)
        except SolidgearError:
            # beside a turning point more harmonics may have no motion at this speed
            near = replace(point, motion=motion, balance=balance, tangent=along)
            corrected = self.correct(near, 0.0)
            if corrected is None:
                raise
            return corrected[0]

    def sign_change(
        self, before: Point, step: float, value: Callable[[Point], float]
    ) -> Point | None:
        """Return the point at which a value changes sign within a step, by Illinois' method;
        None if none can be located.
        """
        corrected = self.correct(before, step)
        if corrected is None:
            return None
        low, high, out = (0.0, value(before)), (step, value(corrected[0])), corrected[0]
        if low[1] * high[1] > 0:
            return None
        for _ in range(LOOKS):
            if high[1] == 0 or abs(high[0] - low[0]) <= NEAR * abs(step):
                break
            middle = high[0] - high[1] * (high[0] - low[0]) / (high[1] - low[1])
            corrected = self.correct(before, middle)
            if corrected is None:
                return None
            out, new = corrected[0], value(corrected[0])
            low = (low[0], low[1] / 2) if new * high[1] > 0 else high
            high = (middle, new)
        return out


@pinned
def follow(
    remainder: Remainder,
    begin: float,
    end: float,
    *,
    harmonics: int | None = None,
    step: float = 0.05,
) -> Branch:
    """Return the branch of periodic motions between two frequencies of the excitation, rad/s,
    either one the larger, by the method of Allgower and Georg (2003), Introduction to Numerical
    Continuation Methods, chapters 2 and 6.

    The number of harmonics is fixed, or as many as the decay of the highest requires; `step` is the
    longest, in shares of the range of speeds and of the largest linear motion. A range that holds
    zero, and a branch that comes back the way it went or does not end, are refused.

    Examples
    --------
    >>> from solidgear.core.system import Inertia, RowSpring, System
    >>> from solidgear.backlash.solver.model import remainder
    >>> from solidgear.core.system.law import Gap
    >>> teeth = RowSpring("gear", [0, 0, 1, 0, 0, 0], 1.0, law=Gap(1.0, 1.0))
    >>> pair = System({"gear": Inertia(1.0, "z")}, {"mesh": teeth})
    >>> losses = dict(loss={"mesh": 0.1}, kind="viscous", matched_hz=1 / (2 * np.pi))
    >>> found = remainder(pair, load=np.array([0.1]), errors={"mesh": [0.05]}, **losses)
    >>> branch = follow(found, 0.5, 1.3)
    >>> [round(float(branch.points[k].omega), 3) for k in branch.turning]
    [0.828, 0.708]
    """
    if not (begin > 0 and end > 0 and begin != end and np.isfinite([begin, end]).all()):
        raise SolidgearError(
            f"speeds from {begin:g} to {end:g} rad/s; give two different ones above zero"
        )
    count = harmonics or LEAST_HARMONICS
    for _ in range(SHORTER):
        branch = _followed(remainder, begin, end, count, harmonics is None, step)
        if branch is not None:
            return branch
        step /= 2
    raise SolidgearError(
        f"the branch from {begin:g} rad/s turns back on itself at the shortest steps"
    )


def _begun(remainder: Remainder, count: int, omega: float) -> tuple[Balance, np.ndarray]:
    """Return the motion at the first speed: the linear one where it is sound, else grown with the
    excitation.
    """
    balance = Balance(remainder, count)
    motion = balance.start(omega)
    try:
        return balance, balance.solve(motion, omega)
    except (SolidgearError, np.linalg.LinAlgError):
        pass
    motion = Balance(remainder.scaled(0.0), count).start(omega)
    for share in np.linspace(0.05, 1.0, 20):
        motion = Balance(remainder.scaled(float(share)), count).solve(motion, omega)
    return balance, motion


def _followed(remainder, begin, end, count, adaptive, longest) -> Branch | None:
    """Return the branch, or None where it came back the way it went."""
    balance, motion = _begun(remainder, count, begin)
    low, high = min(begin, end), max(begin, end)
    grid = np.linspace(low, high, 200)
    size = max(float(np.abs(balance.linear(w)[remainder.rows :]).max()) for w in grid)
    # a linear peak is far above the real one with a gap
    gaps = [edge for law, _ in remainder.laws for edge in law.edges]
    size = min(size, max([abs(e) for e in gaps if e], default=size))
    walk = Follower(balance, size or 1.0, high - low)
    ahead = np.zeros(motion.size + 1)
    ahead[-1] = np.sign(end - begin)
    first = walk.point(motion, begin, ahead)
    points, turning = walked(walk, first, longest, adaptive, lambda p: not low <= p.omega <= high)
    cut(points, walk, low, high)
    if points[-1].omega == begin:
        end, start = points[-1].motion, first.balance.resized(first.motion, walk.balance.count)[1]
        if np.abs(end - start).max() <= SAME * np.abs(start).max():
            return None
    return Branch(tuple(points), tuple(turning), (walk.size, walk.width))


def walked(
    walk: Follower,
    first: Point,
    longest: float,
    adaptive: bool,
    ended: Callable[[Point], bool],
) -> tuple[list[Point], list[int]]:
    """Return the points of a branch from the first one until one ends it, and which of them turn."""
    points, turning = [first], []
    step = longest / 4
    while len(points) < MOST_POINTS:
        last = points[-1]
        if adaptive:
            last = points[-1] = fitted(walk, last)
        correction = walk.correct(last, step)
        if correction is None or not _sound(last, correction[0]):
            step /= 2
            if step < SHORTEST * longest:
                raise SolidgearError(
                    f"the branch cannot be followed beyond {last.omega:g} rad/s; "
                    "two branches may cross there"
                )
            continue
        new, iterations = correction
        if last.tangent[-1] * new.tangent[-1] < 0:
            turn = walk.sign_change(last, step, lambda p: p.tangent[-1])
            if turn is not None:
                turning.append(len(points))
                points.append(turn)
        points.append(new)
        if ended(new):
            return points, turning
        if iterations <= EASY:
            step = min(step * GROWTH, longest)
    raise SolidgearError(f"the branch has no end after {MOST_POINTS} points")


def _sound(last: Point, new: Point) -> bool:
    """Return whether a step followed the branch: little bent, on the same side of it, and no leap."""
    return bool(last.sign in (0.0, new.sign) and new.tangent @ last.tangent > STRAIGHT)


def fitted(walk: Follower, point: Point) -> Point:
    """Return the point with as many harmonics as the highest need."""
    count = point.balance.count
    tail = point.balance.tail(point.motion)
    while tail > TAIL and count < MOST_HARMONICS * walk.periods:
        count = count + 2
        point = walk.refit(point, count)
        tail = point.balance.tail(point.motion)
    return point


def cut(points: list[Point], walk: Follower, low: float, high: float) -> None:
    """Move the last point, which is beyond the range, to the end."""
    last, before = points[-1], points[-2]
    edge = low if last.omega < low else high
    share = (edge - before.omega) / (last.omega - before.omega)
    motion = before.motion + share * (last.motion - before.motion)
    points[-1] = walk.point(walk.balance.solve(motion, edge), edge, last.tangent)
