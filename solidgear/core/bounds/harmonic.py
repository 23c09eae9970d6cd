"""Distance of a harmonic solid from the exact solution: bounds of flexibility and modes, and where
on the mesh they come from.

With the flexibility F of the free body at its ports and M from
:mod:`solidgear.core.kernel.local_problems`, as quadratic forms of loads that balance each other,

    F <= F_exact <= F + M.

Bearings, held ports and housings come after that: whatever they are, compliances grow with the
flexibility and stiffnesses fall, so that both ends are found by condensing both (:meth:`softer`).

A Rayleigh quotient lies above its eigenvalue by at most ``M / (1 - lambda / lambda_next)`` with the
energy M of the local solutions of a mode of unit mass (Kato 1949, J. Phys. Soc. Japan 4, 334;
Temple 1928, Proc. R. Soc. A 119, 276). Of near modes the order may change: the lower end of the
j-th is the j-th smallest of all lower ends.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from solidgear.core.body import FURTHER, Block, Body
from solidgear.core.body.cache import Cache
from solidgear.core.bounds.loads import Loading
from solidgear.core.bounds.patches import local_energies
from solidgear.core.bounds.richer_space import RicherSpace
from solidgear.core.solve.modes import Mode, ModeSet
from solidgear.core.solve.statics import flexibility, twin_matrix

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: an order leaves at most this share of the remaining error
SLOWEST = 0.8
#: least gap to the next eigenvalue that a bound is made with, relative; nearer modes are a group
APART = 0.02


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
    lowest: dict[str, float]  #: least eigenvalue that each mode may have, rad^2/s^2
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

    def frequency(self, mode: Mode) -> float:
        """Return the least frequency that a mode may have, Hz."""
        return float(np.sqrt(max(self.lowest[mode.name], 0.0)) / (2 * np.pi))


def richer_space(scene: Scene, body: Body) -> RicherSpace:
    """Return the richer space of a harmonic body, kept with it."""
    return body.cache.get(RicherSpace, lambda: RicherSpace(scene, body))


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
    later: ModeSet | None = None,
) -> HarmonicBounds:
    """Compute bounds of the flexibility and of some modes of a harmonic body.

    `scene` is the one that the body was meshed from, chamfers as cones
    (:func:`solidgear.core.scene.coned.coned`). `modes` are modes of the body, one more of every group
    than the ones of the `wanted` names; `safety` multiplies the bounds of modes. `later` are modes
    of the body in other supports, whose bounds will be computed next: local problems that they
    share with these are not solved again.
    """
    space = richer_space(scene, body)
    size, cells = 6 * len(body.ports), space.flat.cells.shape[1]
    computed = body.cache.find(_OfPorts) if statics else None
    ports_missing = statics and computed is None
    empty = np.zeros((cells if ports_missing else 0, size, size))
    of_ports = computed or _OfPorts(empty, np.zeros((size, size)))
    chosen = with_neighbours(modes, wanted)
    of_modes = body.cache.get(_OfModes, _OfModes).by_id
    new = [m for m in (*chosen, *with_neighbours(later, wanted)) if id(m) not in of_modes]
    of_modes |= {id(mode): _OfMode(mode, np.zeros(cells)) for mode in new}
    for index, block in _originals(body, new):
        parts = [_modes_on(body, k, new) for k in (index, *_twins(body, index))]
        count = block.ports.shape[0] if ports_missing and block.components else 0
        if count:
            parts.insert(0, _unit_loads(body, index))
        owners = [of_modes[id(mode)] for part in parts for mode in part.modes]
        if not count and not owners:
            continue
        two_more, one_more = local_energies(space, block, _stacked([p.loading for p in parts]))
        for k, owner in enumerate(owners, count):
            owner.by_cell += two_more[:, k, k]
            owner.less += float(one_more[:, k, k].sum())
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
    by_name: dict[str, _OfMode] = {mode.name: of_modes[id(mode)] for mode in chosen}
    energy = {name: safety * with_tail(e.by_cell.sum(), e.less) for name, e in by_name.items()}
    solved = () if modes is None else modes.solved
    return HarmonicBounds(
        body,
        of_ports.by_cell,
        of_ports.less,
        {name: e.by_cell for name, e in by_name.items()},
        lower_ends_of(chosen, solved, energy),
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


@dataclass(frozen=True)
class _OfModes:
    """Energies of modes that were computed before; kept with their body."""

    by_id: dict[int, _OfMode] = field(default_factory=dict)


@dataclass(frozen=True)
class _Part:
    """Displacements of one block, and their modes, if they are modes."""

    loading: Loading
    modes: Sequence[Mode] = ()


def with_neighbours(modes: ModeSet | None, wanted: Sequence[str]) -> list[Mode]:
    """Return the wanted modes, and of their groups those that might change places with them: one
    more.
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
    return list({m.name: m for m in chosen}.values())


