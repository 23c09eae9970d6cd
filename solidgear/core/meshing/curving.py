"""Middle nodes of curved tetrahedra: moved out so that sides enclose the volume of the surface they
follow, and drawn in where elements fold.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from skfem import Mesh, MeshTet1, MeshTet2

from solidgear.core.meshing.edge_places import edge_places
from solidgear.core.meshing.quality import element_ratios, element_volumes, outward

M = TypeVar("M", bound=Mesh)
#: below this min/max det J the edges of an element are straightened
FOLD = 0.05
#: growth of a sagitta s over a chord of half length c, times (s / c)^2. A parabola through three points
#: of an arc cuts off a share a^4 / 30 of its circle, where the arc spans 2a; one whose sagitta is
#: larger by (s / c)^2 / 5 encloses the same area. Of regular triangles on a cylinder the same holds at
#: 0.22 to 0.27, as they lie on it
OUT = 0.25
#: of a sagitta, how far an edge may move to give back volume: a fifth of the tolerance of seats
MOST_GIVEN = 0.02


def with_nodes(mesh: M, doflocs: np.ndarray) -> M:
    """Return the mesh with nodes elsewhere: connections stay, and with them the tables of edges,
    faces and unknowns, which take longer to make than all else of a mesh.
    """
    moved = copy(mesh)
    moved.doflocs = np.ascontiguousarray(doflocs)
    vars(moved).pop("_cached_mapping", None)  # it holds the old places
    return moved


def with_middles(mesh: M, edges: np.ndarray, middles: np.ndarray) -> M:
    """Return a second-order mesh with middle nodes at some places (3, k), m, each on the edge
    between two vertices (2, k); others stay.
    """
    place = edge_places(edges, mesh.edges)
    doflocs = mesh.doflocs.copy()
    doflocs[:, mesh.dofs.edge_dofs[0, place >= 0]] = middles[:, place[place >= 0]]
    return with_nodes(mesh, doflocs)


def ten_nodes(
    points: np.ndarray, corners: np.ndarray, edges: np.ndarray, middles: np.ndarray
) -> MeshTet2:
    """Return ten-node tetrahedra by (4, ne) corners among points (3, n), m, of which only theirs
    are kept, with middle nodes as for :func:`with_middles`.
    """
    used, small = np.unique(corners, return_inverse=True)
    straight = MeshTet1(
        np.ascontiguousarray(points[:, used]),
        np.ascontiguousarray(small.reshape(corners.shape).astype(np.int32)),
    )
    place = np.full(points.shape[1], -1)
    place[used] = np.arange(len(used))
    ends = place[edges]
    in_mesh = (ends >= 0).all(axis=0)
    return with_middles(MeshTet2.from_mesh(straight), ends[:, in_mesh], middles[:, in_mesh])


@dataclass(frozen=True)
class Filling:
    """Curved tetrahedra in drawn volumes."""

    mesh: MeshTet2
    volume: np.ndarray  #: (ne,) number of the drawn volume that each element is in
    inside: np.ndarray  #: (k,) edges that lie on no drawn surface, but for their ends
    #: share that the second moments of a drawn volume are off by, as edges of elements that would
    #: fold are straight
    straightened: dict[int, float] = field(default_factory=dict)


def relaxed(filling: Filling) -> Filling:
    """Return the elements with the middle nodes of those that fold drawn towards the middle of
    their edges, as far as needed.

    Elements that fold between two faces of one surface have been cut in two before
    (:mod:`solidgear.core.meshing.bisecting`); the tip of a cone, wedges of few degrees and slivers
    remain. The volume that chords take from a drawn volume there, its other curved sides give back,
    each by the share that it has in all that they can give: some 1e-3 of their sagittas.
    """
    mesh = filling.mesh
    straight = mesh.p[:, mesh.edges].mean(axis=1)
    middles = mesh.dofs.edge_dofs[0]
    keep = np.ones(mesh.edges.shape[1])
    curve = mesh.doflocs[:, middles] - straight
    # a straight edge may fold the element beside it, which then is straightened in its turn
    for part in (0.5, 0.25, *[0.0] * 10):
        inverted = np.flatnonzero(element_ratios(mesh) < FOLD)
        if not len(inverted):
            break
        edges = np.unique(mesh.t2e[:, inverted])
        keep[edges] = np.minimum(keep[edges], part)
        doflocs = mesh.doflocs.copy()
        doflocs[:, middles] = straight + keep * curve
        mesh = with_nodes(mesh, doflocs)
    if (keep == 1.0).all():
        return filling
    return _with_volume_restored(filling, mesh, curve, keep)


def _with_volume_restored(
    filling: Filling, mesh: MeshTet2, curve: np.ndarray, keep: np.ndarray
) -> Filling:
    """Return the mesh with every drawn volume as large as its sides enclosed before edges were
    straightened, where folded elements count with their sign; as far as that moves no edge by too
    much, and not where an element would fold.
    """
    drawn, part = np.unique(filling.volume, return_inverse=True)
    lowest = np.full(len(keep), part.max())
    highest = np.zeros(len(keep), int)
    np.minimum.at(lowest, mesh.t2e.ravel(), np.tile(part, len(mesh.t2e)))
    np.maximum.at(highest, mesh.t2e.ravel(), np.tile(part, len(mesh.t2e)))
    gives = (keep == 1.0) & (lowest == highest)
    gain = np.where(gives, _gain(filling.mesh, curve), 0.0)
    size = np.bincount(part, element_volumes(filling.mesh))
    lost = size - np.bincount(part, element_volumes(mesh))
    able = np.bincount(lowest, gain**2, minlength=len(size))
    most = np.zeros(len(size))
    np.maximum.at(most, lowest, np.abs(gain))
    scale = np.divide(lost, able, out=np.zeros_like(lost), where=able > 0)
    limit = np.divide(MOST_GIVEN, most, out=np.zeros_like(most), where=most > 0)
    scale = np.clip(scale, -limit, limit)
    middles = mesh.dofs.edge_dofs[0]
    while True:
        doflocs = mesh.doflocs.copy()
        doflocs[:, middles] += scale[lowest] * gain * curve
        restored = with_nodes(mesh, doflocs)
        folded = np.unique(part[element_ratios(restored) < FOLD])
        if not scale[folded].any():
            break
        scale[folded] = 0.0
    # volume missing at the surface counts twice in the second moments of a full section, of a hollow
    # one less
    error = 2 * np.abs(1 - np.bincount(part, element_volumes(restored)) / size)
    return replace(filling, mesh=restored, straightened=dict(zip(drawn.tolist(), error.tolist())))


def _gain(mesh: MeshTet2, curve: np.ndarray) -> np.ndarray:
    """Return the volume that each edge between curved sides would add, were its sagitta twice as
    large: a third of the area of each side times its motion along the normal. Edges in the plane of
    a side, such as those of cut faces, add none.
    """
    facets = mesh.boundary_facets()
    normal = outward(mesh, facets) / 2
    sides = mesh.facets[[[0, 1, 0], [1, 2, 2]]][:, :, facets]
    gain, least = np.zeros(curve.shape[1]), np.full(curve.shape[1], np.inf)
    depth = np.maximum(np.linalg.norm(curve, axis=0), 1e-300)
    for place in edge_places(mesh.edges, sides):
        along = (normal * curve[:, place]).sum(axis=0)
        np.add.at(gain, place, along / 3)
        np.minimum.at(least, place, np.abs(along) / np.linalg.norm(normal, axis=0) / depth[place])
    return np.where((least > 0.5) & (depth > 1e-9 * np.ptp(mesh.p)), gain, 0.0)


def volume_preserved(mesh: MeshTet2) -> MeshTet2:
    """Return the mesh with middle nodes, which lie on the true surface, moved a little beyond it,
    so that curved sides enclose as much as it does.

    On a circle of sixteen edges they move by 1e-5 of its radius, and the volume lost falls from
    5e-5 to some 2e-6.
    """
    a, b = mesh.p[:, mesh.edges[0]], mesh.p[:, mesh.edges[1]]
    middles = mesh.dofs.edge_dofs[0]
    straight = (a + b) / 2
    curve = mesh.doflocs[:, middles] - straight
    steep = 4 * (curve**2).sum(axis=0) / ((b - a) ** 2).sum(axis=0)
    doflocs = mesh.doflocs.copy()
    doflocs[:, middles] = straight + (1 + OUT * steep) * curve
    return with_nodes(mesh, doflocs)
