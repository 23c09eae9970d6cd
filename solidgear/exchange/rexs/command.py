"""The command import: a gearbox in REXS as a train file with its shafts."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from solidgear.core import SolidgearError, whole
from solidgear.exchange.rexs.document import RexsError
from solidgear.exchange.rexs.importing import Imported, imported, name_of
from solidgear.exchange.rexs.loadable import with_loadable
from solidgear.exchange.rexs.reading import read
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
    document = read(file)
    try:
        gearbox = imported(document, name_of(file))
    except RexsError as error:
        raise RexsError(f"{file}: {error}") from None
    gearbox = with_loadable(gearbox, str(file))
    paths = {out / name: text for name, text in gearbox.files.items()}
    for path in paths:
        if path.exists() and not force:
            raise SolidgearError(
                f"{path}: there is such a file already; give another --out, or --force"
            )
    _write(paths)
    first = next(iter(paths))
    if run.as_json:
        print(
            json.dumps(
                {
                    "files": [str(path) for path in paths],
                    "train": gearbox.has_train,
                    "facts": [*gearbox.facts],
                    "notes": dict(gearbox.notes.groups),
                }
            )
        )
    else:
        _report(gearbox, first)
        say("", f"Next: solidgear {'check' if gearbox.has_train else 'answer'} {as_typed(first)}")


def _write(texts: Mapping[Path, str]) -> None:
    """Write all files or none."""
    try:
        with ExitStack() as stack:
            for path, text in texts.items():
                path.parent.mkdir(parents=True, exist_ok=True)
                stack.enter_context(whole(path)).write_text(text, encoding="utf-8")
    except OSError as error:
        reason = error.strerror or error
        folder = next(iter(texts)).parent
        raise SolidgearError(
            f"{folder}: cannot be written ({reason}); name a folder you may write"
        ) from error


def _report(gearbox: Imported, first: Path) -> None:
    say(f"{first}: {'; '.join(gearbox.facts)}")
    for heading, lines in gearbox.notes.groups:
        say("", heading)
        for line in lines:
            say(filled(line, "  "))
