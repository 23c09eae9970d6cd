"""The rows of a sweep on disk: written as they come, resumed where they stop.

Rows go to a CSV file; a Parquet file is made from it when all are there.  A JSON file beside it says which sweep the rows belong to.
"""

from __future__ import annotations

import csv
import hashlib
import json
import math
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from solidgear.errors import SolidgearError
from solidgear.whole_file import whole


class RowFile:
    """Rows of one sweep.

    Parameters
    ----------
    path : Path
        ``.csv`` or ``.parquet``.
    columns : mapping of str to type
        Names and types, the first one being the number of the row.
    plan : mapping
        What the rows depend on, JSON-serialisable; rows of another plan are never mixed in.
    overwrite : bool
        Start anew whatever is there.

    Attributes
    ----------
    done : set of int
        Rows that are there already.

    Raises
    ------
    SolidgearError
        For another suffix, a missing package, a folder that cannot be written, or rows of another plan.
    """

    def __init__(self, path: Path, columns: Mapping[str, type], plan: Mapping[str, Any], overwrite: bool = False):
        self.path, self.columns = Path(path), dict(columns)
        if self.path.suffix not in (".csv", ".parquet"):
            raise SolidgearError(f"--out {self.path}: the name must end in .csv or .parquet")
        self._parquet = self.path.suffix == ".parquet"
        if self._parquet:
            _pyarrow()
        self.work = self.path.with_name(self.path.name + ".part.csv") if self._parquet else self.path
        self._record = self.path.with_name(self.path.name + ".json")
        self._plan = json.loads(json.dumps(plan))
        self.done: set[int] = set()
        self._complete = False
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            there = self.path.exists() or self.work.exists()
            if there and not overwrite:
                self._check_plan()
                self._resume()
            else:
                self._begin()
        except OSError as error:
            raise SolidgearError(f"--out {self.path}: cannot be written ({error.strerror or error})") from None

    def _check_plan(self) -> None:
        try:
            before = json.loads(self._record.read_text(encoding="utf-8"))["plan"]
        except (OSError, ValueError, KeyError, TypeError):
            raise SolidgearError(f"{self.path}: is there already, and nothing beside it says that it came from this sweep; choose another --out, or add --overwrite") from None
        differ = [key for key in sorted({*before, *self._plan}) if before.get(key) != self._plan.get(key)]
        if differ:
            raise SolidgearError(f"{self.path}: holds the rows of another sweep (it differs in: {', '.join(differ)}); choose another --out, or add --overwrite")

    def _resume(self) -> None:
        if self._parquet and self.path.exists():
            self._complete = True
            self.done = set(_pyarrow().parquet.read_table(self.path, columns=["variant"])["variant"].to_pylist())
            return
        text = self.work.read_bytes()
        intact = text[: text.rfind(b"\n") + 1]
        lines = list(csv.reader(intact.decode("utf-8").splitlines()))
        if not lines or lines[0] != list(self.columns):
            self._begin()
            return
        if len(intact) < len(text):  # the last row was cut off in the middle
            os.truncate(self.work, len(intact))
        self.done = {int(line[0]) for line in lines[1:]}

    def _begin(self) -> None:
        for old in {self.path, self.work}:
            old.unlink(missing_ok=True)
        digest = hashlib.sha256(json.dumps(self._plan, sort_keys=True).encode()).hexdigest()
        with whole(self._record) as partial:
            partial.write_text(json.dumps({"fingerprint": digest, "plan": self._plan}, indent=1), encoding="utf-8")
        with self.work.open("w", newline="", encoding="utf-8") as f:
            csv.writer(f, lineterminator="\n").writerow(self.columns)

    def append(self, rows: Iterable[Mapping[str, Any]]) -> None:
        """Add rows; they are in the file when this returns."""
        rows = list(rows)
        with self.work.open("a", newline="", encoding="utf-8") as f:
            writer = csv.writer(f, lineterminator="\n")
            writer.writerows([_text(row.get(name)) for name in self.columns] for row in rows)
        self.done |= {row["variant"] for row in rows}

    def finish(self) -> None:
        """All rows are there: make the Parquet file if that is what was asked for."""
        if not self._parquet or self._complete:
            return
        arrow = _pyarrow()
        with self.work.open(newline="", encoding="utf-8") as f:
            table = sorted(csv.DictReader(f), key=lambda row: int(row["variant"]))
        kinds = {int: arrow.int64(), float: arrow.float64(), str: arrow.string()}
        data = {name: arrow.array([kind(row[name]) if row[name] else None for row in table], kinds[kind]) for name, kind in self.columns.items()}
        with whole(self.path) as partial:
            arrow.parquet.write_table(arrow.table(data), partial)
        self.work.unlink()
        self._complete = True


def _text(value: Any) -> Any:
    """What stands in a CSV field: full precision, nothing for what does not exist."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return repr(value) if isinstance(value, float) else value


def _pyarrow():
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise SolidgearError("Parquet files need pyarrow: pip install 'solidgear[sweep]', or write a .csv file") from None
    return pyarrow
