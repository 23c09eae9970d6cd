"""A page on one question about a train: charts to be read, modes to be turned, and the numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

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
    "sweep": "Natural frequencies and what else the rows tell, over the number that varies.",
    "receptance": "Amplitude and phase of the receptance of every model drawn.",
}


def write_sheet(
    path: Path,
    title: str,
    lead: str,
    tables: Iterable[Table],
    *,
    charts: Mapping[str, Make] | None = None,
    viewer: str = "",
    notes: Sequence[str] = (),
    cautions: Sequence[str] = (),
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

    Raises
    ------
    SolidgearError
        If the file cannot be written.
    """
    from markupsafe import Markup

    drawn = {name: page_svg(name, make) for name, make in (charts or {}).items()}
    page = template("train_sheet.html").render(
        title=title,
        lead=lead,
        tables=[table for table in tables if table],
        charts=[(Markup(svg.decode()), WORDS[name]) for name, svg in drawn.items() if svg],
        viewer=Markup(viewer),
        notes=notes,
        cautions=cautions,
    )
    return write_page(path, page)
