"""Displacement of the surface of a shaft, in space, from the unknowns of any fidelity.

Beams and harmonic solids are bodies of revolution and drawn by revolving their meridian; a beam
section is the case U = V, W linear in r of :mod:`solidgear.report.revolution`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.report.moving_surface import PIECES, Surface
from solidgear.report.revolution import Rings, revolve, wave
from solidgear.report.solid_surface import solid_surface


def surface(scene, body, vectors: Mapping[int, np.ndarray]) -> Surface:
    """Surface of a body moved by a vector of unknowns.

    Parameters
    ----------
    scene : Scene
        The one the body was built from.
    body : Body
    vectors : mapping of block index to (n,) ndarray
        One shape, such as ``Mode.vectors[0]``; blocks left out stand still.

    Returns
    -------
    Surface

    Raises
    ------
    SolidgearError
        For a body that carries no geometry, or a vector that does not fit its block.
    """
    if body.geometry is None:
        raise SolidgearError(f"the {body.fidelity} body carries no geometry to draw")
    moved = mesh_unknowns(body, vectors)
    if body.fidelity == "solid":
        return solid_surface(body.geometry, moved.get("full"))
    if body.fidelity == "harmonic":
        rings, waves = _harmonic(body.geometry, moved)
    else:
        rings, waves = _beam(scene, body.geometry, moved)
    return revolve(rings, waves)


def mesh_unknowns(body, vectors: Mapping[int, np.ndarray]) -> dict[str, np.ndarray]:
    """Block name -> unknowns of its mesh, with rigidly tied seats expanded.

    Raises
    ------
    SolidgearError
        If a vector does not fit its block.
    """
    out = {}
    for index, vector in vectors.items():
        block = body.block(index)
        if np.shape(vector) != (block.size,):
            raise SolidgearError(
                f"a shape of block {block.name} has {block.size} values, not {np.shape(vector)}"
            )
        out[block.name] = (
            np.asarray(vector, float) if block.expand is None else block.expand @ vector
        )
    return out


def _beam(scene, nodes, moved):
    """The profile of the scene, each section of it a rigid disc."""
    rings = _profile(scene, nodes)
    waves = []
    for name, start in (("bending_z", 0.0), ("bending_x", np.pi / 2)):
        if name in moved:
            # In the x plane the second unknown is -thz, which turns z into x as thx turns y into z.
            lift, tilt = (
                np.interp(rings.y, nodes, moved[name][k : 2 * len(nodes) : 2]) for k in (0, 1)
            )
            waves.append(wave(1, start, lift, lift, -rings.r * tilt))
    if "axial" in moved:
        waves.append(wave(0, 0.0, 0.0, 0.0, np.interp(rings.y, nodes, moved["axial"])))
    if "torsion" in moved:
        waves.append(
            wave(
                0,
                0.0,
                0.0,
                0.0,
                0.0 * rings.r,
                rings.r * np.interp(rings.y, nodes, moved["torsion"]),
            )
        )
    return rings, waves


def _profile(scene, nodes) -> Rings:
    """Closed outline of the meridian: up the outer surface, down the bore, counter-clockwise in (r,
    y).
    """
    tol = 1e-9 * scene.length
    outer: list[tuple[float, float]] = []
    inner: list[tuple[float, float]] = []
    for s in scene.segments:
        inside = nodes[(nodes > s.y0 + tol) & (nodes < s.y1 - tol)]
        y = np.concatenate([[s.y0], inside, [s.y1]])
        share = (y - s.y0) / s.length
        outer += zip(s.outer0 + share * (s.outer1 - s.outer0), y)
        inner += zip(s.inner0 + share * (s.inner1 - s.inner0), y)
    loop = np.array(outer + inner[::-1])
    loop = loop[np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1) > tol]
    # Faces across the axis are divided, so that their colours follow the displacement.
    parts, drawn, size = [], [], 0
    for p, q in zip(loop, np.roll(loop, -1, axis=0)):
        n = (
            max(1, int(np.ceil(abs(q[0] - p[0]) / (0.03 * scene.length))))
            if abs(q[1] - p[1]) < tol
            else 1
        )
        parts.append(p + np.arange(n)[:, None] / n * (q - p))
        drawn.append(size)
        size += n
    r, y = np.concatenate(parts).T
    ring = np.arange(size)
    return Rings(r, y, np.column_stack([ring, (ring + 1) % size]), np.array(drawn))


def _harmonic(geometry, moved):
    """The outline of the meridian mesh; inside an edge the basis itself is evaluated, whatever its
    order.
    """
    from solidgear.fidelity.assembly import reference

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
    ra, rb = points[:, edges[side, cell, 0]], points[:, edges[side, cell, 1]]
    r[ring], y[ring] = ra[:, :, None] + s * (rb - ra)[:, :, None]
    values = [reference(geometry.element, p)[0] for p in sides]

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
            waves.append(wave(n, np.pi / 2 if name == "bending_x" else 0.0, p + q, p - q, w))
    return rings, waves


def _on_axis(geometry) -> np.ndarray:
    """Scalar unknowns with a share on the axis, as the builder finds them."""
    from solidgear.fidelity.assembly import reference

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
