"""Command ``sensitivities``: derivatives of numbers of a shaft by the entries of its file; tables, chart
and files."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import command
from solidgear.show.options import Fixed, SceneFile, Shown, options
from solidgear.show.panel import Panel, Series, readout, wrapped
from solidgear.show.plot import NARROW, WIDE, Chart
from solidgear.show.scales import Axis, in_percent
from solidgear.show.sheet import Sheet, Terminal, present
from solidgear.show.table import Cell, Column, Table, text
from solidgear.show.units import Units
from solidgear.show.words import percent
from solidgear.variants.sensitivity.run import Derivative, OfNumber, Sensitivities
from solidgear.variants.sensitivity.run import sensitivities as derive


@command
def sensitivities(
    scene: SceneFile,
    *,
    of: Annotated[
        list[str] | None,
        typer.Option(
            "--of",
            help='What is to be moved, repeatable: "bending 1", C_zz, K_thx, C_zz@pinion. By default '
            "first bending and C_zz.",
        ),
    ] = None,
    by: Annotated[
        list[str] | None,
        typer.Option(
            "--by",
            help="Entries of the file, repeatable: bearing.A.position, or bearing.A for all of it. By "
            "default every number.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for a page, charts, sensitivities.csv and JSON."),
    ] = None,
    fixed: Fixed,
    run: Shown,
) -> None:
    builder_options = options(fixed.settings)
    present(
        lambda progress: derive(
            scene, fixed.name, of, by, progress=progress, **builder_options
        ).sheet(run.units),
        run,
        out,
    )


def sensitivities_sheet(result: Sensitivities, units: Units) -> Sheet:
    """Return the sheet of the derivatives of some numbers."""
    charts = {
        f"sensitivities_{k}": partial(chart, number) for k, number in enumerate(result.of, start=1)
    }
    without = [f"No derivative by {path}: {reason}." for path, reason in result.without.items()]
    return Sheet(
        name="sensitivities",
        title=f"{result.title}: sensitivities",
        lead=f"By the {result.model} model.",
        tables=[table(number, units) for number in result.of],
        data=result.as_dict(),
        charts=charts,
        lines={"sensitivities": lines(result)},
        notes=[*result.notes, *without],
        cautions=result.cautions,
        terminal=Terminal(heading=[f"{result.title}, by the {result.model} model"]),
        words=dict.fromkeys(charts, "Change of the number for one per cent more of each entry."),
    )


#: most rows of a table and bars of a chart; further entries move the number little
MOST = 15
#: smallest distance from the derivative on a coarser mesh that is shown, of the number
LEAST = 1e-4
#: px; height of a bar, and of names on a wide and on a narrow page
BAR, NAMES, NARROW_NAMES = 20.0, 250.0, 172.0
UP, DOWN = "a larger entry raises it", "a larger entry lowers it"


def strongest(number: OfNumber) -> list[Derivative]:
    """Return the derivatives by the entries that move a number most."""
    return [derivative for derivative in number.derivatives if derivative.elasticity][:MOST]


def table(number: OfNumber, units: Units) -> Table:
    """Return the table of the entries that move one number."""
    shown = strongest(number)
    columns: list[Column] = [
        text("entry of the file", lambda d: d.path),
        text("as written", lambda d: d.written),
        Column("for 1 % more", lambda d: d.elasticity / 100, percent, unit="1"),
        Column(
            "by its unit",
            lambda d: Cell(d.by, "", _by_unit(d, number.unit, units)),
            name="derivative",
        ),
    ]
    distances = [d.apart / 100 for d in shown if d.apart is not None]
    if max(distances, default=0.0) >= LEAST:
        columns.append(Column("mesh", lambda d: d.apart and d.apart / 100, _mesh))
    others = [d for d in number.derivatives if d not in shown]
    without_effect = sum(not d.elasticity for d in others)
    note = []
    if distances and max(distances) < LEAST:
        note.append(f"Mesh: below {percent(LEAST, signed=False)} everywhere.")
    if len(others) > without_effect:
        most = percent(abs(others[0].elasticity) / 100, signed=False)
        note.append(f"{len(others) - without_effect} more move it by {most} or less.")
    if without_effect:
        note.append(f"Without effect: {without_effect}.")
    value = units.text(number.value, number.unit)
    return Table(f"What would move {number.name} ({value})", columns, shown, " ".join(note))


def _by_unit(derivative: Derivative, unit: str, units: Units) -> str:
    """Return a derivative by one unit of the file, to four digits with its sign."""
    value = units.value(derivative.by_unit, unit) or 0.0
    return f"{value:+.4g} {units.unit(unit)} per {derivative.unit or '1'}"


def _mesh(share: float) -> str:
    if share < LEAST:
        return f"< {percent(LEAST, signed=False)}"
    return f"+- {percent(share, signed=False)}"


def lines(result: Sensitivities) -> Table:
    """Return the table of all derivatives for other programs, in SI."""
    heads = (
        "number",
        "value",
        "unit",
        "value from coarser mesh",
        "entry",
        "written",
        "at",
        "derivative",
        "elasticity",
        "elasticity from coarser mesh",
        "one-sided",
    )
    rows = [
        (
            number.name,
            number.value,
            number.unit,
            number.apart,
            d.path,
            d.written,
            d.at,
            d.by,
            d.elasticity,
            d.apart,
            d.side,
        )
        for number in result.of
        for d in number.derivatives
    ]
    return Table("sensitivities", [Column(head, write=repr) for head in heads], rows)


def chart(number: OfNumber, width: float = WIDE) -> Chart | None:
    """Draw bars of the change of one number for one per cent of each entry."""
    rows = strongest(number)
    if not rows:
        return None
    left = NAMES if width > NARROW else NARROW_NAMES
    names = {float(k): "\n".join(wrapped(d.path, left - 10)) for k, d in enumerate(rows)}
    thick = max(BAR, 15.0 * max(name.count("\n") + 1 for name in names.values()) + 2)
    top = 1.05 * abs(rows[0].elasticity) / 100
    panel = Panel(
        Axis(f"change of {number.name} for 1 % more", (-top, top), label=in_percent),
        Axis("", (len(rows) - 0.5, -0.5), ticks=names, grid=False),
        thick * len(rows),
        series={UP: Series("#0072b2"), DOWN: Series("#b3305c")},
        legend={"orient": "top", "symbolType": "square", "columns": 2 if width > NARROW else 1},
        left=left,
    )
    bars = [
        {
            "x": 0.0,
            "x2": d.elasticity / 100,
            "y": k - 0.38,
            "y2": k + 0.38,
            "name": UP if d.elasticity > 0 else DOWN,
            "readout": readout(
                d.path,
                ("in the file", d.written, ""),
                ("1 % more", percent(d.elasticity / 100), ""),
            ),
        }
        for k, d in enumerate(rows)
    ]
    panel.draw({"type": "rect", "strokeWidth": 0}, bars)
    return Chart([[panel]], width)
