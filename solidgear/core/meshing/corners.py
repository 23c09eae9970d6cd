"""Corners of the outline of a shaft and how singular stress is there.

At a corner displacement behaves like ``distance ** exponent``; the smaller the exponent, the more
layers a mesh needs towards the corner.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.meshing.quality import outward

if TYPE_CHECKING:
    from solidgear.core.scene.outline import Edge, Outline
    from solidgear.core.scene.shaft import Shaft

# Exponent of a right-angled shoulder, against which layers are counted.
SHOULDER = 0.5445


def corner_exponent(angle: float) -> float:
    """Return the exponent of displacement at a traction-free corner, smaller of the symmetric and
    antisymmetric modes; `angle` is of the material, rad, and 1.0 is returned up to pi.

    Williams (1952), J. Appl. Mech. 19, 526: ``sin(l w) = +- l sin(w)`` for a material angle w;
    0.5445 at 270 degrees.

    Examples
    --------
    >>> round(corner_exponent(1.5 * np.pi), 4), round(corner_exponent(2 * np.pi), 3)
    (0.5445, 0.5)
    """
    if angle <= np.pi * (1 + 1e-9):
        return 1.0
    roots = []
    for sign in (1.0, -1.0):
        grid = np.linspace(0.3, 0.9999, 400)
        f = np.sin(grid * angle) + sign * grid * np.sin(angle)
        for i in np.flatnonzero(f[:-1] * f[1:] < 0):
            roots.append(_root(angle, sign, grid[i], grid[i + 1]))
    return min(roots, default=1.0)


def _root(angle: float, sign: float, low: float, high: float) -> float:
    """Return the root of ``sin(x angle) + sign x sin(angle)`` between two ends of different sign,
    by halving.

    SciPy's root finders would do the same and take a tenth of a second to import, in every command.
    """
    rising = np.sin(high * angle) + sign * high * np.sin(angle) > 0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if (np.sin(middle * angle) + sign * middle * np.sin(angle) > 0) == rising:
            high = middle
        else:
            low = middle
    return float(0.5 * (low + high))


def sharpest_corner(scene: Shaft) -> tuple[float, float]:
    """Return the largest material angle at a shoulder of a scene, rad, and its exponent by
    :func:`corner_exponent`; (pi, 1) when there is no shoulder.

    Examples
    --------
    >>> import solidgear as sg
    >>> angle, exponent = sharpest_corner(sg.load("geometry/shaft_stepped.toml"))
    >>> round(float(np.degrees(angle))), round(exponent, 4)
    (270, 0.5445)
    """
    worst = max((edge.angle for edge in scene.outline.edges), default=np.pi)
    return worst, corner_exponent(worst)


def corner_layers(
    outline: Outline, joint: int, layers: int, edges: Sequence[Edge] | None = None
) -> int:
    """Return the geometric layers that the corners of two segments need, were they sharp, where a
    right-angled shoulder needs `layers`: those of both surfaces, unless edges are given.

    Layers of one ratio shrink the error by ``ratio ** (2 exponent)`` each, and the error that they
    have to shrink grows with ``1 - exponent``, which is zero on a smooth outline. A change of
    material counts as a shoulder.
    """
    if outline.segments[joint - 1].material != outline.segments[joint].material:
        return layers
    edges = outline.edges_at(joint) if edges is None else edges
    angle = max((edge.sharp_angle for edge in edges), default=np.pi)
    lacking = (1.0 - corner_exponent(angle)) / (1.0 - SHOULDER)
    return min(layers, int(np.ceil(layers * lacking - 0.05)))


#: turn of the surface across an edge, rad, from which on it is one and no facet of something round
EDGE = np.pi / 4


#: rad, to which the angle between flat sides of cells stands for that of a surface
ROUGH = np.pi / 12


def notch_exponent(mesh: Any) -> float:
    """Return the exponent of displacement at the sharpest concave edge of the surface of a volume mesh
    of scikit-fem, by :func:`corner_exponent`; 1.0 without any.

    Examples
    --------
    >>> from skfem import MeshHex
    >>> cube = MeshHex().refined(1)
    >>> notch_exponent(cube), round(notch_exponent(cube.remove_elements([0])), 4)
    (1.0, 0.5445)
    """
    turns = _concave(mesh)[1]
    if not len(turns):
        return 1.0
    return corner_exponent(np.pi + ROUGH * round(float(turns.max()) / ROUGH))


def concave_edges(mesh: Any) -> np.ndarray:
    """Return the vertices (2, k) of the sharp concave edges of the surface of a volume mesh of
    scikit-fem.
    """
    return _concave(mesh)[0]


def _concave(mesh: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices (2, k) of sharp concave edges, and by how much the surface turns, rad."""
    outside = mesh.boundary_facets()
    middle = mesh.p[:, mesh.facets[:, outside]].mean(axis=1)
    normal = outward(mesh, outside)
    normal /= np.linalg.norm(normal, axis=0)
    edge = mesh.f2e[:, outside]
    facet = np.broadcast_to(np.arange(len(outside)), edge.shape).ravel()
    order = np.argsort(edge.ravel(), kind="stable")
    a, b = facet[order[::2]], facet[order[1::2]]  # on both sides of each edge
    turn = np.arccos(np.clip(np.sum(normal[:, a] * normal[:, b], axis=0), -1.0, 1.0))
    rising = np.sum(normal[:, a] * (middle[:, b] - middle[:, a]), axis=0) > 0
    sharp = (turn > EDGE) & rising
    return mesh.edges[:, edge.ravel()[order[::2]][sharp]], turn[sharp]
