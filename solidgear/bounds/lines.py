"""Lines across a meridian: towards corners of slender cells, and through the middle of cells."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solidgear.meshing.corner_layers import side_at
from solidgear.meshing.meridian import Meridian, drawn_across

#: a cell at a corner that is longer than so many times its width is cut across first
SLENDER = 10.0
#: cells that hold this share of what is away from corners are halved where an order more helps
#: little, the long way alone where they are so many times as long
MOST, SQUARE = 0.7, 1.4


def place_of(point: np.ndarray) -> tuple[float, float]:
    """y and r of a point (r, y), m."""
    return float(point[1]), float(point[0])


class Lines:
    """Lines across a mesh, of which no two come close."""

    def __init__(self, flat: Meridian, points: Sequence[tuple[float, float]]):
        self.first, self.flat, self.points = flat, flat, list(points)

    def before(self, place: tuple[float, float]) -> None:
        """Lines across the cells at a corner that are slender there, geometrically away from it."""
        flat = self.first
        vertex = int(np.hypot(flat.points[1] - place[0], flat.points[0] - place[1]).argmin())
        here = flat.points[:, vertex]
        ends = {
            int(cell[(k + turn) % 4])
            for cell in flat.cells.T
            for k in np.flatnonzero(cell == vertex)
            for turn in (1, 3)
        }
        way = {v: flat.points[:, v] - here for v in sorted(ends)}
        length = {v: float(np.linalg.norm(own)) for v, own in way.items()}
        for v, full in length.items():
            at = SLENDER * min(length.values())
            while at < full / 2:
                self.add(here + way[v] * at / full, at / 2)
                at *= SLENDER

    def halve(self, share: np.ndarray) -> None:
        """Lines across the middle of the cells that hold most."""
        held, total = 0.0, share.sum()
        for cell in np.argsort(-share):
            if held > MOST * total:
                break
            held += share[cell]
            a, b, c, d = self.first.points[:, self.first.cells[:, cell]].T
            one = max(np.linalg.norm(b - a), np.linalg.norm(c - d))
            other = max(np.linalg.norm(d - a), np.linalg.norm(c - b))
            if one * SQUARE > other:
                self.add((a + b) / 2, float(np.linalg.norm(b - a)) / 4)
            if other * SQUARE > one:
                self.add((a + d) / 2, float(np.linalg.norm(d - a)) / 4)

    def add(self, point: np.ndarray, room: float) -> None:
        """A line through a point, unless there is one within some distance, m, on the same side."""
        a, b, share = side_at(self.flat.cells.T, self.flat.points.T, point)
        length = float(np.linalg.norm(self.flat.points[:, b] - self.flat.points[:, a]))
        if min(share, 1 - share) * length < room:
            return
        self.points.append(place_of(point))
        self.flat = drawn_across(self.flat, [self.points[-1]])
