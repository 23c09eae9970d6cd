"""The one currency of the house: a free elastic shaft with named ports.

Every fidelity (beam, harmonic solid, 3D solid) is turned into a :class:`Body`;
everything after that (condensation, modes, evidence) is written once against it.
Bearings are never part of a body: they are :class:`Supports` that act on ports.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import scipy.sparse as sp

from solidgear.body.mass import ScalarMass
from solidgear.body.sections import Sections, from_points, signed
from solidgear.body.surface import Drawing, Surface, mesh_unknowns
from solidgear.errors import SolidgearError
from solidgear.frames import DOF_NAMES, shift

if TYPE_CHECKING:
    from solidgear.scene import Bearing, Scene

    #: what :func:`as_supports` takes
    Holding: TypeAlias = "Supports | Scene | Iterable[Bearing]"

#: Index of the block of n waves around the axis is this plus n, where it is not among the blocks of
#: a body.
FURTHER = 1000


@dataclass(frozen=True)
class Port:
    """A six-component point on the axis through which a body is loaded and held.

    Attributes
    ----------
    name : str
    y : float
        Axial position of the reference point, m.
    attachment : str
        How the point is tied to the material: ``average``, ``rigid``, ``section`` or ``node``.
    """

    name: str
    y: float
    attachment: str


def component_rows(ports: Iterable[int], components: Sequence[int]) -> np.ndarray:
    """Places of some components of some ports (indices) in a vector of six per port."""
    return np.array([6 * p + c for p in ports for c in components], int)


@dataclass(frozen=True, eq=False)
class Block:
    """One family of motions that symmetry decouples from the others.

    Attributes
    ----------
    name : str
        ``bending_z``, ``bending_x``, ``axial``, ``torsion``, ``ovalising_n`` or ``full``.
    components : tuple of int
        Which of the six port components this block carries.
    stiffness, mass : (n, n) sparse, or a :class:`~solidgear.body.mass.ScalarMass` for the mass
        Symmetric; two blocks that are twins hold the *same* objects.
    rigid : (n, len(components)) ndarray
        Rigid motions about the origin of the scene, one column per component.
    y : (n,) ndarray
        Axial position of each unknown; NaN for unknowns that are not point values.
    ports : (n_ports * len(components), n) sparse
        Port motions as linear functions of the unknowns, port by port.
    mirror : (int, tuple of float), optional
        Index of the block this one repeats in the other plane, and the sign of each component
        there.
    border : int
        Number of unknowns at the end that are coupled to very many others (motions of rigid seats).
    planar : bool
        Whether the matrix comes from a 1D or 2D mesh, for which a light factorisation is best.
    expand : (n_mesh, n) sparse, optional
        The unknowns of the mesh from those of a block with rigidly tied seats; None where they are
        the same.
    sections : callable, optional
        See :mod:`solidgear.body.sections`; None where all unknowns are values at points, ``y``.
    """

    name: str
    components: tuple[int, ...]
    stiffness: sp.csr_matrix
    mass: sp.csr_matrix | ScalarMass
    rigid: np.ndarray
    y: np.ndarray
    ports: sp.csr_matrix
    mirror: tuple[int, tuple[float, ...]] | None = None
    planar: bool = True
    border: int = 0
    expand: sp.csr_matrix | None = None
    sections: Sections | None = None

    def mirrored(
        self, name: str, components: tuple[int, ...], index: int, signs: tuple[float, ...]
    ) -> Block:
        """The same block in the other bending plane.

        In the x plane the matrices of the z plane act on ``(u_x, -thz)``: same matrices, signs on
        the components.

        Parameters
        ----------
        name, components
            Of the new block.
        index : int
            Place of this block in its body.
        signs : tuple of float
            One per component.
        """
        count = self.ports.shape[0] // len(signs)
        ports = sp.diags(np.tile(signs, count)) @ self.ports
        rigid = self.rigid * np.asarray(signs)
        return replace(
            self,
            name=name,
            components=components,
            rigid=rigid,
            ports=ports.tocsr(),
            mirror=(index, signs),
            sections=self.sections and signed(self.sections, signs),
        )

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return self.stiffness.shape[0]

    def section_loads(self, stations: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What gives the section motions of shapes; see :mod:`solidgear.body.sections`.

        Parameters
        ----------
        stations : (s,) ndarray
            Axial positions, ascending, m; the first and the last at the ends of the shaft.

        Returns
        -------
        loads : (n, s * c) ndarray
        gram : (s * c, s * c) ndarray
        columns : (s * c,) ndarray of int
            Index ``6 * station + component`` of every column.
        """
        columns = [6 * s + c for s in range(len(stations)) for c in self.components]
        loads, gram = (
            self.sections or from_points(self.mass, self.rigid, self.y, self.components)
        )(stations)
        return loads, gram, np.array(columns, int)


