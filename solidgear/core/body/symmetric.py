"""A symmetric matrix held by its upper triangle."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sp


class Symmetric:
    """A symmetric matrix by its entries on and above the diagonal: products take no longer, and it
    takes half the memory.

    Examples
    --------
    >>> chain = Symmetric(sp.csr_matrix([[3.0, -1.0], [0.0, 2.0]]))
    >>> (chain @ np.eye(2)).tolist()
    [[3.0, -1.0], [-1.0, 2.0]]
    """

    def __init__(self, upper: sp.csr_matrix):
        self.upper = upper

    def __matmul__(self, columns: np.ndarray) -> np.ndarray:
        out = self.upper @ columns
        out += self.upper.T @ columns
        out -= self.diagonal[:, None] * columns
        return out

    @cached_property
    def diagonal(self) -> np.ndarray:
        """The main diagonal (n,), which every product takes."""
        return self.upper.diagonal()

    def tocsr(self) -> sp.csr_matrix:
        """Return all entries."""
        return (self.upper + sp.triu(self.upper, 1).T).tocsr()
