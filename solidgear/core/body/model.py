"""The one currency of the house: a free elastic shaft with named ports.

Every model (beam, harmonic solid, 3D solid) is turned into a :class:`Body`; everything after
that (condensation, modes, evidence) is written once against it. Bearings are never part of a body:
they are :class:`~solidgear.core.body.supports.Supports` that act on ports.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import scipy.sparse as sp

from solidgear.core.body.cache import Cache
from solidgear.core.body.mass import ScalarMass
from solidgear.core.body.sections import Sections, from_points, signed
from solidgear.core.body.surface import Drawing, Surface
from solidgear.core.body.symmetric import Symmetric
from solidgear.core.display import Displayed
from solidgear.core.errors import SolidgearError
from solidgear.core.factoring import Factoring
from solidgear.core.frames import shift

#: Index of the block of n waves around the axis is this plus n, where it is not among the blocks of
#: a body.
FURTHER = 1000
#: Index of the same block a quarter of a wave further round (its sine form): this plus n.
SINE = 2000
#: (n,) unknown that stands in the mirror of each, and (n,) sign that its motion has there
Reflection = tuple[np.ndarray, np.ndarray]


#: unknowns (n, k) to the effect of spin on them (n, k), kg times them
Swirl = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Port:
    """A six-component point on the axis through which a body is loaded and held."""

    name: str
    y: float  #: of the reference point, m
    #: to the material: ``average``, ``rigid``, ``section`` or ``node``
    attachment: str
    #: x, z: place beside the axis, m
    x: float = 0.0
    z: float = 0.0


def component_rows(ports: Iterable[int], components: Sequence[int]) -> np.ndarray:
    """Return the places of some components (0 to 5) of some ports in a vector of six per port, port
    by port.

    Examples
    --------
    >>> component_rows([0, 1], (2, 3))
    array([2, 3, 8, 9])
    """
    return np.array([6 * p + c for p in ports for c in components], int)


@dataclass(frozen=True, eq=False)
class Enrichment:
    """Unknowns of the functions that one order more adds to a mesh, and what couples them to those
    of the mesh.

    Of a mesh with mirror planes the matrices are sums over one cell of each set of images, times
    the cells of it: right for motions that are symmetric or antisymmetric about the planes.
    """

    stiffness: Symmetric  #: (s, s) N/m
    coupling: sp.csr_matrix  #: (s, n) stiffness between them and the unknowns of the mesh, N/m
    #: mass between them and the unknowns of the mesh, kg: (s, n), or (s / c, n / c) where it is the
    #: same for each of c components, which are numbered together
    inertia: sp.csr_matrix
    summed: np.ndarray  #: (s,) which of them the matrices have rows for
    ports: np.ndarray  #: (c p, m) motions of the ports by them
    moves: np.ndarray  #: (m,) 1 for unknowns that move, 0 for those that are held
    functions: np.ndarray  #: (m,) function of every unknown
    cells: np.ndarray  #: (k, ne) functions of every cell
    #: of the unknowns of the mesh and of the functions, in the planes x = 0, z = 0 and x = z
    reflections: tuple[tuple[Reflection, Reflection], ...] = ()


@dataclass(frozen=True, eq=False)
class Block:
    """One family of motions that symmetry decouples from the others."""

    name: str  #: ``bending_z``, ``bending_x``, ``axial``, ``torsion``, ``ovalising_n`` or ``full``
    components: tuple[int, ...]  #: which of the six port components this block carries
    #: stiffness, mass: symmetric; two blocks that are twins hold the *same* objects
    stiffness: sp.csr_matrix
    mass: sp.csr_matrix | ScalarMass
    rigid: np.ndarray  #: rigid motions about the origin of the scene, one column per component
    #: (n,) axial position of each unknown; NaN for unknowns that are not point values
    y: np.ndarray
    #: port motions as linear functions of the unknowns, port by port; nothing before it has any
    ports: sp.csr_matrix = field(default_factory=lambda: sp.csr_matrix((0, 0)))
    #: index of the block this one repeats in the other plane, and the sign of each component there
    mirror: tuple[int, tuple[float, ...]] | None = None
    #: whether the matrix comes from a 1D or 2D mesh, for which a light factorisation is best
    planar: bool = True
    #: number of unknowns at the end that are coupled to very many others (motions of rigid seats)
    border: int = 0
    #: the unknowns of the mesh from those of a block with rigidly tied seats, or of some motions only;
    #: None where they are the same
    expand: sp.csr_matrix | None = None
    #: see :mod:`solidgear.core.body.sections`; None where all unknowns are values at points, ``y``
    sections: Sections | None = None
    #: of all motions in the mirror planes x = 0 and z = 0 of a mesh that has them, 1 or -1 each
    parity: tuple[float, ...] | None = None
    #: the coupling by spin of unknowns (n, k) with the twin a quarter of a wave further round
    #: (:mod:`solidgear.core.solve.spin`), times them; None where there is none
    swirl: Swirl | None = None
    #: returns what one order more adds to the mesh of the block, or of the one that it repeats, the same
    #: object for all blocks of a mesh that have a parity; None where nothing does
    enrich: Callable[[], Enrichment] | None = None

    def mirrored(
        self, name: str, components: tuple[int, ...], index: int, signs: tuple[float, ...]
    ) -> Block:
        """Return the same block in the other bending plane, with its own components, and a sign for
        each.

        In the x plane the matrices of the z plane act on ``(u_x, -thz)``: same matrices, signs on
        the components. `index` is the place of this block in its body.
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
        """Return loads (n, s c) and Gram matrix (s c, s c) that give the section motions of shapes
        at ascending stations (s,), m, from end to end of the shaft, by
        :mod:`solidgear.core.body.sections`; and the index ``6 * station + component`` of every column.
        """
        columns = [6 * s + c for s in range(len(stations)) for c in self.components]
        loads, gram = (
            self.sections or from_points(self.mass, self.rigid, self.y, self.components)
        )(stations)
        return loads, gram, np.array(columns, int)


