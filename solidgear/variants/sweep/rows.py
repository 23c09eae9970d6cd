"""The file that a sweep makes: written whole from its rows, which are kept in a store beside it.

For ``--out rows.csv`` the rows are in ``rows.csv.sqlite``, batch by batch as they come
(:mod:`solidgear.variants.sweep.store`).  ``rows.csv`` is made from it, in order of the rows: whenever there
are twice as many, when the sweep is stopped, and when all are there.  A Parquet file is made when
all are there.  The file always takes the place of the one before in one step.

A file that was changed by anybody else is set aside under another name and written anew; a file
that has no store beside it is not touched.
"""

from __future__ import annotations

import csv
import glob
import hashlib
import io
import logging
import math
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import Any

from solidgear.core.errors import SolidgearError
from solidgear.core.machine.whole_file import whole
from solidgear.variants.sweep.store import Store, StoreError

tell_in_log: Callable[[str], None] = logging.getLogger(__name__).warning


class RowFile:
    """Rows of one sweep, to be used in a ``with`` statement.

    Parameters
    ----------
    path : Path
        ``.csv`` or ``.parquet``.
    columns : mapping of str to type
        Names and types, the first one being the number of the row, from 0.
    plan : mapping
        What the rows depend on, JSON-serialisable; rows of another plan are never mixed in.
    total : int
        Rows there are to be.
    overwrite : bool
        Start anew whatever is there.
    tell : callable
        Called with a sentence for everything that was found damaged and mended.

    Attributes
    ----------
    done : set of int
        Rows that are there already.
    repairs : list of str
        What was found damaged and how it was mended, a sentence each.

    Raises
    ------
    SolidgearError
        For another suffix, a missing package, a folder that cannot be written, a file that another
        process is writing, rows of another plan, or a store that is damaged beyond repair.
    """

    def __init__(
        self,
        path: Path,
        columns: Mapping[str, type],
        plan: Mapping[str, Any],
        total: int,
        overwrite: bool = False,
        tell: Callable[[str], None] = tell_in_log,
    ):
        self.path, self.columns, self._total, self._tell = Path(path), dict(columns), total, tell
        if self.path.suffix not in (".csv", ".parquet"):
            raise SolidgearError(f"--out {self.path}: the name must end in .csv or .parquet")
        self._parquet = self.path.suffix == ".parquet"
        if self._parquet:
            _pyarrow()
        self.done: set[int] = set()
        self.repairs: list[str] = []
        beside = self.path.with_name(self.path.name + ".sqlite")
        with self._writing():
            self.path.parent.mkdir(parents=True, exist_ok=True)
            for place in (self.path, beside):
                if place.exists() and not place.is_file():
                    raise SolidgearError(
                        f"--out {self.path}: {place} is there and is no file; choose another name"
                    )
            self._store = Store(beside, {"columns": list(columns), **plan}, overwrite)
        self.done = self._store.done
        try:
            with self._writing():
                self._compare(overwrite)
        except BaseException:
            self._store.close()
            raise

    @property
    def basis(self) -> int | None:
        """Level of the basis that rows begin with, None as long as nobody has found it out."""
        return self._store.facts.get("basis")

    @basis.setter
    def basis(self, level: int) -> None:
        with self._writing():
            self._store.note("basis", level)

    @property
    def _written_as(self) -> list[str]:
        """Digests of the file: of the last one written, before it of one that may have stayed."""
        return self._store.facts.get("file", {}).get("digests", [])

    def __enter__(self) -> RowFile:
        return self

    def __exit__(self, kind, *_) -> None:
        """Whatever happened, the rows that are there are in the file if it is a CSV file."""
        try:
            if self.done and not self._parquet:
                with suppress(SolidgearError) if kind else nullcontext():
                    self.finish()
        finally:
            self._store.close()

    # ---------------------------------------------------------------------------- what is there
    def _compare(self, overwrite: bool) -> None:
        """Compare the file with the store."""
        for left in self.path.parent.glob(f".{glob.escape(self.path.name)}.*.part"):
            with suppress(OSError):
                left.unlink()  # of a process that was killed; nobody else writes here now
        if overwrite:
            self.path.unlink(missing_ok=True)
        if self._store.repaired:
            self._mended(self._store.repaired)
        found = _digest(self.path)
        if found and found not in self._written_as and not self.done:
            raise SolidgearError(
                f"{self.path}: is there already, and nothing beside it says that it came from this "
                f"sweep (no rows in {self._store.path.name}); choose another --out, or add --overwrite"
            )
        up_to_date = found and found in self._written_as[-1:]
        self._written = self._store.facts["file"]["rows"] if up_to_date else 0

    def _set_aside(self) -> str | None:
        """Digest of the file as it was written last; one that was changed gets another name."""
        found, beside = _digest(self.path), self._store.path.name
        if self._written_as and not found:
            self._mended(f"{self.path} was gone and is written anew from {beside}")
        if not found or found in self._written_as:
            return found
        aside, count = self.path.with_name(self.path.name + ".changed"), 1
        while aside.exists():
            count += 1
            aside = self.path.with_name(f"{self.path.name}.changed{count}")
        os.replace(self.path, aside)
        self._mended(
            f"{self.path} does not match the record of what was written: what was there is now "
            f"{aside.name}, and it is written anew from {beside}"
        )
        return None

    def _mended(self, text: str) -> None:
        self.repairs.append(text)
        self._tell(text)

    # ---------------------------------------------------------------------------------- writing
    def append(self, rows: Iterable[Mapping[str, Any]]) -> None:
        """Add rows; they are on the disk when this returns."""
        with self._writing():
            self._store.append((row["variant"], self._line(row)) for row in rows)
            # at every doubling, so that a sweep of any length writes each row about twice
            if not self._parquet and len(self.done) >= 2 * self._written:
                with suppress(OSError):  # such as a spreadsheet that has it open; it is tried again
                    self._export()

    def finish(self) -> None:
        """Make the file of all rows that are there, unless it is up to date."""
        if len(self.done) != self._written:
            with self._writing():
                self._export()

    def _export(self) -> None:
        before = self._set_aside()
        with whole(self.path) as partial:
            if self._parquet:
                self._write_parquet(partial)
            else:
                self._write_csv(partial)
            # If the process is killed here, either file may be found.
            digests = [digest for digest in (before, _digest(partial)) if digest]
            self._store.note("file", {"digests": digests, "rows": len(self.done)})
        self._written = len(self.done)

    def _write_csv(self, partial: Path) -> None:
        with partial.open("w", newline="", encoding="utf-8") as f:
            f.write(_csv_line(self.columns) + "\n")
            f.writelines(line + "\n" for line in self._store.lines())

    def _write_parquet(self, partial: Path) -> None:
        arrow = _pyarrow()
        types = {int: arrow.int64(), float: arrow.float64(), str: arrow.string()}
        data = {
            name: arrow.array(values, types[self.columns[name]])
            for name, values in self.by_column().items()
        }
        arrow.parquet.write_table(arrow.table(data), partial)

    def by_column(self) -> dict[str, list[Any]]:
        """Values of all rows that are there, in their order; None where a row has none."""
        table = list(csv.reader(self._store.lines()))
        return {
            name: [kind(row[k]) if row[k] else None for row in table]
            for k, (name, kind) in enumerate(self.columns.items())
        }

    def _line(self, row: Mapping[str, Any]) -> str:
        return _csv_line(_text(row.get(name)) for name in self.columns)

    @contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except (OSError, StoreError) as error:
            reason = getattr(error, "strerror", None) or error
            kept = ""
            if self.done:
                rows = f"{len(self.done)} of {self._total} rows"
                kept = f"; {rows} are kept, and the same command goes on from there"
            raise SolidgearError(f"--out {self.path}: cannot be written ({reason}){kept}") from None


def _csv_line(values: Iterable[Any]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(values)
    return text.getvalue()[:-1]


def _text(value: Any) -> Any:
    """Text of a CSV field: full precision, nothing for what does not exist."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return float.__repr__(value) if isinstance(value, float) else value


def _digest(path: Path) -> str | None:
    """Of the bytes of a file; None where there is none."""
    try:
        with path.open("rb") as f:
            return hashlib.file_digest(f, "sha256").hexdigest()
    except FileNotFoundError:
        return None


def _pyarrow():
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise SolidgearError(
            "Parquet files need pyarrow: pip install 'solidgear[sweep]', or write a .csv file"
        ) from None
    return pyarrow
