"""Errors a user can act on: one sentence for each problem, with its place, the value as written and
how to correct it.
"""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from numbers import Integral
from typing import Any

#: problems of one file that are written out; the rest are counted
MOST_PROBLEMS = 20
#: hint on the brackets that a file has before a table
BRACKETS = re.compile(r"(, given once)?: write \[+\w+\]+ with \w+ brackets( before each)?")
#: name of an argument of Python in the text of an error
ARGUMENT = re.compile(r"`([a-z_]+)`")
#: letters of a line on a terminal
LONGEST = 1000


class SolidgearError(Exception):
    """Base of every error that solidgear raises on purpose; its text is for the user, with arguments
    of Python between backquotes, such as ```torque```, which commands show as their options.

    Examples
    --------
    >>> import solidgear as sg
    >>> rod = sg.Segment.cylinder("rod", length=0.3, diameter=0.03)
    >>> scene = sg.Scene.from_parts([rod])
    >>> try:
    ...     sg.modes(sg.build(scene, "euler"), scene, n=0)
    ... except sg.SolidgearError as error:
    ...     print(error)
    modes: n = 0 is not a number of modes; ask for 1 or more
    """

    def spell_arguments(self, spell: Callable[[str], str]) -> None:
        """Write the names of arguments in the text another way, such as options of a command.

        Examples
        --------
        >>> error = SolidgearError("give `torque` or `point`, not both")
        >>> error.spell_arguments(lambda name: f"--{name}")
        >>> print(error)
        give --torque or --point, not both
        """
        self.args = tuple(_spelled(text, spell) for text in self.args)


class NoSuchName(SolidgearError, KeyError):
    """A name that a result has not, in brackets: a `KeyError`, as of a dict."""

    __str__ = Exception.__str__  # a KeyError would show its text in quotes


class NoBounds(SolidgearError):
    """A solid whose error cannot be bounded, on a finer mesh perhaps."""

    def __init__(self, reason: str, finer_helps: bool = False):
        super().__init__(reason)
        self.finer_helps = finer_helps


