"""The command contact: teeth under load, over a mesh cycle and over the torque."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import SolidgearError
from solidgear.show.command import command
from solidgear.show.options import Shown
from solidgear.show.sheet import present
from solidgear.strength.acting import Acting
from solidgear.teeth.study import FACTORS
from solidgear.teeth.study import contact as solved
from solidgear.teeth.train_teeth import TeethModel
from solidgear.trains.options import TrainFile


class TeethName(StrEnum):
    """Models of the teeth."""

    slices = "slices"
    solid = "solid"


#: most slices and positions that are of any use
MOST_SLICES, MOST_POSITIONS = 200, 256


@command
def contact(
    train: TrainFile,
    *,
    acting: Acting,
    teeth: Annotated[
        TeethName,
        typer.Option("--teeth", help="Model of the teeth: slices (plane), or solid (3D)."),
    ] = TeethName.slices,
    slices: Annotated[
        int, typer.Option("--slices", help="Slices of the face.")
    ] = TeethModel.slices,
    positions: Annotated[
        int, typer.Option("--positions", help="Positions of a mesh cycle.")
    ] = TeethModel.positions,
    curve: Annotated[
        bool,
        typer.Option("--curve/--no-curve", help="Solve further torques as well, for the curves."),
    ] = True,
    judge: Annotated[
        bool,
        typer.Option(
            "--judge",
            help="Solve the teeth by the norm, slices and in 3D, and say which is enough.",
        ),
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for a page, charts and the mesh cycle."),
    ] = None,
    run: Shown,
) -> None:
    for option, value, least, most in (
        ("--slices", slices, 4, MOST_SLICES),
        ("--positions", positions, 8, MOST_POSITIONS),
    ):
        if not least <= value <= most:
            raise SolidgearError(f"{option} {value}: give {least} to {most}")
    acting.refuse_load(train)
    present(
        lambda progress: solved(
            train,
            acting.point,
            torque=acting.torque,
            of=acting.of,
            weight=acting.weight,
            model=TeethModel(teeth.value, slices, positions),
            factors=FACTORS if curve else (),
            judge=judge,
            progress=progress,
        ).sheet(run.units),
        run,
        out,
    )
