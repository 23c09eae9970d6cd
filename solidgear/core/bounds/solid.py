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

from solidgear.core.body import Body
from solidgear.core.body.cache import Cache
from solidgear.core.body.model import Enrichment
from solidgear.core.bounds.harmonic import lower_ends, on_ports, with_neighbours
from solidgear.core.bounds.sharpest import sharpest_exponent
from solidgear.core.elements import ELEMENTS
from solidgear.core.errors import SolidgearError
from solidgear.core.solve.modes import Mode, ModeSet
from solidgear.core.solve.shifted import factors
from solidgear.core.solve.statics import SOLVED, flexibility, port_fields

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: share of an energy that may be missing where conjugate gradients end
MISSING = 0.04
#: of the lower side: volume and seats of a mesh are not quite those of the body
ROUND = 0.97
#: steps after which they have failed
MOST_STEPS = 200


@dataclass
class SolidBounds:
    """Bounds of one 3D body on its mesh."""

    body: Body
    share: float  #: the largest energy of an error over that in one order more
    #: (6 p, 6 p) energies of the errors under unit loads on the ports in one order more, N m
    reached: np.ndarray
    lowest: dict[str, float]  #: least eigenvalue that each mode may have, rad^2/s^2
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
        return ROUND * self.reached

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

    def frequency(self, mode: Mode) -> float:
        """Return the least frequency that a mode may have, Hz."""
        return float(np.sqrt(max(self.lowest[mode.name], 0.0)) / (2 * np.pi))


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
    order = ELEMENTS[body.mesh["element"]].order
    share = 1 / (1 - (order / (order + 1)) ** (4 * sharpest_exponent(scene)))
    size = 6 * len(body.ports)
    reached = np.zeros((size, size))
    parts: dict[int, tuple[np.ndarray, Errors]] = {}
    if statics:
        for index, fields, _, _ in port_fields(body, SOLVED):
            block = body.blocks[index]
            rows, errors = body.rows(block), errors_of_loads(body, index, fields)
            reached[np.ix_(rows, rows)] = errors.energies
            parts[index] = rows, errors
    chosen = with_neighbours(modes, wanted)
    energy: dict[str, float] = {}
    by_cells: dict[str, np.ndarray] = {}
    for index, block in enumerate(body.blocks):
        on_block = [mode for mode in chosen if index in mode.vectors[0]]
        shapes = [(mode, vectors[index]) for mode in on_block for vectors in mode.vectors]
        if not shapes:
            continue
        fields = np.column_stack([shape for _, shape in shapes])
        fields = fields / np.sqrt(np.einsum("nk,nk->k", fields, block.mass @ fields))
        values = np.array([(2 * np.pi * mode.frequency_hz) ** 2 for mode, _ in shapes])
        errors = errors_of_modes(body, index, fields, values)
        found = np.diag(errors.energies)
        for k, (mode, _) in enumerate(shapes):
            if found[k] > energy.get(mode.name, 0.0):
                energy[mode.name] = float(found[k])
                by_cells[mode.name] = _by_cells(body, index, errors, np.eye(len(shapes))[k])
    solved = () if modes is None else modes.solved
    ends = {str(name): safety * share * value for name, value in energy.items()}

    def cells(forces: np.ndarray) -> np.ndarray:
        by_block = [
            _by_cells(body, index, errors, forces[rows]) for index, (rows, errors) in parts.items()
        ]
        return np.sum(by_block, axis=0)

    lowest: dict[str, float] = {}
    highest = max((m.frequency_hz for m in solved), default=0.0)
    # the mesh mixes families no more than its own error, so that each keeps its order
    for family in dict.fromkeys(mode.family for mode in chosen):
        members = sorted((m for m in chosen if m.family == family), key=lambda m: m.frequency_hz)
        values = (2 * np.pi * np.array([m.frequency_hz for m in members])) ** 2
        energies = np.array([ends[m.name] for m in members])
        family_ends = lower_ends(values, energies, (2 * np.pi * highest) ** 2)
        lowest |= dict(zip((m.name for m in members), family_ends))
    return SolidBounds(body, share, reached, lowest, by_cells, cells)


