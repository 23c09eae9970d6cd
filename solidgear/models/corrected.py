r"""Defect correction: the harmonic solid of the plain part, and what features change by two 3D
solids on one mesh.

A 3D mesh errs at seat ends and shoulders, and by nearly as much with a feature as without. With
``X`` any number of the free body seen from its ports (:mod:`solidgear.models.modal`),

    X = X_harmonic + (X_with - X_without)

keeps of the 3D error only what the feature changes of it (Stetter 1978, Numer. Math. 29, 425). The
harmonic solid errs by 1e-5 to 1e-4, so that a few thousand 3D unknowns give a keyed shaft to 1e-3.

The numbers corrected are: the rigid mass matrix; the flexibility of the lowest free modes and
their port motions, modes turned so that those with the feature are most like those without, and
these most like the harmonic ones; and the residual flexibility of the ports, such that all of the
flexibility is corrected. (The residual mass stays that of the plain part.) No more modes are kept
than leave it positive. They make a small body with the same ports:
bearings, masses and systems are put on it as on any other. What it leaves out of the harmonic solid
is what the modes above the last one kept do that mu_0 and mu_1 do not hold, as in any superelement.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp

from solidgear.body import Block, Body
from solidgear.body.sections import Sections
from solidgear.body.surface import Drawing, Surface, Volume
from solidgear.errors import SolidgearError
from solidgear.models.corrected_mesh import meshed_cuts
from solidgear.models.harmonic.body import harmonic
from solidgear.models.modal import Modal, alike_turn, modal
from solidgear.models.solid.featured import featured_body
from solidgear.models.solid.halves import PARTS
from solidgear.scene.attached import attached_stations

#: free modes kept, twins counted twice: these hold the supported modes of a plain pinion to 2e-7
#: (bending 1) and 3e-5 (bending 3)
KEPT = 16
#: share of them that is solved in 3D besides, where others lie between
SPARE = 0.6
#: free modes of the plain part on both meshes are the same where sections hold this much of one in
#: the others, and frequencies differ by less
ALIKE, SAME = 0.9, 0.1
#: and with the features, which change it, this much: those found had 0.75 and more, those that were
#: not there, and had another put in their place, below 0.05
STILL = 0.5
#: share of the largest flexibility of a port that is none
NOTHING = 1e-9
#: eigenvalues nearer than this, relative, are those of a pair
TWIN = 1e-6
#: fewest of them that are worth a body
FEWEST = 2
Families = list[tuple[str, tuple[int, ...]]]


def corrected(
    scene,
    *,
    order: int = 4,
    layers: int = 2,
    edge_layers: int = 2,
    harmonic_size: float = 4.0,
    refinement: float = 0.5,
    modes: int = KEPT,
    attachments: tuple[str, ...] | None = None,
) -> Body:
    """Free body of a scene with features, by defect correction: two blocks where features have a mirror
    plane, one where there is none; options as in
    :data:`~solidgear.models.options.CORRECTED_OPTIONS`, of which the first four are those of the
    harmonic solid, ``refinement`` that of the 3D mesh that both 3D solids share.

    Raises
    ------
    SolidgearError
        A rigid seat across a feature, modes of both meshes that cannot be told apart, or what a
        builder raises.
    """
    plain = scene.plain
    base = harmonic(
        plain,
        order=order,
        layers=layers,
        edge_layers=edge_layers,
        relative_size=harmonic_size,
        attachments=attachments,
    )
    wanted = [*attached_stations(scene.stations, attachments)]
    made = meshed_cuts(scene, refinement, attachments)
    without = featured_body(scene, wanted, made, refinement, plain=True)
    with_ = featured_body(scene, wanted, made, refinement)
    exact = modal(base, modes)
    solved = modes + math.ceil(SPARE * modes)
    before, after = modal(without, solved), modal(with_, solved)
    families = _families(made.plane)
    exact = _recognised(exact, before, after, families)
    numbers = _corrected(exact, before, after, families)
    while not _positive_enough(numbers.static) and exact.motions.shape[1] > FEWEST:
        exact = exact.first(_fewer(exact))
        numbers = _corrected(exact, before, after, families)
    blocks = _blocks(numbers, base, exact, made.plane)
    return Body(
        "corrected",
        blocks,
        base.ports,
        base.scale,
        scene.length,
        {
            **without.mesh,
            "order": order,
            "modes_kept": int(exact.motions.shape[1]),
            "harmonic_unknowns": base.size,
            "solid_unknowns": with_.size,
            "volume": with_.mesh["volume"],
        },
        _Drawing(base.geometry, _shares(base, made.plane)) if base.geometry else None,
    )


@dataclass
class _Numbers:
    """Corrected numbers of the ports."""

    rigid_mass: np.ndarray
    value: np.ndarray
    motions: np.ndarray
    static: np.ndarray
    inert: np.ndarray


def _corrected(exact: Modal, before: Modal, after: Modal, families: Families) -> _Numbers:
    # modes of the plain shaft on the 3D mesh that stand for the harmonic ones, then those with the
    # feature that stand for these
    turn = _alike(before, exact, exact.sections, families)
    plain = turn.T @ before.value @ turn, before.motions @ turn
    again = _alike(after, exact, before.sections @ turn, families)
    cut = again.T @ after.value @ again, after.motions @ again
    # of modes the flexibility, as of all: what a mesh lacks at seats and shoulders is a part of it by
    # itself, and what a feature adds is another, so that neither is scaled by the other
    soft, softer, own = (np.linalg.inv(v) for v in (plain[0], cut[0], exact.value))
    value = np.linalg.inv(own + (softer - soft))
    motions = exact.motions + (cut[1] - plain[1])
    whole = exact.static + (after.static - before.static)
    static = whole - motions @ np.linalg.solve(value, motions.T)
    inert = exact.residual(np.eye(len(value)))[1]
    # what a feature changes of mu_1 is a small part of a small part, and the difference of two
    # meshes would be that of large numbers: it is left as it is
    mass = exact.rigid_mass + (after.rigid_mass - before.rigid_mass)
    return _Numbers(mass, (value + value.T) / 2, motions, static, inert)


def _alike(found: Modal, exact: Modal, sections: np.ndarray, families: Families) -> np.ndarray:
    """The turn of modes that makes them most like others, which stand for the harmonic ones and
    move ``sections``. None stands for one of another family: what one of them gives up, no block
    of the other could hold.
    """
    turn = np.zeros((found.motions.shape[1], exact.motions.shape[1]))
    for _, own in families:
        mine, theirs = found.within(own), exact.within(own)
        at = np.ix_(mine, theirs)
        turn[at] = alike_turn(found.sections[:, mine], sections[:, theirs], exact.gram)
    return turn


def _positive_enough(static: np.ndarray) -> bool:
    """True where no load meets a flexibility that is clearly negative."""
    size = np.sqrt(np.maximum(np.diag(static), 0.0))
    size = np.where(size > 0, size, 1.0)
    w = np.linalg.eigvalsh(static / np.outer(size, size))
    return bool(w[0] > -NOTHING * w[-1])


def _fewer(exact: Modal) -> int:
    """Number of modes without the highest, or without the highest pair."""
    value = np.diag(exact.value)
    return len(value) - (2 if value[-1] < value[-2] * (1 + TWIN) else 1)


def _recognised(exact: Modal, before: Modal, after: Modal, families: Families) -> Modal:
    """The lowest of the harmonic modes, as far as each is found among those of the 3D mesh, its
    frequency (not its square, which is what modes hold) nearly the same, and no more of any family
    than both 3D solids have: on a stub, many of theirs move no sections and stand for none.
    """
    count = 0
    value = np.diag(exact.value)
    for k in range(1, len(value) + 1):
        if k < len(value) and value[k] < value[k - 1] * (1 + TWIN):
            continue  # a pair is turned as one, and not cut in two
        own = exact.first(k)
        if any(
            len(own.within(f)) > min(len(m.within(f)) for m in (before, after)) for _, f in families
        ):
            break
        turn = _alike(before, own, own.sections, families)
        theirs = np.diag(turn.T @ before.value @ turn)
        apart = np.abs(np.sqrt(theirs / np.diag(own.value)) - 1)
        plain = before.sections @ turn
        cut = after.sections @ _alike(after, own, plain, families)
        if (
            (_shared(plain, own.sections, own.gram) < ALIKE).any()
            or (apart > SAME).any()
            or (_shared(cut, plain, own.gram) < STILL).any()
        ):
            break
        count = k
    if count < FEWEST:
        raise SolidgearError(
            "corrected: the free modes of the plain shaft are not recognised on the 3D mesh; "
            "raise refinement, or use the solid"
        )
    return exact.first(count)


def _shared(found: np.ndarray, wanted: np.ndarray, gram: np.ndarray) -> np.ndarray:
    """Share of each of some modes that the one that stands for it has, by what sections do."""
    each = "ik,ij,jk->k"
    return np.einsum(each, found, gram, wanted) / np.einsum(each, wanted, gram, wanted)


def _families(plane: int | None) -> Families:
    """Groups that modes cannot mix: names of blocks, and port components of each."""
    return [("full", tuple(range(6)))] if plane is None else list(PARTS[plane])


def _shares(base: Body, plane: int | None) -> dict[str, list[Block]]:
    """Blocks of the harmonic solid that move in each block of the corrected one."""
    return {
        name: [b for b in base.blocks if set(b.components) <= set(own)]
        for name, own in _families(plane)
    }


def _blocks(numbers: _Numbers, base: Body, exact: Modal, plane: int | None) -> tuple[Block, ...]:
    """Blocks in rigid motions, modes and attachment fields."""
    return tuple(_block(numbers, base, exact, name, own) for name, own in _families(plane))


def _block(numbers: _Numbers, base: Body, exact: Modal, name: str, own) -> Block:
    components = list(own)
    members = [k for k, b in enumerate(base.blocks) if set(b.components) <= set(own)]
    mine = [i for i, v in enumerate(exact.vectors) if next(iter(v)) in members]
    rows = np.array([6 * p + c for p in range(len(base.ports)) for c in components], int)
    static, inert = (m[np.ix_(rows, rows)] for m in (numbers.static, numbers.inert))
    fields, stiff = _attachment_fields(static)
    shapes = _shapes(base, exact, members, mine, components, rows, fields)
    mass = sla.block_diag(
        numbers.rigid_mass[components][:, components],
        np.eye(len(mine)),
        _positive(fields.T @ inert @ fields),
    )
    stiffness = sla.block_diag(
        np.zeros((len(components),) * 2), numbers.value[mine][:, mine], stiff
    )
    ports = np.hstack(
        [
            base.rigid_ports[rows][:, components],
            numbers.motions[rows][:, mine],
            static @ fields,
        ]
    )
    rigid = np.eye(len(mass))[:, : len(components)]
    return Block(
        name,
        tuple(own),
        sp.csr_matrix(stiffness),
        sp.csr_matrix(mass),
        rigid,
        np.full(len(mass), np.nan),
        sp.csr_matrix(ports),
        None,
        expand=sp.csr_matrix(np.vstack([shapes[k] for k in members])),
        sections=_sections(base, members, shapes),
    )


def _attachment_fields(static: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Combinations of port loads whose fields have unit energy, and their stiffness; loads under
    which the ports do not give are left out.
    """
    size = np.sqrt(np.maximum(np.diag(static), 0.0))
    size = np.where(size > 0, size, 1.0)
    w, v = np.linalg.eigh(static / np.outer(size, size))
    keep = w > NOTHING * w.max()
    fields = (v[:, keep] / np.sqrt(w[keep])) / size[:, None]
    return fields, np.eye(int(keep.sum()))


