"""Motion while the speed changes evenly: run-up, and run-down."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from solidgear.backlash.solver.integrated import LOOKS, TOLERANCE, Integrated
from solidgear.backlash.solver.model import Remainder
from solidgear.backlash.solver.motion import Run
from solidgear.core import SolidgearError, pinned

#: cycles of the excitation that a run may take: fewer show no envelope, more take hours
FEWEST_CYCLES, MOST_CYCLES = 10, 20_000
#: spectra of a run; least and most cycles of the excitation in each, and looks a cycle; its orders
SPECTRA, WINDOW, SEEN, HIGHEST = 40, (16, 64), 64, 8
#: cycles between two calls with the share that is done
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
    other_links: tuple[RunUp, ...] = ()  #: the same of the other links with a law

    @property
    def swing(self) -> np.ndarray:
        """Return half of the swing of the force, (c,), N."""
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
    progress: Callable[[float], None] | None = None,
) -> RunUp:
    """Compute the motion while the frequency of the excitation goes from `begin` to `end`, rad/s.

    The ramp, rad/s^2, is above zero whichever of the two is the larger; one that passes in a few
    cycles or takes very many is refused. The motion begins at `state` (2r,), or at rest at the
    linear mean; `progress` is called with the share that is done. See Lewis (1932), Vibration
    during acceleration through a critical speed, Trans. ASME 54, 253-261.
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
        times, s, v, modal = Run(remainder, begin, slope, duration).integrate(modal, progress)
    else:
        run = Integrated(remainder, begin, tolerance=tolerance, ramp=slope)
        times, s, v, modal = _by_cycles(run, cycles, modal, progress)
    omega = begin + slope * times
    angle = times * (begin + omega) / 2
    factor = remainder.factor(angle) if remainder.varies else None
    line = remainder.line(angle, omega[:, None])
    forces = remainder.forces(s, v, factor, line).value
    first = np.searchsorted(angle, 2 * np.pi * np.arange(cycles) - 1e-9)
    speed = np.sqrt(begin**2 + 4 * np.pi * slope * (np.arange(cycles) + 0.5))
    runs = []
    for _, rows in remainder.laws:
        along = line.along(rows, s) if line is not None and rows in line.links else s[:, rows.start]
        force = forces[:, rows.start]
        runs.append(
            RunUp(
                omega=speed,
                lowest=np.minimum.reduceat(force, first),
                highest=np.maximum.reduceat(force, first),
                least=np.minimum.reduceat(along, first),
                most=np.maximum.reduceat(along, first),
                state=modal,
                spectra=_spectra(angle, force, cycles, begin, slope),
            )
        )
    return replace(runs[0], other_links=tuple(runs[1:]))


def _spectra(
    angle: np.ndarray, force: np.ndarray, cycles: int, begin: float, slope: float
) -> Spectra:
    """Return the spectra of a force over the angle of the excitation."""
    shortest, longest = WINDOW
    long = min(int(np.clip(cycles // SPECTRA, shortest, longest)), cycles // 2)
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
    lines = np.arange(2, HIGHEST * long + 1)
    return Spectra(omega, lines / long, size[:, lines])


def _by_cycles(run: Integrated, cycles: int, modal: np.ndarray, progress):
    """Return times (t,), stretches and rates (t, m) of a run that is integrated, and the last
    state.
    """
    rows = []
    for cycle in range(cycles):
        if progress and cycle % TOLD == 0:
            progress(cycle / cycles)
        angle = 2 * np.pi * (cycle + np.arange(LOOKS + 1) / LOOKS)
        times = 2 * angle / (run.omega + np.sqrt(run.omega**2 + 2 * run.ramp * angle))
        modal, s, v = run.integrate(modal, times)
        rows.append((times[:-1], s, v))
    return *(np.concatenate(parts) for parts in zip(*rows)), modal
