"""The command deflect: a train under torque, or a shaft under its load."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import command
from solidgear.show.options import BY_MODEL, Settings, Shown, options, relative
from solidgear.show.sheet import present
from solidgear.strength.acting import Acting, AtRestFile
from solidgear.strength.deflection.study import deflect as deflected


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
            "euler and timoshenko, and the cheapest solid that models all of a shaft.",
        ),
    ] = None,
    tol: Annotated[
        float | None,
        relative(
            "--tol",
            "Relative error that meshes of solid shafts may leave in the motions of gears; by "
            "default a tenth of the file's tolerance for harmonic ones, and all of it for 3D ones.",
        ),
    ] = None,
    settings: Settings = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for a page, deflection lines and their chart."),
    ] = None,
    run: Shown,
) -> None:
    present(
        lambda progress: deflected(
            file,
            models,
            **vars(acting),
            tol=tol,
            settings=options(settings),
            progress=progress,
        ).sheet(run.units),
        run,
        out,
    )
