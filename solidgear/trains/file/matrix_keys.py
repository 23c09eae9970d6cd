"""Keys of a file that stand beside the name of a file of matrices, and are read with it."""

from __future__ import annotations

from typing import Any, ClassVar

from pydantic.fields import FieldInfo

from solidgear.core import Model
from solidgear.core.reduction.matrix_units import UnitsWord


class MatrixKeys(Model):
    """Keys beside ``matrices``."""

    #: unit system of the file of matrices
    units: UnitsWord = ""
    #: node of the file of matrices for every point, such as {"input.A" = 101}; of a rigid housing
    #: the place of every point whose motion is given, m
    points: dict[str, Any] = {}


class WithMatrices(Model):
    """Base of tables that may name a file of matrices."""

    Words: ClassVar[type[Model]] = MatrixKeys

    @classmethod
    def table_keys(cls) -> dict[str, FieldInfo | None]:
        return cls.Words.table_keys() | super().table_keys()
