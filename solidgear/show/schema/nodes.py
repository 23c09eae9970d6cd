"""Schema of a value by its type: numbers with units, words, lists, tables, and what may be several.

Keywords are those of JSON Schema draft 7 that editors follow.  Nothing is referred to: editors show
the sentence of a key only where it stands beside the key.  Where a value may be of several types,
keywords of each stand side by side, for a keyword binds values of its type alone, and an editor then
marks the wrong key and not the whole table.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt, MaxLen, MinLen
from pydantic.fields import FieldInfo

from solidgear.core import Range, Written
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import DIMENSIONS
from solidgear.core.scene.written import Kinds, Measure, Three, Word
from solidgear.show.schema.units import number_of, text_of, words_on_unit

Node = dict[str, Any]
#: makes the schema of a table of a model, and of a table of several kinds
OfModel = Callable[[type[Model]], Node]
OfKinds = Callable[[Kinds], Node]

#: keywords of bounds by their marks, with the attribute that holds the bound
BOUNDS = {
    Ge: ("minimum", "ge"),
    Gt: ("exclusiveMinimum", "gt"),
    Le: ("maximum", "le"),
    Lt: ("exclusiveMaximum", "lt"),
    MinLen: ("minItems", "min_length"),
    MaxLen: ("maxItems", "max_length"),
}
SIMPLE = {str: "string", int: "integer", float: "number", bool: "boolean"}
#: of regular expressions
_SPECIAL = frozenset(r".^$*+?()[]{}|\/")


class Nodes:
    """Maker of schemas, with the makers of tables."""

    def __init__(self, of_model: OfModel, of_kinds: OfKinds):
        self.of_model, self.of_kinds = of_model, of_kinds

    def of(self, kind: Any, marks: Sequence[Any] = ()) -> Node:
        """Return the schema of a type with marks, the outermost last."""
        if get_origin(kind) is Annotated:
            inner, *inner_marks = get_args(kind)
            return self.of(inner, [*inner_marks, *marks])
        # a Field inside a type keeps its marks to itself
        fields = [mark for mark in marks if isinstance(mark, FieldInfo)]
        if any(field.discriminator for field in fields):
            return self.of_kinds(_shapes(get_args(kind)))
        said = [field.description for field in fields if field.description]
        if said:
            return described(self.of(kind, [m for m in marks if m not in fields]), said[-1])
        marks = [*marks, *(mark for field in fields for mark in field.metadata)]
        written = [mark for mark in marks if isinstance(mark, Written)]
        if written:
            return self.of(written[-1].kind)
        for mark in marks:
            if isinstance(mark, Kinds):
                return self.of_kinds(mark)
            if isinstance(mark, Word):
                return _words(mark)
            if isinstance(mark, Measure):
                return _measure(kind, mark.dimension, marks)
            if isinstance(mark, Three):
                return _list([_measure(float, mark.dimension, ())] * 3)
        return self._of_type(kind) | _bounds(marks)

    def _of_type(self, kind: Any) -> Node:
        if isinstance(kind, Mapping):
            return table({key: self.of(entry) for key, entry in kind.items()})
        origin, parts = get_origin(kind), get_args(kind)
        if origin is Literal:
            return {"type": SIMPLE[type(parts[0])], "enum": [*parts]}
        if origin in (Union, types.UnionType):
            return either([self.of(part) for part in parts if part is not type(None)])
        if origin is tuple and parts[1:] != (...,):
            return _list([self.of(part) for part in parts])
        if origin in (list, tuple):
            return {"type": "array", "items": self.of(parts[0])}
        if origin is dict:
            return {"type": "object", "additionalProperties": self.of(parts[1])}
        if kind is dict:
            return {"type": "object"}
        if isinstance(kind, type) and issubclass(kind, Model):
            return self.of_model(kind)
        if isinstance(kind, type) and issubclass(kind, str):
            return {"type": "string"}
        return {"type": SIMPLE[kind]} if kind in SIMPLE else {}


def _shapes(models: Sequence[type[Model]]) -> Kinds:
    """Return models by their kinds."""
    return Kinds(lambda: {get_args(m.model_fields["kind"].annotation)[0]: m for m in models})


def table(properties: Mapping[str, Node], required: Sequence[str] = ()) -> Node:
    """Return the schema of a table with these keys alone."""
    out: Node = {"type": "object", "properties": dict(properties), "additionalProperties": False}
    return {**out, "required": [*required]} if required else out


def described(node: Node, sentence: str) -> Node:
    """Return a schema with the sentence of its key, and how a file writes a quantity."""
    parts = [_ended(sentence) or node.get("description", ""), node.get("$comment", "")]
    description = " ".join(part for part in parts if part)
    out = _without_notes(node)
    return {"description": description} | out | {"description": description} if description else out


def _ended(sentence: str) -> str:
    sentence = sentence.replace("``", "`").strip()
    if not sentence:
        return ""
    return sentence[:1].upper() + sentence[1:] + ("" if sentence.endswith(".") else ".")


def _without_notes(node: Any) -> Any:
    """Return a schema without the notes of the entries of its lists."""
    if isinstance(node, Mapping):
        return {k: _without_notes(v) for k, v in node.items() if k != "$comment"}
    return [_without_notes(entry) for entry in node] if isinstance(node, list) else node


def also(node: Node, *conditions: Node) -> Node:
    """Return a schema with further conditions; editors do not look for keys in them."""
    if not conditions:
        return node
    before = node.get("then", {}).get("allOf", [])
    return {**node, "if": {}, "then": {"allOf": [*before, *conditions]}}


def either(nodes: Sequence[Node]) -> Node:
    """Return the schema of a value that is one of several."""
    by_type: dict[str, list[Node]] = {}
    for node in nodes:
        kinds = node.get("type", [])
        for kind in [kinds] if isinstance(kinds, str) else kinds:
            by_type.setdefault(kind, []).append(node)
    if any("type" not in node for node in nodes):
        return {}
    merged: Node = {"type": [*by_type] if len(by_type) > 1 else next(iter(by_type))}
    for kind, of_kind in by_type.items():
        merged |= MERGES[kind](of_kind)
    words = [word for node in nodes for word in node.get("enum", ())]
    if words and "enum" not in merged:
        # editors offer these words
        others = [kind for kind in by_type if kind != "string" or "pattern" in merged]
        merged["anyOf"] = [{"enum": words}, {"type": others}]
    units = {node["x-unit"] for node in nodes if "x-unit" in node}
    if len(units) == 1:
        merged["x-unit"] = units.pop()
    hints = dict.fromkeys(node["$comment"] for node in nodes if "$comment" in node)
    return merged | ({"$comment": " ".join(hints)} if hints else {})


def pattern(*texts: str) -> str:
    """Return an expression of a whole text that is one of several."""
    return f"^(?:{'|'.join(texts)})$"


def escaped(word: str) -> str:
    """Return the regular expression of a word."""
    return "".join(f"\\{letter}" if letter in _SPECIAL else letter for letter in word)


def _either_text(nodes: Sequence[Node]) -> Node:
    if all("enum" in node for node in nodes) and len(nodes) > 1:
        return {"enum": [word for node in nodes for word in node["enum"]]}
    texts: list[str] = []
    for node in nodes:
        if "pattern" in node:
            texts.append(node["pattern"].removeprefix("^(?:").removesuffix(")$"))
        elif "enum" in node:
            texts += map(escaped, node["enum"])
        else:
            return {}
    return {"pattern": pattern(*texts)}


def _either_number(nodes: Sequence[Node]) -> Node:
    keys = [key for key, _ in BOUNDS.values() if all(key in node for node in nodes)]
    return {key: (min if "inimum" in key else max)(node[key] for node in nodes) for key in keys}


def _either_list(nodes: Sequence[Node]) -> Node:
    if len(nodes) == 1:
        return {key: nodes[0][key] for key in ("items", "minItems", "maxItems") if key in nodes[0]}
    out: Node = {"items": either([node["items"] for node in nodes])}
    for key, widest in (("minItems", min), ("maxItems", max)):
        if all(key in node for node in nodes):
            out[key] = widest(node[key] for node in nodes)
    return out


def _either_table(nodes: Sequence[Node]) -> Node:
    named = [node for node in nodes if "properties" in node]
    properties: Node = {}
    for node in named:
        for key, entry in node["properties"].items():
            before = properties.setdefault(key, entry)
            properties[key] = (
                entry if entry == before else _with_sentence(either([before, entry]), before)
            )
    out: Node = {"properties": properties}
    others = [n["additionalProperties"] for n in nodes if n.get("additionalProperties")]
    out["additionalProperties"] = others[0] if others else False
    if len(nodes) == 1:
        return {key: v for key, v in nodes[0].items() if key not in ("type", "description")}
    out["minProperties"] = 1
    conditions = [_as_given(node, named, bool(others)) for node in named]
    return also(out, *(condition for condition in conditions if condition))


def _with_sentence(node: Node, source: Node) -> Node:
    """Return a schema with the sentence of another."""
    said = source.get("description")
    return {"description": said, **node} if said else node


def _as_given(node: Node, named: Sequence[Node], open_keys: bool) -> Node:
    """Return the condition on a table that has a key of this schema alone."""
    others = {key for other in named if other is not node for key in other["properties"]}
    alone = [key for key in node["properties"] if key not in others]
    then: Node = {key: node[key] for key in ("required",) if key in node}
    if not open_keys:
        then["propertyNames"] = {"enum": [*node["properties"]]}
    return {"if": {"anyOf": [{"required": [key]} for key in alone]}, "then": then} if alone else {}


MERGES: dict[str, Callable[[Sequence[Node]], Node]] = {
    "string": _either_text,
    "number": _either_number,
    "integer": _either_number,
    "boolean": lambda nodes: {},
    "array": _either_list,
    "object": _either_table,
}


def _list(items: Sequence[Node]) -> Node:
    if all(item == items[0] for item in items):
        entries: Any = items[0]
    else:
        entries = [*items]
    return {"type": "array", "items": entries, "minItems": len(items), "maxItems": len(items)}


def _measure(kind: Any, dimension: str, marks: Sequence[Any]) -> Node:
    ranges = [mark for mark in marks if isinstance(mark, Range)]
    out: Node = {"type": ["number", "string"], **number_of(ranges)}
    if kind is str:
        return {"type": "string", "pattern": pattern(text_of(dimension, ranges))}
    out["pattern"] = pattern(text_of(dimension, ranges))
    si = DIMENSIONS[dimension][0]
    return {**out, **({"x-unit": si} if si else {}), "$comment": words_on_unit(si)}


def _words(mark: Word) -> Node:
    if not mark.pattern:
        return {"type": "string", "enum": [*mark.words]}
    words = {"anyOf": [{"enum": [*mark.words]}, {"type": "string"}]} if mark.words else {}
    return {"type": "string", **words, "pattern": pattern(*map(escaped, mark.words), mark.pattern)}


def _bounds(marks: Sequence[Any]) -> Node:
    out = {}
    for mark in marks:
        keyword, attribute = BOUNDS.get(type(mark), ("", ""))
        if keyword:
            out[keyword] = getattr(mark, attribute)
    return out
