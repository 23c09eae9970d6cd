"""Pits in the surface of a mesh of tetrahedra: what an element leaves that was lost there.

A lost element at the surface leaves two or three faces that meet in a re-entrant edge, while the two
nodes across that edge are still joined, by an edge of the elements beside it. In a sound mesh they
are not: re-entrant edges of a part have air between their two sides. But for the corner of a pocket,
where a third wall may join them; there the walls go on beyond the three faces, where a lost element
leaves a rim.
"""

from __future__ import annotations

from typing import Any

import numpy as np

#: sine of the angle by which two faces must turn to be no smooth surface
TURN = 0.1


def lost_elements(mesh: Any) -> np.ndarray:
    """Points (3, n), m, where the surface is as if an element were lost; one with three faces has
    three.
    """
    p, outside = mesh.p, mesh.boundary_facets()
    faces, inside = mesh.facets[:, outside], mesh.t[:, mesh.f2t[0, outside]]
    ab, ac = p[:, faces[1]] - p[:, faces[0]], p[:, faces[2]] - p[:, faces[0]]
    normal = np.cross(ab.T, ac.T).T
    normal /= np.linalg.norm(normal, axis=0)
    # away from the middle of the element behind
    behind = p[:, inside].mean(axis=1) - p[:, faces[0]]
    normal *= -np.sign((normal * behind).sum(axis=0))
    # every edge of the surface with the face on either side, and the corner across
    corners = np.array([(0, 1, 2), (0, 2, 1), (1, 2, 0)])
    pairs = np.sort(faces[corners[:, :2]], axis=1)
    total = p.shape[1]
    key = (pairs[:, 0].astype(np.int64) * total + pairs[:, 1]).ravel()
    across, face = faces[corners[:, 2]].ravel(), np.tile(np.arange(faces.shape[1]), 3)
    order = np.argsort(key, kind="stable")
    first = np.flatnonzero(np.r_[True, np.diff(key[order]) != 0])
    two = first[np.diff(np.r_[first, len(order)]) == 2]
    one, other = order[two], order[two + 1]
    a, b = np.divmod(key[one], total)
    along = (p[:, b] - p[:, a]) / np.linalg.norm(p[:, b] - p[:, a], axis=0)
    reach = p[:, across[other]] - p[:, a]
    wide = np.linalg.norm(reach - along * (reach * along).sum(axis=0), axis=0)
    turn = np.zeros(len(key))  # above zero where re-entrant
    turn[one] = turn[other] = (normal[:, face[one]] * reach).sum(axis=0) / wide
    lo, hi = np.sort([across[one], across[other]], axis=0)
    own = np.sort(mesh.edges.astype(np.int64), axis=0)
    joined = np.isin(lo.astype(np.int64) * total + hi, own[0] * total + own[1])
    rim = np.abs(turn.reshape(3, -1)).min(axis=0) > TURN
    found = (turn[one] > TURN) & joined & rim[face[one]] & rim[face[other]]
    return (p[:, a[found]] + p[:, b[found]]) / 2
