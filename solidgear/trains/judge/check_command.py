"""The command check: verdicts, faults and cautions of a shaft or a train."""

from __future__ import annotations

from pathlib import Path

from solidgear.core import HARMONIC, LADDER, build, is_train, load
from solidgear.guards.check import Check, check_scene
from solidgear.guards.sheet import check_sheet
from solidgear.show.command import command
from solidgear.show.options import MODEL, Fixed, Run, SceneFile, refuse
from solidgear.show.sheet import present


@command
def check(
    scene: SceneFile,
    *,
    model: Fixed,
    run: Run,
) -> None:
    checked = _train if is_train(scene) else _shaft
    present(lambda _: check_sheet(checked(scene, model)), run)


def _shaft(file: Path, model: Fixed) -> Check:
    """Check one shaft; a model of revolution is looked at on the plain part, and the check says so."""
    scene = load(file)
    part = scene.plain if LADDER[model.name].unfit(scene) else scene
    light = model.name == MODEL and not model.settings
    return check_scene(scene, build(part, MODEL, **HARMONIC) if light else model.body(part))


def _train(file: Path, model: Fixed) -> Check:
    """Check a train; refuse options of one shaft."""
    # start-up: a shaft has no use for the studies of trains
    from solidgear.trains.judge.check import check_train
    from solidgear.trains.options import Reduced

    instead = "for other models and meshes run check on the file of a shaft"
    given = {"--model": model.name != MODEL, "--set": bool(model.settings)}
    refuse(given, f"one shaft, and {file} is a train: {instead}")
    return check_train(Reduced().assembly(file, solves_teeth=False))
