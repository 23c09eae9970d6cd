"""Entries of a file that vary: ``PATH=VALUES`` texts, by paths of :mod:`solidgear.core.scene.paths`.

VALUES are ``a:b:n``, ``log:a:b:n`` or a list ``a,b,c``; a number is plain (SI) or has a unit. A list
may hold texts as well, such as designations; in quotes a number is a text too. Of whole numbers, such
as teeth, ``a:b`` is all of them; of others it is a range whose places a search may choose.
``PATH+PATH=VALUES`` gives several entries the same value. A value goes into the tables of the file
as a person would have written it there, so that all rules of the file apply.

A study over entries puts them into tables here, combines them by a ``Design``, reads them by
``FileVariants`` and keeps the rows of a ``FileTask``.  Tables become a scene by ``scene_of`` of
:mod:`solidgear.core.scene.file`, a train by ``train_of`` of :mod:`solidgear.trains.file.reading`.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from solidgear.core import DIMENSIONS, SceneError, SolidgearError, near, nearest
from solidgear.core.errors import did_you_mean, names_in
from solidgear.core.scene.paths import (
    Keys,
    Tables,
    entries,
    entry,
    keys_of,
    label_of,
    replace_entry,
)
from solidgear.core.scene.text_keys import NAMES, is_text, is_whole
from solidgear.core.scene.units import quantity

_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)", re.S)
#: More variants than this are a slip of the keyboard.
MOST = 10_000_000
#: from a path to the file that holds it, by its name among all, and the path within
Owner = Callable[[str], tuple[str, str]]


class Place(NamedTuple):
    """Place of an entry."""

    file: str  #: name of the file, of several, that holds it
    path: str  #: within that file
    keys: Keys  #: in the tables of the file as it is

    @property
    def label(self) -> str:
        """Path with the name of the file."""
        return f"{self.file}.{self.path}".removeprefix(".")


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One entry of a file that varies, or several with one value."""

    label: str  #: name of its column, such as ``bearing.2.position``
    values: tuple[float, ...]
    #: how values between the listed ones are drawn: along a line, along its logarithm, or not at
    #: all
    spacing: str
    places: tuple[Place, ...]
    in_file: object = None  #: value that the file holds at the first of them
    unit: str = ""  #: of the values of a range, as the user wrote it; empty of plain numbers
    integers: bool = False  #: whether the values of a range are whole numbers
    #: values of a list as they are written, whose `values` count from 0; empty of a range
    words: tuple[str | float | bool, ...] = ()
    text: bool = False  #: whether its values are words, whatever they look like
    #: whether a search may choose any value between both ends
    open: bool = False

    @property
    def file(self) -> str:
        """Name of the file, of several, that holds the first of them."""
        return self.places[0].file

    @property
    def keys(self) -> Keys:
        """Keys of the first of them in the tables of its file."""
        return self.places[0].keys

    def is_in(self, file: str) -> bool:
        """True if any of them stands in a file."""
        return any(place.file == file for place in self.places)

    def draw(self, u: np.ndarray) -> np.ndarray:
        """Return (n,) values for numbers between 0 and 1."""
        if self.spacing == "list":
            places = np.minimum((u * len(self.values)).astype(int), len(self.values) - 1)
            return np.array(self.values)[places]
        a, b = self.values[0], self.values[-1]
        return a + (b - a) * u if self.spacing == "linear" else a * (b / a) ** u

    def written(self, value: float) -> str | float | bool:
        """Return a value as it is written into a file."""
        if self.words:
            return self.words[int(value)]
        round_number = value == int(value) and abs(value) < 1e15
        number = int(value) if round_number and (self.integers or self.unit) else value
        return f"{number!r} {self.unit}" if self.unit else number

    @property
    def shown_in(self) -> str:
        """Unit of its numbers, as the user wrote it; empty for SI."""
        if self.text:
            return ""
        units = {match[2] if (match := amount(word)) else "" for word in self.words}
        return self.unit or (units.pop() if len(units) == 1 else "")

    @property
    def numeric(self) -> bool:
        """True where every value is a number."""
        return not self.text and all(in_si(word) is not None for word in self.words)

    def in_row(self, value: float) -> str | float | None:
        """Return a value as a row has it: SI, or a text of a list that has any; the value of the file
        for one that is not a number.
        """
        written = self.in_file if math.isnan(value) else self.written(value)
        if written is None or isinstance(written, (list, Mapping)):
            return None
        number = in_si(written) if self.numeric else None
        return number if number is not None else str(written)


def assignment(text: str, form: str) -> tuple[str, str]:
    """Split ``PATH=VALUES`` into path and values; an error shows the `form` that is wanted."""
    path, equals, values = text.partition("=")
    if not equals or not path.strip() or not values.strip():
        raise SolidgearError(f"`vary` {text}: write {form}")
    return path.strip(), values


