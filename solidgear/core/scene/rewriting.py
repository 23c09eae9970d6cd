"""Text of a file that says something else now: only entries that differ are written anew, so that
units, comments and order stay.

A file is compared with what it should say by canonical tables: those of the object that is read from
it (:mod:`solidgear.core.scene.writing`).  Each key at the root is tried in three ways, the first of
which reads back as wanted: its entries one by one, in the words that the file has; its tables one by
one, written anew; all of it anew.
"""

from __future__ import annotations

import copy
import os
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from solidgear.core.errors import SceneError
from solidgear.core.scene.document import Document
from solidgear.core.scene.materials import by_name
from solidgear.core.scene.units import quantity, with_unit_of

Table = Mapping[str, Any]
#: keys whose values name files, relative to that of their table
FILES = ("scene", "step", "mesh", "contact_cells", "measured_flank", "matrices", "shapes", "file")
#: words of a file that go where an entry is written in other words
INSTEAD = {
    "position": ("at", "from", "on", "seat", "face"),
    "span": ("attach_to", "on", "seat"),
    "seat_width": ("on", "seat"),
    "stiffness": ("matrix", "hold", "catalogue"),
    "catalogue": ("stiffness", "matrix", "hold"),
    "hold": ("stiffness", "matrix", "catalogue"),
    "start_diameter": ("diameter",),
    "start_bore": ("bore",),
}
#: keys at the root that go where another is written anew: canonical tables do without them
BESIDE = {"bearing": ("arrangement",), "port": ("ask.port",)}
#: entries that a file states for all tables, and what a table says that has none in canonical tables
USUAL = {"attachment": "average"}
#: tables whose entries belong together
WHOLE = ("uncertain",)
#: entries at the root before all tables
FIRST = ("title", "name", "source")


@dataclass(frozen=True)
class Form:
    """Reading and writing of one kind of file."""

    #: canonical tables of what the tables of a file in a folder describe, or SceneError
    canonical: Callable[[Table, str], Table]


def rewritten(document: Document, path: str, form: Form, target: Table) -> str:
    """Return the text of a document, to lie at a path, that reads back as canonical tables."""
    import tomlkit  # start-up: not every scene is written

    text = _moved(document, path)

    def says(text: str) -> Table | None:
        try:
            return form.canonical(tomllib.loads(text), path)
        except SceneError:
            return None

    for key in (*FIRST, *dict.fromkeys((*target, *document.tables))):
        now = says(text)
        if now is not None and now.get(key) == target.get(key):
            continue
        if now is not None and key not in target and key not in now:
            continue  # a word of the file that canonical tables do without
        last = text
        for change in (_entries, _tables, _anew):
            file = tomlkit.parse(text)
            try:
                change(file, key, (now or {}).get(key), target.get(key))
                last = tomlkit.dumps(file)
                then = says(last)
            except (KeyError, IndexError, TypeError, ValueError, AttributeError):
                continue  # a file in words that this way does not know
            if then is not None and then.get(key) == target.get(key):
                break
        text = last
    return text if says(text) == target else written_anew(target)


def written_anew(tables: Table) -> str:
    """Return the text of a file that holds tables."""
    import tomlkit  # start-up: not every scene is written

    file = tomlkit.document()
    for key in sorted(tables, key=lambda key: (_is_long(tables[key]), [*tables].index(key))):
        file.add(key, _item(tables[key], top=True))
    return tomlkit.dumps(file)


def _is_long(value: Any) -> bool:
    """Return True for tables, which follow entries of one line."""
    return isinstance(value, Mapping) or _is_tables(value)


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(v, Mapping) for v in value)


def _item(value: Any, top: bool = False) -> Any:
    """Return a value as an item of a file: at the `top` of it, and where tables lie in tables, with a
    line for each entry.
    """
    import tomlkit  # start-up: not every scene is written

    if _is_tables(value) and top:
        items = tomlkit.aot()
        for table in value:
            items.append(_item(table, top=True))
        return items
    if not isinstance(value, Mapping):
        return tomlkit.item([_item(v) for v in value] if isinstance(value, list) else value)
    deep = top or any(map(_is_tables, value.values()))
    table: Any = tomlkit.table() if deep else tomlkit.inline_table()
    for key in sorted(value, key=lambda key: deep and _is_deep(value[key])):
        table.add(key, _item(value[key], top=deep and _is_deep(value[key])))
    return table


def _is_deep(value: Any) -> bool:
    """Return True for a table that holds lists of tables."""
    return isinstance(value, Mapping) and any(
        _is_tables(v) or _is_deep(v) for v in value.values()
    )


def _moved(document: Document, path: str) -> str:
    """Return the text of a document with names of files relative to another folder."""
    import tomlkit  # start-up: not every scene is written

    old, new = (os.path.dirname(os.path.abspath(p)) for p in (document.path, path))
    if old == new:
        return document.text
    file = tomlkit.parse(document.text)
    for table, key in list(_named_files(file)):
        names = table[key]
        paths = [os.path.join(old, name) for name in ([names] if isinstance(names, str) else names)]
        moved = [os.path.relpath(p, new).replace(os.sep, "/") for p in paths]
        table[key] = moved[0] if isinstance(names, str) else moved
    return tomlkit.dumps(file)


