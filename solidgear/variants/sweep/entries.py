"""Entries of a file that vary: ``PATH=VALUES`` texts, by paths of :mod:`solidgear.core.scene.paths`.

VALUES are ``a:b:n``, ``log:a:b:n`` or a list ``a,b,c``; a number is plain (SI) or has a unit. A list
may hold texts as well, such as designations; in quotes a number is a text too. ``PATH+PATH=VALUES``
gives several entries the same value. What is put into the tables of the file is what a person would
have written there, so that all rules of the file apply.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from solidgear.core.errors import SceneError, SolidgearError, did_you_mean, near, nearest
from solidgear.core.scene.paths import (
    Keys,
    Tables,
    entries,
    entry,
    keys_of,
    label_of,
    replace_entry,
)
from solidgear.core.scene.text_keys import is_text
from solidgear.variants.sweep.amounts import amount, in_si
from solidgear.variants.sweep.spans import Span, spread

#: from a path to the file that holds it, by its name among all, and the path within
Owner = Callable[[str], tuple[str, str]]


class Place(NamedTuple):
    """Place of an entry."""

    file: str  #: which of several files holds it
    path: str  #: within that file
    keys: Keys  #: where in the tables of the file as it is

    @property
    def label(self) -> str:
        """The path with the name of its file."""
        return f"{self.file}.{self.path}".removeprefix(".")


@dataclass(frozen=True, kw_only=True)
class Entry(Span):
    """One entry of a file that varies, or several with one value."""

    places: tuple[Place, ...]
    there: object = None  #: what the file holds at the first of them
    unit: str = ""  #: of the values of a range, as the user wrote it; empty of plain numbers
    whole: bool = False  #: whether the values of a range are whole numbers
    #: what is put in of a list, whose `values` count from 0; empty of a range
    words: tuple[str | float | bool, ...] = ()
    text: bool = False  #: whether its values are words, whatever they look like

    @property
    def file(self) -> str:
        """Index of the file, of several, that holds the first of them."""
        return self.places[0].file

    @property
    def keys(self) -> Keys:
        """Path of that in the tables of its file."""
        return self.places[0].keys

    def is_in(self, file: str) -> bool:
        """Tell whether any of them stands in a file."""
        return any(place.file == file for place in self.places)

    def put(self, value: float) -> str | float | bool:
        """Text written into a file for a value."""
        if self.words:
            return self.words[int(value)]
        plain = (self.whole or self.unit) and value == int(value) and abs(value) < 1e15
        number = int(value) if plain else value
        return f"{number!r} {self.unit}" if self.unit else number

    @property
    def shown_in(self) -> str:
        """Unit that its numbers are read in, as the user wrote it; empty for SI."""
        if self.text:
            return ""
        units = {found[2] if (found := amount(word)) else "" for word in self.words}
        return self.unit or (units.pop() if len(units) == 1 else "")

    @property
    def numeric(self) -> bool:
        """True where every value is a number."""
        return not self.text and all(in_si(word) is not None for word in self.words)

    def told(self, value: float) -> str | float | None:
        """A value as a row tells it: SI, or a text of a list that has any; that of the file where the
        value is none.
        """
        put = self.there if math.isnan(value) else self.put(value)
        if put is None or isinstance(put, (list, Mapping)):
            return None
        number = in_si(put) if self.numeric else None
        return number if number is not None else str(put)


def entries_of(
    texts: Iterable[str], files: Mapping[str, Tables], owner: Owner
) -> tuple[Entry, ...]:
    """Read all ``PATH=VALUES`` texts of a study over files, by their names.

    Raises
    ------
    SolidgearError
        A text that cannot be read, a name that a list of the file does not have, or the same entry
        twice.
    """
    out: list[Entry] = []
    for text in texts:
        path, equals, spec = text.partition("=")
        if not equals or not path.strip() or not spec.strip():
            raise SolidgearError(
                f'--vary {text}: write PATH=VALUES, such as "mesh.stiffness=log:1e8 N/m:1e9 N/m:5"'
            )
        try:
            places = _places(path.strip(), files, owner)
            there = entry(places[0].keys, files[places[0].file])
            of_words = _is_text(places, there)
            listed = of_words or ":" not in spec
            values = _listed(spec.split(","), of_words) if listed else _range(spec)
        except SceneError as error:
            raise SolidgearError(f"--vary {text}: {error}") from None
        made = Entry(
            label="+".join(one.label for one in places),
            places=places,
            there=there,
            text=of_words,
            **values,
        )
        _once(f"--vary {text}", [*out, made])
        out.append(made)
    return tuple(out)


def entries_of_table(
    path: Path, files: Mapping[str, Tables], owner: Owner
) -> tuple[tuple[Entry, ...], list[list[float]]]:
    """Entries that a table of one's own varies, and the values of its rows.

    Parameters
    ----------
    path : Path
        A CSV file: paths as heads, a variant a row, what is to be written into the file in its
        cells; an empty one leaves an entry as it is.

    Raises
    ------
    SolidgearError
        A file that cannot be read, has no rows, or a head as :func:`entries_of`.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            heads, *rows = [row for row in csv.reader(file) if any(map(str.strip, row))] or [[]]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise SolidgearError(f"--table {path}: cannot be read ({error})") from None
    if not heads or not rows:
        raise SolidgearError(
            f"--table {path}: has no variants; write paths as heads and a variant a row"
        )
    out: list[Entry] = []
    columns: list[list[float]] = []
    for k, head in enumerate(heads):
        try:
            places = _places(head.strip(), files, owner)
            there = entry(places[0].keys, files[places[0].file])
        except SceneError as error:
            raise SolidgearError(f"--table {path}: {head}: {error}") from None
        cells = [row[k].strip() if k < len(row) else "" for row in rows]
        text = _is_text(places, there)
        listed = _listed([cell for cell in cells if cell], text)
        words = listed["words"]
        label = "+".join(one.label for one in places)
        out.append(Entry(label=label, places=places, there=there, text=text, **listed))
        _once(f"--table {path}", out)
        columns.append(
            [float(words.index(_word(cell, text))) if cell else math.nan for cell in cells]
        )
    return tuple(out), [list(row) for row in zip(*columns)]


