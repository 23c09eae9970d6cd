"""Direct solvers for sparse symmetric matrices, all behind the same four names.

A back end takes the matrix as CSR, sorted, and analyses it; then it knows ``estimate_mb``, the
memory the numbers will need, and only ``factor()`` takes that memory.  After it ``solve(rhs)``,
``negative`` and ``nnz`` can be asked for.

======== =============================== ===================== ===========================================
name     what it is                      indefinite matrices   memory estimate
======== =============================== ===================== ===========================================
pardiso  MKL PARDISO, LL' or LDL'        yes                   its own, from the analysis
cholmod  SuiteSparse, supernodal LL'     no                    a law: scikit-sparse does not pass on the count
mumps    MUMPS, LDL'                     yes                   its own, from the analysis
superlu  SciPy's SuperLU, LU             unpivoted             a law: it has no separate analysis
======== =============================== ===================== ===========================================
"""

from __future__ import annotations

import ctypes
import os
import weakref
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, files

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from solidgear.errors import SolidgearError
from solidgear.interruptible import Made
from solidgear.threads import offered


class FactorError(SolidgearError):
    """A matrix could not be factored."""


def upper_triangle(matrix: sp.csr_matrix) -> sp.csr_matrix:
    """Upper triangle with the diagonal, of a CSR matrix with sorted rows (five to ten times faster
    than ``scipy.sparse.triu``).

    Its arrays are those of the lower triangle by columns as well.
    """
    n = matrix.shape[0]
    keep = matrix.indices >= np.repeat(
        np.arange(n, dtype=matrix.indices.dtype), np.diff(matrix.indptr)
    )
    before = np.concatenate([[0], np.cumsum(keep, dtype=matrix.indptr.dtype)])
    return sp.csr_matrix(
        (matrix.data[keep], matrix.indices[keep], before[matrix.indptr]), shape=(n, n)
    )


def _size_mb(matrix):
    return (matrix.data.nbytes + matrix.indices.nbytes + matrix.indptr.nbytes) / 2**20


# --------------------------------------------------------------------------- PARDISO
@lru_cache(maxsize=1)
def _mkl():
    """The library.

    Its threads sleep as soon as a call is over, unless told otherwise: by default they spin for 0.2
    s, which with both of two cores busy made ten modes of a 3D solid take 1.3 times as long (two
    runs in turn: 1.36, 1.34).

    pypardiso searches the whole environment for the library at every construction (1 s and more);
    the installed package ``mkl`` knows where its library is, and asking once is enough.
    """
    os.environ.setdefault("KMP_BLOCKTIME", "0")  # read when the library is loaded
    try:
        rt = (
            None
            if os.environ.get("PYPARDISO_MKL_RT")
            else next((f for f in files("mkl") or () if "mkl_rt" in f.name), None)
        )
    except PackageNotFoundError:
        rt = None
    if rt is not None:
        return ctypes.CDLL(str(rt.locate()))
    from pypardiso.pardiso_wrapper import PyPardisoSolver

    return PyPardisoSolver(mtype=2).libmkl


@lru_cache(maxsize=1)
def _mkl_pardiso():
    """The C function, on no more threads than there are processors for it."""
    library = _mkl()
    function = library["pardiso"]  # a handle of our own, without pypardiso's argument types
    function.restype = None
    most = min(offered(), library.MKL_Get_Max_Threads())

    def on_its_threads(*arguments):
        before = library.MKL_Set_Num_Threads_Local(most)
        try:
            function(*arguments)
        finally:
            library.MKL_Set_Num_Threads_Local(before)

    return on_its_threads


def _pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def _int(value):
    return ctypes.byref(ctypes.c_int32(value))


#: where a phase of PARDISO takes no right-hand side, and gives no solution
UNUSED = np.zeros(1)


