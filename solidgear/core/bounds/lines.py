"""Lines across a meridian: towards corners of slender cells, and through the middle of cells."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solidgear.core.meshing.corner_layers import side_at
from solidgear.core.meshing.meridian import Meridian, drawn_across

#: a cell at a corner that is longer than so many times its width is cut across first
SLENDER = 10.0
#: cells with this share of the error away from corners are halved where an order more helps little,
#: the long way alone where they are so many times as long
MOST, SQUARE = 0.7, 1.4


def place_of(point: np.ndarray) -> tuple[float, float]:
    """Return y and r of a point (r, y), m."""
    return float(point[1]), float(point[0])


class Lines:
    """Lines across a mesh, of which no two come close."""

    def __init__(self, flat: Meridian, points: Sequence[tuple[float, float]]):
        self.first, self.flat, self.points = flat, flat, list(points)

    def cut_slender(self, place: tuple[float, float]) -> None:
        """Add lines across the cells at a corner that are slender there, geometrically away from
        it.
        """
        flat = self.first
        vertex = int(np.hypot(flat.points[1] - place[0], flat.points[0] - place[1]).argmin())
        corner = flat.points[:, vertex]
        ends = {
            int(cell[(k + turn) % 4])
            for cell in flat.cells.T
            for k in np.flatnonzero(cell == vertex)
            for turn in (1, 3)
        }
        way = {v: flat.points[:, v] - corner for v in sorted(ends)}
        length = {v: float(np.linalg.norm(vector)) for v, vector in way.items()}
        for v, full in length.items():
            distance = SLENDER * min(length.values())
            while distance < full / 2:
                self.add(corner + way[v] * distance / full, distance / 2)
                distance *= SLENDER

    def halve(self, share: np.ndarray) -> None:
        """Add lines across the middle of the cells that hold the largest shares."""
        covered, total = 0.0, share.sum()
        for cell in np.argsort(-share):
            if covered > MOST * total:
                break
            covered += share[cell]
            a, b, c, d = self.first.points[:, self.first.cells[:, cell]].T
            first_side = max(np.linalg.norm(b - a), np.linalg.norm(c - d))
            second_side = max(np.linalg.norm(d - a), np.linalg.norm(c - b))
            if first_side * SQUARE > second_side:
                self.add((a + b) / 2, float(np.linalg.norm(b - a)) / 4)
            if second_side * SQUARE > first_side:
                self.add((a + d) / 2, float(np.linalg.norm(d - a)) / 4)

    def add(self, point: np.ndarray, room: float) -> None:
        """Add a line through a point, unless there is one within some distance, m, on the same side
        of a cell.
        """
        a, b, share = side_at(self.flat.cells.T, self.flat.points.T, point)
        length = float(np.linalg.norm(self.flat.points[:, b] - self.flat.points[:, a]))
        if min(share, 1 - share) * length < room:
            return
        self.points.append(place_of(point))
        self.flat = drawn_across(self.flat, [self.points[-1]])
