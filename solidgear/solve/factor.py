"""Factorisation of sparse symmetric matrices: which back end, whether it will fit, and the result.

``factorise(matrix)`` is for positive definite matrices, ``indefinite(matrix)`` for those whose
negative eigenvalues are counted. The back ends themselves are in :mod:`solidgear.solve.backends`.
"""

from __future__ import annotations

import os

import numpy as np
import scipy.sparse as sp

from solidgear.factoring import Factoring
from solidgear.machine.memory import available_mb
from solidgear.solve.backends import BACKENDS, INSTALL, OUT_OF_CORE, SINGLE, missing
from solidgear.solve.backends.matrix import FactorError
from solidgear.solve.factored import Factor, Indefinite, heard
from solidgear.solve.inertia_relief import Linear
from solidgear.solve.schur import any_corner, bordered, definite_corner
from solidgear.solve.single import Refining

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
# Solids below this size: what PARDISO gains is what it costs to load MKL (0.2 s, once). A corrected
# solid of four halves of 4,000 to 5,000 unknowns gains 0.25 s.
SMALL = 3_500
# Fastest first, for solids. Factorisation against PARDISO at 41 000 (HEX20) and 93 000 unknowns
# (TET10), two runs in turn on two busy cores: CHOLMOD 0.65 to 1.3, MUMPS 1.4 to 1.8 with OpenBLAS;
# 2.7 and 5 with the reference BLAS (TET10, one run); SuperLU about 14 (HEX20, one run apart from
# these).
FASTEST = ("pardiso", "cholmod", "mumps", "superlu")
COUNTING = ("pardiso", "mumps", "superlu")
# Normwise backward error (Rigal and Gaches) of one solve.  Solids give 1e-17, since their solutions
# lie in the low modes; it must be far below the ratio of the lowest eigenvalues to the norm, about
# 1e-9 there, for the signs of those to mean anything.
SOUND = 1e-14
#: a factor in double precision, in memory
USUAL = Factoring()


def pardiso_missing() -> str:
    """Empty if PARDISO can be used, else the reason why not."""
    return missing("pardiso")


