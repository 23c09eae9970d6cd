"""A panel on paper: its axes, legend and title around the marks, and the room that they take."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from solidgear.show import marks
from solidgear.show.marks import Frame
from solidgear.show.panel import LETTER, Panel, wrapped
from solidgear.show.pen import LEAD, Pen, element, width_of
from solidgear.show.scales import Axis, Shade

#: colours of grid, of ticks with the line along them, and of words
GRID, TICK, WORDS = "#e3e3e3", "#555555", "#000000"
#: px; of a tick, of a tick and the gap to its words, from words to what stands beyond
TICKED, ASIDE, APART = 5.0, 7.0, 5.0
LINE = LETTER + LEAD
#: px; from a title to what stands below it
HEADED = 8.0
#: degrees; of names that stand at a slant below a panel
SLANT = -60.0
#: px; symbols of a legend, and the gap from a column to the next
SYMBOL, STROKE, COLUMN = 10.0, 18.0, 16.0
#: px; of the bar of shades
BAR = 16.0


class Ticked(NamedTuple):
    """A tick: its place from the left or down from the top, px, and its words."""

    place: float
    words: str


@dataclass
class Paper:
    """A panel, the paper left of its axes and the width of what they enclose, px."""

    panel: Panel
    beside: float
    width: float

    @cached_property
    def below(self) -> list[Ticked]:
        """The ticks of the lower axis; words without room are left out."""
        found = self._across(self.panel.x)
        return found if self.panel.turned else _apart(found, lambda t: _half(t.words))

    @cached_property
    def above(self) -> list[Ticked]:
        """The ticks of the upper axis."""
        upper = self.panel.upper
        return _apart(self._across(upper), lambda t: _half(t.words)) if upper else []

    def _across(self, axis: Axis) -> list[Ticked]:
        if not axis.shown:
            return []
        # ticks of an upper axis stand at places of the lower one
        share = self.panel.x.share
        return [Ticked(self.width * share(v), text) for v, text in axis.marks(self.width)]

    @cached_property
    def upright(self) -> list[Ticked]:
        """The ticks of the axis on the left."""
        axis, height = self.panel.y, self.panel.height
        if not axis.shown:
            return []
        places = [Ticked(height * (1 - axis.share(v)), text) for v, text in axis.marks(height)]
        return _apart(places, lambda t: LETTER / 2 + LEAD / 2 * t.words.count("\n"))

    @cached_property
    def legend(self) -> Legend | None:
        """The series or shades that a legend names."""
        panel = self.panel
        shade = next((layer.shade for layer in panel.layers if layer.shade), None)
        if shade is not None and shade.ticks:
            return ShadeLegend("bottom" if panel.upper else "top", shade)
        named = any("name" in row for layer in panel.layers for row in layer.rows)
        return SeriesLegend.of(panel) if panel.legend and named else None

    @cached_property
    def title(self) -> list[str]:
        """The lines of the title."""
        room = self.width + self.beside
        return wrapped(self.panel.title, room) if self.panel.title else []

    @property
    def over(self) -> float:
        """px that stand over the axes."""
        out = 3.0
        if self.above:
            out += ASIDE + LINE + self._lines(self.panel.upper) * LINE + 2.0
        if self.legend and self.legend.side == "top":
            out += self.legend.height + 12.0
        return out + len(self.title) * LINE + HEADED * bool(self.title)

    @property
    def under(self) -> float:
        """px that stand under the axes."""
        out = 0.0
        if self.panel.x.shown:
            out += ASIDE + self._named + self._lines(self.panel.x) * LINE + APART
        if self.legend and self.legend.side == "bottom":
            out += self.legend.height + APART
        return out

    @cached_property
    def _named(self) -> float:
        """px of the words of the lower ticks."""
        texts = [t.words for t in self.below if t.words]
        if not texts:
            return 0.0
        if self.panel.turned:
            return abs(math.sin(math.radians(SLANT))) * max(_wide(t) for t in texts) + LETTER / 2
        return max(t.count("\n") + 1 for t in texts) * LINE

    def _lines(self, axis: Axis | None) -> int:
        return len(wrapped(axis.title, self.width)) if axis and axis.title else 0

    def draw(self, pen: Pen, left: float, top: float) -> None:
        """Draw the panel with the upper left corner of its axes at a place."""
        frame = Frame(self.panel, left, top, self.width)
        self._grid(pen, left, top)
        self._axes(pen, left, top)
        clip = pen.clip(left, top, self.width, self.panel.height)
        for layer in self.panel.layers:
            pen.put(marks.layer(frame, layer, pen, clip))
        y = top - self.over + LINE
        for line in self.title:
            x = left - self.beside + 3
            pen.put(pen.words(x, y, line, font_weight="bold", fill=WORDS))
            y += LINE
        if self.legend and self.legend.side == "top":
            self.legend.draw(pen, left, y - LINE + HEADED * bool(self.title))
        elif self.legend and self.legend.side == "bottom":
            low = top + self.panel.height + self.under - self.legend.height
            self.legend.draw(pen, left, low)
        elif self.legend:
            self.legend.draw(pen, left + self.width + COLUMN, top)

    def _grid(self, pen: Pen, left: float, top: float) -> None:
        lines = []
        if self.panel.x.grid:
            lines += [(left + t.place, top, 0.0, self.panel.height) for t in self.below]
        if self.panel.y.grid:
            lines += [(left, top + t.place, self.width, 0.0) for t in self.upright]
        pen.put(_strokes(lines, GRID))

    def _axes(self, pen: Pen, left: float, top: float) -> None:
        panel, low = self.panel, top + self.panel.height
        if panel.x.shown:
            lines = [(left + t.place, low, 0.0, TICKED) for t in self.below]
            pen.put(_strokes([(left, low, self.width, 0.0), *lines], TICK))
            words = [self._below(pen, left + t.place, low, t.words) for t in self.below]
            pen.put(_group(words))
            y = low + ASIDE + self._named + LETTER
            self._title(pen, panel.x, left, y)
        if panel.upper and self.above:
            lines = [(left + t.place, top, 0.0, -TICKED) for t in self.above]
            pen.put(_strokes([(left, top, self.width, 0.0), *lines], TICK))
            look: dict[str, Any] = {"align": "center", "fill": WORDS}
            texts = [
                pen.words(left + t.place, top - ASIDE - 2, t.words, **look) for t in self.above
            ]
            pen.put(_group(texts))
            lines_above = self._lines(panel.upper) - 1
            self._title(pen, panel.upper, left, top - ASIDE - LINE - 4 - LINE * lines_above)
        if panel.y.shown:
            lines = [(left, top + t.place, -TICKED, 0.0) for t in self.upright]
            pen.put(_strokes([(left, top, 0.0, panel.height), *lines], TICK))
            how: dict[str, Any] = {"align": "right", "baseline": "middle", "fill": WORDS}
            texts = [pen.words(left - ASIDE, top + t.place, t.words, **how) for t in self.upright]
            pen.put(_group(texts))
            title = wrapped(panel.y.title, panel.height) if panel.y.title else []
            # the last of its lines stands nearest
            x = left - self.beside + 1.5 * LETTER * len(title) - APART - LINE * (len(title) - 1)
            turned: dict[str, Any] = {"align": "center", "turn": -90.0, "fill": WORDS}
            middle = top + panel.height / 2
            if title:
                pen.put(_group([pen.words(x, middle, "\n".join(title), **turned)]))

    def _below(self, pen: Pen, x: float, low: float, words: str) -> str:
        if self.panel.turned:
            look: dict[str, Any] = {"align": "right", "baseline": "middle", "turn": SLANT}
            return pen.words(x, low + ASIDE, words, **look, fill=WORDS)
        return pen.words(x, low + ASIDE, words, align="center", baseline="top", fill=WORDS)

    def _title(self, pen: Pen, axis: Axis, left: float, y: float) -> None:
        if axis.title:
            text = "\n".join(wrapped(axis.title, self.width))
            middle = left + self.width / 2
            pen.put(_group([pen.words(middle, y, text, align="center", fill=WORDS)]))


def _strokes(lines: Iterable[tuple[float, float, float, float]], colour: str) -> str:
    """Return straight lines, each of a place and a way (px), as one element."""
    ways = "".join(
        f"M{x:.1f},{y:.1f}" + (f"h{a:.1f}" if a else f"v{b:.1f}") for x, y, a, b in lines
    )
    return element("path", d=ways, stroke=colour, aria_hidden="true") if ways else ""


def _group(drawn: Sequence[str]) -> str:
    return element("g", "".join(drawn), aria_hidden="true")


def _wide(text: str) -> float:
    return width_of(text, LETTER)


def _half(text: str) -> float:
    return _wide(text) / 2 + 2.0


def _apart(ticks: list[Ticked], half) -> list[Ticked]:
    """Return ticks of which no words overlap: of those in the way of the one before, none says
    anything.
    """
    out, end = [], -math.inf
    for tick in sorted(ticks):
        words = tick.words
        if words and tick.place - half(tick) < end:
            words = ""
        if words:
            end = tick.place + half(tick)
        out.append(Ticked(tick.place, words))
    return out


class Legend:
    """What the looks of marks mean."""

    side: str
    height: float

    def draw(self, pen: Pen, left: float, top: float) -> None:
        """Draw it with its upper left corner at a place."""
        raise NotImplementedError


@dataclass
class ShadeLegend(Legend):
    """A bar of colours with numbers below it."""

    side: str
    shade: Shade
    height: float = 2 * LINE + BAR + 6.0

    def draw(self, pen: Pen, left: float, top: float) -> None:
        """Draw the bar, its title above and its numbers below."""
        shade = self.shade
        stops = "".join(
            element("stop", offset=k / (len(shade.colours) - 1), stop_color=colour)
            for k, colour in enumerate(shade.colours)
        )
        fill = pen.define("linearGradient", stops)
        title = pen.words(left, top + LETTER, shade.title, fill=WORDS)
        bar: dict[str, Any] = {"x": left, "y": top + LINE + 3, "width": shade.length, "height": BAR}
        drawn = [title, element("rect", **bar, fill=fill)]
        low, high = shade.ends
        for value, words in (shade.ticks or {}).items():
            share = math.log(value / low) / math.log(high / low)
            align = "left" if share < 0.01 else "right" if share > 0.99 else "center"
            x, y = left + share * shade.length, top + LINE + BAR + 6 + LETTER
            drawn.append(pen.words(x, y, words, align=align, fill=WORDS))
        pen.put(_group(drawn))


@dataclass
class SeriesLegend(Legend):
    """The series of a panel in columns, each behind its symbol."""

    side: str
    #: rows of series, and by series its symbol
    panel: Panel
    columns: int
    symbol: str

    @classmethod
    def of(cls, panel: Panel) -> SeriesLegend:
        """Return the legend of a panel that has one."""
        look, kinds = panel.legend or {}, set()
        for layer in panel.layers:
            if any("name" in row for row in layer.rows):
                kinds.add(layer.mark["type"])
        surfaces = "square" if kinds & {"rect", "area"} else "stroke"
        symbol = look.get("symbolType", "shape" if "point" in kinds else surfaces)
        side = look.get("orient", "right")
        columns = 1 if side == "right" else look.get("columns", len(panel.series))
        return cls(side, panel, max(1, columns), symbol)

    @property
    def rows(self) -> list[list[str]]:
        """The names of series by rows."""
        names = list(self.panel.series)
        return [names[k : k + self.columns] for k in range(0, len(names), self.columns)]

    @property
    def height(self) -> float:  # type: ignore[override]
        """px of all rows."""
        return (LINE + 2) * len(self.rows)

    def draw(self, pen: Pen, left: float, top: float) -> None:
        """Draw symbols and names."""
        rows, drawn = self.rows, []
        handle = STROKE if self.symbol == "stroke" else SYMBOL
        places = [left]
        for k in range(max(map(len, rows))):
            widest = max(_wide(row[k]) for row in rows if k < len(row))
            places.append(places[-1] + handle + 5 + widest + COLUMN)
        for i, row in enumerate(rows):
            y = top + (LINE + 2) * i + LINE / 2
            for x, name in zip(places, row):
                drawn.append(self._symbol(name, x, y, handle))
                drawn.append(pen.words(x + handle + 5, y, name, baseline="middle", fill=WORDS))
        pen.put(_group(drawn))

    def _symbol(self, name: str, x: float, y: float, handle: float) -> str:
        look = self.panel.series[name]
        if self.symbol == "stroke":
            wide = (self.panel.legend or {}).get("symbolStrokeWidth", 1.5)
            ends: dict[str, Any] = {"x1": x, "x2": x + handle, "y1": y, "y2": y}
            return element("line", **ends, stroke=look.colour, stroke_width=wide)
        shape = look.shape if self.symbol == "shape" else self.symbol
        size = handle**2
        return marks.symbol(x + handle / 2, y, shape, size, fill=look.colour, stroke=look.colour)
