"""The command import: a gearbox in REXS as a train file with its shafts."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from solidgear.exchange.rexs.importing import Imported
from solidgear.exchange.rexs.study import import_rexs
from solidgear.show.command import as_typed, command, filled, say
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
    if run.as_json:
        print(
            json.dumps(
                {
                    "files": [str(path) for path in gearbox.paths],
                    "train": gearbox.has_train,
                    "facts": [*gearbox.facts],
                    "notes": dict(gearbox.notes.groups),
                }
            )
        )
    else:
        _report(gearbox, first)
        say("", f"Next: solidgear {'check' if gearbox.has_train else 'answer'} {as_typed(first)}")


def _report(gearbox: Imported, first: Path) -> None:
    say(f"{first}: {'; '.join(gearbox.facts)}")
    for heading, lines in gearbox.notes.groups:
        say("", heading)
        for line in lines:
            say(filled(line, "  "))
