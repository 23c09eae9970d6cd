"""MKL's PARDISO, called without a wrapper."""

from __future__ import annotations

import ctypes
import os
import weakref
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, files

import numpy as np
import scipy.sparse as sp

from solidgear.machine.threads import offered
from solidgear.solve.backends.matrix import FactorError, size_mb, upper_triangle


@lru_cache(maxsize=1)
def _mkl():
    """The library.

    Its threads sleep as soon as a call is over, unless the environment has it otherwise: by default
    they spin for 0.2 s, which with both of two cores busy made ten modes of a 3D solid take 1.3
    times as long (two runs in turn: 1.36, 1.34).

    pypardiso searches the whole environment for the library at every construction (1 s and more);
    the installed package ``mkl`` knows where its library is, and asking once is enough.
    """
    os.environ.setdefault("KMP_BLOCKTIME", "0")  # read when the library is loaded
    installed = None if os.environ.get("PYPARDISO_MKL_RT") else _installed_mkl()
    if installed is not None:
        return ctypes.CDLL(str(installed.locate()))
    from pypardiso.pardiso_wrapper import PyPardisoSolver

    return PyPardisoSolver(mtype=2).libmkl


def _installed_mkl():
    """The library in the package ``mkl``, or None."""
    try:
        inside = files("mkl") or ()
    except PackageNotFoundError:
        return None
    return next((f for f in inside if "mkl_rt" in f.name), None)


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

    Parameters
    ----------
    matrix : (n, n) sparse
        Symmetric, sorted rows.
    definite : bool
        Whether it is positive definite: LL', else LDL' with Bunch-Kaufman pivots.

    Raises
    ------
    FactorError
        If an entry of the diagonal is missing, or the analysis fails.
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
        empty = np.diff(self.upper.indptr).min() == 0
        if empty or np.any(self.upper.indices[self.upper.indptr[:-1]] != np.arange(self.n)):
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
        self._release.atexit = False  # a factorisation that was interrupted may still use it
        self._call(11)
        symbolic_peak, symbolic, numeric = (int(kb) for kb in self.iparm[14:17])
        self.estimate_mb = max(symbolic_peak, symbolic + numeric) / 1024 + size_mb(self.upper)

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
        """Factor; :class:`FactorError` if the matrix is not what it should be."""
        self._call(22)

    @property
    def nnz(self) -> int:
        """Entries of the factor."""
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
        """Solution for one (n,) or several (n, k) right-hand sides; `FactorError` for NaN."""
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

    The three motions of a node have the same neighbours: ordering nodes gives the same fill for a
    ninth of the graph, and the analysis takes 0.3 s instead of 1.0 s on 93,000 unknowns. Only the
    cost depends on it, so the test may be a loose one.
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
