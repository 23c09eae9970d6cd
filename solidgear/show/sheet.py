"""The sheet of a study: tables, charts and sentences, for the terminal, a page, files and JSON.

A study lists what it shows once, in a :class:`Sheet`; :func:`present` solves and shows it as its
command was asked to.
"""

from __future__ import annotations

import io
import json
import os
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from solidgear.core import whole
from solidgear.core.machine.whole_file import write_page as write_whole
from solidgear.show.command import NOT_REACHED, Progress, caution, filled, say
from solidgear.show.file_stems import file_stems
from solidgear.show.table import Table
from solidgear.show.units import Units, in_ascii, units_named

if TYPE_CHECKING:
    from rich.console import Console, RenderableType

    from solidgear.show.options import Run
    from solidgear.show.plot import Make

#: files of a chart
KINDS = ("png", "svg")
#: columns of a sheet that is printed as a text
PRINTED = 100


@dataclass(frozen=True)
class Section:
    """A part of a page, with a heading that the contents point to."""

    anchor: str
    title: str
    words: str = ""
    #: by names of letters and underscores, each of no other chart of the page
    charts: Mapping[str, Make] = field(default_factory=dict)
    tables: Sequence[Table] = ()  #: those without rows are left out
    #: SVG by what it says in words, before the charts
    drawings: Mapping[str, bytes | None] = field(default_factory=dict)
    filed: Collection[str] | None = None  #: charts that are files as well; None: all of them
    viewer: str = ""  #: HTML of shapes, before the tables
    notes: Sequence[str] = ()  #: below the tables


@dataclass(frozen=True)
class Terminal:
    """Parts that a terminal shows in another way than the page; None is as on the page."""

    heading: Sequence[str | Table] | None = None  #: in place of title and lead
    tables: Sequence[RenderableType] | None = None
    closing: Sequence[str | Table] | None = None  #: in place of notes and cautions
    #: sentences longer than a line: broken at the width, with further lines indented, or whole
    lines: Literal["broken", "hanging", "whole"] = "broken"
    results: Sequence[str] | None = None  #: in place of headline and verdict
    unbroken: Sequence[str] = ()  #: last, a line of any length each


@dataclass(frozen=True)
class Sheet:
    """Everything that a study shows, in the order in which it is read."""

    name: str  #: of its page and its JSON
    title: str
    lead: str  #: what the numbers hold for
    tables: Sequence[Table]  #: those without rows are left out
    data: Mapping[str, Any]  #: plain, in SI, as JSON holds it
    charts: Mapping[str, Make] = field(default_factory=dict)  #: by file
    lines: Mapping[str, Table] = field(default_factory=dict)  #: in SI for other programs, by file
    headline: str = ""  #: the main result in a sentence, which ends the lead of the page
    verdict: Sequence[str] = ()
    notes: Sequence[str] = ()
    cautions: Sequence[str] = ()
    sections: Sequence[Section] = ()  #: of the page alone
    viewer: str = ""  #: HTML of shapes, of the page alone
    reached: bool = True  #: whether every error bar is within the tolerance
    terminal: Terminal = Terminal()
    exit_code: int = 0  #: of a fault, or of a run that ended early, after its numbers
    #: what charts say, by file; the title where there is nothing
    words: Mapping[str, str] = field(default_factory=dict)
    #: name of its JSON, which then lists all files, where that is not the name of its page
    json_name: str = ""
    pictures: Sequence[str] = ()  #: files of its folder that are drawn already


def present(study: Callable[[Progress], Sheet], run: Run, out: Path | None = None) -> None:
    """Solve a study, write its folder if there is one, print its sheet, and exit with the code of
    the sheet, or 3 where the tolerance is not reached.
    """
    with _held(out) if out else nullcontext(), run.progress() as progress:
        sheet = study(progress)
        files = write_folder(sheet, out) if out else []
    if run.as_json:
        print(as_json(sheet))
    else:
        print_sheet(sheet)
        if sheet.json_name and files:
            say(f"Report: {files[0]}")
        elif files:
            written = f"Written: {', '.join(map(str, files))}"
            say(written, soft_wrap=sheet.terminal.lines != "broken")
    exit_code = sheet.exit_code or (0 if sheet.reached else NOT_REACHED)
    if exit_code:
        import typer  # start-up: pages are written without a command line

        raise typer.Exit(exit_code)


