"""The command sheet: one page of a shaft or a train."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from solidgear.datasheet.messages import LANGUAGES, LanguageChoice
from solidgear.datasheet.page import check_ending
from solidgear.datasheet.study import sheet as solved
from solidgear.show.command import Progress, caution, command
from solidgear.show.options import Shown, relative
from solidgear.show.sheet import Sheet, present
from solidgear.show.units import units_named
from solidgear.strength.acting import Acting, AtRestFile
from solidgear.strength.stress.command import Rated


@command
def sheet(
    file: AtRestFile,
    *,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="File of the page: .html, or .pdf where Chromium, Chrome or Edge is installed.",
        ),
    ] = None,
    language: Annotated[
        LanguageChoice, typer.Option("--language", help="Language of the page: en or de.")
    ] = LANGUAGES[0],
    acting: Acting,
    speed: Annotated[
        str | None,
        typer.Option(help='Speed of a shaft, such as "1500 rpm"; by default that of its file.'),
    ] = None,
    tol: Annotated[
        float | None,
        relative("--tol", "Relative error allowed for numbers of a shaft; else the file's own."),
    ] = None,
    rated: Rated,
    run: Shown,
) -> None:
    if out is not None:
        check_ending(out)  # before anything is solved

    def study(progress: Progress) -> Sheet:
        facts = solved(
            file,
            tol,
            language=str(language),
            speed=speed,
            **vars(acting),
            conditions=rated.conditions(),
            progress=progress,
        )
        screen = facts.sheet(units_named(run.units))
        if out is None:
            return screen
        progress("page")
        files = facts.save(out, run.units)
        lines = [f"Written: {path}" for path in files]
        if files[0].suffix.lower() != out.suffix.lower():
            lines.append(caution(no_browser(out, files[0])))
        return replace(screen, terminal=replace(screen.terminal, unbroken=lines))

    present(study, run)


def no_browser(out: Path, page: Path) -> str:
    """Return the sentence on a PDF that there is no browser for."""
    return (
        f"no PDF {out}: no Chromium, Chrome or Edge is on PATH or named by BROWSER; {page} prints "
        "on one sheet from any browser"
    )
