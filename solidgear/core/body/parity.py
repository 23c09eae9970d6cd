"""Motions that are symmetric or antisymmetric to mirror planes."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from solidgear.core.body.model import Reflection


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
