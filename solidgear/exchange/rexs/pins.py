r"""Pin and bearings of a planet as springs on its middle.

The pin is a Timoshenko beam clamped where the plates hold it, or on one side; the planet is rigid on
its bearings, which stand on the pin in series with it:

    K = G' (C_pin + C_bearings)^-1 G,  G_i = [1, y_i - y_middle].
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

import numpy as np

#: shear coefficient of a solid round section with Poisson's ratio nu (Cowper, 1966)
COWPER = (6.0, 7.0)


def clamped_compliance(
    places: Sequence[float],
    ends: Sequence[float],
    diameter: float,
    bore: float,
    E: float,
    nu: float,
) -> np.ndarray:
    """Return the (n, n) deflection across a pin at places (m) under forces there, m/N; `ends` are
    where plates clamp it.

    Examples
    --------
    A slender pin clamped at one end deflects by ``L^3 / 3 E I``.

    >>> C = clamped_compliance([0.2], [0.0], 0.002, 0.0, 2.1e11, 0.3)
    >>> round(float(C[0, 0] * 3 * 2.1e11 * pi * 0.002**4 / 64 / 0.2**3), 3)
    1.0
    """
    nodes = np.unique(np.round([*places, *ends], 9))
    area, inertia = pi / 4 * (diameter**2 - bore**2), pi / 64 * (diameter**4 - bore**4)
    factor = COWPER[0] * (1 + nu) / (COWPER[1] + COWPER[0] * nu)
    shear = factor * E / (2 * (1 + nu)) * area
    K = np.zeros((2 * len(nodes), 2 * len(nodes)))
    for k, length in enumerate(np.diff(nodes)):
        phi = 12 * E * inertia / (shear * length**2)
        c = E * inertia / ((1 + phi) * length**3)
        a, b, d = 6 * length, (4 + phi) * length**2, (2 - phi) * length**2
        element = c * np.array([[12, a, -12, a], [a, b, -a, d], [-12, -a, 12, -a], [a, d, -a, b]])
        K[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += element
    clamped = [int(np.argmin(np.abs(nodes - end))) for end in ends]
    free = [i for i in range(len(K)) if i // 2 not in clamped]
    compliance = np.zeros_like(K)
    compliance[np.ix_(free, free)] = np.linalg.inv(K[np.ix_(free, free)])
    rows = [2 * int(np.argmin(np.abs(nodes - place))) for place in places]
    return compliance[np.ix_(rows, rows)]


def on_middle(compliance: np.ndarray, arms: Sequence[float]) -> np.ndarray:
    """Return the (2, 2) stiffness against motion across the axis and tilting of a rigid planet on
    springs with a compliance (n, n), m/N, at arms (m) from its middle.

    Examples
    --------
    >>> K = on_middle(np.diag([1e-8, 1e-8]), [-0.01, 0.01])
    >>> round(float(K[0, 0])), round(float(K[1, 1]))
    (200000000, 20000)
    """
    motion = np.column_stack([np.ones(len(arms)), arms])
    return motion.T @ np.linalg.solve(compliance, motion)
