"""Panels of charts: pairs of axes, and layers of marks over rows of data, described in Vega-Lite.

Keys of a row are channels of Vega-Lite (``x``, ``y``, ``text``, ``fill`` ...), and two more: ``name``,
a series of the legend, and ``readout``, the words that ``readout.js`` shows where a mark is pointed at.
"""

from __future__ import annotations

import json
import math
import textwrap
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

#: px; height of letters, and how much of it a letter takes across
LETTER, ACROSS = 12, 0.58
#: px; of what ticks say left of a panel
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
#: what ticks say, as expressions of Vega
NUMBER, PERCENT = "format(datum.value, '~g')", "format(100 * datum.value, '~g') + ' %'"
COUNT = "format(datum.value, '~s')"
#: channels whose values in rows are looks themselves
LOOKS = ("fill", "strokeWidth")
#: of names below a panel that stand at a slant
TURNED = {"labelAngle": -60, "labelAlign": "right", "labelOverlap": False}


class Axis(NamedTuple):
    """One axis of a panel."""

    title: str
    ends: tuple[float, float]  #: from left to right, or from the foot up
    log: bool = False
    label: str = NUMBER  #: what a tick says, as an expression of Vega
    ticks: Mapping[float, str] | None = None  #: where they stand and what they say instead
    grid: bool = True
    shown: bool = True  #: of one that is not shown only the ends count

    def channel(self, room: float, more: Mapping[str, Any]) -> dict[str, Any]:
        """Return the axis in Vega-Lite, its title in lines that fit a room (px)."""
        kind = {"type": "log"} if self.log else {"zero": False}
        scale = {**kind, "domain": sorted(self.ends), "nice": False}
        scale["reverse"] = bool(self.ends[0] > self.ends[1])
        if not self.shown:
            return {"type": "quantitative", "scale": scale, "axis": None}
        axis: dict[str, Any] = {"title": wrapped(self.title, room), "grid": self.grid, **more}
        if self.ticks is not None:
            places, names = list(self.ticks), [text.split("\n") for text in self.ticks.values()]
            axis["values"] = places
            axis["labelExpr"] = f"{json.dumps(names)}[indexof({json.dumps(places)}, datum.value)]"
        else:
            axis["labelExpr"] = self.label
            if self.log:
                axis["values"] = log_ticks(*sorted(self.ends))
            else:
                axis["tickCount"] = max(3, int(room / 75))
        return {"type": "quantitative", "scale": scale, "axis": axis}


def log_ticks(low: float, high: float) -> list[float]:
    """Return powers of ten between two ends, with their doubles and fives where these are few.

    Examples
    --------
    >>> log_ticks(0.05, 300)
    [0.1, 1.0, 10.0, 100.0]
    >>> log_ticks(3, 60)
    [5.0, 10.0, 20.0, 50.0]
    >>> log_ticks(2, 5.5)
    [2.0, 3.0, 4.0, 5.0]
    """
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    span = math.log10(high / low)
    steps = (1, 1.5, 2, 3, 4, 5, 7) if span < 0.7 else (1, 2, 5) if span < 2.4 else (1,)
    places = (float(f"{step}e{k}") for k in decades for step in steps)
    return [place for place in places if low <= place <= high]


class Series(NamedTuple):
    """Looks of a series in panels and legend; `shape` is one of Vega."""

    colour: str
    shape: str = "circle"


class Panel:
    """A pair of axes and what is drawn between them.

    Parameters
    ----------
    height : float
        px.
    series : mapping of str to Series
        By their names in rows.
    legend : dict, optional
        Of the series, in Vega-Lite; none is drawn without it.
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
        self.below = TURNED if turned else {"labelOverlap": True}
        self.layers: list[tuple[Any, list[dict[str, Any]], dict[str, Any]]] = []

    def draw(
        self, mark: str | Mapping[str, Any], rows: Iterable[Mapping[str, Any]], **encoding: Any
    ) -> None:
        """Add a layer: a mark of Vega-Lite with what all of its rows share, and channels besides
        those of the rows. Rows with a place that is no number, or none on a logarithmic axis, are
        left out.
        """
        placed = [dict(row) for row in rows if self._placed(row)]
        if placed:
            mark = {"type": mark} if isinstance(mark, str) else dict(mark)
            self.layers.append((mark, placed, encoding))

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

    def spec(self, beside: float, width: float) -> dict[str, Any]:
        """Return the panel in Vega-Lite, with axes `width` wide and `beside` from the left, px."""
        extent = beside - 1.5 * LETTER * len(wrapped(self.y.title, self.height))
        places = {
            "x": self.x.channel(width, self.below),
            "y": self.y.channel(self.height, {"minExtent": extent, "maxExtent": extent}),
        }
        layers = [self._layer(*layer, places) for layer in self.layers]
        out: dict[str, Any] = {"width": width, "height": self.height, "layer": layers}
        if self.title:
            out["title"] = wrapped(self.title, width)
        if self.upper:
            self._add_upper(self.upper, layers, places["x"], width)
            out["resolve"] = {"axis": {"x": "independent"}}
        return out

    def _add_upper(self, upper: Axis, layers: list, below: dict[str, Any], width: float) -> None:
        """Add an axis above, and leave the one below to a single layer."""
        places = [
            layer["encoding"]["x"] for layer in layers if "field" in layer["encoding"].get("x", {})
        ]
        for place in places[1:]:
            place["axis"] = None
        above = upper.channel(width, {"orient": "top", "labelOverlap": True})["axis"]
        mark = {"type": "point", "size": 0, "aria": False}
        rows = {"values": [{"x": self.x.ends[0]}]}
        encoding = {"x": {**below, "field": "x", "axis": above}}
        layers.append({"data": rows, "mark": mark, "encoding": encoding})

    def _layer(self, mark, rows, encoding, places) -> dict[str, Any]:
        channels: dict[str, Any] = {}
        for key in dict.fromkeys(key for row in rows for key in row):
            if key in places:
                channels[key] = {"field": key, **places[key]}
            elif key == "readout":
                channels["description"] = {"field": key, "type": "nominal"}
            elif key == "name":
                channels |= self._looks(mark["type"])
            elif key in ("x2", "y2"):
                channels[key] = {"field": key}
            elif key in ("text", "detail"):
                channels[key] = {"field": key, "type": "nominal"}
            elif key in LOOKS:
                channels[key] = {"field": key, "type": "nominal", "scale": None}
        if mark["type"] == "line":
            for k, row in enumerate(rows):
                row["order"] = k
            channels["order"] = {"field": "order", "type": "quantitative"}
        mark = {"clip": mark["type"] not in ("text", "point"), **mark}
        mark["aria"] = "description" in channels
        return {"data": {"values": rows}, "mark": mark, "encoding": {**channels, **encoding}}

    def _looks(self, mark: str) -> dict[str, Any]:
        """Return the channels that distinguish series."""
        looks = self.series.values()
        ranges = {"color": [look.colour for look in looks]}
        if mark == "point":
            ranges["shape"] = [look.shape for look in looks]
        return {
            channel: {
                "field": "name",
                "type": "nominal",
                "scale": {"domain": list(self.series), "range": values},
                "legend": self.legend,
            }
            for channel, values in ranges.items()
        }


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
    panel.draw(name, [{"y": tolerance, "text": words}], x={"value": "width"})
