"""Stiffness matrices as roots, and springs in series, to full precision.

A matrix ``K = L L'`` of springs may stand on a support that gives in some motions h, as bearings
stand in a housing: the springs stretch by ``L'(d - E h)``, and the support resists h with ``H``.  At
rest h is where the energy ``|L'(d - E h)|^2 + h'H h`` is least.  Motions that H leaves free are taken
out of the springs exactly: L becomes ``L N``, N the complement of ``L'E Z`` with Z those motions.
The parallel sum remains,

    K_s = L (I + B B')^-1 L',     B = L'E Y,     Y'H Y = I,

with the inverse from the singular values of B.  No difference of large numbers is taken and there is
no penalty: a support of any stiffness, also of none in some direction, takes one path.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla

from solidgear.core.errors import SolidgearError

#: singular value of unit columns below which motions are the same
SAME = 1e-9
#: coupling, over the geometric mean of two entries of the diagonal, that is rounding
ROUNDING = 1e-15
#: eigenvalue, over the diagonal, below which a direction hangs on the last digits of the entries
LOST = 1e-10
#: a spring holds what moves with it where it is so much stiffer, of the largest eigenvalue beside it: no
#: frequency changes by more than the inverse, and a sum of both would leave rounding of the softer one
RIGID = 1e7


def root_of(matrix: np.ndarray) -> np.ndarray:
    """Return the root L (n, rank) of a symmetric positive semidefinite matrix, ``L L' = matrix``.

    Cholesky's factor with the largest pivots first, of the matrix scaled to a unit diagonal: a
    spring of 1e-3 N/m beside one of 1e24 keeps full precision, in a column for itself.
    (Eigenvectors would mix equal entries of the scaled matrix, whatever they couple.)

    Examples
    --------
    >>> root_of(np.array([[4.0, 0.0], [0.0, 0.0]]))
    array([[2.],
           [0.]])
    """
    d = np.sqrt(np.abs(np.diag(matrix)))
    order = np.argsort(-d, kind="stable")
    unit = np.where(d > 0, d, 1.0)[order]
    remainder = matrix[np.ix_(order, order)] / np.outer(unit, unit)
    columns = []
    for j in range(len(remainder)):
        if remainder[j, j] > 1e-12:
            column = remainder[:, j] / np.sqrt(remainder[j, j])
            column[:j] = 0.0
            columns.append(column)
            remainder = remainder - np.outer(column, column)
    out = np.zeros((len(d), len(columns)))
    out[order] = d[order, None] * np.array(columns).reshape(len(columns), len(d)).T
    return out


def modes_on_springs(
    stiffness: np.ndarray, mass: np.ndarray, columns: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return squares of angular frequencies (k,), ascending, and shapes (n, k) of a small system that
    springs of any stiffness tie to the ground.

    Parameters
    ----------
    stiffness, mass : (n, n) ndarray
        Of the system without the springs; the mass positive definite.
    columns : (n, r) ndarray
        Root C of the springs, ``C C'`` their stiffness. Those that hold their motion rigidly leave
        shapes out, one each.

    Examples
    --------
    Two unit masses on a unit spring, the second one clamped:

    >>> spring = np.array([[1.0, -1.0], [-1.0, 1.0]])
    >>> square, shapes = modes_on_springs(spring, np.eye(2), np.array([[0.0], [1e11]]))
    >>> square.round(12), abs(shapes.T).round(12)
    (array([1.]), array([[1., 0.]]))
    """
    light = sla.solve_triangular(np.linalg.cholesky(mass), columns, lower=True)
    sizes = np.einsum("nr,nr->r", light, light)
    # the largest eigenvalue is not below that of any unknown by itself, which mostly tells enough
    largest = float((np.diag(stiffness) / np.diag(mass)).max(initial=0.0))
    if (sizes > RIGID * largest).any():
        largest = float(sla.eigh(stiffness, mass, eigvals_only=True)[-1])
    rigid = sizes > RIGID * largest
    free = _spanned(columns[:, rigid]) if rigid.any() else np.eye(len(mass))
    soft = free.T @ columns[:, ~rigid]
    square, mix = sla.eigh(free.T @ stiffness @ free + soft @ soft.T, free.T @ mass @ free)
    return square, free @ mix


