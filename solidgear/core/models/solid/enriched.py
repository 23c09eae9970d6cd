"""Functions that one order more adds to those of a volume mesh, and their matrices.

Along an edge a polynomial of the next order that vanishes at both ends, times what falls to zero
away from the edge; in a face products of such polynomials.  With those of the mesh they hold, on a
tetrahedron, all polynomials of one order more; on a box all but products inside, which no face sees
(Szabo and Babuska 1991, Finite Element Analysis, ch. 6 and 13).  A function that is odd along its
edge or face has a sign in every cell, so that it is one function for all of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import product
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import scipy.sparse as sp
from skfem.refdom import RefHex, RefTet

from solidgear.core.body import Reflection
from solidgear.core.body.model import Enrichment
from solidgear.core.body.symmetric import Symmetric
from solidgear.core.elements import ELEMENTS
from solidgear.core.kernel.assembly import Tabulation, unknowns
from solidgear.core.meshing.lobatto import gauss_box
from solidgear.core.models.solid.images import Images, images_of, of_vectors, orbits
from solidgear.core.models.solid.matrices import _cell_rule, integrals, rigid_part, weighed
from solidgear.core.models.solid.mesh import SolidMesh

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Material

#: values (q,) at some points, and slopes (3, q) along the reference coordinates
Sample = tuple[np.ndarray, np.ndarray]
Legendre = np.polynomial.legendre.Legendre
#: cells whose stiffness is in memory at once
CELLS = 400


@dataclass(frozen=True)
class Further:
    """Functions on a reference cell beyond those of an element, counted as scikit-fem does."""

    edge: tuple[int, ...]  #: orders of the functions of an edge
    face: tuple[tuple[int, int], ...]  #: orders of the functions of a face in both directions
    refdom: Any  #: scikit-fem's reference cell

    dim: ClassVar = 3
    nodal_dofs: ClassVar = 0
    interior_dofs: ClassVar = 0

    @classmethod
    def beyond(cls, element: str) -> Further:
        """Return the functions of one order more than those of an element such as ``tet10``."""
        order = ELEMENTS[element].order + 1
        if element.startswith("tet"):
            return cls((order,), ((2, 2),) if order > 2 else (), RefTet)
        orders = [(a, b) for a, b in product(range(2, order + 1), repeat=2)]
        if element == "hex27":
            orders.remove((2, 2))
        return cls((order,), tuple(orders), RefHex)

    @property
    def edge_dofs(self) -> int:
        """Number of functions of an edge."""
        return len(self.edge)

    @property
    def facet_dofs(self) -> int:
        """Number of functions of a face."""
        return len(self.face)

    def at(self, points: np.ndarray) -> Sample:
        """Return values (k, q) and slopes (k, 3, q) at reference points (3, q)."""
        samples = self._in_tetrahedron(points) if self.refdom is RefTet else self._in_box(points)
        values, slopes = zip(*samples)
        return np.array(values), np.array(slopes)

    def _in_tetrahedron(self, points: np.ndarray) -> Iterable[Sample]:
        """Yield the functions of a tetrahedron, of barycentric coordinates."""
        slopes = np.array([[-1.0, -1.0, -1.0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
        values = np.vstack([1 - points.sum(axis=0), points])
        corners = [(v, np.tile(s[:, None], v.shape)) for v, s in zip(values, slopes)]
        for i, j in RefTet.edges:
            for order in self.edge:
                (a, da), (b, db) = corners[i], corners[j]
                shape = Legendre.basis(order - 2)
                along = shape(b - a), shape.deriv()(b - a) * (db - da)
                yield _times([corners[i], corners[j], along])
        for face in RefTet.facets:
            for _ in self.face:
                yield _times([corners[k] for k in face])

    def _in_box(self, points: np.ndarray) -> Iterable[Sample]:
        """Yield the functions of a box, products of functions of one coordinate each."""
        places = np.asarray(RefHex.p)
        for edge in RefHex.edges:
            axis = int(np.argmax(np.ptp(places[:, edge], axis=1)))
            start, end = places[axis, edge]
            for order in self.edge:
                parts = [_towards(points, a, places[a, edge[0]]) for a in range(3) if a != axis]
                sign = np.sign(end - start) if order % 2 else 1.0
                value, slope = _bubble(points, axis, order)
                yield _times([*parts, (sign * value, sign * slope)])
        for face in RefHex.facets:
            normal, across = _axes_of(places[:, face])
            blend = _towards(points, normal, places[normal, face[0]])
            for orders in self.face:
                yield _times([blend, *(_bubble(points, a, n) for a, n in zip(across, orders))])

    def numbered(self, m: SolidMesh) -> tuple[np.ndarray, np.ndarray]:
        """Return the numbers (k, ne) of the functions in every cell of a mesh, and their signs."""
        corners, numbers = m.mesh.t, unknowns(m.mesh, self)
        signs = np.ones(numbers.shape)
        row = 0
        for i, j in self.refdom.edges:
            for order in self.edge:
                if order % 2:
                    signs[row] = np.where(corners[i] < corners[j], 1.0, -1.0)
                row += 1
        if self.refdom is RefTet:
            return numbers, signs
        for face in RefHex.facets:
            rows = slice(row, row + len(self.face))
            numbers[rows], signs[rows] = self._turned(corners[face], face, numbers[rows])
            row += len(self.face)
        return numbers, signs

    def _turned(
        self, corners: np.ndarray, face: Sequence[int], numbers: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return numbers and signs of the functions of a quadrilateral, which runs from its least
        corner, first towards the lesser one of the two next to it.
        """
        _, across = _axes_of(np.asarray(RefHex.p)[:, face])
        places = np.asarray(RefHex.p)[np.ix_(across, face)]
        cell = np.arange(corners.shape[1])
        start = places[:, corners.argmin(axis=0)]

        def next_to(axis: int) -> np.ndarray:
            """Return the corner next to the least one along a local axis."""
            wanted = start.copy()
            wanted[axis] = 1 - wanted[axis]
            return corners[np.abs(places[:, :, None] - wanted[:, None]).sum(axis=0).argmin(0), cell]

        straight = next_to(0) < next_to(1)
        place = {orders: k for k, orders in enumerate(self.face)}
        turned, signs = np.empty_like(numbers), np.ones(numbers.shape)
        for k, orders in enumerate(self.face):
            swapped = place[orders[1], orders[0]]
            turned[k] = np.where(straight, numbers[k], numbers[swapped])
            for order, backward in zip(orders, start > 0.5):
                if order % 2:
                    signs[k] *= np.where(backward, -1.0, 1.0)
        return turned, signs


