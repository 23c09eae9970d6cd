"""How charts look, and how a figure becomes an SVG that can stand in a page."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any

from solidgear.report.border import as_record
from solidgear.report.night import for_dark_too
from solidgear.report.readout import with_readings

if TYPE_CHECKING:
    from matplotlib.typing import RcKeyType

    from solidgear.judge.record import Record

#: how the tolerance asked for is drawn
TOLERANCE = "#aa2222"
STYLE: dict[RcKeyType, Any] = {
    "svg.fonttype": "none",  # text stays text: it can be searched, copied and read aloud
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Arial", "Helvetica"],
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#555555",
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e3e3e3",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "hatch.linewidth": 0.4,
    "text.parse_math": False,  # a dollar in a name is a dollar
}


#: in; of narrow paper: on a phone of 390 px a letter of 8 pt is 8.8 px high
NARROW_WIDTH = 4.55
_NARROW: ContextVar[bool] = ContextVar("narrow paper", default=False)
#: a chart of the report: from what a run found to an SVG in bytes, None where there is nothing
Chart = Callable[["Record | Mapping[str, Any]"], bytes | None]


def as_svg(function: Callable[[Record], Any]) -> Chart:
    """From a function that makes a figure to one that returns its SVG, ready to stand in an HTML
    page.
    """

    @functools.wraps(function)
    def drawn(found: Record | Mapping[str, Any]) -> bytes | None:
        return svg_of(function.__name__, lambda: function(as_record(found)))

    return drawn


def svg_of(name: str, make: Callable[[], Any]) -> bytes | None:
    """The SVGs of a figure, ready to stand in an HTML page, with what is to be read off them: a
    wide one, and behind it one for a phone, of which ``style.html`` shows either.

    Parameters
    ----------
    name : str
        Letters and underscores, of no other figure of the page.
    make : callable
        Gives the figure, or None where there is nothing to draw.
    """
    wide = _drawn(name, make, "wide")
    with on_narrow_paper():
        narrow = _drawn(f"{name}_narrow", make, "narrow")
    return None if wide is None or narrow is None else (wide + narrow).encode()


def _drawn(name: str, make: Callable[[], Any], kind: str) -> str | None:
    """One drawing of a chart: an <svg> of a class, in the colours of the page."""
    import matplotlib

    from solidgear.report.paper import written

    with matplotlib.rc_context():
        matplotlib.rcdefaults()  # the user's own matplotlibrc must not change a report
        matplotlib.rcParams.update({**STYLE, "svg.hashsalt": f"solidgear {name}"})
        figure = make()
        if figure is None:
            return None
        svg = with_readings(_embeddable(written(figure), name), figure)
    return for_dark_too(svg.replace("<svg", f'<svg class="{kind}"', 1))


def _embeddable(svg: str, name: str) -> str:
    """The bare <svg> element, with identifiers that no other chart on the page has."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"\s*<metadata>.*?</metadata>", "", svg, flags=re.S)
    svg = re.sub(r'(\sid=")', rf"\g<1>{name}-", svg)
    return re.sub(r'(url\(#|href="#)', rf"\g<1>{name}-", svg)


@contextmanager
def on_narrow_paper() -> Iterator[None]:
    """Inside of it charts are drawn for a phone."""
    before = _NARROW.set(True)
    try:
        yield
    finally:
        _NARROW.reset(before)


def paper_width(wide: float) -> float:
    """How wide a chart becomes that is so wide on a wide page, in."""
    return min(wide, NARROW_WIDTH) if _NARROW.get() else wide


def legend_columns(wide: int) -> int:
    """In how many columns a legend stands that has so many on a wide page."""
    return min(wide, 2) if _NARROW.get() else wide


@contextmanager
def styled() -> Iterator[None]:
    """The style of all figures, whatever the user's own matplotlibrc says."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        yield


def new_figure(width: float, height: float):
    """A figure of so many inches, or what becomes of it on narrow paper."""
    from matplotlib.figure import Figure

    from solidgear.report.narrow import NarrowFigure

    if _NARROW.get():
        return NarrowFigure(width, height, layout="constrained")
    return Figure(figsize=(width, height), layout="constrained")


def tolerance_line(ax, tolerance: float, x: float = 0.99, size: float = 8, **line) -> None:
    """The tolerance asked for as a line across a panel, named at its right end.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    tolerance : float
    x : float
        Where the name ends, as a share of the width.
    size : float
        Of the name, pt.
    **line
        Width and style.
    """
    ax.axhline(tolerance, color=TOLERANCE, **line)
    ax.annotate(
        f"tolerance {100 * tolerance:.4g} %",
        (x, tolerance),
        xycoords=("axes fraction", "data"),
        xytext=(0, 2),
        textcoords="offset points",
        ha="right",
        fontsize=size,
        color=TOLERANCE,
    )


def percent_decades(ax) -> None:
    """Decades in per cent, not as powers of ten: those need the mathematics mode that names are
    kept out of.
    """
    from matplotlib.ticker import FuncFormatter, NullFormatter

    ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{100 * v:.6g} %"))
    ax.yaxis.set_minor_formatter(NullFormatter())
