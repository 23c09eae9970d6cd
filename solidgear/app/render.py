"""Command ``render``: pictures of mode shapes."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from solidgear.comparison.page.write import Drawn, render_mode, turn_modes
from solidgear.core import LADDER, SolidgearError
from solidgear.core import modes as solve
from solidgear.show.command import command
from solidgear.show.options import Choice, Fixed, SceneFile
from solidgear.show.remarks import load


@command
def render(
    scene: SceneFile,
    *,
    out: Annotated[Path, typer.Option("--out", "-o", help="PNG file to write.")] = Path("mode.png"),
    model: Fixed,
    mode: Annotated[
        str, typer.Option(help='Name of the mode, such as "bending 1" or "axial 1".')
    ] = "bending 1",
    turn: Annotated[
        Path | None,
        typer.Option(
            help="HTML file: all modes in 3D, to be turned, animated and cut, instead of one picture."
        ),
    ] = None,
    beside: Annotated[
        Choice | None, typer.Option(help="A second model in the page of --turn, side by side.")
    ] = None,
) -> None:
    if beside and not turn:
        raise SolidgearError(
            f"--beside {beside}: two models need the page of --turn; add --turn model.html"
        )
    loaded = load(scene)
    drawn = []
    for chosen in [model, *([Fixed(beside)] if beside not in (None, model.name) else [])]:
        body = chosen.body(loaded)
        mode_set = solve(body, loaded, max(loaded.ask.modes, 10))
        drawn.append(Drawn(body, mode_set, LADDER[chosen.name].title))
    if turn is None:
        print(render_mode(drawn[0], mode, out))
        return
    path, sentence = turn_modes(drawn, turn, loaded.title or loaded.name, mode)
    if sentence:
        print(f"caution: {sentence}", file=sys.stderr)
    print(path)
