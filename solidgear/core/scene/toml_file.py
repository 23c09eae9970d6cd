"""Reading of TOML files as plain tables, or one sentence on where a file is wrong and how to correct
it.
"""

from __future__ import annotations

import re
import stat
import sys
import tomllib
from collections.abc import Iterable, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, TextIO

from solidgear.core.errors import SceneError, printable

#: bytes; a shipped scene takes some thousands, the largest possible shaft some ten thousands
LARGEST = 300_000
#: full stops in one line: a 6x6 matrix has 36. The parser's time grows with the cube of the parts
#: of a key
MOST_DOTS = 100
#: in place of a path
STANDARD_INPUT = "-"


def parse(file_path: str) -> dict[str, Any]:
    """Read the tables of a TOML file; refuse a missing, odd or too large file, text that is not UTF-8
    and text that is not TOML.
    """
    return tables_in(read_text(file_path), file_path)


def read_text(file_path: str) -> str:
    """Read the text of a TOML file; refuse a missing, odd or too large file, and text that is not
    UTF-8.
    """
    try:
        return _text(file_path)
    except FileNotFoundError:
        reason = "there is no such file"
    except UnicodeDecodeError as error:
        reason = f"not UTF-8 text (byte {error.start}); save the file as UTF-8"
    except SceneError as error:
        reason = error.reason
    except (OSError, ValueError) as error:
        reason = f"cannot be read: {getattr(error, 'strerror', None) or error}"
    raise SceneError(reason, where=place_of(file_path))


def tables_in(text: str, file_path: str) -> dict[str, Any]:
    """Return the tables of the text of a file; refuse text that is not TOML."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        reason = _syntax_reason(text, str(error))
    except RecursionError:
        reason = "not a scene: its tables are nested too deeply"
    except ValueError as error:
        reason = f"cannot be read: {error}"
        if "digits" in str(error):
            reason = "not a scene: a number in it has thousands of digits"
    raise SceneError(reason, where=place_of(file_path))


def describes_train(raw: Mapping[str, Any]) -> bool:
    """True for tables of a train of shafts, and not of one shaft."""
    return "segment" not in raw and ("shaft" in raw or {"pinion", "gear"} <= set(raw))


def name_of(file_path: str) -> str:
    """Return the name of the scene in a file: the stem of the path."""
    return "scene" if file_path == STANDARD_INPUT else Path(file_path).stem


def place_of(file_path: str) -> str:
    """Return a path as errors name it."""
    return "standard input" if file_path == STANDARD_INPUT else file_path


@lru_cache(maxsize=1)
def _standard_input(stream: TextIO) -> bytes:
    """Read standard input once: files are read again to locate problems."""
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
        raise SceneError(f"this is not a scene: it is larger than {LARGEST // 1000} kB")
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
#: common mistakes, by the line the parser stopped in, the most specific first: pattern and hint
_MISTAKES = (
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
_LISTS = ("segment", "bearing", "mass", "feature", "port", "load", "case")
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


def _syntax_reason(text: str, message: str) -> str:
    """Return the parser's message in plain words, with the line it stopped in."""
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
    for pattern, plain in _MISTAKES:
        if pattern.search(bare):
            return plain
    return next(
        (plain for start, plain in _PARSER.items() if words.startswith(start)),
        words[:1].lower() + words[1:],
    )


def with_table_paths(error: SceneError, raw: Mapping[str, Any]) -> SceneError:
    """Return an error with paths of the file, where it has a table in place of a list of one."""
    problems = []
    for problem in error.problems:
        if problem.path[1:2] == (0,) and isinstance(raw.get(problem.path[0]), Mapping):
            problem = problem.located(None, path=(problem.path[0], *problem.path[2:]))
        problems.append(problem)
    return SceneError.of(problems)


class FileOrder:
    """Order of the entries of a file, to sort problems by."""

    def __init__(self, raw: Mapping):
        self.raw = raw
        self.places: dict[int, dict] = {}

    def positions(self, path: tuple) -> list[int]:
        """Return the positions of the keys of a path in their tables; a missing key comes last."""
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
