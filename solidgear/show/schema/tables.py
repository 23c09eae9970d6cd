"""Schema of a table of a file by the model that reads it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic.fields import FieldInfo

from solidgear.core.scene.typed import Holds, Model
from solidgear.core.scene.written import Kinds
from solidgear.show.schema.nodes import Node, Nodes, also, described, table
from solidgear.show.schema.sentences import sentences, summary


def of_model(kind: type[Model]) -> Node:
    """Return the schema of a table that a model reads."""
    said, needed = _said(kind), {key for group in kind.needs for key in _keys(group)}
    properties, required = {}, []
    for key, field in kind.table_keys().items():
        source = field or _source(kind, key)
        properties[key] = _with_default(described(_of_field(source), said.get(key, "")), source)
        if field is not None and field.is_required() and key not in needed:
            required.append(key)
    out = also(table(properties, required), *map(_one_of, kind.needs))
    return {"type": "object", "description": summary(kind), **out}


def of_kinds(kinds: Kinds) -> Node:
    """Return the schema of a table that is one of several kinds."""
    nodes = {name: of_model(kind) for name, kind in kinds.tables().items()}
    properties: dict[str, Node] = {
        "kind": {"type": "string", "enum": [*nodes], "description": "Kind of the table."}
    }
    for name, node in nodes.items():
        for key, entry in node["properties"].items():
            if key != "kind":
                _add(properties, key, name, entry)
    conditions = []
    for name, node in nodes.items():
        then: Node = {"propertyNames": {"enum": [*node["properties"]]}}
        required = [key for key in node.get("required", ()) if key not in kinds.given]
        if required:
            then["required"] = required
        differing = {
            key: {k: v for k, v in entry.items() if k != "description"}
            for key, entry in node["properties"].items()
            if key != "kind" and "type" not in properties[key]
        }
        if differing:
            then["properties"] = differing
        if "then" in node:
            then["allOf"] = node["then"]["allOf"]
        condition = {"properties": {"kind": {"enum": [name]}}, "required": ["kind"]}
        conditions.append({"if": condition, "then": then})
    return also(table(properties, ["kind"]), *conditions)


def _add(properties: dict[str, Node], key: str, kind: str, entry: Node) -> None:
    """Add the key of a kind; of a key that means something else in each, the sentences alone."""
    before = properties.get(key)
    if before is None:
        properties[key] = entry
        return
    plain = [{k: v for k, v in node.items() if k != "description"} for node in (before, entry)]
    texts = [before.get("description", ""), entry.get("description", "")]
    if plain[0] != plain[1]:
        properties[key] = {}
    else:
        properties[key] = {**plain[0]}
    if texts[1] not in texts[0]:
        texts = [f"{texts[0]} Of a {kind.replace('_', ' ')}: {texts[1]}"]
    properties[key]["description"] = texts[0]


def _of_field(field: FieldInfo | None) -> Node:
    if field is None:
        return {}
    held = [mark.kind for mark in field.metadata if isinstance(mark, Holds)]
    if held and not any(type(mark).__name__ == "Written" for mark in field.metadata):
        node = of_model(held[0])
        several = "list" in str(field.annotation)
        return {"type": "array", "items": node} if several else node
    return NODES.of(field.annotation, field.metadata)


def _with_default(node: Node, field: FieldInfo | None) -> Node:
    default = None if field is None else _plain(field.default)
    return node if default in (None, "", []) else {**node, "default": default}


def _plain(default: Any) -> Any:
    if isinstance(default, str | int | float | bool):
        return default
    if isinstance(default, tuple) and all(isinstance(v, int | float) for v in default):
        return [*default]
    return None


def _said(kind: type[Model]) -> dict[str, str]:
    """Return the sentences on the keys of a table."""
    out = {
        field.alias or name: text
        for name, text in sentences(kind).items()
        if (field := kind.model_fields.get(name)) is not None
    }
    for name, keys in getattr(kind, "sources", {}).items():
        out = {key: out[name] for key in keys if name in out} | out
    words = getattr(kind, "Words", Model)
    of_words = sentences(words)
    out |= {
        field.alias or name: text
        for name, text in of_words.items()
        if (field := words.model_fields.get(name)) is not None
    }
    return out


def _source(kind: type[Model], key: str) -> FieldInfo | None:
    """Return the field that a key of another name gives."""
    sources = getattr(kind, "sources", {})
    return next((kind.model_fields[name] for name, keys in sources.items() if key in keys), None)


def _keys(group: tuple[Any, ...]) -> Iterator[str]:
    for keys in group:
        yield from [keys] if isinstance(keys, str) else keys


def _one_of(group: tuple[Any, ...]) -> Node:
    """Return the condition that a table has one of the keys, or all of some, at least."""
    return {"anyOf": [{"required": [k] if isinstance(k, str) else [*k]} for k in group]}


NODES = Nodes(of_model, of_kinds)
