"""The inverse of a free body with rigid masses on its ports, by that of the body alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg as sla

if TYPE_CHECKING:
    from solidgear.solve.supported import Supported


class MassUpdate:
    """Inverse of ``K + shift (M + J J')`` by that of the body before the masses J (n, q) are put
    on its ports.
    """

    def __init__(self, supported: Supported, heavy: np.ndarray):
        self._own, self._heavy = supported, heavy
        rigid = supported.orthonormal_rigid()
        mass_rigid = supported.mass(rigid)
        carried = rigid.T @ heavy
        # the shift times what a unit load at a mass moves: rigid motions of it without rounding
        elastic = supported.factored(heavy - mass_rigid @ carried)
        elastic = elastic - rigid @ (mass_rigid.T @ elastic)
        self._through = supported.shift * elastic + rigid @ carried
        small = np.eye(heavy.shape[1]) + heavy.T @ self._through
        self._inner = sla.cho_factor((small + small.T) / 2)

    def inverse(self, x: np.ndarray) -> np.ndarray:
        """Displacements under (n, k) loads that no rigid motion does work on."""
        y = self._own.factored(x)
        return y - self._through @ sla.cho_solve(self._inner, self._heavy.T @ y)
