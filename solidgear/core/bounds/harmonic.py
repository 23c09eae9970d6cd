"""Distance of a harmonic solid from the exact solution: bounds of flexibility and modes, and where
on the mesh they come from.

With the flexibility F of the free body at its ports and M from
:mod:`solidgear.core.kernel.local_problems`, as quadratic forms of loads that balance each other,

    F <= F_exact <= F + M.

Bearings, held ports and housings come after that: whatever they are, compliances grow with the
flexibility and stiffnesses fall, so that both ends are found by condensing both (:meth:`softer`).

Eigenvalues have lower ends by the products of energy of the local solutions of modes of unit mass
(:mod:`solidgear.core.bounds.clusters`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from solidgear.core.body import FURTHER, Block, Body
from solidgear.core.body.cache import Cache
from solidgear.core.bounds.clusters import cluster_of, clusters, lower_ends
from solidgear.core.bounds.loads import Loading
from solidgear.core.bounds.patches import local_energies
from solidgear.core.bounds.richer_space import RicherSpace
from solidgear.core.errors import NoBounds
from solidgear.core.safety import ROOM, SLOWEST
from solidgear.core.solve.groups import is_dense
from solidgear.core.solve.modes import Mode, ModeSet
from solidgear.core.solve.statics import flexibility, twin_matrix

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: shapes of a mode, by blocks and the arrays that hold them
Same = tuple[tuple[int, int], ...]
#: modes of a body, perhaps in other supports, and the names of those whose bounds will be computed
Later = tuple[ModeSet, Sequence[str]]
#: energy of displacements, in that of a mode, that its error does not rest on
NEGLIGIBLE = 1e-10


@dataclass
class HarmonicBounds:
    """Bounds of one harmonic body."""

    body: Body
    #: (ne, 6 p, 6 p) M of the flexibility by cells of the mesh, N m per unit loads; empty without
    #: statics
    of_ports: np.ndarray
    less: np.ndarray  #: (6 p, 6 p) sum of M by a richer space of an order less
    #: (ne,) energies of the local solutions of a mode, rad^2/s^2, by the name of the mode
    of_modes: dict[str, np.ndarray]
    #: least eigenvalue that each mode may have, rad^2/s^2, where one is known
    lowest: dict[str, float]
    two_sided: ClassVar = False  #: a mesh is too stiff

    @cached_property
    def more(self) -> np.ndarray:
        """(6 p, 6 p) M of the flexibility."""
        return self.of_ports.sum(axis=0)

    @cached_property
    def tailed(self) -> np.ndarray:
        """(6 p, 6 p) M of the flexibility with the tail beyond two orders."""
        pairs = zip(np.diag(self.more), np.diag(self.less))
        tail = [with_tail(two, one) / two if two > 0 else 1.0 for two, one in pairs]
        return self.more * np.sqrt(np.outer(tail, tail))

    @property
    def least(self) -> np.ndarray:
        """(6 p, 6 p) least that the flexibility grows by: nothing is known of it."""
        return np.zeros_like(self.less)

    def energy_by_cells(self, forces: np.ndarray) -> np.ndarray:
        """Return (ne,) energies of the local solutions under forces (6 p,) on the ports."""
        return np.einsum("i,cij,j->c", forces, self.of_ports, forces)

    def softer(self, more: np.ndarray) -> Body:
        """Return the body with a larger flexibility; only ports know of it."""
        computed = flexibility(self.body)
        return replace(self.body, cache=Cache(replace(computed, matrix=computed.matrix + more)))

    def frequency(self, mode: Mode) -> float | None:
        """Return the least frequency that a mode may have, Hz; None where nothing was solved beyond
        those near it.
        """
        return least_frequency(self.lowest, mode)


def least_frequency(lowest: Mapping[str, float], mode: Mode) -> float | None:
    """Return the least frequency of a mode, Hz, from least eigenvalues by name; None without."""
    least = lowest.get(mode.name)
    return None if least is None else float(np.sqrt(max(least, 0.0)) / (2 * np.pi))


def richer_space(scene: Scene, body: Body) -> RicherSpace:
    """Return the richer space of a harmonic body, kept with it."""
    return body.cache.get(RicherSpace, lambda: RicherSpace(scene, body))


def why_unbounded(scene: Scene, body: Body) -> str:
    """Return the reason why the error of a harmonic body has no bounds; empty where it has."""
    try:
        richer_space(scene, body).unseen()
    except NoBounds as error:
        return str(error)
    return ""


def with_tail(two_more: float, one_more: float) -> float:
    """Return the energy of an error, from bounds by two orders more and by one, with the tail
    beyond them: each order takes an equal share of the remaining energy.

    Examples
    --------
    >>> with_tail(0.75, 0.5)
    1.0
    """
    if not 0.0 < one_more < two_more:
        return float(two_more)
    ratio = min((two_more - one_more) / one_more, SLOWEST)
    return float(two_more + (two_more - one_more) * ratio / (1 - ratio))


def harmonic_bounds(
    scene: Scene,
    body: Body,
    *,
    statics: bool,
    modes: ModeSet | None = None,
    wanted: Sequence[str] = (),
    safety: float = 1.0,
    later: Sequence[Later] = (),
) -> HarmonicBounds:
    """Compute bounds of the flexibility and of some modes of a harmonic body.

    `scene` is the one that the body was meshed from, chamfers as cones
    (:func:`solidgear.core.scene.coned.coned`). `modes` are modes of the body, of every group
    up to one beyond the cluster of each of the `wanted` names; `safety` multiplies the bounds of
    modes. `later` are modes whose bounds will be computed next: local problems that they share with
    these are not solved again.
    """
    space = richer_space(scene, body)
    size, cells = 6 * len(body.ports), space.flat.cells.shape[1]
    computed = body.cache.find(_OfPorts) if statics else None
    ports_missing = statics and computed is None
    empty = np.zeros((cells if ports_missing else 0, size, size))
    of_ports = computed or _OfPorts(empty, np.zeros((size, size)))
    chosen = with_neighbours(modes, wanted)
    kept = body.cache.get(_OfModes, _OfModes)
    new = kept.missing(chosen)
    for mode_set, names in later:
        new += kept.missing(with_neighbours(mode_set, names))
    new = list({same(mode): mode for mode in new}.values())
    of_modes = kept.by_id
    of_modes |= {same(mode): _OfMode(mode, np.zeros(cells)) for mode in new}
    kept.products.update({(same(a), same(b)): 0.0 for a in new for b in new})
    for index, block in _originals(body, new):
        parts = [_modes_on(body, k, new) for k in (index, *_twins(body, index))]
        count = block.ports.shape[0] if ports_missing and block.components else 0
        if count:
            parts.insert(0, _unit_loads(body, index))
        owners = [of_modes[same(mode)] for part in parts for mode in part.modes]
        if not count and not owners:
            continue
        two_more, one_more = local_energies(space, block, _stacked([p.loading for p in parts]))
        for k, owner in enumerate(owners, count):
            owner.by_cell += two_more[:, k, k]
            owner.less += float(one_more[:, k, k].sum())
        kept.add(parts, two_more[:, count:, count:].sum(axis=0))
        if count:
            rows = body.rows(block)
            of_ports.by_cell[np.ix_(np.arange(cells), rows, rows)] = two_more[:, :count, :count]
            of_ports.less[np.ix_(rows, rows)] = one_more[:, :count, :count].sum(axis=0)
    if ports_missing:
        for block in body.blocks:
            if block.mirror is not None:
                rows = body.rows(block)
                of_ports.by_cell[np.ix_(np.arange(cells), rows, rows)] = twin_matrix(
                    body, block, of_ports.by_cell
                )
                of_ports.less[np.ix_(rows, rows)] = twin_matrix(body, block, of_ports.less)
        body.cache.keep(of_ports)
    by_name: dict[str, _OfMode] = {mode.name: of_modes[same(mode)] for mode in chosen}
    solved = () if modes is None else modes.solved
    return HarmonicBounds(
        body,
        of_ports.by_cell,
        of_ports.less,
        {name: e.by_cell for name, e in by_name.items()},
        lower_ends_of(chosen, solved, kept.energies(chosen, safety)),
    )


@dataclass(frozen=True)
class _OfPorts:
    """Bounds of a flexibility; kept with their body."""

    by_cell: np.ndarray
    less: np.ndarray  #: sum by a richer space of an order less


@dataclass
class _OfMode:
    """Energies of the local solutions of a mode."""

    mode: Mode
    by_cell: np.ndarray
    less: float = 0.0  #: sum by a richer space of an order less

    @property
    def energy(self) -> float:
        """With the tail of further orders."""
        return with_tail(self.by_cell.sum(), self.less)


@dataclass(frozen=True)
class _Part:
    """Displacements of one block, and their modes, if they are modes."""

    loading: Loading
    modes: Sequence[Mode] = ()


@dataclass(frozen=True)
class _OfModes:
    """Energies of modes that were computed before; kept with their body."""

    by_id: dict[Same, _OfMode] = field(default_factory=dict)
    #: products of energy of two modes that were computed together
    products: dict[tuple[Same, Same], float] = field(default_factory=dict)

    def missing(self, modes: Sequence[Mode]) -> list[Mode]:
        """Return the modes that are yet to be computed: of near ones all together."""
        out = []
        for group in by_problem(modes):
            near = len(clusters([eigenvalue(m) for m in group])) < len(group)
            known = all(same(m) in self.by_id for m in group) and (
                not near or all((same(a), same(b)) in self.products for a in group for b in group)
            )
            out += [m for m in group if near or same(m) not in self.by_id] if not known else []
        return out

    def add(self, parts: Sequence[_Part], products: np.ndarray) -> None:
        """Add products of energy (k, k) of the modes of some parts: each goes with those of its own
        part.
        """
        first = 0
        for part in parts:
            for i, a in enumerate(part.modes):
                for j, b in enumerate(part.modes):
                    self.products[same(a), same(b)] += float(products[first + i, first + j])
            first += len(part.modes)

    def energies(self, modes: Sequence[Mode], safety: float) -> np.ndarray:
        """Return (k, k) products of energy of some modes, with tails; zero of those that are not
        near.
        """
        found = [self.by_id[same(mode)] for mode in modes]
        grown = [e.energy / e.by_cell.sum() if e.by_cell.any() else 1.0 for e in found]
        matrix = np.array(
            [[self.products.get((same(a), same(b)), 0.0) for b in modes] for a in modes]
        )
        matrix = matrix.reshape(len(modes), len(modes)) * np.sqrt(np.outer(grown, grown))
        np.fill_diagonal(matrix, [e.energy for e in found])
        return safety * matrix


def with_neighbours(modes: ModeSet | None, wanted: Sequence[str]) -> list[Mode]:
    """Return the wanted modes, and of their groups those that might change places with them: one
    more, and of a cluster all, with what lies beyond it.
    """
    if modes is None or not wanted:
        return []
    elastic = [m for m in modes.solved if m.frequency_hz > 0]
    elastic.sort(key=lambda m: m.frequency_hz)
    chosen = []
    for name in wanted:
        mode = modes.named(name)
        if mode is None:
            continue
        group = [m for m in elastic if of_one_problem(m, mode)]
        chosen += group[: group.index(mode) + 2]
        coupled = [m for m in elastic if shares_blocks(m, mode)]
        chosen += _cluster([m for m in coupled if of_one_problem(m, mode)], mode)
    return list({m.name: m for m in chosen}.values())


def _cluster(modes: Sequence[Mode], mode: Mode) -> Sequence[Mode]:
    """Return the modes near one, of some in ascending order, and the next one; none of one that is
    alone.
    """
    values = [eigenvalue(m) for m in modes]
    run = cluster_of(values, modes.index(mode))
    return modes[run.start : run.stop + 1] if len(run) > 1 else []


def is_bounded(modes: ModeSet, mode: Mode) -> bool:
    """Return whether a mode was solved so far above another that this one's bar is hardly wider."""
    coupled = [m for m in modes.solved if m.frequency_hz > 0 and shares_blocks(m, mode)]
    return 1 - eigenvalue(mode) / max(map(eigenvalue, coupled)) >= ROOM


