"""The command bearing: catalogue bearings of a shaft under its load, or of a train over its
operating points.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.bearings.chart import draw_bearings
from solidgear.bearings.sheet import scene_sheet, train_sheet
from solidgear.bearings.study import bearing_facts, loaded_by, over_load
from solidgear.core import SolidgearError, as_written, explained, is_train, shaft
from solidgear.show.command import Progress, command
from solidgear.show.options import Run, SceneFile, speed_of
from solidgear.show.plot import check_ending
from solidgear.show.sheet import Sheet, present


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
        typer.Option("--speed", help='Speed of the shaft, such as "3000 rpm", for lives in hours.'),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Chart of stiffness over load: a file that ends in .png or .svg."
        ),
    ] = None,
    run: Run,
) -> None:
    def study(_: Progress) -> Sheet:
        if not is_train(scene):
            return _shaft(scene, load, name, speed, out)
        for option, value in {"--load": load, "--speed": speed, "--out": out}.items():
            if value:
                raise SolidgearError(
                    f"{option} belongs to a scene; for a train give torque and speed in [operation]"
                )
        return _train(scene, name)

    present(study, run)


def _shaft(
    file: Path, load: str | None, name: str | None, speed: str | None, chart: Path | None
) -> Sheet:
    """Solve the bearings of a shaft, or one of them, and draw the chart that is asked for."""
    if chart is not None:
        check_ending(chart)
    turns = speed_of(speed)
    scene = as_written(file)
    if load is not None:
        scene = loaded_by(scene, load, name)
    with explained(file):
        body = shaft(scene)
        facts = [f for f in bearing_facts(scene, body, turns) if name in (None, f.name)]
        if not facts:
            raise SolidgearError(f"--bearing {name}: no bearing of catalogue data has this name")
        if chart is not None:
            draw_bearings(chart, facts, over_load(scene, body))
    return scene_sheet(scene.name, facts, chart)


def _train(file: Path, name: str | None) -> Sheet:
    """Solve the bearings of a train, or one of them."""
    # start-up: bearings of a shaft have no use for the equilibrium of trains
    from solidgear.trains.load.lives import train_lives
    from solidgear.trains.loading import load_train

    lives = [life for life in train_lives(load_train(file)) if name in (None, life.name)]
    if not lives:
        raise SolidgearError(
            f"--bearing {name}: no bearing of catalogue data has this name; write shaft and name, "
            "such as pinion.A"
        )
    return train_sheet(file.stem, lives)
