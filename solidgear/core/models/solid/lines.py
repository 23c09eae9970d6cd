"""Lines of a mesh of tetrahedra along which stress is singular, and layers towards them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.meshing.edge_layers import Layered, layered
from solidgear.core.meshing.edge_places import edge_places
from solidgear.core.meshing.quality import check_mesh
from solidgear.core.models.solid.mesh import SolidMesh, _isoparametric

if TYPE_CHECKING:
    from solidgear.core.meshing.quality import MeshQuality
    from solidgear.core.models.solid.block import Facets
    from solidgear.core.scene.parts import Material
    from solidgear.core.scene.shaft import Station

#: turn of the surface across a concave edge, rad, from which on it has layers: displacement goes with
#: a power of 0.75 there, whose error shrinks nearly as fast as that of a smooth one
TURN = pi / 6
#: local corners at the ends of the sides of a facet, and the one across
SIDES = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


@dataclass(frozen=True)
class LayeredMesh:
    """A mesh with layers towards its singular lines."""

    mesh: SolidMesh
    quality: MeshQuality
    split: Layered
    facets_before: Facets  #: those of the mesh without layers

    def facets(self, station: Station, attachment: str) -> np.ndarray:
        """Return the facets that carry a station."""
        return self.split.facets_in(self.facets_before(station, attachment))


def with_layers(
    m: SolidMesh,
    quality: MeshQuality,
    facets: Facets,
    wanted: Sequence[tuple[Station, str]],
    materials: Sequence[Material],
    *,
    layers: int,
    ratio: float,
    plane: int | None = None,
) -> LayeredMesh:
    """Split ten-node tetrahedra towards the lines along which stress is singular; `materials` are those
    that the elements name, and `plane` is the axis at right angles to the plane of a half.
    """
    rigid = [facets(station, attachment) for station, attachment in wanted if attachment == "rigid"]
    split = layered(m.mesh, singular_lines(m, materials, rigid, plane), layers, ratio)
    if split.mesh is m.mesh:
        return LayeredMesh(m, quality, split, facets)
    return LayeredMesh(
        _isoparametric(split.mesh, m.name, m.segment[split.parents]),
        replace(check_mesh(split.mesh), geometry=quality.geometry),
        split,
        facets,
    )


def singular_lines(
    m: SolidMesh,
    materials: Sequence[Material],
    rigid: Sequence[np.ndarray],
    plane: int | None = None,
) -> np.ndarray:
    """Return the edges of ten-node tetrahedra along which stress is singular: concave ones, ends of
    rigid seats, given as facets, and joints of materials on the surface.
    """
    surface = m.boundary
    if plane is not None:
        height = np.abs(m.mesh.p[plane, m.mesh.facets[:, surface]])
        surface = surface[(height > 1e-9 * np.ptp(m.mesh.p)).any(axis=0)]
    on_surface, counts = np.unique(_sides(m, surface), return_counts=True)
    # on the plane of a half the surface goes on beyond
    inside = on_surface[counts == 2]
    ends = [_ends(m, facets) for facets in rigid]
    joints = np.unique(_sides(m, _joints(m, materials)))
    candidates = np.unique(np.concatenate([*ends, joints]))
    lines = np.concatenate([_concave(m, surface), np.intersect1d(candidates, inside)])
    return np.unique(lines)


def _sides(m: SolidMesh, facets: np.ndarray) -> np.ndarray:
    """Return the edges (3, f) around facets."""
    rows = np.array(SIDES)[:, :2].T
    return edge_places(m.mesh.edges, m.mesh.facets[rows][:, :, facets])


def _ends(m: SolidMesh, facets: np.ndarray) -> np.ndarray:
    """Return the edges around some facets."""
    edges, counts = np.unique(_sides(m, facets), return_counts=True)
    return edges[counts == 1]


def _joints(m: SolidMesh, materials: Sequence[Material]) -> np.ndarray:
    """Return the facets between elements of unlike materials."""
    kinds = list(dict.fromkeys(materials))
    kind = np.array([kinds.index(material) for material in materials])[m.segment]
    inner = np.flatnonzero(m.mesh.f2t[1] >= 0)
    low, high = kind[m.mesh.f2t[:, inner]]
    return inner[low != high]


def _concave(m: SolidMesh, facets: np.ndarray) -> np.ndarray:
    """Return the edges between two facets of a curved surface with more than half a turn of material,
    by the planes that touch both facets in the middle of the edge.
    """
    edges = _sides(m, facets)
    nodes, middles = m.mesh.p, m.mesh.doflocs[:, m.mesh.dofs.edge_dofs[0]]
    corners = m.mesh.facets[:, facets]
    # beside an edge the surface leaves along the slope of its six functions
    away = []
    for k, (a, b, c) in enumerate(SIDES):
        across = 2 * (middles[:, edges[(k + 1) % 3]] + middles[:, edges[(k + 2) % 3]])
        across -= 2 * middles[:, edges[k]] + nodes[:, corners[c]]
        across -= (nodes[:, corners[a]] + nodes[:, corners[b]]) / 2
        along = nodes[:, corners[b]] - nodes[:, corners[a]]
        along /= np.linalg.norm(along, axis=0)
        across -= along * (across * along).sum(axis=0)
        away.append(across / np.linalg.norm(across, axis=0))
    behind = nodes[:, m.mesh.t[:, m.mesh.f2t[0, facets]]].mean(axis=1) - nodes[:, corners].mean(
        axis=1
    )
    order = np.argsort(edges.ravel(), kind="stable")
    edge, tangent = edges.ravel()[order], np.hstack(away)[:, order]
    owner = np.tile(np.arange(len(facets)), 3)[order]
    first = np.flatnonzero(edge[1:] == edge[:-1])
    start = m.mesh.edges[:, edge[first]]
    along = nodes[:, start[1]] - nodes[:, start[0]]
    normal = np.cross(along.T, tangent[:, first].T).T
    normal *= -np.sign((normal * behind[:, owner[first]]).sum(axis=0)) / np.linalg.norm(
        normal, axis=0
    )
    low, high = tangent[:, first], tangent[:, first + 1]
    rise, turn = (normal * high).sum(axis=0), -(low * high).sum(axis=0)
    return edge[first][(rise > 0) & (np.arctan2(rise, turn) > TURN)]
