"""Command ``compare``: a scene or a train by every model, or two files of a kind."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from solidgear.comparison.models import check_models
from solidgear.comparison.models import compare as compared
from solidgear.comparison.page.sheet import sheet
from solidgear.comparison.race.command import run_chart
from solidgear.comparison.two import two_shafts_page, two_trains_page
from solidgear.comparison.two.differences import differences
from solidgear.comparison.two.two_shafts import TwoShafts, two_shafts
from solidgear.comparison.two.two_trains import TwoTrains, two_trains
from solidgear.core import ELEMENTS, LADDER, SolidgearError, is_train, listed
from solidgear.core import load as read
from solidgear.show.command import Progress, caution, command, say
from solidgear.show.folder import held
from solidgear.show.options import MODEL, SceneFile, Shown, options_by_name, refuse
from solidgear.show.remarks import load
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import units_named
from solidgear.trains.assembly.shaft import checked_model
from solidgear.trains.judge.command import compare_train
from solidgear.trains.options import Pair, Reduced


@command
def compare(
    scene: SceneFile,
    more: Annotated[
        list[Path] | None,
        typer.Argument(
            help="A second scene or train, to be compared with the first.", show_default=False
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
            help="Builder option of one model as MODEL.key=value, repeatable: solid.around=32, "
            "harmonic.order=8. An option of the mesh fixes it.",
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
        typer.Option(
            "--pinion", help=f"For two trains: model of both pinions, {MODEL} by default."
        ),
    ] = None,
    gear: Annotated[
        str | None, typer.Option("--gear", help="For two trains: model of both gears, as --pinion.")
    ] = None,
    shafts: Annotated[
        list[str] | None,
        typer.Option(
            "--shaft",
            help="For two trains: model of a shaft with another name, input=euler; repeatable.",
        ),
    ] = None,
    mesh: Annotated[
        str | None,
        typer.Option(
            "--mesh",
            help="For two trains: the mesh whose transmission error drives; by default the first.",
        ),
    ] = None,
    run: Shown,
) -> None:
    of_one_shaft = {
        "--models": models != ",".join(LADDER.names),
        "--solid-element": bool(solid_element),
        "--set": bool(settings),
        "--chart": chart,
    }
    of_trains = {
        "--pinion": bool(pinion),
        "--gear": bool(gear),
        "--shaft": bool(shafts),
        "--mesh": bool(mesh),
    }
    if more:
        mix = Pair(pinion or MODEL, gear or MODEL, shafts)
        compare_two([scene, *more], out, mix, mesh, run, of_one_shaft, of_trains)
        return
    refuse(of_trains, f"two trains, and {scene} is one, of which every model is solved")
    if is_train(scene):
        compare_train(scene, out, renders, run, of_one_shaft)
        return

    loaded = read(scene)
    names = tuple(m.strip() for m in models.split(",") if m.strip())
    check_models(names)
    chosen = options_by_name(settings, LADDER.bodies, "model", "solid.around=32")
    if solid_element:
        chosen.setdefault("solid", {})["element"] = solid_element

    def study(progress: Progress) -> Sheet:
        with held(out):
            comparison = compared(loaded, names, settings=chosen, progress=progress)
            complete = comparison.record.complete
            drawn = renders and complete
            comparison.write_report(out, renders=drawn, units=run.units, progress=progress)
            if chart and complete:
                run_chart(loaded, out, progress=progress)
        exit_code = 0 if comparison.solutions else 1
        files = [f"Report: {out / 'report.html'}"]
        return sheet(comparison.record, files, exit_code if complete else 130)

    present(study, run)


#: where options of one shaft lead
TRAINS = "for two trains --pinion, --gear and --shaft choose the models"


def compare_two(
    files: list[Path],
    out: Path,
    mix: Pair,
    mesh: str | None,
    run: Shown,
    options: dict[str, bool],
    of_trains: dict[str, bool],
) -> None:
    """Compare two trains or two shafts; `options` and `of_trains` say which options of the other
    kind were given.
    """
    if len(files) > 2:
        raise SolidgearError(
            f"compare takes one file, or two scenes or two trains; {len(files)} are given"
        )
    a, b = map(str, files)
    trains = is_train(a), is_train(b)
    if trains[0] != trains[1]:
        train, shaft = (a, b) if trains[0] else (b, a)
        raise SolidgearError(
            f"{train} is a train and {shaft} one shaft: compare two trains, two shafts, or either "
            "file alone"
        )
    if trains[0]:
        refuse(options, f"one shaft, and {files[0]} is a train: {TRAINS}")
    else:
        _refuse_of_two_shafts(options | of_trains)
    if a == b or (os.path.exists(a) and os.path.exists(b) and os.path.samefile(a, b)):
        _say_same(a, b, "two trains" if trains[0] else "two shafts", run)
        return
    solve = _two_trains(a, b, mix, mesh) if trains[0] else _two_shafts(a, b)
    with held(out), run.progress() as progress:
        pair = solve(progress=progress)
        progress("report")
        pair.write_report(out, units=run.units)
    if run.as_json:
        print(json.dumps(pair.results, allow_nan=False))
        return
    units = units_named(run.units)
    if isinstance(pair, TwoTrains):
        printed = two_trains_page.printed(pair, units)
    else:
        printed = two_shafts_page.printed(pair, units)
    say(
        *(f"{train.label}, {train.title}" for train in pair.both),
        *printed,
        *map(caution, pair.cautions),
        f"Report: {out / 'report.html'}",
        soft_wrap=False,
    )


def _refuse_of_two_shafts(options: dict[str, bool]) -> None:
    for option in (option for option, is_given in options.items() if is_given):
        raise SolidgearError(
            f"{option} does not apply to two shafts: both are solved as by answer, to a tenth of "
            "their tolerance"
        )


def _say_same(a: str, b: str, kind: str, run: Shown) -> None:
    text = f"{a} is given twice" if a == b else f"{a} and {b} are one file"
    sentence = f"{text}: nothing differs, so nothing was solved."
    if run.as_json:
        print(json.dumps({"kind": kind, "differences": [], "sentences": [sentence]}))
    else:
        say(sentence)


def _two_trains(a: str, b: str, mix: Pair, mesh: str | None) -> Callable[..., TwoTrains]:
    """Return the comparison of two train files, to be run."""
    shops = [Reduced().assembly(Path(path)) for path in (a, b)]
    models = mix.by_shaft(shops[0].train)
    for model in models.values():
        checked_model(model)
    return partial(two_trains, shops, _names(a, b), differences(a, b), *models.values(), mesh=mesh)


def _two_shafts(a: str, b: str) -> Callable[..., TwoShafts]:
    """Return the comparison of two scene files, to be run."""
    scenes = [load(Path(path)) for path in (a, b)]
    return partial(two_shafts, scenes, _names(a, b), differences(a, b))


def _names(a: str, b: str) -> tuple[str, str]:
    """Return names of two files: those without folder and ending, unless they are the same."""
    short = Path(a).stem, Path(b).stem
    return short if short[0] != short[1] else (a, b)
