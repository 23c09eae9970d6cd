"""Derivatives of natural frequencies by what a scene is made of, from its modes alone.

By an entry p of the scene that leaves the mesh as it is, an eigenvalue changes by
``d(w^2)/dp = u' (dK/dp - w^2 dM/dp) u`` with the mode normalised to the mass (Fox and Kapoor 1968,
AIAA J. 6, 2426, eq. 12; of a pair the mean of both). Matrices and springs are made on either side of
p and held against the same mode: two assemblies and no solution.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from solidgear.body import Body, as_supports
from solidgear.body.supports import Supports
from solidgear.errors import SolidgearError
from solidgear.scene import Scene
from solidgear.solve.modes import Mode

#: of the logarithm of an entry, on either side
STEP = 1e-4


def log_derivatives(found: Sequence[Mode], at: Callable[[float], tuple[Scene, Body]]) -> np.ndarray:
    """Derivatives of the logarithms of natural frequencies by that of an entry.

    Parameters
    ----------
    found : sequence of Mode
        Elastic ones.
    at : callable
        Scene and body with the entry multiplied by ``exp(x)``.

    Returns
    -------
    (len(found),) ndarray

    Raises
    ------
    SolidgearError
        If the mesh changes with the entry.
    """
    (low, below), (high, above) = at(-STEP), at(STEP)
    if [block.size for block in below.blocks] != [block.size for block in above.blocks]:
        raise SolidgearError("the mesh changes with this entry, and derivatives need the same mesh")
    ends = [(below, as_supports(low)), (above, as_supports(high))]
    out = np.zeros(len(found))
    for k, mode in enumerate(found):
        square = (2 * np.pi * mode.frequency_hz) ** 2
        for shape in mode.vectors:
            (k0, m0), (k1, m1) = (_energies(body, supports, shape) for body, supports in ends)
            slope = ((k1 - k0) - square * (m1 - m0)) / (2 * STEP) / ((m0 + m1) / 2)
            out[k] += slope / (2 * square) / len(mode.vectors)
    return out


def _energies(body: Body, supports: Supports, shape: dict[int, np.ndarray]) -> tuple[float, float]:
    """``u' K u`` and ``u' M u`` of a shape, with the springs and masses on its ports."""
    stiff = heavy = 0.0
    motion = np.zeros(6 * len(body.ports))
    for index, u in shape.items():
        block = body.block(index)
        stiff += float(u @ (block.stiffness @ u))
        heavy += float(u @ (block.mass @ u))
        if block.components:
            motion[body.rows(block)] += block.ports @ u
    if supports.ports:
        at = motion[supports.rows(body)]
        stiff += float(at @ supports.stiffness @ at)
        heavy += float(at @ supports.masses @ at)
    return stiff, heavy
