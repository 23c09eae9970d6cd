"""Tables that two trains and two shafts beside each other share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.report.table import Cell, Column, Table, text, word
from solidgear.report.words import DASH, hertz, percent

#: letters of an entry of a file on a page and in a terminal
LONG, SHORT = 60, 34
SAME = "Nothing differs in the input."


def title(both: Mapping[str, Mapping[str, Any]]) -> str:
    """Title of two shafts or trains, once if they have the same."""
    titles = [one["title"] for one in both.values()]
    return titles[0] if len(set(titles)) == 1 else f"{titles[0]} beside {titles[1]}"


def who(found: Any) -> str:
    """Both letters and what they stand for."""
    return "; ".join(one.label for one in found.both)


def inputs(found: Any, width: int = LONG) -> Table:
    """Entries in which the files differ, each in at most so many letters."""
    columns = [text("entry"), text("A"), text("B")]
    rows = [[one.path, *one.written(width)] for one in found.inputs]
    note = "A dash: not in that file, where something else holds without it."
    if any(str(cell).endswith("...") for row in rows for cell in row):
        note += " What ends in dots is whole in results.json."
    return Table("Input that differs", columns, rows, note, style="ruled")


def modes(found: Any) -> Table:
    """Natural frequencies side by side, with what of their differences is resolved."""
    columns = [
        text("mode", _name),
        Column("A, Hz", lambda p: its(p.a, "frequency_hz"), hertz),
        Column("B, Hz", lambda p: its(p.b, "frequency_hz"), hertz),
        Column("difference", lambda p: apart(p.change)),
    ]
    note = f"Paired {found.pairing}. "
    if any(p.change is not None and p.change.band is not None for p in found.modes):
        columns.append(Column("both bars", lambda p: band(p.change)))
        columns.append(word("", lambda p: p.verdict))
        note += (
            "Both bars: the sum of the error bars of both frequencies, relative to A; a difference "
            "below it is not resolved, which is not agreement. "
        )
    columns.append(Column("MAC", lambda p: p.mac, "{:.2f}".format))
    note += (
        "MAC: how alike the motions of both are; a dash: paired by name, whose shapes may differ, "
        "or without a partner."
    )
    return Table("Natural frequencies", columns, found.modes, note, style="ruled")


def its(one: Any, key: str) -> Any:
    """Attribute of what may be missing."""
    return None if one is None else getattr(one, key)


def _name(pair: Any) -> str:
    """A mode as A calls it, and as B does where that is another name."""
    names = [one.name for one in (pair.a, pair.b) if one is not None]
    return names[0] if len(set(names)) == 1 else f"{names[0]} (B: {names[1]})"


def apart(change: Any, scale: float | None = None) -> str | Cell | None:
    """Difference in per cent, marked where its bars hold it; relative to a scale, or to A."""
    if change is None:
        return None
    scale = scale or abs(change.a)
    told = percent(change.difference / scale) if scale else DASH
    return Cell(told, "unresolved") if change.verdict == "not resolved" else told


def band(change: Any, scale: float | None = None) -> str | None:
    """Sum of both bars in per cent of a scale, or of A."""
    scale = scale or (abs(change.a) if change is not None else None)
    if change is None or change.band is None or not scale:
        return None
    return percent(change.band / scale, signed=False)
