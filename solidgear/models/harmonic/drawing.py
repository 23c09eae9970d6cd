"""Drawing of a harmonic solid: the outline of its meridian as a body of revolution."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from solidgear.body.revolution import Rings, Wave, revolve, ring_of, wave
from solidgear.body.surface import PIECES, Surface
from solidgear.errors import SolidgearError
from solidgear.kernel.assembly import reference
from solidgear.kernel.cell_shapes import Shapes

if TYPE_CHECKING:
    from solidgear.models.harmonic.body import HarmonicMesh


def surface(geometry: HarmonicMesh, moved: Mapping[str, np.ndarray]) -> Surface:
    """The outline of the meridian mesh turned around the axis."""
    rings, on_rings = _rings(geometry)
    axis = _on_axis(geometry)
    fields = {name: _with_axis(vector, name, axis) for name, vector in moved.items()}
    return revolve(rings, [_wave(name, rings, (on_rings @ u).T) for name, u in fields.items()])


def rows(geometry: HarmonicMesh, name: str, chosen: np.ndarray) -> np.ndarray:
    """(3 k, n) displacements of some points of the surface by the unknowns of a block."""
    rings, on_rings = _rings(geometry)
    kept = _kept(name, _on_axis(geometry))
    moved = []
    for unit in np.eye(kept.shape[1]):
        alike = np.broadcast_to(unit[:, None], (len(unit), len(rings.r)))
        moved.append(revolve(rings, [_wave(name, rings, alike)]).displacement[chosen])
    own = on_rings[ring_of(rings)[chosen]].toarray()
    return np.einsum("ckx,kj->kxjc", moved, own).reshape(3 * len(chosen), -1)[:, kept.ravel()]


def _rings(geometry: HarmonicMesh) -> tuple[Rings, sp.csr_matrix]:
    """Circles of the outline, and a scalar field on them by its unknowns; inside an edge the basis
    itself is evaluated, whatever its order.
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

    found = []
    for k in range(4):
        own = dofs[:, cell[side == k]]
        at = np.arange(own.shape[1] * len(s)).reshape(1, -1, len(s))
        entry = np.broadcast_arrays(values[k][:, None], at, own[:, :, None])
        size = (at.size, int(dofs.max()) + 1)
        found.append(sp.csr_matrix((entry[0].ravel(), (entry[1].ravel(), entry[2].ravel())), size))
    order = np.concatenate([ring[side == k].ravel() for k in range(4)])
    on_rings = sp.vstack(found).tocsr()[np.unique(order, return_index=True)[1]]
    drawn = np.column_stack([ring[:, :-1].ravel(), ring[:, 1:].ravel()])
    return Rings(r, y, drawn, np.arange(len(vertex))), on_rings


def _waves(name: str) -> int:
    known = {"axial": 0, "torsion": 0, "bending_z": 1, "bending_x": 1}
    return known[name] if name in known else int(name.rsplit("_", 1)[1])


def _wave(name: str, rings: Rings, amplitude: np.ndarray) -> Wave:
    """Motion of rings by the amplitudes (c, rings) of a block."""
    n = _waves(name)
    if name == "torsion":
        return wave(0, 0.0, 0.0, 0.0, 0.0 * rings.r, rings.r * amplitude[0])
    if n == 0:
        return wave(0, 0.0, amplitude[0], 0.0, amplitude[1])
    p, q, w = amplitude
    start = np.pi / (2 * n) if name.startswith("sine_") else 0.0
    return wave(n, np.pi / 2 if name == "bending_x" else start, p + q, p - q, w)


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


def _kept(name: str, axis: np.ndarray) -> np.ndarray:
    """(n_scalar, c) unknowns of a block, without those that are zero on the axis."""
    if name == "torsion":
        return np.ones((len(axis), 1), bool)
    n = _waves(name)
    keep = np.ones((len(axis), 2 if n == 0 else 3), bool)
    if n == 0:
        keep[axis, 0] = False
    elif n == 1:
        keep[axis, 1:] = False
    else:
        keep[axis] = False
    return keep


def _with_axis(vector: np.ndarray, name: str, axis: np.ndarray) -> np.ndarray:
    """(n_scalar, c) unknowns with the zeros on the axis put back."""
    keep = _kept(name, axis)
    if keep.sum() != len(vector):
        raise SolidgearError(
            f"a shape of harmonic n = {_waves(name)} has {len(vector)} values where its mesh has "
            f"{int(keep.sum())} unknowns"
        )
    out = np.zeros(keep.shape)
    out[keep] = vector
    return out
