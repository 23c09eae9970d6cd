"""Distance of a harmonic solid from the exact solution: bounds of its flexibility and of its modes,
and where on its mesh they come from.

With the flexibility F of the free body at its ports and M from
:mod:`solidgear.kernel.local_problems`, as quadratic forms of loads that balance each other,

    F <= F_exact <= F + M.

Bearings, held ports and housings come after that: whatever they are, compliances grow with the
flexibility and stiffnesses fall, so that both ends are found by condensing both (:meth:`softer`).

A Rayleigh quotient lies above its eigenvalue by at most ``M / (1 - lambda / lambda_next)`` with the
energy M of the local solutions of a mode of unit mass (Kato 1949, J. Phys. Soc. Japan 4, 334; Temple
1928, Proc. R. Soc. A 119, 276). Of near modes the order may change: the lower end of the j-th is the
j-th smallest of all lower ends.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from solidgear.body import FURTHER, Block, Body
from solidgear.body.cache import Cache
from solidgear.bounds.loads import Loading
from solidgear.bounds.patches import local_energies
from solidgear.bounds.richer_space import RicherSpace
from solidgear.solve.modes import Mode, ModeSet
from solidgear.solve.statics import flexibility, of_twin

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: an order takes at least so little of what is left
SLOWEST = 0.8
#: least gap to the next eigenvalue that a bound is made with, relative; nearer modes are a group
APART = 0.02


@dataclass
class HarmonicBounds:
    """Bounds of one harmonic body."""

    body: Body
    #: (ne, 6 p, 6 p) M of its flexibility by cells of the mesh, N m per unit loads; empty where
    #: statics were not asked for
    of_ports: np.ndarray
    less: np.ndarray  #: (6 p, 6 p) its sum by a richer space of an order less
    #: by the name of a mode, (ne,) energies of its local solutions, rad^2/s^2
    of_modes: dict[str, np.ndarray]
    lowest: dict[str, float]  #: least eigenvalue that each mode may have, rad^2/s^2

    @cached_property
    def more(self) -> np.ndarray:
        """(6 p, 6 p) M of its flexibility."""
        return self.of_ports.sum(axis=0)

    def softer(self, more: np.ndarray) -> Body:
        """The body with a larger flexibility; only ports know of it."""
        known = flexibility(self.body)
        return replace(self.body, cache=Cache(replace(known, matrix=known.matrix + more)))

    def frequency(self, mode: Mode) -> float:
        """Least frequency that a mode may have, Hz."""
        return float(np.sqrt(max(self.lowest[mode.name], 0.0)) / (2 * np.pi))


def richer_space(scene: Scene, body: Body) -> RicherSpace:
    """The richer space of a harmonic body, kept with it."""
    return body.cache.get(RicherSpace, lambda: RicherSpace(scene, body))


def with_tail(two: float, one: float) -> float:
    """Energy of an error as two orders more see it, with the tail that they do not: as each order
    takes a like share of what is left.

    Parameters
    ----------
    two, one : float
        Bounds by two orders more, and by one.

    Examples
    --------
    >>> with_tail(0.75, 0.5)
    1.0
    """
    if not 0.0 < one < two:
        return float(two)
    ratio = min((two - one) / one, SLOWEST)
    return float(two + (two - one) * ratio / (1 - ratio))


def harmonic_bounds(
    scene: Scene,
    body: Body,
    *,
    statics: bool,
    found: ModeSet | None = None,
    wanted: Sequence[str] = (),
    safety: float = 1.0,
    later: ModeSet | None = None,
) -> HarmonicBounds:
    """Bounds of a harmonic body.

    Parameters
    ----------
    scene : Scene
        That the body was meshed from, chamfers as cones (:func:`solidgear.scene.coned.coned`).
    statics : bool
        Whether the flexibility is wanted.
    found : ModeSet, optional
        Modes of the body, one more of every group than wanted.
    wanted : sequence of str
        Names of modes.
    safety : float
        On the bounds of modes.
    later : ModeSet, optional
        Of the body in other supports, whose bounds will be asked for: what local problems of theirs
        have in common with these is not done again.
    """
    space = richer_space(scene, body)
    size, cells = 6 * len(body.ports), space.flat.cells.shape[1]
    known = body.cache.find(_OfPorts) if statics else None
    still = statics and known is None
    empty = np.zeros((cells if still else 0, size, size))
    of_ports = known or _OfPorts(empty, np.zeros((size, size)))
    modes = _asked(found, wanted)
    local = body.cache.get(_OfModes, _OfModes).of
    new = [m for m in (*modes, *_asked(later, wanted)) if id(m) not in local]
    local |= {id(mode): _OfMode(mode, np.zeros(cells)) for mode in new}
    every = () if found is None else found.solved
    for index, block in _originals(body, new):
        parts = [_of_modes(body, k, new) for k in (index, *_twins(body, index))]
        count = block.ports.shape[0] if still and block.components else 0
        if count:
            parts.insert(0, _of_loads(body, index))
        owners = [local[id(mode)] for part in parts for mode in part.modes]
        if not count and not owners:
            continue
        two, one = local_energies(space, block, _together([part.loading for part in parts]))
        for k, owner in enumerate(owners, count):
            owner.whole += two[:, k, k]
            owner.less += float(one[:, k, k].sum())
        if count:
            rows = body.rows(block)
            of_ports.whole[np.ix_(np.arange(cells), rows, rows)] = two[:, :count, :count]
            of_ports.less[np.ix_(rows, rows)] = one[:, :count, :count].sum(axis=0)
    if still:
        for block in body.blocks:
            if block.mirror is not None:
                rows = body.rows(block)
                of_ports.whole[np.ix_(np.arange(cells), rows, rows)] = of_twin(
                    body, block, of_ports.whole
                )
                of_ports.less[np.ix_(rows, rows)] = of_twin(body, block, of_ports.less)
        body.cache.keep(of_ports)
    energy: dict[str, _OfMode] = {mode.name: local[id(mode)] for mode in modes}
    own = {name: safety * with_tail(e.whole.sum(), e.less) for name, e in energy.items()}
    of_modes = {name: e.whole for name, e in energy.items()}
    return HarmonicBounds(
        body, of_ports.whole, of_ports.less, of_modes, _lower_ends(modes, every, own)
    )


@dataclass(frozen=True)
class _OfPorts:
    """Bounds of a flexibility, by cells and for an order less in sum; kept with their body."""

    whole: np.ndarray
    less: np.ndarray


@dataclass
class _OfMode:
    """Energies of the local solutions of a mode, by cells and for an order less in sum."""

    mode: Mode
    whole: np.ndarray
    less: float = 0.0


@dataclass(frozen=True)
class _OfModes:
    """Those that are known, by the mode itself; kept with their body."""

    of: dict[int, _OfMode] = field(default_factory=dict)


@dataclass(frozen=True)
class _Part:
    """Displacements of one block, and the modes that they are, if they are modes."""

    loading: Loading
    modes: Sequence[Mode] = ()


def _asked(found: ModeSet | None, wanted: Sequence[str]) -> list[Mode]:
    """Modes wanted, and of their groups those that might change places with them: one more."""
    if found is None or not wanted:
        return []
    every = [m for m in found.solved if m.frequency_hz > 0]
    every.sort(key=lambda m: m.frequency_hz)
    out = []
    for name in wanted:
        mode = found.named(name)
        if mode is None:
            continue
        group = [m for m in every if of_one_problem(m, mode)]
        out += group[: group.index(mode) + 2]
    return list({m.name: m for m in out}.values())


def of_one_problem(one: Mode, other: Mode) -> bool:
    """True where two modes belong to one eigenproblem."""
    return set(one.vectors[0]) == set(other.vectors[0]) or (
        one.family == other.family and one.multiplicity == other.multiplicity
    )


def _originals(body: Body, modes: Sequence[Mode]) -> Iterator[tuple[int, Block]]:
    """Blocks that are no mirror images, by the numbers that modes have for them."""
    yield from ((k, block) for k, block in enumerate(body.blocks) if block.mirror is None)
    further = {b for mode in modes for b in mode.vectors[0] if b >= FURTHER}
    yield from ((b, body.block(b)) for b in sorted(further))


def _twins(body: Body, index: int) -> list[int]:
    """Blocks that are mirror images of one: the same matrices, so that one factor serves both."""
    return [k for k, block in enumerate(body.blocks) if block.mirror and block.mirror[0] == index]


def _of_loads(body: Body, index: int) -> _Part:
    """Unit loads on the ports, balanced by inertia."""
    block = body.blocks[index]
    ports = block.ports.T.toarray()
    heavy = block.rigid.T @ (block.mass @ block.rigid)
    carried = -block.rigid @ np.linalg.solve(heavy, block.rigid.T @ ports)
    return _Part(Loading(flexibility(body).fields[index], np.eye(ports.shape[1]), carried))


def _of_modes(body: Body, index: int, modes: Sequence[Mode]) -> _Part:
    """Modes on one block."""
    here = [mode for mode in modes if index in mode.vectors[0]]
    none = np.zeros((body.block(index).size, 0))
    shapes = np.column_stack([none, *(mode.vectors[0][index] for mode in here)])
    value = np.array([_eigenvalue(mode) for mode in here])
    return _Part(_vibrating(body, index, shapes, value), here)


def _vibrating(body: Body, index: int, shapes: np.ndarray, value: np.ndarray) -> Loading:
    """Modes of a body in whatever holds it, with what that does to them at the ports, in the sense of
    the block's original.
    """
    block = body.block(index)
    left = block.stiffness @ shapes - (block.mass @ shapes) * value
    force = _on_ports(block, left)
    if block.mirror is not None:
        force = force * np.tile(block.mirror[1], len(body.ports))[:, None]
    return Loading(shapes, force, shapes * value)


def vibration_energies(
    scene: Scene, body: Body, fields: Mapping[int, np.ndarray], value: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Energies of the local solutions of modes of something that a body is a part of, by the richer space
    and by one of an order less, rad^2/s^2.

    Parameters
    ----------
    fields : dict of int to (n, k) ndarray
        Unknowns of blocks by their index, of unit mass of the whole.
    value : (k,) ndarray
        Eigenvalues, rad^2/s^2.
    """
    space, out = richer_space(scene, body), np.zeros((2, len(value)))
    for index, block in _originals(body, ()):
        own = [k for k in (index, *_twins(body, index)) if k in fields]
        if not own:
            continue
        parts = [_vibrating(body, k, fields[k], value) for k in own]
        for row, energy in zip(out, local_energies(space, block, _together(parts))):
            row += energy.sum(axis=0).diagonal().reshape(len(own), -1).sum(axis=0)
    return out[0], out[1]


