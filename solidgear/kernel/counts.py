"""Nodes and matrix entries of a mesh from the numbers of its vertices, edges, faces and cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Kind:
    """Nodes of an element type: on vertices, edges, faces and inside; of an element, a face and an
    edge with all that bounds it.
    """

    on: tuple[int, int, int, int]
    cell: int
    face: int
    edge: int

    @property
    def order(self) -> int:
        """Of the polynomials along an edge."""
        return self.edge - 1


KINDS = {
    "hex8": Kind((1, 0, 0, 0), 8, 4, 2),
    "hex20": Kind((1, 1, 0, 0), 20, 8, 3),
    "hex27": Kind((1, 1, 1, 1), 27, 9, 3),
    "tet4": Kind((1, 0, 0, 0), 4, 3, 2),
    "tet10": Kind((1, 1, 0, 0), 10, 6, 3),
}


def solved_as(element: str) -> str:
    """Element that the mesh of a file is solved with: first-order tetrahedra are its shape only."""
    return "tet10" if element == "tet4" else element


def sections(rings: np.ndarray, full: np.ndarray, around: int) -> tuple[float, float, float]:
    """Vertices, edges and faces of all sections: rings of cells, and a square core in place of the
    first where the shaft is full.
    """
    count, k = np.diff(rings)[:, 0] - full, around // 4
    vertices = around * (count + 1) + full * (k - 1) ** 2
    edges = around * (2 * count + 1) + full * 2 * k * (k - 1)
    return float(vertices.sum()), float(edges.sum()), float((around * count + full * k * k).sum())


def nodes(
    element: str, counts: tuple[float, float, float, float], sides: int
) -> tuple[float, float]:
    """Unknowns and matrix entries of a mesh of so many vertices, edges, faces and cells, whose
    faces have so many sides.
    """
    kind, (vertices, edges, faces, cells) = KINDS[element], counts
    inner_faces = (6 if sides == 4 else 4) * cells - faces
    # every edge of the surface bounds two of its faces, and Euler's formula gives its vertices
    surface = faces - inner_faces
    inner_edges, inner_vertices = edges - sides / 2 * surface, vertices - (sides / 2 - 1) * surface
    pairs = (
        kind.cell**2 * cells
        - kind.face**2 * inner_faces
        + kind.edge**2 * inner_edges
        - inner_vertices
    )
    return 3 * float(np.dot(kind.on, counts)), 9 * pairs
