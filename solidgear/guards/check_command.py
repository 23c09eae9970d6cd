"""The command check: verdicts, faults and cautions of a shaft or a train."""

from __future__ import annotations

from solidgear.guards.check_study import check as checked
from solidgear.show.command import command
from solidgear.show.options import CaseName, Fixed, Run, SceneFile, options
from solidgear.show.sheet import present


@command
def check(
    scene: SceneFile,
    *,
    model: Fixed,
    case: CaseName = None,
    run: Run,
) -> None:
    settings = options(model.settings)
    present(lambda _: checked(scene, model.name, settings, case=case).sheet(), run)
