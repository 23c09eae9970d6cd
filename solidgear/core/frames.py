"""Six-component motions and loads under a change of reference point.

Order everywhere: ``(x, y, z, thx, thy, thz)``, y along the shaft, SI units. A small rotation ``th``
about the reference point moves a point at offset ``r`` by ``th x r``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

DOF_NAMES = ("x", "y", "z", "thx", "thy", "thz")


def cross_matrix(r: np.ndarray | Sequence[float]) -> np.ndarray:
    """Return the (3, 3) skew-symmetric matrix of the cross product, ``[r] v = r x v``.

    Examples
    --------
    >>> cross_matrix([1.0, 0.0, 0.0]) @ [0.0, 1.0, 0.0]  # x cross y is z
    array([0., 0., 1.])
    """
    x, y, z = r
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def shift(offset: ArrayLike) -> np.ndarray:
    """Return the (6, 6) adjoint T to a reference point `offset` (m) from the old one.

    ``motion_new = T motion_old``; loads go the other way, ``load_old = T.T load_new``.

    Examples
    --------
    A shaft that tilts by 1 mrad about x rises by 0.1 mm at a point 0.1 m further along y:

    >>> motion = shift([0.0, 0.1, 0.0]) @ [0.0, 0.0, 0.0, 1e-3, 0.0, 0.0]
    >>> round(float(motion[2]), 9)
    0.0001
    """
    out = np.eye(6)
    out[:3, 3:] = -cross_matrix(np.asarray(offset, float))
    return out


def on_axis(place: float | Sequence[float]) -> np.ndarray:
    """Return a point (3,), or the point of the axis at y, m.

    Examples
    --------
    >>> on_axis(0.2), on_axis([0.1, 0.2, 0.3])
    (array([0. , 0.2, 0. ]), array([0.1, 0.2, 0.3]))
    """
    return np.array([0.0, place, 0.0] if np.ndim(place) == 0 else place, float)


def rotation(axis: int, angle: float) -> np.ndarray:
    """Return the (6, 6) right-handed rotation of motions and loads about axis 0, 1 or 2 by `angle`
    (rad).

    Examples
    --------
    A quarter turn about y carries z into x:

    >>> import numpy as np
    >>> np.round(rotation(1, np.pi / 2) @ [0.0, 0.0, 1.0, 0.0, 0.0, 0.0], 12) + 0.0
    array([1., 0., 0., 0., 0., 0.])
    """
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    q = np.eye(3)
    q[i, i] = q[j, j] = c
    q[i, j], q[j, i] = -s, s
    return np.kron(np.eye(2), q)
