"""Drawing of a harmonic solid: the outline of the meridian as a body of revolution."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from solidgear.core.body.revolution import Rings, Wave, revolve, ring_of, wave
from solidgear.core.body.surface import PIECES, Surface
from solidgear.core.kernel.assembly import reference
from solidgear.core.kernel.cell_shapes import Shapes
from solidgear.core.models.harmonic.families import TORSION, family_of

if TYPE_CHECKING:
    from solidgear.core.models.harmonic.mesh import HarmonicMesh


def surface(geometry: HarmonicMesh, moved: Mapping[str, np.ndarray]) -> Surface:
    """Return the outline of the meridian mesh turned around the axis."""
    rings, on_rings = _rings(geometry)
    fields = {name: geometry.whole(family_of(name), u) for name, u in moved.items()}
    return revolve(rings, [_wave(name, rings, (on_rings @ u).T) for name, u in fields.items()])


def rows(geometry: HarmonicMesh, name: str, chosen: np.ndarray) -> np.ndarray:
    """Return the displacements (3 k, n) of points of the surface by the unknowns of a block."""
    rings, on_rings = _rings(geometry)
    free = family_of(name).free(geometry.on_axis)
    moved = []
    for unit in np.eye(free.shape[1]):
        amplitude = np.broadcast_to(unit[:, None], (len(unit), len(rings.r)))
        moved.append(revolve(rings, [_wave(name, rings, amplitude)]).displacement[chosen])
    values = on_rings[ring_of(rings)[chosen]].toarray()
    return np.einsum("ckx,kj->kxjc", moved, values).reshape(3 * len(chosen), -1)[:, free.ravel()]


def _rings(geometry: HarmonicMesh) -> tuple[Rings, sp.csr_matrix]:
    """Return the circles of the outline, and a scalar field on them by its unknowns; inside an edge
    the basis itself is evaluated, whatever the order.
    """
    points, cells, dofs = geometry.meridian.points, geometry.meridian.cells, geometry.dofs
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
    values = [reference(geometry.element, p)[0] for p in sides]

    place = Shapes(geometry.meridian, geometry.element).places(dofs)
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