class SceneError(SolidgearError, ValueError):
    """A scene that cannot be used as written: the first problem, and all others with it.

    Parameters
    ----------
    reason : str
        The problem, and a right value.
    path : tuple of str and int
        Keys and zero-based indices from the root of the scene to the faulty entry.
    value : str
        The entry as written, already turned into text; empty when there is none.
    field : str
        `path` in readable form, such as ``bearing[2] "2".seat_width``; made by `located`.
    where : str
        The file (or scene) the entry is in.
    others : sequence of SceneError
        Further problems of the same scene.

    Attributes
    ----------
    problems : tuple of SceneError
        All of them, this one first. Each alone is one sentence; the text for a whole file lists
        `MOST_PROBLEMS` of them at most.

    Examples
    --------
    >>> import solidgear as sg
    >>> try:
    ...     sg.Material(E="207 GPa", nu=0.6, density="7850 kg/m^3")
    ... except sg.SceneError as error:
    ...     print(error)
    nu = 0.6: must lie between -1 and 0.5, both excluded; steel is 0.3
    """

    def __init__(
        self,
        reason: str,
        *,
        path: tuple = (),
        value: str = "",
        field: str = "",
        where: str = "",
        others: Sequence[SceneError] = (),
    ):
        super().__init__(reason)
        self.reason, self.path, self.value, self.field, self.where = (
            reason,
            tuple(path),
            value,
            field,
            where,
        )
        self.others = tuple(others)

    @classmethod
    def of(cls, problems: Iterable[SceneError]) -> SceneError:
        """One error of several (at least one), each of which may itself hold several."""
        first, *others = (problem for error in problems for problem in error.problems)
        return first._changed(others=others)

    @property
    def problems(self) -> tuple[SceneError, ...]:
        """This problem alone, then the others."""
        return (self._changed(others=()), *self.others) if self.others else (self,)

    @property
    def sentence(self) -> str:
        """First problem alone, in one line, without the lines that a file lacks."""
        reason = self.reason.partition("\n\n")[0]
        place = " = ".join(
            part for part in (self.field or ".".join(map(str, self.path)), self.value) if part
        )
        return printable(
            ": ".join(part for part in (_file_name(self.where), place, reason) if part)
        )

    @property
    def lacking(self) -> str:
        """Lines that the file lacks, which the reason ends with; empty where it names none."""
        return self.reason.partition("\n\n")[2]

    def __str__(self) -> str:
        count = len(self.others)
        if not count:
            return "\n\n".join(filter(None, [self.sentence, self.lacking]))
        if not self.where:  # a scene made in Python: the rest is in `problems`
            more = "1 more problem" if count == 1 else f"{count} more problems"
            return f"{self.sentence} (and {more}: see its problems)"
        lines = [
            f"{count + 1} problems in {printable(_file_name(self.where))}",
            *("  " + problem.sentence for problem in self.problems[:MOST_PROBLEMS]),
        ]
        if count + 1 > MOST_PROBLEMS:
            lines.append(f"  and {count + 1 - MOST_PROBLEMS} more")
        lines += [f"\n{p.lacking}" for p in self.problems[:MOST_PROBLEMS] if p.lacking]
        return "\n".join(lines)

    def located(
        self, data: Any, *, where: str = "", prefix: tuple = (), path: tuple | None = None
    ) -> SceneError:
        """The same error with fields named, and values quoted, from the user's data.

        Parameters
        ----------
        data : mapping or object or None
            Root that the paths of the problems start from.
        where : str
            The file (or scene) it came from.
        prefix : tuple
            Put before the path of every problem.
        path : tuple, optional
            Takes the place of the path of every problem.

        Returns
        -------
        SceneError
        """
        return type(self).of(
            problem._located(data, where, (*prefix, *problem.path) if path is None else path)
            for problem in self.problems
        )

    def of_dict(self) -> SceneError:
        """The same error without hints on the brackets of a file, for tables given in Python."""
        return type(self).of(
            SceneError(
                BRACKETS.sub("", problem.reason),
                path=problem.path,
                value=problem.value,
                field=problem.field,
                where=problem.where,
            )
            for problem in self.problems
        )

    def spell_arguments(self, spell: Callable[[str], str]) -> None:
        """Write the names of arguments in the texts of all problems another way."""
        super().spell_arguments(spell)
        self.reason = _spelled(self.reason, spell)
        for problem in self.others:
            problem.spell_arguments(spell)

    def _located(self, data: Any, source: str, path: tuple) -> SceneError:
        field, entry, exists = _name_and_value(path, data)
        return self._changed(
            path=path,
            value=show(entry) if exists else self.value,
            field=field,
            where=source or self.where,
        )

    def _changed(self, **changes: Any) -> SceneError:
        fields = {
            name: getattr(self, name) for name in ("path", "value", "field", "where", "others")
        }
        return type(self)(self.reason, **(fields | changes))


# --------------------------------------------------------------------------- texts
def _spelled(text: Any, spell: Callable[[str], str]) -> Any:
    return ARGUMENT.sub(lambda name: spell(name[1]), text) if isinstance(text, str) else text


def printable(text: str) -> str:
    """Return a text in one line, escaping letters that would move the cursor of a terminal or reverse
    its direction of writing.
    """
    return _escaped(" ".join(text.split()))


def for_terminal(error: Exception) -> str:
    """Return the text of an error for a terminal: all lines of a `SceneError`, of others one line of
    at most `LONGEST` letters.
    """
    if isinstance(error, SceneError):
        return str(error)
    line = printable(str(error))
    return line if len(line) <= LONGEST else f"{line[: LONGEST - 100]} ... {line[-90:]}"


def _file_name(file: str) -> str:
    return file if len(file) <= 300 else f"...{file[-200:]}"


