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
  options, variation, columns), the number of the row and its text.
- *The structure of the database is damaged.*  SQLite checks it at every opening.

A damaged database is made anew from the rows that can still be reached by their number and match
their checksum; the others count as not solved.  The key is not needed for that, because a row
proves by its checksum to which sweep it belongs.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

from solidgear.errors import SolidgearError

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
ONE_ROW = "SELECT variant, line, checksum FROM rows WHERE variant = ?"
ADD_ROW = "INSERT INTO rows VALUES (?, ?, ?)"
SET_FACT = "INSERT OR REPLACE INTO facts VALUES (?, ?, ?)"


class Store:
    """Rows of one sweep, held by one process at a time.

    Parameters
    ----------
    key : mapping
        What the rows depend on, JSON-serialisable; rows of another key are never mixed in.
    total : int
        Rows there are to be; they are numbered from 0.
    overwrite : bool
        Start anew whatever is there.

    Attributes
    ----------
    done : set of int
        Numbers of the rows that are there.
    repaired : str
        What was found damaged and how it was mended, in a sentence; empty if nothing was.
    facts : dict
        What goes with the rows, JSON-serialisable: ``rows``, how many there are, and what
        :meth:`note` has put there.

    Raises
    ------
    SolidgearError
        If another process holds the database, it has rows of another sweep, or it is damaged
        beyond telling whose rows it has.
    OSError, sqlite3.Error
        If it cannot be written.
    """

    def __init__(self, path: Path, key: Mapping[str, Any], total: int, overwrite: bool = False):
        self.path, self.total = Path(path), total
        self._key = json.loads(json.dumps(key))
        self._fingerprint = _digest(_json(self._key))
        self.done: set[int] = set()
        self.repaired = ""
        self.facts: dict[str, Any] = {"rows": 0}
        self._db, self._file = self._lock(overwrite)
        try:
            if overwrite:
                self._discard()
            else:
                self._open()
            self._db.execute("PRAGMA journal_mode = WAL")
            self._db.execute("PRAGMA synchronous = NORMAL")
        except BaseException:
            self._db.close()
            raise

    # ---------------------------------------------------------------------------------- opening
    def _lock(self, discard: bool) -> tuple[sqlite3.Connection, tuple[int, int]]:
        """The database under its exclusive lock, and which file that is."""
        for _ in range(3):
            if not self.path.exists():
                self.path.open("ab").close()  # says why, where it cannot be; SQLite does not
            file = self._identity()
            db = sqlite3.connect(self.path.absolute(), timeout=0, isolation_level=None)
            db.text_factory = lambda raw: raw.decode("utf-8", "surrogateescape")
            try:
                db.execute("PRAGMA trusted_schema = OFF")
                db.execute("PRAGMA writable_schema = ON")  # lets a file be read that was cut off
                db.execute("PRAGMA locking_mode = EXCLUSIVE")  # not given back after a transaction
                db.execute("BEGIN EXCLUSIVE")
                db.execute("COMMIT")
                db.execute("PRAGMA journal_mode = DELETE")  # what a killed process left in its log
            except sqlite3.DatabaseError as error:
                db.close()
                if _is(error, sqlite3.SQLITE_BUSY):
                    raise self._taken() from None
                if not _is(error, sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT):
                    raise
                if not discard:
                    raise self._lost(error) from None
                self.path.unlink()
                continue
            # Another process that ends without rows takes its file away, perhaps just now.
            if file is not None and self._identity() == file:
                return db, file
            db.close()
        raise self._taken()

    def _open(self) -> None:
        try:
            self._take()
        except sqlite3.DatabaseError as error:
            if _is(error, sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_ERROR):
                raise self._lost(error) from None
            raise

    def _take(self) -> None:
        """Take the rows that are there, and mend what is damaged."""
        if self._is_new():
            self._remake([])
            return
        key, facts, sound = self._facts_there()
        if key is not None and self._is_other(key):
            self._remake([])
            return
        if sound and self._is_sound() and facts.get("rows") == len(self.done):
            self.facts = facts
            return
        if key is None and next(self._reachable(), None) is None:
            raise self._lost("neither its key nor any row of this sweep is intact")
        self.done, self.facts = set(), facts
        before = min(facts.get("rows", self.total), self.total)
        self._remake(self._reachable())
        kept = len(self.done)
        if kept == 0:
            found = "none of its rows is intact, all are solved again"
        elif kept < before:
            found = f"{kept} of its rows are intact and kept, the others are solved again"
        else:
            found = f"all {kept} rows are intact and were saved into a new one"
        self.repaired = f"{self.path} was damaged: {found}"

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

    def _facts_there(self) -> tuple[Any, dict[str, Any], bool]:
        """Key of the sweep that is there, or None; facts that are intact; whether all of it is."""
        key, facts, sound = None, {}, True
        try:
            with closing(self._db.execute("SELECT name, value, checksum FROM facts")) as found:
                for name, text, checksum in found:
                    if not isinstance(text, str):
                        sound = False
                    elif name == "key" and checksum == _digest(text):
                        key = json.loads(text)
                    elif checksum == self._checksum(name, text):
                        facts[name] = json.loads(text)
                    else:
                        sound = False
        except sqlite3.DatabaseError:
            sound = False
        key = key if isinstance(key, dict) else None
        return key, facts, sound and key is not None

    def _is_other(self, key: Mapping[str, Any]) -> bool:
        """Tell whether a key is that of another sweep; refused if there are rows of it."""
        # as texts, for a number that is none is not equal to itself
        names = sorted({*key, *self._key})
        differ = [name for name in names if _json(key.get(name)) != _json(self._key.get(name))]
        if differ and self._one("SELECT count(*) FROM rows"):
            # columns follow from the rest; alone they differ between versions only
            told = ", ".join([name for name in differ if name != "columns"] or differ)
            raise SolidgearError(
                f"{self.path.with_suffix('')}: holds the rows of another sweep (it differs in: "
                f"{told}); choose another --out, or add --overwrite"
            )
        return bool(differ)

    def _is_sound(self) -> bool:
        """Tell whether the structure and all rows are intact; `done` has the numbers then."""
        try:
            if self._one("PRAGMA integrity_check(1)") != "ok":
                return False
            with closing(self._db.execute(ALL_ROWS)) as rows:
                for number, line, checksum in rows:
                    if not self._intact(number, line, checksum):
                        return False
                    self.done.add(number)
        except sqlite3.DatabaseError:
            return False
        return True

    def _reachable(self) -> Iterator[tuple[int, str]]:
        """Rows that are intact, in a database of which parts may be unreadable."""
        for number in range(self.total):
            try:
                found = self._db.execute(ONE_ROW, (number,)).fetchall()
            except sqlite3.DatabaseError:
                continue
            if found and self._intact(*found[0]):
                yield number, found[0][1]

    def _intact(self, number: Any, line: Any, checksum: Any) -> bool:
        typed = isinstance(number, int) and isinstance(line, str)
        return typed and 0 <= number < self.total and checksum == self._checksum(number, line)

    def _checksum(self, name: Any, text: Any) -> str:
        return _digest(f"{self._fingerprint}\n{name}\n{text}")

    def _one(self, query: str) -> Any:
        return self._db.execute(query).fetchall()[0][0]

    def _identity(self) -> tuple[int, int] | None:
        try:
            found = self.path.stat()
        except FileNotFoundError:
            return None
        return found.st_dev, found.st_ino

    # ---------------------------------------------------------------------------------- writing
    def _remake(self, rows: Iterable[tuple[int, str]]) -> None:
        """Some rows in place of all that is there, in one step and under the same lock."""
        with closing(sqlite3.connect("", isolation_level=None)) as new:  # a temporary file
            new.executescript(TABLES)
            with new:
                new.execute("BEGIN")
                for number, line in rows:
                    new.execute(ADD_ROW, (number, line, self._checksum(number, line)))
                    self.done.add(number)
                key = _json(self._key)
                new.execute(SET_FACT, ("key", key, _digest(key)))
                self.facts["rows"] = len(self.done)
                new.executemany(SET_FACT, map(self._fact, self.facts.items()))
            new.backup(self._db)

    def _discard(self) -> None:
        try:
            self._remake([])
        except sqlite3.DatabaseError as error:
            if not _is(error, sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT):
                raise
            self._db.close()
            self.path.unlink()
            self._db, self._file = self._lock(True)
            self._remake([])

    def append(self, rows: Iterable[tuple[int, str]]) -> None:
        """Add rows, each a number and its text; all are on the disk when this returns, or none."""
        self._still_there()
        new = [(number, line, self._checksum(number, line)) for number, line in rows]
        with self._db:
            self._db.execute("BEGIN")
            self._db.executemany(ADD_ROW, new)
            self._db.execute(SET_FACT, self._fact(("rows", len(self.done) + len(new))))
        self.done.update(number for number, _, _ in new)
        self.facts["rows"] = len(self.done)

    def note(self, name: str, value: Any) -> None:
        """Keep something beside the rows."""
        self._still_there()
        self._db.execute(SET_FACT, self._fact((name, value)))
        self.facts[name] = value

    def _fact(self, item: tuple[str, Any]) -> tuple[str, str, str]:
        name, value = item
        return name, _json(value), self._checksum(name, _json(value))

    def lines(self) -> Iterator[str]:
        """Texts of the rows by ascending number, each checked once more."""
        count = 0
        with closing(self._db.execute(ALL_ROWS)) as rows:
            for number, line, checksum in rows:
                if not self._intact(number, line, checksum):
                    raise self._changed()
                count += 1
                yield line
        if count != len(self.done):
            raise self._changed()

    def close(self) -> None:
        """Let another process have the database; one without rows is taken away."""
        with suppress(sqlite3.Error, OSError):  # a full disk, say: the log is kept then
            self._db.execute("PRAGMA journal_mode = DELETE")
            if not self._one("SELECT count(*) FROM rows") and self._identity() == self._file:
                self.path.unlink()  # not on Windows, which keeps a file that is open
        self._db.close()

    def _still_there(self) -> None:
        if self._identity() != self._file:
            raise SolidgearError(
                f"{self.path}: was taken away or replaced while the sweep was writing to it; "
                "start the sweep again"
            )

    # --------------------------------------------------------------------------------- refusals
    def _taken(self) -> SolidgearError:
        return SolidgearError(
            f"{self.path}: is in use by another process, perhaps the same sweep; "
            "wait for it to end, or choose another --out"
        )

    def _lost(self, reason: Any) -> SolidgearError:
        return SolidgearError(
            f"{self.path}: is damaged beyond repair ({reason}); put back a copy, "
            "or add --overwrite to solve all rows again"
        )

    def _changed(self) -> SolidgearError:
        return SolidgearError(
            f"{self.path}: was changed while the sweep was writing to it; the same command mends it"
        )


def _is(error: sqlite3.Error, *codes: int) -> bool:
    # the low byte is the kind, the rest the place; an error of the binding itself has no code
    return getattr(error, "sqlite_errorcode", sqlite3.SQLITE_ERROR) & 0xFF in codes


def _json(value: Any) -> str:
    return json.dumps(value, sort_keys=True)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()