def _towards(points: np.ndarray, axis: int, end: float) -> Sample:
    """Return the coordinate that is one at an end of an axis and zero at the other."""
    slope = np.zeros(points.shape)
    slope[axis] = 1.0 if end else -1.0
    return (points[axis] if end else 1 - points[axis]), slope


def _bubble(points: np.ndarray, axis: int, order: int) -> Sample:
    """Return the polynomial of an order along an axis that vanishes at both ends."""
    t, shape = points[axis], Legendre.basis(order - 2)
    slope = np.zeros(points.shape)
    slope[axis] = (1 - 2 * t) * shape(2 * t - 1) + 2 * t * (1 - t) * shape.deriv()(2 * t - 1)
    return t * (1 - t) * shape(2 * t - 1), slope


def _times(factors: Sequence[Sample]) -> Sample:
    """Return a product of functions."""

    def two(a: Sample, b: Sample) -> Sample:
        return a[0] * b[0], a[0] * b[1] + b[0] * a[1]

    return reduce(two, factors)


def _axes_of(places: np.ndarray) -> tuple[int, list[int]]:
    """Return the axis normal to a face with corners at these places (3, 4), and the two others."""
    normal = int(np.argmin(np.ptp(places, axis=1)))
    return normal, [a for a in range(3) if a != normal]


