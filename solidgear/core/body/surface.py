"""Drawing of a body: the surface moved by a vector of unknowns, and the mesh of a volume."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

#: pieces an edge is cut into, where its displacement is curved
PIECES = 4


@dataclass(frozen=True, eq=False)
class Surface:
    """A moving surface, made of faces whose normals point out of the material."""

    points: np.ndarray  #: (n, 3) x, y, z at rest, m
    #: (n, 3) in the unit of the vector it was made from; m for unit-mass shapes up to their common
    #: factor
    displacement: np.ndarray
    faces: np.ndarray  #: (m, 4) quadrilaterals
    triangles: np.ndarray  #: (k, 3)
    #: (l, 2) pieces of lines that are worth drawing: element edges of a solid, circles and
    #: meridians otherwise
    lines: np.ndarray


@dataclass(frozen=True, eq=False)
class Volume:
    """A mesh of a volume whose unknowns are displacements x, y, z of the nodes, node by node."""

    element: str  #: one of :data:`solidgear.core.elements.ELEMENTS`
    nodes: np.ndarray  #: (3, n) m
    cells: np.ndarray  #: (nodes of a cell, m)
    #: (nodes of a cell, 3) reference coordinates of a cell's nodes, in the order of ``cells``
    local: np.ndarray


class Drawing(Protocol):
    """Geometry that a builder leaves with the body for pictures and files."""

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """Surface moved by the unknowns of some blocks, by name; blocks left out stand still."""

    def volume(self) -> Volume | None:
        """The mesh of the volume; None for bodies that have only a surface."""
