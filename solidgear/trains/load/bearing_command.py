"""The command bearing: catalogue bearings of a shaft under its load, or of a train over its
operating points.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import Progress, command
from solidgear.show.options import CaseName, Run, SceneFile
from solidgear.show.plot import check_ending
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import ENGINEERING
from solidgear.trains.load.bearing import bearing as solve
from solidgear.trains.load.bearing import bearings_sheet


@command
def bearing(
    scene: SceneFile,
    *,
    load: Annotated[
        str | None,
        typer.Option(
            "--load",
            help='Another load, such as "x=2 kN, z=-500 N, thx=10 N*m", on the port or the bearing '
            "of --bearing.",
        ),
    ] = None,
    name: Annotated[
        str | None, typer.Option("--bearing", help="Only this bearing, under --load.")
    ] = None,
    speed: Annotated[
        str | None,
        typer.Option("--speed", help='Speed of the shaft, such as "3000 rpm".'),
    ] = None,
    case: CaseName = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Chart of stiffness over load: a file that ends in .png or .svg."
        ),
    ] = None,
    run: Run,
) -> None:
    if out is not None:
        check_ending(out)

    def study(_: Progress) -> Sheet:
        solved = solve(scene, name, load=load, speed=speed, case=case)
        if out is not None:
            solved.draw(out)
        return bearings_sheet(solved, ENGINEERING, out)

    present(study, run)
