"""Tables of a scene file that rooms of features add, as far as the core asks something of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Protocol

from pydantic import BeforeValidator, TypeAdapter, ValidationError

from solidgear.core.errors import SceneError, scene_error
from solidgear.core.registry import absent, addition


def _refuse(table: str) -> Any:
    """Refuse a table whose room is not there."""
    raise SceneError(absent("table", table))


def refused(table: str) -> Any:
    """Return the type of a table whose room is not there."""
    return Annotated[Any, BeforeValidator(lambda value: _refuse(table))]


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
    def seat_width(self) -> float: ...

    @property
    def one_sided(self) -> bool: ...

    @property
    def faces_one_way(self) -> bool: ...

    @property
    def ribs(self) -> str: ...

    @property
    def both_ways(self) -> bool: ...

    def with_changes(self, **changes: Any) -> Any: ...


class Pairing:
    """Reader of the key ``arrangement``, which mounts two bearings as a pair; without a room that
    reads it there are no pairs.
    """

    #: type of the key
    Words: Any = Annotated[
        tuple, BeforeValidator(lambda value: _refuse("arrangement") if value else ())
    ]

    def read_pairs(self, words: Any, tables: Sequence[Mapping[str, Any]]) -> list | None:
        """Return the pairs that the words of a file name; None where tables are wrong."""
        return []

    def readable_tables(self, tables: Sequence[Mapping[str, Any]], pairs: list | None) -> Sequence:
        """Return the tables of bearings with a direction for those that wait for one."""
        return tables


class PartReader:
    """Reader of the table ``body``, which takes the shaft from another file; without a room that
    reads it the table is refused.
    """

    Table: Any = refused("body")  #: type of the table
    Body: Any = refused("body")  #: type of the body that it becomes

    def check_tables(self, tables: Mapping[str, Any]) -> None:
        """Refuse tables of a file that its body cannot have."""

    def with_seats(self, part: Any, stations: Iterable, segments: Sequence) -> Any:
        """Return the body with remarks on seats that are not whole."""
        return part

    def written(self, body: Any) -> dict[str, Any]:
        """Return the table that names the part of a scene."""
        raise NotImplementedError

    def refuse_parts(self, table: Any, folder: Path) -> Any:
        """Refuse the table."""
        _refuse("body")

    recognise = refuse_parts


def pairing() -> Pairing:
    """Return the reader of pairs of bearings."""
    return (addition("table", "arrangement") or Pairing)()


def with_list(tables: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return the tables of a scene with bearings of the list that it names."""
    complete = addition("table", "list of bearings")
    if complete is None:
        return dict(tables) if tables.get("bearings") is None else _refuse("list of bearings")
    return complete(tables, folder)


def paired(bearings: Sequence[Any], arrangement: Any) -> tuple[tuple[Any, ...], Sequence[Any]]:
    """Return bearings made in Python with a provisional direction where an arrangement mounts them, and
    their pairs; as they are without one.
    """
    if arrangement is None:
        return tuple(bearings), ()
    reader = pairing()
    try:
        words = TypeAdapter(reader.Words).validate_python(arrangement)
    except ValidationError as error:
        problem = scene_error(error, arrangement)
        raise problem.located(None, prefix=("arrangement",)) from None
    tables = [bearing.words or {"name": bearing.name} for bearing in bearings]
    pairs = reader.read_pairs(words, tables) or []
    known = reader.readable_tables(tables, pairs)
    return tuple(
        bearing
        if known_table == table
        else bearing.with_changes(catalogue=known_table["catalogue"])
        for bearing, table, known_table in zip(bearings, tables, known)
    ), pairs


def parts() -> PartReader:
    """Return the reader of parts from files."""
    return (addition("table", "body") or PartReader)()
