r"""Harmonic balance with two base frequencies: teeth in mesh, and something slow that they ride on.

Stretches are a double Fourier series over the angles of both,

    s = sum S_jk exp(i (j w_1 + k w_2) t),        S_jk = S_lin,jk + H(j w_1 + k w_2) P_jk + F p_jk,

so that lines at ``j w_1 + k w_2`` are the sidebands of the mesh.  The excess force of the laws is
taken on a grid of both angles.  The rest is :mod:`solidgear.backlash.solver.balance`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.backlash.solver.balance import (
    ARRIVED,
    Residual,
    apply_to_parts,
    as_complex,
    as_real,
    over_parts,
)
from solidgear.backlash.solver.model import Remainder
from solidgear.core import SolidgearError, pinned

#: steps of Newton's method, and halvings of one that leads away
ITERATIONS, HALVINGS = 40, 8


@dataclass(frozen=True, eq=False)
class TwoTone:
    """Equations of a system under two excitations, of different frequencies; refuse laws of
    straight pieces, whose corners a grid does not see.
    """

    #: fast, slow: one system under its constant load, with the excitation and the cycle of either
    #: frequency; where both have a cycle, forces are multiplied by both
    fast: Remainder
    slow: Remainder
    omega: tuple[float, float]  #: rad/s
    counts: tuple[int, int]  #: multiples of both frequencies
    instants: tuple[int, int] = (64, 64)  #: of the grid, over each angle

    def __post_init__(self):
        if any(law.kinks for law, _ in self.fast.laws):
            raise SolidgearError(
                "a law with a corner has no balance of two frequencies; give its edge a rounding"
            )

    @cached_property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Return multiples (j, k) of both frequencies, the constant first; either (j, k) or (-j,
        -k).
        """
        fast, slow = self.counts
        first = [(0, k) for k in range(slow + 1)]
        return (*first, *((j, k) for j in range(1, fast + 1) for k in range(-slow, slow + 1)))

    @property
    def frequencies(self) -> np.ndarray:
        """Return the frequencies (p,) of all pairs, rad/s, some negative."""
        return np.array(self.pairs) @ np.array(self.omega)

    @cached_property
    def _angles(self) -> np.ndarray:
        """Return the angles (T, 2) of the grid."""
        turns = (2 * np.pi * np.arange(count) / count for count in self.instants)
        return np.stack(np.meshgrid(*turns, indexing="ij"), axis=-1).reshape(-1, 2)

    @cached_property
    def _series(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return synthesis (T, 2p-1) of a0, a, b, the rate, and analysis."""
        angle, w = self._angles @ np.array(self.pairs[1:]).T, self.frequencies[1:]
        c, s = np.cos(angle), np.sin(angle)
        make = np.hstack([np.ones((len(angle), 1)), c, s])
        rate = np.hstack([np.zeros((len(angle), 1)), -w * s, w * c])
        read = 2 / len(angle) * make.T
        read[0] /= 2
        return make, rate, read

    @cached_property
    def factor(self) -> np.ndarray | None:
        """Return the factor (T, m) of forces at every instant; None where nothing varies."""
        if not (self.fast.varies or self.slow.varies):
            return None
        fast, slow = self._angles.T
        return self.fast.factor(fast) * self.slow.factor(slow)

    @cached_property
    def linear(self) -> np.ndarray:
        """Return the motion (n,) of the linear system."""
        out = np.zeros((len(self.pairs), self.fast.rows), complex)
        by_fast, by_slow = (
            remainder.linear(w, count)[0]
            for remainder, w, count in zip((self.fast, self.slow), self.omega, self.counts)
        )
        for k, (fast, slow) in enumerate(self.pairs):
            if not slow:
                out[k] = by_fast[fast]
            elif not fast:
                out[k] = by_slow[slow]
        return as_real(out).ravel()

    @cached_property
    def _moves(self) -> np.ndarray:
        """Return the receptance (p, m, m) at all pairs."""
        return self.fast.receptance(self.frequencies)[0]

    def waves(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return stretches and rates (T, m) on the grid."""
        make, rate, _ = self._series
        parts = motion.reshape(-1, self.fast.rows)
        return make @ parts, rate @ parts

    def residual(self, motion: np.ndarray) -> Residual:
        """Compute the residual of the balance at a motion (n,)."""
        remainder = self.fast
        make, rate, read = self._series
        s, v = self.waves(motion)
        excess, carries = remainder.excess(s, v, self.factor)
        parts, slopes = read @ excess.value, over_parts(read, excess.by_stretch, make)
        still, soft = parts, slopes
        if remainder.drags:
            slopes = slopes + over_parts(read, excess.by_rate, rate)
        if remainder.drags and remainder.flexible.any():
            slowly, _ = remainder.excess(s, np.zeros_like(v), self.factor)
            still = read @ slowly.value
            soft = over_parts(read, slowly.by_stretch, make)
        moved = apply_to_parts(self._moves, parts) + still @ remainder.flexible
        by_motion = apply_to_parts(self._moves, slopes.reshape(len(parts), -1)).reshape(
            slopes.shape
        )
        by_motion = by_motion + np.einsum("ij,njkl->nikl", remainder.flexible, soft)
        jacobian = np.eye(motion.size) - by_motion.reshape((motion.size,) * 2)
        value = motion - self.linear - moved.ravel()
        return Residual(value, jacobian, np.zeros(0), carries or not remainder.hangs)

    @cached_property
    def start(self) -> np.ndarray:
        """Return the motion (n,) of the linear system around the place where laws carry the mean
        forces.
        """
        out = self.linear.reshape(-1, self.fast.rows).copy()
        mean = np.diag(self.fast.stiffness) * self.fast.mean
        for law, rows in self.fast.laws:
            depth = getattr(law, "depth", None)
            if depth is not None:
                out[0, rows] = [depth(force) for force in mean[rows]]
        return out.ravel()

    @pinned
    def solve(self, motion: np.ndarray | None = None) -> np.ndarray:
        """Return the motion (n,) by Newton's method, from a guess or from the linear one; refuse
        one that does not converge.
        """
        motion = self.start if motion is None else motion
        residual = self.residual(motion)
        for _ in range(ITERATIONS):
            step = np.linalg.solve(residual.jacobian, -residual.value)
            for _ in range(HALVINGS):
                after = self.residual(motion + step)
                if np.linalg.norm(after.value) <= np.linalg.norm(residual.value):
                    break
                if np.abs(step).max() <= ARRIVED * np.abs(motion).max():
                    return motion
                step = step / 2
            motion, residual = motion + step, after
            if np.abs(step).max() <= ARRIVED * np.abs(motion).max():
                return motion
        raise SolidgearError(
            "the balance of two frequencies does not converge from this motion; begin nearer"
        )

    def lines(self, motion: np.ndarray | None = None) -> dict[tuple[int, int], np.ndarray]:
        """Return the complex amplitude (m,) of the stretches at every pair, solved for without a
        motion.
        """
        motion = self.solve() if motion is None else motion
        amplitudes = as_complex(motion.reshape(-1, self.fast.rows))
        return dict(zip(self.pairs, amplitudes))

    def force_lines(self, motion: np.ndarray) -> dict[tuple[int, int], np.ndarray]:
        """Return the complex amplitude (m,) of the forces of the laws at every pair, N."""
        forces = self.fast.forces(*self.waves(motion), self.factor).value
        return dict(zip(self.pairs, as_complex(self._series[2] @ forces)))
