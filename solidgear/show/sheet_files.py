"""The files of one question, of studies that have no sheet of their own yet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from solidgear.show.plot import Make
from solidgear.show.sheet import Section, Sheet, write_folder
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
    sheet = Sheet(
        name=name,
        title=title,
        lead=lead,
        tables=tables,
        data=data,
        charts=charts,
        lines=lines,
        verdict=verdict,
        notes=notes,
        cautions=cautions,
        sections=sections,
        viewer=viewer,
    )
    return write_folder(sheet, folder)
