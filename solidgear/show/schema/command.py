"""Command that prints schemas: of files, and of the JSON of commands."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import SolidgearError
from solidgear.core.machine.whole_file import write_files
from solidgear.show.command import command
from solidgear.show.schema.files import KINDS, path_of


@command
def schema(
    kind: Annotated[str, typer.Argument(help=f"Kind of file: {', '.join(KINDS)}.")] = "scene",
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="File to write, in place of printing.")
    ] = None,
    where: Annotated[bool, typer.Option("--where", help="Print where the schema file is.")] = False,
    json_of: Annotated[
        str,
        typer.Option(
            "--json", metavar="COMMAND", help="Schema of what a command prints with --json."
        ),
    ] = "",
) -> None:
    if json_of and where:
        raise SolidgearError("schema: what a command prints has no file; leave out --where")
    path = path_of(kind)
    if where:
        typer.echo(str(path))
        return
    if json_of:
        from solidgear.show.schema.results import text_of_command  # start-up: of this option

        text = text_of_command(json_of)
    else:
        text = path.read_text("utf-8")
    if out is None:
        typer.echo(text, nl=False)
        return
    write_files({out: text.encode()})
    typer.echo(f"Written: {out}")
