"""A race as a figure: error against cost, one line of panels a quantity."""

from __future__ import annotations

import io
import textwrap
from pathlib import Path
from typing import Any

from solidgear.evidence.pareto import Race, Row
from solidgear.report.chart_style import STYLE
from solidgear.report.race_rows import COSTS, left_out, replace_file
from solidgear.report.words import count, is_number, percent, seconds

COLOUR = {
    "lumped": "#b3305c",
    "beam": "#0072b2",
    "harmonic": "#00805e",
    "tetrahedra": "#d08a00",
    "hexahedra": "#5a3e8c",
}
FAMILY_NAME = {
    "lumped": "lumped",
    "beam": "beams",
    "harmonic": "harmonic solid",
    "tetrahedra": "3D, tetrahedra",
    "hexahedra": "3D, hexahedra",
}
MARKER = {
    "lumped": "P",
    "Euler": "v",
    "Timoshenko": "s",
    "harmonic h": "o",
    "harmonic p": "D",
    "TET4": "<",
    "TET10": "^",
    "HEX8": "s",
    "HEX20": "D",
    "HEX27": "h",
}
QUANTITY = {"C_zz": "port compliance C_zz", "bending 1": "first bending frequency"}


def draw(race: Race, path) -> Path:
    """Draw the figure of a race as a PNG.

    Returns
    -------
    pathlib.Path
    """
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()  # the user's own matplotlibrc must not change a figure
        matplotlib.rcParams.update(STYLE)
        target = io.BytesIO()
        figure(race).savefig(target, format="png", dpi=150, metadata={"Software": None})
    replace_file(Path(path), target.getvalue())
    return Path(path)


def figure(race: Race):
    """Panels of error over seconds and over unknowns, one line of panels a quantity, log-log."""
    from matplotlib.figure import Figure

    quantities = list(race.reference["values"])
    out = Figure(figsize=(13.2, 1.5 + 4.1 * len(quantities)), layout="constrained")
    axes = out.subplots(len(quantities), len(COSTS), squeeze=False, sharex="col", sharey="row")
    for line, quantity in zip(axes, quantities):
        for ax, cost in zip(line, COSTS):
            _panel(ax, race, quantity, cost)
        line[0].set_ylabel(f"error of {QUANTITY[quantity]}")
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
        handles=_legend(race),
        loc="outside right upper",
        fontsize=8.5,
        handlelength=3.2,
        labelspacing=0.45,
    )
    out.supxlabel(_footer(race), x=0.01, ha="left", fontsize=8, color="#444444", linespacing=1.45)
    return out


