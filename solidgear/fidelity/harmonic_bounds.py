"""How far a harmonic solid is from the exact solution: bounds of its flexibility and of its modes,
and where on its mesh they come from.

With the flexibility F of the free body at its ports and M from
:mod:`solidgear.fidelity.patches`, as quadratic forms of loads that balance each other,

    F <= F_exact <= F + M.

Bearings, held ports and housings come after that: whatever they are, compliances grow with the
flexibility and stiffnesses fall, so that both ends are found by condensing both (:meth:`softer`).

A Rayleigh quotient lies above its eigenvalue by at most ``M / (1 - lambda / lambda_next)`` with the
energy M of the local solutions of a mode of unit mass (Kato 1949, J. Phys. Soc. Japan 4, 334; Temple
1928, Proc. R. Soc. A 119, 276). Of near modes the order may change: the lower end of the j-th is the
j-th smallest of all lower ends.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from solidgear.body import FURTHER, Block, Body
from solidgear.body.kept import Kept
from solidgear.body.model import component_rows
from solidgear.fidelity.meridian_patches import Loading, local_energies
from solidgear.fidelity.meridian_pieces import RicherSpace
from solidgear.solve.modes import Mode, ModeSet
from solidgear.solve.statics import flexibility

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: an order takes at least so little of what is left
SLOWEST = 0.8
#: least gap to the next eigenvalue that a bound is made with, relative; nearer modes are a group
APART = 0.02


@dataclass
class HarmonicBounds:
    """Bounds of one harmonic body.

    Attributes
    ----------
    body : Body
    more, less : (6 p, 6 p) ndarray
        M of its flexibility, N m per unit loads, by the richer space and by one of an order less; zero
        where statics were not asked for.
    of_ports : (ne, 6 p, 6 p) ndarray
        The same by cells of the mesh.
    of_modes : dict of str to ndarray
        By the name of a mode, (ne,) energies of its local solutions, rad^2/s^2.
    lowest : dict of str to float
        Least eigenvalue that each mode may have, rad^2/s^2.
    """

    body: Body
    more: np.ndarray
    less: np.ndarray
    of_ports: np.ndarray
    of_modes: dict[str, np.ndarray] = field(default_factory=dict)
    lowest: dict[str, float] = field(default_factory=dict)

    def softer(self, more: np.ndarray) -> Body:
        """The body with a larger flexibility; only ports know of it."""
        known = flexibility(self.body)
        return replace(self.body, kept=Kept(replace(known, matrix=known.matrix + more)))

    def frequency(self, mode: Mode) -> float:
        """Least frequency that a mode may have, Hz."""
        return float(np.sqrt(max(self.lowest[mode.name], 0.0)) / (2 * np.pi))


def richer_space(scene: Scene, body: Body) -> RicherSpace:
    """The richer space of a harmonic body, kept with it."""
    return body.kept.get(RicherSpace, lambda: RicherSpace(scene, body))


def with_tail(two: float, one: float) -> float:
    """What two orders more see of an error, and what they would not: as each order takes a like share
    of what is left.

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
) -> HarmonicBounds:
    """Bounds of a harmonic body.

    Parameters
    ----------
    scene : Scene
        That the body was meshed from, chamfers as cones (:func:`solidgear.scene.coned.coned`).
    body : Body
    statics : bool
        Whether the flexibility is wanted.
    found : ModeSet, optional
        Modes of the body, one more of every group than wanted.
    wanted : sequence of str
        Names of modes.
    safety : float
        On the bounds of modes.
    """
    space = richer_space(scene, body)
    size, cells = 6 * len(body.ports), space.flat.cells.shape[1]
    nothing = np.zeros((size, size))
    out = HarmonicBounds(body, nothing, nothing.copy(), np.zeros((cells, size, size)))
    modes = _asked(found, wanted)
    energy = {mode.name: np.zeros(cells) for mode in modes}
    lower = dict.fromkeys(energy, 0.0)
    every = [] if found is None else [*found.modes, *found.beyond]
    for index, block in _blocks(body, modes):
        here = [mode for mode in modes if index in mode.vectors[0]]
        still = statics and bool(block.components) and block.mirror is None
        if not still and not here:
            continue
        loading, ports = _loading(body, index, block, here, still)
        found_here, less = local_energies(space, block, loading)
        for k, mode in enumerate(here):
            energy[mode.name] += found_here[:, ports + k, ports + k]
            lower[mode.name] += float(less[:, ports + k, ports + k].sum())
        if still:
            rows = body.rows(block)
            out.of_ports[np.ix_(np.arange(cells), rows, rows)] = found_here[:, :ports, :ports]
            out.less[np.ix_(rows, rows)] = less[:, :ports, :ports].sum(axis=0)
    if statics:
        for block in body.blocks:
            if block.mirror is not None:
                _mirrored(body, block, out.of_ports)
                _mirrored(body, block, out.less[None])
        out.more = out.of_ports.sum(axis=0)
    out.of_modes = energy
    own = {name: safety * with_tail(e.sum(), lower[name]) for name, e in energy.items()}
    out.lowest = _lower_ends(modes, every, own)
    return out


