"""Modes of a system, and the singular values that they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from solidgear.core.errors import SolidgearError

#: Entries of a unit vector below this are rounding, and no motion.
TINY = 1e-13


@dataclass(frozen=True, eq=False)
class SystemModes:
    """Undamped modes of a :class:`System`."""

    frequency_hz: np.ndarray  #: (k,) ascending; rigid motions are exactly 0.0
    shapes: np.ndarray  #: (N, k) on the coordinates of the system, mass-normalised
    #: fraction of each mode's strain energy in every elastic part and link; zero in rigid motions
    energy: Mapping[str, np.ndarray]
    #: (k,) largest relative error of each frequency that the reduction of parts leaves, proven
    #: (:mod:`solidgear.core.system.system`); infinite where nothing can be promised
    error_bound: np.ndarray
    residual: float  #: largest ``|K u - w^2 M u|`` relative to ``|K| |u|``

    @property
    def rigid(self) -> int:
        """Number of zero frequencies."""
        return int((self.frequency_hz == 0).sum())

    def dominant(self) -> list[str]:
        """Return the part or link with most of the strain energy of every mode; ``rigid`` if none
        has any.
        """
        names = list(self.energy)
        if not names:
            return ["rigid"] * len(self.frequency_hz)
        shares = np.array([self.energy[name] for name in names])
        most = shares.argmax(axis=0)
        return [names[i] if shares[i, k] > 0 else "rigid" for k, i in enumerate(most)]


def relative_residual(
    stiffness: np.ndarray, mass: np.ndarray, shapes: np.ndarray, omega: np.ndarray
) -> float:
    """Return the largest ``|K u - w^2 M u|`` relative to ``|K| |u|``."""
    size = np.abs(stiffness)
    scale = (size @ np.abs(shapes)).max(axis=0, initial=0.0)
    # A rigid motion may touch no spring at all, or by rounding only.
    least = TINY * size.max(initial=0.0) * np.abs(shapes).max(axis=0, initial=0.0)
    scale = np.maximum(scale, least)
    miss = stiffness @ shapes - mass @ shapes * omega**2
    miss = np.abs(miss).max(axis=0, initial=0.0)
    return float((miss / np.where(scale > 0, scale, 1.0)).max(initial=0.0))


def singular(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return singular values, descending, and right vectors (rows) of a matrix of full column rank.

    Jacobi's method with pivoting (Drmac and Veselic 2008): rows of very different size, springs of
    1 and of 1e20 N/m, cost no digits of the small values, where bidiagonalisation rounds by 1e-16
    of the largest.
    """
    order = np.argsort(-np.abs(rows).max(axis=1), kind="stable")
    # "F": accurate for badly scaled rows and columns; no left vectors, all right ones
    value, _, right, scale, _, failed = lapack.dgejsv(rows[order], joba=2, jobu=3, jobv=0)
    if failed:
        raise SolidgearError(
            "the modes of the system do not converge; check stiffnesses and masses"
        )
    return value * (scale[0] / scale[1]), right.T
