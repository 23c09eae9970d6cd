"""The boundary of a volume mesh as a moving surface."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from solidgear.core.body.surface import Surface


@dataclass(frozen=True, eq=False)
class Outline:
    """Boundary at rest, and the motion of its points by that of the nodes."""

    points: np.ndarray  #: (n, 3) m
    quads: np.ndarray
    triangles: np.ndarray
    lines: np.ndarray
    owners: np.ndarray  #: (m,) cell of every quadrilateral or triangle
    #: values of the basis in a face, and the unknowns of elements that have such a face
    parts: list[tuple[np.ndarray, np.ndarray]]
    first: np.ndarray  #: (n,) place of each point among all points of all faces

    def surface(self, vector: np.ndarray | None) -> Surface:
        """Return the boundary moved by the unknowns of the nodes; faces of second order are divided,
        so that curved ones look curved.
        """
        moved = np.zeros_like(self.points)
        if vector is not None:
            moved = on_faces(self.parts, vector.reshape(-1, 3))[self.first]
        return Surface(self.points, moved, self.quads, self.triangles, self.lines)

    def on_nodes(self, size: int) -> sp.csr_matrix:
        """Return the matrix of a scalar field at all points by its values at the nodes, `size` of
        them.
        """
        matrices = []
        for value, dofs in self.parts:
            rows = np.arange(dofs.shape[1] * value.shape[1]).reshape(1, -1, value.shape[1])
            v, i, j = np.broadcast_arrays(value[:, None], rows, dofs[:, :, None])
            matrices.append(sp.csr_matrix((v.ravel(), (i.ravel(), j.ravel())), (rows.size, size)))
        return sp.vstack(matrices).tocsr()[self.first]


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


def on_faces(parts: Iterable[tuple[np.ndarray, np.ndarray]], field: np.ndarray) -> np.ndarray:
    """Return a field of the nodes at all points of all faces."""
    return np.concatenate(
        [np.einsum("bq,bef->eqf", value, field[dofs]).reshape(-1, 3) for value, dofs in parts]
    )


def face_grid(m: int, corners: int):
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