class Pardiso:
    """MKL PARDISO called directly: pypardiso copies the indices at every call, hashes the matrix at
    every solve and refines twice.

    Parameter numbers and error codes: oneMKL developer reference, "pardiso iparm Parameter".
    """

    name = "pardiso"
    ERRORS = {
        -2: "not enough memory",
        -4: "a zero or negative pivot: the matrix is not positive definite",
        -8: "an overflow of 32-bit integers",
    }
    # no defaults; parallel nested dissection; no refinement; two-level factorisation; parallel
    # solve; report entries; count from zero
    SETTINGS = {1: 1, 2: 3, 8: 0, 24: 1, 25: 2, 18: -1, 35: 1}
    # perturb pivots below 1e-8 of the norm (and report them); Bunch-Kaufman pivots
    INDEFINITE = {10: 8, 21: 1}

    def __init__(self, matrix: sp.csr_matrix, definite: bool = True):
        self.upper = upper_triangle(matrix)
        self.n = matrix.shape[0]
        # An empty row would end in a segmentation fault.
        if np.diff(self.upper.indptr).min() == 0 or np.any(
            self.upper.indices[self.upper.indptr[:-1]] != np.arange(self.n)
        ):
            raise FactorError(
                "PARDISO failed on the system matrix: an entry of the diagonal is missing"
            )
        self.pt, self.iparm = np.zeros(64, np.int64), np.zeros(64, np.int32)
        for number, value in {**self.SETTINGS, **({} if definite else self.INDEFINITE)}.items():
            self.iparm[number - 1] = value
        self.definite = definite
        self.order = _node_order(matrix)
        if self.order is not None:
            self.iparm[4] = 1
        self.ia, self.ja = (
            self.upper.indptr.astype(np.int32, copy=False),
            self.upper.indices.astype(np.int32, copy=False),
        )
        self._release = weakref.finalize(
            self, _release, _mkl_pardiso(), self.pt, self.iparm, 2 if definite else -2, self.n
        )
        self._release.atexit = False  # a factorisation that was interrupted may still be at it
        self._call(11)
        symbolic_peak, symbolic, numeric = (int(kb) for kb in self.iparm[14:17])
        self.estimate_mb = max(symbolic_peak, symbolic + numeric) / 1024 + _size_mb(self.upper)

    def _call(self, phase, rhs=UNUSED, x=UNUSED, columns=1):
        mtype = 2 if self.definite else -2
        error = _pardiso_phase(
            phase,
            self.pt,
            self.iparm,
            mtype,
            self.n,
            self.upper.data,
            self.ia,
            self.ja,
            self.order,
            rhs,
            x,
            columns,
        )
        if error:
            raise FactorError(
                f"PARDISO failed on the system matrix: {self.ERRORS.get(error, f'error {error}')}"
            )

    def factor(self):
        self._call(22)

    @property
    def nnz(self) -> int:
        return int(self.iparm[17])

    @property
    def negative(self) -> int | None:
        """Negative pivots; None if some were perturbed or do not add up."""
        perturbed, positive, negative = (
            int(self.iparm[13]),
            int(self.iparm[21]),
            int(self.iparm[22]),
        )
        return negative if not perturbed and positive + negative == self.n else None

    def solve(self, rhs):
        rhs = np.asfortranarray(rhs, dtype=float)
        x = np.empty_like(rhs)
        if rhs.size:
            self._call(33, rhs, x, 1 if rhs.ndim == 1 else rhs.shape[1])
        # An indefinite matrix can pass the factorisation and come back as NaN.
        if not np.isfinite(x).all():
            raise FactorError("PARDISO returned NaN: the system matrix is not positive definite")
        return np.ascontiguousarray(x)


def _pardiso_phase(
    phase, pt, iparm, mtype, n, data, ia, ja, order=None, rhs=UNUSED, x=UNUSED, columns=1
) -> int:
    error = ctypes.c_int32(0)
    _mkl_pardiso()(
        _pointer(pt),
        _int(1),
        _int(1),
        _int(mtype),
        _int(phase),
        _int(n),
        _pointer(data),
        _pointer(ia),
        _pointer(ja),
        None if order is None else _pointer(order),
        _int(columns),
        _pointer(iparm),
        _int(0),
        _pointer(rhs),
        _pointer(x),
        ctypes.byref(error),
    )
    return error.value


