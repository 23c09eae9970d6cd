"""A document: the tables of a scene, of a train or of measured data, wherever they come from.

A file, a dict and an object are one thing: each gives tables with the keys of a file.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias, TypeVar, runtime_checkable

from solidgear.core.errors import SceneError, SolidgearError, show
from solidgear.core.scene.paths import Tables
from solidgear.core.scene.toml_file import describes_train, place_of, read_text, tables_in

Thing = TypeVar("Thing")


@runtime_checkable
class Documented(Protocol):
    """A scene, a train or measured data, which gives its tables."""

    def to_dict(self) -> dict[str, Any]: ...


@dataclass(frozen=True)
class Document:
    """Tables with the folder of the files that they name.

    Examples
    --------
    >>> document = document_of("geometry/shaft_stepped.toml")
    >>> document.describes_train, [*document.tables][:2]
    (False, ['title', 'source'])
    """

    tables: Tables
    #: of the file, or of that which it would be: the folder of the files that it names, and its
    #: name in messages
    path: str
    text: str = ""  #: of the file that it was read from

    @property
    def describes_train(self) -> bool:
        """True for a train of shafts, and not for one shaft."""
        return describes_train(self.tables)


@dataclass(frozen=True, eq=False)
class Origin:
    """What a scene or a train was read from, which is no part of what it is: all are equal."""

    document: Document | None = None
    thing: Any = None  #: as it was read

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Origin)

    def __hash__(self) -> int:
        return 0


#: what every study begins with
Source: TypeAlias = str | os.PathLike | Mapping[str, Any] | Document | Documented
SOURCE_WORDS = "the path of a TOML file, its tables as a dict, or a Scene or Train"


def document_of(source: Source) -> Document:
    """Return the document of a path, of tables or of an object; tables name files relative to the
    folder of work.
    """
    if isinstance(source, Document):
        return source
    if isinstance(source, str | os.PathLike):
        path = os.fspath(source)
        text = read_text(path)
        return Document(tables_in(text, path), path, text)
    if isinstance(source, Mapping):
        return Document(source, name_of_source(source))
    if isinstance(source, Documented):
        # what has not changed since means what its file says: a place moves with its segment
        read = getattr(source, "as_read", None)
        return read or Document(source.to_dict(), name_of_source(source))
    raise SolidgearError(f"{show(repr(source), 40)[1:-1]}: give {SOURCE_WORDS}")


def read_tables(
    tables: Mapping[str, Any],
    folder: str | os.PathLike,
    name: str,
    kind: str,
    reader: Callable[[Document], Thing],
) -> Thing:
    """Return what a reader of documents makes of a dict, whose names of files are relative to a folder;
    errors are those of a dict of a `kind`.
    """
    if not isinstance(tables, Mapping):
        raise SolidgearError(
            f"{show(repr(tables), 40)[1:-1]}: give the tables of a {kind} as a dict, by the keys of "
            "its file"
        )
    try:
        return reader(Document(tables, os.path.normpath(os.path.join(folder, name))))
    except SceneError as error:
        raise error.of_dict() from None


def name_of_source(source: Source) -> str:
    """Return the name of a source in messages: a path, or that of its tables or its object."""
    if isinstance(source, str | os.PathLike):
        return place_of(os.fspath(source))
    if isinstance(source, Document):
        return place_of(source.path)
    if isinstance(source, Mapping):
        return "train" if describes_train(source) else "scene"
    return getattr(source, "name", "") or "scene"


def is_train(source: Source) -> bool:
    """True for what describes a train."""
    return document_of(source).describes_train
