"""The command system-modes: natural frequencies of a train, pictures, and a page to turn them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import SolidgearError
from solidgear.show.command import Progress, command
from solidgear.show.options import UNITS, Shown
from solidgear.show.sheet import Sheet, present, write_page
from solidgear.show.units import units_named
from solidgear.show.viewer import viewer_fragment
from solidgear.trains.modes.pictures import draw_modes, still_picture, turning_modes
from solidgear.trains.modes.sheet import modes_sheet
from solidgear.trains.modes.study import SolvedModes
from solidgear.trains.modes.study import system_modes as solved
from solidgear.trains.options import Mix, Reduced, TrainFile


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
    if mode and pictures is None:
        raise SolidgearError("--mode says which mode to draw; add --pictures and a folder")
    if run.units != UNITS and turn is None:
        raise SolidgearError(
            f"--units {run.units}: the table has Hz and rpm only; add --turn model.html for a "
            "page in these units"
        )

    def study(progress: Progress) -> Sheet:
        modes = solved(train, models.models, settings=models.settings, **reduced.words)
        written, viewer = [], ""
        if pictures:
            written += _drawn(modes, pictures, mode)
        if turn is not None:
            viewer, sentence = _turned(modes, reduced.max_frequency)
            written += [line for line in (sentence, f"Written: {turn}") if line]
        sheet = modes_sheet(modes, units_named(run.units), viewer, written)
        if turn is not None:
            write_page(sheet, turn)
        return sheet

    present(study, run)


def _drawn(modes: SolvedModes, folder: Path, numbers: list[int] | None) -> list[str]:
    """Draw pictures of modes and return the lines to print."""
    listed = [n for n, mode in enumerate(modes, start=1) if mode.frequency_hz > 0]
    mix = modes.solved.models.values()
    pictures = draw_modes(modes.assembly, *mix, folder=folder, numbers=numbers or listed).values()
    written = [str(picture.path) for picture in pictures if picture.ok]
    lines = [f"Written: {', '.join(written)}"] if written else []
    return lines + sorted({picture.reason for picture in pictures if not picture.ok})


def _turned(modes: SolvedModes, max_frequency: float | None) -> tuple[str, str]:
    """Return the modes to turn as HTML, and why it has no picture for print."""
    assembly, mix = modes.assembly, modes.solved.models.values()
    models = turning_modes(assembly, *mix, highest_hz=max_frequency)
    elastic = [shape.name for shape in models.shapes]
    first = next((name for name in elastic if "bending" in name), elastic[0])
    number = [mode.name for mode in modes].index(first) + 1
    still, sentence = still_picture(assembly, *mix, number=number)
    return viewer_fragment([models], still=still, first=first), sentence
