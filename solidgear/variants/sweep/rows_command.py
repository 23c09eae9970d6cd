"""Rows of a sweep: options, a progress bar while they are made, and sentences on them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from solidgear.show.command import Group, console
from solidgear.show.plot import FORMATS, check_ending
from solidgear.show.sheet import write_sheet
from solidgear.show.units import ENGINEERING
from solidgear.variants.sweep.bearing_task import SweptBearings
from solidgear.variants.sweep.chart import sweep_chart, sweep_table
from solidgear.variants.sweep.curves import Curves, chartable
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import FileTask, R, Swept, Task, run

#: rows that are printed on the terminal as well
FEW = 40
#: ending of a chart that is a page
PAGE = ".html"
#: reasons of refusals that are printed
REASONS = 5
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
    dask: Annotated[
        str | None,
        typer.Option(
            "--dask", help="Address of a running Dask scheduler, such as tcp://host:8786."
        ),
    ] = None
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Discard rows that are there.")] = (
        False
    )

    def run(self, task: Task[R], silent: bool) -> R:
        """Run a task with these options, and return the result of it."""
        with self._counted(silent) as show:
            return run(
                task,
                self.out,
                jobs=self.jobs,
                dask=self.dask,
                overwrite=self.overwrite,
                progress=show,
            )

    @property
    def of_files(self) -> bool:
        """True where options are given that are for variants of files."""
        return bool(self.one_at_a_time or self.table or self.keep_sum)

    def design(self, vary: Sequence[str]) -> Design:
        """Return the entries that vary, and in which combinations."""
        return Design(
            tuple(vary),
            sample=self.sample,
            seed=self.seed,
            one_at_a_time=self.one_at_a_time,
            table=self.table,
            keep_sum=tuple(self.keep_sum or ()),
        )

    @contextmanager
    def _counted(self, silent: bool) -> Iterator[ShowRows]:
        """Show a bar of the rows that are there, on a terminal; after Ctrl-C print their number."""
        terminal = console(stderr=True)
        bar = Progress(
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
            help="Of a train: what rows tell, system-modes, response or deflect; repeatable, all by "
            "default.",
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


def rows_there(result: Swept | SweptBearings) -> str:
    """Return the sentence on the rows that are there."""
    path = str(result.path).encode("utf-8", "backslashreplace").decode()  # bytes that are no text
    if result.skipped == result.total:
        return f"{path}: all {result.total} rows were there already."
    before = f"; {result.skipped} more were there already" if result.skipped else ""
    return f"Wrote {result.total - result.skipped} rows to {path}{before}."


def solved(result: Swept) -> str:
    """Return the sentence on the variants of this run and their time."""
    new = result.total - result.skipped
    each = 1e3 * result.seconds / new
    return (
        f"{new} variants in {result.seconds:.1f} s, {each:.0f} ms each; {result.refused} refused."
    )


def refusals(result: Swept | SweptBearings) -> list[str]:
    """Return a sentence a reason for which variants were refused, the commonest first."""
    reasons = sorted(result.whys.items(), key=lambda why: -why[1])
    sentences = []
    for why, count in reasons[:REASONS]:
        variants = f" ({count} variants)" if count > 1 else ""
        sentences.append(f"Refused{variants}: {why}")
    if len(reasons) > REASONS:
        others = sum(count for _, count in reasons[REASONS:])
        sentences.append(f"{others} more are refused for other reasons (column status).")
    return sentences


def end_rows(result: Swept) -> None:
    """End with exit code 1 if no variant could be solved."""
    if result.refused == result.total:
        raise typer.Exit(1)


def check_chart(file: Path | None, task: FileTask | None = None) -> None:
    """Refuse a chart of an unknown format, or one of a task without curves, before the rows."""
    if file is not None:
        check_ending(file, (*FORMATS, PAGE))
        if task is not None:
            chartable(task.variants)


def draw_chart(
    curves: Curves | None, title: str, lead: str, file: Path | None, cautions: Sequence[str] = ()
) -> list[str]:
    """Draw the curves into a picture or a page, and return the sentence on it; none without a file."""
    if file is None:
        return []
    if curves is None or curves.empty:
        return ["Chart: none"]
    title = f"{title}: sweep over {curves.over}"
    if file.suffix.lower() != PAGE:
        return [f"Chart: {sweep_chart(curves, title).write(file)}"]
    charts = {"sweep": partial(sweep_chart, curves, "", ENGINEERING)}
    tables = [sweep_table(curves)]
    return [f"Chart: {write_sheet(file, title, lead, tables, charts=charts, cautions=cautions)}"]
