"""Stress concentration factors of filleted shoulders of round shafts, fitted to finite elements."""

from __future__ import annotations

import numpy as np


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
