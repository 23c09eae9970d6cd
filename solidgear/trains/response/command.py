"""The commands response and receptance: steady motion of a train, by its transmission error or by a
force on a port."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.show.command import command
from solidgear.show.options import Shown
from solidgear.show.sheet import present
from solidgear.trains.options import Driven, Reduced, TrainFile
from solidgear.trains.response.speed import Speed
from solidgear.trains.response.study import receptance as between
from solidgear.trains.response.study import response as responded

END = "as PORT:COMPONENT, such as gear.gear:z, in the axes of the port's own shaft."


@command
def response(
    train: TrainFile,
    *,
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Folder for response.csv and its chart.")
    ] = Path("out"),
    driven: Driven,
    force: Annotated[
        list[str] | None,
        typer.Option(
            "--force",
            help="Force on a port instead of the transmission error, such as gear.gear:z=100 in N; repeatable.",
        ),
    ] = None,
    together: Annotated[
        bool,
        typer.Option(
            "--together",
            help="Drive by all meshes at the frequencies of the mesh, each at its phase.",
        ),
    ] = False,
    orders: Annotated[
        int | None,
        typer.Option(
            "--orders", help="Number of orders of the mesh in orders.png; 3, or as many as given."
        ),
    ] = None,
    at: Speed,
    reduced: Reduced,
    run: Shown,
) -> None:
    present(
        lambda progress: responded(
            train,
            **driven.words,
            forces=force,
            together=together,
            orders=orders,
            **vars(at),
            **reduced.words,
        ).sheet(run.units),
        run,
        out,
    )


@command
def receptance(
    train: TrainFile,
    *,
    from_: Annotated[str, typer.Option("--from", help=f"Where a unit force acts, {END}")],
    to: Annotated[str, typer.Option("--to", help=f"Where the motion is read, {END}")],
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Folder for receptance.csv and its chart.")
    ] = Path("out"),
    driven: Driven,
    reduced: Reduced,
    run: Shown,
) -> None:
    present(
        lambda progress: between(train, from_, to, **driven.words, **reduced.words).sheet(
            run.units
        ),
        run,
        out,
    )
