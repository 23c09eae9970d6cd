"""Errors in one order more by pieces that mirror planes leave apart.

Motions that are symmetric or antisymmetric about a mirror plane of a mesh do not meet
(:mod:`solidgear.core.solve.symmetry`).  So the error of a displacement is the sum of those of its
parts of each kind, every one of which is known from the cells on one side, times as many as there
are.  A plane between the two others turns one of the two kinds of bending into the other: both have
one problem, and twin displacements have one error.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import Reflection
from solidgear.core.body.model import Enrichment
from solidgear.core.solve.symmetry import mirrored_basis, symmetric_bases

#: of the residual of a displacement, squared: a part that is none, or that follows from others
NONE, FOLLOWS = 1e-8, 1e-12
#: of the square of a displacement: a part of a kind that is none
ROUNDING = 1e-16


class Whole:
    """Basis of all functions."""

    @property
    def T(self) -> Whole:
        """Itself."""
        return self

    def __matmul__(self, columns: np.ndarray) -> np.ndarray:
        return columns


@dataclass(frozen=True)
class Part:
    """Functions and displacements of one kind."""

    fold: sp.csr_matrix | Whole  #: (m, p) orthonormal basis of these functions
    planes: tuple[tuple[Reflection, float], ...]  #: mirrors of the mesh, and the parity in each
    turn: Reflection | None = None  #: mirror of the mesh that makes another kind of it

    def columns(self, fields: np.ndarray) -> np.ndarray:
        """Return the places of the displacements (n, k) that have a part of this kind."""
        if not self.planes:
            return np.arange(fields.shape[1])
        size = np.einsum("nk,nk->k", fields, fields)
        part = self.of(fields)
        return np.flatnonzero(np.einsum("nk,nk->k", part, part) > ROUNDING * size)

    def of(self, fields: np.ndarray) -> np.ndarray:
        """Return the part (n, k) of displacements or forces that is of this kind, turned."""
        for (partner, sign), parity in self.planes:
            fields = (fields + (parity * sign)[:, None] * fields[partner]) / 2
        return self.turned(fields)

    def turned(self, fields: np.ndarray) -> np.ndarray:
        """Return displacements or forces (n, k) of this kind turned, or those turned as of this."""
        if self.turn is None:
            return fields
        partner, sign = self.turn
        return sign[:, None] * fields[partner]


@dataclass(frozen=True)
class Piece:
    """Kinds of functions that have one problem, the first of which is not turned."""

    parts: tuple[Part, ...]
    near: sp.csr_matrix | Whole  #: (m', p) basis of the first, of functions that were summed up
    held: np.ndarray  #: (p, 1) 0 for functions that are held
    inverse: np.ndarray  #: (p,) of the diagonal of the stiffness, 0 for functions that are held


def pieces_of(more: Enrichment) -> list[Piece]:
    """Return the pieces of an enrichment: one without mirror planes."""
    diagonal = more.stiffness.diagonal()
    if not more.reflections:
        return [Piece((Part(Whole(), ()),), Whole(), more.moves[:, None], more.moves / diagonal)]
    planes = [mesh for mesh, _ in more.reflections[:2]]
    bases = symmetric_bases(len(more.moves), [images for _, images in more.reflections[:2]])
    pieces = []
    for kind, fold in bases.items():
        parts = [Part(fold, tuple(zip(planes, kind)))]
        if len(more.reflections) == 3 and kind[0] != kind[-1]:
            if kind < kind[::-1]:
                continue  # solved beside the other one
            mesh, images = more.reflections[2]
            turned = mirrored_basis(fold, images)
            parts.append(Part(turned, tuple(zip(planes, kind[::-1])), mesh))
        near = fold[more.summed]
        held = fold.power(2).T @ more.moves
        inverse = held / (near.power(2).T @ diagonal)
        pieces.append(Piece(tuple(parts), near, held[:, None], inverse))
    return pieces


def independent(
    columns: np.ndarray, weight: np.ndarray, whole: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return some columns (n, k) from which the others follow, as their places (r,), and how (r, k);
    squares, by weights (n,), are compared with their own, and with those of the `whole` (k,) that
    they are a part of.

    Examples
    --------
    >>> columns = np.array([[1.0, 2.0, 0.0, 1e-6], [1.0, 2.0, 1.0, 0.0]])
    >>> independent(columns, np.ones(2), np.ones(4))
    (array([0, 2]), array([[1., 2., 0., 0.],
           [0., 0., 1., 0.]]))
    """
    own = np.einsum("nk,n,nk->k", columns, weight, columns)
    some = np.flatnonzero(own > NONE * whole)
    scaled = columns[:, some] / np.sqrt(own[some])
    gram = scaled.T @ (weight[:, None] * scaled)
    left = np.ones(len(some))
    rows, chosen = np.zeros((0, len(some))), []
    # Cholesky's factor, row by row, the column of which most is left first
    while left.max(initial=0.0) > FOLLOWS:
        pivot = int(left.argmax())
        row = gram[pivot] - rows[:, pivot] @ rows
        rows = np.vstack([rows, row / np.sqrt(row[pivot])])
        chosen.append(pivot)
        left = left - rows[-1] ** 2
        left[chosen] = 0.0
    size = np.sqrt(own[some])
    combined = np.zeros((len(chosen), columns.shape[1]))
    combined[:, some] = np.linalg.solve(rows[:, chosen], rows) * size / size[chosen][:, None]
    return some[chosen], combined
