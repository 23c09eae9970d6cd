r"""Two whole spur gears of which every tooth is meshed, in contact, in plane strain.

Pitches whose teeth may touch have cells finer than the width of contact on their flanks, the others
coarse ones; all are joined to a ring along their sides.  The bore of the second wheel is held, that of
the first turns about its centre.

**Contact** is resolved: no law of Hertz is in it, and no depth.  The pressure on the first wheel's
flanks is linear between nodes, phi_i p_i; with quadratic cells the second wheel has the same pressure
where the first one's normal meets it.  What is asked of the gap is its mean under each phi_i,

    int phi_i (u_1 + u_2 + g - theta rb_1) ds >= 0,    p_i >= 0,    one of both zero,

with motions u along the normals into each wheel and the torque ``rb_1 int p ds`` (the mortar method:
Wohlmuth, Acta Numerica 20, 2011, p. 569-734).  The motions are those of a wheel's flank nodes under
unit forces on them, solved once.

**Gaps** are exact: involutes of one base circle are parallel curves, so that a point at the clockwise
angle delta from a flank is ``rb delta`` away from it along the normal.  Arcs of an involute grow with
the squared radius, ``ds = d(r^2) / (2 rb)``, and so do the cells of a flank.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree
from skfem import Basis, ElementQuad2, ElementVector, MeshQuad1, MeshQuad2
from skfem.models.elasticity import lame_parameters, linear_elasticity

from solidgear.core.gears.flank_shape import FlankShape
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.core.solve.factor import factorise
from solidgear.teeth.compliance.mesh import Fineness, PitchMesh, pitch_mesh
from solidgear.teeth.compliance.solid_mesh import turned

YOUNGS, POISSON = 2.06e11, 0.3
#: cells of teeth that may touch, and of all others, which share the rows of the rim
FINE = Fineness(fillet=8, flank=80, across=12)
COARSE = Fineness(fillet=4, flank=6, across=6)
#: contact lines that may carry within half a pitch of the pitch point, on both sides
LINES = (-1, 0, 1)
#: distance at which nodes of two pitches are the same, m
SAME = 1e-9
#: points of Gauss between two nodes; widest gap that may close, m; least share of a node's length
GAUSS, WIDEST, SLIVER = 6, 1e-4, 1e-3
#: changes of the nodes that touch
MOST_STEPS = 60


@dataclass(frozen=True, eq=False)
class WholeGear:
    """All pitches of a wheel, joined, tooth 0 on +y."""

    wheel: Wheel
    shape: FlankShape
    points: np.ndarray  #: (n, 2) m
    cells: np.ndarray  #: (m, 9) nodes as of ``ElementQuad2``, corners counter-clockwise
    #: tooth -> (k,) nodes of its right flank from the fillet to the tip, of teeth that may touch
    flanks: dict[int, np.ndarray]
    bore: np.ndarray  #: (b,) nodes

    @property
    def arcs(self) -> np.ndarray:
        """(k,) arcs of the flank nodes along the involute, from its base circle, m."""
        wheel = self.wheel
        count = len(next(iter(self.flanks.values())))
        squares = np.linspace(wheel.form**2, wheel.tip**2, count)
        return (squares - wheel.base**2) / (2 * wheel.base)

    @cached_property
    def compliance(self) -> np.ndarray:
        """(t k, t k) motion of all flank nodes into the teeth, with the bore held, per force and face
        width, m per N/m; tooth by tooth.
        """
        corners = np.unique(self.cells[:, :4])
        number = np.full(len(self.points), -1)
        number[corners] = np.arange(len(corners))
        straight = MeshQuad1(self.points[corners].T, number[self.cells[:, :4]].T)
        mesh = MeshQuad2.from_mesh(straight)
        mesh.doflocs[:, mesh.dofs.element_dofs] = self.points[self.cells].transpose(2, 1, 0)
        basis = Basis(mesh, ElementVector(ElementQuad2()), intorder=7)
        stiffness = linear_elasticity(*lame_parameters(YOUNGS, POISSON)).assemble(basis)
        unknowns = np.empty((len(self.points), 2), int)
        unknowns[self.cells] = basis.element_dofs.T.reshape(-1, 9, 2)
        free = np.setdiff1d(np.arange(basis.N), unknowns[self.bore])
        radii = np.sqrt(2 * self.wheel.base * self.arcs + self.wheel.base**2)
        _, normals = self.wheel.flank_points(radii)
        directions = np.concatenate(
            [turned(normals, k * self.wheel.pitch_angle) for k in self.flanks]
        )
        columns = unknowns[np.concatenate(list(self.flanks.values()))]
        rows = np.broadcast_to(np.arange(len(columns))[:, None], columns.shape)
        entries = (directions.ravel(), (rows.ravel(), columns.ravel()))
        forces = sp.csr_matrix(entries, shape=(len(columns), basis.N))[:, free]
        factor = factorise(stiffness[free][:, free].tocsr())
        out = np.hstack(
            [
                forces @ factor.solve(forces[start : start + 64].T.toarray())
                for start in range(0, len(columns), 64)
            ]
        )
        return (out + out.T) / 2


def whole_gear(
    wheel: Wheel,
    hold: float,
    shape: FlankShape,
    teeth: Sequence[int],
    fineness: tuple[Fineness, Fineness] = (FINE, COARSE),
) -> WholeGear:
    """Mesh all pitches of a wheel, those of some teeth finely and with the shape of their flanks."""
    fine, coarse = (pitch_mesh(wheel, hold, f) for f in fineness)
    fine = _modified(fine, wheel, shape)
    fine_teeth = {k % wheel.count: k for k in teeth}
    pitches = [fine if k in fine_teeth else coarse for k in range(wheel.count)]
    starts = np.cumsum([0, *(len(mesh.points) for mesh in pitches)])
    points = np.concatenate(
        [turned(mesh.points, k * wheel.pitch_angle) for k, mesh in enumerate(pitches)]
    )
    # nodes of shared sides lie on each other
    first = np.arange(len(points))
    for a, b in sorted(cKDTree(points).query_pairs(SAME)):
        first[b] = first[a]
    remaining, joined = np.unique(first, return_inverse=True)
    return WholeGear(
        wheel,
        shape,
        points[remaining],
        np.concatenate([joined[mesh.cells + n] for mesh, n in zip(pitches, starts)]),
        {k: joined[fine.flank + starts[place]] for place, k in fine_teeth.items()},
        np.unique(np.concatenate([joined[mesh.circle + n] for mesh, n in zip(pitches, starts)])),
    )


def _modified(mesh: PitchMesh, wheel: Wheel, shape: FlankShape) -> PitchMesh:
    """Return a pitch whose right flank misses what its shape says."""
    points = mesh.points.copy()
    length = np.sqrt(np.maximum(mesh.radii**2 - wheel.base**2, 0.0))
    _, normals = wheel.flank_points(mesh.radii)
    points[mesh.flank] += shape.deviation(length, 0.0)[:, None] * normals
    return replace(mesh, points=points)


@dataclass(frozen=True, eq=False)
class FlankContact:
    """Weak contact of the flanks at one position, rows by nodes of the first wheel that may touch."""

    first: np.ndarray  #: (n, t k) pressure to forces on the flank nodes of the first wheel
    second: np.ndarray  #: (n, t k) of the second wheel
    length: np.ndarray  #: (n,) m
    gap: np.ndarray  #: (n,) gap times length, m^2


@dataclass(frozen=True, eq=False)
class WholePair:
    """Two whole gears in contact; the second wheel is held at its bore."""

    wheels: WheelPair
    gears: tuple[WholeGear, WholeGear]

    @classmethod
    def of(
        cls,
        wheels: WheelPair,
        holds: tuple[float, float],
        shapes: tuple[FlankShape, FlankShape],
        fineness: tuple[Fineness, Fineness] = (FINE, COARSE),
    ) -> WholePair:
        """Mesh both wheels with bores of given radii, m."""
        first, second = (
            whole_gear(wheel, hold, shape, [sense * k for k in LINES], fineness)
            for wheel, hold, shape, sense in zip(
                (wheels.first, wheels.second), holds, shapes, (1, -1)
            )
        )
        return cls(wheels, (first, second))

    def turns(self, phase: float) -> tuple[float, float]:
        """Return by what both wheels are turned clockwise at a position in pitches, rad."""
        pair = self.wheels
        first, second = pair.first, pair.second
        radii = pair.first_radius(pair.pitch_point), pair.second_radius(pair.pitch_point)
        return (
            phase * first.pitch_angle - float(first.half_angle(radii[0])),
            np.pi - phase * second.pitch_angle - float(second.half_angle(radii[1])),
        )

    def rotation(self, phase: float, torque: float) -> float:
        """Return the rotation of the first bore under a torque per face width, N, at a position from
        minus a half to a half pitch, rad.
        """
        contact = self._contact(phase)
        first, second = (gear.compliance for gear in self.gears)
        matrix = (
            contact.first @ first @ contact.first.T + contact.second @ second @ contact.second.T
        )
        lever = self.wheels.first.base * contact.length
        _, rotation = _pressure(matrix, contact, lever, torque)
        return rotation

    def _contact(self, phase: float) -> FlankContact:
        parts = [self._line(k, phase) for k in LINES]
        first, second, length, gap = (np.concatenate([part[j] for part in parts]) for j in range(4))
        full = float(np.diff(self.gears[0].arcs).min())
        chosen = length > SLIVER * full
        return FlankContact(first[chosen], second[chosen], length[chosen], gap[chosen])

    def _line(self, k: int, phase: float) -> tuple[np.ndarray, ...]:
        """Return forces on both wheels, lengths and gaps of one pair of teeth by nodes of the first."""
        driver, driven = self.gears
        wheel, mate = driver.wheel, driven.wheel
        nodes = driver.arcs
        place, weight = _quadrature(nodes)
        roll = np.sqrt(2 * wheel.base * place)
        r = np.hypot(wheel.base, roll)
        turns = self.turns(phase)
        angle = turns[0] + k * wheel.pitch_angle + wheel.half_angle(r)
        x, y = r * np.sin(angle), r * np.cos(angle) - self.wheels.distance
        mate_roll = np.sqrt(np.maximum(x**2 + y**2 - mate.base**2, 0.0))
        centre = turns[1] - k * mate.pitch_angle
        ahead = np.arctan2(x, y) - centre - mate.half_angle(np.hypot(x, y))
        parted = mate.base * ((ahead + np.pi) % (2 * np.pi) - np.pi)
        mate_roll = mate_roll - parted
        gap = parted + driver.shape.deviation(roll, 0.0) + driven.shape.deviation(mate_roll, 0.0)
        mate_place = mate_roll**2 / (2 * mate.base)
        mate_nodes = driven.arcs
        meets = (gap < WIDEST) & (mate_place > mate_nodes[0]) & (mate_place < mate_nodes[-1])
        place, weight, gap, mate_place = (v[meets] for v in (place, weight, gap, mate_place))
        tested = _hats(nodes, place) * weight[:, None]
        forces = []
        for gear, tooth, at in ((driver, k, place), (driven, -k, mate_place)):
            block = np.zeros((len(nodes), len(gear.flanks), len(gear.arcs)))
            block[:, list(gear.flanks).index(tooth)] = tested.T @ _quadratic(gear.arcs, at)
            forces.append(block.reshape(len(nodes), -1))
        return *forces, tested.sum(axis=0), tested.T @ gap


def _quadrature(nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return points and weights of Gauss between all nodes."""
    points, weights = np.polynomial.legendre.leggauss(GAUSS)
    half = np.diff(nodes)[:, None] / 2
    middle = (nodes[:-1] + nodes[1:])[:, None] / 2
    return (middle + half * points).ravel(), (half * weights).ravel()