def _places(path: str, files: Mapping[str, Tables], owner: Owner) -> tuple[Place, ...]:
    """Places that a path stands for, or several with a plus between them."""

    def place(path: str) -> Place:
        file, within = owner(path)
        keys = keys_of(within, files[file])
        return Place(file, label_of(keys, files[file]), keys)

    if "+" not in path or _holds(path, files, owner):
        return (place(path),)
    return tuple(place(part.strip()) for part in path.split("+"))


def _holds(path: str, files: Mapping[str, Tables], owner: Owner) -> bool:
    """Tell whether a file holds an entry of that path: names may have a plus."""
    try:
        file, within = owner(path)
        return entry(keys_of(within, files[file]), files[file]) is not None
    except SolidgearError:
        return False


def _once(where: str, varied: Sequence[Entry]) -> None:
    """Refuse an entry that varies twice."""
    seen: set[tuple[str, Keys]] = set()
    for place in (place for one in varied for place in one.places):
        if (place.file, place.keys) in seen:
            raise SolidgearError(
                f"{where}: {place.label} is varied already; give all its values in one list"
            )
        seen.add((place.file, place.keys))


@dataclass(frozen=True)
class Kept:
    """A sum of entries of one file that stays what it is in the file: the last of them gives way."""

    places: tuple[Place, ...]  #: the one that gives way last
    total: float

    @property
    def label(self) -> str:
        """Path of the entry that gives way."""
        return self.places[-1].label

    def left(self, tables: Tables) -> float:
        """Remainder for the last entry, SI."""
        left = self.total - sum(_number_at(place, tables) for place in self.places[:-1])
        return float(f"{left:.12g}")

    def put(self, tables: Tables) -> Tables:
        """Tables with the last entry given what is left."""
        return replace_entry(tables, keys_of(self.places[-1].path, tables), self.left(tables))


