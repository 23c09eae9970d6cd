"""The sheet of a study: tables, charts and sentences, for the terminal, a page, files and JSON.

A study lists what it shows once, in a :class:`Sheet`; :func:`present` solves and shows it as its
command was asked to.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from solidgear.core import whole
from solidgear.core.machine.whole_file import write_page as write_whole
from solidgear.show.command import NOT_REACHED, Progress, caution, say
from solidgear.show.folder import held
from solidgear.show.page_parts import Contents, template
from solidgear.show.plot import WIDE, Make, page_svg
from solidgear.show.table import Table
from solidgear.show.units import in_ascii

if TYPE_CHECKING:
    from solidgear.show.options import Run

#: what charts say in words, by how their names begin
WORDS = {
    "response": "Dynamic mesh force and transmission error of each model.",
    "orders": (
        "Orders of the mesh and of both shafts over the speed of the pinion, and the natural "
        "frequencies they meet. Colour: mesh force along orders of the transmission error."
    ),
    "deflection": (
        "Deflection lines of every shaft in both planes, by every model; dashed lines are bearings."
    ),
    "turn_": (
        "Mesh force of every planet over a turn of its carrier from the file's position on; "
        "bearings have their stiffness at rest."
    ),
    "measured": (
        "The measured spectrum, its peaks named by their orders at this speed, above the computed "
        "mesh force. Grey lines: natural frequencies."
    ),
    "section_forces": (
        "Section forces along the shaft; with two components, the dashed line is their resultant."
    ),
    "off": (
        "Difference of each computed frequency from the measured one; grey: two standard "
        "deviations of the measured and the error bar of the computed one."
    ),
    "mac": (
        "MAC, the likeness of every measured shape (rows) and every computed mode at the "
        "measuring points."
    ),
    "overlay": (
        "Measured (dark) and computed (green, with its band) responses at the same points; dots: "
        "resonances found."
    ),
    "nonlinear": (
        "Dynamic mesh force over the speed of the pinion: periodic motions with backlash, stable and "
        "unstable, with the jumps between them, runs through the speeds, and the linear answer. Below: "
        "contact over the cycle, and the orders of the largest force."
    ),
    "housing": (
        "Loads on the mounts of the housing and accelerations of its points, over all three "
        "directions."
    ),
    "waterfall": (
        "Spectra of the mesh force along the run, each over 16 to 64 mesh cycles around its speed; grey: "
        "orders of the mesh."
    ),
    "receptance": "Amplitude and phase of the receptance of every model.",
    "shapes": (
        "Motions of sections along both shafts in the lowest pairs of modes, in the plane of the "
        "largest, scaled to one."
    ),
    "shares": "Strain energy of every mode by part.",
}


@dataclass(frozen=True)
class Section:
    """A part of a page, with a heading that the contents point to."""

    anchor: str
    title: str
    words: str = ""
    #: by names of letters and underscores, each of no other chart of the page; those in ``WORDS``
    #: say what is written there, others the title
    charts: Mapping[str, Make] = field(default_factory=dict)
    tables: Sequence[Table] = ()  #: those without rows are left out
    #: SVG by what it says in words, before the charts
    drawings: Mapping[str, bytes | None] = field(default_factory=dict)


@dataclass(frozen=True)
class Terminal:
    """Parts that a terminal shows in another way than the page; None is as on the page."""

    heading: Sequence[str] | None = None  #: in place of title and lead
    tables: Sequence[Table] | None = None
    closing: Sequence[str] | None = None  #: in place of notes and cautions


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
    words: Mapping[str, str] = field(default_factory=dict)  #: what charts say, by file


def present(study: Callable[[Progress], Sheet], run: Run, out: Path | None = None) -> None:
    """Solve a study, write its folder if there is one, print its sheet, and exit with code 3 where
    the tolerance is not reached.
    """
    with held(out) if out else nullcontext(), run.progress() as progress:
        sheet = study(progress)
        files = write_folder(sheet, out) if out else []
    if run.as_json:
        print(as_json(sheet))
    else:
        print_sheet(sheet)
        if files:
            say(f"Written: {', '.join(map(str, files))}", soft_wrap=False)
    if not sheet.reached:
        import typer  # start-up: pages are written without a command line

        raise typer.Exit(NOT_REACHED)


def print_sheet(sheet: Sheet) -> None:
    """Print a sheet on the terminal, broken at its width."""
    terminal = sheet.terminal
    heading, tables, closing = terminal.heading, terminal.tables, terminal.closing
    if heading is None:
        heading = [sheet.title, sheet.lead]
    if tables is None:
        tables = sheet.tables
    if closing is None:
        closing = [*sheet.notes, *map(caution, sheet.cautions)]
    results = [in_ascii(sheet.headline), *sheet.verdict]
    say(*heading, *(table for table in tables if table), soft_wrap=False)
    say(*(sentence for sentence in results if sentence), *closing, soft_wrap=False)


def as_json(sheet: Sheet) -> str:
    """Return the data of a sheet as a line of JSON."""
    return json.dumps(sheet.data, allow_nan=False)


def write_folder(sheet: Sheet, folder: Path) -> list[Path]:
    """Write a page and its data, tables by file name, and charts; return the paths."""
    folder.mkdir(parents=True, exist_ok=True)
    files = [table.write(folder / f"{stem}.csv") for stem, table in sheet.lines.items()]
    files.append(folder / f"{sheet.name}.json")
    write_json(files[-1], sheet.data)
    for charts in (sheet.charts, *(section.charts for section in sheet.sections)):
        for stem, make in charts.items():
            files += write_charts(folder / stem, make)
    return [write_page(sheet, folder / f"{sheet.name}.html"), *files]


def write_page(sheet: Sheet, path: Path) -> Path:
    """Write the page of a sheet alone."""
    return write_sheet(
        path,
        sheet.title,
        f"{sheet.lead} {sheet.headline}".strip(),
        sheet.tables,
        charts=sheet.charts,
        notes=sheet.notes,
        cautions=sheet.cautions,
        verdict=sheet.verdict,
        viewer=sheet.viewer,
        sections=sheet.sections,
        words=sheet.words,
    )


def write_json(path: Path, data: Mapping[str, Any]) -> None:
    """Write plain data as a whole file or none."""
    with whole(path) as half:
        half.write_text(json.dumps(data, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def write_charts(stem: Path, make: Make) -> list[Path]:
    """Write a chart as PNG and SVG."""
    chart = make(WIDE)
    if chart is None:
        return []
    files = [stem.with_suffix(f".{kind}") for kind in ("png", "svg")]
    chart.write(*files)
    return files


def write_sheet(
    path: Path,
    title: str,
    lead: str,
    tables: Iterable[Table] = (),
    *,
    charts: Mapping[str, Make] | None = None,
    viewer: str = "",
    notes: Sequence[str] = (),
    cautions: Sequence[str] = (),
    verdict: Sequence[str] = (),
    sections: Sequence[Section] = (),
    words: Mapping[str, str] | None = None,
) -> Path:
    """Write a page without network: conclusions, cautions, charts, HTML of shapes, tables and
    notes.
    """
    from markupsafe import Markup

    drawn = [
        (s, [table for table in s.tables if table], [*_given(s), *_drawn(s.charts, {}, s.title)])
        for s in sections
    ]
    page = template("train_sheet.html").render(
        contents=Contents(),
        title=title,
        lead=lead,
        tables=[table for table in tables if table],
        charts=_drawn(charts or {}, words or {}, title),
        viewer=Markup(viewer),
        notes=notes,
        cautions=cautions,
        verdict=verdict,
        sections=[part for part in drawn if part[0].words or part[1] or part[2]],
    )
    return write_whole(path, page)


def _drawn(
    charts: Mapping[str, Make], words: Mapping[str, str], title: str
) -> list[tuple[str, str]]:
    """Draw charts for the page with their words, without empty ones."""
    from markupsafe import Markup

    drawn = {name: page_svg(name, make) for name, make in charts.items()}
    return [
        (Markup(svg.decode()), words.get(name) or _words(name) or f"{title}.")
        for name, svg in drawn.items()
        if svg
    ]


def _given(section: Section) -> list[tuple[str, str]]:
    """Return drawings for the page with their words."""
    from markupsafe import Markup

    return [(Markup(svg.decode()), words) for words, svg in section.drawings.items() if svg]


def _words(name: str) -> str:
    return next((words for start, words in WORDS.items() if name.startswith(start)), "")
