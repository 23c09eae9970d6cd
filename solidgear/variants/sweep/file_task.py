"""The runner of sweeps: a task turns variants into rows, and :func:`run` makes and keeps them."""

from __future__ import annotations

import dataclasses
import re
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, KeysView, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from solidgear.core import Sheeted, SolidgearError, nearest, pinned, show
from solidgear.core.errors import names_in
from solidgear.core.machine.processes import give_back
from solidgear.core.machine.threads import usable_cores
from solidgear.core.machine.version import VERSION
from solidgear.core.models.limits import number
from solidgear.core.named import no_such
from solidgear.variants.sweep.curves import Curves, chartable, curves_of
from solidgear.variants.sweep.error_curves import ErrorCurves, error_curves
from solidgear.variants.sweep.file_variants import FileVariants
from solidgear.variants.sweep.rows import RowFile

#: columns of rows: the largest relative error that a reduction leaves in natural frequencies, and
#: words on all other error bars
BOUND, BARS = "reduction_bound", "about_bars"
#: column of the sentences to be read before a row is used, and what parts them
CAUTIONS, AND = "cautions", " | "

#: called with the number of rows that are there, of rows in all, and the present step
Progress = Callable[[int, int, str], None]


def named_kinds(ask: str | Iterable[str], known: Sequence[str], of: str) -> tuple[str, ...]:
    """Return the kinds of numbers of rows that are asked for, with commas or one by one, in the order
    of those that are `known`; refuse others.
    """
    asked = {word.strip() for text in names_in(ask) for word in text.split(",") if word.strip()}
    for word in asked.difference(known):
        raise SolidgearError(
            f"`ask` {show(word, 40)}: of {of} give one or more of {', '.join(known)}"
            f"{nearest(word, known)}"
        )
    return tuple(word for word in known if word in asked)


def without_bars(model: str) -> str:
    """Return the words on numbers of a model that was given, which have no error bars."""
    return f"none: the {model} mesh was given; -f auto has error bars"


#: result of a task
R = TypeVar("R")
Rows = list[dict[str, Any]]
#: numbers in a sentence
NUMBERS = re.compile(r"[-+]?\d[\d.,e+-]*")