def _named_files(value: Any) -> Iterator[tuple[Any, str]]:
    """Yield the entries that name files, by their tables and keys."""
    if isinstance(value, Mapping):
        for key, entry in value.items():
            texts = [entry] if isinstance(entry, str) else entry if isinstance(entry, list) else []
            if key in FILES and texts and all(isinstance(text, str) for text in texts):
                yield value, key
            else:
                yield from _named_files(entry)
    elif isinstance(value, list):
        for entry in value:
            yield from _named_files(entry)


# --------------------------------------------------------------------------- ways to write a key
def _entries(file: Any, key: str, now: Any, then: Any) -> None:
    """Write the entries of a key that differ, in the words of the file."""
    if key in WHOLE:
        raise KeyError(key)
    _write(file, key, now, then)


def _write(table: Any, key: str, now: Any, then: Any) -> None:
    """Write what differs under a key of a table of a file."""
    if then is None and key in USUAL:
        table[key] = USUAL[key]
    elif then is None:
        del table[key]
    elif isinstance(then, Mapping) and isinstance(now, Mapping) and _is_table(table, key):
        for name in dict.fromkeys((*now, *then)):
            if now.get(name) != then.get(name):
                _write(table[key], name, now.get(name), then.get(name))
    elif _is_tables(then) and _is_tables(now) and key in table:
        rows = table[key] if isinstance(table[key], list) else [table[key]]
        for row, old, new in _paired(rows, now, then):
            for name in dict.fromkeys((*old, *new)):
                if old.get(name) != new.get(name):
                    _write(row, name, old.get(name), new.get(name))
    else:
        _write_value(table, key, now, then)


def _is_table(table: Any, key: str) -> bool:
    return key in table and isinstance(table[key], Mapping)


def _write_value(table: Any, key: str, now: Any, then: Any) -> None:
    """Write a value under a key of a table of a file, with the unit of the one before."""
    before = table.get(key)
    if key == "position" and "from" in table and isinstance(now, float):
        offset = quantity(before if before is not None else 0.0, "length")
        table[key] = with_unit_of(before, offset + then - now)
        return
    for word in INSTEAD.get(key, ()):
        if word in table:
            del table[word]
    if key == "material" and isinstance(before, str) and _is_named(then):
        table[key] = then["name"]
    elif isinstance(then, list) and isinstance(before, list) and len(then) == len(before):
        table[key] = [with_unit_of(b, t) for b, t in zip(before, then)]
    elif isinstance(then, (Mapping, list)):
        table[key] = _item(then, top=False)
    else:
        table[key] = with_unit_of(before, then)


def _is_named(material: Table) -> bool:
    """Return True for a material that its name stands for."""
    try:
        return bool(material.get("name")) and by_name(material["name"]) == dict(material)
    except SceneError:
        return False


def _paired(rows: Any, now: list, then: list) -> Iterator[tuple[Any, Table, Table]]:
    """Yield tables of a list of the file with what they say and should say, by name."""
    if len(rows) != len(now) or len(now) != len(then):
        raise KeyError("a list of another length")
    by = {table.get("name", k): table for k, table in enumerate(rows)}
    names = [table.get("name", k) for k, table in enumerate(now)]
    if len(by) == len(rows) and set(by) == set(names) == {t.get("name", k) for k, t in enumerate(then)}:
        after = {table.get("name", k): table for k, table in enumerate(then)}
        yield from ((by[name], old, after[name]) for name, old in zip(names, now))
    else:
        yield from zip(rows, now, then)


def _tables(file: Any, key: str, now: Any, then: Any) -> None:
    """Write the tables of a list that differ anew, leave out those that went, and append new ones."""
    rows, inline = file[key], not hasattr(file[key], "_body")
    names_now = [table["name"] for table in now]
    names_then = [table["name"] for table in then]
    old, new = dict(zip(names_now, now)), dict(zip(names_then, then))
    for k in reversed(range(len(rows))):
        name = rows[k]["name"]
        if name not in new:
            del rows[k]
        elif old[name] != new[name]:
            rows[k] = _item(new[name], top=not inline)
    for name in names_then:
        if name not in old:
            rows.append(_item(new[name], top=not inline))


def _anew(file: Any, key: str, now: Any, then: Any) -> None:
    """Write all of a key anew."""
    for word in BESIDE.get(key, ()):
        table, _, name = word.rpartition(".")
        holder = file.get(table, {}) if table else file
        if name in holder:
            del holder[name]
    if then is None:
        del file[key]
    elif key not in file:
        file.add(key, _item(then, top=True))
    else:
        inline = isinstance(file[key], list) and not hasattr(file[key], "_body")
        file[key] = _item(copy.deepcopy(then), top=not inline)
