r"""Formulas of DIN 743:2012 for shoulders of shafts and for all notches, each a function.

Inputs and results are SI; the norm writes lengths in mm and stress in MPa. Coefficients were
checked against two public programs that share no text with each other, and four solved
examinations; no worked example of the norm itself was at hand. Other notches, groups of steel and
finite life are in :mod:`solidgear.strength.stress.norm`.
"""

from __future__ import annotations

import math
from typing import Literal

Load = Literal["tension", "bending", "torsion"]
LOADS: tuple[Load, ...] = ("tension", "bending", "torsion")
#: A, B, C and z of form factors of shoulders (DIN 743-2, table 2)
SHOULDER: dict[Load, tuple[float, float, float, float]] = {
    "tension": (0.62, 3.5, 0.0, 0.0),
    "bending": (0.62, 5.8, 0.2, 3.0),
    "torsion": (3.4, 19.0, 1.0, 2.0),
}
#: fatigue limit under full reversal over tensile strength, of a polished bar (DIN 743-3)
ALTERNATING: dict[Load, float] = {"tension": 0.4, "bending": 0.5, "torsion": 0.3}
#: d / D above which neighbouring steps of a shoulder sharpen the gradient
SHALLOW = 0.67
#: static support of yielding by load, of solid and hollow shafts (DIN 743-1, table 3)
STATIC_SUPPORT: dict[Load, tuple[float, float]] = {
    "tension": (1.0, 1.0),
    "bending": (1.2, 1.1),
    "torsion": (1.2, 1.0),
}


def form_factor(load: Load, large: float, small: float, radius: float) -> float:
    """Return the form factor of a shoulder of diameters D and d, m, and a fillet radius, m (DIN
    743-2, 5.2 and table 2).

    Examples
    --------
    >>> [round(form_factor(load, 0.06, 0.04, 0.004), 2) for load in LOADS]
    [1.89, 1.72, 1.38]
    """
    a, b, c, z = SHOULDER[load]
    t = (large - small) / 2
    slender = radius / small
    return 1 + 1 / math.sqrt(
        a * radius / t
        + 2 * b * slender * (1 + 2 * slender) ** 2
        + c * (radius / t) ** z * small / large
    )


def gradient(load: Load, large: float, small: float, radius: float) -> float:
    """Return the relative stress gradient of a shoulder, 1/m (DIN 743-2, table 3).

    Examples
    --------
    >>> round(gradient("torsion", 0.06, 0.04, 0.004) * 0.004, 3)
    1.15
    """
    if load == "torsion":
        return 1.15 / radius
    depth = (large - small) / 2
    phi = 1 / (4 * math.sqrt(depth / radius) + 2) if small / large > SHALLOW else 0.0
    return 2.3 * (1 + phi) / radius


def support(slope: float, yield_point: float, hard: bool = False) -> float:
    """Return the support number n by the relative stress gradient, 1/m, and the yield point at
    the size of the part, Pa (DIN 743-2, 4.3), or for a hard surface layer.

    Examples
    --------
    >>> round(support(2000.0, 356e6), 3)  # 1 + sqrt(2) 10^-(0.33 + 0.5)
    1.209
    >>> round(support(2000.0, 356e6, hard=True), 3)  # 1 + sqrt(2) 10^-0.7
    1.282
    """
    return 1 + math.sqrt(slope * 1e-3) * 10 ** -(0.7 if hard else 0.33 + yield_point / 712e6)


def size_factor(load: Load, diameter: float) -> float:
    """Return the geometric factor of size K_2 (DIN 743-2, equations 15 and 16).

    Examples
    --------
    >>> [round(size_factor("bending", d), 3) for d in (0.0075, 0.04, 0.15, 0.3)]
    [1.0, 0.888, 0.8, 0.8]
    """
    if load == "tension":
        return 1.0
    clipped = min(max(1e3 * diameter, 7.5), 150.0)
    return 1 - 0.2 * math.log10(clipped / 7.5) / math.log10(20)


def surface_factor(load: Load, roughness: float, ultimate: float) -> float:
    """Return the factor of surface roughness K_F by Rz, m, and the tensile strength at the size
    of the part, Pa (DIN 743-2, equations 18 and 19).

    Examples
    --------
    >>> [round(surface_factor(load, 10e-6, 800e6), 3) for load in ("bending", "torsion")]
    [0.868, 0.924]
    """
    normal = 1 - 0.22 * math.log10(1e6 * roughness) * (math.log10(ultimate / 20e6) - 1)
    factor = 0.575 * normal + 0.425 if load == "torsion" else normal
    return min(factor, 1.0)


def yield_rise(load: Load, notch: float) -> float:
    """Return the rise of the yield point in a notch, gamma_F, by the fatigue or form factor (DIN
    743-1, table 2).

    Examples
    --------
    >>> [yield_rise("bending", beta) for beta in (1.2, 1.7, 2.5, 3.5)]
    [1.0, 1.05, 1.1, 1.15]
    """
    if load == "torsion" or notch < 1.5:
        return 1.0
    return 1.05 if notch < 2 else 1.1 if notch < 3 else 1.15


def total_factor(notch: float, size: float, surface: float, hardening: float) -> float:
    """Return the total influence K_sigma or K_tau (DIN 743-1): ``(beta / K_2 + 1 / K_F - 1) /
    K_V``.
    """
    return (notch / size + 1 / surface - 1) / hardening


def mean_sensitivity(limit: float, ultimate: float) -> float:
    """Return the influence of mean stress psi by the limit of the part and the tensile strength,
    Pa.
    """
    return limit / (2 * ultimate - limit)


def amplitude_limit(
    limit: float, psi: float, static: float, mean: float, amplitude: float, constant_mean: bool
) -> float:
    """Return the amplitude that the part bears beside an equivalent mean stress, Pa: a constant one
    (DIN 743-1, case 1), or one that grows with the loads like the present amplitude (case 2), from
    the fatigue limit of the part, Pa, the sensitivity, and the yield limit, Pa.

    Examples
    --------
    A mean stress as large as the amplitude, growing with it: 200 / (1 + 0.25)

    >>> amplitude_limit(200.0, 0.25, 600.0, 50.0, 50.0, constant_mean=False)
    160.0
    >>> amplitude_limit(200.0, 0.25, 600.0, 50.0, 50.0, constant_mean=True)
    187.5
    """
    if constant_mean:
        if mean <= (static - limit) / (1 - psi):
            return limit - psi * mean
        return max(static - mean, 0.0)
    ratio = mean / amplitude
    yields = limit > psi * static and ratio > (static - limit) / (limit - psi * static)
    return static / (1 + ratio) if yields else limit / (1 + psi * ratio)
