"""Kinematics of a row of balls or rollers: the motion of a ring as felt at an azimuth.

Axes are those of the shaft: y along it, order ``(x, y, z, thx, thy, thz)``.  The azimuth phi counts
from x towards z.  A motion q of the inner ring (with the shaft) against the outer one moves a point
of the inner ring at radius R, height a along y and azimuth phi by

    radially   cos(phi) x + sin(phi) z + a (sin(phi) thx - cos(phi) thz)
    along y    y + R (cos(phi) thz - sin(phi) thx),

the components of ``u + th x r``.  A motion around the axis presses on no rolling element, so that
thy has no part: the torsional row of every stiffness here is exactly zero.

The load of a row is the gradient of the energy of the contacts, and the tangent the Hessian, so the
latter is symmetric.  Contacts can only press, their force grows with the approach and the distance
of two points is a convex function: the energy is convex in q, and the tangent positive
semidefinite.  Whatever minimises it, alone or with a shaft, is the one equilibrium there is.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from solidgear.bearings.hertz import STEEL_E, STEEL_NU

#: of (x, y, z, thx, thy, thz), those that contacts feel
FELT = [0, 1, 2, 3, 5]
_UPPER = np.triu_indices(5)
_PLACE = np.array(FELT)


class Contacts(NamedTuple):
    """Loads of the rolling elements of a row."""

    azimuth: np.ndarray  #: (n,) from x towards z, rad
    load: np.ndarray  #: (..., n) N; along the contact normal
    #: (..., n) contact angle, rad, positive where the shaft is pressed towards +y; NaN where
    #: unloaded
    angle: np.ndarray
    #: inner, outer: (..., n) largest pressure at both rings, Pa
    inner: np.ndarray
    outer: np.ndarray
    #: on_inner, on_outer: (..., n, slices) N, on the slices of each element at both rings; a ball
    #: is one slice
    on_inner: np.ndarray
    on_outer: np.ndarray


@dataclass(frozen=True)
class Elements:
    """Rolling elements of one row, and their place; lengths in m, angles in rad."""

    count: int
    #: diameter, pitch: of an element (mean), and of the circle of their centres
    diameter: float
    pitch: float
    angle: float = 0.0  #: nominal contact angle; 0 for deep grooves, cylindrical and needle rollers
    side: int = 1  #: which way the shaft is held by a contact angle: towards +y or -y
    #: radial internal clearance (diametral, as catalogues give it); negative is an interference
    clearance: float = 0.0
    preload: float = 0.0  #: how far the inner ring has been pushed into contact along y, m
    height: float = 0.0  #: of the elements' centres along y from the reference point
    first: float = 0.0  #: azimuth of the first element, from x towards z
    #: E, nu: of elements and rings
    E: float = STEEL_E
    nu: float = STEEL_NU

    @cached_property
    def azimuth(self) -> np.ndarray:
        """(count,) evenly spaced, rad."""
        return self.first + 2 * np.pi * np.arange(self.count) / self.count


def felt(
    radius: np.ndarray | float, height: np.ndarray | float, azimuth: np.ndarray | float
) -> np.ndarray:
    """Return the radial and axial motion (2, n, 5) of points of the inner ring under unit motions
    of it, columns x, y, z, thx, thz, from radius, m, height along y from the reference point, m,
    and azimuth, rad, (n,) each.

    Examples
    --------
    A tilt about x lifts the point on z by the radius towards -y:

    >>> import numpy as np
    >>> axial = felt(0.02, 0.0, np.pi / 2)[1, 0]
    >>> bool(np.allclose(axial, [0, 1, 0, -0.02, 0]))
    True
    """
    radius, height, azimuth = np.broadcast_arrays(
        np.atleast_1d(radius), np.atleast_1d(height), np.atleast_1d(azimuth)
    )
    c, s, zero = np.cos(azimuth), np.sin(azimuth), np.zeros_like(azimuth)
    radial = np.stack([c, zero, s, height * s, -height * c], axis=-1)
    axial = np.stack([zero, zero + 1.0, zero, -radius * s, radius * c], axis=-1)
    return np.stack([radial, axial])


def products(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return symmetric products ``(a b' + b a') / 2`` of rows (n, 5), upper triangles flattened,
    (n, 15): with weights on the left one matrix product makes any number of tangents.
    """
    i, j = _UPPER
    return (a[:, i] * b[:, j] + a[:, j] * b[:, i]) / 2


def symmetric(upper: np.ndarray) -> np.ndarray:
    """Return (..., 6, 6) from upper triangles (..., 15) in felt components; the row of thy is zero."""
    out = np.zeros((*upper.shape[:-1], 6, 6))
    i, j = _PLACE[_UPPER[0]], _PLACE[_UPPER[1]]
    out[..., i, j] = upper
    out[..., j, i] = upper
    return out


def six(load: np.ndarray) -> np.ndarray:
    """Return (..., 6) from the felt components (..., 5)."""
    out = np.zeros((*load.shape[:-1], 6))
    out[..., _PLACE] = load
    return out
