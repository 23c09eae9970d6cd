"""A TOML file as plain tables, or one sentence on where it is wrong and what would be right."""

from __future__ import annotations

import os
import re
import stat
import sys
import tomllib
from collections.abc import Iterable, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, TextIO

from solidgear.errors import SceneError, printable

#: bytes; a shipped scene takes some thousands, the largest shaft and bearings there may be some ten
#: thousands
LARGEST = 300_000
#: full stops in one line: a 6x6 matrix has 36. The parser's time grows with the cube of the parts
#: of a key
MOST_DOTS = 100
#: in place of a path
STANDARD_INPUT = "-"


def parse(file_path: str) -> dict[str, Any]:
    """Tables of a TOML file, or a refusal: no such file, no plain file, too large, no UTF-8 text or
    no TOML.
    """
    try:
        text = _text(file_path)
        return tomllib.loads(text)
    except FileNotFoundError:
        reason = "there is no such file"
    except UnicodeDecodeError as error:
        reason = f"not UTF-8 text (byte {error.start}); save the file as UTF-8"
    except tomllib.TOMLDecodeError as error:
        reason = _what_is_wrong(text, str(error))
    except RecursionError:
        reason = "not a scene: its tables are nested too deeply"
    except SceneError as error:
        reason = error.reason
    except (OSError, ValueError) as error:
        long = "digits" in str(error)
        reason = (
            "not a scene: a number in it has thousands of digits"
            if long
            else f"cannot be read: {getattr(error, 'strerror', None) or error}"
        )
    raise SceneError(reason, where=place_of(file_path))


def describes_train(raw: Mapping[str, Any]) -> bool:
    """True for tables of a train of shafts, and not of one shaft."""
    return "segment" not in raw and ("shaft" in raw or {"pinion", "gear"} <= set(raw))


def is_train(path: str | os.PathLike) -> bool:
    """True for a file that describes a train."""
    return describes_train(parse(os.fspath(path)))


def name_of(file_path: str) -> str:
    """Name of the scene in a file: that of the file."""
    return "scene" if file_path == STANDARD_INPUT else Path(file_path).stem


def place_of(file_path: str) -> str:
    """A path as errors name it."""
    return "standard input" if file_path == STANDARD_INPUT else file_path


@lru_cache(maxsize=1)
def _standard_input(stream: TextIO) -> bytes:
    """Text of standard input; a file is read more than once, to say where it is wrong."""
    return stream.buffer.read(LARGEST + 1)


def _bytes(file_path: str) -> bytes:
    if file_path == STANDARD_INPUT:
        return _standard_input(sys.stdin)
    kind = Path(file_path).stat().st_mode
    if stat.S_ISDIR(kind):
        raise SceneError("this is a folder; give the TOML file in it")
    if not stat.S_ISREG(kind):
        # a pipe would be waited for, and a device may never end
        raise SceneError(
            "this is a pipe or a device, not a file; write the scene into a file and give that"
        )
    with Path(file_path).open("rb") as file:
        return file.read(LARGEST + 1)


def _text(file_path: str) -> str:
    data = _bytes(file_path)
    if len(data) > LARGEST:
        raise SceneError(f"this is no scene: it is larger than {LARGEST // 1000} kB")
    if data.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\0" in data:
        raise SceneError(
            f"not UTF-8 text (byte {max(data.find(0), 0)}): it is UTF-16 or no text at all; "
            "save the file as UTF-8"
        )
    text = data.decode("utf-8-sig")
    for number, line in enumerate(text.split("\n"), start=1):
        if line.count(".") > MOST_DOTS:
            raise SceneError(
                f"not a scene: line {number} has more than {MOST_DOTS} full stops, "
                "and no key or matrix that many parts"
            )
    return text


