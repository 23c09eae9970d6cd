"""Shapes of the cells of a meridian: straight, or with a side on a circle.

A side on a circle is drawn by the functions of the element itself (isoparametric), so that every
motion as a rigid body is one of the element's displacements, whatever its order.  The error of the
area falls with twice the order: of a fillet of a twentieth of the diameter 1e-6 of the volume at
order 2, 1e-10 at 5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import Element, ElementQuad1

from solidgear.core.kernel.assembly import Tabulated, Tabulation, reference
from solidgear.core.meshing.cells import ENDS, HIGH, LOW, OUT
from solidgear.core.meshing.lobatto import gauss
from solidgear.core.meshing.meridian import Meridian

_CORNERS = ElementQuad1()


@dataclass(frozen=True)
class Kind:
    """Cells that share one tabulation."""

    cells: np.ndarray  #: (m,)
    curved: bool
    flip: tuple[bool, ...]  #: local edges whose odd functions have the other sign


class Shapes:
    """Geometry and basis of the cells of a meridian, by the element of the unknowns."""

    def __init__(self, flat: Meridian, element: Element):
        self.flat, self.element = flat, element
        self._tabulations: dict[tuple, Tabulation] = {}  # of blocks that share cells, made once
        self.curved = np.flatnonzero(flat.arc >= 0)
        self._place = {int(cell): k for k, cell in enumerate(self.curved)}
        self._nodes = self._curved_nodes()
        marks = list(zip(flat.arc >= 0, map(tuple, flat.flip.T)))
        self.kinds = [
            Kind(
                np.array([k for k, mark in enumerate(marks) if mark == (curved, flip)]),
                curved,
                flip,
            )
            for curved, flip in sorted(set(marks))
        ]

    def tabulation(self, kind: Kind, points: np.ndarray) -> Tabulation:
        """Return the basis of some cells, tabulated at reference points."""
        key = kind.curved, tuple(kind.flip), points.shape, points.tobytes()
        if key not in self._tabulations:
            self._tabulations[key] = self._tabulated(kind, points)
        return self._tabulations[key]

    def _tabulated(self, kind: Kind, points: np.ndarray) -> Tabulation:
        basis = Tabulation(self.element if kind.curved else _CORNERS, self.element, points)
        odd = [f for edge in np.flatnonzero(kind.flip) for f in self._odd(int(edge))]
        if odd:
            basis.value, basis.slope = basis.value.copy(), basis.slope.copy()
            basis.value[odd] *= -1
            basis.slope[odd] *= -1
        return basis

    def nodes(self, kind: Kind, cells: np.ndarray) -> np.ndarray:
        """Return (2, nn, m) coefficients of the mapping of some cells of one kind, m."""
        if not kind.curved:
            return self.flat.points[:, self.flat.cells[:, cells]]
        return self._nodes[:, :, [self._place[int(cell)] for cell in cells]]

    def on(self, kind: Kind, cells: np.ndarray, points: np.ndarray) -> Tabulated:
        """Tabulate the basis on some cells of one kind."""
        return self.tabulation(kind, points).on(self.nodes(kind, cells))

    def places(self, dofs: np.ndarray) -> np.ndarray:
        """Return (2, n) coefficients of position in the basis, m: of straight cells only those of
        corners are not zero in a hierarchical basis.
        """
        out = np.zeros((2, int(dofs.max()) + 1))
        if self._nodal:
            nodes = np.array([self.element.doflocs[:, 0], self.element.doflocs[:, 1]])
            straight = Tabulation(_CORNERS, self.element, nodes)
            out[:, dofs.T] = straight.on(self.flat.points[:, self.flat.cells]).x
        else:
            out[:, dofs[:4]] = self.flat.points[:, self.flat.cells]
        if len(self.curved):
            out[:, dofs[:, self.curved]] = self._nodes
        return out

    @property
    def _nodal(self) -> bool:
        return not np.isnan(self.element.doflocs).any()

    def _edge(self, edge: int) -> np.ndarray:
        """Return the basis functions that belong to a local edge, lowest first."""
        count = self.element.facet_dofs
        return 4 + edge * count + np.arange(count)

    def _odd(self, edge: int) -> np.ndarray:
        """Return the basis functions of a local edge that are odd along it."""
        return self._edge(edge)[1::2] if not self._nodal else np.zeros(0, int)

    def _curved_nodes(self) -> np.ndarray:
        """Return (2, nb, m) coefficients of the mapping of the curved cells."""
        flat, cells = self.flat, self.curved
        corner = flat.points[:, flat.cells[:, cells]]
        if self._nodal:
            nodes = np.array([self.element.doflocs[:, 0], self.element.doflocs[:, 1]])
            out = Tabulation(_CORNERS, self.element, nodes).on(corner).x.transpose(0, 2, 1).copy()
            for k, cell in enumerate(cells):
                edge = int(flat.arc[cell])
                along, across = _local(edge, nodes)
                a, b = (corner[:, end, k] for end in ENDS[edge])
                out[:, :, k] += across * _bulge(a, b, flat.centre[:, cell], along)[0]
            return out
        out = np.zeros((2, len(reference(self.element, np.zeros((2, 1)))[0]), len(cells)))
        out[:, :4] = corner
        x, w = gauss(24)
        for k, cell in enumerate(cells):
            edge = int(flat.arc[cell])
            a, b = (corner[:, end, k] for end in ENDS[edge])
            functions = self._edge(edge)
            points, direction = _on_edge(edge, x)
            slope = reference(self.element, points)[1][functions, direction]
            wanted = _bulge(a, b, flat.centre[:, cell], x)[1]
            # their derivatives are Legendre polynomials, orthogonal on the edge
            out[:, functions, k] = (wanted * w) @ slope.T / (slope**2 @ w)
        return out


def _local(edge: int, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the coordinate along a local edge, and the share that reaches a point (1 on the
    edge).
    """
    if edge in (LOW, HIGH):
        return points[0], points[1] if edge == HIGH else 1 - points[1]
    return points[1], points[0] if edge == OUT else 1 - points[0]


def _on_edge(edge: int, x: np.ndarray) -> tuple[np.ndarray, int]:
    """Return reference points on a local edge, and the direction it runs in."""
    if edge in (LOW, HIGH):
        return np.array([x, np.full_like(x, float(edge == HIGH))]), 0
    return np.array([np.full_like(x, float(edge == OUT)), x]), 1


def _bulge(a, b, centre, t) -> tuple[np.ndarray, np.ndarray]:
    """Return the distance of an arc from a to b from the chord at shares t of the angle, and the
    derivative; (2, len(t)), m.
    """
    va, vb = a - centre, b - centre
    start = np.arctan2(va[1], va[0])
    turn = np.arctan2(va[0] * vb[1] - va[1] * vb[0], va @ vb)
    radius, angle = np.hypot(va[0], va[1]), start + turn * np.asarray(t)
    arc = centre[:, None] + radius * np.array([np.cos(angle), np.sin(angle)])
    chord = a[:, None] + np.outer(b - a, t)
    slope = radius * turn * np.array([-np.sin(angle), np.cos(angle)]) - (b - a)[:, None]
    return arc - chord, slope
