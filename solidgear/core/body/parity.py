"""Motions that are symmetric or antisymmetric to mirror planes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from solidgear.core.body.model import Reflection


def symmetric_basis(
    n: int, reflections: Sequence[Reflection], parity: Sequence[float]
) -> sp.csr_matrix:
    """Return an orthonormal basis (n, p) of the motions that are symmetric or antisymmetric to every
    plane, by the parity in each: at most one entry a row, and of all parities together as many columns
    as there are unknowns.
    """
    unknowns = np.arange(n)
    # place and sign of every unknown under all products of reflections, as motions of this parity have it
    places, signs = [unknowns], [np.ones(n)]
    for (partner, sign), of_plane in zip(reflections, parity):
        places += [place[partner] for place in places]
        signs += [of_plane * turn[partner] * sign for turn in signs]
    first = np.min(places, axis=0) == unknowns
    # a motion on a plane that is turned into its opposite is none of this kind
    alive = np.all([(place != unknowns) | (t > 0) for place, t in zip(places, signs)], axis=0)
    start = np.flatnonzero(first & alive)
    # unknowns on a plane are met more than once, each time with the same sign
    weight = np.zeros(n)
    column_of = np.zeros(n, int)
    for place, t in zip(places, signs):
        weight[place[start]], column_of[place[start]] = t[start], np.arange(len(start))
    rows = np.flatnonzero(weight)
    size = np.bincount(column_of[rows], minlength=len(start))
    entries = weight[rows] / np.sqrt(size[column_of[rows]])
    return sp.csr_matrix((entries, (rows, column_of[rows])), shape=(n, len(start)))


def mirrored_basis(fold: sp.csr_matrix, reflection: Reflection) -> sp.csr_matrix:
    """Return the mirror image of a basis."""
    partner, sign = reflection
    return (sp.diags(sign) @ fold[partner]).tocsr()
