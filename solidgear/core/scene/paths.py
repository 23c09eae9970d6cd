"""Paths of entries of a scene or train file: ``bearing.A.seat_width``, ``mesh.stiffness``.

A path names keys of tables with dots between. A table of a list is given by name or by number,
counted from one; the only table of a list may be left out. An entry of a list of numbers is given by
number. A material given by name is a table of constants, and an entry of a stiffness may go without
the table or matrix that holds it. A key that the file does not hold may be one of the format: the
reader of the changed tables refuses others.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from solidgear.core.errors import SceneError, listed, nearest, show
from solidgear.core.scene.bearing_stiffness import STIFFNESS_NAMES
from solidgear.core.scene.materials import as_table

Tables = Mapping[str, Any]
#: key of the factor on springs
FACTOR = "scale"
#: keys and places from the root of a file to an entry
Keys = tuple[str | int, ...]


def keys_of(path: str, tables: Tables) -> Keys:
    """Return the keys and places that a path stands for in the tables of a file; refuse a name or
    number that a list does not have, and a path that ends at a table.

    Examples
    --------
    >>> tables = {"bearing": [{"name": "A", "position": "15 mm"}, {"name": "B"}]}
    >>> keys_of("bearing.A.position", tables), keys_of("bearing.2.seat_width", tables)
    (('bearing', 0, 'position'), ('bearing', 1, 'seat_width'))
    >>> keys_of("bearing.A.kxx", tables)
    ('bearing', 0, 'stiffness', 'kxx')
    """
    keys: list[str | int] = []
    table: Any = tables
    remainder = path
    while remainder:
        if isinstance(table, list):
            place, remainder = _place_in(table, remainder, ".".join(map(str, keys)))
            keys.append(place)
        elif isinstance(table, Mapping) and keys and _names_itself(table, remainder):
            remainder = _after(remainder, _word(remainder))
            continue
        elif remainder in STIFFNESS_NAMES and keys[:1] in (["bearing"], ["housing"]):
            keys += _stiffness_keys(tuple(keys), table or {}, remainder)
            return tuple(keys)
        elif isinstance(table, Mapping) or table is None:
            matches = [key for key in table or {} if _begins(remainder, key)]
            word = max(matches, key=len, default="") or _word(remainder)
            remainder = _after(remainder, word)
            keys.append(word)
        else:
            reason = (
                f"is {show(table, 40)}, which has no {_word(remainder)}; write a table to vary "
                f"{_word(remainder)}"
            )
            raise SceneError(reason, field=label_of(tuple(keys), tables))
        table = _child(table, keys[-1]) if remainder else _value(table, keys[-1])
    if isinstance(table, list) and len(table) == 1 and isinstance(table[0], Mapping):
        table = table[0]
    if isinstance(table, (Mapping, list)) and keys[-1:] != ["material"]:  # which has names too
        names = table if isinstance(table, Mapping) else _names(table)
        reason = f"is no single entry; add one of {listed(names)}"
        raise SceneError(reason, field=label_of(tuple(keys), tables))
    return tuple(keys)


def label_of(keys: Keys, tables: Tables) -> str:
    """Return the path of an entry, with names of tables where they have one.

    Examples
    --------
    >>> label_of(("bearing", 0, "position"), {"bearing": [{"name": "A"}]})
    'bearing.A.position'
    """
    out, table = [], tables
    for key in keys:
        table = _child(table, key)
        name = _name(table) if isinstance(key, int) else key
        out.append(name or str(int(key) + 1))
    return ".".join(out)


def entry(keys: Keys, tables: Tables) -> Any:
    """Return the value of an entry of a file; where it holds none 1 for a factor, else None."""
    table: Any = tables
    for key in keys[:-1]:
        table = _child(table, key)
    value = _value(table, keys[-1])
    return 1.0 if value is None and keys[-1] == FACTOR else value


def with_entry(tables: Any, keys: Keys, value: Any) -> Any:
    """Return a copy of tables with one entry replaced, and missing tables on the way to it made.

    Examples
    --------
    >>> with_entry({"losses": {"mesh": 0.1}}, ("losses", "shafts"), 0.02)
    {'losses': {'mesh': 0.1, 'shafts': 0.02}}
    """
    if not keys:
        return value
    first, *further = keys
    if isinstance(first, int):
        out = list(tables)
        out[first] = with_entry(out[first], tuple(further), value)
        return out
    table = tables if isinstance(tables, Mapping) else {}
    inner = _child(table, first) if further else None
    return {**table, first: with_entry(inner, tuple(further), value)}


def replace_entry(tables: Tables, keys: Keys, value: Any) -> Tables:
    """Return :func:`with_entry`, of a stiffness matrix with the mirrored entry as well."""
    out = with_entry(tables, keys, value)
    if len(keys) > 2 and keys[-3] == "matrix":
        out = with_entry(out, (*keys[:-2], keys[-1], keys[-2]), value)
    return out


def entries(tables: Any, before: Keys = ()) -> Iterator[Keys]:
    """Yield the keys of every entry of a file that is no table."""
    if isinstance(tables, Mapping):
        for key in tables:
            yield from entries(_child(tables, key), (*before, key))
    elif isinstance(tables, list):
        for k, value in enumerate(tables):
            yield from entries(value, (*before, k))
    else:
        yield before


def _place_in(things: list, remainder: str, label: str) -> tuple[int, str]:
    """Return the place of a thing in a list, and the remainder of the path."""
    names = _names(things)
    for k in sorted(range(len(names)), key=lambda k: -len(names[k])):
        if _name(things[k]) and _begins(remainder, names[k]):
            return k, _after(remainder, names[k])
    word = _word(remainder)
    if word.isdecimal() and 1 <= int(word) <= len(things):
        return int(word) - 1, _after(remainder, word)
    if len(things) == 1 and isinstance(things[0], Mapping):
        return 0, remainder
    raise SceneError(f"there is no {label}.{word}{nearest(word, names)}; there are {listed(names)}")


def _names(things: list) -> list[str]:
    """Return the names of things in a list, or their numbers."""
    return [_name(thing) or str(k) for k, thing in enumerate(things, start=1)]


def _names_itself(table: Mapping[str, Any], remainder: str) -> bool:
    """Return True where a path names a single table as if it were one of a list."""
    word = _word(remainder)
    return word not in table and word in (_name(table), "1") and remainder != word


def _begins(remainder: str, name: str) -> bool:
    return remainder == name or remainder.startswith(f"{name}.")


def _word(remainder: str) -> str:
    return remainder.partition(".")[0]


def _after(remainder: str, word: str) -> str:
    return remainder[len(word) + 1 :]


def _name(thing: Any) -> str:
    name = thing.get("name") if isinstance(thing, Mapping) else None
    return name if isinstance(name, str) else ""


def _stiffness_keys(keys: Keys, table: Mapping[str, Any], name: str) -> Keys:
    """Return the keys of an entry of a stiffness in the table of a bearing or a housing."""
    if "catalogue" in table:
        reason = (
            f"bearing {show(_name(table))} has its stiffness from its catalogue data; vary "
            f"bearing.{_name(table)}.scale, or an entry of its catalogue"
        )
        raise SceneError(reason)
    if "matrix" in table:
        row, column, _ = STIFFNESS_NAMES[name]
        return "matrix", row, column
    of_bearing = keys[0] == "bearing"
    inside = keys[-1] == "stiffness" or (of_bearing and keys[-1] == "housing")
    return (name,) if inside or name in table else ("stiffness", name)


def _child(table: Any, key: str | int) -> Any:
    """Return the value under a key, a material given by name as a table."""
    value = _value(table, key)
    return as_table(value) if key == "material" else value


def _value(table: Any, key: str | int) -> Any:
    """Return the value that a file holds under a key; None where it holds none."""
    if isinstance(table, Mapping):
        return table.get(key)
    return table[key] if isinstance(table, list) and isinstance(key, int) else None
