"""Structured quadrilateral mesh of the meridian (r, y) of a shaft of revolution."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.meshing.blended import quadrilaterals
from solidgear.core.meshing.cells import ENDS
from solidgear.core.meshing.corner_layers import Pieces, cut_towards
from solidgear.core.meshing.layout import Layout

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft

#: y and r of a corner, m, and how often the cells around it are cut
Cut = tuple[float, float, int]
#: share of a side that a cut leaves: the best ratio of layers towards a singularity of any exponent (Gui
#: and Babuska 1986, Numer. Math. 49, 613)
CUT_RATIO = 0.15


@dataclass(frozen=True)
class Meridian:
    """Quadrilaterals in the (r, y) plane.

    Every cell is numbered inner-low, outer-low, outer-high, inner-high, so that its first
    local coordinate runs outwards and its second along the shaft: hierarchical
    edge functions of scikit-fem carry no orientation sign and need just that.
    """

    points: np.ndarray  #: (2, n) r and y, m
    cells: np.ndarray  #: (4, m)
    segment: np.ndarray  #: (m,)
    #: outer, inner: (k,) cells with their outer (inner) edge on a lateral surface
    outer: np.ndarray
    inner: np.ndarray
    #: (m,) local edge that is part of a circle, or -1: 0 low, 1 outer, 2 high, 3 inner
    arc: np.ndarray
    centre: np.ndarray  #: (2, m) r and y of the middle of that circle, m
    flip: np.ndarray  #: (4, m) local edges whose odd functions have the other sign


def meridian(scene: Shaft, plan: Layout) -> Meridian:
    """Mesh the meridian of a scene along a layout.

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> from solidgear.core.meshing.grading import Grading
    >>> from solidgear.core.meshing.layout import layout
    >>> scene = Scene.from_parts([Segment.cylinder("rod", length=0.3, diameter=0.06)])
    >>> mesh = meridian(scene, layout(scene, Grading()))
    >>> float(mesh.points[0].max()), float(mesh.points[1].max())
    (0.03, 0.3)
    """
    quads, places = quadrilaterals(scene, plan)
    index: dict[int, int] = {}
    for cell in quads:
        for corner in cell.ids:
            index.setdefault(corner, len(index))
    points = np.array([places[corner] for corner in index]).T
    cells = np.array([[index[corner] for corner in cell.ids] for cell in quads]).T
    edge, centre = np.full(len(quads), -1), np.zeros((2, len(quads)))
    flip = np.zeros((4, len(quads)), bool)
    for k, cell in enumerate(quads):
        if cell.arc:
            edge[k], *centre[:, k] = cell.arc
        if cell.flip is not None:
            flip[cell.flip, k] = True
    return Meridian(
        points,
        cells,
        np.array([cell.segment for cell in quads]),
        np.array([k for k, cell in enumerate(quads) if cell.ring == cell.count - 1]),
        np.array([k for k, cell in enumerate(quads) if cell.ring == 0]),
        edge,
        centre,
        flip,
    )


def drawn_across(flat: Meridian, across: Sequence[tuple[float, float]]) -> Meridian:
    """Return a mesh with further lines, from side to opposite side through all cells in their way,
    each by y and r of a point on a side that it passes, m; SolidgearError if no side is there.
    """
    through = [np.array([r, y]) for y, r in across]
    return _pieced(flat, cut_towards(flat.cells.T, flat.points.T, {}, CUT_RATIO, through))


def cut_meridian(flat: Meridian, cuts: Sequence[Cut]) -> tuple[Meridian, np.ndarray]:
    """Return a mesh whose cells are cut towards some vertices, each given by y and r, m, and
    how often all cells around it are cut; and the cell of the uncut mesh that each new cell lies
    in. SolidgearError if no vertex is there.

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> from solidgear.core.meshing.grading import Grading
    >>> from solidgear.core.meshing.layout import layout
    >>> scene = Scene.from_parts([Segment.cylinder("rod", length=0.03, diameter=0.06)])
    >>> mesh = meridian(scene, layout(scene, Grading(layers=0, edge_layers=0)))
    >>> cut, parent = cut_meridian(mesh, [(0.03, 0.03, 1)])
    >>> cut.cells.shape[1] - mesh.cells.shape[1]  # the one cell there is three
    2
    """
    wanted = {_vertex_at(flat, y, r): int(count) for y, r, count in cuts}
    pieces = cut_towards(flat.cells.T, flat.points.T, wanted, CUT_RATIO)
    return _pieced(flat, pieces), pieces.parent


def _pieced(flat: Meridian, pieces: Pieces) -> Meridian:
    """Return the mesh of some pieces; corners on an arc stay on it."""
    parent, corners = pieces.parent, pieces.corners
    points = pieces.points.copy()
    arc = np.full(len(parent), -1)
    for k in np.flatnonzero(flat.arc[parent] >= 0):
        edge = int(flat.arc[parent[k]])
        on_arc = on_side(pieces.local[k], edge)
        if on_arc.sum() == 2:
            arc[k] = edge
            for v, local in zip(corners[k][on_arc], pieces.local[k][on_arc]):
                points[v] = _on_arc(flat, int(parent[k]), edge, local)
    outer, inner = (
        np.array([on_side(local, side).sum() == 2 for local in pieces.local]) for side in (1, 3)
    )
    return Meridian(
        points.T,
        corners.T,
        flat.segment[parent],
        np.flatnonzero(outer & np.isin(parent, flat.outer)),
        np.flatnonzero(inner & np.isin(parent, flat.inner)),
        arc,
        flat.centre[:, parent],
        conflicts(corners),
    )


def _vertex_at(flat: Meridian, y: float, r: float) -> int:
    """Return the vertex at a place."""
    away = np.hypot(flat.points[0] - r, flat.points[1] - y)
    nearest = int(away.argmin())
    if away[nearest] > 1e-8 * flat.points[1].max():
        raise SolidgearError(
            f"cuts: no corner of the mesh is at y = {y:.6g} m, r = {r:.6g} m; "
            f"the nearest is {away[nearest]:.3g} m away"
        )
    return nearest


def on_side(local: np.ndarray, side: int) -> np.ndarray:
    """Return (4,) a mask of the corners of a piece, (4, 2) in the coordinates of its cell, that lie
    on a side of that.
    """
    axis, value = ((1, 0.0), (0, 1.0), (1, 1.0), (0, 0.0))[side]
    return np.abs(local[:, axis] - value) < 1e-12


def _on_arc(flat: Meridian, cell: int, edge: int, local: np.ndarray) -> np.ndarray:
    """Return the place on the arc of a cell, m, of a point in the coordinates of the cell."""
    a, b = (flat.points[:, flat.cells[end, cell]] for end in ENDS[edge])
    share = local[0] if edge in (0, 2) else local[1]
    va, vb = a - flat.centre[:, cell], b - flat.centre[:, cell]
    turn = share * np.arctan2(va[0] * vb[1] - va[1] * vb[0], va @ vb)
    c, s = np.cos(turn), np.sin(turn)
    return flat.centre[:, cell] + np.array([c * va[0] - s * va[1], s * va[0] + c * va[1]])


def conflicts(corners: np.ndarray) -> np.ndarray:
    """Return (4, m) a mask of sides that run the other way than in the first cell that has them."""
    first: dict[tuple[int, int], int] = {}
    out = np.zeros((4, len(corners)), bool)
    for k, cell in enumerate(corners):
        for side, (a, b) in enumerate(ENDS):
            begin, end = int(cell[a]), int(cell[b])
            first_begin = first.setdefault((min(begin, end), max(begin, end)), begin)
            out[side, k] = first_begin != begin
    return out
