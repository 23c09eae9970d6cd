"""Rows of a sweep in an SQLite file, and the table that is written whole from them.

For ``--out rows.csv`` the rows are in ``rows.csv.sqlite``, one transaction a batch. ``rows.csv`` is
written in order of the rows whenever there are twice as many, when the sweep is stopped and when it
ends; a Parquet file when it ends.
"""

from __future__ import annotations

import csv
import glob
import io
import json
import math
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing, contextmanager, nullcontext, suppress
from functools import cached_property
from pathlib import Path
from typing import Any

from solidgear.core import SolidgearError, whole

try:
    import sqlite3
except ImportError:  # left out of some builds of Python
    raise SolidgearError(
        "a sweep keeps its rows in SQLite, which this Python was built without; use one that has it"
    ) from None

#: marks of our databases ("gear" in ASCII) and of their tables; others are refused
APPLICATION, SCHEMA = 0x67656172, 2
TABLES = f"""
PRAGMA application_id = {APPLICATION};
PRAGMA user_version = {SCHEMA};
CREATE TABLE facts (name TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE rows (variant INTEGER PRIMARY KEY, line TEXT NOT NULL);
"""
DAMAGED = (sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_ERROR)


class ColumnsOfRows(Mapping[str, list[Any]]):
    """Values of all rows of a database by the names of columns, read when they are first asked for: a
    million rows are not held for a sweep that shows none of them.
    """

    def __init__(self, database: Path, kinds: Mapping[str, type]):
        self.database, self.kinds = database, dict(kinds)

    @cached_property
    def _values(self) -> dict[str, list[Any]]:
        with closing(sqlite3.connect(self.database.absolute())) as db:
            return _by_column(_lines(db), self.kinds)

    def __getitem__(self, name: str) -> list[Any]:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.kinds)

    def __len__(self) -> int:
        return len(self.kinds)


def _lines(db: sqlite3.Connection) -> Iterator[str]:
    return (line for (line,) in db.execute("SELECT line FROM rows ORDER BY variant"))


def _by_column(lines: Iterable[str], kinds: Mapping[str, type]) -> dict[str, list[Any]]:
    table = list(csv.reader(lines))
    return {
        name: [kind(row[k]) if row[k] else None for row in table]
        for k, (name, kind) in enumerate(kinds.items())
    }


