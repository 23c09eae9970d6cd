"""Volume that the faces of a drawn solid enclose.

The kernel integrates over each face with few points, which is exact of planes, cylinders and cones and
0.9 % off on splines. So it is held against curved triangles on the same faces, and where they differ,
triangles of a higher order tell.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

#: relative difference from the kernel that triangles of second order explain: with 32 sides to a turn
#: they lack some 3e-6 of a full section
SAME = 2e-5
#: order of triangles where the kernel is not confirmed, with a tenth of that error, and how many of them
#: it is made for, some seconds of nodes on splines
ORDER, MOST = 4, 4_000
#: difference from the kernel, over that of second order, that triangles of this order explain
LEFT = 0.25


def volumes_of(gmsh: Any, solids: Sequence[int]) -> np.ndarray:
    """Volumes of solids whose faces carry triangles, m^3; the order of these changes."""
    drawn = np.array([gmsh.model.occ.getMass(3, tag) for tag in solids])
    triangles = sum(len(tags) for tags in gmsh.model.mesh.getElements(2)[1])
    second = _enclosed(gmsh, solids, 2)
    if (np.abs(drawn - second) <= SAME * np.abs(second)).all():
        return drawn
    if triangles > MOST:
        return second
    finest = _enclosed(gmsh, solids, ORDER)
    confirmed = np.abs(drawn - finest) <= LEFT * np.abs(second - finest)
    return np.where(confirmed, drawn, finest)


def _enclosed(gmsh, solids: Sequence[int], order: int) -> np.ndarray:
    """Volumes inside triangles of an order, by the divergence theorem."""
    gmsh.model.mesh.setOrder(order)
    volumes = []
    for tag in solids:
        gmsh.model.mesh.setOutwardOrientation(tag)
        faces = gmsh.model.getBoundary([(3, tag)], oriented=False)
        volumes.append(sum(_flux(gmsh, face) for _, face in faces) / 3)
    return np.array(volumes)


def _flux(gmsh, face: int) -> float:
    """Integral of the place times the normal over the triangles of a face, m^3."""
    total = 0.0
    for kind in gmsh.model.mesh.getElementTypes(2, face):
        order = gmsh.model.mesh.getElementProperties(kind)[2]
        points, weights = gmsh.model.mesh.getIntegrationPoints(kind, f"Gauss{3 * order}")
        tangents, _, places = gmsh.model.mesh.getJacobians(kind, points, face)
        tangents = tangents.reshape(-1, len(weights), 3, 3)
        normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
        at = places.reshape(-1, len(weights), 3)
        total += float(np.einsum("eqi,eqi,q->", normal, at, weights))
    return total
