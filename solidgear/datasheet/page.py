"""The page of a data sheet, as HTML and as PDF by a browser."""

from __future__ import annotations

import os
from pathlib import Path

from solidgear.core import SolidgearError
from solidgear.core.machine.whole_file import write_page
from solidgear.datasheet.browser import browser, pages_of, print_pdf
from solidgear.datasheet.drawing import NARROW, WIDE, enlarged_by, shaft_svg
from solidgear.datasheet.facts import DrawnShaft, Facts
from solidgear.datasheet.language import Language
from solidgear.datasheet.sections import sections, tiles, verdict
from solidgear.show.page_parts import template
from solidgear.show.sketch import extent
from solidgear.show.units import units_named

#: shafts of a train that one page draws
MOST_SHAFTS = 4
#: factor from which on radii are called enlarged
ENLARGED = 1.01
#: zooms at which a page is printed until it is one sheet
ZOOMS = (1.0, 0.93, 0.86, 0.8, 0.74)
#: endings of files
HTML, PDF = (".html", ".htm"), (".pdf",)


def html_of(facts: Facts, units: str = "engineering", zoom: float = 1.0) -> str:
    """Return the page of a sheet as HTML, printed at a zoom."""
    from markupsafe import Markup

    words = Language(facts.language, units_named(units))
    drawings = [(name, Markup(svg)) for name, svg in _drawings(facts, words)]
    return template("onepage.html", Path(__file__).parent).render(
        title=facts.title,
        lang=facts.language,
        zoom=zoom,
        sheet=facts,
        say=words.say,
        day=words.date(facts.day),
        tiles=list(tiles(facts, words)),
        verdict=list(verdict(facts, words)),
        operation="" if facts.operation is None else words.sentence(facts.operation),
        drawings=drawings,
        caption=_caption(facts, words),
        sections=sections(facts, words),
    )


def drawn_shafts(facts: Facts) -> list[DrawnShaft]:
    """Return the first shafts of a sheet that have segments, as many as a page holds."""
    return [shaft for shaft in facts.drawn if shaft.scene.get("segments")][:MOST_SHAFTS]


def _room(facts: Facts) -> tuple[float, float]:
    """Return the largest length and radius of all drawn shafts, m."""
    sizes = [extent(shaft.scene) for shaft in drawn_shafts(facts)]
    return max(length for length, _ in sizes), max(radius for _, radius in sizes)


def _drawings(facts: Facts, words: Language) -> list[tuple[str, str]]:
    """Return drawings of the shafts with their names; of one shaft a wide one and one for a phone."""
    shafts = drawn_shafts(facts)
    if not shafts:
        return []
    room = _room(facts)
    if not facts.train:
        (shaft,) = shafts
        sizes = (("wide", WIDE), ("narrow", NARROW))
        drawings = [shaft_svg(f"{kind}-", kind, shaft, words, width, room) for kind, width in sizes]
        return [("", "".join(drawings))]
    return [
        (shaft.name, shaft_svg(f"shaft{k}-", "each", shaft, words, NARROW, room))
        for k, shaft in enumerate(shafts)
    ]


def _caption(facts: Facts, words: Language) -> str:
    """Return what the drawings show."""
    shafts = drawn_shafts(facts)
    if not shafts:
        return ""
    loaded = any(shaft.forces for shaft in shafts)
    unit = words.units.unit("m")
    sentences = [words.say("drawing" if loaded else "drawing alone", unit=unit)]
    width = NARROW if facts.train else WIDE
    times = max(enlarged_by(shaft, width, _room(facts)) for shaft in shafts)
    if times > ENLARGED:
        sentences.append(words.say("radii enlarged", times=words.local(f"{times:.2g}")))
    left_out = [shaft.name for shaft in facts.drawn if shaft not in shafts]
    if left_out:
        sentences.append(words.say("shafts left out", names=words.listed(left_out)))
    return " ".join(sentences)


def check_ending(path: str | os.PathLike) -> Path:
    """Return the path of a page; refuse one that ends in neither .html nor .pdf."""
    path = Path(path)
    if path.suffix.lower() not in HTML + PDF:
        raise SolidgearError(f"`out` {path}: name a file that ends in .html or .pdf")
    return path


def save(facts: Facts, path: str | os.PathLike, units: str = "engineering") -> list[Path]:
    """Write the page of a sheet as HTML, or as PDF; where there is no browser as HTML beside it."""
    path = check_ending(path)
    program = browser() if path.suffix.lower() in PDF else None
    if program is None:
        page = path if path.suffix.lower() in HTML else path.with_suffix(".html")
        return [write_page(page, html_of(facts, units))]
    for zoom in ZOOMS:
        printed = print_pdf(program, html_of(facts, units, zoom), path.name)
        if pages_of(printed) == 1:
            break
    return [write_page(path, printed)]
