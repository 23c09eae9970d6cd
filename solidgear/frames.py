"""Six-component motions and loads under a change of reference point.

Order everywhere: ``(x, y, z, thx, thy, thz)``, y along the shaft, SI units.
A small rotation ``th`` about the reference point moves a point at offset ``r``
by ``th x r``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

DOF_NAMES = ("x", "y", "z", "thx", "thy", "thz")


def cross_matrix(r: np.ndarray | Sequence[float]) -> np.ndarray:
    """Matrix ``[r]`` with ``[r] v = r x v``, shape (3, 3)."""
    x, y, z = r
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def shift(offset: ArrayLike) -> np.ndarray:
    """Adjoint that carries a motion to another reference point.

    Parameters
    ----------
    offset : (3,) array_like
        Vector from the old to the new reference point, in m.

    Returns
    -------
    (6, 6) ndarray
        ``T`` with ``motion_new = T motion_old``; loads go the other way,
        ``load_old = T.T load_new``.
    """
    out = np.eye(6)
    out[:3, 3:] = -cross_matrix(np.asarray(offset, float))
    return out


def move_stiffness(stiffness: ArrayLike, offset: ArrayLike) -> np.ndarray:
    """6x6 stiffness seen from a reference point displaced by ``offset`` (m).

    The two points are joined rigidly; ``K_new = T^-T K_old T^-1`` with
    ``T = shift(offset)``, and the inverse of a shift is the opposite shift.
    """
    back = shift(-np.asarray(offset, float))
    return back.T @ np.asarray(stiffness, float) @ back


def move_compliance(compliance: ArrayLike, offset: ArrayLike) -> np.ndarray:
    """6x6 compliance seen from a point displaced by ``offset`` (m): ``T C T'``."""
    forth = shift(offset)
    return forth @ np.asarray(compliance, float) @ forth.T


def rotation(axis: int, angle: float) -> np.ndarray:
    """(6, 6) rotation of motions and loads about coordinate ``axis`` by ``angle`` (rad)."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    q = np.eye(3)
    q[i, i] = q[j, j] = c
    q[i, j], q[j, i] = -s, s
    return np.kron(np.eye(2), q)
