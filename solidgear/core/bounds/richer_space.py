"""The richer space of a harmonic solid, in which the error of the solid is estimated: cells cut
towards corners where stress is singular or a load jumps, functions of higher order, their numbers
and places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from solidgear.core.body import Block, Body, Port
from solidgear.core.bounds.lines import Lines, place_of
from solidgear.core.bounds.singular_places import Place, refuse_unresolved, singular_places
from solidgear.core.meshing.cells import ENDS
from solidgear.core.meshing.corner_layers import cut_towards
from solidgear.core.meshing.lobatto import at_nodes, products
from solidgear.core.meshing.meeting import SAME, least_side
from solidgear.core.meshing.meridian import CUT_RATIO, Meridian, on_side
from solidgear.core.models.harmonic.blocks import EDGE_ENDS, Work
from solidgear.core.models.harmonic.families import Family
from solidgear.core.safety import EXTRA, LAYERS, SHORT

if TYPE_CHECKING:
    from solidgear.core.models.harmonic.mesh import HarmonicMesh
    from solidgear.core.scene import Scene


class RicherSpace:
    """The richer space of a harmonic body that was meshed from a scene; it serves all blocks."""

    #: (count,) mask of functions on the axis
    on_axis: np.ndarray
    #: numbers (m, 4 rich) of the functions of every piece on its corners and sides, and their signs,
    #: where a side runs against its number
    ids: np.ndarray
    signs: np.ndarray
    count: int  #: of functions on corners and sides
    #: (n,) the hat that every vertex of the mesh belongs to
    corner_hat: np.ndarray
    #: pieces and their sides at the seat or plane of every port
    carrying: list[list[tuple[int, int]]]
    #: (count,) mask of the functions that move as a port does, by the ports that are rigid seats
    tied: dict[int, np.ndarray]

    def __init__(self, scene: Scene, body: Body):
        self.scene, self.ports = scene, body.ports  # not the body, which keeps this
        geometry: HarmonicMesh = body.geometry  # type: ignore[assignment]
        self.flat = geometry.meridian  #: the mesh of the body
        self._parent = geometry.parent  #: (ne,) cells before cuts towards corners
        self.order = geometry.order  #: of its elements
        self.rich = self.order + EXTRA  #: order of the richer space
        self._work = Work(scene, geometry)
        self._to_products()
        #: singular places by the vertices there
        self.corners = corner_places(scene, body.ports, self.flat)
        cuts = {v: LAYERS if place.sharp else min(1, LAYERS) for v, place in self.corners.items()}
        lines = Lines(self.flat, ())
        for vertex in self.corners if LAYERS else ():
            # the effect of a corner of a slender cell reaches from its width to its length
            lines.cut_slender(place_of(self.flat.points[:, vertex]))
        across = [np.array([r, y]) for y, r in lines.points]
        self.pieces = cut_towards(self.flat.cells.T, self.flat.points.T, cuts, CUT_RATIO, across)
        self._number()
        self._seats()

    def unseen(self) -> np.ndarray:
        """Return (ne,) the energy of an error over what the richer space sees of it, in cells of the
        mesh: of the cost of a corner of exponent a all but ``q^(2 a n)``, which n cuts of ratio q leave.
        NoBounds where cells cannot be so small that less than half of that cost remains.
        """
        least = least_side(self.scene.length)
        for place in self.corners.values():
            refuse_unresolved(f"{place.what} (y = {1e3 * place.y:.4g} mm)", place.within(least))
        out = np.ones(self.flat.cells.shape[1])
        for vertex, place in self.corners.items():
            if place.sharp:
                around = self._parent[(self.flat.cells == vertex).any(axis=0)]
                left = CUT_RATIO ** (2 * place.exponent * LAYERS)
                beside = np.isin(self._parent, around)
                out[beside] = np.maximum(out[beside], 1 / (1 - left))
        return out

    def _to_products(self) -> None:
        """Set the matrices from the functions of the element to products of Lobatto's, by cell, and
        the shape of every cell in these.
        """
        points, inverse = at_nodes(self.order)
        count = self.flat.cells.shape[1]
        self._up = np.empty((count, len(inverse), len(inverse)))
        self.straight = self.flat.points[:, self.flat.cells].transpose(2, 1, 0)[:, [0, 3, 1, 2]]
        self.curved: dict[int, np.ndarray] = {}
        shapes = self._work.shapes
        for kind in shapes.kinds:
            tabulation = shapes.tabulation(kind, points.T)
            self._up[kind.cells] = inverse @ tabulation.value.T
            if kind.curved:
                place = tabulation.on(shapes.nodes(kind, kind.cells)).x
                for k, cell in enumerate(kind.cells):
                    self.curved[int(cell)] = inverse @ place[:, k].T
        self.bent = np.isin(np.arange(count), list(self.curved))

    def coefficients(self, block: Block, family: Family, u: np.ndarray) -> np.ndarray:
        """Return (ne, (order + 1)^2, c, k) coefficients of (n, k) displacements of a block, in
        products.
        """
        u = u if block.expand is None else block.expand @ u
        full = self._work.geometry.whole(family, u)
        cells = self._up @ full.reshape(len(full), -1)[self._work.dofs.T]
        return cells.reshape(*cells.shape[:2], family.count, -1)

    def places(self, cells: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return (m, q, 2) places, m, of (q, 2) reference points of cells that are all straight or
        all curved.
        """
        if self.bent[cells[0]]:
            shape = np.array([self.curved[int(k)] for k in cells])
            return products(self.order, points)[0].T @ shape
        return products(1, points)[0].T @ self.straight[cells]

    def _number(self) -> None:
        """Number the functions on corners and sides; those inside are never numbered."""
        corners = self.pieces.corners
        pairs = corners[:, np.array(ENDS)]
        edges, which = np.unique(np.sort(pairs, axis=2).reshape(-1, 2), axis=0, return_inverse=True)
        n, per_side = len(self.pieces.points), self.rich - 1
        on_side = n + which.reshape(-1, 4, 1) * per_side + np.arange(per_side)
        self.ids = np.concatenate([corners, on_side.reshape(len(corners), -1)], axis=1)
        self.count = n + len(edges) * per_side
        odd = np.where(np.arange(per_side) % 2 == 1, -1.0, 1.0)
        forward = pairs[..., 0] < pairs[..., 1]
        signs = np.where(forward[..., None], 1.0, odd).reshape(len(corners), -1)
        self.signs = np.concatenate([np.ones((len(corners), 4)), signs], axis=1)
        near = np.abs(self.pieces.points[:, 0]) < 1e-9 * np.abs(self.pieces.points[:, 0]).max()
        self.on_axis = np.concatenate([near, np.repeat(near[edges].all(axis=1), per_side)])

    def _seats(self) -> None:
        """Set the sides that carry loads, the unknowns that rigid seats hold, and the hats that are
        one.
        """
        self.carrying, self.tied = [], {}
        joined = _short_sides(self.flat)
        stations = {s.name: s for s in self.scene.stations}
        for index, port in enumerate(self.ports):
            station = stations[port.name]
            cells, direction, value = self._work.side(station, port.attachment)
            side = ENDS.index(EDGE_ENDS[direction, value])
            self.carrying.append(self._on_side(cells, side))
            if port.attachment == "rigid":
                self.tied[index] = self._functions(self.carrying[-1])
                ends = np.unique(self.flat.cells[list(ENDS[side])][:, cells])
                joined += [np.array([ends[0], v]) for v in ends[1:]]
        self.corner_hat = _united(self.flat.points.shape[1], joined)

    def _on_side(self, cells: np.ndarray, side: int) -> list[tuple[int, int]]:
        """Return pieces and their sides that lie on a side of some cells."""
        out = []
        for piece in np.flatnonzero(np.isin(self.pieces.parent, cells)):
            corners = on_side(self.pieces.local[piece], side)
            out += [(int(piece), k) for k, (a, b) in enumerate(ENDS) if corners[a] and corners[b]]
        return out

    def _functions(self, sides: list[tuple[int, int]]) -> np.ndarray:
        """Return (count,) a mask of the functions that do not vanish on some sides of pieces."""
        mask, per_side = np.zeros(self.count, bool), self.rich - 1
        for piece, k in sides:
            mask[self.ids[piece, list(ENDS[k])]] = True
            mask[self.ids[piece, 4 + k * per_side : 4 + (k + 1) * per_side]] = True
        return mask