def of_one_problem(a: Mode, b: Mode) -> bool:
    """Return whether two modes belong to one eigenproblem."""
    return set(a.vectors[0]) == set(b.vectors[0]) or (
        a.family == b.family and a.multiplicity == b.multiplicity
    )


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
    value = np.array([_eigenvalue(mode) for mode in on_block])
    return _Part(_vibrating(body, index, shapes, value), on_block)


def _vibrating(body: Body, index: int, shapes: np.ndarray, value: np.ndarray) -> Loading:
    """Return modes of a body with the forces of its supports at the ports, in the sense of the
    block's original.
    """
    block = body.block(index)
    residual = block.stiffness @ shapes - (block.mass @ shapes) * value
    force = on_ports(block, residual)
    if block.mirror is not None:
        force = force * np.tile(block.mirror[1], len(body.ports))[:, None]
    return Loading(shapes, force, shapes * value)


def vibration_energies(
    scene: Scene, body: Body, fields: Mapping[int, np.ndarray], value: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the energies of the local solutions of modes of a system that a body is a part of, by
    the richer space and by one of an order less, rad^2/s^2.

    `fields` are (n, k) unknowns of blocks by their index, of unit mass of the system; `value` (k,)
    are eigenvalues, rad^2/s^2.
    """
    space, out = richer_space(scene, body), np.zeros((2, len(value)))
    for index, block in _originals(body, ()):
        moving = [k for k in (index, *_twins(body, index)) if k in fields]
        if not moving:
            continue
        parts = [_vibrating(body, k, fields[k], value) for k in moving]
        for row, energy in zip(out, local_energies(space, block, _stacked(parts))):
            row += energy.sum(axis=0).diagonal().reshape(len(moving), -1).sum(axis=0)
    return out[0], out[1]


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


def lower_ends_of(
    modes: Sequence[Mode], solved: Sequence[Mode], energy: Mapping[str, float]
) -> dict[str, float]:
    """Return the least eigenvalue of some modes by their names, by the gap to the highest one
    solved of their group: the discrete modes between are orthogonal to each other.
    """
    out: dict[str, float] = {}
    pending = sorted(modes, key=lambda m: m.frequency_hz)
    while pending:
        group = [m for m in pending if of_one_problem(m, pending[0])]
        pending = [m for m in pending if m not in group]
        highest = max(_eigenvalue(m) for m in solved if of_one_problem(m, group[0]))
        value = np.array([_eigenvalue(m) for m in group])
        ends = lower_ends(value, np.array([energy[m.name] for m in group]), highest)
        out |= {mode.name: float(end) for mode, end in zip(group, ends)}
    return out


def lower_ends(value: np.ndarray, energy: np.ndarray, highest: float) -> np.ndarray:
    """Return the least eigenvalues of modes of one eigenproblem, from their Rayleigh quotients,
    ascending, the energies of their local solutions, both (k,), and the highest eigenvalue that was
    solved.

    Examples
    --------
    >>> lower_ends(np.array([1.0, 2.0]), np.array([0.1, 0.1]), 4.0).round(4)
    array([0.8667, 1.8   ])
    """
    gap = 1 - value / highest
    # nothing beyond the last is known: it is looked at for its place only
    gap = np.where(gap > 0, np.maximum(gap, APART), 1.0)
    return np.sort(value - energy / gap)


def _eigenvalue(mode: Mode) -> float:
    return float((2 * np.pi * mode.frequency_hz) ** 2)
