"""Ports of a block: rows of mean motions, and rigid (kinematic) attachment, where seat unknowns are
replaced by the six motions of a port.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import Block
from solidgear.core.body.model import Swirl
from solidgear.core.body.sections import from_points, through
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import on_axis, shift


class Attached(NamedTuple):
    """A port of a block."""

    place: float | Sequence[float]  #: y on the axis, or the point, m
    rows: np.ndarray | sp.spmatrix | None = None  #: (c, n) motion of the port
    #: (n,) in place of that, a mask of the unknowns that move with it as one rigid piece
    held: np.ndarray | None = None


def with_ports(block: Block, ports: Iterable[Attached]) -> Block:
    """Add all ports, in their order, to a block that has none yet."""
    nothing = sp.csr_matrix((len(block.components), block.size))
    rows: list[np.ndarray | sp.spmatrix] = []
    ties = []
    for index, port in enumerate(ports):
        rows.append(nothing if port.rows is None else port.rows)
        if port.held is not None:
            ties.append((index, port.place, port.held))
    if rows and not any(map(sp.issparse, rows)):
        # at once: those of a beam, port by port, would take as long as its matrices
        stacked = sp.csr_matrix(np.vstack(rows))
    else:
        stacked = sp.vstack([nothing[:0], *map(sp.csr_matrix, rows)]).tocsr()
    return tie_rigidly(replace(block, ports=stacked), ties)


def tie_rigidly(
    block: Block, ties: Sequence[tuple[int, float | Sequence[float], np.ndarray]]
) -> Block:
    """Let surfaces of a block move as rigid bodies: of each the index of the port, the place (y on
    the axis, or a point, m), and the (n,) mask of unknowns.

    These are replaced by the motion of the port, through ``u = T u_reduced``, so ``T'KT`` and
    ``T'MT``. SolidgearError if two surfaces share unknowns, which would make them one rigid body.
    """
    if not ties:
        return block
    n, c = block.size, len(block.components)
    tied = np.zeros(n, int)
    for _, _, mask in ties:
        tied += mask
    if tied.max() > 1:
        raise SolidgearError(
            "two rigid seats share points of the surface; "
            "separate them or use the attachment 'average'"
        )
    free = np.flatnonzero(tied == 0)
    columns = [
        sp.csr_matrix((np.ones(len(free)), (free, np.arange(len(free)))), shape=(n, len(free)))
    ]
    rigid, y = [block.rigid[free]], [block.y[free]]
    ports = block.ports.tolil()[:, free]
    extra = sp.lil_matrix((ports.shape[0], c * len(ties)))
    for k, (index, place, mask) in enumerate(ties):
        local = _about(block, place)
        unknowns = np.flatnonzero(mask)
        columns.append(sp.csr_matrix(_rows(local, unknowns, n)))
        # Motion of the port under rigid motions of the body about the origin.
        carry = np.linalg.lstsq(local[unknowns], block.rigid[unknowns], rcond=None)[0]
        carry[np.abs(carry) < 1e-12] = 0.0
        rigid.append(carry)
        y.append(np.full(c, np.nan))
        for i in range(c):
            extra[index * c + i, k * c + i] = 1.0
    t = sp.hstack(columns).tocsr()
    # Means taken over a tied surface (a section that touches a seat) follow the tie.
    follow = block.ports @ sp.hstack(columns[1:])
    return Block(
        block.name,
        block.components,
        (t.T @ block.stiffness @ t).tocsr(),
        (t.T @ block.mass @ t).tocsr(),
        np.vstack(rigid),
        np.concatenate(y),
        sp.hstack([ports, extra + follow]).tocsr(),
        planar=block.planar,
        border=c * len(ties),
        expand=t if block.expand is None else (block.expand @ t).tocsr(),
        sections=through(
            block.sections or from_points(block.mass, block.rigid, block.y, block.components), t
        ),
        swirl=reduced(block.swirl, t),
        parity=block.parity,
        enrich=block.enrich,
    )


def reduced(swirl: Swirl | None, t: sp.csr_matrix) -> Swirl | None:
    """Return the effect of spin on fewer unknowns v, where ``u = t v``, from that on u."""
    return None if swirl is None else lambda v: t.T @ swirl(t @ v)


def _about(block: Block, place: float | Sequence[float]) -> np.ndarray:
    """Return rigid motions about a point, or one on the axis."""
    components = list(block.components)
    return block.rigid @ shift(-on_axis(place))[np.ix_(components, components)]


def _rows(values, places, n):
    out = np.zeros((n, values.shape[1]))
    out[places] = values[places]
    return out
