"""A free body reduced once to the lowest free modes and to residual moments of its seats.

Notation: ``A = K + sigma M`` (the operator every body is factored with), G the motions of the
ports, U the rigid motions and the lowest free modes, and H the inverse of A with U taken out of it.
The reduced basis of a set of seats is

    V = [U, W_0, .., W_J],   W_j = (H M)^j H G',

attachment fields (Rubin 1975, AIAA J. 13, 996; the rigid part is inertia relief) and J Krylov steps
on them.  U is invariant under ``A^-1 M`` and the rest lies in its complement, so nothing of the
mesh is needed but the free eigenvalues, ``G U``, and the moments

    mu_j = G (H M)^j H G':   W_i' A W_j = mu_(i+j),   W_i' M W_j = mu_(i+j+1),   W_i' M A^-1 M W_j =
    mu_(i+j+2),   G W_j = mu_j.

Any choice of seats is a choice of rows and columns of these.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp

from solidgear.core.body import Block, Body
from solidgear.core.body.cache import Cache
from solidgear.core.body.mass import ScalarMass
from solidgear.core.machine.threads import pinned
from solidgear.core.solve.families import FAMILIES
from solidgear.core.solve.modes import modes
from solidgear.core.solve.shifted import SHIFT, Factored, factors
from solidgear.core.solve.statics import flexibility

Mass: TypeAlias = sp.csr_matrix | ScalarMass


@dataclass(frozen=True)
class ReducedBlock:
    """One block of a body, seen from the seats; all shapes in U have unit energy in A."""

    components: tuple[int, ...]
    turn: np.ndarray  #: (r, c) coordinates in U of unit rigid motions about the origin
    theta: np.ndarray  #: (u,) ``1 / (lambda + sigma)`` of the shapes in U, rigid ones first, s^2
    motions: np.ndarray  #: (c * p, u) port motions of the shapes in U
    moments: np.ndarray  #: (2 J + 3, c * p, c * p) mu_0 .. mu_(2J+2); empty when U is complete
    cut: float  #: least theta that is not in U: the largest of ``A^-1 M`` on its complement, s^2
    #: of the shapes in U; the last entry is that of the block itself, or empty
    families: tuple[str, ...]
    mirror: tuple[int, tuple[float, ...]] | None = None  #: as in :class:`solidgear.core.body.Block`

    @property
    def steps(self) -> int:
        """Number of fields per port component, J + 1."""
        return max(0, (len(self.moments) - 1) // 2)

    def mirrored(self, index: int, block: Block) -> ReducedBlock:
        """Return the same in the other bending plane."""
        assert block.mirror is not None  # called for blocks that repeat another only
        signs = np.array(block.mirror[1])
        sign = np.tile(signs, len(self.motions) // len(signs))
        return replace(
            self,
            components=block.components,
            turn=self.turn * signs,
            motions=sign[:, None] * self.motions,
            moments=self.moments * np.outer(sign, sign),
            mirror=(index, block.mirror[1]),
        )


@dataclass(frozen=True)
class Reduced:
    """Data of a body that the variants of a sweep need; small, and independent of the body."""

    blocks: tuple[ReducedBlock, ...]
    #: the ports with their static flexibility, and the components of the blocks: enough for
    #: :func:`solidgear.core.solve.statics.condense`
    frame: Body
    shift: float  #: sigma, rad^2/s^2
    round: bool  #: symmetry promises pairs
    level: int  #: number of times the basis was enlarged

    @property
    def size(self) -> int:
        """Unknowns of the largest block with two seats occupied."""
        return max(len(b.theta) + 2 * len(b.components) * b.steps for b in self.blocks)


@dataclass(frozen=True)
class FreeShapes:
    """Mass-orthonormal shapes of a free block, rigid motions first."""

    shapes: np.ndarray  #: (n, r + k)
    value: np.ndarray  #: (r + k,) eigenvalues, ascending, rad^2/s^2; exactly 0 for the r rigid ones
    order: np.ndarray  #: (k,) place of each elastic shape in the input
    #: (r, r) cholesky factor of the rigid mass matrix: unit rigid motions are ``shapes[:, :r] @
    #: lower.T``
    lower: np.ndarray


#: (free modes per wanted one, Krylov steps) from the first basis to the largest
LEVELS = ((1.0, 1), (2.0, 1), (4.0, 2))


@pinned
def reduce(body: Body, n: int, level: int = 0) -> Reduced:
    """Reduce a body for sweeps that need the ``n`` lowest supported shapes, at an index into
    `LEVELS`; the lumped point is its first port, and the seats come after it.
    """
    more, steps = LEVELS[level]
    blocks: list[ReducedBlock] = []
    for index, block in enumerate(body.blocks):
        if block.mirror is not None:
            blocks.append(blocks[block.mirror[0]].mirrored(block.mirror[0], block))
            continue
        # A separate block holds a part of the wanted modes only.
        share = 2 * n if len(block.components) == 6 else n // 2
        blocks.append(_reduce_block(body, index, int(more * (share + 6)), steps))
    return Reduced(
        tuple(blocks),
        _frame(body),
        SHIFT * body.scale,
        body.mesh.get("round", True),
        level,
    )


def _reduce_block(body: Body, index: int, count: int, steps: int) -> ReducedBlock:
    block, factor, shift = body.blocks[index], factors(body)[index], SHIFT * body.scale
    r = len(block.components)
    single = Body(
        body.fidelity,
        (replace(block, mirror=None),),
        body.ports,
        body.scale,
        body.length,
        body.mesh,
        body.geometry,
        cache=Cache(Factored([factor])),
    )
    elastic = [
        (v[0], m.family)
        for m in modes(single, (), n=min(count + 1, block.size)).modes
        if not m.name.rigid
        for v in m.vectors
    ]
    basis = free_shapes(block, [vector for vector, _ in elastic])
    u, value = basis.shapes, basis.value
    theta = 1 / (value + shift)
    families = [_family((c,)) for c in block.components]
    families += [elastic[k][1] for k in basis.order]
    complete = u.shape[1] >= block.size
    cut = 0.0 if complete else float(theta[-1])
    if not complete:
        u, theta, families = u[:, :-1], theta[:-1], families[:-1]
    heavy = block.mass @ u
    moments = np.zeros((0, block.ports.shape[0], block.ports.shape[0]))
    if not complete and r:

        def inverse(load):
            w = factor.solve(load - heavy @ (u.T @ load))
            return w - u @ (heavy.T @ w)

        moments = np.array(residual_fields(inverse, block.mass, block.ports, steps)[0])
    block_family = _family(block.components) if block.components else ""
    scaled = u * np.sqrt(theta)
    turn = basis.lower.T * np.sqrt(1 / theta[:r])[:, None]
    return ReducedBlock(
        block.components,
        turn,
        theta,
        block.ports @ scaled,
        moments,
        cut,
        (*families, block_family),
        None,
    )


def free_shapes(block: Block, elastic: Sequence[np.ndarray]) -> FreeShapes:
    """Return rigid motions of a free block and some elastic modes, mass-normalised and in
    any order, as a basis.
    """
    r = len(block.components)
    lower, columns = np.zeros((0, 0)), list(elastic)
    if r:
        lower = np.linalg.cholesky(block.rigid.T @ (block.mass @ block.rigid))
        columns.insert(0, block.rigid @ sla.inv(lower).T)
    u = np.column_stack(columns) if columns else np.zeros((block.size, 0))
    # Pairs come with their mean frequency; the quotient is that of the shape itself.
    value = np.einsum("ij,ij->j", u, block.stiffness @ u) / np.einsum("ij,ij->j", u, block.mass @ u)
    value[:r] = 0.0
    order = np.argsort(value[r:], kind="stable")
    sequence = np.concatenate([np.arange(r), r + order]).astype(int)
    return FreeShapes(u[:, sequence], value[sequence], order, lower)


def residual_fields(
    inverse: Callable[[np.ndarray], np.ndarray], mass: Mass, ports: sp.csr_matrix, steps: int
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return moments mu_0 .. mu_(2 J + 2) of some ports, even ones across a solve, odd ones as Gram
    matrices, and the fields W_0 .. W_J (n, q) of their rows (q, n), after so many steps J.

    `inverse` is H, the inverse of A (or of K) with U taken out.
    """
    w = inverse(ports.T.toarray())
    out, fields = [ports @ w], [w]
    for step in range(steps + 1):
        heavy = mass @ w
        next_field = inverse(heavy)
        out += [w.T @ heavy, heavy.T @ next_field]
        w = next_field
        if step < steps:
            fields.append(w)
    return [(m + m.T) / 2 for m in out], fields


