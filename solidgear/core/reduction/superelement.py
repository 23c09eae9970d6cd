r"""A body seen from the ports: a few coordinates, and a way back to the mesh.

Every reduction here is a Ritz basis V of the free body that holds the rigid motions.  Written in the
modes of the free body in the span of V,

    u = V q,      M = 1,      K = diag(0, .., 0, w_1^2, .., w_m^2),      port motions = (G V) q,

so that stiffness is that of strain rows ``diag(w)``, rigid motions are the coordinates that no row
touches, exactly, and two superelements differ in nothing but their V
(:func:`solidgear.core.reduction.rubin.rubin`, :func:`solidgear.core.reduction.craig_bampton.craig_bampton`).

Fields left out by V
--------------------
Let springs of any kind join ports of several bodies and ground, ``B = K + G' Kb G``, and let the
masses ``M`` carry further inertias at ports.  Every basis here holds the rigid motions R and the
static displacements E N of port loads in equilibrium (``P'N = 0`` with P = G R).  A field y with
``V' B y = 0`` then moves no port.  For with d = G y and f = Kb d, R gives ``P'f = 0``, so that
f = N c; E N gives ``N'(d + F f) = 0`` with the flexibility F, hence ``d'Kb d + f'F f = 0``: no spring
is stretched, and d is that of a rigid motion which nothing resists, known exactly and taken out
beforehand.  So Y, all such fields, are those of ``V' K y = 0``, whatever holds the body.

Two things about Y are kept with a superelement, as its
:class:`Truncation`:

- ``cut``, the lowest eigenvalue in Y: ``y' M y <= y' K y / cut``;
- ``defect``, ``V' M Y Y' M V`` for a K-orthonormal Y: the work of inertia forces of V on Y.

From these follows a proven bound on every frequency of any system the body is built into
(:mod:`solidgear.core.system.system`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as sla

from solidgear.core.body import Block, Body
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import shift

#: ports to keep: names, or (name, attachment) where the body has more than one of a name
PortChoice = Iterable[str | tuple[str, str]]


@dataclass(frozen=True, eq=False)
class PortMotion:
    """Motion of a port as a linear function of coordinates."""

    rows: np.ndarray  #: (6, n) x y z thx thy thz in the axes of the port, m and rad
    point: np.ndarray  #: (3,) place of the port, m
    axes: np.ndarray  #: (3, 3) axes of the port as columns, in those of ``point``

    def seen_from(self, port: PortMotion) -> np.ndarray:
        """Return the motion (6, n) at the place and in the axes of another port, carried there
        rigidly.
        """
        turn = port.axes.T @ self.axes
        offset = self.axes.T @ (port.point - self.point)
        return np.kron(np.eye(2), turn) @ shift(offset) @ self.rows


@dataclass(frozen=True, eq=False)
class Truncation:
    """Truncation of a reduced part; see the head of this module."""

    cut: float  #: lowest eigenvalue of the fields left out, rad^2/s^2; infinite without any
    defect: np.ndarray  #: (n, n) positive semidefinite, s^2 in mass-normalised coordinates


@dataclass(frozen=True, eq=False)
class ReducedMotions:
    """One block of a body in the modes of its basis."""

    index: int  #: of the block in its body
    #: (m,) eigenvalues of the free block in the basis, rad^2/s^2; exactly 0 for the rigid ones,
    #: which come first
    value: np.ndarray
    shapes: np.ndarray  #: (n, m) mass-normalised, on the unknowns of the block
    motions: np.ndarray  #: (6, p, m) of the chosen ports
    truncation: Truncation


@dataclass(frozen=True, eq=False)
class Superelement:
    """A free body reduced to some of its ports; a part of a :class:`solidgear.core.system.System`.

    Coordinates are mass-normalised: ``mass`` is one, ``strain`` is diagonal.

    Attributes
    ----------
    kind : str
        ``rubin`` or ``craig_bampton``.
    fidelity : str
        Model of the body.
    blocks : tuple of ReducedMotions
        Blocks of the body that move ports, in its order.
    ports : mapping of str to PortMotion

    Examples
    --------
    >>> import solidgear as sg
    >>> rod = sg.Segment.cylinder("rod", length=0.5, diameter=0.05)
    >>> body = sg.build(sg.Scene.from_parts([rod]), "euler")
    >>> part = sg.rubin(body, n=12)
    >>> part.rigid, list(part.ports)
    (6, ['port'])
    >>> bending = sg.modes(body, n=1).named("bending 1").frequency_hz
    >>> bool(abs(part.frequency_hz[6] / bending - 1) < 1e-9)
    True
    """

    kind: str
    fidelity: str
    blocks: tuple[ReducedMotions, ...]
    ports: Mapping[str, PortMotion]

    @cached_property
    def value(self) -> np.ndarray:
        """Eigenvalues (m,) of the free body in the basis, block by block, rad^2/s^2."""
        return np.concatenate([b.value for b in self.blocks])

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.value)

    @property
    def rigid(self) -> int:
        """Number of rigid motions."""
        return int((self.value == 0).sum())

    @property
    def frequency_hz(self) -> np.ndarray:
        """Frequencies (m,) of these eigenvalues, ascending, Hz; the last ones belong to residual
        fields and are no modes of the body.
        """
        return np.sqrt(np.sort(self.value)) / (2 * np.pi)

    @cached_property
    def mass(self) -> np.ndarray:
        """Identity (m, m)."""
        return np.eye(self.size)

    @cached_property
    def strain(self) -> np.ndarray:
        """Rows (m - rigid, m) S with ``K = S'S``."""
        return np.diag(np.sqrt(self.value))[self.value > 0]

    @cached_property
    def truncation(self) -> Truncation:
        """Truncation of all blocks together."""
        return joined(b.truncation for b in self.blocks)

    def expand(self, coordinates: np.ndarray) -> dict[int, np.ndarray]:
        """Back to the mesh.

        Parameters
        ----------
        coordinates : (m,) or (m, k) ndarray

        Returns
        -------
        dict of int to (n,) or (n, k) ndarray
            Unknowns of every block of the body by index, as in
            :attr:`solidgear.core.solve.modes.Mode.vectors`.
        """
        coordinates = np.asarray(coordinates)
        if len(coordinates) != self.size:
            raise SolidgearError(
                f"a superelement of {self.size} coordinates cannot expand {len(coordinates)} of them"
            )
        cuts = np.cumsum([0] + [len(b.value) for b in self.blocks])
        return {
            b.index: b.shapes @ coordinates[start:end]
            for b, start, end in zip(self.blocks, cuts, cuts[1:])
        }


