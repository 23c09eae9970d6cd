"""Elimination by hand of unknowns that couple to very many others, as a dense Schur complement."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.linalg as sla

from solidgear.core.solve.backends.matrix import FactorError


def bordered(matrix, border, factor, corner_of):
    """Factor the inner part of a matrix by `factor` and the Schur complement of the border,
    unknowns at the end, by `corner_of` (:func:`definite_corner` or :func:`any_corner`); None where
    one of both gives none.
    """
    n = matrix.shape[0] - border
    if n == 0:  # a shaft that rigid seats hold from end to end: nothing but border
        return factor(matrix)
    inner = factor(matrix[:n, :n])
    if inner is None:
        return None
    edge = matrix[:n, n:].toarray()
    through = inner.solve(edge)
    corner = matrix[n:, n:].toarray() - edge.T @ through
    inverse_and_count = corner_of((corner + corner.T) / 2)
    if inverse_and_count is None:
        return None
    through_corner, negative = inverse_and_count

    def solve(rhs):
        top = inner.solve(rhs[:n])
        bottom = through_corner(rhs[n:] - edge.T @ top)
        return np.concatenate([top - through @ bottom, bottom])

    if hasattr(inner, "negative"):
        # Haynsworth: the inertia of a matrix is that of a block plus that of its Schur complement.
        return replace(inner, _solve=solve, negative=inner.negative + negative)
    return replace(inner, _solve=solve)


def definite_corner(corner):
    """Return the inverse of a positive definite Schur complement, and zero negative eigenvalues."""
    try:
        factor = sla.cho_factor(corner)
    except np.linalg.LinAlgError as error:
        raise FactorError("the system matrix is not positive definite") from error
    return (lambda rhs: sla.cho_solve(factor, rhs)), 0


def any_corner(corner):
    """Return the inverse and the number of negative eigenvalues of a Schur complement; None if it
    is singular.
    """
    # Rows of a border differ in unit (forces, moments): scaled, so that small ones are not taken
    # for rounding.
    scale = 1 / np.sqrt(np.maximum(np.abs(corner).max(axis=1), np.finfo(float).tiny))
    values, vectors = np.linalg.eigh(corner * np.outer(scale, scale))
    if np.abs(values).min() < 1e-13 * np.abs(values).max():
        return None
    inverse = scale[:, None] * (vectors / values) @ vectors.T * scale
    return (lambda rhs: inverse @ rhs), int(np.count_nonzero(values < 0))