def is_beside_many(modes: ModeSet, mode: Mode) -> bool:
    """Return whether modes lie so close from one on that no search would bound it."""
    coupled = [m for m in modes.solved if m.frequency_hz > 0 and shares_blocks(m, mode)]
    coupled.sort(key=lambda m: m.frequency_hz)
    values = [eigenvalue(m) for m in coupled for _ in m.vectors]
    return is_dense(values, values.index(eigenvalue(mode)), ROOM)


def of_one_problem(a: Mode, b: Mode) -> bool:
    """Return whether two modes belong to one eigenproblem."""
    return set(a.vectors[0]) == set(b.vectors[0]) or (
        a.family == b.family and a.multiplicity == b.multiplicity
    )


def shares_blocks(a: Mode, b: Mode) -> bool:
    """Return whether two modes move some of the same blocks, so that they may mix."""
    return not set(a.vectors[0]).isdisjoint(b.vectors[0])


def _originals(body: Body, modes: Sequence[Mode]) -> Iterator[tuple[int, Block]]:
    """Yield blocks that are no mirror images, by the numbers that modes have for them."""
    yield from ((k, block) for k, block in enumerate(body.blocks) if block.mirror is None)
    further = {b for mode in modes for b in mode.vectors[0] if b >= FURTHER}
    yield from ((b, body.block(b)) for b in sorted(further))


