"""What REXS has no place for: the difference of two tables, kept in an attribute of our own.

REXS lets a program add attributes whose names begin with ``custom_``, which others pass over.  A rest
holds, table by table, the entries to set, those to leave out, and what both replace: where the file
has been changed there since, by another program, the file holds.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeGuard

from solidgear.exchange.rexs.commented import Said, Sourced, plain
from solidgear.exchange.rexs.document import Component
from solidgear.exchange.rexs.units import REST

#: relative; numbers that went through the units of a file, and back
SAME = 1e-15
#: relative; a number of the file in other digits, as the arithmetic between its places leaves it
DIGITS = 1e-9
Table = dict[str, Any]
#: entries that an import makes up from names and numbers of components
MADE_UP = frozenset(("title", "source"))
#: entries that REXS has in other words, by the key of the file
CARRIED = frozenset(
    "pitch_radius spiral_angle between sun carrier of scene_load kind span at position seat_width "
    "loaded_side from name teeth pressure_angle".split()
)


def key_of(table: Mapping[str, Any], place: int) -> str:
    """Return what a table of a list is called: its name, what it lies between, or its place."""
    name = str(table.get("name") or "-".join(table.get("between", ())))
    return name or f"#{place}"


def is_rows(value: Any) -> TypeGuard[list[Any]]:
    """Return True for a list of tables."""
    return isinstance(value, list) and bool(value) and all(isinstance(v, Mapping) for v in value)


def by_key(rows: list[Any]) -> dict[str, Any] | None:
    """Return tables of a list by what they are called; None where two are called the same."""
    keyed = {key_of(row, k): row for k, row in enumerate(rows)}
    return keyed if len(keyed) == len(rows) else None


def same(value: Any, other: Any, tolerance: float = SAME) -> bool:
    """Return True for values that a file says alike, to the last digits of its units."""
    if isinstance(value, Said) and isinstance(other, Mapping) and len(other) == 1:
        # a preload is a force or a displacement, by its unit
        other = next(iter(other.values()))
    value, other = (v.number if isinstance(v, Said) else v for v in (value, other))
    if isinstance(value, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(value) == len(other) and all(same(v, w, tolerance) for v, w in zip(value, other))
    if isinstance(value, Mapping) and isinstance(other, Mapping):
        return value.keys() == other.keys() and all(
            same(value[k], other[k], tolerance) for k in value
        )
    numbers = [v for v in (value, other) if isinstance(v, (int, float)) and not isinstance(v, bool)]
    if len(numbers) == 2:
        return abs(numbers[0] - numbers[1]) <= tolerance * abs(numbers[1])
    return value == other


def rest_of(
    tables: Mapping[str, Any], due: Mapping[str, Any], usual: Callable[[Any, Any], Table]
) -> Table:
    """Return what is to be done to tables so that they are those that are due; empty for nothing.

    `usual` gives the entries of a table that it has without a word.
    """
    out: Table = {"set": {}, "without": [], "was": {}, "in": {}, "rows": {}}
    known = usual(tables, due)
    for key, value in due.items():
        given = tables.get(key)
        if isinstance(given, Mapping) and isinstance(value, Mapping):
            out["in"][key] = rest_of(given, value, usual)
        elif is_rows(given) and is_rows(value) and _alike(given, value):
            out["rows"][key] = _rows_rest(given, value, usual)
        elif key in tables and same(given, value) or same(known.get(key), value):
            continue
        else:
            out["set"][key] = value
            out["was"] |= {key: given} if key in tables and key not in MADE_UP else {}
    out["without"] = [key for key in tables if key not in due]
    out["was"] |= {key: tables[key] for key in out["without"]}
    out["in"] = {key: part for key, part in out["in"].items() if part}
    out["rows"] = {key: part for key, part in out["rows"].items() if part}
    return {key: part for key, part in out.items() if part}


def _alike(rows: list[Any], due: list[Any]) -> bool:
    keyed, keyed_due = by_key(rows), by_key(due)
    return keyed is not None and keyed_due is not None and bool(keyed.keys() & keyed_due.keys())


def _rows_rest(rows: list[Any], due: list[Any], usual: Callable[[Any, Any], Table]) -> Table:
    """Return the rest of a list: of its tables by what they are called, and their order."""
    keyed, keyed_due = by_key(rows) or {}, by_key(due) or {}
    parts = {k: rest_of(keyed[k], keyed_due[k], usual) for k in keyed_due if k in keyed}
    out: Table = {"in": {k: part for k, part in parts.items() if part}}
    out["add"] = {k: row for k, row in keyed_due.items() if k not in keyed}
    out["without"] = [k for k in keyed if k not in keyed_due]
    out["order"] = [*keyed_due] if [*keyed] != [*keyed_due] else []
    return {key: part for key, part in out.items() if part}


def restored(
    tables: Mapping[str, Any], rest: Mapping[str, Any], doubt: Callable[[str], None]
) -> Table:
    """Return tables with what REXS has no place for; `doubt` is called with what changed since."""
    out = dict(tables)
    for key, value in rest.get("was", {}).items():
        if json.loads(json.dumps(plain(out.get(key)))) != value:
            doubt(f"{key} has been changed in the file since it was written, and that holds")
            return out
    for key in rest.get("without", ()):
        out.pop(key, None)
    for key, value in rest.get("set", {}).items():
        is_table = isinstance(value, Mapping) or is_rows(value)
        out[key] = value if is_table else Sourced(value, REST)
    for key, part in rest.get("in", {}).items():
        inner = out.get(key, {})
        inner = inner.value if isinstance(inner, Sourced) else inner
        if isinstance(inner, Mapping):
            out[key] = restored(inner, part, doubt)
    for key, part in rest.get("rows", {}).items():
        if isinstance(out.get(key), list):
            out[key] = _restored_rows(out[key], part, doubt)
    return out


def _restored_rows(
    rows: list[Any], rest: Mapping[str, Any], doubt: Callable[[str], None]
) -> list[Any]:
    keyed = {key_of(plain(row), k): row for k, row in enumerate(rows)}
    for key, part in rest.get("in", {}).items():
        if key in keyed:
            keyed[key] = restored(keyed[key], part, doubt)
        else:
            doubt(f"{key} is not in the file any more")
    keyed |= rest.get("add", {})
    for key in rest.get("without", ()):
        keyed.pop(key, None)
    order = rest.get("order", [])
    names = [k for k in order if k in keyed] + [k for k in keyed if k not in order]
    return [keyed[name] for name in names]


def rest_text(rest: Mapping[str, Any]) -> str:
    """Return a rest as the text of an attribute."""
    return json.dumps(plain(rest), ensure_ascii=False)


def read_rest(component: Component) -> Table:
    """Return the rest of a component; empty where it has none.

    Raises
    ------
    RexsError
        A text that is no rest.
    """
    text = component.text(REST)
    if not text:
        return {}
    try:
        rest = json.loads(text)
    except (ValueError, RecursionError):
        raise component.wrong(REST, "is no JSON; leave the attribute out to go on") from None
    if not _is_rest(rest):
        raise component.wrong(REST, "is not as solidgear writes it; leave it out to go on")
    return rest


#: what each entry of a rest is, of a table or of a list
_SHAPES = {"set": dict, "was": dict, "add": dict, "without": list, "order": list}


def _is_rest(rest: Any) -> bool:
    if not isinstance(rest, dict) or rest.keys() - {*_SHAPES, "in", "rows"}:
        return False
    shapes = all(isinstance(rest[key], kind) for key, kind in _SHAPES.items() if key in rest)
    inner = [rest.get("in", {}), rest.get("rows", {})]
    if not shapes or not all(isinstance(parts, dict) for parts in inner):
        return False
    words = [word for key in ("without", "order") for word in rest.get(key, ())]
    rows = rest.get("add", {}).values()
    return (
        all(isinstance(word, str) for word in words)
        and all(isinstance(row, dict) for row in rows)
        and all(_is_rest(part) for parts in inner for part in parts.values())
    )


#: the list in which torque and speed are those of another shaft than in REXS
OPERATION = "operation"


def lost(rest: Mapping[str, Any], name: str) -> Iterator[tuple[str, list[str]]]:
    """Yield components of a rest, by what they are called, each with its keys that REXS lacks."""
    was = rest.get("was", {})
    values = {k: v for k, v in rest.get("set", {}).items() if k not in CARRIED}
    if keys := [k for k, v in values.items() if not (k in was and same(was[k], v, DIGITS))]:
        yield name, keys
    for key, part in rest.get("in", {}).items():
        yield from lost(part, f"{name} {key}")
    for key, part in rest.get("rows", {}).items():
        carried = ("torque", "speed") if key == OPERATION else ()
        for row in part.get("add", {}):
            yield f"{name} {key} {row}", ["all"]
        for row, inner in part.get("in", {}).items():
            for place, keys in lost(inner, f"{name} {key} {row}"):
                if keys := [k for k in keys if k not in carried]:
                    yield place, keys
