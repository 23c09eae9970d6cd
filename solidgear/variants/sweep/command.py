"""Command ``sweep``: bearing sets on one body, or variants of the file of a shaft or train."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import LADDER, SolidgearError, build, is_train, parse
from solidgear.core.plain import plain
from solidgear.guards.check import cautions
from solidgear.show.arguments import load
from solidgear.show.command import Progress as Steps
from solidgear.show.command import caution, command, say
from solidgear.show.options import AUTO, MODEL, Chosen, Run, options, refuse, relative
from solidgear.show.settled import ended, over_the_sweep
from solidgear.trains.assembly.shaft import JUDGE, mix_label
from solidgear.trains.options import Pair, Reduced, of_shafts
from solidgear.variants.sweep.bearing_task import bearing_task
from solidgear.variants.sweep.bearing_variants import BearingVariants, bearing_variants
from solidgear.variants.sweep.chart import sweep_table
from solidgear.variants.sweep.choice import bars_of_rows, settled_for_sweep
from solidgear.variants.sweep.file_task import Swept
from solidgear.variants.sweep.rows_command import (
    FEW,
    OfTrain,
    Rows,
    check_chart,
    draw_chart,
    end_rows,
    refusals,
    rows_there,
    solved,
)
from solidgear.variants.sweep.scene_task import scene_task
from solidgear.variants.sweep.train_task import ASKED, MODES, MOST_MODES, PARTS, train_task
from solidgear.variants.sweep.train_variants import shafts_in

#: relative, of frequencies of a shaft
TOLERANCE = 1e-6


@command
def sweep(
    scene: Annotated[
        Path,
        typer.Argument(
            help="Scene or train file (TOML), such as geometry/pinion_overhung.toml; - for standard "
            "input."
        ),
    ],
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            help="PATH=VALUES, repeatable: any entry of the file, such as segment.neck.diameter, "
            "bearing.A.seat_width, mesh.stiffness, pinion.bearing.2.position; PATH+PATH gives several "
            "one value. Where springs (bearing.NAME.kxx, bearing.NAME.scale for all of it, housing.kxx) "
            "and positions of bearings of a shaft vary alone, one body does for all. "
            'VALUES: FROM:TO:COUNT, log:FROM:TO:COUNT or A,B,C, such as "0.2 m:0.24 m:9".',
        ),
    ] = None,
    rows: Rows,
    model: Chosen,
    tolerance: Annotated[
        float,
        relative(
            "--tolerance", "Relative error of frequencies; checked by a bound for every variant."
        ),
    ] = TOLERANCE,
    pair: Pair,
    train_rows: OfTrain,
    reduced: Reduced,
    run: Run,
) -> None:
    if is_train(scene):
        of_shaft = {
            "--model": model.name != AUTO,
            "--tol": model.tol is not None,
            "--tolerance": tolerance != TOLERANCE,
        }
        models = "its models are those of --pinion and --gear"
        refuse(of_shaft, f"one shaft, and {scene} is a train: {models}")
        _sweep_train(scene, vary or [], rows, pair, model.pairs, train_rows, reduced, run)
        return
    of_train = {
        "--pinion": pair.pinion != MODEL,
        "--gear": pair.gear != MODEL,
        "--shaft": bool(pair.shafts),
        "--mesh": bool(train_rows.mesh),
        "--ask": bool(train_rows.ask),
        "--every-point": train_rows.every_point,
        **reduced.given,
    }
    refuse(of_train, f"a train, and {scene} is the scene of one shaft")
    if not (rows.of_files or train_rows.chart):
        variants = bearing_variants(scene, vary or [], rows.sample, rows.seed)
        if variants is not None:
            _sweep_bearings(variants, rows, model, tolerance, run)
            return
    if tolerance != TOLERANCE:
        raise SolidgearError("--tolerance is that of one body for many bearing sets; give --tol")
    _sweep_scene(scene, vary or [], rows, model, train_rows.chart, run)


def _sweep_bearings(
    variants: BearingVariants, rows: Rows, model: Chosen, tolerance: float, run: Run
) -> None:
    variants.first_sound()
    scene = load(variants.path)
    # before a file of rows is begun
    settled = bars = None
    if model.automatic(scene):
        with Steps(quiet=not sys.stderr.isatty()) as steps:
            settled = settled_for_sweep(variants, model.tol, progress=steps)
            steps("bars of natural frequencies")
            bars = bars_of_rows(variants, settled, rows.n or scene.ask.modes)
        name, builder_options = settled.rung, settled.options
    else:
        name = str(model.name)
        builder_options = LADDER[name].checked(options(model.pairs))
    task = bearing_task(
        variants,
        model=name,
        options=builder_options,
        n=rows.n,
        tolerance=tolerance,
        bars=bars,
        judged_on=settled.judged_on if settled else 0,
    )
    result = rows.run(task, run.as_json)
    if run.as_json:
        record = plain(result)
        if settled is not None:
            record |= settled.as_dict()
        print(json.dumps(record, default=str))
        ended(settled)
        return
    for sentence in cautions(scene, build(scene.plain, "timoshenko"), name):
        print(caution(sentence), file=sys.stderr)
    print(rows_there(result))
    new = result.total - result.skipped
    if new:
        print(
            "Bearings alone vary: one body does for all, reduced to its seats.\n"
            f"{result.unknowns} unknowns with {result.seats} seats solved once in "
            f"{result.seconds_once:.1f} s; {new} variants of up to {result.basis} unknowns, "
            f"{1e3 * result.seconds_each:.1f} ms each; {result.refused} refused, "
            f"{result.full} solved in full."
        )
    sentences = [*refusals(result), result.settling, *over_the_sweep(settled)]
    for sentence in filter(None, sentences):
        print(sentence)
    ended(settled)


def _sweep_scene(
    scene: Path, vary: list[str], rows: Rows, model: Chosen, chart: Path | None, run: Run
) -> None:
    check_chart(chart)
    automatic = model.automatic()
    task = scene_task(
        scene,
        rows.design(vary),
        model=None if automatic else str(model.name),
        tolerance=model.tol,
        options={} if automatic else options(model.pairs),
        n=rows.n,
    )
    check_chart(chart, task)
    result = rows.run(task, run.as_json)
    lead = f"Rows in {result.path.name}."
    chart_lines = draw_chart(result.curves, scene.stem, lead, chart, result.cautions)
    if run.as_json:
        print(json.dumps(plain(result) | {"cautions": result.cautions}))
        end_rows(result)
        return
    curves = result.curves
    if curves is not None and len(curves.x) <= FEW and curves.frequencies:
        say(sweep_table(curves))
    say(rows_there(result))
    if result.total > result.skipped:
        say(solved(result))
    say(_sentence_on_bars(result), *refusals(result), *chart_lines)
    say(*map(caution, result.cautions))
    end_rows(result)


def _sentence_on_bars(result: Swept) -> str:
    bars = [
        bar / hz
        for bar, hz in zip(result.columns.get("f1_hz bar", []), result.columns["f1_hz"])
        if bar is not None and hz
    ]
    if not bars:
        return "A model that is given has no error bars; -f auto has."
    return f"Error bars are in columns beside the numbers; of f1 up to {max(bars):.2g}."


def _sweep_train(
    train: Path,
    vary: list[str],
    rows: Rows,
    pair: Pair,
    settings: list[str],
    train_rows: OfTrain,
    reduced: Reduced,
    run: Run,
) -> None:
    check_chart(train_rows.chart)
    reduced.checked()
    mix = pair.of([*shafts_in(parse(str(train)))], train.stem)
    task = train_task(
        train,
        rows.design(vary),
        models=mix,
        mesh=train_rows.mesh,
        settings=of_shafts(settings, mix),
        ask=train_rows.ask or ASKED,
        n=rows.n,
        every_point=train_rows.every_point,
        max_frequency=reduced.max_frequency,
        point=reduced.point,
        reduction=reduced.reduction,
        kept=reduced.kept,
        local_harmonics=reduced.harmonics,
    )
    check_chart(train_rows.chart, task)
    result = rows.run(task, run.as_json)
    title = task.usual.title or task.usual.name
    bodies = task.bench.made if rows.jobs == 1 and rows.dask is None else None
    cut, curves = task.cut(result.columns), result.curves
    sentences = (*task.cautions, *_caution_on_parting(result))
    models = mix_label(mix)
    lead = f"{models[0].upper()}{models[1:]}; rows in {result.path.name}."
    chart_lines = draw_chart(curves, title, lead, train_rows.chart, sentences)
    if run.as_json:
        more = {"bodies": bodies, "cut": cut, "title": title, "cautions": sentences}
        print(json.dumps(plain(result) | more))
        end_rows(result)
        return
    say(f"{title}: {models}")
    if curves is not None and len(curves.x) <= FEW and (curves.mesh_force or curves.peak_hz):
        say(sweep_table(curves))
    say(rows_there(result))
    if result.total > result.skipped:
        shafts = "" if bodies is None else f"{bodies} shafts meshed and reduced; "
        say(f"{shafts}{solved(result)}")
    say(*refusals(result), *_limits(cut, train_rows, mix))
    say(*chart_lines, *map(caution, sentences))
    end_rows(result)


def _caution_on_parting(result: Swept) -> list[str]:
    """Return the sentence on rows whose teeth part, if there are any."""
    lowest = [hz for hz in result.columns.get(PARTS, []) if hz is not None]
    if not lowest:
        return []
    rows = "row" if len(lowest) == 1 else "rows"
    return [
        f"in {len(lowest)} {rows} of {result.total} the dynamic mesh force passes the mean one, from "
        f"{min(lowest):.0f} Hz at the lowest (column {PARTS}): the teeth part, and peaks from there on "
        "do not hold; ask solidgear nonlinear of that variant"
    ]


def _limits(cut: int, train_rows: OfTrain, mix: Mapping[str, str]) -> list[str]:
    """Return sentences on numbers that rows do not have."""
    lines = []
    if cut > 0:
        lines.append(
            f"Rows have up to {MOST_MODES + cut} natural frequencies, and columns for "
            f"{MOST_MODES}: give -n {MOST_MODES + cut} for all."
        )
    if MODES in (train_rows.ask or (MODES,)):
        meshes = ""
        if JUDGE in mix.values():
            meshes = "; what the meshes leave, solidgear system-modes tells of one variant"
        lines.append(f"Column reduction_bound: what the reduction leaves, proven{meshes}.")
    return lines
