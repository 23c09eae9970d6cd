"""Branches of motions that repeat themselves after two periods, from where a period doubles."""

from __future__ import annotations

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.machine.threads import pinned
from solidgear.nonlinear.balance import Balance, as_complex, as_real
from solidgear.nonlinear.continuation import Branch, Follower, Point, walked
from solidgear.nonlinear.stability import multipliers

#: half orders over the scale of motions at which two periods are one again, and the first step away
MERGED, AWAY = 1e-3, 0.01


def flip(point: Point) -> float:
    """One plus the most negative real multiplier: below zero where the period doubles."""
    found = multipliers(point)
    real = found.real[np.abs(found.imag) < 1e-9 * np.abs(found[0]) + 1e-12]
    return 1.0 + float(real.min(initial=0.0))


@pinned
def doubled(branch: Branch, step: float = 0.02) -> list[Branch]:
    """Motions of two periods, from every place of a branch at which its period doubles.

    Parameters
    ----------
    step : float
        Longest step, as that of :func:`solidgear.nonlinear.continuation.follow`.

    Returns
    -------
    list of Branch
        Each until its motions have one period again or leave the range; frequencies are those of
        two periods, half of the excitation.  One that ends where another began is told once.
    """
    out: list[Branch] = []
    met: list[float] = []
    for begin in branch.crossings(flip):
        if any(abs(begin.omega / end - 1) < MERGED for end in met):
            continue
        found = _from(begin, branch, step)
        out.append(found)
        met.append(2 * found.points[-1].omega)
    return out


def _from(begin: Point, branch: Branch, step: float) -> Branch:
    size, width = branch.scale
    m = begin.balance.remainder.rows
    own = begin.balance.remainder.slower(2)
    harmonics = np.zeros((2 * begin.balance.count + 1, m), complex)
    harmonics[::2] = begin.harmonics
    balance = Balance(own, 2 * begin.balance.count)
    motion = as_real(harmonics).ravel()
    left = balance.residual(motion, begin.omega / 2)
    along = np.append(np.linalg.svd(left.jacobian)[2][-1], 0.0)
    walk = Follower(balance, size, width / 2)
    first = Point(begin.omega / 2, motion, balance, along, 0.0)
    low, high = branch.omega.min() / 2, branch.omega.max() / 2

    def ended(point: Point) -> bool:
        halves = np.abs(as_complex(point.motion.reshape(-1, m))[1::2]).max()
        return bool(halves < MERGED * size or not low <= point.omega <= high)

    near = walk.correct(first, AWAY)
    if near is None:
        raise SolidgearError(
            f"the motion of two periods at {begin.omega:g} rad/s cannot be followed"
        )
    points, turning = walked(walk, near[0], step, False, ended)
    return Branch((first, *points), tuple(k + 1 for k in turning), (size, width / 2))
