"""Structured hexahedral mesh of a shaft of revolution: an O-grid swept along the layout of mesh
lines.

The cross-section is a square core of k x k cells inside rings of 4k cells. Nodes on circles lie a
little outside them, such that the piecewise quadratic circle encloses the exact area: the leading
error of volume and inertia then cancels (8 cells around: 8e-4 in area without it).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from skfem import MeshHex1, MeshHex2
from skfem.element import ElementHex2

from solidgear.core.meshing.blended import quadrilaterals
from solidgear.core.meshing.cells import ENDS, HIGH, IN, LOW, OUT, Cell
from solidgear.core.meshing.layout import Layout
from solidgear.core.meshing.quality import MeshError

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft

# Between 0 (circular core: 180 degree corners) and 1 (square core: thin first ring).
SQUARENESS = 0.5


def hexahedra(scene: Shaft, plan: Layout, around: int = 8) -> tuple[MeshHex2, np.ndarray]:
    """Mesh a scene with curved 27-node hexahedra, right-handed, and return the segment (n,) of
    each; `around` is the number of cells around the circumference, a multiple of 4, at least 8.

    MeshError if ``around`` does not fit, or a bore closes to a point (use tetrahedra there).

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> from solidgear.core.meshing.grading import Grading
    >>> from solidgear.core.meshing.layout import layout
    >>> from solidgear.core.scene.closed_form import volume_of
    >>> from solidgear.core.meshing.quality import check_mesh
    >>> scene = Scene.from_parts([Segment.cylinder("rod", length=0.3, diameter=0.06)])
    >>> mesh, segment = hexahedra(scene, layout(scene, Grading(layers=0, core=True)))
    >>> quality = check_mesh(mesh, volume=volume_of(scene.outline))
    >>> quality.n_elements == len(segment)
    True
    """
    straight, place, owner = straight_hexahedra(scene, plan, around)
    mesh = MeshHex2.from_mesh(straight)
    located = mesh.doflocs.copy()
    located[:, mesh.dofs.element_dofs.T] = np.moveaxis(place, -1, 0)
    return MeshHex2(located, mesh.t), owner


def straight_hexahedra(
    scene: Shaft, plan: Layout, around: int
) -> tuple[MeshHex1, np.ndarray, np.ndarray]:
    """Return the same mesh with straight edges, places of the (ne, 27, 3) nodes of elements,
    and segments; errors as there.
    """
    if around % 4 or around < 8:
        raise MeshError(
            f"hexahedra: {around} cells around do not fit an O-grid; "
            "use a multiple of 4, at least 8"
        )
    k = around // 4
    half = np.pi / around
    inflate = 1 / np.sqrt(np.sin(half) * (1 + (1 - np.cos(half)) / 3) / half)
    angle = 5 * np.pi / 4 + np.arange(2 * around) * half
    core = _core(k)
    rim = _rim(core)
    offsets = (2 * ElementHex2.doflocs).round().astype(int)  # (27, 3) in half cells
    cells, places = quadrilaterals(scene, plan)
    nodes, keys, owner = [], [], []
    a = np.arange(around)
    i, j = (g.ravel() for g in np.meshgrid(np.arange(k), np.arange(k), indexing="ij"))
    fan = offsets[None] + np.stack([0 * a, 2 * a, 0 * a], axis=-1)[:, None]
    turn = fan[..., 1] % (2 * around)
    for cell in cells:
        # (across, along the shaft) in half cells: r and y
        r, y = _nine(cell, places)
        segment = scene.segments[cell.segment]
        solid = segment.inner0 == segment.inner1 == 0.0
        if cell.ring == 0 and not solid and np.any(r[0] == 0.0):
            raise MeshError(
                f"segment {segment.name!r}: its bore closes to a point, "
                "which an O-grid cannot mesh; use element 'tet10'"
            )
        if solid and cell.ring == 0:
            # cells of the core: local axes (z, x, y) are right-handed
            fine = offsets[None] + 2 * np.column_stack([i, j, np.zeros_like(i)])[:, None]
            xy = core[fine[..., 0], fine[..., 1]] * r[2][fine[..., 2]][..., None]
            nodes.append(np.stack([xy[..., 1], y[2][fine[..., 2]], xy[..., 0]], axis=-1))
            rim_ids = np.array([cell.ids[1], cell.ids[2]])
            keys.append(_core_key(fine[:, :8] // 2, cell.ids[0], cell.ids[3], rim_ids, k, around))
            owner.append(np.full(len(i), cell.segment))
            continue
        out, along = fan[..., 0], fan[..., 2]
        on_core = solid and cell.ring == 1
        inner = r[0][along] * (rim[turn] if on_core else inflate)
        outer = r[2][along] * inflate
        radius = inner + (outer - inner) * out / 2
        if cell.arc:  # middle nodes follow a curved side
            radius = radius + (r[1] - (r[0] + r[2]) / 2)[along] * inflate * (out == 1)
        nodes.append(
            np.stack(
                [radius * np.sin(angle[turn]), y[out, along], radius * np.cos(angle[turn])], axis=-1
            )
        )
        corner = fan[:, :8] // 2
        ids = np.array([[cell.ids[0], cell.ids[3]], [cell.ids[1], cell.ids[2]]])
        keys.append(_ring_key(ids[corner[..., 0], corner[..., 2]], corner[..., 1], around))
        owner.append(np.full(around, cell.segment))
    place, key = np.concatenate(nodes), np.concatenate(keys)
    _, first, t = np.unique(key, return_index=True, return_inverse=True)
    points = place[:, :8].reshape(-1, 3)[first]
    straight = MeshHex1(points.T.copy(), t.reshape(key.shape).T.copy().astype(np.int32))
    return straight, place, np.concatenate(owner)


def _core(k: int) -> np.ndarray:
    """Return (2k+1, 2k+1, 2) nodes of the core for a unit radius, in (z, x): a Coons patch between
    four bulged sides.
    """
    n = 2 * k
    t = 5 * np.pi / 4 + np.arange(4 * n) * np.pi / (2 * n)
    square = np.cos(np.pi / 4) / np.maximum(abs(np.cos(t)), abs(np.sin(t)))
    r = (1 - SQUARENESS) + SQUARENESS * square
    edge = np.column_stack([r * np.cos(t), r * np.sin(t)])
    low = edge[: n + 1]
    right_side = edge[n : 2 * n + 1]
    high = edge[2 * n : 3 * n + 1][::-1]
    left_side = np.roll(edge, -3 * n, axis=0)[: n + 1][::-1]
    s = np.linspace(0, 1, n + 1)
    u, v = s[:, None, None], s[None, :, None]
    patch = (
        (1 - v) * low[:, None]
        + v * high[:, None]
        + (1 - u) * left_side[None]
        + u * right_side[None]
    )
    corners = (
        (1 - u) * (1 - v) * low[0]
        + u * (1 - v) * low[-1]
        + u * v * high[-1]
        + (1 - u) * v * high[0]
    )
    return patch - corners


def _rim(core: np.ndarray) -> np.ndarray:
    """Return the radius of the core's edge, counter-clockwise from the first corner, at every half
    cell.
    """
    n = core.shape[0] - 1
    edge = np.concatenate([core[:n, 0], core[n, :n], core[:0:-1, n], core[0, :0:-1]])
    return np.linalg.norm(edge, axis=1)


def _nine(cell: Cell, places) -> tuple[np.ndarray, np.ndarray]:
    """Return (3, 3) r and y of a quadrilateral at the corners, the middles of the sides and the
    middle, by half cells outwards and along the shaft.
    """
    corner = np.array([places[vertex] for vertex in cell.ids])
    out = np.zeros((3, 3, 2))
    out[0, 0], out[2, 0], out[2, 2], out[0, 2] = corner
    out[1, [0, 2]] = (out[0, [0, 2]] + out[2, [0, 2]]) / 2
    out[:, 1] = (out[:, 0] + out[:, 2]) / 2
    if cell.arc:
        edge, *centre = cell.arc
        a, b = (corner[end] - centre for end in ENDS[edge])
        bulge = (a + b) * (np.linalg.norm(a) / np.linalg.norm(a + b) - 0.5)
        middle_of_edge = {LOW: (1, 0), OUT: (2, 1), HIGH: (1, 2), IN: (0, 1)}[edge]
        out[middle_of_edge] += bulge
        out[1, 1] += bulge / 2
    return out[..., 0], out[..., 1]


def _ring_key(ids, turn, around):
    """Return keys of vertices: those of the meridian, turned."""
    return 1 + (ids.astype(np.int64) * around + turn % around)


def _core_key(corner, low, high, rim_ids, k, around):
    """Return keys of core vertices: those on the edge are vertices of the first ring, inner ones
    are negative.
    """
    i, j, along = corner[..., 0], corner[..., 1], corner[..., 2]
    turn = np.select([j == 0, i == k, j == k, i == 0], [i, k + j, 3 * k - i, 4 * k - j], -1)
    axis = np.array([low, high], dtype=np.int64)[along]
    inside = -1 - (axis * (k + 1) + i) * (k + 1) - j
    return np.where(turn >= 0, _ring_key(rim_ids[along], turn, around), inside)
