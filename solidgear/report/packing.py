"""Closed surfaces and their motions in few bytes, for a page that has to hold them.

Whole numbers take the place of coordinates. Triangles come in an order in which each shares an edge
with an earlier one, and points are numbered as they first appear. A new point is then foretold from
the three of the neighbour across the opposite edge, ``a + b - c`` (Touma and Gotsman, Triangle mesh
compression, Graphics Interface 1998). What is left is small where a surface is flat, or its motion
smooth, and is deflated (RFC 1950). ``viewer_mesh.js`` undoes it: what is done here must be kept in step.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from solidgear.body.surface import Surface

#: steps of the longest side of a surface: triangles of fine edge layers keep their direction
PLACES = 2**20
#: steps of the largest displacement of a shape; half a step in three directions is 3e-4 of it
SWINGS = 3000
#: points nearer than this share of the length are one
SAME = 1e-8


@dataclass(frozen=True, eq=False)
class Mesh:
    """A surface of triangles, its points in the order in which the triangles name them.

    Attributes
    ----------
    points : (n, 3) ndarray
        m.
    triangles : (m, 3) ndarray of int
        Normals point out of the material.
    source : (n,) ndarray of int
        Where each point stands in the surface that it was made from.
    foretold : (n, 3) ndarray of int
        Points a, b, c of which a + b - c foretells each; a = b = c = -1 for the first.
    """

    points: np.ndarray
    triangles: np.ndarray
    source: np.ndarray
    foretold: np.ndarray


def mesh_of(surface: Surface) -> Mesh:
    """The triangles of a drawn surface, welded where two pieces of it meet, in packing order."""
    first, number = _welded(surface.points)
    quads, triangles = number[surface.faces], number[surface.triangles]
    triangles = np.concatenate([_halved(surface.points[first], quads), triangles])
    pair = np.sort(triangles, axis=1)
    flat = (pair[:, 0] == pair[:, 1]) | (pair[:, 1] == pair[:, 2])
    # Where two bodies are welded face to face, neither face is of the surface.
    _, back, count = np.unique(pair, axis=0, return_inverse=True, return_counts=True)
    triangles = triangles[~flat & (count[back.ravel()] == 1)]
    triangles = triangles[_walk(triangles)]
    used, at = np.unique(triangles, return_index=True)
    order = used[np.argsort(at)]
    new = np.zeros(len(first), int)
    new[order] = np.arange(len(order))
    triangles = new[triangles]
    source = first[order]
    return Mesh(surface.points[source], triangles, source, _foretold(triangles))


def _welded(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """One point of every heap of coinciding ones, and for every point the number of its heap."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    n = len(points)
    near = cKDTree(points).query_pairs(SAME * np.ptp(points, axis=0).max(), output_type="ndarray")
    graph = coo_matrix((np.ones(len(near)), (near[:, 0], near[:, 1])), shape=(n, n))
    _, heap = connected_components(graph, directed=False)
    _, first, number = np.unique(heap, return_index=True, return_inverse=True)
    return first, number.ravel()


def _halved(points: np.ndarray, quads: np.ndarray) -> np.ndarray:
    """Quadrilaterals as two triangles each, along the shorter diagonal."""
    side = [np.linalg.norm(points[quads[:, i + 2]] - points[quads[:, i]], axis=1) for i in (0, 1)]
    turned = np.where((side[1] < side[0])[:, None], np.roll(quads, -1, axis=1), quads)
    return np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])


def _edges(triangles: np.ndarray) -> np.ndarray:
    """(m, 3) one number per edge, that opposite each corner."""
    a, b = np.roll(triangles, -1, axis=1), np.roll(triangles, -2, axis=1)
    return np.minimum(a, b) * (int(triangles.max()) + 1) + np.maximum(a, b)


def _walk(triangles: np.ndarray) -> np.ndarray:
    """An order in which every triangle but the first of a piece shares an edge with an earlier one."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order, connected_components

    m = len(triangles)
    keys = _edges(triangles).ravel()
    by_key = np.argsort(keys, kind="stable")
    meets = np.flatnonzero(keys[by_key][1:] == keys[by_key][:-1])
    one, other = by_key[meets] // 3, by_key[meets + 1] // 3
    graph = coo_matrix((np.ones(len(one)), (one, other)), shape=(m, m)).tocsr()
    _, piece = connected_components(graph, directed=False)
    starts = np.unique(piece, return_index=True)[1]
    return np.concatenate(
        [breadth_first_order(graph, s, directed=False, return_predecessors=False) for s in starts]
    )


def _foretold(triangles: np.ndarray) -> np.ndarray:
    """Three points that foretell each: those of the first triangle on the edge opposite to it."""
    keys = _edges(triangles).ravel()
    _, first, back = np.unique(keys, return_index=True, return_inverse=True)
    earliest = first[back.ravel()]  # place of the first corner opposite the same edge
    _, corner = np.unique(triangles, return_index=True)  # of every point, where it first appears
    k, j = corner // 3, corner % 3
    partner = earliest[corner]
    a, b = triangles[k, (j + 1) % 3], triangles[k, (j + 2) % 3]
    c = triangles.ravel()[partner]
    before = np.arange(len(corner)) - 1
    known = partner // 3 < k
    out = np.column_stack(
        [np.where(known, a, before), np.where(known, b, 0), np.where(known, c, 0)]
    )
    out[0] = -1
    return out


def packed_values(mesh: Mesh, values: np.ndarray, step: float) -> str:
    """Values at the points, as whole numbers of steps, foretold and deflated.

    Parameters
    ----------
    mesh : Mesh
    values : (n, c) ndarray
        In the order of its points.
    step : float
        In their unit.
    """
    whole = np.rint(values / step).astype(np.int64)
    a, b, c = mesh.foretold[1:].T
    rest = whole.copy()
    rest[1:] -= whole[a] + whole[b] - whole[c]
    return _deflated(2 * np.abs(rest) - (rest < 0), axis=1)


def packed_triangles(mesh: Mesh) -> str:
    """How far each corner is behind the next new point; 0 is that point."""
    flat = mesh.triangles.ravel()
    highest = np.concatenate([[0], np.maximum.accumulate(flat)[:-1] + 1])
    return _deflated(highest - flat, axis=0)


def _deflated(counts: np.ndarray, axis: int) -> str:
    """Counts below 2^32 as base64: column by column, all low bytes first."""
    values = np.ascontiguousarray(counts.T if axis else counts).ravel().astype("<u4")
    planes = np.ascontiguousarray(values.view(np.uint8).reshape(-1, 4).T)
    return base64.b64encode(zlib.compress(planes.tobytes(), 9)).decode()
