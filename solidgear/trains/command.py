"""The command system-modes: natural frequencies of a train."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import SolidgearError
from solidgear.show.command import caution, command, say
from solidgear.show.options import UNITS, Shown
from solidgear.show.sheet import write_sheet
from solidgear.show.units import units_named
from solidgear.show.viewer import viewer_fragment
from solidgear.trains.assembly.shaft import mix_label
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.judge.comparison import train_data
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.modes.pictures import draw_modes, still_picture, turning_modes
from solidgear.trains.options import Mix, Reduced, TrainFile
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.tables import modes


@command
def system_modes(
    train: TrainFile,
    *,
    models: Mix,
    pictures: Annotated[
        Path | None,
        typer.Option("--pictures", help="Folder for pictures of the modes, all shafts in place."),
    ] = None,
    mode: Annotated[
        list[int] | None,
        typer.Option("--mode", help="Draw only this mode, counted from 1 as listed; repeatable."),
    ] = None,
    turn: Annotated[
        Path | None,
        typer.Option(help="HTML file: all modes of all shafts in 3D, to be turned and animated."),
    ] = None,
    reduced: Reduced,
    run: Shown,
) -> None:
    assembly = models.assembly(reduced, train)
    if mode and pictures is None:
        raise SolidgearError("--mode says which mode to draw; add --pictures and a folder")
    warnings = unit_slips(assembly)
    mix = tuple(models.by_shaft(assembly.train).values())
    count = assembly.train.ask.modes
    system = train_modes(assembly, *mix, max_frequency=reduced.max_frequency, at_most=count)
    if run.units != UNITS and turn is None:
        raise SolidgearError(
            f"--units {run.units}: the table has Hz and rpm only; add --turn model.html for a "
            "page in these units"
        )
    drawn = _drawn(assembly, pictures, mode, system) if pictures else []
    if turn is not None:
        drawn += _turned(assembly, system, turn, reduced.max_frequency, run.units, warnings)
    if run.as_json:
        cautions = {"cautions": [*warnings, *system.cautions]}
        print(json.dumps(system.as_dict() | cautions, allow_nan=False))
        return
    say(*system.heading(), *map(caution, warnings))
    say(modes(system.as_dict(), numbered=True), *system.remarks(), *drawn)


def _drawn(assembly, folder: Path, numbers: list[int] | None, system):
    """Draw pictures of modes and return the lines to print."""
    listed = [n for n, mode in enumerate(system.modes, start=1) if mode.frequency_hz > 0]
    mix = system.models.values()
    pictures = draw_modes(assembly, *mix, folder=folder, numbers=numbers or listed).values()
    written = [str(picture.path) for picture in pictures if picture.ok]
    lines = [f"Written: {', '.join(written)}"] if written else []
    return lines + sorted({picture.reason for picture in pictures if not picture.ok})


def _turned(
    assembly, system, path: Path, max_frequency: float | None, units: str, slips: tuple[str, ...]
) -> list[str]:
    """Write the page of modes to turn and return the line to print."""
    mix = system.models.values()
    models = turning_modes(assembly, *mix, highest_hz=max_frequency)
    names = [mode.name for mode in system.modes]
    elastic = [shape.name for shape in models.shapes]
    first = next((name for name in elastic if "bending" in name), elastic[0])
    still, sentence = still_picture(assembly, *mix, number=names.index(first) + 1)
    write_sheet(
        path,
        system.train,
        f"Natural frequencies and mode shapes: {mix_label(system.models)}.",
        [
            train_tables.modes(system.as_dict(), "Natural frequencies"),
            train_tables.facts(train_data(assembly), units_named(units)),
        ],
        viewer=viewer_fragment([models], still=still, first=first),
        notes=system.notes(),
        cautions=[*slips, *system.cautions],
    )
    return [*filter(None, [sentence]), f"Written: {path}"]
