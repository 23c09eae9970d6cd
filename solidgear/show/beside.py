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
from solidgear.show.sheet import Section, write_charts, write_json, write_sheet
from solidgear.show.table import Cell, Column, Table, text, word
from solidgear.show.units import Units
from solidgear.show.words import DASH, hertz, percent, seconds

#: letters of an entry of a file on a page and in a terminal
LONG, SHORT = 60, 34
SAME = "Nothing differs in the input."


def write_beside(
    pair: Any,
    sections: Callable[[], Sequence[Section]],
    out: str | os.PathLike,
    units: Units,
    *,
    lines: Mapping[str, Table] | None = None,
    charts: Mapping[str, Make] | None = None,
) -> Path:
    """Write results.json, tables, charts and report.html with its sections; return the path of the
    page.
    """
    lines, charts = lines or {}, charts or {}
    files = ["report.html", *(f"{name}.csv" for name in lines)]
    files += [f"{name}.{kind}" for name in charts for kind in ("png", "svg")]
    titles = dict.fromkeys(side.title for side in pair.both)
    with begun(out) as folder:
        # Numbers first: whatever happens to charts, they are there.
        write_json(folder / "results.json", {**pair.results, "files": files})
        for name, table in lines.items():
            table.write(folder / f"{name}.csv")
        for name, make in charts.items():
            write_charts(folder / name, make)
        return write_sheet(
            folder / "report.html",
            " beside ".join(titles),
            f"solidgear report on {pair.results['kind']}: "
            f"{'; '.join(side.label for side in pair.both)}.",
            verdict=pair.told(units),
            cautions=pair.cautions,
            sections=sections(),
            notes=[f"Whole run: {seconds(pair.seconds)} s."],
        )


def inputs(pair: Any, width: int = LONG) -> Table:
    """Return entries in which the files differ, each in at most so many letters."""
    columns = [text("entry"), text("A"), text("B")]
    rows = [[difference.path, *difference.texts(width)] for difference in pair.inputs]
    note = "A dash: not in that file."
    if any(str(cell).endswith("...") for row in rows for cell in row):
        note += " Entries that end in dots are whole in results.json."
    return Table("Input that differs", columns, rows, note, style="ruled")


def modes(pair: Any) -> Table:
    """Return natural frequencies side by side, with the verdict on each difference."""
    columns = [
        text("mode", names),
        Column("A, Hz", lambda p: its(p.a, "frequency_hz"), hertz),
        Column("B, Hz", lambda p: its(p.b, "frequency_hz"), hertz),
        Column("difference", lambda p: apart(p.change)),
    ]
    note = f"Paired {pair.pairing}. "
    if any(p.change is not None and p.change.band is not None for p in pair.modes):
        columns.append(Column("both error bars", lambda p: band(p.change)))
        columns.append(word("", lambda p: p.verdict))
        note += (
            "Both error bars: their sum, relative to A; a smaller difference is not resolved, "
            "which is not agreement. "
        )
    columns.append(Column("MAC", lambda p: p.mac, "{:.2f}".format))
    note += (
        "MAC: likeness of both shapes; a dash: paired by name, so that shapes may differ, or "
        "without a partner."
    )
    return Table("Natural frequencies", columns, pair.modes, note, style="ruled")


def its(mode: Any, key: str) -> Any:
    """Return an attribute, or None of None."""
    return None if mode is None else getattr(mode, key)


def names(pair: Any, key: str = "name") -> str:
    """Return the name of a mode in A, and in B where it is another."""
    labels = [getattr(mode, key) for mode in (pair.a, pair.b) if mode is not None]
    return labels[0] if len(set(labels)) == 1 else f"{labels[0]} (B: {labels[1]})"


def apart(change: Any, scale: float | None = None) -> str | Cell | None:
    """Return the difference in per cent of a scale, or of A, marked where it is within the error
    bars.
    """
    if change is None:
        return None
    scale = scale or abs(change.a)
    text_ = percent(change.difference / scale) if scale else DASH
    return Cell(text_, "unresolved") if change.verdict == "not resolved" else text_


def band(change: Any, scale: float | None = None) -> str | None:
    """Return the sum of both error bars in per cent of a scale, or of A."""
    scale = scale or (abs(change.a) if change is not None else None)
    if change is None or change.band is None or not scale:
        return None
    return percent(change.band / scale, signed=False)
