"""Rows that a sweep makes: options on them, a bar while they are made, and words on them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from solidgear.cli.app import Group

if TYPE_CHECKING:
    from solidgear.studies.sweep import Summary
    from solidgear.studies.sweep.train_run import TrainSummary

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

    @property
    def how(self) -> dict[str, Any]:
        """The same as arguments of a sweep."""
        return dict(vars(self))

    @contextmanager
    def counted(self, silent: bool) -> Iterator[tuple[Show, Tell]]:
        """A bar of the rows that are there, where there is a terminal; after Ctrl-C they are told."""
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TextColumn,
            TimeRemainingColumn,
        )

        terminal = Console(stderr=True, highlight=False)
        bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
            console=terminal,
            disable=silent or not terminal.is_terminal,
        )
        reached = [0, 0]

        def tell(text: str) -> None:
            terminal.print(f"solidgear: {text}", markup=False, emoji=False, soft_wrap=True)

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


def rows_there(found: Summary | TrainSummary) -> str:
    """Sentence on the rows that are there."""
    path = str(found.path).encode("utf-8", "backslashreplace").decode()  # bytes that are no text
    return f"{path}: {found.total} rows, {found.skipped} of them there before."


def refusals(found: Summary | TrainSummary) -> list[str]:
    """Sentence on variants that were refused, if any were."""
    if not found.why:
        return []
    others = "; others say theirs" if found.refused > 1 else ""
    return [f"Refused: {found.why} (column status{others})."]