def _escaped(text: str) -> str:
    return text if text.isprintable() else "".join(map(_escaped_letter, text))


def _escaped_letter(letter: str) -> str:
    if letter.isprintable():
        return letter
    code = ord(letter)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def show(value: Any, width: int = 70) -> str:
    """Return a value as TOML would have it, in one line of at most `width` letters, however large or
    deep it is.

    Examples
    --------
    >>> show({"kxx": 1e8, "note": "measured"})
    '{"kxx": 100000000.0, "note": "measured"}'
    >>> show(list(range(100)), width=12)
    '[0, 1, 2,...'
    """
    text = ""
    for piece in _pieces(value, width):
        text += piece
        if len(text) > width:
            return text[: width - 3] + "..."
    return text


def _pieces(value: Any, width: int) -> Iterator[str]:
    """Yield the text of a value from left to right, so that a reader who stops after `width`
    characters has gone no deeper.
    """
    if isinstance(value, Mapping):
        yield "{"
        for k, (key, entry) in enumerate(value.items()):
            yield (", " if k > 0 else "") + _quoted(str(key), width) + ": "
            yield from _pieces(entry, width)
        yield "}"
    elif isinstance(value, (list, tuple)):
        yield "["
        for k, entry in enumerate(value):
            if k > 0:
                yield ", "
            yield from _pieces(entry, width)
        yield "]"
    elif value is None or isinstance(value, bool):
        yield {None: "null", True: "true", False: "false"}[value]
    elif isinstance(value, Integral):
        # Python refuses to write thousands of digits in tens, not in sixteens.
        yield repr(int(value)) if int(value).bit_length() < 1000 else hex(int(value))
    elif isinstance(value, float):
        yield repr(float(value))
    else:
        yield _quoted(str(value), width)


def _quoted(text: str, width: int) -> str:
    return _escaped(json.dumps(text[: width + 1], ensure_ascii=False))


def nearest(word: Any, candidates: Iterable[str]) -> str:
    """Return ``'; did you mean "x"?'`` for the nearest candidate; an empty text where none is near.

    Examples
    --------
    >>> nearest("diameter_start", ["end_diameter", "start_diameter"])
    '; did you mean "start_diameter"?'
    >>> nearest("c_zz", ["K_zz", "C_zz"])  # not the first that differs by one letter
    '; did you mean "C_zz"?'
    """
    return did_you_mean(near(word, candidates))


def did_you_mean(word: str | None) -> str:
    """Return the hint of :func:`nearest` for a word; an empty text without one."""
    return f'; did you mean "{word}"?' if word else ""


def near(word: Any, candidates: Iterable[str]) -> str:
    """Return the candidate nearest to `word`: other capitals, the same parts, spelt alike; or ''."""
    text, names = str(word)[:60], list(candidates)
    same_letters = [candidate for candidate in names if candidate.casefold() == text.casefold()]
    same_parts = [
        candidate for candidate in names if sorted(candidate.split("_")) == sorted(text.split("_"))
    ]
    return next(iter(same_letters or same_parts or difflib.get_close_matches(text, names, 1)), "")


def names_in(names: str | Iterable[str]) -> tuple[str, ...]:
    """Return names as a tuple; a text is a name, and no row of letters.

    Examples
    --------
    >>> names_in("bending 1"), names_in(["C_zz", "C_yy"])
    (('bending 1',), ('C_zz', 'C_yy'))
    """
    return (names,) if isinstance(names, str) else tuple(names)


def listed(words: Iterable[Any], most: int = 24) -> str:
    """Return words with commas between, at most `most` of them, and a count of the others.

    Examples
    --------
    >>> listed(["x", "y", "z"], most=2)
    'x, y and 1 more'
    """
    words = [str(word) for word in words]
    return ", ".join(words[:most]) + (f" and {len(words) - most} more" if len(words) > most else "")


