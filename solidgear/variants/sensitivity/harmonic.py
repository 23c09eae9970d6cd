"""Derivatives of a harmonic solid by shape and material, on a mesh that moves with them.

Every cell is carried along with its unknowns by a velocity V of the nodes: ``d(phi,i) = -phi,j V_j,i``,
``d(phi / r) = -(phi / r) V_r / r`` and ``d(r dA) = (V_r / r + div V) r dA``.  The change of the energy
of two states is linear in V, so it is gathered once as a force on every node and then multiplied
with the velocities of any number of parameters (the volume form of the shape derivative; see Haug,
Choi and Komkov, Design Sensitivity Analysis of Structural Systems, 1986, ch. 3).
It is the exact derivative of the discrete number on the moving mesh.

Nodes follow the ends of segments, seats and sections along the axis, linearly between them, and the
surfaces across it, linearly between the mesh lines that run from joint to joint.

Where surfaces of two segments meet without a step but move differently, the nodes between take the
mean, and motion of the surface beyond that is added as the energy on it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from skfem import ElementQuad1

from solidgear.core import TOUCH, Body, Scene, SolidgearError, coned
from solidgear.core.kernel.assembly import reference
from solidgear.core.meshing.bands import radial_bands
from solidgear.core.models.beam.element import SHAPE
from solidgear.core.models.harmonic.blocks import EDGE_ENDS, Work
from solidgear.core.models.harmonic.families import TORSION, Family, family_of
from solidgear.core.scene.shaft import attached_stations
from solidgear.variants.sensitivity.adjoint import (
    SEAT,
    Form,
    in_plane,
    line_velocities,
    rates,
    shared_blocks,
)


@dataclass
class Push:
    """Derivatives of one number by places, seats, surfaces and materials."""

    nodes: np.ndarray  #: (2, n) by r and y of the nodes
    planes: np.ndarray  #: (p,) by the reference points of the ports
    ends: np.ndarray  #: (p, 2) by the ends of their seats, beyond the motion of the mesh
    #: (2, k, 2) by the radius of the surface outside and in the bore, at both ends of its cells,
    #: beyond that
    surface: list[np.ndarray]
    lame: np.ndarray  #: (s,) by Lame's first constant of every segment
    shear: np.ndarray  #: (s,) by its shear modulus
    density: np.ndarray  #: (s,) by its density


class HarmonicAdjoint:
    """Derivatives of numbers of a harmonic body (straight sides, order 3 or more) by shape and
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
        owner = [(k, form.scale) for k, form in enumerate(forms) for _ in form.pairs]
        self.pushes = [self._empty() for _ in forms]
        for family, columns, uses in self._families(pairs):
            states = _States(
                adjoint=self,
                family=family,
                columns=columns,
                first=np.array([i for _, i, _ in uses]),
                second=np.array([j for _, _, j in uses]),
                lam=np.array([pairs[k][0].eigenvalue for k, _, _ in uses]),
                scale=np.array([owner[k][1] for k, _, _ in uses]),
                pushes=[self.pushes[owner[k][0]] for k, _, _ in uses],
            )
            states.volume()
            states.ports()

    def _empty(self) -> Push:
        p, s = len(self.body.ports), len(self.scene.segments)
        return Push(
            nodes=np.zeros_like(self.flat.points),
            planes=np.zeros(p),
            ends=np.zeros((p, 2)),
            surface=[np.zeros((len(self.sides[side]), 2)) for side in (1, 0)],
            lame=np.zeros(s),
            shear=np.zeros(s),
            density=np.zeros(s),
        )

    def _families(self, pairs):
        """Yield (family, columns, uses): unknowns on the mesh of every state in every block of a
        family, and (pair, column of the first state, column of its second).
        """
        groups: dict[Family, tuple[list, dict, list]] = {}
        for k, pair in enumerate(pairs):
            for index, shapes in shared_blocks(self.body, pair):
                family = family_of(self.body.block(index).name)
                columns, numbers, uses = groups.setdefault(family, ([], {}, []))
                for state, u in zip(pair, shapes):
                    if (id(state), index) not in numbers:
                        numbers[id(state), index] = len(columns)
                        columns.append((state, index, self.work.geometry.whole(family, u)))
                uses.append((k, *(numbers[id(state), index] for state in pair)))
        for family, (columns, _, uses) in groups.items():
            yield family, columns, uses


