"""One table for every reader: a terminal, a page, a notebook, a file.

A :class:`Table` holds values; each :class:`Column` says how its own are written. What a medium needs
beside that stands here and nowhere else: :mod:`rich` asks for ``__rich_console__``, a notebook for
``_repr_html_``, a page calls the macro ``table`` of ``parts.html``, a file takes :meth:`Table.csv`.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from solidgear.core import whole
from solidgear.show.frames import dataframe, dataset
from solidgear.show.page_parts import template
from solidgear.show.units import Units, in_ascii, plain_unit
from solidgear.show.words import DASH, as_text

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions, RenderResult
    from rich.table import Table as RichTable

#: rows that a `repr` shows
MOST_ROWS = 24
#: characters from which on a text asks for a wide column where a page is narrow
LONG = 60
#: kinds of columns: numbers to the right, texts and single words to the left, marks in the middle
NUMBER, TEXT, WORD, MARK = "number", "text", "word", "mark"
#: how a kind is called in the style sheet
CSS = {NUMBER: "", TEXT: "text", WORD: "word text", MARK: ""}
#: on which side of its column a kind stands in a terminal
SIDE: dict[str, Literal["left", "right", "center"]] = {
    NUMBER: "right",
    TEXT: "left",
    WORD: "left",
    MARK: "center",
}


class Cell(NamedTuple):
    """A value that stands out."""

    value: Any
    #: ``quiet`` (said with less weight), ``faint`` (next to nothing), ``strong``, ``good``, ``bad``
    #: (beyond what was asked), ``unresolved``, or ``mark`` and the status of an input
    look: str = ""
    #: how it is written, where its column has no rule for it
    text: str | None = None


@dataclass(frozen=True)
class Column:
    """A column of a table."""

    head: str  #: with its unit
    #: the value, or :class:`Cell`, of an item; by default the item has its cells in the order of
    #: the columns
    of: Callable[[Any], Any] | None = None
    #: writes a value; texts stand as they are, and a dash for what is not there
    write: Callable[[Any], str] = as_text
    #: ``number``, ``text``, ``word`` or ``mark``; by default a text for the first column, else a
    #: number
    kind: str = ""
    #: name of the quantity and SI unit of the values in a frame; by default those that the head has,
    #: as ``force [N]`` or ``force, N``
    name: str = ""
    unit: str = ""
    axis: bool = False  #: whether other columns are over its values, as over a frequency
    over: str = ""  #: the one axis that its values depend on, where a table has several
    hidden: bool = False  #: whether it is in frames alone

    def written(self, value: Any, nothing: str = DASH) -> str:
        """Return a value as this column writes it."""
        if value is None or isinstance(value, float) and not math.isfinite(value):
            return nothing
        return value if isinstance(value, str) else self.write(value)


def text(head: str, of: Callable[[Any], Any] | None = None) -> Column:
    """Return a column of texts, which may take several lines."""
    return Column(head, of, kind=TEXT)


def word(head: str, of: Callable[[Any], Any] | None = None) -> Column:
    """Return a column of single words."""
    return Column(head, of, kind=WORD)


def quantity(
    head: str, si: str, units: Units, of: Callable[[Any], Any] | None = None, digits: int = 5
) -> Column:
    """Return a column of values of an SI unit, shown in `units`."""
    write = partial(units.number, si=si, digits=digits)
    return Column(f"{head}, {units.unit(si)}", of, write, name=head, unit=plain_unit(si))


def given(head: str, si: str, units: Units, of: Callable[[Any], Any] | None = None) -> Column:
    """Return a column of values out of a scene, without zeros behind them."""
    write = partial(units.given, si=si)
    return Column(f"{head}, {units.unit(si)}", of, write, name=head, unit=plain_unit(si))


class Aside(list):
    """A row that is shown and has its values beside those of another row in a frame."""


@dataclass
class Table:
    """A table.

    Examples
    --------
    >>> Table("two modes", ("mode", "Hz"), [("bending 1", 2758.0042), ("axial 1", 1388.5)])
    two modes
      mode       Hz
      bending 1  2758.00
      axial 1    1388.50
    """

    title: str
    #: a text is the head of a column whose values need no more than :func:`as_text`
    columns: Sequence[Any]
    #: items for the columns, which become rows of values
    rows: Sequence[Any] = field(default_factory=list)
    note: str = ""  #: what stands below
    #: name of a style: ``facts``, ``summary`` and ``numbers`` of pages, ``matrix``, and those of
    #: terminals in ``TERMINAL``
    style: str = ""
    #: where the rows are several blocks: for each what stands over equal shares of the columns
    #: behind the first, such as units
    over: Sequence[tuple[str, ...]] = ()
    name: str = ""  #: of its frame, by default from its title

    def __post_init__(self) -> None:
        columns = [c if isinstance(c, Column) else Column(c) for c in self.columns]
        self.columns = [
            c if c.kind else replace(c, kind=NUMBER if k else TEXT) for k, c in enumerate(columns)
        ]
        items = self.rows
        self.rows = [
            [c.of(item) if c.of else item[k] for k, c in enumerate(self.columns)] for item in items
        ]
        framed = [row for item, row in zip(items, self.rows) if not isinstance(item, Aside)]
        self._framed = self.columns, framed
        if any(c.hidden for c in self.columns):
            shown = [k for k, c in enumerate(self.columns) if not c.hidden]
            self.rows = [[row[k] for k in shown] for row in self.rows]
            self.columns = [self.columns[k] for k in shown]

    def __bool__(self) -> bool:
        return bool(self.rows)

    @property
    def key(self) -> str:
        """Name of its frame: of the title what stands before a comma, or a colon."""
        words = re.split(r"[,:(]", self.title)[0]
        return self.name or "_".join(re.findall(r"\w+", words.lower()))

    @property
    def heads(self) -> list[str]:
        """Heads of the columns."""
        return [column.head for column in self.columns]

    def counted(self, name: str) -> Table:
        """Return the table with the numbers of its rows, from 0, as the axis of its frame."""
        columns, rows = self._framed
        numbered = [[*row, k] for k, row in enumerate(rows)]
        plain = [replace(column, of=None) for column in columns]
        return replace(self, columns=[*plain, Column(name, axis=True, hidden=True)], rows=numbered)

    @property
    def values(self) -> list[list[Any]]:
        """The rows without looks."""
        return _values(self.rows)

    @property
    def framed(self) -> tuple[Sequence[Column], list[list[Any]]]:
        """Columns and values of a frame, with those that are not shown."""
        columns, rows = self._framed
        return columns, _values(rows)

    @property
    def cells(self) -> list[list[Cell]]:
        """The rows as they are written, texts with their looks."""
        return [[self._cell(c, value) for c, value in zip(self.columns, row)] for row in self.rows]

    @property
    def texts(self) -> list[list[str]]:
        """The rows as they are written."""
        return [[cell.value for cell in row] for row in self.cells]

    @staticmethod
    def _cell(column: Column, value: Any) -> Cell:
        cell = value if isinstance(value, Cell) else Cell(value)
        return Cell(column.written(cell.value) if cell.text is None else cell.text, cell.look)

    @property
    def blocks(self) -> list[tuple[tuple[str, ...], list[list[Cell]]]]:
        """Groups of rows, with their heading."""
        rows, many = self.cells, len(self.over) or 1
        size = math.ceil(len(rows) / many)
        over = self.over or [()]
        return [(over[k], rows[k * size : (k + 1) * size]) for k in range(many)]

    # ---------------------------------------------------------------------- a terminal
    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        yield fitted(self, console, options)

    def __repr__(self) -> str:
        if not self.rows:
            return self.title
        texts = [self.heads, *self.texts[:MOST_ROWS]]
        lines = [[in_ascii(text) for text in row] for row in texts]
        widths = [max(map(len, column)) for column in zip(*lines)]
        more = len(self.rows) - MOST_ROWS
        return "\n".join(
            [
                self.title,
                *("  " + "  ".join(map(str.ljust, line, widths)).rstrip() for line in lines),
                *([f"  and {more} more"] if more > 0 else []),
            ]
        )

    # ---------------------------------------------------------------------- a page
    def _repr_html_(self) -> str:
        return str(template("parts.html").module.table(self))

    def css(self, k: int, cell: Cell | None = None) -> str:
        """Return classes of column `k` in the style sheet, or of a cell in it."""
        kind = CSS[self.columns[k].kind] if k else ""
        if cell is None:
            return kind
        wide = "long" if kind and len(cell.value) > LONG else ""
        return " ".join(filter(None, (kind, cell.look, wide)))

    # ---------------------------------------------------------------------- files
    def csv(self) -> str:
        """Return the table as comma-separated values; empty where there is no value."""
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(self.heads)
        for row in self.values:
            writer.writerow([c.written(value, "") for c, value in zip(self.columns, row)])
        return out.getvalue()

    def write(self, path: Path) -> Path:
        """Write the table as comma-separated values, a whole file or none."""
        with whole(path) as half:
            half.write_text(self.csv(), encoding="utf-8", newline="")
        return path

    def to_dataframe(self) -> Any:
        """Return the values, in SI, as a data frame of pandas.

        Columns are called by their quantities; ``attrs["units"]`` has their units by name, and
        ``attrs["title"]`` the title.

        Raises
        ------
        SolidgearError
            Where pandas is not installed; nothing else of solidgear needs it.
        """
        return dataframe(self)

    def to_xarray(self) -> Any:
        """Return the values, in SI, over the columns that are axes, as a data set of xarray.

        Raises
        ------
        SolidgearError
            Where xarray is not installed, or no column is an axis.
        """
        return dataset(self)


def _values(rows: Iterable[Sequence[Any]]) -> list[list[Any]]:
    return [[v.value if isinstance(v, Cell) else v for v in row] for row in rows]


def in_units(value: float | None, si: str, units: Units, digits: int = 5, look: str = "") -> Cell:
    """Return a value of SI that is shown in other units, in a column of several."""
    return Cell(value, look, units.number(value, si, digits))


def exact(value: float) -> str:
    """Return a number for other programs."""
    return f"{value:.9g}"


def numbers(columns: Mapping[str, Iterable[float | str | None]], axes: int = 0) -> Table:
    """Return columns of numbers in SI and of texts by their heads, for other programs; the first
    `axes` of them are axes.
    """
    heads = [Column(head, write=exact, axis=k < axes) for k, head in enumerate(columns)]
    return Table("", heads, list(zip(*columns.values())))


#: what rich is told of the styles of terminals
TERMINAL: dict[str, dict[str, Any]] = {
    "": {"pad_edge": False},
    "narrow": {"pad_edge": False, "padding": 0, "collapse_padding": True},
    "ruled": {"show_edge": False},
    "bare": {"padding": (0, 1, 0, 0)},
}
TERMINAL["matrix"] = TERMINAL["narrow"]
#: right of a cell, left of it none, where a terminal has no room for more
TIGHT = ((0, 1, 0, 0), (0, 0, 0, 0))
#: characters that a column of texts has at least, if one of them needs as many
LEAST_TEXT = 12


def fitted(table: Table, console: Console, options: ConsoleOptions) -> RichTable:
    """Return a table for a terminal of a width: texts and heads wrap, numbers are never cut."""
    rich_table = printed(table)
    if _width(rich_table, console, options) <= options.max_width:
        return rich_table
    columns = list(zip(table.columns, zip(*table.texts)))
    whole = [_least(column, cells, column.head.split("\n")) for column, cells in columns]
    broken = [_least(column, cells, column.head.split()) for column, cells in columns]
    # numbers without a line between them would run together
    tight = TIGHT if rich_table.box else TIGHT[:1]
    ways = [(rich_table.padding, whole), *((pad, broken) for pad in (rich_table.padding, *tight))]
    for padding, widths in ways:
        rich_table.padding = padding
        for column, width in zip(rich_table.columns, widths):
            column.width, column.no_wrap = width, False
        spare = options.max_width - _width(rich_table, console, options)
        if spare >= 0:
            _widen_texts(table, rich_table, spare)
            return rich_table
    rich_table.width = _width(rich_table, console, options)
    return rich_table


def _width(rich_table: RichTable, console: Console, options: ConsoleOptions) -> int:
    """Return the characters that a table takes without a limit."""
    from rich.measure import Measurement

    return Measurement.get(console, options.update(max_width=1000), rich_table).maximum


def _least(column: Column, cells: Iterable[str], heads: Iterable[str]) -> int:
    """Return the characters of the widest cell or part of the head; for texts of a word."""
    parts = _widest([*heads, *cells])
    if column.kind != TEXT:
        return parts
    words = [word for cell in cells for word in cell.split()]
    return max(_widest([*heads, *words]), min(parts, LEAST_TEXT))


def _widest(texts: Iterable[str]) -> int:
    from rich.cells import cell_len

    return max((cell_len(in_ascii(cell)) for cell in texts), default=0)


def _widen_texts(table: Table, rich_table: RichTable, spare: int) -> None:
    """Share the rest of a line among columns of texts."""
    narrow = []
    for k, (column, cells) in enumerate(zip(table.columns, zip(*table.texts))):
        if column.kind == TEXT:
            narrow.append((_widest(cells) - (rich_table.columns[k].width or 0), k))
    for place, (needs, k) in enumerate(sorted(narrow)):
        more = max(min(needs, spare // (len(narrow) - place)), 0)
        rich_table.columns[k].width = (rich_table.columns[k].width or 0) + more
        spare -= more


def printed(table: Table) -> RichTable:
    """Return a table for a terminal.

    Texts go through :class:`rich.text.Text`, so that a name with brackets in it stays a name.
    """
    from rich import box
    from rich.table import Table as RichTable
    from rich.text import Text

    boxes = {"ruled": box.HEAVY_HEAD, "bare": None}
    rich_table = RichTable(
        box=boxes.get(table.style, box.SIMPLE_HEAD),
        title=Text(in_ascii(table.title), "table.title") if table.title else None,
        title_justify="left",
        caption=Text(in_ascii(table.note), "table.caption") if table.note else None,
        caption_justify="left",
        **TERMINAL.get(table.style, TERMINAL[""]),
    )
    for column in table.columns:
        rich_table.add_column(
            Text(in_ascii(column.head)),
            justify=SIDE[column.kind],
            no_wrap=column.kind != TEXT,
        )
    last = len(table.over) - 1
    for k, (heading, rows) in enumerate(table.blocks):
        if heading:
            rich_table.add_row(*_spread(heading, len(table.columns)), style="dim")
        for row in rows:
            ends = k < last and row is rows[-1]
            rich_table.add_row(*(Text(in_ascii(cell.value)) for cell in row), end_section=ends)
    return rich_table


def _spread(heading: Sequence[str], columns: int) -> Iterable[str]:
    """Return texts centred over their equal shares of columns."""
    share = (columns - 1) // len(heading)
    cells = [""] * columns
    for k, text in enumerate(heading):
        cells[1 + k * share + share // 2] = in_ascii(text)
    return cells
