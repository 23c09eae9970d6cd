"""The command that answers a question from the cheapest model."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated

import typer

from solidgear.cli.app import NOT_REACHED, JsonFlag, Progress, SceneFile, command, console

if TYPE_CHECKING:
    from rich.table import Table

    from solidgear.studies.answering import Answered, Step
    from solidgear.studies.settle import Settled


@command
def answer(
    scene: SceneFile,
    tol: Annotated[
        float | None,
        typer.Option("--tol", help="Relative error allowed, such as 1e-3; else the scene's own."),
    ] = None,
    ask: Annotated[
        str,
        typer.Option(
            "--ask",
            help="Comma-separated: C_zz, K_thx, bending, ...; by default what the scene asks for.",
        ),
    ] = "",
    as_json: JsonFlag = False,
) -> None:
    """Numbers within a tolerance, each with its bar, from the cheapest model that can show it."""
    from solidgear.scene.file import load
    from solidgear.studies.answering import answer as solve

    loaded = load(scene)
    with Progress(quiet=as_json) as progress:
        found = solve(loaded, tol, ask, progress=progress)
    if as_json:
        print(json.dumps(found.as_dict(), allow_nan=False))
    else:
        terminal = console()
        terminal.print(_values(found))
        terminal.print(_path(found))
        for line in sentences(found):
            terminal.print(line, markup=False, soft_wrap=True)
    if not found.reached:
        raise typer.Exit(NOT_REACHED)


def _values(found: Answered) -> Table:
    from rich import box
    from rich.table import Table

    from solidgear.report.words import engineering, percent

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("quantity")
    table.add_column("value", justify="right")
    table.add_column("unit")
    table.add_column("bar", justify="right")
    table.add_column("from")
    for row in found.values:
        bar = f"+- {percent(row.bar, signed=False)}"
        table.add_row(row.quantity, engineering(row.value, 6), row.unit, bar, row.how)
    return table


def _path(found: Answered) -> Table:
    from rich import box
    from rich.table import Table

    from solidgear.report.words import count, percent, seconds

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("tried")
    table.add_column("mesh")
    table.add_column("dofs", justify="right")
    table.add_column("bar", justify="right")
    table.add_column("time, s", justify="right")
    for step in _solved(found):
        name = f"{step.rung}, chosen" if step.chosen else step.rung
        bar = percent(step.bar, signed=False)
        table.add_row(name, step.setting, count(step.unknowns), bar, seconds(step.seconds))
    return table


def _solved(found: Answered) -> list[Step]:
    return [step for step in found.steps if step.unknowns is not None]


def sentences(found: Answered | Settled) -> list[str]:
    """What was chosen, what was passed over and why, in plain text."""
    from solidgear.report.words import percent

    passed: dict[str, list[str]] = {}
    for step in found.steps:
        if not step.valid:
            passed.setdefault(step.why, []).append(step.rung)
    lines = [f"Passed over: {', '.join(names)}: {why}." for why, names in passed.items()]
    if found.missing:
        lines.append(
            f"Not there: {', '.join(found.missing)} (a free motion, or no such mode among the lowest)."
        )
    asked = percent(found.tolerance, signed=False)
    cost = sum(step.seconds for step in found.steps)
    if found.reached:
        lines.append(f"Within {asked}: {found.rung}, {cost:.2g} s for all meshes tried.")
        return lines
    why = next((step.why for step in found.steps if step.chosen and step.why), "")
    lines.append(f"Not reached: {asked} was asked for{f'; {why}' if why else ''}.")
    return lines