def _together(parts: Sequence[Loading]) -> Loading:
    """Displacements of several loadings beside each other."""
    return Loading(
        np.hstack([part.fields for part in parts]),
        np.hstack([part.forces for part in parts]),
        np.hstack([part.carried for part in parts]),
    )


def _on_ports(block: Block, left: np.ndarray) -> np.ndarray:
    """Forces on the ports that leave a residual of the free body, in the least-squares sense:
    what bearings and masses do to a mode, however stiff they are.
    """
    if not block.ports.shape[0]:
        return np.zeros((0, left.shape[1]))
    rows = block.ports.toarray()
    size = np.linalg.norm(rows, axis=1)
    size[size == 0.0] = 1.0
    scaled = rows / size[:, None]
    return np.linalg.lstsq(scaled @ scaled.T, scaled @ left, rcond=1e-12)[0] / size[:, None]


def _lower_ends(
    modes: Sequence[Mode], every: Sequence[Mode], energy: Mapping[str, float]
) -> dict[str, float]:
    """Least eigenvalue of some modes, by the gap to the highest one found of their group: the
    discrete modes between are orthogonal to each other.
    """
    out: dict[str, float] = {}
    left = sorted(modes, key=lambda m: m.frequency_hz)
    while left:
        group = [m for m in left if of_one_problem(m, left[0])]
        left = [m for m in left if m not in group]
        highest = max(_eigenvalue(m) for m in every if of_one_problem(m, group[0]))
        value = np.array([_eigenvalue(m) for m in group])
        ends = lower_ends(value, np.array([energy[m.name] for m in group]), highest)
        out |= {mode.name: float(end) for mode, end in zip(group, ends)}
    return out


def lower_ends(value: np.ndarray, energy: np.ndarray, highest: float) -> np.ndarray:
    """Least eigenvalues of modes of one eigenproblem.

    Parameters
    ----------
    value : (k,) ndarray
        Rayleigh quotients, ascending.
    energy : (k,) ndarray
        Of their local solutions.
    highest : float
        The highest one that was found.

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
