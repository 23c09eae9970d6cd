r"""Periodic motion by time alone: exact between contacts, contacts located, steady state detected;
curved laws, and those that vary over the cycle, are integrated to a tolerance.

It shares the force laws and the linear part with harmonic balance, and nothing else.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as sla
from scipy.special import factorial

from solidgear.backlash.solver.continuation import Point
from solidgear.backlash.solver.integrated import LOOKS, TOLERANCE, Integrated
from solidgear.backlash.solver.model import Remainder
from solidgear.backlash.solver.pieces import SHORT, TERMS, Piece, Pieces
from solidgear.core import SolidgearError, pinned

#: rest of a transient, relative, when a motion is steady
STEADY = 1e-5
#: periods of the excitation after which a motion is called unsteady, and that may make one of its own
MOST_PERIODS, LONGEST_CYCLE = 4_000, 8
#: periods over which changes must fade to be judged
FADING = 8
#: a change from period to period above which a motion of several periods is one, in tolerances
STILL_FADING = 100.0
#: changes that are no motion, of exact pieces
ROUNDING = 1e-12
#: steps between two looks for crossings, and powers of time that stand for the excitation in a step
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
        """Return the root mean square (m,) of the stretches about their mean."""
        return self.stretch.std(axis=0)


class Run:
    """Motion of a remainder in time, exact between contacts, at one frequency of the excitation or
    while it changes evenly.

    Within a step so short that the frequency hardly changes, the excitation is a series of powers
    of time, whose effect on a state depends on the pieces alone. Speeds grow from `omega`, rad/s,
    by `slope`, rad/s^2 (then without unbalance), over `duration`, s, by default one period.
    """

    def __init__(
        self, remainder: Remainder, omega: float, slope: float = 0.0, duration: float | None = None
    ):
        one_period = duration is None
        duration = 2 * np.pi / omega if duration is None else duration
        fastest = max(omega, omega + slope * duration)
        at_fastest = Pieces(remainder, fastest)
        # a piece is linear in the frequency: two of them give all
        self.at_rest, self.at_one = at_fastest, at_fastest
        if slope:
            self.at_rest, self.at_one = Pieces(remainder, 0.0), Pieces(remainder, 1.0)
        self.remainder, self.edges = remainder, at_fastest.edges
        size = at_fastest.piece(at_fastest.name(remainder.mean)).size
        period = 2 * np.pi / fastest
        self.looks = max(LOOKS, int(np.ceil(size / SHORT * period)))
        count = self.looks if one_period else int(np.ceil(duration / (period / self.looks)))
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
        """Return the state (2r,) a period later, and stretches and rates (looks, m) on the way."""
        _, s, v, modal = self.integrate(modal)
        return modal, s, v

    def piece(self, name: tuple[int, ...], omega: float) -> Piece:
        """Return the linear equation on some pieces, at a frequency of the excitation."""
        resting, turning = self.at_rest.piece(name), self.at_one.piece(name)
        if resting is turning:
            return resting
        return Piece(
            resting.matrix + omega * (turning.matrix - resting.matrix),
            resting.stretch,
            resting.rate + omega * (turning.rate - resting.rate),
        )

    def integrate(self, modal: np.ndarray, progress: Callable[[float], None] | None = None):
        """Return times (t,), stretches and rates (t, m), and the last state."""
        size, count = 2 * len(self.remainder.omega), len(self.times) - 1
        s, v = (np.empty((count, self.remainder.rows)) for _ in range(2))
        name = self._piece_at(np.append(modal, self.around[0]))
        y, k = modal, 0
        while k < count:
            if progress:
                progress(k / count)
            block = slice(k, min(k + BLOCK, count) + 1)
            transition, push = self._steps(name, block)
            states = np.empty((len(push), size))
            states[0] = y
            for j in range(len(push) - 1):
                states[j + 1] = transition @ states[j] + push[j]
            stacked, resting = np.hstack([states, self.around[block]]), self.at_rest.piece(name)
            ahead = stacked @ resting.stretch.T
            departures = np.flatnonzero(self._outside(name, ahead[1:]))
            stay = int(departures[0]) if len(departures) else len(push) - 1
            count_kept = min(stay + 1, len(push) - 1)
            s[k : k + count_kept] = ahead[:count_kept]
            turning = stacked[:count_kept] @ (self.at_one.piece(name).rate - resting.rate).T
            v[k : k + count_kept] = (
                stacked[:count_kept] @ resting.rate.T
                + self.speeds[k : k + count_kept, None] * turning
            )
            y, k = states[stay], k + stay
            if len(departures):
                y, name = self._across_edges(
                    name, np.append(y, self.around[k]), float(self.speeds[k])
                )
                y, k = y[:size], k + 1
        return self.times[:-1], s, v, y

    def _steps(self, name: tuple[int, ...], block: slice) -> tuple[np.ndarray, np.ndarray]:
        """Return the transition (2r, 2r) of a state over one step, and the contribution of the
        excitation to it in each of some steps (n, 2r).
        """
        if name not in self._tables:
            self._tables[name] = self._table(name)
        transition, constant, by_rest, by_speed = self._tables[name]
        speed = self.speeds[block, None, None]
        powers = (speed * self.orders[:, None]) ** np.arange(POWERS) * self.turn[block, :, None]
        flat = powers.reshape(len(powers), -1)
        return transition, constant + (flat @ by_rest + speed[:, :, 0] * (flat @ by_speed)).real

    def _table(self, name: tuple[int, ...]) -> tuple[np.ndarray, ...]:
        size = 2 * len(self.remainder.omega)
        resting = self.at_rest.piece(name).matrix[:size]
        matrix, forcing = resting[:, :size], resting[:, size:]
        change = self.at_one.piece(name).matrix[:size, size:] - forcing
        responses = []
        for columns in (forcing, change):
            orders = columns[:, 1::2] - 1j * columns[:, 2::2]
            responses.append(self._powers(matrix, orders).transpose(2, 0, 1).reshape(-1, size))
        constant = self._powers(matrix, forcing[:, :1])[0, :, 0]
        return sla.expm(self.step * matrix), constant, *responses

    def _powers(self, matrix: np.ndarray, forcing: np.ndarray) -> np.ndarray:
        """Return the effect (POWERS, 2r, o) of a forcing (2r, o) times ``t^k / k!`` over a step."""
        terms = [forcing]
        for _ in range(TERMS - 1):
            terms.append(matrix @ terms[-1])
        order = 1 + np.arange(POWERS)[:, None] + np.arange(TERMS)
        return np.tensordot(self.step**order / factorial(order), np.array(terms), axes=1)

    def _outside(self, name: tuple[int, ...], stretch: np.ndarray) -> np.ndarray:
        """Return which of some stretches (t, m) are off these pieces, (t,)."""
        departed = [
            np.searchsorted(edges, stretch[:, row]) != place
            for row, (place, edges) in enumerate(zip(name, self.edges))
        ]
        return np.any(departed, axis=0)

    def _piece_at(self, y: np.ndarray) -> tuple[int, ...]:
        """Return the piece on which a state lies: the one that the stretches name."""
        name = self.at_rest.name(self.remainder.mean)
        for _ in range(6):
            actual = self.at_rest.name(self.at_rest.piece(name).stretch @ y)
            if actual == name:
                return name
            name = actual
        raise SolidgearError("a state in time is on no piece of the laws, or on two")

    def _across_edges(self, name, y, omega: float):
        """Return state and piece after a step in which a stretch leaves the piece."""
        remaining = self.step
        while remaining > 0:
            piece = self.piece(name, omega)
            terms = piece.series(y)
            time, row, side = self._crossing(name, terms @ piece.stretch.T, remaining)
            y = terms.T @ time ** np.arange(TERMS)
            if row is None:
                return y, name
            remaining -= time
            name = tuple(w + side * (j == row) for j, w in enumerate(name))
        return y, name

    def _crossing(self, name, series: np.ndarray, duration: float):
        """Return the first time within a duration at which a stretch leaves the piece, the row, and
        the side.
        """
        first = duration
        crossing: tuple[float, int | None, int] = duration, None, 0
        for row, (place, edges) in enumerate(zip(name, self.edges)):
            for edge, side in ((place - 1, -1), (place, 1)):
                if not 0 <= edge < len(edges):
                    continue
                distance = series[:, row].copy()
                distance[0] -= edges[edge]
                time = _root(side * distance, first)
                if time is not None:
                    first, crossing = time, (time, row, side)
        return crossing


def _root(series: np.ndarray, end: float) -> float | None:
    """Return the first time up to `end` at which a polynomial, at most zero at first, rises through
    zero.
    """
    value = series[::-1]
    if np.polyval(value, end) <= 0:
        return None
    slope = np.polyder(value)
    low, high = 0.0, end
    if series[0] >= 0 and series[1] > 0:
        return 0.0
    time = end / 2
    for _ in range(CROSSINGS):
        f = np.polyval(value, time)
        low, high = (time, high) if f <= 0 else (low, time)
        rise = np.polyval(slope, time)
        new = time - f / rise if rise else (low + high) / 2
        if not low < new < high:
            new = (low + high) / 2
        if abs(new - time) <= LOCATED * end:
            return float(new)
        time = new
    return float(time)


def run_of(remainder: Remainder, omega: float) -> Run | Integrated:
    """Return the motion in time at a frequency, exact where laws are straight."""
    straight = all(law.pieces for law, _ in remainder.laws) and not remainder.varies
    return Run(remainder, omega) if straight else Integrated(remainder, omega)


def departure(point: Point) -> float:
    """Return the largest difference of a periodic motion's stretches from a period in time, begun
    at the state, over their swing; large for a motion that only its sampled balance has.
    """
    run = run_of(point.balance.remainder, point.omega)
    _, in_time, _ = run.period(point.state())
    angle = 2 * np.pi * np.arange(len(in_time)) / len(in_time)
    n = 1j * np.arange(point.balance.count + 1)
    balanced = (np.exp(angle[:, None] * n) @ point.harmonics).real
    return float((np.abs(in_time - balanced).max(axis=0) / np.ptp(balanced, axis=0)).max())


def steady_motion(
    remainder: Remainder,
    omega: float,
    state: np.ndarray | None = None,
    *,
    most: int = MOST_PERIODS,
    steady: float = STEADY,
) -> Steady:
    """Return the motion that a state runs into at a frequency of the excitation, rad/s.

    It begins at `state` (2r,), or at rest at the linear mean; a motion that still changes after
    `most` periods is unsteady, cycle 0. `steady` is the rest of the transient that is
    accepted, relative to the swing of the stretches, judged by how fast it fades.
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
        for c, changes in change.items():
            if len(waves) > c:
                changes.append(float(np.abs(waves[-1] - waves[-1 - c]).max()) / swing)
        cycle = next((c for c, changes in change.items() if _faded(changes, steady, rounding)), 0)
        # a motion that still fades towards one period looks like two or three before
        if cycle > 1 and max(change[1][-FADING:]) < STILL_FADING * steady:
            cycle = 0
    stretch, rate = (np.concatenate(series[-max(cycle, 1) :]) for series in (waves, rates))
    angle = 2 * np.pi * np.arange(len(stretch)) / run.looks
    factor = remainder.factor(angle) if remainder.varies else None
    line = remainder.line(angle, omega)
    force = remainder.forces(stretch, rate, factor, line).value
    return Steady(omega, cycle, periods, stretch, force, modal)


def _faded(change: list[float], steady: float, rounding: float) -> bool:
    """Return whether changes are rounding, or fade so that all later ones add up to little."""
    if len(change) < 2 * FADING:
        return False
    latest, before = max(change[-FADING:]), max(change[-2 * FADING : -FADING])
    if latest <= rounding:
        return True
    if latest >= before:
        return latest <= 1e-3 * steady
    rate = (latest / before) ** (1 / FADING)
    return latest * rate <= steady * (1 - rate)


@pinned
def sweep(
    remainder: Remainder,
    omegas: Sequence[float],
    *,
    state: np.ndarray | None = None,
    most: int = MOST_PERIODS,
    steady: float = STEADY,
) -> list[Steady]:
    """Return the steady motions at some frequencies, rad/s, in that order, each begun where the
    last one ended.
    """
    out: list[Steady] = []
    for omega in omegas:
        out.append(steady_motion(remainder, float(omega), state, most=most, steady=steady))
        state = out[-1].state
    return out
