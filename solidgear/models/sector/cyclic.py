r"""A part of equal sectors from one of them: blocks of cyclic symmetry.

Copy k of the sector is turned by ``k alpha`` about y, ``alpha = 2 pi / N``, and its displacement,
seen in its own turned axes, is ``v_k = Re(e^{i k h alpha} V)`` for the harmonic index h. On the cut
faces ``V_slave = e^{i h alpha} R(alpha) V_master``: with ``V = T q``,

    K_h = T^H K T,    energy (N/2) q^H K_h q for 0 < h < N/2, and N q' K_0 q,

where a Hermitian ``A + i B`` is solved as the real ``[[A, -B], [B, A]]`` whose eigenvalues are pairs
(Thomas 1979, Int. J. Numer. Methods Eng. 14, 81). Points on the axis are their own slaves: what is
left to them is the axial motion for h = 0 and one complex number for h = 1, along the eigenvector
of R to ``e^{-i alpha}``.

Translation and rotation along y are h = 0, those across it h = 1, so that ports move in these two
only. Sums over copies give the port rows: with the loads ``b`` and the Gram matrix ``A`` of the
sector's part of a seat, the motion is ``A_full^{-1} Re(P b' T q)`` with
``P = sum_k e^{i k h alpha} Rot6^k``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from solidgear.body import Block
from solidgear.frames import rotation
from solidgear.kernel.attachment import Attached, with_ports
from solidgear.models.solid.block import rigid_motions
from solidgear.models.solid.matrices import _matrices, weighed
from solidgear.models.solid.mesh import SolidMesh

#: port components of the two harmonics that ports move in
PORTED: dict[int, tuple[int, ...]] = {0: (1, 4), 1: (0, 2, 3, 5)}
#: shares of a port row below which an entry is rounding
ROUNDING = 1e-14
_TURN = sp.csr_matrix([[0.0, -1.0], [1.0, 0.0]])


@dataclass(frozen=True)
class Sector:
    """Nodes of a sector and how they repeat themselves."""

    count: int  #: sectors around, at least 3
    #: master, slave: (k,) nodes on both cut faces, one the image of the other
    master: np.ndarray
    slave: np.ndarray
    axis: np.ndarray  #: (a,) nodes on the axis

    @property
    def angle(self) -> float:
        """Of the sector, rad."""
        return 2 * np.pi / self.count


def basis(sector: Sector, nodes: int, h: int) -> tuple[sp.csr_matrix, np.ndarray, np.ndarray]:
    """Motions of one sector that go with one harmonic index.

    Parameters
    ----------
    nodes : int
        Of the sector.
    h : int
        Below half the number of sectors.

    Returns
    -------
    basis : (3 nodes, m) sparse
        T; real for h = 0.
    own : (3 nodes, m) sparse
        The same without slaves: its columns are orthonormal, so that ``q = own^H V``.
    node : (m,) ndarray of int
        The node that each unknown belongs to.

    Examples
    --------
    A node on the axis moves along it, or across it by one complex number:

    >>> alone = Sector(5, np.zeros(0, int), np.zeros(0, int), np.array([0]))
    >>> [basis(alone, 1, h)[0].shape[1] for h in (0, 1, 2)]
    [1, 1, 0]
    """
    free = np.ones(nodes, bool)
    free[sector.slave] = free[sector.axis] = False
    kept = np.flatnonzero(free)
    column = np.full(nodes, -1)
    column[kept] = 3 * np.arange(len(kept))
    on_axis = {0: np.array([[0.0], [1.0], [0.0]]), 1: _across(sector.angle)}.get(
        h, np.zeros((3, 0))
    )
    wide = on_axis.shape[1]
    size = 3 * len(kept) + wide * len(sector.axis)
    turn = np.exp(1j * h * sector.angle) * rotation(1, sector.angle)[:3, :3]
    own = _blocks(kept, column[kept], np.eye(3), (3 * nodes, size))
    first = 3 * len(kept) + wide * np.arange(len(sector.axis))
    own = own + _blocks(sector.axis, first, on_axis, (3 * nodes, size))
    every = own + _blocks(sector.slave, column[sector.master], turn, (3 * nodes, size))
    node = np.r_[np.repeat(kept, 3), np.repeat(sector.axis, wide)]
    if h == 0:
        every, own = every.real, own.real
    return every.tocsr(), own.tocsr(), node


def _across(angle: float) -> np.ndarray:
    """(3, 1) unit motion across the axis that a turn takes to ``e^{-i angle}`` times itself."""
    turn = rotation(1, angle)[:3, :3]
    one = np.array([[1.0], [0.0], [1j]]) / np.sqrt(2)
    return one if np.allclose(turn @ one, np.exp(-1j * angle) * one) else one.conj()


def _blocks(nodes, columns, block, shape) -> sp.csr_matrix:
    rows, wide = 3 * np.asarray(nodes)[:, None, None], block.shape[1]
    i = np.broadcast_to(rows + np.arange(3)[:, None], (len(nodes), 3, wide))
    j = np.asarray(columns)[:, None, None] + np.arange(wide)
    j = np.broadcast_to(j, (len(nodes), 3, wide))
    v = np.broadcast_to(block, (len(nodes), 3, wide))
    return sp.csr_matrix((v.ravel().astype(complex), (i.ravel(), j.ravel())), shape=shape)


def doubled(matrix: sp.csr_matrix) -> sp.csr_matrix:
    """The real matrix (2 n, 2 m) that acts on real and imaginary parts side by side.

    Examples
    --------
    >>> doubled(sp.csr_matrix([[2 + 3j]])).toarray()
    array([[ 2., -3.],
           [ 3.,  2.]])
    """
    real, imaginary = (sp.csr_matrix(part) for part in (matrix.real, matrix.imag))
    return (sp.kron(real, sp.eye(2)) + sp.kron(imaginary, _TURN)).tocsr()


def _interleaved(matrix: np.ndarray) -> np.ndarray:
    """(2 n, c) real and imaginary parts of the rows of a complex (n, c)."""
    return np.stack([matrix.real, matrix.imag], axis=1).reshape(2 * len(matrix), -1)


def cyclic_blocks(
    mesh: SolidMesh,
    scene: Any,
    sector: Sector,
    wanted: Sequence[tuple[Any, str]],
    parts_of: Callable[[Any, str], Any],
    harmonics: Sequence[int] = (),
) -> tuple[Block, ...]:
    """Blocks of a whole part from the mesh of one sector: ``cyclic_0`` (components 1, 4), ``cyclic_1``
    (0, 2, 3, 5), and ``cyclic_h`` without ports for further harmonics from 2 on.

    ``parts_of(station, attachment)`` gives pieces of the surface, or of the material, whose mean
    motion is that of the station (:meth:`SolidMesh.over_facets`), and the nodes that a rigid seat
    holds, None for any other.
    """
    k, m = _matrices(mesh, [segment.material for segment in scene.segments])
    m, n = m.tocsr(), mesh.nodes.shape[1]
    rigid = rigid_motions(mesh.nodes)
    seats = []
    for station, attachment in wanted:
        pieces, held = parts_of(station, attachment)
        seats.append((station, held, *weighed(pieces, station.y, n)))
    blocks = []
    for h in (0, 1, *harmonics):
        t, own, node = basis(sector, n, h)
        blocks.append(_block(h, k, m, t, own, node, mesh.nodes[1], rigid, sector, seats))
    return tuple(blocks)


def _block(h, k, m, t, own, node, y, rigid, sector: Sector, seats) -> Block:
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
    columns = own.conj().T @ (rigid @ back[:, components])
    columns = columns.real if real else _interleaved(columns)
    where = y[node] if real else np.repeat(y[node], 2)
    ports = []
    for station, held, gram, loads in seats if components else ():
        if held is not None:
            mask = np.isin(node, held)
            ports.append(Attached(station.y, held=mask if real else np.repeat(mask, 2)))
            continue
        whole = sum(turn @ gram @ turn.T for turn in turns)[np.ix_(components, components)]
        summed = sum(p * turn for p, turn in zip(phase, turns))[list(components)]
        motion = np.linalg.solve(whole, summed @ (t.T @ loads).T)
        motion = motion.real if real else _interleaved(motion.conj().T).T
        motion[np.abs(motion) < ROUNDING * np.abs(motion).max(axis=1, keepdims=True)] = 0.0
        ports.append(Attached(station.y, motion))
    block = Block(
        f"cyclic_{h}",
        components,
        stiffness.tocsr(),
        mass.tocsr(),
        columns,
        where,
        planar=False,
        expand=spread(t),
    )
    return with_ports(block, ports)
