"""A race as a figure: error against cost, one line of panels a quantity."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from solidgear.judge.race.pareto import AUTOMATIC, Race, Row
from solidgear.report.cells import whole_number
from solidgear.report.chart_style import new_figure, percent_decades, styled, tolerance_line
from solidgear.report.race_legend import FRONT, footer, legend
from solidgear.report.race_rows import COSTS, error_text, options_text, replace_file
from solidgear.report.race_style import REFERENCE, Look
from solidgear.report.readout import readable
from solidgear.report.words import count, is_number, percent, seconds

QUANTITY = {"C_zz": "port compliance C_zz", "bending 1": "first bending frequency"}
#: the series whose orders are written beside its points
ORDERS = "harmonic p graded"


def draw(race: Race, path) -> Path:
    """Draw the figure of a race as a PNG.

    Returns
    -------
    pathlib.Path
    """
    with styled():
        target = io.BytesIO()
        figure(race).savefig(target, format="png", dpi=150, metadata={"Software": None})
    replace_file(Path(path), target.getvalue())
    return Path(path)


def figure(race: Race):
    """Panels of error over seconds and over unknowns, one line of panels a quantity, log-log."""
    quantities = list(race.reference["values"])
    out = new_figure(13.2, 1.5 + 4.1 * len(quantities))
    axes = out.subplots(len(quantities), len(COSTS), squeeze=False, sharex="col", sharey="row")
    for line, quantity in zip(axes, quantities):
        for ax, cost in zip(line, COSTS):
            _panel(ax, race, quantity, cost)
        line[0].set_ylabel(f"error of {QUANTITY.get(quantity, quantity)}")
    for ax, words in zip(axes[-1], COSTS.values()):
        ax.set_xlabel(words)
    title = race.scene.get("title") or race.scene.get("name", "")
    out.suptitle(
        f"{title}: error against cost" + ("" if race.complete else " (interrupted)"),
        x=0.01,
        ha="left",
        fontsize=12,
        weight="bold",
    )
    out.legend(
        handles=legend(race),
        loc="outside right upper",
        fontsize=8.5,
        handlelength=3.2,
        labelspacing=0.45,
    )
    out.supxlabel(footer(race), x=0.01, ha="left", fontsize=8, color="#444444", linespacing=1.45)
    return out


def _panel(ax, race: Race, quantity: str, cost: str) -> None:
    ax.set(xscale="log", yscale="log")
    left, right = _reach(race, cost)
    low, top = _heights(race, quantity)
    floor = max(race.reference["bands"][quantity], low)
    _band(ax, race.reference["bands"][quantity], low)
    tolerance = (race.scene.get("ask") or {}).get("tolerance")
    if is_number(tolerance) and low < tolerance < top:
        tolerance_line(ax, tolerance, x=0.995, size=7.5, lw=0.8, ls=":")
    _front(ax, race, quantity, cost, (right, top))
    for name in dict.fromkeys(row.series for row in race.rows):
        rows = [row for row in race.rows if row.series == name]
        _series(ax, race, rows, quantity, cost)
        _crosses(ax, rows, quantity, cost, top / 1.5)
    if cost in race.reference:
        place = race.reference[cost]
        style: dict[str, Any] = {"ms": 11, "color": REFERENCE, "mfc": "white"}
        ax.plot([place], [floor], "*", zorder=4, clip_on=False, **style)
        band = percent(race.reference["bands"][quantity], signed=False)
        told = {
            "own band": ("", [band]),
            "time": ("s", [seconds(race.reference["seconds"])]),
            "unknowns": ("", [whole_number(race.reference["unknowns"])]),
        }
        readable(ax, [place], [floor], "reference, harmonic solid", told, colour=REFERENCE)
        right = max(right, 1.5 * place)
    ax.set(xlim=(left, right), ylim=(low, top))
    _ticks(ax, cost)
    setup = sum(race.setup.values())
    if cost == "seconds" and left < setup < right:
        _setup(ax, setup)


def _reach(race: Race, cost: str) -> tuple[float, float]:
    """Both ends of the axis of a cost."""
    costs = [getattr(row, cost) for row in race.rows if row.status in ("ok", "failed")]
    known = [value for value in costs if value] or [1.0]
    return min(known) / 2.2, max(known) * 2.2


def _heights(race: Race, quantity: str) -> tuple[float, float]:
    """Both ends of the axis of errors.

    A band far below every error is named at the bottom, so that it does not squeeze what there is
    to see.
    """
    band = race.reference["bands"][quantity]
    errors = []
    for row in race.rows:
        error = race.error(row, quantity)
        if error is None:
            continue
        like = row.like_for_like.get(quantity) if error else None
        errors += [error, like or band]
    known = [error for error in errors if error > 0] or [1e-3]
    return max(band / 2.5, min(known) / 40), max(known) * 4


def _band(ax, band: float, low: float) -> None:
    """What the reference does not resolve."""
    floor = max(band, low)
    if band > 0:
        ax.axhspan(low, floor, color="#00805e", alpha=0.13, lw=0)
    below = "" if band > low else ", below this axis"
    ax.annotate(
        f"band of the reference {percent(band, signed=False)}{below}",
        (0.01, floor),
        xycoords=("axes fraction", "data"),
        xytext=(0, 3),
        textcoords="offset points",
        fontsize=7.5,
        color=REFERENCE,
        va="bottom",
    )


def _front(ax, race: Race, quantity: str, cost: str, corner: tuple[float, float]) -> None:
    """The Pareto front as steps, from the top of the panel to its right end."""
    steps = race.front(quantity, cost)
    if not steps:
        return
    right, top = corner
    xs = [getattr(row, cost) for row in steps]
    ys = [race.sure_error(row, quantity) for row in steps]
    ax.step(
        [xs[0], *xs, right],
        [top, *ys, ys[-1]],
        where="post",
        color=FRONT,
        lw=5,
        alpha=0.45,
        solid_joinstyle="miter",
        zorder=1.5,
    )


def _ticks(ax, cost: str) -> None:
    from matplotlib.ticker import FuncFormatter, NullFormatter

    def figures(value: float, _) -> str:
        return f"{value:g}" if cost == "seconds" else count(value)

    ax.xaxis.set_major_formatter(FuncFormatter(figures))
    ax.xaxis.set_minor_formatter(NullFormatter())
    percent_decades(ax)


def _setup(ax, spent: float) -> None:
    """What a process pays once, as an upright line."""
    ax.axvline(spent, color="#777777", lw=0.9, ls=(0, (1, 2)))
    ax.annotate(
        "set-up, once a process",
        (spent, 0.985),
        xycoords=("data", "axes fraction"),
        xytext=(-3, 0),
        textcoords="offset points",
        rotation=90,
        ha="right",
        va="top",
        fontsize=7.5,
        color="#666666",
    )


def _series(ax, race: Race, rows: list[Row], quantity: str, cost: str) -> None:
    """A line through the levels of a series, and their points."""
    look = Look(rows[0].series, rows[0].family)
    spots = []
    for row in rows:
        error = race.error(row, quantity)
        if error is not None:
            spots.append((row, getattr(row, cost), error))
    told = {
        f"error of {quantity}": ("", [error_text(race, row, quantity) for row, _, _ in spots]),
        "time": ("s", [seconds(row.seconds) for row, _, _ in spots]),
        "unknowns": ("", [whole_number(row.unknowns) for row, _, _ in spots]),
        "setting": ("", [options_text(row) for row, _, _ in spots]),
    }
    xs, ys = [x for _, x, _ in spots], [y for _, _, y in spots]
    readable(ax, xs, ys, look.series, told, colour=look.colour)
    if not look.converges:
        likes = [row.like_for_like.get(quantity) or float("nan") for row, _, _ in spots]
        readable(ax, xs, likes, f"{look.series}, like for like", told, colour=look.colour)
    ax.plot(
        xs,
        ys,
        ls=look.dashes,
        color=look.colour,
        lw=look.width,
        alpha=0.75 if look.uniform else 1.0,
        zorder=2,
    )
    for row, x, y in spots:
        ax.plot([x], [y], look.marker, ms=5.5, color=look.colour, mfc=look.fill, mew=1.0, zorder=3)
        if not race.resolved(row, quantity):
            _arrow(ax, (x, y), look.colour)
        if cost == "seconds" and len(row.samples) > 1:
            fastest, slowest = min(row.samples), max(row.samples)
            ax.hlines(y, fastest, slowest, color=look.colour, lw=0.9, alpha=0.45, zorder=1.8)
        if look.series == ORDERS:
            _beside(ax, (x, y), f"p{row.options['order']}", look.colour)
        if look.family == AUTOMATIC:
            _beside(ax, (x, y), f"{100 * row.options['tol']:g} %", look.colour)
        like = row.like_for_like.get(quantity)
        if like and not look.converges:
            ax.plot([x, x], [y, like], ":", color=look.colour, lw=1.1, zorder=1.9)
            ax.plot(
                [x], [like], look.marker, ms=5.5, color=look.colour, mfc="white", mew=1.1, zorder=3
            )
    if spots and not look.converges:
        # levels that do not converge to the reference coincide: one name will do
        _, x, y = spots[-1]
        _name(ax, look, (x, y))


def _arrow(ax, spot: tuple[float, float], colour: str) -> None:
    """Below a point on the band: the error may be smaller."""
    ax.annotate(
        "",
        spot,
        xytext=(0, -13),
        textcoords="offset points",
        zorder=3,
        arrowprops={"arrowstyle": "<|-", "color": colour, "lw": 1.1, "shrinkB": 3},
    )


def _beside(ax, spot: tuple[float, float], text: str, colour: str) -> None:
    ax.annotate(
        text,
        spot,
        xytext=(-4, -3),
        textcoords="offset points",
        ha="right",
        va="top",
        fontsize=7,
        color=colour,
    )


def _name(ax, look: Look, spot: tuple[float, float]) -> None:
    """The name of a series beside its last point; a lumped model's, which lies close to that of a
    beam, below it.
    """
    place: dict[str, Any] = {"xytext": (6, 5)}
    if look.family == "lumped":
        place = {"xytext": (0, -8), "ha": "center", "va": "top"}
    ax.annotate(
        look.series, spot, textcoords="offset points", fontsize=8, color=look.colour, **place
    )


def _crosses(ax, rows: list[Row], quantity: str, cost: str, height: float) -> None:
    """Rows that failed, or have no such number, at the top."""
    colour = Look(rows[0].series, rows[0].family).colour
    for row in rows:
        failed = row.status == "failed" or (row.status == "ok" and quantity not in row.errors)
        if failed and getattr(row, cost):
            ax.plot([getattr(row, cost)], [height], "x", ms=8, mew=2, color=colour, zorder=4)
