r"""A part of equal sectors from half of one: where a sector is even about its middle plane, its
matrices are real.

With ``v_k = Re(e^{i k h alpha} V)`` as in :mod:`solidgear.models.sector.cyclic` and the mirror S of the
middle plane, ``conj(S V(S x))`` meets the same conditions on the cut faces as V does. So every
eigenspace has a basis of motions that are their own image: ``V = a + i b`` with a symmetric and b
antisymmetric. On the middle plane a stays in the plane and b moves across it. On the cut face, at
half the angle of the sector,

    V = e^{i h alpha / 2} (w_r r + w_y y + i w_t t),    w real,

with the directions r along the radius and t around: both conditions of the whole sector in one.
Inside a and b do not meet. On the axis h = 0 leaves y to a, and h = 1 one number, ``z + i x``.

What is left are as many real unknowns as the whole sector has complex ones, and one of every pair
of twins: the other one is ``-i V``. With h = 0 a (axial) and b (torsion) are blocks of their own;
with h = 1 the unknowns are bending in the plane of y and z, and the block in the plane of x and y
mirrors it (Thomas 1979 solves the pair at once).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from solidgear.body import Block
from solidgear.body.surface import Surface
from solidgear.frames import rotation
from solidgear.kernel.attachment import Attached, with_ports
from solidgear.meshing.sector import MATCH, SectorMesh
from solidgear.models.sector.cyclic import ROUNDING
from solidgear.models.sector.mesh import PieceSolid
from solidgear.models.solid.block import rigid_motions
from solidgear.models.solid.drawing import copied, solid_surface
from solidgear.models.solid.matrices import _matrices, weighed
from solidgear.models.solid.mesh import SolidMesh, _isoparametric

#: blocks that ports move in: harmonic index and components
PORTED: dict[str, tuple[int, tuple[int, ...]]] = {
    "axial": (0, (1,)),
    "torsion": (0, (4,)),
    "bending_z": (1, (2, 3)),
}
_MIRROR = np.array([-1.0, 1.0, 1.0])
#: the mirror on a motion of three displacements and three rotations
_MIRROR6 = np.diag([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0])


@dataclass(frozen=True)
class HalfSector:
    """Places of the nodes of half a sector."""

    count: int  #: sectors around, at least 3
    #: middle, cut, axis: nodes on the middle plane and on the cut face without the axis, and on the
    #: axis
    middle: np.ndarray
    cut: np.ndarray
    axis: np.ndarray
    turn: float = 0.0  #: angle of the middle of the sector, rad

    @property
    def angle(self) -> float:
        """Of the whole sector, rad."""
        return 2 * np.pi / self.count


def basis(half: HalfSector, nodes: int, h: int) -> tuple[sp.csr_matrix, np.ndarray]:
    """Motions of half a sector that go with one harmonic index.

    Parameters
    ----------
    nodes : int
        Of the half.
    h : int
        Below half the number of sectors.

    Returns
    -------
    basis : (6 nodes, m) sparse
        a, then b, from the unknowns; its columns are orthonormal. With h = 0 each of them is in one
        of both.
    node : (m,) ndarray of int
        The node that each unknown belongs to.

    Examples
    --------
    Three real unknowns on the cut face, as on the middle plane; on the axis one or none:

    >>> none = np.zeros(0, int)
    >>> cut = HalfSector(5, none, np.array([0]), none)
    >>> middle, axis = (HalfSector(5, *own) for own in ((np.array([0]), none, none), (none, none, np.array([0]))))
    >>> [[basis(own, 1, h)[0].shape[1] for h in (0, 1, 2)] for own in (cut, middle, axis)]
    [[3, 3, 3], [3, 3, 3], [1, 1, 0]]
    """
    inside = np.setdiff1d(np.arange(nodes), np.r_[half.middle, half.cut, half.axis])
    real, imaginary = np.eye(6)[:, :3], np.eye(6)[:, 3:]
    s, c = np.sin(half.angle / 2), np.cos(half.angle / 2)
    radial, along, around = np.array([[s, 0.0, c], [0.0, 1.0, 0.0], [c, 0.0, -s]])
    cos, sin = np.cos(h * half.angle / 2), np.sin(h * half.angle / 2)
    on_cut = np.array(
        [
            np.r_[cos * radial, sin * radial],
            np.r_[cos * along, sin * along],
            np.r_[-sin * around, cos * around],
        ]
    ).T
    on_axis = {0: real[:, [1]], 1: (real[:, [2]] + imaginary[:, [0]]) / np.sqrt(2)}
    kinds = (
        (inside, np.eye(6)),
        (half.middle, np.column_stack([real[:, 1:], imaginary[:, 0]])),
        (half.cut, on_cut),
        (half.axis, on_axis.get(h, np.zeros((6, 0)))),
    )
    rows, columns, values, node, size = [], [], [], [], 0
    for own, motions in kinds:
        wide = motions.shape[1]
        place = 3 * nodes * (np.arange(6) // 3) + np.arange(6) % 3
        i = 3 * own[:, None, None] + place[:, None]
        j = size + wide * np.arange(len(own))[:, None, None] + np.arange(wide)
        i, j, v = np.broadcast_arrays(i, j, motions)
        some = v != 0.0
        rows.append(i[some])
        columns.append(j[some])
        values.append(v[some])
        node.append(np.repeat(own, wide))
        size += wide * len(own)
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return sp.csr_matrix(entries, shape=(6 * nodes, size)), np.concatenate(node)


def half_sector_blocks(
    mesh: HalfSectorSolid,
    scene: Any,
    wanted: Sequence[tuple[Any, str]],
    parts_of: Callable[[Any, str], Any],
    harmonics: Sequence[int] = (),
) -> tuple[Block, ...]:
    """Blocks of a whole part from the mesh of half a sector, as by
    :func:`solidgear.models.sector.cyclic.cyclic_blocks`: ``axial``, ``torsion``, ``bending_z`` and
    its mirror image ``bending_x``, and ``ovalising_h`` without ports, which stands for its twin as
    well.
    """
    k, m = _matrices(mesh, [segment.material for segment in scene.segments])
    m, n, half = m.tocsr(), mesh.nodes.shape[1], mesh.sector
    rigid = rigid_motions(mesh.nodes)
    seats = []
    for station, attachment in wanted:
        pieces, held = parts_of(station, attachment)
        gram, loads = weighed(pieces, station.y, n)
        seats.append((station, held, _around(gram, half), loads))
    both = [sp.block_diag([x, x], format="csr") for x in (k, m)]
    blocks: list[Block] = []
    still, node = basis(half, n, 0)
    # a holds axial motion, b torsion: the columns of each
    turning = np.asarray(abs(still[3 * n :]).sum(axis=0)).ravel() > 0
    for name, own, one in (("axial", ~turning, 0), ("torsion", turning, 1)):
        t = still[3 * n * one : 3 * n * (one + 1)][:, own]
        blocks.append(_block(name, (k, m), t, node[own], mesh, rigid, seats))
    t, node = basis(half, n, 1)
    bending = _block("bending_z", both, t, node, mesh, rigid, seats)
    blocks += [bending, bending.mirrored("bending_x", (0, 5), len(blocks), (1.0, -1.0))]
    for h in harmonics:
        t, node = basis(half, n, h)
        blocks.append(_block(f"ovalising_{h}", both, t, node, mesh, rigid, ()))
    return tuple(blocks)


def _around(gram: np.ndarray, half: HalfSector) -> np.ndarray:
    """The Gram matrix of a whole seat from that of its part on the half."""
    gram = gram + _MIRROR6 @ gram @ _MIRROR6
    turns = [rotation(1, k * half.angle) for k in range(half.count)]
    return sum(turn @ gram @ turn.T for turn in turns)


def _block(name, matrices, t, node, mesh: HalfSectorSolid, rigid, seats) -> Block:
    h, components = PORTED.get(name, (2, ()))
    # both halves of all sectors; cos^2 and sin^2 of the phases are one half on the mean
    energy = 2 * mesh.sector.count if h == 0 else mesh.sector.count
    stiffness, mass = (energy * (t.T @ x @ t) for x in matrices)
    ports = []
    for station, held, gram, loads in seats:
        if held is not None:
            ports.append(Attached(station.y, held=np.isin(node, held)))
            continue
        own = gram[np.ix_(components, components)]
        motion = np.linalg.solve(own, energy * (t.T @ _in_parts(loads, components)).T)
        motion[np.abs(motion) < ROUNDING * np.abs(motion).max(axis=1, keepdims=True)] = 0.0
        ports.append(Attached(station.y, motion))
    block = Block(
        name,
        components,
        stiffness.tocsr(),
        mass.tocsr(),
        t.T @ _in_parts(rigid, components) if components else np.zeros((t.shape[1], 0)),
        mesh.nodes[1, node],
        planar=False,
        expand=t.tocsr(),
    )
    return with_ports(block, ports)


def _in_parts(six: np.ndarray, components: tuple[int, ...]) -> np.ndarray:
    """Rigid motions, or loads on them, of a whole part as a, and with waves b below it.

    Seen in turned axes a translation along z becomes ``e^{i k alpha} (z + i x)``, and the axis of a
    tilt about x turns the other way, from x to -z.
    """
    own = six[:, list(components)]
    return np.vstack([own, six[:, [0, 5]] * (1.0, -1.0)]) if components == (2, 3) else own


@dataclass(frozen=True, eq=False)
class HalfSectorSolid(PieceSolid):
    """The mesh of half a sector, which draws the whole part."""

    sector: HalfSector

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """All copies of the half and of its image, each with its phase."""
        half, parts = self.sector, []
        for name, vector in moved.items():
            a, b = (
                solid_surface(self, part).displacement for part in _real_and_not(self, name, vector)
            )
            parts.append((name, a, b))
        rest = solid_surface(self, None)
        copies = []
        for k in range(half.count):
            angle = k * half.angle + half.turn
            turn = rotation(1, angle)[:3, :3]
            for side, image in ((1.0, np.eye(3)), (-1.0, np.diag(_MIRROR))):
                local = np.zeros(rest.points.shape)
                for name, a, b in parts:
                    of_a, of_b = _phases(name, angle)
                    local += of_a * a + side * of_b * b
                copies.append((turn @ image, local))
        return copied(rest, copies)


def _real_and_not(mesh: SolidMesh, name: str, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """a and b of the vector of a block."""
    size = 3 * mesh.nodes.shape[1]
    zero = np.zeros(size)
    if name == "axial":
        return vector, zero
    return (zero, vector) if name == "torsion" else (vector[:size], vector[size:])


def _phases(name: str, angle: float) -> tuple[float, float]:
    """Of a and b in a copy at some angle: the real part of ``e^{i h angle} (a + i b)``, times -i in
    the plane of x.
    """
    if name in ("axial", "torsion"):
        return 1.0, 1.0
    if name == "bending_x":
        return np.sin(angle), np.cos(angle)
    h = 1 if name == "bending_z" else int(name.rsplit("_", 1)[1])
    return np.cos(h * angle), -np.sin(h * angle)


def half_sector_solid(made: SectorMesh) -> HalfSectorSolid:
    """The isoparametric mesh of half a sector, its planes found."""
    plain = _isoparametric(made.mesh, "tet10", made.segment)
    outside = made.mesh.boundary_facets()
    x, _, z = made.mesh.p[:, made.mesh.facets[:, outside]]
    tolerance = MATCH * np.ptp(made.mesh.p[1])
    c, s = np.cos(np.pi / made.count), np.sin(np.pi / made.count)
    planes = [outside[(np.abs(away) < tolerance).all(axis=0)] for away in (x, x * c - z * s)]
    middle, cut = (plain.facet_unknowns(own) for own in planes)
    axis = np.intersect1d(middle, cut)
    half = HalfSector(
        made.count, np.setdiff1d(middle, axis), np.setdiff1d(cut, axis), axis, made.turn
    )
    return HalfSectorSolid(
        plain.mesh,
        plain.name,
        plain.element,
        plain.dofs,
        plain.nodes,
        plain.segment,
        np.concatenate(planes),
        half,
    )
