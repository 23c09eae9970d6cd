"""Factorisation of sparse symmetric matrices: which back end, whether it will fit, and the result.

``factorise(matrix)`` is for positive definite matrices, ``indefinite(matrix)`` for those whose
negative eigenvalues are counted. The back ends themselves are in :mod:`solidgear.solve.backends`.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp

from solidgear.machine.interruptible import call
from solidgear.machine.memory import available_mb
from solidgear.solve.backends import BACKENDS, INSTALL, missing
from solidgear.solve.backends.matrix import FactorError

__all__ = [
    "Factor",
    "FactorError",
    "Indefinite",
    "factorise",
    "indefinite",
    "negative_pivots",
    "pardiso_missing",
]

# SuperLU's indices overflow on the factors of planar meshes of very high order ("not enough
# memory").
LARGE_PLANAR = 30_000_000  # entries
# Solids below this size: what PARDISO gains is what it costs to load MKL (0.2 s, once).
SMALL = 6_000
# Fastest first, for solids. Factorisation against PARDISO at 41 000 (HEX20) and 93 000 unknowns
# (TET10), two runs in turn on two busy cores: CHOLMOD 0.65 to 1.3, MUMPS 1.4 to 1.8 with OpenBLAS;
# 2.7 and 5 with the reference BLAS (TET10, one run); SuperLU about 14 (HEX20, one run apart from
# these).
FASTEST = ("pardiso", "cholmod", "mumps", "superlu")
COUNTING = ("pardiso", "mumps", "superlu")
# Unknowns from which on a call can take so long that Ctrl-C must be heard meanwhile; handing it
# over costs 0.1 ms.
LONG = 5_000
# Normwise backward error (Rigal and Gaches) of one solve.  Solids give 1e-17, since their solutions
# lie in the low modes; it must be far below the ratio of the lowest eigenvalues to the norm, about
# 1e-9 there, for the signs of those to mean anything.
SOUND = 1e-14


@dataclass
class Factor:
    """Result of :func:`factorise`.

    Attributes
    ----------
    backend : str
        ``pardiso``, ``cholmod``, ``mumps`` or ``superlu``.
    reason : str
        Why this back end was taken.
    estimate_mb : float or None
        Memory it was expected to need, MB.
    nnz : int or None
        Entries of the factor, where the back end reports them.
    """

    backend: str
    reason: str
    _solve: Callable[[np.ndarray], np.ndarray]
    estimate_mb: float | None = None
    nnz: int | None = None

    def solve(self, rhs: np.ndarray) -> np.ndarray:
        """Solve with the factor.

        Parameters
        ----------
        rhs : (n,) or (n, k) ndarray

        Returns
        -------
        ndarray
            Of the same shape.
        """
        return _heard(len(rhs), self._solve, rhs)


@dataclass
class Indefinite(Factor):
    """Result of :func:`indefinite`.

    Attributes
    ----------
    negative : int
        Number of negative eigenvalues.
    """

    negative: int = 0


def pardiso_missing() -> str:
    """Empty if PARDISO can be used, else the reason why not."""
    return missing("pardiso")


def factorise(
    matrix: sp.spmatrix, backend: str | None = None, planar: bool = False, border: int = 0
) -> Factor:
    """Factor a symmetric positive definite matrix.

    Parameters
    ----------
    matrix : (n, n) sparse
        Both triangles given.
    backend : {None, 'pardiso', 'cholmod', 'mumps', 'superlu'}
        None chooses by size and availability; the environment variable ``SOLIDGEAR_BACKEND`` forces
        one for a whole run.
    planar : bool
        The matrix comes from a 1D or 2D mesh: fill is small and SuperLU is the fastest.
    border : int
        Unknowns at the end that couple to very many others.  They are eliminated by hand, as a
        dense Schur complement: left to a fill-reducing ordering they cost ten times the rest.

    Returns
    -------
    Factor

    Raises
    ------
    FactorError
        If the matrix holds NaN, is not positive definite to the back end, will not fit into memory,
        or the back end is not there.

    Examples
    --------
    >>> matrix = sp.csr_matrix(np.array([[4.0, 1.0], [1.0, 3.0]]))
    >>> factor = factorise(matrix, backend="superlu")
    >>> bool(np.allclose(matrix @ factor.solve(np.ones(2)), 1.0))
    True
    """
    matrix = _canonical(matrix)
    if border:
        return _bordered(
            matrix, border, lambda inner: factorise(inner, backend, planar), _definite_corner
        )
    name, reason = choice(matrix, backend, planar)
    work = _factored(name, matrix, planar, definite=True)
    return Factor(name, reason, work.solve, work.estimate_mb, work.nnz)


def indefinite(
    matrix: sp.spmatrix, backend: str | None = None, planar: bool = False, border: int = 0
) -> Indefinite | None:
    """Factor a symmetric matrix of any sign and count its negative eigenvalues (Sylvester's law of
    inertia).

    Every count is backed by the backward error of one solve with a random load: a stable
    factorisation counts exactly for a matrix within its backward error, so a count is in doubt only
    for eigenvalues that close to zero (one load is a sample, not a bound).  A back end whose factor
    is not sound, or whose pivots give no count, is passed over for the next.

    Parameters
    ----------
    matrix, backend, planar, border
        As for :func:`factorise`; CHOLMOD cannot, and if it is forced the others are tried.

    Returns
    -------
    Indefinite or None
        None if no back end gave a count that can be trusted; a matrix that is singular to rounding
        is such a case.

    Raises
    ------
    FactorError
        If the matrix holds NaN, will not fit into memory, or the back end is not there.

    Examples
    --------
    >>> indefinite(sp.csr_matrix(np.diag([2.0, -1.0, 3.0]))).negative
    1
    """
    matrix = _canonical(matrix)
    if border:
        return _bordered(
            matrix, border, lambda inner: indefinite(inner, backend, planar), _any_corner
        )
    chosen, reason = choice(matrix, backend, planar)
    forced = reason == FORCED and chosen in COUNTING
    others = () if forced else (other for other in COUNTING if other != chosen)
    for name in (chosen, *others):
        if name not in COUNTING or missing(name):
            continue
        try:
            work = _factored(name, matrix, planar, definite=False)
            if work.negative is not None and _backward_error(matrix, work.solve) < SOUND:
                return Indefinite(
                    name, reason, work.solve, work.estimate_mb, work.nnz, work.negative
                )
        except NoRoom:
            raise
        except FactorError:
            pass
        reason = f"no sound factor by {name}"
    return None


def negative_pivots(matrix: sp.spmatrix, backend: str | None = None) -> tuple[int, str] | None:
    """Number of negative eigenvalues of a sparse symmetric matrix.

    Parameters
    ----------
    matrix : (n, n) sparse
    backend : str, optional
        As for :func:`factorise`.

    Returns
    -------
    (int, str) or None
        The count and the back end that made it; None as for :func:`indefinite`.
    """
    found = indefinite(matrix, backend)
    return None if found is None else (found.negative, found.backend)


# --------------------------------------------------------------------------- choice
FORCED = "asked for"


class NoRoom(FactorError):
    """A factor that will not fit into memory."""


def _canonical(matrix):
    if not np.all(np.isfinite(matrix.data)):
        raise FactorError(
            "the system matrix holds NaN or infinite entries; check material and geometry"
        )
    matrix = sp.csr_matrix(matrix)
    if not matrix.has_canonical_format:
        matrix = matrix.copy() if matrix.has_sorted_indices else matrix.sorted_indices()
        matrix.sum_duplicates()
    return matrix


def choice(
    matrix: sp.csr_matrix, backend: str | None = None, planar: bool = False
) -> tuple[str, str]:
    """The back end that will factor a matrix.

    Parameters
    ----------
    matrix : (n, n) sparse
        Its size and number of entries count.
    backend, planar
        As for :func:`factorise`.

    Returns
    -------
    name, reason : str

    Raises
    ------
    FactorError
        If the one asked for is unknown or not there.

    Examples
    --------
    >>> choice(sp.identity(100, format="csr"), backend="superlu")
    ('superlu', 'asked for')
    """
    backend = backend or os.environ.get("SOLIDGEAR_BACKEND") or None
    n = matrix.shape[0]
    if backend is not None:
        if backend not in BACKENDS:
            raise FactorError(
                f"unknown back end {backend!r}; use " + ", ".join(map(repr, BACKENDS))
            )
        why = _missing(backend)
        if why:
            raise FactorError(f"back end {backend} was asked for but {why}")
        return backend, FORCED
    if planar and matrix.nnz < LARGE_PLANAR:
        return "superlu", "a planar mesh fills in little"
    if n <= SMALL:
        return "superlu", f"{n} unknowns are not above {SMALL}"
    absent = []
    for name in FASTEST:
        why = _missing(name)
        if not why:
            break
        absent.append(f"{why}; {INSTALL[name]}")
    return name, f"{n} unknowns are above {SMALL}" + "".join(
        f"; faster but absent: {why}" for why in absent
    )


def _missing(name):
    return pardiso_missing() if name == "pardiso" else missing(name)


def _factored(name, matrix, planar, definite):
    free = available_mb()
    options = {"planar": planar} if name in ("cholmod", "superlu") else {}
    n = matrix.shape[0]
    work = _heard(n, BACKENDS[name], matrix, definite=definite, **options)
    if free is not None and work.estimate_mb > free:
        raise NoRoom(
            f"{n} unknowns need about {_mb(work.estimate_mb)} MB to factor by {name}, "
            f"{_mb(free)} MB are free; "
            "use a coarser mesh, or the harmonic model, which needs far less"
        )
    _heard(n, work.factor)
    return work


def _heard(n, function, *arguments, **options):
    """A call that Ctrl-C can end, if it is on enough unknowns to last."""
    return call(function, *arguments, **options) if n >= LONG else function(*arguments, **options)


def _mb(amount):
    return f"{amount:.0f}" if amount >= 10 else f"{amount:.2g}"


def _backward_error(matrix, solve):
    rhs = np.random.default_rng(0).standard_normal(matrix.shape[0])
    x = solve(rhs)
    if not np.isfinite(x).all():
        return np.inf
    # Frobenius: bounds the 2-norm from above, by no more than the bandwidth's root
    largest = np.linalg.norm(matrix.data)
    return np.linalg.norm(matrix @ x - rhs) / (largest * np.linalg.norm(x) + np.linalg.norm(rhs))


# --------------------------------------------------------------------------- border
def _bordered(matrix, border, factor, corner_of):
    """Factor the inner part by `factor`, the Schur complement of the border by `corner_of`."""
    n = matrix.shape[0] - border
    if n == 0:  # a shaft that rigid seats hold from end to end: nothing but border
        return factor(matrix)
    inner = factor(matrix[:n, :n])
    if inner is None:
        return None
    edge = matrix[:n, n:].toarray()
    through = inner.solve(edge)
    corner = matrix[n:, n:].toarray() - edge.T @ through
    found = corner_of((corner + corner.T) / 2)
    if found is None:
        return None
    through_corner, negative = found

    def solve(rhs):
        top = inner.solve(rhs[:n])
        bottom = through_corner(rhs[n:] - edge.T @ top)
        return np.concatenate([top - through @ bottom, bottom])

    if isinstance(inner, Indefinite):
        # Haynsworth: the inertia of a matrix is that of a block plus that of its Schur complement.
        return Indefinite(
            inner.backend,
            inner.reason,
            solve,
            inner.estimate_mb,
            inner.nnz,
            inner.negative + negative,
        )
    return Factor(inner.backend, inner.reason, solve, inner.estimate_mb, inner.nnz)


def _definite_corner(corner):
    try:
        factor = sla.cho_factor(corner)
    except np.linalg.LinAlgError as error:
        raise FactorError("the system matrix is not positive definite") from error
    return (lambda rhs: sla.cho_solve(factor, rhs)), 0


def _any_corner(corner):
    # Rows of a border differ in unit (forces, moments): scaled, so that small ones are not taken
    # for rounding.
    scale = 1 / np.sqrt(np.maximum(np.abs(corner).max(axis=1), np.finfo(float).tiny))
    values, vectors = np.linalg.eigh(corner * np.outer(scale, scale))
    if np.abs(values).min() < 1e-13 * np.abs(values).max():
        return None
    inverse = scale[:, None] * (vectors / values) @ vectors.T * scale
    return (lambda rhs: inverse @ rhs), int(np.count_nonzero(values < 0))
