"""Drawing of a body: the surface moved by a vector of unknowns, and the mesh of a volume."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from solidgear.core.errors import SolidgearError

if TYPE_CHECKING:
    from solidgear.core.body.model import Body

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


def mesh_unknowns(body: Body, vectors: Mapping[int, np.ndarray]) -> dict[str, np.ndarray]:
    """Return block name -> unknowns of the mesh, with rigidly tied seats expanded.

    Raises
    ------
    SolidgearError
        If a vector does not fit its block.
    """
    out = {}
    for index, vector in vectors.items():
        block = body.block(index)
        if np.shape(vector) != (block.size,):
            raise SolidgearError(
                f"a shape of block {block.name} has {block.size} values, not {np.shape(vector)}"
            )
        out[block.name] = (
            np.asarray(vector, float) if block.expand is None else block.expand @ vector
        )
    return out
