r"""Finite life and spectra: the consequent form of Miner's rule, and its elementary form.

A notch bears N_D = 1e6 cycles at its fatigue limit; above, N falls as the share of the limit to the
power -q, 5 by normal stress and 8 by torsion (DIN 743-4). In the consequent form levels below the
limit do no damage until the limit, lowered by damage D as (1 - D)^(1/(q - 1)), has come down to them
(Haibach, Betriebsfestigkeit, 3rd ed. 2006, chapter 3, after Gatts: the decay whose approximation is
the slope 2q - 1). With shares u_1 > u_2 > ... of the limit, all scaled by S, and n_i cycles,

    Z(S) = sum over m of  (U_m^(q-1) - U_(m+1)^(q-1)) / sum over i <= m of n_i (S u_i)^q / N_D

repetitions of the spectrum are borne, U the scaled shares, at most 1. The safety is the S at which
Z D_M is one. The sum of damage D_M that a spectrum bears is 0.3 for steel by the FKM guideline (6th
ed. 2012); one level alone bears 1. Knee and slopes of the norm could be held against no second
source.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from solidgear.strength.stress.din743 import Load

#: cycles at the knee, and fewest of finite life
KNEE, FEWEST = 1e6, 1e3
#: slope of life over stress
EXPONENTS: Mapping[Load, float] = {"tension": 5.0, "bending": 5.0, "torsion": 8.0}
#: sum of damage that a spectrum of several levels bears
DAMAGE_SUM = 0.3


def repetitions(shares: Sequence[float], cycles: Sequence[float], exponent: float) -> float:
    """Return how often a spectrum is borne by the consequent rule at a sum of damage of one, by
    shares of the fatigue limit and cycles of its levels.

    Examples
    --------
    One level at 1.5 of the limit bears 1e6 / 1.5^5 cycles; one below the limit bears all:

    >>> round(repetitions([1.5], [1e4], 5.0), 2), repetitions([0.9], [1e9], 5.0)
    (13.17, inf)
    """
    order = np.argsort(shares)[::-1]
    share, count = np.asarray(shares, float)[order], np.asarray(cycles, float)[order]
    if share[0] <= 1:
        return math.inf
    rate = np.cumsum(count * share**exponent) / KNEE
    limits = np.append(np.minimum(share, 1.0), 0.0) ** (exponent - 1)
    return float(((limits[:-1] - limits[1:]) / rate).sum())


def elementary_repetitions(
    shares: Sequence[float], cycles: Sequence[float], exponent: float
) -> float:
    """Return how often a spectrum is borne by the elementary rule, without a fatigue limit.

    Examples
    --------
    >>> round(elementary_repetitions([1.5, 0.9], [1e4, 1e5], 5.0), 2)
    7.41
    """
    return KNEE / sum(n * u**exponent for u, n in zip(shares, cycles))


def equivalent_share(
    shares: Sequence[float], cycles: Sequence[float], exponent: float, damage_sum: float
) -> float:
    """Return the share of the fatigue limit that does the damage of a spectrum: one over the factor
    by which its levels may be raised until it is borne once.

    Examples
    --------
    Of one level: half of it, where it may be (1e6 / 31250)^(1/5) = 2 times the limit

    >>> round(equivalent_share([1.2], [31250], 5.0, 1.0), 6)
    0.6
    """
    from scipy.optimize import brentq  # start-up: ratings without a life need none

    largest = max(shares)
    if largest <= 0:
        return 0.0

    def excess(scale: float) -> float:
        borne = repetitions([scale * share for share in shares], cycles, exponent)
        return math.log(max(damage_sum * borne, 1e-300))

    lowest = (1 + 1e-9) / largest
    if excess(lowest) <= 0:
        return largest
    raised = lowest
    while excess(raised) > 0:
        raised *= 2
    return float(1 / brentq(excess, raised / 2 if raised > lowest else lowest, raised))
