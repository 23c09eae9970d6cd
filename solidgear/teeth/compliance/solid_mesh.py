r"""One pitch of a toothed wheel in 3D: curved hexahedra, swept along the helix from the plane mesh.

The plane mesh lies at z = 0; at z it is turned clockwise by ``twist z`` with ``twist = tan beta / r``,
so that a point of the involute keeps to its helix, and the right side of a pitch covers the left one
of the next after a turn by the pitch angle.  Middle nodes of cells lie on flank and fillet as those of
the plane mesh do, and on helices between the layers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from skfem import ElementQuadS2, MeshHex
from skfem.refdom import RefHex

from solidgear.core.errors import SolidgearError
from solidgear.core.kernel.assembly import reference, unknowns
from solidgear.core.meshing.lobatto import gauss
from solidgear.core.models.solid.mesh import SolidMesh, basis_of
from solidgear.teeth.compliance.mesh import PitchMesh

#: element that teeth are made of
NAME = "hex20"
#: coordinates of the nodes of a quadrilateral: corners, then middles of sides
FLAT = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]])
#: points of quadrature along z within a cell and a slice
ALONG = 3
#: distance from a cell, in its size, at which a point counts as inside: between nodes a flank departs
#: from the parabola through them by the cube of their distance over its radius
EDGE = 0.01
#: cells near a point that are tried for it, and steps of Newton's method in each
NEAR, STEPS = 12, 15


def turned(points: np.ndarray, angle: np.ndarray | float) -> np.ndarray:
    """Return points or vectors (..., 2) turned clockwise by angles (...), rad."""
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y = points[..., 0], points[..., 1]
    return np.stack([cosine * x + sine * y, -sine * x + cosine * y], axis=-1)


def directions(angles: np.ndarray) -> np.ndarray:
    """Return unit vectors (..., 2) at angles (...) clockwise from +y, rad."""
    return np.stack([np.sin(angles), np.cos(angles)], axis=-1)


@dataclass(frozen=True, eq=False)
class SweptPitch:
    """One pitch of a wheel, swept along its face.

    Nodes are named by their node in the plane and their level along z: ends of layers have even
    levels, middles of layers odd ones.
    """

    plane: PitchMesh
    ends: np.ndarray  #: (layers + 1,) ends of the layers along z, m
    twist: float  #: clockwise turn by length along z, rad/m

    @property
    def layers(self) -> int:
        """Number of cells along the face."""
        return len(self.ends) - 1

    @cached_property
    def levels(self) -> np.ndarray:
        """(2 layers + 1,) z of the levels, m."""
        levels = np.empty(2 * self.layers + 1)
        levels[::2], levels[1::2] = self.ends, (self.ends[:-1] + self.ends[1:]) / 2
        return levels

    @cached_property
    def solid(self) -> SolidMesh:
        """Mesh of the pitch."""
        return self._solid_and_numbers[0]

    @property
    def numbers(self) -> np.ndarray:
        """(plane nodes, levels) numbers of the nodes, -1 where there is none."""
        return self._solid_and_numbers[1]

    @cached_property
    def _solid_and_numbers(self) -> tuple[SolidMesh, np.ndarray]:
        corners, count = self.plane.corners, len(self.plane.points)
        flat, level = self._names(RefHex.p.T)
        layer = np.arange(self.layers)[:, None, None]
        cells = corners[:, flat % 4] + count * (layer + level // 2)
        used, compact = np.unique(cells, return_inverse=True)
        places = self.places(self.plane.points[used % count], self.ends[used // count])
        mesh = MeshHex(places.T.copy(), np.ascontiguousarray(compact.reshape(-1, 8).T, np.int32))
        element = basis_of(NAME)
        dofs = unknowns(mesh, element)
        flat, level = self._names(element.doflocs)
        of_plane = np.broadcast_to(
            self.plane.cells[:, flat], (self.layers, len(corners), len(flat))
        )
        of_level = np.broadcast_to(2 * layer + level, of_plane.shape)
        numbers = np.full((count, len(self.levels)), -1)
        numbers[of_plane, of_level] = dofs.T.reshape(of_plane.shape)
        node, level_of = np.nonzero(numbers >= 0)
        nodes = np.empty((3, int(dofs.max()) + 1))
        nodes[:, numbers[node, level_of]] = self.places(
            self.plane.points[node], self.levels[level_of]
        ).T
        return SolidMesh(mesh, NAME, element, dofs, nodes, np.zeros(mesh.nelements, int)), numbers

    def _names(self, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the node of the quadrilateral (k,), and the level in the layer (k,), of nodes (k, 3)
        of a cell.
        """
        near = np.abs(local[:, None, :2] - FLAT).max(axis=2) < 0.25
        return near.argmax(axis=1), np.rint(2 * local[:, 2]).astype(int)

    def places(self, points: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the places (..., 3) of points (..., 2) of the plane, swept to some z (...), m."""
        flat = turned(points, self.twist * z)
        return np.concatenate([flat, np.broadcast_to(z, flat.shape[:-1])[..., None]], axis=-1)

    def nodes_of(self, plane_nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the nodes (k,) above some of the plane, the index of each among these, and its level;
        in the same order for the left and the right side.
        """
        index, level = np.nonzero(self.numbers[plane_nodes] >= 0)
        return self.numbers[plane_nodes[index], level], index, level

    def inner(self, holds: bool) -> np.ndarray:
        """Return the (i,) unknowns neither on a side nor, where it is held, on the cylinder that ends
        the rim.
        """
        inner = np.ones(self.solid.nodes.shape[1], bool)
        for nodes in (*self.plane.sides, *([self.plane.circle] if holds else [])):
            inner[self.nodes_of(nodes)[0]] = False
        return (3 * np.flatnonzero(inner)[:, None] + np.arange(3)).ravel()

    def side_motions(self, pitch: float, power: int, holds: bool) -> sp.csr_matrix:
        """Return the (3 n, 2 q) motions of the unknowns of both sides, which are polynomials along z
        above each node of the plane, by those of the left side and of the next left side at the
        pitch angle; the end of the rim does not move where it is held.
        """
        sides = self.plane.sides[:, :-1] if holds else self.plane.sides
        turn = np.eye(3)
        turn[:2, :2] = turned(np.eye(2), pitch).T
        parts = []
        for side, frame in zip(sides, (np.eye(3), turn)):
            nodes, index, level = self.nodes_of(side)
            z = self.levels[level] / np.abs(self.ends).max()
            powers = np.polynomial.legendre.legvander(z, power)
            columns = index[:, None] * (power + 1) + np.arange(power + 1)
            rows = np.broadcast_to(nodes[:, None], columns.shape)
            size = (self.solid.nodes.shape[1], len(side) * (power + 1))
            motion = sp.csr_matrix((powers.ravel(), (rows.ravel(), columns.ravel())), shape=size)
            parts.append(sp.kron(motion, frame))
        return sp.hstack(parts).tocsr()

    def inside(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the cell of the plane (k,) that each point (k, 2) lies in and its coordinates there
        (k, 2); SolidgearError for points outside all.
        """
        nodes = self.plane.points[self.plane.cells[:, : len(FLAT)]]
        far = ((points[:, None] - nodes.mean(axis=1)) ** 2).sum(axis=-1)
        best = np.full(len(points), np.inf)
        cell, place = np.zeros(len(points), int), np.zeros((len(points), 2))
        for candidate in np.argsort(far, axis=1)[:, :NEAR].T:
            local = _inverted(nodes[candidate], points)
            outside = np.abs(local - 0.5).max(axis=1) - 0.5
            better = outside < best
            best[better], cell[better] = outside[better], candidate[better]
            place[better] = local[better]
        if best.max() > EDGE:
            raise SolidgearError("teeth: a place below the flank lies outside the mesh")
        return cell, np.clip(place, 0.0, 1.0)

    def means(self, slices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return places along z (p,), their weights and slices, for means over slices of the face with
        ends (s + 1,), m; pieces of slices beyond the face count as its end.
        """
        x, w = gauss(ALONG)
        places, weights, numbers = [], [], []
        for number, (low, high) in enumerate(zip(slices, slices[1:])):
            inner = self.ends[(self.ends > low) & (self.ends < high)]
            edges = np.concatenate([[low], inner, [high]])
            steps = np.diff(edges)[:, None]
            places.append((edges[:-1, None] + steps * x).ravel())
            weights.append((steps * w).ravel() / (high - low))
            numbers.append(np.full(steps.size * ALONG, number))
        return np.concatenate(places), np.concatenate(weights), np.concatenate(numbers)

    def rows(
        self,
        cells: np.ndarray,
        local: np.ndarray,
        z: np.ndarray,
        directions: np.ndarray,
        weights: np.ndarray,
        numbers: np.ndarray,
    ) -> sp.csr_matrix:
        """Return rows that read motions at places, weighed and summed up.

        Parameters
        ----------
        cells, local, z : (p,), (p, 2), (p,) ndarray
            Cells of the plane and coordinates in them, and places along the face, m.
        directions : (p, 3) ndarray
            In which motions are read.
        weights, numbers : (p,) ndarray
            Weight of each place, and the row that it belongs to.

        Returns
        -------
        (rows, 3 n) csr_matrix
        """
        shape, nodes = self.shapes(cells, local, z)
        values = shape * weights * directions.T[:, None]
        columns = 3 * nodes + np.arange(3)[:, None, None]
        rows = np.broadcast_to(numbers, values.shape)
        size = (int(numbers.max()) + 1, 3 * self.solid.nodes.shape[1])
        return sp.csr_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape=size)

    def shapes(
        self, cells: np.ndarray, local: np.ndarray, z: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the functions (nb, p) of the mesh at places as for :meth:`rows`, or the nearest ones
        of the face, and their nodes (nb, p).
        """
        z = np.clip(z, self.ends[0], self.ends[-1])
        layer = np.minimum(np.searchsorted(self.ends, z, side="right"), self.layers) - 1
        third = (z - self.ends[layer]) / np.diff(self.ends)[layer]
        shape, _ = reference(self.solid.element, np.column_stack([local, third]).T)
        return shape, self.solid.dofs[:, layer * len(self.plane.cells) + cells]


def _inverted(nodes: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return the coordinates (k, 2) of points (k, 2) in cells with nodes (k, 8, 2), far outside where
    there are none.
    """
    local = np.full((len(points), 2), 0.5)
    for _ in range(STEPS):
        value, slope = _serendipity(local)
        miss = points - np.einsum("kb,kbi->ki", value, nodes)
        step = np.linalg.solve(np.einsum("kbj,kbi->kij", slope, nodes), miss[..., None])
        local = np.clip(local + step[..., 0], -1.0, 2.0)
    return local


def _serendipity(local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the functions (k, 8) of a quadrilateral of eight nodes at coordinates (k, 2), and their
    gradients (k, 8, 2).
    """
    value, slope = reference(ElementQuadS2(), local.T)
    return value.T, slope.transpose(2, 0, 1)
