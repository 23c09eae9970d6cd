"""Mesh of a meridian with the unknowns of a harmonic solid on it, drawn as a body of revolution."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from skfem import Element, ElementQuad1, ElementQuad2, MeshQuad1
from skfem.element import ElementQuadP

from solidgear.core.body.revolution import Rings, Wave, revolve, wave
from solidgear.core.body.surface import PIECES, Surface
from solidgear.core.errors import SolidgearError
from solidgear.core.kernel.assembly import reference, unknowns
from solidgear.core.kernel.cell_shapes import Shapes
from solidgear.core.meshing.meridian import Meridian
from solidgear.core.models.harmonic.families import TORSION, Family, family_of


@dataclass(frozen=True)
class HarmonicMesh:
    """Mesh of a meridian with the unknowns of one component of the displacement."""

    mesh: MeshQuad1
    element: Element
    dofs: np.ndarray  #: (nb, ne)
    meridian: Meridian
    order: int
    uncut: Meridian  #: before cells were cut towards corners
    parent: np.ndarray  #: (ne,) cell of ``uncut`` of every cell

    @property
    def size(self) -> int:
        """Number of unknowns of one component."""
        return int(self.dofs.max()) + 1

    def edge_unknowns(self, cells: np.ndarray, direction: int, value: float) -> np.ndarray:
        """Return the unknowns of cells that do not vanish on a local edge, where a coordinate has a
        value.
        """
        # more points than the highest function has zeros on an edge
        along = np.linspace(0.0, 1.0, self.order + 4)[1:-1]
        points = np.empty((2, len(along)))
        points[direction], points[1 - direction] = value, along
        alive = np.abs(reference(self.element, points)[0]).max(axis=1) > 1e-12
        return np.unique(self.dofs[alive][:, cells])

    @cached_property
    def on_axis(self) -> np.ndarray:
        """Mask of the unknowns with a share on the axis."""
        flat = self.meridian
        radius = np.abs(flat.points[0][flat.cells[[0, 3]][:, flat.inner]])
        cells = flat.inner[(radius < 1e-9 * flat.points[0].max()).all(axis=0)]
        out = np.zeros(self.size, bool)
        out[self.edge_unknowns(cells, 0, 0.0)] = True
        return out

    def whole(self, family: Family, u: np.ndarray) -> np.ndarray:
        """Return the unknowns (n, c, ...) of a family from those that the axis leaves free."""
        keep = family.free(self.on_axis)
        if keep.sum() != len(u):
            raise SolidgearError(
                f"a shape of harmonic n = {max(family.waves, 0)} has {len(u)} values where its mesh "
                f"has {int(keep.sum())} unknowns"
            )
        out = np.zeros((*keep.shape, *u.shape[1:]))
        out[keep] = u
        return out

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """Return the outline of the meridian turned around the axis."""
        rings, on_rings = self.rings
        fields = {name: self.whole(family_of(name), u) for name, u in moved.items()}
        return revolve(rings, [_wave(name, rings, (on_rings @ u).T) for name, u in fields.items()])

    def rows(self, name: str, chosen: np.ndarray) -> np.ndarray:
        """Return the displacements (3 k, n) of points of the surface by the unknowns of a block."""
        rings, on_rings = self.rings
        free = family_of(name).free(self.on_axis)
        moved = []
        for unit in np.eye(free.shape[1]):
            amplitude = np.broadcast_to(unit[:, None], (len(unit), len(rings.r)))
            moved.append(revolve(rings, [_wave(name, rings, amplitude)]).displacement[chosen])
        values = on_rings[rings.ring[chosen]].toarray()
        rows = np.einsum("ckx,kj->kxjc", moved, values).reshape(3 * len(chosen), -1)
        return rows[:, free.ravel()]

    @cached_property
    def rings(self) -> tuple[Rings, sp.csr_matrix]:
        """The circles of the outline, and a scalar field on them by its unknowns; inside an edge
        the basis itself is evaluated, whatever the order.
        """
        points, cells, dofs = self.meridian.points, self.meridian.cells, self.dofs
        pieces = 1 if dofs.shape[0] == 4 else PIECES
        s = np.linspace(0.0, 1.0, pieces + 1)
        zero, ones = np.zeros_like(s), np.ones_like(s)
        sides = [np.array(p) for p in ((s, zero), (ones, s), (1 - s, ones), (zero, 1 - s))]
        ends = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
        edges = cells[ends].transpose(0, 2, 1)  # (side, cell, end)
        cells_of = Counter(map(tuple, np.sort(edges.reshape(-1, 2), axis=1)))
        on_boundary = np.array([[cells_of[tuple(sorted(e))] == 1 for e in side] for side in edges])
        off_axis = points[0][edges].max(axis=2) > 1e-9 * points[0].max()
        side, cell = np.nonzero(on_boundary & off_axis)
        vertex, corner = np.unique(edges[side, cell], return_inverse=True)
        corner = corner.reshape(-1, 2)
        between = len(vertex) + np.arange(len(side) * (pieces - 1)).reshape(len(side), -1)
        ring = np.column_stack([corner[:, 0], between, corner[:, 1]])
        r, y = np.zeros((2, ring.max() + 1))
        values = [reference(self.element, p)[0] for p in sides]

        place = Shapes(self.meridian, self.element).places(dofs)
        for k in range(4):
            on_side = side == k
            r[ring[on_side]], y[ring[on_side]] = np.einsum(
                "bq,cbe->ceq", values[k], place[:, dofs[:, cell[on_side]]]
            )

        matrices = []
        for k in range(4):
            side_dofs = dofs[:, cell[side == k]]
            rows = np.arange(side_dofs.shape[1] * len(s)).reshape(1, -1, len(s))
            v, i, j = np.broadcast_arrays(values[k][:, None], rows, side_dofs[:, :, None])
            size = (rows.size, int(dofs.max()) + 1)
            matrices.append(sp.csr_matrix((v.ravel(), (i.ravel(), j.ravel())), size))
        order = np.concatenate([ring[side == k].ravel() for k in range(4)])
        on_rings = sp.vstack(matrices).tocsr()[np.unique(order, return_index=True)[1]]
        drawn = np.column_stack([ring[:, :-1].ravel(), ring[:, 1:].ravel()])
        return Rings(r, y, drawn, np.arange(len(vertex))), on_rings

    def volume(self) -> None:
        """Return None: the mesh is that of a meridian."""
        return None


def harmonic_mesh(
    flat: Meridian,
    order: int,
    uncut: Meridian | None = None,
    parent: np.ndarray | None = None,
) -> HarmonicMesh:
    """Number the unknowns of quadrilaterals of some order on a meridian."""
    mesh = MeshQuad1(flat.points, flat.cells, sort_t=False)
    element = {1: ElementQuad1, 2: ElementQuad2}.get(order, lambda: ElementQuadP(order))()
    if parent is None:
        parent = np.arange(flat.cells.shape[1])
    return HarmonicMesh(mesh, element, unknowns(mesh, element), flat, order, uncut or flat, parent)


def _wave(name: str, rings: Rings, amplitude: np.ndarray) -> Wave:
    """Return the motion of rings by the amplitudes (c, rings) of a block."""
    n = family_of(name).waves
    if n == TORSION:
        return wave(0, 0.0, 0.0, 0.0, 0.0 * rings.r, rings.r * amplitude[0])
    if n == 0:
        return wave(0, 0.0, amplitude[0], 0.0, amplitude[1])
    p, q, w = amplitude
    start = np.pi / (2 * n) if name.startswith("sine_") else 0.0
    return wave(n, np.pi / 2 if name == "bending_x" else start, p + q, p - q, w)
