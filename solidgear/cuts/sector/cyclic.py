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

What one order more adds to the mesh is tied by the same basis, with edges and faces for nodes: a
slave follows its master, with the other sign where its edge runs the other way round.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from solidgear.core import Block, rotation
from solidgear.core.body.model import Enrichment
from solidgear.core.body.symmetric import Symmetric
from solidgear.core.kernel.attachment import Attached, with_ports
from solidgear.core.models.solid.block import rigid_motions
from solidgear.core.models.solid.enriched import Addition, Seat
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


def cyclic_blocks(
    mesh: SolidMesh,
    sector: Sector,
    scene: Scene,
    wanted: Sequence[tuple[Station, str]],
    seat_of: Callable[[Station, str], Seat],
    harmonics: Sequence[int] = (),
) -> tuple[Block, ...]:
    """Return the blocks of a whole part from the mesh of one sector: ``cyclic_0`` (components 1, 4),
    ``cyclic_1`` (0, 2, 3, 5), and ``cyclic_h`` without ports for further harmonics from 2 on.

    ``seat_of(station, attachment)`` gives the part of a seat that lies in the sector.
    """
    materials = [segment.material for segment in scene.segments]
    k, m = _matrices(mesh, materials)
    m, n = m.tocsr(), mesh.nodes.shape[1]
    rigid = rigid_motions(mesh.nodes)
    seats = []
    for station, attachment in wanted:
        seat = seat_of(station, attachment)
        seats.append((seat, *weighed(seat.pieces(mesh), station.y, n)))
    # the blocks share it
    addition = cache(partial(Addition.of_mesh, mesh, materials))
    blocks = []
    for h in (0, 1, *harmonics):
        wave = Wave(sector, h)
        block = _block(wave, k, m, mesh, rigid, seats)
        grams = [(seat, gram) for seat, gram, _ in seats]
        blocks.append(replace(block, enrich=partial(_enrichment, addition, wave, grams)))
    return tuple(blocks)


