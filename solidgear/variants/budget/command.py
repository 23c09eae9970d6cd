"""Command ``budget``: the range of every number by every open input."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import SolidgearError, listed
from solidgear.core.judge.answer import asked_for
from solidgear.show.command import Progress, command
from solidgear.show.options import CaseName, Run, SceneFile
from solidgear.show.plot import check_ending
from solidgear.show.remarks import load
from solidgear.show.sheet import Sheet, present
from solidgear.variants.budget.budget import budget as solve_budget
from solidgear.variants.budget.chart import budget_chart, budget_sheet


@command
def budget(
    scene: SceneFile,
    *,
    ask: Annotated[
        str,
        typer.Option(
            "--ask", help="Numbers, comma-separated, as for answer; by default what is judged."
        ),
    ] = "",
    samples: Annotated[
        int,
        typer.Option("--samples", help="Number of random samples of all inputs together."),
    ] = 0,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Seed of the samples.")] = 0,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Chart of it: a file that ends in .png or .svg."),
    ] = None,
    case: CaseName = None,
    run: Run,
) -> None:
    if out is not None:
        check_ending(out)
    loaded = load(scene, case)
    names = asked_for(loaded, ask) if ask else ()

    def study(progress: Progress) -> Sheet:
        ranges = solve_budget(loaded, samples=samples, seed=seed, progress=progress)
        absent = [name for name in names if ranges.of(name) is None]
        if absent:
            raise SolidgearError(f"--ask: no range is known for {listed(absent)}")
        chart = budget_chart(ranges, asked=names)
        if out is not None and chart is not None:
            chart.write(out)
        sheet = budget_sheet(ranges, asked=names)
        return sheet if out is None else replace(sheet, notes=[f"Chart: {out}"])

    present(study, run)
