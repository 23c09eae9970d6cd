"""Command ``sweep``: one body, many bearing sets; or many variants of the file of a shaft or train."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core.errors import SolidgearError
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.scene.toml_file import is_train, parse
from solidgear.guards.check import cautions
from solidgear.show.arguments import load
from solidgear.show.command import Progress as Steps
from solidgear.show.command import caution, command, say
from solidgear.show.options import AUTO, MODEL, Chosen, Run, options, refuse, relative
from solidgear.show.settled import ended, over_the_sweep
from solidgear.trains.assembly.shaft import JUDGE, mix_label
from solidgear.trains.options import Pair, Reduced, of_shafts
from solidgear.variants.sweep.bearing_sweep import sweep as swept
from solidgear.variants.sweep.bearing_variants import BearingVariants, bearing_variants
from solidgear.variants.sweep.chart import sweep_table
from solidgear.variants.sweep.choice import bars_of_rows, settled_for_sweep
from solidgear.variants.sweep.file_task import Swept
from solidgear.variants.sweep.rows_command import (
    FEW,
    Rows,
    Told,
    checked_chart,
    drawn,
    ended_rows,
    record_of,
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
    told: Told,
    reduced: Reduced,
    run: Run,
) -> None:
    if is_train(scene):
        of_shaft = {
            "--model": model.name != AUTO,
            "--tol": model.tol is not None,
            "--tolerance": tolerance != TOLERANCE,
        }
        instead = "its models are those of --pinion and --gear"
        refuse(of_shaft, f"one shaft, and {scene} is a train: {instead}")
        _sweep_train(scene, vary or [], rows, pair, model.pairs, told, reduced, run)
        return
    of_train = {
        "--pinion": pair.pinion != MODEL,
        "--gear": pair.gear != MODEL,
        "--shaft": bool(pair.shafts),
        "--mesh": bool(told.mesh),
        "--ask": bool(told.ask),
        "--every-point": told.every_point,
        **reduced.given,
    }
    refuse(of_train, f"a train, and {scene} is the scene of one shaft")
    if not (rows.of_files or told.chart):
        variants = bearing_variants(scene, vary or [], rows.sample, rows.seed)
        if variants is not None:
            _sweep_shaft(variants, rows, model, tolerance, run)
            return
    if tolerance != TOLERANCE:
        raise SolidgearError("--tolerance is that of one body for many bearing sets; give --tol")
    _sweep_entries(scene, vary or [], rows, model, told.chart, run)


def _sweep_shaft(
    variants: BearingVariants, rows: Rows, model: Chosen, tolerance: float, run: Run
) -> None:
    variants.first_sound()
    loaded = load(variants.path)
    # before a file of rows is begun
    settled = bars = None
    if model.automatic(loaded):
        with Steps(quiet=not sys.stderr.isatty()) as steps:
            settled = settled_for_sweep(variants, model.tol, progress=steps)
            steps("bars of natural frequencies")
            bars = bars_of_rows(variants, settled, rows.n or loaded.ask.modes)
        name, given = settled.rung, settled.options
    else:
        name = str(model.name)
        given = LADDER[name].checked(options(model.pairs))
    with rows.counted(run.as_json) as (show, tell):
        found = swept(
            variants,
            fidelity=name,
            options=given,
            tolerance=tolerance,
            bars=bars,
            judged_on=settled.judged_on if settled else 0,
            progress=show,
            tell=tell,
            out=rows.out,
            n=rows.n,
            jobs=rows.jobs,
            dask=rows.dask,
            overwrite=rows.overwrite,
        )
    if run.as_json:
        record = asdict(found)
        if settled is not None:
            record |= settled.as_dict()
        print(json.dumps(record, default=str))
        ended(settled)
        return
    for sentence in cautions(loaded, build(loaded.plain, "timoshenko"), name):
        print(caution(sentence), file=sys.stderr)
    new = found.total - found.skipped
    print(rows_there(found))
    if new:
        print(
            "Bearings alone vary: one body does for all, reduced to its seats.\n"
            f"{found.unknowns} unknowns with {found.seats} seats solved once in "
            f"{found.seconds_once:.1f} s; {new} variants of up to {found.basis} unknowns, "
            f"{1e3 * found.seconds_each:.1f} ms each; {found.refused} refused, {found.full} solved in full."
        )
    for sentence in refusals(found):
        print(sentence)
    if found.settling:
        print(found.settling)
    for sentence in over_the_sweep(settled):
        print(sentence)
    ended(settled)


def _sweep_entries(
    scene: Path, vary: list[str], rows: Rows, model: Chosen, chart: Path | None, run: Run
) -> None:
    """Sweep entries of a scene and tell of it."""
    checked_chart(chart)
    automatic = model.automatic()
    with rows.counted(run.as_json) as (show, tell):
        task = scene_task(
            scene,
            rows.design(vary),
            model=None if automatic else str(model.name),
            tolerance=model.tol,
            options={} if automatic else options(model.pairs),
            n=rows.n,
        )
        found = rows.made(task, chart, show, tell)
    lead = f"Rows in {found.path.name}."
    written = drawn(found.curves, scene.stem, lead, chart, found.cautions)
    if run.as_json:
        print(record_of(found, cautions=found.cautions))
        ended_rows(found)
        return
    if found.curves is not None and len(found.curves.x) <= FEW and found.curves.frequencies:
        say(sweep_table(found.curves))
    say(rows_there(found), *_work(found), *refusals(found), *written)
    say(*map(caution, found.cautions))
    ended_rows(found)


def _work(found: Swept) -> list[str]:
    """Sentences on what was done in this run, and how sure the rows are."""
    lines = []
    if found.total > found.skipped:
        lines.append(solved(found))
    bars = [
        bar / hz
        for bar, hz in zip(found.columns.get("f1_hz bar", []), found.columns["f1_hz"])
        if bar is not None and hz
    ]
    if bars:
        lines.append(f"Error bars are in columns beside the numbers; of f1 up to {max(bars):.2g}.")
    else:
        lines.append("A model that is given has no error bars; -f auto has.")
    return lines


def _sweep_train(
    train: Path,
    vary: list[str],
    rows: Rows,
    pair: Pair,
    settings: list[str],
    told: Told,
    reduced: Reduced,
    run: Run,
) -> None:
    """Sweep a train and tell of it."""
    checked_chart(told.chart)
    reduced.checked()
    mix = pair.of([*shafts_in(parse(str(train)))], train.stem)
    with rows.counted(run.as_json) as (show, tell):
        task = train_task(
            train,
            rows.design(vary),
            models=mix,
            mesh=told.mesh,
            settings=of_shafts(settings, mix),
            ask=told.ask or ASKED,
            n=rows.n,
            every_point=told.every_point,
            max_frequency=reduced.max_frequency,
            point=reduced.point,
            reduction=reduced.reduction,
            kept=reduced.kept,
            local_harmonics=reduced.harmonics,
        )
        found = rows.made(task, told.chart, show, tell)
    title = task.usual.title or task.usual.name
    made = task.bench.made if rows.jobs == 1 and rows.dask is None else None
    shafts = "" if made is None else f"{made} shafts meshed and reduced; "
    cut, curves = task.cut(found.columns), found.curves
    cautions = (*task.cautions, *_parting(found))
    written = drawn(curves, title, _lead(found, mix), told.chart, cautions)
    if run.as_json:
        print(record_of(found, bodies=made, cut=cut, title=title, cautions=cautions))
        ended_rows(found)
        return
    say(f"{title}: {mix_label(mix)}")
    if curves is not None and len(curves.x) <= FEW and (curves.mesh_force or curves.peak_hz):
        say(sweep_table(curves))
    work = []
    if found.total > found.skipped:
        work.append(f"{shafts}{solved(found)}")
    say(rows_there(found), *work, *refusals(found), *_limits(cut, told, mix))
    say(*written, *map(caution, cautions))
    ended_rows(found)


def _parting(found: Swept) -> list[str]:
    """Sentence on rows whose teeth part."""
    lowest = [hz for hz in found.columns.get(PARTS, []) if hz is not None]
    if not lowest:
        return []
    rows = "row" if len(lowest) == 1 else "rows"
    return [
        f"in {len(lowest)} {rows} of {found.total} the dynamic mesh force passes the mean one, from "
        f"{min(lowest):.0f} Hz at the lowest (column {PARTS}): the teeth part, and peaks from there on "
        "do not hold; ask solidgear nonlinear of that variant"
    ]


def _limits(cut: int, told: Told, mix: Mapping[str, str]) -> list[str]:
    """Sentences on what rows do not tell."""
    lines = []
    if cut > 0:
        lines.append(
            f"Rows have up to {MOST_MODES + cut} natural frequencies, and columns for "
            f"{MOST_MODES}: give -n {MOST_MODES + cut} for all."
        )
    if MODES in (told.ask or (MODES,)):
        meshed = JUDGE in mix.values()
        meshes = "; what the meshes leave, solidgear system-modes tells of one variant" * meshed
        lines.append(f"Column reduction_bound: what the reduction leaves, proven{meshes}.")
    return lines


def _lead(found: Swept, mix: Mapping[str, str]) -> str:
    models = mix_label(mix)
    return f"{models[0].upper()}{models[1:]}; rows in {found.path.name}."
