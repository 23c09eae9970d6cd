"""Entries in which two files differ, each by path and as written.

Tables of lists are paired by name, and by number where they have none.  Files that an entry names,
such as the scene of a shaft, are compared too.  Entries with the same meaning do not differ: a
quantity in other units, or a key that repeats the default.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isclose
from pathlib import Path
from typing import TYPE_CHECKING, Any

from solidgear.core import DIMENSIONS, Document, SceneError, Source, document_of, show
from solidgear.core.scene import file
from solidgear.core.scene.toml_file import describes_train
from solidgear.core.scene.units import quantity
from solidgear.trains.file import reading as train_file
from solidgear.trains.file.train import SIDES, Train

if TYPE_CHECKING:
    from solidgear.core import Scene

#: relative; an angle in degrees and the same in radians differ by rounding
ROUNDING = 1e-12
#: tables that stand for a list of one
ONE_OR_MORE = ("port", "operation")
#: keys of texts without numbers
WORDS = ("title", "source", "note", "status", "scene")
#: keys that name a file whose content counts, and not the name alone
FILES = ("contact_cells", "step", "mesh", "matrices")


@dataclass(frozen=True)
class Difference:
    """An entry in which two files differ."""

    path: str  #: such as ``pinion.bearing.0.position``, as :mod:`solidgear.core.scene.paths` has it
    #: a, b: as written; None where a file does not have it
    a: Any
    b: Any

    @property
    def in_words(self) -> bool:
        """True for a text without numbers: a title, a source, the name of a file that is compared."""
        return self.path.rpartition(".")[2] in WORDS

    def texts(self, width: int) -> tuple[str | None, str | None]:
        """Return both entries in at most `width` letters: texts without quotes, others as in a file.

        Examples
        --------
        >>> Difference("mesh.stiffness", "2.5e8 N/m", None).texts(70)
        ('2.5e8 N/m', None)
        >>> Difference("losses", {"mesh": 0.12}, "a long text").texts(8)
        ('{"mes...', 'a lon...')
        """
        return _text(self.a, width), _text(self.b, width)


def differences(a: Source, b: Source) -> tuple[Difference, ...]:
    """Return the entries in which two trains or scenes differ, in the order of the first, without
    their names; the [ask] of shafts of a train is left out.

    Examples
    --------
    >>> pairs = differences("geometry/axle_overhung.toml", "geometry/axle_straddle.toml")
    >>> [pair.path for pair in pairs][:3]
    ['title', 'pinion.scene', 'pinion.title']
    >>> pairs[1].a, pairs[1].b
    ('pinion_overhung.toml', 'pinion_straddle.toml')
    """
    return tuple(_Tables((document_of(a), document_of(b))).of_files())


def scene_differences(a: Scene, b: Scene) -> tuple[Difference, ...]:
    """Return the fields in which two scenes differ, SI, whatever files they come from.

    Examples
    --------
    >>> import solidgear as sg
    >>> long, short = (sg.Segment.cylinder("rod", length=x, diameter=0.02) for x in (0.6, 0.5))
    >>> pairs = scene_differences(*(sg.Scene.from_parts([rod]) for rod in (long, short)))
    >>> (pairs[0].path, pairs[0].a, pairs[0].b)
    ('segments.rod.y1', 0.6, 0.5)
    """
    first, second = (scene.model_dump(mode="json") for scene in (a, b))
    return tuple(_Tables().differing("", first, second, left_out=("name",)))


class _Tables:
    """Two tables, entry by entry; of files, with the path of the entry that names them."""

    def __init__(self, files: tuple[Document, Document] | None = None, prefix: str = ""):
        self.files, self.prefix = files, prefix
        self.raw = [dict(document.tables) for document in files or ()]
        for raw in self.raw:
            for key in ONE_OR_MORE:
                if isinstance(raw.get(key), Mapping):
                    raw[key] = [raw[key]]
        self.models = [self._model(k) for k in range(len(self.raw))]

    def of_files(self) -> Iterator[Difference]:
        """Yield the differences of both files."""
        a, b = self.raw
        yield from self.differing("", a, b, left_out=("name", "ask") if self.prefix else ("name",))

    def differing(
        self, path: str, a: dict, b: dict, left_out: tuple[str, ...] = ()
    ) -> Iterator[Difference]:
        """Yield the differences of two tables at a path."""
        for key in dict.fromkeys([*a, *b]):
            if key not in left_out and not self._is_default(a, b, key):
                entry_path = f"{path}.{key}" if path else key
                yield from self._entries(entry_path, key, a.get(key), b.get(key))

    def _entries(self, path: str, key: str, a: Any, b: Any) -> Iterator[Difference]:
        side, _, key_name = path.rpartition(".")
        is_shaft = side in SIDES or side.startswith("shaft.")
        is_scene = bool(self.files) and key_name == "scene" and is_shaft
        if isinstance(a, dict) and isinstance(b, dict) and not is_scene:
            yield from self.differing(path, a, b)
        elif _are_tables(a) and _are_tables(b):
            yield from self._lists(path, a, b)
        elif not is_scene and (not _is_equal(a, b) or self._other_content(key, a, b)):
            yield Difference(self.prefix + path, a, b)
        if is_scene:
            if a != b and isinstance(a, str) and isinstance(b, str):
                yield Difference(self.prefix + path, a, b)
            scenes = self._scene(0, a), self._scene(1, b)
            yield from _Tables(scenes, f"{self.prefix}{side}.").of_files()

    def _lists(self, path: str, a: list[dict], b: list[dict]) -> Iterator[Difference]:
        """Yield the differences of lists of tables, by names or numbers."""
        names = _names(a), _names(b)
        keys = names if all(names) else (range(len(a)), range(len(b)))
        first, second = dict(zip(keys[0], a)), dict(zip(keys[1], b))
        for key in dict.fromkeys([*first, *second]):
            entry_path = f"{path}.{key + 1 if isinstance(key, int) else key}"
            yield from self._entries(entry_path, "", first.get(key), second.get(key))

    def _is_default(self, a: dict, b: dict, key: str) -> bool:
        """Return True for a key of one table of a file alone that would change nothing in the
        other.
        """
        if not self.files or key in a and key in b:
            return False
        k, table, value = (1, b, a[key]) if key in a else (0, a, b[key])
        table[key] = value
        unchanged = self.models[k] is not None and self._model(k) == self.models[k]
        del table[key]
        return unchanged

    def _model(self, k: int) -> Train | Scene | None:
        """Return the scene or train of a file; None where it cannot be read alone."""
        assert self.files
        read = train_file.train_of if describes_train(self.raw[k]) else file.scene_of
        try:
            return read(self.raw[k], self.files[k].path)
        except SceneError:
            return None

    def _scene(self, k: int, scene: Any) -> Document:
        """Return the scene of a shaft, of a file of its own or within the train."""
        assert self.files
        path = self.files[k].path
        if isinstance(scene, Mapping):
            return Document(scene, path)
        return document_of(Path(path).parent / str(scene))

    def _other_content(self, key: str, a: Any, b: Any) -> bool:
        """Return True for one name of two files with different content."""
        if not self.files or key not in FILES or not (isinstance(a, str) and isinstance(b, str)):
            return False
        files = [Path(document.path).parent / name for document, name in zip(self.files, (a, b))]
        return all(f.is_file() for f in files) and files[0].read_bytes() != files[1].read_bytes()


def _text(value: Any, width: int) -> str | None:
    if value is None or not isinstance(value, str):
        return None if value is None else show(value, width)
    return value if len(value) <= width else f"{value[: width - 3]}..."


def _are_tables(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(entry, dict) for entry in value)


def _names(entries: list[dict]) -> list[str]:
    """Return the names of the tables of a list; none unless all have different names."""
    names = [entry.get("name") for entry in entries]
    distinct = [name for name in dict.fromkeys(names) if isinstance(name, str)]
    return distinct if len(distinct) == len(names) else []


def _is_equal(a: Any, b: Any) -> bool:
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(_is_equal, a, b))
    first, second = _in_si(a), _in_si(b)
    if first is None or second is None:
        return bool(a == b)
    return isclose(first, second, rel_tol=ROUNDING)


def _in_si(value: Any) -> float | None:
    """Return a number, or the SI value of a text with a unit of any dimension; None for others."""
    for dimension in DIMENSIONS:
        if dimension != "dimensionless":
            try:
                return quantity(value, dimension)
            except SceneError:
                continue
    return None
