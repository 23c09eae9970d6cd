r"""A part of equal sectors from half of one: where a sector is even about the middle plane, its
matrices are real.

With ``v_k = Re(e^{i k h alpha} V)`` as in :mod:`solidgear.cuts.sector.cyclic` and the mirror S of the
middle plane, ``conj(S V(S x))`` meets the same conditions on the cut faces as V does. So every
eigenspace has a basis of motions that equal their image: ``V = a + i b`` with a symmetric and b
antisymmetric. On the middle plane a stays in the plane and b moves across it. On the cut face, at
half the angle of the sector,

    V = e^{i h alpha / 2} (w_r r + w_y y + i w_t t),    w real,

with the directions r along the radius and t around: both conditions of the whole sector in one.
Inside a and b do not meet. On the axis h = 0 leaves y to a, and h = 1 one number, ``z + i x``.

There are as many real unknowns as the whole sector has complex ones, and one of every pair of
twins: the other one is ``-i V``. With h = 0 a (axial) and b (torsion) are separate blocks; with
h = 1 the unknowns are bending in the plane of y and z, and the block in the plane of x and y mirrors
it (Thomas 1979 solves the pair at once).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp

from solidgear.core import Block, Surface, rotation
from solidgear.core.body.model import Enrichment
from solidgear.core.body.symmetric import Symmetric
from solidgear.core.kernel.attachment import Attached, with_ports
from solidgear.core.models.solid.block import rigid_motions
from solidgear.core.models.solid.drawing import copied
from solidgear.core.models.solid.enriched import Addition, Seat
from solidgear.core.models.solid.matrices import _matrices, weighed
from solidgear.core.models.solid.mesh import SolidMesh, _isoparametric
from solidgear.cuts.sector.cyclic import ROUNDING, functions_of_edges, functions_of_faces
from solidgear.cuts.sector.mesh import PieceSolid
from solidgear.cuts.sector.meshing import MATCH, SectorMesh

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.scene.shaft import Station

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
    middle: np.ndarray  #: nodes on the middle plane without the axis
    cut: np.ndarray  #: nodes on the cut face without the axis
    axis: np.ndarray  #: nodes on the axis
    turn: float = 0.0  #: angle of the middle of the sector, rad

    @property
    def angle(self) -> float:
        """Angle of the whole sector, rad."""
        return 2 * np.pi / self.count


def basis(half: HalfSector, nodes: int, h: int) -> tuple[sp.csr_matrix, np.ndarray]:
    """Return the basis (6 nodes, m) of motions of half a sector with harmonic index h, below half the
    number of sectors, and the node (m,) of each unknown.

    Rows are a, then b; columns are orthonormal. With h = 0 each column is in one of both.

    Examples
    --------
    Three real unknowns on the cut face, as on the middle plane; on the axis one or none:

    >>> none, node = np.zeros(0, int), np.array([0])
    >>> cut = HalfSector(5, middle=none, cut=node, axis=none)
    >>> middle = HalfSector(5, middle=node, cut=none, axis=none)
    >>> axis = HalfSector(5, middle=none, cut=none, axis=node)
    >>> [[basis(half, 1, h)[0].shape[1] for h in (0, 1, 2)] for half in (cut, middle, axis)]
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
    for members, motions in kinds:
        wide = motions.shape[1]
        place = 3 * nodes * (np.arange(6) // 3) + np.arange(6) % 3
        i = 3 * members[:, None, None] + place[:, None]
        j = size + wide * np.arange(len(members))[:, None, None] + np.arange(wide)
        i, j, v = np.broadcast_arrays(i, j, motions)
        nonzero = v != 0.0
        rows.append(i[nonzero])
        columns.append(j[nonzero])
        values.append(v[nonzero])
        node.append(np.repeat(members, wide))
        size += wide * len(members)
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return sp.csr_matrix(entries, shape=(6 * nodes, size)), np.concatenate(node)


def half_sector_blocks(
    mesh: HalfSectorSolid,
    scene: Scene,
    wanted: Sequence[tuple[Station, str]],
    seat_of: Callable[[Station, str], Seat],
    harmonics: Sequence[int] = (),
) -> tuple[Block, ...]:
    """Return the blocks of a whole part from the mesh of half a sector, as by
    :func:`solidgear.cuts.sector.cyclic.cyclic_blocks`: ``axial``, ``torsion``, ``bending_z`` and
    its mirror image ``bending_x``, and ``ovalising_h`` without ports, which stands for its twin as
    well.
    """
    materials = [segment.material for segment in scene.segments]
    k, m = _matrices(mesh, materials)
    matrices, n = (k, m.tocsr()), mesh.nodes.shape[1]
    rigid = rigid_motions(mesh.nodes)
    seats = []
    for station, attachment in wanted:
        seat = seat_of(station, attachment)
        gram, loads = weighed(seat.pieces(mesh), station.y, n)
        seats.append((seat, _around(gram, mesh.sector), loads))
    # the blocks share it
    addition = cache(partial(Addition.of_mesh, mesh, materials))
    blocks: list[Block] = []
    for name in (*PORTED, *(f"ovalising_{h}" for h in harmonics)):
        grams = [(seat, gram) for seat, gram, _ in seats]
        enrich = partial(_enrichment, addition, name, mesh.sector, grams)
        block = replace(_block(name, matrices, mesh, rigid, seats), enrich=enrich)
        blocks.append(block)
        if name == "bending_z":
            place = len(blocks) - 1
            blocks.append(block.mirrored("bending_x", (0, 5), place, (1.0, -1.0)))
    return tuple(blocks)


def _around(gram: np.ndarray, half: HalfSector) -> np.ndarray:
    """Return the Gram matrix of a whole seat from that of its part on the half."""
    gram = gram + _MIRROR6 @ gram @ _MIRROR6
    turns = [rotation(1, k * half.angle) for k in range(half.count)]
    return sum(turn @ gram @ turn.T for turn in turns)


def _block(name: str, matrices, mesh: HalfSectorSolid, rigid, seats) -> Block:
    half = mesh.sector
    t, node = _unknowns(name, half, mesh.nodes.shape[1])
    components = _components(name)
    stiffness, mass = (_copies(name, half) * (t.T @ _block_matrix(name, x) @ t) for x in matrices)
    ports = []
    for seat, gram, loads in seats if components else ():
        if seat.rigid:
            mask = np.isin(node, mesh.facet_unknowns(seat.facets))
            ports.append(Attached(seat.place, held=mask))
        else:
            ports.append(Attached(seat.place, _motion(name, half, gram, loads, t)))
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


def _enrichment(
    addition: Callable[[], Addition],
    name: str,
    half: HalfSector,
    seats: Sequence[tuple[Seat, np.ndarray]],
) -> Enrichment:
    """Compute what one order more adds to a block: functions move as nodes in their place do."""
    more, copies, components = addition(), _copies(name, half), _components(name)
    t, function = _unknowns(name, _functions(more, half), more.count)
    still, rows = np.zeros(0, int), [np.zeros((0, len(function)))]
    for seat, gram in seats if components else ():
        if seat.rigid:
            still = np.r_[still, more.alive(seat.facets)]
            rows.append(np.zeros((len(components), len(function))))
        else:
            rows.append(_motion(name, half, gram, more.loads(seat), t))
    inertia = sp.kron(more.inertia, sp.identity(3))
    stiffness = _block_matrix(name, more.stiffness.tocsr())
    return Enrichment(
        Symmetric(sp.triu(copies * (t.T @ stiffness @ t), format="csr")),
        (copies * (t.T @ _block_matrix(name, more.coupling))).tocsr(),
        (copies * (t.T @ _block_matrix(name, inertia))).tocsr(),
        np.arange(len(function)),
        np.vstack(rows),
        np.where(np.isin(function, still), 0.0, 1.0),
        function,
        more.numbers,
    )


def _functions(more: Addition, half: HalfSector) -> HalfSector:
    """Return the places of the functions of one order more."""
    mesh: Any = more.mesh
    of_node, _ = functions_of_edges(more)
    corners, of_face = functions_of_faces(more, mesh.inner)
    on_cut = np.isin(corners, half.cut).any(axis=0)
    middle, cut, axis = (of_node[nodes] for nodes in (half.middle, half.cut, half.axis))
    return replace(
        half,
        middle=np.r_[middle[middle >= 0], of_face[~on_cut]],
        cut=np.r_[cut[cut >= 0], of_face[on_cut]],
        axis=axis[axis >= 0],
    )


def _components(name: str) -> tuple[int, ...]:
    """Return the components of ports that move in a block."""
    return PORTED[name][1] if name in PORTED else ()


def _harmonic(name: str) -> int:
    """Return the harmonic index of a block."""
    return PORTED[name][0] if name in PORTED else int(name.rsplit("_", 1)[1])


def _copies(name: str, half: HalfSector) -> int:
    """Return the energy of both halves of all sectors over that of a, and with waves b: cos^2 and
    sin^2 of the phases are one half on the mean.
    """
    return 2 * half.count if _harmonic(name) == 0 else half.count


def _block_matrix(name: str, matrix: sp.spmatrix) -> sp.csr_matrix:
    """Return a matrix of the half for a, or for a and b."""
    parts = [matrix] if _harmonic(name) == 0 else [matrix, matrix]
    return sp.block_diag(parts, format="csr")


def _unknowns(name: str, half: HalfSector, nodes: int) -> tuple[sp.csr_matrix, np.ndarray]:
    """Return the basis of a block, of :func:`basis`, and the node (m,) of each unknown."""
    h = _harmonic(name)
    t, node = basis(half, nodes, h)
    if h:
        return t, node
    # a holds axial motion, b torsion: the columns of each
    part = ("axial", "torsion").index(name)
    rows = t[3 * nodes * part : 3 * nodes * (part + 1)]
    columns = np.asarray(abs(rows).sum(axis=0)).ravel() > 0
    return rows[:, columns], node[columns]


def _motion(
    name: str, half: HalfSector, gram: np.ndarray, loads: np.ndarray, t: sp.csr_matrix
) -> np.ndarray:
    """Return the motion (c, m) of a whole seat by the unknowns, from its Gram matrix and the loads
    of its part on the half.
    """
    components = _components(name)
    block_gram = gram[np.ix_(components, components)]
    block_loads = t.T @ _in_parts(loads, components)
    motion = np.linalg.solve(block_gram, _copies(name, half) * block_loads.T)
    motion[np.abs(motion) < ROUNDING * np.abs(motion).max(axis=1, keepdims=True)] = 0.0
    return motion


def _in_parts(six: np.ndarray, components: tuple[int, ...]) -> np.ndarray:
    """Return rigid motions, or loads on them, of a whole part as a, and with waves b below it.

    Seen in turned axes a translation along z becomes ``e^{i k alpha} (z + i x)``, and the axis of a
    tilt about x turns the other way, from x to -z.
    """
    block_columns = six[:, list(components)]
    return (
        np.vstack([block_columns, six[:, [0, 5]] * (1.0, -1.0)])
        if components == (2, 3)
        else block_columns
    )


@dataclass(frozen=True, eq=False)
class HalfSectorSolid(PieceSolid):
    """The mesh of half a sector, which draws the whole part."""

    sector: HalfSector

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """Return all copies of the half and of its image, each with its phase."""
        half, parts = self.sector, []
        for name, vector in moved.items():
            a, b = (
                self.outline.surface(part).displacement
                for part in _even_and_odd(self, name, vector)
            )
            parts.append((name, a, b))
        undeformed = self.outline.surface(None)
        copies = []
        for k in range(half.count):
            angle = k * half.angle + half.turn
            turn = rotation(1, angle)[:3, :3]
            for side, image in ((1.0, np.eye(3)), (-1.0, np.diag(_MIRROR))):
                local = np.zeros(undeformed.points.shape)
                for name, a, b in parts:
                    of_a, of_b = _phases(name, angle)
                    local += of_a * a + side * of_b * b
                copies.append((turn @ image, local))
        return copied(undeformed, copies)


def _even_and_odd(mesh: SolidMesh, name: str, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a and b of the vector of a block."""
    size = 3 * mesh.nodes.shape[1]
    zero = np.zeros(size)
    if name == "axial":
        return vector, zero
    return (zero, vector) if name == "torsion" else (vector[:size], vector[size:])


def _phases(name: str, angle: float) -> tuple[float, float]:
    """Return the factors of a and b in a copy at an angle: the real part of ``e^{i h angle} (a + i
    b)``, times -i in the plane of x.
    """
    if name in ("axial", "torsion"):
        return 1.0, 1.0
    if name == "bending_x":
        return np.sin(angle), np.cos(angle)
    h = 1 if name == "bending_z" else int(name.rsplit("_", 1)[1])
    return np.cos(h * angle), -np.sin(h * angle)


def half_sector_solid(meshed: SectorMesh) -> HalfSectorSolid:
    """Return the isoparametric mesh of half a sector, with the nodes of the planes."""
    plain = _isoparametric(meshed.mesh, "tet10", meshed.segment)
    outside = meshed.mesh.boundary_facets()
    x, _, z = meshed.mesh.p[:, meshed.mesh.facets[:, outside]]
    tolerance = MATCH * np.ptp(meshed.mesh.p[1])
    c, s = np.cos(np.pi / meshed.count), np.sin(np.pi / meshed.count)
    planes = [
        outside[(np.abs(distance) < tolerance).all(axis=0)] for distance in (x, x * c - z * s)
    ]
    middle, cut = (plain.facet_unknowns(facets) for facets in planes)
    axis = np.intersect1d(middle, cut)
    half = HalfSector(
        meshed.count, np.setdiff1d(middle, axis), np.setdiff1d(cut, axis), axis, meshed.turn
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
