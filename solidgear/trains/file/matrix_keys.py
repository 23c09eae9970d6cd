"""Keys of a file that stand beside the name of a file of matrices, and are read with it."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import Field
from pydantic.fields import FieldInfo

from solidgear.core import Model, Written
from solidgear.core.reduction.matrix_units import UnitsWord
from solidgear.trains.file.mesh_cycle import Vector

#: number of a node, or those of the nodes that move and turn a point, as CalculiX has them
NodeNumber = int | Annotated[list[int], Field(min_length=2, max_length=2)]


class PlacedNode(Model):
    """Node of a file of matrices with its place."""

    #: number of the node, or of the two that move and turn the point
    node: NodeNumber
    #: place of the node, m; by default that of the file
    position: Vector | None = None


#: point of a file of matrices, as a file writes it
PointNode = NodeNumber | PlacedNode


class MatrixKeys(Model):
    """Keys beside ``matrices``."""

    #: unit system of the file of matrices
    units: UnitsWord = ""
    #: node of the file of matrices for every point, such as {"input.A" = 101}; of a rigid housing
    #: the place of every point whose motion is given, m
    points: Annotated[dict[str, Any], Written(dict[str, PointNode])] = {}


class WithMatrices(Model):
    """Base of tables that may name a file of matrices."""

    Words: ClassVar[type[Model]] = MatrixKeys

    @classmethod
    def table_keys(cls) -> dict[str, FieldInfo | None]:
        return cls.Words.table_keys() | super().table_keys()
