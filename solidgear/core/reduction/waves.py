r"""Harmonics n >= 2 of a body of revolution as further coordinates of the superelement.

Ports are mean motions of rings and bearings hold ports, so that these harmonics are coupled neither
to bearings nor to one another; forces on a patch of the surface drive them
(:mod:`solidgear.core.models.harmonic.patch`).  Each is reduced as blocks with ports are
(:mod:`solidgear.core.reduction.rubin`): free modes and residual fields of the mean motions of the patch,
so that its statics is exact and the bound on frequencies of systems holds on.

A harmonic has a cosine and a sine form of the same matrices.  With the patch at the angle t0 and
``a = n t0``, R its rows of the part even (radial, axial) and odd (tangential) about it,

    cosine: cos a R_r, - sin a R_t, cos a R_y,        sine: sin a R_r, cos a R_t, sin a R_y.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import FURTHER, SINE, Body
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import shift
from solidgear.core.machine.threads import pinned
from solidgear.core.reduction.moments import free_shapes
from solidgear.core.reduction.rubin import lowest_shapes, residual_block
from solidgear.core.reduction.superelement import PortMotion, ReducedMotions, Superelement
from solidgear.core.solve.modes import modes
from solidgear.core.solve.shifted import factors

#: free modes of every harmonic that are kept
KEPT = 6


@pinned
def with_waves(
    part: Superelement,
    body: Body,
    carrier: str,
    offset: np.ndarray,
    axes: np.ndarray,
    rows: Mapping[int, np.ndarray],
    name: str = "mesh.point",
    count: int = KEPT,
    fields: Mapping[int, np.ndarray] | None = None,
) -> Superelement:
    """Add harmonics n >= 2 of the body to a superelement, and a port that moves with them.

    Harmonics that it has already are kept: patches at other angles have their fields in common and each
    its port. The new port, of that name, is carried rigidly by the port ``carrier`` at an ``offset``
    (3,), m, with radial, tangential and axial direction as columns of ``axes``; ``rows`` (3, m), by n,
    are mean motions of the patch in these directions. ``count`` free modes of each harmonic are kept.
    ``fields`` (k, m), by n, are mean motions of all patches that are to have ports, where they lie
    differently along the shaft; by default those of this one.
    """
    if name in part.ports:
        raise SolidgearError(
            f"a station is called {name!r}, which is the name of the port at the mesh point; "
            "call it otherwise"
        )
    angle = np.arctan2(axes[0, 0], axes[2, 0])
    blocks = list(part.blocks)
    fields = rows if fields is None else fields
    for n in rows:
        if all(block.index != FURTHER + n for block in blocks):
            value, shapes, truncation = _reduced(body.family(n), fields[n], count)
            still = np.zeros((6, len(part.ports), len(value)))
            for index in (FURTHER + n, SINE + n):
                blocks.append(ReducedMotions(index, value, shapes, still, truncation))
    local = np.hstack([_local(block, angle, axes, rows) for block in blocks])
    added = ((0, 0), (0, local.shape[1] - part.size))
    ports = {
        p: replace(motion, rows=np.pad(motion.rows, added)) for p, motion in part.ports.items()
    }
    carrying = ports[carrier]
    motion = shift(offset) @ carrying.rows
    motion[:3] += local
    port = PortMotion(motion, carrying.point + carrying.axes @ offset, carrying.axes)
    return Superelement(part.kind, part.fidelity, tuple(blocks), {**ports, name: port})


def _local(block: ReducedMotions, angle: float, axes: np.ndarray, rows) -> np.ndarray:
    """Return the motion (3, m) that a block of waves adds to a patch; zeros by other blocks."""
    n = block.index % FURTHER
    if block.index < FURTHER or n not in rows:
        return np.zeros((3, len(block.value)))
    c, s = np.cos(n * angle), np.sin(n * angle)
    turn = np.array([s, c, s] if block.index > SINE else [c, -s, c])
    return axes @ (turn[:, None] * (rows[n] @ block.shapes))


def _reduced(family: Body, rows: np.ndarray, count: int):
    """Return eigenvalues, shapes and truncation of one harmonic; the same for its cosine and its
    sine.
    """
    # every mode stands for two
    shapes, cut = lowest_shapes(modes(family, (), n=2 * count + 1), 2 * count)
    (block,), (factor,) = family.blocks, factors(family)
    free = free_shapes(block, [v[0] for v in shapes])
    nothing = np.zeros(len(rows))
    return residual_block(block, factor, free, cut, sp.csr_matrix(rows), nothing, steps=1)


def own_waves(part: Superelement) -> dict[int, np.ndarray]:
    """Return the coordinates of every harmonic n >= 2 of a superelement, by n, cosine and sine
    together.
    """
    cuts = np.cumsum([0] + [len(block.value) for block in part.blocks])
    out: dict[int, np.ndarray] = {}
    for block, start, end in zip(part.blocks, cuts, cuts[1:]):
        if block.index > FURTHER:
            n = block.index % FURTHER
            out[n] = np.r_[out.get(n, np.zeros(0, int)), np.arange(start, end)]
    return out


def local_compliance(part: Superelement, name: str, direction: np.ndarray) -> float:
    """Compute the compliance of a port by the harmonics n >= 2 under a constant force in a
    direction (3,), m/N.
    """
    waves = np.concatenate([np.zeros(0, int), *own_waves(part).values()])
    moved = np.asarray(direction) @ part.ports[name].rows[:3, waves]
    return float((moved**2 / part.value[waves]).sum())
