"""Command ``optimise``: search for the entries of a scene that reach a goal best."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import NOT_REACHED, command, say
from solidgear.show.folder import held
from solidgear.show.options import AUTO, BY_MODEL, AutoChoice, Run, relative
from solidgear.variants.optimise.optimise import optimise as optimised
from solidgear.variants.optimise.tables import designs, write_optimum


@command
def optimise(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary", help='PATH=LOW:HIGH, such as "bearing.B.position=180 mm:240 mm"; repeatable.'
        ),
    ] = None,
    goal: Annotated[
        str, typer.Option("--goal", help='"max NUMBER" or "min NUMBER", such as "max bending 1".')
    ],
    keep: Annotated[
        list[str] | None,
        typer.Option(
            "--keep", help='Limit, such as "C_zz < 5 um/kN" or "mass < 12 kg"; repeatable.'
        ),
    ] = None,
    keep_sum: Annotated[
        list[str] | None,
        typer.Option("--keep-sum", help="PATH+PATH: their sum stays as in the file."),
    ] = None,
    model: Annotated[
        AutoChoice,
        typer.Option(
            *BY_MODEL, help="Model of every design; of one that is given there are no bars."
        ),
    ] = AUTO,
    tol: Annotated[
        float | None,
        relative(
            "--tol", "Bar allowed of every design; a tenth of the scene's tolerance by default."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder for a page, data, table and chart.")
    ] = None,
    run: Run,
) -> None:
    with held(out) if out else nullcontext(), run.progress() as progress:
        optimum = optimised(
            scene,
            vary or (),
            goal,
            keep or (),
            keep_sum=keep_sum or (),
            model=None if model == AUTO else str(model),
            tol=tol,
            progress=progress,
        )
        files = write_optimum(out, optimum) if out else []
    if run.as_json:
        print(json.dumps(optimum.results, allow_nan=False))
    else:
        say(optimum.scene, designs(optimum), *optimum.sentences, soft_wrap=False)
        if files:
            say(f"Written: {', '.join(map(str, files))}", soft_wrap=False)
    if optimum.best is None:
        raise typer.Exit(NOT_REACHED)