# --------------------------------------------------------------------------- plain words
_NUMBER = r"[+-]?\d[\d_]*"
#: what people write, by the line the parser stopped in, the more telling first: pattern and plain
#: words, with groups of the pattern
_HABITS = (
    (
        re.compile(rf"=\s*({_NUMBER}),(\d+)\s*([^\s\d,\]#]*)$"),
        'a decimal comma; decimals take a point, and a unit quotes, such as 3.5 or "3.5 mm"',
    ),
    (
        re.compile(rf"=\s*{_NUMBER}(\.\d+)?([eE][+-]?\d+)?\s*[^\W\d_][^=#\"']*$"),
        'a quantity with a unit is a text in quotes, such as "90 mm"',
    ),
    (
        re.compile(r"=\s*(True|False|TRUE|FALSE|yes|no|on|off)\b"),
        "a truth value is written true or false",
    ),
    (re.compile(r"=\s*[A-Za-z][^=#\"']*$"), 'a text is written in quotes, such as "head.end"'),
    (re.compile(r"=\s*$"), "there is no value behind the ="),
    (re.compile(r"^\s*\[+[^\]]*$"), "the ] is missing"),
    (re.compile(r"^\s*[\w.-]+\s*:"), "a value is written behind =, not behind :"),
)
_TWICE = re.compile(
    r"(?:Cannot declare|Cannot mutate immutable namespace|Cannot redefine namespace) \((.*)\)"
)
_LISTS = ("segment", "bearing", "mass", "feature", "port")
_PARSER = {
    "Cannot overwrite a value": "a key is given twice in its table, or as a value and as a table",
    "Unterminated string": "a text is not closed: its last quotes are missing",
    "Unclosed array": "a list is not closed: its ] is missing",
    "Unclosed inline table": "a table in one line is not closed, or a comma is missing in it",
    "Unescaped '\\' in a string": (
        "a \\ in quotes starts a code; write it twice, or use single quotes"
    ),
    "Illegal character '\\n'": "a text is not closed: its last quotes are missing",
    "Illegal character '\\r'": (
        "lines end in a lone carriage return; save the file with the line ends of Unix or Windows"
    ),
    "Invalid date or datetime": "a date that is none",
    "Expected '=' after a key in a key/value pair": "a key is followed by = and its value",
    "Invalid statement": "a line is a [table], a key = value or a # comment",
    "Expected newline or end of document after a statement": (
        "one key = value a line, and nothing behind it"
    ),
}


def _what_is_wrong(text: str, message: str) -> str:
    """The parser's message in plain words, with the line it stopped in."""
    words, _, place = message.partition(" (at ")
    position = re.match(r"line (\d+)", place)
    lines = text.split("\n")
    number = int(position[1]) if position else len(lines)
    line = lines[min(number, len(lines)) - 1].strip()
    quoted = f", {printable(line[:70])}" if line else ""
    return f"not valid TOML in line {number}{quoted}: {_plain_words(words, line)}"


def _plain_words(words: str, line: str) -> str:
    twice = _TWICE.match(words)
    if twice:
        keys = re.findall(r"'([^']*)'", twice[1])
        name = ".".join(keys)
        if len(keys) == 1 and keys[0] in _LISTS:
            return f"there is a second [{name}]; each is written with double brackets, [[{name}]]"
        owner = keys[0] if keys and keys[0] in _LISTS else "scene"
        return (
            f"there is a second [{name}]; a {owner} has one, so put all of its keys into the first"
        )
    listed = re.match(r"\[\[(\w+)\]\]", line)
    if words.startswith("Cannot overwrite a value") and listed and listed[1] in _LISTS:
        name = listed[1]
        return f"there is a [{name}] before; each is written with double brackets, [[{name}]]"
    if words.startswith("Duplicate inline table key"):
        return "a key is given twice in its table"
    bare = re.sub(r"\s*#.*$", "", line[:300])
    for pattern, plain in _HABITS:
        if pattern.search(bare):
            return plain
    return next(
        (plain for start, plain in _PARSER.items() if words.startswith(start)),
        words[:1].lower() + words[1:],
    )


def of_tables(error: SceneError, raw: Mapping[str, Any]) -> SceneError:
    """Problems of the one entry of a list told as those of a table, where a file has a table."""
    return SceneError.of(
        problem.located(None, path=(problem.path[0], *problem.path[2:]))
        if problem.path[1:2] == (0,) and isinstance(raw.get(problem.path[0]), Mapping)
        else problem
        for problem in error.problems
    )


class FileOrder:
    """Order of the entries of a file."""

    def __init__(self, raw: Mapping):
        self.raw = raw
        self.places: dict[int, dict] = {}

    def of(self, path: tuple) -> list[int]:
        """Places of the keys of a path in their tables, the last one for a key that is missing."""
        out: list[int] = []
        table = self.raw
        for key in path:
            if id(table) not in self.places:
                self.places[id(table)] = {key: k for k, key in enumerate(_keys(table))}
            places = self.places[id(table)]
            if key not in places:
                return [*out, len(places)]
            out.append(places[key])
            table = table[key]
        return out


def _keys(table: Any) -> Iterable:
    if isinstance(table, Mapping):
        return table
    return range(len(table)) if isinstance(table, list) else ()
