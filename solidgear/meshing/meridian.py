"""Structured quadrilateral mesh of the meridian (r, y) of a shaft of revolution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.meshing.blended import quadrilaterals
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
    arc : (m,) ndarray of int
        Local edge that is part of a circle, or -1: 0 low, 1 outer, 2 high, 3 inner.
    centre : (2, m) ndarray
        r and y of the middle of that circle, m.
    flip : (m,) ndarray of int
        Local edge whose odd functions have the other sign, or -1.
    """

    points: np.ndarray
    cells: np.ndarray
    segment: np.ndarray
    outer: np.ndarray
    inner: np.ndarray
    arc: np.ndarray
    centre: np.ndarray
    flip: np.ndarray


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
    made = quadrilaterals(scene, plan)
    index: dict[int, int] = {}
    for cell in made.cells:
        for corner in cell.ids:
            index.setdefault(corner, len(index))
    points = np.array([made.places[corner] for corner in index]).T
    cells = np.array([[index[corner] for corner in cell.ids] for cell in made.cells]).T
    edge, centre = np.full(len(made.cells), -1), np.zeros((2, len(made.cells)))
    for k, cell in enumerate(made.cells):
        if cell.arc:
            edge[k], *centre[:, k] = cell.arc
    return Meridian(
        points,
        cells,
        np.array([cell.segment for cell in made.cells]),
        np.array([k for k, cell in enumerate(made.cells) if cell.ring == cell.count - 1]),
        np.array([k for k, cell in enumerate(made.cells) if cell.ring == 0]),
        edge,
        centre,
        np.array([-1 if cell.flip is None else cell.flip for cell in made.cells]),
    )
