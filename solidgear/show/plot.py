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

from solidgear.core.errors import SolidgearError
from solidgear.core.machine.whole_file import whole
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
        """The chart in Vega-Lite."""
        rows = [part for row in self.rows for part in _parts(row, self.width)]
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
        one = (self.width - BETWEEN * (len(row) - 1)) / len(row)
        panels = [panel.spec(beside, one - beside - panel.right) for panel in row]
        return {"hconcat": panels, "resolve": SEPARATE}

    def svg(self, name: str = "part-") -> str:
        """The chart as an SVG, without a ground; identifiers in it begin with a name."""
        return _compact(_drawing_library().vegalite_to_svg(self.spec()), name)

    def write(self, file: Path, *beside: Path) -> Path:
        """Write a picture, drawn once for all files it goes to, as their endings say: ``.png`` or
        ``.svg``.
        """
        library = _drawing_library()
        endings = {one: check_ending(one) for one in (file, *beside)}
        svg = library.vegalite_to_svg({**self.spec(), "background": "#ffffff", "padding": 12})
        for one, ending in endings.items():
            if ending == ".png":
                data = library.svg_to_png(svg, scale=FINENESS)
            else:
                data = _compact(svg, "part-").encode()
            try:
                with whole(one) as half:
                    half.write_bytes(data)
            except OSError as error:
                raise SolidgearError(
                    f"{one}: cannot be written ({error.strerror or error})"
                ) from error
        return file


def in_columns(panels: Sequence[Panel], columns: int) -> list[list[Panel]]:
    """Rows of so many panels."""
    return [list(panels[k : k + columns]) for k in range(0, len(panels), columns)]


def _parts(row: list[Panel], width: float) -> list[list[Panel]]:
    """Rows of no more panels than there is room for."""
    return in_columns(row, max(1, int(width / row[0].least)))


def _compact(svg: str, name: str) -> str:
    """An SVG without what is not seen, places to a hundredth of a pixel, and its identifiers, which
    vl-convert counts on from drawing to drawing, counted anew behind a name.
    """
    own: dict[str, str] = {}

    def tag(found: re.Match[str]) -> str:
        text = found[0]
        if text.startswith(('<path class="background"', '<path class="foreground"')):
            return ""
        text = re.sub(r' (?:aria-roledescription|role|opacity)="(?:[a-z -]*|1)"', "", text)
        # a label of what has no role is read by nobody
        text = re.sub(r' aria-label="[^"]*"', r'\g<0> role="img"', text)
        text = re.sub(r'(?<= id=")[^"]+|(?<="url\(#)[^)]+', number, text)
        return re.sub(r' (?:d|transform)="[^"]*"', short, text)

    def number(found: re.Match[str]) -> str:
        return own.setdefault(found[0], f"{name}{len(own)}")

    def short(found: re.Match[str]) -> str:
        return re.sub(r"(\.\d\d)\d+", r"\1", found[0])

    return re.sub(r"<[a-z][^>]*>", tag, svg)


def check_ending(file: Path, known: Sequence[str] = FORMATS) -> str:
    """The ending of a picture's name.

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
    if ending not in known:
        raise SolidgearError(f"{file}: no picture ends like that; use {' or '.join(known)}")
    return ending


@cache
def _drawing_library() -> Any:
    """vl-convert, which measures words in the letters that matplotlib brings: they are the same on
    every machine, and wider than those that a browser may have instead.
    """
    import vl_convert

    found = find_spec("matplotlib")
    for folder in (found and found.submodule_search_locations) or ():
        vl_convert.register_font_directory(f"{folder}/mpl-data/fonts/ttf")
    return vl_convert


#: from the width of a page to a chart on it, None where there is nothing to draw
Make = Callable[[float], "Chart | None"]


def page_svg(name: str, make: Make) -> bytes | None:
    """A chart as it stands in a page: a wide drawing and one for a phone, of which ``style.html``
    shows either. Its name has letters and underscores, and is of no other chart of the page.
    """
    drawings = []
    for kind, width in (("wide", WIDE), ("narrow", NARROW)):
        chart = make(width)
        if chart is None:
            return None
        svg = chart.svg(f"{name}-{kind}-")
        drawings.append(svg.replace('class="marks"', f'class="{kind}"', 1))
    return "".join(drawings).encode()
