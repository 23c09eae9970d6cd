"""Rows of a sweep over entries of files, made and kept."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from solidgear.studies.sweep.rows import RowFile
from solidgear.studies.sweep.workers import Task, workers

#: variants that are sent to another process at once
SENT = 8


@dataclass(frozen=True)
class Made:
    """Rows that are there.

    Attributes
    ----------
    path : Path
        Of the file.
    skipped : int
        Rows that were there before.
    columns : dict of str to list
        Values of all rows, in their order; None where a row has none.
    repairs : tuple of str
        What was found damaged in the files and how it was mended, a sentence each.
    """

    path: Path
    skipped: int
    columns: dict[str, list[Any]]
    repairs: tuple[str, ...]

    @property
    def refusals(self) -> dict[str, int]:
        """Reasons why variants have no numbers, and how many for that reason."""
        return dict(Counter(status for status in self.columns["status"] if status != "ok"))


def make_rows(
    task: Task,
    total: int,
    out: Path,
    columns: Mapping[str, type],
    plan: Mapping[str, Any],
    in_turn: Callable[[Iterable[int]], list[int]] = sorted,
    *,
    jobs: int,
    dask: str | None,
    overwrite: bool,
    progress: Callable[[int, int, str], None],
    tell: Callable[[str], None],
) -> Made:
    """Solve the variants whose rows are not there yet.

    Parameters
    ----------
    total : int
        Variants.
    plan : mapping
        What the rows depend on.
    in_turn : callable
        Puts variants into the order in which they are solved.
    jobs, dask, overwrite, progress, tell
        As of :func:`solidgear.studies.sweep.train_run.sweep_train`.
    """
    team = workers(jobs, dask)
    repairs: list[str] = []

    def mended(text: str) -> None:
        repairs.append(text)
        tell(text)

    with RowFile(out, columns, plan, total, overwrite, mended) as file:
        skipped = len(file.done)
        todo = in_turn(k for k in range(total) if k not in file.done)
        progress(skipped, total, "solving")
        size = 1 if jobs == 1 and dask is None else max(1, min(SENT, len(todo) // (4 * jobs)))
        parts = [todo[k : k + size] for k in range(0, len(todo), size)]
        for rows in team(lambda: task, parts):
            file.append(rows)
            progress(len(file.done), total, "solving")
        file.finish()
        return Made(file.path, skipped, file.by_column(), tuple(repairs))