class Task(Generic[R]):
    """Turns variants into rows: a dataclass, whose fields alone are sent to other processes."""

    variants: FileVariants
    #: most variants in one transaction: solved in this process, and by others
    batch: ClassVar[tuple[int, int]] = 1, 8

    @property
    def columns(self) -> dict[str, type]:
        """Names and types of the numbers of a variant, in order."""
        raise NotImplementedError

    @property
    def plan(self) -> dict[str, Any]:
        """Facts that rows depend on beside the entries that vary, as data for JSON."""
        raise NotImplementedError

    def refuse_chart(self) -> None:
        """Refuse a chart of variants without curves."""
        chartable(self.variants)

    def prepare(self, file: RowFile, progress: Callable[[str], None]) -> None:
        """Solve all that rows share, in this process and before the first of them."""

    def numbers(self, index: int) -> dict[str, Any]:
        """Return the numbers of a variant, whatever was solved before it; SolidgearError if none."""
        raise NotImplementedError

    @pinned
    def rows(self, indices: Iterable[int], cautions: bool = True) -> Rows:
        """Return the rows of some variants, with their cautions unless these are asked for elsewhere;
        what their bodies took goes back to the system.
        """
        rows = [self._row(index, cautions) for index in indices]
        give_back()  # a process would keep the holes that they leave, some 20 MB a harmonic row
        return rows

    def _row(self, index: int, cautions: bool) -> dict[str, Any]:
        row: dict[str, Any] = {"variant": index, **self.variants.varied(index)}
        try:
            numbers = self.numbers(index)
            told = AND.join(self.cautions_of(index)) if cautions else ""
        except SolidgearError as error:
            return row | {"status": self.variants.status(error, index)}
        return row | {"status": "ok"} | numbers | ({CAUTIONS: told} if told else {})

    def cautions_of(self, index: int) -> Sequence[str]:
        """Return the sentences to be read before the numbers of a variant that has some are used."""
        return ()

    def checked(self, row: dict[str, Any]) -> dict[str, Any]:
        """Return a row of any process as it goes into the file, in this process."""
        return row

    def result(self, file: RowFile, skipped: int, seconds: tuple[float, float], alone: bool) -> R:
        """Return the result of a run: `skipped` rows were there before, wall seconds are until the
        first row and from there on, `alone` where no other process solved any.
        """
        raise NotImplementedError

    def __getstate__(self) -> dict[str, Any]:
        fields = dataclasses.fields(self)  # type: ignore[arg-type]
        return {field.name: getattr(self, field.name) for field in fields}


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Swept(Sheeted):
    """Rows of a sweep.

    Examples
    --------
    >>> import solidgear as sg
    >>> rows = sg.sweep("geometry/shaft_stepped.toml", "segment.left.diameter=45 mm,55 mm", n=2)
    >>> len(rows), bool(rows["f2_hz"][0] < rows["f2_hz"][1]), bool(max(rows["f2_hz bar"]) < 10)
    (2, True, True)
    """

    shown: ClassVar[str] = "swept"
    sheeted: ClassVar[str] = "variants.sweep.sheet:sweep_sheet"
    filed: ClassVar[str] = "variants.sweep.sheet:filed_sheet"
    plain_names: ClassVar[tuple[Any, ...]] = (
        ("file", "path"),
        "total",
        "skipped",
        "refused",
        "whys",
        "seconds",
    )

    #: values of all rows by the names of columns, SI; None where a row has none. Bars stand beside
    #: numbers as ``f1_hz bar``, in the same unit.
    columns: Mapping[str, list[Any]]
    total: int  #: number of variants
    varied: tuple[str, ...]  #: columns of the entries that vary
    curves: Curves | None  #: where one number varies
    #: transmission error over the torque, where something else varies as well
    error_curves: tuple[ErrorCurves, ...]
    #: reasons why variants were refused, and how many for that reason
    whys: dict[str, int]
    path: Path  #: file that they were written to; of a sweep from Python without one it is gone
    skipped: int  #: rows that were there before
    seconds: float  #: wall seconds of this run
    task: Task[Any]  #: what solved the variants
    alone: bool  #: no other process solved any

    def __len__(self) -> int:
        return self.total

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.columns:
            raise no_such(name, self.columns)
        values = self.columns[name]
        texts = any(isinstance(value, str) for value in values)
        return np.array(values, object if texts else float)

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def keys(self) -> KeysView[str]:
        """Names of the columns: by them it is a mapping of arrays, whose length is that of its rows, as
        a data frame is.
        """
        return self.columns.keys()

    @property
    def rows(self) -> list[dict[str, Any]]:
        """Values of every row by the names of columns."""
        return [dict(zip(self.columns, row)) for row in zip(*self.columns.values())]

    @property
    def refused(self) -> int:
        """Number of variants that have no numbers."""
        return sum(self.whys.values())

    @property
    def cautions(self) -> tuple[str, ...]:
        """Sentences to be read before numbers of rows are used, that of the first row of those that
        differ by numbers alone, each with the rows that have it unless all do.
        """
        solved = [row for row in self.rows if row["status"] == "ok"]
        told: dict[str, list[tuple[int, str]]] = {}
        for row in solved:
            for sentence in filter(None, (row.get(CAUTIONS) or "").split(AND)):
                kind = NUMBERS.sub("#", sentence)
                told.setdefault(kind, []).append((row["variant"], sentence))
        return tuple(
            sentences[0][1]
            if len(sentences) == len(solved) and len({text for _, text in sentences}) == 1
            else f"{sentences[0][1]} (variant {sentences[0][0]}; alike in {len(sentences)} of "
            f"{self.total} rows, column {CAUTIONS})"
            for sentences in told.values()
        )


