r"""A whole wheel of equal pitches from the matrices of one, seen from its two sides.

A pitch of stiffness K that is held at its rim is condensed to the motion q of its left side and that
of its right one, which is the left side of the next pitch clockwise, turned by the pitch angle phi.
With S the condensed stiffness and g the condensed loads,

    S_LL q_j + S_LR q_{j+1} + S_RL q_{j-1} + S_RR q_j = g_L,j + g_R,j-1,

which is cyclic: the wave ``q_j = sum_k e^{i k phi j} q_k`` decouples it into Hermitian matrices

    A_k = S_LL + S_RR + e^{i k phi} S_LR + e^{-i k phi} S_RL

(Thomas, International Journal for Numerical Methods in Engineering 14, 1979, p. 81-102).  On the sides
motions may be smooth functions along the face: the loads are half a pitch away.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from solidgear.core.solve.factor import factorise


@dataclass(frozen=True, eq=False)
class CondensedPitch:
    """A pitch seen from its sides, in the frame of tooth 0; the right side moves in the frame of
    tooth 1.
    """

    stiffness: np.ndarray  #: (2 q, 2 q)
    loads: np.ndarray  #: (2 q, m) of unit loads within the pitch
    readings: np.ndarray  #: (p, 2 q) motions within it by the motions of the sides
    direct: np.ndarray  #: (p, m) motions by loads, with sides that stand still

    @property
    def half(self) -> int:
        """Number of motions of a side."""
        return len(self.stiffness) // 2


def condensed(
    stiffness: sp.csr_matrix,
    inner: np.ndarray,
    sides: sp.csr_matrix,
    loads: sp.csr_matrix,
    readings: sp.csr_matrix,
) -> CondensedPitch:
    """Condense a pitch.

    Parameters
    ----------
    stiffness : (n, n) csr_matrix
    inner : (i,) ndarray of int
        Unknowns neither on the sides nor held.
    sides : (n, 2 q) csr_matrix
        Motions of the unknowns on the sides by those of the left and of the right side.
    loads : (n, m) csr_matrix
        Unit loads.
    readings : (p, n) csr_matrix
        Rows of motions that are asked for.
    """
    rows = stiffness[inner]
    across = rows @ sides
    factor = factorise(rows[:, inner].tocsr())
    count = sides.shape[1]
    solved = factor.solve(sp.hstack([across, loads[inner]]).toarray())
    follow, alone = -solved[:, :count], solved[:, count:]
    read = readings[:, inner]
    on_sides = (sides.T @ stiffness @ sides).toarray() + across.T @ follow
    return CondensedPitch(
        (on_sides + on_sides.T) / 2,
        (sides.T @ loads).toarray() - across.T @ alone,
        read @ follow + (readings @ sides).toarray(),
        read @ alone,
    )


@dataclass(frozen=True, eq=False)
class Ring:
    """A whole wheel of pitches."""

    pitch: CondensedPitch
    count: int

    def phase(self, wave: int) -> complex:
        """Return the factor from a pitch to the next in a wave."""
        return complex(np.exp(2j * np.pi * wave / self.count))

    @cached_property
    def _inverses(self) -> list[np.ndarray]:
        """(q, q) inverse matrix of each wave from 0 to half the count."""
        s, q = self.pitch.stiffness, self.pitch.half
        inverses = []
        for wave in range(self.count // 2 + 1):
            ahead = self.phase(wave) * s[:q, q:]
            inverses.append(np.linalg.inv(s[:q, :q] + s[q:, q:] + ahead + ahead.conj().T))
        return inverses

    def waves(self, loads: np.ndarray, amplitudes: list[np.ndarray] | None = None) -> np.ndarray:
        """Return the (w, q, k) waves of the motion of left sides.

        Parameters
        ----------
        loads : (2 q, m) ndarray
            Condensed loads.
        amplitudes : list of (m, k) ndarray, optional
            Of the loads in each wave; by default they act on pitch 0 alone.
        """
        q = self.pitch.half
        waves = []
        for wave, inverse in enumerate(self._inverses):
            load = loads[:q] + np.conj(self.phase(wave)) * loads[q:]
            waves.append(inverse @ (load if amplitudes is None else load @ amplitudes[wave]))
        return np.array(waves)

    def sides(self, waves: np.ndarray, pitch: int) -> np.ndarray:
        """Return the (2 q, k) motion of both sides of a pitch."""
        return np.concatenate([self._left(waves, pitch), self._left(waves, pitch + 1)])

    def _left(self, waves: np.ndarray, pitch: int) -> np.ndarray:
        order = np.arange(len(waves))
        # a wave and its conjugate run around in opposite senses, unless they are the same
        times = np.where((order == 0) | (2 * order == self.count), 1, 2) / self.count
        factor = times * np.exp(2j * np.pi * order * pitch / self.count)
        return np.tensordot(factor.real, waves.real, 1) - np.tensordot(factor.imag, waves.imag, 1)