class _States:
    """States of one family of motion, and the pairs of them."""

    def __init__(
        self, adjoint: HarmonicAdjoint, family: Family, columns, first, second, lam, scale, pushes
    ):
        self.adjoint, self.work, self.family = adjoint, adjoint.work, family
        self.columns = columns
        self.u = np.stack([u for _, _, u in columns], axis=-1)
        self.first, self.second, self.lam, self.scale = first, second, lam, scale
        self.pushes = pushes
        self.trace, normal, shear = family.energy
        self.shearing = 2 * normal + shear
        # forces that rigid seats hold surfaces by
        self.rigid = family.waves == 1 and any(a == "rigid" for _, a in adjoint.stations)
        self.residual = np.zeros((self.work.n, *self.u.shape[1:]))

    def fields(self, t, cells):
        """Return values (m, q, c, k) and functions (3, m, q, c, k), as in `strains`, at points of
        cells.
        """
        local = self.u[self.work.dofs[:, cells]]
        value = np.einsum("bq,bmck->mqck", t.value, local, optimize=True)
        slope = np.einsum("bdq,bmck->dmqck", t.slope, local, optimize=True)
        gradient = np.einsum("dimq,dmqck->imqck", t.inverse, slope, optimize=True)
        around = value / t.x[0][:, :, None, None]
        return value, np.concatenate([around[None], gradient])

    def densities(self, material, value, g):
        """Return the energies of all pairs: trace, shearing and mass, each (m, q, P); the stress
        functions; and Lame's constants.
        """
        trace = np.einsum("ipjq,jmuqk->imupk", self.trace, g, optimize=True)
        shearing = np.einsum("ipjq,jmuqk->imupk", self.shearing, g, optimize=True)
        first = g[..., self.first]
        e_trace = np.einsum("imupk,imupk->muk", first, trace[..., self.second])
        e_shear = np.einsum("imupk,imupk->muk", first, shearing[..., self.second])
        heavy = np.einsum(
            "mupk,mupk,p->muk", value[..., self.first], value[..., self.second], self.family.share
        )
        mu = material.shear_modulus
        lame = 2 * mu * material.nu / (1 - 2 * material.nu)
        return e_trace, e_shear, heavy, lame * trace + mu * shearing, lame, mu

    def volume(self) -> None:
        """Add derivatives by shape and material, and the forces of rigid seats, from all cells."""
        work, flat = self.work, self.adjoint.flat
        shape, dshape = reference(ElementQuad1(), work.points)
        for part, material, t, dv in work.batches():
            segments = flat.segment[part]
            w = self.family.weight(t.x[0], dv)[:, :, None]
            value, g = self.fields(t, part)
            e_trace, e_shear, heavy, stress, lame, mu = self.densities(material, value, g)
            mass = self.lam * heavy
            e = lame * e_trace + mu * e_shear - material.density * mass
            g_a, g_b = g[..., self.first], g[..., self.second]
            s_a, s_b = stress[..., self.first], stress[..., self.second]
            # product of gradient j of a state with stress i of its partner, both ways
            t_ij = np.einsum("jmupk,imupk->ijmuk", g_a, s_b, optimize=True)
            t_ij = t_ij + np.einsum("jmupk,imupk->ijmuk", g_b, s_a, optimize=True)
            r = t.x[0][:, :, None]
            radial = w * (self.family.power * e - t_ij[0, 0]) / r
            spread = -t_ij[1:, 1:] * w
            for i in range(2):
                spread[i, i] += w * e
            slope = np.einsum("bdq,dimq->bimq", dshape, t.inverse, optimize=True)
            force = np.einsum("bimq,ijmqk->jbmk", slope, spread, optimize=True)
            force[0] += np.einsum("bq,mqk->bmk", shape, radial, optimize=True)
            force *= -self.scale
            for k, push in enumerate(self.pushes):
                for j in range(2):
                    np.add.at(push.nodes[j], flat.cells[:, part], force[j, :, :, k])
                for rate, density, sign in (
                    (push.lame, e_trace, -1.0),
                    (push.shear, e_shear, -1.0),
                    (push.density, mass, 1.0),
                ):
                    of_cells = (w[..., 0] * density[..., k]).sum(axis=1)
                    np.add.at(rate, segments, sign * self.scale[k] * of_cells)
            if self.rigid:
                self._hold(part, material, t, w, value, stress)
        for side in (1, 0):
            self._surface(side)

    def _hold(self, part, material, t, w, value, stress) -> None:
        """Add forces of the cells on the functions of their corners."""
        lam = np.array([state.eigenvalue for state, _, _ in self.columns])
        pull = stress[0] / t.x[0][:, :, None, None]
        pull = pull - material.density * lam * self.family.share[:, None] * value
        gradient = np.einsum("bdq,dimq->bimq", t.slope[:4], t.inverse)
        out = np.einsum("bq,mqpk->bmpk", t.value[:4], pull * w[..., None])
        out += np.einsum("bimq,imqpk->bmpk", gradient, stress[1:] * w[..., None])
        np.add.at(self.residual, self.work.dofs[:4][:, part], out)

    def _surface(self, side: int) -> None:
        """Add the energy on surfaces beside joints, by the radius at both ends of a cell."""
        flat, work = self.adjoint.flat, self.work
        cells = self.adjoint.sides[side]
        sign = 1.0 if side else -1.0
        for index in np.flatnonzero(self._joints(side)):
            cell = cells[index : index + 1]
            t = work.on_edge(cell, 0, float(side))
            dy = t.tangent[:, :, 1, 1] * work.gw
            value, g = self.fields(t, cell)
            material = self.adjoint.scene.segments[int(flat.segment[cell[0]])].material
            e_trace, e_shear, heavy, _, lame, mu = self.densities(material, value, g)
            e = lame * e_trace + mu * e_shear - material.density * self.lam * heavy
            e = e * self.family.weight(t.x[0], dy)[:, :, None]
            for end, hat in enumerate((1 - work.g, work.g)):
                rates = -sign * self.scale * np.einsum("q,mqk->k", hat, e)
                for k, push in enumerate(self.pushes):
                    push.surface[1 - side][index, end] += rates[k]

    def _joints(self, side: int) -> np.ndarray:
        """Return the mask of surface cells that touch a joint without a step."""
        edges = [
            e.y
            for e in self.adjoint.scene.outline.edges
            if e.surface == ("outer" if side else "bore") and not e.steps and e.before > 0
        ]
        flat = self.adjoint.flat
        y = flat.points[1][flat.cells[:, self.adjoint.sides[side]]]
        tol = 1e-9 * self.adjoint.scene.length
        near = [(np.abs(y - edge).min(axis=0) < tol) for edge in edges]
        return np.any(near, axis=0) if near else np.zeros(y.shape[1], bool)

    def ports(self) -> None:
        """Add the terms of the rows of ports: F' dB u of both states."""
        if self.family.waves not in (TORSION, 0, 1):
            return
        if self.rigid:
            self._unload()
        for k, (push, scale) in enumerate(zip(self.pushes, self.scale)):
            first, second = self.first[k], self.second[k]
            for forced, moved in ((first, second), (second, first)):
                for p in range(len(self.adjoint.stations)):
                    self._row(p, forced, moved, push, scale)

    def _unload(self) -> None:
        """Subtract from the forces on rigid seats those of other ports there."""
        for p, (station, attachment) in enumerate(self.adjoint.stations):
            if attachment == "rigid":
                continue
            rows = self.work.mean(self.family, station, attachment)
            for k, (state, index, _) in enumerate(self.columns):
                force = in_plane(self.adjoint.body, index, state.forces)[p]
                self.residual[..., k] -= (force @ rows).reshape(-1, 3)

    def _row(self, p: int, forced: int, displaced: int, push: Push, scale: float) -> None:
        """Add derivatives by one port under the forces of one column and the displacement of another."""
        station, attachment = self.adjoint.stations[p]
        state, index, _ = self.columns[forced]
        force = in_plane(self.adjoint.body, index, state.forces)[p]
        moved = in_plane(self.adjoint.body, index, self.columns[displaced][0].motions)[p]
        if attachment == "rigid":
            if self.family.waves == 1:
                self._rigid(p, station, forced, moved, push, scale)
            return
        if not force.any():
            return
        work, flat = self.work, self.adjoint.flat
        value, r, h, weight, dofs, cells, ends = work.surface(station, attachment)
        u = np.einsum("bq,bec->eqc", value, self.u[dofs][..., displaced])
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
            residual = u[..., -1] - moved[0]
            density, by_r = g * r**power * residual, g * power * r ** (power - 1) * residual
            by_h = np.zeros_like(residual)
        corner = flat.cells[list(ends)][:, cells]
        side = flat.points[:, corner[1]] - flat.points[:, corner[0]]
        length = np.hypot(*side)
        total = (weight * density).sum(axis=1)
        for end, hat, sign in ((0, 1 - work.g, -1.0), (1, work.g, 1.0)):
            for j, by_place in ((0, by_r), (1, by_h)):
                rates = (weight * by_place) @ hat + sign * total * side[j] / length**2
                np.add.at(push.nodes[j], corner[end], scale * rates)
        push.planes[p] -= scale * (weight * by_h).sum()
        if attachment == "average":
            # per length along the axis, at the two ends of the seat
            rate = density * (length / np.abs(side[1]))[:, None]
            lines = flat.points[1][corner]
            low, high = int(lines[0].argmin()), int(lines[1].argmax())
            basis = np.polynomial.legendre.Legendre
            for end, cell, sign, place in ((0, low, -1.0, 0.0), (1, high, 1.0, 1.0)):
                fit = basis.fit(work.g, rate[cell], len(work.g) - 1, domain=[0, 1])
                push.ends[p, end] += sign * scale * float(fit(place))

    def _rigid(self, p, station, forced, moved, push: Push, scale) -> None:
        """Add derivatives by a rigid seat, which takes its nodes along as they lie about the port."""
        work, flat = self.work, self.adjoint.flat
        cells, direction, value = work.side(station, "rigid")
        nodes = np.unique(flat.cells[list(EDGE_ENDS[direction, value])][:, cells])
        corner = {int(n): int(d) for n, d in zip(flat.cells.ravel(), work.dofs[:4].ravel())}
        forces = self.residual[[corner[int(n)] for n in nodes]][..., forced]
        push.nodes[1][nodes] -= scale * forces[:, 0] * moved[1]
        push.planes[p] += scale * forces[:, 0].sum() * moved[1]
        push.nodes[0][nodes] += scale * forces[:, 2] * moved[1]


