"""Sections of a data sheet in a language: tables and sentences for page and terminal."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from solidgear.datasheet.facts import (
    NEAR,
    Amount,
    BearingFact,
    Facts,
    ModeTerm,
    Place,
    Remark,
    Resonance,
    Speed,
    Term,
)
from solidgear.datasheet.language import Language
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import Cell, Column, Table, text, word
from solidgear.show.units import Units, in_ascii
from solidgear.show.words import DASH

#: SI unit of a stress
STRESS = "Pa stressed"
#: rows of a table, and sentences of a section, that one page holds
MOST_ROWS, MOST_MOTIONS, MOST_SENTENCES, MOST_CORNERS = 8, 3, 6, 6
#: hours from which on a life is as good as without end
ENDLESS = 1e6


#: messages on safeties that are less at another notch
LESSER = {"yielding": "worst yielding", "crack": "worst crack"}


@dataclass(frozen=True)
class Section:
    """A section of the page."""

    key: str
    title: str
    table: Table | None = None
    sentences: tuple[str, ...] = ()
    notes: tuple[str, ...] = field(default_factory=tuple)


@dataclass(frozen=True)
class Tile:
    """A number that is read first."""

    value: str
    label: str
    place: str
    look: str = ""


def sheet_of(facts: Facts, units: Units) -> Sheet:
    """Return the sheet of a terminal and of JSON."""
    words = Language(facts.language, units)
    several = sections(facts, words)
    lines = [f"{words.say('section verdict')}: {' '.join(verdict(facts, words))}"]
    for section in several:
        if section.sentences:
            lines.append(f"{section.title}: {' '.join(section.sentences)}")
    lead = f"{words.say('file')} {facts.file}, {words.date(facts.day)}"
    if facts.operation is not None:
        lead += f". {words.sentence(facts.operation)}"
    return Sheet(
        name="sheet",
        title=facts.title,
        lead=lead,
        tables=[s.table for s in several if s.table],
        data=facts.as_dict(),
        verdict=[*map(in_ascii, lines)],
        reached=facts.trust.reached,
        terminal=Terminal(lines="hanging"),
    )


def sections(facts: Facts, words: Language) -> list[Section]:
    """Return the sections of a sheet in the order in which they are read."""
    parts = [
        _numbers(facts, words),
        _worst(facts, words),
        _bearings(facts, words),
        _motions(facts, words),
        _frequencies(facts, words),
        _speeds(facts, words),
        _assumed(facts, words),
        _cautions(facts, words),
    ]
    return [section for section in parts if section.table or section.sentences]


def tiles(facts: Facts, words: Language) -> Iterator[Tile]:
    """Yield the numbers that are read first."""
    notch, section = facts.notch, facts.section
    if notch is not None and notch.fatigue is not None:
        look = "bad" if notch.fatigue < 1 else ""
        place = ", ".join([notch.place, *_corners(facts, words, "tile corner", "tile corners")])
        yield Tile(_safety(notch.fatigue, words), words.say("tile fatigue"), place, look)
    elif notch is not None:
        stress = words.text(notch.amplitude, STRESS, 3)
        yield Tile(stress, words.say("tile stress"), notch.place)
    elif section is not None:
        stress = words.text(section.equivalent, STRESS, 3)
        yield Tile(stress, words.say("tile nominal"), section.segment)
    lives = [bearing for bearing in facts.bearings if bearing.life is not None]
    if lives:
        worst = min(lives, key=lambda b: (b.life or math.inf) if b.hours is None else b.hours)
        yield Tile(_life(worst, words), words.say("tile life"), worst.name)
    if facts.motions:
        most = max(facts.motions, key=lambda motion: motion.size)
        moved = words.text(most.size, "m moved", 3)
        yield Tile(moved, words.say("tile motion"), most.place)
    if facts.frequencies:
        first = min(facts.frequencies, key=lambda frequency: frequency.hz)
        hertz = words.text(first.hz, "Hz", 4)
        yield Tile(hertz, words.say("tile frequency"), words.mode(first.mode))
    bar = (
        facts.trust.static_bar if facts.trust.static_bar is not None else facts.trust.frequency_bar
    )
    if bar is not None:
        yield Tile(words.bar(bar), words.say("tile trust"), words.model(facts.trust.model))


def verdict(facts: Facts, words: Language) -> Iterator[str]:
    """Yield sentences on the model that is trusted, and the cheapest that would do."""
    trust, model = facts.trust, words.model(facts.trust.model)
    shares = {"static": trust.static_bar, "frequency": trust.frequency_bar}
    bars = {name: words.percent(share) for name, share in shares.items() if share is not None}
    if not bars:
        yield words.say("trust nothing", model=model)
    else:
        yield words.say("trust", model=model)
        key = "both" if len(bars) == 2 else next(iter(bars))
        yield words.say(f"trust {key}", **bars, tolerance=words.percent(trust.tolerance))
    if not trust.demand:
        return
    demand = words.say(trust.demand)
    if trust.cheapest and trust.gap is not None:
        cheap, gap = words.model(trust.cheapest), words.percent(abs(trust.gap))
        yield words.say("cheapest", model=cheap, within=demand, off=gap)
    else:
        yield words.say("none cheaper", within=demand)


def _absent(facts: Facts, words: Language, key: str) -> tuple[str, ...]:
    remark = facts.absent.get(key)
    return () if remark is None else (_sentence(remark, words),)


def _sentence(remark: Remark, words: Language) -> str:
    """Return a remark as a sentence, lists of names joined."""
    values = {
        name: words.listed(value) if isinstance(value, tuple) and not _is_term(value) else value
        for name, value in remark.values.items()
    }
    return words.say(remark.key, **{name: _local(value, words) for name, value in values.items()})


def _is_term(value: Any) -> bool:
    return isinstance(value, (Amount, ModeTerm, Place, Speed, Term))


def _local(value: Any, words: Language) -> Any:
    """Return a number that is written already with the decimal mark of the language."""
    is_number = isinstance(value, str) and value.replace(".", "", 1).isdigit()
    return words.local(value) if is_number else value


def _numbers(facts: Facts, words: Language) -> Section:
    title = words.say("section numbers")
    if not facts.figures:
        sentences = _absent(facts, words, "figures") or (words.say("absent numbers"),)
        return Section("numbers", title, sentences=sentences)
    columns = [
        text(words.say("quantity")),
        Column(words.say("value")),
        Column(words.say("model error")),
        Column(words.say("open data")),
    ]
    rows: list[list[Any]] = []
    for figure in facts.figures[:MOST_ROWS]:
        si = "" if figure.unit == "1" else figure.unit
        value, bar = words.measured(figure.value, si, figure.bar)
        name = words.measure(figure.name) if facts.train else words.quantity(figure.name)
        cells = [Cell(figure.value, "strong", value.strip()), bar.strip()]
        rows.append([name, *cells, words.interval(figure.open)])
    notes = [words.say("note numbers")]
    if not facts.train and facts.drawn:
        port = (facts.drawn[0].scene.get("port") or {}).get("name", "")
        notes.insert(0, words.say("note at point", point=port))
    more = _more(len(facts.figures), MOST_ROWS, words)
    return Section("numbers", title, Table(title, columns, rows), (), (*more, *notes))


def _more(count: int, most: int, words: Language) -> tuple[str, ...]:
    return (words.say("more", count=count - most),) if count > most else ()


def _worst(facts: Facts, words: Language) -> Section:
    title, notch, section = words.say("section worst"), facts.notch, facts.section
    sentences = []
    if notch is not None:
        place = _of_shaft(notch.place, notch.shaft, facts, words)
        at_place = {"place": place, "y": Place(notch.y)}
        amplitude = Amount(notch.amplitude, STRESS)
        if notch.bar is None:
            sentences.append(words.say("worst nominal", amplitude=amplitude, **at_place))
        else:
            bar = Amount(notch.bar, STRESS, 2)
            sentences.append(words.say("worst notch", amplitude=amplitude, bar=bar, **at_place))
        if notch.open is not None:
            low, high = (Amount(end, STRESS) for end in notch.open)
            sentences.append(words.say("worst open", low=low, high=high))
        if notch.fatigue is not None and notch.yielding is not None:
            fatigue, yielding = (_safety(s, words) for s in (notch.fatigue, notch.yielding))
            sentences.append(words.say("worst rated", fatigue=fatigue, yielding=yielding))
        for other in notch.elsewhere:
            place = _of_shaft(other.place, other.shaft, facts, words)
            value = _safety(other.safety, words)
            key = LESSER[other.kind]
            sentences.append(words.say(key, place=place, y=Place(other.y), safety=value))
        if notch.least is not None:
            fatigue, yielding = (_safety(s, words) for s in notch.least)
            sentences.append(words.say("worst least", fatigue=fatigue, yielding=yielding))
    sentences += _absent(facts, words, "worst") + _absent(facts, words, "notch")
    sentences += _corners(facts, words, "worst corner", "worst corners")
    if section is not None:
        place = _of_shaft(section.segment, section.shaft, facts, words)
        stresses = {
            name: Amount(getattr(section, name), STRESS)
            for name in ("equivalent", "bending", "torsion")
        }
        sentences.append(words.say("worst section", segment=place, y=Place(section.y), **stresses))
    return Section("worst", title, sentences=tuple(sentences))


def _corners(facts: Facts, words: Language, single: str, several: str) -> Iterator[str]:
    """Yield the message on the sharp corners, which are not rated, by its key of one or of more."""
    places = [words.place(corner.y) for corner in facts.corners]
    if facts.train:
        places = [
            _of_shaft(place, corner.shaft, facts, words)
            for place, corner in zip(places, facts.corners)
        ]
    if places:
        key, more = single if len(places) == 1 else several, len(places) - MOST_CORNERS
        named = words.listed(tuple(places[:MOST_CORNERS])) + (f" + {more}" if more > 0 else "")
        yield words.say(key, count=len(places), places=named)


def _of_shaft(place: str, shaft: str, facts: Facts, words: Language) -> str:
    return words.say("of shaft", place=place, shaft=shaft) if facts.train else place


def _safety(value: float, words: Language) -> str:
    """Return a safety to two digits, and beyond any use as such."""
    return words.local(f"{value:.2f}") if value < 100 else "> 100"


def _life(bearing: BearingFact, words: Language) -> str:
    """Return a life in hours, or millions of revolutions where there is no speed."""
    if bearing.hours is not None:
        hours = bearing.hours
        unit = words.say("hours")
        return (
            f"{words.number(hours, '1', 3)} {unit}"
            if hours < ENDLESS
            else f"> {words.number(ENDLESS, '1', 1)} {unit}"
        )
    if bearing.life is None or not math.isfinite(bearing.life):
        return DASH
    return f"{words.number(bearing.life / 1e6, '1', 3)} {words.say('millions')}"


def _bearings(facts: Facts, words: Language) -> Section:
    title = words.say("section bearings")
    if not facts.bearings:
        return Section("bearings", title, sentences=(words.say("absent bearings"),))
    loaded = any(b.radial is not None for b in facts.bearings)
    lived = any(b.life is not None for b in facts.bearings)
    ranges = {bearing.name: _life_range(bearing, words) for bearing in facts.bearings}
    ranged = any(ends != DASH for ends in ranges.values())
    newton = words.units.unit("N")
    columns = [text(words.say("bearing")), word(words.say("type"))]
    if loaded:
        columns += [Column(f"{words.say(head)}, {newton}") for head in ("radial", "axial")]
    if lived:
        columns.append(Column(words.say("life")))
    if ranged:
        columns.append(Column(words.say("life range")))
    if lived:
        columns.append(Column(words.say("static")))
    rows = []
    for bearing in facts.bearings[:MOST_ROWS]:
        row: list[Any] = [bearing.name, bearing.designation or DASH]
        if loaded:
            row += [words.number(load, "N", 4) for load in (bearing.radial, bearing.axial)]
        if lived:
            row.append(Cell(bearing.hours, "strong", _life(bearing, words)))
        if ranged:
            row.append(ranges[bearing.name])
        if lived:
            safety = bearing.static_safety
            row.append(DASH if safety is None else _safety(safety, words))
        rows.append(row)
    kinds = {b.kind for b in facts.bearings if b.kind}
    notes = [words.say(f"note {kind}") for kind in sorted(kinds)]
    notes += [words.say("note table")] if any(b.over_table for b in facts.bearings) else []
    notes += [words.say("note range")] if ranged else []
    notes += [words.say("note static" if lived else "note no life")]
    more = _more(len(facts.bearings), MOST_ROWS, words)
    return Section("bearings", title, Table(title, columns, rows), (), (*more, *notes))


def _life_range(bearing: BearingFact, words: Language) -> str:
    """Return the ends of a life in the unit that it is most in."""
    if bearing.open is None or not bearing.life or not math.isfinite(bearing.life):
        return DASH
    unit = 1e6 if bearing.hours is None else bearing.life / bearing.hours
    ends = [end / unit for end in bearing.open]
    if any(end >= ENDLESS or not math.isfinite(end) for end in ends):
        return f"> {words.number(min(ends), '1', 3)}" if min(ends) < ENDLESS else DASH
    return words.between((ends[0], ends[1]), "1")


def _motions(facts: Facts, words: Language) -> Section:
    title = words.say("section motions")
    if not facts.motions:
        return Section("motions", title, sentences=_absent(facts, words, "motions"))
    ranged = any(m.open is not None for m in facts.motions)
    columns = [text(words.say("place")), text(""), Column(words.say("value"))]
    columns += [Column(words.say("model error"))]
    columns += [Column(words.say("open data"))] if ranged else []
    rows = []
    for motion in facts.motions[:MOST_MOTIONS]:
        across = motion.radial, motion.radial_bar, motion.open, "m moved"
        along = motion.axial, motion.axial_bar, motion.open_axial, "m moved"
        about = motion.tilt, motion.tilt_bar, motion.open_tilt, "rad moved"
        parts = (("across", across), ("along", along), ("tilt", about))
        for head, (size, bar, open_, si) in parts if motion.axial else (parts[0], parts[2]):
            share = bar / size if bar is not None and size else None
            value, error = words.measured(size, si, share)
            row: list[Any] = [motion.place, words.say(head), Cell(size, "strong", value), error]
            rows.append([*row, words.between(open_, si)] if ranged else row)
    more = _more(len(facts.motions), MOST_MOTIONS, words)
    notes = (*more, words.say("note motions"))
    return Section("motions", title, Table(title, columns, rows), (), notes)


def _frequencies(facts: Facts, words: Language) -> Section:
    title = words.say("section frequencies")
    if not facts.frequencies:
        return Section("frequencies", title, sentences=_absent(facts, words, "frequencies"))
    ranged = any(f.open is not None for f in facts.frequencies)
    columns = [text(words.say("mode")), Column("Hz"), Column(words.say("model error"))]
    columns += [Column(words.say("open data"))] if ranged else []
    rows = []
    for frequency in sorted(facts.frequencies, key=lambda f: f.hz)[:MOST_ROWS]:
        hertz = words.with_bar(frequency.hz, "Hz", frequency.bar).removesuffix(" Hz")
        value = Cell(frequency.hz, "strong", hertz)
        row = [words.mode(frequency.mode), value, words.bar(frequency.bar)]
        rows.append([*row, words.interval(frequency.open)] if ranged else row)
    notes = [words.say("note spin")]
    if facts.train and any(frequency.bar is None for frequency in facts.frequencies):
        notes.append(words.say("note no mesh bars", model=words.model(facts.trust.model)))
    return Section("frequencies", title, Table(title, columns, rows), (), tuple(notes))


def _speeds(facts: Facts, words: Language) -> Section:
    title = words.say("section speeds")
    if not facts.speed:
        return Section("speeds", title, sentences=_absent(facts, words, "speeds"))
    speed = Speed(facts.speed)
    first = words.say("turns", speed=speed)
    if facts.turns:
        first = words.say("turns of", shaft=facts.turns, speed=speed)
    met = [r for r in facts.resonances if abs(r.distance) <= NEAR]
    near = words.percent(NEAR)
    if not met and not facts.resonances:
        return Section("speeds", title, sentences=(first, words.say("speeds none", near=near)))
    if not met:
        nearest = facts.resonances[0]
        far = words.say("speeds far", near=near, **_meeting(nearest, words))
        return Section("speeds", title, sentences=(first, far))
    columns = [
        text(words.say("order")),
        text(words.say("mode")),
        Column(f"{words.say('avoid')}, /min"),
    ]
    rows = []
    for resonance in met[:MOST_ROWS]:
        ends = resonance.low * 30 / math.pi, resonance.high * 30 / math.pi
        meeting = _meeting(resonance, words)
        rows.append([meeting["order"], words.mode(resonance.mode), words.between(ends, "1", 4)])
    more = _more(len(met), MOST_ROWS, words)
    return Section("speeds", title, Table(title, columns, rows), (first,), more)


def _meeting(resonance: Resonance, words: Language) -> dict[str, Any]:
    """Return what a sentence on a resonance has in it."""
    values: dict[str, Any] = {"order": resonance.order, "source": resonance.source}
    key = "order of named shaft" if resonance.source else "order of shaft"
    if resonance.by_teeth:
        key, values["source"] = "order of mesh", words.mesh(resonance.source.removeprefix("mesh"))
    return {
        "order": words.say(key, **values),
        "mode": words.mode(resonance.mode),
        "critical": Speed(resonance.speed),
    }


def _assumed(facts: Facts, words: Language) -> Section:
    sentences = [_sentence(remark, words) for remark in facts.assumed]
    most = (*sentences[:MOST_SENTENCES], words.say("assumed elastic"))
    return Section("assumed", words.say("section assumed"), sentences=most)


def _cautions(facts: Facts, words: Language) -> Section:
    sentences = [_sentence(remark, words) for remark in facts.cautions]
    near = (r for r in facts.resonances if abs(r.distance) <= NEAR)
    for resonance in sorted(near, key=lambda r: abs(r.distance))[:1]:
        distance = words.percent(abs(resonance.distance))
        sentences.append(words.say("caution speed", off=distance, **_meeting(resonance, words)))
    most = sentences[:MOST_SENTENCES]
    if facts.elsewhere:
        most.append(words.say("elsewhere", count=facts.elsewhere))
    return Section("cautions", words.say("section cautions"), sentences=tuple(most))
