"""Factorisation of sparse symmetric positive definite matrices, behind one small interface.

``factorise(matrix)`` returns an object with ``solve(rhs)``, ``backend`` and ``reason``.
PARDISO (extra ``fast``) is used for large matrices when it is there; SuperLU always works.
"""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from solidgear.errors import SolidgearError

# SuperLU's indices overflow on the factors of planar meshes of very high order ("not enough memory").
LARGE_PLANAR = 30_000_000  # entries
# Below this size SuperLU's lack of start-up cost wins over PARDISO (0.09 s per constructor).
SMALL = 12_000


class FactorError(SolidgearError):
    """A matrix could not be factored."""


@dataclass
class Factor:
    """Result of :func:`factorise`.

    Attributes
    ----------
    backend : str
        ``pardiso`` or ``superlu``.
    reason : str
        Why this back end was taken.
    """

    backend: str
    reason: str
    _solve: object

    def solve(self, rhs: np.ndarray) -> np.ndarray:
        """Solve for one (n,) or several (n, k) right-hand sides."""
        return self._solve(rhs)


@lru_cache(maxsize=1)
def pardiso_missing() -> str:
    """Empty if PARDISO can be used, else the reason why not."""
    try:
        import pypardiso.pardiso_wrapper as wrapper

        wrapper.PyPardisoSolver(mtype=2)
    except Exception as error:  # a broken MKL raises OSError, ImportError or AttributeError
        return f"pypardiso is not usable ({type(error).__name__})"
    return ""


def factorise(matrix: sp.spmatrix, backend: str | None = None, planar: bool = False, border: int = 0) -> Factor:
    """Factor a symmetric positive definite matrix.

    Parameters
    ----------
    matrix : (n, n) sparse
        Both triangles given.
    backend : {None, 'pardiso', 'superlu'}
        None chooses by size and availability; the environment variable
        ``SOLIDGEAR_BACKEND`` forces one for a whole run.
    planar : bool
        The matrix comes from a 1D or 2D mesh: fill is small and SuperLU is the fastest.

    border : int
        Unknowns at the end that couple to very many others.  They are eliminated by hand, as a dense Schur complement:
        left to a fill-reducing ordering they cost ten times the rest.

    Raises
    ------
    FactorError
        If the matrix holds NaN, is singular to the back end, or the back end is not there.
    """
    if not np.all(np.isfinite(matrix.data)):
        raise FactorError("the system matrix holds NaN or infinite entries; check material and geometry")
    if border:
        return _bordered(matrix.tocsr(), backend, planar, border)
    backend = backend or os.environ.get("SOLIDGEAR_BACKEND") or None
    n = matrix.shape[0]
    planar = planar and matrix.nnz < LARGE_PLANAR
    if backend is None:
        light = planar or n <= SMALL
        missing = "" if light else pardiso_missing()
        if planar:
            backend, reason = "superlu", "a planar mesh fills in little"
        elif n <= SMALL:
            backend, reason = "superlu", f"{n} unknowns are below {SMALL}"
        elif missing:
            backend, reason = "superlu", f"{missing}; install the extra 'fast' for large solids"
        else:
            backend, reason = "pardiso", f"{n} unknowns are above {SMALL}"
    else:
        reason = "asked for"
    if backend == "pardiso":
        if pardiso_missing():
            raise FactorError(f"back end pardiso was asked for but {pardiso_missing()}")
        return Factor("pardiso", reason, _Pardiso(matrix))
    if backend == "superlu":
        return Factor("superlu", reason, _superlu(matrix))
    raise FactorError(f"unknown back end {backend!r}; use 'pardiso' or 'superlu'")


def _bordered(matrix, backend, planar, border):
    n = matrix.shape[0] - border
    inner = factorise(matrix[:n, :n], backend, planar)
    edge = matrix[:n, n:].toarray()
    through = inner.solve(edge)
    corner = matrix[n:, n:].toarray() - edge.T @ through
    try:
        corner = sla.cho_factor((corner + corner.T) / 2)
    except np.linalg.LinAlgError as error:
        raise FactorError("the system matrix is not positive definite") from error

    def solve(rhs):
        top = inner.solve(rhs[:n])
        bottom = sla.cho_solve(corner, rhs[n:] - edge.T @ top)
        return np.concatenate([top - through @ bottom, bottom])

    return Factor(inner.backend, inner.reason, solve)


def _superlu(matrix):
    try:
        lu = spla.splu(
            matrix.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise FactorError(f"SuperLU could not factor the system matrix ({error})") from error
    except MemoryError:
        raise FactorError(f"SuperLU ran out of memory or of 32-bit indices on {matrix.shape[0]} unknowns; install the extra 'fast', or use a coarser model") from None
    return lu.solve


class _Pardiso:
    """MKL PARDISO for symmetric positive definite matrices, solve phase called directly.

    pypardiso's own ``solve`` hashes the matrix at every call and refines twice.
    """

    def __init__(self, matrix):
        import pypardiso.pardiso_wrapper as wrapper

        self._error = wrapper.PyPardisoError
        self.upper = sp.triu(matrix, format="csr")
        self.upper.sort_indices()
        self.solver = wrapper.PyPardisoSolver(mtype=2)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # no defaults; parallel nested dissection; no refinement; two-level factorisation; report nnz
            for i, value in {1: 1, 2: 3, 8: 0, 24: 1, 25: 2, 18: -1}.items():
                self.solver.set_iparm(i, value)
        self._call(12, np.zeros((matrix.shape[0], 1), order="F"))

    def _call(self, phase, rhs):
        self.solver.set_phase(phase)
        try:
            return self.solver._call_pardiso(self.upper, rhs)
        except self._error as error:
            raise FactorError(f"PARDISO failed on the system matrix: {error}") from error

    def __call__(self, rhs):
        x = self._call(33, np.asfortranarray(rhs, dtype=float))
        # An indefinite matrix can pass the factorisation and come back as NaN.
        if not np.isfinite(x).all():
            raise FactorError("PARDISO returned NaN: the system matrix is not positive definite")
        return x

    def __del__(self):
        try:
            self.solver.free_memory(everything=True)
        except Exception:  # interpreter shutdown
            pass
