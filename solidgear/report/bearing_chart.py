"""Picture of catalogue bearings: stiffness over load, and how the elements share it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from solidgear.report.chart_style import new_figure
from solidgear.report.where_chart import write_picture
from solidgear.report.words import engineering

COLOURS = {"x": "#1f5fa8", "y": "#b2561a", "z": "#2b7a4b"}


class BearingPanel(NamedTuple):
    """What is drawn of one bearing.

    Attributes
    ----------
    title : str
    factors : (n,) ndarray
        Times the load of the scene.
    middle, low, high : (n, 3) ndarray
        Stiffness in x, y and z, N/m, and the ends of its range.
    rows : sequence of (azimuth, load)
        Of every element, rad from x towards z, and N.
    """

    title: str
    factors: np.ndarray
    middle: np.ndarray
    low: np.ndarray
    high: np.ndarray
    rows: Sequence[tuple[np.ndarray, np.ndarray]]


def draw_bearings(file: Path, panels: Sequence[BearingPanel]) -> None:
    """Write the picture.

    Parameters
    ----------
    file : Path
        Its ending, ``.png`` or ``.svg``, says what it becomes.
    panels : sequence of BearingPanel

    Raises
    ------
    SolidgearError
        For another ending, or a file that cannot be written.
    """
    write_picture(file, lambda: _figure(panels), "bearings")


def _figure(panels: Sequence[BearingPanel]):
    figure = new_figure(9.0, 3.4 * len(panels))
    for k, panel in enumerate(panels):
        _stiffness(figure.add_subplot(len(panels), 2, 2 * k + 1), panel)
        _shares(figure.add_subplot(len(panels), 2, 2 * k + 2, projection="polar"), panel)
    return figure


def _stiffness(ax, panel: BearingPanel) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for k, (name, colour) in enumerate(COLOURS.items()):
        values = np.where(panel.middle[:, k] > 0, panel.middle[:, k], np.nan)
        if np.all(np.isnan(values)):
            continue
        ax.fill_between(
            panel.factors,
            np.where(panel.low[:, k] > 0, panel.low[:, k], np.nan),
            np.where(panel.high[:, k] > 0, panel.high[:, k], np.nan),
            color=colour,
            alpha=0.18,
            linewidth=0,
        )
        ax.plot(panel.factors, values, color=colour, label=f"K_{name}{name}")
    ax.axvline(1.0, color="#777777", linewidth=0.8, linestyle="--")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel("load over that of the scene")
    ax.set_ylabel("stiffness, N/m")
    ax.set_title(panel.title)
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
    ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: engineering(v, 3)))
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.legend(loc="best")


def _shares(ax, panel: BearingPanel) -> None:
    names = ("row",) if len(panel.rows) == 1 else ("lower row", "upper row")
    for (azimuth, load), name, colour in zip(panel.rows, names, ("#444444", "#a03070")):
        width = 0.55 * 2 * np.pi / len(azimuth)
        ax.bar(azimuth, load, width=width, color=colour, alpha=0.75, label=name)
    ax.set_xticks(np.arange(4) * np.pi / 2, ["x", "z", "-x", "-z"])
    ax.set_title("load of every element, N")
    ax.tick_params(labelsize=7)
    # between the spokes, on the side that carries least
    total = np.sum([load @ np.exp(1j * azimuth) for azimuth, load in panel.rows])
    ax.set_rlabel_position(float(np.degrees(np.angle(-total))) if abs(total) > 0 else 22.5)
    if len(panel.rows) > 1:
        ax.legend(loc="lower left", bbox_to_anchor=(-0.25, -0.05), fontsize=7)