def _panel(ax, race: Race, quantity: str, cost: str) -> None:
    from matplotlib.ticker import FuncFormatter, NullFormatter

    ax.set(xscale="log", yscale="log")
    band = race.reference["bands"][quantity]
    shown = [r for r in race.rows if race.error(r, quantity) is not None]
    steps = race.front(quantity, cost)
    costs = [
        getattr(r, cost) for r in race.rows if r.status in ("ok", "failed") and getattr(r, cost)
    ] or [1.0]
    left, right = min(costs) / 2.2, max(costs) * 2.2
    errors = [race.error(r, quantity) for r in shown] + [
        race.error(r, quantity) and r.like_for_like.get(quantity) or band for r in shown
    ]
    errors = [e for e in errors if e > 0] or [1e-3]
    top, low = max(errors) * 4, max(band / 2.5, min(e for e in errors if e > 0) / 40)

    # a band far below every error is named at the bottom, so that it does not squeeze what there is
    # to see
    if band > 0:
        ax.axhspan(low, max(band, low), color="#00805e", alpha=0.13, lw=0)
    ax.annotate(
        f"band of the reference {percent(band, signed=False)}"
        + ("" if band > low else ", below this axis"),
        (0.01, max(band, low)),
        xycoords=("axes fraction", "data"),
        xytext=(0, 3),
        textcoords="offset points",
        fontsize=7.5,
        color="#00603f",
        va="bottom",
    )
    tolerance = (race.scene.get("ask") or {}).get("tolerance")
    if is_number(tolerance) and low < tolerance < top:
        ax.axhline(tolerance, color="#aa2222", lw=0.8, ls=":")
        ax.annotate(
            f"tolerance {100 * tolerance:.4g} %",
            (0.995, tolerance),
            xycoords=("axes fraction", "data"),
            xytext=(0, 2),
            textcoords="offset points",
            ha="right",
            fontsize=7.5,
            color="#aa2222",
        )
    if steps:
        xs, ys = [getattr(r, cost) for r in steps], [race.sure_error(r, quantity) for r in steps]
        ax.step(
            [xs[0], *xs, right],
            [top, *ys, ys[-1]],
            where="post",
            color="#9a9a9a",
            lw=5,
            alpha=0.45,
            solid_joinstyle="miter",
            zorder=1.5,
        )
    for name in dict.fromkeys(r.series for r in race.rows):
        _series(ax, race, [r for r in race.rows if r.series == name], quantity, cost, top)
    if cost in race.reference:
        ax.plot(
            [race.reference[cost]],
            [max(band, low)],
            "*",
            ms=11,
            color="#00603f",
            mfc="white",
            zorder=4,
            clip_on=False,
        )
        right = max(right, 1.5 * race.reference[cost])
    ax.set(xlim=(left, right), ylim=(low, top))
    ax.xaxis.set_major_formatter(
        FuncFormatter(lambda v, _: f"{v:g}" if cost == "seconds" else count(v))
    )
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{100 * v:.6g} %"))
    ax.yaxis.set_minor_formatter(NullFormatter())
    setup = sum(race.setup.values())
    if cost == "seconds" and left < setup < right:
        ax.axvline(setup, color="#777777", lw=0.9, ls=(0, (1, 2)))
        ax.annotate(
            "set-up, once a process",
            (setup, 0.985),
            xycoords=("data", "axes fraction"),
            xytext=(-3, 0),
            textcoords="offset points",
            rotation=90,
            ha="right",
            va="top",
            fontsize=7.5,
            color="#666666",
        )


def _series(ax, race: Race, rows: list[Row], quantity: str, cost: str, top: float) -> None:
    colour, marker = COLOUR[rows[0].family], MARKER.get(_kind(rows[0].series), "o")
    dashed = rows[0].series.endswith("uniform")
    good = [r for r in rows if race.error(r, quantity) is not None]
    xs, ys = [getattr(r, cost) for r in good], [race.error(r, quantity) for r in good]
    ax.plot(
        xs,
        ys,
        ls="--" if dashed else "-",
        color=colour,
        lw=1.0 if dashed else 1.5,
        alpha=0.75 if dashed else 1.0,
        zorder=2,
    )
    for r, x, y in zip(good, xs, ys):
        ax.plot(
            [x], [y], marker, ms=5.5, color=colour, mfc=_fill(colour, dashed), mew=1.0, zorder=3
        )
        if not race.resolved(r, quantity):
            ax.annotate(
                "",
                (x, y),
                xytext=(0, -13),
                textcoords="offset points",
                zorder=3,
                arrowprops={"arrowstyle": "<|-", "color": colour, "lw": 1.1, "shrinkB": 3},
            )
        if cost == "seconds" and len(r.samples) > 1:
            ax.hlines(
                y, min(r.samples), max(r.samples), color=colour, lw=0.9, alpha=0.45, zorder=1.8
            )
        if rows[0].series == "harmonic p graded":
            ax.annotate(
                f"p{r.options['order']}",
                (x, y),
                xytext=(-4, -3),
                textcoords="offset points",
                ha="right",
                va="top",
                fontsize=7,
                color=colour,
            )
        like = r.like_for_like.get(quantity)
        if rows[0].family in ("lumped", "beam") and like:
            ax.plot([x, x], [y, like], ":", color=colour, lw=1.1, zorder=1.9)
            ax.plot([x], [like], marker, ms=5.5, color=colour, mfc="white", mew=1.1, zorder=3)
    if rows[0].family in ("lumped", "beam") and good:
        # beams do not converge to the reference: their levels coincide, one name will do
        place = (
            {"xytext": (0, -8), "ha": "center", "va": "top"}
            if rows[0].family == "lumped"
            else {"xytext": (6, 5)}
        )
        ax.annotate(
            rows[0].series,
            (xs[-1], ys[-1]),
            textcoords="offset points",
            fontsize=8,
            color=colour,
            **place,
        )
    for r in rows:
        failed = r.status == "failed" or (r.status == "ok" and quantity not in r.errors)
        if failed and getattr(r, cost):
            ax.plot([getattr(r, cost)], [top / 1.5], "x", ms=8, mew=2, color=colour, zorder=4)


