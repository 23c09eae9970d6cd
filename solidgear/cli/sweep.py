"""Command ``sweep``: one body, many bearing sets."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from solidgear.cli.app import Progress as Steps
from solidgear.cli.app import command
from solidgear.cli.settled import ended, over_the_sweep
from solidgear.cli.shared import Chosen, Run, SceneFile, options


@command
def sweep(
    scene: SceneFile,
    *,
    vary: Annotated[
        list[str],
        typer.Option(
            "--vary",
            help="bearing.NAME.FIELD=VALUES, repeatable. FIELD: position (from y = 0), scale, "
            "or an entry such as kxx or kx_thz. "
            "bearing.NAME.housing.FIELD and housing.FIELD vary what the scene gives a housing. "
            'VALUES: FROM:TO:COUNT, log:FROM:TO:COUNT or A,B,C, such as "0.2 m:0.24 m:9".',
        ),
    ],
    out: Annotated[
        Path,
        typer.Option(
            "--out",
            "-o",
            help="Rows, as .csv or .parquet; run again to go on where it stopped. They are kept in "
            "a database beside it (rows.csv.sqlite), from which the file is written in one step.",
        ),
    ] = Path("rows.csv"),
    model: Chosen,
    n: Annotated[
        int | None, typer.Option("-n", help="Number of elastic shapes; twins count twice.")
    ] = None,
    sample: Annotated[
        int | None,
        typer.Option(
            "--sample", help="Draw so many points (Latin hypercube) instead of all combinations."
        ),
    ] = None,
    seed: Annotated[int, typer.Option("--seed", help="Of the random sample.")] = 0,
    tolerance: Annotated[
        float,
        typer.Option(
            "--tolerance",
            help="Relative error of frequencies; checked by a bound for every variant.",
        ),
    ] = 1e-6,
    jobs: Annotated[int, typer.Option("--jobs", "-j", help="Processes on this machine.")] = 1,
    dask: Annotated[
        str | None,
        typer.Option(
            "--dask", help="Address of a running Dask scheduler, such as tcp://host:8786."
        ),
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Discard rows that are there.")
    ] = False,
    run: Run,
) -> None:
    """Stiffness and first modes of thousands of bearing sets on one body."""
    from dataclasses import asdict

    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    from solidgear.cli.reading import load
    from solidgear.ladder import build
    from solidgear.ladder.registry import LADDER
    from solidgear.studies.check import cautions
    from solidgear.studies.sweep import sweep as swept
    from solidgear.studies.sweep.choice import settled_for_sweep

    loaded = load(scene)
    # before a file of rows is begun
    settled = None
    if model.automatic():
        with Steps(quiet=not sys.stderr.isatty()) as steps:
            settled = settled_for_sweep(
                loaded, vary, model.tol, sample=sample, seed=seed, progress=steps
            )
        name, given = settled.rung, settled.options
    else:
        name = str(model.name)
        given = LADDER[name].checked(options(model.pairs))
    terminal = Console(stderr=True, highlight=False)
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=terminal,
        disable=run.as_json or not terminal.is_terminal,
    )
    reached = [0, 0]
    try:
        with bar:
            line = bar.add_task("reading", total=None)

            def show(done: int, total: int, text: str) -> None:
                reached[:] = done, total
                bar.update(line, completed=done, total=total, description=text)

            def tell(text: str) -> None:
                terminal.print(f"solidgear: {text}", markup=False, emoji=False, soft_wrap=True)

            found = swept(
                loaded,
                vary,
                out,
                fidelity=name,
                options=given,
                n=n,
                sample=sample,
                seed=seed,
                tolerance=tolerance,
                jobs=jobs,
                dask=dask,
                overwrite=overwrite,
                build=build,
                progress=show,
                tell=tell,
            )
    except KeyboardInterrupt:
        if reached[0]:
            print(
                f"solidgear: {reached[0]} of {reached[1]} rows are kept; the same command goes on from there",
                file=sys.stderr,
            )
        raise
    if run.as_json:
        record = asdict(found)
        if settled is not None:
            record |= settled.as_dict()
        print(json.dumps(record, default=str))
        ended(settled)
        return
    for sentence in cautions(loaded, build(loaded.plain, "timoshenko"), name):
        print(f"caution: {sentence}", file=sys.stderr)
    new = found.total - found.skipped
    path = str(found.path).encode("utf-8", "backslashreplace").decode()  # bytes that are no text
    print(f"{path}: {found.total} rows, {found.skipped} of them there before.")
    if new:
        print(
            f"{found.unknowns} unknowns with {found.seats} seats solved once in "
            f"{found.seconds_once:.1f} s; {new} variants of up to {found.basis} unknowns, "
            f"{1e3 * found.seconds_each:.1f} ms each; {found.refused} refused, {found.full} solved in full."
        )
        if found.why:
            others = "; others say theirs" if found.refused > 1 else ""
            print(f"Refused: {found.why} (column status{others}).")
    if found.settling:
        print(found.settling)
    for sentence in over_the_sweep(settled):
        print(sentence)
    ended(settled)