def as_texts(vary: str | Iterable[str] | Mapping[str, Any]) -> tuple[str, ...]:
    """Return ``PATH=VALUES`` texts as they are, or those of values by their paths.

    Examples
    --------
    >>> as_texts({"material.E": np.linspace(2.0e11, 2.1e11, 2), "bearing.A.position": "10 mm:20 mm:3"})
    ('material.E=200000000000.0,210000000000.0', 'bearing.A.position=10 mm:20 mm:3')
    """
    if not isinstance(vary, Mapping):
        return tuple(names_in(vary))
    return tuple(f"{path}={_as_list(path, values)}" for path, values in vary.items())


def _as_list(path: str, values: Any) -> str:
    """Return the values of an entry as the text of a list; a text is one already."""
    if isinstance(values, str):
        return values
    each = np.atleast_1d(values).tolist()
    if any(isinstance(value, list) or "," in str(value) for value in each):
        raise SolidgearError(f"`vary` {path}: give a list of numbers, or of texts without commas")
    return ",".join(map(str, each))


#: forms of the values of a sweep, and of a search
SWEPT = 'PATH=VALUES, such as "mesh.stiffness=log:1e8 N/m:1e9 N/m:5"'
SEARCHED = (
    'PATH=LOW:HIGH, such as "bearing.B.position=180 mm:240 mm", or PATH=A,B,C, such as '
    '"bearing.A.catalogue.designation=6208,6210"'
)


def entries_of(
    texts: Iterable[str], files: Mapping[str, Tables], owner: Owner, search: bool = False
) -> tuple[Entry, ...]:
    """Read all ``PATH=VALUES`` texts of a study over files, by their names, those of a `search` with
    open ranges; refuse unknown entries and the same twice.
    """
    out: list[Entry] = []
    for text in texts:
        path, spec = assignment(text, SEARCHED if search else SWEPT)
        try:
            places = _places(path, files, owner)
            in_file = entry(places[0].keys, files[places[0].file])
            as_text = _has_words(places, in_file, re.split("[,:]", spec))
            if as_text or ":" not in spec:
                values = _listed(spec.split(","), as_text)
            else:
                values = _range(spec, all(is_whole(place.keys) for place in places), search)
            if search and len(values["values"]) < 2:
                raise SceneError("holds one value alone, and nothing is left to choose")
        except SceneError as error:
            raise SolidgearError(f"`vary` {text}: {error}") from None
        out.append(_entry(places, in_file, as_text, values))
        _refuse_twice(f"`vary` {text}", out)
    return tuple(out)


