"""Published stress concentration factors of filleted shoulders of round shafts, D over d."""

from __future__ import annotations

import numpy as np

#: coefficients of 1, sqrt(h/r) and h/r in C_1 to C_4, up to h/r = 2 and beyond (Pilkey, Peterson's
#: Stress Concentration Factors, 2nd ed. 1997, charts 3.4, 3.10 and 3.12)
CHARTS = {
    ("tension", 0): (
        (0.926, 1.157, -0.099),
        (0.012, -3.036, 0.961),
        (-0.302, 3.977, -1.744),
        (0.365, -2.098, 0.878),
    ),
    ("tension", 1): (
        (1.200, 0.860, -0.022),
        (-1.805, -0.346, -0.038),
        (2.198, -0.486, 0.165),
        (-0.593, -0.028, -0.106),
    ),
    ("bending", 0): (
        (0.947, 1.206, -0.131),
        (0.022, -3.405, 0.915),
        (0.869, 1.777, -0.555),
        (-0.810, 0.422, -0.260),
    ),
    ("bending", 1): (
        (1.232, 0.832, -0.008),
        (-3.813, 0.968, -0.260),
        (7.423, -4.868, 0.869),
        (-3.839, 3.070, -0.600),
    ),
    ("torsion", 0): (
        (0.905, 0.783, -0.075),
        (-0.437, -1.969, 0.553),
        (1.557, 1.073, -0.578),
        (-1.061, 0.171, 0.086),
    ),
}
#: h/r between which the fits are given
RANGE = {"tension": (0.1, 20.0), "bending": (0.1, 20.0), "torsion": (0.25, 4.0)}


def peterson(load: str, ratio: float, radius: float) -> float | None:
    """Form factor by Peterson's charts; None where the fit is not given.

    Parameters
    ----------
    load : {'tension', 'bending', 'torsion'}
    ratio, radius : float
        D/d and r/d.
    """
    steep = (ratio - 1) / 2 / radius
    if not RANGE[load][0] <= steep <= RANGE[load][1]:
        return None
    rows = CHARTS[load, int(steep > 2 and load != "torsion")]
    terms = np.array([1.0, np.sqrt(steep), steep])
    depth = 1 - 1 / ratio
    return float(sum(terms @ np.array(row) * depth**k for k, row in enumerate(rows)))


def finite_elements(load: str, ratio: float, radius: float) -> float:
    """Form factor by fits to finite elements (Tipton, Sorem and Rolovic 1996, J. Mech. Des. 118,
    321, for tension and bending; Rolovic, Tipton and Sorem 2001, J. Mech. Des. 123, 300, for
    torsion).

    Parameters
    ----------
    load : {'tension', 'bending', 'torsion'}
    ratio, radius : float
        D/d and r/d.
    """
    q = ratio**2
    if load == "tension":
        root = (3.43 - 3.41 * q - 0.0232 * q**2) / (1 - 8.85 * q - 0.078 * q**2)
        return float(0.493 + 0.48 * ratio**-2.43 + radius**-0.48 * np.sqrt(root))
    if load == "bending":
        root = (-0.14 - 0.363 * q + 0.503 * q**2) / (1 - 2.39 * q + 3.368 * q**2)
        return float(0.632 + 0.377 * ratio**-4.4 + radius**-0.5 * np.sqrt(root))
    root = (0.002 - 0.125 * q + 0.123 * q**2) / (1 - 2.75 * q + 2.55 * q**2)
    return float(0.78 + 0.2 * ratio**-10 + radius**-0.46 * np.sqrt(root))
