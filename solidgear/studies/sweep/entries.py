"""Entries of a file that vary: ``PATH=VALUES`` texts, by paths of :mod:`solidgear.scene.paths`.

VALUES are ``a:b:n``, ``log:a:b:n`` or a list ``a,b,c``; a number is plain (SI) or has a unit. A list
may hold texts as well, such as designations; in quotes a number is a text too. What is put into the
tables of the file is what a person would have written there, so that all rules of the file apply.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from solidgear.errors import SceneError, SolidgearError, nearest
from solidgear.scene.paths import Keys, Tables, changed, entries, entry, keys_of, label_of
from solidgear.scene.units import DIMENSIONS, quantity
from solidgear.studies.sweep.vary import Span, spread

_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)", re.S)
#: from a path to the file that holds it, by its name among all, and the path within
Owner = Callable[[str], tuple[str, str]]


@dataclass(frozen=True, kw_only=True)
class Entry(Span):
    """One entry of a file that varies.

    Attributes
    ----------
    file : str
        Which of several files holds it.
    path : str
        Within that file.
    keys : tuple of str and int
        Where in the tables of the file as it is.
    unit : str
        Of the values of a range, as the user wrote it; empty of plain numbers.
    whole : bool
        Whether the values of a range are whole numbers.
    words : tuple
        What is put in of a list, whose `values` count from 0; empty of a range.
    """

    file: str
    path: str
    keys: Keys
    unit: str = ""
    whole: bool = False
    words: tuple[str | float | bool, ...] = ()

    def put(self, value: float) -> str | float | bool:
        """Tables of a file with a value put in."""
        if self.words:
            return self.words[int(value)]
        plain = (self.whole or self.unit) and value == int(value) and abs(value) < 1e15
        number = int(value) if plain else value
        return f"{number!r} {self.unit}" if self.unit else number

    @property
    def shown_in(self) -> str:
        """Unit that its numbers are read in, as the user wrote it; empty for SI."""
        units = {amount[2] if (amount := _amount(word)) else "" for word in self.words}
        return self.unit or (units.pop() if len(units) == 1 else "")

    @property
    def numeric(self) -> bool:
        """True where every value is a number."""
        return all(in_si(word) is not None for word in self.words)

    def told(self, value: float) -> str | float:
        """A value as a row tells it: SI, or a text of a list that has any."""
        put = self.put(value)
        number = in_si(put) if self.numeric else None
        return number if number is not None else str(put)


def entries_of(
    texts: Iterable[str], files: Mapping[str, Tables], owner: Owner
) -> tuple[Entry, ...]:
    """Read all ``PATH=VALUES`` texts of a study.

    Parameters
    ----------
    texts : iterable of str
    files : mapping of str to mapping
        Tables by the name of their file.

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
        file, within = owner(path.strip())
        tables = files[file]
        try:
            keys = keys_of(within, tables)
            own = label_of(keys, tables)
            label = f"{file}.{own}".removeprefix(".")
            values = _listed(spec, entry(keys, tables)) if ":" not in spec else _range(spec)
        except SceneError as error:
            raise SolidgearError(f"--vary {text}: {error}") from None
        if any((one.file, one.keys) == (file, keys) for one in out):
            raise SolidgearError(
                f"--vary {text}: {label} is varied already; give all its values in one list"
            )
        out.append(Entry(label=label, file=file, path=own, keys=keys, **values))
    return tuple(out)


def put_in(tables: Tables, varied: Sequence[Entry], row: Sequence[float]) -> Tables:
    """Tables of a file, or of one like it, with a value of each entry put in."""
    for one, value in zip(varied, row):
        tables = changed(tables, keys_of(one.path, tables), one.put(value))
    return tables


def hinted(error: SceneError, path: str, files: Mapping[str, Tables]) -> str:
    """Sentence of an error about a path; of an unknown key with the entry that the whole path stands
    for, as likely as not, before what those know who know a part of it.
    """
    known = [
        f"{file}.{label_of(keys, tables)}".removeprefix(".")
        for file, tables in files.items()
        for keys in entries(tables)
    ]
    said, unknown, _ = error.sentence.partition("unknown key")
    hint = nearest(path, known) if unknown else ""
    return f"{said}{unknown}{hint}" if hint else error.sentence


def in_si(value: str | float | bool) -> float | None:
    """A number, or a text with a unit, in SI; None for what is neither.

    Examples
    --------
    >>> in_si("20 mm"), in_si("3000 rpm") == in_si("50 Hz"), in_si("concave"), in_si(20)
    (0.02, False, None, 20.0)
    """
    if isinstance(value, bool):
        return None
    if not isinstance(value, str):
        return float(value)
    if not (found := _amount(value)) or not found[2]:
        return None
    for dimension in DIMENSIONS:
        try:
            return quantity(value, dimension)
        except SceneError:
            continue
    return None


def _amount(word: object) -> re.Match[str] | None:
    """Number and unit of a text."""
    return _NUMBER.fullmatch(word.strip()) if isinstance(word, str) else None


def _range(spec: str) -> dict:
    """Fields of an entry that goes over a range."""
    units: list[str] = []
    ends: list[str] = []

    def read(text: str) -> float:
        found = _NUMBER.fullmatch(text)
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


def _listed(spec: str, there: object) -> dict:
    """Fields of an entry with a list of values; what the file holds there says whether a number is
    a text.
    """
    texts = isinstance(there, str) and in_si(there) is None
    words = tuple(dict.fromkeys(_word(part.strip(), texts) for part in spec.split(",")))
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
