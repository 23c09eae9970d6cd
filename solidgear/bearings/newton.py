"""Newton with a line search, for the equilibrium of contacts, which press and never pull.

The energy of contacts and elastic parts is convex (:mod:`solidgear.bearings.row`), so the slope of
the whole energy along any direction only grows: a step is too long when the slope at the end has
turned positive, and the search needs no energy, only loads.  Where nothing presses yet the tangent
is singular; motions without stiffness take a step of bounded length along the load that is not
balanced, until a contact meets it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from solidgear.core import SolidgearError

#: iterations; a dozen is common, contacts that come and go take some more
MOST = 200
#: m; a first step, and the way after which what meets no stiffness is taken not to be held
FIRST_STEP, LOST = 2e-4, 0.05
#: of the largest stiffness, which may be that of a held seat: softer directions have none
SOFT = 1e-13
#: largest imbalance, relative to the load
UNBALANCED = 1e-12


class Settled(NamedTuple):
    """An equilibrium."""

    motion: np.ndarray  #: (n,)
    #: largest imbalance, relative to the largest load or to the forces at work without any, in scaled
    #: units
    unbalanced: float
    iterations: int


class NothingHolds(SolidgearError):
    """Load that nothing balances, however far the point moves, with the `direction` (n,) of the
    motion.
    """

    def __init__(self, reason: str, direction: np.ndarray):
        super().__init__(reason)
        self.direction = direction


def settle(
    load: Callable[[np.ndarray], np.ndarray],
    tangent: Callable[[np.ndarray], np.ndarray],
    target: np.ndarray,
    size: np.ndarray,
    start: np.ndarray | None = None,
    at_work: float = 0.0,
) -> Settled:
    """Return the motion at which a convex system carries a load, N and N m.

    `load` gives the load (n,) and `tangent` the derivative (n, n) at a motion (n,); `size` (n,) is
    the motion of each unknown that counts as one metre: 1 for translations, one over a length for
    rotations. Forces `at_work`, N, balance each other at `start`, such as those of a preload: an
    imbalance is judged on them where they are larger than the load, since rounding is theirs. A
    load that is not balanced after a motion of `LOST` metres, and meets no stiffness there, is refused.

    Examples
    --------
    >>> import numpy as np
    >>> hertz = lambda x: 8e9 * np.maximum(x - 1e-5, 0) ** 1.5
    >>> slope = lambda x: np.diag(1.2e10 * np.maximum(x - 1e-5, 0) ** 0.5)
    >>> found = settle(hertz, slope, np.array([1.0]), np.ones(1))
    >>> round(float(found.motion[0]) * 1e6, 6)
    10.25
    """
    state = np.zeros(len(target)) if start is None else np.array(start, float)
    goal, reach = size * target, FIRST_STEP
    missing = goal - size * load(state)
    scale = max(at_work, *(float(np.abs(forces).max(initial=0.0)) for forces in (goal, missing)))
    if scale == 0.0:
        return Settled(state, 0.0, 0)
    best, best_at, stalled = np.inf, state, 0
    iterations = 0
    while iterations < MOST:
        iterations += 1
        imbalance = float(np.abs(missing).max())
        if imbalance < best:
            best, best_at, stalled = imbalance, state, stalled if imbalance > 0.5 * best else 0
        stalled += 1
        if imbalance <= UNBALANCED * scale or stalled > 25:
            break
        step = size * _step(size[:, None] * tangent(state) * size, missing, scale, reach)
        way, missing, still_falling = _searched(load, goal, size, state, step, missing)
        if way == 0.0:
            break
        state = state + way * step
        reach = 4 * reach if still_falling else reach
        # a slender shaft may bend as far, and is held
        far = np.abs(state / size).max() > LOST
        if far and _is_loose(size[:, None] * tangent(state) * size, missing, scale):
            raise NothingHolds("nothing holds this load", step / size)
    # a tangent that is steep where contact begins turns rounding of motions into load
    return Settled(best_at, best / scale, iterations)


def _principal(
    stiffness: np.ndarray, missing: np.ndarray, scale: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Return principal stiffnesses with their directions, the load that is missing along each, and
    the least stiffness that counts as one.
    """
    value, vector = np.linalg.eigh((stiffness + stiffness.T) / 2)
    part = vector.T @ missing
    part[np.abs(part) < 1e-3 * UNBALANCED * scale] = 0.0
    return value, vector, part, max(SOFT * float(value.max(initial=0.0)), 1e-3 * scale)


def _is_loose(stiffness: np.ndarray, missing: np.ndarray, scale: float) -> bool:
    """Return True where a load that is missing meets no stiffness."""
    value, _, part, floor = _principal(stiffness, missing, scale)
    return bool(np.any(np.abs(part[value <= floor]) > UNBALANCED * scale))


def _step(stiffness: np.ndarray, missing: np.ndarray, scale: float, reach: float) -> np.ndarray:
    value, vector, part, floor = _principal(stiffness, missing, scale)
    step = vector @ (part / np.maximum(value, floor))
    length = float(np.abs(step).max())
    return step * min(1.0, reach / length) if length > 0 else step


def _searched(load, goal, size, state, step, missing):
    """Return the length of the step, the imbalance after it, and whether the energy still falls
    steeply.
    """
    direction = step / size
    first = float(missing @ direction)
    low, high, way = 0.0, np.inf, 1.0
    best = (0.0, missing, False)
    if not first > 0:
        return best
    for _ in range(60):
        imbalance = goal - size * load(state + way * step)
        slope = float(imbalance @ direction)
        if abs(slope) <= 0.5 * first:
            return way, imbalance, False
        if slope > 0:  # the energy still falls beyond
            return way, imbalance, True
        high = way
        way = (low + high) / 2
    return best
