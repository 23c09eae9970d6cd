"""A moving surface, made of faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: pieces an edge is cut into, where its displacement is curved
PIECES = 4


@dataclass(frozen=True, eq=False)
class Surface:
    """A moving surface, made of faces whose normals point out of the material.

    Attributes
    ----------
    points : (n, 3) ndarray
        x, y, z at rest, m.
    displacement : (n, 3) ndarray
        In the unit of the vector it was made from; m for unit-mass shapes up to their common
        factor.
    faces : (m, 4) ndarray of int
        Quadrilaterals.
    triangles : (k, 3) ndarray of int
    lines : (l, 2) ndarray of int
        Pieces of lines that are worth drawing: element edges of a solid, circles and meridians
        otherwise.
    """

    points: np.ndarray
    displacement: np.ndarray
    faces: np.ndarray
    triangles: np.ndarray
    lines: np.ndarray
