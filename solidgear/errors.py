"""Errors a user can act on: one sentence, naming the place, the value as written and what would be right."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any


class SolidgearError(Exception):
    """Base of every error solidgear raises on purpose."""


class SceneError(SolidgearError, ValueError):
    """A scene that cannot be used as written.

    Parameters
    ----------
    reason : str
        What is wrong and what would be right.
    path : tuple of str and int
        Keys and zero-based indices from the root of the scene to the faulty entry.
    value : str
        The entry as written, already turned into text; empty when there is none.
    field : str
        `path` in readable form, such as ``bearing[2] "2".seat_width``; made by `located`.
    where : str
        The file (or scene) the entry is in.
    """

    def __init__(self, reason: str, *, path: tuple = (), value: str = "", field: str = "", where: str = ""):
        super().__init__(reason)
        self.reason, self.path, self.value, self.field, self.where = reason, tuple(path), value, field, where

    def __str__(self) -> str:
        place = " = ".join(part for part in (self.field or ".".join(map(str, self.path)), self.value) if part)
        return " ".join(": ".join(part for part in (self.where, place, self.reason) if part).split())

    def located(self, data: Any, *, where: str = "", prefix: tuple = (), path: tuple | None = None) -> SceneError:
        """The same error with its field named, and its value quoted, from the `data` the user wrote."""
        path = (*prefix, *self.path) if path is None else path
        field, found, known = _name_and_value(path, data)
        value = show(found) if known else self.value
        return type(self)(self.reason, path=path, value=value, field=field, where=where or self.where)


def show(value: Any, width: int = 70) -> str:
    """`value` as one would write it in TOML, in one line of at most `width` characters."""
    try:
        text = json.dumps(value, default=str, ensure_ascii=False)
    except (TypeError, ValueError):
        text = repr(value)
    text = {"NaN": "nan", "Infinity": "inf", "-Infinity": "-inf"}.get(text, text)
    return text if len(text) <= width else text[: width - 3] + "..."


def first_problem(error: Any, data: Any, *, where: str = "") -> SceneError:
    """Turn pydantic's ValidationError into the one-line `SceneError` of its first problem.

    Parameters
    ----------
    error : pydantic.ValidationError
    data : mapping
        What was validated, for names and values as written.
    where : str
        File or scene name put in front.
    """
    first = error.errors(include_url=False)[0]
    path = (*first["loc"], "kind") if first["type"].startswith("union_tag") else first["loc"]
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, SceneError):
        return cause.located(data, where=where, prefix=path)
    return SceneError(_plain_words(first)).located(data, where=where, path=path)


def _plain_words(first: Mapping) -> str:
    kind, ctx = first["type"], first.get("ctx", {})
    words = {
        "missing": "this key is missing",
        "string_type": "must be a text in quotes",
        "int_type": "must be a whole number",
        "list_type": "must be a list in square brackets",
        "tuple_type": "must be a list in square brackets",
        "dict_type": "must be a table",
        "model_type": "must be a table of keys",
        "model_attributes_type": "must be a table of keys",
        "union_tag_not_found": "this key is missing; it says which shape the segment has",
        "union_tag_invalid": f"unknown kind; write one of {ctx.get('expected_tags')}",
        "literal_error": f"must be {ctx.get('expected')}",
    }
    return words.get(kind) or first["msg"].replace("Input should be", "must be").replace("Value error, ", "")


def _name_and_value(path: tuple, data: Any) -> tuple[str, Any, bool]:
    """Readable name of `path` in `data`, the value found there, and whether there is one."""
    field, known = "", True
    for key in path:
        known, data = _child(data, key) if known else (False, None)
        if isinstance(key, int):
            field += f"[{key + 1}]"  # engineers count from one
            named, name = _child(data, "name") if known else (False, None)
            field += f" {show(name, 40)}" if named and isinstance(name, str) else ""
        else:
            text = key if str(key).replace("_", "").isalnum() else json.dumps(str(key))
            field += f".{text}" if field else str(text)
    return field, data, known and bool(path)


def _child(data: Any, key: Any) -> tuple[bool, Any]:
    if isinstance(data, Mapping):
        return (True, data[key]) if key in data else (False, None)
    if isinstance(key, int):
        inside = isinstance(data, Sequence) and not isinstance(data, str) and key < len(data)
        return (True, data[key]) if inside else (False, None)
    return (True, getattr(data, key)) if hasattr(data, key) else (False, None)


def nearest(word: Any, known: Iterable[str]) -> str:
    """``'; did you mean "x"?'``, or nothing when no known word is near."""
    close = difflib.get_close_matches(str(word), list(known), 1)
    return f'; did you mean "{close[0]}"?' if close else ""
