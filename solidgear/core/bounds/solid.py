"""Distance of a 3D solid from the exact solution: energies of its error in one order more.

With the functions W that one order more adds to those of the mesh
(:mod:`solidgear.core.models.solid.enriched`), the error e of a solution in both together has

    S e_W = r,      S = C - B K^-1 B',      r = f_W - B u

where K is the stiffness of the mesh, C that of W, B what couples them.  Its energy ``E = e_W' r`` is
found by conjugate gradients with the factor of K that the solution has left; it rises from below.
Since it is a Galerkin energy, flexibilities lie between

    F + E <= F_exact <= F + s E,      s = 1 / (1 - (p / (p + 1))^(4 a)),

the lower side exactly, the upper one as far as one order more takes the share ``1/s`` of the error
that it takes of the sharpest edge, with the exponent a of displacement there (Szabo and Babuska 1991,
Finite Element Analysis, ch. 10: an error in energy of p^(-4 a) at an edge).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from scipy.linalg import eigvalsh_tridiagonal

from solidgear.core.body import Body
from solidgear.core.body.cache import Cache
from solidgear.core.bounds.clusters import lower_ends
from solidgear.core.bounds.enriched_block import EnrichedBlock, enriched_block, independent
from solidgear.core.bounds.harmonic import (
    eigenvalue,
    least_frequency,
    on_ports,
    shares_blocks,
    with_neighbours,
)
from solidgear.core.bounds.layers import Layers
from solidgear.core.bounds.narrow import mesh_of, narrow_share
from solidgear.core.bounds.singular_places import (
    refuse_unresolved,
    share_within,
    sharpest_exponent,
)
from solidgear.core.elements import ELEMENTS
from solidgear.core.errors import NoBounds
from solidgear.core.kernel.room import MB
from solidgear.core.machine.memory import NoRoom, require
from solidgear.core.machine.processes import give_back
from solidgear.core.meshing.meeting import least_side
from solidgear.core.models.solid.mesh import SolidMesh
from solidgear.core.models.solid.seat_faces import Seats
from solidgear.core.safety import CONVEX, LEAST, LOAD_EDGE, LOCAL, MISSING, MOST_STEPS, ROOM, SLOWER
from solidgear.core.scene.shaft import without_axis
from solidgear.core.solve.inertia_relief import ratio
from solidgear.core.solve.modes import Mode, ModeSet
from solidgear.core.solve.shifted import factors
from solidgear.core.solve.statics import flexibility, port_fields, twin_matrix

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: relative error of the energy of displacements, far below that of the error sought
FIELDS = 1e-14
#: share of an energy below which gains are rounding, and fall no more
ROUNDING = 1e-12
#: vectors of every column that are held while they go on
COPIES = 8
#: way out of an estimate that finds no room
COARSER = "use a coarser mesh"


@dataclass
class SolidBounds:
    """Bounds of one 3D body on its mesh."""

    body: Body
    share: float  #: the largest energy of an error over that in one order more
    #: (6 p, 6 p) energies of the errors under unit loads on the ports in one order more, N m
    reached: np.ndarray
    #: least eigenvalue that each mode may have, rad^2/s^2, where one is known
    lowest: dict[str, float]
    of_modes: dict[str, np.ndarray]  #: (ne,) energies of the error of a mode, by its name
    _cells: Callable[[np.ndarray], np.ndarray]
    two_sided: ClassVar = False  #: a mesh is too stiff

    @cached_property
    def more(self) -> np.ndarray:
        """(6 p, 6 p) most that the flexibility may grow by."""
        return self.share * self.reached

    @cached_property
    def least(self) -> np.ndarray:
        """(6 p, 6 p) least that the flexibility grows by."""
        return LEAST * self.reached

    @cached_property
    def less(self) -> np.ndarray:
        """(6 p, 6 p) zero: no further order takes a part of the error."""
        return np.zeros_like(self.reached)

    def energy_by_cells(self, forces: np.ndarray) -> np.ndarray:
        """Return (ne,) energies of the error under forces (6 p,) on the ports."""
        return self._cells(forces)

    def softer(self, more: np.ndarray) -> Body:
        """Return the body with a larger flexibility; only ports know of it."""
        computed = flexibility(self.body)
        return replace(self.body, cache=Cache(replace(computed, matrix=computed.matrix + more)))

    def frequency(self, mode: Mode) -> float | None:
        """Return the least frequency that a mode may have, Hz; None where nothing was solved beyond
        those near it.
        """
        return least_frequency(self.lowest, mode)


def solid_bounds(
    scene: Scene,
    body: Body,
    *,
    statics: bool,
    modes: ModeSet | None = None,
    wanted: Sequence[str] = (),
    safety: float = 1.0,
) -> SolidBounds:
    """Compute bounds of the flexibility and of some modes of a 3D body; parameters are those of
    :func:`solidgear.core.bounds.harmonic.harmonic_bounds`.
    """
    _refuse_cut_seats(scene, body)
    share = share_of_error(scene, body)
    size = 6 * len(body.ports)
    reached = np.zeros((size, size))
    # ports of every block, their signs in the block that it repeats, and errors of that one
    parts: dict[int, tuple[np.ndarray, np.ndarray, Errors]] = {}
    if statics:
        for index, fields, _, _ in port_fields(body, FIELDS):
            block = body.blocks[index]
            rows, errors = body.rows(block), errors_of_loads(body, index, fields)
            reached[np.ix_(rows, rows)] = errors.energies
            parts[index] = rows, np.ones(len(rows)), errors
        for k, block in enumerate(body.blocks):
            if block.mirror is not None:
                original, signs = block.mirror
                rows = body.rows(block)
                reached[np.ix_(rows, rows)] = twin_matrix(body, block, reached)
                parts[k] = rows, np.tile(signs, len(body.ports)), parts[original][2]
    solved = () if modes is None else modes.solved
    chosen = with_neighbours(modes, wanted)
    chosen += _farther(chosen, solved)
    shapes = sorted(
        (_Shape(m, value, u) for m in chosen for value, u in zip(eigenvalues(m), m.vectors)),
        key=lambda shape: shape.value,
    )
    kept = body.cache.find(_OfShapes)
    if kept is None or not kept.holds(shapes):
        kept = _OfShapes(shapes, *_of_shapes(body, shapes))
        body.cache.keep(kept)
    products, cells_of = kept.of(shapes)
    by_cells: dict[str, np.ndarray] = {}
    for shape, energy in zip(shapes, cells_of):
        name = shape.mode.name
        # the mean of a pair, of which some bodies hold one shape only
        by_cells[name] = by_cells.get(name, 0.0) + energy / len(shape.mode.vectors)

    def cells(forces: np.ndarray) -> np.ndarray:
        by_block = [
            _by_cells(body, _original(body, index), errors, signs * forces[rows])
            for index, (rows, signs, errors) in parts.items()
        ]
        return np.sum(by_block, axis=0)

    lowest = _lowest(shapes, safety * share * products)
    return SolidBounds(body, share, reached, lowest, by_cells, cells)


def _refuse_cut_seats(scene: Scene, body: Body) -> None:
    """Refuse a mesh from a file in which a rigid seat ends between nodes: those inside hold less of it,
    so that no function of the mesh moves as the body would.
    """
    mesh, hair = body.geometry, 1e-7 * scene.length
    if "file" not in body.mesh or not isinstance(mesh, SolidMesh):
        return
    seats = Seats(mesh, scene.segments, clipped=True)
    rigid = {port.name for port in body.ports if port.attachment == "rigid"}
    for station in scene.stations:
        if station.name not in rigid or getattr(station, "patch", None) is not None:
            continue
        y = mesh.mesh.p[1, mesh.mesh.facets[:, seats(station, "rigid")]]
        if y.min() < station.lo - hair or y.max() > station.hi + hair:
            raise NoBounds(
                f"the rigid seat of {station.name!r} ends between nodes of the mesh, which hold less of "
                "it than it is long: put nodes at its ends, or use attachment 'average'"
            )


def share_of_error(scene: Scene, body: Body) -> float:
    """Return the largest energy of an error of a 3D body over that which one order more finds of it;
    refuse a mesh on which it finds next to nothing.
    """
    element = body.mesh["element"]
    order = ELEMENTS[element].order
    mesh = mesh_of(body)
    layers = None if mesh is None else Layers.of(scene, body, mesh)
    share = 1 / (1 - (order / (order + 1)) ** (4 * _sharpest(scene, body, layers)))
    share = max(share, narrow_share(scene, body, order, layers))
    if layers is not None:
        layers.refuse_locked()
        share += layers.added_share
    return share * SLOWER.get(element, 1.0)


def _sharpest(scene: Scene, body: Body, layers: Layers | None) -> float:
    """Return the exponent of displacement at the sharpest edge of a body, with or without an axis."""
    edges = LOAD_EDGE
    if layers is not None and scene.body is not None:
        # edges of a part from a file stand in its mesh, as those of its round part do in the outline
        edges = layers.sharp.sharpest
        share = share_within(least_side(scene.length) / scene.length, edges)
        refuse_unresolved(layers.sharp.at_sharpest(layers.mesh), share)
    if not without_axis(scene):
        rigid = [port.name for port in body.ports if port.attachment == "rigid"]
        return min(sharpest_exponent(scene, rigid), edges)
    loaded = any(getattr(s, "patch", None) is not None for s in scene.stations)
    return edges if loaded or edges < LOAD_EDGE else CONVEX


@dataclass(frozen=True)
class _Shape:
    """One shape of a mode, with its eigenvalue."""

    mode: Mode
    value: float  #: rad^2/s^2
    vectors: dict[int, np.ndarray]  #: as in :attr:`Mode.vectors`

    @property
    def fields(self) -> tuple[tuple[int, int], ...]:
        """Blocks, and the arrays that hold the shape."""
        return tuple((block, id(field)) for block, field in self.vectors.items())


@dataclass(frozen=True)
class _OfShapes:
    """Errors of the shapes that were computed last; kept with their body."""

    shapes: Sequence[_Shape]
    products: np.ndarray  #: (k, k) of energy, rad^2/s^2
    by_cells: Sequence[np.ndarray]  #: (ne,) energies of each

    def holds(self, shapes: Sequence[_Shape]) -> bool:
        """Return whether the errors of some shapes are among these."""
        return {shape.fields for shape in shapes} <= {shape.fields for shape in self.shapes}

    def of(self, shapes: Sequence[_Shape]) -> tuple[np.ndarray, list[np.ndarray]]:
        """Return the products (k, k) and the energies by cells of some of the shapes."""
        fields = [shape.fields for shape in self.shapes]
        places = [fields.index(shape.fields) for shape in shapes]
        return self.products[np.ix_(places, places)], [self.by_cells[k] for k in places]


def eigenvalues(mode: Mode) -> tuple[float, ...]:
    """Return the eigenvalue of every shape of a mode, rad^2/s^2: of twins those about their mean."""
    mean = eigenvalue(mode)
    if len(mode.vectors) == 1:
        return (mean,)
    apart = (1 + mode.split) ** 2
    return 2 * mean / (1 + apart), 2 * mean * apart / (1 + apart)


def _of_shapes(body: Body, shapes: Sequence[_Shape]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the products of energy (k, k) of the errors of shapes, and their energies by cells
    (ne,); of a shape in several blocks those of all.
    """
    products = np.zeros((len(shapes), len(shapes)))
    by_cells = [np.zeros(1)] * len(shapes)
    for index in range(len(body.blocks)):
        # a block and its twin hold the same matrices
        parts = [
            (k, place, vector)
            for k, shape in enumerate(shapes)
            for place, vector in shape.vectors.items()
            if _original(body, place) == index
        ]
        if not parts:
            continue
        fields = np.column_stack([vector for *_, vector in parts])
        values = np.array([shapes[k].value for k, *_ in parts])
        errors = errors_of_modes(body, index, fields, values)
        owners = np.array([k for k, *_ in parts])
        blocks = np.array([place for _, place, _ in parts])
        in_one_block = blocks[:, None] == blocks
        np.add.at(products, np.ix_(owners, owners), errors.energies * in_one_block)
        for k, load in zip(owners, np.eye(len(parts))):
            by_cells[k] = by_cells[k] + _by_cells(body, index, errors, load)
    return products, by_cells


