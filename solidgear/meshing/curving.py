"""Middle nodes of curved tetrahedra: drawn in where elements fold, and moved out so that sides enclose
the volume of what they stand for.
"""

from __future__ import annotations

from copy import copy
from typing import TypeVar

import numpy as np
from skfem import Mesh, MeshTet1, MeshTet2

from solidgear.meshing.edge_places import edge_places
from solidgear.meshing.quality import element_ratios, element_volumes, outward

M = TypeVar("M", bound=Mesh)
#: below this min/max det J the edges of an element are straightened
FOLD = 0.05
#: growth of a sagitta s over a chord of half length c, times (s / c)^2. A parabola through three points
#: of an arc cuts off a share a^4 / 30 of its circle, where the arc spans 2a; one whose sagitta is
#: larger by (s / c)^2 / 5 encloses the same area. Of regular triangles on a cylinder the same holds at
#: 0.22 to 0.27, as they lie on it
OUT = 0.25
#: of a sagitta, how far an edge may move to give back volume: a fifth of what seats allow
MOST_GIVEN = 0.02


def with_nodes(mesh: M, doflocs: np.ndarray) -> M:
    """The mesh with its nodes elsewhere: what belongs to what stays, and with it the tables of edges,
    faces and unknowns, which take longer to make than all else of a mesh.
    """
    moved = copy(mesh)
    moved.doflocs = np.ascontiguousarray(doflocs)
    vars(moved).pop("_cached_mapping", None)  # it knows where nodes were
    return moved


def with_middles(mesh: M, edges: np.ndarray, middles: np.ndarray) -> M:
    """A second-order mesh with its middle nodes at some places (3, k), m, each on the edge between two
    vertices (2, k).
    """
    doflocs = mesh.doflocs.copy()
    doflocs[:, mesh.dofs.edge_dofs[0]] = middles[:, edge_places(edges, mesh.edges)]
    return with_nodes(mesh, doflocs)


def ten_nodes(
    points: np.ndarray, corners: np.ndarray, edges: np.ndarray, middles: np.ndarray
) -> MeshTet2:
    """Ten-node tetrahedra by (4, ne) corners among points (3, n), m, of which only theirs are kept,
    with middle nodes as for :func:`with_middles`.
    """
    used, small = np.unique(corners, return_inverse=True)
    straight = MeshTet1(
        np.ascontiguousarray(points[:, used]),
        np.ascontiguousarray(small.reshape(corners.shape).astype(np.int32)),
    )
    place = np.full(points.shape[1], -1)
    place[used] = np.arange(len(used))
    known = place[edges]
    among = (known >= 0).all(axis=0)
    return with_middles(MeshTet2.from_mesh(straight), known[:, among], middles[:, among])


def relaxed(mesh: MeshTet2) -> MeshTet2:
    """The mesh with the mid nodes of folded elements drawn towards the middle of their edges, as
    far as needed.

    Only the tip of a cone, wedges of few degrees and slivers at a bore fold elements of a sensible
    size. What chords take from the volume there, the other curved sides give back, each by the
    share that it has in what all of them can give: some 1e-3 of their sagittas.
    """
    straight = mesh.p[:, mesh.edges].mean(axis=1)
    middles = mesh.dofs.edge_dofs[0]
    whole = mesh
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
    return _given_back(mesh, whole, curve, keep)


def _given_back(mesh: MeshTet2, whole: MeshTet2, curve: np.ndarray, keep: np.ndarray) -> MeshTet2:
    """A mesh with the volume of the one whose edges were not straightened, which is what its sides
    enclose, as folded elements count with their sign; as it is where an edge would have to move by
    too much or an element would fold.
    """
    if (keep == 1.0).all():
        return mesh
    lost = float(element_volumes(whole).sum() - element_volumes(mesh).sum())
    gain = np.where(keep == 1.0, _gain(whole, curve), 0.0)
    able = (gain**2).sum()
    if not able > 0 or abs(lost) * np.abs(gain).max() > MOST_GIVEN * able:
        return mesh
    middles = mesh.dofs.edge_dofs[0]
    share = lost * gain / able
    doflocs = mesh.doflocs.copy()
    doflocs[:, middles] += share * curve
    given = with_nodes(mesh, doflocs)
    return mesh if (element_ratios(given) < FOLD).any() else given


def _gain(mesh: MeshTet2, curve: np.ndarray) -> np.ndarray:
    """Volume for each edge between curved sides, were its sagitta twice as large: a third of the area
    of each side times what moves along its normal. Edges in the plane of a side, such as those of cut
    faces, give none.
    """
    facets = mesh.boundary_facets()
    normal = outward(mesh, facets) / 2
    sides = mesh.facets[[[0, 1, 0], [1, 2, 2]]][:, :, facets]
    gain, least = np.zeros(curve.shape[1]), np.full(curve.shape[1], np.inf)
    depth = np.maximum(np.linalg.norm(curve, axis=0), 1e-300)
    for at in edge_places(mesh.edges, sides):
        along = (normal * curve[:, at]).sum(axis=0)
        np.add.at(gain, at, along / 3)
        np.minimum.at(least, at, np.abs(along) / np.linalg.norm(normal, axis=0) / depth[at])
    return np.where((least > 0.5) & (depth > 1e-9 * np.ptp(mesh.p)), gain, 0.0)


def volume_preserved(mesh: MeshTet2) -> MeshTet2:
    """The mesh with middle nodes, which lie on the true surface, moved a little beyond it, so that
    curved sides enclose as much as it does.

    On a circle of sixteen edges they move by 1e-5 of its radius, and what is lost falls from 5e-5
    to some 2e-6 of the volume.
    """
    a, b = mesh.p[:, mesh.edges[0]], mesh.p[:, mesh.edges[1]]
    middles = mesh.dofs.edge_dofs[0]
    straight = (a + b) / 2
    curve = mesh.doflocs[:, middles] - straight
    steep = 4 * (curve**2).sum(axis=0) / ((b - a) ** 2).sum(axis=0)
    doflocs = mesh.doflocs.copy()
    doflocs[:, middles] = straight + (1 + OUT * steep) * curve
    return with_nodes(mesh, doflocs)
