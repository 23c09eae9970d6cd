"""Panels of charts: pairs of axes, and layers of marks over rows of data.

Marks and their looks have the names of Vega-Lite, and so have keys of a row (``x``, ``x2``, ``y``, ``y2``,
``text``, ``fill``, ``strokeWidth``, ``detail`` of a line in parts). Two more are ``name``, a series of the
legend, and ``readout``, the words that ``readout.js`` shows where a mark is pointed at.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from solidgear.show.scales import Axis, Shade

#: px; height of letters, and how much of it a letter takes across
LETTER, ACROSS = 12, 0.58
#: px; of paper that ticks take left of a panel
LEFT = 48.0
#: colour of lines and words that belong to no series
INK, GREY, TOLERANCE = "#222222", "#6b6b6b", "#aa2222"
#: shapes of markers by their letters in matplotlib, which records of runs hold
SHAPES = {
    "o": "circle",
    "s": "square",
    "D": "diamond",
    "^": "triangle-up",
    "v": "triangle-down",
    "<": "triangle-left",
    "P": "cross",
    "x": "M-.9,-.9L.9,.9M-.9,.9L.9,-.9",
    "h": "M1,0L.5,.87L-.5,.87L-1,0L-.5,-.87L.5,-.87Z",
    "*": "M0,-1.3L.3,-.4L1.24,-.4L.48,.15L.76,1.05L0,.5L-.76,1.05L-.48,.15L-1.24,-.4L-.3,-.4Z",
}


class Series(NamedTuple):
    """Looks of a series in panels and legend; `shape` is one of Vega."""

    colour: str
    shape: str = "circle"


class Layer(NamedTuple):
    """Marks of one kind, and the rows that they stand for."""

    mark: dict[str, Any]
    rows: list[dict[str, Any]]
    shade: Shade | None = None


class Panel:
    """A pair of axes and what is drawn between them.

    Parameters
    ----------
    height : float
        px.
    series : mapping of str to Series
        By their names in rows.
    legend : dict, optional
        Of the series, with the names of Vega-Lite; none is drawn without it.
    left, right : float
        px of the paper that is taken by what ticks say, and beyond the right end.
    least : float
        px of the paper that it needs to stand beside others.
    upper : Axis, optional
        A second one above, whose ticks stand at places of the first.
    turned : bool
        Whether names below stand at a slant.
    """

    def __init__(
        self,
        x: Axis,
        y: Axis,
        height: float,
        title: str = "",
        *,
        series: Mapping[str, Series] | None = None,
        legend: Mapping[str, Any] | None = None,
        left: float = LEFT,
        right: float = 8.0,
        turned: bool = False,
        least: float = 250.0,
        upper: Axis | None = None,
    ):
        self.x, self.y, self.height, self.title = x, y, height, title
        self.series, self.legend = series or {}, legend
        self.left, self.right, self.least, self.upper = left, right, least, upper
        self.turned = turned
        self.layers: list[Layer] = []

    def draw(
        self,
        mark: str | Mapping[str, Any],
        rows: Iterable[Mapping[str, Any]],
        shade: Shade | None = None,
    ) -> None:
        """Add a layer: a mark with what all of its rows share, and the colours of numbers of its
        rows. Rows with a place that is no number, or none on a logarithmic axis, are left out.
        """
        placed = [dict(row) for row in rows if self._placed(row)]
        if placed:
            mark = {"type": mark} if isinstance(mark, str) else dict(mark)
            self.layers.append(Layer(mark, placed, shade))

    def read(self, rows: Iterable[Mapping[str, Any]], colour: str) -> None:
        """Add places to be read without a mark: along a curve, or in a cell."""
        self.draw({"type": "point", "size": 0, "clip": True, "color": colour}, rows)

    def _placed(self, row: Mapping[str, Any]) -> bool:
        for name, value in row.items():
            if name in ("x", "x2", "y", "y2"):
                axis = self.x if name[0] == "x" else self.y
                if value is None or not math.isfinite(value) or (axis.log and value <= 0):
                    return False
        return True

    @property
    def beside(self) -> float:
        """px of paper left of the panel: what ticks say and the name of the axis."""
        return self.left + 1.5 * LETTER * len(wrapped(self.y.title, self.height))


def curve(x: np.ndarray, y: np.ndarray, **same: Any) -> list[dict[str, Any]]:
    """Return rows of a curve, with the channels that all of its places share.

    Examples
    --------
    >>> curve(np.array([0.0, 1.0]), np.array([2.0, 3.0]), name="beam")
    [{'x': 0.0, 'y': 2.0, 'name': 'beam'}, {'x': 1.0, 'y': 3.0, 'name': 'beam'}]
    """
    return [{"x": a, "y": b, **same} for a, b in zip(x.tolist(), y.tolist())]


def lines_legend(columns: int) -> dict[str, Any]:
    """Return the legend of curves above a panel, in Vega-Lite."""
    return {"orient": "top", "columns": columns, "symbolType": "stroke", "symbolStrokeWidth": 3}


def readout(name: str, *facts: tuple[str, str, str]) -> str:
    """Return the words of a mark: a name, and name, value and unit a line; no line without a
    value.

    Examples
    --------
    >>> readout("beam", ("error", "3 %", ""), ("time", "2", "s"), ("remark", "", ""))
    'beam\\nerror: 3 %\\ntime: 2 s'
    """
    lines = (f"{fact}: {value} {unit}".rstrip() for fact, value, unit in facts if value)
    return "\n".join([name, *lines])


def wrapped(text: str, room: float) -> list[str]:
    """Return a text in lines that fit a room, px.

    Examples
    --------
    >>> wrapped("as long as it is", 70)
    ['as long as', 'it is']
    """
    letters = max(int(room / (ACROSS * LETTER)), 8)
    return [line for part in text.split("\n") for line in textwrap.wrap(part, letters) or [""]]


def read_places(x: Any, y: Any, places: int = 100, log: bool = False) -> list[int]:
    """Return indices of the places of a curve to be read: ends, tops and dips, and some others
    evenly.

    Parameters
    ----------
    x, y : (n,) array_like
        `x` ascending, and above zero where the axis is logarithmic.

    Examples
    --------
    >>> read_places([0, 1, 2, 3, 4, 5, 6, 7, 8], [0, 0, 0, 0, 9, 0, 0, 0, 0], places=2)
    [0, 4, 8]
    """
    along = np.log(x) if log else np.asarray(x, float)
    share = places * (along - along[0]) / (along[-1] - along[0])
    turns = 1 + np.flatnonzero(np.diff(y)[:-1] * np.diff(y)[1:] < 0)
    first = np.unique(share.astype(int), return_index=True)[1]
    return sorted({*turns.tolist(), *first.tolist(), len(along) - 1})


def tolerance_line(panel: Panel, tolerance: float) -> None:
    """Draw the tolerance as a line across a panel, named at its right end."""
    panel.draw({"type": "rule", "color": TOLERANCE, "strokeDash": [5, 3]}, [{"y": tolerance}])
    name = {"type": "text", "color": TOLERANCE, "align": "right", "dy": -7}
    words = f"tolerance {100 * tolerance:.4g} %"
    panel.draw(name, [{"x": panel.x.ends[1], "y": tolerance, "text": words}])
