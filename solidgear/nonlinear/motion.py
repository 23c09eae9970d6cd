r"""Periodic motion by time alone: exact between contacts, contacts located, steady state detected.
Curved laws, and those that vary over the cycle, are integrated to a tolerance.

Nothing of harmonic balance is used but the force laws and what is linear.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as sla
from scipy.special import factorial

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
#: steps between two looks at what is crossed, and powers of time that tell the excitation in a step
BLOCK, POWERS = 64, 9
#: Newton's steps that locate a crossing, and its rest relative to the gap
CROSSINGS, LOCATED = 30, 1e-13


@dataclass(frozen=True, eq=False)
class Steady:
    """A motion that no longer changes."""

    omega: float  #: of the excitation, rad/s
    cycle: int  #: periods of the excitation after which it repeats itself; 0 where it never did
    periods: int  #: that it took
    #: stretch, force: (t, m) over its cycle, at equal intervals; forces with those of dampers
    stretch: np.ndarray
    force: np.ndarray
    state: np.ndarray  #: (2r,) at its end, where another speed can begin

    @property
    def rms(self) -> np.ndarray:
        """(m,) root mean square of the stretches about their mean."""
        return self.stretch.std(axis=0)


class Run:
    """A remainder in time, exact between contacts, at one frequency of the excitation or while it
    changes evenly.

    Within a step so short that its own change of the frequency is nothing, the excitation is told by
    its powers of time, whose effect on a state depends on the pieces alone.

    Parameters
    ----------
    omega : float
        Of the excitation at the beginning, rad/s.
    slope : float
        How it grows, rad/s^2; without unbalance where it does.
    duration : float, optional
        s; one period without it.
    """

    def __init__(
        self, remainder: Remainder, omega: float, slope: float = 0.0, duration: float | None = None
    ):
        once = duration is None
        duration = 2 * np.pi / omega if duration is None else duration
        fastest = max(omega, omega + slope * duration)
        there = Pieces(remainder, fastest)
        # what a piece is at any frequency lies on a line through two of them
        self.still, self.unit = there, there
        if slope:
            self.still, self.unit = Pieces(remainder, 0.0), Pieces(remainder, 1.0)
        self.remainder, self.edges = remainder, there.edges
        size = there.piece(there.name(remainder.mean)).size
        period = 2 * np.pi / fastest
        self.looks = max(LOOKS, int(np.ceil(size / SHORT * period)))
        count = self.looks if once else int(np.ceil(duration / (period / self.looks)))
        self.step = duration / count
        self.times = self.step * np.arange(count + 1)
        middle = self.times + self.step / 2
        self.speeds = omega + slope * middle
        # the angle at the beginning of a step whose speed is that of its middle throughout
        angle = middle * (omega + self.speeds) / 2 - self.speeds * self.step / 2
        self.orders = 1j * np.arange(1, len(remainder.error) + 1)
        self.turn = np.exp(angle[:, None] * self.orders)
        self.around = np.ones((count + 1, 1 + 2 * self.turn.shape[1]))
        self.around[:, 1::2], self.around[:, 2::2] = self.turn.real, self.turn.imag
        self._tables: dict[tuple[int, ...], tuple[np.ndarray, ...]] = {}

    def period(self, modal: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """State (2r,) a period later, and stretches and rates (looks, m) on the way."""
        _, s, v, modal = self.whole(modal)
        return modal, s, v

    def piece(self, name: tuple[int, ...], omega: float) -> Piece:
        """The linear equation on some pieces, at a frequency of the excitation."""
        at_rest, turning = self.still.piece(name), self.unit.piece(name)
        if at_rest is turning:
            return at_rest
        return Piece(
            at_rest.matrix + omega * (turning.matrix - at_rest.matrix),
            at_rest.stretch,
            at_rest.rate + omega * (turning.rate - at_rest.rate),
        )

    def whole(self, modal: np.ndarray, told: Callable[[float], None] | None = None):
        """Times (t,), stretches and rates (t, m), and the last state."""
        size, count = 2 * len(self.remainder.omega), len(self.times) - 1
        s, v = (np.empty((count, self.remainder.rows)) for _ in range(2))
        name = self._standing(np.append(modal, self.around[0]))
        y, k = modal, 0
        while k < count:
            if told:
                told(k / count)
            here = slice(k, min(k + BLOCK, count) + 1)
            over, push = self._steps(name, here)
            states = np.empty((len(push), size))
            states[0] = y
            for j in range(len(push) - 1):
                states[j + 1] = over @ states[j] + push[j]
            whole, still = np.hstack([states, self.around[here]]), self.still.piece(name)
            ahead = whole @ still.stretch.T
            gone = np.flatnonzero(self._off(name, ahead[1:]))
            stay = int(gone[0]) if len(gone) else len(push) - 1
            kept = min(stay + 1, len(push) - 1)
            s[k : k + kept] = ahead[:kept]
            turning = whole[:kept] @ (self.unit.piece(name).rate - still.rate).T
            v[k : k + kept] = (
                whole[:kept] @ still.rate.T + self.speeds[k : k + kept, None] * turning
            )
            y, k = states[stay], k + stay
            if len(gone):
                y, name = self._through(name, np.append(y, self.around[k]), float(self.speeds[k]))
                y, k = y[:size], k + 1
        return self.times[:-1], s, v, y

    def _steps(self, name: tuple[int, ...], here: slice) -> tuple[np.ndarray, np.ndarray]:
        """Transition (2r, 2r) of a state over one step, and what the excitation adds to it in each of
        some steps (n, 2r).
        """
        if name not in self._tables:
            self._tables[name] = self._table(name)
        over, constant, still, unit = self._tables[name]
        speed = self.speeds[here, None, None]
        powers = (speed * self.orders[:, None]) ** np.arange(POWERS) * self.turn[here, :, None]
        flat = powers.reshape(len(powers), -1)
        return over, constant + (flat @ still + speed[:, :, 0] * (flat @ unit)).real

    def _table(self, name: tuple[int, ...]) -> tuple[np.ndarray, ...]:
        size = 2 * len(self.remainder.omega)
        still = self.still.piece(name).matrix[:size]
        own, given = still[:, :size], still[:, size:]
        change = self.unit.piece(name).matrix[:size, size:] - given
        by = []
        for columns in (given, change):
            orders = columns[:, 1::2] - 1j * columns[:, 2::2]
            by.append(self._powers(own, orders).transpose(2, 0, 1).reshape(-1, size))
        constant = self._powers(own, given[:, :1])[0, :, 0]
        return sla.expm(self.step * own), constant, *by

    def _powers(self, own: np.ndarray, given: np.ndarray) -> np.ndarray:
        """(POWERS, 2r, o) what a step of a forcing (2r, o) by ``t^k / k!`` comes to."""
        terms = [given]
        for _ in range(TERMS - 1):
            terms.append(own @ terms[-1])
        order = 1 + np.arange(POWERS)[:, None] + np.arange(TERMS)
        return np.tensordot(self.step**order / factorial(order), np.array(terms), axes=1)

    def _off(self, name: tuple[int, ...], stretch: np.ndarray) -> np.ndarray:
        """(t,) which of some stretches (t, m) are off these pieces."""
        own = [
            np.searchsorted(edges, stretch[:, row]) != where
            for row, (where, edges) in enumerate(zip(name, self.edges))
        ]
        return np.any(own, axis=0)

    def _standing(self, y: np.ndarray) -> tuple[int, ...]:
        """The piece on which a state is: the one that its own stretches name."""
        name = self.still.name(self.remainder.mean)
        for _ in range(6):
            own = self.still.name(self.still.piece(name).stretch @ y)
            if own == name:
                return name
            name = own
        raise SolidgearError("a state in time is on no piece of the laws, or on two")

    def _through(self, name, y, omega: float):
        """State and piece after a step in which a stretch leaves its piece."""
        rest = self.step
        while rest > 0:
            piece = self.piece(name, omega)
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
        for row, (where, edges) in enumerate(zip(name, self.edges)):
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
    change: dict[int, list[float]] = {c: [] for c in range(1, LONGEST_CYCLE + 1)}
    cycle = periods = 0
    while not cycle and periods < most:
        periods += 1
        modal, s, v = run.period(modal)
        waves, rates = [*waves[-LONGEST_CYCLE:], s], [*rates[-LONGEST_CYCLE:], v]
        swing = float(np.ptp(s, axis=0).max()) or 1.0
        for c, own in change.items():
            if len(waves) > c:
                own.append(float(np.abs(waves[-1] - waves[-1 - c]).max()) / swing)
        cycle = next((c for c, own in change.items() if _faded(own, steady, rounding)), 0)
        # what still fades towards one period looks like two or three before
        if cycle > 1 and max(change[1][-FADING:]) < STILL_FADING * steady:
            cycle = 0
    kept, rate = (np.concatenate(own[-max(cycle, 1) :]) for own in (waves, rates))
    angle = 2 * np.pi * np.arange(len(kept)) / run.looks
    factor = remainder.factor(angle) if remainder.varies else None
    line = remainder.line(angle, omega)
    force = remainder.forces(kept, rate, factor, line).value
    return Steady(omega, cycle, periods, kept, force, modal)


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
