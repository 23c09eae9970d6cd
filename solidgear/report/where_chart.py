"""Picture of the mesh of a meridian, every cell in the colour of its share of the error."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.machine.whole_file import whole
from solidgear.report.chart_style import STYLE, as_svg, new_figure, paper_width
from solidgear.report.readout import readable
from solidgear.report.words import percent

if TYPE_CHECKING:
    from solidgear.judge.record import Record

#: shares below this are all of one colour
LEAST = 1e-4
#: a shaft that is more slender than this is drawn with its radius stretched
SLENDEREST = 7.0
#: in; and the most that a half section gets
WIDTH, HIGHEST = 9.0, 4.0
#: in; the names of the places need so much
NARROWEST = 4.0
FORMATS = (".png", ".svg")
#: in; of paper that the number of a place takes
DIGIT = 0.19
#: in; a picture from close by of cells at a place whose corners are nearer than this share of the length
CLOSE, SMALL = 2.2, 0.02
#: lines of the mesh
LINE = "#00000080"
#: places that are named, and the share from which on they are
MOST_PLACES, WORTH_NAMING = 5, 5e-4


def draw_where(
    file: Path,
    points: np.ndarray,
    cells: np.ndarray,
    shares: np.ndarray,
    rows: Sequence[Any] = (),
    title: str = "",
) -> None:
    """Write the picture.

    Parameters
    ----------
    file : Path
        Its ending, ``.png`` or ``.svg``, says what it becomes.
    points : (2, n) ndarray
        r and y of the corners of the cells, m.
    cells : (4, m) ndarray of int
    shares : (m,) ndarray
        Of every cell; their magnitudes are drawn.
    rows : sequence of Row or PlaceRecord
        Places, the largest share first; those worth it are named.
    title : str

    Raises
    ------
    SolidgearError
        For another ending, or a file that cannot be written.
    """
    write_picture(file, lambda: _figure(points, cells, shares, rows, title), "where")


def write_picture(file: Path, make: Callable[[], Any], name: str) -> None:
    """Write a figure as a picture.

    Parameters
    ----------
    file : Path
        Its ending, ``.png`` or ``.svg``, says what it becomes.
    make : callable
        Returns a matplotlib figure.
    name : str
        Of the kind of picture, for identifiers in an SVG.

    Raises
    ------
    SolidgearError
        For another ending, or a file that cannot be written.
    """
    import matplotlib

    ending = check_ending(file)
    with matplotlib.rc_context():
        matplotlib.rcdefaults()  # the user's own matplotlibrc must not change a picture
        matplotlib.rcParams.update({**STYLE, "svg.hashsalt": f"solidgear {name}"})
        target = io.BytesIO()
        without: dict[str, Any] = {"Date": None} if ending == ".svg" else {"Software": None}
        make().savefig(target, format=ending[1:], dpi=150, metadata=without)
    try:
        with whole(file) as half:
            half.write_bytes(target.getvalue())
    except OSError as error:
        raise SolidgearError(f"{file}: cannot be written ({error.strerror or error})") from error


def check_ending(file: Path) -> str:
    """The ending of a picture's name.

    Parameters
    ----------
    file : Path

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
    if ending not in FORMATS:
        raise SolidgearError(f"{file}: no picture ends like that; use {' or '.join(FORMATS)}")
    return ending


