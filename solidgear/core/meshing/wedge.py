"""Exponents of displacement at the tip of wedges of several materials, bonded side by side.

Displacements ``r^a g(theta)`` in plane strain are in equilibrium with faces free or held where

    (K + a (C - C') - a^2 M) g = 0,

K, C and M being integrals along the angle of strains that do not and that do grow with a: the roots
are eigenvalues of a small matrix, none is looked for.  Across the plane ``C`` vanishes.  Functions
are polynomials of high order along each wedge, to which g is smooth: eight digits.  In a body of
revolution both problems rule near an edge (Williams 1952, J. Appl. Mech. 19, 526; Bogy 1971, J. Appl.
Mech. 38, 377).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.meshing.lobatto import gauss, lobatto

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Material

#: order of the polynomials along a wedge
ORDER = 12
#: angles, rad, that differ by less are one
SAME_ANGLE = 1e-9
#: angle of a wedge, rad, and its material
Wedge = tuple[float, "Material"]


def wedge_exponent(wedges: Sequence[Wedge], held: int = 0, closed: bool = False) -> float:
    """Return the least exponent of displacement, its real part, at the tip of wedges side by side; one
    at most. Of the two outer faces none, the first or both are held, by one rigid body; of wedges all
    around, `closed`, there are none.

    Examples
    --------
    >>> import numpy as np
    >>> from solidgear.core.scene import Material
    >>> steel = Material(E=2.07e11, nu=0.3, density=7850)
    >>> rubber = Material(E=2e9, nu=0.49, density=1400)
    >>> round(wedge_exponent([(1.5 * np.pi, steel)]), 4)
    0.5445
    >>> round(wedge_exponent([(0.5 * np.pi, steel), (0.5 * np.pi, rubber)]), 3)
    0.612
    >>> round(wedge_exponent([(0.5 * np.pi, rubber), (0.5 * np.pi, steel)], held=1), 3)
    0.058
    """
    if len(wedges) == 1 and not held and wedges[0][0] <= pi + SAME_ANGLE:
        return 1.0
    stiff = max(material.E for _, material in wedges)
    plain = tuple((round(float(a), 9), float(m.E / stiff), float(m.nu)) for a, m in wedges)
    return _exponent(plain, held, closed)


@lru_cache(maxsize=256)
def _exponent(wedges: tuple[tuple[float, float, float], ...], held: int, closed: bool) -> float:
    roots = []
    for law, count in LAWS:
        laws = [(angle, law(e, nu)) for angle, e, nu in wedges]
        roots.append(_exponents(_matrices(laws, count, closed), count, held))
    return float(min(*np.concatenate(roots), 1.0))


def _exponents(matrices: _Matrices, count: int, held: int) -> np.ndarray:
    """Return the real parts of the exponents above zero, of displacements of `count` components.

    Roots come in pairs of either sign. Where nothing is held, translations and their logarithms are
    roots at zero, which rounding parts.
    """
    roots = _roots(*matrices, count * held)
    if not held:
        roots = roots[np.argsort(np.abs(roots))][2 * count :]
    return roots.real[roots.real > 0]


#: M, C and K
_Matrices = tuple[np.ndarray, np.ndarray, np.ndarray]
#: elasticity, and the strains of functions that do and that do not grow with the exponent: of value
#: and slope along the angle, (strain, component) each
_Law = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def _plane(e: float, nu: float) -> _Law:
    """Return radial and hoop strain and shear of displacements (radial, hoop)."""
    shear = e / (2 * (1 + nu))
    bulk = 2 * shear * nu / (1 - 2 * nu)
    elasticity = np.array([[bulk + 2 * shear, bulk, 0], [bulk, bulk + 2 * shear, 0], [0, 0, shear]])
    growing = np.array([[1.0, 0], [0, 0], [0, 1]])
    value = np.array([[0.0, 0], [1, 0], [0, -1]])
    slope = np.array([[0.0, 0], [0, 1], [1, 0]])
    return elasticity, growing, value, slope


def _across(e: float, nu: float) -> _Law:
    """Return both shears of a displacement across the plane."""
    elasticity = e / (2 * (1 + nu)) * np.eye(2)
    return elasticity, np.array([[1.0], [0]]), np.zeros((2, 1)), np.array([[0.0], [1]])


#: strains in the plane and across it, and the components of displacement that make them
LAWS: tuple[tuple[Callable[[float, float], _Law], int], ...] = ((_plane, 2), (_across, 1))


def _matrices(
    wedges: Sequence[tuple[float, _Law]], components: int, closed: bool = False
) -> _Matrices:
    """Return M, C and K of wedges, unknowns by places along the angle."""
    size = components * (ORDER * len(wedges) + (not closed))
    m, c, k = (np.zeros((size, size)) for _ in range(3))
    points, weights = gauss(ORDER + 2)
    value, slope = lobatto(ORDER, points)
    for n, (angle, (elasticity, growing, still, turning)) in enumerate(wedges):
        by_value = np.einsum("qn,sc->qsnc", value, still)
        by_slope = np.einsum("qn,sc->qsnc", slope / angle, turning)
        steady = (by_value + by_slope).reshape(len(points), len(elasticity), -1)
        rising = np.einsum("qn,sc->qsnc", value, growing).reshape(steady.shape)
        # both outer faces first
        faces = [*range(len(wedges)), 0] if closed else [0, *range(2, len(wedges) + 1), 1]
        inside = len(set(faces)) + (ORDER - 1) * n + np.arange(ORDER - 1)
        places = np.r_[faces[n], faces[n + 1], inside]
        rows = (components * places[:, None] + np.arange(components)).ravel()
        for matrix, left, right in ((m, rising, rising), (c, steady, rising), (k, steady, steady)):
            part = np.einsum("q,qsi,st,qtj->ij", angle * weights, left, elasticity, right)
            matrix[np.ix_(rows, rows)] += part
    return m, c, k


def _roots(m: np.ndarray, c: np.ndarray, k: np.ndarray, held: int) -> np.ndarray:
    """Return the exponents, with so many of the unknowns held."""
    m, c, k = (matrix[held:, held:] for matrix in (m, c, k))
    left = np.linalg.solve(m, np.hstack([k, c - c.T]))
    size = len(m)
    return np.linalg.eigvals(np.vstack([np.hstack([np.zeros((size, size)), np.eye(size)]), left]))
