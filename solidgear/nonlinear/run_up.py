"""Motion while the speed changes evenly: run-up, and run-down."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.machine.threads import pinned
from solidgear.nonlinear.integrated import LOOKS, TOLERANCE, Integrated
from solidgear.nonlinear.model import Remainder
from solidgear.nonlinear.motion import Run

#: cycles of the excitation that a run may take: fewer tell no envelope, more take hours
FEWEST_CYCLES, MOST_CYCLES = 10, 20_000
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
    """A motion under a ramp of the speed, cycle by cycle of the excitation."""

    omega: np.ndarray  #: (c,) in the middle of each cycle, rad/s
    #: lowest, highest: (c,) force of the first link within it, that of a damper included, N
    lowest: np.ndarray
    highest: np.ndarray
    #: least, most: (c,) its stretch, m
    least: np.ndarray
    most: np.ndarray
    state: np.ndarray  #: (2r,) at the end
    spectra: Spectra  #: of this force, at speeds that are evenly apart
    others: tuple[RunUp, ...] = ()  #: the same of the other links with a law

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
        times, s, v, modal = Run(remainder, begin, slope, duration).whole(modal, told)
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
