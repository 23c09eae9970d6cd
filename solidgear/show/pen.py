"""Drawings in SVG: shapes and words in absolute places, and how much room words take."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

FONT = "DejaVu Sans, Arial, Helvetica, sans-serif"
#: widths of letters in DejaVu Sans, shares of their height; of any other letter
WIDTHS = {
    **dict.fromkeys("iljI|'.,:;!", 0.32),
    **dict.fromkeys('ftr()[]/-" ', 0.4),
    **dict.fromkeys("mwMW%@–…", 0.93),
}
WIDTH = 0.62
#: px; from one line of letters to the next, above the height of the letters
LEAD = 2.0
#: where the place of words is, up from the foot of their letters, share of the height: of the first
#: of several lines, but of ``middle`` and ``bottom`` of all
BASELINES = {"top": 0.79, "middle": 0.3, "first": 0.3, "bottom": -0.21, "alphabetic": 0.0}
ANCHORS = {"left": "start", "center": "middle", "right": "end"}
ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#xA;"})
#: characters that no SVG may hold
UNFIT = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def escaped(text: str) -> str:
    """Return a text as it stands in an SVG; without characters that none may hold."""
    return UNFIT.sub("\ufffd", text).translate(ESCAPES)


def short(value: float) -> str:
    """Return a coordinate to a hundredth.

    Examples
    --------
    >>> short(2.0), short(1.239), short(-0.001)
    ('2', '1.24', '0')
    """
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def path(points: Sequence[tuple[float, float]], closed: bool = False) -> str:
    """Return a line through points as an SVG tells it."""
    places = [f"{short(x)},{short(y)}" for x, y in points]
    return "M" + "L".join(places) + "Z" * closed


def element(tag: str, inside: str | None = None, **looks: Any) -> str:
    """Return an element of an SVG; looks that are None are left out.

    Examples
    --------
    >>> element("line", x1=0.0, x2=2.5, stroke_width=1, fill=None)
    '<line x1="0" x2="2.5" stroke-width="1"/>'
    """
    parts = []
    for name, value in looks.items():
        if value is None:
            continue
        text = escaped(value) if isinstance(value, str) else short(value)
        parts.append(f' {name.replace("_", "-")}="{text}"')
    return f"<{tag}{''.join(parts)}" + ("/>" if inside is None else f">{inside}</{tag}>")


def width_of(text: str, size: float) -> float:
    """Return the width of the longest line of a text, about as wide as its letters are drawn."""
    lines = text.split("\n")
    return size * max(sum(WIDTHS.get(letter, WIDTH) for letter in line) for line in lines)


class Pen:
    """Elements of a drawing, in the order of their layers and in which they came.

    Parameters
    ----------
    name : str
        Identifiers in the drawing begin with it.
    size : float
        Height of letters.
    """

    def __init__(self, name: str, size: float):
        self.name, self.size = name, size
        self.left, self.right = math.inf, -math.inf  #: of words that were drawn
        self._elements: list[tuple[float, str]] = []
        self._definitions: list[str] = []

    def put(self, drawn: str, layer: float = 0.0) -> None:
        """Add an element over those of lower layers."""
        self._elements.append((layer, drawn))

    def define(self, tag: str, inside: str, **looks: Any) -> str:
        """Add a definition and return how an element refers to it."""
        identifier = f"{self.name}{len(self._definitions)}"
        self._definitions.append(element(tag, inside, id=identifier, **looks))
        return f"url(#{identifier})"

    def clip(self, x: float, y: float, width: float, height: float) -> str:
        """Return what keeps drawing within a rectangle."""
        return self.define("clipPath", element("rect", x=x, y=y, width=width, height=height))

    def words(
        self,
        x: float,
        y: float,
        text: str,
        *,
        align: str = "left",
        baseline: str = "alphabetic",
        size: float | None = None,
        turn: float = 0.0,
        shift: tuple[float, float] = (0.0, 0.0),
        lead: float = LEAD,
        **looks: Any,
    ) -> str:
        """Return words at a place, turned about it by degrees and shifted after that."""
        height = size or self.size
        lines = text.split("\n")
        above = (len(lines) - 1) * (height + lead)
        down = BASELINES[baseline] * height
        down -= above * {"bottom": 1.0, "middle": 0.5}.get(baseline, 0.0)
        along, across = shift[0], shift[1] + down
        if turn:
            move = f"translate({short(x)},{short(y)}) rotate({short(turn)})"
            place: dict[str, Any] = {"transform": move, "x": along, "y": across}
        else:
            place = {"x": x + along, "y": y + across}
            self._reach(x + along, align, width_of(text, height))
        inside = escaped(lines[0])
        if len(lines) > 1:
            spans = [element("tspan", escaped(lines[0]))]
            for line in lines[1:]:
                spans.append(element("tspan", escaped(line), x=place["x"], dy=height + lead))
            inside = "".join(spans)
        anchor = None if align == "left" else ANCHORS[align]
        own = None if height == self.size else height
        return element("text", inside, **place, text_anchor=anchor, font_size=own, **looks)

    def _reach(self, x: float, align: str, width: float) -> None:
        share = {"left": 0.0, "center": 0.5, "right": 1.0}[align]
        self.left = min(self.left, x - share * width)
        self.right = max(self.right, x + (1 - share) * width)

    def svg(self, kind: str, left: float, right: float, height: float, ground: str = "") -> str:
        """Return the drawing, of a class of a page's style and on a ground, if any."""
        order = sorted(range(len(self._elements)), key=lambda k: self._elements[k][0])
        width = right - left
        definitions = element("defs", "".join(self._definitions)) if self._definitions else ""
        box = f"{short(left)} 0 {short(width)} {short(height)}"
        behind = ""
        if ground:
            behind = element("rect", x=left, y=0.0, width=width, height=height, fill=ground)
        return element(
            "svg",
            definitions + behind + "".join(self._elements[k][1] for k in order),
            xmlns="http://www.w3.org/2000/svg",
            **{"class": kind},
            width=width,
            height=height,
            viewBox=box,
            font_family=FONT,
            font_size=self.size,
            fill="none",
        )
