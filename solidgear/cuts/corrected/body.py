"""Defect correction: the harmonic solid of the plain part, and the change by features from two 3D
solids on one mesh.

A 3D mesh errs at seat ends and shoulders, and by nearly as much with a feature as without. With
``X`` any number of the free body seen from the ports,

    X = X_harmonic + (X_with - X_without)

keeps only the part of the 3D error that the feature changes (Stetter 1978, Numer. Math. 29, 425). The
harmonic solid errs by 1e-5 to 1e-4, so that a few thousand 3D unknowns give a keyed shaft to 1e-3.

The numbers corrected are: the rigid mass matrix; the flexibility of the lowest free modes and
their port motions, modes turned so that those with the feature are most like those without, and
these most like the harmonic ones; and the residual flexibility of the ports, such that all of the
flexibility is corrected. (The residual mass stays that of the plain part.) No more modes are kept
than leave it positive. They make a small body with the same ports:
bearings, masses and systems are put on it as on any other. It leaves out the dynamics of higher
harmonic modes beyond mu_0 and mu_1, as any superelement does.

A free body seen from the ports: rigid motions, lowest free modes, and residual flexibility.

Rubin's representation (1975, AIAA J. 13, 996): with U the free elastic modes, G the rows of the
ports and H the inverse of K without rigid motions and without U, a body is

    u = R a + U q + H G' f,    rigid mass, lambda, G U,    mu_0 = G H G',    mu_1 = G H M H G',

numbers of the ports alone, on any mesh. Two meshes of one part have nearly the same numbers, so that
those of one can be corrected by the difference of two others.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
from scipy.sparse.csgraph import min_weight_full_bipartite_matching

from solidgear.core import Block, Body, SolidgearError, Surface, modes
from solidgear.core.body.sections import Sections
from solidgear.core.body.surface import Drawing, Volume
from solidgear.core.models.harmonic.body import harmonic
from solidgear.core.models.solid.mesh import SolidMesh
from solidgear.core.scene.shaft import attached_stations
from solidgear.core.solve.statics import port_fields, twin_matrix
from solidgear.cuts.corrected.mesh import meshed_cuts
from solidgear.cuts.solid.featured import featured_body
from solidgear.cuts.solid.halves import PARTS

#: free modes kept, twins counted twice: these hold the supported modes of a plain pinion to 2e-7
#: (bending 1) and 3e-5 (bending 3)
KEPT = 16
#: share of them that is solved in 3D besides, where others lie between
SPARE = 0.6
#: free modes of the plain part on both meshes are the same where sections of one hold this share of
#: the other, and frequencies differ by less
ALIKE, SAME = 0.9, 0.1
#: share with the features, which change a mode: modes recognised had 0.75 and more, modes that were
#: missing, and had another in their place, below 0.05
STILL = 0.5
#: flexibility below this share of the largest one of a port counts as none
NOTHING = 1e-9
#: eigenvalues nearer than this, relative, are those of a pair
TWIN = 1e-6
#: fewest modes that are worth a body, and fewest that are asked for
FEWEST, LEAST = 2, 4
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
    """Build the free body of a scene with features, by defect correction: two blocks where features have
    a mirror plane, one where there is none; options as in
    :data:`~solidgear.core.models.options.CORRECTED_OPTIONS`, of which the first four are those of the
    harmonic solid, and ``refinement`` that of the 3D mesh of both 3D solids.

    Without modes it is as exact at rest, and solves none; it has no natural frequencies then.

    Refused: a rigid seat across a feature, and modes of both meshes that cannot be matched.
    """
    if 0 < modes < LEAST:
        raise SolidgearError(f"corrected: modes = {modes}: give {LEAST} or more, or 0 at rest")
    plain = scene.plain
    base = harmonic(
        plain,
        order=order,
        layers=layers,
        edge_layers=edge_layers,
        relative_size=harmonic_size,
        attachments=attachments,
    )
    ties = [*attached_stations(scene.stations, attachments)]
    cut_mesh = meshed_cuts(scene, refinement, attachments)
    without = featured_body(scene, ties, cut_mesh, refinement, plain=True)
    with_ = featured_body(scene, ties, cut_mesh, refinement)
    exact = modal(base, modes)
    solved = modes + math.ceil(SPARE * modes)
    before, after = modal(without, solved), modal(with_, solved)
    # modes of different groups do not mix: names of blocks, and port components of each
    families: Families = [("full", tuple(range(6)))]
    if cut_mesh.plane is not None:
        families = list(PARTS[cut_mesh.plane])
    exact = _recognised(exact, before, after, families) if modes else exact
    numbers = _corrected(exact, before, after, families)
    while not _positive_enough(numbers.static) and exact.motions.shape[1] > FEWEST:
        exact = exact.first(_fewer(exact))
        numbers = _corrected(exact, before, after, families)
    blocks = tuple(_block(numbers, base, exact, name, family) for name, family in families)
    body = Body(
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
            "geometry": without.mesh["geometry"] * _change(before, after),
        },
        _drawing(base, families, without, with_),
    )
    body.cache.keep(Origin(base, without, with_, ~cut_mesh.cut))
    return body


def _change(before: Modal, after: Modal) -> float:
    """Return the largest share of a flexibility that features change: an error of the shape that both
    3D solids have counts as far.
    """
    plain, change = np.diag(before.static), np.diag(after.static - before.static)
    moved = plain > NOTHING * plain.max()
    return float(np.abs(change[moved] / plain[moved]).max())


@dataclass(frozen=True)
class Origin:
    """The bodies that a corrected one was made of."""

    plain: Body  #: harmonic
    without: Body  #: 3D, features left in
    with_: Body  #: 3D, features cut out
    kept: np.ndarray  #: (ne,) whether a cell of the plain part is one of the other


@dataclass
class _Numbers:
    """Corrected numbers of the ports, as in :class:`~solidgear.cuts.corrected.body.Modal`."""

    rigid_mass: np.ndarray
    value: np.ndarray
    motions: np.ndarray
    static: np.ndarray
    inert: np.ndarray


def _corrected(exact: Modal, before: Modal, after: Modal, families: Families) -> _Numbers:
    # modes of the plain shaft on the 3D mesh that match the harmonic ones, then those with the
    # feature that match these
    """Return the numbers of the harmonic solid, corrected by the change from the 3D solid without
    features to that with features.
    """
    turn = _matched(before, exact, exact.sections, families)
    plain = turn.T @ before.value @ turn, before.motions @ turn
    cut_turn = _matched(after, exact, before.sections @ turn, families)
    cut = cut_turn.T @ after.value @ cut_turn, after.motions @ cut_turn
    # of modes the flexibility, as of all: the error of a mesh at seats and shoulders is one part of
    # it, and the change by a feature is another, so that neither is scaled by the other
    soft, softer, harmonic_flexibility = (np.linalg.inv(v) for v in (plain[0], cut[0], exact.value))
    value = np.linalg.inv(harmonic_flexibility + (softer - soft))
    motions = exact.motions + (cut[1] - plain[1])
    flexibility = exact.static + (after.static - before.static)
    static = flexibility - motions @ np.linalg.solve(value, motions.T)
    inert = exact.residual(np.eye(len(value)))[1]
    # the change of mu_1 by a feature is a small part of a small part, and the difference of two
    # meshes would be that of large numbers: mu_1 is left as it is
    mass = exact.rigid_mass + (after.rigid_mass - before.rigid_mass)
    return _Numbers(mass, (value + value.T) / 2, motions, static, inert)


def _matched(meshed: Modal, exact: Modal, sections: np.ndarray, families: Families) -> np.ndarray:
    """Return the turn (k, l) of modes that makes them most like others, which match the harmonic
    ones and move ``sections``; only modes of one family match, for no block of another could hold a
    part of them.
    """
    turn = np.zeros((meshed.motions.shape[1], exact.motions.shape[1]))
    for _, components in families:
        rows, columns = meshed.within(components), exact.within(components)
        turn[np.ix_(rows, columns)] = alike_turn(
            meshed.sections[:, rows], sections[:, columns], exact.gram
        )
    return turn


def _positive_enough(static: np.ndarray) -> bool:
    """Return True where no load meets a flexibility that is clearly negative."""
    size = np.sqrt(np.maximum(np.diag(static), 0.0))
    size = np.where(size > 0, size, 1.0)
    w = np.linalg.eigvalsh(static / np.outer(size, size))
    return bool(w[0] > -NOTHING * w[-1])


def _fewer(exact: Modal) -> int:
    """Return the number of modes without the highest, or without the highest pair."""
    value = np.diag(exact.value)
    return len(value) - (2 if value[-1] < value[-2] * (1 + TWIN) else 1)


def _recognised(exact: Modal, before: Modal, after: Modal, families: Families) -> Modal:
    """Return the lowest harmonic modes, as far as each is recognised among those of the 3D mesh by
    shape and frequency, and no more of a family than both 3D solids have: on a stub, many of
    theirs move no sections and match none.
    """
    count = 0
    value = np.diag(exact.value)
    for k in range(1, len(value) + 1):
        if k < len(value) and value[k] < value[k - 1] * (1 + TWIN):
            continue  # a pair is turned as one, and not cut in two
        lowest = exact.first(k)
        counts = [
            (len(lowest.within(f)), len(before.within(f)), len(after.within(f)))
            for _, f in families
        ]
        if any(n > min(n_before, n_after) for n, n_before, n_after in counts):
            break
        turn = _matched(before, lowest, lowest.sections, families)
        meshed_value = np.diag(turn.T @ before.value @ turn)
        # of the frequency, and not of its square, which the values are
        difference = np.abs(np.sqrt(meshed_value / np.diag(lowest.value)) - 1)
        plain = before.sections @ turn
        cut = after.sections @ _matched(after, lowest, plain, families)
        if (
            (_shared(plain, lowest.sections, lowest.gram) < ALIKE).any()
            or (difference > SAME).any()
            or (_shared(cut, plain, lowest.gram) < STILL).any()
        ):
            break
        count = k
    if count < FEWEST:
        raise SolidgearError(
            "corrected: the free modes of the plain shaft are not recognised on the 3D mesh; "
            "raise refinement, or use the solid"
        )
    return exact.first(count)


def _shared(partners: np.ndarray, modes: np.ndarray, gram: np.ndarray) -> np.ndarray:
    """Return the share of each mode that its partner has, by the motions of sections."""
    by_mode = "ik,ij,jk->k"
    return np.einsum(by_mode, partners, gram, modes) / np.einsum(by_mode, modes, gram, modes)


def _shares(base: Body, families: Families) -> dict[str, list[Block]]:
    """Return the blocks of the harmonic solid that move in each block of the corrected one."""
    return {
        name: [b for b in base.blocks if set(b.components) <= set(components)]
        for name, components in families
    }


def _block(numbers: _Numbers, base: Body, exact: Modal, name: str, family) -> Block:
    """Build the block of a family in rigid motions, modes and attachment fields."""
    components = list(family)
    members = [k for k, b in enumerate(base.blocks) if set(b.components) <= set(family)]
    places = [i for i, v in enumerate(exact.vectors) if next(iter(v)) in members]
    rows = np.array([6 * p + c for p in range(len(base.ports)) for c in components], int)
    static, inert = (m[np.ix_(rows, rows)] for m in (numbers.static, numbers.inert))
    fields, stiff = _attachment_fields(static)
    shapes = _shapes(base, exact, members, places, components, rows, fields)
    mass = sla.block_diag(
        numbers.rigid_mass[components][:, components],
        np.eye(len(places)),
        _positive(fields.T @ inert @ fields),
    )
    stiffness = sla.block_diag(
        np.zeros((len(components),) * 2), numbers.value[places][:, places], stiff
    )
    ports = np.hstack(
        [
            base.rigid_ports[rows][:, components],
            numbers.motions[rows][:, places],
            static @ fields,
        ]
    )
    rigid = np.eye(len(mass))[:, : len(components)]
    return Block(
        name,
        tuple(family),
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
    """Return combinations of port loads whose fields have unit energy, and their stiffness; loads
    under which the ports do not give are left out.
    """
    size = np.sqrt(np.maximum(np.diag(static), 0.0))
    size = np.where(size > 0, size, 1.0)
    w, v = np.linalg.eigh(static / np.outer(size, size))
    keep = w > NOTHING * w.max()
    fields = (v[:, keep] / np.sqrt(w[keep])) / size[:, None]
    return fields, np.eye(int(keep.sum()))


def _positive(matrix: np.ndarray) -> np.ndarray:
    """Return the nearest matrix that is clearly positive definite."""
    w, v = np.linalg.eigh((matrix + matrix.T) / 2)
    return (v * np.maximum(w, 1e-6 * w.max())) @ v.T


def _shapes(base, exact: Modal, members, places, components, rows, fields) -> dict[int, np.ndarray]:
    """Return the unknowns of the harmonic blocks by those of the corrected one, by block."""
    out = {}
    for k in members:
        block = base.blocks[k]
        rigid = np.zeros((block.size, len(components)))
        for i, c in enumerate(block.components):
            rigid[:, components.index(c)] = block.rigid[:, i]
        modes = np.zeros((block.size, len(places)))
        for i, m in enumerate(places):
            if k in exact.vectors[m]:
                modes[:, i] = exact.vectors[m][k]
        block_rows = base.rows(block)
        place = [int(np.flatnonzero(rows == r)[0]) for r in block_rows]
        attached = exact.without_modes(exact.fields[k], k, block_rows)
        out[k] = np.hstack([rigid, modes, attached @ fields[place]])
    return out


def _sections(base: Body, members, shapes) -> Sections:
    """Return the section motions of the plain shaft in the unknowns of the corrected block."""

    def sections(stations):
        parts = {k: base.blocks[k].section_loads(stations) for k in members}
        components = sorted({c for k in members for c in base.blocks[k].components})
        place = {
            6 * s + c: i
            for i, (s, c) in enumerate((s, c) for s in range(len(stations)) for c in components)
        }
        width = next(iter(shapes.values())).shape[1]
        loads, gram = np.zeros((width, len(place))), np.zeros((len(place),) * 2)
        for k, (load, block_gram, columns) in parts.items():
            entries = [place[int(c)] for c in columns]
            loads[:, entries] += shapes[k].T @ load
            gram[np.ix_(entries, entries)] += block_gram
        return loads, gram

    return sections


def _drawing(base: Body, families: Families, without: Body, with_: Body) -> _Drawing | None:
    """Return the drawing of a corrected body; None where the harmonic one has none."""
    if base.geometry is None:
        return None
    return _Drawing(base.geometry, _shares(base, families), without.geometry, with_.geometry)


@dataclass(frozen=True, eq=False)
class _Drawing:
    """Drawing on the plain shaft, which moves as the corrected body does."""

    plain: Drawing
    members: dict[str, list[Block]]
    uncut: Any  #: the 3D solid with its features left in, among whose cells error bars are shared
    cut: Any  #: the one with features cut out

    @property
    def solved(self) -> SolidMesh:
        """The mesh among whose cells error bars are shared."""
        return self.uncut.solved

    def surface(self, moved: Mapping[str, Any]) -> Surface:
        """Return the plain shaft, moved."""
        parts: dict[str, np.ndarray] = {}
        for name, vector in moved.items():
            start = 0
            for block in self.members.get(name, []):
                part = vector[start : start + block.size]
                parts[block.name] = part if block.expand is None else block.expand @ part
                start += block.size
        return self.plain.surface(parts)

    def volume(self) -> Volume | None:
        """Return None: there is no mesh of a volume."""
        return None


#: stations by whose motions modes of two meshes are recognised
STATIONS = 25
#: share of a mode that sections must hold to be one of a shaft: ovalising is left to mu_0
SHAFT = 0.5


@dataclass
class Modal:
    """Port numbers of a free body."""

    rigid_mass: np.ndarray  #: (6, 6)
    #: (k, k) stiffness among the modes, rad^2/s^2: diagonal before it is corrected
    value: np.ndarray
    motions: np.ndarray  #: (6 p, k) G U
    sections: np.ndarray  #: (6 s, k) motions of sections in every mode
    gram: np.ndarray  #: (6 s, 6 s) mass matrix of sections
    static: np.ndarray  #: (6 p, 6 p) mu_0 before any mode is taken out of H
    inert: np.ndarray  #: (6 p, 6 p) mu_1 likewise
    vectors: list[dict[int, np.ndarray]]  #: the modes on the mesh
    moves: list[tuple[int, ...]]  #: port components of the block that each mode is of
    #: ``H G'`` on the mesh likewise, by block, columns of that block's port components
    fields: dict[int, np.ndarray]

    def residual(self, turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return mu_0 and mu_1, (6 p, 6 p) each, with orthonormal combinations (k, l) of the modes
        taken out.
        """
        motions, value = self.motions @ turn, turn.T @ self.value @ turn
        reached = np.linalg.solve(value, motions.T)
        return self.static - motions @ reached, self.inert - reached.T @ reached

    def without_modes(self, fields: np.ndarray, index: int, rows: np.ndarray) -> np.ndarray:
        """Return fields (n, q) of unit loads on port components of a block, the modes taken out."""
        for i, vector in enumerate(self.vectors):
            if index in vector:
                reached = self.motions[rows, i] / self.value[i, i]
                fields = fields - np.outer(vector[index], reached)
        return fields

    def first(self, count: int) -> Modal:
        """Return the same with the lowest modes only."""
        return replace(
            self,
            value=self.value[:count, :count],
            motions=self.motions[:, :count],
            sections=self.sections[:, :count],
            vectors=self.vectors[:count],
            moves=self.moves[:count],
        )

    def within(self, components: tuple[int, ...]) -> np.ndarray:
        """Return the places of the modes that move in these port components and in no others."""
        return np.array(
            [k for k, moved in enumerate(self.moves) if set(moved) <= set(components)], int
        )


