"""Motions of cross-sections in a shape: least squares, weighted by mass, over motions that are
linear between stations along the axis.

A shape u of a body is described by section motions q at stations s as ``u = sum_s h_s(y) R(x, z)
q_s``, with hat functions h_s and the rigid motions R of a section about its own centre. The normal
equations are ``G q = b`` with ``G_st = int rho h_s h_t R'R`` and the loads ``b_s = int rho h_s
R'u``, which are linear in the unknowns of u. Both are integrals over the material: no mesh has to
be fine enough to hold a hat function.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.sparse as sp

#: Stations (s,) to loads (n, s c), one column per station and component, and the matrix G (s c, s
#: c).
Sections = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def hats(y: np.ndarray, stations: np.ndarray) -> sp.csr_matrix:
    """Return (p, s) hat functions of ascending stations at some places (p,), m, not beyond the
    outer ones.

    Examples
    --------
    >>> import numpy as np
    >>> hats(np.array([0.25, 1.0]), np.array([0.0, 1.0, 2.0])).toarray()
    array([[0.75, 0.25, 0.  ],
           [0.  , 1.  , 0.  ]])
    """
    below = np.clip(np.searchsorted(stations, y, side="right") - 1, 0, len(stations) - 2)
    t = (y - stations[below]) / (stations[below + 1] - stations[below])
    values, columns = np.column_stack([1 - t, t]), np.column_stack([below, below + 1])
    return sp.csr_matrix(
        (values.ravel(), columns.ravel(), np.arange(0, 2 * len(y) + 1, 2)),
        shape=(len(y), len(stations)),
    )


def from_points(
    mass: Any, rigid: np.ndarray, y: np.ndarray, components: tuple[int, ...]
) -> Sections:
    """Return sections of a body whose unknowns are values at points ``y`` (m), closer to each other
    than the stations; one with NaN is no value at a point and takes no part in the fields. `rigid`
    (n, c) are rigid motions about the origin.
    """
    at_point = ~np.isnan(y)
    place = np.where(at_point, y, 0.0)
    # A rigid tilt about the origin is a section tilt plus y times a translation: without the latter
    # it is the motion of a section about its own centre.
    local = np.where(at_point[:, None], rigid, 0.0)
    column = {c: k for k, c in enumerate(components)}
    for tilt, translation, sign in ((3, 2, 1.0), (5, 0, -1.0)):
        if tilt in column and translation in column:
            local[:, column[tilt]] -= sign * place * local[:, column[translation]]

    def sections(stations):
        count = len(components)
        fields = np.zeros((len(y), len(stations), count))
        hat = hats(np.clip(place, stations[0], stations[-1]), stations).tocoo()
        fields[hat.row, hat.col] = hat.data[:, None] * local[hat.row]
        columns = fields.reshape(len(y), -1)
        loads = mass @ columns
        return loads, columns.T @ loads

    return sections


def through(sections: Sections, reduction: sp.csr_matrix) -> Sections:
    """Return sections in fewer unknowns v, where ``u = reduction v``, from those of u."""

    def reduced(stations):
        loads, gram = sections(stations)
        return reduction.T @ loads, gram

    return reduced


def signed(sections: Sections, signs: tuple[float, ...]) -> Sections:
    """Return sections with the sign of components changed, as in the other bending plane."""

    def mirrored(stations):
        loads, gram = sections(stations)
        sign = np.tile(signs, len(stations))
        return loads * sign, gram * np.outer(sign, sign)

    return mirrored