def _positive(matrix: np.ndarray) -> np.ndarray:
    """The nearest matrix that is clearly positive definite."""
    w, v = np.linalg.eigh((matrix + matrix.T) / 2)
    return (v * np.maximum(w, 1e-6 * w.max())) @ v.T


def _shapes(base, exact: Modal, members, mine, components, rows, fields) -> dict[int, np.ndarray]:
    """Unknowns of the harmonic blocks from those of the corrected one."""
    out = {}
    for k in members:
        block = base.blocks[k]
        rigid = np.zeros((block.size, len(components)))
        for i, c in enumerate(block.components):
            rigid[:, components.index(c)] = block.rigid[:, i]
        modes = np.zeros((block.size, len(mine)))
        for i, m in enumerate(mine):
            if k in exact.vectors[m]:
                modes[:, i] = exact.vectors[m][k]
        own = base.rows(block)
        place = [int(np.flatnonzero(rows == r)[0]) for r in own]
        attached = exact.without_modes(exact.fields[k], k, own)
        out[k] = np.hstack([rigid, modes, attached @ fields[place]])
    return out


def _sections(base: Body, members, shapes) -> Sections:
    """Section motions of the plain shaft in the unknowns of the corrected block."""

    def sections(stations):
        parts = {k: base.blocks[k].section_loads(stations) for k in members}
        own = sorted({c for k in members for c in base.blocks[k].components})
        place = {
            6 * s + c: i
            for i, (s, c) in enumerate((s, c) for s in range(len(stations)) for c in own)
        }
        width = next(iter(shapes.values())).shape[1]
        loads, gram = np.zeros((width, len(place))), np.zeros((len(place),) * 2)
        for k, (load, block_gram, columns) in parts.items():
            at = [place[int(c)] for c in columns]
            loads[:, at] += shapes[k].T @ load
            gram[np.ix_(at, at)] += block_gram
        return loads, gram

    return sections


@dataclass(frozen=True, eq=False)
class _Drawing:
    """Pictures on the plain shaft, which moves as the corrected body does."""

    plain: Drawing
    members: dict[str, list[Block]]

    def surface(self, moved: Mapping[str, Any]) -> Surface:
        """The plain shaft, moved."""
        parts: dict[str, np.ndarray] = {}
        for name, vector in moved.items():
            start = 0
            for block in self.members.get(name, []):
                own = vector[start : start + block.size]
                parts[block.name] = own if block.expand is None else block.expand @ own
                start += block.size
        return self.plain.surface(parts)

    def volume(self) -> Volume | None:
        """No mesh of a volume."""
        return None
