"""The files of one question: numbers, charts as PNG and SVG, and a page to read them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from solidgear.core import whole
from solidgear.show.plot import WIDE, Make
from solidgear.show.sheet import Section, write_sheet
from solidgear.show.table import Table


def write_files(
    folder: Path,
    name: str,
    title: str,
    lead: str,
    tables: Sequence[Table],
    data: Mapping[str, Any],
    *,
    lines: Mapping[str, Table],
    charts: Mapping[str, Make],
    notes: Sequence[str] = (),
    cautions: Sequence[str] = (),
    verdict: Sequence[str] = (),
    viewer: str = "",
    sections: Sequence[Section] = (),
) -> list[Path]:
    """Write a page and its data (SI), tables by file name, and charts; return the paths."""
    folder.mkdir(parents=True, exist_ok=True)
    files = [table.write(folder / f"{stem}.csv") for stem, table in lines.items()]
    files.append(folder / f"{name}.json")
    write_json(files[-1], data)
    drawn = [charts, *(section.charts for section in sections)]
    for stem, make in (item for some in drawn for item in some.items()):
        files += write_charts(folder / stem, make)
    path = folder / f"{name}.html"
    write_sheet(
        path,
        title,
        lead,
        tables,
        charts=charts,
        notes=notes,
        cautions=cautions,
        verdict=verdict,
        viewer=viewer,
        sections=sections,
    )
    return [path, *files]


def write_json(path: Path, data: Mapping[str, Any]) -> None:
    """Write plain data as a whole file or none."""
    with whole(path) as half:
        half.write_text(json.dumps(data, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def write_charts(stem: Path, make: Make) -> list[Path]:
    """Write a chart as PNG and SVG."""
    chart = make(WIDE)
    if chart is None:
        return []
    files = [stem.with_suffix(f".{kind}") for kind in ("png", "svg")]
    chart.write(*files)
    return files
