r"""Motion of a half-plane under a force on its surface, the singular part of what a tooth does.

Per force and face width a point at the distance x along the surface and at the depth h moves along the
force by

    F = 2 (1 - nu^2) / (pi E) [ h^2 / (2 (1 - nu) (x^2 + h^2)) - ln(x^2 + h^2) / 2 ]

but for a constant (Flamant; Johnson, Contact Mechanics, 1985, 2.3): a half-plane has no end, and no
motion of its own.  Less the motion at a depth *reach*, of which only the logarithm counts, it is a
motion *near* the force, below no distance negative and small far away.
"""

from __future__ import annotations

from math import pi

import numpy as np

from solidgear.teeth.contact.local import Elasticity


def half_plane(distance: np.ndarray, depth, unit: float, elasticity: Elasticity) -> np.ndarray:
    """Return the motion at distances along the surface and depths, m, per force and face width, with
    logarithms of lengths in a unit, m.
    """
    squares = (distance**2 + depth**2) / unit**2
    side = (depth / unit) ** 2 / (2 * (1 - elasticity.poisson) * squares)
    return 2 / (pi * elasticity.plane) * (side - np.log(squares) / 2)


def near_force(distance: np.ndarray, depth: float, reach: float, elasticity: Elasticity):
    """Return the part of that motion which is near the force: within a reach, m."""
    cut = np.log((distance / reach) ** 2 + 1) / (pi * elasticity.plane)
    return half_plane(distance, depth, reach, elasticity) + cut