@dataclass(frozen=True, eq=False)
class Body:
    """A free elastic shaft at one fidelity.

    Attributes
    ----------
    fidelity : str
    blocks : tuple of Block
    ports : tuple of Port
        In the order of the rows of every block's ``ports``.
    scale : float
        Estimate of the lowest elastic eigenvalue of the free body, rad^2/s^2; it sets the spectral
        shift.
    length : float
        Overall length, m; it makes rotations and translations comparable.
    mesh : dict
        Facts about the discretisation, for the record.
    geometry : Drawing or None
        The mesh as its builder has it, which knows how it is drawn
        (:class:`solidgear.body.surface.Drawing`).
    further : object or None
        Builder of further circumferential families, such as
        :class:`solidgear.fidelity.circumferential.Families`; None where the blocks are all that the
        fidelity knows.
    """

    fidelity: str
    blocks: tuple[Block, ...]
    ports: tuple[Port, ...]
    scale: float
    length: float
    mesh: dict[str, Any] = field(default_factory=dict)
    geometry: Drawing | None = None
    further: Any = None
    # Factorisations and flexibilities are kept with the body they belong to, so that they die with
    # it.
    memory: dict[str, Any] = field(default_factory=dict, repr=False)

    @property
    def size(self) -> int:
        """Number of unknowns, twins counted twice."""
        return sum(block.size for block in self.blocks)

    def block(self, index: int) -> Block:
        """A block by its index; from ``FURTHER`` on, that of a further circumferential family,
        built when first asked for.
        """
        return self.blocks[index] if index < FURTHER else self.family(index - FURTHER).blocks[0]

    def family(self, n: int) -> Body:
        """The motions of ``n`` waves around the axis (at least 2), as a body of one block without
        port motions; kept once built.

        Raises
        ------
        SolidgearError
            If the fidelity has no such families.
        """
        if self.further is None:
            raise SolidgearError(
                f"the {self.fidelity} body has no motions of {n} waves around its axis"
            )
        kept = self.memory.setdefault("families", {})
        if n not in kept:
            scale = (2 * np.pi * self.further.light(n)) ** 2
            kept[n] = Body(
                self.fidelity, (self.further.block(n),), (), scale, self.length, self.mesh
            )
        return kept[n]

    def surface(self, vectors: Mapping[int, np.ndarray]) -> Surface:
        """Surface of the body moved by a vector of unknowns.

        Parameters
        ----------
        vectors : mapping of block index to (n,) ndarray
            One shape, such as ``Mode.vectors[0]``; blocks left out stand still.

        Raises
        ------
        SolidgearError
            For a body that carries no geometry, or a vector that does not fit its block.
        """
        if self.geometry is None:
            raise SolidgearError(f"the {self.fidelity} body carries no geometry to draw")
        return self.geometry.surface(mesh_unknowns(self, vectors))

    def port_index(self, name: str, attachment: str | None = None) -> int:
        """Index of the port called ``name``; the first one unless an attachment is asked for.

        Raises
        ------
        SolidgearError
            If the body has no such port.
        """
        for k, port in enumerate(self.ports):
            if port.name == name and attachment in (None, port.attachment):
                return k
        have = ", ".join(f"{p.name} ({p.attachment})" for p in self.ports)
        wanted = name if attachment is None else f"{name} ({attachment})"
        raise SolidgearError(f"the {self.fidelity} body has no port {wanted}; it has {have}")

    @cached_property
    def rigid_ports(self) -> np.ndarray:
        """(6 * n_ports, 6) motions of all ports under unit rigid motions about the origin."""
        return np.vstack([shift((0.0, p.y, 0.0)) for p in self.ports])

    def rows(self, block: Block) -> np.ndarray:
        """Places of a block's port rows among the ``6 * n_ports`` port components."""
        return component_rows(range(len(self.ports)), block.components)

    def mass_matrix(self) -> np.ndarray:
        """(6, 6) rigid-body mass matrix about the origin of the scene, kg, kg m, kg m^2."""
        out = np.zeros((6, 6))
        for block in self.blocks:
            c = list(block.components)
            out[np.ix_(c, c)] += block.rigid.T @ (block.mass @ block.rigid)
        return out

    def rigid_residual(self) -> float:
        """Largest ``|K R|`` relative to ``|K| |R|``: zero for a body that is truly free."""
        worst = 0.0
        for block in self.blocks:
            if not block.components:
                continue
            scale = abs(block.stiffness) @ abs(block.rigid)
            worst = max(
                worst, float((abs(block.stiffness @ block.rigid) / scale.max(axis=0)).max())
            )
        return worst


