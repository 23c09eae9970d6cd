r"""Harmonic balance with two base frequencies: teeth in mesh, and something slow that they ride on.

Stretches are a double Fourier series over the angles of both,

    s = sum S_jk exp(i (j w_1 + k w_2) t),        S_jk = S_lin,jk + H(j w_1 + k w_2) P_jk + F p_jk,

so that lines at ``j w_1 + k w_2`` are the sidebands of the mesh.  The excess force of the laws is
taken on a grid of both angles.  The rest is :mod:`solidgear.nonlinear.balance`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.machine.threads import pinned
from solidgear.nonlinear.balance import (
    ARRIVED,
    Residual,
    applied,
    as_complex,
    as_real,
    over_parts,
)
from solidgear.nonlinear.model import Remainder

#: steps of Newton's method, and halvings of one that leads away
ITERATIONS, HALVINGS = 40, 8


@dataclass(frozen=True, eq=False)
class TwoTone:
    """The equations of a system under two excitations of their own frequencies.

    Raises
    ------
    SolidgearError
        For laws of straight pieces, whose corners a grid does not see.

    Examples
    --------
    A mass on a Hertzian contact, pushed at 2 and at 0.1 rad/s, has sidebands:

    >>> from solidgear.nonlinear.model import remainder
    >>> from solidgear.system import Inertia, RowSpring, System
    >>> from solidgear.system.law import Gap
    >>> law = Gap(1.0, 0.0, exponent=1.5)
    >>> spring = RowSpring("mass", [0, 0, 1, 0, 0, 0], law.stiffness(1.0), law=law)
    >>> one = System({"mass": Inertia(1.0, "z")}, {"contact": spring})
    >>> known = dict(loss={"contact": 0.1}, load=np.ones(1))
    >>> fast, slow = (remainder(one, forces=[[size]], **known) for size in (0.5, 0.2))
    >>> lines = TwoTone(fast, slow, (2.0, 0.1), (4, 4)).lines()
    >>> [round(float(abs(lines[1, k][0])), 4) for k in (-1, 0, 1)]
    [0.0047, 0.1985, 0.0034]
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
        """Multiples (j, k) of both frequencies, the constant first; of (j, k) and (-j, -k) one."""
        fast, slow = self.counts
        first = [(0, k) for k in range(slow + 1)]
        return (*first, *((j, k) for j in range(1, fast + 1) for k in range(-slow, slow + 1)))

    @property
    def frequencies(self) -> np.ndarray:
        """(p,) of all pairs, rad/s, some negative."""
        return np.array(self.pairs) @ np.array(self.omega)

    @cached_property
    def _angles(self) -> np.ndarray:
        """(T, 2) of the grid."""
        turns = (2 * np.pi * np.arange(count) / count for count in self.instants)
        return np.stack(np.meshgrid(*turns, indexing="ij"), axis=-1).reshape(-1, 2)

    @cached_property
    def _series(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Synthesis (T, 2p-1) of a0, a, b, the rate of it, and analysis."""
        angle, w = self._angles @ np.array(self.pairs[1:]).T, self.frequencies[1:]
        c, s = np.cos(angle), np.sin(angle)
        make = np.hstack([np.ones((len(angle), 1)), c, s])
        rate = np.hstack([np.zeros((len(angle), 1)), -w * s, w * c])
        read = 2 / len(angle) * make.T
        read[0] /= 2
        return make, rate, read

    @cached_property
    def factor(self) -> np.ndarray | None:
        """(T, m) what forces are multiplied by at every instant; None where nothing varies."""
        if not (self.fast.varies or self.slow.varies):
            return None
        fast, slow = self._angles.T
        return self.fast.factor(fast) * self.slow.factor(slow)

    @cached_property
    def linear(self) -> np.ndarray:
        """(n,) motion of the linear system."""
        out = np.zeros((len(self.pairs), self.fast.rows), complex)
        own, other = (
            one.linear(w, count)[0]
            for one, w, count in zip((self.fast, self.slow), self.omega, self.counts)
        )
        for k, (fast, slow) in enumerate(self.pairs):
            if not slow:
                out[k] = own[fast]
            elif not fast:
                out[k] = other[slow]
        return as_real(out).ravel()

    @cached_property
    def _moves(self) -> np.ndarray:
        """(p, m, m) receptance at all pairs."""
        return self.fast.receptance(self.frequencies)[0]

    def waves(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Stretches and rates (T, m) on the grid."""
        make, rate, _ = self._series
        parts = motion.reshape(-1, self.fast.rows)
        return make @ parts, rate @ parts

    def residual(self, motion: np.ndarray) -> Residual:
        """Residual of the balance at a motion (n,)."""
        own = self.fast
        make, rate, read = self._series
        s, v = self.waves(motion)
        excess, held = own.excess(s, v, self.factor)
        parts, by = read @ excess.value, over_parts(read, excess.by_stretch, make)
        still, soft = parts, by
        if own.drags:
            by = by + over_parts(read, excess.by_rate, rate)
        if own.drags and own.flexible.any():
            slowly, _ = own.excess(s, np.zeros_like(v), self.factor)
            still = read @ slowly.value
            soft = over_parts(read, slowly.by_stretch, make)
        moved = applied(self._moves, parts) + still @ own.flexible
        taken = applied(self._moves, by.reshape(len(parts), -1)).reshape(by.shape)
        taken = taken + np.einsum("ij,njkl->nikl", own.flexible, soft)
        jacobian = np.eye(motion.size) - taken.reshape((motion.size,) * 2)
        value = motion - self.linear - moved.ravel()
        return Residual(value, jacobian, np.zeros(0), held or not own.hangs)

    @cached_property
    def start(self) -> np.ndarray:
        """(n,) motion of the linear system around where laws carry its mean forces."""
        out = self.linear.reshape(-1, self.fast.rows).copy()
        mean = np.diag(self.fast.stiffness) * self.fast.mean
        for law, at in self.fast.laws:
            depth = getattr(law, "depth", None)
            if depth is not None:
                out[0, at] = [depth(force) for force in mean[at]]
        return out.ravel()

    @pinned
    def solve(self, motion: np.ndarray | None = None) -> np.ndarray:
        """Motion (n,) by Newton's method, from a guess or from the linear one.

        Raises
        ------
        SolidgearError
            If it does not converge; begin nearer.
        """
        motion = self.start if motion is None else motion
        left = self.residual(motion)
        for _ in range(ITERATIONS):
            step = np.linalg.solve(left.jacobian, -left.value)
            for _ in range(HALVINGS):
                after = self.residual(motion + step)
                if np.linalg.norm(after.value) <= np.linalg.norm(left.value):
                    break
                if np.abs(step).max() <= ARRIVED * np.abs(motion).max():
                    return motion
                step = step / 2
            motion, left = motion + step, after
            if np.abs(step).max() <= ARRIVED * np.abs(motion).max():
                return motion
        raise SolidgearError(
            "the balance of two frequencies does not converge from this motion; begin nearer"
        )

    def lines(self, motion: np.ndarray | None = None) -> dict[tuple[int, int], np.ndarray]:
        """(m,) complex amplitude of the stretches at every pair, solved for without a motion."""
        motion = self.solve() if motion is None else motion
        found = as_complex(motion.reshape(-1, self.fast.rows))
        return dict(zip(self.pairs, found))

    def force_lines(self, motion: np.ndarray) -> dict[tuple[int, int], np.ndarray]:
        """(m,) complex amplitude of the forces of the laws at every pair, N."""
        forces = self.fast.forces(*self.waves(motion), self.factor).value
        return dict(zip(self.pairs, as_complex(self._series[2] @ forces)))
