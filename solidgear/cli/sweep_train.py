"""The command sweep on a train."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from solidgear.cli.app import Group, caution, say
from solidgear.cli.shared import Run
from solidgear.cli.sweep_rows import (
    FEW,
    Rows,
    checked_chart,
    drawn,
    ended_rows,
    record_of,
    refusals,
    rows_there,
)
from solidgear.cli.train_options import Pair, Reduced, of_shafts
from solidgear.report.sweep_chart import sweep_table
from solidgear.scene.toml_file import parse
from solidgear.studies.sweep.train_run import TrainSummary
from solidgear.studies.sweep.train_run import sweep_train as swept
from solidgear.studies.sweep.train_task import ASKED, MODES, MOST_MODES
from solidgear.studies.sweep.train_variants import shafts_in
from solidgear.studies.train.shaft import JUDGE, told_mix


@dataclass(frozen=True)
class Told(Group):
    """Numbers that rows of a train tell."""

    ask: Annotated[
        list[str] | None,
        typer.Option(
            "--ask",
            help="Of a train: what rows tell, system-modes, response or deflect; repeatable, all by "
            "default.",
        ),
    ] = None
    every_point: Annotated[
        bool, typer.Option("--every-point", help="Of a train: a row for each operating point.")
    ] = False
    mesh: Annotated[
        str | None,
        typer.Option(
            "--mesh", help="Of a train: whose transmission error drives it, of several; the first."
        ),
    ] = None
    chart: Annotated[
        Path | None,
        typer.Option(
            "--chart",
            help="Curves over the number that varies, as .png, .svg or .html.",
        ),
    ] = None


def sweep_train(
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
        found = swept(
            train,
            rows.design(vary),
            models=mix,
            mesh=told.mesh,
            settings=of_shafts(settings, mix),
            ask=told.ask or ASKED,
            every_point=told.every_point,
            charted=told.chart is not None,
            max_frequency=reduced.max_frequency,
            point=reduced.point,
            reduction=reduced.reduction,
            kept=reduced.kept,
            local_harmonics=reduced.harmonics,
            progress=show,
            tell=tell,
            **rows.how,
        )
    curves = found.curves
    written = drawn(curves, found.title, _lead(found, mix), told.chart, found.cautions)
    if run.as_json:
        print(record_of(found))
        ended_rows(found)
        return
    say(f"{found.title}: {told_mix(mix)}")
    if curves is not None and len(curves.x) <= FEW and (curves.mesh_force or curves.peak_hz):
        say(sweep_table(curves))
    say(rows_there(found), *_work(found), *refusals(found), *_limits(found, told, mix), *written)
    say(*map(caution, found.cautions))
    ended_rows(found)


def _work(found: TrainSummary) -> list[str]:
    """Sentence on what was done in this run."""
    new = found.total - found.skipped
    if not new:
        return []
    shafts = "" if found.bodies is None else f"{found.bodies} shafts meshed and reduced; "
    return [
        f"{shafts}{new} variants in {found.seconds:.1f} s, {1e3 * found.seconds / new:.0f} ms each; "
        f"{found.refused} refused."
    ]


def _limits(found: TrainSummary, told: Told, mix: Mapping[str, str]) -> list[str]:
    """Sentences on what rows do not tell."""
    lines = []
    if found.cut > 0:
        lines.append(
            f"Rows have up to {MOST_MODES + found.cut} natural frequencies, and columns for "
            f"{MOST_MODES}: give -n {MOST_MODES + found.cut} for all."
        )
    if MODES in (told.ask or (MODES,)):
        meshed = JUDGE in mix.values()
        meshes = "; what the meshes leave, solidgear system-modes tells of one variant" * meshed
        lines.append(f"Column error_bound: what the reduction leaves, proven{meshes}.")
    return lines


def _lead(found: TrainSummary, mix: Mapping[str, str]) -> str:
    models = told_mix(mix)
    return f"{models[0].upper()}{models[1:]}; rows in {found.path.name}."
