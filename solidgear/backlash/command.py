"""The command nonlinear: a train whose teeth have backlash, over speed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.backlash.nonlinear import SPEEDS
from solidgear.backlash.nonlinear import nonlinear as solved
from solidgear.show.command import command
from solidgear.show.options import Shown
from solidgear.show.sheet import present
from solidgear.trains.options import Mix, Reduced, TrainFile


@command
def nonlinear(
    train: TrainFile,
    *,
    models: Mix,
    backlash: Annotated[
        str | None,
        typer.Option(
            help='Backlash along the line of action, such as "100 um"; by default the file\'s.'
        ),
    ] = None,
    mean_force: Annotated[
        str | None,
        typer.Option(
            "--mean-force",
            help='Mean force of the teeth, such as "5 kN"; by default by the file\'s operating '
            "point.",
        ),
    ] = None,
    error: Annotated[
        str | None,
        typer.Option(help='Transmission error, such as "10 um"; by default the file\'s.'),
    ] = None,
    mesh: Annotated[
        str | None,
        typer.Option(
            "--mesh",
            help="Mesh whose transmission error drives the train, and to which --backlash, "
            "--mean-force and --error belong; by default the first.",
        ),
    ] = None,
    min_frequency: Annotated[
        float | None,
        typer.Option("--min-frequency", help="Hz; a hundredth of the highest by default."),
    ] = None,
    against: Annotated[
        list[str] | None,
        typer.Option(
            "--against",
            help="Further models to judge, as PINION+GEAR, one for each shaft; lumped and "
            "Timoshenko shafts by default.",
        ),
    ] = None,
    apart: Annotated[
        int,
        typer.Option(
            "--apart", help="Number of speeds at which separate branches are searched; 0 for none."
        ),
    ] = SPEEDS,
    in_time: Annotated[
        int,
        typer.Option(
            "--in-time", help="Number of speeds at which to check it by integration in time."
        ),
    ] = 0,
    run_up: Annotated[
        list[float] | None,
        typer.Option(
            "--run-up",
            help="Run through the range in time at so many rpm/s of the engine's shaft; below 0 "
            "for a run-down.",
        ),
    ] = None,
    contact_loss: Annotated[
        float | None,
        typer.Option(
            "--contact-loss",
            help="Frequency in Hz at which a damper in contact only has the loss factor of the "
            "mesh.",
        ),
    ] = None,
    forces: Annotated[
        int,
        typer.Option(
            "--forces", help="Number of mean forces for a map of jumps over speed and torque."
        ),
    ] = 0,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for the branch, its chart and a page."),
    ] = None,
    reduced: Reduced,
    run: Shown,
) -> None:
    present(
        lambda progress: solved(
            train,
            models.models,
            settings=models.settings,
            backlash=backlash,
            mean_force=mean_force,
            error=error,
            mesh=mesh,
            min_frequency=min_frequency,
            against=against,
            apart=apart,
            in_time=in_time,
            run_up=run_up or (),
            contact_loss=contact_loss,
            forces=forces,
            progress=progress,
            **reduced.words,
        ).sheet(run.units),
        run,
        out,
    )