def entries_of_table(
    path: Path, files: Mapping[str, Tables], owner: Owner
) -> tuple[tuple[Entry, ...], list[list[float]]]:
    """Read a CSV file with paths as heads and a variant a row: entries, and the values of its rows.

    Cells hold the text to be written into the file; an empty one leaves an entry as it is.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            heads, *rows = [row for row in csv.reader(file) if any(map(str.strip, row))] or [[]]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise SolidgearError(f"`table` {path}: cannot be read ({error})") from None
    if not heads or not rows:
        raise SolidgearError(
            f"`table` {path}: has no variants; write paths as heads and a variant a row"
        )
    out: list[Entry] = []
    columns: list[list[float]] = []
    for k, head in enumerate(heads):
        try:
            places = _places(head.strip(), files, owner)
            in_file = entry(places[0].keys, files[places[0].file])
        except SceneError as error:
            raise SolidgearError(f"`table` {path}: {head}: {error}") from None
        cells = [row[k].strip() if k < len(row) else "" for row in rows]
        as_text = _has_words(places, in_file, cells)
        values = _listed([cell for cell in cells if cell], as_text)
        out.append(_entry(places, in_file, as_text, values))
        _refuse_twice(f"`table` {path}", out)
        columns.append(
            [values["words"].index(_word(cell, as_text)) if cell else math.nan for cell in cells]
        )
    return tuple(out), [list(map(float, row)) for row in zip(*columns)]


def _entry(
    places: tuple[Place, ...], in_file: object, as_text: bool, values: dict[str, Any]
) -> Entry:
    label = "+".join(place.label for place in places)
    return Entry(label=label, places=places, in_file=in_file, text=as_text, **values)


def _places(path: str, files: Mapping[str, Tables], owner: Owner) -> tuple[Place, ...]:
    """Return the places that a path stands for, several with a plus between them."""
    if "+" not in path or _is_held(path, files, owner):
        return (place_of(path, files, owner),)
    return tuple(place_of(part.strip(), files, owner) for part in path.split("+"))


def place_of(path: str, files: Mapping[str, Tables], owner: Owner) -> Place:
    """Return the place that a path stands for; SceneError where there is none."""
    file, within = owner(path)
    keys = keys_of(within, files[file])
    for k in range(1, len(keys)):
        if is_text(keys[:k]) and keys[k - 1] not in NAMES:  # a word, which holds no table
            raise SceneError(explained(SceneError("unknown key"), path, files))
    return Place(file, label_of(keys, files[file]), keys)


def _is_held(path: str, files: Mapping[str, Tables], owner: Owner) -> bool:
    """True if a file holds an entry of that path: names may have a plus."""
    try:
        file, within = owner(path)
        return entry(keys_of(within, files[file]), files[file]) is not None
    except SolidgearError:
        return False


def _refuse_twice(where: str, varied: Sequence[Entry]) -> None:
    """Refuse an entry that varies twice."""
    places: set[tuple[str, Keys]] = set()
    for place in (place for varying in varied for place in varying.places):
        if (place.file, place.keys) in places:
            raise SolidgearError(
                f"{where}: {place.label} is varied already; give all its values in one list"
            )
        places.add((place.file, place.keys))


@dataclass(frozen=True)
class KeptSum:
    """A sum of entries of one file that stays as it is in the file: the last of them gives way."""

    places: tuple[Place, ...]  #: the one that gives way last
    total: float

    @property
    def label(self) -> str:
        """Path of the entry that gives way."""
        return self.places[-1].label

    def remainder(self, tables: Tables) -> float:
        """Compute the last entry, SI."""
        remainder = self.total - sum(_number_at(place, tables) for place in self.places[:-1])
        return float(f"{remainder:.12g}")

    def put(self, tables: Tables) -> Tables:
        """Return tables with the last entry put in."""
        return replace_entry(tables, keys_of(self.places[-1].path, tables), self.remainder(tables))


def kept_sums(
    texts: Iterable[str], files: Mapping[str, Tables], owner: Owner, varied: Sequence[Entry]
) -> tuple[KeptSum, ...]:
    """Read all ``PATH+PATH`` texts of sums that are kept: numbers of one file, of which all but one
    vary.
    """
    out = []
    moved = {(place.file, place.keys) for entry in varied for place in entry.places}
    for text in texts:
        try:
            places = _places(text.strip(), files, owner)
            numbers = [_number_at(place, files[place.file]) for place in places]
        except SceneError as error:
            raise SolidgearError(f"`keep_sum` {text}: {error}") from None
        free = [place for place in places if (place.file, place.keys) not in moved]
        if len(places) < 2 or len({place.file for place in places}) > 1 or len(free) != 1:
            raise SolidgearError(
                f"`keep_sum` {text}: write entries of one file with + between them, such as "
                "segment.a.length+segment.b.length, all but one of which vary; that one gives way"
            )
        fixed = [place for place in places if place not in free]
        out.append(KeptSum((*fixed, *free), sum(numbers)))
    return tuple(out)


def _number_at(place: Place, tables: Tables) -> float:
    value = in_si(entry(keys_of(place.path, tables), tables))
    if value is None:
        raise SceneError("is not a number in the file, or has an unknown unit", field=place.path)
    return value


def put_in(tables: Tables, file: str, varied: Sequence[Entry], row: Sequence[float]) -> Tables:
    """Return the tables of a file, or of one in its place, with the values of its entries."""
    for varying, value in zip(varied, row):
        for place in varying.places:
            if place.file == file and not math.isnan(value):
                tables = replace_entry(tables, keys_of(place.path, tables), varying.written(value))
    return tables


def explained(error: SceneError, path: str, files: Mapping[str, Tables]) -> str:
    """Return the sentence of an error about a path; an unknown key with the likeliest entry of the
    same thing by its last word, else with the likeliest by the whole path.
    """
    before, unknown, _ = error.sentence.partition("unknown key")
    if not unknown:
        return error.sentence
    labels = [
        f"{file}.{label_of(keys, tables)}".removeprefix(".")
        for file, tables in files.items()
        for keys in entries(tables)
    ]
    thing, _, word = path.rpartition(".")
    of_thing = {
        label.rpartition(".")[2]: label for label in labels if label.startswith(f"{thing}.")
    }
    if of_thing:
        hint = did_you_mean(of_thing.get(near(word, of_thing)))
    else:
        hint = nearest(path, labels)
    return f"{before}{unknown}{hint}" if hint else error.sentence


def _range(spec: str, whole_key: bool, search: bool) -> dict[str, Any]:
    """Return the fields of an entry that goes over a range, ``a:b:n`` or ``log:a:b:n``; ``a:b`` of a
    key of whole numbers, or of a search.
    """
    spacing, parts = "linear", [part.strip() for part in spec.split(":")]
    if parts[0] == "log":
        spacing, parts = "log", parts[1:]
    counted = len(parts) == 3
    if not counted and (len(parts) != 2 or not (whole_key or search)):
        forms = '"a:b", "a:b:n", "log:a:b:n"' if search else '"a:b:n", "log:a:b:n"'
        raise SceneError(f'values are {forms} or a list "a,b,c"')
    units: list[str] = []
    ends: list[float] = []
    whole = True
    for part in parts[:2]:
        match = amount(part)
        if match is None:
            raise SceneError(f"{part!r} is not a number, with or without a unit")
        number, unit = match.groups()
        units.append(unit)
        whole &= re.fullmatch(r"[+-]?\d+", number) is not None
        value, first = in_si(part if unit else float(number)), units[0]
        of_first = in_si(f"1 {first}") if first else 1.0
        if value is None or of_first is None:
            raise SceneError(f"{unit!r} is not a known unit")
        if bool(unit) != bool(first):
            raise SceneError("give both ends with a unit, or none")
        if unit and not _dimensions(unit) & _dimensions(first):
            raise SceneError(f"{first!r} and {unit!r} are units of different quantities")
        ends.append(float(number) if unit == first else value / of_first)
    if counted and not (parts[2].isdecimal() and 2 <= int(parts[2]) <= MOST):
        raise SceneError(f"a:b:n needs a whole number n of 2 or more values, not {parts[2]!r}")
    if ends[0] == ends[1] and search:
        raise SceneError("both ends are the same, and nothing is left to choose")
    if spacing == "log" and not ends[0] * ends[1] > 0:
        raise SceneError("a logarithmic range needs both ends above zero")
    if whole_key and not whole:
        raise SceneError("both ends must be whole numbers")
    values = ends
    if counted:
        between = np.linspace if spacing == "linear" else np.geomspace
        values = between(ends[0], ends[1], int(parts[2])).tolist()
    elif whole_key:
        if abs(ends[1] - ends[0]) >= MOST:
            raise SceneError(f"are more than the {MOST} values that one entry takes")
        values = [*map(float, range(int(min(ends)), int(max(ends)) + 1))]
    return {
        "values": tuple(dict.fromkeys(values)),
        "spacing": spacing,
        "unit": units[0],
        "integers": whole and all(value == int(value) for value in values),
        "open": not (counted or whole_key),
    }


def _has_words(places: Sequence[Place], in_file: object, cells: Iterable[str]) -> bool:
    """True for an entry of words, by the format of files or by the value in the file, in whose place
    no number is given: a mesh stiffness is one or ``teeth``.
    """
    word_in_file = isinstance(in_file, str) and in_si(in_file) is None
    numbers = (in_si(plain_number(cell.strip())) is not None for cell in cells)
    return (word_in_file and not any(numbers)) or any(is_text(place.keys) for place in places)


def _listed(cells: Iterable[str], as_text: bool) -> dict[str, Any]:
    """Return the fields of an entry with a list of values, of which a number may be a text."""
    cells = [*cells]
    if not all(map(str.strip, cells)):
        raise SceneError("a value of the list is empty")
    words = tuple(dict.fromkeys(_word(cell.strip(), as_text) for cell in cells))
    return {"words": words, "values": tuple(map(float, range(len(words)))), "spacing": "list"}


def _word(text: str, as_text: bool) -> str | float | bool:
    if len(text) > 1 and text[0] == text[-1] and text[0] in "\"'":
        return text[1:-1]
    if as_text:
        return text
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            number = kind(text)
        except ValueError:
            continue
        return number
    return text


def in_si(value: object) -> float | None:
    """Return a number, or a text with a unit, in SI; None for any other value.

    Examples
    --------
    >>> in_si("20 mm"), in_si("3000 rpm") == in_si("50 Hz"), in_si("concave"), in_si(20)
    (0.02, False, None, 20.0)
    """
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    if not isinstance(value, str):
        return None
    if not (match := amount(value)) or not match[2]:
        return None
    known = sorted(_dimensions(match[2]), key=[*DIMENSIONS].index)
    return quantity(value, known[0]) if known else None


def _dimensions(unit: str) -> set[str]:
    """Return the dimensions that a unit can be of."""
    dimensions = set()
    for dimension in DIMENSIONS:
        with suppress(SceneError):
            quantity(f"1 {unit}", dimension)
            dimensions.add(dimension)
    return dimensions


def amount(word: object) -> re.Match[str] | None:
    """Match number and unit of a text."""
    return _NUMBER.fullmatch(word.strip()) if isinstance(word, str) else None


def plain_number(text: str) -> str | float:
    """Return a number where a text is one, else the text."""
    try:
        return float(text)
    except ValueError:
        return text
