"""MKL's PARDISO, called without a wrapper."""

from __future__ import annotations

import ctypes
import os
import shutil
import tempfile
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, files

import numpy as np
import scipy.sparse as sp

from solidgear.core.machine.threads import usable_cores
from solidgear.core.solve.backends.matrix import FactorError, size_mb, upper_triangle


@lru_cache(maxsize=1)
def _mkl():
    """Load the library, once.

    The threads of it sleep as soon as a call is over, unless the environment has it otherwise: by
    default they spin for 0.2 s, which with both of two cores busy made ten modes of a 3D solid take
    1.3 times as long (two runs in turn: 1.36, 1.34).

    pypardiso searches the whole environment for the library at every construction (1 s and more);
    the installed package ``mkl`` knows where the library is, and asking once is enough.
    """
    os.environ.setdefault("KMP_BLOCKTIME", "0")  # read when the library is loaded
    installed = None if os.environ.get("PYPARDISO_MKL_RT") else _installed_mkl()
    if installed is not None:
        return ctypes.CDLL(str(installed.locate()))
    from pypardiso.pardiso_wrapper import PyPardisoSolver

    return PyPardisoSolver(mtype=2).libmkl


def _installed_mkl():
    """Find the library in the package ``mkl``; None if it is not installed."""
    try:
        inside = files("mkl") or ()
    except PackageNotFoundError:
        return None
    return next((f for f in inside if "mkl_rt" in f.name), None)


@lru_cache(maxsize=1)
def _mkl_pardiso():
    """Return the C function, on no more threads than there are processors for it."""
    library = _mkl()
    function = library["pardiso"]  # a handle of our own, without pypardiso's argument types
    function.restype = None
    most = min(usable_cores(), library.MKL_Get_Max_Threads())

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


#: bytes by the entry of the matrix that an out-of-core factor keeps of itself in memory; PARDISO gives
#: it (iparm 63) only of the factorisation that is not used here: 16.0 and 16.4 on two solids
KEPT = 16.0


class Pardiso:
    """MKL PARDISO called directly: pypardiso copies the indices at every call, hashes the matrix at
    every solve and refines twice. LL' of a positive definite matrix, else LDL' with Bunch-Kaufman
    pivots; out of core the factor is kept in a folder that goes with it.

    Parameter numbers and error codes: oneMKL developer reference, "pardiso iparm Parameter".

    Raises
    ------
    FactorError
        If an entry of the diagonal is missing, or the analysis fails.
    """

    name = "pardiso"
    package, install = "pypardiso", "pip install 'solidgear[fast]'"
    ERRORS = {
        -2: "not enough memory",
        -4: "a zero or negative pivot: the matrix is not positive definite",
        -8: "an overflow of 32-bit integers",
        -9: "not enough memory for what an out-of-core factor keeps of itself",
        -10: "the files of an out-of-core factor cannot be opened",
        -11: "the files of an out-of-core factor cannot be read or written; is the disk full?",
    }
    # no defaults; parallel nested dissection; no refinement; two-level factorisation; parallel
    # solve; report entries; count from zero
    SETTINGS = {1: 1, 2: 3, 8: 0, 24: 1, 25: 2, 18: -1, 35: 1}
    # perturb pivots below 1e-8 of the norm (and report them); Bunch-Kaufman pivots
    INDEFINITE = {10: 8, 21: 1}
    SINGLE = {28: 1}
    # in files; with an order of one's own or two-level factorisation PARDISO keeps nearly all in
    # memory all the same (measured at 142,533 unknowns: a peak of 1290 MB for 787)
    OUT_OF_CORE = {60: 2, 2: 2, 24: 0}

    def __init__(
        self,
        matrix: sp.csr_matrix,
        definite: bool = True,
        single: bool = False,
        out_of_core: bool = False,
    ):
        self.number = np.float32 if single else np.float64
        self.upper = upper_triangle(matrix)
        self.upper.data = self.upper.data.astype(self.number, copy=False)
        self.n = matrix.shape[0]
        # An empty row would end in a segmentation fault.
        empty = np.diff(self.upper.indptr).min() == 0
        if empty or np.any(self.upper.indices[self.upper.indptr[:-1]] != np.arange(self.n)):
            raise FactorError(
                "PARDISO failed on the system matrix: an entry of the diagonal is missing"
            )
        self.pt, self.iparm = np.zeros(64, np.int64), np.zeros(64, np.int32)
        settings = dict(self.SETTINGS)
        settings |= {} if definite else self.INDEFINITE
        settings |= self.SINGLE if single else {}
        settings |= self.OUT_OF_CORE if out_of_core else {}
        for number, value in settings.items():
            self.iparm[number - 1] = value
        self.definite = definite
        self.folder = _folder(self) if out_of_core else None
        self.order = None if out_of_core else _node_order(matrix)
        if self.order is not None:
            self.iparm[4] = 1
        self.ia, self.ja = (
            self.upper.indptr.astype(np.int32, copy=False),
            self.upper.indices.astype(np.int32, copy=False),
        )
        self._release = weakref.finalize(
            self,
            _release,
            _mkl_pardiso(),
            self.pt,
            self.iparm,
            2 if definite else -2,
            self.n,
            self.folder,
        )
        self._release.atexit = False  # a factorisation that was interrupted may still use it
        self._call(11)
        symbolic_peak, symbolic, numeric = (int(kb) for kb in self.iparm[14:17])
        if out_of_core:
            numeric = KEPT * matrix.nnz / 1024
            self.core_mb = 2 * numeric / 1024 + 100
        self.estimate_mb = max(symbolic_peak, symbolic + numeric) / 1024 + size_mb(self.upper)

    #: MB that an out-of-core factor may hold in memory; given by PARDISO after the analysis
    core_mb = 2000.0

    def _call(self, phase, rhs=UNUSED, x=UNUSED, columns=1):
        mtype = 2 if self.definite else -2
        with _files_in(self.folder, self.core_mb):
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
        """Factor; :class:`FactorError` if the matrix cannot be factored."""
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
        """Solve for one (n,) or several (n, k) right-hand sides; `FactorError` for NaN."""
        rhs = np.asfortranarray(rhs, dtype=self.number)
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