def _twins(body: Body, index: int) -> list[int]:
    """Return blocks that are mirror images of one: the same matrices, so that one factor serves
    both.
    """
    return [k for k, block in enumerate(body.blocks) if block.mirror and block.mirror[0] == index]


def _unit_loads(body: Body, index: int) -> _Part:
    """Return unit loads on the ports, balanced by inertia."""
    block = body.blocks[index]
    ports = block.ports.T.toarray()
    heavy = block.rigid.T @ (block.mass @ block.rigid)
    carried = -block.rigid @ np.linalg.solve(heavy, block.rigid.T @ ports)
    return _Part(Loading(flexibility(body).fields[index], np.eye(ports.shape[1]), carried))


def _modes_on(body: Body, index: int, modes: Sequence[Mode]) -> _Part:
    """Return the shapes of modes on one block."""
    on_block = [mode for mode in modes if index in mode.vectors[0]]
    no_modes = np.zeros((body.block(index).size, 0))
    shapes = np.column_stack([no_modes, *(mode.vectors[0][index] for mode in on_block)])
    value = np.array([eigenvalue(mode) for mode in on_block])
    original = body.block(index)
    if original.mirror is not None:
        original = body.block(original.mirror[0])
    return _Part(_vibrating(original, shapes, shapes * value), on_block)


