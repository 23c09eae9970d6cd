"""Structured quadrilateral mesh of the meridian (r, y) of a shaft of revolution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.meshing.layout import Layout

if TYPE_CHECKING:
    from solidgear.scene.shaft import Shaft


@dataclass(frozen=True)
class Meridian:
    """Quadrilaterals in the (r, y) plane, all numbered alike.

    Every cell is numbered inner-low, outer-low, outer-high, inner-high, so that its first
    local coordinate runs outwards and its second along the shaft: hierarchical
    edge functions of scikit-fem carry no orientation sign and need just that.

    Attributes
    ----------
    points : (2, n) ndarray
        r and y, m.
    cells : (4, m) ndarray of int
    segment : (m,) ndarray of int
    outer, inner : (k,) ndarray of int
        Cells with their outer (inner) edge on a lateral surface.
    """

    points: np.ndarray
    cells: np.ndarray
    segment: np.ndarray
    outer: np.ndarray
    inner: np.ndarray


def meridian(scene: Shaft, plan: Layout) -> Meridian:
    """Mesh the meridian of a scene along a layout.

    Parameters
    ----------
    scene : Scene
    plan : Layout

    Returns
    -------
    Meridian

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> from solidgear.meshing.grading import Grading
    >>> from solidgear.meshing.layout import layout
    >>> scene = Scene.from_parts([Segment.cylinder("rod", length=0.3, diameter=0.06)])
    >>> mesh = meridian(scene, layout(scene, Grading()))
    >>> float(mesh.points[0].max()), float(mesh.points[1].max())
    (0.03, 0.3)
    """
    points: list[tuple[float, float]] = []
    index: dict[tuple[int, int], int] = {}
    cells: list[tuple[int, int, int, int]] = []
    owner, outer, inner = [], [], []
    for row, seg in enumerate(plan.segment):
        segment = scene.segments[seg]
        rings = [
            plan.rings(seg, (segment.y0, segment.y1), y) for y in (plan.y[row], plan.y[row + 1])
        ]
        number = plan.ring_numbers(seg)

        def node(line, ring, row=row, rings=rings, number=number):
            key = (line, number[ring])
            if key not in index:
                index[key] = len(points)
                points.append((rings[line - row][ring], plan.y[line]))
            return index[key]

        for ring in range(len(number) - 1):
            if ring == 0:
                inner.append(len(cells))
            if ring == len(number) - 2:
                outer.append(len(cells))
            cells.append(
                (node(row, ring), node(row, ring + 1), node(row + 1, ring + 1), node(row + 1, ring))
            )
            owner.append(seg)
    return Meridian(
        np.array(points).T, np.array(cells).T, np.array(owner), np.array(outer), np.array(inner)
    )