def _short_sides(flat: Meridian) -> list[np.ndarray]:
    """Return the ends of sides that are short beside another side of a cell: a hat that falls
    across a slender cell would strain every function that bends it.
    """
    pairs = flat.cells[np.array(ENDS)]
    length = np.linalg.norm(flat.points[:, pairs[:, 1]] - flat.points[:, pairs[:, 0]], axis=0)
    side, cell = np.nonzero(length < SHORT * length.max(axis=0))
    return list(pairs[side, :, cell])


def _united(count: int, joined: list[np.ndarray]) -> np.ndarray:
    """Return (count,) the number of the hat of every vertex, some of which share one."""
    if not joined:
        return np.arange(count)
    a, b = np.array(joined).T
    graph = sp.coo_matrix((np.ones(len(a)), (a, b)), shape=(count, count))
    return connected_components(graph, directed=False)[1]


@dataclass(frozen=True)
class Mapped:
    """Pieces at reference points."""

    points: np.ndarray  #: (m, q, 2) in the coordinates of their cells
    place: np.ndarray  #: (m, q, 2) r and y, m
    #: (m, q) of the derivative of position along the coordinates of the pieces, m^2
    det: np.ndarray
    #: inverse, outer: (m, 2, 2, q) derivatives of the coordinates of the pieces, and of their cells
    #: (second axis), along r and y (third), 1/m
    inverse: np.ndarray
    outer: np.ndarray
    #: value, slope: functions of the mesh and their derivatives along the coordinates of the cells
    value: np.ndarray
    slope: np.ndarray


