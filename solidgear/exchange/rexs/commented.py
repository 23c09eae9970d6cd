"""Tables of a file with a comment beside each value, as TOML."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import Any

from solidgear.exchange.rexs.units import scaled

#: letters of a line of comments at the head of a file
LINE = 118


@dataclass(frozen=True)
class Sourced:
    """A value and where it came from."""

    value: Any
    source: str


#: relative; what the arithmetic between two files leaves, which twelve digits may leave out
NOISE = 1e-15


class Said(str):
    """A quantity as a file has it, with the number in SI that the file gives it."""

    number: float


def said(length: float, unit: str, factor: float = 1.0, noise: float = NOISE) -> Said:
    """Return a quantity as a file has it, from its number in SI and the SI units in one unit: in
    twelve digits where these say it.

    Examples
    --------
    >>> said(0.08, "mm", 1e-3)
    '80 mm'
    """
    text = f"{length / factor:.12g}"
    if abs(scaled(float(text), factor) - length) > noise * abs(length):
        text = repr(float(length / factor))
    out = Said(f"{text} {unit}")
    out.number = scaled(float(text), factor)
    return out


def mm(length: float) -> Said:
    """Return a length in millimetres."""
    return said(length, "mm", 1e-3)


def deg(angle: float) -> Said:
    """Return an angle in degrees."""
    return said(angle, "deg", pi / 180)


def plain(tables: Any) -> Any:
    """Return tables without comments."""
    if isinstance(tables, Sourced):
        return plain(tables.value)
    if isinstance(tables, Mapping):
        return {key: plain(value) for key, value in tables.items()}
    if isinstance(tables, list):
        return [plain(value) for value in tables]
    return tables


def toml_of(tables: Mapping[str, Any], head: Sequence[str] = ()) -> str:
    """Return tables as TOML, with a head of comments, and each value's source beside it."""
    import tomlkit  # start-up: for files that are written

    document = tomlkit.document()
    for line in head:
        document.add(tomlkit.comment(one_line(line)) if line else tomlkit.nl())
    if head:
        document.add(tomlkit.nl())
    _fill(document, tables)
    return tomlkit.dumps(document)


def _fill(container: Any, tables: Mapping[str, Any]) -> None:
    import tomlkit  # start-up: for files that are written

    values = {k: v for k, v in tables.items() if not _is_table(v)}
    for key, value in values.items():
        item = tomlkit.item(plain(value), _parent=None)
        if isinstance(plain(value), Mapping):
            item = tomlkit.inline_table()
            item.update(plain(value))
        if isinstance(value, Sourced) and value.source:
            item.comment(one_line(value.source))
        container.add(key, item)
    for key, value in tables.items():
        if key in values:
            continue
        if isinstance(value, Mapping):
            table = tomlkit.table(is_super_table=all(map(_is_table, value.values())))
            _fill(table, value)
            container.add(key, table)
            continue
        rows = tomlkit.aot()
        for row in value:
            table = tomlkit.table()
            _fill(table, row)
            rows.append(table)
        container.add(key, rows)


def one_line(text: str) -> str:
    """Return a text of a file that was read, without letters that would end a comment or move a cursor."""
    return "".join(letter if letter.isprintable() else "?" for letter in text)


def _is_table(value: Any) -> bool:
    """Return True for what has a heading in brackets."""
    if isinstance(value, list):
        return bool(value) and all(isinstance(row, Mapping) for row in value)
    return isinstance(value, Mapping)


def wrapped(text: str, indent: str = "  ") -> list[str]:
    """Return a line of a head in lines that are not too long."""
    import textwrap  # start-up: for files that are written

    return textwrap.wrap(text, LINE, initial_indent=indent, subsequent_indent=indent + "  ")
