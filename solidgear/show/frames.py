"""Tables as data frames of pandas and as data sets of xarray, for programs that go on from results.

A frame holds the values of a table in SI, whatever units a reader has chosen, under the names of
quantities; units stand in ``attrs``.  A data set has its columns over those that are axes.
"""

from __future__ import annotations

import math
import re
from collections.abc import Container, Mapping, Sequence
from typing import Any, Protocol

from solidgear.core import SolidgearError, listed, nearest

#: a head with its unit: in brackets, or behind a comma
IN_BRACKETS = re.compile(r"(?P<name>.*?) ?\[(?P<unit>[^\]]*)\]")
BEHIND = re.compile(r"(?P<name>.+),\s(?P<unit>[^\s,]+(?: m)?)")
#: units as heads have them alone, and what is measured in them
ALONE = {"Hz": ("frequency", "Hz"), "s": ("time", "s")}


class Framed(Protocol):
    """A table, as :class:`solidgear.show.table.Table` is one."""

    title: str

    @property
    def framed(self) -> tuple[Sequence[Any], list[list[Any]]]:
        """Columns and values."""


def dataframe(table: Framed) -> Any:
    """Return the values of a table as a data frame."""
    try:
        import pandas
    except ImportError:
        raise missing("pandas", "a data frame") from None
    rows = table.framed[1]
    names = enumerate(quantities(table))
    frame = pandas.DataFrame({name: _values([row[k] for row in rows]) for k, name in names})
    frame.attrs = {"title": table.title, "units": units(table)}
    return frame


def _values(column: list[Any]) -> list[Any]:
    """Return the values of a column; a column without any holds numbers that are none."""
    values = [_plain(value) for value in column]
    return values if any(value is not None for value in values) else [math.nan] * len(values)


def dataset(table: Framed) -> Any:
    """Return the columns of a table over those that are axes, as a data set."""
    try:
        import xarray
    except ImportError:
        raise missing("xarray", "a data set") from None
    axes = [name for name, c in zip(quantities(table), table.framed[0]) if c.axis]
    if not axes:
        raise SolidgearError(
            f"{table.title or 'this table'} has no axis: to_dataframe() has its values"
        )
    frame = dataframe(table)
    if frame.duplicated(axes).any():
        raise SolidgearError(f"{table.title or 'this table'} has rows at one place of its axes")
    if len(axes) > 1:
        # places in the order of the rows, and not of their sizes
        result = frame.set_index(axes).to_xarray()
        result = result.reindex({axis: frame[axis].unique() for axis in axes})
        for name, column in zip(quantities(table), table.framed[0]):
            if column.over:
                values = frame.groupby(column.over, sort=False)[name].first()
                result[name] = (column.over, values[result[column.over].values].to_numpy())
    else:
        result = _over_one(xarray, frame, axes[0])
    for name, unit in units(table).items():
        result[name].attrs["units"] = unit
    result.attrs["title"] = table.title
    return result


def chosen(tables: Mapping[str, Framed], name: str, over_axes: bool = False) -> Framed:
    """Return a table by its name; by default the first, or the first that has an axis."""
    fit = {
        key: table
        for key, table in tables.items()
        if not over_axes or any(column.axis for column in table.framed[0])
    }
    if not fit:
        raise SolidgearError("this result has no axes: to_dataframe() has its numbers")
    if name and name not in fit:
        raise SolidgearError(
            f"there is no table {name!r}{nearest(name, fit)} There are {listed(fit)}"
        )
    return fit[name] if name else next(iter(fit.values()))


def quantities(table: Framed) -> dict[str, str]:
    """Return the names of quantities of the columns, each once, with their units; empty where there
    is none.
    """
    names: dict[str, str] = {}
    for column in table.framed[0]:
        name, unit = _quantity(column)
        name = _other(name, names)
        names[name] = unit
    return names


def units(table: Framed) -> dict[str, str]:
    """Return the units of columns that have one, by the names of their quantities."""
    return {name: unit for name, unit in quantities(table).items() if unit}


def missing(library: str, what: str) -> SolidgearError:
    """Return the refusal of what a library that is not installed would make."""
    return SolidgearError(f"{what} needs {library}: pip install 'solidgear[tables]'")


def _quantity(column: Any) -> tuple[str, str]:
    """Return the name of a column and the unit of its values."""
    head = column.head.replace("\n", ", ")
    for pattern in (IN_BRACKETS, BEHIND):
        if match := pattern.fullmatch(head):
            return column.name or match["name"], column.unit or match["unit"]
    name, unit = ALONE.get(head, (head, ""))
    return column.name or name or "row", column.unit or unit


def _other(name: str, names: Container[str]) -> str:
    """Return a name that none of some has."""
    count, other = 1, name
    while other in names:
        count += 1
        other = f"{name} {count}"
    return other


def _over_one(xarray: Any, frame: Any, axis: str) -> Any:
    """Return columns over one axis, in the order of the rows."""
    data = {name: (axis, frame[name].to_numpy()) for name in frame.columns if name != axis}
    return xarray.Dataset(data, {axis: frame[axis].to_numpy()})


def _plain(value: Any) -> Any:
    """Return a value without what this program has added to a text."""
    return str(value) if isinstance(value, str) else value
