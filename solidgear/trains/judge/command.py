"""A train judged like a shaft: compare on a train file, and judge-system."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import caution, command, say
from solidgear.show.folder import held
from solidgear.show.options import Shown, refuse
from solidgear.show.table import Column, Table, text
from solidgear.show.viewer import viewer_fragment
from solidgear.trains.judge.comparison import compare_train as compared
from solidgear.trains.modes.modes import unpublished_lines
from solidgear.trains.options import Reduced, TrainFile, mix
from solidgear.trains.page.page import write_train
from solidgear.trains.page.tables import mix_words


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
    train: Path, out: Path, renders: bool, run: Shown, options: dict[str, bool]
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
    _judged(train, out, Reduced(), run, renders=renders)


def _judged(
    train: Path,
    out: Path | None,
    reduced: Reduced,
    run: Shown,
    more: Sequence[tuple[str, ...]] = (),
    *,
    renders: bool,
) -> None:
    assembly = reduced.assembly(train)
    with held(out) if out else nullcontext(), run.progress() as progress:
        comparison = compared(assembly, reduced.max_frequency, more, progress)
        results = comparison.results()
        if out:
            progress("report")
            draw = comparison.pictures if renders else None
            viewer = viewer_fragment(comparison.turned(), first=next(iter(comparison.loud), ""))
            write_train(
                results,
                comparison.drawn,
                comparison.marks,
                comparison.orders,
                out,
                draw,
                run.units,
                viewer,
            )
    if run.as_json:
        print(json.dumps(results, allow_nan=False))
        return
    verdict = comparison.verdict
    heading = f"{verdict.train}, up to {verdict.highest_hz:g} Hz"
    say(heading, *comparison.top.sentences(), _verdict_table(verdict), soft_wrap=False)
    say(*verdict.sentences(), *unpublished_lines(verdict.unpublished))
    say(*map(caution, verdict.cautions))
    if out:
        say(f"Report: {out / 'report.html'}")


def _verdict_table(verdict):
    def end(hz: float | None) -> str:
        return f"{verdict.highest_hz:.0f}+" if hz is None else f"{hz:.0f}"

    def off(mix) -> str:
        if mix.error is None:
            return f"{mix.mode} gone" if mix.mode else ""
        digits = 1 if abs(mix.error) < 0.0995 else 0
        return f"{mix.mode} {100 * mix.error:+.{digits}f} %"

    columns = [
        text(" + ".join(verdict.mixes[0].models), lambda m: mix_words(m.mix)),
        Column(f"modes\n{100 * verdict.tolerance:g} %", lambda m: end(m.modes_to_hz)),
        Column(f"force\n{verdict.decibels:g} dB", lambda m: end(m.force_to_hz)),
        Column(f"force\n{100 * verdict.tolerance:g} %", lambda m: end(m.close_to_hz)),
        text("first mode off", off),
        text("by", lambda m: m.cause),
        Column("s", lambda m: f"{m.seconds:.1f}"),
    ]
    return Table("Within the tolerance up to, in Hz", columns, verdict.mixes, style="bare")
