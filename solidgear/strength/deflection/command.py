"""The command deflect: a train under torque, or a shaft under its load."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import explained
from solidgear.show.command import Progress, command
from solidgear.show.options import BY_MODEL, Shown, relative
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import units_named
from solidgear.strength.acting import Acting, AtRestFile
from solidgear.strength.deflection import at_rest
from solidgear.strength.deflection.sheet import sheet


@command
def deflect(
    file: AtRestFile,
    *,
    acting: Acting,
    models: Annotated[
        list[str] | None,
        typer.Option(
            *BY_MODEL,
            help="Model of every shaft; repeatable, the finest last. By default rigid, "
            "euler, timoshenko and harmonic.",
        ),
    ] = None,
    tol: Annotated[
        float | None,
        relative(
            "--tol",
            "Relative error that meshes of harmonic shafts may leave in the motions of gears; by "
            "default a tenth of the file's tolerance.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for a page, deflection lines and their chart."),
    ] = None,
    run: Shown,
) -> None:
    (assembly, point), units = acting.read(file, tol), units_named(run.units)
    every_point = (
        acting.torque is None and acting.point is None and len(assembly.train.operation) > 1
    )

    def study(progress: Progress) -> Sheet:
        with explained(file):
            deflected = at_rest.deflect(
                assembly, point, models or at_rest.MODELS, progress, every_point
            )
        return sheet(deflected, units)

    present(study, run, out)