def mapped(space: RicherSpace, part: np.ndarray, points: np.ndarray) -> Mapped:
    """Map pieces (m,) that are all straight or all curved, at points (q, 2) in their
    coordinates.
    """
    corner, slope = hats(points)
    local = space.pieces.local[part]
    inside = corner.T @ local
    jac_in = np.einsum("dhq,mhx->mxdq", slope, local)
    parent = space.pieces.parent[part]
    value, rate = products(space.order, inside)
    if space.bent[parent[0]]:
        shape = np.array([space.curved[int(p)] for p in parent])
        of_shape, rate_of_shape = value, rate
    else:
        shape = space.straight[parent]
        of_shape, rate_of_shape = products(1, inside)
    place = of_shape.transpose(0, 2, 1) @ shape
    jac_out = np.stack([r.transpose(0, 2, 1) @ shape for r in rate_of_shape], axis=1)
    outer, det_out = inverted(jac_out.transpose(0, 3, 1, 2))
    inner, det_in = inverted(jac_in)
    inverse = np.einsum("mdxq,mxpq->mdpq", inner, outer)
    return Mapped(inside, place, det_out * det_in, inverse, outer, value, rate)


def hats(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return (..., 4, q) hats at the corners of a cell, and their (2, ..., 4, q) slopes."""
    value, slope = products(1, points)
    walk = [0, 2, 3, 1]
    return value[..., walk, :], slope[..., walk, :]


def inverted(jac: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the inverse and the determinant of (m, 2, 2, q) matrices."""
    a, b, c, d = jac[:, 0, 0], jac[:, 0, 1], jac[:, 1, 0], jac[:, 1, 1]
    det = a * d - b * c
    out = np.empty_like(jac)
    out[:, 0, 0], out[:, 0, 1], out[:, 1, 0], out[:, 1, 1] = d, -b, -c, a
    return out / det[:, None, None], det


def corner_places(scene: Scene, ports: Sequence[Port], flat: Meridian) -> dict[int, Place]:
    """Return the singular places of a scene by the vertices of a mesh that lie there; stations are tied
    as ports are.
    """
    stations = {station.name: station for station in scene.stations}
    ties = [(stations[port.name], port.attachment) for port in ports]
    out = {}
    for place in singular_places(scene, ties):
        away = np.hypot(flat.points[0] - place.r, flat.points[1] - place.y)
        vertex = int(away.argmin())
        if not place.round and away[vertex] <= SAME * scene.length:
            out[vertex] = place
    return out
