r"""A whole wheel of equal pitches from the matrices of one, seen from its two sides.

A pitch of stiffness K is condensed to the motion q of its left side and that of its right one, which
is the left side of the next pitch clockwise.  With the condensed stiffness S and loads g,

    (S_LL + S_RR) q_j + S_LR q_{j+1} + S_RL q_{j-1} = g_L,j + g_R,j-1,

which is cyclic: loads that grow from pitch to pitch by the factor ``p = exp(2 pi i n / z)``, a wave n,
are answered by motions that do, and by a Hermitian matrix

    S_LL + S_RR + p S_LR + S_RL / p

(Thomas, International Journal for Numerical Methods in Engineering 14, 1979, p. 81-102).  Loads on one
pitch alone are the mean of z such waves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from solidgear.core.solve.factor import factorise


@dataclass(frozen=True, eq=False)
class CondensedPitch:
    """A pitch seen from its sides, in the frame of tooth 0; its right side moves in that of tooth 1."""

    stiffness: np.ndarray  #: (2 q, 2 q)
    loads: np.ndarray  #: (2 q, m) of unit loads within the pitch
    readings: np.ndarray  #: (r, 2 q) motions within it by the motions of the sides
    direct: np.ndarray  #: (r, m) motions by loads, while the sides stand still

    def response(self, wave: int, count: int) -> np.ndarray:
        """Return the (r, m) complex motions of a pitch by loads that grow as a wave around so many
        pitches.
        """
        q = len(self.stiffness) // 2
        factor = np.exp(2j * np.pi * wave / count)
        ahead = factor * self.stiffness[:q, q:]
        matrix = self.stiffness[:q, :q] + self.stiffness[q:, q:] + ahead + ahead.conj().T
        load = self.loads[:q] + np.conj(factor) * self.loads[q:]
        reading = self.readings[:, :q] + factor * self.readings[:, q:]
        return self.direct + reading @ np.linalg.solve(matrix, load)


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
    readings : (r, n) csr_matrix
        Rows of the motions that are read.
    """
    rows = stiffness[inner]
    across = rows @ sides
    factor = factorise(rows[:, inner].tocsr())
    count = sides.shape[1]
    solved = factor.solve(sp.hstack([across, loads[inner]]).toarray())
    follow, alone = -solved[:, :count], solved[:, count:]
    read = readings[:, inner]
    on_sides = (sides.T @ (stiffness @ sides)).toarray() + across.T @ follow
    return CondensedPitch(
        (on_sides + on_sides.T) / 2,
        (sides.T @ loads).toarray() - across.T @ alone,
        read @ follow + (readings @ sides).toarray(),
        read @ alone,
    )


def at_pitch(responses: np.ndarray, pitch: int, count: int) -> np.ndarray:
    """Return the (r, m) motions of a pitch by loads on pitch 0 alone, from the (waves, r, m) responses
    to the waves from 0 to half the count.

    Examples
    --------
    Three masses that do not know of each other:

    >>> alone = np.ones((2, 1, 1), complex)
    >>> [round(abs(at_pitch(alone, pitch, 3).item()), 12) for pitch in range(3)]
    [1.0, 0.0, 0.0]
    """
    wave = np.arange(len(responses))
    # a wave and its conjugate run around in opposite senses, unless they are the same
    times = np.where((wave == 0) | (2 * wave == count), 1, 2) / count
    factor = times * np.exp(2j * np.pi * wave * pitch / count)
    by_parts = np.tensordot(factor.real, responses.real, 1)
    return by_parts - np.tensordot(factor.imag, responses.imag, 1)
