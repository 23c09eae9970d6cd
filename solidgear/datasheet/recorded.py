"""The data sheet of a shaft beside the report of its comparison."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from solidgear.core import Record, Scene
from solidgear.datasheet.numbers import recorded_numbers
from solidgear.datasheet.page import save
from solidgear.datasheet.shaft import shaft_sheet
from solidgear.strength.load import AT_REST
from solidgear.trains.assembly.assembly import NO_MODES, Assembly


def recorded_sheet(record: Record, scene: Scene, language: str, path: Path) -> list[Path]:
    """Write the sheet of a shaft with the numbers of its comparison, linked to the report."""
    assembly = Assembly.of(scene, kept=NO_MODES)
    point = assembly.train.point or AT_REST
    facts = shaft_sheet(assembly, point, numbers=recorded_numbers(record, scene))
    linked = replace(facts, language=language, report="report.html")
    return save(linked, path, record.shown_in)
