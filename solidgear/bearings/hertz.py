"""Elastic contact of rolling elements: points by Hertz, lines by the rule of ISO/TS 16281.

Point contact.  Two bodies of curvature sum S and curvature difference F touch over an ellipse of
axes ratio ``k = a / b``, the root of

    ((k^2 + 1) E(m) - 2 K(m)) / ((k^2 - 1) E(m)) = F,      m = 1 - 1/k^2,

with the complete elliptic integrals K, E.  A load Q then brings them together by delta with
``Q = c delta^(3/2)``, ``c = pi k E' sqrt(E(m) / (4.5 S K(m)^3))`` and ``E' = E / (1 - nu^2)`` for
two bodies of one material (Harris and Kotzalas, Essential Concepts of Bearing Technology, 5th ed.,
ch. 6; Hamrock and Brewe fit the same integrals).  Nothing is fitted here: the integrals are
evaluated.

Line contact.  The approach of a roller to both rings has no closed form that is independent of
the rings; ISO/TS 16281:2008, 5.3 takes ``q = 35948 l^(8/9) delta^(10/9)`` (N, mm) for steel, both
contacts together, after Palmgren.
"""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

import numpy as np

#: Pa and ratio; ISO/TS 16281 gives its constants for this steel
STEEL_E, STEEL_NU = 210e9, 0.3

#: powers of the approach in Q = c delta^p
POINT_POWER, LINE_POWER = 3 / 2, 10 / 9

#: N / mm^(8/9 + 10/9), ISO/TS 16281:2008, equation (37)
_ISO_LINE = 35948.0

#: steps after which the axes ratio of an ellipse is taken as it is; six are common
_MOST_STEPS = 50


class Point(NamedTuple):
    """A point contact."""

    constant: float  #: c of ``Q = c delta^(3/2)``, N/m^(3/2)
    #: long, short: semi-axes of the ellipse at 1 N, m; they grow with the cube root of the load
    long: float
    short: float

    def pressure(self, load: np.ndarray) -> np.ndarray:
        """Return the largest pressure under a load in N, Pa."""
        return 1.5 * np.cbrt(load) / (np.pi * self.long * self.short)

    def load(self, pressure: float) -> float:
        """Return the load under which the largest pressure is that in Pa, N."""
        return float((pressure * np.pi * self.long * self.short / 1.5) ** 3)


@functools.lru_cache(maxsize=4096)
def point_contact(rolling: float, across: float, E: float = STEEL_E, nu: float = STEEL_NU) -> Point:
    """Return Hertz's contact of two bodies of one material, from the sums of both bodies'
    curvatures in the two principal planes, 1/m, both positive.

    Examples
    --------
    A ball of 10 mm on a plane: Q = 4/3 E* sqrt(R) delta^1.5 with 1/E* = 2 (1 - nu^2) / E

    >>> ball = point_contact(200.0, 200.0)
    >>> star = 210e9 / (2 * 0.91)
    >>> round(ball.constant / (4 / 3 * star * 0.005**0.5), 12)
    1.0
    """
    total = rolling + across
    ratio = _axes_ratio(abs(rolling - across) / total)
    first, second = _integrals(ratio)
    modulus = E / (1 - nu**2)
    constant = np.pi * ratio * modulus * np.sqrt(second / (4.5 * total * first**3))
    short = np.cbrt(6 * second / (np.pi * ratio * total * modulus))
    return Point(float(constant), float(ratio * short), float(short))


def _axes_ratio(difference: float) -> float:
    # near a circle the quotient is 0/0: F = 3/4 (k - 1) there, to first order
    if difference < 1e-5:
        return 1 + 4 / 3 * difference
    # F is concave in the logarithm of k, so that steps of Newton from below never pass the root
    log_ratio = 2 / 3 * difference
    for _ in range(_MOST_STEPS):
        ratio = math.exp(log_ratio)
        first, second = _integrals(ratio)
        wide = ratio**2 - 1
        share = first / second
        estimate = (wide + 2 - 2 * share) / wide
        # dK/dlog k = (k^2 E - K) / (k^2 - 1) and dE/dlog k = (E - K) / (k^2 - 1)
        moved = (ratio**2 - 2 * share + share**2) / wide
        slope = 2 * (ratio**2 * (1 - estimate) - moved) / wide
        step = (difference - estimate) / slope
        log_ratio += step
        if step <= 1e-14 * log_ratio:  # or it is back by rounding
            break
    return math.exp(log_ratio)


def _integrals(ratio: float) -> tuple[float, float]:
    """Return K(m) and E(m) at ``m = 1 - 1/ratio^2``, by the arithmetic-geometric mean (Abramowitz
    and Stegun 17.6).
    """
    a, b, power = 1.0, 1 / ratio, 0.5
    series = power * (1 - b) * (1 + b)
    while a - b > 1e-15 * a:
        a, b, half = (a + b) / 2, math.sqrt(a * b), (a - b) / 2
        power *= 2
        series += power * half**2
    first = math.pi / (2 * a)
    return first, first * (1 - series)


def line_constant(length: float, E: float = STEEL_E, nu: float = STEEL_NU) -> float:
    """Return c of ``Q = c delta^(10/9)`` for a roller of an effective length (m) between the
    rings, both contacts together, N/m^(10/9); the rule is one for steel, and is scaled by ``E / (1
    - nu^2)``.

    Examples
    --------
    >>> round(line_constant(0.010) * 1e-3 ** (10 / 9))  # N/mm^(10/9), of a roller of 10 mm
    278332
    """
    relative = (E / (1 - nu**2)) / (STEEL_E / (1 - STEEL_NU**2))
    return _ISO_LINE * relative * (length * 1e3) ** (8 / 9) * 1e3**LINE_POWER


def line_pressure(
    load: np.ndarray, length: float, curvature: float, E: float = STEEL_E, nu: float = STEEL_NU
) -> np.ndarray:
    """Return the largest pressure of a line contact by Hertz, Pa: load in N, length in m, sum of
    both bodies' curvatures in 1/m, E in Pa.

    Examples
    --------
    >>> round(float(line_pressure(1000.0, 0.01, 250.0)) / 1e6)
    958
    """
    star = E / (2 * (1 - nu**2))
    return np.sqrt(load / length * star * curvature / np.pi)
