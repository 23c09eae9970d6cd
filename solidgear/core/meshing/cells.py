"""Cells of the meridian of a shaft, between two mesh lines and two ring lines each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from solidgear.core.meshing.layout import Layout
    from solidgear.core.scene.shaft import Shaft

#: local edges, in the numbering of the corners of a cell
LOW, OUT, HIGH, IN = range(4)
#: ends of the local edges, in the sense of its local coordinate
ENDS = ((0, 1), (1, 2), (3, 2), (0, 3))
#: (r, y) of vertices by their numbers, m
Places = dict[int, tuple[float, float]]
#: cells by row and number of the inner ring line
Cells = dict[tuple[int, int], "Cell"]


@dataclass
class Cell:
    """A quadrilateral: inner-low, outer-low, outer-high, inner-high."""

    #: of its corners; those of ring lines are ``line * ring lines + ring``
    ids: tuple[int, int, int, int]
    segment: int
    ring: int = -1  #: its place in its segment from the inside, -1 in a block
    count: int = 0  #: rings of cells of that segment
    #: a local edge that is an arc, and (r, y) of its middle, m
    arc: tuple[int, float, float] | None = None
    flip: int | None = None  #: a local edge whose odd functions have the other sign


def ring_cells(scene: Shaft, plan: Layout) -> tuple[Cells, Places]:
    """Return all cells between lines and rings, in their order, and the places of their corners."""
    cells: Cells = {}
    places: Places = {}
    for row, k in enumerate(plan.segment):
        number, segment = plan.ring_numbers(k), scene.segments[k]
        span = (segment.y0, segment.y1)
        low, high = (int(line * plan.ring_lines) for line in (row, row + 1))
        for start, y in ((low, plan.y[row]), (high, plan.y[row + 1])):
            for ring, r in zip(number, plan.rings(k, span, y)):
                places.setdefault(start + int(ring), (r, y))
        for ring in range(len(number) - 1):
            a, b = (int(n) for n in number[ring : ring + 2])
            ids = (low + a, low + b, high + b, high + a)
            cells[row, a] = Cell(ids, k, ring, len(number) - 1)
    return cells, places
