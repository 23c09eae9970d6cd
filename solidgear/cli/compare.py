"""Command ``compare``: a scene or a train by every model, or two files of a kind."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from solidgear.cli.app import command, say
from solidgear.cli.chart import run_chart
from solidgear.cli.shared import (
    MODEL,
    SceneFile,
    Shown,
    options_by_name,
)
from solidgear.cli.train_judge import compare_train
from solidgear.cli.two_files import compare_two
from solidgear.elements import ELEMENTS
from solidgear.errors import SolidgearError, listed
from solidgear.ladder.registry import LADDER
from solidgear.report.folder import held
from solidgear.report.terminal import closing_lines, final_table, verdict_text
from solidgear.scene.toml_file import is_train
from solidgear.studies.comparison import check_models
from solidgear.studies.comparison import compare as compared
from solidgear.studies.loading import load


@command
def compare(
    scene: SceneFile,
    more: Annotated[
        list[Path] | None,
        typer.Argument(
            help="A second file of its kind, to be held beside the first.", show_default=False
        ),
    ] = None,
    *,
    out: Annotated[
        Path,
        typer.Option(
            "--out", "-o", help="Folder for results.json, report.html, renders and vtu files."
        ),
    ] = Path("out"),
    models: Annotated[
        str,
        typer.Option("--models", help=f"Comma-separated: {','.join(LADDER.names)}."),
    ] = ",".join(LADDER.names),
    renders: Annotated[
        bool,
        typer.Option("--renders/--no-renders", help="Draw the first bending mode of every model."),
    ] = True,
    solid_element: Annotated[
        str | None, typer.Option("--solid-element", help=f"One of {listed(ELEMENTS)}.")
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            help="Builder option of one model as MODEL.key=value, repeatable: "
            "solid.around=32, harmonic.order=8. One that speaks of the mesh fixes it.",
        ),
    ] = None,
    chart: Annotated[
        bool,
        typer.Option(
            "--chart",
            help="Also chart error against cost, as a section of the report (about four minutes more).",
        ),
    ] = False,
    pinion: Annotated[
        str | None,
        typer.Option("--pinion", help=f"Of two trains: model of both pinions, {MODEL} else."),
    ] = None,
    gear: Annotated[
        str | None, typer.Option("--gear", help="Of two trains: model of both gears, as --pinion.")
    ] = None,
    run: Shown,
) -> None:
    of_one_shaft = {
        "--models": models != ",".join(LADDER.names),
        "--solid-element": bool(solid_element),
        "--set": bool(settings),
        "--chart": chart,
    }
    if more:
        compare_two([scene, *more], out, (pinion, gear), run, of_one_shaft)
        return
    for option, given in (("--pinion", pinion), ("--gear", gear)):
        if given:
            raise SolidgearError(
                f"{option} is for two trains, and {scene} is one file: every model of it is solved"
            )
    if is_train(scene):
        compare_train(scene, out, renders, run, of_one_shaft)
        return

    loaded = load(scene)
    wanted = tuple(m.strip() for m in models.split(",") if m.strip())
    check_models(wanted)
    chosen = options_by_name(settings, LADDER.bodies, "model", "solid.around=32")
    if solid_element:
        chosen.setdefault("solid", {})["element"] = solid_element
    with held(out):
        with run.progress() as progress:
            found = compared(loaded, wanted, settings=chosen, progress=progress)
            drawn = renders and found.record.complete
            found.write_report(out, renders=drawn, units=run.units, progress=progress)
        if chart and found.record.complete:
            run_chart(loaded, out, quiet=run.as_json)
    if run.as_json:
        print(json.dumps(found.results, allow_nan=False))
    else:
        say(final_table(found.record), verdict_text(found.record), soft_wrap=False)
        say(*closing_lines(found.record), f"Report: {out / 'report.html'}")
    if not found.record.complete:
        raise typer.Exit(130)
    if not found.solutions:
        raise typer.Exit(1)
