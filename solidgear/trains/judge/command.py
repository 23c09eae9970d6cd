"""A train judged like a shaft: compare on a train file, and judge-system."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import Progress, command
from solidgear.show.options import Shown, refuse
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import units_named
from solidgear.trains.judge.sheet import drawn_sheet
from solidgear.trains.judge.study import judge as judged
from solidgear.trains.options import Reduced, TrainFile, mix


@command
def judge_system(
    train: TrainFile,
    *,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder for the report, as for compare.")
    ] = None,
    against: Annotated[
        list[str] | None,
        typer.Option(
            "--against", help="Further mix of models to judge, as PINION+GEAR; repeatable."
        ),
    ] = None,
    reduced: Reduced,
    run: Shown,
) -> None:
    more = [mix(text) for text in against or []]
    _judged(train, out, reduced, run, more, renders=True)


def compare_train(
    train: Path,
    out: Path,
    tol: float | None,
    renders: bool,
    run: Shown,
    options: dict[str, bool],
) -> None:
    """Compare models of a train.

    Parameters
    ----------
    options : dict of str to bool
        Options of compare that speak of one shaft, and whether they were given.
    """
    instead = (
        "every mix of its models is judged; add further ones by solidgear judge-system --against"
    )
    refuse(options, f"one shaft, and {train} is a train: {instead}")
    _judged(train, out, Reduced(tol=tol), run, renders=renders)


def _judged(
    train: Path,
    out: Path | None,
    reduced: Reduced,
    run: Shown,
    more: Sequence[tuple[str, ...]] = (),
    *,
    renders: bool,
) -> None:
    def study(progress: Progress) -> Sheet:
        comparison = judged(train, more, progress=progress, **reduced.words)
        if out is None:
            return comparison.sheet(run.units)
        progress("report")
        return drawn_sheet(comparison, units_named(run.units), out, renders)

    present(study, run, out)
