"""The boundary of a volume mesh as a moving surface."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from solidgear.core.body.surface import PIECES, Surface
from solidgear.core.kernel.assembly import reference

if TYPE_CHECKING:
    from solidgear.core.models.solid.mesh import SolidMesh


@dataclass(frozen=True, eq=False)
class Outline:
    """Boundary at rest, and the motion of its points by that of the nodes."""

    points: np.ndarray  #: (n, 3) m
    quads: np.ndarray
    triangles: np.ndarray
    lines: np.ndarray
    #: values of the basis in a face, and the unknowns of elements that have such a face
    parts: list[tuple[np.ndarray, np.ndarray]]
    first: np.ndarray  #: (n,) place of each point among all points of all faces


def solid_surface(geometry: SolidMesh, vector: np.ndarray | None) -> Surface:
    """Return the boundary of the volume mesh; faces of second order are divided, so that curved
    ones look curved.
    """
    still = geometry.outline
    moved = np.zeros_like(still.points)
    if vector is not None:
        moved = _on_faces(still.parts, vector.reshape(-1, 3))[still.first]
    return Surface(still.points, moved, still.quads, still.triangles, still.lines)


def copied(surface: Surface, copies: Iterable[tuple[np.ndarray, np.ndarray]]) -> Surface:
    """Return copies of a surface by orthogonal maps (3, 3), each with the displacements (n, 3) of
    its points before it is mapped; faces of an image in a mirror turn round.
    """
    points, moved, faces, triangles, lines = [], [], [], [], []
    for k, (to, displacement) in enumerate(copies):
        order = slice(None, None, 1 if np.linalg.det(to) > 0 else -1)
        shift = k * len(surface.points)
        points.append(surface.points @ to.T)
        moved.append(displacement @ to.T)
        faces.append(shift + surface.faces[:, order])
        triangles.append(shift + surface.triangles[:, order])
        lines.append(shift + surface.lines)
    return Surface(*(np.vstack(parts) for parts in (points, moved, faces, triangles, lines)))


def _on_faces(parts: Iterable[tuple[np.ndarray, np.ndarray]], field: np.ndarray) -> np.ndarray:
    """Return a field of the nodes at all points of all faces."""
    return np.concatenate(
        [np.einsum("bq,bef->eqf", value, field[dofs]).reshape(-1, 3) for value, dofs in parts]
    )


def on_nodes(geometry: SolidMesh) -> sp.csr_matrix:
    """Return the matrix of a scalar field at all points of the boundary by its values at the nodes."""
    matrices, size = [], geometry.nodes.shape[1]
    for value, dofs in geometry.outline.parts:
        rows = np.arange(dofs.shape[1] * value.shape[1]).reshape(1, -1, value.shape[1])
        v, i, j = np.broadcast_arrays(value[:, None], rows, dofs[:, :, None])
        matrices.append(sp.csr_matrix((v.ravel(), (i.ravel(), j.ravel())), (rows.size, size)))
    return sp.vstack(matrices).tocsr()[geometry.outline.first]


def outline(geometry: SolidMesh) -> Outline:
    """Return the outline that all surfaces of a mesh share, however it moves."""
    refdom, element, dofs = geometry.mesh.refdom, geometry.element, geometry.dofs
    linear = len(dofs) == refdom.nnodes
    # Two pieces end at the nodes in the middle of edges; more only pay where the mesh is coarse
    # enough to see it.
    m = PIECES if len(geometry.boundary) < 4000 else 2
    if linear:
        m = 1
    corners = len(refdom.facets[0])
    grid, cells, rim = _grid(m, corners)
    # Every rim point lies k pieces along the edge from corner a to corner b (k = 0 at a).
    a = np.repeat(np.arange(corners), m)
    b, k = (a + 1) % corners, np.tile(np.arange(m), corners)
    parts, keys, faces, lines, count = [], [], [], [], 0
    for place, elements in geometry.local_facets(geometry.boundary):
        points, s, t = geometry.on_facet(place, grid.T / m)
        parts.append((reference(element, points)[0], dofs[:, elements]))
        serial = count + np.arange(len(elements) * len(grid)).reshape(-1, len(grid))
        count += serial.size
        # A point inside a face is unique; one on an edge is named by the vertices of the edge, so that
        # neighbours share it.
        key = np.stack([-1 - serial, 0 * serial, 0 * serial], axis=-1)
        va, vb = (geometry.mesh.t[refdom.facets[place]][c][:, elements].T for c in (a, b))
        vb = np.where(k == 0, va, vb)
        key[:, rim] = np.stack(
            [np.minimum(va, vb), np.maximum(va, vb), np.where(va <= vb, k, m - k)], axis=-1
        )
        keys.append(key.reshape(-1, 3))
        middle = refdom.p[:, refdom.facets[place]].mean(axis=1)
        outward = np.cross(s, t) @ (middle - refdom.p.mean(axis=1)) > 0
        faces.append(serial[:, cells if outward else cells[:, ::-1]].reshape(-1, corners))
        lines.append(serial[:, np.column_stack([rim, np.roll(rim, -1)])].reshape(-1, 2))
    _, first, number = np.unique(
        np.concatenate(keys), axis=0, return_index=True, return_inverse=True
    )
    number = number.ravel()
    by_corners = {corners: number[np.concatenate(faces)]}
    edges = np.unique(np.sort(number[np.concatenate(lines)], axis=1), axis=0)
    quads, triangles = (by_corners.get(n, np.zeros((0, n), int)) for n in (4, 3))
    return Outline(_on_faces(parts, geometry.nodes.T)[first], quads, triangles, edges, parts, first)


def _grid(m: int, corners: int):
    """Return points (i, j), cells and rim (from the first corner on) of a face divided into m
    pieces along each edge.
    """
    i, j = (g.ravel() for g in np.meshgrid(np.arange(m + 1), np.arange(m + 1), indexing="ij"))
    n = m + 1
    step = np.arange(m)
    if corners == 4:
        c = (i * n + j)[(i < m) & (j < m)]
        cells = np.column_stack([c, c + n, c + n + 1, c + 1])
        rim = np.concatenate([step * n, m * n + step, (m - step) * n + m, m - step])
        return np.column_stack([i, j]), cells, rim
    inside = i + j <= m
    place = np.cumsum(inside) - 1
    low, high = (i * n + j)[i + j < m], (i * n + j)[i + j < m - 1]
    cells = np.vstack(
        [
            np.column_stack([low, low + n, low + 1]),
            np.column_stack([high + n, high + n + 1, high + 1]),
        ]
    )
    rim = np.concatenate([step * n, (m - step) * n + step, m - step])
    return np.column_stack([i, j])[inside], place[cells], place[rim]
