"""Published form factors of filleted shoulders of solid round shafts, beside those that are solved."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from solidgear.strength.stress.din743 import Load, form_factor

#: coefficients of 1, sqrt(h/r) and h/r in C_1 to C_4, up to h/r = 2 and beyond (Pilkey, Peterson's
#: Stress Concentration Factors, 2nd ed. 1997, charts 3.4, 3.10 and 3.12)
CHARTS: Mapping[tuple[Load, int], tuple[tuple[float, float, float], ...]] = {
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
RANGE: Mapping[Load, tuple[float, float]] = {
    "tension": (0.1, 20.0),
    "bending": (0.1, 20.0),
    "torsion": (0.25, 4.0),
}


def peterson(load: Load, large: float, small: float, radius: float) -> float | None:
    """Return the form factor of a shoulder of diameters D and d and a fillet radius, in one unit,
    by Peterson's charts; None where their fit is not given.

    Examples
    --------
    >>> round(peterson("bending", 60.0, 40.0, 4.0), 2)
    1.74
    """
    steep = (large - small) / 2 / radius
    if not RANGE[load][0] <= steep <= RANGE[load][1]:
        return None
    rows = CHARTS[load, int(steep > 2 and load != "torsion")]
    terms = np.array([1.0, np.sqrt(steep), steep])
    depth = 1 - small / large
    return float(sum(terms @ np.array(row) * depth**k for k, row in enumerate(rows)))


#: by their source
PUBLISHED: dict[str, Callable[[Load, float, float, float], float | None]] = {
    "Peterson": peterson,
    "DIN 743": form_factor,
}
