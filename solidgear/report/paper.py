"""From a figure to its SVG, laid out once and measured as it will be drawn.

``Figure.savefig`` draws a figure with a layout twice, once into nothing, and makes a renderer for
every layout, each of which measures every word anew. Here one renderer measures all figures, a figure
is laid out, and drawn once.
"""

from __future__ import annotations

import functools
import io
from typing import Any

from matplotlib.backends.backend_svg import FigureCanvasSVG, RendererSVG

from solidgear.report.narrow import NarrowFigure

#: of the units that an SVG is drawn in
DPI = 72.0
#: none of what would change from run to run, or tell of programs
WITHOUT = {"Date": None, "Creator": None, "Format": None, "Type": None}


class SvgCanvas(FigureCanvasSVG):
    """What figures are drawn on; asked for a renderer to measure with, it gives always the same."""

    def get_renderer(self) -> RendererSVG:
        """The renderer that knows how large every word is that it was asked for before."""
        return _measuring()


@functools.cache
def _measuring() -> RendererSVG:
    # sizes of words depend neither on the paper nor on what is written
    return RendererSVG(1.0, 1.0, io.StringIO(), metadata=WITHOUT)


def written(figure: Any) -> str:
    """The SVG of a figure, as a file of its own would hold it.

    The figure stays as it was drawn: its layout is done.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        A :class:`~solidgear.report.narrow.NarrowFigure` is made to fit its paper first.

    Returns
    -------
    str
    """
    for ax in figure.axes:
        for part in (*ax.collections, *ax.images):
            part.set_rasterized(False)  # pixels would keep their colours in the dark
    canvas, dpi = SvgCanvas(figure), figure.dpi
    figure.dpi = DPI
    if isinstance(figure, NarrowFigure):
        figure.fit()
    elif (engine := figure.get_layout_engine()) is not None:
        engine.execute(figure)
    figure.set_layout_engine("none")
    figure.dpi = dpi  # at which images, if there are any, are drawn
    target = io.BytesIO()
    canvas.print_svg(target, metadata=WITHOUT)
    return target.getvalue().decode()
