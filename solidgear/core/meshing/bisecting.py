"""Tetrahedra that fold between points of one smooth surface, cut in two.

Where two curved faces of an element meet in an edge, or two curved edges in a vertex, the surface
has one tangent plane: the angle between them is half a turn or more and det J is zero or less
there, however fine the mesh is. Straight edges would take a share of the volume that falls by no
order. So an edge of such an element that goes through the material from surface to surface is
halved, and with it all elements around that edge. No node that was there moves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core.meshing.curving import FOLD, Filling, ten_nodes
from solidgear.core.meshing.edge_places import edge_places
from solidgear.core.meshing.quality import element_ratios

#: how far a new vertex may lie from the middle of its edge towards the mean of the vertices around it
WAYS = (0.0, 0.25, 0.5)


def bisected(filling: Filling) -> Filling:
    """Return the elements, those that fold cut in two where no part of them folds then."""
    kept = 0  # elements that were there when their edges were tried
    while True:
        mesh, inside = filling.mesh, filling.inside
        folded = mesh.t2e[:, element_ratios(mesh) < FOLD]
        surface = np.isin(mesh.edges, mesh.edges[:, ~inside]).all(axis=0)
        edges = np.unique(folded[(inside & surface)[folded]])
        halved = _halved(filling, edges[np.isin(edges, mesh.t2e[:, kept:])])
        if halved is filling:
            return filling
        # halves come last
        kept = mesh.t.shape[1] - (halved.mesh.t.shape[1] - mesh.t.shape[1])
        filling = halved


def _halved(filling: Filling, edges: np.ndarray) -> Filling:
    """Return the elements with some edges halved, but for those beside one that is, and those that
    would leave a fold; the same filling where none is.
    """
    if not len(edges):
        return filling
    mesh = filling.mesh
    halves = _Halves.of(filling, edges)
    least = np.array([halves.least_ratios(way) for way in WAYS])
    usable, best = least.max(axis=0, initial=0.0) >= FOLD, least.argmax(axis=0)
    uncut = np.ones(mesh.t.shape[1], bool)
    points, cells, parents = [mesh.p], [mesh.t], [np.arange(len(uncut))]
    cut: list[int] = []
    for place in np.flatnonzero(usable):
        pairs = np.flatnonzero(halves.edge == place)
        around = halves.cell[pairs]
        if not uncut[around].all():
            continue
        vertex = mesh.p.shape[1] + len(cut)
        corners = mesh.t[:, around]
        ends = mesh.edges[:, edges[place]]
        cells += [np.where(corners == end, vertex, corners) for end in ends]
        points.append(halves.vertices(WAYS[best[place]])[:, [place]])
        parents.append(np.tile(around, 2))
        uncut[around] = False
        cut.append(edges[place])
    if not cut:
        return filling
    middles = mesh.doflocs[:, mesh.dofs.edge_dofs[0]]
    cells[0], parents[0] = mesh.t[:, uncut], parents[0][uncut]
    uncut_edges = np.delete(np.arange(mesh.edges.shape[1]), cut)
    finer = ten_nodes(
        np.hstack(points), np.hstack(cells), mesh.edges[:, uncut_edges], middles[:, uncut_edges]
    )
    before = edge_places(mesh.edges, finer.edges)
    return Filling(
        finer,
        filling.volume[np.concatenate(parents)],
        np.where(before < 0, True, filling.inside[before]),
    )


@dataclass(frozen=True)
class _Halves:
    """Elements around some edges, each edge for itself: what they would be with it halved."""

    filling: Filling
    edges: np.ndarray  #: (k,)
    edge: np.ndarray  #: (m,) place among them, of every element around one
    cell: np.ndarray  #: (m,)
    middle: np.ndarray  #: (3, k)
    reach: np.ndarray  #: (3, k) from there to the mean of the vertices around

    @classmethod
    def of(cls, filling: Filling, edges: np.ndarray) -> _Halves:
        """Find the elements around edges (k,), which ascend."""
        mesh = filling.mesh
        cell, side = np.nonzero(np.isin(mesh.t2e, edges).T)
        edge = np.searchsorted(edges, mesh.t2e[side, cell])
        middle = mesh.p[:, mesh.edges[:, edges]].mean(axis=1)
        place, vertex = np.unique([np.tile(edge, 4), mesh.t[:, cell].ravel()], axis=1)
        total = np.array([np.bincount(place, x, len(edges)) for x in mesh.p[:, vertex]])
        around = total / np.bincount(place, minlength=len(edges))
        return cls(filling, edges, edge, cell, middle, around - middle)

    def vertices(self, way: float) -> np.ndarray:
        """Return the new vertices (3, k)."""
        return self.middle + way * self.reach

    def least_ratios(self, way: float) -> np.ndarray:
        """Return the least ratio (k,) of det J in the halves around each edge."""
        mesh, count = self.filling.mesh, len(self.edges)
        n = mesh.p.shape[1] + count  # vertices, of each edge for itself
        corners, new = mesh.t[:, self.cell], mesh.p.shape[1] + self.edge
        halves = np.hstack(
            [np.where(corners == end, new, corners) for end in mesh.edges[:, self.edges[self.edge]]]
        )
        sides = mesh.t2e[:, self.cell]
        sides = np.where(sides == self.edges[self.edge], sides[[1, 0, *range(2, 6)]], sides)
        vertices, small = np.unique(np.tile(self.edge, 2) * n + halves, return_inverse=True)
        own = self.edge * n + mesh.edges[:, sides]
        ends = np.minimum(np.searchsorted(vertices, own), len(vertices) - 1)
        part = ten_nodes(
            np.hstack([mesh.p, self.vertices(way)])[:, vertices % n],
            small.reshape(halves.shape),
            ends.reshape(2, -1),
            mesh.doflocs[:, mesh.dofs.edge_dofs[0, sides.ravel()]],
        )
        least = np.full(count, np.inf)
        np.minimum.at(least, np.tile(self.edge, 2), element_ratios(part))
        return least
