"""Tori of revolution in the surface of a part, such as fillets: each as cones end to end."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

#: cones to a quarter of a turn of the arc
TO_A_QUARTER = 6
#: least points on an arc: three lie on one always
LEAST_POINTS = 12


class Arc(NamedTuple):
    """Cones along an arc: ends (n,), m, and how far they lie beside it, m; the middle (y, r) and the
    radius of the arc, m, and 1 where it lies beyond its middle, seen from the axis, -1 below.
    """

    y: np.ndarray
    r: np.ndarray
    off: float
    centre: tuple[float, float]
    radius: float
    side: float


def arcs(y, r, triangles, near) -> Iterator[tuple[np.ndarray, Arc]]:
    """Pieces of a surface on one arc of the meridian: their triangles, and the cones.

    `y` and `r` are of points, (n,), m; `triangles` are (3, t), and a point nearer than `near` is on
    the arc. The volume of the cones is that of the arc.
    """
    a, b, c = triangles
    ones = np.ones(2 * len(a))
    links = coo_array((ones, (np.r_[a, b], np.r_[b, c])), shape=(len(y), len(y)))
    piece = connected_components(links, directed=False)[1][a]
    for one in np.unique(piece):
        members = np.flatnonzero(piece == one)
        used = np.unique(triangles[:, members])
        found = _cones(y[used], r[used], near) if len(used) >= LEAST_POINTS else None
        if found is not None:
            yield members, found


def _cones(y, r, near) -> Arc | None:
    """Cones along the arc of some points; None where they are on none."""
    middle, height = y.mean(), r.mean()
    u, v = y - middle, r - height
    matrix = np.column_stack([2 * u, 2 * v, np.ones_like(u)])
    (cu, cv, rest), _, rank, _ = np.linalg.lstsq(matrix, u * u + v * v, rcond=1e-9)
    square = rest + cu * cu + cv * cv
    if rank < 3 or not square > 0:
        return None
    yc, rc, radius = middle + cu, height + cv, float(np.sqrt(square))
    side = 1.0 if height > rc else -1.0
    # a meridian that turns back has two radii at one place
    if np.abs(np.hypot(y - yc, r - rc) - radius).max() > near or (side * (r - rc)).min() < -near:
        return None
    first, last = (np.arcsin(np.clip((end - yc) / radius, -1, 1)) for end in (y.min(), y.max()))
    count = max(2, int(np.ceil(TO_A_QUARTER * (last - first) / (np.pi / 2) - 1e-3)))
    angle = np.linspace(first, last, count + 1)

    def ends(wider: float) -> tuple[np.ndarray, np.ndarray]:
        size = np.r_[radius, np.full(count - 1, radius * (1 + wider)), radius]
        along = np.clip(yc + size * np.sin(angle), y.min(), y.max())
        along[0], along[-1] = y.min(), y.max()
        return along, np.maximum(rc + side * size * np.cos(angle), 0.0)

    true = _under(angle[-1], rc, radius, side) - _under(angle[0], rc, radius, side)
    low, high = 0.0, 1e-6
    for _ in range(20):  # the secant, of a volume that is all but linear
        off = [cone_volume(*ends(w)) - true for w in (low, high)]
        if off[0] == off[1] or low == high:
            break
        low, high = high, high - off[1] * (high - low) / (off[1] - off[0])
    along, across = ends(high)
    if not (np.diff(along) > 0).all():
        return None
    chords = np.hypot((along[1:] + along[:-1]) / 2 - yc, (across[1:] + across[:-1]) / 2 - rc)
    beside = float(np.abs(chords - radius).max())
    return Arc(along, across, beside, (float(yc), float(rc)), radius, side)


def _under(angle, rc, radius, side) -> float:
    """Volume below an arc up to an angle, m^3."""
    s, c = np.sin(angle), np.cos(angle)
    straight = (rc * rc + radius * radius) * radius * s - (radius * s) ** 3 / 3
    return float(np.pi * (straight + side * rc * radius**2 * (angle + s * c)))


def cone_volume(y, r) -> float:
    """Volume of cones end to end, m^3."""
    a, b = r[:-1], r[1:]
    return float((np.pi * np.diff(y) * (a * a + a * b + b * b) / 3).sum())