def _by_cells(body: Body, index: int, errors: Errors, loads: np.ndarray) -> np.ndarray:
    """Return (ne,) energies by cells of the error under a combination of loads: that of a function
    to equal parts to the cells that it lives in.
    """
    numbers = _enrichment(body, index).cells
    energy = ((errors.fields @ loads) * (errors.residuals @ loads)).reshape(-1, 3).sum(axis=1)
    count = np.bincount(numbers.ravel(), minlength=len(energy))
    return np.maximum((energy / count)[numbers].sum(axis=0), 0.0)


@dataclass(frozen=True)
class Errors:
    """Errors of some displacements of a block in one order more."""

    fields: np.ndarray  #: (m, k) the part of one order more
    residuals: np.ndarray  #: (m, k)
    scale: np.ndarray  #: (k,) root of the whole energy over that which was reached
    steps: int

    @property
    def energies(self) -> np.ndarray:
        """(k, k) products of energy."""
        products = self.fields.T @ self.residuals
        return (products + products.T) / 2 * np.outer(self.scale, self.scale)


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
    """Compute the errors of displacements (n, k) of a block under forces (6 p, k) on its ports and
    the inertia of an acceleration (n, k); refuse a problem that does not converge.
    """
    block, more = body.blocks[index], _enrichment(body, index)
    held = more.moves[:, None]
    if block.expand is not None:
        fields, carried = block.expand @ fields, block.expand @ carried
    inertia = (more.inertia @ carried.reshape(more.inertia.shape[1], -1)).reshape(len(held), -1)
    residuals = held * (more.ports.T @ forces + inertia - more.coupling @ fields)
    follow = _following(body, index)

    def schur(x: np.ndarray) -> np.ndarray:
        return held * (more.stiffness @ x + more.coupling @ follow(x))

    return _conjugate_gradients(schur, more.moves / more.stiffness.diagonal(), residuals)


def on_mesh(body: Body, index: int, errors: Errors) -> np.ndarray:
    """Return the part (n, k) of the errors of a block in the functions of the mesh."""
    return _following(body, index)(errors.fields)


def _following(body: Body, index: int) -> Callable[[np.ndarray], np.ndarray]:
    """Return what gives the displacements (n, k) of the mesh of a block that follow those of one
    order more, (m, k), without any load.
    """
    block, factor = body.blocks[index], factors(body)[index]
    back = _enrichment(body, index).coupling.T.tocsr()
    heavy = block.mass @ block.rigid
    gram = block.rigid.T @ heavy

    def follow(x: np.ndarray) -> np.ndarray:
        load = back @ x
        u = factor.solve(load if block.expand is None else block.expand.T @ load)
        u -= block.rigid @ np.linalg.solve(gram, heavy.T @ u)
        return -u if block.expand is None else -(block.expand @ u)

    return follow


def _enrichment(body: Body, index: int) -> Enrichment:
    """Return the enrichment of a block, kept with its body."""
    kept = body.cache.get(_Enrichments, _Enrichments)
    if index not in kept:
        enrich = body.blocks[index].enrich
        assert enrich is not None
        kept[index] = enrich()
    return kept[index]


class _Enrichments(dict[int, Enrichment]):
    """Enrichments of blocks by their index."""


def _conjugate_gradients(apply, inverse, load) -> Errors:
    solution = np.zeros_like(load)
    residual, step = load.copy(), np.zeros_like(load)
    size = np.zeros(load.shape[1])
    energy, gains = np.zeros(load.shape[1]), []
    for count in range(MOST_STEPS):
        z = inverse[:, None] * residual
        fresh = np.einsum("ij,ij->j", residual, z)
        step = z + step * np.divide(fresh, size, out=np.zeros_like(size), where=size > 0)
        size = fresh
        pull = apply(step)
        along = size / np.einsum("ij,ij->j", step, pull)
        solution += step * along
        residual -= pull * along
        gains.append(along * size)
        energy = energy + gains[-1]
        missing = _missing(gains)
        if (missing < MISSING * energy).all():
            return Errors(solution, load, np.sqrt(1 + missing / energy), count + 1)
    raise SolidgearError("the error in one order more was not found")


def _missing(gains: Sequence[np.ndarray]) -> np.ndarray:
    """Return the energy that is still missing, if gains go on to fall as they have."""
    if len(gains) < 3:
        return np.full(gains[-1].shape, np.inf)
    ratio = np.sqrt(gains[-1] / gains[-3])
    return np.where(ratio < 1, gains[-1] * ratio / np.maximum(1 - ratio, 1e-9), np.inf)
