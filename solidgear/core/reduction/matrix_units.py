"""Systems of units of matrices, each consistent in itself: a force is a mass times an acceleration."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from solidgear.core.errors import SolidgearError, listed, show
from solidgear.core.scene.written import Word


@dataclass(frozen=True)
class MatrixUnits:
    """Units of length, mass and force; the second and the radian are those of all systems.

    Coordinates of modes have the root of the unit of energy, so that a mass of one stays one.

    Examples
    --------
    >>> MATRIX_UNITS["mm-t-N"].matrix(1, 0).diagonal()  # an N/mm is a thousand N/m
    array([1.e+03, 1.e+03, 1.e+03, 1.e-03, 1.e-03, 1.e-03])
    """

    name: str
    length: float  #: m
    force: float  #: N
    words: str  #: of length, mass and force

    @property
    def energy(self) -> float:
        """Unit of energy, J."""
        return self.force * self.length

    def coordinates(self, points: int, modes: int) -> np.ndarray:
        """Return the units (6 points + modes,) of coordinates, SI."""
        point = [self.length] * 3 + [1.0] * 3
        return np.r_[np.tile(point, points), np.full(modes, np.sqrt(self.energy))]

    def matrix(self, points: int, modes: int) -> np.ndarray:
        """Return the units (n, n) of entries of stiffness; of mass they are the same times s^2."""
        size = self.coordinates(points, modes)
        return self.energy / np.outer(size, size)


INCH, POUND = 0.0254, 4.4482216152605
SI = MatrixUnits("m-kg-N", 1.0, 1.0, "metres, kilograms and newtons")
#: systems by name
MATRIX_UNITS: Mapping[str, MatrixUnits] = {
    units.name: units
    for units in (
        SI,
        MatrixUnits("mm-t-N", 1e-3, 1.0, "millimetres, tonnes and newtons"),
        MatrixUnits("in-lbf-s", INCH, POUND, "inches, pounds-force and lbf s^2/in of mass"),
    )
}
#: type of the name of a system
UnitsWord = Annotated[str, Word(tuple(MATRIX_UNITS))]


def matrix_units(name: str) -> MatrixUnits:
    """Return a system of units by name."""
    if name not in MATRIX_UNITS:
        raise SolidgearError(f"units {show(name, 30)}: use one of {listed(MATRIX_UNITS)}")
    return MATRIX_UNITS[name]
