"""A train judged like a shaft: compare on a train file, and judge-system."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from solidgear.cli.app import UNITS, JsonFlag, Progress, UnitsOption, command, console
from solidgear.cli.train import (
    Kept,
    LocalHarmonics,
    MaxFrequency,
    Reduction,
    TrainFile,
    caution,
    mix,
    refuse_given,
    say,
    workshop,
)


@command
def judge_system(
    train: TrainFile,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder for the report, as of compare.")
    ] = None,
    max_frequency: MaxFrequency = None,
    against: Annotated[
        list[str] | None,
        typer.Option("--against", help="Further mix to judge, as PINION+GEAR; repeatable."),
    ] = None,
    reduction: Reduction = "rubin",
    kept: Kept = 24,
    local_harmonics: LocalHarmonics = None,
    units: UnitsOption = UNITS,
    as_json: JsonFlag = False,
) -> None:
    """Comparison of a train with further mixes and reductions, and no folder unless asked for."""
    more = [mix(text) for text in against or []]
    how = max_frequency, more, reduction, kept
    _judged(train, out, as_json, *how, renders=True, local=local_harmonics, units=units)


def compare_train(
    train: Path, out: Path, as_json: bool, renders: bool, units: str, given: dict[str, bool]
) -> None:
    """The command compare on a train.

    Parameters
    ----------
    train, out : Path
    as_json, renders : bool
    units : str
    given : dict of str to bool
        Options of compare that speak of one shaft, and whether they were given.
    """
    instead = (
        "every mix of its models is judged; add further ones by solidgear judge-system --against"
    )
    refuse_given(given, train, instead)
    _judged(train, out, as_json, renders=renders, units=units)


def _judged(
    train: Path,
    out: Path | None,
    as_json: bool,
    max_frequency: float | None = None,
    more: Sequence[tuple[str, str]] = (),
    reduction: str = "rubin",
    kept: int = 24,
    renders: bool = False,
    local: str | None = None,
    units: str = UNITS,
) -> None:
    from solidgear.report.folder import held
    from solidgear.report.train_page import write_train
    from solidgear.report.viewer import viewer_fragment
    from solidgear.studies.train.comparison import compare_train as run
    from solidgear.studies.train.modes import unpublished_lines

    shop = workshop(train, reduction, kept, max_frequency, local)
    with held(out) if out else nullcontext(), Progress(quiet=as_json) as progress:
        found = run(shop, max_frequency, more, progress)
        results = found.results()
        if out:
            progress("report")
            draw = found.pictures if renders else None
            viewer = viewer_fragment(found.turned(), first=found.loudest_name)
            shown = found.drawn, found.marks, found.orders
            write_train(results, *shown, out, draw, units, viewer)
    if as_json:
        print(json.dumps(results, allow_nan=False))
        return
    verdict, terminal = found.verdict, console()
    terminal.print(f"{verdict.train}, up to {verdict.highest_hz:g} Hz", markup=False)
    terminal.print(_verdict_table(verdict))
    say(*verdict.sentences(), *unpublished_lines(verdict.unpublished))
    say(*map(caution, verdict.cautions))
    if out:
        say(f"Report: {out / 'report.html'}")


def _verdict_table(found):
    from rich.table import Table

    title = "Within the band up to, in Hz"
    table = Table(title=title, title_justify="left", box=None, padding=(0, 1, 0, 0))
    table.add_column("pinion + gear")
    for head in (
        f"modes\n{100 * found.tolerance:g} %",
        f"force\n{found.decibels:g} dB",
        f"force\n{100 * found.tolerance:g} %",
    ):
        table.add_column(head, justify="right")
    table.add_column("first mode off")
    table.add_column("by")
    table.add_column("s", justify="right")
    for one in found.mixes:
        ends = [
            f"{found.highest_hz:.0f}+" if hz is None else f"{hz:.0f}"
            for hz in (one.modes_to_hz, one.force_to_hz, one.close_to_hz)
        ]
        off = "" if not one.mode else f"{one.mode} gone"
        if one.error is not None:
            digits = 1 if abs(one.error) < 0.0995 else 0
            off = f"{one.mode} {100 * one.error:+.{digits}f} %"
        name = f"{one.pinion} + {one.gear}" if one.pinion != one.gear else f"both {one.gear}"
        table.add_row(name, *ends, off, one.cause, f"{one.seconds:.1f}")
    return table
