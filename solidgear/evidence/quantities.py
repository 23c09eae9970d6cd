"""The handful of numbers by which models are compared, and where they are found in results."""

from __future__ import annotations

import numpy as np

from solidgear.solve.modes import ModeSet
from solidgear.solve.statics import Condensed

# name -> (kind, place, unit); compliances first: they are what a change of tie or model moves least by accident.
QUANTITIES = {
    "C_zz": ("compliance", (2, 2), "m/N"),
    "C_z,thx": ("compliance", (2, 3), "rad/N"),
    "C_thx": ("compliance", (3, 3), "rad/(N m)"),
    "C_yy": ("compliance", (1, 1), "m/N"),
    "K_zz": ("stiffness", (2, 2), "N/m"),
    "K_z,thx": ("stiffness", (2, 3), "N/rad"),
    "K_thx": ("stiffness", (3, 3), "N m/rad"),
    "K_yy": ("stiffness", (1, 1), "N/m"),
    "bending 1": ("frequency", "bending 1", "Hz"),
    "bending 2": ("frequency", "bending 2", "Hz"),
    "axial 1": ("frequency", "axial 1", "Hz"),
    "torsion 1": ("frequency", "torsion 1", "Hz"),
}


def measure(condensed: Condensed, modes: ModeSet) -> dict[str, float]:
    """The compared numbers of one solution; those that do not exist (free motions, missing modes) are left out."""
    out = {}
    for name, (kind, place, _) in QUANTITIES.items():
        if kind == "frequency":
            mode = modes.named(place)
            value = mode.frequency_hz if mode else np.nan
        else:
            value = getattr(condensed, kind)[place]
        if np.isfinite(value) and value != 0.0:
            out[name] = float(value)
    return out


def change(new: dict[str, float], old: dict[str, float], name: str) -> float | None:
    """Relative change of one quantity, or None where either lacks it; rounding (below 1e-11) counts as none."""
    if name in new and name in old:
        relative = new[name] / old[name] - 1
        return relative if abs(relative) > 1e-11 else 0.0
    return None
