"""Motion while the speed changes evenly: run-up, and run-down."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import factorial
from typing import NamedTuple

import numpy as np
import scipy.linalg as sla

from solidgear.errors import SolidgearError
from solidgear.machine.threads import pinned
from solidgear.nonlinear.integrated import LOOKS, TOLERANCE, Integrated
from solidgear.nonlinear.model import Remainder
from solidgear.nonlinear.motion import Run
from solidgear.nonlinear.pieces import TERMS, Piece, Pieces

#: cycles of the excitation that a run may take: fewer tell no envelope, more take hours
FEWEST_CYCLES, MOST_CYCLES = 10, 20_000
#: steps between two looks at what is crossed, and powers of time that tell the excitation in a step
BLOCK, POWERS = 64, 9
#: spectra of a run; least and most cycles of the excitation, and looks at each, that one is made of;
#: orders that it has
SPECTRA, WINDOW, SEEN, HIGHEST = 40, (16, 64), 64, 8
#: cycles between two words on how far a run is
TOLD = 50


class Spectra(NamedTuple):
    """Amplitudes of a force by orders of the excitation, each over some cycles (Hann's window)."""

    omega: np.ndarray  #: (n,) in the middle of each, rad/s
    order: np.ndarray  #: (k,)
    size: np.ndarray  #: (n, k) N


@dataclass(frozen=True, eq=False)
class RunUp:
    """A motion under a ramp of the speed, cycle by cycle of the excitation.

    Attributes
    ----------
    omega : (c,) ndarray
        In the middle of each cycle, rad/s.
    lowest, highest : (c,) ndarray
        Force of the first link within it, that of a damper included, N.
    least, most : (c,) ndarray
        Its stretch, m.
    state : (2r,) ndarray
        At the end.
    spectra : Spectra
        Of this force, at speeds that are evenly apart.
    others : tuple of RunUp
        The same of the other links with a law.
    """

    omega: np.ndarray
    lowest: np.ndarray
    highest: np.ndarray
    least: np.ndarray
    most: np.ndarray
    state: np.ndarray
    spectra: Spectra
    others: tuple[RunUp, ...] = ()

    @property
    def swing(self) -> np.ndarray:
        """(c,) half of the swing of the force, N."""
        return (self.highest - self.lowest) / 2


@pinned
def run_up(
    remainder: Remainder,
    begin: float,
    end: float,
    ramp: float,
    *,
    state: np.ndarray | None = None,
    tolerance: float = TOLERANCE,
    told: Callable[[float], None] | None = None,
) -> RunUp:
    """Motion while the frequency of the excitation goes from one to another.

    Parameters
    ----------
    begin, end : float
        rad/s.
    ramp : float
        How fast, rad/s^2; above zero whichever of the two is the larger.
    state : (2r,) ndarray, optional
        To begin at; rest at the linear mean without it.
    told : callable, optional
        Called with the share that is done.

    Raises
    ------
    SolidgearError
        For a ramp that passes in a few cycles or takes very many, or a range that holds zero.

    References
    ----------
    Lewis (1932), Vibration during acceleration through a critical speed, Trans. ASME 54, 253-261.
    """
    if not (begin > 0 and end > 0 and begin != end and ramp > 0):
        raise SolidgearError(
            f"a run from {begin:g} to {end:g} rad/s by {ramp:g} rad/s^2; give two different speeds "
            "and a ramp above zero"
        )
    cycles = int(abs(end**2 - begin**2) / (4 * np.pi * ramp))
    if not FEWEST_CYCLES <= cycles <= MOST_CYCLES:
        raise SolidgearError(
            f"this ramp passes the range in {cycles} cycles of the excitation (mesh cycles of a "
            f"train); give one that takes {FEWEST_CYCLES} to {MOST_CYCLES}"
        )
    slope = ramp if end > begin else -ramp
    modal = np.zeros(2 * len(remainder.omega)) if state is None else state
    duration = 4 * np.pi * cycles / (begin + np.sqrt(begin**2 + 4 * np.pi * cycles * slope))
    straight = all(law.pieces for law, _ in remainder.laws) and not remainder.varies
    if straight and not remainder.unbalance:
        times, s, v, modal = Ramped(remainder, begin, slope, duration).whole(modal, told)
    else:
        run = Integrated(remainder, begin, tolerance=tolerance, ramp=slope)
        times, s, v, modal = _by_cycles(run, cycles, modal, told)
    omega = begin + slope * times
    angle = times * (begin + omega) / 2
    factor = remainder.factor(angle) if remainder.varies else None
    line = remainder.line(angle, omega[:, None])
    forces = remainder.forces(s, v, factor, line).value
    first = np.searchsorted(angle, 2 * np.pi * np.arange(cycles) - 1e-9)
    speed = np.sqrt(begin**2 + 4 * np.pi * slope * (np.arange(cycles) + 0.5))
    runs = []
    for _, at in remainder.laws:
        along = line.along(at, s) if line is not None and at in line.links else s[:, at.start]
        force = forces[:, at.start]
        least, most = np.minimum.reduceat(along, first), np.maximum.reduceat(along, first)
        ends = np.minimum.reduceat(force, first), np.maximum.reduceat(force, first)
        heard = _spectra(angle, force, cycles, begin, slope)
        runs.append(RunUp(speed, *ends, least, most, modal, heard))
    return replace(runs[0], others=tuple(runs[1:]))


def _spectra(
    angle: np.ndarray, force: np.ndarray, cycles: int, begin: float, slope: float
) -> Spectra:
    """Of a force over the angle of the excitation."""
    long = min(int(np.clip(cycles // SPECTRA, *WINDOW)), cycles // 2)
    count = min(SPECTRA, cycles // long)

    def speed(cycle):
        return np.sqrt(begin**2 + 4 * np.pi * slope * cycle)

    omega = np.linspace(speed(long / 2), speed(cycles - long / 2), count)
    first = (omega**2 - begin**2) / (4 * np.pi * slope) - long / 2
    inside = np.arange(long * SEEN) / SEEN
    waves = np.interp(2 * np.pi * (first[:, None] + inside), angle, force)
    bell = 1 - np.cos(2 * np.pi * inside / long)
    size = 2 * np.abs(np.fft.rfft(waves * bell, axis=1)) / bell.sum()
    # a window ends between orders: the mean leaks into the first two
    kept = np.arange(2, HIGHEST * long + 1)
    return Spectra(omega, kept / long, size[:, kept])


def _by_cycles(run: Integrated, cycles: int, modal: np.ndarray, told):
    """Times (t,), stretches and rates (t, m) of a run that is integrated, and its last state."""
    rows = []
    for cycle in range(cycles):
        if told and cycle % TOLD == 0:
            told(cycle / cycles)
        angle = 2 * np.pi * (cycle + np.arange(LOOKS + 1) / LOOKS)
        times = 2 * angle / (run.omega + np.sqrt(run.omega**2 + 2 * run.ramp * angle))
        modal, s, v = run.over(modal, times)
        rows.append((times[:-1], s, v))
    return *(np.concatenate(own) for own in zip(*rows)), modal


class Ramped(Run):
    """Exact between contacts, while the frequency of the excitation changes evenly.

    Within a step so short that its own change of the frequency is nothing, the excitation is told by
    its powers of time, whose effect on a state depends on the pieces alone.
    """

    def __init__(self, remainder: Remainder, begin: float, slope: float, duration: float):
        self.still, self.unit = Pieces(remainder, 0.0), Pieces(remainder, 1.0)
        self.begin, self.slope = begin, slope
        super().__init__(remainder, max(begin, begin + slope * duration))
        count = int(np.ceil(duration / self.step))
        self.step = duration / count
        self.times = self.step * np.arange(count + 1)
        middle = self.times + self.step / 2
        self.speeds = begin + slope * middle
        # the angle at the beginning of a step whose speed is that of its middle throughout
        angle = middle * (begin + self.speeds) / 2 - self.speeds * self.step / 2
        self.orders = 1j * np.arange(1, len(remainder.error) + 1)
        self.turn = np.exp(angle[:, None] * self.orders)
        self.around = np.ones((count + 1, 1 + 2 * self.turn.shape[1]))
        self.around[:, 1::2], self.around[:, 2::2] = self.turn.real, self.turn.imag
        self._tables: dict[tuple[int, ...], tuple[np.ndarray, ...]] = {}

    def piece(self, name: tuple[int, ...]) -> Piece:
        """The linear equation on some pieces, at the speed of this moment."""
        at_rest, turning = self.still.piece(name), self.unit.piece(name)
        return Piece(
            at_rest.matrix + self.omega * (turning.matrix - at_rest.matrix),
            at_rest.stretch,
            at_rest.rate + self.omega * (turning.rate - at_rest.rate),
        )

    def whole(self, modal: np.ndarray, told: Callable[[float], None] | None):
        """Times (t,), stretches and rates (t, m), and the last state."""
        size, count = 2 * len(self.remainder.omega), len(self.times) - 1
        s, v = (np.empty((count, self.remainder.rows)) for _ in range(2))
        self.omega = float(self.speeds[0])
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
                self.omega = float(self.speeds[k])
                y, name = self._through(name, np.append(y, self.around[k]), self.step)
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
        out = np.zeros((POWERS, *given.shape), given.dtype)
        term = given
        for i in range(TERMS):
            for k in range(POWERS):
                out[k] += term * (self.step ** (i + k + 1) / factorial(i + k + 1))
            term = own @ term
        return out