@dataclass(frozen=True, eq=False)
class Supports:
    """Springs between ports and ground.

    Attributes
    ----------
    ports : tuple of str
        Names of the supported ports.
    stiffness : (6 m, 6 m) ndarray
        Symmetric positive semidefinite, port by port; off-diagonal blocks only where a common
        housing ties bearings together.
    attachments : tuple of (str or None)
        Attachment asked for at each port; None takes the body's first.
    """

    ports: tuple[str, ...]
    stiffness: np.ndarray
    attachments: tuple[str | None, ...] = ()

    @cached_property
    def root(self) -> np.ndarray:
        """(6 m, r) matrix ``L`` with ``L L' = stiffness`` and r its rank.

        Cholesky's factor with the stiffest pivots first, of the matrix scaled to a unit diagonal: a spring of 1e-3 N/m beside one of 1e24
        keeps its own precision, in a column of its own.  (Eigenvectors would mix equal entries of the scaled matrix, whatever they couple.)
        """
        if not self.ports:
            return np.zeros((0, 0))
        d = np.sqrt(np.abs(np.diag(self.stiffness)))
        order = np.argsort(-d, kind="stable")
        unit = np.where(d > 0, d, 1.0)[order]
        left = self.stiffness[np.ix_(order, order)] / np.outer(unit, unit)
        columns = []
        for j in range(len(left)):
            if left[j, j] > 1e-12:
                column = left[:, j] / np.sqrt(left[j, j])
                column[:j] = 0.0
                columns.append(column)
                left = left - np.outer(column, column)
        out = np.zeros((len(d), len(columns)))
        out[order] = d[order, None] * np.array(columns).reshape(len(columns), len(d)).T
        return out

    def rows(self, body: Body) -> np.ndarray:
        """Places of the supported components among the body's port components."""
        wanted = self.attachments or (None,) * len(self.ports)
        places = [6 * body.port_index(n, a) + np.arange(6) for n, a in zip(self.ports, wanted)]
        return np.concatenate(places) if places else np.zeros(0, int)

    def with_attachment(self, attachment: str | None) -> Supports:
        """The same springs acting on another attachment of the same ports."""
        return Supports(self.ports, self.stiffness, (attachment,) * len(self.ports))

    def unresisted(self, body: Body) -> np.ndarray:
        """(6, k) rigid motions about the origin that no spring resists (orthonormal, rotations
        times the length).
        """
        size = np.array([1.0, 1.0, 1.0, 1 / body.length, 1 / body.length, 1 / body.length])
        if not self.ports:
            return np.eye(6) * size
        # Rank does not depend on how stiff a spring is: every row is brought to unit length first.
        a = self.root.T @ body.rigid_ports[self.rows(body)] * size
        norm = np.linalg.norm(a, axis=1, keepdims=True)
        a = a / np.where(norm > 0, norm, 1.0)
        _, s, vt = np.linalg.svd(a)
        rank = int((s > 1e-9).sum())
        null = vt[rank:].T
        null[np.abs(null) < 1e-9] = 0.0
        return size[:, None] * null


def as_supports(source: Holding) -> Supports:
    """Supports from a scene (housing included), from bearings (no housing), or as they are.

    A housing spring sits between ground and the axially rigid ring that carries all outer races:
    eliminating that ring leaves ``K - K e (e'K e + k)^-1 e'K`` with e the common axial motion.
    """
    if isinstance(source, Supports):
        return source
    housing = getattr(source, "housing_axial", None)
    bearings: Iterable = getattr(source, "bearings", source) or ()
    bearings = tuple(bearings)
    n = len(bearings)
    k = np.zeros((6 * n, 6 * n))
    for i, bearing in enumerate(bearings):
        k[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = bearing.stiffness
    if housing is not None and n:
        e = np.zeros(6 * n)
        e[1::6] = 1.0
        ke = k @ e
        k = k - np.outer(ke, ke) / (e @ ke + housing)
    return Supports(tuple(b.name for b in bearings), k)


__all__ = ["DOF_NAMES", "Block", "Body", "Port", "Supports", "as_supports"]