class _Families(dict[int, "Body"]):
    """Circumferential families built before, by their number of waves."""


@dataclass(frozen=True, eq=False, repr=False)
class Body(Displayed):
    """A free elastic shaft by one model.

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
        The builder's mesh, which draws itself
        (:class:`solidgear.core.body.surface.Drawing`).
    further : object or None
        Builder of further circumferential families, such as
        :class:`solidgear.core.models.harmonic.body.Families`; None where the blocks are all that the
        model has.
    cache : Cache
        Results of solvers for this body, such as its factors.
    factoring : Factoring
        How its matrices are to be factored.
    remedies : callable, optional
        ``remedies(body, error)`` adds advice where its factors do not fit.

    Examples
    --------
    >>> import solidgear as sg
    >>> rod = sg.Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> body = sg.build(sg.Scene.from_parts([rod]), "timoshenko")
    >>> [(port.name, port.attachment) for port in body.ports]
    [('port', 'average')]
    >>> body.rigid_residual() < 1e-9  # no force holds it
    True
    """

    shown: ClassVar[str] = "body"

    fidelity: str
    blocks: tuple[Block, ...]
    ports: tuple[Port, ...]
    scale: float
    length: float
    mesh: dict[str, Any] = field(default_factory=dict)
    geometry: Drawing | None = None
    further: Any = None
    cache: Cache = field(default_factory=Cache, repr=False)
    factoring: Factoring = Factoring()
    remedies: Callable[..., SolidgearError] | None = None

    @property
    def size(self) -> int:
        """Number of unknowns, twins counted twice."""
        return sum(block.size for block in self.blocks)

    def block(self, index: int) -> Block:
        """A block by its index.

        Parameters
        ----------
        index : int
            From ``FURTHER`` on, that of a further circumferential family, built when first asked
            for; from ``SINE`` on, its sine form.

        Returns
        -------
        Block

        Raises
        ------
        SolidgearError
            If the model has no such family.
        """
        if index < FURTHER:
            return self.blocks[index]
        if index < SINE:
            return self.family(index - FURTHER).blocks[0]
        cosine = self.family(index - SINE).blocks[0]
        return replace(cosine, name=f"sine_{cosine.name}")

    def family(self, n: int) -> Body:
        """The motions of some waves around the axis, as a body of one block without port motions.

        Parameters
        ----------
        n : int
            Waves, at least 2; a family is kept once built.

        Returns
        -------
        Body

        Raises
        ------
        SolidgearError
            If the model has no such families.
        """
        if self.further is None:
            raise SolidgearError(
                f"the {self.fidelity} body has no motions of {n} waves around its axis"
            )
        families = self.cache.get(_Families, _Families)
        if n not in families:
            scale = (2 * np.pi * self.further.light(n)) ** 2
            families[n] = Body(
                self.fidelity, (self.further.block(n),), (), scale, self.length, self.mesh
            )
        return families[n]

    def without_results(self) -> Body:
        """The same body, its families shared, for what is kept with the body: that would hold itself
        by the body's own cache, in a circle that no reference count frees.
        """
        return replace(self, cache=Cache(self.cache.get(_Families, _Families)))

    def without_matrices(self) -> Body:
        """The body to be drawn alone, without what it was solved with: its matrices are empty."""

        def without(block: Block) -> Block:
            nothing = sp.csr_matrix((block.size, block.size))
            return replace(block, stiffness=nothing, mass=nothing, enrich=None, swirl=None)

        return replace(self, blocks=tuple(map(without, self.blocks)), cache=Cache())

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
        return self.geometry.surface(self.mesh_unknowns(vectors))

    def mesh_unknowns(self, vectors: Mapping[int, np.ndarray]) -> dict[str, np.ndarray]:
        """Unknowns of the mesh by name of the block, with rigidly tied seats expanded.

        Parameters
        ----------
        vectors : mapping of block index to (n,) ndarray

        Raises
        ------
        SolidgearError
            If a vector does not fit its block.
        """
        out = {}
        for index, vector in vectors.items():
            block = self.block(index)
            if np.shape(vector) != (block.size,):
                raise SolidgearError(
                    f"a shape of block {block.name} has {block.size} values, not {np.shape(vector)}"
                )
            out[block.name] = (
                np.asarray(vector, float) if block.expand is None else block.expand @ vector
            )
        return out

    def port_index(self, name: str, attachment: str | None = None) -> int:
        """Index of a port.

        Parameters
        ----------
        name : str
        attachment : str, optional
            Without it the first port of that name counts.

        Returns
        -------
        int

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
        return np.vstack([shift((p.x, p.y, p.z)) for p in self.ports])

    def rows(self, block: Block) -> np.ndarray:
        """Places of a block's port rows among the ``6 * n_ports`` port components."""
        return component_rows(range(len(self.ports)), block.components)

    def port_motions(self, vectors: Mapping[int, np.ndarray]) -> np.ndarray:
        """(6 * n_ports,) motions of all ports in a shape, by block index."""
        out = np.zeros(6 * len(self.ports))
        for index, vector in vectors.items():
            block = self.block(index)
            if block.components:
                out[self.rows(block)] += block.ports @ vector
        return out

    def mass_matrix(self) -> np.ndarray:
        """Rigid-body mass matrix about the origin of the scene.

        Returns
        -------
        (6, 6) ndarray
            kg, kg m, kg m^2.
        """
        out = np.zeros((6, 6))
        for block in self.blocks:
            c = list(block.components)
            out[np.ix_(c, c)] += block.rigid.T @ (block.mass @ block.rigid)
        return out

    def rigid_residual(self) -> float:
        """Largest ``|K R|`` relative to ``|K| |R|``: zero for a body that is truly free.

        Returns
        -------
        float
        """
        worst = 0.0
        for block in self.blocks:
            if not block.components:
                continue
            scale = (abs(block.stiffness) @ abs(block.rigid)).max(axis=0)
            # A shaft that is one rigid seat has no stiffness but rounding: it is compared with the
            # inertia of its mass at the lowest elastic frequency.
            inertia = self.scale * abs(block.mass @ block.rigid).max(axis=0)
            met = abs(block.stiffness @ block.rigid) / np.maximum(scale, inertia)
            worst = max(worst, float(met.max()))
        return worst
