"""Groups of a part that its frusta are made of, and their shares."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from solidgear.scene.outline import Frustum

#: two places along y nearer than this part of the length are one
SAME_PLACE = 2e-6
#: sections of a frustum that shares are taken from, and lines across each
SECTIONS, SCANS = 3, 200


class Share(NamedTuple):
    """A frustum and what it is made of."""

    wall: Frustum
    #: groups and their shares of its volume, roughly where there are several
    groups: tuple[tuple[int, float], ...]

    @property
    def mixed(self) -> bool:
        """True where several groups meet inside it."""
        return len(self.groups) > 1


def shared_out(
    points: np.ndarray, triangles: np.ndarray, sides: np.ndarray, walls: Sequence[Frustum]
) -> list[Share]:
    """Frusta of a part, cut where groups meet in a plane across the axis, and what each is made of:
    of one group only if no other comes into it anywhere.

    `triangles` (3, t) are the surface of the part and what lies between groups, `sides` (2, t) the
    groups on both sides of each, -1 outside; y is the axis, m.
    """
    y = points[1][triangles]
    low, high = y.min(axis=0), y.max(axis=0)
    near = SAME_PLACE * (walls[-1].y1 - walls[0].y0)
    across = high - low <= near
    between = (sides >= 0).all(axis=0)
    out = []
    for piece in _cut(walls, np.unique(low[between & across]), near):
        # what only touches the end of a frustum is not in it
        inside = ~across & (high > piece.y0 + near) & (low < piece.y1 - near)
        groups = np.unique(sides[:, inside])
        groups = groups[groups >= 0]
        if len(groups) == 1:
            out.append(Share(piece, ((int(groups[0]), 1.0),)))
            continue
        areas = np.zeros(len(groups))
        for place in (np.arange(SECTIONS) + 0.4837) / SECTIONS:
            at = piece.y0 + place * (piece.y1 - piece.y0)
            for k, group in enumerate(groups):
                own = inside & (sides == group).any(axis=0)
                areas[k] += section_area(points, triangles[:, own], at)
        shares = areas / areas.sum()
        out.append(Share(piece, tuple((int(g), float(s)) for g, s in zip(groups, shares))))
    return out


def _cut(walls: Sequence[Frustum], places: Iterable[float], near: float) -> Iterable[Frustum]:
    for wall in walls:
        start = wall
        for place in places:
            if start.y0 + near < place < start.y1 - near:
                t = (place - start.y0) / (start.y1 - start.y0)
                outer = start.outer0 + t * (start.outer1 - start.outer0)
                inner = start.inner0 + t * (start.inner1 - start.inner0)
                yield start._replace(y1=float(place), outer1=outer, inner1=inner)
                start = start._replace(y0=float(place), outer0=outer, inner0=inner)
        yield start


def section_area(points: np.ndarray, triangles: np.ndarray, y: float) -> float:
    """Area inside a closed surface at one place along y, by lines across it.

    Parameters
    ----------
    points : (3, n) ndarray
        m.
    triangles : (3, t) ndarray of int
        Facing either way.
    y : float
        m; no node of the surface lies there.

    Returns
    -------
    float
        m^2, within about a hundredth.

    Examples
    --------
    >>> square = np.array([[1, 0, 1], [-1, 0, 1], [-1, 0, -1], [1, 0, -1]], float)
    >>> points = np.vstack([square, square + [0, 2, 0]]).T
    >>> here, there = np.arange(4), (np.arange(4) + 1) % 4
    >>> sides = np.hstack([[here, there, here + 4], [there, there + 4, here + 4]])
    >>> round(float(section_area(points, sides, 0.7)), 9)
    4.0
    """
    corners = points[:, triangles]  # (3, corner, t)
    hits = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        p, q = corners[:, i], corners[:, j]
        crossed = (p[1] < y) != (q[1] < y)
        t = np.divide(y - p[1], q[1] - p[1], out=np.zeros(len(crossed)), where=crossed)
        hits.append((crossed, p + t * (q - p)))
    # two sides of a triangle are crossed, or none
    first = np.where(hits[0][0], hits[0][1], hits[1][1])
    second = np.where(hits[2][0], hits[2][1], hits[1][1])
    cut = sum(crossed.astype(int) for crossed, _ in hits) == 2
    (x0, _, z0), (x1, _, z1) = first[:, cut], second[:, cut]
    if not len(x0):
        return 0.0
    lowest, highest = min(z0.min(), z1.min()), max(z0.max(), z1.max())
    step = (highest - lowest) / SCANS
    area = 0.0
    for z in lowest + step * (np.arange(SCANS) + 0.5):
        meets = (z0 < z) != (z1 < z)
        t = (z - z0[meets]) / (z1[meets] - z0[meets])
        at = np.sort(x0[meets] + t * (x1[meets] - x0[meets]))
        area += step * float((at[1::2] - at[: len(at) // 2 * 2 : 2]).sum())
    return area
