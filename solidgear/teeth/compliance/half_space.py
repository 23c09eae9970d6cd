r"""What gives way near a load, in closed form: a half-space under a force that is spread over a line.

A normal force on the surface moves the points at the depth h and the distance rho aside by

    u = (1 + nu) / (2 pi E) [ h^2 / R^3 + 2 (1 - nu) / R ],    R^2 = rho^2 + h^2,

along the normal (Johnson, Contact Mechanics, 1985, 3.22).  Spread over a piece of a line of the length
l and averaged over a like piece at the distance x along and p across it, 1 / R gives the second
difference, over steps of l and divided by l^2, of ``x asinh(x / c) - sqrt(x^2 + c^2)``, of which 1 / R
is the second derivative, and h^2 / R^3 that of ``h^2 / c^2 sqrt(x^2 + c^2)``, with c^2 = h^2 + p^2.
"""

from __future__ import annotations

from math import pi

import numpy as np

from solidgear.teeth.contact.local import Elasticity


def between_pieces(
    along: np.ndarray,
    across: np.ndarray,
    depth: float | np.ndarray,
    length: float | np.ndarray,
    material: Elasticity,
) -> np.ndarray:
    """Return the mean motion of pieces of lines at a depth by a unit force on other pieces, m/N.

    Parameters
    ----------
    along : (...,) ndarray
        Distance of the middles of both pieces along them, m.
    across : (...,) ndarray
        Square of their distance across, m^2.
    depth, length : float or (...,) ndarray
        Below the surface, and of every piece, m.
    material : Elasticity

    Examples
    --------
    Short pieces far apart: a force at a distance.

    >>> steel = Elasticity()
    >>> far = between_pieces(np.array(1.0), np.array(0.0), 1e-6, 1e-3, steel)
    >>> round(float(far * np.pi * 2.06e11 / (1 - 0.3**2)), 6)
    1.0
    """
    squared = depth**2 + across
    c = np.sqrt(squared)
    nu = material.poisson

    def integral(x: np.ndarray) -> np.ndarray:
        root = np.sqrt(x**2 + squared)
        return depth**2 / squared * root + 2 * (1 - nu) * (x * np.arcsinh(x / c) - root)

    difference = integral(along + length) - 2 * integral(along) + integral(along - length)
    return (1 + nu) / (2 * pi * material.youngs) * difference / length**2
