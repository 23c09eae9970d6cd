"""A page on one question: charts to be read, modes to be turned, and the numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from solidgear.core.machine.whole_file import write_page
from solidgear.show.page_parts import Contents, template
from solidgear.show.plot import Make, page_svg
from solidgear.show.table import Table

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
    "designs": "The goal in every design solved, each with its error bar.",
    "sweep": "Natural frequencies and other columns over the number that varies.",
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
    "sensitivities": "Change of the number for one per cent more of each entry.",
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
) -> Path:
    """Write a page without network: conclusions, cautions, charts, HTML of shapes, tables and
    notes.
    """
    from markupsafe import Markup

    drawn = [
        (s, [table for table in s.tables if table], [*_given(s), *_drawn(s.charts, s.title)])
        for s in sections
    ]
    page = template("train_sheet.html").render(
        contents=Contents(),
        title=title,
        lead=lead,
        tables=[table for table in tables if table],
        charts=_drawn(charts or {}, title),
        viewer=Markup(viewer),
        notes=notes,
        cautions=cautions,
        verdict=verdict,
        sections=[part for part in drawn if part[0].words or part[1] or part[2]],
    )
    return write_page(path, page)


def _drawn(charts: Mapping[str, Make], title: str) -> list[tuple[str, str]]:
    """Draw charts for the page with their words, without empty ones."""
    from markupsafe import Markup

    drawn = {name: page_svg(name, make) for name, make in charts.items()}
    return [
        (Markup(svg.decode()), _words(name) or f"{title}.") for name, svg in drawn.items() if svg
    ]


def _given(section: Section) -> list[tuple[str, str]]:
    """Return drawings for the page with their words."""
    from markupsafe import Markup

    return [(Markup(svg.decode()), words) for words, svg in section.drawings.items() if svg]


def _words(name: str) -> str:
    return next((words for start, words in WORDS.items() if name.startswith(start)), "")