@dataclass(frozen=True)
class Seat:
    """Facets of a mesh that carry a port."""

    place: float | Sequence[float]  #: of the port: y on the axis, or a point, m
    facets: np.ndarray
    rigid: bool = False  #: whether they move as one rigid piece
    within: tuple[float, float] | None = None  #: ends along y, m, of the part that counts
    cells: np.ndarray | None = None  #: whose mean motion is that of the port, in place of facets

    def pieces(self, m: SolidMesh) -> Iterable:
        """Return quadrature on the seat, of :meth:`SolidMesh.over_facets`."""
        if self.cells is not None:
            return m.over_cells(self.cells)
        return m.over_facets(self.facets, self.within)


@dataclass(frozen=True, eq=False)
class Addition:
    """Functions that one order more adds to a mesh, each with three components, and their
    matrices, which of a mesh with mirror planes have rows of some only, as those of an
    :class:`Enrichment` do.
    """

    mesh: SolidMesh
    further: Further
    numbers: np.ndarray  #: (k, ne) functions of every cell
    signs: np.ndarray  #: (k, ne) that they have there
    stiffness: Symmetric  #: (3 s, 3 s) N/m
    coupling: sp.csr_matrix  #: (3 s, 3 n) stiffness between them and the nodes of the mesh, N/m
    inertia: sp.csr_matrix  #: (s, n) mass between them and the nodes, of every component, kg
    summed: np.ndarray  #: (s,) which of them the matrices have rows for
    images: tuple[Images, ...] = ()  #: of the cells in every mirror plane

    @classmethod
    def of_mesh(
        cls,
        m: SolidMesh,
        materials: Sequence[Material],
        reflections: Sequence[Reflection] = (),
    ) -> Addition:
        """Compute what one order more adds to a mesh; `reflections` are those of its unknowns."""
        further = Further.beyond(m.name)
        numbers, signs = further.numbered(m)
        images = images_of(m.mesh.t, reflections)
        cells, multiples = orbits(images[:2], m.dofs.shape[1])
        summed, places = np.unique(numbers[:, cells], return_inverse=True)
        n = m.nodes.shape[1]
        basis, weights = _with_further(m, further)
        part = replace(m, dofs=m.dofs[:, cells], segment=m.segment[cells])
        stiffness, mass = integrals(
            part,
            materials,
            basis,
            weights,
            np.vstack([part.dofs, n + places.reshape(len(numbers), -1)]),
            np.vstack([np.ones(part.dofs.shape), signs[:, cells]]),
            multiples,
            first=len(m.dofs),
        )
        coupling, own = stiffness.before(), stiffness.symmetric()
        del stiffness  # as large as both
        return cls(m, further, numbers, signs, own, coupling, mass.before(), summed, images)

    @property
    def count(self) -> int:
        """Number w of the functions."""
        return int(self.numbers.max()) + 1

    def reflected(self, reflections: Sequence[Reflection]) -> Iterable[Reflection]:
        """Yield the mirrors of their unknowns (3 w,), from those of the unknowns of the mesh."""
        for reflection, image in zip(reflections, self.images):
            of_functions = image.of_functions(self.further, self.numbers, self.signs)
            yield of_vectors(reflection, *of_functions)

    def alive(self, facets: np.ndarray) -> np.ndarray:
        """Return the functions that do not vanish on some facets."""
        corner = np.full((2, 1), 0.3) + np.array([[0.0, 0.2, 0.0], [0.0, 0.0, 0.1]])
        parts = [np.zeros(0, int)]
        for place, cells in self.mesh.local_facets(facets):
            value, _ = self.further.at(self.mesh.on_facet(place, corner)[0])
            parts.append(self.numbers[np.abs(value).max(axis=1) > 1e-9][:, cells].ravel())
        return np.unique(np.concatenate(parts))

    def loads(self, seat: Seat) -> np.ndarray:
        """Return the loads (3 w, 6) of unit rigid motions of a seat, of :func:`weighed`."""
        return weighed(self._pieces(seat), seat.place, self.count)[1]

    def _pieces(
        self, seat: Seat
    ) -> Iterable[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]:
        """Yield quadrature on a seat as :meth:`SolidMesh.over_facets`, with values (e, k, q)."""
        pieces = (
            self.mesh.quadrature_on(seat.facets, seat.within)
            if seat.cells is None
            else [self.mesh.quadrature_in(seat.cells)]
        )
        for points, cells, x, weight in pieces:
            value, _ = self.further.at(points)
            yield value * self.signs[:, cells].T[:, :, None], x, weight, self.numbers[:, cells]


