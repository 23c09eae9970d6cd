"""Facets of a mesh under the seats of a body: on cylinders about the axis, and on patches."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.meshing.quality import outward
from solidgear.core.models.solid.seat_faces import Seats

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.models.solid.mesh import SolidMesh
    from solidgear.core.scene import Scene


def seat_facets(scene: Scene, body: Body, mesh: SolidMesh, station: Any) -> np.ndarray:
    """Return the facets of the surface that carry a station; of a mesh from a file also those that reach
    beyond the ends of a seat, and of a seat within half a mesh those of that half.
    """
    if getattr(station, "patch", None) is not None:
        index = [port.name for port in body.ports].index(station.name)
        on_patch = _carrying(body, index)[mesh.mesh.facets[:, mesh.boundary]].all(axis=0)
        return mesh.boundary[on_patch]
    if "file" in body.mesh:
        return Seats(mesh, scene.segments, clipped=True)(station, station.attachment)
    return mesh.seat(station, scene.segments, 1e-7 * scene.length)


def _carrying(body: Body, index: int) -> np.ndarray:
    """Return which nodes of a body in one block carry the loads on a port."""
    (block,) = body.blocks
    weights = abs(block.ports[6 * index : 6 * index + 6]).sum(axis=0)
    moved = np.asarray(weights).ravel() > 0
    if block.expand is not None:
        moved = np.asarray(abs(block.expand) @ moved.astype(float)) > 0
    return np.any(moved.reshape(-1, 3), axis=1)


def rim_of(mesh: SolidMesh, facets: np.ndarray) -> np.ndarray:
    """Return the edges at which some facets end."""
    edges, count = np.unique(mesh.mesh.f2e[:, facets], return_counts=True)
    return edges[count == 1]


def unit_normals(mesh: Any, facets: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return unit normals (3, k) of facets, out of some cells beside them."""
    normal = outward(mesh, facets)
    normal /= np.linalg.norm(normal, axis=0)
    return np.where(mesh.f2t[0, facets] == cells, normal, -normal)
