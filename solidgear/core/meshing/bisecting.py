"""Tetrahedra that fold between points of one smooth surface, cut in two.

Where two curved faces of an element meet in an edge, or two curved edges in a vertex, the surface
has one tangent plane: the angle between them is half a turn or more and det J is zero or less
there, however fine the mesh is. Straight edges would take a share of the volume that falls by no
order. So an edge of such an element that goes through the material from surface to surface is
halved, and with it all elements around that edge. No node that was there moves.
"""

from __future__ import annotations

import numpy as np

from solidgear.core.meshing.curving import FOLD, Filling, ten_nodes
from solidgear.core.meshing.edge_places import edge_places
from solidgear.core.meshing.quality import element_ratios

#: how far a new vertex may lie from the middle of its edge towards the mean of the vertices around it
WAYS = (0.0, 0.25, 0.5)


def bisected(filling: Filling) -> Filling:
    """Return the elements, those that fold cut in two where no part of them folds then."""
    while True:
        mesh, inside = filling.mesh, filling.inside
        folded = mesh.t2e[:, element_ratios(mesh) < FOLD]
        surface = np.isin(mesh.edges, mesh.edges[:, ~inside]).all(axis=0)
        halved = _halved(filling, np.unique(folded[(inside & surface)[folded]]))
        if halved is filling:
            return filling
        filling = halved


def _halved(filling: Filling, edges: np.ndarray) -> Filling:
    """Return the elements with some edges halved, but for those beside one that is, and those that
    would leave a fold; the same filling where none is.
    """
    mesh = filling.mesh
    middles = mesh.doflocs[:, mesh.dofs.edge_dofs[0]]
    uncut = np.ones(mesh.t.shape[1], bool)
    points, cells, parents, cut = mesh.p, [mesh.t], [np.arange(len(uncut))], []
    for edge in edges:
        around = np.flatnonzero((mesh.t2e == edge).any(axis=0))
        if not uncut[around].all():
            continue
        corners, ends = mesh.t[:, around], mesh.edges[:, edge]
        halves = np.hstack([np.where(corners == end, points.shape[1], corners) for end in ends])
        sides = np.setdiff1d(mesh.t2e[:, around], edge)
        middle = points[:, ends].mean(axis=1, keepdims=True)
        reach = points[:, np.unique(corners)].mean(axis=1, keepdims=True) - middle
        trials = [np.hstack([points, middle + way * reach]) for way in WAYS]
        parts = [ten_nodes(p, halves, mesh.edges[:, sides], middles[:, sides]) for p in trials]
        least = [element_ratios(part).min() for part in parts]
        if max(least) < FOLD:
            continue
        points = trials[int(np.argmax(least))]
        cells.append(halves)
        parents.append(np.tile(around, 2))
        uncut[around] = False
        cut.append(edge)
    if not cut:
        return filling
    cells[0], parents[0] = mesh.t[:, uncut], parents[0][uncut]
    uncut_edges = np.delete(np.arange(mesh.edges.shape[1]), cut)
    finer = ten_nodes(points, np.hstack(cells), mesh.edges[:, uncut_edges], middles[:, uncut_edges])
    before = edge_places(mesh.edges, finer.edges)
    return Filling(
        finer,
        filling.volume[np.concatenate(parents)],
        np.where(before < 0, True, filling.inside[before]),
    )
