"""Display of results: in a line or a few, as a table of a notebook, as a picture.

What is told of each is written in :mod:`solidgear.report.shown`, above all the rooms these objects
live in; it is found by name when it is first needed, so that nothing below imports the report.
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any, ClassVar

#: rows of a table that a `repr` shows
MOST_ROWS = 24
TELLING = "solidgear.report.shown"


@dataclass(frozen=True, eq=False)
class Table:
    """A small table of a result.

    Attributes
    ----------
    title : str
    heads : tuple of str
        With units.
    rows : sequence of tuple
        Numbers, texts, and None for what is not known.

    Examples
    --------
    >>> Table("two modes", ("mode", "Hz"), [("bending 1", 2758.0042), ("axial 1", 1388.5)])
    two modes
      mode       Hz
      bending 1  2758.00
      axial 1    1388.50
    """

    title: str
    heads: tuple[str, ...]
    rows: Sequence[tuple[Any, ...]]

    def __repr__(self) -> str:
        shown = [self.heads, *(tuple(map(_text, row)) for row in self.rows[:MOST_ROWS])]
        if not self.rows:
            return self.title
        widths = [max(len(row[k]) for row in shown) for k in range(len(self.heads))]
        lines = ["  ".join(c.ljust(w) for c, w in zip(row, widths)).rstrip() for row in shown]
        left = len(self.rows) - MOST_ROWS
        more = [f"  and {left} more"] if left > 0 else []
        return "\n".join([self.title, *(f"  {line}" for line in lines), *more])

    def _repr_html_(self) -> str:
        def row(cells: Sequence[str], tag: str) -> str:
            return "<tr>" + "".join(f"<{tag}>{escape(c)}</{tag}>" for c in cells) + "</tr>"

        body = "".join(row([_text(c) for c in one], "td") for one in self.rows)
        return (
            f"<table><caption>{escape(self.title)}</caption>"
            f"<thead>{row(self.heads, 'th')}</thead><tbody>{body}</tbody></table>"
        )

    def to_dataframe(self) -> Any:
        """As a data frame of pandas.

        Raises
        ------
        ImportError
            Where pandas is not installed; nothing else of solidgear needs it.
        """
        import pandas

        return pandas.DataFrame(list(self.rows), columns=list(self.heads))


def _text(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.2f}" if 1000 <= abs(value) < 1e5 else f"{value:.6g}"
    return str(value)


class Displayed:
    """A result that shows itself; ``shown`` names its functions in :mod:`solidgear.report.shown`
    (the table) and, with ``_figure`` behind it, the picture.
    """

    shown: ClassVar[str] = ""

    def table(self, *args: Any, **kwargs: Any) -> Table:
        """Its numbers in short.

        Returns
        -------
        Table
        """
        return getattr(importlib.import_module(TELLING), self.shown)(self, *args, **kwargs)

    def plot(self, *args: Any, **kwargs: Any) -> Any:
        """A picture of it.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        TypeError
            Where there is nothing to draw.
        """
        draw = getattr(importlib.import_module(TELLING), f"{self.shown}_figure", None)
        if draw is None:
            raise TypeError(f"a {type(self).__name__} has no picture; table() tells its numbers")
        return draw(self, *args, **kwargs)

    def to_dataframe(self, *args: Any, **kwargs: Any) -> Any:
        """Its table as a data frame of pandas, which must be installed; see :meth:`table`."""
        return self.table(*args, **kwargs).to_dataframe()

    def __repr__(self) -> str:
        return repr(self.table())

    __str__ = __repr__

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()