def _fill(colour: str, pale: bool):
    """A pale fill for uniform meshes; an empty marker means like for like."""
    from matplotlib.colors import to_rgb

    return tuple(0.35 * c + 0.65 for c in to_rgb(colour)) if pale else colour


def _kind(series: str) -> str:
    return series.removesuffix(" uniform").removesuffix(" graded")


def _legend(race: Race) -> list:
    from matplotlib.lines import Line2D

    handles = []
    for family, name in FAMILY_NAME.items():
        series = list(dict.fromkeys(r.series for r in race.rows if r.family == family))
        if not series:
            continue
        if family != "lumped":
            handles.append(Line2D([], [], ls="", label=name.upper()))
        for s in series:
            dashed = s.endswith("uniform")
            line: dict[str, Any] = {
                "ls": "" if family in ("lumped", "beam") else "--" if dashed else "-",
                "lw": 1.0 if dashed else 1.5,
            }
            name = (
                s.replace("harmonic ", "")
                .replace("h ", "h, order 2, ")
                .replace("p ", "p, order 1 up, ")
            )
            handles.append(
                Line2D(
                    [],
                    [],
                    color=COLOUR[family],
                    mfc=_fill(COLOUR[family], dashed),
                    marker=MARKER.get(_kind(s), "o"),
                    ms=5.5,
                    label=name,
                    **line,
                )
            )
    handles += [
        Line2D([], [], ls="", label=""),
        Line2D(
            [],
            [],
            ls=":",
            marker="s",
            mfc="white",
            color=COLOUR["beam"],
            ms=5.5,
            label="like for like:\nsection ties on both sides",
        ),
        Line2D(
            [],
            [],
            color="#9a9a9a",
            lw=5,
            alpha=0.45,
            label="Pareto front,\ncancellations not counted",
        ),
        Line2D(
            [],
            [],
            ls="",
            marker="*",
            ms=11,
            mfc="white",
            color="#00603f",
            label="the reference itself",
        ),
        Line2D(
            [], [], ls="", marker=7, ms=8, color="#555555", label="below the band: not resolved"
        ),
        Line2D(
            [],
            [],
            ls="",
            marker="x",
            ms=8,
            mew=2,
            color="#555555",
            label="failed, or no such number",
        ),
    ]
    return handles


def _footer(race: Race) -> str:
    reference, machine = race.reference, race.environment
    runs = [len(r.samples) for r in race.rows if r.status == "ok"]
    lines = [
        f"Reference: harmonic solid, {', '.join(f'{k} {v}' for k, v in reference['options'].items())}, {reference['unknowns']} unknowns, {seconds(reference['seconds'])} s; "
        f"its band is the grid convergence index of orders {reference['options']['order'] - 2} to {reference['options']['order']}.",
        f"Time: new body, six loads, {race.modes} modes; median of {race.runs} interleaved runs"
        + (f" (slow cases down to {min(runs)})" if runs and min(runs) < race.runs else "")
        + (
            ". Set-up, not in it: "
            + ", ".join(f"{k} {seconds(v)} s" for k, v in race.setup.items())
            if race.setup
            else ""
        )
        + ".",
        f"{machine.get('cpu')}, {machine.get('cores')} cores, {machine.get('date')}; the whole chart took {race.seconds:.0f} s.",
    ]
    if left_out(race):
        lines += textwrap.wrap(
            f"Left out ({race.budget:g} s allowed): {left_out(race)}; reasons in rows.csv.", 190
        )
    return "\n".join(lines)