def _original(body: Body, index: int) -> int:
    """Return the block that one repeats; of one that repeats none, itself."""
    mirror = body.blocks[index].mirror
    return index if mirror is None else mirror[0]


def _farther(chosen: Sequence[Mode], solved: Sequence[Mode]) -> list[Mode]:
    """Return a mode of every eigenproblem that lies farther above those chosen: the first that leaves
    them room, or the last that was solved.
    """
    out: dict[str, Mode] = {}
    for mode in sorted(chosen, key=eigenvalue, reverse=True):
        coupled = [m for m in (*chosen, *out.values()) if shares_blocks(m, mode)]
        highest = max(map(eigenvalue, coupled))
        above = [m for m in solved if shares_blocks(m, mode) and eigenvalue(m) > highest]
        above.sort(key=eigenvalue)
        if above and 1 - eigenvalue(mode) / highest < ROOM:
            with_room = (m for m in above if 1 - eigenvalue(mode) / eigenvalue(m) >= ROOM)
            farther = next(with_room, above[-1])
            out[farther.name] = farther
    return list(out.values())


def _lowest(shapes: Sequence[_Shape], products: np.ndarray) -> dict[str, float]:
    """Return the least eigenvalue of modes by their names, from shapes in ascending order and the
    products of energy of their errors, of every eigenproblem for itself; of twins the lesser.
    """
    lowest: dict[str, float] = {}
    pending = list(range(len(shapes)))
    while pending:
        blocks = set(shapes[pending[0]].vectors)
        places = [k for k in pending if blocks & set(shapes[k].vectors)]
        pending = [k for k in pending if k not in places]
        group = [shapes[k].mode for k in places]
        values = np.array([shapes[k].value for k in places])
        shared = products[np.ix_(places, places)]
        # modes of a coarse mesh lie far too high: the highest at least as far as any other
        off = float((shared.diagonal() / values).max())
        ends = lower_ends(
            values,
            shared,
            values[-1] * max(1 - off, 0.0),
            # the mesh mixes families no more than its own error, so that each keeps its order
            families=[mode.family for mode in group],
        )
        for mode, end in zip(group, ends):
            lowest[mode.name] = min(float(end), lowest.get(mode.name, np.inf))
    return {name: end for name, end in lowest.items() if end > 0}


