"""Schemas of the JSON that commands print, from the types of their results.

A result becomes JSON by :func:`solidgear.core.plain.plain`, whose rules these schemas follow; what a
command prints beside its results stands as a :class:`solidgear.show.printed.Printed` beside the
code that makes it.
"""

from __future__ import annotations

import types
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import cached_property
from pathlib import PurePath
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin, get_type_hints

import numpy as np
from pydantic import BaseModel

from solidgear.core import SolidgearError, nearest, show
from solidgear.core.registry import needed, registered
from solidgear.show.printed import Printed
from solidgear.show.schema.files import DRAFT, text_of
from solidgear.show.schema.sentences import sentences, summary

Node = dict[str, Any]
#: JSON has no infinite numbers
NUMBER: Node = {"type": ["number", "null"]}
SIMPLE: dict[Any, Node] = {
    str: {"type": "string"},
    bool: {"type": "boolean"},
    int: {"type": "integer"},
    float: NUMBER,
    complex: {},
    type(None): {"type": "null"},
}


class Field(NamedTuple):
    """A key of a result: its type and its sentence."""

    kind: Any
    sentence: str = ""


def text_of_command(command: str) -> str:
    """Return the schema of what a command prints with ``--json``, as text; refuse a command that
    prints none.
    """
    return text_of(schema_of_command(command))


def schema_of_command(command: str) -> Node:
    """Return the schema of what a command prints with ``--json``."""
    commands = registered("printed")
    if command not in commands:
        raise SolidgearError(
            f"no command {show(command, 40)} prints JSON{nearest(command, commands)}; "
            f"those that do are {', '.join(sorted(commands))}"
        )
    printed = needed("printed", command, command)
    title = f"solidgear {command} --json: numbers in SI"
    return {"$schema": DRAFT, "title": title, **of(printed)}


def of(kind: Any) -> Node:
    """Return the schema of a type of a result."""
    if isinstance(kind, Printed):
        return _of_printed(kind)
    if isinstance(kind, tuple):  # of what is printed in several forms
        return {"anyOf": [of(part) for part in kind]}
    if isinstance(kind, Mapping):
        return _table({key: Field(part) for key, part in kind.items()})
    origin, parts = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return of(parts[0])
    if origin is Literal:
        return {"enum": [*parts]}
    if origin in (Union, types.UnionType):
        return _any([of(part) for part in parts])
    if origin is tuple and parts[1:] != (...,):
        items = [of(part) for part in parts]
        return {"type": "array", "items": items, "minItems": len(items), "maxItems": len(items)}
    return _of_class(origin or kind, parts)


def _of_class(kind: Any, parts: tuple[Any, ...]) -> Node:
    if kind in SIMPLE:
        return SIMPLE[kind]
    if not isinstance(kind, type):
        return {}
    if issubclass(kind, np.ndarray):
        return {"type": ["array", "number"]}
    if issubclass(kind, str | PurePath):
        return {"type": "string"}
    if issubclass(kind, bool | int | float):
        return next(SIMPLE[base] for base in (bool, int, float) if issubclass(kind, base))
    if is_dataclass(kind) or hasattr(kind, "_fields") or issubclass(kind, BaseModel):
        open_keys = issubclass(kind, BaseModel) and kind.model_config.get("extra") == "allow"
        return {"description": summary(kind), **_table(keys_of(kind), not open_keys)}
    if issubclass(kind, Mapping):
        return {"type": "object", "additionalProperties": of(parts[1])} if parts else {}
    if issubclass(kind, Sequence):
        return {"type": "array", "items": of(parts[0]) if parts else {}}
    return {}


def keys_of(kind: type) -> dict[str, Field]:
    """Return the keys of a result as plain data, with their types."""
    said, hints = sentences(kind), _hints(kind)
    if issubclass(kind, BaseModel):
        names: Any = [name for name, field in kind.model_fields.items() if not field.exclude]
        custom = kind.__pydantic_decorators__.model_serializers
        if custom:  # writes other keys than its fields
            return {}
        hints = {name: field.annotation for name, field in kind.model_fields.items()}
    elif is_dataclass(kind):
        names = getattr(kind, "plain_names", None)
        if names is None:
            names = [field.name for field in fields(kind) if field.repr]
    else:
        names = kind._fields  # type: ignore[attr-defined]  # of a named tuple
    pairs = [(name, name) if isinstance(name, str) else name for name in names]
    return {key: Field(_kind(kind, name, hints), said.get(name, "")) for key, name in pairs}


def _kind(kind: type, name: str, hints: Mapping[str, Any]) -> Any:
    """Return the type of a field, or of a property; Any where it is not known."""
    thing = getattr(kind, name, None)
    function = thing.fget if isinstance(thing, property) else None
    if isinstance(thing, cached_property):
        function = thing.func
    if function is not None:
        return _hints(function).get("return", Any)
    return hints.get(name, type(thing) if isinstance(thing, str) else Any)


def _hints(thing: Any) -> dict[str, Any]:
    """Return the types of fields, Any for one whose name is not imported."""
    try:
        return get_type_hints(thing)
    except NameError:
        bases = [base for base in reversed(getattr(thing, "__mro__", (thing,)))]
        return {k: v for base in bases for k, v in _each_hint(base).items()}


def _each_hint(thing: Any) -> dict[str, Any]:
    import sys

    names = vars(sys.modules[thing.__module__])
    out = {}
    for name, text in getattr(thing, "__annotations__", {}).items():
        try:
            out[name] = eval(text, names) if isinstance(text, str) else text
        except NameError:
            out[name] = Any
    return out


def _of_printed(printed: Printed) -> Node:
    keys, sometimes = _keys(printed), _sometimes(printed)
    out = _table({**sometimes, **keys})
    out["required"] = [*keys]
    if printed.named is not None:
        out["additionalProperties"] = of(printed.named)
    return out


def _keys(kind: Any) -> dict[str, Field]:
    """Return the keys that every run has."""
    if not isinstance(kind, Printed):
        return keys_of(kind)
    keys = {k: v for part in kind.results for k, v in _keys(part).items()}
    keys |= {k: Field(v) for k, v in kind.keys.items()}
    return {k: v for k, v in keys.items() if k not in kind.without}


def _sometimes(printed: Printed) -> dict[str, Field]:
    """Return the keys that not every run has."""
    bases = [part for part in printed.results if isinstance(part, Printed)]
    keys = {k: v for base in bases for k, v in _sometimes(base).items()}
    keys |= {k: v for part in printed.optional for k, v in _keys(part).items()}
    return keys | {k: Field(v) for k, v in printed.sometimes.items()}


def _table(keys: Mapping[str, Field], closed: bool = True) -> Node:
    properties = {}
    for key, entry in keys.items():
        node = of(entry.kind)
        properties[key] = {"description": entry.sentence, **node} if entry.sentence else node
    out: Node = {"type": "object"}
    if not properties:
        return out
    out["properties"] = properties
    if closed:
        out |= {"additionalProperties": False, "required": [*properties]}
    return out


def _any(nodes: Sequence[Node]) -> Node:
    if any(not node for node in nodes):
        return {}
    unique = [node for k, node in enumerate(nodes) if node not in nodes[:k]]
    return unique[0] if len(unique) == 1 else {"anyOf": unique}
