"""Matrices in a terminal: in 80 columns, and the same without colour."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from solidgear.show.matrices import block
from solidgear.show.table import Table
from solidgear.show.units import SI, Units, units_named

if TYPE_CHECKING:
    import numpy as np


#: figures of a coupling that is next to nothing
WEAK = 3


def matrix_table(
    matrix: np.ndarray | Sequence[Sequence[float | None]],
    kind: str,
    units: str | Units = SI,
    title: str = "",
    sizes: Sequence[Sequence[float]] | None = None,
) -> Table:
    """Return a 6x6 with its units, titled by its kind; free components (None or NaN) are dashes."""
    chosen = units_named(units)
    rows = matrix.tolist() if hasattr(matrix, "tolist") else matrix
    # a weak coupling has few figures that mean something, and a row has 80 columns
    table = block(rows, kind, chosen, sizes=sizes, faint_digits=WEAK)
    table.title = f"{title or kind}, {chosen.title}"
    return table
