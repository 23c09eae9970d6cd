"""Text of a file that has changed: only entries that differ are written anew, so that
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
from contextlib import suppress
from typing import Any

from solidgear.core.errors import SceneError
from solidgear.core.machine.whole_file import write_page
from solidgear.core.scene.document import Document
from solidgear.core.scene.materials import by_name
from solidgear.core.scene.units import POSITION_DECIMALS, quantity, with_unit_of

Table = Mapping[str, Any]
#: keys whose values name files, relative to that of their table
FILES = ("scene", "step", "mesh", "contact_cells", "measured_flank", "matrices", "shapes", "file")
#: the same of a train or scene, but not of tables in it: a loss factor is called so too
LIST = "bearings"
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
#: times that a key is written in one way: places in it may count from others in it
PASSES = 3
#: path of a text that lies in no file: it says its own name, and where the files that it names are
NOWHERE = ""
#: entries at the root before all tables
FIRST = ("title", "name", "source")


#: canonical tables of what the tables of a file at a path describe; it raises SceneError
Canonical = Callable[[Table, str], Table]


def rewritten(document: Document, path: str, canonical: Canonical, target: Table) -> str:
    """Return the text of a document, to lie at a path, that reads back as canonical tables."""
    text = _moved(document, path)

    def says(text: str) -> Table | None:
        try:
            return canonical(tomllib.loads(text), path)
        except SceneError:
            return None

    current = says(text)
    for key in (*FIRST, *dict.fromkeys((*target, *document.tables))):
        if current is not None and current.get(key) == target.get(key):
            continue
        for way in WAYS:
            last, reading = _changed(text, current, key, target, way, says)
            if reading is not None and reading.get(key) == target.get(key):
                break
        text, current = last, reading
    return text if current == target else written_anew(target)


def _changed(
    text: str,
    current: Table | None,
    key: str,
    target: Table,
    way: Callable[[Any, str, Any, Any], None],
    says: Callable[[str], Table | None],
) -> tuple[str, Table | None]:
    """Return a text with a key changed in one way, and what it says."""
    import tomlkit  # start-up: not every scene is written

    for _ in range(PASSES):
        file = tomlkit.parse(text)
        try:
            way(file, key, (current or {}).get(key), target.get(key))
            text = tomlkit.dumps(file)
            current = says(text)
        except (KeyError, IndexError, TypeError, ValueError, AttributeError):
            return text, None  # a file in words that this way does not know
        if current is None or current.get(key) == target.get(key):
            break
    return text, current


def toml_of(
    document: Document | None,
    path: str | os.PathLike | None,
    canonical: Canonical,
    target: Table,
) -> str:
    """Return :func:`text_of`, and write it to a path if one is given."""
    text = text_of(document, path, canonical, target)
    if path is not None:
        write_page(path, text)
    return text


def text_of(
    document: Document | None,
    path: str | os.PathLike | None,
    canonical: Canonical,
    target: Table,
) -> str:
    """Return the text of a file that reads back as canonical tables: that of the document it was
    read from, as far as that holds, to lie at a path or, without one, anywhere.
    """
    if document is None or not document.text:
        return written_anew(target)
    if path is not None:  # files named from a folder are found once it is there
        with suppress(OSError):
            os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    return rewritten(document, os.fspath(path or NOWHERE), canonical, target)


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
        for entry in value:
            items.append(_item(entry, top=True))
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
    return isinstance(value, Mapping) and any(_is_tables(v) or _is_deep(v) for v in value.values())


def _moved(document: Document, path: str) -> str:
    """Return the text of a document with names of files relative to another folder, or full paths."""
    import tomlkit  # start-up: not every scene is written

    old, new = (os.path.dirname(os.path.abspath(p)) for p in (document.path, path))
    if path != NOWHERE and old == new:
        return document.text
    file = tomlkit.parse(document.text)
    for table, key in list(_named_files(file)):
        names = table[key]
        paths = [os.path.join(old, name) for name in ([names] if isinstance(names, str) else names)]
        moved = [_in_text(p) if path == NOWHERE else _relative(p, new) for p in paths]
        table[key] = moved[0] if isinstance(names, str) else moved
    return tomlkit.dumps(file)


def _in_text(path: str) -> str:
    """Return a path as files write it on every system."""
    return os.path.normpath(path).replace(os.sep, "/")


def _relative(path: str, folder: str) -> str:
    """Return a path relative to a folder; as it is on another drive of Windows."""
    try:
        return _in_text(os.path.relpath(path, folder))
    except ValueError:
        return path


def _named_files(value: Any, top: bool = True) -> Iterator[tuple[Any, str]]:
    """Yield the entries that name files, by their tables and keys, of all of a file or of a table."""
    if isinstance(value, Mapping):
        names = (*FILES, LIST) if top or "segment" in value else FILES
        for key, entry in value.items():
            texts = [entry] if isinstance(entry, str) else entry if isinstance(entry, list) else []
            if key in names and texts and all(isinstance(text, str) for text in texts):
                yield value, key
            else:
                yield from _named_files(entry, top=False)
    elif isinstance(value, list):
        for entry in value:
            yield from _named_files(entry, top=False)


# --------------------------------------------------------------------------- ways to write a key
def _entries(file: Any, key: str, current: Any, wanted: Any) -> None:
    """Write the entries of a key that differ, in the words of the file."""
    if key in WHOLE:
        raise KeyError(key)
    _write(file, key, current, wanted)


def _write(table: Any, key: str, current: Any, wanted: Any) -> None:
    """Write what differs under a key of a table of a file."""
    if wanted is None and key in USUAL:
        table[key] = USUAL[key]
    elif wanted is None:
        del table[key]
    elif isinstance(wanted, Mapping) and isinstance(current, Mapping) and _is_table(table, key):
        for name in dict.fromkeys((*current, *wanted)):
            if current.get(name) != wanted.get(name):
                _write(table[key], name, current.get(name), wanted.get(name))
    elif _is_tables(wanted) and _is_tables(current) and key in table:
        rows = table[key] if isinstance(table[key], list) else [table[key]]
        for row, old, new in _paired(rows, current, wanted):
            for name in dict.fromkeys((*old, *new)):
                if old.get(name) != new.get(name):
                    _write(row, name, old.get(name), new.get(name))
    else:
        _write_value(table, key, current, wanted)


def _is_table(table: Any, key: str) -> bool:
    return key in table and isinstance(table[key], Mapping)


def _write_value(table: Any, key: str, current: Any, wanted: Any) -> None:
    """Write a value under a key of a table of a file, with the unit of the one before."""
    before = table.get(key)
    if key == "position" and "from" in table and isinstance(current, float):
        offset = quantity(before if before is not None else 0.0, "length")
        table[key] = with_unit_of(before, round(offset + wanted - current, POSITION_DECIMALS))
        return
    for word in INSTEAD.get(key, ()):
        if word in table:
            del table[word]
    if key == "material" and isinstance(before, str) and _is_named(wanted):
        table[key] = wanted["name"]
    elif isinstance(wanted, list) and isinstance(before, list) and len(wanted) == len(before):
        table[key] = [with_unit_of(b, t) for b, t in zip(before, wanted)]
    elif isinstance(wanted, (Mapping, list)):
        table[key] = _item(wanted, top=False)
    else:
        table[key] = with_unit_of(before, wanted)


def _is_named(material: Table) -> bool:
    """Return True for a material that its name stands for."""
    try:
        return bool(material.get("name")) and by_name(material["name"]) == dict(material)
    except SceneError:
        return False


def _paired(rows: Any, current: list, wanted: list) -> Iterator[tuple[Any, Table, Table]]:
    """Yield tables of a list of the file with what they say and should say, by name."""
    if len(rows) != len(current) or len(current) != len(wanted):
        raise KeyError("a list of another length")
    row_named = {table.get("name", k): table for k, table in enumerate(rows)}
    names = [table.get("name", k) for k, table in enumerate(current)]
    if len(row_named) == len(rows) and set(row_named) == set(names) == {
        t.get("name", k) for k, t in enumerate(wanted)
    }:
        after = {table.get("name", k): table for k, table in enumerate(wanted)}
        yield from ((row_named[name], old, after[name]) for name, old in zip(names, current))
    else:
        yield from zip(rows, current, wanted)


def _tables(file: Any, key: str, current: Any, wanted: Any) -> None:
    """Write the tables of a list that differ anew, leave out those that went, and append new ones."""
    rows, inline = file[key], not hasattr(file[key], "_body")
    old_names = [table["name"] for table in current]
    new_names = [table["name"] for table in wanted]
    old, new = dict(zip(old_names, current)), dict(zip(new_names, wanted))
    for k in reversed(range(len(rows))):
        name = rows[k]["name"]
        if name not in new:
            del rows[k]
        elif old[name] != new[name]:
            rows[k] = _item(new[name], top=not inline)
    for name in new_names:
        if name not in old:
            rows.append(_item(new[name], top=not inline))


def _anew(file: Any, key: str, current: Any, wanted: Any) -> None:
    """Write all of a key anew."""
    for word in BESIDE.get(key, ()):
        table, _, name = word.rpartition(".")
        holder = file.get(table, {}) if table else file
        if name in holder:
            del holder[name]
    if wanted is None:
        del file[key]
    elif key not in file:
        file.add(key, _item(wanted, top=True))
    else:
        inline = isinstance(file[key], list) and not hasattr(file[key], "_body")
        file[key] = _item(copy.deepcopy(wanted), top=not inline)


#: ways to write a key, the first of which reads back as wanted
WAYS = (_entries, _tables, _anew)
