"""Command on one scene: chart, error against cost."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Annotated

import typer

from solidgear.comparison.page.html import write_report
from solidgear.comparison.race.figure import race_chart
from solidgear.comparison.race.race import PICTURE, Race, write_rows
from solidgear.comparison.race.sheet import sheet
from solidgear.comparison.race.timing import (
    BUDGET,
    FULL_BUDGET,
    FULL_SURE,
    plan,
    race,
    setup_seconds,
)
from solidgear.comparison.recording import as_record
from solidgear.core import Record, Scene, SolidgearError, number_cautions
from solidgear.show.command import Progress, command
from solidgear.show.folder import clear_halves, held
from solidgear.show.options import Run, SceneFile
from solidgear.show.remarks import load
from solidgear.show.sheet import Sheet, present


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
    loaded = load(scene)

    def study(progress: Progress) -> Sheet:
        race, reported = run_chart(
            loaded, out, full=full, runs=runs, budget=budget, progress=progress
        )
        numbers = dict.fromkeys(map(str, race.reference.values))
        return sheet(race, out, reported, number_cautions(loaded, numbers))

    present(study, run)


def run_chart(
    scene: Scene,
    out: Path,
    *,
    full: bool = False,
    runs: int = 5,
    budget: float | None = None,
    progress: Progress,
) -> tuple[Race, bool]:
    """Run and write the chart of a scene, and put it into the report that an earlier comparison of
    it left there; with whether there was such a report.

    SolidgearError for a bad number, a folder that cannot be written, or a comparison by another
    version of solidgear, before anything is timed; where no case has an answer.
    """
    if runs < 1:
        raise SolidgearError(f"--runs {runs}: give a whole number of at least 1")
    if budget is not None and not 0 < budget < float("inf"):
        raise SolidgearError(f"--budget {budget:g}: give seconds above 0")
    budget = budget or (FULL_BUDGET if full else BUDGET)
    try:
        with held(out) as folder:
            clear_halves(folder)
            earlier = _earlier(folder, scene)
            progress("set-up costs, in a fresh interpreter")
            raced = race(
                scene,
                plan(scene, full),
                runs=runs,
                budget=budget,
                sure=FULL_SURE if full else None,
                setup=setup_seconds(),
                progress=progress,
                keep=functools.partial(write_rows, folder=folder),
            )
            progress("chart")
            race_chart(raced).write(folder / PICTURE)
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
