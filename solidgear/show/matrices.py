"""A 6x6 as a table, with a unit over each of its four blocks."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from solidgear.core import DOF_NAMES
from solidgear.core.quantity import BLOCK_UNITS
from solidgear.show.table import Cell, Table, in_units
from solidgear.show.units import Units
from solidgear.show.words import is_number

#: a row of numbers each for six components
Rows = Sequence[Sequence[float | None]]
#: below this share of the geometric mean of its diagonal entries a coupling is next to nothing
FAINT = 1e-6


def block(
    matrix: Rows,
    kind: str,
    units: Units,
    title: str = "",
    free: Collection[str] = (),
    sizes: Sequence[Sequence[float | None]] | None = None,
    faint_digits: int = 0,
) -> Table:
    """Return a 6x6 of one point or between two, with dashes for `free` components and for None.

    `sizes` are the entries of both diagonals, of rows and of columns, beside which a coupling may
    be next to nothing; by default those of the matrix, whose diagonal is none. `faint_digits` are
    the figures of such a coupling in units without exponents, where zeros would fill its cell; by
    default it is a bare zero.
    """
    diagonal = [entry(matrix, k, k) for k in range(6)]
    across, along = sizes or (diagonal, diagonal)
    same, mixed, turn = BLOCK_UNITS[kind]
    quarters = ((same, mixed), (mixed, turn))

    def cell(i: int, j: int) -> Cell:
        value = entry(matrix, i, j)
        if not is_number(value) or {DOF_NAMES[i], DOF_NAMES[j]} & set(free):
            return Cell(None, "quiet")
        coupling = i != j or sizes is not None
        if not coupling or not is_nothing(value, across[i], along[j]):
            return in_units(value, quarters[i // 3][j // 3], units)
        digits = 5 if units.exponents else faint_digits
        if not digits:
            return Cell(value, "faint", "0")
        return in_units(value, quarters[i // 3][j // 3], units, digits, "faint")

    return Table(
        title,
        ["", *DOF_NAMES],
        [[name, *(cell(i, j) for j in range(6))] for i, name in enumerate(DOF_NAMES)],
        style="matrix",
        over=[tuple(map(units.unit, pair)) for pair in quarters],
    )


def entry(matrix: Rows | None, i: int, j: int) -> float | None:
    """Return one entry of a matrix; None if there is none."""
    if matrix is None or i >= len(matrix) or j >= len(matrix[i]):
        return None
    return matrix[i][j]


def is_nothing(value: float | None, first: float | None, second: float | None) -> bool:
    """Return True where a coupling is negligible beside two entries of its size."""
    if value is None or first is None or second is None:
        return False
    return abs(value) <= FAINT * abs(first * second) ** 0.5
