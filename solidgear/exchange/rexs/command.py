"""The command import: a gearbox in REXS as a train file with its shafts."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import SolidgearError
from solidgear.exchange.rexs.importing import Imported
from solidgear.exchange.rexs.study import import_rexs
from solidgear.show.command import NOT_REACHED, as_typed, command, filled, say
from solidgear.show.options import Run


@command
def import_file(
    file: Annotated[
        Path, typer.Argument(help="REXS file: .rexs, .rexsj, .rexsz, or a zip of one.")
    ],
    out: Annotated[Path, typer.Option(help="Folder for the train and its shafts.")],
    force: Annotated[bool, typer.Option(help="Replace files that are there.")] = False,
    *,
    run: Run,
) -> None:
    gearbox = import_rexs(file, out, force=force)
    first = gearbox.paths[0]
    problem = _problem(first, gearbox)
    if run.as_json:
        print(
            json.dumps(
                {
                    "files": [str(path) for path in gearbox.paths],
                    "train": gearbox.has_train,
                    "facts": [*gearbox.facts],
                    "notes": dict(gearbox.notes.groups),
                    "problem": None if problem is None else str(problem),
                }
            )
        )
    else:
        _report(gearbox, first)
    if problem is not None:
        typer.echo(f"solidgear: {problem}", err=True)
        raise typer.Exit(NOT_REACHED)
    if not run.as_json:
        say("", f"Next: solidgear {'check' if gearbox.has_train else 'answer'} {as_typed(first)}")


def _report(gearbox: Imported, first: Path) -> None:
    say(f"{first}: {'; '.join(gearbox.facts)}")
    for heading, lines in gearbox.notes.groups:
        say("", heading)
        for line in lines:
            say(filled(line, "  "))


def _problem(path: Path, gearbox: Imported) -> SolidgearError | None:
    """Return why the files cannot be used as they are; None where they can."""
    from solidgear.core.scene.file import load  # start-up: for files that were written
    from solidgear.trains.file.reading import load_train  # start-up: as above

    try:
        load_train(path) if gearbox.has_train else load(path)
    except SolidgearError as error:
        return error
    return None
