"""Rows that a sweep makes: options on them, a bar while they are made, and words on them."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from solidgear.show.command import Group, console
from solidgear.show.plot import FORMATS, check_ending
from solidgear.show.sheet import write_sheet
from solidgear.show.units import ENGINEERING
from solidgear.variants.sweep.bearing_sweep import Summary
from solidgear.variants.sweep.chart import sweep_chart, sweep_table
from solidgear.variants.sweep.curves import Curves, chartable
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import FileTask, Swept, run

#: rows that are told on the terminal as well
FEW = 40
#: ending of a chart that is a page
PAGE = ".html"
#: reasons of refusals that are told
REASONS = 5
#: told rows that are there, rows in all and what is done
Show = Callable[[int, int, str], None]
#: told a sentence on what was mended
Tell = Callable[[str], None]


@dataclass(frozen=True)
class Rows(Group):
    """Rows that a sweep makes, where to and by whom."""

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

    def made(self, task: FileTask, chart: Path | None, show: Show, tell: Tell) -> Swept:
        """Rows of variants of files; refused before where a chart of them cannot be drawn."""
        if chart is not None:
            chartable(task.variants)
        return run(
            task,
            self.out,
            jobs=self.jobs,
            dask=self.dask,
            overwrite=self.overwrite,
            progress=show,
            tell=tell,
        )

    @property
    def of_files(self) -> bool:
        """Tell whether options are given that are for variants of files."""
        return bool(self.one_at_a_time or self.table or self.keep_sum)

    def design(self, vary: Sequence[str]) -> Design:
        """Entries that vary, and in which combinations."""
        sums = tuple(self.keep_sum or ())
        drawn = self.sample, self.seed, self.one_at_a_time
        return Design(tuple(vary), *drawn, self.table, sums)

    @contextmanager
    def counted(self, silent: bool) -> Iterator[tuple[Show, Tell]]:
        """A bar of the rows that are there, where there is a terminal; after Ctrl-C they are told."""
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

        def tell(text: str) -> None:
            terminal.print(f"solidgear: {text}", soft_wrap=True)

        try:
            with bar:
                line = bar.add_task("reading", total=None)

                def show(done: int, total: int, text: str) -> None:
                    reached[:] = done, total
                    bar.update(line, completed=done, total=total, description=text)

                yield show, tell
        except KeyboardInterrupt:
            if reached[0]:
                print(
                    f"solidgear: {reached[0]} of {reached[1]} rows are kept; the same command goes "
                    "on from there",
                    file=sys.stderr,
                )
            raise


@dataclass(frozen=True)
class Told(Group):
    """Numbers that rows of a train tell."""

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


def rows_there(found: Swept | Summary) -> str:
    """Sentence on the rows that are there."""
    path = str(found.path).encode("utf-8", "backslashreplace").decode()  # bytes that are no text
    if found.skipped == found.total:
        return f"{path}: all {found.total} rows were there already."
    there = f"; {found.skipped} more were there already" if found.skipped else ""
    return f"Wrote {found.total - found.skipped} rows to {path}{there}."


def solved(found: Swept) -> str:
    """Sentence on what was done in this run."""
    new = found.total - found.skipped
    each = 1e3 * found.seconds / new
    return f"{new} variants in {found.seconds:.1f} s, {each:.0f} ms each; {found.refused} refused."


def refusals(found: Swept | Summary) -> list[str]:
    """Sentences on variants that were refused, if any were: a reason each, the commonest first."""
    most = sorted(found.whys.items(), key=lambda why: -why[1])
    told = [
        f"Refused{f' ({count} variants)' if count > 1 else ''}: {why}"
        for why, count in most[:REASONS]
    ]
    if len(most) > REASONS:
        left = sum(count for _, count in most[REASONS:])
        told.append(f"{left} more are refused for other reasons (column status).")
    return told


def record_of(found: Swept, **more: Any) -> str:
    """The account as JSON, without the rows."""
    kept = ("path", "total", "skipped", "refused", "whys", "seconds", "repairs")
    return json.dumps({name: getattr(found, name) for name in kept} | more, default=str)


def ended_rows(found: Swept) -> None:
    """An exit code of its own where no variant could be solved."""
    if found.refused == found.total:
        raise typer.Exit(1)


def checked_chart(file: Path | None) -> None:
    """Refuse a chart of an unknown format before anything is solved."""
    if file is not None:
        check_ending(file, (*FORMATS, PAGE))


def drawn(
    curves: Curves | None, title: str, lead: str, file: Path | None, cautions: Sequence[str] = ()
) -> list[str]:
    """Sentence on the curves, once they are drawn into a picture or a page; none if none was asked
    for.
    """
    if file is None:
        return []
    if curves is None or curves.empty:
        return ["Chart: none"]
    title = f"{title}: sweep over {curves.over}"
    if file.suffix.lower() != PAGE:
        return [f"Chart: {sweep_chart(curves, title).write(file)}"]
    charts = {"sweep": partial(sweep_chart, curves, "", ENGINEERING)}
    told = [sweep_table(curves)]
    return [f"Chart: {write_sheet(file, title, lead, told, charts=charts, cautions=cautions)}"]
