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

from solidgear.errors import SolidgearError

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
    """Cut the cells around some vertices, as often as each asks for.

    Parameters
    ----------
    cells : (ne, 4) ndarray of int
        Vertices in the order of a walk around each.
    points : (n, 2) ndarray
        Of the vertices, m.
    layers : mapping of int to int
        Vertex to number of cuts.
    ratio : float
        What is left of a side at the corner by each cut; less of a side so long that the small cell
        would be longer than `LONGEST` times its width.
    across : sequence of (2,) ndarray
        Points on sides, m: before all else a line is drawn through each, from side to opposite side
        through all cells in its way.

    Examples
    --------
    One square, cut twice towards its first corner:

    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> found = cut_towards(np.array([[0, 1, 2, 3]]), square, {0: 2}, 0.1)
    >>> len(found.parent), float(found.points[found.corners[0]].max())
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
    """The side of a mesh of (ne, 4) cells that a point (m) lies on, by its ends, and how far along
    it is; SolidgearError if there is none.
    """
    every, places = np.array(cells), np.array(points)
    a, b = every.ravel(), np.roll(every, -1, axis=1).ravel()
    way = places[b] - places[a]
    length = np.einsum("ix,ix->i", way, way)
    share = np.clip(np.einsum("ix,ix->i", point - places[a], way) / length, 0.0, 1.0)
    off = np.linalg.norm(places[a] + share[:, None] * way - point, axis=1)
    k = int(off.argmin())
    if off[k] > 1e-6 * np.sqrt(length[k]):
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
        """All cells in the way of a line that begins on a side and goes on to opposite sides."""
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
                known = on_side.get(far) or on_side.get(far[::-1])
                if known is None:
                    one, other = far
                    known = self._new(self.points[one], self.points[other], share)
                    on_side[far] = known
                    todo.append((*far, share))
                here = on_side.get((a, b)) or on_side.get((b, a))
                assert here is not None
                self._two(piece, (a, b), far, (here, known), share)

    def _two(
        self,
        piece: int,
        near: tuple[int, int],
        far: tuple[int, int],
        new: tuple[int, int],
        share: float,
    ) -> None:
        """Replace a piece by its halves on both sides of a line."""
        corners, local = self.corners[piece], self.local[piece]
        at = {v: local[k] for k, v in enumerate(corners)}
        at |= {
            middle: (1 - share) * at[one] + share * at[other]
            for (one, other), middle in zip((near, far), new)
        }
        for v in corners:
            self.around[v].discard(piece)
        halves = []
        for gone in (1, 0):
            swap = {near[gone]: new[0], far[gone]: new[1]}
            halves.append([int(swap.get(v, v)) for v in corners])
        self.parent.append(self.parent[piece])
        self.corners[piece] = halves[0]
        self.corners.append(halves[1])
        self.local[piece] = np.array([at[v] for v in halves[0]])
        self.local.append(np.array([at[v] for v in halves[1]]))
        self._note(piece, halves[0])
        self._note(len(self.corners) - 1, halves[1])

    def cut(self, vertex: int, ratio: float) -> None:
        """All pieces around a vertex."""
        around = sorted(self.around[vertex])
        ends = {self._beside(piece, vertex)[k] for piece in around for k in (1, 3)}
        length = {v: float(np.linalg.norm(self.points[v] - self.points[vertex])) for v in ends}
        longest = LONGEST * min(length.values())
        share = {v: ratio * min(1.0, longest / length[v]) for v in ends}
        on_side: dict[int, int] = {}
        for v in sorted(ends):
            on_side[v] = self._new(self.points[vertex], self.points[v], share[v])
        for piece in around:
            self._three(piece, vertex, on_side, share)

    def _three(self, piece: int, vertex: int, on_side, share) -> None:
        """Replace a piece by its small corner and two trapezia."""
        first = self.corners[piece].index(vertex)
        _, after, far, before = (self.corners[piece][(first + k) % 4] for k in range(4))
        here = np.array([self.local[piece][(first + k) % 4] for k in range(4)])
        s, t = share[after], share[before]
        weights = np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
        middle = len(self.points)
        corner = np.array([self.points[self.corners[piece][(first + k) % 4]] for k in range(4)])
        self.points.append(weights @ corner)
        a, b = on_side[after], on_side[before]
        at_a, at_b = (1 - s) * here[0] + s * here[1], (1 - t) * here[0] + t * here[3]
        at_middle = weights @ here
        for v in self.corners[piece]:
            self.around[v].discard(piece)
        self.corners[piece] = _turned([vertex, a, middle, b], first)
        self.local[piece] = np.array(_turned([here[0], at_a, at_middle, at_b], first))
        self._note(piece, self.corners[piece])
        for ids, where in (
            ([a, after, far, middle], [at_a, here[1], here[2], at_middle]),
            ([b, middle, far, before], [at_b, at_middle, here[2], here[3]]),
        ):
            self.parent.append(self.parent[piece])
            self.corners.append(_turned(ids, first))
            self.local.append(np.array(_turned(where, first)))
            self._note(len(self.parent) - 1, self.corners[-1])

    def _beside(self, piece: int, vertex: int) -> list[int]:
        """Corners of a piece from one of them on."""
        first = self.corners[piece].index(vertex)
        return [self.corners[piece][(first + k) % 4] for k in range(4)]

    def _new(self, a: np.ndarray, b: np.ndarray, share: float) -> int:
        self.points.append((1 - share) * a + share * b)
        return len(self.points) - 1

    def _note(self, piece: int, corners: list[int]) -> None:
        for v in corners:
            self.around.setdefault(v, set()).add(piece)


def _turned(four: list, first: int) -> list:
    """Four corners in the sense of the parent: the one that stands at its corner ``first`` there."""
    return [four[(k - first) % 4] for k in range(4)]