def _held(folder: str | os.PathLike) -> AbstractContextManager[Any]:
    from solidgear.show.folder import held  # start-up: for a folder alone

    return held(folder)


def sheet_of(result: Any, make: Callable[[Any, Units], Sheet], units: str | Units) -> Sheet:
    """Return the sheet of a result in some units."""
    return make(result, units_named(units))


def main_table(sheet: Sheet) -> Table:
    """Return the first table of a sheet with rows, or its conclusions as one."""
    tables = [*sheet.tables, *(table for s in sheet.sections for table in s.tables)]
    conclusions = Table(sheet.title, [""], [[line] for line in [*sheet.verdict, *sheet.notes]])
    return next((table for table in tables if table), conclusions)


def tables_of(sheet: Sheet) -> dict[str, Table]:
    """Return all tables of numbers of a sheet by name, the main one first; those of files have their
    names.
    """
    shown = [*sheet.tables, *(table for s in sheet.sections for table in s.tables)]
    printed = [block for block in sheet.terminal.tables or () if isinstance(block, Table)]
    shown = shown if any(shown) else printed
    tables = {table.key: table for table in shown if table and table.style != "facts"}
    named = {name: table for name, table in sheet.lines.items() if table}
    return {**tables, **named} or {"": main_table(sheet)}


def as_printed(sheet: Sheet) -> str:
    """Return what a terminal shows of a sheet."""
    from rich.console import Console  # start-up: as in `say`

    lines = io.StringIO()
    plain = Console(file=lines, width=PRINTED, highlight=False, markup=False, emoji=False)
    print_sheet(sheet, plain)
    return "\n".join(map(str.rstrip, lines.getvalue().rstrip("\n").split("\n")))


def as_html(sheet: Sheet) -> str:
    """Return tables and sentences of a sheet for a notebook."""
    from markupsafe import escape

    sentences = [*filter(None, [sheet.title, sheet.headline]), *sheet.verdict]
    blocks = [f"<p>{escape(sentence)}</p>" for sentence in sentences]
    blocks += [table._repr_html_() for table in sheet.tables if table]
    blocks += [f"<p>{escape(text)}</p>" for text in [*sheet.notes, *map(caution, sheet.cautions)]]
    return "".join(blocks)


def write_result(
    result: Any,
    folder: str | os.PathLike,
    units: str | Units,
    make_for_folder: Callable[[Any, Units, Path], Sheet] | None = None,
) -> list[Path]:
    """Write the sheet of a result into a folder that no other run holds, and return the files."""
    chosen = units_named(units)
    with _held(folder) as place:
        if make_for_folder is None:
            return write_folder(result.sheet(chosen), place)
        return write_folder(make_for_folder(result, chosen, place), place)


def print_sheet(sheet: Sheet, printer: Console | None = None) -> None:
    """Print a sheet on the terminal, or another one, broken at its width."""
    terminal = sheet.terminal
    heading, tables, closing = terminal.heading, terminal.tables, terminal.closing
    results = terminal.results
    if heading is None:
        heading = [text for text in (sheet.title, sheet.lead) if text]
    if tables is None:
        tables = sheet.tables
    if closing is None:
        closing = [*sheet.notes, *map(caution, sheet.cautions)]
    if results is None:
        results = [in_ascii(sheet.headline), *sheet.verdict]
    blocks = [*heading, *(table for table in tables if table)]
    blocks += [*(sentence for sentence in results if sentence), *closing]
    if terminal.lines == "hanging":
        blocks = [filled(block) if isinstance(block, str) else block for block in blocks]
    say(*blocks, soft_wrap=terminal.lines != "broken", printer=printer)
    say(*terminal.unbroken, printer=printer)