def joined(truncations: Iterable[Truncation]) -> Truncation:
    """Return the truncation of parts that share no coordinates, together."""
    parts = list(truncations)
    cut = min((t.cut for t in parts), default=np.inf)
    return Truncation(cut, sla.block_diag(*(t.defect for t in parts)))


def chosen_ports(body: Body, ports: PortChoice | None) -> dict[str, int]:
    """Return the index of every port that a reduction keeps, by name; refuse a port that the
    body does not have, and a name that is asked for twice.
    """
    if ports is None:
        ports = dict.fromkeys(p.name for p in body.ports)
    out: dict[str, int] = {}
    for choice in ports:
        name, attachment = (choice, None) if isinstance(choice, str) else choice
        if name in out:
            raise SolidgearError(f"the port {name!r} is given twice; give it once")
        out[name] = body.port_index(name, attachment)
    return out


def port_rows(block: Block, ports: Iterable[int]) -> np.ndarray:
    """Return the rows of some ports (indices) in the port matrix of a block."""
    c = len(block.components)
    return np.array([c * p + k for p in ports for k in range(c)], int)


def ease(body: Body) -> np.ndarray:
    """Return the units (6 p,) in which motions of ports have equal size, SI: the approximate motion of a
    port by inertia under a unit load at the first frequency of the body.

    Always positive; an elastic flexibility need not be, for the mean motion of a seat as long as
    the shaft is a rigid motion alone.
    """
    swing = body.rigid_ports
    inertia = np.einsum("ij,ji->i", swing, np.linalg.solve(body.mass_matrix(), swing.T))
    return inertia / body.scale


def assemble(
    kind: str, body: Body, chosen: Mapping[str, int], blocks: Iterable[ReducedMotions]
) -> Superelement:
    """Return the superelement of blocks that have been reduced to the chosen ports."""
    blocks = tuple(blocks)
    motions = np.concatenate([b.motions for b in blocks], axis=2)
    ports = {}
    for place, (name, index) in enumerate(chosen.items()):
        point = np.array([body.ports[index].x, body.ports[index].y, body.ports[index].z])
        ports[name] = PortMotion(motions[:, place, :], point, np.eye(3))
    return Superelement(kind, body.fidelity, blocks, ports)


def reduced_motions(
    block: Block, index: int, ports: list[int], value, shapes, truncation: Truncation
) -> ReducedMotions:
    """Return a block in mass-normalised shapes; in those of its twin, for one that repeats another."""
    motions = np.zeros((6, len(ports), len(value)))
    moved = block.ports[port_rows(block, ports)] @ shapes
    motions[list(block.components)] = moved.reshape(
        len(ports), len(block.components), len(value)
    ).transpose(1, 0, 2)
    return ReducedMotions(index, value, shapes, motions, truncation)
