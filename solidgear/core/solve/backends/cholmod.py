"""SuiteSparse's CHOLMOD."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from solidgear.core.solve.backends.matrix import FactorError, size_mb, upper_triangle
from solidgear.core.solve.backends.memory_law import law


class Cholmod:
    """SuiteSparse CHOLMOD through scikit-sparse: METIS ordering, supernodal LL'; of positive
    definite matrices alone.
    """

    name = "cholmod"
    package, install = "scikit-sparse", "pip install 'solidgear[cholmod]'"

    def __init__(self, matrix: sp.csr_matrix, definite: bool = True, planar: bool = False):
        from sksparse.cholmod import analyze

        upper = upper_triangle(matrix)
        self.lower = sp.csc_matrix((upper.data, upper.indices, upper.indptr), shape=upper.shape)
        self.estimate_mb = law("cholmod", matrix.shape[0], matrix.nnz, planar) + size_mb(self.lower)
        self.nnz = None
        self.symbolic = analyze(self.lower, mode="supernodal", ordering_method="metis")

    def factor(self):
        """Factor; :class:`FactorError` if the matrix is not positive definite."""
        from sksparse.cholmod import CholmodError, CholmodNotPositiveDefiniteError

        try:
            self.symbolic.cholesky_inplace(self.lower)
        except CholmodNotPositiveDefiniteError as error:
            raise FactorError(
                "CHOLMOD could not factor the system matrix: it is not positive definite"
            ) from error
        except CholmodError as error:
            raise FactorError(f"CHOLMOD could not factor the system matrix ({error})") from error
        del self.lower  # the factor does not need it

    def solve(self, rhs):
        """Solve for one (n,) or several (n, k) right-hand sides."""
        return np.ascontiguousarray(self.symbolic(np.asarray(rhs, dtype=float)))