def rings(scene, flat) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return, for the corners of the cells of every segment, their share of its length, and the
    radii at its two ends of the mesh lines that they lie on.
    """
    _, left, right = radial_bands(scene.outline)
    out = []
    for k, s in enumerate(scene.segments):
        corner = flat.cells[:, flat.segment == k]
        r, y = flat.points[:, corner]
        t = (y - s.y0) / s.length
        ends = np.empty((2, *t.shape))
        for share in np.unique(t):
            column = t == share
            radii = (1 - share) * left[k] + share * right[k]
            ends[:, column] = [
                np.interp(r[column], radii, side[: len(radii)]) for side in (left[k], right[k])
            ]
        out.append((t, *ends))
    return out


#: places of seats that lines of the mesh follow
FOLLOWED = {"section": ("y",), "rigid": ("lo", "hi"), "average": ("lo", "hi")}


class Motion:
    """Motion of nodes, seats and materials of a harmonic body with one parameter, from the scene a
    little before and after it; refused where places of one mesh line move apart and a rigid or
    section port lies there.
    """

    def __init__(self, adjoint: HarmonicAdjoint, low: Scene, high: Scene, step: float):
        self.low, self.high, self.step = coned(low), coned(high), step
        self.adjoint = adjoint
        self.segment = rates(self.low.segments, self.high.segments, SHAPE, step)
        self.station = rates(self.low.stations, self.high.stations, SEAT, step)
        if len(self.segment) != len(adjoint.scene.segments):
            raise SolidgearError("the shaft takes another form there")

    def radial(self, axial: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the radial velocity (4, m) of the corners of cells by their segment, and the mean
        (n,) at the nodes.
        """
        adjoint, flat, scene = self.adjoint, self.adjoint.flat, self.adjoint.scene
        by_segment = np.zeros(flat.cells.shape)
        for k, s in enumerate(scene.segments):
            cells = np.flatnonzero(flat.segment == k)
            corner = flat.cells[:, cells]
            t, left, right = adjoint.rings[k]
            y0, y1, *_ = self.segment[k]
            rate = (1 - t) * self._across(k, 0, left) + t * self._across(k, 1, right)
            # a node that slides along a cone follows it
            slope = (right - left) / s.length
            by_segment[:, cells] = rate + slope * (axial[corner] - (1 - t) * y0 - t * y1)
        count, total = np.zeros((2, flat.points.shape[1]))
        for k in range(len(scene.segments)):
            # once a segment, however many cells of it meet there
            cells = np.flatnonzero(flat.segment == k)
            nodes, first = np.unique(flat.cells[:, cells].ravel(), return_index=True)
            count[nodes] += 1
            total[nodes] += by_segment[:, cells].ravel()[first]
        return by_segment, total / count

    def _across(self, k: int, end: int, r: np.ndarray) -> np.ndarray:
        """Return the radial velocity on an end of a segment, at radii r."""
        segments = self.adjoint.scene.segments
        sides = [(k, end)] + [(j, 1 - end) for j in (k + 2 * end - 1,) if 0 <= j < len(segments)]
        marks: dict[float, float] = {}
        for j, side_end in sides:
            for name, column in (("inner", 4), ("outer", 2)):
                place = getattr(segments[j], f"{name}{side_end}")
                if not any(abs(place - m) < TOUCH for m in marks):
                    marks[place] = self.segment[j, column + side_end]
        marks.setdefault(0.0, 0.0)
        places = np.array(sorted(marks))
        return np.interp(r, places, [marks[m] for m in places])

    def derivative(self, push: Push) -> float:
        """Return the derivative of a number by the parameter, without actions on ports."""
        if not self.segment.any() and not self.station.any():
            return self._matter(push)
        velocity, slip, bulge = self.moved
        total = float((push.nodes * velocity).sum() + push.planes @ self.station[:, 0])
        total += float((push.ends * slip).sum())
        total += sum(float((rates * out).sum()) for rates, out in zip(push.surface, bulge))
        return total + self._matter(push)

    @cached_property
    def moved(self) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
        """Velocity of the nodes, and beyond it the slip of seat ends and the bulge of surfaces."""
        adjoint, flat = self.adjoint, self.adjoint.flat
        lines, moved = line_velocities(
            adjoint.scene, adjoint.stations, self.segment, self.station, FOLLOWED
        )
        axial = np.interp(flat.points[1], lines, moved)
        by_segment, mean = self.radial(axial)
        seats = self.station[:, 1:] - np.array(
            [np.interp([s.lo, s.hi], lines, moved) for s, _ in adjoint.stations]
        )
        averaged = np.array([a == "average" for _, a in adjoint.stations])
        slip = np.where(averaged[:, None], seats, 0.0)
        beyond = by_segment - mean[flat.cells]
        outer, bore = beyond[[1, 2]][:, adjoint.sides[1]], beyond[[0, 3]][:, adjoint.sides[0]]
        surface_y = flat.points[1][flat.cells[[1, 2]][:, adjoint.sides[1]]]
        bulging = {float(y) for y in surface_y[np.abs(outer) > 1e-9]}
        tol = 1e-9 * adjoint.scene.length
        for s, attachment in adjoint.stations:
            if attachment != "section" and any(s.lo - tol <= y <= s.hi + tol for y in bulging):
                raise SolidgearError(f"the surface under {s.name} splits in two")
        return np.array([mean, axial]), slip, [outer.T, bore.T]

    def _matter(self, push: Push) -> float:
        out = 0.0
        for k, segments in enumerate(zip(self.low.segments, self.high.segments)):
            a, b = (segment.material for segment in segments)
            if a == b:
                continue
            mu = [m.shear_modulus for m in (a, b)]
            lame = [2 * g * m.nu / (1 - 2 * m.nu) for g, m in zip(mu, (a, b))]
            out += push.lame[k] * (lame[1] - lame[0]) + push.shear[k] * (mu[1] - mu[0])
            out += push.density[k] * (b.density - a.density)
        return out / self.step