# --------------------------------------------------------------------------- pydantic
def scene_error(error: Any, data: Any) -> SceneError:
    """Convert pydantic's ValidationError of `data` to a `SceneError` of all problems."""
    return SceneError.of(_plain_error(entry, data) for entry in error.errors(include_url=False))


def _plain_error(entry: Mapping, data: Any) -> SceneError:
    path = (*entry["loc"], "kind") if entry["type"].startswith("union_tag") else entry["loc"]
    cause = entry.get("ctx", {}).get("error")
    if isinstance(cause, SceneError):
        return cause.located(data, prefix=path)
    return SceneError(_plain_words(entry, data)).located(data, path=path)


#: keys that every file needs, and how to write them
WRITE = {
    "material": 'write material = "steel", or a table with E, nu and density',
    "segment": 'write segment = [{ kind = "cylinder", name = ..., length = ..., diameter = ... }, ...]',
}


def _plain_words(entry: Mapping, data: Any) -> str:
    kind, ctx = entry["type"], entry.get("ctx", {})
    expected = str(ctx.get("expected", ""))
    word = entry.get("input")
    hint = nearest(word, re.findall(r"'([^']*)'", expected)) if isinstance(word, str) else ""
    example = WRITE.get(str(entry["loc"][0]), "") if len(entry["loc"]) == 1 else ""
    words = {
        "missing": f"this key is missing{'; ' if example else ''}{example}",
        "string_type": "must be a text in quotes",
        "string_unicode": "must be a text of plain letters",
        "int_type": "must be a whole number",
        "list_type": "must be a list in square brackets",
        "tuple_type": "must be a list in square brackets",
        "dict_type": "must be a table of keys",
        "model_type": "must be a table of keys",
        "model_attributes_type": "must be a table of keys",
        "union_tag_not_found": "this key is missing; "
        + (
            'it gives the sort of the feature, such as kind = "keyway"'
            if entry["loc"][0] == "feature"
            else 'it gives the shape of the segment, such as kind = "cylinder"'
        ),
        "union_tag_invalid": f"unknown kind; write one of {ctx.get('expected_tags')}",
        "literal_error": f"must be {expected}{hint}",
    }
    if kind in ("model_type", "model_attributes_type", "dict_type") and isinstance(
        _name_and_value(entry["loc"], data)[1], list
    ):
        return (
            f"must be a table of keys, given once: write [{entry['loc'][-1]}] with single brackets"
        )
    if kind == "list_type" and isinstance(_name_and_value(entry["loc"], data)[1], Mapping):
        return f"must be a list: write [[{entry['loc'][-1]}]] with double brackets before each"
    return words.get(kind) or entry["msg"].replace("Input should be", "must be").replace(
        "Value error, ", ""
    )


def _name_and_value(path: tuple, data: Any) -> tuple[str, Any, bool]:
    """Return the readable name of `path` in `data`, the value there, and whether there is one."""
    field, exists = "", True
    for key in path:
        exists, data = _child(data, key) if exists else (False, None)
        if isinstance(key, int):
            field += f"[{key + 1}]"  # engineers count from one
            has_name, name = _child(data, "name") if exists else (False, None)
            field += f" {show(name, 40)}" if has_name and isinstance(name, str) else ""
        else:
            plain = len(str(key)) <= 40 and str(key).replace("_", "").isalnum()
            text = str(key) if plain else show(str(key), 40)
            field += f".{text}" if field else text
    return field, data, exists and bool(path)


def _child(data: Any, key: Any) -> tuple[bool, Any]:
    words = getattr(data, "words", None)  # of what has no place yet
    if isinstance(data, Mapping) or isinstance(words, Mapping):
        data = words or data
        return (True, data[key]) if key in data else (False, None)
    if isinstance(key, int):
        inside = isinstance(data, Sequence) and not isinstance(data, str) and key < len(data)
        return (True, data[key]) if inside else (False, None)
    return (True, getattr(data, key)) if hasattr(data, key) else (False, None)
