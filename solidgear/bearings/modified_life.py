"""Modified life of ISO 281:2007: reliability, lubricating film, dirt and the fatigue limit.

    L_nm = a_1 a_ISO L_10

The film is judged by ``kappa = nu / nu_1``, the viscosity at work over that which the size and the
speed ask for,

    nu_1 = 45000 n^-0.83 Dpw^-0.5 below 1000 r/min,     4500 n^-0.5 Dpw^-0.5 above   (mm^2/s, mm)

and with e_C for dirt and the fatigue load limit C_u, for 0.1 <= kappa <= 4,

    balls     a_ISO = 0.1 (1 - (2.5671 - A / kappa^B)^0.83 (e_C C_u / P)^(1/3))^-9.3
    rollers   a_ISO = 0.1 (1 - (1.5859 - A / kappa^B) (e_C C_u / P)^0.4)^-9.185

and at most 50 (ISO 281:2007, 9.3.3; A and B make the formulas join at kappa = 0.4, which a misprinted
0.019087 for balls does not).  Reliability is a Weibull distribution with a
life of 5 % that all reach, ``a_1 = 0.05 + 0.95 (ln S / ln 0.9)^(2/3)``: Table 12 of ISO 281 to its
digits (ISO/TR 1281-2:2008).

ISO/TS 16281 takes a_ISO for every slice by itself, at the load P of a row whose slices are all
loaded like this one.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

#: largest a_ISO, and the range of kappa in which it is known
MOST_LIFE, LEAST_FILM, FULL_FILM = 50.0, 0.1, 4.0
#: for kappa from: A, B; of balls and of rollers
_FILM = {
    True: ((1.0, 1.9987, 0.071739), (0.4, 1.9987, 0.19087), (0.1, 2.2649, 0.054381)),
    False: ((1.0, 1.2348, 0.071739), (0.4, 1.2348, 0.19087), (0.1, 1.3993, 0.054381)),
}


class Law(NamedTuple):
    """Constants of a_ISO for a kind of element: see the head of this module."""

    start: float
    film: float
    load: float
    power: float


_LAW = {True: Law(2.5671, 0.83, 1 / 3, 9.3), False: Law(1.5859, 1.0, 0.4, 9.185)}


def reliability_factor(reliability: float) -> float:
    """a_1 of ISO 281, Table 12."""
    return 0.05 + 0.95 * (math.log(reliability) / math.log(0.9)) ** (2 / 3)


def reference_viscosity(speed: float, pitch: float) -> float:
    """Viscosity nu_1, m^2/s, that a bearing asks for at a speed, rad/s, and a diameter of the
    circle of the elements' centres, m.
    """
    turns, size = speed * 30 / math.pi, pitch * 1e3
    factor = 45000 * turns**-0.83 if turns < 1000 else 4500 * turns**-0.5
    return factor * size**-0.5 * 1e-6


def life_factor(kappa: float, ratio: np.ndarray, balls: bool) -> np.ndarray:
    """a_ISO of ISO 281 for radial bearings.

    Parameters
    ----------
    kappa : float
        Viscosity ratio, from 0.1, below which ISO 281 says nothing; above 4 it counts as 4.
    ratio : ndarray
        ``e_C C_u / P``.

    Returns
    -------
    ndarray
        At most 50.

    Examples
    --------
    >>> life_factor(1.0, np.array([0.1, 2.0]), balls=True).round(2)
    array([ 2.43, 50.  ])
    """
    kappa = min(kappa, FULL_FILM)
    law = _LAW[balls]
    _, a, b = next(entry for entry in _FILM[balls] if kappa >= entry[0])
    inner = 1 - (law.start - a / kappa**b) ** law.film * ratio**law.load
    # of a film this thick nothing below the fatigue limit fails
    least = (MOST_LIFE / 0.1) ** (-1 / law.power)
    return 0.1 * np.maximum(inner, least) ** -law.power
