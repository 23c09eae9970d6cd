r"""Harmonic balance: periodic motion as a Fourier series of the stretches of links with a law
alone.

With S_h the harmonics of the stretches, P_h those of the excess force of the laws over their
tangents and H the receptance of all that is linear,

    S_h = S_lin,h + H(h w) P_h + F p_h,

P from the motion in time (alternating frequency and time) and the Jacobian from the tangents there,
exact for the sampled law.  A system of any size costs as much as its few stretches.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from solidgear.backlash.solver.kinks import kinks
from solidgear.backlash.solver.model import Remainder
from solidgear.backlash.solver.sway import Line
from solidgear.core import SolidgearError
from solidgear.core.system.law import Force

#: instants a harmonic, and of a period at least: with two, turning points of a law of pieces were 2 % off
INSTANTS = 16
LEAST_INSTANTS = 256
#: change of the unknowns, relative to the largest stretch, at which Newton's method has arrived
ARRIVED = 1e-11
ITERATIONS = 12


@cache
def series(count: int, instants: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return synthesis (T, 2H+1) of a0, a_h, b_h, the derivative over the angle, and analysis."""
    angle = 2 * np.pi * np.arange(instants) / instants
    h = np.arange(1, count + 1)
    c, s = np.cos(angle[:, None] * h), np.sin(angle[:, None] * h)
    make = np.hstack([np.ones((instants, 1)), c, s])
    slope = np.hstack([np.zeros((instants, 1)), -h * s, h * c])
    read = 2 / instants * make.T
    read[0] /= 2
    return make, slope, read


def as_real(harmonics: np.ndarray) -> np.ndarray:
    """Return coefficients (2H+1, m) a0, a_h, b_h of complex harmonics (H+1, m)."""
    return np.concatenate([harmonics[:1].real, harmonics[1:].real, -harmonics[1:].imag])


def as_complex(parts: np.ndarray) -> np.ndarray:
    """Return complex harmonics (H+1, m) of coefficients (2H+1, m)."""
    count = len(parts) // 2
    return np.concatenate([parts[:1] + 0j, parts[1 : count + 1] - 1j * parts[count + 1 :]])


@dataclass(frozen=True, eq=False)
class Residual:
    """Imbalance at a trial motion, with derivatives."""

    value: np.ndarray  #: (n,)
    jacobian: np.ndarray  #: (n, n)
    by_omega: np.ndarray  #: (n,)
    #: some link carries a force at some instant, or none needs to: where laws alone hold the
    #: system, a motion without any leaves the Jacobian singular
    carries: bool


