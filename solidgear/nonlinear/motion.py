r"""Periodic motion by time alone: exact between contacts, contacts located, steady state detected.
Curved laws, and those that vary over the cycle, are integrated to a tolerance.

Nothing of harmonic balance is used but the force laws and what is linear.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.machine.threads import pinned
from solidgear.nonlinear.continuation import Point
from solidgear.nonlinear.integrated import LOOKS, TOLERANCE, Integrated
from solidgear.nonlinear.model import Remainder
from solidgear.nonlinear.pieces import SHORT, TERMS, Piece, Pieces

#: what is left of a transient, relative, when a motion is steady
STEADY = 1e-5
#: periods of the excitation after which a motion is called unsteady, and that may make one of its own
MOST_PERIODS, LONGEST_CYCLE = 4_000, 8
#: periods over which changes must fade to be judged
FADING = 8
#: a change from period to period above which a motion of several periods is one, in tolerances
STILL_FADING = 100.0
#: changes that are no motion, of exact pieces
ROUNDING = 1e-12
#: Newton's steps that locate a crossing, and its rest relative to the gap
CROSSINGS, LOCATED = 30, 1e-13


@dataclass(frozen=True, eq=False)
class Steady:
    """A motion that no longer changes.

    Attributes
    ----------
    omega : float
        Of the excitation, rad/s.
    cycle : int
        Periods of the excitation after which it repeats itself; 0 where it never did.
    periods : int
        That it took.
    stretch, force : (t, m) ndarray
        Over its cycle, at equal intervals; forces with those of dampers.
    section : (p, 2) ndarray
        First stretch and its rate at the beginning of each of the last periods (Poincare).
    state : (2r,) ndarray
        At its end, where another speed can begin.
    """

    omega: float
    cycle: int
    periods: int
    stretch: np.ndarray
    force: np.ndarray
    section: np.ndarray
    state: np.ndarray

    @property
    def rms(self) -> np.ndarray:
        """(m,) root mean square of the stretches about their mean."""
        return self.stretch.std(axis=0)


class Run:
    """A remainder in time, at one frequency of the excitation."""

    def __init__(self, remainder: Remainder, omega: float):
        self.remainder, self.omega = remainder, omega
        self.pieces = Pieces(remainder, omega)
        size = self.piece(self.pieces.name(remainder.mean)).size
        self.looks = max(LOOKS, int(np.ceil(size / SHORT * 2 * np.pi / omega)))
        self.step = 2 * np.pi / omega / self.looks
        self._ahead: dict[tuple[int, ...], tuple[np.ndarray, np.ndarray]] = {}

    def piece(self, name: tuple[int, ...]) -> Piece:
        """The linear equation on some pieces."""
        return self.pieces.piece(name)

    def period(self, modal: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """State (2r,) a period later, and stretches and rates (looks, m) on the way."""
        y = self.pieces.state(modal)
        name = self._standing(y)
        s, v = (np.empty((self.looks, self.remainder.rows)) for _ in range(2))
        k = 0
        while k < self.looks:
            piece = self.piece(name)
            seen, over = self._looking(name)
            left = self.looks - k
            ahead = np.concatenate([piece.stretch @ y, *(seen[:left] @ y)]).reshape(left + 1, -1)
            gone = np.flatnonzero(self._off(name, ahead[1:]))
            stay = int(gone[0]) if len(gone) else left
            # a period is looked at once, its end being the beginning of the next
            count = min(stay + 1, left)
            s[k : k + count] = ahead[:count]
            before = y
            for j in range(count):
                v[k + j] = piece.rate @ (over[j - 1] @ before if j else before)
            y = over[stay - 1] @ y if stay else y
            k += stay
            if stay < left:
                y, name = self._through(name, y, self.step)
                k += 1
        return y[: 2 * len(self.remainder.omega)], s, v

    def _looking(self, name: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
        """Rows (looks, m, n) that give the stretches 1, 2 ... steps later, and transitions."""
        if name not in self._ahead:
            piece = self.piece(name)
            one = piece.over(self.step)
            over = np.empty((self.looks, *one.shape))
            over[0] = one
            for k in range(1, self.looks):
                over[k] = one @ over[k - 1]
            self._ahead[name] = piece.stretch @ over, over
        return self._ahead[name]

    def _off(self, name: tuple[int, ...], stretch: np.ndarray) -> np.ndarray:
        """(t,) which of some stretches (t, m) are off these pieces."""
        own = [
            np.searchsorted(edges, stretch[:, row]) != where
            for row, (where, edges) in enumerate(zip(name, self.pieces.edges))
        ]
        return np.any(own, axis=0)

    def _standing(self, y: np.ndarray) -> tuple[int, ...]:
        """The piece on which a state is: the one that its own stretches name."""
        name = self.pieces.name(self.remainder.mean)
        for _ in range(6):
            own = self.pieces.name(self.piece(name).stretch @ y)
            if own == name:
                return name
            name = own
        raise SolidgearError("a state in time is on no piece of the laws, or on two")

    def _through(self, name, y, rest: float):
        """State and piece after a time in which a stretch leaves its piece."""
        while rest > 0:
            piece = self.piece(name)
            terms = piece.series(y)
            at, row, side = self._crossing(name, terms @ piece.stretch.T, rest)
            y = terms.T @ at ** np.arange(TERMS)
            if row is None:
                return y, name
            rest -= at
            name = tuple(w + side * (j == row) for j, w in enumerate(name))
        return y, name

    def _crossing(self, name, series: np.ndarray, rest: float):
        """First time within `rest` at which a stretch leaves its piece, which one, and to which side."""
        first = rest
        found: tuple[float, int | None, int] = rest, None, 0
        for row, (where, edges) in enumerate(zip(name, self.pieces.edges)):
            for edge, side in ((where - 1, -1), (where, 1)):
                if not 0 <= edge < len(edges):
                    continue
                own = series[:, row].copy()
                own[0] -= edges[edge]
                at = _root(side * own, first)
                if at is not None:
                    first, found = at, (at, row, side)
        return found


def _root(series: np.ndarray, rest: float) -> float | None:
    """First time up to `rest` at which a polynomial, at most zero at first, rises through zero."""
    value = series[::-1]
    if np.polyval(value, rest) <= 0:
        return None
    slope = np.polyder(value)
    low, high = 0.0, rest
    if series[0] >= 0 and series[1] > 0:
        return 0.0
    at = rest / 2
    for _ in range(CROSSINGS):
        f = np.polyval(value, at)
        low, high = (at, high) if f <= 0 else (low, at)
        by = np.polyval(slope, at)
        new = at - f / by if by else (low + high) / 2
        if not low < new < high:
            new = (low + high) / 2
        if abs(new - at) <= LOCATED * rest:
            return float(new)
        at = new
    return float(at)


def run_of(remainder: Remainder, omega: float) -> Run | Integrated:
    """Motion in time at a frequency, exact where laws are straight."""
    straight = all(law.pieces for law, _ in remainder.laws) and not remainder.varies
    return Run(remainder, omega) if straight else Integrated(remainder, omega)


def departure(point: Point) -> float:
    """Largest difference of the stretches of a periodic motion from a period in time, begun at its
    state, over their swing; a motion that nothing but its sampled balance has is off by much.
    """
    run = run_of(point.balance.remainder, point.omega)
    _, own, _ = run.period(point.state())
    angle = 2 * np.pi * np.arange(len(own)) / len(own)
    n = 1j * np.arange(point.balance.count + 1)
    told = (np.exp(angle[:, None] * n) @ point.harmonics).real
    return float((np.abs(own - told).max(axis=0) / np.ptp(told, axis=0)).max())


def settled(
    remainder: Remainder,
    omega: float,
    state: np.ndarray | None = None,
    *,
    most: int = MOST_PERIODS,
    steady: float = STEADY,
) -> Steady:
    """The motion that a state runs into.

    Parameters
    ----------
    omega : float
        Of the excitation, rad/s.
    state : (2r,) ndarray, optional
        To begin at; rest at the linear mean without it.
    most : int
        Periods after which a motion that still changes is called unsteady, its cycle 0.
    steady : float
        What may be left of the transient, of the swing of the stretches; told by how fast it fades.

    Returns
    -------
    Steady
    """
    run = run_of(remainder, omega)
    rounding = ROUNDING if isinstance(run, Run) else 10 * TOLERANCE
    modal = np.zeros(2 * len(remainder.omega)) if state is None else state
    waves: list[np.ndarray] = []
    rates: list[np.ndarray] = []
    section: list[tuple[float, float]] = []
    change: dict[int, list[float]] = {c: [] for c in range(1, LONGEST_CYCLE + 1)}
    cycle = 0
    for _ in range(most):
        modal, s, v = run.period(modal)
        waves, rates = [*waves[-LONGEST_CYCLE:], s], [*rates[-LONGEST_CYCLE:], v]
        section.append((float(s[0, 0]), float(v[0, 0])))
        swing = float(np.ptp(s, axis=0).max()) or 1.0
        for c, own in change.items():
            if len(waves) > c:
                own.append(float(np.abs(waves[-1] - waves[-1 - c]).max()) / swing)
        cycle = next((c for c, own in change.items() if _faded(own, steady, rounding)), 0)
        # what still fades towards one period looks like two or three before
        if cycle > 1 and max(change[1][-FADING:]) < STILL_FADING * steady:
            cycle = 0
        if cycle:
            break
    kept, rate = (np.concatenate(own[-max(cycle, 1) :]) for own in (waves, rates))
    angle = 2 * np.pi * np.arange(len(kept)) / run.looks
    factor = remainder.factor(angle) if remainder.varies else None
    line = remainder.line(angle, omega)
    force = remainder.forces(kept, rate, factor, line).value
    return Steady(omega, cycle, len(section), kept, force, np.array(section[-64:]), modal)


def _faded(change: list[float], steady: float, rounding: float) -> bool:
    """Tell whether changes fade, and what all later ones add up to is little, or are rounding."""
    if len(change) < 2 * FADING:
        return False
    now, before = max(change[-FADING:]), max(change[-2 * FADING : -FADING])
    if now <= rounding:
        return True
    if now >= before:
        return now <= 1e-3 * steady
    rate = (now / before) ** (1 / FADING)
    return now * rate <= steady * (1 - rate)


@pinned
def sweep(
    remainder: Remainder,
    omegas: Sequence[float],
    *,
    state: np.ndarray | None = None,
    most: int = MOST_PERIODS,
    steady: float = STEADY,
) -> list[Steady]:
    """Steady motions one after the other, each begun where the last one ended.

    Parameters
    ----------
    omegas : sequence of float
        rad/s, in the order in which they are run through.
    state : (2r,) ndarray, optional
        To begin at; rest at the linear mean without it.
    """
    out: list[Steady] = []
    for omega in omegas:
        out.append(settled(remainder, float(omega), state, most=most, steady=steady))
        state = out[-1].state
    return out