def as_json(sheet: Sheet) -> str:
    """Return the data of a sheet as a line of JSON."""
    return json.dumps(sheet.data, allow_nan=False)


def write_folder(sheet: Sheet, folder: Path) -> list[Path]:
    """Write a page and its data, tables by file name, and charts; return the paths."""
    from solidgear.show.folder import begun  # start-up: as in `_held`

    with begun(folder) if sheet.json_name else nullcontext():
        return _written(sheet, folder)


def _written(sheet: Sheet, folder: Path) -> list[Path]:
    folder.mkdir(parents=True, exist_ok=True)
    charts = {**sheet.charts}
    for s in sheet.sections:
        charts |= {name: make for name, make in s.charts.items() if _is_filed(s, name)}
    data, stems = sheet.data, file_stems([*sheet.lines, *charts])
    if sheet.json_name:
        names = [f"{sheet.name}.html", *(f"{stems[name]}.csv" for name in sheet.lines)]
        names += [f"{stems[name]}.{kind}" for name in charts for kind in KINDS]
        names += sheet.pictures
        data = {**data, "files": names}
    json_file = folder / f"{sheet.json_name or sheet.name}.json"
    write_json(json_file, data)  # numbers first: whatever happens to charts, they are there
    files = [table.write(folder / f"{stems[name]}.csv") for name, table in sheet.lines.items()]
    files.append(json_file)
    for name, make in charts.items():
        files += write_charts(folder / stems[name], make)
    page = write_page(sheet, folder / f"{sheet.name}.html")
    return [page, *files]


def write_page(sheet: Sheet, path: Path) -> Path:
    """Write the page of a sheet, without network: conclusions, cautions, charts, HTML of shapes,
    tables, sections and notes.
    """
    from markupsafe import Markup

    from solidgear.show.page_parts import Contents, template  # start-up: for pages alone

    sections = [
        (
            section,
            [table for table in section.tables if table],
            [*_given(section), *_drawn(section.charts, section.title, sheet.words)],
            Markup(section.viewer),
        )
        for section in sheet.sections
    ]
    page = template("sheet.html").render(
        contents=Contents(),
        title=sheet.title,
        lead=f"{sheet.lead} {sheet.headline}".strip(),
        tables=[table for table in sheet.tables if table],
        charts=_drawn(sheet.charts, sheet.title, sheet.words),
        viewer=Markup(sheet.viewer),
        notes=sheet.notes,
        cautions=sheet.cautions,
        verdict=sheet.verdict,
        sections=[part for part in sections if part[0].words or any(part[1:])],
    )
    return write_whole(path, page)


def _is_filed(section: Section, chart: str) -> bool:
    return section.filed is None or chart in section.filed


def write_json(path: Path, data: Mapping[str, Any]) -> None:
    """Write plain data as a whole file or none."""
    with whole(path) as half:
        half.write_text(json.dumps(data, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def write_charts(stem: Path, make: Make) -> list[Path]:
    """Write a chart as PNG and SVG."""
    from solidgear.show.plot import WIDE  # start-up: for charts alone

    chart = make(WIDE)
    if chart is None:
        return []
    files = [stem.with_suffix(f".{kind}") for kind in KINDS]
    chart.write(*files)
    return files


def _drawn(
    charts: Mapping[str, Make], title: str, words: Mapping[str, str]
) -> list[tuple[str, str]]:
    """Draw charts for the page with their words, without empty ones."""
    from markupsafe import Markup

    from solidgear.show.plot import page_svg  # start-up: as in `write_charts`

    drawn = {name: page_svg(name, make) for name, make in charts.items()}
    return [
        (Markup(svg.decode()), words.get(name) or f"{title}.") for name, svg in drawn.items() if svg
    ]


def _given(section: Section) -> list[tuple[str, str]]:
    """Return drawings for the page with their words."""
    from markupsafe import Markup

    return [(Markup(svg.decode()), words) for words, svg in section.drawings.items() if svg]
