"""Rows of a sweep over entries of files, made and kept."""

from __future__ import annotations

import dataclasses
import time
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from solidgear import __version__
from solidgear.core.display import Displayed
from solidgear.core.errors import SolidgearError, listed, nearest
from solidgear.core.machine.threads import pinned
from solidgear.core.models.limits import number
from solidgear.variants.sweep.curves import Curves, curves_of
from solidgear.variants.sweep.file_variants import FileVariants
from solidgear.variants.sweep.rows import RowFile, tell_in_log
from solidgear.variants.sweep.workers import Rows, workers

#: variants that are sent to another process at once
SENT = 8

#: told rows that are there, rows in all, and what is being done
Progress = Callable[[int, int, str], None]


class FileTask:
    """Everything that turns variants of files into rows: a dataclass, whose fields alone are sent to
    other processes.
    """

    variants: FileVariants

    @property
    def columns(self) -> dict[str, type]:
        """Names and types of the numbers of a variant, in order."""
        raise NotImplementedError

    @property
    def plan(self) -> dict[str, Any]:
        """Facts that rows depend on beside what varies, as data for JSON."""
        raise NotImplementedError

    @property
    def cautions(self) -> tuple[str, ...]:
        """Sentences on what does not fit together in variants that can be solved."""
        return self.variants.cautions

    @property
    def measured(self) -> tuple[str, ...]:
        """Names of the numbers of a misalignment."""
        return ()

    def numbers(self, index: int) -> dict[str, Any]:
        """Numbers of a variant, whatever was solved before it; SolidgearError if it has none."""
        raise NotImplementedError

    @pinned
    def rows(self, indices: Iterable[int]) -> Rows:
        """Rows of some variants."""
        return [self._row(index) for index in indices]

    def _row(self, index: int) -> dict[str, Any]:
        row: dict[str, Any] = {"variant": index, **self.variants.told(index)}
        try:
            found = self.numbers(index)
        except SolidgearError as error:
            return row | {"status": self.variants.status(error, index)}
        return row | {"status": "ok"} | found

    def __getstate__(self) -> dict[str, Any]:
        own = dataclasses.fields(self)  # type: ignore[arg-type]
        return {field.name: getattr(self, field.name) for field in own}


@dataclass(frozen=True, eq=False, repr=False)
class Swept(Displayed):
    """Rows of a sweep.

    Examples
    --------
    >>> import solidgear as sg
    >>> rows = sg.sweep("geometry/shaft_stepped.toml", "segment.left.diameter=45 mm,55 mm", n=2)
    >>> len(rows), bool(rows["f2_hz"][0] < rows["f2_hz"][1]), bool(max(rows["f2_hz bar"]) < 10)
    (2, True, True)
    """

    shown: ClassVar[str] = "swept"

    #: values of all rows by the names of columns, SI; None where a row has none. Bars stand beside
    #: numbers as ``f1_hz bar``, in the same unit.
    columns: dict[str, list[Any]]
    varied: tuple[str, ...]  #: columns of what varies
    curves: Curves | None  #: where one number varies
    path: Path  #: file that they were written to; of a sweep from Python without one it is gone
    skipped: int  #: rows that were there before
    seconds: float  #: wall seconds of this run
    #: what was found damaged in the files and how it was mended, a sentence each
    repairs: tuple[str, ...]
    #: what does not fit together in variants that were solved, a sentence each
    cautions: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.columns["variant"])

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.columns:
            raise SolidgearError(
                f"a sweep has no column {name!r}{nearest(name, self.columns)}; "
                f"it has {listed(self.columns)}"
            )
        values = self.columns[name]
        texts = any(isinstance(value, str) for value in values)
        return np.array(values, object if texts else float)

    @property
    def total(self) -> int:
        """Variants."""
        return len(self)

    @property
    def whys(self) -> dict[str, int]:
        """Reasons why variants were refused, and how many for that reason."""
        return dict(Counter(status for status in self.columns["status"] if status != "ok"))

    @property
    def refused(self) -> int:
        """Variants that have no numbers."""
        return sum(self.whys.values())

    def to_dataframe(self) -> Any:
        """All columns as a data frame of pandas, which must be installed."""
        import pandas

        return pandas.DataFrame(self.columns)


def run(
    task: FileTask,
    out: Path,
    *,
    jobs: int = 1,
    dask: str | None = None,
    overwrite: bool = False,
    progress: Progress = lambda done, total, text: None,
    tell: Callable[[str], None] = tell_in_log,
) -> Swept:
    """Solve the variants whose rows are not there yet.

    Parameters
    ----------
    out : Path
        ``.csv`` or ``.parquet``. Rows already there from the same sweep are kept and not solved
        again.
    jobs : int
        Processes on this machine (joblib), at most eight for each processor.
    dask : str, optional
        Address of a Dask scheduler, whose workers have solidgear installed.
    overwrite : bool
        Discard rows that are there.
    progress : callable
        Called with rows that are there, rows in all, and what is being done.
    tell : callable
        Called with a sentence for every damage to the files that was found and mended.

    Raises
    ------
    SolidgearError
        A file that belongs to another sweep, is being written by one or cannot be written. A variant
        that is refused is no error: its row says why.
    """
    start = time.perf_counter()
    number("sweep", "jobs", jobs, least=1, whole=True)
    team, total = workers(jobs, dask), len(task.variants)
    columns = {"variant": int, **task.variants.columns, "status": str, **task.columns}
    plan = {**task.plan, **task.variants.plan, "version": __version__}
    with RowFile(out, columns, plan, total, overwrite, tell) as file:
        skipped = len(file.done)
        todo = task.variants.in_turn(k for k in range(total) if k not in file.done)
        progress(skipped, total, "solving")
        size = 1 if jobs == 1 and dask is None else max(1, min(SENT, len(todo) // (4 * jobs)))
        for rows in team(lambda: task, [todo[k : k + size] for k in range(0, len(todo), size)]):
            file.append(rows)
            progress(len(file.done), total, "solving")
        file.finish()
        values = file.by_column()
    return Swept(
        values,
        tuple(task.variants.columns),
        curves_of(values, task.variants, task.measured),
        file.path,
        skipped,
        time.perf_counter() - start,
        tuple(file.repairs),
        task.cautions,
    )
