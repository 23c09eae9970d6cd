"""Display of results: in a line or a few, as a table of a notebook, as a picture.

What is told of each is written in :mod:`solidgear.report.shown`, above all the rooms these objects
live in; it is found by name when it is first needed, so that nothing below imports the report.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

if TYPE_CHECKING:
    from solidgear.report.table import Table

TELLING = "solidgear.report.shown"


class Displayed:
    """A result that shows itself; ``shown`` names its functions in :mod:`solidgear.report.shown`
    (the table) and, with ``_figure`` behind it, the picture.
    """

    shown: ClassVar[str] = ""

    def table(self, *args: Any, **kwargs: Any) -> Table:
        """Its numbers in short."""
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


def plain(value: Any) -> Any:
    """A result as data that JSON can hold: dataclasses by their fields, those that no `repr` shows
    left out; arrays as lists; what is infinite as None.

    Examples
    --------
    >>> plain({"load": np.array([1.0, 2.0]), "life": math.inf})
    {'load': [1.0, 2.0], 'life': None}
    """
    if is_dataclass(value):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value) if f.repr}
    if hasattr(value, "_asdict"):  # a named tuple
        return plain(value._asdict())
    if isinstance(value, Mapping):
        return {key: plain(entry) for key, entry in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
