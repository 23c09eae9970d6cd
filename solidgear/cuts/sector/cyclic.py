r"""A part of equal sectors from one of them: blocks of cyclic symmetry.

Copy k of the sector is turned by ``k alpha`` about y, ``alpha = 2 pi / N``, and its displacement,
seen in its own turned axes, is ``v_k = Re(e^{i k h alpha} V)`` for the harmonic index h. On the cut
faces ``V_slave = e^{i h alpha} R(alpha) V_master``: with ``V = T q``,

    K_h = T^H K T,    energy (N/2) q^H K_h q for 0 < h < N/2, and N q' K_0 q,

where a Hermitian ``A + i B`` is solved as the real ``[[A, -B], [B, A]]`` whose eigenvalues are pairs
(Thomas 1979, Int. J. Numer. Methods Eng. 14, 81). Points on the axis are slaves of themselves, with
the axial motion left for h = 0 and one complex number for h = 1, along the eigenvector of R to
``e^{-i alpha}``.

Translation and rotation along y are h = 0, those across it h = 1, so that ports move in these two
only. Sums over copies give the port rows: with the loads ``b`` and the Gram matrix ``A`` of the
sector's part of a seat, the motion is ``A_full^{-1} Re(P b' T q)`` with
``P = sum_k e^{i k h alpha} Rot6^k``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from solidgear.core import Block, rotation
from solidgear.core.kernel.attachment import Attached, with_ports
from solidgear.core.models.solid.block import rigid_motions
from solidgear.core.models.solid.matrices import _matrices, weighed
from solidgear.core.models.solid.mesh import SolidMesh

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.scene.shaft import Station

#: port components of the two harmonics that ports move in
PORTED: dict[int, tuple[int, ...]] = {0: (1, 4), 1: (0, 2, 3, 5)}
#: shares of a port row below which an entry is rounding
ROUNDING = 1e-14
_TURN = sp.csr_matrix([[0.0, -1.0], [1.0, 0.0]])


@dataclass(frozen=True)
class Sector:
    """Nodes of a sector on cut faces and axis."""

    count: int  #: sectors around, at least 3
    master: np.ndarray  #: (k,) nodes on a cut face
    slave: np.ndarray  #: (k,) their images on the opposite cut face
    axis: np.ndarray  #: (a,) nodes on the axis

    @property
    def angle(self) -> float:
        """Angle of the sector, rad."""
        return 2 * np.pi / self.count


def basis(sector: Sector, nodes: int, h: int) -> tuple[sp.csr_matrix, np.ndarray, np.ndarray]:
    """Return the basis T (3 nodes, m) of motions of one sector with harmonic index h, below half the
    number of sectors and real for h = 0; the same without slaves, whose columns are orthonormal, so
    that ``q = free^H V``; and the node (m,) of each unknown.

    Examples
    --------
    A node on the axis moves along it, or across it by one complex number:

    >>> alone = Sector(5, np.zeros(0, int), np.zeros(0, int), np.array([0]))
    >>> [basis(alone, 1, h)[0].shape[1] for h in (0, 1, 2)]
    [1, 1, 0]
    """
    inside = np.ones(nodes, bool)
    inside[sector.slave] = inside[sector.axis] = False
    masters = np.flatnonzero(inside)
    column = np.full(nodes, -1)
    column[masters] = 3 * np.arange(len(masters))
    on_axis = np.zeros((3, 0))
    if h < 2:
        on_axis = np.array([[0.0], [1.0], [0.0]]) if h == 0 else _across(sector.angle)
    wide = on_axis.shape[1]
    size = 3 * len(masters) + wide * len(sector.axis)
    turn = np.exp(1j * h * sector.angle) * rotation(1, sector.angle)[:3, :3]
    free = _blocks(masters, column[masters], np.eye(3), (3 * nodes, size))
    first = 3 * len(masters) + wide * np.arange(len(sector.axis))
    free = free + _blocks(sector.axis, first, on_axis, (3 * nodes, size))
    full = free + _blocks(sector.slave, column[sector.master], turn, (3 * nodes, size))
    node = np.r_[np.repeat(masters, 3), np.repeat(sector.axis, wide)]
    if h == 0:
        full, free = full.real, free.real
    return full.tocsr(), free.tocsr(), node


def _across(angle: float) -> np.ndarray:
    """Return the unit motion (3, 1) across the axis that a turn takes to ``e^{-i angle}`` times
    itself.
    """
    turn = rotation(1, angle)[:3, :3]
    motion = np.array([[1.0], [0.0], [1j]]) / np.sqrt(2)
    return motion if np.allclose(turn @ motion, np.exp(-1j * angle) * motion) else motion.conj()


def _blocks(nodes, columns, block, shape) -> sp.csr_matrix:
    rows, wide = 3 * np.asarray(nodes)[:, None, None], block.shape[1]
    i = np.broadcast_to(rows + np.arange(3)[:, None], (len(nodes), 3, wide))
    j = np.asarray(columns)[:, None, None] + np.arange(wide)
    j = np.broadcast_to(j, (len(nodes), 3, wide))
    v = np.broadcast_to(block, (len(nodes), 3, wide))
    return sp.csr_matrix((v.ravel().astype(complex), (i.ravel(), j.ravel())), shape=shape)


def doubled(matrix: sp.csr_matrix) -> sp.csr_matrix:
    """Return the real matrix (2 n, 2 m) that acts on real and imaginary parts side by side.

    Examples
    --------
    >>> doubled(sp.csr_matrix([[2 + 3j]])).toarray()
    array([[ 2., -3.],
           [ 3.,  2.]])
    """
    real, imaginary = (sp.csr_matrix(part) for part in (matrix.real, matrix.imag))
    return (sp.kron(real, sp.eye(2)) + sp.kron(imaginary, _TURN)).tocsr()


def _interleaved(matrix: np.ndarray) -> np.ndarray:
    """Return the real and imaginary parts (2 n, c) of the rows of a complex (n, c)."""
    return np.stack([matrix.real, matrix.imag], axis=1).reshape(2 * len(matrix), -1)


#: pieces whose mean motion is that of a station, and the nodes that a rigid seat holds
SeatParts = tuple[Iterable, np.ndarray | None]


def cyclic_blocks(
    mesh: SolidMesh,
    sector: Sector,
    scene: Scene,
    wanted: Sequence[tuple[Station, str]],
    parts_of: Callable[[Station, str], SeatParts],
    harmonics: Sequence[int] = (),
) -> tuple[Block, ...]:
    """Return the blocks of a whole part from the mesh of one sector: ``cyclic_0`` (components 1, 4),
    ``cyclic_1`` (0, 2, 3, 5), and ``cyclic_h`` without ports for further harmonics from 2 on.

    ``parts_of(station, attachment)`` gives pieces of the surface, or of the material, whose mean
    motion is that of the station (:meth:`SolidMesh.over_facets`), and the nodes that a rigid seat
    holds, None for any other.
    """
    k, m = _matrices(mesh, [segment.material for segment in scene.segments])
    m, n = m.tocsr(), mesh.nodes.shape[1]
    rigid = rigid_motions(mesh.nodes)
    seats = []
    for station, attachment in wanted:
        pieces, rigid_nodes = parts_of(station, attachment)
        seats.append((station, rigid_nodes, *weighed(pieces, station.y, n)))
    blocks = []
    for h in (0, 1, *harmonics):
        t, free, node = basis(sector, n, h)
        blocks.append(_block(h, k, m, t, free, node, mesh.nodes[1], rigid, sector, seats))
    return tuple(blocks)


def _block(h, k, m, t, free, node, y, rigid, sector: Sector, seats) -> Block:
    count, components = sector.count, PORTED.get(h, ())
    turns = [rotation(1, j * sector.angle) for j in range(count)]
    phase = np.exp(1j * h * sector.angle * np.arange(count))
    real = h == 0
    spread = sp.csr_matrix if real else doubled
    energy = count if real else count / 2
    conjugate = t.conj().T
    stiffness, mass = (energy * spread((conjugate @ x @ t).tocsr()) for x in (k, m))
    # rigid motions of the whole part, in the turned axes of its copies
    back = sum(p.conj() * turn.T for p, turn in zip(phase, turns)) / energy
    columns = free.conj().T @ (rigid @ back[:, components])
    columns = columns.real if real else _interleaved(columns)
    places = y[node] if real else np.repeat(y[node], 2)
    ports = []
    for station, rigid_nodes, gram, loads in seats if components else ():
        if rigid_nodes is not None:
            mask = np.isin(node, rigid_nodes)
            ports.append(Attached(station.y, held=mask if real else np.repeat(mask, 2)))
            continue
        seat_gram = sum(turn @ gram @ turn.T for turn in turns)[np.ix_(components, components)]
        summed = sum(p * turn for p, turn in zip(phase, turns))[list(components)]
        motion = np.linalg.solve(seat_gram, summed @ (t.T @ loads).T)
        motion = motion.real if real else _interleaved(motion.conj().T).T
        motion[np.abs(motion) < ROUNDING * np.abs(motion).max(axis=1, keepdims=True)] = 0.0
        ports.append(Attached(station.y, motion))
    block = Block(
        f"cyclic_{h}",
        components,
        stiffness.tocsr(),
        mass.tocsr(),
        columns,
        places,
        planar=False,
        expand=spread(t),
    )
    return with_ports(block, ports)
