"""Error against cost as a figure, as rows on file, as a table in the terminal and as a section of
the report.
"""

from __future__ import annotations

import base64
import csv
import io
import json
import logging
import textwrap
from collections.abc import Mapping
from dataclasses import asdict, fields
from pathlib import Path

from solidgear.evidence.pareto import CHARTED, Race, Row
from solidgear.report.chart_style import STYLE
from solidgear.report.table import Table
from solidgear.report.words import (
    count,
    is_number,
    percent,
    seconds,
)
from solidgear.whole_file import whole

log = logging.getLogger(__name__)

ROWS, MACHINE, PICTURE = "rows.csv", "machine.json", "speed_accuracy.png"
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
COSTS = {"seconds": "wall time from scene to both answers, s (median)", "unknowns": "unknowns"}
QUANTITY = {"C_zz": "port compliance C_zz", "bending 1": "first bending frequency"}
#: kinds of error in rows.csv besides those charted
WHOLE = "C 6x6"
CAPTION = (
    "Error against the refined harmonic solid with the attachments of the scene, over wall time and over unknowns. Solid lines: meshes graded to shoulders and seat ends; "
    "dashed and pale: uniform. Thin bars: fastest and slowest run. Beams tie to nodes and cannot average over a seat: filled is the error a user of this scene makes, tie "
    "included; hollow, at the other end of the dotted line, the error against the solid with section ties, like for like; where the hollow one lies higher, errors cancel. "
    "A sharp dip of a curve is a change of sign, not a good mesh. The grey steps are the Pareto front, on which no cancellation counts: a beam stands there with the "
    "larger of its two errors, a mesh with the largest of its own and those of finer meshes of its series. Points with an arrow, on the edge of the shaded band, lie below "
    "what the reference resolves. Crosses at the top failed, or found no such number; the reason is in rows.csv."
)


# ------------------------------------------------------------------------------------------------- files
def write_rows(race: Race, folder: Path) -> None:
    """Write ``rows.csv`` and ``machine.json`` into a folder, each in one step.

    What an earlier race left goes first: its record and its picture must not stand beside these
    rows, should the run be killed.
    """
    record = {f.name: getattr(race, f.name) for f in fields(race) if f.name != "rows"}
    if sum(len(row.samples) for row in race.rows) <= 1:
        for name in (MACHINE, PICTURE):
            (folder / name).unlink(missing_ok=True)
    _replace(folder / ROWS, _csv(race).encode())
    _replace(folder / MACHINE, (json.dumps(record, indent=1, allow_nan=False) + "\n").encode())


def read_race(folder) -> Race | None:
    """The race that `write_rows` left in a folder; None where there is none that can be read."""
    folder = Path(folder)
    if not (folder / MACHINE).exists() or not (folder / ROWS).exists():
        return None
    try:
        record = dict(json.loads((folder / MACHINE).read_text(encoding="utf-8")))
        with open(folder / ROWS, encoding="utf-8", newline="") as lines:
            race = Race(**record, rows=[_row(line) for line in csv.DictReader(lines)])
        records(race)  # what is not whole shows here, and not in the middle of a page
        return race
    except (OSError, ValueError, KeyError, TypeError) as error:
        log.warning("%s in %s cannot be read: %s", ROWS, folder, error)
        return None


def records(race: Race) -> list[dict]:
    """One flat record a row, as in ``rows.csv``; what a row does not have is None."""
    fronts = {(q, cost): race.front(q, cost) for q in race.reference["values"] for cost in COSTS}
    out = []
    for row in race.rows:
        samples = row.samples or [None]
        r = {
            k: v
            for k, v in asdict(row).items()
            if k not in ("options", "samples", "values", "errors", "like_for_like")
        }
        r |= {
            "options": options_text(row),
            "runs": len(row.samples),
            "seconds_min": min(samples),
            "seconds_median": row.seconds,
            "seconds_max": max(samples),
        }
        r["samples"] = " ".join(repr(s) for s in row.samples)
        r |= {_column(q): row.values.get(q) for q in CHARTED}
        r |= {f"error_{_column(q)}": row.errors.get(q) for q in (*CHARTED, WHOLE)}
        r |= {f"like_for_like_{_column(q)}": row.like_for_like.get(q) for q in CHARTED}
        for q in race.reference["values"]:
            r[f"resolved_{_column(q)}"] = (
                "" if q not in row.errors else "yes" if race.resolved(row, q) else "no"
            )
            r[f"front_{_column(q)}"] = " ".join(
                cost for cost in COSTS if any(row is other for other in fronts[q, cost])
            )
        out.append(r)
    return out


def options_text(row: Row) -> str:
    """Builder options as they follow ``--set``."""
    return " ".join(
        f"{k}={v:.6g}" if isinstance(v, float) else f"{k}={v}" for k, v in row.options.items()
    )


def _column(quantity: str) -> str:
    return quantity.replace(" ", "_")


