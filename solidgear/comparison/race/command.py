"""Command on one scene: chart, error against cost."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Annotated

import typer

from solidgear.comparison.page.html import write_report
from solidgear.comparison.race.cases import plan, setup_seconds
from solidgear.comparison.race.figure import draw
from solidgear.comparison.race.pareto import Race
from solidgear.comparison.race.rows import PICTURE, left_out, records, write_rows
from solidgear.comparison.race.tables import front_table
from solidgear.comparison.race.timing import BUDGET, FULL_BUDGET, FULL_SURE, race
from solidgear.core import Record, Scene, SolidgearError
from solidgear.show.border import as_record
from solidgear.show.command import Progress, command, say
from solidgear.show.folder import clear_halves, held
from solidgear.show.options import Run, SceneFile
from solidgear.show.remarks import load


@command
def chart(
    scene: SceneFile,
    *,
    out: Annotated[
        Path,
        typer.Option(
            "--out",
            "-o",
            help="Folder for rows.csv, machine.json and speed_accuracy.png; a report of `compare` "
            "there gets the chart.",
        ),
    ] = Path("out"),
    full: Annotated[
        bool,
        typer.Option(
            "--full", help="More meshes, larger solids, a finer reference; an hour and more."
        ),
    ] = False,
    runs: Annotated[
        int, typer.Option("--runs", help="Runs of each case; slow cases get fewer.")
    ] = 5,
    budget: Annotated[
        float | None,
        typer.Option(
            "--budget",
            help="Seconds of processor time for the points, without the reference; meshes that do "
            "not fit are skipped and named. 120, or 3600 with --full.",
        ),
    ] = None,
    run: Run,
) -> None:
    raced, reported = run_chart(
        load(scene), out, full=full, runs=runs, budget=budget, quiet=run.as_json
    )
    if run.as_json:
        record = {
            "scene": raced.scene["name"],
            "complete": raced.complete,
            "reference": raced.reference,
            "setup": raced.setup,
            "seconds": raced.seconds,
            "rows": records(raced),
        }
        print(json.dumps(record, allow_nan=False))
    else:
        say(*front_table(raced), soft_wrap=False)
        failed = [row for row in raced.rows if row.status == "failed"]
        failures = (f"failed: {row.series}, level {row.level}: {row.reason}" for row in failed)
        say(*failures, soft_wrap=False)
        if left_out(raced):
            say(
                f"left out ({raced.budget:g} s of processor time for the points; reasons in "
                f"{out / 'rows.csv'}): {left_out(raced)}"
            )
        say(f"Chart: {out / PICTURE}" + (f", and in {out / 'report.html'}" if reported else ""))
    if not raced.complete:
        raise typer.Exit(130)


def run_chart(
    scene: Scene,
    out: Path,
    *,
    full: bool = False,
    runs: int = 5,
    budget: float | None = None,
    quiet: bool = False,
) -> tuple[Race, bool]:
    """Run and write the chart of a scene, and put it into the report that an earlier comparison of it left
    there; with whether there was such a report.

    SolidgearError for a bad number, a folder that cannot be written, a scene with nothing to chart or a
    comparison of it by another version of solidgear, before anything is timed; where no case has an
    answer.
    """
    if runs < 1:
        raise SolidgearError(f"--runs {runs}: give a whole number of at least 1")
    if budget is not None and not 0 < budget < float("inf"):
        raise SolidgearError(f"--budget {budget:g}: give seconds above 0")
    budget = budget or (FULL_BUDGET if full else BUDGET)
    try:
        with held(out) as folder, Progress(quiet=quiet) as progress:
            clear_halves(folder)
            earlier = _earlier(folder, scene)
            progress("set-up costs, in a fresh interpreter")
            setup = setup_seconds()
            raced = race(
                scene,
                plan(scene, full),
                runs=runs,
                budget=budget,
                sure=FULL_SURE if full else None,
                setup=setup,
                progress=progress,
                keep=functools.partial(write_rows, folder=folder),
            )
            progress("chart")
            draw(raced, folder / PICTURE)
            if earlier is not None:
                write_report(earlier, folder)
            return raced, earlier is not None
    except OSError as error:
        raise SolidgearError(
            f"--out {out}: writing stopped ({error.strerror or error}); files already there are whole"
        ) from error


def _earlier(folder: Path, scene: Scene) -> Record | None:
    """Return the record of an earlier comparison of the same scene; None where there is none."""
    path = folder / "results.json"
    try:
        results = json.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, ValueError):
        return None
    same = json.loads(json.dumps(scene.as_dict()))
    if not isinstance(results, dict) or results.get("scene") != same:
        return None
    return as_record(results, str(path))
