"""The handful of numbers by which models are compared, and where they are found in results."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.solve.modes import ModeSet
from solidgear.solve.statics import Condensed

# name -> (kind, place, unit); compliances first: they are what a change of tie or model moves least
# by accident.  The place is an entry of a matrix, or the name of a mode.
QUANTITIES: dict[str, tuple[str, tuple[int, int] | str, str]] = {
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


#: a coupling passes through zero where symmetry wants it to: it is related to the geometric mean
#: of these two
COUPLINGS = {"C_z,thx": ("C_zz", "C_thx"), "K_z,thx": ("K_zz", "K_thx")}

#: What models are judged by: compliances and the frequencies a gear designer reads.  Stiffnesses
#: follow from compliances and are shown, not judged: inverting spreads a small change of one entry
#: over all of them.
JUDGED = ("C_zz", "C_z,thx", "C_thx", "C_yy", "bending 1", "axial 1")


def measure(condensed: Condensed | None, modes: ModeSet | None) -> dict[str, float]:
    """The compared numbers of one solution; those that do not exist (free motions, missing modes)
    or were not solved (None) are left out.
    """
    out = {}
    for name, (kind, place, _) in QUANTITIES.items():
        value = np.nan
        if isinstance(place, str):
            mode = modes.named(place) if modes is not None else None
            value = mode.frequency_hz if mode else np.nan
        elif condensed is not None:
            value = getattr(condensed, kind)[place]
        if np.isfinite(value) and (value != 0.0 or name in COUPLINGS):
            out[name] = float(value)
    # a coupling of motions that nothing resists is no number
    return {name: v for name, v in out.items() if all(d in out for d in COUPLINGS.get(name, ()))}


def size(values: Mapping[str, float], name: str) -> float:
    """What errors of a quantity are relative to: of couplings the geometric mean of their diagonal
    entries (`COUPLINGS`), of all else the value itself.
    """
    if name in COUPLINGS:
        one, two = COUPLINGS[name]
        if one in values and two in values:
            return float((values[one] * values[two]) ** 0.5)
    return abs(values[name])


def change(new: Mapping[str, float], old: Mapping[str, float], name: str) -> float | None:
    """Relative change of one quantity, or None where either lacks it; rounding (below 1e-11) counts
    as none.

    Couplings are related to the geometric mean of their diagonal entries (`COUPLINGS`), all else to
    the old value.
    """
    if name not in new or name not in old:
        return None
    scale = size(old, name)
    if scale == 0.0:
        return 0.0 if new[name] == 0.0 else None
    relative = (new[name] - old[name]) / scale
    return relative if abs(relative) > 1e-11 else 0.0
