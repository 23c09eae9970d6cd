"""Six components of forces and motions as columns, by name and unit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solidgear.core import DOF_NAMES

FORCE_UNITS = ("N",) * 3 + ("N m",) * 3
MOTION_UNITS = ("m",) * 3 + ("rad",) * 3


def six_columns(name: str, units: Sequence[str], values: np.ndarray) -> dict[str, np.ndarray]:
    """Return columns (f,) of values (f, 6), such as ``gear thx [rad]``."""
    return {
        f"{name} {dof} [{unit}]": values[:, c]
        for c, (dof, unit) in enumerate(zip(DOF_NAMES, units))
    }
