"""The command sweep on a train."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from solidgear.cli.app import Group, caution, say
from solidgear.cli.shaft_settings import of_shafts
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
from solidgear.cli.train_options import Pair, Reduced
from solidgear.report.sweep_chart import sweep_table
from solidgear.studies.sweep.train_run import TrainSummary
from solidgear.studies.sweep.train_run import sweep_train as swept
from solidgear.studies.sweep.train_task import ASKED, MODES, MOST_MODES
from solidgear.studies.train.shaft import JUDGE


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
    with rows.counted(run.as_json) as (show, tell):
        found = swept(
            train,
            rows.design(vary),
            pinion=pair.pinion,
            gear=pair.gear,
            settings=of_shafts(settings, {"pinion": pair.pinion, "gear": pair.gear}),
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
    written = drawn(curves, found.title, _lead(found, pair), told.chart, found.cautions)
    if run.as_json:
        print(record_of(found))
        ended_rows(found)
        return
    say(f"{found.title}: pinion {pair.pinion}, gear {pair.gear}")
    if curves is not None and len(curves.x) <= FEW and (curves.mesh_force or curves.peak_hz):
        say(sweep_table(curves))
    say(rows_there(found), *_work(found), *refusals(found), *_limits(found, told, pair), *written)
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


def _limits(found: TrainSummary, told: Told, pair: Pair) -> list[str]:
    """Sentences on what rows do not tell."""
    lines = []
    if found.cut > 0:
        lines.append(
            f"Rows have up to {MOST_MODES + found.cut} natural frequencies, and columns for "
            f"{MOST_MODES}: give -n {MOST_MODES + found.cut} for all."
        )
    if MODES in (told.ask or (MODES,)):
        meshed = JUDGE in (pair.pinion, pair.gear)
        meshes = "; what the meshes leave, solidgear system-modes tells of one variant" * meshed
        lines.append(f"Column error_bound: what the reduction leaves, proven{meshes}.")
    return lines


def _lead(found: TrainSummary, pair: Pair) -> str:
    return f"Pinion {pair.pinion}, gear {pair.gear}; rows in {found.path.name}."