@dataclass(frozen=True)
class Wave:
    """Motions of a part of equal sectors with one harmonic index."""

    sector: Sector
    h: int

    @property
    def components(self) -> tuple[int, ...]:
        """Components of ports that move."""
        return PORTED.get(self.h, ())

    @property
    def copies(self) -> float:
        """Energy of all sectors over that of the complex motion of one."""
        return self.sector.count if self.h == 0 else self.sector.count / 2

    @cached_property
    def turns(self) -> list[np.ndarray]:
        """(6, 6) turns of the copies."""
        return [rotation(1, j * self.sector.angle) for j in range(self.sector.count)]

    @cached_property
    def phases(self) -> np.ndarray:
        """(count,) phases of the copies."""
        return np.exp(1j * self.h * self.sector.angle * np.arange(self.sector.count))

    def spread(self, matrix: sp.csr_matrix) -> sp.csr_matrix:
        """Return a matrix that acts on the real unknowns."""
        return sp.csr_matrix(matrix) if self.h == 0 else doubled(matrix)

    def repeated(self, values: np.ndarray) -> np.ndarray:
        """Return values (m,) of complex unknowns, of the real ones."""
        return values if self.h == 0 else np.repeat(values, 2)

    def motion(self, gram: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Return the motion (c, m) of a whole seat by the real unknowns, from the Gram matrix of its
        part on the sector and the loads (m, 6) there on the complex ones.
        """
        components = list(self.components)
        seat_gram = sum(turn @ gram @ turn.T for turn in self.turns)[np.ix_(components, components)]
        summed = sum(p * turn for p, turn in zip(self.phases, self.turns))[components]
        motion = np.linalg.solve(seat_gram, summed @ loads.T)
        motion = motion.real if self.h == 0 else _interleaved(motion.conj().T).T
        motion[np.abs(motion) < ROUNDING * np.abs(motion).max(axis=1, keepdims=True)] = 0.0
        return motion


def _block(wave: Wave, k, m, mesh: SolidMesh, rigid, seats) -> Block:
    t, free, node = basis(wave.sector, mesh.nodes.shape[1], wave.h)
    components, conjugate = wave.components, t.conj().T
    stiffness, mass = (wave.copies * wave.spread((conjugate @ x @ t).tocsr()) for x in (k, m))
    # rigid motions of the whole part, in the turned axes of its copies
    back = sum(p.conj() * turn.T for p, turn in zip(wave.phases, wave.turns)) / wave.copies
    columns = free.conj().T @ (rigid @ back[:, components])
    columns = columns.real if wave.h == 0 else _interleaved(columns)
    ports = []
    for seat, gram, loads in seats if components else ():
        if seat.rigid:
            mask = np.isin(node, mesh.facet_unknowns(seat.facets))
            ports.append(Attached(seat.place, held=wave.repeated(mask)))
        else:
            ports.append(Attached(seat.place, wave.motion(gram, t.T @ loads)))
    block = Block(
        f"cyclic_{wave.h}",
        components,
        stiffness.tocsr(),
        mass.tocsr(),
        columns,
        wave.repeated(mesh.nodes[1, node]),
        planar=False,
        expand=wave.spread(t),
    )
    return with_ports(block, ports)


def _enrichment(
    addition: Callable[[], Addition], wave: Wave, seats: Sequence[tuple[Seat, np.ndarray]]
) -> Enrichment:
    """Compute what one order more adds to a block: functions on slaves are tied as nodes are."""
    more, components = addition(), wave.components
    functions, signs = _functions(more, wave.sector)
    t, _, function = basis(functions, more.count, wave.h)
    t = sp.diags(np.repeat(signs, 3)) @ t
    size = len(wave.repeated(function))
    still, rows = np.zeros(0, int), [np.zeros((0, size))]
    for seat, gram in seats if components else ():
        if seat.rigid:
            still = np.r_[still, more.alive(seat.facets)]
            rows.append(np.zeros((len(components), size)))
        else:
            rows.append(wave.motion(gram, t.T @ more.loads(seat)))
    back = wave.copies * t.conj().T
    inertia = sp.kron(more.inertia, sp.identity(3))
    tied = np.arange(more.count)
    tied[functions.slave] = functions.master
    return Enrichment(
        Symmetric(sp.triu(wave.spread(back @ more.stiffness.tocsr() @ t), format="csr")),
        wave.spread(back @ more.coupling),
        wave.spread(back @ inertia),
        np.arange(size),
        np.vstack(rows),
        wave.repeated(np.where(np.isin(function, still), 0.0, 1.0)),
        wave.repeated(function),
        tied[more.numbers],
    )


def _functions(more: Addition, sector: Sector) -> tuple[Sector, np.ndarray]:
    """Return the functions of one order more on cut faces and axis, and the signs (w,) with which
    those of slaves follow their masters: an edge may run the other way round.
    """
    m = more.mesh
    of_node, ends = functions_of_edges(more)
    image = np.arange(m.nodes.shape[1])
    image[sector.slave] = sector.master
    on_edge = of_node[sector.slave] >= 0
    slave, master = (of_node[nodes[on_edge]] for nodes in (sector.slave, sector.master))
    axis = of_node[sector.axis]
    signs = np.ones(more.count)
    start, end = ends[:, slave]
    signs[slave] = np.where((start < end) == (image[start] < image[end]), 1.0, -1.0)
    corners, of_face = functions_of_faces(more, m.mesh.boundary_facets())
    faces = []
    for side in (sector.slave, sector.master):
        on_side = np.isin(corners, np.r_[side, sector.axis]).all(axis=0)
        order = np.lexsort(np.sort(image[corners[:, on_side]], axis=0))
        faces.append(of_face[on_side][order])
    return (
        Sector(sector.count, np.r_[master, faces[1]], np.r_[slave, faces[0]], axis[axis >= 0]),
        signs,
    )


def functions_of_edges(more: Addition) -> tuple[np.ndarray, np.ndarray]:
    """Return the function on the edge of every middle node (n,), -1 for corners, and the nodes (2,
    w) at the ends of edges, by their functions.
    """
    m, edges = more.mesh, more.further.refdom.edges
    of_node = np.full(m.nodes.shape[1], -1)
    ends = np.full((2, more.count), -1)
    corners = len(m.mesh.t)
    for k, edge in enumerate(edges):
        of_node[m.dofs[corners + k]] = more.numbers[k]
        ends[:, more.numbers[k]] = m.dofs[list(edge)]
    return of_node, ends


def functions_of_faces(more: Addition, facets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes (3, f) at the corners of some facets, and the function (f,) on each."""
    m = more.mesh
    corners, functions = [], []
    for place, cells in m.local_facets(facets):
        corners.append(m.dofs[m.mesh.refdom.facets[place]][:, cells])
        functions.append(more.numbers[len(m.mesh.t2e) + place, cells])
    return np.hstack(corners), np.concatenate(functions)
