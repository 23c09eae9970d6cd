"""A train judged like a shaft: compare on a train file, and judge-system."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import Progress, command
from solidgear.show.folder import begun
from solidgear.show.options import Shown, refuse
from solidgear.show.sheet import Sheet, present, write_json
from solidgear.show.units import units_named
from solidgear.trains.judge.comparison import Pictures
from solidgear.trains.judge.comparison import compare_train as compared
from solidgear.trains.judge.sheet import comparison_sheet, shapes
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
    reduced: Reduced,
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
    _judged(train, out, reduced, run, renders=renders)


def _judged(
    train: Path,
    out: Path | None,
    reduced: Reduced,
    run: Shown,
    more: Sequence[tuple[str, ...]] = (),
    *,
    renders: bool,
) -> None:
    assembly, units = reduced.assembly(train), units_named(run.units)

    def study(progress: Progress) -> Sheet:
        comparison = compared(assembly, reduced.max_frequency, more, progress)
        if out is None:
            return comparison_sheet(comparison, units)
        progress("report")
        with begun(out) as folder:
            # numbers first: whatever happens to pictures, they are there; without a list of files,
            # since the folder is begun again when all of it is written
            write_json(folder / "results.json", comparison.results())
            pictures = comparison.pictures(folder) if renders else Pictures()
        return comparison_sheet(comparison, units, pictures, shapes(comparison, pictures, out))

    present(study, run, out)
