"""Everything that two trains and two shafts beside each other leave in a folder: numbers, curves,
charts, and one self-contained page.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from solidgear.show.folder import begun
from solidgear.show.plot import Make
from solidgear.show.sheet import Section, write_sheet
from solidgear.show.sheet_files import write_charts, write_json
from solidgear.show.table import Cell, Column, Table, text, word
from solidgear.show.units import Units
from solidgear.show.words import DASH, hertz, percent, seconds

#: letters of an entry of a file on a page and in a terminal
LONG, SHORT = 60, 34
SAME = "Nothing differs in the input."


def write_beside(
    found: Any,
    sections: Callable[[], Sequence[Section]],
    out: str | os.PathLike,
    units: Units,
    *,
    lines: Mapping[str, Table] | None = None,
    charts: Mapping[str, Make] | None = None,
) -> Path:
    """Write results.json, tables for other programs (`lines`), those charts that are files as well,
    and report.html with its sections; the path is that of the page.
    """
    lines, charts = lines or {}, charts or {}
    files = ["report.html", *(f"{name}.csv" for name in lines)]
    files += [f"{name}.{kind}" for name in charts for kind in ("png", "svg")]
    titles = dict.fromkeys(one.title for one in found.both)
    with begun(out) as folder:
        # Numbers first: whatever happens to charts, they are there.
        write_json(folder / "results.json", {**found.results, "files": files})
        for name, table in lines.items():
            table.write(folder / f"{name}.csv")
        for name, make in charts.items():
            write_charts(folder / name, make)
        return write_sheet(
            folder / "report.html",
            " beside ".join(titles),
            f"solidgear report on {found.results['kind']}: "
            f"{'; '.join(one.label for one in found.both)}.",
            verdict=found.told(units),
            cautions=found.cautions,
            sections=sections(),
            notes=[f"Whole run: {seconds(found.seconds)} s."],
        )


def inputs(found: Any, width: int = LONG) -> Table:
    """Entries in which the files differ, each in at most so many letters."""
    columns = [text("entry"), text("A"), text("B")]
    rows = [[one.path, *one.texts(width)] for one in found.inputs]
    note = "A dash: not in that file, where something else holds without it."
    if any(str(cell).endswith("...") for row in rows for cell in row):
        note += " What ends in dots is whole in results.json."
    return Table("Input that differs", columns, rows, note, style="ruled")


def modes(found: Any) -> Table:
    """Natural frequencies side by side, with what of their differences is resolved."""
    columns = [
        text("mode", names),
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


def names(pair: Any, key: str = "name") -> str:
    """A mode as A calls it, and as B does where that is another name."""
    told = [getattr(one, key) for one in (pair.a, pair.b) if one is not None]
    return told[0] if len(set(told)) == 1 else f"{told[0]} (B: {told[1]})"


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
