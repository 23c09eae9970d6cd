"""A ring that slides along y: on a spring, or free in the seat.

The energy of contacts and spring is convex in the place of the ring, so the imbalance
only falls with it: a Newton step that leaves the interval is halved.  The stiffness of
the bearing is then the tangent with y condensed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

#: m; no ring is pushed or slides further
FURTHEST = 5e-3
#: m; rounding of the places of grooves, and below it that of a balance
_ROUNDING = 1e-18
#: share of two terms below which their difference is rounding
CANCELLED = 1e-14
_MOST = 200

Along = Callable[[np.ndarray], np.ndarray]


def slide_to_balance(
    load: Along,
    tangent: Along,
    motion: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    pull: Along | None = None,
    spring: float = 0.0,
) -> np.ndarray:
    """Return motions (..., 6) whose y, within bounds (...), m, is where contacts and the pull along
    y balance.

    `load` gives the load (..., 6) of the contacts at motions (..., 6) and `tangent` the derivative;
    `pull`, if any, the force (...) that holds the ring at y, N, which falls by `spring` for each
    metre that y grows, N/m.
    """
    moved = motion.copy()
    y = np.clip(np.zeros_like(low), low, high)
    for _ in range(_MOST):
        moved[..., 1] = y
        miss = load(moved)[..., 1] - (0.0 if pull is None else pull(y))
        slope = tangent(moved)[..., 1, 1] + spring
        low, high = np.where(miss < 0, y, low), np.where(miss > 0, y, high)
        if np.all(np.abs(miss) <= _ROUNDING * slope):
            break
        step = y - miss / np.where(slope > 0, slope, 1.0)
        inside = (slope > 0) & (step > low) & (step < high)
        following = np.where(miss == 0, y, np.where(inside, step, (low + high) / 2))
        if np.array_equal(following, y):
            break
        y = following
    return moved


def condense_y(stiffness: np.ndarray, spring: float = 0.0) -> np.ndarray:
    """Return the stiffness (..., 6, 6) on a ring that slides along y on a spring, N/m."""
    soft = (stiffness[..., 1, 1] + spring)[..., None, None]
    outer = stiffness[..., :, 1, None] * stiffness[..., None, 1, :]
    held = outer / np.where(soft > 0, soft, 1.0)
    left = stiffness - held
    # one ball that carries holds no tilt on a ring that slides: both cancel to rounding
    return np.where(np.abs(left) > CANCELLED * np.abs(held), left, 0.0)
