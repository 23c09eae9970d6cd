"""Keys of scene and train files whose values are words, never numbers, and those of whole numbers."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from solidgear.core.registry import added
from solidgear.core.scene.blends import BLENDS
from solidgear.core.scene.feature_rules import kinds_of_features
from solidgear.core.scene.file import SceneFile, ScenePartFile
from solidgear.core.scene.paths import Keys
from solidgear.core.scene.typed import Holds, Model

#: names of files and of materials, whatever they are read into
NAMES = ("scene", "material")


def is_text(keys: Keys) -> bool:
    """Return True for an entry whose value is a word by the format of files.

    Examples
    --------
    >>> is_text(("bearing", 0, "catalogue", "designation")), is_text(("bearing", 0, "position"))
    (True, False)
    >>> is_text(("bearing", 0, "from")), is_text(("bearing", 0, "seat", "from"))
    (True, False)
    """
    names = tuple(key for key in keys if isinstance(key, str))
    return names[-1:] != () and (names[-1] in NAMES or any(map(_of_words, _kinds(names))))


def is_whole(keys: Keys) -> bool:
    """Return True for an entry whose value is a whole number by the format of files.

    Examples
    --------
    >>> is_whole(("pinion", "teeth")), is_whole(("pinion", "module"))
    (True, False)
    """
    names = tuple(key for key in keys if isinstance(key, str))
    return any(map(_of_whole_numbers, _kinds(names)))


@lru_cache(maxsize=512)
def _kinds(names: tuple[str, ...]) -> tuple[Any, ...]:
    """Return the types that an entry may have."""
    kinds: list[type[Model]] = [SceneFile, ScenePartFile, *added("file").values()]
    fields: list[FieldInfo] = []
    for name in names:
        fields = [field for kind in kinds if (field := kind.table_keys().get(name)) is not None]
        # a name that is no key of a table names one of several
        kinds = [kind for field in fields for kind in _tables(field)] or kinds
        if name == "feature":
            kinds = [*kinds_of_features().values(), *BLENDS.values()]
    return tuple(field.annotation for field in fields)


def _tables(field: FieldInfo) -> Iterator[type[Model]]:
    """Yield the models that a field holds."""
    yield from (mark.kind for mark in field.metadata if isinstance(mark, Holds))
    annotations = [field.annotation]
    while annotations:
        kind: Any = annotations.pop()
        if isinstance(kind, type) and issubclass(kind, Model):
            yield kind
        annotations += get_args(kind) if get_origin(kind) is not Literal else ()


def _of_words(kind: Any) -> bool:
    """Return True for a type of words alone, or of words and None."""
    if get_origin(kind) is Literal:
        return all(isinstance(word, str) for word in get_args(kind))
    parts = [part for part in get_args(kind) if isinstance(part, type) or get_args(part)]
    parts = [part for part in parts if part is not type(None)]
    return kind is str or (bool(parts) and all(map(_of_words, parts)))


def _of_whole_numbers(kind: Any) -> bool:
    """Return True for a type of whole numbers alone, or of these and None."""
    if get_origin(kind) is Annotated:
        return _of_whole_numbers(get_args(kind)[0])
    parts = [part for part in get_args(kind) if part is not type(None)]
    return kind is int or (bool(parts) and all(map(_of_whole_numbers, parts)))
