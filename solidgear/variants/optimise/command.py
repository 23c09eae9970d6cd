"""Command ``optimise``: search for the entries of a scene that reach a goal best; its table and chart."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import command
from solidgear.show.options import AUTO, BY_MODEL, AutoChoice, CaseName, Run, relative
from solidgear.show.panel import GREY, Panel, Series, readout
from solidgear.show.plot import WIDE, Chart
from solidgear.show.remarks import document_under
from solidgear.show.scales import Axis
from solidgear.show.sheet import Sheet, Terminal, present
from solidgear.show.table import NUMBER, Column, Table, text
from solidgear.show.units import ENGINEERING, Units
from solidgear.variants.optimise.optimise import Design, Optimum
from solidgear.variants.optimise.optimise import optimise as optimised


@command
def optimise(
    scene: Annotated[Path, typer.Argument(help="Scene or train file (TOML).")],
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary", help='PATH=LOW:HIGH, such as "bearing.B.position=180 mm:240 mm"; repeatable.'
        ),
    ] = None,
    goal: Annotated[
        str,
        typer.Option(
            "--goal",
            help='"max NUMBER" or "min NUMBER", such as "max bending 1"; of a train a column of its '
            'sweep, such as "min transmission_error".',
        ),
    ],
    keep: Annotated[
        list[str] | None,
        typer.Option(
            "--keep", help='Limit, such as "C_zz < 5 um/kN" or "mass < 12 kg"; repeatable.'
        ),
    ] = None,
    keep_sum: Annotated[
        list[str] | None,
        typer.Option("--keep-sum", help="PATH+PATH: their sum stays as in the file."),
    ] = None,
    model: Annotated[
        AutoChoice,
        typer.Option(
            *BY_MODEL, help="Model of every design; of one that is given there are no bars."
        ),
    ] = AUTO,
    tol: Annotated[
        float | None,
        relative(
            "--tol", "Bar allowed of every design; a tenth of the scene's tolerance by default."
        ),
    ] = None,
    point: Annotated[
        str | None,
        typer.Option("--point", help="Of a train: operating point, by name or number; the first."),
    ] = None,
    every_point: Annotated[
        bool,
        typer.Option(
            "--every-point",
            help="Of a train: goal and limits hold for the worst of all operating points.",
        ),
    ] = False,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder for a page, data, table and chart.")
    ] = None,
    case: CaseName = None,
    run: Run,
) -> None:
    present(
        lambda progress: optimised(
            document_under(scene, case),
            vary or (),
            goal,
            keep or (),
            keep_sum=keep_sum or (),
            model=None if model == AUTO else str(model),
            tol=tol,
            point=point,
            every_point=every_point,
            progress=progress,
        ).sheet(),
        run,
        out,
    )


def optimum_sheet(optimum: Optimum, units: Units = ENGINEERING) -> Sheet:
    """Return the sheet of a search, whose numbers are in SI as those of the file are."""
    title = f"{optimum.scene}: {optimum.goal}"
    return Sheet(
        name="optimum",
        title=title,
        lead=f"Every design solved by {optimum.solved}.",
        tables=[designs(optimum)],
        data=optimum.results,
        charts={"designs": partial(designs_chart, optimum, title)},
        lines={"designs": designs(optimum)},
        notes=optimum.sentences,
        reached=optimum.best is not None,
        terminal=Terminal(heading=[optimum.scene]),
        words={"designs": "The goal in every design solved, each with its error bar."},
    )


KEPT, MISSED, BEST = "keeps every limit", "misses a limit", "best"
LOOKS = {
    KEPT: Series("#00805e"),
    MISSED: Series("#b3305c", "square"),
    BEST: Series("#0072b2", "diamond"),
}


def designs(optimum: Optimum) -> Table:
    """Return the table of all designs in the order in which they were solved."""
    labels = list(optimum.path[0].values)
    columns = [
        Column("", kind=NUMBER, name="design"),
        *(Column(label, write="{:.6g}".format, kind=NUMBER) for label in labels),
        Column(optimum.goal.name, write="{:.6g}".format, kind=NUMBER),
        Column("bar", write="{:.2g}".format, kind=NUMBER, name=f"{optimum.goal.name} error bar"),
        replace(text(""), name="status"),
    ]
    rows = [
        [d.number, *d.values.values(), d.value, d.bar, _remark(optimum, d)] for d in optimum.path
    ]
    note = "SI. Design 0 is the file as it is."
    return Table("Designs", columns, rows, note, style="ruled")


def _remark(optimum: Optimum, design: Design) -> str:
    if design.status != "ok":
        return design.status[:60]
    return _look(optimum, design).replace(KEPT, "")


def _look(optimum: Optimum, design: Design) -> str:
    if design is optimum.best:
        return BEST
    return KEPT if design.kept else MISSED


def designs_chart(optimum: Optimum, title: str, width: float = WIDE) -> Chart:
    """Draw the goal over the one entry that varies, or over the number of the design."""
    labels = list(optimum.path[0].values)
    solved = [
        (design, design.value, design.bar or 0.0)
        for design in optimum.path
        # the file as it is may not hold the entry
        if design.value is not None and (len(labels) > 1 or design.values[labels[0]] is not None)
    ]
    over = labels[0] if len(labels) == 1 else "design"
    x = [d.values[over] if len(labels) == 1 else d.number for d, _, _ in solved]
    low = min(value - bar for _, value, bar in solved)
    high = max(value + bar for _, value, bar in solved)
    room = 0.08 * (high - low) or abs(high)
    edge = 0.03 * (max(x) - min(x)) or 1.0
    panel = Panel(
        Axis(over if len(labels) > 1 else f"{over}, SI", (min(x) - edge, max(x) + edge)),
        Axis(f"{optimum.goal.name}, SI", (low - room, high + room)),
        300.0,
        series=LOOKS,
        legend={"orient": "top"},
    )
    bars = [
        {"x": place, "y": value - bar, "y2": value + bar}
        for place, (_, value, bar) in zip(x, solved)
        if bar
    ]
    panel.draw({"type": "rule", "color": GREY, "strokeWidth": 2}, bars)
    points = []
    for place, (design, value, _) in zip(x, solved):
        numbers = {**design.values, optimum.goal.name: value}
        facts = [
            (label, "as it is" if number is None else f"{number:.6g}", "")
            for label, number in numbers.items()
        ]
        words = readout(f"design {design.number}", *facts)
        points.append({"x": place, "y": value, "name": _look(optimum, design), "readout": words})
    panel.draw({"type": "point", "filled": True, "size": 60}, points)
    return Chart([[panel]], width, title)
