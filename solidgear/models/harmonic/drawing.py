"""Drawing of a harmonic solid: the outline of its meridian as a body of revolution."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from solidgear.body.revolution import Rings, revolve, wave
from solidgear.body.surface import PIECES, Surface
from solidgear.errors import SolidgearError
from solidgear.kernel.assembly import reference
from solidgear.kernel.cell_shapes import Shapes

if TYPE_CHECKING:
    from solidgear.models.harmonic.body import HarmonicMesh


def surface(geometry: HarmonicMesh, moved: Mapping[str, np.ndarray]) -> Surface:
    """The outline of the meridian mesh; inside an edge the basis itself is evaluated, whatever its
    order.
    """
    points, cells, dofs = geometry.meridian.points, geometry.meridian.cells, geometry.dofs
    pieces = 1 if dofs.shape[0] == 4 else PIECES
    s = np.linspace(0.0, 1.0, pieces + 1)
    zero, one = np.zeros_like(s), np.ones_like(s)
    sides = [np.array(p) for p in ((s, zero), (one, s), (1 - s, one), (zero, 1 - s))]
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    edges = cells[ends].transpose(0, 2, 1)  # (side, cell, end)
    seen = Counter(map(tuple, np.sort(edges.reshape(-1, 2), axis=1)))
    edge_r = points[0][edges].max(axis=2)
    free = np.array([[seen[tuple(sorted(e))] == 1 for e in side] for side in edges]) & (
        edge_r > 1e-9 * points[0].max()
    )
    side, cell = np.nonzero(free)
    vertex, corner = np.unique(edges[side, cell], return_inverse=True)
    corner = corner.reshape(-1, 2)
    between = len(vertex) + np.arange(len(side) * (pieces - 1)).reshape(len(side), -1)
    ring = np.column_stack([corner[:, 0], between, corner[:, 1]])
    r, y = np.zeros((2, ring.max() + 1))
    values = [reference(geometry.element, p)[0] for p in sides]

    place = Shapes(geometry.meridian, geometry.element).places(dofs)
    for k in range(4):
        here = side == k
        r[ring[here]], y[ring[here]] = np.einsum(
            "bq,cbe->ceq", values[k], place[:, dofs[:, cell[here]]]
        )

    def on_rings(field):
        out = np.zeros((len(r), field.shape[1]))
        for k in range(4):
            here = side == k
            out[ring[here]] = np.einsum("bq,bec->eqc", values[k], field[dofs[:, cell[here]]])
        return out.T

    rings = Rings(
        r, y, np.column_stack([ring[:, :-1].ravel(), ring[:, 1:].ravel()]), np.arange(len(vertex))
    )
    axis = _on_axis(geometry)
    waves = []
    for name, vector in moved.items():
        if name == "torsion":
            waves.append(wave(0, 0.0, 0.0, 0.0, 0.0 * r, r * on_rings(vector[:, None])[0]))
            continue
        n = {"axial": 0, "bending_z": 1, "bending_x": 1}.get(name)
        n = int(name.rsplit("_", 1)[1]) if n is None else n
        amplitude = on_rings(_with_axis(vector, n, axis))
        if n == 0:
            waves.append(wave(0, 0.0, amplitude[0], 0.0, amplitude[1]))
        else:
            p, q, w = amplitude
            start = np.pi / (2 * n) if name.startswith("sine_") else 0.0
            waves.append(wave(n, np.pi / 2 if name == "bending_x" else start, p + q, p - q, w))
    return revolve(rings, waves)


def _on_axis(geometry: HarmonicMesh) -> np.ndarray:
    """Scalar unknowns with a share on the axis, as the builder finds them."""
    flat, dofs = geometry.meridian, geometry.dofs
    tol = 1e-9 * flat.points[0].max()
    cells = flat.inner[
        (np.abs(flat.points[0][flat.cells[[0, 3]][:, flat.inner]]) < tol).all(axis=0)
    ]
    # More points than the highest basis function has zeros on an edge.
    inside = np.linspace(0.0, 1.0, 16)[1:-1]
    values = reference(geometry.element, np.array([0 * inside, inside]))[0]
    alive = np.abs(values).max(axis=1) > 1e-12
    out = np.zeros(int(dofs.max()) + 1, bool)
    out[dofs[alive][:, cells]] = True
    return out


def _with_axis(vector, n, axis) -> np.ndarray:
    """(n_scalar, c) unknowns with the zeros on the axis put back."""
    keep = np.ones((len(axis), 2 if n == 0 else 3), bool)
    if n == 0:
        keep[axis, 0] = False
    elif n == 1:
        keep[axis, 1:] = False
    else:
        keep[axis] = False
    if keep.sum() != len(vector):
        raise SolidgearError(
            f"a shape of harmonic n = {n} has {len(vector)} values where its mesh has {int(keep.sum())} unknowns"
        )
    out = np.zeros(keep.shape)
    out[keep] = vector
    return out
