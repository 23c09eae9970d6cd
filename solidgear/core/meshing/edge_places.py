"""Look-up of edges in a list of edges, by the two vertices that each lies between."""

from __future__ import annotations

import numpy as np


def edge_places(listed: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Return places of edges (2, ...) in a list of edges (2, k), by the vertices that they lie
    between, in either order: the first of several, -1 where the list does not have the edge.

    Examples
    --------
    >>> edge_places(np.array([[4, 1, 0], [2, 0, 1]]), np.array([[2, 1, 3], [4, 0, 0]]))
    array([ 0,  1, -1])
    """
    # of 64 bits: products of numbers pass 2^31 from 46,341 vertices on
    low, high = np.sort(listed.astype(np.int64), axis=0)
    first, last = np.sort(wanted.astype(np.int64), axis=0)
    total = 1 + max(high.max(initial=0), last.max(initial=0))
    key, sought = low * total + high, first * total + last
    order = np.argsort(key, kind="stable")
    place = order[np.minimum(np.searchsorted(key[order], sought), len(key) - 1)]
    return np.where(key[place] == sought, place, -1)
