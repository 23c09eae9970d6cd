"""Displacement of the surface of a shaft, in space, from the unknowns of any fidelity.

Beams and harmonic solids are bodies of revolution: both are drawn by revolving their meridian, and
both move by ``u_r = U cos n(t - t0), u_t = -V sin n(t - t0) + S, u_y = W cos n(t - t0)`` with ``z =
r cos t, x = r sin t``. A beam section is the case U = V, W linear in r.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from solidgear.errors import SolidgearError

TURNS = 48
MERIDIANS = 12
#: pieces an edge of the meridian is cut into, where its displacement is curved
PIECES = 4


@dataclass(frozen=True, eq=False)
class Surface:
    """A moving surface, made of faces whose normals point out of the material.

    Attributes
    ----------
    points : (n, 3) ndarray
        x, y, z at rest, m.
    displacement : (n, 3) ndarray
        In the unit of the vector it was made from; m for unit-mass shapes up to their common
        factor.
    faces : (m, 4) ndarray of int
        Quadrilaterals.
    triangles : (k, 3) ndarray of int
    lines : (l, 2) ndarray of int
        Pieces of lines that are worth drawing: element edges of a solid, circles and meridians
        otherwise.
    """

    points: np.ndarray
    displacement: np.ndarray
    faces: np.ndarray
    triangles: np.ndarray
    lines: np.ndarray


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
        return _solid(body.geometry, moved.get("full"))
    if body.fidelity == "harmonic":
        rings, waves = _harmonic(body.geometry, moved)
    else:
        rings, waves = _beam(scene, body.geometry, moved)
    return _revolve(rings, waves)


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


# ------------------------------------------------------------------------------------------------- revolution
@dataclass(frozen=True)
class _Rings:
    """Circles (r, y), the pieces of meridian (k, 2) between them with material on their left, and
    those to draw.
    """

    r: np.ndarray
    y: np.ndarray
    pieces: np.ndarray
    drawn: np.ndarray


@dataclass(frozen=True)
class _Wave:
    """Amplitudes on every ring of one term of the sum in the module's docstring."""

    n: int
    start: float
    radial: np.ndarray
    tangential: np.ndarray
    axial: np.ndarray
    swirl: np.ndarray


def _wave(n, start, radial, tangential, axial, swirl=0.0) -> _Wave:
    full = np.broadcast_arrays(*(np.asarray(a, float) for a in (radial, tangential, axial, swirl)))
    return _Wave(n, start, *full)