class RowFile:
    """Rows of one sweep, to be used in a ``with`` statement by one process at a time; refuses rows of
    another plan.
    """

    def __init__(
        self,
        path: Path,
        columns: Mapping[str, type],  # the first is the number of the row, from 0
        plan: Mapping[str, Any],  # all that rows depend on, JSON-serialisable
        total: int,  # number of rows of the finished sweep
        overwrite: bool = False,
    ):
        self.path, self.columns, self.total = Path(path), dict(columns), total
        if self.path.suffix not in (".csv", ".parquet"):
            raise SolidgearError(f"`out` {self.path}: the name must end in .csv or .parquet")
        self._parquet = self.path.suffix == ".parquet"
        if self._parquet:
            _pyarrow()
        self.done: set[int] = set()  #: numbers of the rows that are there
        self._exported = 0  # rows in the table, as far as this run has written it
        self._database = self.path.with_name(self.path.name + ".sqlite")
        with self._writing():
            self.path.parent.mkdir(parents=True, exist_ok=True)
            for place in (self.path, self._database):
                if place.exists() and not place.is_file():
                    raise SolidgearError(
                        f"`out` {self.path}: {place} is not a file; choose another name"
                    )
            self._db = self._locked(overwrite)
            try:
                self._begin(json.dumps({"columns": list(columns), **plan}, sort_keys=True))
            except BaseException as error:
                self._db.close()
                raise self._refusal(error) from None

    def __enter__(self) -> RowFile:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        try:
            if self.done and not self._parquet:
                with suppress(SolidgearError) if kind else nullcontext():
                    self.finish()
        finally:
            with suppress(sqlite3.Error, OSError):  # a full disk, say: the log is kept then
                self._db.execute("PRAGMA journal_mode = DELETE")
                if not self.done:
                    self._database.unlink()
            self._db.close()
            if not self.done and sys.platform == "win32":  # which keeps a file that is open
                with suppress(OSError):
                    self._database.unlink(missing_ok=True)

    # ---------------------------------------------------------------------------------- opening
    def _locked(self, overwrite: bool) -> sqlite3.Connection:
        """Connect to the database under an exclusive lock, to a new one if rows are overwritten."""
        self._database.open("ab").close()  # says why it cannot be written, which SQLite does not
        db = sqlite3.connect(self._database.absolute(), timeout=0, isolation_level=None)
        try:
            db.execute("PRAGMA locking_mode = EXCLUSIVE")  # kept until the process ends
            db.execute("BEGIN EXCLUSIVE")
            db.execute("COMMIT")
        except sqlite3.DatabaseError as error:
            db.close()
            if not overwrite or _has_code(error, sqlite3.SQLITE_BUSY):
                raise self._refusal(error) from None
        if not overwrite:
            return db
        db.close()
        for ending in ("", "-wal", "-shm", "-journal"):
            self._database.with_name(self._database.name + ending).unlink(missing_ok=True)
        self.path.unlink(missing_ok=True)
        return self._locked(overwrite=False)

    def _begin(self, plan: str) -> None:
        """Make the tables, or take the rows that are there if they are of this plan."""
        marks = [self._value(f"PRAGMA {name}") for name in ("application_id", "user_version")]
        if marks == [0, 0] and not self._value("SELECT count(*) FROM sqlite_master"):
            self._db.executescript(TABLES)
        elif marks != [APPLICATION, SCHEMA]:
            raise SolidgearError(
                f"{self._database}: is no database of rows that this version of solidgear reads; "
                "choose another `out`, or add `overwrite`"
            )
        self._db.execute("PRAGMA journal_mode = WAL")
        # synced now and then: a failure of the machine may cost the last batches, of the process none
        self._db.execute("PRAGMA synchronous = NORMAL")
        self.done = {number for (number,) in self._db.execute("SELECT variant FROM rows")}
        for partial in self.path.parent.glob(f".{glob.escape(self.path.name)}.*.part"):
            with suppress(OSError):
                partial.unlink()  # of a process that was killed; nobody else writes here now
        if self.done:
            self._refuse_other(plan)
            return
        if self.path.exists():
            raise SolidgearError(
                f"{self.path}: is there already and not from this sweep (no rows in "
                f"{self._database.name}); choose another `out`, or add `overwrite`"
            )
        self._db.execute("DELETE FROM facts")
        self._db.execute("INSERT INTO facts VALUES ('plan', ?)", (plan,))

    def _refuse_other(self, plan: str) -> None:
        """Refuse rows of another plan, with the names in which it differs."""
        text = self._value("SELECT value FROM facts WHERE name = 'plan'") or "{}"
        if text == plan:
            return
        a, b = json.loads(text), json.loads(plan)
        # as texts: a number that is none is not equal to itself
        differing = [
            name
            for name in sorted({*a, *b})
            if json.dumps(a.get(name), sort_keys=True) != json.dumps(b.get(name), sort_keys=True)
        ]
        # columns follow from the others; alone they differ between versions only
        names = [name for name in differing if name != "columns"] or differing
        raise SolidgearError(
            f"{self.path}: holds the rows of another sweep (it differs in: {', '.join(names)}); "
            "choose another `out`, or add `overwrite`"
        )

    def _value(self, query: str) -> Any:
        """Return the one value of a query; None without any."""
        row = self._db.execute(query).fetchone()
        return None if row is None else row[0]

    @property
    def basis(self) -> int | None:
        """Level of the basis that rows of bearings begin with; None as long as it is unknown."""
        level = self._value("SELECT value FROM facts WHERE name = 'basis'")
        return None if level is None else int(level)

    @basis.setter
    def basis(self, level: int) -> None:
        with self._writing():
            self._db.execute("INSERT OR REPLACE INTO facts VALUES ('basis', ?)", (str(level),))

    # ---------------------------------------------------------------------------------- writing
    def append(self, rows: Iterable[Mapping[str, Any]]) -> None:
        """Add rows; all are on the disk when this returns, or none."""
        lines = [
            (row["variant"], _csv_line(map(_field, map(row.get, self.columns)))) for row in rows
        ]
        with self._writing():
            with self._db:
                self._db.execute("BEGIN")
                self._db.executemany("INSERT INTO rows VALUES (?, ?)", lines)
            self.done.update(number for number, _ in lines)
            # at every doubling, so that a sweep of any length writes each row about twice
            if not self._parquet and len(self.done) >= 2 * self._exported:
                with suppress(OSError):  # such as a spreadsheet that has it open; it is tried again
                    self._export()

    def finish(self) -> None:
        """Write the table of all rows that are there."""
        if len(self.done) != self._exported:
            with self._writing():
                self._export()

    def _export(self) -> None:
        with whole(self.path) as partial:
            if self._parquet:
                self._write_parquet(partial)
            else:
                self._write_csv(partial)
        self._exported = len(self.done)

    def _write_csv(self, partial: Path) -> None:
        with partial.open("w", newline="", encoding="utf-8") as file:
            file.write(_csv_line(self.columns) + "\n")
            file.writelines(line + "\n" for line in self._lines())

    def _write_parquet(self, partial: Path) -> None:
        arrow = _pyarrow()
        types = {int: arrow.int64(), float: arrow.float64(), str: arrow.string()}
        data = {
            name: arrow.array(values, types[self.columns[name]])
            for name, values in self.by_column().items()
        }
        arrow.parquet.write_table(arrow.table(data), partial)

    def by_column(self) -> dict[str, list[Any]]:
        """Return the values of all rows that are there, in order; None where a row has none."""
        return _by_column(self._lines(), self.columns)

    def later(self) -> ColumnsOfRows:
        """Return the same values, read when they are first asked for."""
        return ColumnsOfRows(self._database, self.columns)

    def _lines(self) -> Iterator[str]:
        return _lines(self._db)

    # --------------------------------------------------------------------------------- refusals
    @contextmanager
    def _writing(self) -> Iterator[None]:
        """Turn errors of disk and database into a sentence with the number of rows that are kept."""
        try:
            yield
        except (OSError, sqlite3.Error) as error:
            reason = getattr(error, "strerror", None) or error
            kept = ""
            if self.done:
                rows = f"{len(self.done)} of {self.total} rows"
                kept = f"; {rows} are kept, and the same command goes on from there"
            raise SolidgearError(f"`out` {self.path}: cannot be written ({reason}){kept}") from None

    def _refusal(self, error: BaseException) -> BaseException:
        """Return an error of opening as a sentence, where it is one of the database."""
        if _has_code(error, sqlite3.SQLITE_BUSY):
            return SolidgearError(
                f"{self._database}: is in use by another process, perhaps the same sweep; "
                "wait for it to end, or choose another `out`"
            )
        if _has_code(error, *DAMAGED):
            return SolidgearError(
                f"{self._database}: is damaged beyond repair ({error}); put back a copy, "
                "or add `overwrite` to solve all rows again"
            )
        return error


def _has_code(error: BaseException, *codes: int) -> bool:
    """True for an error of the database of one of these kinds."""
    if not isinstance(error, sqlite3.DatabaseError):
        return False
    # the low byte is the kind, the others the place; an error of the binding itself has no code
    return getattr(error, "sqlite_errorcode", sqlite3.SQLITE_ERROR) & 0xFF in codes


def _csv_line(values: Iterable[Any]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(values)
    return text.getvalue()[:-1]


def _field(value: Any) -> Any:
    """Return a value as a CSV field: full precision, empty for None and what is not a number."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return float.__repr__(value) if isinstance(value, float) else value


def _pyarrow() -> Any:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise SolidgearError(
            "Parquet files need pyarrow: pip install 'solidgear[sweep]', or write a .csv file"
        ) from None
    return pyarrow
