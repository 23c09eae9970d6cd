"""Charts for a phone: the same drawing on narrow paper, its panels below one another.

What makes a figure is run twice, for a wide page and inside of ``on_narrow_paper``. There ``new_figure``
(``chart_style.py``) gives a :class:`NarrowFigure`, which puts panels that stood beside one another below
one another and makes what is written fit the width. Letters keep their size, and the page shows one
drawing or the other (``style.html``).
"""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from matplotlib.figure import Figure

from solidgear.report.chart_style import NARROW_WIDTH as WIDTH

if TYPE_CHECKING:
    from matplotlib.layout_engine import ConstrainedLayoutEngine

#: of the width, that labels beside a panel may take
BESIDE = 0.36
#: of a room, that words may fill: letters differ in width
FULL = 0.94
#: in; empty paper that is worth cutting off
EMPTY = 0.15
#: most parts of an axis below a panel
TICKS = 5
#: in; between the foot of a figure and what stands above it
FOOT = 0.12
#: rotation of labels below a panel that would run into one another
TURNED = 55.0


class NarrowFigure(Figure):
    """A figure whose panels stand below one another, whatever grid is asked for.

    Parameters
    ----------
    width, height : float
        That it would have on a wide page, in.
    """

    _suptitle: Any
    _supxlabel: Any

    def __init__(self, width: float, height: float, **settings: Any):
        super().__init__(figsize=(min(width, WIDTH), height), **settings)
        self._grids: list[np.ndarray] = []

    def subplots(self, nrows: int = 1, ncols: int = 1, **settings: Any) -> Any:
        """Panels as of :meth:`matplotlib.figure.Figure.subplots`, each as high as it would be there."""
        squeeze = settings.pop("squeeze", True)
        if ncols > 1:
            settings = {}  # axes are shared in a grid, of which nothing is left
        self.set_figheight(self.get_figheight() * ncols)
        grid = super().subplots(nrows * ncols, 1, squeeze=False, **settings).reshape(nrows, ncols)
        self._grids.append(grid)
        return grid if not squeeze else grid[0, 0] if grid.size == 1 else grid.squeeze()

    def legend(self, *handles: Any, **settings: Any) -> Any:
        """A legend of the figure, below it, in so many columns as fit."""
        settings |= {"loc": "outside lower left", "ncols": 1}
        return super().legend(*handles, **settings)

    def fit(self) -> None:
        """Make what is written fit the paper, and put everything in its place."""
        self._label_panels()
        self._thin_ticks()
        self._arrange()
        wrapped = self._wrap_words()
        if self._part_legend() or wrapped:
            self._arrange()
        if self._turn_labels():
            self._arrange()
        if any(ax.get_aspect() != "auto" for ax in self.axes) and self._cut_off():
            self._arrange()

    def _thin_ticks(self) -> None:
        """No more numbers below a panel than there is room for."""
        from matplotlib.ticker import MaxNLocator

        for ax in self.axes:
            if isinstance(ax.xaxis.get_major_locator(), MaxNLocator):
                ax.locator_params(axis="x", nbins=TICKS)

    def _arrange(self) -> None:
        """Put everything in its place, so that it can be measured."""
        engine = self.get_layout_engine()
        if engine is not None:
            engine.execute(self)

    def _label_panels(self) -> None:
        """A panel is called what the one below or left of it was called in the grid."""
        for grid in self._grids:
            if grid.shape[1] == 1:
                continue
            for (row, column), ax in np.ndenumerate(grid):
                if ax.axison and not ax.get_xlabel():
                    ax.set_xlabel(grid[-1, column].get_xlabel())
                if ax.axison and not ax.get_ylabel():
                    ax.set_ylabel(grid[row, 0].get_ylabel())

    def _wrap_words(self) -> bool:
        """Titles and labels in lines that fit the width; whether any had to be changed."""
        changed = False
        across = self.get_figwidth() * self.dpi
        titles: list[Any] = [self._suptitle, self._supxlabel]
        panels: list[Any] = self.axes
        for ax in panels:
            titles += [ax.title, ax._left_title, ax.xaxis.label]
        for text in titles:
            if text is not None and text.get_text():
                room = across - max(text.get_window_extent().x0, 0.0)
                changed = _wrapped(text, room) or changed
        for ax in self.axes:
            labels = [label.get_text() for label in ax.get_yticklabels()]
            sizes = [label.get_window_extent().width for label in ax.get_yticklabels()]
            if max(sizes, default=0.0) > BESIDE * across:
                letters = int(BESIDE * across / max(sizes) * max(map(_longest, labels)))
                ax.set_yticks(ax.get_yticks(), [_filled(label, letters) for label in labels])
                changed = True
        return changed

    def _part_legend(self) -> bool:
        """A legend of the figure stands above what is written at its foot; whether there are both."""
        foot, engine = self._supxlabel, cast("ConstrainedLayoutEngine", self.get_layout_engine())
        if foot is None or not foot.get_text() or engine is None or not self.legends:
            return False
        high = self.get_figheight() * self.dpi
        for legend in self.legends:
            # the layout makes room for the higher one of the two only
            own, below = (one.get_window_extent().height / high for one in (legend, foot))
            gap = FOOT / self.get_figheight()
            legend.set_bbox_to_anchor((0.0, below + gap))
            engine.set(rect=(0.0, own + gap, 1.0, 1.0 - own - gap))
        return True

    def _turn_labels(self) -> bool:
        """Names below a panel are turned where they would run into one another; whether any were."""
        turned = False
        for ax in self.axes:
            labels = [
                one for one in ax.get_xticklabels() if one.get_text() and not one.get_rotation()
            ]
            boxes = sorted((one.get_window_extent() for one in labels), key=lambda box: box.x0)
            if any(one.x1 > other.x0 for one, other in zip(boxes, boxes[1:])):
                for label in labels:
                    label.set(rotation=TURNED, ha="right", rotation_mode="anchor")
                turned = True
        return turned

    def _cut_off(self) -> bool:
        """No empty paper above and below a panel that keeps its proportions; whether there was any."""
        empty = self.get_figheight() - self.get_tightbbox().height
        if self._grids and empty > EMPTY:
            self.set_figheight(self.get_figheight() - empty + EMPTY)
            return True
        return False


def _longest(text: str) -> int:
    return max(map(len, text.split("\n")))


def _wrapped(text: Any, room: float) -> bool:
    """Put a text in lines that fit a room, pixels; whether it did not."""
    size = text.get_window_extent().width
    if size > FULL * room:
        letters = int(FULL * room / size * _longest(text.get_text()))
        text.set_text(_filled(text.get_text(), letters))
        return True
    return False


def _filled(text: str, letters: int) -> str:
    """Every line of a text in lines of at most so many letters."""
    lines = (textwrap.wrap(line, max(letters, 8)) or [""] for line in text.split("\n"))
    return "\n".join(line for several in lines for line in several)
