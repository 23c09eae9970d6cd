"""SciPy's SuperLU."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from solidgear.core.machine.interruptible import ThreadBound
from solidgear.core.solve.backends.matrix import FactorError
from solidgear.core.solve.backends.memory_law import law

# Reading SuperLU's pivots copies its factor. That takes 1 to 4 % of the time on solids and 6 to 9 %
# on planar meshes, and as much memory again: done where SuperLU is the automatic choice for a
# solid, and where a planar matrix is so small that it costs nothing.
CHECKED, CHECKED_PLANAR = 12_000, 1_000
#: of the memory of a factor in double precision: numbers take half, indices what they take
SINGLE_SHARE = 0.67


class SuperLU:
    """SciPy's SuperLU in symmetric mode; pivots stay on the diagonal unless one vanishes."""

    name = "superlu"
    package, install = "scipy", ""

    def __init__(
        self,
        matrix: sp.csr_matrix,
        definite: bool = True,
        planar: bool = False,
        single: bool = False,
    ):
        self.number = np.float32 if single else np.float64
        # the matrix is symmetric: its rows are its columns
        self.matrix = sp.csc_matrix(
            (matrix.data.astype(self.number, copy=False), matrix.indices, matrix.indptr),
            shape=matrix.shape,
        )
        self.checked = definite and matrix.shape[0] <= (CHECKED_PLANAR if planar else CHECKED)
        copies = 2 if self.checked or not definite else 1
        share = SINGLE_SHARE if single else 1.0
        self.estimate_mb = copies * share * law("superlu", matrix.shape[0], matrix.nnz, planar)

    def factor(self):
        """Factor; :class:`FactorError` if memory ends, or the matrix cannot be factored."""
        n = self.matrix.shape[0]
        try:
            self._lu = ThreadBound(
                spla.splu(
                    self.matrix,
                    permc_spec="MMD_AT_PLUS_A",
                    diag_pivot_thresh=0.0,
                    options={"SymmetricMode": True},
                )
            )
        except RuntimeError as error:
            raise FactorError(f"SuperLU could not factor the system matrix ({error})") from error
        except MemoryError:
            raise FactorError(
                f"SuperLU ran out of memory or of 32-bit indices on {n} unknowns; "
                "install the extra 'fast', or use a coarser model"
            ) from None
        self.nnz = int(self._lu.value.nnz)
        del self.matrix
        # SuperLU does not mind an indefinite matrix, and one off-diagonal pivot is proof of a
        # vanishing diagonal.
        if self.checked and self.negative != 0:
            raise FactorError(
                "SuperLU could not factor the system matrix, which is not positive definite: "
                "stiffnesses differ too much for sixteen digits; look for segments that are very "
                "short or thin against their diameter, or use another model"
            )

    @property
    def negative(self) -> int | None:
        """Negative pivots; None where a row was exchanged, so that the signs are not those of the
        matrix.  Copies the factor.
        """
        lu = self._lu.value
        if not np.array_equal(lu.perm_r, lu.perm_c):
            return None
        return int(np.count_nonzero(lu.U.diagonal() < 0))

    def solve(self, rhs):
        """Solve for one (n,) or several (n, k) right-hand sides."""
        return self._lu.value.solve(np.asarray(rhs, dtype=self.number))