def kept_of(
    texts: Iterable[str], files: Mapping[str, Tables], owner: Owner, varied: Sequence[Entry]
) -> tuple[Kept, ...]:
    """Read all ``PATH+PATH`` texts of sums that are kept.

    Raises
    ------
    SolidgearError
        Fewer than two entries, of more than one file, no numbers, or none or all of them vary.
    """
    out = []
    moved = {(place.file, place.keys) for one in varied for place in one.places}
    for text in texts:
        try:
            places = _places(text.strip(), files, owner)
            numbers = [_number_at(place, files[place.file]) for place in places]
        except SceneError as error:
            raise SolidgearError(f"--keep-sum {text}: {error}") from None
        free = [place for place in places if (place.file, place.keys) not in moved]
        if len(places) < 2 or len({place.file for place in places}) > 1 or len(free) != 1:
            raise SolidgearError(
                f"--keep-sum {text}: write entries of one file with + between them, such as "
                "segment.a.length+segment.b.length, all but one of which vary; that one gives way"
            )
        fixed = [place for place in places if place not in free]
        out.append(Kept((*fixed, *free), sum(numbers)))
    return tuple(out)


def _number_at(place: Place, tables: Tables) -> float:
    value = in_si(entry(keys_of(place.path, tables), tables))
    if value is None:
        raise SceneError("is no number in the file, or has no unit that is known", field=place.path)
    return value


def put_in(tables: Tables, file: str, varied: Sequence[Entry], row: Sequence[float]) -> Tables:
    """Tables of a file, or of one that takes its place, with the values of its entries put in."""
    for one, value in zip(varied, row):
        for place in one.places:
            if place.file == file and not math.isnan(value):
                tables = replace_entry(tables, keys_of(place.path, tables), one.put(value))
    return tables


def hinted(error: SceneError, path: str, files: Mapping[str, Tables]) -> str:
    """Sentence of an error about a path; of an unknown key with the entry that its last word stands
    for, as likely as not, among those of the same thing, else with that of the whole path.
    """
    known = [
        f"{file}.{label_of(keys, tables)}".removeprefix(".")
        for file, tables in files.items()
        for keys in entries(tables)
    ]
    said, unknown, _ = error.sentence.partition("unknown key")
    thing, _, word = path.rpartition(".")
    beside = {label.rpartition(".")[2]: label for label in known if label.startswith(f"{thing}.")}
    if not unknown:
        return error.sentence
    hint = did_you_mean(beside.get(near(word, beside))) if beside else nearest(path, known)
    return f"{said}{unknown}{hint}" if hint else error.sentence


def _range(spec: str) -> dict:
    """Fields of an entry that goes over a range."""
    units: list[str] = []
    ends: list[str] = []

    def read(text: str) -> float:
        found = amount(text)
        if found is None:
            raise SceneError(f"{text!r} is no number, with or without a unit")
        ends.append(found[1])
        units.append(found[2])
        own, first = in_si(text if found[2] else float(found[1])), units[0]
        one = in_si(f"1 {first}") if first else 1.0
        if own is None or one is None:
            raise SceneError(f"{found[2]!r} is no known unit")
        if bool(found[2]) != bool(first):
            raise SceneError("give both ends with a unit, or none")
        return float(found[1]) if found[2] == first else own / one

    values, spacing = spread(spec, read)
    whole = all(re.fullmatch(r"[+-]?\d+", end) for end in ends)
    whole &= all(value == int(value) for value in values)
    fields = {"values": tuple(dict.fromkeys(values)), "spacing": spacing, "unit": units[0]}
    return fields | {"whole": whole}


def _is_text(places: Sequence[Place], there: object) -> bool:
    """True for an entry of words, by the format of files or by what a file holds there."""
    own = isinstance(there, str) and in_si(there) is None
    return own or any(is_text(place.keys) for place in places)


def _listed(cells: Iterable[str], text: bool) -> dict:
    """Fields of an entry with a list of values, of which a number may be a text."""
    words = tuple(dict.fromkeys(_word(part.strip(), text) for part in cells))
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
