"""Direction of weight, and its acceleration."""

from __future__ import annotations

from typing import Literal

import numpy as np

from solidgear.core.frames import DOF_NAMES

Direction = Literal["x", "-x", "y", "-y", "z", "-z"]
#: m/s^2, standard gravity (ISO 80000-3)
GRAVITY = 9.80665


def acceleration(towards: str | None) -> np.ndarray:
    """Return the acceleration (3,) of weight in a direction, m/s^2; zeros without one.

    Examples
    --------
    >>> acceleration("-z")
    array([ 0.     ,  0.     , -9.80665])
    """
    out = np.zeros(3)
    if towards is not None:
        out[DOF_NAMES.index(towards[-1])] = -GRAVITY if towards.startswith("-") else GRAVITY
    return out
