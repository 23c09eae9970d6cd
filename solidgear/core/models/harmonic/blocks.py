"""Blocks of an axisymmetric-harmonic solid: stiffness, mass and port motions of one harmonic.

With y the axis and ``z = r cos t, x = r sin t``, harmonic n >= 1 of the displacement is
``u_r = U cos nt, u_t = -V sin nt, u_y = W cos nt`` (n = 0: ``u_r = U, u_y = W``; torsion apart).
The unknowns are ``p = (U + V)/2, q = (U - V)/2, w = W``, for which the conditions on the axis are
plain zeros; p is the mean lateral displacement of a ring.  For torsion the unknown is ``u_t / r``.
See e.g. Zienkiewicz and Taylor, The Finite Element Method, 5th ed., vol. 2, sec. 9.6, for the
semi-analytical idea; the choice of unknowns is ours.

Section motions of a harmonic solid, by quadrature on the cells: they may be far longer than the
distance of two stations.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from skfem import ElementQuad1

from solidgear.core.body import Block
from solidgear.core.body.sections import Sections, hats, through
from solidgear.core.kernel.assembly import Pattern, Tabulated, Tabulation, batches
from solidgear.core.kernel.attachment import Attached, reduced, with_ports
from solidgear.core.kernel.cell_shapes import Shapes
from solidgear.core.meshing.lobatto import gauss, gauss_box
from solidgear.core.models.harmonic.families import TORSION, Family, family_of
from solidgear.core.models.harmonic.mesh import HarmonicMesh
from solidgear.core.scene.shaft import on_face

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft


#: element of the mapping of straight cells
CORNERS = ElementQuad1()
#: corners at the ends of the local edge where a coordinate has a value
EDGE_ENDS = {(0, 1.0): (1, 2), (1, 1.0): (3, 2), (1, 0.0): (0, 1)}


def _functions(t: Tabulated, weight: np.ndarray, around: bool) -> np.ndarray:
    """Return the values (ne, k, nb, nq) of phi / r, where asked for, phi,r and phi,y, times the
    root of the weights.
    """
    root = np.sqrt(weight)
    if not around:
        return t.gradient(root)
    return np.concatenate([(t.value * (root / t.x[0])[:, None])[:, None], t.gradient(root)], axis=1)


def _products(t: Tabulated) -> np.ndarray:
    """Return the products (nq, nb nb) of basis functions, of which every mass is a weighted sum."""
    nq = t.value.shape[1]
    return (t.value[:, None] * t.value).reshape(-1, nq).T


def _in_each(scalar: sp.csr_matrix, share: np.ndarray, keep: np.ndarray) -> sp.csr_matrix:
    """Return the matrix of unknowns of which each goes with those of the same component alone, by
    the matrix of one component and the share (c,) of each, without those that a mask (n c,) leaves
    out.
    """
    places = np.flatnonzero(keep)
    number = np.cumsum(keep) - 1
    rows = scalar[places // len(share)]
    component = np.repeat(places % len(share), np.diff(rows.indptr))
    column = rows.indices * len(share) + component
    left = keep[column]
    ends = np.concatenate([[0], np.cumsum(left)])[rows.indptr]
    out = sp.csr_matrix(
        ((rows.data * share[component])[left], number[column[left]], ends),
        shape=(len(places), len(places)),
    )
    out.eliminate_zeros()
    return out


class Work:
    """Tabulated basis, materials and surface integrals shared by the blocks of one body."""

    def __init__(self, scene: Shaft, geometry: HarmonicMesh):
        self.scene, self.geometry, self.order = scene, geometry, geometry.order
        self.flat, self.dofs, self.element = geometry.meridian, geometry.dofs, geometry.element
        self.g, self.gw = gauss(self.order + 2)
        self.points, self.weights = gauss_box(self.order + 2, 2)
        self.pattern = Pattern(self.dofs)
        self.n = self.pattern.n
        self.shapes = Shapes(self.flat, self.element)
        self.bases = [self.shapes.tabulation(kind, self.points) for kind in self.shapes.kinds]
        # Vertex functions carry all rigid motions; higher ones are zero there in a hierarchical
        # basis, but where a side is curved.
        self.place = self.shapes.places(self.dofs)
        self.point = np.ones(self.n, bool)
        if self.order > 2:
            self.point[:] = False
            self.point[self.dofs[:4]] = True
        self.y = np.where(self.point, self.place[1], np.nan)
        density = np.array([s.material.density for s in scene.segments])[self.flat.segment]
        self.hats = HatIntegrals(self.shapes, self.dofs, self.order, density)
        self.area = 0.0
        self._edges: dict[tuple[int, float], Tabulation] = {}  # by direction and value

    def batches(self):
        """Yield (cells, material, tabulated basis, area weights (m, nq)), one material and one
        shape of cells at a time.
        """
        bytes_each = 8 * (3 * self.dofs.shape[0] * len(self.weights) + 30 * self.dofs.shape[0] ** 2)
        of_segments = [segment.material for segment in self.scene.segments]
        for material in dict.fromkeys(of_segments):
            made_of = np.array([other == material for other in of_segments])
            for kind, basis in zip(self.shapes.kinds, self.bases):
                cells = kind.cells[made_of[self.flat.segment[kind.cells]]]
                for part in batches(cells, bytes_each):
                    t = basis.on(self.shapes.nodes(kind, part))
                    yield part, material, t, t.det * self.weights

    def block(self, name: str, components: tuple[int, ...], wanted) -> Block:
        """Build the block of a family of motion, by name, with the ports of stations and their
        attachments.
        """
        family, nb = family_of(name), self.dofs.shape[0]
        c = family.count
        stiffness, heavy = self.pattern.sum(c), self.pattern.sum()
        area = 0.0
        # Strains are linear in (phi / r, phi,r, phi,y) of each unknown, in torsion in the last two;
        # one Gram matrix of those functions per element holds every product that occurs.
        used = slice(1 if family.waves == TORSION else 0, 3)
        value = products = np.zeros(0)
        for part, material, t, dv in self.batches():
            area += dv.sum()
            w = family.weight(t.x[0], dv)
            f = _functions(t, w, used.start == 0)
            k = f.shape[1]
            f = f.reshape(len(part), k * nb, -1)
            gram = (
                (f @ f.transpose(0, 2, 1))
                .reshape(-1, k, nb, k, nb)
                .transpose(1, 3, 0, 2, 4)
                .reshape(k * k, -1)
            )
            law = family.stiffness(material)[used][:, :, used].transpose(1, 3, 0, 2)
            stiffness.add(part, law.reshape(c * c, k * k) @ gram)
            if value is not t.value:  # that all batches of one shape share
                value, products = t.value, _products(t)
            heavy.add(part, material.density * w @ products)
        self.area = area
        keep = family.free(self.geometry.on_axis).ravel()
        r, y = self.place
        rigid = family.rigid(r, y, self.point.astype(float)).reshape(self.n * c, -1)
        heavy_left = _in_each(heavy.matrix(), family.share, keep)
        turns = np.tile(family.turns, self.n)[keep, None]
        block = Block(
            name,
            components,
            stiffness.matrix()[keep][:, keep],
            heavy_left,
            rigid[keep],
            np.repeat(self.y, c)[keep],
            # the mass couples no two unknowns of a point
            swirl=(lambda v: heavy_left @ (turns * v)) if turns.any() else None,
        )
        seats = [
            self._seat_unknowns(station, c)[keep] if attachment == "rigid" else None
            for station, attachment in wanted
        ]
        if not components:
            return self._clamped(with_ports(block, ()), seats)
        ports = []
        for seat, (station, attachment) in zip(seats, wanted):
            if seat is not None:
                ports.append(Attached(station.y, held=seat))
            else:
                mean = self.mean(family, station, attachment)[:, keep]
                ports.append(Attached(station.y, mean))
        return with_ports(replace(block, sections=self._sections(family, keep)), ports)

    def _seat_unknowns(self, station, c: int) -> np.ndarray:
        """Return the mask of the unknowns on a seat, so many at each node."""
        seat = np.zeros((self.n, c), bool)
        seat[self.geometry.edge_unknowns(*self.side(station, "rigid"))] = True
        return seat.ravel()

    def _clamped(self, block: Block, seats) -> Block:
        """Return a block of waves, which move no port, with rigid seats at rest in it."""
        still = np.zeros(block.size, bool)
        for seat in seats:
            if seat is not None:
                still |= seat
        free = np.flatnonzero(~still)
        if len(free) == block.size:
            return block
        to = sp.identity(block.size, format="csc")[:, free].tocsr()
        return replace(
            block,
            stiffness=(to.T @ block.stiffness @ to).tocsr(),
            mass=(to.T @ block.mass @ to).tocsr(),
            rigid=block.rigid[free],
            y=block.y[free],
            ports=block.ports[:, free],
            expand=to,
            swirl=reduced(block.swirl, to),
        )

    def _sections(self, family: Family, keep: np.ndarray) -> Sections:
        """Return the section motions of a block with the unknowns of a mask left."""
        full = self.hats.sections(PARTS[family.waves], family.count)
        return through(full, sp.identity(len(keep), format="csc")[:, keep].tocsr())

    def seat_cells(self, station):
        """Return the cells with their outer edge on the seat."""
        y = self.flat.points[1][self.flat.cells[:, self.flat.outer]]
        tol = 1e-9 * self.scene.length
        return self.flat.outer[
            (y.min(axis=0) >= station.lo - tol) & (y.max(axis=0) <= station.hi + tol)
        ]

    def on_edge(self, cells, direction: int, value: float):
        """Tabulate the basis on a local edge of straight cells: where a coordinate has a value."""
        if (direction, value) not in self._edges:
            points = np.empty((2, len(self.g)))
            points[direction], points[1 - direction] = value, self.g
            self._edges[direction, value] = Tabulation(CORNERS, self.element, points)
        return self._edges[direction, value].on(self.flat.points[:, self.flat.cells[:, cells]])

    def side(self, station, attachment: str) -> tuple[np.ndarray, int, float]:
        """Return the cells with an edge on a seat, an end face or a section, and the direction and the
        value of the coordinate that is the same along it.
        """
        if attachment != "section" and not on_face(station):
            return self.seat_cells(station), 0, 1.0
        distance = np.abs(self.flat.points[1][self.flat.cells] - station.y)
        tol = 1e-9 * self.scene.length
        # of cells beside a fillet a single corner may lie in the plane
        cells = np.flatnonzero((distance[2:] < tol).all(axis=0))
        if len(cells):
            return cells, 1, 1.0
        # a section at the very start
        return np.flatnonzero((distance[:2] < tol).all(axis=0)), 1, 0.0

    def surface(self, station, attachment: str):
        """Return basis values (nb, q), r, y - y0, length weights (e, q) and unknowns on a seat or a
        section; its cells, and their corners at both ends of it.
        """
        cells, direction, value = self.side(station, attachment)
        t = self.on_edge(cells, direction, value)
        weight = np.linalg.norm(t.tangent[:, :, :, 1 - direction], axis=2) * self.gw
        ends = EDGE_ENDS[direction, value]
        return t.value, t.x[0], t.x[1] - station.y, weight, self.dofs[:, cells], cells, ends

    def mean(self, family: Family, station, attachment) -> np.ndarray:
        """Return the least-squares rigid motion (m, n c) of a surface, as rows on the unknowns of a
        family.
        """
        value, r, h, w, dofs, *_ = self.surface(station, attachment)
        density = family.means(r, h, w)
        rows = np.zeros((self.n, *density.shape[2:]))
        np.add.at(rows, dofs.T, np.einsum("bq,eqcm->ebcm", value, density))
        return rows.reshape(-1, rows.shape[2]).T


@dataclass(frozen=True)
class Part:
    """Part of a displacement that a component of section motion moves: ``u = sign r^power`` in one
    unknown, under the mass ``factor rho r^weight``.
    """

    unknown: int
    factor: float
    weight: int
    sign: float = 1.0
    power: int = 0


#: by waves around, in unknowns (u_r, u_y) axially, u_t / r in torsion, (p, q, w) in bending with
#: translation and tilt
PARTS = {
    0: (Part(1, 2 * np.pi, 1),),
    TORSION: (Part(0, 2 * np.pi, 3),),
    1: (Part(0, 2 * np.pi, 1), Part(2, np.pi, 1, -1.0, 1)),
}


class HatIntegrals:
    """Integrals of hat functions along the axis over the cells of a meridian, weighted by density
    and powers of the radius, of which the sections of every block are made; those of the last
    stations are kept.
    """

    def __init__(self, shapes: Shapes, dofs: np.ndarray, order: int, density: np.ndarray):
        self._shapes, self._dofs, self._density = shapes, dofs, density
        self._n = int(dofs.max()) + 1
        self._rule = gauss(order + 2)
        self._kept: tuple[bytes, tuple[dict[int, np.ndarray], dict[int, np.ndarray]]] | None = None

    def on(self, stations: np.ndarray) -> tuple[dict[int, np.ndarray], dict[int, np.ndarray]]:
        """Return, by the power p of the radius, ``int rho r^p phi h_s`` (n, s) and ``int rho r^p h_s
        h_t`` (s, s) with the basis phi and hat functions h.
        """
        key = stations.tobytes()
        if self._kept is None or self._kept[0] != key:
            self._kept = key, self._integrated(stations)
        return self._kept[1]

    def _integrated(self, stations: np.ndarray):
        count, (x, w), flat = len(stations), self._rule, self._shapes.flat
        loads = {power: np.zeros((self._n, count)) for power in (1, 2, 3)}
        grams = {power: np.zeros((count, count)) for power in (1, 3)}
        # a cell is cut along the axis until no piece is longer than from station to station
        reach = np.ptp(flat.points[1][flat.cells], axis=0)
        pieces = np.ceil(reach / np.diff(stations).min() - 1e-9).astype(int).clip(1)
        for cut in np.unique(pieces):
            along = ((np.arange(cut)[:, None] + x) / cut).ravel()
            a, b = np.meshgrid(x, along, indexing="ij")
            weight = np.outer(w, np.tile(w / cut, cut)).ravel()
            points = np.array([a.ravel(), b.ravel()])
            for cells, t in self._tabulated(pieces == cut, points, 2 * count):
                mass = t.det * weight * self._density[cells, None]
                hat = hats(np.clip(t.x[1].ravel(), stations[0], stations[-1]), stations).toarray()
                to_unknowns = _at_cells(self._dofs[:, cells], self._n)
                for power, load in loads.items():
                    heavy = hat * (mass * t.x[0] ** power).reshape(-1, 1)
                    moved = t.value @ heavy.reshape(*t.det.shape, count)
                    load += to_unknowns @ moved.reshape(-1, count)
                    if power in grams:
                        grams[power] += hat.T @ heavy
        return loads, grams

    def _tabulated(self, wanted: np.ndarray, points: np.ndarray, fields: int):
        """Yield (cells, tabulated basis) for the cells of a mask, a batch of one shape at a time,
        with room for some fields more at their points.
        """
        bytes_each = 8 * (12 + fields) * points.shape[1]
        for kind in self._shapes.kinds:
            basis = self._shapes.tabulation(kind, points)
            for cells in batches(kind.cells[wanted[kind.cells]], bytes_each):
                yield cells, basis.on(self._shapes.nodes(kind, cells))

    def sections(self, parts: tuple[Part, ...], unknowns: int) -> Sections:
        """Return the sections of a block: one part a component, with so many unknowns at each scalar
        degree of freedom, numbered together.
        """

        def sections(stations):
            loads, grams = self.on(stations)
            count = len(stations)
            load = np.zeros((self._n, unknowns, count, len(parts)))
            gram = np.zeros((count, len(parts), count, len(parts)))
            for k, part in enumerate(parts):
                load[:, part.unknown, :, k] = (
                    part.factor * part.sign * loads[part.weight + part.power]
                )
                gram[:, k, :, k] = part.factor * grams[part.weight + 2 * part.power]
            size = count * len(parts)
            return load.reshape(self._n * unknowns, size), gram.reshape(size, size)

        return sections


def _at_cells(dofs: np.ndarray, n: int) -> sp.csc_matrix:
    """Return the sum (n, cells nb) of values of all cells at the unknowns, cell by cell."""
    ones = np.ones(dofs.size)
    return sp.csc_matrix((ones, dofs.T.ravel(), np.arange(dofs.size + 1)), (n, dofs.size))
