"""A ring that slides along y: on a spring, or in its seat with nothing to hold it.

The energy of contacts and spring is convex in the place of the ring, so what is missing from its
balance only falls with it: a Newton step that leaves the interval is halved.  What the bearing
resists then is its tangent with y condensed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

#: m; no ring is pushed or slides further
FURTHEST = 5e-3
#: m; rounding of the places of grooves, and below it that of a balance
_ROUNDING = 1e-18
_MOST = 200

Along = Callable[[np.ndarray], np.ndarray]


def balanced(
    load: Along,
    tangent: Along,
    motion: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    pull: Along | None = None,
    spring: float = 0.0,
) -> np.ndarray:
    """Motions (..., 6) whose y is where contacts and what pulls along y balance.

    Parameters
    ----------
    load, tangent : callable
        Load (..., 6) of the contacts at motions (..., 6), and its derivative.
    motion : (..., 6) ndarray
        All but y is kept.
    low, high : (...) ndarray
        Bounds of y, m.
    pull : callable, optional
        Force (...) that holds the ring at y, N; none where nothing does.
    spring : float
        How much of it goes with each metre that y grows less, N/m.
    """
    seen = motion.copy()
    y = np.clip(np.zeros_like(low), low, high)
    for _ in range(_MOST):
        seen[..., 1] = y
        miss = load(seen)[..., 1] - (0.0 if pull is None else pull(y))
        slope = tangent(seen)[..., 1, 1] + spring
        low, high = np.where(miss < 0, y, low), np.where(miss > 0, y, high)
        if np.all(np.abs(miss) <= _ROUNDING * slope):
            break
        step = y - miss / np.where(slope > 0, slope, 1.0)
        inside = (slope > 0) & (step > low) & (step < high)
        following = np.where(miss == 0, y, np.where(inside, step, (low + high) / 2))
        if np.array_equal(following, y):
            break
        y = following
    return seen


def condensed(stiffness: np.ndarray, spring: float = 0.0) -> np.ndarray:
    """Stiffness (..., 6, 6) of what stands on a ring that slides along y on a spring, N/m."""
    soft = (stiffness[..., 1, 1] + spring)[..., None, None]
    outer = stiffness[..., :, 1, None] * stiffness[..., None, 1, :]
    return stiffness - outer / np.where(soft > 0, soft, 1.0)