@dataclass(frozen=True, eq=False)
class Balance:
    """The equations of a remainder for so many harmonics."""

    remainder: Remainder
    count: int  #: harmonics H
    instants: int = INSTANTS  #: a harmonic

    @property
    def samples(self) -> int:
        """Return the number of instants of a period."""
        return max(LEAST_INSTANTS, self.instants * self.count)

    @cached_property
    def _series(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return series(self.count, self.samples)

    @cached_property
    def factor(self) -> np.ndarray | None:
        """Return the factor (T, m) of forces at every instant; None where nothing varies."""
        angle = 2 * np.pi * np.arange(self.samples) / self.samples
        return self.remainder.factor(angle) if self.remainder.varies else None

    def line(self, omega: float) -> Line | None:
        """Return shares of the rows at every instant; None where no line of action turns."""
        if self._line is None:
            return None
        return self._line._replace(slope=omega * self._line.slope)

    @cached_property
    def _line(self) -> Line | None:
        return self.remainder.line(2 * np.pi * np.arange(self.samples) / self.samples, 1.0)

    def linear(self, omega: float) -> np.ndarray:
        """Return the motion (n,) of the linear system, whose rest is where the forces are zero."""
        return as_real(self.remainder.linear(omega, self.count)[0]).ravel()

    def start(self, omega: float) -> np.ndarray:
        """Return the motion (n,) of the linear system around the place where laws carry the mean
        forces; a link without stiffness carries none, and moves with the others.
        """
        out, remainder = self.linear(omega).reshape(-1, self.remainder.rows), self.remainder
        stiffness = np.diag(remainder.stiffness)
        # excess of the law over the linear stretch at its mean force, as a force of its spring
        lacking = np.zeros(remainder.rows)
        for law, rows in remainder.laws:
            depth = getattr(law, "depth", None)
            if depth is not None:
                for row in remainder.rows_of(rows):
                    force = stiffness[row] * remainder.mean[row]
                    lacking[row] = stiffness[row] * depth(force) - force
        still = remainder.receptance(np.zeros(1))[0][0].real + remainder.flexible
        out[0] += still @ lacking
        return out.ravel()

    def stretch(self, motion: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray]:
        """Return stretches and rates (T, m) over a period."""
        make, slope, _ = self._series
        parts = motion.reshape(-1, self.remainder.rows)
        return make @ parts, omega * (slope @ parts)

    def residual(self, motion: np.ndarray, omega: float) -> Residual:
        """Compute the residual of the balance at a motion (n,) and a frequency, rad/s."""
        remainder = self.remainder
        make, slope, read = self._series
        s, v = self.stretch(motion, omega)
        line = self.line(omega)
        excess, carries = remainder.excess(s, v, self.factor, line)
        parts, slopes = self._parts(excess, s, line)
        h = np.arange(self.count + 1)
        receptance, change = remainder.receptance(h * omega)
        linear, linear_change = remainder.linear(omega, self.count)
        still, soft = parts, slopes
        by_omega = np.zeros_like(parts)
        if remainder.drags:
            if remainder.flexible.any():
                at_rest = remainder.excess(s, np.zeros_like(v), self.factor, self.line(0.0))[0]
                still, soft = self._parts(at_rest, s, line)
            slopes = slopes + omega * over_parts(read, excess.by_rate, slope)
            by_omega = read @ np.einsum("tij,tj->ti", excess.by_rate, v / omega)
            if line is not None:
                drift = (line.with_drift(s, v) - v) / omega
                by_omega += read @ np.einsum("tij,tj->ti", excess.by_rate - remainder.damper, drift)
            added, by_added = self._leaps(s, v, line, omega)
            parts, slopes, by_omega = parts + added, slopes + by_added, by_omega + added / omega
        changed = as_real(linear_change) + apply_to_parts(h[:, None, None] * change, parts)
        changed = changed + apply_to_parts(receptance, by_omega)
        moved = apply_to_parts(receptance, parts) + still @ remainder.flexible
        by_motion = apply_to_parts(receptance, slopes.reshape(len(parts), -1)).reshape(slopes.shape)
        if remainder.flexible.any():
            by_motion = by_motion + np.einsum("ij,njkl->nikl", remainder.flexible, soft)
        jacobian = np.eye(motion.size) - by_motion.reshape((motion.size,) * 2)
        value = motion - (as_real(linear) + moved).ravel()
        return Residual(value, jacobian, -changed.ravel(), carries or not remainder.hangs)

    def _parts(
        self, excess: Force, s: np.ndarray, line: Line | None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return coefficients (2H+1, m) of an excess, and their derivatives (2H+1, m, 2H+1, m) by
        those of the stretch.

        Between two instants on both sides of a kink of a law a sampled sum takes a straight line
        for a bent one; the difference is added, exact for a straight stretch. Without it the error
        jumps as kinks pass from one interval to the next, and a branch has false folds.
        """
        make, _, read = self._series
        parts, slopes = read @ excess.value, over_parts(read, excess.by_stretch, make)
        for kink in kinks(self.remainder, s, line):
            gap, first = kink.gap, kink.crossed
            if not len(first):
                continue
            ends = first, (first + 1) % len(gap)
            u, v = (np.abs(gap[end]) for end in ends)
            # slopes of u v / (u + v)
            weights = [
                np.sign(gap[end]) * (opposite / (u + v)) ** 2 for end, opposite in zip(ends, (v, u))
            ]
            bent = sum(
                slope[:, None, None] * make[end][:, :, None] * kink.direction[end][:, None, :]
                for end, slope in zip(ends, weights)
            )
            for end in ends:
                weight = kink.jump / 4 * read[:, end]
                share = 1.0 if self.factor is None else self.factor[end]
                direction, area = share * kink.direction[end], u * v / (u + v)
                parts += (weight * area) @ direction
                slopes += np.einsum("hk,ki,knj->hinj", weight, direction, bent)
                if kink.bend is not None:
                    turned = area[:, None, None] * np.reshape(share, (-1, 1, 1)) * kink.bend[end]
                    slopes += np.einsum("hk,kij,kn->hinj", weight, turned, make[end])
        return parts, slopes

    def _leaps(
        self, s: np.ndarray, v: np.ndarray, line: Line | None, omega: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the same as :meth:`_parts` adds, for dampers that set in at once: where in an
        interval.
        """
        make, slope, read = self._series
        parts = np.zeros((len(read), s.shape[1]))
        slopes = np.zeros((*parts.shape, *parts.shape))
        for kink in kinks(self.remainder, s, line):
            gap, first = kink.gap, kink.crossed
            if not len(first) or not kink.damper:
                continue
            speed = kink.speed(s, v)
            after = (first + 1) % len(gap)
            ends = np.where(gap[first] > 0, (first, after), (after, first))
            inside, outside = np.abs(gap[ends])
            share = inside / (inside + outside)
            bent = sum(
                (opposite / (inside + outside) ** 2)[:, None, None]
                * make[end][:, :, None]
                * kink.direction[end][:, None, :]
                for end, opposite in zip(ends, (outside, inside))
            )
            # a product that is linear between both ends, from where it sets in
            weights = (-((1 - share) ** 2) / 2, share**2 / 2)
            for end, much, more in zip(ends, weights, (1 - share, share)):
                weight = -kink.damper * read[:, end]
                direction = kink.direction[end]
                rates = omega * slope[end][:, :, None] * direction[:, None, :]
                if kink.turning is not None:
                    rates = rates + make[end][:, :, None] * kink.turning[end][:, None, :]
                if self.factor is not None:
                    direction = direction * self.factor[end]
                parts += (weight * (much * speed[end])) @ direction
                changes = much[:, None, None] * rates + (more * speed[end])[:, None, None] * bent
                slopes += np.einsum("hk,ki,knj->hinj", weight, direction, changes)
        return parts, slopes

    def solve(
        self,
        motion: np.ndarray,
        omega: float,
        *,
        steps: int = 4 * ITERATIONS,
        close: float = ARRIVED,
        far: float | None = None,
    ) -> np.ndarray:
        """Return the motion (n,) at a frequency by Newton's method, from a guess.

        It ends at a last change below `close`, relative; it is given up after `steps`, or beyond
        `far` times the size of the guess, with SolidgearError.
        """
        most = np.inf if far is None else far * np.abs(motion).max()
        for _ in range(steps):
            residual = self.residual(motion, omega)
            if not residual.carries:
                break
            step = np.linalg.solve(residual.jacobian, -residual.value)
            motion = motion + step
            if not np.abs(motion).max() < most:
                break
            if np.abs(step).max() <= close * np.abs(motion).max():
                return motion
        raise SolidgearError("harmonic balance does not converge from this motion; begin nearer")

    def resized(self, motion: np.ndarray, count: int) -> tuple[Balance, np.ndarray]:
        """Return the same motion with more harmonics, the new ones zero, or fewer."""
        parts = as_complex(motion.reshape(-1, self.remainder.rows))
        out = np.zeros((count + 1, self.remainder.rows), complex)
        out[: len(parts)] = parts[: count + 1]
        return Balance(self.remainder, count, self.instants), as_real(out).ravel()

    def tail(self, motion: np.ndarray) -> float:
        """Return the largest of the two highest harmonics over that of all but the mean."""
        size = np.abs(as_complex(motion.reshape(-1, self.remainder.rows))[1:]).max(axis=1)
        return float(size[-2:].max() / max(size.max(), np.finfo(float).tiny))


def over_parts(read: np.ndarray, tangent: np.ndarray, make: np.ndarray) -> np.ndarray:
    """Return coefficients (2H+1, m, 2H+1, m) of a force by those of the motion that the tangent (T,
    m, m) acts on.
    """
    m = tangent.shape[1]
    out = np.empty((len(read), m, make.shape[1], m))
    for i, j in np.ndindex(m, m):
        out[:, i, :, j] = read @ (tangent[:, i, j, None] * make)
    return out


def apply_to_parts(matrix: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Apply matrices (H+1, m, m) to coefficients (2H+1, m), or to columns of them (2H+1, m k)."""
    count, m = len(matrix) - 1, matrix.shape[1]
    columns = parts.reshape(len(parts), m, -1)
    cosines, sines = columns[1 : count + 1], columns[count + 1 :]
    real, imag = matrix[1:].real, matrix[1:].imag
    out = [
        matrix[:1].real @ columns[:1],
        real @ cosines + imag @ sines,
        real @ sines - imag @ cosines,
    ]
    return np.concatenate(out).reshape(parts.shape)
