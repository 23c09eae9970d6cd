"""Corners of the outline of a shaft and how singular stress is there.

At a corner displacement behaves like ``distance ** exponent``; the smaller the exponent, the more
layers a mesh needs towards the corner.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.meshing.meeting import meeting
from solidgear.core.meshing.wedge import wedge_exponent

if TYPE_CHECKING:
    from solidgear.core.scene.outline import Edge, Outline
    from solidgear.core.scene.shaft import Shaft

# Exponent of a right-angled shoulder, against which layers are counted.
SHOULDER = 0.5445
#: exponent below which an edge of a mesh of tetrahedra has layers: the error at a larger one shrinks
#: nearly as fast as that of what is smooth
SLOW = 0.75


def sharpest_corner(scene: Shaft) -> tuple[float, float]:
    """Return the largest material angle at a shoulder of a scene, rad, and its exponent of displacement;
    (pi, 1) when there is no shoulder.

    Examples
    --------
    >>> import solidgear as sg
    >>> angle, exponent = sharpest_corner(sg.load("geometry/shaft_stepped.toml"))
    >>> round(float(np.degrees(angle))), round(exponent, 4)
    (270, 0.5445)
    """
    worst = max((edge.angle for edge in scene.outline.edges), default=np.pi)
    return worst, wedge_exponent([(worst, scene.segments[0].material)])


def corner_layers(
    outline: Outline, joint: int, layers: int, edges: Sequence[Edge] | None = None
) -> int:
    """Return the geometric layers that the corners of two segments need, were they sharp, where a
    right-angled shoulder needs `layers`: those of both surfaces, unless edges are given.

    Layers of one ratio shrink the error by ``ratio ** (2 exponent)`` each, and the error that they
    have to shrink grows with ``1 - exponent``, which is zero on a smooth outline of one material.
    """
    edges = outline.edges_at(joint) if edges is None else edges
    meetings = [meeting(outline.segments, edge.y, edge.r) for edge in edges]
    exponent = min((meets.exponent for meets in meetings if meets is not None), default=1.0)
    lacking = (1.0 - exponent) / (1.0 - SHOULDER)
    return min(layers, int(np.ceil(layers * lacking - 0.05)))
