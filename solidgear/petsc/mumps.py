"""MUMPS."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from solidgear.core.solve.backends.matrix import FactorError, upper_triangle


class Mumps:
    """MUMPS through python-mumps, LDL'; pivots of a positive definite matrix stay on the diagonal.

    The ordering is left to MUMPS.  PORD was a quarter faster on solids of revolution, but ends the
    process on some small dense matrices.
    """

    name = "mumps"
    package, install = "python-mumps", "pip install 'solidgear[mumps]'"

    def __init__(self, matrix: sp.csr_matrix, definite: bool = True, out_of_core: bool = False):
        import mumps

        self.out_of_core = out_of_core

        self.error, self.definite, self.context = mumps.MUMPSError, definite, mumps.Context()
        upper = upper_triangle(matrix).tocoo()
        self.context.set_matrix(upper, symmetric=True)
        self._try(self.context.analyze, ordering="auto")
        # by coordinates: two indices and a number
        by_coordinates = 16 * upper.nnz / 2**20
        stats = self.context.analysis_stats
        needed = stats.est_mem_ooc if out_of_core else stats.est_mem_incore
        self.estimate_mb = float(needed) + by_coordinates

    def _try(self, step, **options):
        try:
            step(**options)
        except self.error as error:
            raise FactorError(f"MUMPS could not factor the system matrix ({error})") from error

    def factor(self):
        """Factor; :class:`FactorError` if the matrix cannot be factored."""
        self._try(
            self.context.factor,
            reuse_analysis=True,
            pivot_tol=0.0 if self.definite else 0.01,
            ooc=self.out_of_core,
        )
        if self.definite and self.negative:
            raise FactorError(
                "MUMPS could not factor the system matrix: it is not positive definite"
            )

    @property
    def nnz(self) -> int:
        """Entries of the factor."""
        return int(self.context.factor_stats.nonzeros)

    @property
    def negative(self) -> int | None:
        """Negative pivots (INFOG(12) of the users' guide); None if tiny ones were replaced."""
        if self.context.factor_stats.tiny_pivots:
            return None
        return int(self.context.mumps_instance.infog[12])

    def solve(self, rhs):
        """Solve for one (n,) or several (n, k) right-hand sides."""
        return np.ascontiguousarray(self.context.solve(np.asarray(rhs, dtype=float)))
