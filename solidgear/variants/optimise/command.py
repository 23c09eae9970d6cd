"""Command ``optimise``: search for the entries of a scene that reach a goal best; its table and chart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import command
from solidgear.show.options import AUTO, BY_MODEL, AutoChoice, CaseName, Run, relative
from solidgear.show.plot import Make
from solidgear.show.remarks import document_under
from solidgear.show.sheet import Sheet, Terminal, present
from solidgear.show.table import NUMBER, Column, Table, text
from solidgear.show.units import ENGINEERING, Units
from solidgear.variants.optimise.charts import FRONT, KEPT, designs_chart, front_chart, look_of
from solidgear.variants.optimise.optimise import Design, Optimum
from solidgear.variants.optimise.optimise import optimise as optimised
from solidgear.variants.optimise.sentences import ROUNDING, sentences

#: designs that a terminal shows
FEW = 5


@command
def optimise(
    scene: Annotated[Path, typer.Argument(help="Scene or train file (TOML).")],
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            help='PATH=LOW:HIGH, such as "bearing.B.position=180 mm:240 mm", or a list, PATH=A,B,C, '
            'such as "bearing.A.catalogue.designation=7208 B,7210 B"; repeatable.',
        ),
    ] = None,
    goal: Annotated[
        list[str],
        typer.Option(
            "--goal",
            help='"max NUMBER" or "min NUMBER", such as "max bending 1", "max life" or another column '
            "of the sweep of the file; given twice it makes a front.",
        ),
    ],
    keep: Annotated[
        list[str] | None,
        typer.Option(
            "--keep",
            help='Limit, such as "C_zz < 5 um/kN", "mass < 12 kg" or "life > 20000 h"; repeatable.',
        ),
    ] = None,
    keep_sum: Annotated[
        list[str] | None,
        typer.Option("--keep-sum", help="PATH+PATH: their sum stays as in the file."),
    ] = None,
    follow: Annotated[
        list[str] | None,
        typer.Option(
            "--follow", help="PATH: a diameter that follows the bore of a designation that varies."
        ),
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
    most: Annotated[
        int | None,
        typer.Option("--most", help="Designs that are solved at most; 500 for each goal."),
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
            follow=follow or (),
            model=None if model == AUTO else str(model),
            tol=tol,
            most=most,
            point=point,
            every_point=every_point,
            progress=progress,
        ).sheet(),
        run,
        out,
    )


def optimum_sheet(optimum: Optimum, units: Units = ENGINEERING) -> Sheet:
    """Return the sheet of a search."""
    title = f"{optimum.scene}: {' and '.join(map(str, optimum.goals))}"
    tables = {"designs": designs(optimum)}
    charts: dict[str, Make] = {"designs": partial(designs_chart, optimum, title)}
    if optimum.front:
        tables = {"front": front(optimum)} | tables
        charts = {"front": partial(front_chart, optimum, title, units)}
    return Sheet(
        name="optimum",
        title=title,
        lead=f"Every design solved by {optimum.solved}.",
        tables=[*tables.values()],
        data=optimum.results,
        charts=charts,
        lines=tables,
        notes=[*sentences(optimum, units)],
        cautions=optimum.cautions,
        reached=optimum.best is not None,
        terminal=Terminal(
            heading=[optimum.scene],
            tables=[front(optimum) if optimum.front else _best_designs(optimum)],
        ),
        words={
            "designs": "The goal in every design solved, each with its error bar.",
            "front": "Both goals in every design solved; the line joins those that none beats in both.",
        },
    )


def designs(optimum: Optimum) -> Table:
    """Return the table of all designs in the order in which they were solved."""
    note = "SI. Design 0 is the file as it is."
    return _table(optimum, optimum.path, "Designs", note)


def _best_designs(optimum: Optimum) -> Table:
    """Return the table of the few best designs, the best first."""
    upward = optimum.goal.upward
    sound = [design for design in optimum.path if design.kept and design.value is not None]
    few = sorted(sound, key=lambda d: (-1 if upward else 1) * (d.value or 0.0))[:FEW]
    return _table(optimum, few, "Best designs", "SI. Design 0 is the file as it is.")


def front(optimum: Optimum) -> Table:
    """Return the table of the designs of a front."""
    return _table(optimum, optimum.front, "Front", "SI. None of these is beaten in both goals.")


def _table(optimum: Optimum, rows: Sequence[Design], title: str, note: str) -> Table:
    """Return a table of designs with values and goals."""
    words = {
        label
        for design in optimum.path
        for label, value in design.values.items()
        if isinstance(value, str)
    }
    columns = [
        Column("", kind=NUMBER, name="design"),
        *(
            replace(text(_head(label)), name=label)
            if label in words
            else Column(_head(label), write="{:.6g}".format, kind=NUMBER, name=label)
            for label in optimum.path[0].values
        ),
    ]
    for goal in optimum.goals:
        columns += [
            Column(goal.name, write="{:.6g}".format, kind=NUMBER),
            Column("bar", write="{:.2g}".format, kind=NUMBER, name=f"{goal.name} error bar"),
        ]
    columns.append(replace(text(""), name="status"))
    cells = [
        [
            design.number,
            *design.values.values(),
            *_goals(optimum, design),
            _remark(optimum, design),
        ]
        for design in rows
    ]
    return Table(title, columns, cells, note, style="ruled")


def _goals(optimum: Optimum, design: Design) -> list[float | None]:
    """Return the numbers of all goals of a design, with error bars."""
    if not design.goals:
        return [None, None] * len(optimum.goals)
    out: list[float | None] = []
    for value, bar in design.goals:
        out += [value, bar if bar and bar > ROUNDING * abs(value) else None]
    return out


def _head(label: str) -> str:
    """Return the path of an entry as the head of a column: the last word below the others."""
    before, _, last = label.rpartition(".")
    return f"{before}\n{last}" if before and "+" not in label else label


def _remark(optimum: Optimum, design: Design) -> str:
    if design.status != "ok":
        return design.status[:60]
    look = look_of(optimum, design)
    return "" if look == KEPT else "front" if look == FRONT else look
