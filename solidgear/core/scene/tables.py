"""Tables of a scene file that rooms of features add, as far as the core asks something of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Protocol

from pydantic import BeforeValidator

from solidgear.core.errors import SceneError
from solidgear.core.registry import addition


def _refuse(value: Any) -> Any:
    raise SceneError("belongs to a part of solidgear that is not installed")


#: type of a table whose room is not installed
Absent = Annotated[Any, BeforeValidator(_refuse)]


class BearingData(Protocol):
    """Catalogue data of a rolling bearing."""

    kind: str
    arrangement: str
    holds: str | None  #: direction in which it holds the shaft
    preload: Any
    load: Any
    displacement: Any
    speed: float  #: rad/s

    @property
    def estimated(self) -> Sequence[str]: ...

    @property
    def floats(self) -> bool: ...

    @property
    def one_sided(self) -> bool: ...

    @property
    def both_ways(self) -> bool: ...

    def with_changes(self, **changes: Any) -> Any: ...


class Pairing(Protocol):
    """Reader of the key ``arrangement``, which mounts two bearings as a pair."""

    Words: Any  #: type of the key

    def read_pairs(self, words: Any, tables: Sequence[Mapping[str, Any]]) -> list | None: ...

    def readable_tables(
        self, tables: Sequence[Mapping[str, Any]], pairs: list | None
    ) -> Sequence: ...


class Unpaired:
    """Pairing where no room reads the key."""

    Words = Annotated[tuple, BeforeValidator(lambda value: _refuse(value) if value else ())]

    def read_pairs(self, words: Any, tables: Sequence[Mapping[str, Any]]) -> list:
        """Return no pairs."""
        return []

    def readable_tables(self, tables: Sequence[Mapping[str, Any]], pairs: list | None) -> Sequence:
        """Return the tables as they are."""
        return tables


class PartReader(Protocol):
    """Reader of the table ``body``, which takes the shaft from another file."""

    Table: Any  #: type of the table
    Body: Any  #: type of the body that it becomes

    def with_port(self, tables: Mapping[str, Any]) -> Mapping[str, Any]: ...

    def with_seats(self, part: Any, stations: Iterable, segments: Sequence) -> Any: ...

    def refuse_parts(self, table: Any, folder: Path) -> Any: ...

    def recognise(self, table: Any, folder: Path) -> Any: ...


class NoParts:
    """Reader of parts where no room has one."""

    Table = Body = Absent

    def with_port(self, tables: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the tables as they are."""
        return tables

    def with_seats(self, part: Any, stations: Iterable, segments: Sequence) -> Any:
        """Return the part as it is."""
        return part

    def refuse_parts(self, table: Any, folder: Path) -> Any:
        """Refuse the table."""
        _refuse(table)

    recognise = refuse_parts


def pairing() -> Any:
    """Return the reader of pairs of bearings, a :class:`Pairing`."""
    return (addition("table", "arrangement") or Unpaired)()


def parts() -> Any:
    """Return the reader of parts from files, a :class:`PartReader`."""
    return (addition("table", "body") or NoParts)()
