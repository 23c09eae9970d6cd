"""The command deflect: a train under torque, or a shaft under its load."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import explained
from solidgear.show.command import Progress, command
from solidgear.show.options import BY_MODEL, Shown
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import units_named
from solidgear.strength.acting import Acting, AtRestFile
from solidgear.strength.deflection import shaft, train
from solidgear.strength.deflection.sheet import scene_sheet, train_sheet
from solidgear.trains.assembly.assembly import Assembly


@command
def deflect(
    file: AtRestFile,
    *,
    acting: Acting,
    models: Annotated[
        list[str] | None,
        typer.Option(
            *BY_MODEL,
            help="Model of every shaft; repeatable, the finest last. By default rigid (trains "
            "only), euler, timoshenko and harmonic.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for a page, deflection lines and their chart."),
    ] = None,
    run: Shown,
) -> None:
    loaded, units = acting.read(file), units_named(run.units)

    def study(progress: Progress) -> Sheet:
        if isinstance(loaded, tuple):
            loaded_train, point = loaded
            every_point = (
                acting.torque is None and acting.point is None and len(loaded_train.operation) > 1
            )
            deflected = train.deflect_train(
                Assembly(loaded_train), point, models or train.MODELS, progress, every_point
            )
            return train_sheet(deflected, units)
        with explained(file):
            return scene_sheet(shaft.deflect_scene(loaded, models or shaft.MODELS, progress), units)

    present(study, run, out)