def _asked(found: ModeSet | None, wanted: Sequence[str]) -> list[Mode]:
    """Modes wanted, and of their groups those that might change places with them: one more."""
    if found is None or not wanted:
        return []
    every = [m for m in (*found.modes, *found.beyond) if m.frequency_hz > 0]
    every.sort(key=lambda m: m.frequency_hz)
    out = []
    for name in wanted:
        mode = found.named(name)
        if mode is None:
            continue
        group = [m for m in every if _alike(m, mode)]
        out += group[: group.index(mode) + 2]
    return list({m.name: m for m in out}.values())


def _alike(one: Mode, other: Mode) -> bool:
    """Whether two modes belong to one eigenproblem."""
    return set(one.vectors[0]) == set(other.vectors[0]) or (
        one.family == other.family and one.multiplicity == other.multiplicity
    )


def _blocks(body: Body, modes: Sequence[Mode]):
    """Blocks by the numbers that modes have for them."""
    yield from enumerate(body.blocks)
    further = {b for mode in modes for b in mode.vectors[0] if b >= FURTHER}
    for b in sorted(further):
        yield b, body.block(b)


def _loading(
    body: Body, index: int, block: Block, modes: Sequence[Mode], still: bool
) -> tuple[Loading, int]:
    """Unit loads on the ports balanced by inertia, then modes; and how many loads there are."""
    fields, forces, carried = [], [], []
    ports = block.ports.T.toarray()
    if still:
        heavy = block.rigid.T @ (block.mass @ block.rigid)
        fields.append(flexibility(body).fields[index])
        forces.append(np.eye(ports.shape[1]))
        carried.append(-block.rigid @ np.linalg.solve(heavy, block.rigid.T @ ports))
    if modes:
        shapes = np.column_stack([mode.vectors[0][index] for mode in modes])
        value = (2 * np.pi * np.array([mode.frequency_hz for mode in modes])) ** 2
        left = block.stiffness @ shapes - (block.mass @ shapes) * value
        fields.append(shapes)
        forces.append(_on_ports(block, left))
        carried.append(shapes * value)
    force = np.hstack(forces)
    if block.mirror is not None:
        force = force * np.tile(block.mirror[1], len(body.ports))[:, None]
    count = ports.shape[1] if still else 0
    return Loading(np.hstack(fields), force, np.hstack(carried)), count


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


def _mirrored(body: Body, block: Block, of_ports: np.ndarray) -> None:
    """Entries of a twin from those of its original."""
    assert block.mirror is not None
    index, signs = block.mirror
    own = body.rows(block)
    original = component_rows(range(len(body.ports)), body.blocks[index].components)
    turn = np.tile(signs, len(body.ports))
    cells = np.arange(len(of_ports))
    of_ports[np.ix_(cells, own, own)] = of_ports[np.ix_(cells, original, original)] * np.outer(
        turn, turn
    )


def _lower_ends(
    modes: Sequence[Mode], every: Sequence[Mode], energy: Mapping[str, float]
) -> dict[str, float]:
    """Least eigenvalue of some modes, by the gap to the highest one found of their group: the
    discrete modes between are orthogonal to each other.
    """
    out: dict[str, float] = {}
    left = sorted(modes, key=lambda m: m.frequency_hz)
    while left:
        group = [m for m in left if _alike(m, left[0])]
        left = [m for m in left if m not in group]
        highest = max(_eigenvalue(m) for m in every if _alike(m, group[0]))
        value = np.array([_eigenvalue(m) for m in group])
        own = np.array([energy[m.name] for m in group])
        gap = 1 - value / highest
        # nothing beyond the last is known: it is looked at for its place only
        gap = np.where(gap > 0, np.maximum(gap, APART), 1.0)
        ends = np.sort(value - own / gap)
        for mode, end in zip(group, ends):
            out[mode.name] = float(end)
    return out


def _eigenvalue(mode: Mode) -> float:
    return float((2 * np.pi * mode.frequency_hz) ** 2)