def modal(body: Body, count: int) -> Modal:
    """Compute the port numbers of a free body with the ``count`` lowest modes, twins counted twice."""
    vectors, values, moved = [], [], []
    mode_set = modes(body, (), n=count, ovalising=False, stations=STATIONS) if count else None
    for mode in mode_set.modes if mode_set else ():
        if mode.frequency_hz == 0.0 or mode.captured < SHAFT:
            continue
        for vector, motion in zip(mode.vectors, mode.motions):
            vectors.append(vector)
            moved.append(motion.ravel())
            values.append(sum(v @ (body.blocks[b].stiffness @ v) for b, v in vector.items()))
    motions = np.array([body.port_motions(v) for v in vectors]).T
    sections = np.array(moved).T
    gram = mode_set.gram if mode_set else np.eye(6 * STATIONS)
    static, inert, fields = _static(body)
    return Modal(
        rigid_mass=body.mass_matrix(),
        value=np.diag(values),
        motions=motions.reshape(6 * len(body.ports), len(vectors)),
        sections=sections.reshape(6 * STATIONS, len(vectors)),
        gram=gram,
        static=static,
        inert=inert,
        vectors=vectors,
        moves=[body.blocks[next(iter(vector))].components for vector in vectors],
        fields=fields,
    )


def _static(body: Body) -> tuple[np.ndarray, np.ndarray, dict[int, np.ndarray]]:
    """Return mu_0, mu_1 and the fields of unit port loads, rigid motions taken out."""
    n = 6 * len(body.ports)
    static, inert = np.zeros((2, n, n))
    fields: dict[int, np.ndarray] = {}
    for index, u, work, _ in port_fields(body, 1e-20):
        block = body.blocks[index]
        rows = np.ix_(body.rows(block), body.rows(block))
        static[rows], inert[rows] = work, u.T @ (block.mass @ u)
        fields[index] = u
    for index, block in enumerate(body.blocks):
        if block.mirror is not None:
            rows = np.ix_(body.rows(block), body.rows(block))
            for matrix in (static, inert):
                matrix[rows] = twin_matrix(body, block, matrix)
            original, signs = block.mirror
            fields[index] = fields[original] * np.tile(signs, len(body.ports))
    return (static + static.T) / 2, (inert + inert.T) / 2, fields