def _hats(nodes: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return the (q, n) linear functions of equally spaced nodes at places."""
    steps = (place[:, None] - nodes) / (nodes[1] - nodes[0])
    return np.maximum(1 - np.abs(steps), 0.0)


def _quadratic(nodes: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return the (q, n) functions of quadratic cells at places; every second node is a middle."""
    width = nodes[2] - nodes[0]
    cell = np.clip(((place - nodes[0]) / width).astype(int), 0, len(nodes) // 2 - 1)
    t = (place - nodes[0]) / width - cell
    out = np.zeros((len(place), len(nodes)))
    each = np.arange(len(place))
    shapes = (1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)
    for j, shape in enumerate(shapes):
        out[each, 2 * cell + j] = shape
    return out


def _pressure(
    matrix: np.ndarray, contact: FlankContact, lever: np.ndarray, torque: float
) -> tuple[np.ndarray, float]:
    """Return pressures, N/m^2, and the rotation, rad, by the nodes that touch: those that pull are
    left out, those that overlap taken in (primal-dual active sets).
    """
    length = contact.length
    # a node at its pressure and one at its overlap weigh alike
    stiff = float(np.mean(length**2 / np.diag(matrix)) / np.mean(length))
    touching = contact.gap / length < 1e-6 + float((contact.gap / length).min())
    for _ in range(MOST_STEPS):
        nodes = np.flatnonzero(touching)
        n = len(nodes)
        bordered = np.zeros((n + 1, n + 1))
        bordered[:n, :n] = matrix[np.ix_(nodes, nodes)]
        bordered[:n, n], bordered[n, :n] = -lever[nodes], lever[nodes]
        scale = np.concatenate([np.ones(n), [bordered[0, 0] / lever[nodes[0]]]])
        right = np.concatenate([-contact.gap[nodes], [torque]])
        solved = np.linalg.solve(bordered * scale, right) * scale
        pressure = np.zeros(len(length))
        pressure[nodes], rotation = solved[:-1], float(solved[-1])
        apart = (matrix @ pressure + contact.gap - lever * rotation) / length
        before, touching = touching, pressure - stiff * apart > 0
        if np.array_equal(before, touching):
            return pressure, rotation
    raise RuntimeError("the nodes that touch did not settle")
