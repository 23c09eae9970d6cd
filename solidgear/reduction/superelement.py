r"""A body seen from its ports: a few coordinates, and a way back to the mesh.

Every reduction here is a Ritz basis V of the free body that holds its rigid motions.  In the span
of V the free body has its own modes; written in them,

    u = V q,      M = 1,      K = diag(0, .., 0, w_1^2, .., w_m^2),      port motions = (G V) q,

so that stiffness is a matter of strain rows ``diag(w)``, rigid motions are the coordinates that no
row touches, exactly, and two superelements differ in nothing but which V they came from
(:func:`solidgear.reduction.rubin.rubin`, :func:`solidgear.reduction.craig_bampton.craig_bampton`).

What V leaves out
-----------------
Let springs of any kind join ports of several bodies and ground, ``B = K + G' Kb G``, and let the
masses ``M`` carry further inertias at ports.  Every basis here holds the rigid motions R and the
static displacements E N of port loads in equilibrium (``P'N = 0`` with P = G R).  A field y with
``V' B y = 0`` then moves no port.  For with d = G y and f = Kb d, R gives ``P'f = 0``, so that
f = N c; E N gives ``N'(d + F f) = 0`` with the flexibility F, hence ``d'Kb d + f'F f = 0``: no spring
is stretched, and d is that of a rigid motion which nothing resists, known exactly and taken out
beforehand.  So Y, all such fields, is what ``V' K y = 0`` says, whatever holds the body.

Two things about Y are kept with a superelement, as its
:class:`Truncation`:

- ``cut``, the lowest eigenvalue in Y: ``y' M y <= y' K y / cut``;
- ``defect``, ``V' M Y Y' M V`` for a K-orthonormal Y: what inertia forces of V do to Y.

From these follows a proven bound on every frequency of any system the body is built into
(:mod:`solidgear.system.bound`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as sla

from solidgear.body import Block, Body
from solidgear.errors import SolidgearError
from solidgear.frames import shift

#: Which ports a reduction keeps: names, or (name, attachment) where the body has more than one.
PortChoice = Iterable["str | tuple[str, str]"]


@dataclass(frozen=True, eq=False)
class PortMotion:
    """Motion of a port as a linear function of coordinates."""

    rows: np.ndarray  #: (6, n) x y z thx thy thz in the port's own axes, m and rad
    point: np.ndarray  #: (3,) where the port is, m
    axes: np.ndarray  #: (3, 3) its own axes as columns, in those that ``point`` is told in

    def seen_from(self, other: PortMotion) -> np.ndarray:
        """(6, n) motion at the place and in the axes of another port, carried there rigidly."""
        turn = other.axes.T @ self.axes
        offset = self.axes.T @ (other.point - self.point)
        return np.kron(np.eye(2), turn) @ shift(offset) @ self.rows


@dataclass(frozen=True, eq=False)
class Truncation:
    """Truncation of a reduced part; see the head of this module."""

    cut: float  #: lowest eigenvalue of the fields left out, rad^2/s^2; infinite if nothing is
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
    """A free body reduced to some of its ports; a part of a :class:`solidgear.system.System`.

    Coordinates are mass-normalised: ``mass`` is one, ``strain`` is diagonal.

    Attributes
    ----------
    kind : str
        ``rubin`` or ``craig_bampton``.
    fidelity : str
        Of the body.
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
        """(m,) eigenvalues of the free body in the basis, block by block, rad^2/s^2."""
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
        """(m,) the same as frequencies, ascending, Hz; the last ones belong to residual fields and
        are no modes of the body.
        """
        return np.sqrt(np.sort(self.value)) / (2 * np.pi)

    @cached_property
    def mass(self) -> np.ndarray:
        """(m, m) identity."""
        return np.eye(self.size)

    @cached_property
    def strain(self) -> np.ndarray:
        """(m - rigid, m) rows S with ``K = S'S``."""
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
            Unknowns of every block of the body by its index, as in
            :attr:`solidgear.solve.modes.Mode.vectors`.
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
    """Truncation of parts that share no coordinates, together."""
    every = list(truncations)
    cut = min((t.cut for t in every), default=np.inf)
    return Truncation(cut, sla.block_diag(*(t.defect for t in every)))


def chosen_ports(body: Body, ports: PortChoice | None) -> dict[str, int]:
    """Index of every port that a reduction keeps, by the name it will have.

    Raises
    ------
    SolidgearError
        For a port the body does not have, or a name that is asked for twice.
    """
    if ports is None:
        ports = dict.fromkeys(p.name for p in body.ports)
    out: dict[str, int] = {}
    for choice in ports:
        name, attachment = (choice, None) if isinstance(choice, str) else choice
        if name in out:
            raise SolidgearError(f"the port {name!r} is asked for twice; a part holds it once")
        out[name] = body.port_index(name, attachment)
    return out


def port_rows(block: Block, ports: Iterable[int]) -> np.ndarray:
    """Rows of some ports (indices) in the port matrix of a block."""
    c = len(block.components)
    return np.array([c * p + k for p in ports for k in range(c)], int)


def ease(body: Body) -> np.ndarray:
    """(6 p,) how far a unit load moves a port by inertia at the first frequency of the body, roughly:
    units in which motions of ports are alike, SI.

    Always positive; an elastic flexibility need not be, for the mean motion of a seat as long as
    the shaft is a rigid motion alone.
    """
    swing = body.rigid_ports
    inertia = np.einsum("ij,ji->i", swing, np.linalg.solve(body.mass_matrix(), swing.T))
    return inertia / body.scale


def assemble(
    kind: str, body: Body, chosen: Mapping[str, int], blocks: Iterable[ReducedMotions]
) -> Superelement:
    """A superelement of blocks that have been reduced to the chosen ports."""
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
    """A block in mass-normalised shapes; in those of its twin, for one that repeats another."""
    motions = np.zeros((6, len(ports), len(value)))
    moved = block.ports[port_rows(block, ports)] @ shapes
    motions[list(block.components)] = moved.reshape(
        len(ports), len(block.components), len(value)
    ).transpose(1, 0, 2)
    return ReducedMotions(index, value, shapes, motions, truncation)
