"""A page on one question about a train: charts to be read, modes to be turned, and the numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from solidgear.machine.whole_file import write_page
from solidgear.report.page_parts import template
from solidgear.report.plot import Make, page_svg
from solidgear.report.table import Table

#: what charts of a train say in words, by their names
WORDS = {
    "response": "Dynamic mesh force and transmission error of every model drawn.",
    "orders": (
        "Orders of the mesh and of both shafts over the speed of the pinion, and the natural "
        "frequencies they meet. Colour: the mesh force along an order that the transmission "
        "error has."
    ),
    "deflection": (
        "Deflection lines of every shaft in both planes, by every model; dashed lines are bearings."
    ),
    "measured": (
        "The measured spectrum with the orders that its peaks are at this speed, above the computed "
        "mesh force over the same frequencies. Grey lines: natural frequencies."
    ),
    "receptance": "Amplitude and phase of the receptance of every model drawn.",
}


class Figure(NamedTuple):
    """A chart in a section, by a name of letters and underscores that is no other's of the page, and
    what it says in words.
    """

    name: str
    words: str
    make: Make


@dataclass(frozen=True)
class Section:
    """A part of a page, with a heading that the contents point to.

    Attributes
    ----------
    anchor, title, words : str
    figures : sequence of Figure
    tables : sequence of Table
        Those without rows are left out.
    """

    anchor: str
    title: str
    words: str = ""
    figures: Sequence[Figure] = ()
    tables: Sequence[Table] = ()


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
    """Write a page that needs no network and no other file.

    Parameters
    ----------
    path : Path
    title, lead : str
        What is shown, and with which models.
    tables : iterable of Table
    charts : mapping of str to callable, optional
        A chart each, by its name in ``WORDS``.
    viewer : str
        HTML that shows mode shapes, taken as it is: none of it may come from a file unescaped.
    notes, cautions : sequence of str
    verdict : sequence of str
        Conclusions, which come first.
    sections : sequence of Section
        After all else but the notes.

    Raises
    ------
    SolidgearError
        If the file cannot be written.
    """
    from markupsafe import Markup

    figures = [Figure(name, WORDS[name], make) for name, make in (charts or {}).items()]
    shown = [(s, [table for table in s.tables if table], _drawn(s.figures)) for s in sections]
    page = template("train_sheet.html").render(
        title=title,
        lead=lead,
        tables=[table for table in tables if table],
        charts=_drawn(figures),
        viewer=Markup(viewer),
        notes=notes,
        cautions=cautions,
        verdict=verdict,
        sections=[part for part in shown if part[0].words or part[1] or part[2]],
    )
    return write_page(path, page)


def _drawn(figures: Sequence[Figure]) -> list[tuple[str, str]]:
    """Figures as they stand in the page, and their words; what has nothing to draw is left out."""
    from markupsafe import Markup

    drawn = [(page_svg(figure.name, figure.make), figure.words) for figure in figures]
    return [(Markup(svg.decode()), words) for svg, words in drawn if svg]