#: neighbours of three unknowns over those of a node: 1.00 on seven solids, 1.36 on halves
SPREAD = 1.2


def _node_order(matrix, components: int = 3) -> np.ndarray | None:
    """Find a fill-reducing order of a solid from the graph of the nodes, or None if unknowns do not
    come in threes.

    The three motions of a node have the same neighbours: ordering nodes gives the same fill for a
    ninth of the graph, and the analysis takes 0.3 s instead of 1.0 s on 93,000 unknowns. Only the
    cost depends on it, so the test may be a loose one.
    """
    n, remainder = divmod(matrix.shape[0], components)
    if remainder or n < 1000:
        return None
    length = np.diff(matrix.indptr).reshape(n, components)
    # entries that happen to be zero may be missing
    if np.mean(length.min(axis=1) > 0.3 * length.max(axis=1)) < 0.9:
        return None
    rows = matrix[::components]
    entries = rows.nnz
    graph = sp.csr_matrix((np.ones(entries), rows.indices // components, rows.indptr), shape=(n, n))
    graph.sum_duplicates()
    # Half a part has nodes of fewer unknowns on its plane. Where their number is a multiple of three
    # as well, threes are not nodes, and have a third more neighbours than these.
    if components * graph.nnz > SPREAD * entries:
        return None
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


def _folder(owner: Pardiso) -> str:
    """Make a folder for the files of one factor, deleted with it; where it is follows ``TMPDIR``."""
    folder = tempfile.mkdtemp(prefix="solidgear-factor-")
    weakref.finalize(owner, shutil.rmtree, folder, ignore_errors=True)
    return folder


@contextmanager
def _files_in(folder: str | None, core_mb: float) -> Iterator[None]:
    """Set the environment variables by which PARDISO finds the folder of its files and the memory
    that it may take beside them.
    """
    if folder is None:
        yield
        return
    wanted = {
        # MKL 2026 takes it for a folder, 2024.2 for the beginning of names
        "MKL_PARDISO_OOC_PATH": os.path.join(folder, ""),
        "MKL_PARDISO_OOC_MAX_CORE_SIZE": str(int(np.ceil(core_mb))),
    }
    before = {name: os.environ.get(name) for name in wanted}
    os.environ.update(wanted)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _release(pardiso, pt, iparm, mtype, n, folder=None):
    """Give PARDISO's memory back."""
    nothing = np.zeros(1)
    with _files_in(folder, Pardiso.core_mb):
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