def alike_turn(sections: np.ndarray, reference: np.ndarray, gram: np.ndarray) -> np.ndarray:
    """Return the rotation (k, l) of modes that makes them most like others, by their section motions
    (6 s, k) and (6 s, l), with orthonormal columns (k >= l).

    Every one of the others is given a mode, by the squared cosine between them; these are turned among
    themselves so that ``sections @ turn`` is nearest to ``reference`` (the orthogonal Procrustes
    problem). Modes without a partner take no part: the span stays one of modes.

    Examples
    --------
    >>> alike_turn(np.eye(2), -np.eye(2)[:, ::-1], np.eye(2)).round(12) + 0.0
    array([[ 0., -1.],
           [-1.,  0.]])
    """
    product = sections.T @ gram @ reference
    size, reference_size = (np.einsum("ik,ij,jk->k", s, gram, s) for s in (sections, reference))
    # from 1 on, for a zero in a sparse matrix is a pair that is not allowed
    cosines = sp.csr_matrix(1.0 + product.T**2 / np.outer(reference_size, size))
    _, chosen = min_weight_full_bipartite_matching(cosines, maximize=True)
    u, _, vt = np.linalg.svd(product[chosen])
    turn = np.zeros(product.shape)
    turn[chosen] = u @ vt
    return turn
