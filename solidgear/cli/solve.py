"""Commands on one scene: compare, modes, render, check."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from solidgear.cli.app import caution, command, say
from solidgear.cli.settled import (
    bar_lines,
    beyond,
    ended,
    heading,
    unjudged,
    without_bar,
)
from solidgear.cli.shared import (
    MODEL,
    Choice,
    Fixed,
    Run,
    SceneFile,
    Shown,
    Solved,
    options_by_name,
)
from solidgear.elements import ELEMENTS
from solidgear.errors import SolidgearError, listed, show
from solidgear.ladder.registry import LADDER


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
    """Solve a scene with every model and write a report on which to trust; a train as well, or two
    of a kind beside each other.
    """
    from solidgear.scene.toml_file import is_train

    of_one_shaft = {
        "--models": models != ",".join(LADDER.names),
        "--solid-element": bool(solid_element),
        "--set": bool(settings),
        "--chart": chart,
    }
    if more:
        from solidgear.cli.two_files import compare_two

        compare_two([scene, *more], out, (pinion, gear), run, of_one_shaft)
        return
    for option, given in (("--pinion", pinion), ("--gear", gear)):
        if given:
            raise SolidgearError(
                f"{option} is for two trains, and {scene} is one file: every model of it is solved"
            )
    if is_train(scene):
        from solidgear.cli.train_judge import compare_train

        compare_train(scene, out, renders, run, of_one_shaft)
        return
    from solidgear.report.folder import held
    from solidgear.studies.comparison import check_models
    from solidgear.studies.comparison import compare as compared
    from solidgear.studies.loading import load

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
            from solidgear.cli.chart import run_chart

            run_chart(loaded, out, quiet=run.as_json)
    if run.as_json:
        print(json.dumps(found.results, allow_nan=False))
    else:
        from solidgear.report.terminal import closing_lines, final_table, verdict_text

        say(final_table(found.record), verdict_text(found.record), soft_wrap=False)
        say(*closing_lines(found.record), f"Report: {out / 'report.html'}")
    if not found.record.complete:
        raise typer.Exit(130)
    if not found.solutions:
        raise typer.Exit(1)


#: rows of a list whose beginning has left the terminal
MANY = 30


@command
def modes(
    scene: SceneFile,
    *,
    model: Solved,
    n: Annotated[
        int | None, typer.Option("-n", help="Number of elastic shapes; twins count twice.")
    ] = None,
    max_frequency: Annotated[float | None, typer.Option(help="Hz; leave out modes above.")] = None,
    count: Annotated[
        bool,
        typer.Option(
            "--count", help="Prove by the inertia of a second factor that no mode was missed."
        ),
    ] = False,
    run: Run,
) -> None:
    """Natural frequencies on the bearings, with the evidence for them."""
    from solidgear.cli.reading import load
    from solidgear.judge.completeness import cut_short
    from solidgear.judge.settle import bars_of_modes
    from solidgear.scene.rules import MOST_MODES
    from solidgear.solve.modes import modes as solve
    from solidgear.studies.budget import beside
    from solidgear.studies.check import cautions

    if max_frequency is not None and not max_frequency > 0:
        raise SolidgearError(f"--max-frequency {max_frequency:g}: must be greater than zero, in Hz")
    if n is not None and not 1 <= n <= MOST_MODES:
        raise SolidgearError(
            f"-n {show(n)} is not a number of modes that can be asked for; give 1 to {MOST_MODES}"
        )
    loaded = load(scene)
    body, settled = model.body(loaded, "modes")
    found = solve(
        body,
        loaded,
        loaded.ask.modes if n is None else n,
        max_frequency=max_frequency or loaded.ask.max_frequency,
        count=count,
    )
    bars = bars_of_modes(loaded, body, found, settled)
    said = cautions(loaded, body)
    open_ = beside(loaded)
    asked = n or loaded.ask.modes, max_frequency or loaded.ask.max_frequency
    said += cut_short(found.modes, *asked, option="-n")
    rows = [
        {
            "name": m.name,
            "family": m.family,
            "frequency_hz": m.frequency_hz,
            "multiplicity": m.multiplicity,
            "error": m.error,
            "bar": bars.get(m.name),
        }
        for m in found.modes
    ]
    if run.as_json:
        record = {
            "scene": loaded.name,
            "fidelity": body.fidelity,
            "dofs": body.size,
            "modes": rows,
            "evidence": found.evidence,
            "cautions": said,
            "open": open_.model_dump(mode="json"),
        }
        if settled is not None:
            record |= settled.as_dict() | {"without_bar": without_bar(found, bars)}
        print(json.dumps(record, default=float))
        ended(settled)
        return
    from solidgear.report.terminal import modes_table
    from solidgear.report.words import by_plane
    from solidgear.solve.mixtures import mixtures

    say(heading(loaded, body, settled), modes_table(rows, bars, open_), soft_wrap=False)
    if len(rows) > MANY:
        shapes = sum(m.multiplicity for m in found.modes)
        say(f"{shapes} shapes up to {found.frequency_hz[-1]:.6g} Hz.")
    planes = by_plane(found.names)
    if planes:
        say(planes.strip())
    e = found.evidence
    say(
        f"Residual {e['residual']:.1e}, orthogonality {e['orthogonality']:.1e}, rigid modes "
        f"{e['rigid_modes']}, {e['method']} on {e['backend']}.",
        soft_wrap=False,
    )
    for one, other, gap in e.get("torn_pairs", []):
        say(
            f"caution: {one} and {other} are twins that the mesh has split by {gap:.1e}: refine "
            "it, or use hexahedra or the harmonic model.",
            soft_wrap=False,
        )
    say(*(f"caution: {mixture.sentence}." for mixture in mixtures(found)))
    if e["error"] > 1e-6:
        say(
            f"caution: rounding leaves frequencies good to {e['error']:.0e} only: the smallest "
            "cells are that stiff beside the shaft; a coarser mesh has less of it.",
            soft_wrap=False,
        )
    if count:
        from solidgear.judge.completeness import completeness

        say(completeness(e, body.fidelity), soft_wrap=False)
    lines = bar_lines(settled)
    if settled is None:
        lines.append("No bars: the model was given, and its mesh with it; -f auto has them.")
    if bars:
        lines += unjudged(without_bar(found, bars), body.fidelity)
    lines += beyond(bars, settled)
    say(*lines)
    say(*map(caution, said), soft_wrap=False)
    ended(settled)


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
    """Draw one mode shape off-screen, or all of them in a page where they can be turned."""
    from solidgear.cli.reading import load
    from solidgear.report.write import Drawn, render_mode, turn_modes
    from solidgear.solve.modes import modes as solve

    if beside and not turn:
        raise SolidgearError(
            f"--beside {beside}: two models need the page of --turn; add --turn model.html"
        )
    loaded = load(scene)
    drawn = []
    for one in [model, *([Fixed(beside)] if beside not in (None, model.name) else [])]:
        body = one.body(loaded)
        found = solve(body, loaded, max(loaded.ask.modes, 10))
        drawn.append(Drawn(body, found, LADDER[one.name].title))
    if turn is None:
        print(render_mode(drawn[0].body, drawn[0].modes, mode, out, drawn[0].title))
        return
    path, said = turn_modes(drawn, turn, loaded.title or loaded.name, mode)
    if said:
        print(f"caution: {said}", file=sys.stderr)
    print(path)


@command
def check(
    scene: SceneFile,
    *,
    model: Fixed,
    run: Run,
) -> None:
    """Say what will be modelled and what will not hold, of a scene or a train; a light mesh is the
    heaviest solved.
    """
    from solidgear.scene.toml_file import is_train

    if is_train(scene):
        from solidgear.cli.checked import check_train

        given = {"--model": model.name != MODEL, "--set": bool(model.settings)}
        check_train(scene, run.as_json, given)
        return
    from solidgear.cli.checked import print_check
    from solidgear.ladder import build
    from solidgear.ladder.meshes import HARMONIC
    from solidgear.studies.check import check_scene
    from solidgear.studies.loading import load

    loaded = load(scene)
    # a model of revolution is looked at on the plain part, and the check says so
    shown = loaded.plain if LADDER[model.name].unfit(loaded) else loaded
    light = model.name == MODEL and not model.settings
    found = check_scene(loaded, build(shown, MODEL, **HARMONIC) if light else model.body(shown))
    if run.as_json:
        print(json.dumps(found, default=float))
    else:
        print_check(found)
    if found["faults"]:
        raise typer.Exit(1)
