"""Products of integrated Legendre polynomials: functions of a quadrilateral of any order."""

from __future__ import annotations

from functools import lru_cache, reduce

import numpy as np


def lobatto(order: int, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return (..., order + 1) functions of one direction at x from 0 to 1, and their derivatives:
    ``1 - x`` and ``x`` first, then those that vanish at both ends.

    Examples
    --------
    >>> value, slope = lobatto(3, np.array([0.0, 1.0]))
    >>> np.round(value, 12) + 0.0
    array([[1., 0., 0., 0.],
           [0., 1., 0., 0.]])
    """
    t = 2 * np.asarray(x, float) - 1
    legendre = np.polynomial.legendre.legvander(t, max(order, 1))
    value, slope = np.empty((*t.shape, order + 1)), np.empty((*t.shape, order + 1))
    value[..., 0], value[..., 1] = (1 - t) / 2, (1 + t) / 2
    slope[..., 0], slope[..., 1] = -1.0, 1.0
    for k in range(2, order + 1):
        value[..., k] = (legendre[..., k] - legendre[..., k - 2]) / np.sqrt(2 * (2 * k - 1))
        slope[..., k] = np.sqrt(2 * (2 * k - 1)) * legendre[..., k - 1]
    return value, slope


def products(order: int, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return functions of a quadrilateral (..., (order + 1)^2, q) at reference points (..., q, 2),
    and their gradients with the direction first; the first direction counts slowest.
    """
    a, da = lobatto(order, points[..., 0])
    b, db = lobatto(order, points[..., 1])

    def product(u, v):
        outer = u[..., :, None] * v[..., None, :]
        return np.moveaxis(outer.reshape(*outer.shape[:-2], -1), -2, -1)

    return product(a, b), np.stack([product(da, b), product(a, db)])


@lru_cache(maxsize=32)
def at_nodes(order: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points ((order + 1)^2, 2) on which product functions are independent, and the matrix
    from values there to coefficients.
    """
    x = (1 - np.cos(np.pi * np.arange(order + 1) / order)) / 2
    a, b = np.meshgrid(x, x, indexing="ij")
    inverse = np.linalg.inv(lobatto(order, x)[0])
    return np.stack([a.ravel(), b.ravel()], axis=1), np.kron(inverse, inverse)


@lru_cache(maxsize=32)
def gauss(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points from 0 to 1 and weights of Gauss's rule."""
    x, w = np.polynomial.legendre.leggauss(count)
    return (x + 1) / 2, w / 2


@lru_cache(maxsize=32)
def gauss_box(count: int, dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points (dimension, n) from 0 to 1 and weights of the product of Gauss's rules."""
    x, w = gauss(count)
    points = np.array([g.ravel() for g in np.meshgrid(*(x,) * dimension, indexing="ij")])
    return points, reduce(np.multiply.outer, (w,) * dimension).ravel()


@lru_cache(maxsize=32)
def sides(order: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the places of functions among the products: of the four corners and then of the four
    sides, each in the sense of the coordinate; and of those that vanish on all sides.

    Sides are low, outer, high and inner, as in :data:`solidgear.core.meshing.cells.ENDS`.
    """
    place = np.arange((order + 1) ** 2).reshape(order + 1, order + 1)
    corner = [place[0, 0], place[1, 0], place[1, 1], place[0, 1]]
    on_side = np.concatenate([place[2:, 0], place[1, 2:], place[2:, 1], place[0, 2:]])
    return np.concatenate([corner, on_side]).astype(int), place[2:, 2:].ravel()
