"""Equivalent loads of ISO 281:2007 (dynamic) and ISO 76:2006 (static): P = X F_r + Y F_a.

Where ``F_a / F_r`` is at most e a single row feels the radial load alone.  Two rows that hold the
shaft both ways share the axial load at once: ISO 281's numbers for them are those of one row times
1.63 (balls) or 1.67 (rollers) beyond e, and pass into ``F_r + Y_1 F_a`` without a jump at e.

How far balls climb their grooves grows with the axial load over their squares,
``F_a / (Z Dw^2) = f_0 cos(a) F_a / C_0``; for contact angles of 20 degrees and more that no longer
matters.  The clearance of C3 and C4 lets a deep groove bearing work at a
contact angle, so that it takes the numbers of 10 and of 15 degrees (makers' catalogues have them
under these classes).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.inside import Inside
from solidgear.bearings.rating import Ratings, static_factor

#: ISO 281:2007, Table 3, single row: axial load over balls in N/mm^2, and for contact angles in
#: degrees X with e and Y over it
_DEPTH = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)
_SHALLOW: dict[int, tuple[float, tuple[float, ...], tuple[float, ...]]] = {
    5: (
        0.56,
        (0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44),
        (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00),
    ),
    10: (
        0.46,
        (0.29, 0.32, 0.36, 0.38, 0.40, 0.44, 0.49, 0.54, 0.54),
        (1.88, 1.71, 1.52, 1.41, 1.34, 1.23, 1.10, 1.01, 1.00),
    ),
    15: (
        0.44,
        (0.38, 0.40, 0.43, 0.46, 0.47, 0.50, 0.55, 0.56, 0.56),
        (1.47, 1.40, 1.30, 1.23, 1.19, 1.12, 1.02, 1.00, 1.00),
    ),
}
#: the same for steeper angles: X, e, Y
_STEEP = {
    20: (0.43, 0.57, 1.00),
    25: (0.41, 0.68, 0.87),
    30: (0.39, 0.80, 0.76),
    35: (0.37, 0.95, 0.66),
    40: (0.35, 1.14, 0.57),
    45: (0.33, 1.34, 0.50),
}
#: degrees at which a deep groove bearing works, by its class of clearance
_CLEARANCE_ANGLE = {"C2": 5, "CN": 5, "CM": 5, "C3": 10, "C4": 15, "C5": 15}
#: two rows against each other, over one: of balls and of rollers
_BOTH = {True: 1.63, False: 1.67}
#: ISO 76:2006, Table 2: Y_0 of a single row over the contact angle in degrees
_STATIC_ANGLES = (5, 10, 15, 20, 25, 30, 35, 40, 45)
_STATIC = (0.52, 0.50, 0.46, 0.42, 0.38, 0.33, 0.29, 0.26, 0.22)


class Factors(NamedTuple):
    """Factors of an equivalent load."""

    e: float  #: of F_a / F_r, up to which `low` holds
    #: low, high: X and Y up to e, and beyond
    low: tuple[float, float]
    high: tuple[float, float]


class Equivalent(NamedTuple):
    """Equivalent dynamic load of a bearing."""

    load: float  #: P, N
    #: radial, axial: components of the reaction, N
    radial: float
    axial: float
    #: X, Y, e: factors that were taken, and the limit of F_a / F_r between both pairs of them
    X: float
    Y: float
    e: float


def equivalent_load(
    data: Catalogue, inside: Inside, rated: Ratings, load: np.ndarray
) -> Equivalent:
    """Return the equivalent dynamic load by ISO 281, from ratings of all rows and the load (6,) of
    the shaft on the bearing, N; moments have no part in it.
    """
    radial, axial = math.hypot(load[0], load[2]), abs(float(load[1]))
    e, low, high = factors(data, inside, _depth(data, inside, axial / rated.static))
    x, y = low if axial <= e * radial else high
    return Equivalent(x * radial + y * axial, radial, axial, x, y, e)


def _depth(data: Catalogue, inside: Inside, share: float) -> float:
    """Return the axial load over the squares of the balls that carry it, N/mm^2, from the share of
    C_0.
    """
    if not data.balls or inside.thrust or inside.sphere:
        return 0.0
    # of two rows against each other one carries all of it
    rows = 2 if data.opposed else 1
    return rows * share * static_factor(inside) * math.cos(inside.angle)


def factors(data: Catalogue, inside: Inside, depth: float) -> Factors:
    """Return X, Y and e of a bearing at an axial load over the squares of the balls that carry it,
    N/mm^2; for rollers without a contact angle those of the radial load alone, for thrust balls
    those of the axial one.
    """
    if inside.thrust:
        return Factors(0.0, (0.0, 1.0), (0.0, 1.0))
    if not (data.balls or data.angled):
        return Factors(math.inf, (1.0, 0.0), (1.0, 0.0))
    if inside.sphere:
        x, e, y = _sphere_factors(inside)
    else:
        x, e, y = _ball_factors(data, inside, depth) if data.balls else _cone_factors(inside)
    if not data.opposed:
        return Factors(e, (1.0, 0.0), (x, y))
    x, y = _BOTH[data.balls] * x, _BOTH[data.balls] * y
    return Factors(e, (1.0, y - (1 - x) / e), (x, y))


def _cone_factors(inside: Inside) -> tuple[float, float, float]:
    """Return X, e and Y of tapered rollers."""
    slope = math.tan(inside.angle)
    return 0.4, 1.5 * slope, 0.4 / slope


def _sphere_factors(inside: Inside) -> tuple[float, float, float]:
    """Return X, e and Y of one of two rows of balls on a sphere, of which both have 0.65 and
    ``0.65 cot(a)``.
    """
    slope = math.tan(inside.angle)
    return 0.65 / _BOTH[True], 1.5 * slope, 0.65 / _BOTH[True] / slope


def _ball_factors(data: Catalogue, inside: Inside, depth: float) -> tuple[float, float, float]:
    """Return X, e and Y of a row of balls, between the angles of the table by proportion."""
    angle = math.degrees(inside.angle)
    if not data.angled:
        # of a clearance that is a length, those of the normal class
        angle = _CLEARANCE_ANGLE.get(str(data.clearance), 5)
    tables = [(degrees, _at_depth(degrees, depth)) for degrees in _SHALLOW]
    tables += _STEEP.items()
    degrees = [place for place, _ in tables]
    x, e, y = (float(np.interp(angle, degrees, column)) for column in zip(*(v for _, v in tables)))
    return x, e, y


def _at_depth(degrees: int, depth: float) -> tuple[float, float, float]:
    x, e, y = _SHALLOW[degrees]
    return x, float(np.interp(depth, _DEPTH, e)), float(np.interp(depth, _DEPTH, y))


def static_load(data: Catalogue, inside: Inside, load: np.ndarray) -> float:
    """Return the equivalent static load of a bearing by ISO 76, N, under the load (6,) of the shaft
    on it, N; for rows against each other, that on both.

    Examples
    --------
    >>> from solidgear.bearings.geometry import inner_geometry
    >>> data = Catalogue(designation="6208")
    >>> static_load(data, inner_geometry(data).middle, [1000, 1200, 0, 0, 0, 0])
    1200.0
    """
    radial, axial = math.hypot(load[0], load[2]), abs(float(load[1]))
    x, y = static_factors(data, inside)
    if data.opposed:
        x, y = 2 * x, 2 * y
    return max(radial, x * radial + y * axial)


def static_factors(data: Catalogue, inside: Inside) -> tuple[float, float]:
    """Return X_0 and Y_0 of ISO 76 of a single row."""
    if inside.thrust:
        return 0.0, 1.0
    if not data.angled:
        return (0.6, 0.5) if data.balls else (1.0, 0.0)
    if data.balls and not inside.sphere:
        return 0.5, float(np.interp(math.degrees(inside.angle), _STATIC_ANGLES, _STATIC))
    return 0.5, 0.22 / math.tan(inside.angle)
