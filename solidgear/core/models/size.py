"""Size of a model, counted on the mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.core.kernel.room import MB, PUT, assemblable
from solidgear.core.solve.backends.memory_law import law
from solidgear.core.solve.choice import choice

if TYPE_CHECKING:
    from skfem import Mesh
    from skfem.element import Element

    from solidgear.core.body import Body


@dataclass(frozen=True)
class Size:
    """Unknowns, entries and memory of a model."""

    unknowns: int  #: of all blocks, twins counted twice: the ``size`` of the body
    matrices: tuple[tuple[int, int], ...]  #: rows and entries of every matrix that is factored
    entries: int  #: in all matrices
    planar: bool = False  #: from a 1D or 2D mesh

    @property
    def backend(self) -> str:
        """Name of the back end that will factor the largest matrix."""
        return choice(*max(self.matrices), planar=self.planar)[0]

    @property
    def factors_mb(self) -> float:
        """Approximate memory of all factors together, by the law of
        :mod:`solidgear.core.solve.backends.memory_law`.
        """
        return sum(law(self.backend, *matrix, self.planar) for matrix in self.matrices)

    @property
    def matrices_mb(self) -> float:
        """Memory of all matrices."""
        return PUT * self.entries / MB

    @property
    def mb(self) -> float:
        """Approximate memory of matrices and factors."""
        return self.matrices_mb + self.factors_mb


def size_of_body(body: Body) -> Size:
    """Count a body.

    Examples
    --------
    >>> import solidgear as sg
    >>> rod = sg.Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> size = size_of_body(sg.build(sg.Scene.from_parts([rod]), "timoshenko", elements=4))
    >>> size.unknowns, len(size.matrices)  # both planes of bending have one matrix
    (46, 3)
    """
    blocks = {id(b.stiffness): b for b in body.blocks}.values()
    matrices = [(b.size, b.stiffness.nnz) for b in blocks]
    if any(b.parity is not None for b in blocks):
        _, pairs = coupled(body.geometry.element, _counts(body.geometry.mesh))  # type: ignore[union-attr]
        matrices = _by_parity(body.size, 9 * pairs)
    entries = sum(entries for _, entries in matrices)
    return Size(body.size, tuple(matrices), entries, all(b.planar for b in blocks))


def size_of_mesh(mesh: Mesh, kind: Element, parts: int = 1, mirrors: bool = False) -> Size:
    """Count the 3D solid of a mesh by one of its elements, of several blocks of the same mesh, or of
    blocks by the parity in mirror planes.
    """
    nodes, pairs = coupled(kind, _counts(mesh))
    matrices = _by_parity(3 * nodes, 9 * pairs) if mirrors else [(3 * nodes, 9 * pairs)] * parts
    return Size(parts * 3 * nodes, tuple(matrices), sum(entries for _, entries in matrices))


def _counts(mesh: Mesh) -> tuple[int, ...]:
    """Return the vertices, edges, faces and cells of a mesh."""
    return tuple(map(int, (mesh.nvertices, mesh.nedges, mesh.nfacets, mesh.nelements)))


def coupled(kind: Element, counts: tuple[int, ...]) -> tuple[int, int]:
    """Return the nodes of a mesh of vertices, edges, faces and cells, and the ordered pairs of them that
    share a cell: each pair counts at the smallest of these that has both.

    Examples
    --------
    One tetrahedron of ten nodes couples them all; a second one on a face of it brings four more:

    >>> from skfem.element import ElementTetP2
    >>> coupled(ElementTetP2(), (4, 6, 4, 1)), coupled(ElementTetP2(), (5, 9, 7, 2))
    ((10, 100), (14, 164))
    """
    cell, face = kind.refdom, kind.refdom.brefdom
    # vertices, edges, faces and cells of a vertex, an edge, a face and a cell
    parts = (
        (1,),
        (2, 1),
        (face.nnodes, face.nfacets, 1),
        (cell.nnodes, cell.nedges, cell.nfacets, 1),
    )
    dofs = kind.nodal_dofs, kind.edge_dofs, kind.facet_dofs, kind.interior_dofs
    new_pairs: list[int] = []
    for counts_of_part in parts:
        inside = sum(n * k for n, k in zip(counts_of_part, dofs))
        new_pairs.append(inside**2 - sum(n * k for n, k in zip(counts_of_part, new_pairs)))
    assemblable(counts[3], inside)
    nodes, pairs = (sum(n * k for n, k in zip(counts, numbers)) for numbers in (dofs, new_pairs))
    return nodes, pairs


def _by_parity(unknowns: int, entries: int) -> list[tuple[int, int]]:
    """Return the rows and entries of the matrices of a mesh with two mirror planes and the one between
    them: of three blocks, since both kinds of bending share theirs. Where rows meet a plane they have
    fewer entries, and factors are no smaller for it.
    """
    return [(unknowns // 4, entries // 4)] * 3
