"""Factors of a matrix that mirror planes leave as it is, made in independent pieces.

A body of revolution in hexahedra looks the same in the mirror of the planes x = 0 and z = 0. Each
reflection is an orthogonal matrix P of one entry a row, P P = I, and ``P A = A P``: motions that
are symmetric and antisymmetric to each plane do not meet in A. On an orthonormal basis T of every
such kind A falls into pieces ``T' A T``, and ``A^-1 = sum T (T' A T)^-1 T'`` (Bossavit 1986,
"Symmetry, groups, and boundary value problems"). Two planes leave four pieces of a quarter of the
unknowns: a quarter of the arithmetic of a factorisation of a 3D solid, and less than half of the
entries. Where the plane x = z between them is a mirror as well it makes one of the two kinds of
bending into the other: T of the second is P T of the first, their pieces are one matrix, and one
factor serves both.

Only the factor is folded. The body, the shapes and all judgements stay on all of the mesh, so that
every solution is still checked against the whole matrix.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import Reflection
from solidgear.core.solve.choice import choice
from solidgear.core.solve.factor import Planned, planned
from solidgear.core.solve.factored import Factor

#: A row of a matrix and of its reflection may differ by so much of it. Assembling leaves 2e-15 to
#: 3e-14, more where cells are thin; a mesh that only nearly has a mirror plane is off by far more.
ALIKE = 1e-11


def planned_by_symmetry(matrix: sp.csr_matrix, reflections: Sequence[Reflection]) -> Planned | None:
    """Analyse a symmetric positive definite matrix of a solid, given with both triangles, by the
    pieces of it; None where there is no reflection, or one does not leave the matrix as it is.
    FactorError as :func:`~solidgear.core.solve.factor.planned`.

    Each reflection (partner, sign) is its own inverse; the first two give the same in either order,
    a third one turns the first into the second.

    Examples
    --------
    Three equal masses in a row, which the mirror turns end for end:

    >>> matrix = sp.csr_matrix(np.array([[3.0, -1.0, 0.0], [-1.0, 3.0, -1.0], [0.0, -1.0, 3.0]]))
    >>> factor = planned_by_symmetry(matrix, [(np.array([2, 1, 0]), np.ones(3))]).make()
    >>> bool(np.allclose(matrix @ factor.solve(np.arange(3.0)), np.arange(3.0)))
    True
    """
    if not reflections or not _leave_unchanged(matrix, reflections):
        return None
    backend, reason = choice(matrix.shape[0], matrix.nnz)
    kinds = symmetric_bases(matrix.shape[0], reflections[:2])
    pieces = []
    for kind, fold in kinds.items():
        twin = kind[::-1] if len(reflections) == 3 and kind[0] != kind[-1] else None
        if twin is not None and kind < twin:
            continue  # solved beside the other one
        folds = [fold] if twin is None else [fold, mirrored_basis(fold, reflections[2])]
        # All columns of K T are as symmetric as those of T: one row of each orbit gives the others.
        first, size = _first_of(fold)
        small = (sp.diags(np.sqrt(size)) @ matrix[first]) @ fold
        small.sort_indices()
        pieces.append((folds, [f.T.tocsr() for f in folds], planned(small, backend)))
    estimate = sum(plan.estimate_mb for *_, plan in pieces)

    def make():
        factored = [(folds, back, plan.make()) for folds, back, plan in pieces]
        return Factor(
            factored[0][2].backend,
            f"{reason}; in {len(factored)} pieces by mirror planes",
            _solver(factored),
            estimate,
            _total(factor.nnz for *_, factor in factored),
        )

    return Planned(matrix.shape[0], backend, estimate, make)


def _solver(pieces):
    """Combine the solutions of all pieces."""

    def solve(rhs):
        columns = rhs.reshape(len(rhs), -1)
        width = columns.shape[1]
        out = np.zeros_like(columns, dtype=float)
        for folds, back, factor in pieces:
            folded = np.hstack([b @ columns for b in back])
            if not folded.any():
                continue  # loads of another kind
            solution = factor.solve(folded)
            for i, fold in enumerate(folds):
                out += fold @ solution[:, i * width : (i + 1) * width]
        return out.reshape(rhs.shape)

    return solve


def symmetric_bases(
    n: int, reflections: Sequence[Reflection]
) -> dict[tuple[float, ...], sp.csr_matrix]:
    """Return orthonormal bases (n, p) of the motions that are symmetric or antisymmetric to every
    plane, by the parity in each: at most one entry a row, and together as many columns as there are
    unknowns.
    """
    unknowns = np.arange(n)
    # place and sign of every unknown under all products of reflections
    places, signs = [unknowns], [np.ones(n)]
    for partner, sign in reflections:
        places += [place[partner] for place in places]
        signs += [turn[partner] * sign for turn in signs]
    first = np.min(places, axis=0) == unknowns
    bases = {}
    for kind in itertools.product((1.0, -1.0), repeat=len(reflections)):
        parity = [1.0]
        for plane_parity in kind:
            parity += [plane_parity * p for p in parity]
        # a motion on a plane that is turned into its opposite is none of this kind
        turned = [p * s for p, s in zip(parity, signs)]
        included = first & np.all(
            [(place != unknowns) | (t > 0) for place, t in zip(places, turned)], axis=0
        )
        start = np.flatnonzero(included)
        if not len(start):
            continue
        column = np.arange(len(start))
        # unknowns on a plane are met more than once, each time with the same sign
        weight = np.zeros(n)
        column_of = np.zeros(n, int)
        for place, t in zip(places, turned):
            weight[place[start]], column_of[place[start]] = t[start], column
        rows = np.flatnonzero(weight)
        size = np.bincount(column_of[rows], minlength=len(start))
        entries = weight[rows] / np.sqrt(size[column_of[rows]])
        bases[kind] = sp.csr_matrix((entries, (rows, column_of[rows])), shape=(n, len(start)))
    return bases


def mirrored_basis(fold: sp.csr_matrix, reflection: Reflection) -> sp.csr_matrix:
    """Return the mirror image of a basis."""
    partner, sign = reflection
    return (sp.diags(sign) @ fold[partner]).tocsr()


def _first_of(fold: sp.csr_matrix) -> tuple[np.ndarray, np.ndarray]:
    """Return the first unknown of every column, and how many unknowns the column has."""
    columns = fold.tocsc()
    return columns.indices[columns.indptr[:-1]], np.diff(columns.indptr)


def _leave_unchanged(matrix: sp.csr_matrix, reflections: Sequence[Reflection]) -> bool:
    """Return whether every reflection leaves a matrix as it is, to rounding."""
    probe = np.random.default_rng(0).standard_normal(matrix.shape[0])
    products = matrix @ np.column_stack([probe, *(s * probe[p] for p, s in reflections)])
    # row by row: small entries are not lost in the sum of large ones
    size = np.sqrt(np.add.reduceat(matrix.data**2, matrix.indptr[:-1]))
    return all(
        (
            np.abs(mirrored - sign * products[partner, 0])
            <= ALIKE * np.maximum(size, size[partner])
        ).all()
        for mirrored, (partner, sign) in zip(products.T[1:], reflections)
    )


def _total(numbers):
    counts = list(numbers)
    return None if None in counts else sum(counts)
