"""Matrices and modes in a terminal: in 80 columns, and the same without colour."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from solidgear.core import OpenNumbers
from solidgear.core.judge.record import ModeRecord
from solidgear.show import open_words, words
from solidgear.show.matrices import block
from solidgear.show.table import Column, Table, text
from solidgear.show.units import SI, Units, units_named

if TYPE_CHECKING:
    import numpy as np

    from solidgear.core import Mode

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


def modes_table(
    modes: Sequence[ModeRecord | Mode],
    bars: Mapping[str, float] | None = None,
    open_: OpenNumbers | None = None,
) -> Table:
    """Return natural frequencies with names and multiplicity, and error bars and ranges where
    given.
    """
    columns = [
        text("mode", lambda m: m.name or None),
        text("family", lambda m: m.family or None),
        Column("frequency, Hz", lambda m: m.frequency_hz, words.hertz),
        Column("shapes", lambda m: m.multiplicity),
    ]
    if bars:

        def bar(mode: ModeRecord) -> str:
            width = bars.get(mode.name or "")
            return "" if width is None else words.percent(width, signed=False)

        columns.append(Column("error bar", bar))
    note = ""
    if open_ is not None:
        columns += open_words.columns(open_, lambda mode: mode.name)
        note = open_words.remark(open_)
    return Table("", columns, modes, note)