def _node_order(matrix, components: int = 3) -> np.ndarray | None:
    """Fill-reducing order of a solid from the graph of its nodes, or None if unknowns do not come
    in threes.

    The three motions of a node have the same neighbours: ordering nodes gives the same fill for a ninth of the graph, and the analysis takes
    0.3 s instead of 1.0 s on 93,000 unknowns.  Only the cost depends on it, so the test may be a loose one.
    """
    n, rest = divmod(matrix.shape[0], components)
    if rest or n < 1000:
        return None
    length = np.diff(matrix.indptr).reshape(n, components)
    # entries that happen to be zero may be missing
    if np.mean(length.min(axis=1) > 0.3 * length.max(axis=1)) < 0.9:
        return None
    rows = matrix[::components]
    graph = sp.csr_matrix(
        (np.ones(rows.nnz), rows.indices // components, rows.indptr), shape=(n, n)
    )
    graph.sum_duplicates()
    graph.data[:] = -1.0
    upper = sp.triu(
        graph + graph.T + sp.diags(2.0 * np.asarray(abs(graph).sum(axis=1)).ravel() + 2.0),
        format="csr",
    )
    pt, iparm, order = np.zeros(64, np.int64), np.zeros(64, np.int32), np.zeros(n, np.int32)
    for number, value in {**Pardiso.SETTINGS, 5: 2}.items():
        iparm[number - 1] = value
    error = _pardiso_phase(
        11,
        pt,
        iparm,
        2,
        n,
        upper.data,
        upper.indptr.astype(np.int32),
        upper.indices.astype(np.int32),
        order,
    )
    _release(_mkl_pardiso(), pt, iparm, 2, n)
    if error or not np.array_equal(np.sort(order), np.arange(n)):
        return None
    return (components * order[:, None] + np.arange(components)).ravel().astype(np.int32)


def _release(pardiso, pt, iparm, mtype, n):
    """Give PARDISO's memory back."""
    nothing = np.zeros(1)
    pardiso(
        _pointer(pt),
        _int(1),
        _int(1),
        _int(mtype),
        _int(-1),
        _int(n),
        _pointer(nothing),
        None,
        None,
        None,
        _int(1),
        _pointer(iparm),
        _int(0),
        _pointer(nothing),
        _pointer(nothing),
        _int(0),
    )


# --------------------------------------------------------------------------- CHOLMOD
class Cholmod:
    """SuiteSparse CHOLMOD through scikit-sparse: METIS ordering, supernodal LL'."""

    name = "cholmod"

    def __init__(self, matrix: sp.csr_matrix, definite: bool = True, planar: bool = False):
        from sksparse.cholmod import analyze

        upper = upper_triangle(matrix)
        self.lower = sp.csc_matrix((upper.data, upper.indices, upper.indptr), shape=upper.shape)
        self.estimate_mb = law("cholmod", matrix, planar) + _size_mb(self.lower)
        self.nnz = None
        self.symbolic = analyze(self.lower, mode="supernodal", ordering_method="metis")

    def factor(self):
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
        return np.ascontiguousarray(self.symbolic(np.asarray(rhs, dtype=float)))


# --------------------------------------------------------------------------- MUMPS
class Mumps:
    """MUMPS through python-mumps, LDL'.

    The ordering is left to MUMPS.  PORD was a quarter faster on solids of revolution, but ends the process on some small dense matrices.
    """

    name = "mumps"

    def __init__(self, matrix: sp.csr_matrix, definite: bool = True):
        import mumps

        self.error, self.definite, self.context = mumps.MUMPSError, definite, mumps.Context()
        upper = upper_triangle(matrix).tocoo()
        self.context.set_matrix(upper, symmetric=True)
        self._try(self.context.analyze, ordering="auto")
        self.estimate_mb = (
            float(self.context.analysis_stats.est_mem_incore) + 16 * upper.nnz / 2**20
        )  # by coordinates: two indices and a number

    def _try(self, step, **options):
        try:
            step(**options)
        except self.error as error:
            raise FactorError(f"MUMPS could not factor the system matrix ({error})") from error

    def factor(self):
        self._try(
            self.context.factor, reuse_analysis=True, pivot_tol=0.0 if self.definite else 0.01
        )
        if self.definite and self.negative:
            raise FactorError(
                "MUMPS could not factor the system matrix: it is not positive definite"
            )

    @property
    def nnz(self) -> int:
        return int(self.context.factor_stats.nonzeros)

    @property
    def negative(self) -> int | None:
        """Negative pivots (INFOG(12) of the users' guide); None if tiny ones were replaced."""
        return (
            None
            if self.context.factor_stats.tiny_pivots
            else int(self.context.mumps_instance.infog[12])
        )

    def solve(self, rhs):
        return np.ascontiguousarray(self.context.solve(np.asarray(rhs, dtype=float)))


# --------------------------------------------------------------------------- SuperLU
# Reading SuperLU's pivots copies its factor.  That takes 1 to 4 % of the time on solids and 6 to 9 % on planar meshes, and as much memory again:
# done where SuperLU is the automatic choice for a solid, and where a planar matrix is so small that nobody notices.
CHECKED, CHECKED_PLANAR = 12_000, 1_000


class SuperLU:
    """SciPy's SuperLU in symmetric mode; pivots stay on the diagonal unless one vanishes."""

    name = "superlu"

    def __init__(self, matrix: sp.csr_matrix, definite: bool = True, planar: bool = False):
        # the matrix is symmetric: its rows are its columns
        self.matrix = sp.csc_matrix(
            (matrix.data, matrix.indices, matrix.indptr), shape=matrix.shape
        )
        self.checked = definite and matrix.shape[0] <= (CHECKED_PLANAR if planar else CHECKED)
        copies = 2 if self.checked or not definite else 1
        self.estimate_mb = copies * law("superlu", matrix, planar)

    def factor(self):
        n = self.matrix.shape[0]
        try:
            self._lu = Made(
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
                f"SuperLU ran out of memory or of 32-bit indices on {n} unknowns; install the extra 'fast', or use a coarser model"
            ) from None
        self.nnz = int(self._lu.value.nnz)
        del self.matrix
        # SuperLU does not mind an indefinite matrix, and one off-diagonal pivot is proof of a
        # vanishing diagonal.
        if self.checked and self.negative != 0:
            raise FactorError(
                "SuperLU could not factor the system matrix: it is not positive definite"
            )

    @property
    def negative(self) -> int | None:
        """Negative pivots; None where a row was exchanged, so that the signs say nothing.  Copies the factor."""
        lu = self._lu.value
        if not np.array_equal(lu.perm_r, lu.perm_c):
            return None
        return int(np.count_nonzero(lu.U.diagonal() < 0))

    def solve(self, rhs):
        return self._lu.value.solve(rhs)


# --------------------------------------------------------------------------- what is there
BACKENDS = {back.name: back for back in (Pardiso, Cholmod, Mumps, SuperLU)}
INSTALL = {
    "pardiso": "install the extra 'fast'",
    "cholmod": "install the extra 'cholmod'",
    "mumps": "install the extra 'mumps'",
}


@lru_cache
def missing(name: str) -> str:
    """Empty if the back end can be used, else the reason why not.

    Parameters
    ----------
    name : {'pardiso', 'cholmod', 'mumps', 'superlu'}
    """
    module = {
        "pardiso": "pypardiso",
        "cholmod": "scikit-sparse",
        "mumps": "python-mumps",
        "superlu": "scipy",
    }[name]
    try:
        back = BACKENDS[name](sp.identity(2, format="csr"))
        back.factor()
        if np.array_equal(back.solve(np.ones(2)), np.ones(2)):
            return ""
        return f"{module} is not usable (it fails on the unit matrix)"
    except Exception as error:  # a broken library raises OSError, ImportError, AttributeError ...
        return f"{module} is not usable ({type(error).__name__})"


# --------------------------------------------------------------------------- laws
# Peak memory of a factorisation in MB = c (n / 1e4)^a (entries / 1e6)^b, fitted to peaks of resident memory measured on the shipped
# overhung pinion: solids of all element types with 4 800 to 92 000 unknowns, harmonic blocks of 10 000 to 51 000 (order 2 to 8).
# Estimate over measured: superlu 0.68 to 1.41 (ten solids), 0.97 to 1.04 (five planar); cholmod 0.75 to 1.16 (eleven), 0.97 to 1.02.
# Graded hexahedra are at the low end: fitted without the largest of them, its memory came out as 0.47 (superlu) and 0.64 (cholmod) of the
# measured.  So these tell a model that fits from one that is hopeless, not one that just fits.
LAWS = {
    ("superlu", False): (74.9, 0.778, 0.540),
    ("superlu", True): (18.6, 0.0, 0.836),
    ("cholmod", False): (46.7, 0.455, 0.631),
    ("cholmod", True): (18.6, 0.0, 0.924),
}


def law(name: str, matrix: sp.csr_matrix, planar: bool) -> float:
    """Estimated peak memory, MB, of a back end that cannot say it itself."""
    factor, by_unknowns, by_entries = LAWS[name, planar]
    return factor * (matrix.shape[0] / 1e4) ** by_unknowns * (matrix.nnz / 1e6) ** by_entries