def _by_cells(body: Body, index: int, errors: Errors, loads: np.ndarray) -> np.ndarray:
    """Return (ne,) energies by cells of the error under a combination of loads: that of a function
    to equal parts to the cells that it lives in.
    """
    more = _enriched(body, index).more
    count = np.bincount(more.cells.ravel())
    work = (errors.fields @ loads) * (errors.residuals @ loads)
    energy = np.bincount(more.functions, work, minlength=len(count)) / np.maximum(count, 1)
    return np.maximum(energy[more.cells].sum(axis=0), 0.0)


@dataclass(frozen=True)
class Errors:
    """Errors of some displacements of a block in one order more."""

    fields: np.ndarray  #: (m, k) the part of one order more
    residuals: np.ndarray  #: (m, k)
    steps: int

    @property
    def energies(self) -> np.ndarray:
        """(k, k) products of energy."""
        products = self.fields.T @ self.residuals
        return (products + products.T) / 2


def errors_of_loads(body: Body, index: int, fields: np.ndarray) -> Errors:
    """Compute the errors of the displacements (n, 6 p) of a block under unit loads on its ports."""
    block = body.blocks[index]
    gram = block.rigid.T @ (block.mass @ block.rigid)
    carried = -block.rigid @ np.linalg.solve(gram, block.rigid.T @ block.ports.T.toarray())
    return enriched_errors(body, index, fields, np.eye(fields.shape[1]), carried)


