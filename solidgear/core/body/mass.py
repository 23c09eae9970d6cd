"""The consistent mass of a solid, held as the scalar matrix it is made of."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp


class ScalarMass:
    """``kron(scalar, I)``: the same mass, a symmetric (n, n) matrix in kg, for every component of a
    node's motion, numbered together.

    Takes a third of the memory of the full matrix of a solid. It multiplies arrays and sparse
    matrices, is added to sparse matrices, and is turned into one by :meth:`tocsr`; scipy leaves all
    mixed operations to it.

    Examples
    --------
    >>> import numpy as np
    >>> import scipy.sparse as sp
    >>> mass = ScalarMass(sp.csr_matrix(np.diag([2.0, 3.0])), components=3)
    >>> mass.shape, mass @ np.ones(6)
    ((6, 6), array([2., 2., 2., 3., 3., 3.]))
    """

    __array_ufunc__ = None  # numpy leaves operators to us
    __array_priority__ = 20.0  # and so does scipy, whose matrices have 10.1

    def __init__(self, scalar: sp.csr_matrix, components: int):
        self.scalar, self.components = scalar, components

    @property
    def shape(self) -> tuple[int, int]:
        """(n c, n c) of the full matrix."""
        n = self.scalar.shape[0] * self.components
        return n, n

    @property
    def nnz(self) -> int:
        """Entries of the full matrix."""
        return self.scalar.nnz * self.components

    @property
    def dtype(self) -> np.dtype:
        """Type of the entries."""
        return self.scalar.dtype

    @property
    def T(self) -> ScalarMass:
        """The transpose."""
        return ScalarMass(self.scalar.T.tocsr(), self.components)

    def diagonal(self) -> np.ndarray:
        """Return the main diagonal (n c,)."""
        return np.repeat(self.scalar.diagonal(), self.components)

    def tocsr(self) -> sp.csr_matrix:
        """Return the full (n c, n c) matrix, sparse."""
        return sp.kron(self.scalar, sp.eye(self.components), format="csr")

    def toarray(self) -> np.ndarray:
        """Return the full (n c, n c) matrix, dense."""
        return self.tocsr().toarray()

    def __matmul__(self, operand):
        if sp.issparse(operand):
            return self.tocsr() @ operand
        operand = np.asarray(operand)
        if operand.ndim not in (1, 2) or len(operand) != self.shape[1]:
            raise ValueError(f"matmul: dimension mismatch, {self.shape} by {operand.shape}")
        # all components and columns of a node side by side
        columns = operand.reshape(self.scalar.shape[1], -1)
        return (self.scalar @ columns).reshape(operand.shape)

    def __rmatmul__(self, operand):
        return (
            operand @ self.tocsr() if sp.issparse(operand) else (self.T @ np.asarray(operand).T).T
        )

    def __mul__(self, factor: float) -> ScalarMass:
        if not np.isscalar(factor):
            return NotImplemented
        return ScalarMass(factor * self.scalar, self.components)

    __rmul__ = __mul__

    def __add__(self, operand):
        return self.tocsr() + operand

    __radd__ = __add__

    def __sub__(self, operand):
        return self.tocsr() - operand

    def __rsub__(self, operand):
        return operand - self.tocsr()
