"""Quadrilaterals of the meridian of a shaft, with fillets and chamfers.

Without those every cell lies between two mesh lines and two ring lines. Next to an edge that has
one a block of k x k cells (2k x 2k at a rim) is exchanged:

- at a root the block becomes two, which meet from its inner corner Q to the middle M of the
  outline; one leans on the plane face, the other on the cylinder;
- at a rim the outermost quarter of the block is left out and the blocks beside it are joined from
  the middle of the block to M.

So a line that runs along a face turns and runs on along the cylinder. All corners of cells at the
outline are right angles (a chamfer: 45 to 135 degrees); the two at Q are near 45 degrees.

Hierarchical edge functions carry no sign: those of the edge from Q to M are odd for one of the two
cells where the face lies towards smaller y (`Cell.flip`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.meshing.cells import HIGH, IN, LOW, OUT, Cell, Places, ring_cells
from solidgear.core.meshing.layout import Layout

if TYPE_CHECKING:
    from solidgear.core.meshing.blocks import Joint
    from solidgear.core.scene.corner import Corner
    from solidgear.core.scene.shaft import Shaft


def quadrilaterals(scene: Shaft, plan: Layout) -> tuple[list[Cell], Places]:
    """Return the cells of a layout, in the order of their lines and rings, those of roots last, and
    (r, y) of their corners, m.
    """
    cells, places = ring_cells(scene, plan)
    if plan.joints:
        _Blocks(scene, plan, cells, places).exchange()
    return list(cells.values()), places


class _Blocks:
    """Blocks of a mesh of lines and rings that are being exchanged."""

    def __init__(self, scene, plan, cells, places):
        self.scene, self.plan = scene, plan
        self.cells, self.places = cells, places
        self.numbers = {k: plan.ring_numbers(k) for k in range(len(scene.segments))}
        self.fresh = len(plan.y) * plan.ring_lines

    def exchange(self) -> None:
        """Exchange the blocks of all joints."""
        moved: Places = {}
        for joint in self.plan.joints:
            for seg, zone in ((joint.index - 1, joint.low), (joint.index, joint.high)):
                lines = sorted(joint.line + zone.side * away for away in range(zone.rows + 1))
                for line in lines if 0 <= seg < len(self.scene.segments) else ():
                    for ring, r, y in zip(self.numbers[seg], *self.line_places(joint, seg, line)):
                        moved.setdefault(self.vertex(line, ring), (r, y))
        self.places.update(moved)
        for joint in self.plan.joints:
            for corner in joint.corners:
                (self.root if corner.root else self.rim)(joint, corner)

    def vertex(self, line: int, ring: int) -> int:
        return int(line * self.plan.ring_lines + ring)

    def new_vertex(self, place) -> int:
        self.fresh += 1
        self.places[self.fresh] = (float(place[0]), float(place[1]))
        return self.fresh

    def line_places(self, joint: Joint, seg: int, line: int) -> tuple[np.ndarray, np.ndarray]:
        """Return r and y of the rings of a segment on a line of the zone beside a joint, m."""
        segment = self.scene.segments[seg]
        span = (segment.y0, segment.y1)
        zone = joint.low if seg < joint.index else joint.high
        away = (line - joint.line) * zone.side
        r = self.plan.rings(seg, span, float(self.plan.y[line]))
        y = self._zone_y(joint, zone, seg, away, r)
        if away:
            clipped = np.clip(y, segment.y0, segment.y1)
            local = [self._zone_radii(joint, seg, span, place) for place in clipped]
            r = np.array([rings[k] for k, rings in enumerate(local)])
        return r, y

    def _zone_radii(self, joint: Joint, seg: int, span, y: float) -> np.ndarray:
        """Return radii of the rings of a segment beside a joint, m: at the block of a root as on
        the joint, so that it is square; towards the surfaces as they run.
        """
        radii = self.plan.rings(seg, span, y)
        block_ends = set()
        for corner in joint.corners:
            if corner.root and corner.face_owner == seg:
                ring, cells = self._surface_ring(corner, seg), joint.cells(corner)
                block_ends |= {ring, ring - cells if corner.out > 0 else ring + cells}
        if not block_ends:
            return radii
        on_joint = self.plan.rings(seg, span, joint.y)
        inner = sorted(block_ends - {0, len(radii) - 1})
        places = [on_joint[0], *on_joint[inner], on_joint[-1]]
        return np.interp(on_joint, places, [radii[0], *on_joint[inner], radii[-1]])

    def _zone_y(self, joint: Joint, zone, seg, away, r) -> np.ndarray:
        """Return y of a line of a zone, ``away`` lines from the joint, m."""
        start = np.where(self._crossed(joint, seg), joint.y + joint.shift(r), joint.y)
        if not zone.rows:
            return start
        end = joint.y + zone.side * zone.depth_at(r)
        t = away / zone.rows
        return (1 - t) * start + t * end

    def _crossed(self, joint: Joint, seg: int) -> np.ndarray:
        """Return a mask of the rings of a segment that the line of a joint crosses inside material
        on both sides; those between the two ends of a root's block belong to the block.
        """
        rings = self.numbers[seg]
        crossed = np.ones(len(rings), bool)
        for corner in joint.corners:
            if corner.root and corner.face_owner == seg:
                surface, cells = self._surface_ring(corner, seg), joint.cells(corner)
                place = np.arange(len(rings))
                crossed &= (
                    (place <= surface - cells) if corner.out > 0 else (place >= surface + cells)
                )
        return crossed

    def _surface_ring(self, corner: Corner, seg: int) -> int:
        """Return the place, among the rings of a segment, of the surface that the outline runs
        into.
        """
        owner = self.numbers[corner.owner]
        number = owner[-1] if corner.surface == "outer" else owner[0]
        return int(np.flatnonzero(self.numbers[seg] == number)[0])

    def _frame(self, joint: Joint, corner: Corner, size: int) -> _Frame:
        """Return local lines and rings 0 .. size of a block, whose edge is at (size, size)."""
        seg = corner.face_owner
        surface = self._surface_ring(corner, seg)
        along = -corner.face_side
        out = 1 if corner.surface == "outer" else -1
        lines = [joint.line - along * (size - i) for i in range(size + 1)]
        rings = [surface - out * (size - j) for j in range(size + 1)]
        return _Frame(seg, lines, [int(self.numbers[seg][k]) for k in rings], along, out)

    def _remove(self, frame: _Frame, rows: Iterable[int], rings: Iterable[int]) -> None:
        """Remove cells of a block."""
        for i in rows:
            for j in rings:
                del self.cells[frame.key(i, j)]

    def _interpolate(self, ids: list[list[int]]) -> None:
        """Place the corners inside a block from the sides (transfinite interpolation)."""
        n, m = len(ids) - 1, len(ids[0]) - 1
        p = {k: np.array(self.places[k]) for row in (ids[0], ids[-1]) for k in row}
        p |= {row[k]: np.array(self.places[row[k]]) for row in ids for k in (0, -1)}
        for i in range(1, n):
            for j in range(1, m):
                u, v = i / n, j / m
                sides = (1 - u) * p[ids[0][j]] + u * p[ids[n][j]]
                sides = sides + (1 - v) * p[ids[i][0]] + v * p[ids[i][m]]
                flat = (1 - u) * ((1 - v) * p[ids[0][0]] + v * p[ids[0][m]])
                flat = flat + u * ((1 - v) * p[ids[n][0]] + v * p[ids[n][m]])
                self.places[ids[i][j]] = tuple(sides - flat)

    def root(self, joint: Joint, corner: Corner) -> None:
        """Exchange the block at a root for two."""
        k = joint.cells(corner)
        frame = self._frame(joint, corner, k)
        self._remove(frame, range(k), range(k))
        tensor = [[self.vertex(line, ring) for ring in frame.rings] for line in frame.lines]
        # beside the edge the line of the joint belongs to the cylinder
        r, y = self.line_places(joint, corner.owner, joint.line)
        inside = self._surface_ring(corner, corner.owner)
        strip = self.plan.divided(corner.owner)[-1 if frame.out > 0 else 0]
        for depth in range(1, len(strip)):
            place = inside - frame.out * depth
            ring = int(self.numbers[corner.owner][place])
            self.places[self.vertex(joint.line, ring)] = (r[place], y[place])
        q = np.array(self.places[tensor[0][0]])
        middle = np.array(corner.middle)
        diagonal = [tensor[0][0]] + [self.new_vertex(q + (middle - q) * i / k) for i in range(1, k)]
        diagonal.append(self.new_vertex(middle))
        # on the plane face: rows as before, rings up to the outline
        on_face = self._grid(k)
        for i in range(k + 1):
            on_face[i][0], on_face[i][k] = diagonal[i], tensor[i][k]
        for j in range(1, k):
            on_face[0][j] = tensor[0][j]
            on_face[k][j] = self.new_vertex(corner.point_at(0.5 * (1 - j / k)))
        # on the cylinder: former rows end at the outline
        on_cylinder = self._grid(k)
        for i in range(k + 1):
            on_cylinder[0][i], on_cylinder[k][i] = diagonal[i], tensor[k][i]
            on_cylinder[i][0] = tensor[i][0]
        for i in range(1, k):
            on_cylinder[i][k] = self.new_vertex(corner.point_at(0.5 + 0.5 * i / k))
        # the edge itself has split in two: the cylinder keeps its number, the face has a new one
        face = self.new_vertex(corner.on_face)
        on_face[k][k] = face
        self.places[tensor[k][k]] = corner.on_cylinder
        on_cylinder[k][k] = tensor[k][k]
        on_cylinder[0][k] = diagonal[k]
        self._renumber(joint, frame, tensor[k][k], face)
        for ids in (on_face, on_cylinder):
            for i in range(1, k):
                for j in range(1, k):
                    ids[i][j] = self.new_vertex((0.0, 0.0))
            self._interpolate(ids)
        last, first = (HIGH, LOW) if frame.along > 0 else (LOW, HIGH)
        self._fill(frame, on_face, corner, arc=(k - 1, None, last))
        flip = first if frame.along != frame.out else None
        side = OUT if frame.out > 0 else IN
        self._fill(frame, on_cylinder, corner, arc=(None, k - 1, side), flip=(0, None, flip))

    def rim(self, joint: Joint, corner: Corner) -> None:
        """Leave out the outermost quarter of the block at a rim and join the blocks beside it."""
        k = joint.zone(corner.face_side).rows // 2
        frame = self._frame(joint, corner, 2 * k)
        tensor = [[self.vertex(line, ring) for ring in frame.rings] for line in frame.lines]
        self._remove(frame, range(k, 2 * k), range(k, 2 * k))
        ids = [list(row) for row in tensor]
        for m in range(k + 1):
            ids[k][k + m] = tensor[k + m][k]
        middle = np.array(corner.middle)
        self.places[tensor[2 * k][0]] = corner.on_face
        self.places[tensor[0][2 * k]] = corner.on_cylinder
        self.places[ids[2 * k][k]] = tuple(middle)
        a, b = (np.array(self.places[x]) for x in (tensor[k][0], tensor[0][k]))
        inner = (a + b + middle) / 3
        self.places[tensor[k][k]] = tuple(inner)
        for m in range(1, k):
            self.places[ids[2 * k][m]] = corner.point_at(0.5 * m / k)
            self.places[ids[m][2 * k]] = corner.point_at(1 - 0.5 * m / k)
            self.places[ids[k + m][k]] = tuple(inner + (middle - inner) * m / k)
            self.places[ids[k][m]] = tuple(a + (inner - a) * m / k)
            self.places[ids[m][k]] = tuple(b + (inner - b) * m / k)
        patches = (
            [row[: k + 1] for row in ids[: k + 1]],
            [row[: k + 1] for row in ids[k:]],
            [row[k:] for row in ids[: k + 1]],
        )
        for patch in patches:
            self._interpolate(patch)
        end = HIGH if frame.along > 0 else LOW
        side = OUT if frame.out > 0 else IN
        for i in range(2 * k):
            for j in range(2 * k):
                if i >= k and j >= k:
                    continue
                cell = self.cells[frame.key(i, j)]
                cell.ring = -1 if cell.ring != 0 or j >= k else cell.ring
                cell.ids = frame.corners(ids, i, j)
                if corner.centre:
                    if i == 2 * k - 1:
                        cell.arc = (end, *corner.centre)
                    if j == 2 * k - 1:
                        cell.arc = (side, *corner.centre)
                if i == k - 1 and j >= k and frame.along != frame.out:
                    cell.flip = end

    @staticmethod
    def _grid(k: int) -> list[list[int]]:
        return [[-1] * (k + 1) for _ in range(k + 1)]

    def _renumber(self, joint, frame, old: int, new: int) -> None:
        """Give the cells of the face a corner of their own where the cylinder has moved away."""
        row = joint.line - 1 if frame.along > 0 else joint.line
        for (cell_row, _), cell in self.cells.items():
            if cell_row == row:
                cell.ids = tuple(new if vertex == old else vertex for vertex in cell.ids)

    def _fill(self, frame, ids, corner, arc, flip=(None, None, None)) -> None:
        """Add the cells of a block that is not one of lines and rings; `arc` and `flip` are row and
        column of cells and their local edge.
        """
        k = len(ids) - 1
        for i in range(k):
            for j in range(k):
                cell = Cell(frame.corners(ids, i, j), frame.segment)
                if corner.centre and (i == arc[0] or j == arc[1]):
                    cell.arc = (arc[2], *corner.centre)
                if i == flip[0]:
                    cell.flip = flip[2]
                self.fresh += 1
                self.cells[len(self.plan.y), self.fresh] = cell


@dataclass
class _Frame:
    """A block whose local lines and rings run towards the edge of the shaft."""

    segment: int
    lines: list[int]  #: mesh lines
    rings: list[int]  #: numbers of ring lines
    along: int  #: 1 where local lines run towards larger y, else -1
    out: int  #: 1 where local rings run outwards, else -1

    def key(self, i: int, j: int) -> tuple[int, int]:
        """Return the key of the cell between local lines i, i + 1 and rings j, j + 1."""
        row = self.lines[i] if self.along > 0 else self.lines[i + 1]
        return row, self.rings[j] if self.out > 0 else self.rings[j + 1]

    def corners(self, ids, i: int, j: int) -> tuple[int, int, int, int]:
        """Return the corners of that cell, in the order of the meridian."""
        corners = []
        for outer, high in ((0, 0), (1, 0), (1, 1), (0, 1)):
            line = i + (high if self.along > 0 else 1 - high)
            ring = j + (outer if self.out > 0 else 1 - outer)
            corners.append(ids[line][ring])
        return tuple(corners)