def errors_of_modes(body: Body, index: int, fields: np.ndarray, values: np.ndarray) -> Errors:
    """Compute the errors of modes (n, k) of a block of eigenvalues (k,), rad^2/s^2."""
    block = body.blocks[index]
    left = block.stiffness @ fields - (block.mass @ fields) * values
    return enriched_errors(body, index, fields, on_ports(block, left), fields * values)


def enriched_errors(
    body: Body, index: int, fields: np.ndarray, forces: np.ndarray, carried: np.ndarray
) -> Errors:
    """Compute the errors of displacements (n, k) of a block under forces (c p, k) on its ports and
    the inertia of an acceleration (n, k), with the energy that is expected where the search ends;
    refuse a problem that does not converge.
    """
    block, enriched = body.blocks[index], _enriched(body, index)
    more, near = enriched.more, enriched.near
    if block.expand is not None:
        fields, carried = block.expand @ fields, block.expand @ carried
    count = fields.shape[1]
    numbers = COPIES * count * (len(enriched.held) + fields.shape[0]) + more.coupling.nnz
    require(8 * numbers / MB, f"error bars by {len(enriched.held)} unknowns of one order more")
    follow = _following(body, index)

    def schur(x: np.ndarray) -> np.ndarray:
        x = near @ x
        return enriched.held * (near.T @ (more.stiffness @ x + more.coupling @ follow(x)))

    inertia = (more.inertia @ carried.reshape(more.inertia.shape[1], -1)).reshape(-1, count)
    loads = enriched.fold.T @ (enriched.ports.T @ forces)
    loads = enriched.held * (loads + near.T @ (inertia - more.coupling @ fields))
    chosen, combination = independent(loads, enriched.inverse)
    search = _Search(schur, enriched.inverse, loads[:, chosen])
    steps = _converged(search)
    scale = np.sqrt(1 + ratio(search.missing, search.energy))
    return Errors(
        enriched.fold @ ((search.solution * scale) @ combination),
        enriched.fold @ ((search.load * scale) @ combination),
        steps,
    )