def _vibrating(block: Block, shapes: np.ndarray, carried: np.ndarray) -> Loading:
    """Return displacements of a block, no mirror image, under the inertia forces of accelerations
    and under the forces of supports at the ports.
    """
    residual = block.stiffness @ shapes - block.mass @ carried
    return Loading(shapes, on_ports(block, residual), carried)


@dataclass(frozen=True)
class VibrationEnergies:
    """Energies of the local solutions of k modes of a system that a body is a part of, rad^2/s^2."""

    two_more: np.ndarray  #: (k, k) products by the richer space
    one_more: np.ndarray  #: (k, k) products by the space of an order less
    by_cell: np.ndarray  #: (ne, k) of every mode by cells, by the richer space


def vibration_energies(
    scene: Scene, body: Body, fields: Mapping[int, np.ndarray], value: np.ndarray
) -> VibrationEnergies:
    """Compute the energies of the local solutions of modes of a system that a body is a part of.

    `fields` are (n, k) unknowns of blocks by their index, of unit mass of the system; `value` (k,)
    are eigenvalues, rad^2/s^2.
    """
    count = len(value)
    space, products = richer_space(scene, body), np.zeros((2, count, count))
    by_cell = np.zeros((space.flat.cells.shape[1], count))
    for index, block in _originals(body, ()):
        moving = [k for k in (index, *_twins(body, index)) if k in fields]
        if not moving:
            continue
        # in either plane the same block moves
        basis, shares = _few(block, [fields[k] for k in moving], value, body.scale)
        if not shares.shape[1]:  # no mode moves it, such as axial motion under spur gears
            continue
        energies = local_energies(space, block, basis)
        root = np.sqrt(value)
        # the motions of both planes are orthogonal
        for share in np.split(shares, len(moving)):
            scaled = share * root[:, None]
            for total, energy in zip(products, energies):
                total += scaled @ energy.sum(axis=0) @ scaled.T
            by_cell += np.einsum("ki,cij,kj->ck", scaled, energies[0], scaled, optimize=True)
    return VibrationEnergies(products[0], products[1], by_cell)


