"""Blocks of an axisymmetric-harmonic solid: stiffness, mass and port motions of one harmonic.

With y the axis and ``z = r cos t, x = r sin t``, harmonic n >= 1 of the displacement is
``u_r = U cos nt, u_t = -V sin nt, u_y = W cos nt`` (n = 0: ``u_r = U, u_y = W``; torsion apart).
The unknowns are ``p = (U + V)/2, q = (U - V)/2, w = W``, for which the conditions on the axis are
plain zeros; p is the mean lateral displacement of a ring.  For torsion the unknown is ``u_t / r``.
See e.g. Zienkiewicz and Taylor, The Finite Element Method, 5th ed., vol. 2, sec. 9.6, for the
semi-analytical idea; the choice of unknowns is ours.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from skfem import ElementQuad1

from solidgear.body import Block
from solidgear.body.sections import Sections, through
from solidgear.errors import SolidgearError
from solidgear.kernel.assembly import Pattern, batches, reference, tabulate
from solidgear.kernel.attachment import Attached, with_ports
from solidgear.kernel.cell_shapes import Shapes
from solidgear.models.harmonic.sections import AXIAL, BENDING, TORSION, from_cells

_CORNERS = ElementQuad1()
#: corners at the ends of the local edge where a coordinate has a value
_ENDS = {(0, 1.0): (1, 2), (1, 1.0): (3, 2), (1, 0.0): (0, 1)}


def strains(n: int) -> tuple[np.ndarray, ...]:
    """Strains rr, tt, yy and shears rt, ty, ry of harmonic n, each (3, c): entry [i, p] belongs to
    function i of unknown p, functions being (phi / r, phi,r, phi,y) and unknowns (u_r, u_y) for
    n = 0, (p, q, w) otherwise. Shears rt and ty go with ``sin nt``, the others with ``cos nt``.
    """
    if n == 0:
        rr, tt, yy, rt, ty, ry = np.zeros((6, 3, 2))
        rr[1, 0] = tt[0, 0] = yy[2, 1] = ry[2, 0] = ry[1, 1] = 1.0
    else:
        rr, tt, yy, rt, ty, ry = np.zeros((6, 3, 3))
        rr[1, 0] = rr[1, 1] = 1.0
        tt[0, 0], tt[0, 1] = 1 - n, 1 + n
        yy[2, 2] = 1.0
        rt[0, 0], rt[1, 0], rt[0, 1], rt[1, 1] = 1 - n, -1.0, -(1 + n), 1.0
        ty[2, 0], ty[2, 1], ty[0, 2] = -1.0, 1.0, -n
        ry[2, 0] = ry[2, 1] = ry[1, 2] = 1.0
    return rr, tt, yy, rt, ty, ry


def _energy(n: int):
    """Coefficients of twice the strain energy density of harmonic n.

    Returns three (3, c, 3, c) arrays that multiply lambda, 2 mu and mu: entry [i, p, j, q] belongs
    to the product of function i of unknown p with function j of unknown q, as in `strains`.
    """
    rr, tt, yy, rt, ty, ry = strains(n)

    def product(parts):
        return sum(np.multiply.outer(s, s) for s in parts)

    return product([rr + tt + yy]), product([rr, tt, yy]), product([rt, ty, ry])


def _weight(n: int, t, dv: np.ndarray) -> np.ndarray:
    """(ne, nq) weights of the points in integrals of harmonic n over the body."""
    return (2 * np.pi if n == 0 else np.pi) * dv * t.x[0]


def _functions(t, weight: np.ndarray) -> np.ndarray:
    """(ne, 3, nb, nq) values of phi / r, phi,r and phi,y, times the root of the weights."""
    root = np.sqrt(weight)
    around = (t.value * (root / t.x[0])[:, None])[:, None]
    return np.concatenate([around, t.gradient(root)], axis=1)


def _products(t) -> np.ndarray:
    """(nq, nb nb) products of basis functions, of which every mass is a weighted sum."""
    nq = t.value.shape[1]
    return (t.value[:, None] * t.value).reshape(-1, nq).T


class _Work:
    """Tabulated basis, materials and surface integrals shared by the blocks of one body."""

    def __init__(self, scene, mesh, element, dofs, flat, order):
        self.scene, self.mesh, self.element, self.dofs, self.flat, self.order = (
            scene,
            mesh,
            element,
            dofs,
            flat,
            order,
        )
        x, w = np.polynomial.legendre.leggauss(order + 2)
        self.g, self.gw = (x + 1) / 2, w / 2
        a, b = np.meshgrid(self.g, self.g, indexing="ij")
        self.points = np.array([a.ravel(), b.ravel()])
        self.weights = np.outer(self.gw, self.gw).ravel()
        self.pattern = Pattern(dofs)
        self.n = self.pattern.n
        self.shapes = Shapes(flat, element)
        self.bases = [self.shapes.tabulation(kind, self.points) for kind in self.shapes.kinds]
        # Vertex functions carry all rigid motions; higher ones are zero there in a hierarchical
        # basis, but where a side is curved.
        self.place = self.shapes.places(dofs)
        self.point = np.ones(self.n, bool)
        if order > 2:
            self.point[:] = False
            self.point[dofs[:4]] = True
        self.y = np.where(self.point, self.place[1], np.nan)
        self.area = 0.0
        # Unknowns with a share on the axis.
        on_axis = np.zeros(self.n, bool)
        tol = 1e-9 * flat.points[0].max()
        axis_cells = flat.inner[np.abs(flat.points[0][flat.cells[0, flat.inner]]) < tol]
        axis_cells = axis_cells[np.abs(flat.points[0][flat.cells[3, axis_cells]]) < tol]
        on_axis[self._edge_unknowns(axis_cells, 0, 0.0)] = True
        self.on_axis = on_axis

    def _nodes(self, cells):
        return self.flat.points[:, self.flat.cells[:, cells]]

    def _edge_unknowns(self, cells, direction, value):
        """Unknowns of ``cells`` that do not vanish on a local edge."""
        points = np.empty((2, len(self.g)))
        points[direction], points[1 - direction] = value, self.g
        alive = np.abs(reference(self.element, points)[0]).max(axis=1) > 1e-12
        return np.unique(self.dofs[alive][:, cells])

    def _batches(self):
        """Yields (cells, material, tabulated basis, area weights (m, nq)), one material and one shape
        of cells at a time.
        """
        bytes_each = 8 * (3 * self.dofs.shape[0] * len(self.weights) + 30 * self.dofs.shape[0] ** 2)
        for index, segment in enumerate(self.scene.segments):
            for kind, basis in zip(self.shapes.kinds, self.bases):
                cells = kind.cells[self.flat.segment[kind.cells] == index]
                for part in batches(cells, bytes_each):
                    t = basis.on(self.shapes.nodes(kind, part))
                    yield part, segment.material, t, t.det * self.weights

    def bending_block(self, name, components, n, wanted) -> Block:
        """Block of harmonic n (0 is axial) in the unknowns (p, q, w), or (u_r, u_y) for n = 0."""
        c = 2 if n == 0 else 3
        nb = self.dofs.shape[0]
        stiffness, heavy = self.pattern.sum(c), self.pattern.sum()
        area = 0.0
        # Strains are linear in (phi / r, phi,r, phi,y) of each unknown; one Gram matrix of those
        # three functions per element holds every product that occurs.
        trace, normal, shear = (part.transpose(1, 3, 0, 2).reshape(c * c, 9) for part in _energy(n))
        for part, material, t, dv in self._batches():
            area += dv.sum()
            w = _weight(n, t, dv)
            f = _functions(t, w).reshape(len(part), 3 * nb, -1)
            gram = (
                (f @ f.transpose(0, 2, 1))
                .reshape(-1, 3, nb, 3, nb)
                .transpose(1, 3, 0, 2, 4)
                .reshape(9, -1)
            )
            mu = material.shear_modulus
            lame = 2 * mu * material.nu / (1 - 2 * material.nu)
            stiffness.add(part, (lame * trace + mu * (2 * normal + shear)) @ gram)
            heavy.add(part, material.density * w @ _products(t))
        self.area = area
        k = stiffness.matrix()
        share = np.ones(2) if n == 0 else np.array([2.0, 2.0, 1.0])
        # the product is written in dense blocks, whose zeros couple directions that mass does not
        m = sp.kron(heavy.matrix(), sp.diags(share)).tocsr()
        m.eliminate_zeros()

        keep = self.free_unknowns(n)
        y = np.repeat(self.y, c)[keep]
        rigid = np.zeros((self.n, c, len(components)))
        on = self.point
        if n == 0 and components:
            rigid[on, 1, 0] = 1.0
        elif n == 1:
            rigid[on, 0, 0] = 1.0
            rigid[:, 0, 1] = self.place[1]
            rigid[:, 2, 1] = -self.place[0]
        rigid = rigid.reshape(self.n * c, -1)[keep]
        k, m = k[keep][:, keep], m[keep][:, keep]
        seats = [
            self._seat_unknowns(station, c)[keep] if attachment == "rigid" else None
            for station, attachment in wanted
        ]
        if not components:
            return self._held(with_ports(Block(name, (), k, m, rigid, y), ()), seats)
        ports = [
            Attached(station.y, held=seat)
            if seat is not None
            else Attached(station.y, self._mean(n, station, attachment)[:, keep])
            for seat, (station, attachment) in zip(seats, wanted)
        ]
        sections = self._sections(BENDING if n else AXIAL, c, keep)
        return with_ports(Block(name, components, k, m, rigid, y, sections=sections), ports)

    def _seat_unknowns(self, station, c: int) -> np.ndarray:
        """Mask of the unknowns on a seat, so many at each node."""
        seat = np.zeros((self.n, c), bool)
        seat[self._edge_unknowns(self._seat_cells(station), 0, 1.0)] = True
        return seat.ravel()

    def _held(self, block: Block, seats) -> Block:
        """A block of waves that no motion of a port goes with: rigid seats stand still in it."""
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
        )

    def free_unknowns(self, n: int) -> np.ndarray:
        """Mask of the unknowns of harmonic n, numbered together at each node, that the axis leaves
        free.
        """
        keep = np.ones((self.n, 2 if n == 0 else 3), bool)
        if n == 0:
            keep[self.on_axis, 0] = False
        elif n == 1:
            keep[self.on_axis, 1:] = False
        else:
            keep[self.on_axis] = False
        return keep.ravel()

    def torsion_block(self, wanted) -> Block:
        """Block of torsion in the unknown ``u_t / r``; no condition on the axis."""
        stiffness, heavy = self.pattern.sum(), self.pattern.sum()
        for part, material, t, dv in self._batches():
            w = 2 * np.pi * dv * t.x[0] ** 3
            g = t.gradient(np.sqrt(w * material.shear_modulus))
            g = g.swapaxes(1, 2).reshape(len(part), self.dofs.shape[0], -1)
            stiffness.add(part, g @ g.transpose(0, 2, 1))
            heavy.add(part, material.density * w @ _products(t))
        k, m = stiffness.matrix(), heavy.matrix()
        rigid = self.point.astype(float)[:, None]
        ports = []
        for station, attachment in wanted:
            if attachment == "rigid":
                ports.append(Attached(station.y, held=self._seat_unknowns(station, 1)))
            else:
                value, r, _, weight, dofs, *_ = self.surface(station, attachment)
                row = np.zeros(self.n)
                w = weight * r**3
                np.add.at(row, dofs.T, np.einsum("bq,eq->eb", value, w))
                ports.append(Attached(station.y, row[None] / w.sum()))
        sections = self._sections(TORSION, 1, np.ones(self.n, bool))
        return with_ports(Block("torsion", (4,), k, m, rigid, self.y, sections=sections), ports)

    def _sections(self, parts, unknowns: int, keep: np.ndarray) -> Sections:
        """Section motions of a block of which ``keep`` are the unknowns left."""
        density = np.array([s.material.density for s in self.scene.segments])[self.flat.segment]
        every = from_cells(self.shapes, self.dofs, self.order, density, parts, unknowns)
        return through(every, sp.identity(len(keep), format="csc")[:, keep].tocsr())

    def _seat_cells(self, station):
        """Cells with their outer edge on the seat."""
        y = self.flat.points[1][self.flat.cells[:, self.flat.outer]]
        tol = 1e-9 * self.scene.length
        return self.flat.outer[
            (y.min(axis=0) >= station.lo - tol) & (y.max(axis=0) <= station.hi + tol)
        ]

    def on_edge(self, cells, direction: int, value: float):
        """Basis tabulated on a local edge of straight cells: where a coordinate has a value."""
        points = np.empty((2, len(self.g)))
        points[direction], points[1 - direction] = value, self.g
        return tabulate(_CORNERS, self._nodes(cells), self.element, points)

    def surface(self, station, attachment):
        """Basis values (nb, q), r, y - y0, length weights (e, q) and unknowns on a seat or a
        section; its cells, and their corners at both ends of it.
        """
        if attachment == "average":
            cells, direction, value = self._seat_cells(station), 0, 1.0
        elif attachment == "section":
            off = np.abs(self.flat.points[1][self.flat.cells] - station.y)
            tol = 1e-9 * self.scene.length
            # of cells beside a fillet a single corner may lie in the plane
            cells, direction, value = np.flatnonzero((off[2:] < tol).all(axis=0)), 1, 1.0
            if not len(cells):  # a section at the very start
                cells, value = np.flatnonzero((off[:2] < tol).all(axis=0)), 0.0
        else:
            raise SolidgearError(
                f"attachment {attachment!r} is unknown; use 'average', 'rigid' or 'section'"
            )
        t = self.on_edge(cells, direction, value)
        weight = np.linalg.norm(t.tangent[:, :, :, 1 - direction], axis=2) * self.gw
        ends = _ENDS[direction, value]
        return t.value, t.x[0], t.x[1] - station.y, weight, self.dofs[:, cells], cells, ends

    def _mean(self, n, station, attachment):
        """Least-squares rigid motion of a surface, as rows on the unknowns of harmonic n."""
        value, r, h, w, dofs, *_ = self.surface(station, attachment)

        def scatter(weight):
            row = np.zeros(self.n)
            np.add.at(row, dofs.T, np.einsum("bq,eq->eb", value, weight))
            return row

        if n == 0:
            out = np.zeros((1, self.n, 2))
            out[0, :, 1] = scatter(w * r) / (w * r).sum()
            return out.reshape(1, -1)
        out = np.zeros((2, self.n, 3))
        out[0, :, 0] = scatter(2 * np.pi * w * r)
        out[1, :, 0] = scatter(2 * np.pi * w * r * h)
        out[1, :, 2] = scatter(-np.pi * w * r * r)
        a = np.array(
            [
                [2 * np.pi * (w * r).sum(), 2 * np.pi * (w * r * h).sum()],
                [2 * np.pi * (w * r * h).sum(), np.pi * (w * r * (2 * h * h + r * r)).sum()],
            ]
        )
        return np.linalg.solve(a, out.reshape(2, -1))