def _revolve(rings: _Rings, waves: list[_Wave]) -> Surface:
    """Sweep rings around the axis; a ring of no radius is one point."""
    on_axis = rings.r <= 1e-9 * rings.r.max()
    count = np.where(on_axis, 1, TURNS)
    first = np.concatenate([[0], np.cumsum(count)[:-1]])
    ring = np.repeat(np.arange(len(count)), count)
    step = np.arange(len(ring)) - first[ring]
    t = 2 * np.pi * step / TURNS
    r, y = np.where(on_axis, 0.0, rings.r)[ring], rings.y[ring]
    out = np.zeros((3, len(ring)))  # radial, tangential, axial
    for w in waves:
        cos, sin = np.cos(w.n * (t - w.start)), np.sin(w.n * (t - w.start))
        out[0] += w.radial[ring] * cos
        out[1] += w.swirl[ring] - w.tangential[ring] * sin
        out[2] += w.axial[ring] * cos
    points = np.column_stack([r * np.sin(t), y, r * np.cos(t)])
    displacement = np.column_stack(
        [out[0] * np.sin(t) + out[1] * np.cos(t), out[2], out[0] * np.cos(t) - out[1] * np.sin(t)]
    )

    turn = np.arange(TURNS)

    def at(which, k):
        return first[which][:, None] + np.where(on_axis[which][:, None], 0, k % TURNS)

    a, b = rings.pieces[~on_axis[rings.pieces].all(axis=1)].T
    quads = np.stack([at(a, turn), at(a, turn + 1), at(b, turn + 1), at(b, turn)], axis=-1)
    from_axis, to_axis = on_axis[a], on_axis[b]
    faces = quads[~(from_axis | to_axis)].reshape(-1, 4)
    triangles = np.concatenate(
        [
            quads[from_axis][:, :, [0, 2, 3]].reshape(-1, 3),
            quads[to_axis][:, :, [0, 1, 2]].reshape(-1, 3),
        ]
    )
    spokes = np.arange(0, TURNS, TURNS // MERIDIANS)
    circles = rings.drawn[~on_axis[rings.drawn]]
    lines = [
        np.stack([at(a, spokes), at(b, spokes)], axis=-1),
        np.stack([at(circles, turn), at(circles, turn + 1)], axis=-1),
    ]
    return Surface(
        points, displacement, faces, triangles, np.concatenate([x.reshape(-1, 2) for x in lines])
    )


# ------------------------------------------------------------------------------------------------- beams
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
            waves.append(_wave(1, start, lift, lift, -rings.r * tilt))
    if "axial" in moved:
        waves.append(_wave(0, 0.0, 0.0, 0.0, np.interp(rings.y, nodes, moved["axial"])))
    if "torsion" in moved:
        waves.append(
            _wave(
                0,
                0.0,
                0.0,
                0.0,
                0.0 * rings.r,
                rings.r * np.interp(rings.y, nodes, moved["torsion"]),
            )
        )
    return rings, waves


def _profile(scene, nodes) -> _Rings:
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
    return _Rings(r, y, np.column_stack([ring, (ring + 1) % size]), np.array(drawn))


# ------------------------------------------------------------------------------------------------- harmonic solid
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

    rings = _Rings(
        r, y, np.column_stack([ring[:, :-1].ravel(), ring[:, 1:].ravel()]), np.arange(len(vertex))
    )
    axis = _on_axis(geometry)
    waves = []
    for name, vector in moved.items():
        if name == "torsion":
            waves.append(_wave(0, 0.0, 0.0, 0.0, 0.0 * r, r * on_rings(vector[:, None])[0]))
            continue
        n = {"axial": 0, "bending_z": 1, "bending_x": 1}.get(name)
        n = int(name.rsplit("_", 1)[1]) if n is None else n
        amplitude = on_rings(_with_axis(vector, n, axis))
        if n == 0:
            waves.append(_wave(0, 0.0, amplitude[0], 0.0, amplitude[1]))
        else:
            p, q, w = amplitude
            waves.append(_wave(n, np.pi / 2 if name == "bending_x" else 0.0, p + q, p - q, w))
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


# ------------------------------------------------------------------------------------------------- solid
def _solid(geometry, vector) -> Surface:
    """The boundary of the volume mesh; faces of second order are divided, so that curved ones look
    curved.
    """
    from solidgear.fidelity.assembly import reference

    moved = np.zeros((geometry.nodes.shape[1], 3)) if vector is None else vector.reshape(-1, 3)
    fields = np.column_stack([geometry.nodes.T, moved])
    refdom, element, dofs = geometry.mesh.refdom, geometry.element, geometry.dofs
    linear = len(dofs) == refdom.nnodes
    # Two pieces end at the nodes in the middle of edges; more only pay where the mesh is coarse
    # enough to see it.
    m = 1 if linear else PIECES if len(geometry.boundary) < 4000 else 2
    corners = len(refdom.facets[0])
    grid, cells, rim = _grid(m, corners)
    # Every rim point lies k pieces along the edge from corner a to corner b (k = 0 at a).
    a = np.repeat(np.arange(corners), m)
    b, k = (a + 1) % corners, np.tile(np.arange(m), corners)
    values, keys, faces, lines, done = [], [], [], [], 0
    for place, elements in geometry.local_facets(geometry.boundary):
        corner = refdom.p[:, refdom.facets[place]]
        s, t = corner[:, 1] - corner[:, 0], corner[:, -1] - corner[:, 0]
        points = corner[:, :1] + np.outer(s, grid[:, 0] / m) + np.outer(t, grid[:, 1] / m)
        values.append(
            np.einsum(
                "bq,bef->eqf", reference(element, points)[0], fields[dofs[:, elements]]
            ).reshape(-1, 6)
        )
        serial = done + np.arange(len(elements) * len(grid)).reshape(-1, len(grid))
        done += serial.size
        # A point inside a face is its own; one on an edge is named by the edge's vertices, so that
        # neighbours share it.
        key = np.stack([-1 - serial, 0 * serial, 0 * serial], axis=-1)
        va, vb = (geometry.mesh.t[refdom.facets[place]][c][:, elements].T for c in (a, b))
        vb = np.where(k == 0, va, vb)
        key[:, rim] = np.stack(
            [np.minimum(va, vb), np.maximum(va, vb), np.where(va <= vb, k, m - k)], axis=-1
        )
        keys.append(key.reshape(-1, 3))
        outward = np.cross(s, t) @ (corner.mean(axis=1) - refdom.p.mean(axis=1)) > 0
        faces.append(serial[:, cells if outward else cells[:, ::-1]].reshape(-1, corners))
        lines.append(serial[:, np.column_stack([rim, np.roll(rim, -1)])].reshape(-1, 2))
    _, first, number = np.unique(
        np.concatenate(keys), axis=0, return_index=True, return_inverse=True
    )
    number = number.ravel()
    at = np.concatenate(values)[first]
    found = {corners: number[np.concatenate(faces)]}
    edges = np.unique(np.sort(number[np.concatenate(lines)], axis=1), axis=0)
    quads, triangles = (found.get(n, np.zeros((0, n), int)) for n in (4, 3))
    return Surface(at[:, :3], at[:, 3:], quads, triangles, edges)


def _grid(m: int, corners: int):
    """Points (i, j), cells and rim (from the first corner on) of a face divided into m pieces along
    each edge.
    """
    i, j = (g.ravel() for g in np.meshgrid(np.arange(m + 1), np.arange(m + 1), indexing="ij"))
    n = m + 1
    step = np.arange(m)
    if corners == 4:
        c = (i * n + j)[(i < m) & (j < m)]
        cells = np.column_stack([c, c + n, c + n + 1, c + 1])
        rim = np.concatenate([step * n, m * n + step, (m - step) * n + m, m - step])
        return np.column_stack([i, j]), cells, rim
    inside = i + j <= m
    place = np.cumsum(inside) - 1
    low, high = (i * n + j)[i + j < m], (i * n + j)[i + j < m - 1]
    cells = np.vstack(
        [
            np.column_stack([low, low + n, low + 1]),
            np.column_stack([high + n, high + n + 1, high + 1]),
        ]
    )
    rim = np.concatenate([step * n, (m - step) * n + step, m - step])
    return np.column_stack([i, j])[inside], place[cells], place[rim]