def in_series(
    stiffness: np.ndarray, moves: np.ndarray, support: np.ndarray, name: str = "the housing"
) -> np.ndarray:
    """Return the (n, n) stiffness of springs on an elastic support.

    Parameters
    ----------
    stiffness : (n, n) ndarray
        Of the springs, symmetric positive semidefinite.
    moves : (n, k) ndarray
        Motion of the feet of the springs for unit motions of the support.
    support : (k, k) ndarray
        Stiffness against these motions, symmetric positive semidefinite; zero is free.
    name : str
        Of the support, for errors.

    Raises
    ------
    SolidgearError
        If it is so much softer than the springs that a matrix of sixteen digits cannot hold both.

    Examples
    --------
    Two equal springs, one on top of the other:

    >>> round(float(in_series(np.array([[4.0]]), np.eye(1), np.array([[4.0]]))[0, 0]), 12)
    2.0

    Two springs side by side on a free support pull at each other only:

    >>> pair = in_series(np.diag([1.0, 3.0]), np.ones((2, 1)), np.zeros((1, 1)))
    >>> bool(np.allclose(pair, [[0.75, -0.75], [-0.75, 0.75]]))
    True
    """
    root = root_of(stiffness)
    stretch = root.T @ moves
    support_root = root_of(support)
    if support_root.shape[1] < len(support):
        out = _spanned(stretch @ _null(support_root))
        root = root @ out
        stretch = out.T @ stretch
    q, r = np.linalg.qr(support_root)
    reach = sla.solve_triangular(r, (stretch @ q).T).T if support_root.shape[1] else stretch[:, :0]
    u, s, _ = np.linalg.svd(reach)
    weight = np.ones(len(u))
    weight[: len(s)] = 1 / np.hypot(1.0, s)
    half = root @ (u * weight)
    series = half @ half.T
    # uncoupled motions stay so: planes that rounding tied together would be solved together
    size = np.sqrt(np.diag(series))
    series[np.abs(series) <= ROUNDING * np.outer(size, size)] = 0.0
    if _softest(series, half.shape[1]) < LOST <= _softest(stiffness, root_of(stiffness).shape[1]):
        raise SolidgearError(
            f"{name} is too much softer than the bearings in it for sixteen digits; write 0 for a "
            "motion that it leaves free, or stiffnesses nearer to each other"
        )
    return series


def _null(root: np.ndarray) -> np.ndarray:
    """Return a basis of the motions that ``root @ root.T`` does not resist, coordinates first."""
    size = np.linalg.norm(root, axis=1)
    alone = size == 0
    unit = root[~alone] / size[~alone, None]
    u, s, _ = np.linalg.svd(unit)
    oblique = u[:, int((s > SAME).sum()) :] / size[~alone, None]
    out = np.zeros((len(root), int(alone.sum()) + oblique.shape[1]))
    out[alone, : alone.sum()] = np.eye(int(alone.sum()))
    out[~alone, alone.sum() :] = oblique
    return out


def _spanned(columns: np.ndarray) -> np.ndarray:
    """Return an orthonormal basis of the complement of some columns."""
    size = np.linalg.norm(columns, axis=0)
    unit = columns[:, size > 0] / size[size > 0]
    if not unit.shape[1]:
        return np.eye(len(columns))
    u, s, _ = np.linalg.svd(unit)
    return u[:, int((s > SAME).sum()) :]


def _softest(matrix: np.ndarray, rank: int) -> float:
    """Return the smallest of the `rank` largest eigenvalues, of the matrix scaled to a unit diagonal."""
    size = np.sqrt(np.diag(matrix))
    resists = size > 0
    if not rank or not resists.any():
        return 1.0
    unit = matrix[np.ix_(resists, resists)] / np.outer(size[resists], size[resists])
    return float(np.linalg.eigvalsh(unit)[-rank])
