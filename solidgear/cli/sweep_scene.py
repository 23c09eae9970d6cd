"""The command sweep on entries of a scene file."""

from __future__ import annotations

from pathlib import Path

from solidgear.cli.app import say
from solidgear.cli.shared import Chosen, Run, options
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
from solidgear.report.sweep_chart import sweep_table
from solidgear.studies.sweep.scene_run import SceneSummary
from solidgear.studies.sweep.scene_run import sweep_scene as swept


def sweep_scene(
    scene: Path, vary: list[str], rows: Rows, model: Chosen, chart: Path | None, run: Run
) -> None:
    """Sweep entries of a scene and tell of it."""
    checked_chart(chart)
    automatic = model.automatic()
    with rows.counted(run.as_json) as (show, tell):
        found = swept(
            scene,
            rows.design(vary),
            model=None if automatic else str(model.name),
            tolerance=model.tol,
            options={} if automatic else options(model.pairs),
            charted=chart is not None,
            progress=show,
            tell=tell,
            **rows.how,
        )
    written = drawn(found.curves, scene.stem, f"Rows in {found.path.name}.", chart)
    if run.as_json:
        print(record_of(found))
        ended_rows(found)
        return
    if found.curves is not None and len(found.curves.x) <= FEW and found.curves.frequencies:
        say(sweep_table(found.curves))
    say(rows_there(found), *_work(found), *refusals(found), *written)
    ended_rows(found)


def _work(found: SceneSummary) -> list[str]:
    """Sentences on what was done in this run, and how sure the rows are."""
    new, lines = found.total - found.skipped, []
    if new:
        lines.append(
            "The shaft varies: every variant is meshed and solved for itself. "
            f"{new} variants in {found.seconds:.1f} s, {1e3 * found.seconds / new:.0f} ms each; "
            f"{found.refused} refused."
        )
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
