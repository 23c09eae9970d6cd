"""Quadrilaterals cut geometrically towards single corners of a mesh, without hanging nodes.

A cell that has the corner is cut in three: a small one at the corner and two trapezia that join it
to the sides far away. Both sides that end in the corner are cut, no other one, so that cutting all
cells around a corner leaves the mesh conforming.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from solidgear.core.errors import SolidgearError

#: longest side over shortest of the small cells at a corner, whatever the cells around it are
LONGEST = 4.0


@dataclass(frozen=True)
class Pieces:
    """Cells cut in pieces."""

    parent: np.ndarray  #: (m,) cell that each piece lies in
    #: (m, 4) vertices, those of the uncut mesh under their own numbers, in the sense of the
    #: parent's
    corners: np.ndarray
    local: np.ndarray  #: (m, 4, 2) where they are in the reference coordinates of the parent
    points: np.ndarray  #: (n, 2) vertices with every side straight, m


_LOCAL = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def cut_towards(
    cells: np.ndarray,
    points: np.ndarray,
    layers: Mapping[int, int],
    ratio: float,
    across: Sequence[np.ndarray] = (),
) -> Pieces:
    """Cut cells (ne, 4), vertices in the order of a walk around each, towards some of the vertices,
    and return the pieces.

    `points` (n, 2) are of the vertices, m; `layers` the number of cuts by vertex. Each cut leaves
    `ratio` of a side at the corner; less of a side so long that the small cell would be longer than
    `LONGEST` times the width. Before all else a line is drawn through each point `across`, (2,) on
    a side, m, from side to opposite side through all cells in its way.

    Examples
    --------
    One square, cut twice towards its first corner:

    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> pieces = cut_towards(np.array([[0, 1, 2, 3]]), square, {0: 2}, 0.1)
    >>> len(pieces.parent), float(pieces.points[pieces.corners[0]].max())
    (5, 0.010000000000000002)
    """
    work = _Cutting(cells, points)
    for point in across:
        work.across(point)
    for turn in range(max(layers.values(), default=0)):
        for vertex, wanted in layers.items():
            if wanted > turn:
                work.cut(vertex, ratio)
    return Pieces(
        np.array(work.parent), np.array(work.corners), np.array(work.local), np.array(work.points)
    )


def side_at(cells: ArrayLike, points: ArrayLike, point: np.ndarray) -> tuple[int, int, float]:
    """Return the side of a mesh of (ne, 4) cells that a point (m) lies on, by both ends, and how
    far along it is; SolidgearError if there is none.
    """
    corners, places = np.array(cells), np.array(points)
    a, b = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    way = places[b] - places[a]
    length = np.einsum("ix,ix->i", way, way)
    share = np.clip(np.einsum("ix,ix->i", point - places[a], way) / length, 0.0, 1.0)
    distance = np.linalg.norm(places[a] + share[:, None] * way - point, axis=1)
    k = int(distance.argmin())
    if distance[k] > 1e-6 * np.sqrt(length[k]):
        raise SolidgearError(
            f"across: no side of the mesh passes y = {point[1]:.6g} m, r = {point[0]:.6g} m"
        )
    return int(a[k]), int(b[k]), float(share[k])


class _Cutting:
    """Pieces that are being cut."""

    def __init__(self, cells: np.ndarray, points: np.ndarray):
        self.parent = list(range(len(cells)))
        self.corners = [[int(v) for v in cell] for cell in cells]
        self.local = [_LOCAL for _ in cells]
        self.points = list(points)
        self.around: dict[int, set[int]] = {}
        for piece, corners in enumerate(self.corners):
            self._note(piece, corners)

    def across(self, point: np.ndarray) -> None:
        """Cut all cells in the way of a line that begins on a side and goes on to opposite
        sides.
        """
        a, b, share = side_at(self.corners, self.points, point)
        if min(share, 1 - share) < 1e-9:
            return  # a line is there
        on_side: dict[tuple[int, ...], int] = {
            (a, b): self._new(self.points[a], self.points[b], share)
        }
        todo = [(a, b, share)]
        while todo:
            a, b, share = todo.pop()
            for piece in sorted(self.around[a] & self.around[b]):
                corners = self.corners[piece]
                k = corners.index(a)
                if corners[(k + 1) % 4] == b:
                    far = corners[(k + 3) % 4], corners[(k + 2) % 4]
                elif corners[(k + 3) % 4] == b:
                    far = corners[(k + 1) % 4], corners[(k + 2) % 4]
                else:
                    continue  # cut already: they face each other across a corner
                far_point = on_side.get(far) or on_side.get(far[::-1])
                if far_point is None:
                    far_point = self._new(self.points[far[0]], self.points[far[1]], share)
                    on_side[far] = far_point
                    todo.append((*far, share))
                near_point = on_side.get((a, b)) or on_side.get((b, a))
                assert near_point is not None
                self._halve(piece, (a, b), far, (near_point, far_point), share)

    def _halve(
        self,
        piece: int,
        near: tuple[int, int],
        far: tuple[int, int],
        new: tuple[int, int],
        share: float,
    ) -> None:
        """Replace a piece by the halves on both sides of a line."""
        corners, local = self.corners[piece], self.local[piece]
        place = {v: local[k] for k, v in enumerate(corners)}
        for (a, b), middle in zip((near, far), new):
            place[middle] = (1 - share) * place[a] + share * place[b]
        for v in corners:
            self.around[v].discard(piece)
        halves = []
        for end in (1, 0):
            swap = {near[end]: new[0], far[end]: new[1]}
            halves.append([int(swap.get(v, v)) for v in corners])
        self.parent.append(self.parent[piece])
        self.corners[piece] = halves[0]
        self.corners.append(halves[1])
        self.local[piece] = np.array([place[v] for v in halves[0]])
        self.local.append(np.array([place[v] for v in halves[1]]))
        self._note(piece, halves[0])
        self._note(len(self.corners) - 1, halves[1])

    def cut(self, vertex: int, ratio: float) -> None:
        """Cut all pieces around a vertex."""
        around = sorted(self.around[vertex])
        ends = {self._corners_from(piece, vertex)[k] for piece in around for k in (1, 3)}
        length = {v: float(np.linalg.norm(self.points[v] - self.points[vertex])) for v in ends}
        longest = LONGEST * min(length.values())
        share = {v: ratio * min(1.0, longest / length[v]) for v in ends}
        on_side: dict[int, int] = {}
        for v in sorted(ends):
            on_side[v] = self._new(self.points[vertex], self.points[v], share[v])
        for piece in around:
            self._cut_in_three(piece, vertex, on_side, share)

    def _cut_in_three(self, piece: int, vertex: int, on_side, share) -> None:
        """Replace a piece by the small corner and two trapezia."""
        first = self.corners[piece].index(vertex)
        _, after, far, before = (self.corners[piece][(first + k) % 4] for k in range(4))
        local = np.array([self.local[piece][(first + k) % 4] for k in range(4)])
        s, t = share[after], share[before]
        weights = np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
        middle = len(self.points)
        corner = np.array([self.points[self.corners[piece][(first + k) % 4]] for k in range(4)])
        self.points.append(weights @ corner)
        a, b = on_side[after], on_side[before]
        local_a, local_b = (1 - s) * local[0] + s * local[1], (1 - t) * local[0] + t * local[3]
        local_middle = weights @ local
        for v in self.corners[piece]:
            self.around[v].discard(piece)
        self.corners[piece] = _turned([vertex, a, middle, b], first)
        self.local[piece] = np.array(_turned([local[0], local_a, local_middle, local_b], first))
        self._note(piece, self.corners[piece])
        for ids, places in (
            ([a, after, far, middle], [local_a, local[1], local[2], local_middle]),
            ([b, middle, far, before], [local_b, local_middle, local[2], local[3]]),
        ):
            self.parent.append(self.parent[piece])
            self.corners.append(_turned(ids, first))
            self.local.append(np.array(_turned(places, first)))
            self._note(len(self.parent) - 1, self.corners[-1])

    def _corners_from(self, piece: int, vertex: int) -> list[int]:
        """Return the corners of a piece, beginning with one of them."""
        first = self.corners[piece].index(vertex)
        return [self.corners[piece][(first + k) % 4] for k in range(4)]

    def _new(self, a: np.ndarray, b: np.ndarray, share: float) -> int:
        self.points.append((1 - share) * a + share * b)
        return len(self.points) - 1

    def _note(self, piece: int, corners: list[int]) -> None:
        for v in corners:
            self.around.setdefault(v, set()).add(piece)


def _turned(corners: list, first: int) -> list:
    """Return four corners in the sense of the parent, from those that begin at its corner
    ``first``.
    """
    return [corners[(k - first) % 4] for k in range(4)]
