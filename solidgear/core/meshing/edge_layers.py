"""Layers of tetrahedra towards lines of a mesh, by splitting those that touch them.

Stress that is singular along a line changes fast across it and slowly along it, so that cells need to
shrink across it only.  Each edge with one end on a line gets new vertices, ever nearer to that end; what
lies between two levels of them in a tetrahedron is a prism, or a box along the line, with plane faces in
the coordinates of the tetrahedron.  All are cut into tetrahedra from their vertex of least number, and
so are their faces: neighbours agree, and no cut fails (Dompierre, Labbe, Vallet and Camarero 1999, Proc.
8th International Meshing Roundtable, 195).  A map of second order of coordinates that are linear in
others is of second order in these: the elements fill the same body as before, to rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from skfem import MeshTet2
from skfem.refdom import RefTet

from solidgear.core.meshing.curving import ten_nodes
from solidgear.core.meshing.edge_places import edge_places

#: faces of prisms with corners 0 to 2 at one end, and of boxes with corners 0 to 3 there
PRISM = ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
BOX = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
#: corners at the ends of the edges of a tetrahedron, (2, 6)
ENDS = np.array(RefTet.edges).T

#: numbers (m,) of a vertex of some polyhedra, and its coordinates (m, 4) in the tetrahedra they lie in
Vertex = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Polyhedra:
    """Polyhedra of one kind in the tetrahedra of a mesh."""

    corners: np.ndarray  #: (v, m) numbers of their vertices
    places: np.ndarray  #: (v, m, 4) barycentric coordinates of these
    parents: np.ndarray  #: (m,) tetrahedra that they lie in

    @classmethod
    def of_vertices(cls, vertices: Sequence[Vertex], parents: np.ndarray) -> Polyhedra:
        """Return the polyhedra with some vertices."""
        numbers, places = zip(*vertices)
        return cls(np.array(numbers), np.array(places), parents)

    @classmethod
    def joined(cls, parts: Sequence[Polyhedra]) -> Polyhedra:
        """Return polyhedra of one kind side by side."""
        return cls(
            np.concatenate([part.corners for part in parts], axis=1),
            np.concatenate([part.places for part in parts], axis=1),
            np.concatenate([part.parents for part in parts]),
        )

    def chosen(self, cells: np.ndarray) -> Polyhedra:
        """Return some of them."""
        return Polyhedra(self.corners[:, cells], self.places[:, cells], self.parents[cells])

    def turned(self, rows: np.ndarray) -> Polyhedra:
        """Return them with vertices in the order of (v, m) rows."""
        cell = np.arange(len(self.parents))
        return Polyhedra(self.corners[rows, cell], self.places[rows, cell], self.parents)

    def vertex(self, row: int) -> Vertex:
        """Return one vertex of each."""
        return self.corners[row], self.places[row]

    def in_tetrahedra(self, faces: Sequence[Sequence[int]]) -> Polyhedra:
        """Return the tetrahedra between the vertex of least number and the faces that it is none of,
        each of which is cut from its own vertex of least number.
        """
        first = self.corners.argmin(axis=0)
        parts = []
        for face in np.array(faces, dtype=object):
            rows = np.array(face, int)
            across = np.flatnonzero((rows[:, None] != first).all(axis=0))
            cells = self.chosen(across)
            least = cells.corners[rows].argmin(axis=0)
            around = rows[(least + np.arange(len(rows))[:, None]) % len(rows)]
            for k in range(1, len(rows) - 1):
                parts.append(
                    cells.turned(np.array([first[across], around[0], around[k], around[k + 1]]))
                )
        return Polyhedra.joined(parts)


@dataclass(frozen=True)
class Layered:
    """A mesh with layers."""

    mesh: MeshTet2
    parents: np.ndarray  #: (ne,) tetrahedra of the mesh before that its own lie in
    places: np.ndarray  #: (4, ne, 4) barycentric coordinates of their corners there
    before: MeshTet2  #: the mesh without layers

    def facets_in(self, facets: np.ndarray) -> np.ndarray:
        """Return the facets that some of the mesh without layers are cut into."""
        meant = np.zeros(self.before.facets.shape[1], bool)
        meant[facets] = True
        parts = [np.zeros(0, int)]
        for place, corners in enumerate(RefTet.facets):
            (opposite,) = set(range(4)) - set(corners)
            inside = meant[self.before.t2f[place, self.parents]]
            for part, rows in enumerate(RefTet.facets):
                flat = (self.places[rows, :, opposite] == 0).all(axis=0)
                parts.append(self.mesh.t2f[part, inside & flat])
        return np.unique(np.concatenate(parts))


def layered(mesh: MeshTet2, lines: np.ndarray, layers: int, ratio: float) -> Layered:
    """Split the tetrahedra that touch lines, given as edges of the mesh, into layers of which each is
    thinner than the one before by a ratio.
    """
    cells = Polyhedra(
        mesh.t.astype(np.int64),
        np.repeat(np.eye(4)[:, None], mesh.t.shape[1], axis=1),
        np.arange(mesh.t.shape[1]),
    )
    if not layers or not len(lines):
        return Layered(mesh, cells.parents, cells.places, mesh)
    cells, on_line = _halved(cells, mesh.edges[:, lines].astype(np.int64), mesh.p.shape[1])
    touching = on_line[cells.corners].sum(axis=0)
    # vertices on lines first
    cells = cells.turned(np.argsort(~on_line[cells.corners], axis=0, kind="stable"))
    rays = _Rays.of_cells(cells, on_line, layers, ratio)
    split = Polyhedra.joined(
        [
            cells.chosen(touching == 0),
            *_around_vertices(cells.chosen(touching == 1), rays),
            *_around_edges(cells.chosen(touching == 2), rays),
        ]
    )
    upright = np.arange(4)[:, None]
    inverted = np.linalg.det(split.places.transpose(1, 0, 2)) < 0
    split = split.turned(np.where(inverted, upright[[1, 0, 2, 3]], upright))
    points = np.zeros((3, rays.count))
    points[:, split.corners] = _mapped(mesh, split.parents, split.places)
    middles = _mapped(mesh, split.parents, split.places[ENDS].mean(axis=0))
    ends = split.corners[ENDS].reshape(2, -1)
    curved = ten_nodes(points, split.corners, ends, middles.reshape(3, -1))
    return Layered(curved, split.parents, split.places, mesh)


@dataclass(frozen=True)
class _Rays:
    """Edges with one end on a line, and the new vertices on them."""

    keys: np.ndarray  #: of the edges, ascending
    total: int  #: vertices without the new ones
    layers: int
    ratio: float

    @classmethod
    def of_cells(cls, cells: Polyhedra, on_line: np.ndarray, layers: int, ratio: float) -> _Rays:
        """Find the edges of tetrahedra that have one end among marked vertices."""
        start, end = cells.corners[ENDS]
        # vertices on lines come first
        out = on_line[start] & ~on_line[end]
        return cls(np.unique(start[out] * len(on_line) + end[out]), len(on_line), layers, ratio)

    @property
    def count(self) -> int:
        """Vertices with the new ones."""
        return self.total + len(self.keys) * self.layers

    def levels(self, cells: Polyhedra, start: int, end: int) -> list[Vertex]:
        """Return the vertices from the one next to a start on a line to the end itself."""
        key = cells.corners[start] * self.total + cells.corners[end]
        first = self.total + np.searchsorted(self.keys, key) * self.layers
        vertices = []
        for level in range(self.layers):
            share = self.ratio ** (self.layers - level)
            place = (1 - share) * cells.places[start] + share * cells.places[end]
            vertices.append((first + level, place))
        return [*vertices, cells.vertex(end)]


def _around_vertices(cells: Polyhedra, rays: _Rays) -> list[Polyhedra]:
    """Return the parts of tetrahedra whose first vertex lies on a line: a small one and prisms."""
    a, b, c = (rays.levels(cells, 0, row) for row in (1, 2, 3))
    parts = [Polyhedra.of_vertices([cells.vertex(0), a[0], b[0], c[0]], cells.parents)]
    for k in range(rays.layers):
        prism = [a[k], b[k], c[k], a[k + 1], b[k + 1], c[k + 1]]
        parts.append(Polyhedra.of_vertices(prism, cells.parents).in_tetrahedra(PRISM))
    return parts


def _around_edges(cells: Polyhedra, rays: _Rays) -> list[Polyhedra]:
    """Return the parts of tetrahedra whose first edge lies on a line: a prism at it, boxes, and the
    prism at the edge across.
    """
    a, b = (rays.levels(cells, start, 2) for start in (0, 1))
    c, d = (rays.levels(cells, start, 3) for start in (0, 1))
    inner = [cells.vertex(0), a[0], c[0], cells.vertex(1), b[0], d[0]]
    parts = [Polyhedra.of_vertices(inner, cells.parents).in_tetrahedra(PRISM)]
    for k in range(rays.layers - 1):
        box = [a[k], b[k], d[k], c[k], a[k + 1], b[k + 1], d[k + 1], c[k + 1]]
        parts.append(Polyhedra.of_vertices(box, cells.parents).in_tetrahedra(BOX))
    last = rays.layers - 1
    outer = [a[last], b[last], a[-1], c[last], d[last], c[-1]]
    parts.append(Polyhedra.of_vertices(outer, cells.parents).in_tetrahedra(PRISM))
    return parts


def _halved(cells: Polyhedra, lines: np.ndarray, count: int) -> tuple[Polyhedra, np.ndarray]:
    """Return tetrahedra that have no more than one edge or vertex on lines (2, k) each, and which of
    the vertices lie there: edges from line to line are halved, and of three lines around a face one.
    """
    on_line = np.zeros(count, bool)
    on_line[lines] = True
    while True:
        ends = np.sort(cells.corners[ENDS], axis=0)
        joining = on_line[ends].all(axis=0)
        is_line = edge_places(lines, ends) >= 0
        between = joining & ~is_line
        closed = joining & ~between.any(axis=0) & (on_line[cells.corners].sum(axis=0) > 2)
        wanted = between | closed
        if not wanted.any():
            return cells, on_line
        key = ends[0] * len(on_line) + ends[1]
        edges = np.unique(key[wanted])
        place = np.searchsorted(edges, key)
        place[~np.isin(key, edges)] = len(edges)
        # an edge that is the least of all cells around it is halved now, others later
        least = np.full(len(edges) + 1, len(edges))
        np.minimum.at(least, place, np.broadcast_to(place.min(axis=0), place.shape))
        halved = edges[least[:-1] == np.arange(len(edges))]
        new = len(on_line) + np.arange(len(halved))
        low, high = halved // len(on_line), halved % len(on_line)
        on_this = edge_places(lines, np.array([low, high]))
        old = on_this >= 0
        lines = np.hstack(
            [
                np.delete(lines, on_this[old], axis=1),
                np.array([low[old], new[old]]),
                np.array([new[old], high[old]]),
            ]
        )
        cut = np.isin(key, halved)
        cells = _with_halves(cells, cut, new[np.searchsorted(halved, key[cut])])
        on_line = np.concatenate([on_line, old])


def _with_halves(cells: Polyhedra, cut: np.ndarray, new: np.ndarray) -> Polyhedra:
    """Return tetrahedra with at most one edge of each cut (6, ne) in halves, at vertices of some
    numbers.
    """
    edge, around = np.nonzero(cut)
    doubled, row = cells.chosen(around), np.arange(len(around))
    start, end = ENDS[:, edge]
    middle = (doubled.places[start, row] + doubled.places[end, row]) / 2
    parts = [cells.chosen(np.flatnonzero(~cut.any(axis=0)))]
    for replaced in (start, end):
        corners, places = doubled.corners.copy(), doubled.places.copy()
        corners[replaced, row], places[replaced, row] = new, middle
        parts.append(Polyhedra(corners, places, doubled.parents))
    return Polyhedra.joined(parts)


def _mapped(mesh: MeshTet2, parents: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return places (3, v, m), m, by barycentric coordinates (v, m, 4) in elements of second order."""
    a = np.moveaxis(places, -1, 0)
    start, end = ENDS
    value = np.concatenate([a * (2 * a - 1), 4 * a[start] * a[end]])
    nodes = mesh.doflocs[:, mesh.dofs.element_dofs[:, parents]]
    return np.einsum("ikm,kvm->ivm", nodes, value, optimize=True)
