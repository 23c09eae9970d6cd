"""Placing of a part in a scene: the axis turned to y, the lower end of it at y = 0."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

Triple = tuple[float, float, float]


class Placing(NamedTuple):
    """A map from places in a file to places in a scene, ``turn @ (unit * x - foot)``."""

    unit: float  #: m for each unit of the file
    turn: tuple[Triple, Triple, Triple]  #: 3 x 3, a rotation
    #: point that comes to lie at the origin, where the axis of the part leaves it: m, in the axes of
    #: the file
    foot: Triple

    def to_scene(self, points: np.ndarray) -> np.ndarray:
        """Return places in the scene, m, of (3, n) places in the file."""
        return np.array(self.turn) @ (self.unit * points - np.array(self.foot)[:, None])

    def to_file(self, points: np.ndarray) -> np.ndarray:
        """Return places in the file, m, of (3, n) places in the scene."""
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


def turn_of(axis: str | Triple) -> tuple[Triple, Triple, Triple]:
    """Return the rotation that turns an axis of the file to +y, a direction of length one by the
    least angle.

    Examples
    --------
    >>> turn = np.array(turn_of((0.6, 0.8, 0.0)))
    >>> (turn @ [0.6, 0.8, 0.0]).round(12).tolist(), (turn @ [0, 0, 1]).round(12).tolist()
    ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0])
    """
    if isinstance(axis, str):
        return TURNS[axis]
    x, y, z = axis
    if y < -1 + 1e-12:
        return TURNS["-y"]
    # I + V + V^2 / (1 + y) of the skew matrix V of axis x (0, 1, 0)
    skew = np.array([[0.0, -x, 0.0], [x, 0.0, z], [0.0, -z, 0.0]])
    turn = np.eye(3) + skew + skew @ skew / (1 + y)
    first, second, third = (tuple(float(v) for v in row) for row in turn)
    return first, second, third  # type: ignore[return-value]