def factorise(
    matrix: sp.spmatrix,
    backend: str | None = None,
    planar: bool = False,
    border: int = 0,
    factoring: Factoring = USUAL,
    product: Linear | None = None,
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
    factoring : Factoring
        Precision of the factor, and whether it is kept in files.
    product : callable, optional
        ``matrix @ u``, by which a factor in single precision is refined; by default the matrix
        itself is kept for that.

    Returns
    -------
    Factor

    Raises
    ------
    FactorError
        If the matrix holds NaN, is not positive definite to the back end, will not fit into memory,
        or the back end is not there or cannot do what is asked of the factor.

    Examples
    --------
    >>> matrix = sp.csr_matrix(np.array([[4.0, 1.0], [1.0, 3.0]]))
    >>> factor = factorise(matrix, backend="superlu")
    >>> bool(np.allclose(matrix @ factor.solve(np.ones(2)), 1.0))
    True
    """
    matrix = _canonical(matrix)
    # a shaft that rigid seats hold from end to end is nothing but border
    if 0 < border < matrix.shape[0]:
        whole = product or matrix.__matmul__

        def inner_product(u):
            return whole(np.pad(u, ((0, border), (0, 0))))[:-border]

        return bordered(
            matrix,
            border,
            lambda inner: factorise(inner, backend, planar, 0, factoring, inner_product),
            definite_corner,
        )
    name, reason = choice(matrix, backend, planar, factoring)
    work = _factored(name, matrix, planar, True, factoring)
    if factoring.precision == "double":
        return Factor(name, reason, work.solve, work.estimate_mb, work.nnz, factoring)
    refining = Refining(product or matrix.__matmul__, work.solve)
    return Factor(name, reason, refining.solve, work.estimate_mb, work.nnz, factoring, refining)


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
        return bordered(
            matrix, border, lambda inner: indefinite(inner, backend, planar), any_corner
        )
    chosen, reason = choice(matrix, backend, planar)
    forced = reason == FORCED and chosen in COUNTING
    others = () if forced else (other for other in COUNTING if other != chosen)
    for name in (chosen, *others):
        if name not in COUNTING or missing(name):
            continue
        try:
            work = _factored(name, matrix, planar, False, USUAL)
            if work.negative is not None and _backward_error(matrix, work.solve) < SOUND:
                return Indefinite(
                    name, reason, work.solve, work.estimate_mb, work.nnz, negative=work.negative
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
    matrix: sp.csr_matrix,
    backend: str | None = None,
    planar: bool = False,
    factoring: Factoring = USUAL,
) -> tuple[str, str]:
    """The back end that will factor a matrix.

    Parameters
    ----------
    matrix : (n, n) sparse
        Its size and number of entries count.
    backend, planar, factoring
        As for :func:`factorise`.

    Returns
    -------
    name, reason : str

    Raises
    ------
    FactorError
        If the one asked for is unknown, not there, or cannot do it.

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
        if backend not in _able(factoring):
            raise FactorError(
                f"back end {backend} was asked for but makes no factor in {factoring.words}; "
                f"{' or '.join(_able(factoring)) or 'none'} does"
            )
        return backend, FORCED
    if factoring.out_of_core:
        return _out_of_core(factoring)
    if planar and matrix.nnz < LARGE_PLANAR:
        return "superlu", "a planar mesh fills in little"
    if n <= SMALL:
        return "superlu", f"{n} unknowns are not above {SMALL}"
    absent = []
    for name in (name for name in FASTEST if name in _able(factoring)):
        why = _missing(name)
        if not why:
            break
        absent.append(f"{why}; {INSTALL[name]}")
    return name, f"{n} unknowns are above {SMALL}" + "".join(
        f"; faster but absent: {why}" for why in absent
    )


def _able(factoring: Factoring) -> tuple[str, ...]:
    """Back ends that make such a factor, fastest first."""
    single, files = factoring.precision == "single", factoring.out_of_core
    return tuple(
        name
        for name in FASTEST
        if (not single or name in SINGLE) and (not files or name in OUT_OF_CORE)
    )


def _out_of_core(factoring: Factoring) -> tuple[str, str]:
    absent = []
    for name in _able(factoring):
        why = _missing(name)
        if not why:
            return name, "it keeps its factor in files"
        absent.append(f"{why}: {INSTALL[name]}")
    raise FactorError(f"no back end here makes a factor in {factoring.words}: {'; '.join(absent)}")


def _missing(name):
    return pardiso_missing() if name == "pardiso" else missing(name)


def _factored(name, matrix, planar, definite, factoring):
    free = available_mb()
    options = {"planar": planar} if name in ("cholmod", "superlu") else {}
    options |= {"single": True} if factoring.precision == "single" else {}
    options |= {"out_of_core": True} if factoring.out_of_core else {}
    n = matrix.shape[0]
    work = heard(n, BACKENDS[name], matrix, definite=definite, **options)
    if free is not None and work.estimate_mb > free:
        raise NoRoom(
            f"{n} unknowns need about {_mb(work.estimate_mb)} MB to factor by {name}, "
            f"{_mb(free)} MB are free; "
            "use a coarser mesh, or the harmonic model, which needs far less"
            + f"; {less_memory(factoring)}"
            * bool(definite and not planar and less_memory(factoring))
        )
    heard(n, work.factor)
    return work


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


def less_memory(factoring: Factoring) -> str:
    """Settings of a factor that takes less memory than it does so far, or nothing."""
    more = [] if factoring.precision == "single" else ["precision = single"]
    more += [] if factoring.out_of_core else ["out_of_core = true"]
    return f"a 3D solid also takes {' or '.join(more)}" if more else ""
