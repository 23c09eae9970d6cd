"""Two shafts beside each other: differences of the input, and the changes of numbers they cause.

Both are solved until every error bar is within a tenth of their tolerance, so that a difference
which matters is more than the error bars.  A frequency belongs to that of the mode of the same
shape where both shafts are described at the same stations, else to the mode of the same name.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from solidgear.core import (
    LADDER,
    QUANTITIES,
    BarredMode,
    Mode,
    OpenNumbers,
    Quantity,
    number_cautions,
    pinned,
    size,
)
from solidgear.core.judge.answer import LEAST_TOLERANCE
from solidgear.core.judge.change import Change, ModePair, all_pairs
from solidgear.core.judge.correlation import pair_modes
from solidgear.core.judge.quantities import in_order, judged
from solidgear.core.plain import plain
from solidgear.guards.one_shaft import OneShaft, Progress, one_shaft
from solidgear.show.open_words import interval
from solidgear.show.panel import GREY, Panel, Series, curve, lines_legend, readout
from solidgear.show.plot import BETWEEN, NARROW, WIDE, Chart, in_columns
from solidgear.show.run_tables import pairs_of
from solidgear.show.scales import Axis
from solidgear.show.sheet import Section, Sheet
from solidgear.show.sketch import extent, sketch_svg
from solidgear.show.table import WORD, Cell, Column, Table, in_units, text, word
from solidgear.show.units import ENGINEERING, Units, plain_unit
from solidgear.show.words import hertz, is_number, percent
from solidgear.trains.page.chart import PAIR
from solidgear.two_designs import beside
from solidgear.two_designs.beside import Beside, NumberChange
from solidgear.two_designs.differences import Difference, scene_differences
from solidgear.two_designs.loaded import BY, loaded_changes
from solidgear.variants.budget.budget import beside as open_numbers

if TYPE_CHECKING:
    from solidgear.core import Scene

#: share of the tolerance that the error bars of both are brought to
SHARE = 0.1
#: entries of the other plane that are those of the first unless bearings or features differ
TWINS = {
    Quantity(f"{kind}_{twin}"): Quantity(f"{kind}_{entry}")
    for kind in "CK"
    for twin, entry in (("xx", "zz"), ("x,thz", "z,thx"), ("thz", "thx"))
}
#: relative; twins closer than this are one number, and couplings this small beside their scale are
#: rounding
SAME = 1e-9
#: numbers that a sentence names as not resolved
NAMED = 4
#: words behind a difference, by its verdict
DOUBTS = {"resolved": "", "not resolved": "; not resolved", "no band": "; no error bar"}
NEITHER = "Neither is better in the numbers"
SHAPES = (
    "Motions of sections along both shafts in the lowest pairs of modes, in the plane of the "
    "largest, scaled to one."
)


@dataclass(frozen=True, repr=False, eq=False)
class TwoShafts(Beside[OneShaft, BarredMode]):
    """Two shafts beside each other.

    Attributes
    ----------
    a, b : OneShaft
        Also as ``both``, with their ``cautions``.
    inputs : tuple of Difference
        Entries in which their files, or fields, differ.
    changes : tuple of NumberChange
        Mass, entries of C and K at the lumped points, first frequencies.
    loaded : tuple of NumberChange
        Motions and bearing loads under the loads of both; empty where one has none.
    modes : tuple of ModePair
        By frequency.
    pairing : str
        How modes are paired, in words.
    """

    shown: ClassVar[str] = "two_designs.two_shafts:summary"
    kind: ClassVar[str] = "two shafts"

    tolerance: float  #: relative, that every error bar was brought to
    alone: dict[str, tuple[str, ...]]  #: names of numbers that one shaft alone has, by its letter
    open: tuple[OpenNumbers, OpenNumbers]  #: ranges that the input data of each leave open
    loaded: tuple[NumberChange, ...] = ()
    why_unloaded: str = ""  #: reason why loads of both bring no numbers, a sentence

    @property
    def asks(self) -> bool:
        """True where a scene lists the numbers it asks for."""
        return any(shaft.scene.ask.quantities for shaft in self.both)

    @property
    def asked(self) -> list[NumberChange]:
        """Numbers that either scene asks for; the usual ones where none does."""
        names = [
            name
            for shaft in self.both
            if shaft.scene.ask.quantities or not self.asks
            for name in judged(shaft.scene)
        ]
        by_name = {number.name: number for number in self.changes}
        return [by_name[name] for name in dict.fromkeys(names) if name in by_name]

    def told(self, units: Units = ENGINEERING) -> list[str]:
        """Return the conclusions, with their numbers in the given units."""
        return [
            *_asked(self, units),
            beside.inputs(self.inputs),
            *_numbers(self, units),
            *_under_loads(self, units),
            *beside.modes(self.modes, "among the modes solved of the other"),
            *_alone(self),
            *_solved(self),
        ]

    def sheet(self, units: Units = ENGINEERING) -> Sheet:
        """Return the sheet of terminal, page and JSON."""
        printed = [
            beside.input_table(self, beside.SHORT),
            numbers_table(self, units),
            *loaded_tables(self, units),
            beside.mode_table(self),
        ]
        if self.asks:
            printed.insert(0, asked_table(self, units))
        words = {"shapes": SHAPES}
        sections = _sections(self, units)
        return beside.sheet(self, units, sections, printed, sentences_first=True, words=words)

    def data(self) -> dict[str, Any]:
        """Return the JSON data of shafts alone."""
        return {
            "shafts": {
                letter: {
                    "file": shaft.name,
                    "title": shaft.title,
                    "scene": shaft.scene.as_dict(),
                    "solved": shaft.settled,
                }
                for letter, shaft in self.by_letter.items()
            },
            "tolerance": self.tolerance,
            "numbers": {number.name: _number(number) for number in self.changes},
            "asked": {number.name: number.better or None for number in self.asked},
            "open": dict(zip("ab", self.open)),
            "alone": {letter.lower(): names for letter, names in self.alone.items()},
        } | (
            {"under_loads": {number.name: _number(number) for number in self.loaded}}
            if self.loaded
            else {}
        )


def _number(number: NumberChange) -> dict[str, Any]:
    out = plain(number.change) | {"relative": number.relative, "unit": number.unit}
    out["scale"] = number.scale
    if number.partner:
        out["mode_of_b"] = number.partner
    return out


def summary(pair: TwoShafts) -> Table:
    """Return numbers of two shafts, their differences and verdicts."""
    rows = [
        (
            *(n.name, n.change.a, n.change.b, n.unit),
            *(Cell(n.relative, "", percent(n.relative)), n.verdict),
            *(n.change.bar_a, n.change.bar_b),
        )
        for n in pair.changes
    ]
    heads = [
        *("number", "A", "B", "unit", "difference"),
        Column("", name="verdict"),
        *(Column(f"{letter} error bar", hidden=True) for letter in "AB"),
    ]
    return Table(f"{pair.a.label} beside {pair.b.label}", heads, rows)


@pinned
def two_shafts(
    scenes: Sequence[Scene],
    names: Sequence[str] = (),
    inputs: Sequence[Difference] | None = None,
    progress: Progress = lambda _: None,
) -> TwoShafts:
    """Compare two shafts, each by the cheapest solid whose error bars are within a tenth of the
    smaller tolerance of both; names default to those of the scenes, inputs to the fields that
    differ.
    """
    start = perf_counter()
    first, second = scenes
    tol = max(SHARE * min(s.ask.tolerance for s in scenes), LEAST_TOLERANCE)
    second_points = {port.name for port in second.further_ports}
    points = [port.name for port in first.further_ports if port.name in second_points]
    shafts = []
    for letter, name, scene in zip("AB", names or [s.name for s in scenes], scenes):
        shaft = one_shaft(scene, tol, letter, name, points, progress=progress)
        shaft.settled.body.cache.clear()
        shown = [str(mode.name) for mode in shaft.modes.modes if mode.frequency_hz > 0]
        bars = {name: shaft.bars.get(name) for name in shown}
        said = number_cautions(scene, bars, shaft.settled.rung)
        shafts.append(replace(shaft, cautions=(*shaft.cautions, *said)))
    a, b = shafts
    pairs, pairing = _paired(a, b)
    progress("under the loads")
    loaded, why_unloaded = loaded_changes(scenes)
    progress("what the data leave open")
    return TwoShafts(
        a=a,
        b=b,
        inputs=tuple(scene_differences(first, second) if inputs is None else inputs),
        changes=tuple(_changes(a, b, pairs)),
        modes=tuple(pairs),
        pairing=pairing,
        tolerance=tol,
        alone={
            shaft.letter: tuple(str(q) for q in in_order(shaft.values) if q not in values)
            for shaft, values in ((a, b.values), (b, a.values))
        },
        open=(open_numbers(first), open_numbers(second)),
        loaded=loaded,
        why_unloaded=why_unloaded,
        seconds=perf_counter() - start,
    )


def _changes(
    a: OneShaft, b: OneShaft, pairs: Sequence[ModePair[BarredMode]]
) -> Iterator[NumberChange]:
    """Yield the mass, entries of C and K, and the first frequencies, each beside that of the
    partner of the mode.
    """
    bar_a, bar_b = a.mass_bar, b.mass_bar
    yield NumberChange("mass", "kg", Change(a.mass, b.mass, bar_a, bar_b), a.mass)
    for name in in_order(a.values):
        if name.is_frequency or name not in b.values or _twin(a, name) and _twin(b, name):
            continue
        change = Change(a.values[name], b.values[name], a.bar(name), b.bar(name))
        yield NumberChange(str(name), name.unit, change, size(a.values, name))
    partners = {p.a.name: (p.b.name, p.change) for p in pairs if p.a and p.b and p.change}
    for name in (q for q in QUANTITIES if q.is_frequency):
        mode = a.modes.named(name)
        if mode is None or str(mode.name) not in partners:
            continue
        partner, change = partners[str(mode.name)]
        partner = "" if partner == mode.name else partner
        yield NumberChange(str(name), "Hz", change, abs(change.a), partner)


def _twin(shaft: OneShaft, name: Quantity) -> bool:
    """Return True for an entry of the other plane that repeats that of the first plane."""
    if name not in TWINS or TWINS[name] not in shaft.values:
        return False
    twin = TWINS[name]
    difference = abs(abs(shaft.values[name]) - abs(shaft.values[twin]))
    return difference <= SAME * size(shaft.values, twin)


def _paired(a: OneShaft, b: OneShaft) -> tuple[list[ModePair[BarredMode]], str]:
    """Return modes of both lists with their partners, and in words how they were paired."""
    modes_a, modes_b = (
        [shaft.seen(m) for m in shaft.modes.whole.modes if m.frequency_hz > 0] for shaft in (a, b)
    )
    same_shape: list[ModePair[BarredMode]] = []
    words = "by name, since the shafts are not divided at the same places along the axis"
    stations = a.modes.stations, b.modes.stations
    if stations[0].shape == stations[1].shape and np.allclose(stations[0], stations[1]):
        words = "by the motions of sections along the axis, or by name where no shape is certain"
        for p in pair_modes(b.modes, a.modes):
            partners = [m for m in (p.mode, *p.others) if m is not None and p.certain]
            same_shape += [
                ModePair(a.seen(p.reference), b.seen(m), p.mac or None) for m in partners
            ]
    listed = [{str(m.name) for m in shaft.modes.modes} for shaft in (a, b)]
    # a partner above the end of the other list is none that is missing
    end = min(max((m.frequency_hz for m in modes), default=0.0) for modes in (modes_a, modes_b))
    pairs = [
        pair
        for pair in all_pairs(same_shape, modes_a, modes_b, lambda mode: mode.name)
        if any(m is not None and m.name in names for m, names in zip((pair.a, pair.b), listed))
        and (pair.change is not None or pair.within(end))
    ]
    return pairs, words


# ---------------------------------------------------------------------- sentences
def _asked(shafts: TwoShafts, units: Units) -> Iterator[str]:
    """Yield a sentence for each number asked for, and one on which shaft is better in how many."""
    if not shafts.asks:
        return
    for number in shafts.asked:
        verdict = f"{number.better} is better" if number.better else "neither is better"
        change = _change_text(number, units).removeprefix(f"{number.name}, ")
        yield f"{number.name}: {verdict}, {change}{_open_ranges(shafts, number)}."
    if count := len(shafts.asked):
        score = {letter: sum(n.better == letter for n in shafts.asked) for letter in "AB"}
        first, last = sorted(score, key=lambda letter: -score[letter])
        everything = {1: "the number", 2: "both numbers"}.get(count, f"all {count} numbers")
        share = everything if score[first] == count else f"{score[first]} of {count} numbers"
        second = f" and {last} in {score[last]}" if score[last] else ""
        best = f"{first} is better in {share}" if score[first] else NEITHER
        yield f"{best} asked for{second}, if stiffer and higher in frequency is better."


def _open_ranges(shafts: TwoShafts, number: NumberChange) -> str:
    """Return the ranges of a number by what the data of both leave open, and whether these exceed
    the difference.
    """
    ranges = {
        letter: record.total
        for letter, numbers in zip("AB", shafts.open)
        if (record := numbers.of(number.name)) is not None
    }
    if not ranges:
        return ""
    words = " and ".join(f"{interval(total)} in {letter}" for letter, total in ranges.items())
    widest = max(abs(end or 0.0) for total in ranges.values() for end in (total.low, total.high))
    more = ", which is more than the difference" if widest > _size(number) else ""
    return f"; range from the data {words}{more}"


def _numbers(shafts: TwoShafts, units: Units) -> Iterator[str]:
    statics = [number for number in shafts.changes if number.unit not in ("Hz", "kg")]
    yield from beside.resolved([n.change for n in statics], "compliances and stiffnesses")
    moved = [n for n in statics if n.verdict != "not resolved" and n.relative is not None]
    if moved:
        yield f"Largest change: {_change_text(max(moved, key=_size), units)}."
    unsure = [n for n in shafts.changes if n.verdict == "not resolved" and n.change.difference]
    if unsure:
        names = ", ".join(number.name for number in unsure[:NAMED])
        more = f" and {len(unsure) - NAMED} more" if len(unsure) > NAMED else ""
        yield f"Changed by less than both error bars: {names}{more}."
    yield f"Mass of the shaft: {_change_text(shafts['mass'], units)}."


def _under_loads(shafts: TwoShafts, units: Units) -> Iterator[str]:
    """Yield the changes of deflections under the loads, or the reason why there are none."""
    if shafts.why_unloaded:
        yield shafts.why_unloaded
    moved = [number for number in shafts.loaded if number.unit == "m moved"]
    if moved:
        words = "; ".join(_change_text(number, units) for number in moved)
        yield f"Under the loads of each: {words}."


def _size(number: NumberChange) -> float:
    return abs(number.relative or 0.0)


def _change_text(number: NumberChange, units: Units) -> str:
    change = number.change
    if change.difference == 0.0:
        return f"{units.text(change.a, number.unit, 5)} in both"
    values = f"{units.number(change.a, number.unit, 5)} to {units.text(change.b, number.unit, 5)}"
    name = bars = ""
    if number.unit != "kg":
        name = f"{number.name}, "
        if change.band:
            bars = f", both error bars {percent(change.band / number.scale, signed=False)}"
    return f"{name}from {values} ({percent(number.relative)}{bars}{DOUBTS[number.verdict]})"


def _alone(shafts: TwoShafts) -> Iterator[str]:
    for letter, names in shafts.alone.items():
        if names:
            yield f"Only {letter} has {', '.join(names)}."
    points = [shaft.scene.port.name for shaft in shafts.both]
    if points[0] != points[1]:
        yield f"The lumped point is {points[0]} of A and {points[1]} of B."


def _solved(shafts: TwoShafts) -> Iterator[str]:
    titles = [LADDER[shaft.settled.rung].title for shaft in shafts.both]
    by = f"Both by the {titles[0]}"
    if titles[0] != titles[1]:
        by = f"A by the {titles[0]}, B by the {titles[1]}"
    tolerances = {shaft.scene.ask.tolerance for shaft in shafts.both}
    smaller = "the smaller tolerance of both" if len(tolerances) > 1 else "the tolerance of both"
    yield f"{by}, to error bars of {percent(shafts.tolerance, signed=False)}: a tenth of {smaller}."
    for shaft in shafts.both:
        largest = shaft.settled.largest
        if not shaft.settled.reached and largest is None:
            yield f"{shaft.letter} has no error bars."
        elif not shaft.settled.reached and largest is not None:
            name, bar = largest
            width = percent(bar, signed=False) if is_number(bar) else "unknown"
            yield f"Not reached by {shaft.letter}: the largest error bar is {width}, of {name}."
    if any(b.catalogue is not None for shaft in shafts.both for b in shaft.scene.bearings):
        yield "Error bars are for mesh and solver, not for open data of catalogue bearings."


# ---------------------------------------------------------------------- page
def _sections(pair: TwoShafts, units: Units) -> list[Section]:
    scenes = {letter: shaft.scene.as_dict() for letter, shaft in pair.by_letter.items()}
    longest, thickest = (max(sizes) for sizes in zip(*map(extent, scenes.values())))
    drawings = {
        f"{shaft.label}, section through the axis.": sketch_svg(
            f"shaft_{letter}", scenes[letter], (longest, thickest)
        )
        for letter, shaft in pair.by_letter.items()
    }
    title = "What was asked" if pair.asks else "The usual numbers"
    solved = [_solution(side) for side in pair.both]
    machine = pairs_of(pair.results["environment"], "Environment of the run")
    shapes = {"shapes": partial(shapes_chart, pair, units)}
    return [
        Section("asked", title, tables=[asked_table(pair, units)]),
        beside.input_section(pair),
        Section("shafts", "Both shafts", "Both to one scale.", drawings=drawings),
        Section(
            "numbers", "Numbers", tables=[numbers_table(pair, units), *loaded_tables(pair, units)]
        ),
        Section("modes", "Modes", "", shapes, [beside.mode_table(pair)], filed=()),
        Section("run", "Run", tables=[*solved, machine]),
    ]


def asked_table(pair: TwoShafts, units: Units = ENGINEERING) -> Table:
    """Return numbers asked for: both values, error bars, ranges by open data, and which is better."""
    columns = _columns(units)
    note = (
        "Better: stiffer, or higher in frequency, by more than both error bars; couplings have "
        "none."
    )
    for letter, numbers in zip("AB", pair.open):
        if numbers.inputs:
            columns.append(Column(f"open in {letter}", partial(_open, numbers)))
    if any(numbers.inputs for numbers in pair.open):
        note += (
            " Open: range by bearings and other open data of that design, by the Timoshenko beam, "
            "relative to its number."
        )
    columns.append(word("better", lambda number: number.better or "-"))
    title = "Numbers asked for" if pair.asks else "Usual numbers"
    return Table(title, columns, pair.asked, note, style="ruled")


def _open(numbers: OpenNumbers, number: NumberChange) -> str | None:
    """Return the range of a number by open data."""
    record = numbers.of(number.name)
    return None if record is None else interval(record.total)


def numbers_table(pair: TwoShafts, units: Units = ENGINEERING) -> Table:
    """Return the mass, compliances, stiffnesses and first frequencies side by side."""
    verdict = Column("", lambda n: None if _alike(n) else n.verdict, kind=WORD, name="verdict")
    columns = [*_columns(units), verdict]
    note = (
        "Differences and error bars are relative to A, for couplings to the geometric mean of "
        "both diagonal entries of A. Resolved: more than the sum of both error bars; not resolved "
        "is not agreement. The mass is the shaft's alone, and exact for a round one."
    )
    return Table("Numbers", columns, pair.changes, note, style="ruled")


def loaded_tables(pair: TwoShafts, units: Units = ENGINEERING) -> list[Table]:
    """Return numbers of both under their loads; none where one has no load."""
    if not pair.loaded:
        return []
    verdict = Column("", lambda n: n.verdict if n.change.band else None, kind=WORD, name="verdict")
    note = (
        f"Sizes across the shaft at lumped points, and of bearing loads, {BY}, each "
        "in the case of its loads that was chosen, by default its first. Error bars are for the mesh; loads of bearings have none."
    )
    return [Table("Under the loads", [*_columns(units), verdict], pair.loaded, note, style="ruled")]


def _columns(units: Units) -> list[Column]:
    """Return columns of both numbers with their error bars."""
    return [
        text("number", lambda n: n.name + (f" (B: {n.partner})" if n.partner else "")),
        Column("A", lambda n: _value(n, n.change.a, units)),
        Column("B", lambda n: _value(n, n.change.b, units)),
        text("unit", lambda n: Cell(plain_unit(n.unit), "", units.unit(n.unit))),
        Column("difference", _difference),
        Column("error bar of A", lambda n: _bar(n, n.change.bar_a)),
        Column("error bar of B", lambda n: _bar(n, n.change.bar_b)),
    ]


def _alike(number: NumberChange) -> bool:
    """Return True for an exact number that both share."""
    return number.name == "mass" and number.change.difference == 0


def _difference(number: NumberChange) -> Cell:
    if _alike(number):
        return Cell(0.0, "", percent(0.0))
    return beside.relative(number.change, number.scale or abs(number.change.a))


def _value(number: NumberChange, value: float, units: Units) -> Cell:
    # a coupling that symmetry forbids is nothing but rounding
    if abs(value) <= SAME * number.scale:
        return Cell(0.0, "", "0")
    return in_units(value, number.unit, units, 6)


def _bar(number: NumberChange, width: float | None) -> Cell | None:
    if number.name == "mass" or not is_number(width) or not number.scale:
        return None
    share = width / number.scale
    return Cell(share, "", percent(share, signed=False))


def _solution(shaft: OneShaft) -> Table:
    """Return the model, mesh and size."""
    settled = shaft.settled
    facts = {
        "model": settled.rung,
        "mesh": settled.setting,
        "unknowns": settled.body.size,
        "error bars asked for": percent(settled.tolerance, signed=False),
        "reached": "yes" if settled.reached else "no",
    }
    return pairs_of(facts, f"Solution of {shaft.label}")


#: components of section motions that show a family
SHOWN = {"bending": (0, 2), "axial": (1,), "torsion": (4,)}
#: pairs that are drawn, the lowest
MOST = 8


def shapes_chart(
    shafts: TwoShafts, units: Units = ENGINEERING, width: float = WIDE
) -> Chart | None:
    """Chart motions of sections along both shafts in the lowest pairs of modes, scaled to one."""
    by_name = [
        {str(m.name): m for m in shaft.modes.solved if m.family in SHOWN} for shaft in shafts.both
    ]
    drawn = [
        (beside.mode_label(pair), [by_name[0][pair.a.name], by_name[1][pair.b.name]])
        for pair in shafts.modes
        if pair.a is not None
        and pair.b is not None
        and pair.a.name in by_name[0]
        and pair.b.name in by_name[1]
    ]
    looks = {shaft.label: Series(colour) for shaft, colour in zip(shafts.both, PAIR)}
    last = max(units.values(shaft.modes.stations, "m").max() for shaft in shafts.both)
    columns = 2 if width > NARROW and len(drawn) > 1 else 1
    panels = []
    for k, (title, partners) in enumerate(drawn[:MOST]):
        panel = Panel(
            Axis(f"y in {units.unit('m')}", (0.0, float(last))),
            Axis("", (-1.1, 1.1)),
            130.0,
            title,
            series=looks,
            legend=lines_legend(2) if k == 0 else None,
        )
        panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
        lines = _lines(shafts.both, partners)
        for shaft, mode, line in zip(shafts.both, partners, lines):
            words = readout(shaft.label, ("frequency", hertz(mode.frequency_hz), "Hz"))
            along = units.values(shaft.modes.stations, "m")
            panel.draw("line", curve(along, line, name=shaft.label))
            panel.read(curve(along, line, readout=words), looks[shaft.label].colour)
        panels.append(panel)
    if len(panels) % columns:  # as wide as those above it
        panels[-1].right += (width + BETWEEN) / columns
    return Chart(in_columns(panels, columns), width) if panels else None


def _lines(shafts: Sequence[OneShaft], modes: Sequence[Mode]) -> list[np.ndarray]:
    """Return motions of sections of each shaft in the plane of the largest, scaled to one, with the
    same sign.
    """
    lines = []
    for mode in modes:
        motions = mode.motions[0][:, SHOWN[mode.family]]
        line = motions @ np.linalg.svd(motions, full_matrices=False)[2][0]
        lines.append(line / max(np.abs(line).max(), 1e-300))
    # along their lengths, which may differ
    a, b = (shaft.modes.stations / shaft.modes.stations.max() for shaft in shafts)
    if np.interp(b, a, lines[0]) @ lines[1] < 0:
        lines[1] = -lines[1]
    return lines
