"""Placing of a part in a scene: its axis turned to y, the lower end of it at y = 0."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

Triple = tuple[float, float, float]


class Placing(NamedTuple):
    """From places in a file to places in a scene, ``turn @ (unit * x - foot)``.

    Attributes
    ----------
    unit : float
        m for each unit of the file.
    turn : tuple of tuple of float
        3 x 3, a rotation.
    foot : tuple of float
        What comes to lie at the origin: where the axis of the part leaves it, m, in the axes of the
        file.
    """

    unit: float
    turn: tuple[Triple, Triple, Triple]
    foot: Triple

    def of(self, points: np.ndarray) -> np.ndarray:
        """Places in the scene, m, of (3, n) places in the file."""
        return np.array(self.turn) @ (self.unit * points - np.array(self.foot)[:, None])

    def back(self, points: np.ndarray) -> np.ndarray:
        """Places in the file, m, of (3, n) places in the scene."""
        return np.array(self.turn).T @ points + np.array(self.foot)[:, None]


#: rotations that turn an axis of the file to +y; about a second axis where there is a choice
TURNS: dict[str, tuple[Triple, Triple, Triple]] = {
    "x": ((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "-x": ((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "y": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "-y": ((-1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    "z": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)),
    "-z": ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)),
}
