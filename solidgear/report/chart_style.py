"""How charts look, and how a figure becomes an SVG that can stand in a page."""

from __future__ import annotations

import functools
import io
import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from solidgear.fidelity.ladder import LADDER
from solidgear.report.words import plain

if TYPE_CHECKING:
    from matplotlib.typing import RcKeyType

QUANTITY_NAME = {"c_zz": "C_zz", "k_zz": "K_zz", "bending_1": "bending 1"}
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


def as_svg(function: Callable[[dict], Any]) -> Callable[[Mapping], bytes | None]:
    """From a function that makes a figure to one that returns its SVG, ready to stand in an HTML
    page.
    """

    @functools.wraps(function)
    def drawn(results: Mapping) -> bytes | None:
        import matplotlib

        name = function.__name__
        with matplotlib.rc_context():
            matplotlib.rcdefaults()  # the user's own matplotlibrc must not change a report
            matplotlib.rcParams.update({**STYLE, "svg.hashsalt": f"solidgear {name}"})
            figure = function(plain(results))
            if figure is None:
                return None
            target = io.BytesIO()
            figure.savefig(
                target,
                format="svg",
                metadata={"Date": None, "Creator": None, "Format": None, "Type": None},
            )
        return _embeddable(target.getvalue().decode(), name).encode()

    return drawn


def _embeddable(svg: str, name: str) -> str:
    """The bare <svg> element, with identifiers that no other chart on the page has."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"\s*<metadata>.*?</metadata>", "", svg, flags=re.S)
    svg = re.sub(r'(\sid=")', rf"\g<1>{name}-", svg)
    return re.sub(r'(url\(#|href="#)', rf"\g<1>{name}-", svg)


def new_figure(width: float, height: float):
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def colour_of(key: str) -> str:
    """Colour of a model, apart from the others also for the colour-blind."""
    return LADDER[key].colour if key in LADDER else "#777777"


def marker_of(key: str) -> str:
    """Marker of a model, apart from the others also in grey."""
    return LADDER[key].marker if key in LADDER else "P"


def percent_decades(ax) -> None:
    """Decades in per cent, not as powers of ten: those need the mathematics mode that names are
    kept out of.
    """
    from matplotlib.ticker import FuncFormatter, NullFormatter

    ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{100 * v:.6g} %"))
    ax.yaxis.set_minor_formatter(NullFormatter())