def on_mesh(body: Body, index: int, errors: Errors) -> np.ndarray:
    """Return the part (n, k) of the errors of a block in the functions of the mesh."""
    enriched = _enriched(body, index)
    return _following(body, index)(enriched.near @ (enriched.fold.T @ errors.fields))


def _following(body: Body, index: int) -> Callable[[np.ndarray], np.ndarray]:
    """Return what gives the displacements (n, k) of the mesh of a block that follow those of one
    order more without any load, from these, of functions that were summed up (s, k).
    """
    block, factor = body.blocks[index], factors(body)[index]
    back = _enriched(body, index).more.coupling.T
    heavy = block.mass @ block.rigid
    gram = block.rigid.T @ heavy

    def follow(x: np.ndarray) -> np.ndarray:
        load = back @ x
        u = factor.solve(load if block.expand is None else block.expand.T @ load)
        u -= block.rigid @ np.linalg.solve(gram, heavy.T @ u)
        return -u if block.expand is None else -(block.expand @ u)

    return follow


def _enriched(body: Body, index: int) -> EnrichedBlock:
    """Return what one order more adds to a block, kept with its body; what it adds to the mesh is
    computed once for all blocks of it.
    """
    kept = body.cache.get(_EnrichedBlocks, _EnrichedBlocks)
    if index not in kept:
        block = body.blocks[index]
        enrich = block.enrich
        assert enrich is not None
        of_mesh = (k.more for i, k in kept.items() if body.blocks[i].enrich is enrich)
        more = next(of_mesh, None)
        if more is None:
            try:
                more = enrich()
            except NoRoom as error:
                raise error.of_model(f"error bars of the {body.fidelity} model", COARSER) from None
            give_back()
        kept[index] = enriched_block(block, more)
    return kept[index]


class _EnrichedBlocks(dict[int, EnrichedBlock]):
    """What one order more adds to blocks by their index."""