def _few(
    block: Block, fields: Sequence[np.ndarray], value: np.ndarray, scale: float
) -> tuple[Loading, np.ndarray]:
    """Return few loadings of a block that k modes, in one plane or two, are made of, and the shares
    (k planes, r) of each in the modes of unit energy; `scale` is about the first eigenvalue of the
    body, rad^2/s^2.
    """
    root = np.tile(np.sqrt(value), len(fields))
    unit = np.hstack(fields) / root
    carried = unit * root**2
    # energy of the displacements, and at most that of what inertia forces bring about
    energy = unit.T @ (block.stiffness @ unit) + carried.T @ (block.mass @ carried) / scale
    size, turn = np.linalg.eigh((energy + energy.T) / 2)
    turn = turn[:, size > NEGLIGIBLE]
    return _vibrating(block, unit @ turn, carried @ turn), turn


def _stacked(parts: Sequence[Loading]) -> Loading:
    """Return the displacements of several loadings side by side."""
    return Loading(
        np.hstack([part.fields for part in parts]),
        np.hstack([part.forces for part in parts]),
        np.hstack([part.carried for part in parts]),
    )


def on_ports(block: Block, residual: np.ndarray) -> np.ndarray:
    """Return the forces on the ports that leave a residual of the free body, in the least-squares
    sense: the effect of bearings and masses on a mode, however stiff they are.
    """
    if not block.ports.shape[0]:
        return np.zeros((0, residual.shape[1]))
    rows = block.ports.toarray()
    size = np.linalg.norm(rows, axis=1)
    size[size == 0.0] = 1.0
    scaled = rows / size[:, None]
    return np.linalg.lstsq(scaled @ scaled.T, scaled @ residual, rcond=1e-12)[0] / size[:, None]


def by_problem(modes: Sequence[Mode]) -> Iterator[list[Mode]]:
    """Yield the modes of every eigenproblem, ascending."""
    pending = sorted(modes, key=lambda m: m.frequency_hz)
    while pending:
        group = [m for m in pending if of_one_problem(m, pending[0])]
        pending = [m for m in pending if m not in group]
        yield group


def lower_ends_of(
    modes: Sequence[Mode], solved: Sequence[Mode], products: np.ndarray
) -> dict[str, float]:
    """Return the least eigenvalue of some modes by their names, from their products of energy (k,
    k), where it is known.
    """
    places = {mode.name: k for k, mode in enumerate(modes)}
    out: dict[str, float] = {}
    for group in by_problem(modes):
        highest = max(eigenvalue(m) for m in solved if of_one_problem(m, group[0]))
        ends: dict[str, float] = {}
        while pending := [m for m in group if m.name not in ends]:
            coupled = [m for m in pending if shares_blocks(m, pending[0])]
            values = np.array([eigenvalue(m) for m in coupled])
            own = [places[m.name] for m in coupled]
            found = lower_ends(values, products[np.ix_(own, own)], highest)
            ends |= {m.name: float(end) for m, end in zip(coupled, found)}
        known = [m for m in group if np.isfinite(ends[m.name])]
        # planes that do not mix share their names
        out |= {m.name: end for m, end in zip(known, sorted(ends[m.name] for m in known))}
    return out


def same(mode: Mode) -> Same:
    """Return what a mode has in common with one of another list that has the same shapes."""
    return tuple((block, id(field)) for shape in mode.vectors for block, field in shape.items())


def eigenvalue(mode: Mode) -> float:
    """Return the eigenvalue of a mode, rad^2/s^2."""
    return float((2 * np.pi * mode.frequency_hz) ** 2)
