"""Meridian of a cylinder around a groove, as quadrilaterals that follow the groove.

The right half of the outline runs from the middle of the groove along a straight floor, an arc
and a straight flank to the mouth, each of which may be missing:

    floor    the side below it, of a box around the groove
    arc      half of it the side below, half of it the side to the right
    flank    the side to the right, at the same radii

Rows of cells lie between the outline and the box, thinner towards the outline. Lines and rings go
on from the sides of the box to the ends and to the bore or the axis. The left half is the image.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from solidgear.core.meshing.cells import HIGH, IN, LOW, OUT
from solidgear.core.meshing.meridian import Meridian, conflicts

#: cells along half an arc of a quarter turn
ALONG_ARC = 2
#: growth of cells away from the arc
GROWTH = 2.0
#: first row of cells at the arc, in cells along it
FIRST = 0.7
#: extent of the box beyond the groove in root radii, and its most in the wall below
BEYOND, MOST = 3.0, 0.5
#: local edges of a cell by those of its image
IMAGE = {LOW: HIGH, OUT: OUT, HIGH: LOW, IN: IN, -1: -1}


@dataclass(frozen=True)
class GrooveShape:
    """A groove of revolution in a cylinder, alike on both sides of its middle."""

    depth: float  #: below the cylinder, m
    radius: float  #: of the root, m
    floor: float = 0.0  #: straight, between two arcs, m
    lean: float = 0.0  #: of the flanks, from the plane across the axis, rad

    @property
    def turn(self) -> float:
        """Angle of an arc from the floor to the flank or the mouth, rad."""
        return min(math.pi / 2 - self.lean, math.acos(max(0.0, 1 - self.depth / self.radius)))

    @property
    def height(self) -> float:
        """Height of an arc over the floor, m."""
        return self.radius * (1 - math.cos(self.turn))

    @property
    def mouth(self) -> float:
        """Half of the width on the cylinder, m."""
        flank = max(0.0, self.depth - self.height) * math.tan(self.lean)
        return self.floor / 2 + self.radius * math.sin(self.turn) + flank


@dataclass
class _Cells:
    """Cells that are being collected."""

    places: list[np.ndarray] = field(default_factory=list)  #: (4, 2) r and y of the corners, m
    arc: list[int] = field(default_factory=list)  #: local edge that is part of an arc, or -1
    centre: list[tuple[float, float]] = field(default_factory=list)
    outer: list[bool] = field(default_factory=list)
    inner: list[bool] = field(default_factory=list)

    def add(self, corners, arc: int = -1, centre=(0.0, 0.0), outer=False, inner=False) -> None:
        self.places.append(np.array(corners))
        self.arc.append(arc)
        self.centre.append(centre)
        self.outer.append(outer)
        self.inner.append(inner)

    def grid(self, r: np.ndarray, y: np.ndarray, outer: bool, inner: bool) -> None:
        """Add cells between rings from the inside out and lines."""
        last = len(r) - 2
        for k, (inside, outside) in enumerate(zip(r, r[1:])):
            for low, high in zip(y, y[1:]):
                corners = [(inside, low), (outside, low), (outside, high), (inside, high)]
                self.add(corners, outer=outer and k == last, inner=inner and k == 0)


def groove_meridian(
    shape: GrooveShape, outer: float, inner: float, half: float, refinement: float = 1.0
) -> Meridian:
    """Mesh the meridian of a cylinder with radii outside and in the bore, m, with a groove in the
    middle of a piece that goes on for `half`, m, to either side.
    """
    least = outer - shape.depth
    cell = shape.radius * shape.turn / (2 * ALONG_ARC)
    gap = min(BEYOND * shape.radius, MOST * (least - inner))
    side = shape.mouth + max(gap, BEYOND * shape.radius)
    outline, box, centres = _columns(shape, outer, (least - gap, side), cell, refinement)
    rows = _divided(gap, FIRST * cell, refinement) / gap

    cells = _Cells()
    for k, centre in enumerate(centres):
        for row, (near, far) in enumerate(zip(rows, rows[1:])):
            inside, outside = (
                [(1 - share) * outline[n] + share * box[n] for n in (k, k + 1)]
                for share in (far, near)
            )
            corners = [inside[0], outside[0], outside[1], inside[1]]
            arc = OUT if centre is not None and row == 0 else -1
            cells.add(corners, arc, centre or (0.0, 0.0))
    floor_lines = np.array([y for r, y in box if r <= box[0][0] + 1e-12 * outer])
    side_radii = np.array([r for r, y in box if y >= side * (1 - 1e-12)])
    last_row = gap * (rows[-1] - rows[-2])
    inwards = least - gap - _divided(least - gap - inner, last_row, refinement)
    along = side + _divided(half - side, max(last_row, shape.radius), refinement, outer / 2)
    cells.grid(inwards[::-1], floor_lines, outer=False, inner=True)
    cells.grid(inwards[::-1], along, outer=False, inner=True)
    cells.grid(side_radii, along, outer=True, inner=False)
    return _both_halves(cells, half, outer)


def _columns(
    shape: GrooveShape, outer: float, corner: tuple[float, float], cell: float, refinement: float
) -> tuple[np.ndarray, np.ndarray, list[tuple[float, float] | None]]:
    """Return places (n, 2) on the outline of the right half and on the box, whose corner is given,
    m, and the middle of the arc of each column, None of a straight one.
    """
    least, half_floor, turn = outer - shape.depth, shape.floor / 2, shape.turn
    centre = (least + shape.radius, half_floor)
    end = least + shape.height
    has_flank = end < outer * (1 - 1e-9)
    up_to = end if has_flank else outer
    below, side = corner
    outline: list[tuple[float, float]] = [(least, 0.0)]
    box: list[tuple[float, float]] = [(below, 0.0)]
    centres: list[tuple[float, float] | None] = []

    def column(place, on_box, middle=None) -> None:
        outline.append(place)
        box.append(on_box)
        centres.append(middle)

    if half_floor:
        for y in half_floor - _divided(half_floor, cell, refinement)[::-1][1:]:
            column((least, float(y)), (below, float(y)))
    count = max(1, round(ALONG_ARC * refinement * max(0.5, turn / (math.pi / 2))))

    def on_arc(share: float) -> tuple[float, float]:
        r, y = centre
        angle = share * turn
        return r - shape.radius * math.cos(angle), y + shape.radius * math.sin(angle)

    for k in range(1, count + 1):
        share = k / count
        column(on_arc(share / 2), (below, half_floor + share * (side - half_floor)), centre)
    for k in range(1, count + 1):
        share = k / count
        place = on_arc((1 + share) / 2) if share < 1 or has_flank else (outer, shape.mouth)
        column(place, (below + share * (up_to - below), side), centre)
    if has_flank:
        for away in _divided(outer - end, cell, refinement)[1:]:
            at = centre[1] + shape.radius * math.sin(turn) + away * math.tan(shape.lean)
            column((end + float(away), at), (end + float(away), side))
    return np.array(outline), np.array(box), centres


def _divided(length: float, first: float, refinement: float, most: float = math.inf) -> np.ndarray:
    """Return lines from 0 to a length between which cells grow from a first size on."""
    sizes: list[float] = []
    size = min(first, length)
    while sum(sizes) + size < length * (1 - 1e-9):
        sizes.append(size)
        size = min(size * GROWTH, most)
    rest = length - sum(sizes)
    # a short rest makes the others longer instead
    if sizes and rest < size / 2:
        sizes = [s * length / sum(sizes) for s in sizes]
    else:
        sizes.append(rest)
    lines = np.concatenate([[0.0], np.cumsum(sizes)])
    lines[-1] = length
    count = max(1, round(len(sizes) * refinement))
    if count == len(sizes):
        return lines
    return np.interp(np.linspace(0, len(sizes), count + 1), np.arange(len(lines)), lines)


def _both_halves(cells: _Cells, half: float, outer: float) -> Meridian:
    """Return the mesh of some cells and their images, from y = 0 on."""
    right = np.array(cells.places)
    left = right[:, ::-1] * (1.0, -1.0)
    places = np.concatenate([left, right]) + (0.0, half)
    grid = np.rint(places.reshape(-1, 2) / (1e-9 * outer)).astype(np.int64)
    _, first, number = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    corners = number.reshape(-1, 4)
    centre = np.array(cells.centre)
    return Meridian(
        places.reshape(-1, 2)[first].T,
        corners.T,
        np.zeros(len(corners), int),
        np.flatnonzero(cells.outer * 2),
        np.flatnonzero(cells.inner * 2),
        np.array([IMAGE[edge] for edge in cells.arc] + cells.arc),
        np.concatenate([centre * (1.0, -1.0), centre]).T + [[0.0], [half]],
        conflicts(corners),
    )
