"""Random bearing stiffness: soft to stiff, with and without tilt, couplings that keep it
positive.
"""

from __future__ import annotations

import math

import numpy as np

SOFT, STIFF = 1e6, 1e10  # N/m


def random_springs(
    rng: np.random.Generator, diameter: float, unequal: bool, coupled: str
) -> np.ndarray:
    """A symmetric positive semidefinite (6, 6) in SI, order x y z thx thy thz, free in thy.

    The diameter of the seat sets the size of the tilt stiffness; `unequal` makes x and z differ.
    Coupled are none, force with moment in each plane as a row of inclined rollers has (paired), or
    every motion with every other (strong).
    """
    radial = math.exp(rng.uniform(math.log(SOFT), math.log(STIFF)))
    factors = rng.uniform(0.3, 3.0, 2) if unequal else np.ones(2)
    tilted = rng.random() < 0.7 or coupled != "none"
    tilt = (
        radial * diameter**2 * math.exp(rng.uniform(math.log(1e-3), math.log(0.3)))
        if tilted
        else 0.0
    )
    # a floating bearing does not hold along the shaft
    axial = radial * rng.uniform(0.1, 2.0) if rng.random() < 0.8 else 0.0
    size = np.sqrt(
        [radial * factors[0], axial, radial * factors[1], tilt * factors[1], 0.0, tilt * factors[0]]
    )
    return np.outer(size, size) * _correlation(rng, coupled, unequal)


def _correlation(rng, coupled: str, unequal: bool) -> np.ndarray:
    """Unit diagonal, positive definite, exactly symmetric."""
    one = np.eye(6)
    if coupled == "paired":
        # a turn about the shaft takes (z, thx) into (x, -thz): equal planes have opposite signs
        share = rng.uniform(0.2, 0.9) * rng.choice([-1.0, 1.0])
        one[2, 3] = one[3, 2] = share
        one[0, 5] = one[5, 0] = -share * (rng.uniform(0.5, 1.0) if unequal else 1.0)
    elif coupled == "strong":
        rows = rng.normal(size=(6, 9))
        gram = rows @ rows.T
        scale = 1 / np.sqrt(np.diag(gram))
        one = 0.05 * one + 0.95 * (scale[:, None] * gram * scale)
        one = (one + one.T) / 2
    return one
