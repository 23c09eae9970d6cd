"""Factorisation of sparse symmetric matrices: which back end, whether it will fit, and the result.

``factorise(matrix)`` is for positive definite matrices, ``indefinite(matrix)`` for those whose
negative eigenvalues are counted. The back ends themselves are in :mod:`solidgear.core.solve.backends`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from solidgear.core.factoring import Factoring
from solidgear.core.machine.memory import announce, available_mb, expect, require
from solidgear.core.solve.backends import BACKENDS, missing
from solidgear.core.solve.backends.matrix import FactorError
from solidgear.core.solve.choice import FORCED, USUAL, choice
from solidgear.core.solve.factored import Factor, Indefinite, call_interruptibly
from solidgear.core.solve.inertia_relief import Linear
from solidgear.core.solve.schur import any_corner, bordered, definite_corner
from solidgear.core.solve.single import Refining

__all__ = [
    "Factor",
    "FactorError",
    "Indefinite",
    "Planned",
    "factored",
    "factorise",
    "indefinite",
    "planned",
]

COUNTING = ("pardiso", "mumps", "superlu")
# Normwise backward error (Rigal and Gaches) of one solve.  Solids give 1e-17, since their solutions
# lie in the low modes; it must be far below the ratio of the lowest eigenvalues to the norm, about
# 1e-9 there, for the signs of those to mean anything.
SOUND = 1e-14


def factorise(
    matrix: sp.spmatrix,
    backend: str | None = None,
    planar: bool = False,
    border: int = 0,
    factoring: Factoring = USUAL,
    product: Linear | None = None,
) -> Factor:
    """Factor a symmetric positive definite matrix, given with both triangles.

    Parameters
    ----------
    backend : {None, 'pardiso', 'cholmod', 'mumps', 'superlu'}
        None chooses by size and availability; the environment variable ``SOLIDGEAR_BACKEND`` forces
        one for a whole run.
    planar : bool
        The matrix comes from a 1D or 2D mesh: fill is small and SuperLU is the fastest.
    border : int
        Unknowns at the end that couple to very many others. They are eliminated by hand, as a dense
        Schur complement: left to a fill-reducing ordering they cost ten times the rest.
    product : callable, optional
        ``matrix @ u``, by which a factor in single precision is refined; by default the matrix
        itself is kept for that.

    Raises
    ------
    FactorError
        If the matrix holds NaN, is not positive definite to the back end, or the back end is not
        there or cannot meet `factoring`.
    NoRoom
        If the factor will not fit into memory.

    Examples
    --------
    >>> matrix = sp.csr_matrix(np.array([[4.0, 1.0], [1.0, 3.0]]))
    >>> factor = factorise(matrix, backend="superlu")
    >>> bool(np.allclose(matrix @ factor.solve(np.ones(2)), 1.0))
    True
    """
    free = available_mb()
    return factored([planned(matrix, backend, planar, border, factoring, product)], free)[0]


@dataclass(frozen=True)
class Planned:
    """A factor that is not made yet."""

    unknowns: int
    backend: str  #: that will make it
    estimate_mb: float  #: memory that it will take, by the back end's own analysis where it has one
    make: Callable[[], Factor]  #: the :class:`Factor`; once


def planned(
    matrix: sp.spmatrix,
    backend: str | None = None,
    planar: bool = False,
    border: int = 0,
    factoring: Factoring = USUAL,
    product: Linear | None = None,
) -> Planned:
    """Analyse a matrix without computing a factor; parameters as for :func:`factorise`. FactorError
    if the matrix holds NaN, or the back end is not there or cannot meet `factoring`.

    Examples
    --------
    >>> planned(sp.identity(4, format="csr"), backend="superlu").make().solve(np.ones(4))
    array([1., 1., 1., 1.])
    """
    matrix = _canonical(matrix)
    n = matrix.shape[0]
    # a shaft that rigid seats hold from end to end is nothing but border
    if 0 < border < n:
        full_product = product or matrix.__matmul__

        def inner_product(u):
            return full_product(np.pad(u, ((0, border), (0, 0))))[:-border]

        inner = planned(matrix[:-border, :-border], backend, planar, 0, factoring, inner_product)

        def make_bordered():
            return bordered(matrix, border, lambda _: inner.make(), definite_corner)

        return Planned(n, inner.backend, inner.estimate_mb, make_bordered)
    name, reason = choice(n, matrix.nnz, backend, planar, factoring)
    work = _analysed(name, matrix, planar, True, factoring)

    def make():
        call_interruptibly(n, work.factor)
        solve, refining = work.solve, None
        if factoring.precision != "double":
            refining = Refining(product or matrix.__matmul__, work.solve)
            solve = refining.solve
        return Factor(
            name,
            reason,
            solve,
            estimate_mb=work.estimate_mb,
            nnz=work.nnz,
            factoring=factoring,
            refining=refining,
        )

    return Planned(n, name, work.estimate_mb, make)


def factored(plans: Sequence[Planned], free: float | None = None) -> list[Factor]:
    """Make factors that will all be held, if they fit into memory together: into the MB that were
    free before the analysis, which takes a part of it.

    NoRoom with unknowns, the memory they need and the memory free, before a number is computed;
    FactorError if a matrix is not positive definite to the back end.
    """
    unknowns, need = sum(p.unknowns for p in plans), sum(p.estimate_mb for p in plans)
    require(need, f"{unknowns} unknowns", plans[0].backend, free)
    expect(need)
    announce(unknowns, need)
    return [plan.make() for plan in plans]


def indefinite(
    matrix: sp.spmatrix, backend: str | None = None, planar: bool = False, border: int = 0
) -> Indefinite | None:
    """Factor a symmetric matrix of any sign and count its negative eigenvalues (Sylvester's law of
    inertia); parameters and errors as for :func:`factorise`.

    Every count is backed by the backward error of one solve with a random load: a stable
    factorisation counts exactly for a matrix within its backward error, so a count is in doubt only
    for eigenvalues that close to zero (one load is a sample, not a bound). A back end whose factor
    is not sound, or whose pivots give no count, such as CHOLMOD, is passed over for the next; None
    if no count can be trusted, as for a matrix that is singular to rounding.

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
    chosen, reason = choice(matrix.shape[0], matrix.nnz, backend, planar)
    forced = reason == FORCED and chosen in COUNTING
    names = [chosen] if forced else [chosen, *(name for name in COUNTING if name != chosen)]
    for name in names:
        if name not in COUNTING or missing(name):
            continue
        try:
            free = available_mb()
            work = _analysed(name, matrix, planar, False, USUAL)
            require(work.estimate_mb, f"{matrix.shape[0]} unknowns", name, free)
            call_interruptibly(matrix.shape[0], work.factor)
            if work.negative is not None and _backward_error(matrix, work.solve) < SOUND:
                return Indefinite(
                    name, reason, work.solve, work.estimate_mb, work.nnz, negative=work.negative
                )
        except FactorError:
            pass
        reason = f"no sound factor by {name}"
    return None


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


def _analysed(name, matrix, planar, definite, factoring):
    options = {"planar": planar} if name in ("cholmod", "superlu") else {}
    options |= {"single": True} if factoring.precision == "single" else {}
    options |= {"out_of_core": True} if factoring.out_of_core else {}
    return call_interruptibly(matrix.shape[0], BACKENDS[name], matrix, definite=definite, **options)


def _backward_error(matrix, solve):
    rhs = np.random.default_rng(0).standard_normal(matrix.shape[0])
    x = solve(rhs)
    if not np.isfinite(x).all():
        return np.inf
    # Frobenius: bounds the 2-norm from above, by no more than the bandwidth's root
    largest = np.linalg.norm(matrix.data)
    return np.linalg.norm(matrix @ x - rhs) / (largest * np.linalg.norm(x) + np.linalg.norm(rhs))
