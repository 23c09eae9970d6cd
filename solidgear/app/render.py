"""Command ``render``: pictures of mode shapes."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import LADDER, SolidgearError, number_cautions
from solidgear.core import modes as solve
from solidgear.show.command import command
from solidgear.show.folder import prepare
from solidgear.show.options import CaseName, Choice, Fixed, SceneFile
from solidgear.show.page_parts import data_uri
from solidgear.show.remarks import load
from solidgear.show.render import Drawn, render_modes
from solidgear.show.turning import Turned, turned
from solidgear.show.viewer import Turning


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
    case: CaseName = None,
) -> None:
    if beside and not turn:
        raise SolidgearError(
            f"--beside {beside}: two models need the page of --turn; add --turn model.html"
        )
    loaded = load(scene, case)
    drawn = []
    for chosen in [model, *([Fixed(beside)] if beside not in (None, model.name) else [])]:
        body = chosen.body(loaded)
        mode_set = solve(body, loaded, max(loaded.ask.modes, 10))
        drawn.append(Drawn(body, mode_set, LADDER[chosen.name].title))
    shown = [m.name for m in drawn[0].modes.modes if turn is not None or m.name == mode]
    cautions = number_cautions(loaded, dict.fromkeys(shown), model.name)
    for sentence in cautions:
        print(f"caution: {sentence}", file=sys.stderr)
    if turn is None:
        print(render_mode(drawn[0], mode, out))
        return
    path, sentence = turn_modes(drawn, turn, loaded.title or loaded.name, mode, cautions)
    if sentence:
        print(f"caution: {sentence}", file=sys.stderr)
    print(path)


def render_mode(drawn: Drawn, name: str, path: Path) -> Path:
    """Draw one mode of one body.

    Raises
    ------
    SolidgearError
        If there is no such mode, or nothing can be drawn here (the sentence says what mends it).
    """
    job = drawn.job(name, path)
    prepare(path.parent)
    try:
        (result,) = render_modes([job])
    except OSError as error:  # the drawing process is handed its shape in a temporary file
        raise SolidgearError(
            f"--out {path}: drawing stopped ({error.strerror or error}); "
            "free some space there and in the folder for temporary files"
        ) from error
    if not result.ok:
        raise SolidgearError(result.reason)
    return result.path


def turn_modes(
    drawn: Sequence[Drawn], path: Path, title: str, name: str, cautions: Sequence[str] = ()
) -> tuple[Path, str]:
    """Write a page of all modes to turn; return its path and why it has no picture for print."""
    prepare(path.parent)
    models: list[Turned] = []
    for drawing in drawn:
        drawing.job(name, path)
        models.append(turned(drawing.body, drawing.modes, drawing.title, models))
    still, sentence = "", ""
    with tempfile.TemporaryDirectory(prefix="solidgear-turn-") as folder:
        try:
            picture = render_mode(drawn[0], name, Path(folder) / "mode.png")
            still = data_uri("mode", picture) or ""
        except SolidgearError as error:
            sentence = f"no picture for print in {path.name}: {error}"
    return Turning(tuple(models), title, name, cautions).write(path, still=still), sentence
