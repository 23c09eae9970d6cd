"""Pieces of a meridian as elements of the richer space: their stiffness, and the residual of some
displacements as loads.

The residual of displacements u under forces f on the ports and inertia forces of an acceleration b
is

    R(v) = f . G v + m(b, v) - a(u, v)

with G the motions of the ports. Weighted by the hats of the mesh it loads the pieces of the richer
space (:mod:`solidgear.core.bounds.richer_space`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from solidgear.core.body import Block
from solidgear.core.bounds.richer_space import Mapped, RicherSpace, hats, inverted, mapped
from solidgear.core.kernel.assembly import batches
from solidgear.core.meshing.lobatto import at_nodes, gauss, products, sides
from solidgear.core.models.harmonic.families import family_of

#: bytes that the arrays of one batch of pieces may take: enough for one call to pay, and few enough
#: for a cache to hold some of them
BATCH = 3e7


@dataclass(frozen=True)
class Loading:
    """Displacements of a block whose error is sought, and the loads that they answer."""

    fields: np.ndarray  #: (n, k) displacements, in the unknowns of the block
    forces: np.ndarray  #: (p c, k) on the ports, those of bearings included
    carried: np.ndarray  #: (n, k) accelerations whose inertia forces load the body


@dataclass(frozen=True)
class Batch:
    """Pieces whose functions are in the order of :func:`_nested`."""

    part: np.ndarray  #: (m,) numbers of the pieces
    stiffness: np.ndarray  #: (m, nb c, nb c)
    loads: np.ndarray  #: (m, 4, nb c, k) by the four hats of their cell
    rigid: np.ndarray  #: (m, nb c, r) rigid motions


class LoadedPieces:
    """Pieces of one block under some displacements."""

    def __init__(self, space: RicherSpace, block: Block, loading: Loading):
        self.space, self.loading = space, loading
        self.family = family = family_of(block.name)
        self.k = loading.fields.shape[1]
        self.motions = len(block.components)
        self.local = self._strained(space.coefficients(block, family, loading.fields))
        self.inert = None
        if np.any(loading.carried):
            self.inert = space.coefficients(block, family, loading.carried)
        #: functions on corners and sides, the order of all, and their counts: see `_nested`
        self.outside, self.order, self.ends = _nested(space.rich)

    def _strained(self, local: np.ndarray) -> np.ndarray:
        """Return coefficients without the rigid motion of every cell: less to cancel in strains."""
        space, c = self.space, self.family.count
        flat = local.reshape(len(local), -1, self.k).copy()
        nodes, inverse = at_nodes(space.order)
        for bent in (False, True):
            cells = np.flatnonzero(space.bent == bent)
            if not len(cells):
                continue
            place = space.places(cells, nodes)
            middle = place[..., 1].mean(axis=1, keepdims=True)
            rigid = self.family.rigid(place[..., 0], place[..., 1] - middle)
            m = rigid.shape[-1]
            if not m:
                continue
            rigid = (inverse @ rigid.reshape(len(cells), -1, c * m)).reshape(len(cells), -1, m)
            q, _ = np.linalg.qr(rigid / np.abs(rigid).max(axis=1, keepdims=True))
            flat[cells] -= q @ (q.transpose(0, 2, 1) @ flat[cells])
        return flat.reshape(local.shape)

    def batches(self) -> Iterator[Batch]:
        """Yield all pieces, some at a time."""
        traction = self._tractions()
        space, c = self.space, self.family.count
        nb = (space.rich + 1) ** 2
        # exact for products of functions on straight cells, but for those divided by r
        x, w = gauss(space.rich + 1)
        a, b = np.meshgrid(x, x, indexing="ij")
        points, area = np.stack([a.ravel(), b.ravel()], axis=1), np.outer(w, w).ravel()
        value, slope = (f[..., self.order, :] for f in products(space.rich, points))
        nq = len(area)
        bytes_each = 8 * (16 * nq * c * self.k + 12 * nb * nq + 2 * (c * nb) ** 2 + 9 * nb * nb)
        segments = space.flat.segment[space.pieces.parent]
        bent = space.bent[space.pieces.parent]
        of_segments = [segment.material for segment in space.scene.segments]
        for material in dict.fromkeys(of_segments):
            made_of = np.array([other == material for other in of_segments])[segments]
            law = self.family.stiffness(material).reshape(3 * c, 3 * c)
            for curved in (False, True):
                pieces = np.flatnonzero(made_of & (bent == curved))
                for part in batches(pieces, bytes_each * 4e6 / BATCH):
                    g = mapped(space, part, points)
                    weight = self.family.weight(g.place[..., 0], g.det * area)
                    f = _functions(g, value, slope, np.sqrt(weight))
                    stiffness = _stiffness(f, law, c)
                    loads = self._loads(part, g, f, value, weight, law, material.density)
                    for j, piece in enumerate(part):
                        if int(piece) in traction:
                            loads[j] += traction[int(piece)]
                    yield Batch(part, stiffness, loads, self._rigid(part))

    def _rigid(self, part: np.ndarray) -> np.ndarray:
        """Return (m, nb c, r) rigid motions of pieces."""
        nodes, inverse = at_nodes(self.space.rich)
        place = mapped(self.space, part, nodes).place
        rigid = self.family.rigid(place[..., 0], place[..., 1])
        coefficients = inverse[self.order] @ rigid.reshape(
            len(part), len(nodes), np.prod(rigid.shape[2:])
        )
        c, count = rigid.shape[-2:]
        return coefficients.reshape(len(part), len(nodes) * c, count)

    def _loads(self, part, g: Mapped, f, value, weight, law, density) -> np.ndarray:
        """Return (m, 4, nb c, k) the residual of the displacements, weighted by the hats of the
        cell.
        """
        c, k = self.family.count, self.k
        parent = self.space.pieces.parent[part]
        m, _, nb, nq = f.shape
        coefficients = self.local[parent].reshape(m, -1, c * k)
        strain = np.empty((m, 3, nq, c * k))
        strain[:, 0] = (g.value.transpose(0, 2, 1) @ coefficients) / g.place[..., 0][..., None]
        along = [rate.transpose(0, 2, 1) @ coefficients for rate in g.slope]
        for d in (0, 1):
            strain[:, 1 + d] = along[0] * g.outer[:, 0, d][..., None]
            strain[:, 1 + d] += along[1] * g.outer[:, 1, d][..., None]
        strain = strain.reshape(m, 3, nq, c, k).transpose(0, 1, 3, 2, 4).reshape(m, 3 * c, -1)
        stress = (law @ strain).reshape(m, 3, c, nq, k).transpose(0, 1, 3, 2, 4)
        hat, rate = hats(g.points)
        fall = [
            rate[0] * g.outer[:, 0, d][:, None] + rate[1] * g.outer[:, 1, d][:, None]
            for d in (0, 1)
        ]
        right = np.empty((m, 4, 4, nq, c, k))
        # the functions have the other root of the weight
        half = stress * np.sqrt(weight)[:, None, :, None, None]
        right[:, :, :3] = -hat[:, :, None, :, None, None] * half[:, None]
        full = stress[:, 1:] * weight[:, None, :, None, None]
        right[:, :, 3] = -fall[0][..., None, None] * full[:, None, 0]
        right[:, :, 3] -= fall[1][..., None, None] * full[:, None, 1]
        if self.inert is not None:
            moved = self.inert[parent].reshape(m, -1, c * k)
            force = (g.value.transpose(0, 2, 1) @ moved).reshape(m, nq, c, k)
            force = force * self.family.share[:, None] * (density * weight)[..., None, None]
            right[:, :, 3] += hat[..., None, None] * force[:, None]
        functions = np.concatenate([f, np.broadcast_to(value, (m, 1, nb, nq))], axis=1)
        functions = functions.transpose(0, 2, 1, 3).reshape(m, 1, nb, 4 * nq)
        return (functions @ right.reshape(m, 4, 4 * nq, c * k)).reshape(m, 4, nb * c, k)

    def _tractions(self) -> dict[int, np.ndarray]:
        """Return loads on pieces at seats that are not rigid, and at planes, by the numbers of
        pieces.
        """
        space = self.space
        out: dict[int, np.ndarray] = {}
        x, w = gauss(space.rich + 3)
        for i, seat in enumerate(space.carrying):
            if i in space.tied or not seat or not self.motions:
                continue
            force = self.loading.forces[i * self.motions : (i + 1) * self.motions]
            groups = _sides(space, seat, x)
            r, y = np.concatenate([side.place for side in groups]).transpose(2, 0, 1)
            weight = np.concatenate([side.length for side in groups]) * w
            density = self.family.means(r, y - space.ports[i].y, weight) @ force
            first = np.cumsum([0, *(len(side.pieces) for side in groups)])
            for side, rows in zip(groups, map(slice, first, first[1:])):
                value = products(space.rich, side.points)[0][self.order]
                load = np.einsum("bq,shq,sqck->shbck", value, side.hats, density[rows])
                for piece, load_of_piece in zip(
                    side.pieces, load.reshape(len(load), 4, -1, self.k)
                ):
                    out[piece] = out[piece] + load_of_piece if piece in out else load_of_piece
        return out


def _nested(rich: int) -> tuple[np.ndarray, np.ndarray, tuple[int, int, int]]:
    """Return an order of the functions of a piece in which those of an order less are together.

    `outside` (4 rich,) are the functions on corners and sides, those of the top order last; `order`
    ((rich + 1)^2,) has those inside and outside up to an order less, then outside and inside of the
    top order; `ends` are the counts of those inside up to an order less, outside up to it, and
    outside in all.
    """
    count = rich - 1
    low = [4 + k * count + np.arange(count - 1) for k in range(4)]
    outside = np.concatenate([np.arange(4), *low, 4 + np.arange(1, 5) * count - 1])
    border, inside = sides(rich)
    square = inside.reshape(count, count)
    lower = square[:-1, :-1].ravel()
    top = np.concatenate([square[-1], square[:-1, -1]])
    order = np.concatenate([lower, border[outside], top])
    return outside, order, (len(lower), 4 * (rich - 1), 4 * rich)


def _functions(g: Mapped, value, slope, root: np.ndarray) -> np.ndarray:
    """Return (m, 3, nb, nq) values of phi / r, phi,r and phi,y, times the root of the weights."""
    f = np.empty((len(root), 3, *value.shape))
    f[:, 0] = value * (root / g.place[..., 0])[:, None]
    for d in (0, 1):
        f[:, 1 + d] = slope[0] * (g.inverse[:, 0, d] * root)[:, None]
        f[:, 1 + d] += slope[1] * (g.inverse[:, 1, d] * root)[:, None]
    return f


def _stiffness(f: np.ndarray, law: np.ndarray, c: int) -> np.ndarray:
    """Return (m, nb c, nb c) stiffness of pieces from one Gram matrix of their functions."""
    m, _, nb, nq = f.shape
    flat = f.reshape(m, 3 * nb, nq)
    gram = (flat @ flat.transpose(0, 2, 1)).reshape(m, 3, nb, 3, nb)
    gram = gram.transpose(0, 1, 3, 2, 4).reshape(m, 9, nb * nb)
    weights = law.reshape(3, c, 3, c).transpose(1, 3, 0, 2).reshape(c * c, 9)
    out = (weights @ gram).reshape(m, c, c, nb, nb).transpose(0, 3, 1, 4, 2)
    return out.reshape(m, nb * c, nb * c)


@dataclass(frozen=True)
class _Sides:
    """The same side of some pieces that are all straight or all curved."""

    pieces: list[int]
    points: np.ndarray  #: (m, q, 2) in the coordinates of their cells
    place: np.ndarray  #: (m, q, 2) r and y, m
    length: np.ndarray  #: (m, q) derivative of the length along the side, m
    hats: np.ndarray  #: (m, 4, q) of their cells


def _sides(space: RicherSpace, seat: list[tuple[int, int]], x: np.ndarray) -> list[_Sides]:
    """Return points along sides of pieces, grouped by side and shape."""
    like: dict[tuple[int, bool], list[int]] = {}
    for piece, side in seat:
        bent = bool(space.bent[space.pieces.parent[piece]])
        like.setdefault((side, bent), []).append(piece)
    out = []
    for (side, _), pieces in like.items():
        still = np.full_like(x, (0.0, 1.0, 1.0, 0.0)[side])
        points = np.stack([x, still] if side in (0, 2) else [still, x], axis=1)
        g = mapped(space, np.array(pieces), points)
        # derivative of position along the side, from the inverse
        along = inverted(g.inverse)[0][:, :, 0 if side in (0, 2) else 1]
        out.append(
            _Sides(pieces, points, g.place, np.hypot(along[:, 0], along[:, 1]), hats(g.points)[0])
        )
    return out
