r"""Form factors and stress gradients of DIN 743-2 for grooves, undercuts and cross holes.

Inputs and results are SI. Coefficients of grooves and cross holes agree between the two public
programs of :mod:`solidgear.strength.stress.norm.tested`; that of an undercut beside a shoulder
(5.2.2) is known to neither.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from solidgear.strength.stress import din743
from solidgear.strength.stress.din743 import SHALLOW, Load

#: A and B of round grooves (DIN 743-2, table 2)
ROUND: Mapping[Load, tuple[float, float]] = {
    "tension": (0.22, 1.37),
    "bending": (0.20, 2.75),
    "torsion": (0.70, 10.3),
}
#: r/t, d/D and form factor that the norm gives its formulas for
LEAST_RADIUS, LARGEST_RATIO, LARGEST_FORM = 0.03, 0.98, 6.0


def round_groove(load: Load, small: float, depth: float, radius: float) -> float:
    """Return the form factor of a round groove of floor diameter d, depth t and radius, m (DIN
    743-2, table 2).

    Examples
    --------
    >>> [round(round_groove(load, 0.04, 0.002, 0.002), 2) for load in din743.LOADS]
    [2.61, 2.37, 1.72]
    """
    a, b = ROUND[load]
    slender = radius / small
    return 1 + 1 / math.sqrt(a * radius / depth + 2 * b * slender * (1 + 2 * slender) ** 2)


def round_gradient(load: Load, small: float, depth: float, radius: float) -> float:
    """Return the relative stress gradient of a round groove, 1/m (DIN 743-2, table 3).

    Examples
    --------
    >>> [round(round_gradient(load, 0.04, 0.002, 0.002)) for load in din743.LOADS]
    [1167, 1167, 500]
    """
    if load == "torsion":
        return 1 / radius
    shallow = small / (small + 2 * depth) > SHALLOW
    phi = 1 / (4 * math.sqrt(depth / radius) + 2) if shallow else 0.0
    return 2 * (1 + phi) / radius


def undercut(load: Load, large: float, between: float, small: float, radius: float) -> float:
    """Return the form factor of an undercut beside a shoulder, from the diameter D of the shoulder
    over D_1 of the cylinder to d of the undercut, m (DIN 743-2, 5.2.2): that of a shoulder without
    depth, and of a groove without a shoulder.

    Examples
    --------
    >>> 1.9 < undercut("bending", 0.06, 0.04, 0.0394, 0.001) < 3
    True
    >>> round(undercut("bending", 0.04, 0.04, 0.038, 0.001), 4)
    2.6658
    """
    groove = round_groove(load, small, (between - small) / 2, radius)
    shoulder = din743.form_factor(load, large, small, radius)
    return (groove - shoulder) * math.sqrt((between - small) / (large - small)) + shoulder


def cross_hole(load: Load, hole: float, diameter: float) -> float:
    """Return the form factor of a cross hole in a shaft, on nominal stress of the section without
    the hole's strip (DIN 743-2, 5.2.3).

    Examples
    --------
    >>> [round(cross_hole(load, 0.004, 0.05), 3) for load in din743.LOADS]
    [2.92, 2.32, 1.705]
    """
    share = hole / diameter
    if load == "tension":
        return 3 - share
    if load == "bending":
        return 3 + 1.4 * share - 2.8 * math.sqrt(share)
    return 2.023 - 1.125 * math.sqrt(share)


def hole_gradient(load: Load, hole: float, diameter: float) -> float:
    """Return the relative stress gradient at a cross hole, 1/m (DIN 743-2, table 3).

    Examples
    --------
    >>> [round(hole_gradient(load, 0.004, 0.05)) for load in din743.LOADS]
    [1150, 1190, 615]
    """
    if load == "torsion":
        return 1.15 / (hole / 2) + 2 / diameter
    return 2.3 / (hole / 2) + (2 / diameter if load == "bending" else 0.0)


def out_of_range(small: float, large: float, radius: float, factors: Mapping[Load, float]) -> str:
    """Return why the norm's form factors of grooves and shoulders do not hold; empty where they do.

    Examples
    --------
    >>> out_of_range(0.04, 0.05, 1e-5, {"bending": 5.0})
    'r/t = 0.002 is below 0.03'
    """
    depth = (large - small) / 2
    if radius < LEAST_RADIUS * depth:
        return f"r/t = {radius / depth:.2g} is below {LEAST_RADIUS:g}"
    if small > LARGEST_RATIO * large:
        return f"d/D = {small / large:.4g} is above {LARGEST_RATIO:g}"
    largest = max(factors.values())
    if largest > LARGEST_FORM:
        return f"a form factor of {largest:.3g} is above {LARGEST_FORM:g}"
    return ""
