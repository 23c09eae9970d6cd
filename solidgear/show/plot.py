"""Charts of panels: for a page, and as files.

One description becomes the SVG of a page, in a wide and in a narrow layout, and the PNG or SVG of a
file. ``style.html`` turns the colours of a page in the dark; ``readout.js`` reads its marks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from solidgear.core import SolidgearError
from solidgear.core.machine.whole_file import whole_or_refused
from solidgear.show.panel import LETTER, Panel, wrapped
from solidgear.show.paper import Paper
from solidgear.show.pen import LEAD, Pen

#: px; across a page, and across a phone that is 390 px wide
WIDE, NARROW = 1000.0, 362.0
#: px; between two panels
BETWEEN = 26.0
#: px; around a drawing in a page, and around one in a file of its own
PADDING, MARGIN = 3.0, 10.0
#: pixels of a PNG in one of a chart
FINENESS = 1.5
FORMATS = (".png", ".svg")


class Picture:
    """A drawing for a page, a notebook or a file."""

    def svg(
        self, kind: str = "", name: str = "part-", margin: float = 0.0, ground: str = ""
    ) -> str:
        """Return an SVG of a class of a page's style, within a margin (px) and on a ground, if any;
        identifiers in it begin with a name.
        """
        raise NotImplementedError

    def write(self, file: str | Path, *beside: Path) -> Path:
        """Write a picture, drawn once for all its files, ``.png`` or ``.svg`` by their endings."""
        files = [Path(file), *beside]
        write_picture(self._alone(), files)
        return files[0]

    def __repr__(self) -> str:
        return f"<{type(self).__name__}>"

    def _repr_png_(self) -> bytes:
        return pixels(self._alone())

    def _alone(self) -> str:
        return self.svg("alone", margin=MARGIN, ground="#ffffff")


@dataclass(repr=False)
class Chart(Picture):
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
    >>> from solidgear.show.panel import readout
    >>> from solidgear.show.scales import Axis
    >>> panel = Panel(Axis("length, mm", (0, 2)), Axis("error", (1e-3, 1), log=True), 200)
    >>> panel.draw("point", [{"x": 1, "y": 0.1, "readout": readout("beam", ("error", "10", "%"))}])
    >>> 'aria-label="beam&#xA;error: 10 %"' in Chart([[panel]]).svg()
    True
    """

    rows: list[list[Panel]]
    width: float = WIDE
    title: str = ""
    foot: str = ""

    def svg(
        self, kind: str = "chart", name: str = "part-", margin: float = 0.0, ground: str = ""
    ) -> str:
        """Return the chart as an SVG; see :meth:`Picture.svg`."""
        pen = Pen(name, LETTER)
        low = PADDING + margin
        for line in wrapped(self.title, self.width) if self.title else ():
            low += LETTER + 1 + LEAD
            how: dict[str, Any] = {"size": LETTER + 1, "font_weight": "bold", "fill": "#000000"}
            pen.put(pen.words(PADDING, low, line, **how))
        low += 2 * LEAD * bool(self.title)
        for row in self._papers():
            over, under = max(p.over for p in row), max(p.panel.height + p.under for p in row)
            left = 0.0
            for paper in row:
                paper.draw(pen, left + paper.beside, low + over)
                left += paper.beside + paper.width + paper.panel.right + BETWEEN
            low += over + under + BETWEEN
        low -= BETWEEN
        for line in wrapped(self.foot, self.width) if self.foot else ():
            low += LETTER - 1 + LEAD
            pen.put(pen.words(PADDING, low, line, size=LETTER - 1, fill="#000000"))
        left = min(0.0, pen.left - PADDING) - margin
        right = max(self.width, pen.right + PADDING) + margin
        return pen.svg(kind, left, right, low + PADDING + margin, ground)

    def _papers(self) -> Iterator[list[Paper]]:
        """Yield rows of panels on paper, those of one place below one another equally wide."""
        rows = [
            part
            for row in self.rows
            for part in in_columns(row, max(1, int(self.width / row[0].least)))
        ]
        beside = max(panel.beside for row in rows for panel in row)
        for row in rows:
            width = (self.width - BETWEEN * (len(row) - 1)) / len(row)
            yield [Paper(panel, beside, width - beside - panel.right) for panel in row]


def in_columns(panels: Sequence[Panel], columns: int) -> list[list[Panel]]:
    """Split panels into rows."""
    return [list(panels[k : k + columns]) for k in range(0, len(panels), columns)]


def write_picture(svg: str, files: Sequence[Path]) -> None:
    """Write a drawing as files, ``.png`` or ``.svg`` by their endings."""
    endings = {file: check_ending(file) for file in files}
    for file, ending in endings.items():
        data = pixels(svg) if ending == ".png" else svg.encode()
        with whole_or_refused(file) as half:
            half.write_bytes(data)


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


def pixels(svg: str) -> bytes:
    """Return a drawing as a PNG."""
    return _pixel_library().svg_to_png(svg, scale=FINENESS)


@cache
def _pixel_library() -> Any:
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
        drawings.append(chart.svg(kind, f"{name}-{kind}-"))
    return "".join(drawings).encode()
