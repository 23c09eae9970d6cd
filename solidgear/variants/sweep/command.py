"""Command ``sweep``: bearing sets on one body, or variants of the file of a shaft or train.

The mesh of a sweep: the cheapest whose error bars are within a tolerance for all bearings.

The error of a mesh depends on the bearings: the stiffer they are, the more of the compliance is
the shaft's.  So the mesh is judged on the scene and at both ends of everything that varies, and the
finest that one of these needs serves all.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as ProgressBar

from solidgear.core import (
    LADDER,
    Quantity,
    SceneError,
    Settled,
    SolidgearError,
    bars_of_modes,
    build,
    is_train,
    modes,
    parse,
    settle,
)
from solidgear.core.plain import plain
from solidgear.guards.check import cautions
from solidgear.show.command import Group, caution, command, console, say
from solidgear.show.command import Progress as Steps
from solidgear.show.options import AUTO, MODEL, Chosen, Run, options, refuse, relative
from solidgear.show.plot import FORMATS, check_ending
from solidgear.show.remarks import load
from solidgear.show.settled import ended, over_the_sweep
from solidgear.show.sheet import write_sheet
from solidgear.show.units import ENGINEERING
from solidgear.trains.assembly.shaft import JUDGE, mix_label
from solidgear.trains.options import Pair, Reduced, of_shafts
from solidgear.variants.sweep.bearing_task import SweptBearings, bearing_task
from solidgear.variants.sweep.bearing_variants import BearingVariants, bearing_variants
from solidgear.variants.sweep.bench import surface
from solidgear.variants.sweep.chart import sweep_chart, sweep_table
from solidgear.variants.sweep.curves import Curves, chartable
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import FileTask, R, Swept, Task, run
from solidgear.variants.sweep.scene_task import scene_task
from solidgear.variants.sweep.train_task import ASKED, MODES, MOST_MODES, PARTS, train_task
from solidgear.variants.sweep.train_variants import shafts_in

if TYPE_CHECKING:
    from solidgear.core import Scene
    from solidgear.core.judge.refinement import Progress


#: rows that are printed on the terminal as well
FEW = 40
#: ending of a chart that is a page
PAGE = ".html"
#: reasons of refusals that are printed
REASONS = 5
#: called with the number of rows that are there, of rows in all, and the present step
ShowRows = Callable[[int, int, str], None]


@dataclass(frozen=True)
class Rows(Group):
    """Options on the rows of a sweep, their file and the processes that make them."""

    out: Annotated[
        Path,
        typer.Option(
            "--out",
            "-o",
            help="Rows, as .csv or .parquet; run again to go on where it stopped. They are kept in "
            "a database beside it (rows.csv.sqlite), from which the file is written in one step.",
        ),
    ] = Path("rows.csv")
    n: Annotated[
        int | None, typer.Option("-n", help="Number of elastic shapes; twins count twice.")
    ] = None
    sample: Annotated[
        int | None,
        typer.Option(
            "--sample", help="Draw so many points (Latin hypercube) instead of all combinations."
        ),
    ] = None
    seed: Annotated[int, typer.Option("--seed", help="Of the random sample.")] = 0
    one_at_a_time: Annotated[
        bool,
        typer.Option(
            "--one-at-a-time",
            help="The file as it is, then each value of each entry with all others as in the file.",
        ),
    ] = False
    table: Annotated[
        Path | None,
        typer.Option(
            "--table",
            help="Variants of your own, in place of --vary: a CSV file with paths as heads.",
        ),
    ] = None
    keep_sum: Annotated[
        list[str] | None,
        typer.Option(
            "--keep-sum",
            help="PATH+PATH: their sum stays as in the file; the one that does not vary gives way.",
        ),
    ] = None
    jobs: Annotated[int, typer.Option("--jobs", "-j", help="Processes on this machine.")] = 1
    dask: Annotated[
        str | None,
        typer.Option(
            "--dask", help="Address of a running Dask scheduler, such as tcp://host:8786."
        ),
    ] = None
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Discard rows that are there.")] = (
        False
    )

    def run(self, task: Task[R], silent: bool) -> R:
        """Run a task with these options, and return the result of it."""
        with self._counted(silent) as show:
            return run(
                task,
                self.out,
                jobs=self.jobs,
                dask=self.dask,
                overwrite=self.overwrite,
                progress=show,
            )

    @property
    def of_files(self) -> bool:
        """True where options are given that are for variants of files."""
        return bool(self.one_at_a_time or self.table or self.keep_sum)

    def design(self, vary: Sequence[str]) -> Design:
        """Return the entries that vary, and in which combinations."""
        return Design(
            tuple(vary),
            sample=self.sample,
            seed=self.seed,
            one_at_a_time=self.one_at_a_time,
            table=self.table,
            keep_sum=tuple(self.keep_sum or ()),
        )

    @contextmanager
    def _counted(self, silent: bool) -> Iterator[ShowRows]:
        """Show a bar of the rows that are there, on a terminal; after Ctrl-C print their number."""
        terminal = console(stderr=True)
        bar = ProgressBar(
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
            console=terminal,
            disable=silent or not terminal.is_terminal,
        )
        reached = [0, 0]
        try:
            with bar:
                line = bar.add_task("reading", total=None)

                def show(done: int, total: int, text: str) -> None:
                    reached[:] = done, total
                    bar.update(line, completed=done, total=total, description=text)

                yield show
        except KeyboardInterrupt:
            if reached[0]:
                print(
                    f"solidgear: {reached[0]} of {reached[1]} rows are kept; the same command goes "
                    "on from there",
                    file=sys.stderr,
                )
            raise


@dataclass(frozen=True)
class OfTrain(Group):
    """Options on the numbers of rows of a train."""

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


def rows_there(result: Swept | SweptBearings) -> str:
    """Return the sentence on the rows that are there."""
    path = str(result.path).encode("utf-8", "backslashreplace").decode()  # bytes that are no text
    if result.skipped == result.total:
        return f"{path}: all {result.total} rows were there already."
    before = f"; {result.skipped} more were there already" if result.skipped else ""
    return f"Wrote {result.total - result.skipped} rows to {path}{before}."


def solved(result: Swept) -> str:
    """Return the sentence on the variants of this run and their time."""
    new = result.total - result.skipped
    each = 1e3 * result.seconds / new
    return (
        f"{new} variants in {result.seconds:.1f} s, {each:.0f} ms each; {result.refused} refused."
    )


def refusals(result: Swept | SweptBearings) -> list[str]:
    """Return a sentence a reason for which variants were refused, the commonest first."""
    reasons = sorted(result.whys.items(), key=lambda why: -why[1])
    sentences = []
    for why, count in reasons[:REASONS]:
        variants = f" ({count} variants)" if count > 1 else ""
        sentences.append(f"Refused{variants}: {why}")
    if len(reasons) > REASONS:
        others = sum(count for _, count in reasons[REASONS:])
        sentences.append(f"{others} more are refused for other reasons (column status).")
    return sentences


def end_rows(result: Swept) -> None:
    """End with exit code 1 if no variant could be solved."""
    if result.refused == result.total:
        raise typer.Exit(1)


def check_chart(file: Path | None, task: FileTask | None = None) -> None:
    """Refuse a chart of an unknown format, or one of a task without curves, before the rows."""
    if file is not None:
        check_ending(file, (*FORMATS, PAGE))
        if task is not None:
            chartable(task.variants)


def draw_chart(
    curves: Curves | None, title: str, lead: str, file: Path | None, cautions: Sequence[str] = ()
) -> list[str]:
    """Draw the curves into a picture or a page, and return the sentence on it; none without a file."""
    if file is None:
        return []
    if curves is None or curves.empty:
        return ["Chart: none"]
    title = f"{title}: sweep over {curves.over}"
    if file.suffix.lower() != PAGE:
        return [f"Chart: {sweep_chart(curves, title).write(file)}"]
    charts = {"sweep": partial(sweep_chart, curves, "", ENGINEERING)}
    tables = [sweep_table(curves)]
    return [f"Chart: {write_sheet(file, title, lead, tables, charts=charts, cautions=cautions)}"]


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
            record |= plain(settled)
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


#: bearing sets, beside that of the scene, on which a mesh is judged
MOST = 8
#: modes beyond those of a row, which error bars of the last of a family need
SPARE = 6


def settled_for_sweep(
    variants: BearingVariants,
    tol: float | None = None,
    *,
    progress: Progress = lambda _: None,
) -> Settled:
    """Return the cheapest body whose error bars are within a tolerance on the scene and at the ends
    of a sweep: the finest mesh that one of these bearing sets needs, with the largest error bar of
    each quantity over all of them. The tolerance is relative, that of the scene by default.

    Examples
    --------
    >>> from solidgear.variants.sweep.bearing_variants import bearing_variants
    >>> scales = ["bearing.A.scale=log:0.1:10:9"]
    >>> variants = bearing_variants("geometry/shaft_stepped.toml", scales)
    >>> settled = settled_for_sweep(variants, 0.05)
    >>> settled.judged_on, settled.reached
    (3, True)
    """
    scenes = [variants.scene, *_ends(variants)]
    each: list[Settled] = []
    last: dict[Hashable, Settled] = {}
    for k, scene in enumerate(scenes, start=1):
        numbered = partial(_numbered, progress, k, len(scenes))
        # bearings that sit where others did are other springs on the same body
        body = surface(scene)
        last[body] = settle(scene, tol, "all", before=last.get(body), progress=numbered)
        each.append(last[body])
    finest = max(each, key=lambda settled: settled.body.size)
    bars: dict[Quantity, float] = {}
    for settled in each:
        for quantity, bar in settled.bars.items():
            bars[quantity] = max(bar, bars.get(quantity, 0.0))
    return replace(
        finest,
        bars=bars,
        reached=all(settled.reached for settled in each),
        judged_on=len(each),
    )


def bars_of_rows(variants: BearingVariants, settled: Settled, n: int) -> dict[str, float]:
    """Return relative error bars of the numbers of rows and of `n` natural frequencies by their names:
    the largest over the scene and the ends of a sweep, on the mesh that was settled on.
    """
    bars: dict[str, float] = {str(name): bar for name, bar in settled.bars.items()}
    everywhere: set[str] | None = None
    for scene in [variants.scene, *_ends(variants)]:
        body = build(scene, settled.rung, **settled.options)
        shapes = modes(body, scene, n + SPARE, ovalising=False)
        of_scene = {
            str(name): bar for name, bar in bars_of_modes(scene, body, shapes, settled).items()
        }
        everywhere = {*of_scene} if everywhere is None else everywhere & {*of_scene}
        for name, bar in of_scene.items():
            bars[name] = max(bar, bars.get(name, 0.0))
    assert everywhere is not None
    everywhere |= {*map(str, settled.bars)}
    return {name: bar for name, bar in bars.items() if name in everywhere and math.isfinite(bar)}


def _ends(variants: BearingVariants) -> list[Scene]:
    """Return the variants with the lowest and the highest value of every entry that varies."""
    # the ends of all at once first, then of one after the other
    ranks = variants.values.argsort(axis=0).argsort(axis=0).sum(axis=1)
    wanted = [int(ranks.argmin()), int(ranks.argmax())]
    for column in variants.values.T:
        wanted += [int(np.argmin(column)), int(np.argmax(column))]
    out: list[Scene] = []
    for index in list(dict.fromkeys(wanted))[:MOST]:
        try:
            out.append(variants.variant(index))
        except SceneError:
            continue  # its row will say why
    return out


def _numbered(progress: Progress, k: int, count: int, text: str) -> None:
    progress(f"bearing set {k} of {count}: {text}")