class _Search:
    """Conjugate gradients for the solutions of one piece, by the product with its matrix."""

    def __init__(
        self,
        apply: Callable[[np.ndarray], np.ndarray],
        inverse: np.ndarray,
        load: np.ndarray,
    ):
        self._apply, self._inverse = apply, inverse
        self.load, self.solution = load, np.zeros_like(load)
        self._residual, self._step = load.copy(), np.zeros_like(load)
        self._size = np.zeros(load.shape[1])
        self.energy: np.ndarray = np.zeros(load.shape[1])
        self._gains: list[np.ndarray] = []
        self._along: list[np.ndarray] = []
        self._falls: list[np.ndarray] = []

    def advance(self) -> None:
        """Take a step."""
        z = self._inverse[:, None] * self._residual
        size = np.einsum("ij,ij->j", self._residual, z)
        fall = ratio(size, self._size)
        self._step *= fall
        self._step += z
        self._size = size
        pull = self._apply(self._step)
        along = ratio(size, np.einsum("ij,ij->j", self._step, pull))
        self.solution += self._step * along
        pull *= along
        self._residual -= pull
        self._along.append(along)
        self._falls.append(fall)
        self._gains = [*self._gains[-2:], along * size]
        self.energy = self.energy + self._gains[-1]

    @property
    def missing(self) -> np.ndarray:
        """(k,) energy that is still missing, if gains go on to fall as they have."""
        if len(self._gains) < 3:
            return np.full(self.energy.shape, np.inf)
        gain = self._gains[-1]
        left = np.sqrt(ratio(gain, self._gains[-3]))
        missing = np.where(left < 1, gain * left / np.maximum(1 - left, 1e-9), np.inf)
        return np.where(gain > ROUNDING * self.energy, missing, 0.0)

    @property
    def softest(self) -> float:
        """Least eigenvalue of the problem as far as all columns have met it: of Lanczos' matrix, whose
        entries are the steps (Golub and Van Loan 2013, Matrix Computations, 11.3.5).
        """
        along, falls = np.array(self._along), np.array(self._falls)
        least = np.inf
        for alpha, beta in zip(along.T, falls.T):
            alpha = alpha[: int((np.cumsum(alpha <= 0) == 0).sum())]  # until nothing was left
            if len(alpha):
                beta = beta[1 : len(alpha)]
                diagonal = 1 / alpha
                diagonal[1:] += beta / alpha[:-1]
                off = np.sqrt(beta) / alpha[:-1]
                ends = eigvalsh_tridiagonal(diagonal, off, select="i", select_range=(0, 0))
                least = min(least, float(ends[0]))
        return least

    @property
    def most_missing(self) -> np.ndarray:
        """(k,) most that may be missing, if nothing is softer than half of what any column has met, by
        the rule of Gauss and Radau (Meurant and Tichy 2013, Numer. Algorithms 62, 163, algorithm CGQ).
        """
        floor = self.softest / 2
        left = np.einsum("ij,i,ij->j", self._residual, self._inverse, self._residual)
        falls = [*self._falls[1:], ratio(left, self._size)]
        scale, below = np.full(left.shape, 1 / floor), np.zeros(left.shape, bool)
        for along, fall in zip(self._along, falls):
            more = scale - along
            below |= more <= 0  # something is softer
            scale = ratio(more, floor * more + fall)
        most = np.where(below, np.inf, scale * left)
        return np.where(left > ROUNDING * self.energy, most, 0.0)

    @property
    def converged(self) -> bool:
        """Whether little is missing of all columns as gains fall, and at most what the safety covers: gains
        rest for a while where cells are slender, with a quarter of the energy found.
        """
        if not (self.missing <= MISSING * self.energy).all():
            return False
        return bool((self.most_missing <= (LOCAL - 1) * self.energy).all())


def _converged(search: _Search) -> int:
    """Advance until little is missing of any column, and return the steps: the energy of some columns
    rests at half of its end for a while, which others show that do not rest at the same time.
    """
    if not search.load.shape[1]:
        return 0  # a block may stand still
    for count in range(MOST_STEPS):
        search.advance()
        if search.converged:
            return count + 1
    raise NoBounds(
        f"the error in one order more was not found in {MOST_STEPS} steps: the mesh holds very "
        "slender cells, or a material that is next to incompressible; use shorter cells there"
    )