class FileTask(Task[Swept]):
    """Turns variants of files, each solved by itself, into rows."""

    @cached_property
    def _read(self) -> dict[bytes, Any]:
        """The variant that was read last, by its values."""
        return {}

    def variant(self, index: int) -> Any:
        """Return a variant; numbers and cautions of a row read it once."""
        values = self.variants.values[index].tobytes()
        if values not in self._read:
            self._read.clear()
            self._read[values] = self.variants.variant(index)
        return self._read[values]

    @property
    def misalignments(self) -> tuple[str, ...]:
        """Names of the numbers of a misalignment."""
        return ()

    @property
    def meshes_in_contact(self) -> tuple[str, ...]:
        """Names of the meshes whose teeth have numbers."""
        return ()

    def result(
        self, file: RowFile, skipped: int, seconds: tuple[float, float], alone: bool
    ) -> Swept:
        columns = file.by_column()
        return Swept(
            columns=columns,
            total=len(self.variants),
            whys=dict(Counter(status for status in columns["status"] if status != "ok")),
            varied=tuple(self.variants.columns),
            curves=curves_of(
                lambda: columns, self.variants, self.misalignments, self.meshes_in_contact
            ),
            error_curves=error_curves(columns, self.variants, self.meshes_in_contact),
            path=file.path,
            skipped=skipped,
            seconds=sum(seconds),
            task=self,
            alone=alone,
        )


#: takes a task and lists of variants; yields their rows in order
Workers = Callable[[Task, Sequence[Sequence[int]]], Iterator[Rows]]


def run(
    task: Task[R],
    out: Path | str,
    *,
    jobs: int = 1,
    dask: str | None = None,
    overwrite: bool = False,
    progress: Progress = lambda done, total, text: None,
) -> R:
    """Solve the variants whose rows are not there yet, and return the result of the task; parameters
    as of :func:`solidgear.sweep`. A variant that is refused is no error: its row says why.
    """
    start = time.perf_counter()
    number("sweep", "jobs", jobs, least=1, whole=True)
    team, total = workers(jobs, dask), len(task.variants)
    columns = {"variant": int, **task.variants.columns, "status": str, **task.columns}
    plan = {**task.plan, **task.variants.plan, "version": VERSION}
    with RowFile(Path(out), columns, plan, total, overwrite) as file:
        skipped = len(file.done)
        todo = task.variants.in_turn(k for k in range(total) if k not in file.done)
        if todo:
            task.prepare(file, lambda text: progress(skipped, total, text))
        progress(skipped, total, "solving")
        ready = time.perf_counter()
        most = task.batch[0] if jobs == 1 and dask is None else task.batch[1]
        size = max(1, min(most, len(todo) // (4 * jobs)))
        for rows in team(task, [todo[k : k + size] for k in range(0, len(todo), size)]):
            file.append(map(task.checked, rows))
            progress(len(file.done), total, "solving")
        file.finish()
        seconds = ready - start, time.perf_counter() - ready
        return task.result(file, skipped, seconds, alone=jobs == 1 and dask is None)


def workers(jobs: int = 1, dask: str | None = None) -> Workers:
    """Return the workers that were asked for; refuse those without their package or cluster."""
    if dask:
        return _dask(dask)
    if jobs == 1:
        return lambda task, parts: map(task.rows, parts)
    most = 8 * usable_cores()
    if jobs > most:
        raise SolidgearError(
            f"`jobs` {jobs}: give a whole number up to {most}, eight for each processor here"
        )
    try:
        from joblib import Parallel, delayed
    except ImportError:
        raise SolidgearError(
            f"`jobs` {jobs} needs joblib: pip install 'solidgear[sweep]', or use `jobs` 1"
        ) from None
    # the task is sent with every part as places fall free, with a basis enlarged meanwhile
    return lambda task, parts: Parallel(n_jobs=jobs, return_as="generator")(
        delayed(Task.rows)(task, part) for part in parts
    )


def _dask(address: str) -> Workers:
    try:
        from distributed import Client
    except ImportError:
        raise SolidgearError(
            f"`dask` {address} needs Dask: pip install 'solidgear[dask]'"
        ) from None
    try:
        client = Client(address, timeout=10, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise SolidgearError(
            f"`dask` {address}: no Dask scheduler answers there ({type(error).__name__})"
        ) from None

    def rows_of(task: Task, parts: Sequence[Sequence[int]]) -> Iterator[Rows]:
        with client:
            shared = client.scatter(task, broadcast=True)
            futures = [client.submit(Task.rows, shared, part, pure=False) for part in parts]
            try:
                for future in futures:
                    yield future.result()
            finally:
                client.cancel(futures)

    return rows_of
