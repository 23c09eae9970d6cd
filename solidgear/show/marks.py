"""Marks of a panel as elements of an SVG, in places of the paper."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from solidgear.show.panel import INK, LETTER, Layer, Panel
from solidgear.show.pen import Pen, element, path, short

#: of a mark that is given none, and the widths of its lines
COLOUR = "#4c78a8"
WIDTHS = {"rule": 1.0, "line": 2.0, "point": 2.0, "area": 0.0, "rect": 0.0}
#: area of a point, px^2
SIZE = 30.0
Row = Mapping[str, Any]


@dataclass
class Frame:
    """Paper of a panel: where its upper left corner is and how large it is, px."""

    panel: Panel
    left: float
    top: float
    width: float

    def x(self, value: float) -> float:
        """Return the place of a number across the paper."""
        return self.left + self.width * self.panel.x.share(value)

    def y(self, value: float) -> float:
        """Return the place of a number down the paper."""
        return self.top + self.panel.height * (1 - self.panel.y.share(value))

    def ends(self, row: Row) -> tuple[float, float, float, float]:
        """Return x, x2, y, y2 of a row; without a place it goes from end to end."""
        x = self.x(row["x"]) if "x" in row else self.left
        y = self.y(row["y"]) if "y" in row else self.top + self.panel.height
        x2 = self.x(row["x2"]) if "x2" in row else x if "x" in row else self.left + self.width
        y2 = self.y(row["y2"]) if "y2" in row else y if "y" in row else self.top
        return x, x2, y, y2

    def upright(self, row: Row) -> tuple[float, float, float, float]:
        """Return the ends of a line: of one with a place across and none down, the whole height."""
        x, x2, y, y2 = self.ends(row)
        if "x2" in row and "y" not in row:
            y, y2 = self.top, self.top
        return x, x2, y, y2


def layer(frame: Frame, marks: Layer, pen: Pen, clip: str) -> str:
    """Return the marks of a layer in one group; `clip` keeps lines and surfaces on the paper."""
    kind = marks.mark["type"]
    drawn = "".join(DRAWN[kind](frame, marks, pen))
    clipped = marks.mark.get("clip", kind not in ("text", "point"))
    read = any("readout" in row for row in marks.rows)
    hidden = None if read else "true"
    return element("g", drawn, clip_path=clip if clipped else None, aria_hidden=hidden)


def colour_of(frame: Frame, marks: Layer, row: Row) -> str:
    """Return the colour of a mark: of its number, its series, or of all."""
    if marks.shade and "fill" not in marks.mark and marks.shade.key in row:
        return marks.shade.colour(row[marks.shade.key])
    if "name" in row and "color" not in marks.mark:
        return frame.panel.series[row["name"]].colour
    plain = INK if marks.mark["type"] in ("text", "rule") else COLOUR
    return marks.mark.get("color", plain)


def _label(row: Row) -> dict[str, Any]:
    words = row.get("readout")
    return {"aria_label": words, "role": "img"} if words else {}


def _line_looks(marks: Layer, row: Row, colour: str | None) -> dict[str, Any]:
    mark = marks.mark
    width = row.get("strokeWidth", mark.get("strokeWidth", WIDTHS[mark["type"]]))
    if not width or colour is None:
        return {}
    dash = mark.get("strokeDash") or (1, 0)
    return {
        "stroke": colour,
        "stroke_width": width,
        "stroke_dasharray": ",".join(map(short, dash)) if dash[1] else None,
        "stroke_linecap": mark.get("strokeCap"),
    }


def _opacity(marks: Layer) -> float | None:
    value = marks.mark.get("opacity", 1.0)
    return None if value == 1.0 else value


def _rules(frame: Frame, marks: Layer, pen: Pen) -> Iterator[str]:
    for row in marks.rows:
        x, x2, y, y2 = frame.upright(row)
        looks = _line_looks(marks, row, colour_of(frame, marks, row))
        ends: dict[str, Any] = {"x1": x, "y1": y, "x2": x2, "y2": y2}
        yield element("line", **_label(row), **ends, **looks, opacity=_opacity(marks))


def _rects(frame: Frame, marks: Layer, pen: Pen) -> Iterator[str]:
    for row in marks.rows:
        x, x2, y, y2 = frame.ends(row)
        corners = path([(x, y), (x2, y), (x2, y2), (x, y2)], closed=True)
        looks = _line_looks(marks, row, marks.mark.get("stroke"))
        fill = row.get("fill") or colour_of(frame, marks, row)
        how: dict[str, Any] = {"fill": fill, **looks, "opacity": _opacity(marks)}
        yield element("path", **_label(row), d=corners, **how)


def _parts(rows: list[dict[str, Any]]) -> list[list[dict[str, Any]]]:
    """Return the rows of every line: of one name, and one part of it."""
    parts: dict[tuple, list[dict[str, Any]]] = {}
    for row in rows:
        parts.setdefault((row.get("name"), row.get("detail")), []).append(row)
    return list(parts.values())


def _lines(frame: Frame, marks: Layer, pen: Pen) -> Iterator[str]:
    mark, way = marks.mark, marks.mark.get("interpolate", "")
    for rows in _parts(marks.rows):
        points = [(frame.x(row["x"]), frame.y(row["y"])) for row in rows]
        dots = mark.get("point")
        colour = colour_of(frame, marks, rows[0])
        if way == "step-after":
            corners = [(b[0], a[1]) for a, b in zip(points, points[1:])]
            steps = [place for pair in zip(points, corners) for place in pair]
            points = [*steps, points[-1]]
        fill = mark.get("fill")
        if marks.shade and "fill" not in mark:
            fill, colour = colour, mark.get("stroke", colour)
        looks = _line_looks(marks, rows[0], mark.get("stroke", colour))
        drawn = path(points, closed=way == "linear-closed")
        yield element("path", d=drawn, fill=fill, **looks, opacity=_opacity(marks))
        if dots:
            for x, y in points:
                yield symbol(x, y, "circle", dots["size"], fill=colour)


def _areas(frame: Frame, marks: Layer, pen: Pen) -> Iterator[str]:
    for rows in _parts(marks.rows):
        low = [(frame.x(row["x"]), frame.y(row["y"])) for row in rows]
        high = [(frame.x(row["x"]), frame.y(row["y2"])) for row in reversed(rows)]
        around = path([*low, *high], closed=True)
        fill = colour_of(frame, marks, rows[0])
        yield element("path", d=around, fill=fill, opacity=_opacity(marks))


def _points(frame: Frame, marks: Layer, pen: Pen) -> Iterator[str]:
    mark = marks.mark
    for row in marks.rows:
        colour = colour_of(frame, marks, row)
        fill = row.get("fill", mark.get("fill", colour if mark.get("filled") else None))
        stroke = mark.get("stroke", None if fill else colour)
        shape = mark.get("shape", "circle")
        if "name" in row and "shape" not in mark:
            shape = frame.panel.series[row["name"]].shape
        x, y = frame.x(row["x"]), frame.y(row["y"]) + mark.get("yOffset", 0.0)
        size, looks = mark.get("size", SIZE), _line_looks(marks, row, stroke)
        yield symbol(x, y, shape, size, mark.get("angle", 0), **_label(row), fill=fill, **looks)


def symbol(x: float, y: float, shape: str, size: float, turn: float = 0.0, **looks: Any) -> str:
    """Return a point of a shape and size at a place."""
    move = f"translate({short(x)},{short(y)})" + (f" rotate({short(turn)})" if turn else "")
    named = {key: looks.pop(key) for key in ("aria_label", "role") if key in looks}
    return element("path", **named, d=outline(shape, size), **looks, transform=move)


def outline(shape: str, size: float) -> str:
    """Return the outline of a shape of Vega about its middle, as large as its size says, px^2."""
    r = math.sqrt(size) / 2
    high = math.sqrt(3) / 2 * r
    if shape == "circle":
        radius = short(r)
        half = f"A{radius},{radius},0,1,1,"
        return f"M{radius},0{half}{short(-r)},0{half}{radius},0"
    outlines: dict[str, Callable[[], list[tuple[float, float]]]] = {
        "square": lambda: [(-r, -r), (r, -r), (r, r), (-r, r)],
        "diamond": lambda: [(-r, 0), (0, -r), (r, 0), (0, r)],
        "triangle-up": lambda: [(0, -high), (-r, high), (r, high)],
        "triangle-down": lambda: [(0, high), (-r, -high), (r, -high)],
        "triangle-left": lambda: [(-high, 0), (high, -r), (high, r)],
        "cross": lambda: _cross(r, r / 2.5),
    }
    if shape in outlines:
        return path(outlines[shape](), closed=True)
    if shape == "stroke":
        return path([(-r, 0), (r, 0)])
    return re.sub(r"-?[\d.]+", lambda match: short(r * float(match[0])), shape)


def _cross(r: float, s: float) -> list[tuple[float, float]]:
    quarter = [(-r, -s), (-s, -s), (-s, -r), (s, -r), (s, -s), (r, -s)]
    return [*quarter, *((-x, -y) for x, y in quarter)]


def _texts(frame: Frame, marks: Layer, pen: Pen) -> Iterator[str]:
    mark = marks.mark
    for row in marks.rows:
        yield pen.words(
            frame.x(row["x"]),
            frame.y(row["y"]),
            str(row["text"]),
            align=mark.get("align", "center"),
            baseline=mark.get("baseline", "first"),
            size=mark.get("fontSize", LETTER - 1),
            turn=mark.get("angle", 0.0),
            shift=(mark.get("dx", 0.0), mark.get("dy", 0.0)),
            font_weight=mark.get("fontWeight"),
            fill=colour_of(frame, marks, row),
            opacity=_opacity(marks),
        )


DRAWN: dict[str, Callable[[Frame, Layer, Pen], Iterator[str]]] = {
    "rule": _rules,
    "rect": _rects,
    "line": _lines,
    "area": _areas,
    "point": _points,
    "text": _texts,
}
