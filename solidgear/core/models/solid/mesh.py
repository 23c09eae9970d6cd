"""Isoparametric volume mesh: unknowns and nodes of an element type, facets of seats and sections."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import skfem.element
from skfem import Element, Mesh
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet, RefTri

from solidgear.core.body.surface import PIECES as PIECES_OF_EDGE
from solidgear.core.body.surface import Surface, Volume
from solidgear.core.elements import ELEMENTS
from solidgear.core.kernel.assembly import reference, tabulate, unknowns
from solidgear.core.meshing.geometry import moments_of_cells
from solidgear.core.meshing.lobatto import gauss_box
from solidgear.core.models.solid.drawing import Outline, face_grid, on_faces
from solidgear.core.scene.shaft import on_face

if TYPE_CHECKING:
    from solidgear.core.scene.outline import Outline as ShaftOutline

#: pieces to an edge of a facet that the end of a seat crosses
PIECES = 12


@dataclass(frozen=True, eq=False)
class SolidMesh:
    """An isoparametric volume mesh."""

    mesh: Mesh  #: topology; its geometry is that of ``nodes`` for second-order elements
    name: str  #: ``tet10`` and so on
    element: Element
    dofs: np.ndarray  #: (nb, ne) nodes of every element
    nodes: np.ndarray  #: (3, n) m
    segment: np.ndarray  #: (ne,) that every element lies in

    @property
    def solved(self) -> SolidMesh:
        """The mesh among whose cells error bars are shared: this one."""
        return self

    def motion(self, moved: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return the displacements (n, 3) of the nodes."""
        return np.sum([*moved.values()], axis=0).reshape(-1, 3)

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """Return the boundary of the mesh, moved."""
        return self.outline.surface(self.motion(moved).ravel() if moved else None)

    def rows(self, name: str, chosen: np.ndarray) -> np.ndarray:
        """Return the displacements (3 k, n) of points of the surface by those of the nodes."""
        values = self.outline.on_nodes(self.nodes.shape[1])[chosen].toarray()
        return np.einsum("kj,xy->kxjy", values, np.eye(3)).reshape(3 * len(chosen), -1)

    def volume(self) -> Volume:
        """Return the mesh itself."""
        return Volume(self.name, self.nodes, self.dofs, self.element.doflocs)

    @cached_property
    def boundary(self) -> np.ndarray:
        """Indices of the facets on the surface."""
        return self.mesh.boundary_facets()

    @cached_property
    def outline(self) -> Outline:
        """Boundary at rest, which all surfaces of the mesh share, however it moves."""
        refdom, element, dofs = self.mesh.refdom, self.element, self.dofs
        linear = len(dofs) == refdom.nnodes
        # Two pieces end at the nodes in the middle of edges; more only pay where the mesh is coarse
        # enough to see it.
        m = PIECES_OF_EDGE if len(self.boundary) < 4000 else 2
        if linear:
            m = 1
        corners = len(refdom.facets[0])
        grid, cells, rim = face_grid(m, corners)
        # Every rim point lies k pieces along the edge from corner a to corner b (k = 0 at a).
        a = np.repeat(np.arange(corners), m)
        b, k = (a + 1) % corners, np.tile(np.arange(m), corners)
        parts, keys, faces, lines, owners, count = [], [], [], [], [], 0
        for place, elements in self.local_facets(self.boundary):
            points, s, t = self.on_facet(place, grid.T / m)
            parts.append((reference(element, points)[0], dofs[:, elements]))
            serial = count + np.arange(len(elements) * len(grid)).reshape(-1, len(grid))
            count += serial.size
            # A point inside a face is unique; one on an edge is named by the vertices of the edge, so that
            # neighbours share it.
            key = np.stack([-1 - serial, 0 * serial, 0 * serial], axis=-1)
            va, vb = (self.mesh.t[refdom.facets[place]][c][:, elements].T for c in (a, b))
            vb = np.where(k == 0, va, vb)
            key[:, rim] = np.stack(
                [np.minimum(va, vb), np.maximum(va, vb), np.where(va <= vb, k, m - k)], axis=-1
            )
            keys.append(key.reshape(-1, 3))
            middle = refdom.p[:, refdom.facets[place]].mean(axis=1)
            outward = np.cross(s, t) @ (middle - refdom.p.mean(axis=1)) > 0
            faces.append(serial[:, cells if outward else cells[:, ::-1]].reshape(-1, corners))
            owners.append(np.repeat(elements, len(cells)))
            lines.append(serial[:, np.column_stack([rim, np.roll(rim, -1)])].reshape(-1, 2))
        _, first, number = np.unique(
            np.concatenate(keys), axis=0, return_index=True, return_inverse=True
        )
        number = number.ravel()
        by_corners = {corners: number[np.concatenate(faces)]}
        edges = np.unique(np.sort(number[np.concatenate(lines)], axis=1), axis=0)
        quads, triangles = (by_corners.get(n, np.zeros((0, n), int)) for n in (4, 3))
        at_rest = on_faces(parts, self.nodes.T)[first]
        return Outline(at_rest, quads, triangles, edges, np.concatenate(owners), parts, first)

    def local_facets(self, facets: np.ndarray):
        """Group facets by their place in the element they are seen from; yield (place, elements)."""
        elements = self.mesh.f2t[0, facets]
        place = (self.mesh.t2f[:, elements] == facets).argmax(axis=0)
        for p in np.unique(place):
            yield p, elements[place == p]

    def on_facet(
        self, place: int, coordinates: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the reference points of an element by two coordinates (2, q) in one of its facets,
        and the sides of the facet along which these run.
        """
        corners = self.mesh.refdom.p[:, self.mesh.refdom.facets[place]]
        s, t = corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0]
        return corners[:, :1] + np.outer(s, coordinates[0]) + np.outer(t, coordinates[1]), s, t

    def tabulate(self, points, elements):
        """Tabulate basis and geometry on some elements."""
        return tabulate(self.element, self.nodes[:, self.dofs[:, elements]], self.element, points)

    def over_facets(self, facets: np.ndarray, within: tuple[float, float] | None = None):
        """Yield quadrature on facets: values (nb, q), x (3, e, q), area weights (e, q), unknowns (nb, e);
        parameters are those of :meth:`quadrature_on`.
        """
        for points, elements, x, area in self.quadrature_on(facets, within):
            yield reference(self.element, points)[0], x, area, self.dofs[:, elements]

    def quadrature_on(self, facets: np.ndarray, within: tuple[float, float] | None = None):
        """Yield quadrature on facets: reference points (3, q), elements (e,), x (3, e, q), area weights
        (e, q).

        Of facets that reach beyond the two places ``within`` along y, only the part between counts:
        they are divided into pieces, and of a piece its share between.
        """
        if within is not None:
            y = self.mesh.p[1, self.mesh.facets[:, facets]]
            hair = 1e-7 * (within[1] - within[0])
            across = (y.min(axis=0) < within[0] - hair) | (y.max(axis=0) > within[1] + hair)
            yield from self.quadrature_on(facets[~across])
            facets = facets[across]
        rule = _facet_rule if within is None else _pieces
        ref, weights = rule(self.mesh.refdom)
        for place, elements in self.local_facets(facets):
            points, s, t = self.on_facet(place, ref)
            tab = self.tabulate(points, elements)
            area = np.linalg.norm(np.cross(tab.tangent @ s, tab.tangent @ t), axis=2) * weights
            if within is not None:
                lo, hi = within
                slopes = np.abs((tab.tangent @ s)[..., 1]) + np.abs((tab.tangent @ t)[..., 1])
                reach = np.maximum(slopes / PIECES, 1e-300)
                y = tab.x[1]
                area = area * (
                    np.clip((y - lo) / reach + 0.5, 0, 1) * np.clip((hi - y) / reach + 0.5, 0, 1)
                )
            yield points, elements, tab.x, area

    def moments(self, outline: ShaftOutline) -> np.ndarray:
        """Integrate moments of the parts of a shaft as
        :func:`~solidgear.core.meshing.geometry.moments_of_cells` does.
        """
        places = self.nodes[:, self.dofs]
        return moments_of_cells(self.element, places, self.segment, outline)

    def over_cells(self, elements: np.ndarray):
        """Yield quadrature over elements, as of facets with volume for area."""
        points, _, x, volume = self.quadrature_in(elements)
        yield reference(self.element, points)[0], x, volume, self.dofs[:, elements]

    def quadrature_in(self, elements: np.ndarray):
        """Return quadrature in elements, as :meth:`quadrature_on` with volume for area."""
        points, weights = get_quadrature(self.mesh.refdom, 5)
        tab = self.tabulate(points, elements)
        return points, elements, tab.x, tab.det * weights

    def facet_unknowns(self, facets: np.ndarray) -> np.ndarray:
        """Return the unknowns that do not vanish on some facets."""
        ref, _ = _facet_rule(self.mesh.refdom)
        unknown_parts = []
        for place, elements in self.local_facets(facets):
            points, _, _ = self.on_facet(place, ref)
            alive = np.abs(reference(self.element, points)[0]).max(axis=1) > 1e-9
            unknown_parts.append(self.dofs[alive][:, elements].ravel())
        return np.unique(np.concatenate(unknown_parts))

    def seat(self, station, segments, tol: float) -> np.ndarray:
        """Return the facets of the outer lateral surface between the ends of a seat, or of a face."""
        if on_face(station):
            return self.section(station.y, tol)
        p = self.mesh.p[:, self.mesh.facets[:, self.boundary]]
        y, r = p[1], np.hypot(p[0], p[2])
        inside = (y.min(axis=0) >= station.lo - tol) & (y.max(axis=0) <= station.hi + tol)
        steep = y.max(axis=0) - y.min(axis=0) > tol
        middle = y.mean(axis=0)
        outer = np.interp(middle, *_profile(segments))
        bore = np.interp(middle, *_profile(segments, inner=True))
        near = r.mean(axis=0) > (outer + bore) / 2
        return self.boundary[inside & steep & near]

    def section(self, y0: float, tol: float) -> np.ndarray:
        """Return the facets in the plane of a cross-section."""
        y = self.mesh.p[1, self.mesh.facets]
        return np.flatnonzero(np.abs(y - y0).max(axis=0) < tol)


def basis_of(name: str) -> Element:
    """Return the basis of an element by name."""
    return getattr(skfem.element, ELEMENTS[name].basis)()


def _isoparametric(mesh, name, segment) -> SolidMesh:
    """Number the unknowns and place the nodes of an element type on the geometry of a mesh."""
    element = basis_of(name)
    dofs = unknowns(mesh, element)
    geometry = mesh.elem()
    tab = tabulate(geometry, mesh.doflocs[:, mesh.dofs.element_dofs], geometry, element.doflocs.T)
    nodes = np.zeros((3, int(dofs.max()) + 1))
    nodes[:, dofs.T] = tab.x
    return SolidMesh(mesh, name, element, dofs, nodes, segment)


def _facet_rule(refdom):
    """Return quadrature on a facet in two local coordinates."""
    if refdom is RefTet:
        return get_quadrature(RefTri, 6)
    return gauss_box(4, 2)


def _pieces(refdom):
    """Return middles and sizes of equal pieces of a facet, in two local coordinates."""
    if refdom is RefTet:
        i, j, third = np.meshgrid(*(range(PIECES),) * 2, (1 / 3, 2 / 3), indexing="ij")
        inside = (i + j < PIECES - 1) | ((i + j == PIECES - 1) & (third < 0.5))
        middles = np.array([i[inside] + third[inside], j[inside] + third[inside]]) / PIECES
        return middles, np.full(PIECES**2, 0.5 / PIECES**2)
    x = (np.arange(PIECES) + 0.5) / PIECES
    middles = np.array([g.ravel() for g in np.meshgrid(x, x, indexing="ij")])
    return middles, np.full(PIECES**2, 1.0 / PIECES**2)


def _profile(segments, inner: bool = False):
    """Return breakpoints of the outer (inner) radius; doubled a hair apart at steps, as np.interp
    needs.
    """
    hair = 1e-12 * segments[-1].y1
    y, r = [], []
    for s in segments:
        y += [s.y0 + hair, s.y1 - hair]
        r += [s.inner0, s.inner1] if inner else [s.outer0, s.outer1]
    return np.array(y), np.array(r)
