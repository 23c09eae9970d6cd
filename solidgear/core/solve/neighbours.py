"""Families of shapes whose frequencies lie so near that any mixture of them is as good a solution."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from typing import TypeVar

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import min_weight_full_bipartite_matching

Family = TypeVar("Family", bound=Hashable)


def best_assignment(gain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return rows and columns of a matrix in pairs of the largest sum, as many as there can be.

    Examples
    --------
    >>> rows, columns = best_assignment(np.array([[0.9, 0.8, 0.0], [0.9, 0.0, 0.0]]))
    >>> [(int(r), int(c)) for r, c in zip(rows, columns)]
    [(0, 1), (1, 0)]
    """
    # the graph knows no pairs of nothing; scipy.optimize, which does, takes long to import
    return min_weight_full_bipartite_matching(sp.csr_matrix(gain - gain.min() + 1), maximize=True)


def shared_families(
    rows: Mapping[Family, np.ndarray], size: list[float]
) -> Iterator[tuple[int, Family, np.ndarray]]:
    """Yield members of a space with a family each, as often as the space holds it, and the mixture
    of all members that is the part of one in that family; none where a coarse mesh does not decide.
    The rows (k, ...) hold the part of each member in a family, with the share of it as squared
    norm; `size` those of the members with all families.
    """
    spaces, places, gain = {}, [], []
    for family, row in rows.items():
        content, turn = np.linalg.eigh((row @ row.conj().T).real)
        spaces[family] = turn[:, content > np.mean(size) / 2]
        count = spaces[family].shape[1]
        places += count * [family]
        gain += count * [(np.abs(row) ** 2).sum(axis=1)]
    if len(places) == len(size):
        for i, place in zip(*best_assignment(np.transpose(gain))):
            yield int(i), places[place], spaces[places[place]] @ spaces[places[place]][i]