def _csv(race: Race) -> str:
    rows, target = records(race), io.StringIO()
    if rows:
        writer = csv.DictWriter(target, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return target.getvalue()


def _row(line: Mapping[str, str]) -> Row:
    def numbers(names, prefix):
        return {q: float(line[prefix + _column(q)]) for q in names if line.get(prefix + _column(q))}

    options = dict(pair.split("=", 1) for pair in line["options"].split())
    return Row(
        line["family"],
        line["series"],
        int(line["level"]),
        line["model"],
        {k: _value(v) for k, v in options.items()},
        line["status"],
        line["reason"],
        int(line["unknowns"]) if line["unknowns"] else None,
        [float(s) for s in line["samples"].split()],
        numbers(CHARTED, ""),
        numbers((*CHARTED, WHOLE), "error_"),
        numbers(CHARTED, "like_for_like_"),
    )


def _value(text: str):
    try:
        return json.loads(text)
    except ValueError:
        return text


def _replace(path: Path, data: bytes) -> None:
    with whole(path) as partial:
        partial.write_bytes(data)


# ------------------------------------------------------------------------------------------------- figure
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
    _replace(Path(path), target.getvalue())
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
            line = {
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


def left_out(race: Race) -> str:
    """The levels that were left out, in a line; empty when there are none."""
    first: dict[str, int] = {}
    for r in race.rows:
        if r.status == "left out":
            first[r.series] = min(r.level, first.get(r.series, r.level))
    return ", ".join(f"{series} from level {level}" for series, level in first.items())


# ------------------------------------------------------------------------------------------------- tables
def front_rows(race: Race) -> list[tuple[Row, list[str]]]:
    """Rows on a front over seconds, cheapest first, and of which quantities."""
    on = {q: race.front(q) for q in race.reference["values"]}
    rows = [(r, [q for q in on if any(r is other for other in on[q])]) for r in race.rows]
    return sorted(((r, names) for r, names in rows if names), key=lambda pair: pair[0].seconds)


def error_text(race: Race, row: Row, quantity: str) -> str:
    """Error of a row in per cent, a beam's like for like after a stroke; what the reference does
    not resolve as its band.
    """
    found = race.error(row, quantity)
    if found is None:
        return "-"
    text = (
        percent(found, signed=False)
        if race.resolved(row, quantity)
        else f"< {percent(found, signed=False)}"
    )
    return text + (
        f" / {percent(row.like_for_like[quantity], signed=False)}"
        if quantity in row.like_for_like
        else ""
    )


def front_table(race: Race):
    """The Pareto front over seconds as a rich table of 80 columns."""
    from rich import box
    from rich.console import Group
    from rich.table import Table as RichTable
    from rich.text import Text

    names = {"bending 1": "f1"}
    table = RichTable(
        box=box.SIMPLE_HEAD,
        padding=0,
        collapse_padding=True,
        pad_edge=False,
        title="Pareto front over wall time",
        title_justify="left",
    )
    table.add_column("model", no_wrap=True)
    table.add_column("options")
    for head in ("DOFs", "s", *(f"error {names.get(q, q)}" for q in race.reference["values"])):
        table.add_column(head, justify="right", no_wrap=True)
    for row, on in front_rows(race):
        errors = (
            error_text(race, row, q).replace(" %", "%") + ("*" if q in on else " ")
            for q in race.reference["values"]
        )
        table.add_row(
            Text(row.series),
            Text(options_text(row) or "default"),
            count(row.unknowns),
            seconds(row.seconds),
            *errors,
        )
    notes = "*: on the front of this quantity; <: below the band of the reference\nafter the stroke: like for like, section ties on both sides; no cancellation counts"
    return Group(table, Text(notes))


def section(folder, scene: Mapping) -> dict | None:
    """What the report shows of a race in its folder: picture, words and tables; None where there is
    none of this scene.
    """
    race = read_race(folder) if folder is not None else None
    picture = Path(folder) / PICTURE if race else None
    if race is None or race.scene != scene or not picture.exists():
        return None
    head = [
        "model",
        "options",
        "unknowns",
        "seconds",
        *(f"error of {q}" for q in race.reference["values"]),
        "on the front of",
    ]
    note = "“<”: below the band of the reference, which is shown instead. After the stroke: like for like, with section ties on both sides. No cancellation counts on the front."
    rows = []
    for r, on in front_rows(race):
        errors = (error_text(race, r, q) for q in race.reference["values"])
        rows.append(
            [
                r.series,
                (options_text(r) or "default", "text"),
                f"{r.unknowns:,}".replace(",", " "),
                seconds(r.seconds),
                *errors,
                (", ".join(on), "text"),
            ]
        )
    lost = [
        [f"{r.series}, level {r.level}", (options_text(r), "text"), r.status, (r.reason, "text")]
        for r in race.rows
        if r.status != "ok" or r.reason
    ]
    return {
        "uri": f"data:image/png;base64,{base64.b64encode(picture.read_bytes()).decode()}",
        "caption": CAPTION,
        "tables": [
            Table("The Pareto front over wall time", head, rows, note),
            Table(
                "Set-up, once a process and in none of the times",
                ["what", "seconds"],
                [[k, seconds(v)] for k, v in race.setup.items()],
            ),
            Table(
                "Failed, left out, or with something missing",
                ["case", "options", "status", "reason"],
                lost,
            ),
        ],
    }
