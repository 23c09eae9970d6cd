"""Charts drawn by vl-convert from panels in Vega-Lite: for a page, and as files.

One description becomes the SVG of a page, in a wide and in a narrow layout, and the PNG or SVG of a
file. ``style.html`` turns the colours of a page in the dark; ``readout.js`` reads its marks.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from solidgear.core import SolidgearError, whole
from solidgear.show.panel import LETTER, Panel, wrapped

#: px; across a page, and across a phone that is 390 px wide
WIDE, NARROW = 1000.0, 362.0
#: px; between two panels
BETWEEN = 26.0
#: pixels of a PNG in one of a chart
FINENESS = 1.5
CONFIG: dict[str, Any] = {
    "font": "DejaVu Sans, Arial, Helvetica, sans-serif",
    "mark": {"opacity": 1.0},
    "axis": {
        "aria": False,
        "labelFontSize": LETTER,
        "titleFontSize": LETTER,
        "titleFontWeight": "normal",
        "gridColor": "#e3e3e3",
        "domainColor": "#555555",
        "tickColor": "#555555",
        "labelFlush": False,
        "labelLimit": 0,
        "titleLimit": 0,
    },
    "legend": {
        "aria": False,
        "title": None,
        "labelFontSize": LETTER,
        "titleFontSize": LETTER,
        "titleFontWeight": "normal",
        "labelLimit": 0,
        "symbolLimit": 0,
    },
    "title": {"aria": False, "fontSize": LETTER, "fontWeight": "bold", "anchor": "start"},
    "text": {"fontSize": LETTER - 1, "lineBreak": "\n"},
    "view": {"stroke": None},
    "concat": {"spacing": BETWEEN},
}
#: looks of one panel are none of another's
SEPARATE: dict[str, Any] = {"scale": dict.fromkeys(("color", "fill", "shape"), "independent")}
FORMATS = (".png", ".svg")


@dataclass
class Chart:
    """Panels beside and below one another.

    Parameters
    ----------
    rows : list of list of Panel
        Those that stand beside one another where there is room.
    width : float
        px, of all of it.
    title, foot : str
        Above and below the panels.

    Examples
    --------
    >>> from solidgear.show.panel import Axis, readout
    >>> panel = Panel(Axis("length, mm", (0, 2)), Axis("error", (1e-3, 1), log=True), 200)
    >>> panel.draw("point", [{"x": 1, "y": 0.1, "readout": readout("beam", ("error", "10", "%"))}])
    >>> 'aria-label="beam&#xA;error: 10 %"' in Chart([[panel]]).svg()
    True
    """

    rows: list[list[Panel]]
    width: float = WIDE
    title: str = ""
    foot: str = ""

    def spec(self) -> dict[str, Any]:
        """Return the chart in Vega-Lite."""
        rows = [
            part
            for row in self.rows
            for part in in_columns(row, max(1, int(self.width / row[0].least)))
        ]
        beside = max(panel.beside for row in rows for panel in row)
        drawn = [self._row(row, beside) for row in rows]
        out: dict[str, Any] = {"vconcat": drawn, "resolve": SEPARATE}
        if self.title:
            out["title"] = {"text": wrapped(self.title, self.width), "fontSize": LETTER + 1}
        if self.foot:
            foot: dict[str, Any] = {"text": wrapped(self.foot, self.width), "orient": "bottom"}
            foot |= {"fontWeight": "normal", "fontSize": LETTER - 1}
            out = {"vconcat": [out], "title": foot, "resolve": SEPARATE}
        return {"background": None, "config": CONFIG, "padding": 3, **out}

    def _row(self, row: list[Panel], beside: float) -> dict[str, Any]:
        width = (self.width - BETWEEN * (len(row) - 1)) / len(row)
        panels = [panel.spec(beside, width - beside - panel.right) for panel in row]
        return {"hconcat": panels, "resolve": SEPARATE}

    def svg(self, name: str = "part-") -> str:
        """Return the chart as an SVG, without a ground; identifiers in it begin with a name."""
        return _compact(_drawing_library().vegalite_to_svg(self.spec()), name)

    def write(self, file: Path, *beside: Path) -> Path:
        """Write a picture, drawn once for all its files, ``.png`` or ``.svg`` by their endings."""
        library = _drawing_library()
        endings = {path: check_ending(path) for path in (file, *beside)}
        svg = library.vegalite_to_svg({**self.spec(), "background": "#ffffff", "padding": 12})
        for path, ending in endings.items():
            if ending == ".png":
                data = library.svg_to_png(svg, scale=FINENESS)
            else:
                data = _compact(svg, "part-").encode()
            try:
                with whole(path) as half:
                    half.write_bytes(data)
            except OSError as error:
                raise SolidgearError(
                    f"{path}: cannot be written ({error.strerror or error})"
                ) from error
        return file


def in_columns(panels: Sequence[Panel], columns: int) -> list[list[Panel]]:
    """Split panels into rows."""
    return [list(panels[k : k + columns]) for k in range(0, len(panels), columns)]


def _compact(svg: str, name: str) -> str:
    """Return an SVG without invisible parts, coordinates to 0.01 px and identifiers under a name."""
    names: dict[str, str] = {}

    def tag(match: re.Match[str]) -> str:
        text = match[0]
        if text.startswith(('<path class="background"', '<path class="foreground"')):
            return ""
        text = re.sub(r' (?:aria-roledescription|role|opacity)="(?:[a-z -]*|1)"', "", text)
        # a label of what has no role is read by nobody
        text = re.sub(r' aria-label="[^"]*"', r'\g<0> role="img"', text)
        text = re.sub(r'(?<= id=")[^"]+|(?<="url\(#)[^)]+', number, text)
        return re.sub(r' (?:d|transform)="[^"]*"', short, text)

    def number(match: re.Match[str]) -> str:
        return names.setdefault(match[0], f"{name}{len(names)}")

    def short(match: re.Match[str]) -> str:
        return re.sub(r"(\.\d\d)\d+", r"\1", match[0])

    return re.sub(r"<[a-z][^>]*>", tag, svg)


def check_ending(file: Path, formats: Sequence[str] = FORMATS) -> str:
    """Return the ending of a picture's name.

    Raises
    ------
    SolidgearError
        For one that is no picture.

    Examples
    --------
    >>> check_ending(Path("error.PNG"))
    '.png'
    """
    ending = file.suffix.lower()
    if ending not in formats:
        raise SolidgearError(f"{file}: give a picture a name that ends in {' or '.join(formats)}")
    return ending


@cache
def _drawing_library() -> Any:
    """Return vl-convert with matplotlib's fonts, which are the same on every machine."""
    import vl_convert

    spec = find_spec("matplotlib")
    for folder in (spec and spec.submodule_search_locations) or ():
        vl_convert.register_font_directory(f"{folder}/mpl-data/fonts/ttf")
    return vl_convert


#: from the width of a page to a chart on it, None where there is nothing to draw
Make = Callable[[float], "Chart | None"]


def page_svg(name: str, make: Make) -> bytes | None:
    """Return a chart for a page, wide and for a phone; ``style.html`` shows one of them."""
    drawings = []
    for kind, width in (("wide", WIDE), ("narrow", NARROW)):
        chart = make(width)
        if chart is None:
            return None
        svg = chart.svg(f"{name}-{kind}-")
        drawings.append(svg.replace('class="marks"', f'class="{kind}"', 1))
    return "".join(drawings).encode()