def _figure(points, cells, shares, rows, title: str):
    from matplotlib.ticker import FuncFormatter

    places = [p for p in worth_naming(rows) if p.y is not None and p.r is not None]
    r, y = 1e3 * points
    length, radius = np.ptp(y), r.max()
    stretch = max(1.0, length / (SLENDEREST * radius))
    shape = 1.25 * stretch * radius / length
    widest = paper_width(WIDTH)
    height = min(0.8 * widest * shape, HIGHEST)
    width = min(widest, max(height / shape + 2.0, NARROWEST))
    close = _close(points, places)[: int(width / CLOSE)]
    below = max(height, 1.0) + 1.0 + 0.16 * len(places)
    figure = new_figure(width, below + CLOSE * bool(close))
    heights = [below, CLOSE] if close else [below]
    grid = figure.add_gridspec(len(heights), max(len(close), 1), height_ratios=heights)
    ax = figure.add_subplot(grid[0, :])
    corners = np.stack([y[cells], r[cells]], axis=-1).transpose(1, 0, 2)
    drawn = _drawn(ax, corners, shares)
    ax.set_aspect(stretch)
    ax.set_xlim(y.min() - 0.02 * length, y.max() + 0.02 * length)
    ax.set_ylim(0, 1.25 * radius)
    scale = 0.8 * width / length  # in on paper, about
    spots = [(1e3 * scale * p.y, 1e3 * scale * stretch * p.r) for p in places]
    raised = _raised(spots)
    over = [y + 2 * DIGIT + up - scale * shape * length for (_, y), up in zip(spots, raised)]
    for number, (place, up) in enumerate(zip(places, raised), 1):
        ax.annotate(
            str(number),
            (1e3 * place.y, 1e3 * place.r),
            xytext=(0, 14 + 72 * up),
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize=9,
            fontweight="bold",
            bbox={"boxstyle": "circle,pad=0.15", "fc": "#ffffff", "ec": "#555555", "lw": 0.5},
            arrowprops={"arrowstyle": "-", "lw": 0.6},
        )
    names = [
        f"{number}: {place.what}, y = {1e3 * place.y:.4g} mm, {100 * place.share:.2g} %"
        for number, place in enumerate(places, 1)
    ]
    drawn_as = "" if stretch == 1.0 else f"radius drawn {stretch:.2g} times as large"
    ax.set_xlabel("\n".join(["y, mm", *names]))
    ax.set_ylabel("r, mm")
    ax.set_title("; ".join(filter(None, (title, drawn_as))), pad=72 * max([0.08, *over]))
    bar = figure.colorbar(drawn, ax=ax, pad=0.01, aspect=12)
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{100 * v:g} %"))
    bar.set_label("share of the cell")
    for k, (number, half) in enumerate(close):
        place, inset = places[number - 1], figure.add_subplot(grid[1, k])
        centre = 1e3 * np.array([place.y, place.r])
        low, high = corners.min(axis=1), corners.max(axis=1)
        seen = np.all((low < centre + 1e3 * half) & (high > centre - 1e3 * half), axis=1)
        _drawn(inset, corners[seen], shares[seen])
        inset.set_aspect(1.0)
        inset.set_xlim(*(centre[0] + 1e3 * half * np.array([-1, 1])))
        inset.set_ylim(*(centre[1] + 1e3 * half * np.array([-1, 1])))
        inset.locator_params(nbins=3)
        inset.tick_params(labelsize=7)
        inset.ticklabel_format(useOffset=False)
        inset.set_title(f"{number}, {2e3 * half:.2g} mm wide")
    return figure


def _drawn(ax, corners, shares):
    """Draw all cells in the colours of their shares, which can be read off."""
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import LogNorm

    drawn = PolyCollection(
        list(corners),
        array=np.abs(shares).clip(LEAST, None),
        norm=LogNorm(LEAST, 1.0),
        cmap="YlOrRd",
        edgecolor=LINE,
        linewidth=0.4,
    )
    ax.add_collection(drawn)
    ax.grid(False)
    at = corners.mean(axis=1).T
    told = {
        "share of the error": ("", [percent(abs(share), signed=False) for share in shares]),
        "y": ("mm", [f"{v:.4g}" for v in at[0]]),
        "r": ("mm", [f"{v:.4g}" for v in at[1]]),
    }
    readable(ax, at[0], at[1], "cell", told)
    return drawn


def _close(points: np.ndarray, places: Sequence[Any]) -> list[tuple[int, float]]:
    """Numbers of the places towards which cells are too small to be seen, and half the width (m) of
    what shows them: between the smallest of them and the wall.
    """
    out = []
    for number, place in enumerate(places, 1):
        away = np.hypot(points[0] - place.r, points[1] - place.y)
        near = away[away > 1e-9 * np.ptp(points[1])].min()
        if place.reach is not None and near < SMALL * np.ptp(points[1]):
            out.append((number, float(np.sqrt(near * max(place.reach, near)))))
    return out


def _raised(spots: Sequence[tuple[float, float]]) -> list[float]:
    """How far the number over each spot (inches) is to be raised so that it lies on none before."""
    taken: list[tuple[float, float]] = []
    for x, y in spots:
        while any(abs(x - a) < DIGIT and abs(y - b) < DIGIT for a, b in taken):
            y += 1.01 * DIGIT
        taken.append((x, y))
    return [y - base for (_, y), (_, base) in zip(taken, spots)]


@as_svg
def where_chart(record: Record):
    """Where the error of the judge sits; None without a record of it."""
    where = record.where
    if where is None or not where.cells:
        return None
    cells = np.array(where.points), np.array(where.cells), np.array(where.shares)
    return _figure(*cells, where.rows, "")


def worth_naming(rows: Sequence[Any]) -> list[Any]:
    """The first few places whose share is worth a word.

    Parameters
    ----------
    rows : sequence of Row or PlaceRecord
        Places with a ``share``, the largest first.
    """
    return [r for r in rows[:MOST_PLACES] if r.share is not None and abs(r.share) >= WORTH_NAMING]
