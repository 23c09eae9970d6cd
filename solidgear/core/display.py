"""Display of results: in a few lines, as a table of a notebook, as a picture.

Tables and pictures are made by :mod:`solidgear.show.shown`, above all rooms of results; it is
imported by name when first needed, so that nothing below imports the report.
"""

from __future__ import annotations

import importlib
import os
from pathlib import Path
from typing import Any, ClassVar, Protocol

TABLES = "solidgear.show.shown"
SHEETS = "solidgear.show.sheet"
FRAMES = "solidgear.show.frames"


class Table(Protocol):
    """A table as the way to show builds it: text of a terminal, of a page, a data frame."""

    def to_dataframe(self) -> Any: ...

    def to_xarray(self) -> Any: ...

    def _repr_html_(self) -> str: ...


class Displayed:
    """Base of results with a table and a picture."""

    #: function of :mod:`solidgear.show.shown` that makes the table, or ``module:function`` of the
    #: room of the result; the one of the picture has ``_figure`` behind that name
    shown: ClassVar[str] = ""

    def table(self, *args: Any, **kwargs: Any) -> Table:
        """Return a table of the main numbers."""
        return _shown(self.shown)(self, *args, **kwargs)

    def plot(self, *args: Any, **kwargs: Any) -> Any:
        """Return a picture, shown in a notebook; its ``write`` makes a PNG or SVG file.

        Raises
        ------
        TypeError
            Where there is nothing to draw.
        """
        draw = _shown(f"{self.shown}_figure")
        if draw is None:
            raise TypeError(f"a {type(self).__name__} has no picture; table() shows its numbers")
        return draw(self, *args, **kwargs)

    def framed_tables(self) -> dict[str, Table]:
        """Return all tables of numbers by name, the main one first."""
        more = _shown(f"{self.shown}_tables")
        return {"": self.table()} if more is None else more(self)

    def to_dataframe(self, name: str = "") -> Any:
        """Return a table of numbers as a data frame of pandas, in SI.

        Parameters
        ----------
        name : str
            As :meth:`framed_tables` has it; by default the first.

        Returns
        -------
        pandas.DataFrame
            Columns by names of quantities, error bars beside values; ``attrs["units"]`` has units.

        Raises
        ------
        SolidgearError
            For another name, and where pandas is not installed.
        """
        return _frames().chosen(self.framed_tables(), name).to_dataframe()

    def to_xarray(self, name: str = "") -> Any:
        """Return a table of numbers over its axes as a data set of xarray, in SI.

        Parameters
        ----------
        name : str
            As :meth:`framed_tables` has it; by default the first that has an axis.

        Returns
        -------
        xarray.Dataset
            Columns over those that are axes; ``attrs["units"]`` of each has its unit.

        Raises
        ------
        SolidgearError
            For another name, for a result without axes, and where xarray is not installed.
        """
        return _frames().chosen(self.framed_tables(), name, over_axes=True).to_xarray()

    def __repr__(self) -> str:
        return repr(self.table())

    __str__ = __repr__

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()


class Sheeted(Displayed):
    """Base of results of a study: they show what its command prints, and write what it writes."""

    #: ``module:function`` of the room of the result, which makes its sheet in some units
    sheeted: ClassVar[str] = ""
    #: the same for a folder, given last, where more is drawn for one
    filed: ClassVar[str] = ""

    def sheet(self, units: Any = "engineering") -> Any:
        """Return all that is shown, in units of a name."""
        return _sheets().sheet_of(self, _shown(self.sheeted), units)

    def write(self, folder: str | os.PathLike, units: str = "engineering") -> list[Path]:
        """Write a page, the data, tables and charts into a folder, as the command does.

        Parameters
        ----------
        folder : path
        units : {'engineering', 'si', 'us'}
            Of the page; data and tables are in SI always.

        Returns
        -------
        list of pathlib.Path
            The files.

        Raises
        ------
        SolidgearError
            If the folder cannot be written, or units are unknown.
        """
        return _sheets().write_result(
            self, folder, units, _shown(self.filed) if self.filed else None
        )

    def table(self, *args: Any, **kwargs: Any) -> Table:
        """Return a table of the main numbers."""
        if self.shown:
            return super().table(*args, **kwargs)
        return _sheets().main_table(self.sheet())

    def framed_tables(self) -> dict[str, Table]:
        """Return all tables of numbers by name, the main one first, then those of its files."""
        more = _shown(f"{self.shown}_tables") if self.shown else None
        return _sheets().tables_of(self.sheet()) if more is None else more(self)

    def __repr__(self) -> str:
        return super().__repr__() if self.shown else _sheets().as_printed(self.sheet())

    __str__ = __repr__

    def _repr_html_(self) -> str:
        return super()._repr_html_() if self.shown else _sheets().as_html(self.sheet())


def _frames() -> Any:
    return importlib.import_module(FRAMES)


def _sheets() -> Any:
    return importlib.import_module(SHEETS)


def _shown(name: str) -> Any:
    """Return the function that shows a result, ``module:name`` or a name in TABLES; None if there
    is none.
    """
    module, _, function = name.rpartition(":")
    room = importlib.import_module(f"solidgear.{module}" if module else TABLES)
    return getattr(room, function, None)
