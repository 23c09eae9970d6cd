"""Derivatives of a harmonic solid by its shape and material, on a mesh that moves with them.

Every cell is carried along with its unknowns by a velocity V of the nodes: ``d(phi,i) = -phi,j V_j,i``,
``d(phi / r) = -(phi / r) V_r / r`` and ``d(r dA) = (V_r / r + div V) r dA``.  What this makes of the
energy of two states is linear in V, so it is gathered once as a force on every node and then
multiplied with the velocities of as many parameters as there are (the volume form of the shape
derivative; see Haug, Choi and Komkov, Design Sensitivity Analysis of Structural Systems, 1986, ch. 3).
It is the exact derivative of the discrete number on the moving mesh.

Where surfaces of two segments meet without a step but move differently, the nodes between take the
mean, and what the surface moves beyond that is added as the energy on it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from skfem import ElementQuad1

from solidgear.body import Body
from solidgear.errors import SolidgearError
from solidgear.kernel.assembly import reference
from solidgear.meshing.bands import radial_bands
from solidgear.models.harmonic.blocks import Work
from solidgear.models.harmonic.families import TORSION, Family, family_of
from solidgear.scene.attached import attached_stations
from solidgear.scene.coned import coned
from solidgear.solve.adjoint import Form, State


@dataclass
class Push:
    """Derivatives of one number by all that may move."""

    nodes: np.ndarray  #: (2, n) by r and y of the nodes
    planes: np.ndarray  #: (p,) by the reference points of the ports
    ends: np.ndarray  #: (p, 2) by the ends of their seats, beyond what the mesh moves
    #: (2, k, 2) by the radius of the surface outside and in the bore, at both ends of its cells,
    #: beyond that
    surface: list[np.ndarray]
    #: lame, shear, density: (s,) by Lame's constants and the density of every segment
    lame: np.ndarray
    shear: np.ndarray
    density: np.ndarray


class HarmonicAdjoint:
    """Derivatives of numbers of a harmonic body (straight sides, order 3 or more) by its shape and
    material.
    """

    def __init__(self, scene, body: Body, forms: Sequence[Form]):
        self.scene = scene = coned(scene)
        geometry: Any = body.geometry
        self.flat, self.body = geometry.meridian, body
        self.work = Work(scene, geometry)
        self.stations = [*attached_stations(scene.stations)]
        if [(s.name, a) for s, a in self.stations] != [(p.name, p.attachment) for p in body.ports]:
            raise SolidgearError("derivatives need the attachments of the scene")
        self.sides = {1: self.flat.outer, 0: self.flat.inner}
        self.rings = rings(scene, self.flat)
        pairs = [pair for form in forms for pair in form.pairs]
        owner = [k for k, form in enumerate(forms) for _ in form.pairs]
        scale = [form.scale for form in forms for _ in form.pairs]
        self.pushes = [self._empty() for _ in forms]
        for own, columns, use in self._families(pairs):
            kept = [self.pushes[owner[k]] for k, _, _ in use]
            by = np.array([scale[k] for k, _, _ in use])
            lam = np.array([pairs[k][0].eigenvalue for k, _, _ in use])
            first, second = (np.array([u[side] for u in use]) for side in (1, 2))
            states = _States(self, own, columns, first, second, lam, by, kept)
            states.volume()
            states.ports()

    def _empty(self) -> Push:
        p, s = len(self.body.ports), len(self.scene.segments)
        surface = [np.zeros((len(self.sides[side]), 2)) for side in (1, 0)]
        by_segment = (np.zeros(s) for _ in range(3))
        return Push(
            np.zeros_like(self.flat.points), np.zeros(p), np.zeros((p, 2)), surface, *by_segment
        )

    def _families(self, pairs):
        """Yields (family, columns, uses): unknowns of the mesh of every state in every block of a
        family, and (pair, column of one, column of the other).
        """
        groups: dict[Family, tuple[list, dict, list]] = {}
        for k, (a, b) in enumerate(pairs):
            for index in a.vectors.keys() & b.vectors.keys():
                block = self.body.block(index)
                family = family_of(block.name)
                columns, known, uses = groups.setdefault(family, ([], {}, []))
                at = []
                for state in (a, b):
                    if (id(state), index) not in known:
                        known[id(state), index] = len(columns)
                        u = state.vectors[index]
                        u = u if block.expand is None else block.expand @ u
                        columns.append((state, index, self.work.geometry.whole(family, u)))
                    at.append(known[id(state), index])
                uses.append((k, *at))
        for family, (columns, _, uses) in groups.items():
            yield family, columns, uses


class _States:
    """States of one family of motion, and the pairs of them."""

    def __init__(
        self, whole: HarmonicAdjoint, family: Family, columns, first, second, lam, by, pushes
    ):
        self.whole, self.work, self.family = whole, whole.work, family
        self.columns = columns
        self.u = np.stack([one[2] for one in columns], axis=-1)
        self.first, self.second, self.lam, self.by, self.pushes = first, second, lam, by, pushes
        self.trace, normal, shear = family.energy
        self.rest = 2 * normal + shear
        # forces that rigid seats hold surfaces by
        self.rigid = family.waves == 1 and any(a == "rigid" for _, a in whole.stations)
        self.residual = np.zeros((self.work.n, *self.u.shape[1:]))

    def fields(self, t, cells):
        """Values (m, q, c, k) and functions (3, m, q, c, k) as in `strains`, at points of cells."""
        local = self.u[self.work.dofs[:, cells]]
        value = np.einsum("bq,bmck->mqck", t.value, local, optimize=True)
        slope = np.einsum("bdq,bmck->dmqck", t.slope, local, optimize=True)
        gradient = np.einsum("dimq,dmqck->imqck", t.inverse, slope, optimize=True)
        around = value / t.x[0][:, :, None, None]
        return value, np.concatenate([around[None], gradient])

    def densities(self, material, value, g):
        """Energies of all pairs: trace, rest and mass, each (m, q, P); and the stress functions."""
        trace = np.einsum("ipjq,jmuqk->imupk", self.trace, g, optimize=True)
        rest = np.einsum("ipjq,jmuqk->imupk", self.rest, g, optimize=True)
        one, two = g[..., self.first], self.second
        e_trace = np.einsum("imupk,imupk->muk", one, trace[..., two])
        e_rest = np.einsum("imupk,imupk->muk", one, rest[..., two])
        heavy = np.einsum(
            "mupk,mupk,p->muk", value[..., self.first], value[..., self.second], self.family.share
        )
        mu = material.shear_modulus
        lame = 2 * mu * material.nu / (1 - 2 * material.nu)
        return e_trace, e_rest, heavy, lame * trace + mu * rest, lame, mu

    def volume(self) -> None:
        """Shape, material and the forces of rigid seats, from all cells."""
        work, flat = self.work, self.whole.flat
        shape, dshape = reference(ElementQuad1(), work.points)
        segment = 0
        for part, material, t, dv in work.batches():
            segment = int(flat.segment[part[0]])
            w = self.family.weight(t.x[0], dv)[:, :, None]
            value, g = self.fields(t, part)
            e_trace, e_rest, heavy, stress, lame, mu = self.densities(material, value, g)
            mass = self.lam * heavy
            e = lame * e_trace + mu * e_rest - material.density * mass
            one, two = g[..., self.first], g[..., self.second]
            s_one, s_two = stress[..., self.first], stress[..., self.second]
            # product of gradient j of one state with stress i of the other, both ways
            t_ij = np.einsum("jmupk,imupk->ijmuk", one, s_two, optimize=True)
            t_ij = t_ij + np.einsum("jmupk,imupk->ijmuk", two, s_one, optimize=True)
            r = t.x[0][:, :, None]
            radial = w * (self.family.power * e - t_ij[0, 0]) / r
            spread = -t_ij[1:, 1:] * w
            for i in range(2):
                spread[i, i] += w * e
            slope = np.einsum("bdq,dimq->bimq", dshape, t.inverse, optimize=True)
            force = np.einsum("bimq,ijmqk->jbmk", slope, spread, optimize=True)
            force[0] += np.einsum("bq,mqk->bmk", shape, radial, optimize=True)
            force *= -self.by
            for k, push in enumerate(self.pushes):
                for j in range(2):
                    np.add.at(push.nodes[j], flat.cells[:, part], force[j, :, :, k])
                push.lame[segment] -= self.by[k] * (w[..., 0] * e_trace[..., k]).sum()
                push.shear[segment] -= self.by[k] * (w[..., 0] * e_rest[..., k]).sum()
                push.density[segment] += self.by[k] * (w[..., 0] * mass[..., k]).sum()
            if self.rigid:
                self._hold(part, material, t, w, value, stress)
        for side in (1, 0):
            self._surface(side)

    def _hold(self, part, material, t, w, value, stress) -> None:
        """Add forces of the cells on the functions of their corners."""
        lam = np.array([one[0].eigenvalue for one in self.columns])
        pull = stress[0] / t.x[0][:, :, None, None]
        pull = pull - material.density * lam * self.family.share[:, None] * value
        gradient = np.einsum("bdq,dimq->bimq", t.slope[:4], t.inverse)
        out = np.einsum("bq,mqpk->bmpk", t.value[:4], pull * w[..., None])
        out += np.einsum("bimq,imqpk->bmpk", gradient, stress[1:] * w[..., None])
        np.add.at(self.residual, self.work.dofs[:4][:, part], out)

    def _surface(self, side: int) -> None:
        """Energy on surfaces beside joints, by the radius at both ends of a cell."""
        flat, work = self.whole.flat, self.work
        cells = self.whole.sides[side]
        beside = self.whole_joints(side)
        sign = 1.0 if side else -1.0
        for at in np.flatnonzero(beside):
            cell = cells[at : at + 1]
            t = work.on_edge(cell, 0, float(side))
            dy = t.tangent[:, :, 1, 1] * work.gw
            value, g = self.fields(t, cell)
            material = self.whole.scene.segments[int(flat.segment[cell[0]])].material
            e_trace, e_rest, heavy, _, lame, mu = self.densities(material, value, g)
            e = lame * e_trace + mu * e_rest - material.density * self.lam * heavy
            e = e * self.family.weight(t.x[0], dy)[:, :, None]
            for end, hat in enumerate((1 - work.g, work.g)):
                felt = -sign * self.by * np.einsum("q,mqk->k", hat, e)
                for k, push in enumerate(self.pushes):
                    push.surface[1 - side][at, end] += felt[k]

    def whole_joints(self, side: int) -> np.ndarray:
        """Mask of the surface cells that touch a joint without a step."""
        edges = [
            e.y
            for e in self.whole.scene.outline.edges
            if e.surface == ("outer" if side else "bore") and not e.steps and e.before > 0
        ]
        y = self.whole.flat.points[1][self.whole.flat.cells[:, self.whole.sides[side]]]
        tol = 1e-9 * self.whole.scene.length
        near = [(np.abs(y - at).min(axis=0) < tol) for at in edges]
        return np.any(near, axis=0) if near else np.zeros(y.shape[1], bool)

    def ports(self) -> None:
        """Terms of the rows of ports: F' dB u of both states."""
        if self.family.waves not in (TORSION, 0, 1):
            return
        if self.rigid:
            self._unload()
        for k, (push, by) in enumerate(zip(self.pushes, self.by)):
            for mine, other in ((self.first[k], self.second[k]), (self.second[k], self.first[k])):
                state, index, _ = self.columns[mine]
                for p, (station, attachment) in enumerate(self.whole.stations):
                    self._row(p, station, attachment, state, index, other, push, by, mine)

    def _unload(self) -> None:
        """Take from the forces on rigid seats what other ports bring there."""
        for p, (station, attachment) in enumerate(self.whole.stations):
            if attachment == "rigid":
                continue
            rows = self.work.mean(self.family, station, attachment)
            for k, (state, index, _) in enumerate(self.columns):
                force = self._own(state.forces, index, p)
                self.residual[..., k] -= (force @ rows).reshape(-1, 3)

    def _own(self, six: np.ndarray, index: int, p: int) -> np.ndarray:
        """Components of a port in the plane that this family is written in."""
        block = self.whole.body.blocks[index]
        _, signs = block.mirror or (index, (1.0,) * len(block.components))
        return np.array(signs) * six[[6 * p + c for c in block.components]]

    def _row(self, p, station, attachment, state: State, index, other, push: Push, by, mine):
        """Add what one port does under the forces of one state and the displacement of another."""
        force = self._own(state.forces, index, p)
        moved = self._own(self.columns[other][0].motions, index, p)
        if attachment == "rigid":
            if self.family.waves == 1:
                self._rigid(p, station, mine, moved, push, by)
            return
        if not force.any():
            return
        work, flat = self.work, self.whole.flat
        value, r, h, weight, dofs, cells, ends = work.surface(station, attachment)
        u = np.einsum("bq,bec->eqc", value, self.u[dofs][..., other])
        if self.family.waves == 1:
            ring = 2 * np.pi * weight * r
            area, first, second = ((ring * f).sum() for f in (1.0, h, h * h + r * r / 2))
            gram = np.array([[area, first], [first, second]])
            g = np.linalg.solve(gram, force)
            # distances of the surface from the mean rigid motion
            lift = u[..., 0] - moved[0] - h * moved[1]
            along = u[..., 2] + r * moved[1]
            arm = g[0] + g[1] * h
            density = 2 * np.pi * r * arm * lift - np.pi * r**2 * g[1] * along
            by_r = 2 * np.pi * (arm * lift - r * g[1] * along) - np.pi * r**2 * g[1] * moved[1]
            by_h = 2 * np.pi * r * (g[1] * lift - arm * moved[1])
        else:
            power = 1 if self.family.waves == 0 else 3
            g = force[0] / (weight * r**power).sum()
            rest = u[..., -1] - moved[0]
            density, by_r = g * r**power * rest, g * power * r ** (power - 1) * rest
            by_h = np.zeros_like(rest)
        corner = flat.cells[list(ends)][:, cells]
        side = flat.points[:, corner[1]] - flat.points[:, corner[0]]
        length = np.hypot(*side)
        total = (weight * density).sum(axis=1)
        for end, hat, sign in ((0, 1 - work.g, -1.0), (1, work.g, 1.0)):
            for j, own in ((0, by_r), (1, by_h)):
                felt = (weight * own) @ hat + sign * total * side[j] / length**2
                np.add.at(push.nodes[j], corner[end], by * felt)
        push.planes[p] -= by * (weight * by_h).sum()
        if attachment == "average":
            # per length along the axis, at the two ends of the seat
            rate = density * (length / np.abs(side[1]))[:, None]
            lines = flat.points[1][corner]
            low, high = int(lines[0].argmin()), int(lines[1].argmax())
            basis = np.polynomial.legendre.Legendre
            for end, cell, sign, place in ((0, low, -1.0, 0.0), (1, high, 1.0, 1.0)):
                fit = basis.fit(work.g, rate[cell], len(work.g) - 1, domain=[0, 1])
                push.ends[p, end] += sign * by * float(fit(place))

    def _rigid(self, p, station, mine, moved, push: Push, by) -> None:
        """A rigid seat takes its nodes along as they lie about the port."""
        work, flat = self.work, self.whole.flat
        cells = work.seat_cells(station)
        nodes = np.unique(flat.cells[[1, 2]][:, cells])
        corner = {int(n): int(d) for n, d in zip(flat.cells.ravel(), work.dofs[:4].ravel())}
        held = self.residual[[corner[int(n)] for n in nodes]][..., mine]
        push.nodes[1][nodes] -= by * held[:, 0] * moved[1]
        push.planes[p] += by * held[:, 0].sum() * moved[1]
        push.nodes[0][nodes] += by * held[:, 2] * moved[1]


def rings(scene, flat) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """For the corners of the cells of every segment: their share of its length, and the radii at its
    two ends of the lines that they lie on.
    """
    _, left, right = radial_bands(scene.outline)
    out = []
    for k, s in enumerate(scene.segments):
        corner = flat.cells[:, flat.segment == k]
        r, y = flat.points[:, corner]
        t = (y - s.y0) / s.length
        ends = np.empty((2, *t.shape))
        for at in np.unique(t):
            here = t == at
            radii = (1 - at) * left[k] + at * right[k]
            ends[:, here] = [
                np.interp(r[here], radii, side[: len(radii)]) for side in (left[k], right[k])
            ]
        out.append((t, *ends))
    return out