def residual_basis(mu: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return combinations z ((J + 1) q, w) of the fields W_0 .. W_J with unit energy, from their
    moments (2 J + 3, q, q): ``W z`` has unit Gram matrix in A (or K); and its Gram matrices in M
    and in ``M H M``.
    """
    steps = (len(mu) - 1) // 2

    def hankel(first):
        return np.block([[mu[i + j + first] for j in range(steps)] for i in range(steps)])

    z = orthonormal(hankel(0), mu.shape[1])
    return z, z.T @ hankel(1) @ z, z.T @ hankel(2) @ z


def orthonormal(gram: np.ndarray, width: int) -> np.ndarray:
    """Return combinations of fields with unit Gram matrix: the first ``width`` fields are kept
    whole, later ones where they add something.
    """
    size = 1 / np.sqrt(np.diag(gram))
    gram = gram * np.outer(size, size)
    z = np.zeros((len(gram), 0))
    for start in range(0, len(gram), max(width, 1)):
        new = np.eye(len(gram))[:, start : start + width]
        for _ in range(2):  # twice is enough
            new = new - z @ (z.T @ gram @ new)
        value, vector = np.linalg.eigh(new.T @ gram @ new)
        # Values below this are rounding of the moments; attachment fields must stay for the bound to
        # hold.
        keep = value > (1e-14 if start == 0 else 1e-10)
        z = np.hstack([z, new @ (vector[:, keep] / np.sqrt(value[keep]))])
    return size[:, None] * z


def _family(components: Sequence[int]) -> str:
    """Return the family of motions that all components belong to, or an empty text."""
    return next((name for name, members in FAMILIES.items() if set(components) <= set(members)), "")


def _frame(body: Body) -> Body:
    """Return a body of ports only, with the flexibility of the true one."""

    def bare(block):
        c = len(block.components)
        return Block(
            block.name,
            block.components,
            sp.csr_matrix((0, 0)),
            sp.csr_matrix((0, 0)),
            np.zeros((0, c)),
            np.zeros(0),
            sp.csr_matrix((0, 0)),
            block.mirror,
        )

    return Body(
        body.fidelity,
        tuple(map(bare, body.blocks)),
        body.ports,
        body.scale,
        body.length,
        dict(body.mesh),
        cache=Cache(replace(flexibility(body), fields={})),
    )


__all__ = [
    "LEVELS",
    "FreeShapes",
    "Reduced",
    "ReducedBlock",
    "free_shapes",
    "orthonormal",
    "reduce",
    "residual_basis",
    "residual_fields",
]
