"""Functions of one order more that a block moves in.

Motions that are symmetric or antisymmetric about a mirror plane of a mesh do not meet
(:mod:`solidgear.core.models.solid.parity`), and neither do functions of one order more.  So the error
of a displacement of one kind is found among functions of that kind, and from the cells on one side,
times as many as there are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import Block
from solidgear.core.body.model import Enrichment
from solidgear.core.body.parity import symmetric_basis

#: of the square of a column: what is left of it where it follows from others
FOLLOWS = 1e-12


class Whole:
    """Basis of all functions."""

    @property
    def T(self) -> Whole:
        """Itself."""
        return self

    def __matmul__(self, columns: np.ndarray) -> np.ndarray:
        return columns


@dataclass(frozen=True)
class EnrichedBlock:
    """What one order more adds to a block."""

    more: Enrichment  #: of all motions of the mesh
    fold: sp.csr_matrix | Whole  #: (m, p) orthonormal basis of the functions of its kind
    near: sp.csr_matrix | Whole  #: (s, p) the same of functions that were summed up
    ports: np.ndarray  #: (c q, m) motions of the ports by the functions
    held: np.ndarray  #: (p, 1) 0 for functions that are held
    inverse: np.ndarray  #: (p,) of the diagonal of the stiffness, 0 for functions that are held


def enriched_block(block: Block, more: Enrichment) -> EnrichedBlock:
    """Return what one order more adds to a block, from what it adds to its mesh."""
    diagonal = more.stiffness.diagonal
    if block.parity is None:
        whole = Whole()
        return EnrichedBlock(
            more, whole, whole, more.ports, more.moves[:, None], more.moves / diagonal
        )
    images = [of_functions for _, of_functions in more.reflections[:2]]
    fold = symmetric_basis(len(more.moves), images, block.parity)
    near = fold[more.summed]
    held = fold.power(2).T @ more.moves
    inverse = held / (near.power(2).T @ diagonal)
    by_port = more.ports.reshape(-1, 6, len(more.moves))
    ports = by_port[:, list(block.components)].reshape(-1, len(more.moves))
    return EnrichedBlock(more, fold, near, ports, held[:, None], inverse)


def independent(columns: np.ndarray, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return some columns (n, k) from which the others follow, as their places (r,), and how (r, k);
    squares are by weights (n,).

    Examples
    --------
    >>> columns = np.array([[1.0, 2.0, 0.0], [1.0, 2.0, 1.0]])
    >>> independent(columns, np.ones(2))
    (array([0, 2]), array([[1., 2., 0.],
           [0., 0., 1.]]))
    """
    own = np.einsum("nk,n,nk->k", columns, weight, columns)
    some = np.flatnonzero(own > 0)
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
