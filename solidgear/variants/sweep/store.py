"""The rows of a sweep in an embedded database: every row with a checksum, every batch whole or not.

The database is one file of SQLite, which comes with Python.  What may happen to it, and what
answers:

- *The process ends in the middle of a batch.*  A batch is a transaction; the next opening drops
  it.  Batches go to a second file first, the write-ahead log (``-wal``), which is synced only now
  and then, 20 times faster than a sync a batch; a failure of the machine may cost the last
  batches, that of the process none.  The log is gone when the store is closed.
- *Two sweeps want the same file.*  Opening takes the exclusive lock of the database and keeps it.
  The operating system holds it for the process and drops it when the process ends, however it
  ends; the second sweep is refused at once.
- *The same row twice.*  The number of the row is the primary key.
- *A row was altered, or put there by another.*  Its checksum covers the key of the sweep (scene,
  options, variation, columns), the number of the row and its text.  It counts as not solved.
- *The structure of the database is damaged.*  SQLite checks it at every opening; the sweep is
  refused.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from solidgear.core.errors import SolidgearError

try:
    import sqlite3
except ImportError:  # left out of some builds of Python
    raise SolidgearError(
        "a sweep keeps its rows in SQLite, which this Python was built without; use one that has it"
    ) from None

#: What is raised where a store cannot be written.
StoreError = sqlite3.Error
#: Of the tables below; a database of another one is refused.
SCHEMA = 1
#: Marks a database as ours ("gear" in ASCII).
APPLICATION = 0x67656172
TABLES = f"""
PRAGMA application_id = {APPLICATION};
PRAGMA user_version = {SCHEMA};
CREATE TABLE facts (name TEXT PRIMARY KEY, value TEXT NOT NULL, checksum TEXT NOT NULL);
CREATE TABLE rows (variant INTEGER PRIMARY KEY, line TEXT NOT NULL, checksum TEXT NOT NULL);
"""
ALL_ROWS = "SELECT variant, line, checksum FROM rows ORDER BY variant"
DAMAGED = (sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_ERROR)


class Store:
    """Rows of one sweep, held by one process at a time.

    Parameters
    ----------
    key : mapping
        What the rows depend on, JSON-serialisable; rows of another key are never mixed in.
    overwrite : bool
        Start anew whatever is there.

    Attributes
    ----------
    done : set of int
        Numbers of the rows that are there, from 0.
    repaired : str
        What was found damaged and how it was mended, in a sentence; empty if nothing was.
    facts : dict
        What :meth:`note` has put beside the rows.

    Raises
    ------
    SolidgearError
        If another process holds the database, it has rows of another sweep, or it is damaged.
    OSError, sqlite3.Error
        If it cannot be written.
    """

    def __init__(self, path: Path, key: Mapping[str, Any], overwrite: bool = False):
        self.path = Path(path)
        self._key = _json(key)
        self._fingerprint = _digest(self._key)
        self.done: set[int] = set()
        self.repaired = ""
        self.facts: dict[str, Any] = {}
        if overwrite:
            self._discard()
        self._db = self._connected()
        try:
            _lock(self._db)
            self._still_there()  # a process that ends without rows takes its file away
            self._take()
            self._db.execute("PRAGMA journal_mode = WAL")
            self._db.execute("PRAGMA synchronous = NORMAL")
        except BaseException as error:
            self._db.close()
            raise self._told(error) from None

    # ---------------------------------------------------------------------------------- opening
    def _connected(self) -> sqlite3.Connection:
        self.path.open("ab").close()  # says why, where it cannot be; SQLite does not
        self._file = self._identity()
        return sqlite3.connect(self.path.absolute(), timeout=0, isolation_level=None)

    def _discard(self) -> None:
        """Take away what is there, unless another process holds it."""
        db = self._connected()
        try:
            _lock(db)
        except sqlite3.DatabaseError as error:
            if _is(error, sqlite3.SQLITE_BUSY):
                raise self._told(error) from None
        finally:
            db.close()
        for ending in ("", "-wal", "-shm", "-journal"):
            self.path.with_name(self.path.name + ending).unlink(missing_ok=True)

    def _take(self) -> None:
        """Take the rows that are there; those that were altered are dropped."""
        if self._is_new():
            self._db.executescript(TABLES)
        if self._one("PRAGMA integrity_check(1)") != "ok":
            raise self._lost("its structure is not intact")
        if not self._one("SELECT count(*) FROM rows"):
            self._db.execute("DELETE FROM facts")
            self._set("key", self._key)
            return
        facts = {
            name: text
            for name, text, checksum in self._db.execute("SELECT name, value, checksum FROM facts")
            if name == "key" or checksum == self._checksum(name, text)
        }
        self._refuse_other(facts.pop("key", ""))
        self.facts = {name: json.loads(text) for name, text in facts.items()}
        altered = []
        for number, line, checksum in self._db.execute(ALL_ROWS):
            if checksum == self._checksum(number, line):
                self.done.add(number)
            else:
                altered.append((number,))
        if altered:
            self._db.executemany("DELETE FROM rows WHERE variant = ?", altered)
            self.repaired = (
                f"{self.path} was damaged: {len(self.done)} of its rows are intact and kept, the "
                "others are solved again"
            )

    def _is_new(self) -> bool:
        marks = [self._one(f"PRAGMA {name}") for name in ("application_id", "user_version")]
        if marks == [0, 0] and not self._one("SELECT count(*) FROM sqlite_master"):
            return True
        if marks != [APPLICATION, SCHEMA]:
            raise SolidgearError(
                f"{self.path}: is no database of rows that this version of solidgear reads; "
                "choose another --out, or add --overwrite"
            )
        return False

    def _refuse_other(self, text: str) -> None:
        """Refuse rows of a key that is not that of this sweep."""
        if text == self._key:
            return
        try:
            key, own = dict(json.loads(text)), json.loads(self._key)
        except (TypeError, ValueError):
            raise self._lost("its key is not intact") from None
        # as texts, for a number that is none is not equal to itself
        names = sorted({*key, *own})
        differ = [name for name in names if _json(key.get(name)) != _json(own.get(name))]
        # columns follow from the rest; alone they differ between versions only
        told = ", ".join([name for name in differ if name != "columns"] or differ)
        raise SolidgearError(
            f"{self.path.with_suffix('')}: holds the rows of another sweep (it differs in: "
            f"{told}); choose another --out, or add --overwrite"
        )

    def _one(self, query: str) -> Any:
        return self._db.execute(query).fetchall()[0][0]

    def _identity(self) -> tuple[int, int] | None:
        try:
            found = self.path.stat()
        except FileNotFoundError:
            return None
        return found.st_dev, found.st_ino

    # ---------------------------------------------------------------------------------- writing
    def append(self, rows: Iterable[tuple[int, str]]) -> None:
        """Add rows, each a number and its text; all are on the disk when this returns, or none."""
        self._still_there()
        new = [(number, line, self._checksum(number, line)) for number, line in rows]
        with self._db:
            self._db.execute("BEGIN")
            self._db.executemany("INSERT INTO rows VALUES (?, ?, ?)", new)
        self.done.update(number for number, _, _ in new)

    def note(self, name: str, value: Any) -> None:
        """Keep something beside the rows, JSON-serialisable."""
        self._still_there()
        self._set(name, _json(value))
        self.facts[name] = value

    def _set(self, name: str, text: str) -> None:
        fact = name, text, self._checksum(name, text)
        self._db.execute("INSERT OR REPLACE INTO facts VALUES (?, ?, ?)", fact)

    def _checksum(self, name: Any, text: Any) -> str:
        return _digest(f"{self._fingerprint}\n{name}\n{text}")

    def lines(self) -> Iterator[str]:
        """Texts of the rows by ascending number."""
        return (line for _, line, _ in self._db.execute(ALL_ROWS))

    def close(self) -> None:
        """Let another process have the database; one without rows is taken away."""
        with suppress(sqlite3.Error, OSError):  # a full disk, say: the log is kept then
            self._db.execute("PRAGMA journal_mode = DELETE")
            if not self.done and self._identity() == self._file:
                self.path.unlink()  # not on Windows, which keeps a file that is open
        self._db.close()

    def _still_there(self) -> None:
        if self._identity() != self._file:
            raise SolidgearError(
                f"{self.path}: was taken away or replaced while the sweep was writing to it; "
                "start the sweep again"
            )

    # --------------------------------------------------------------------------------- refusals
    def _told(self, error: BaseException) -> BaseException:
        """An error of opening, in a sentence where it is one of the database."""
        if isinstance(error, sqlite3.DatabaseError) and _is(error, sqlite3.SQLITE_BUSY):
            return SolidgearError(
                f"{self.path}: is in use by another process, perhaps the same sweep; "
                "wait for it to end, or choose another --out"
            )
        if isinstance(error, sqlite3.DatabaseError) and _is(error, *DAMAGED):
            return self._lost(error)
        return error

    def _lost(self, reason: Any) -> SolidgearError:
        return SolidgearError(
            f"{self.path}: is damaged beyond repair ({reason}); put back a copy, "
            "or add --overwrite to solve all rows again"
        )


def _lock(db: sqlite3.Connection) -> None:
    """Take the exclusive lock and keep it."""
    db.execute("PRAGMA locking_mode = EXCLUSIVE")  # not given back after a transaction
    db.execute("BEGIN EXCLUSIVE")
    db.execute("COMMIT")


def _is(error: sqlite3.Error, *codes: int) -> bool:
    # the low byte is the kind, the rest the place; an error of the binding itself has no code
    return getattr(error, "sqlite_errorcode", sqlite3.SQLITE_ERROR) & 0xFF in codes


def _json(value: Any) -> str:
    return json.dumps(value, sort_keys=True)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()
