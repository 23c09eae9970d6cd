"""Command ``sensitivities``: derivatives of numbers of a shaft by the entries of its file."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import command, say
from solidgear.show.folder import held
from solidgear.show.options import Fixed, SceneFile, Shown, options
from solidgear.show.units import units_named
from solidgear.variants.sensitivity import tables as sensitivity
from solidgear.variants.sensitivity.run import sensitivities as derive


@command
def sensitivities(
    scene: SceneFile,
    *,
    of: Annotated[
        list[str] | None,
        typer.Option(
            "--of",
            help='What is to be moved, repeatable: "bending 1", C_zz, K_thx, C_zz@pinion. By default '
            "first bending and C_zz.",
        ),
    ] = None,
    by: Annotated[
        list[str] | None,
        typer.Option(
            "--by",
            help="Entries of the file, repeatable: bearing.A.position, or bearing.A for all of it. By "
            "default every number.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder for a page, charts, sensitivities.csv and JSON."),
    ] = None,
    fixed: Fixed,
    run: Shown,
) -> None:
    builder_options = options(fixed.settings)
    with held(out) if out else nullcontext(), run.progress() as progress:
        result = derive(scene, fixed.name, of, by, progress=progress, **builder_options)
        units = units_named(run.units)
        files = sensitivity.write(out, result, units) if out else []
    if run.as_json:
        print(json.dumps(result.as_dict(), allow_nan=False))
        return
    say(f"{result.title}, by the {result.model} model")
    say(*(sensitivity.table(number, units) for number in result.of))
    say(*sensitivity.notes(result), soft_wrap=False)
    if files:
        say(f"Written: {', '.join(map(str, files))}")