def enrichment(
    m: SolidMesh,
    materials: Sequence[Material],
    seats: Sequence[Seat],
    components: tuple[int, ...] = tuple(range(6)),
    held: tuple[np.ndarray, np.ndarray] | None = None,
    copies: int = 1,
    reflections: Sequence[Reflection] = (),
) -> Enrichment:
    """Compute what one order more adds to a mesh of which so many copies make the body, whose ports
    have these seats and components; `held` are facets, and the components (3,) that do not move
    there; `reflections` are those of the unknowns of the mesh.
    """
    more = Addition.of_mesh(m, materials, reflections)
    n, count = m.nodes.shape[1], more.count
    moves = np.ones((count, 3))
    if held is not None:
        facets, still = held
        moves[np.ix_(more.alive(facets), still)] = 0.0
    rows = []
    for seat in seats:
        if seat.rigid:
            # what does not vanish on a rigid seat stands still: rigid motions are in the mesh
            moves[more.alive(seat.facets)] = 0.0
            rows.append(np.zeros((len(components), 3 * count)))
            continue
        gram, _ = weighed(seat.pieces(m), seat.place, n)
        rows.append(rigid_part(gram, more.loads(seat), components).toarray())
    for matrix in (more.stiffness.upper, more.coupling, more.inertia):
        matrix.data *= copies  # in place: they are the largest arrays of an error bar
    return Enrichment(
        more.stiffness,
        more.coupling,
        more.inertia,
        (3 * more.summed[:, None] + np.arange(3)).ravel(),
        np.vstack([np.zeros((0, 3 * count)), *rows]),
        moves.ravel(),
        np.repeat(np.arange(count), 3),
        more.numbers,
        tuple(zip(reflections, more.reflected(reflections))),
    )


def _with_further(m: SolidMesh, further: Further) -> tuple[Tabulation, np.ndarray]:
    """Tabulate the functions of a mesh and further ones at the points of these weights."""
    points, weights = _cell_rule(m.name) if m.name.startswith("tet") else gauss_box(4, 3)
    basis = Tabulation(m.element, m.element, points)
    value, slope = further.at(points)
    basis.value, basis.slope = np.vstack([basis.value, value]), np.concatenate([basis.slope, slope])
    return basis, weights


def by_cells(m: SolidMesh, on_mesh: np.ndarray, beyond: np.ndarray) -> np.ndarray:
    """Return the values (ne, 3 k, l) in every cell of displacements (3 n, l) in the functions of a
    mesh and (m, l) in further ones.
    """
    numbers, signs = Further.beyond(m.name).numbered(m)
    count = on_mesh.shape[1]
    inner = on_mesh.reshape(-1, 3, count)[m.dofs]
    outer = beyond.reshape(-1, 3, count)[numbers] * signs[:, :, None, None]
    cells = m.dofs.shape[1]
    return np.concatenate([inner, outer]).transpose(1, 0, 2, 3).reshape(cells, -1, count)


def products_by_cells(
    m: SolidMesh, materials: Sequence[Material], values: Sequence[np.ndarray]
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the numbers (e,) of some cells after others and the products of energy (e, l, l) there
    of displacements from :func:`by_cells` side by side.
    """
    basis, weights = _with_further(m, Further.beyond(m.name))
    functions = len(basis.value)
    for start in range(0, m.dofs.shape[1], CELLS):
        part = np.arange(start, min(start + CELLS, m.dofs.shape[1]))
        some = replace(m, dofs=m.dofs[:, part], segment=m.segment[part])
        # every cell by itself: no function is that of another
        numbers = np.arange(functions * len(part)).reshape(len(part), functions).T
        stiffness, _ = integrals(some, materials, basis, weights, numbers)
        here = np.concatenate([x[part] for x in values], axis=2)
        loads = (stiffness.matrix() @ here.reshape(-1, here.shape[2])).reshape(here.shape)
        yield part, here.transpose(0, 2, 1) @ loads
