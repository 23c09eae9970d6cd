"""Command ``sweep``: bearing sets on one body, or variants of the file of a shaft or train."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as ProgressBar

from solidgear.show.command import Group, Progress, command, console
from solidgear.show.options import AUTO, CaseName, Chosen, Run, options, refuse, relative
from solidgear.show.plot import FORMATS, WIDE, check_ending
from solidgear.show.remarks import document_under
from solidgear.show.sheet import present, write_page
from solidgear.trains.options import Pair, Reduction, models_of, of_shafts
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import R, Task, run
from solidgear.variants.sweep.shaft_task import REDUCED, task_of
from solidgear.variants.sweep.sheet import sweep_sheet
from solidgear.variants.sweep.train_task import BY_DEFAULT
from solidgear.variants.sweep.train_variants import shafts_in

#: ending of a chart that is a page
PAGE = ".html"
#: called with the number of rows that are there, of rows in all, and the present step
ShowRows = Callable[[int, int, str], None]


@dataclass(frozen=True)
class Rows(Group):
    """Options on the rows of a sweep, their file and the processes that make them."""

    out: Annotated[
        Path,
        typer.Option(
            "--out",
            "-o",
            help="Rows, as .csv or .parquet; run again to go on where it stopped. They are kept in "
            "a database beside it (rows.csv.sqlite), from which the file is written in one step.",
        ),
    ] = Path("rows.csv")
    n: Annotated[
        int | None, typer.Option("-n", help="Number of elastic shapes; twins count twice.")
    ] = None
    sample: Annotated[
        int | None,
        typer.Option(
            "--sample", help="Draw so many points (Latin hypercube) instead of all combinations."
        ),
    ] = None
    seed: Annotated[int, typer.Option("--seed", help="Of the random sample.")] = 0
    one_at_a_time: Annotated[
        bool,
        typer.Option(
            "--one-at-a-time",
            help="The file as it is, then each value of each entry with all others as in the file.",
        ),
    ] = False
    table: Annotated[
        Path | None,
        typer.Option(
            "--table",
            help="Variants of your own, in place of --vary: a CSV file with paths as heads.",
        ),
    ] = None
    keep_sum: Annotated[
        list[str] | None,
        typer.Option(
            "--keep-sum",
            help="PATH+PATH: their sum stays as in the file; the one that does not vary gives way.",
        ),
    ] = None
    jobs: Annotated[int, typer.Option("--jobs", "-j", help="Processes on this machine.")] = 1
    follow: Annotated[
        list[str] | None,
        typer.Option(
            "--follow", help="PATH: a diameter that follows the bore of a designation that varies."
        ),
    ] = None
    dask: Annotated[
        str | None,
        typer.Option(
            "--dask", help="Address of a running Dask scheduler, such as tcp://host:8786."
        ),
    ] = None
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Discard rows that are there.")] = (
        False
    )

    def run(self, task: Task[R], silent: bool, chart: Path | None = None) -> R:
        """Run a task with these options, and return the result of it; refuse a chart of a task
        without curves before the rows.
        """
        if chart is not None:
            task.refuse_chart()
        with self._counted(silent) as show:
            return run(
                task,
                self.out,
                jobs=self.jobs,
                dask=self.dask,
                overwrite=self.overwrite,
                progress=show,
            )

    def design(self, vary: Sequence[str]) -> Design:
        """Return the entries that vary, and in which combinations."""
        return Design(
            tuple(vary),
            sample=self.sample,
            seed=self.seed,
            one_at_a_time=self.one_at_a_time,
            table=self.table,
            keep_sum=tuple(self.keep_sum or ()),
            follow=tuple(self.follow or ()),
        )

    @contextmanager
    def _counted(self, silent: bool) -> Iterator[ShowRows]:
        """Show a bar of the rows that are there, on a terminal; after Ctrl-C print their number."""
        terminal = console(stderr=True)
        bar = ProgressBar(
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
            console=terminal,
            disable=silent or not terminal.is_terminal,
        )
        reached = [0, 0]
        try:
            with bar:
                line = bar.add_task("reading", total=None)

                def show(done: int, total: int, text: str) -> None:
                    reached[:] = done, total
                    bar.update(line, completed=done, total=total, description=text)

                yield show
        except KeyboardInterrupt:
            if reached[0]:
                print(
                    f"solidgear: {reached[0]} of {reached[1]} rows are kept; the same command goes "
                    "on from there",
                    file=sys.stderr,
                )
            raise


@dataclass(frozen=True)
class OfTrain(Group):
    """Options on the numbers of rows of a train."""

    ask: Annotated[
        list[str] | None,
        typer.Option(
            "--ask",
            help="Numbers of rows, comma-separated or repeated. Of a shaft: answer (by default), deflect, bearing or "
            "stress. Of a train: system-modes, response, deflect (by default), bearing or contact.",
        ),
    ] = None
    every_point: Annotated[
        bool, typer.Option("--every-point", help="Of a train: a row for each operating point.")
    ] = False
    mesh: Annotated[
        str | None,
        typer.Option(
            "--mesh", help="Of a train: whose transmission error drives it, of several; the first."
        ),
    ] = None
    chart: Annotated[
        Path | None,
        typer.Option(
            "--chart",
            help="Curves over the number that varies, as .png, .svg or .html.",
        ),
    ] = None


@command
def sweep(
    scene: Annotated[
        Path,
        typer.Argument(
            help="Scene or train file (TOML), such as geometry/pinion_overhung.toml; - for standard "
            "input."
        ),
    ],
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            help="PATH=VALUES, repeatable: any entry of the file, such as segment.neck.diameter, "
            "bearing.A.seat_width, mesh.stiffness, pinion.bearing.2.position; PATH+PATH gives several "
            "one value. Where springs (bearing.NAME.kxx, bearing.NAME.scale for all of it, housing.kxx) "
            "and positions of bearings of a shaft vary alone, one body does for all. "
            'VALUES: FROM:TO:COUNT, log:FROM:TO:COUNT or A,B,C, such as "0.2 m:0.24 m:9".',
        ),
    ] = None,
    rows: Rows,
    model: Chosen,
    tolerance: Annotated[
        float,
        relative(
            "--tolerance", "Relative error of frequencies; checked by a bound for every variant."
        ),
    ] = REDUCED,
    pair: Pair,
    train_rows: OfTrain,
    reduced: Reduction,
    case: CaseName = None,
    run: Run,
) -> None:
    chart = train_rows.chart
    if chart is not None:
        check_ending(chart, (*FORMATS, PAGE))
    document = document_under(scene, case)
    if document.describes_train:
        of_shaft = {
            "--model": model.name != AUTO,
            "--tolerance": tolerance != REDUCED,
        }
        models = "its models are those of --pinion and --gear"
        refuse(of_shaft, f"one shaft, and {scene} is a train: {models}")
        reduced.checked()
        mix = models_of([*shafts_in(document.tables)], scene.stem, pair.models)
        how: Mapping[str, Any] = {
            "models": pair.models,
            "mesh": train_rows.mesh,
            "settings": of_shafts(model.pairs, mix),
            "ask": train_rows.ask or BY_DEFAULT,
            "every_point": train_rows.every_point,
            "max_frequency": reduced.max_frequency,
            "point": reduced.point,
            "reduction": reduced.reduction,
            "kept": reduced.kept,
            "local_harmonics": reduced.harmonics,
        }
    else:
        of_train = {
            "--pinion": pair.pinion is not None,
            "--gear": pair.gear is not None,
            "--shaft": bool(pair.shafts),
            "--mesh": bool(train_rows.mesh),
            "--every-point": train_rows.every_point,
            **reduced.given,
        }
        refuse(of_train, f"a train, and {scene} is the scene of one shaft")
        automatic = model.automatic()
        how = {
            "model": None if automatic else str(model.name),
            "options": {} if automatic else options(model.pairs),
            "reduction_tolerance": None if tolerance == REDUCED else tolerance,
            "ask": train_rows.ask or (),
        }
    with Progress(quiet=run.as_json or not sys.stderr.isatty()) as progress:
        # before a file of rows is begun
        task = task_of(
            document,
            rows.design(vary or ()),
            n=rows.n,
            tolerance=model.tol,
            progress=progress,
            **how,
        )
    swept = rows.run(task, run.as_json, chart)
    sheet = sweep_sheet(swept, chart=chart)
    if chart is not None and sheet.charts:
        if chart.suffix.lower() == PAGE:
            write_page(sheet, chart)
        else:
            (make,) = sheet.charts.values()
            picture = make(WIDE)
            assert picture is not None  # sheets of sweeps have no empty charts
            replace(picture, title=sheet.title).write(chart)
    present(lambda progress: sheet, run)
    if swept.refused == swept.total:
        raise typer.Exit(1)
