"""Command ``optimise``: search for the entries of a scene that reach a goal best; its table and chart."""

from __future__ import annotations

import json
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from solidgear.show.command import NOT_REACHED, command, say
from solidgear.show.folder import held
from solidgear.show.options import AUTO, BY_MODEL, AutoChoice, Run, relative
from solidgear.show.panel import GREY, Axis, Panel, Series, readout
from solidgear.show.plot import WIDE, Chart
from solidgear.show.sheet_files import write_files
from solidgear.show.table import NUMBER, Column, Table, text
from solidgear.variants.optimise.optimise import optimise as optimised


@command
def optimise(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary", help='PATH=LOW:HIGH, such as "bearing.B.position=180 mm:240 mm"; repeatable.'
        ),
    ] = None,
    goal: Annotated[
        str, typer.Option("--goal", help='"max NUMBER" or "min NUMBER", such as "max bending 1".')
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
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder for a page, data, table and chart.")
    ] = None,
    run: Run,
) -> None:
    with held(out) if out else nullcontext(), run.progress() as progress:
        optimum = optimised(
            scene,
            vary or (),
            goal,
            keep or (),
            keep_sum=keep_sum or (),
            model=None if model == AUTO else str(model),
            tol=tol,
            progress=progress,
        )
        files = write_optimum(out, optimum) if out else []
    if run.as_json:
        print(json.dumps(optimum.results, allow_nan=False))
    else:
        say(optimum.scene, designs(optimum), *optimum.sentences, soft_wrap=False)
        if files:
            say(f"Written: {', '.join(map(str, files))}", soft_wrap=False)
    if optimum.best is None:
        raise typer.Exit(NOT_REACHED)


KEPT, MISSED, BEST = "keeps every limit", "misses a limit", "best"
LOOKS = {
    KEPT: Series("#00805e"),
    MISSED: Series("#b3305c", "square"),
    BEST: Series("#0072b2", "diamond"),
}


def designs(optimum: Any) -> Table:
    """Return the table of all designs in the order in which they were solved."""
    labels = list(optimum.path[0].values)
    columns = [
        Column("", kind=NUMBER),
        *(Column(label, write="{:.6g}".format, kind=NUMBER) for label in labels),
        Column(optimum.goal.name, write="{:.6g}".format, kind=NUMBER),
        Column("bar", write="{:.2g}".format, kind=NUMBER),
        text(""),
    ]
    rows = [
        [d.number, *d.values.values(), d.value, d.bar, _remark(optimum, d)] for d in optimum.path
    ]
    note = "SI. Design 0 is the file as it is."
    return Table("Designs", columns, rows, note, style="ruled")


def _remark(optimum: Any, design: Any) -> str:
    if design.status != "ok":
        return str(design.status)[:60]
    look = _look(optimum, design)
    return "" if look == KEPT else look


def _look(optimum: Any, design: Any) -> str:
    if optimum.best is not None and design.number == optimum.best.number:
        return BEST
    return KEPT if design.kept else MISSED


def designs_chart(optimum: Any, title: str, width: float = WIDE) -> Chart:
    """Draw the goal over the one entry that varies, or over the number of the design."""
    solved = [design for design in optimum.path if design.value is not None]
    labels = list(optimum.path[0].values)
    over = labels[0] if len(labels) == 1 else "design"
    x = [d.values[over] if len(labels) == 1 else d.number for d in solved]
    low = min(d.value - (d.bar or 0.0) for d in solved)
    high = max(d.value + (d.bar or 0.0) for d in solved)
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
        {"x": place, "y": design.value - design.bar, "y2": design.value + design.bar}
        for place, design in zip(x, solved)
        if design.bar
    ]
    panel.draw({"type": "rule", "color": GREY, "strokeWidth": 2}, bars)
    rows = []
    for place, design in zip(x, solved):
        facts = [(label, f"{value:.6g}", "") for label, value in design.values.items()]
        goal = (optimum.goal.name, f"{design.value:.6g}", "")
        rows.append(
            {
                "x": place,
                "y": design.value,
                "name": _look(optimum, design),
                "readout": readout(f"design {design.number}", *facts, goal),
            }
        )
    panel.draw({"type": "point", "filled": True, "size": 60}, rows)
    return Chart([[panel]], width, title)


def write_optimum(folder: Path, optimum: Any) -> list[Path]:
    """Write page, data, table and chart of a search into a folder."""
    title = f"{optimum.scene}: {optimum.goal}"
    lead = "Every design solved by the cheapest mesh whose bars are within the tolerance."
    return write_files(
        folder,
        "optimum",
        title,
        lead,
        [designs(optimum)],
        optimum.results,
        lines={"designs": designs(optimum)},
        charts={"designs": partial(designs_chart, optimum, title)},
        notes=optimum.sentences,
    )
