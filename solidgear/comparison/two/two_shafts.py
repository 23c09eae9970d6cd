"""Two shafts beside each other: differences of the input, and the changes of numbers they cause.

Both are solved until every error bar is within a tenth of their tolerance, so that a difference
which matters is more than the error bars.  A frequency belongs to that of the mode of the same
shape where both shafts are described at the same stations, else to the mode of the same name.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from solidgear.comparison.two import beside
from solidgear.comparison.two.beside import Beside
from solidgear.comparison.two.differences import Difference, scene_differences
from solidgear.comparison.two.two_shafts_page import write_two_shafts
from solidgear.core import (
    COMPLIANCE,
    LADDER,
    QUANTITIES,
    BarredMode,
    Displayed,
    ModeSet,
    OpenNumbers,
    Quantity,
    pinned,
    size,
)
from solidgear.core.judge.answer import LEAST_TOLERANCE
from solidgear.core.judge.change import Change, ModePair, all_pairs
from solidgear.core.judge.correlation import pair_modes
from solidgear.core.judge.quantities import in_order, judged
from solidgear.core.machine.environment import environment
from solidgear.core.plain import plain
from solidgear.guards.one_shaft import OneShaft, Progress, one_shaft
from solidgear.show.open_words import interval
from solidgear.show.units import ENGINEERING, Units, units_named
from solidgear.show.words import is_number, percent
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
#: relative; twins closer than this are one number
SAME = 1e-9
#: numbers that a sentence names as not resolved
NAMED = 4
#: words behind a difference, by its verdict
DOUBTS = {"resolved": "", "not resolved": "; not resolved", "no band": "; no error bar"}
NEITHER = "Neither is better in the numbers"


@dataclass(frozen=True)
class NumberChange:
    """A number of both shafts."""

    name: str  #: quantity, or ``mass``
    unit: str  #: SI
    change: Change
    #: the difference is relative to this: for couplings the geometric mean of both diagonal
    #: entries of A, else the number of A
    scale: float
    partner: str = ""  #: name of the mode of B where that is another one, else nothing

    @property
    def relative(self) -> float | None:
        """Difference over the scale; None where that is zero."""
        return self.change.difference / self.scale if self.scale else None

    @property
    def verdict(self) -> str:
        """``resolved``, ``not resolved`` or ``no band``."""
        return self.change.verdict

    @property
    def better(self) -> str:
        """Letter of the shaft that is stiffer, or higher in frequency, by more than both error
        bars; empty where neither is.
        """
        name = Quantity(self.name)
        if self.verdict != "resolved" or name.is_coupling:
            return ""
        return "B" if (self.change.difference > 0) != (name.kind == COMPLIANCE) else "A"


@dataclass(frozen=True, repr=False, eq=False)
class TwoShafts(Beside[OneShaft, BarredMode], Displayed):
    """Two shafts beside each other.

    Attributes
    ----------
    a, b : OneShaft
        Also as ``both``, with their ``cautions``.
    inputs : tuple of Difference
        Entries in which their files, or fields, differ.
    modes : tuple of ModePair
        By frequency.
    pairing : str
        How modes are paired, in words.
    """

    shown: ClassVar[str] = "two_shafts"

    tolerance: float  #: relative, that every error bar was brought to
    #: mass, entries of C and K at the lumped points, first frequencies
    changes: tuple[NumberChange, ...]
    alone: dict[str, tuple[str, ...]]  #: names of numbers that one shaft alone has, by its letter
    open: tuple[OpenNumbers, OpenNumbers]  #: ranges that the input data of each leave open

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

    def __getitem__(self, name: str) -> NumberChange:
        return next(number for number in self.changes if number.name == name)

    @property
    def sentences(self) -> list[str]:
        """Conclusions in engineering units."""
        return self.told()

    def told(self, units: Units = ENGINEERING) -> list[str]:
        """Return the conclusions, with their numbers in the given units."""
        return sentences(self, units)

    @cached_property
    def results(self) -> dict[str, Any]:
        """Plain data that JSON can hold, SI."""
        return results(self)

    def write_report(self, out: str | os.PathLike, *, units: str = "engineering") -> Path:
        """Write results.json and report.html into a folder.

        Parameters
        ----------
        out : path
            The folder.
        units : {'engineering', 'si', 'us'}
            Units of the page; results.json is SI always.

        Returns
        -------
        pathlib.Path
            The page.

        Raises
        ------
        SolidgearError
            If the folder cannot be written, or units are unknown.
        """
        return write_two_shafts(self, out, units_named(units))


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
    a, b = (
        _settled(scene, tol, letter, name, points, progress)
        for letter, name, scene in zip("AB", names or [s.name for s in scenes], scenes)
    )
    pairs, pairing = _paired(a, b)
    changes = (_mass(a, b), *_statics(a, b), *_frequencies(a, b, pairs))
    differ = tuple(scene_differences(first, second) if inputs is None else inputs)
    alone = {
        shaft.letter: tuple(str(q) for q in in_order(shaft.values) if q not in neighbour.values)
        for shaft, neighbour in ((a, b), (b, a))
    }
    progress("what the data leave open")
    ranges = open_numbers(first), open_numbers(second)
    spent = perf_counter() - start
    return TwoShafts(
        a=a,
        b=b,
        inputs=differ,
        modes=tuple(pairs),
        pairing=pairing,
        seconds=spent,
        tolerance=tol,
        changes=changes,
        alone=alone,
        open=ranges,
    )


def _settled(
    scene: Scene, tol: float, letter: str, name: str, points: list[str], progress: Progress
) -> OneShaft:
    shaft = one_shaft(scene, tol, letter, name, points, progress=progress)
    shaft.settled.body.cache.clear()
    return shaft


def _mass(a: OneShaft, b: OneShaft) -> NumberChange:
    bar_a, bar_b = (
        None if shaft.mass_bar is None else shaft.mass_bar * shaft.mass for shaft in (a, b)
    )
    return NumberChange("mass", "kg", Change(a.mass, b.mass, bar_a, bar_b), a.mass)


def _statics(a: OneShaft, b: OneShaft) -> Iterable[NumberChange]:
    for name in in_order(a.values):
        if name.is_frequency or name not in b.values or _twin(a, name) and _twin(b, name):
            continue
        change = Change(a.values[name], b.values[name], a.bar(name), b.bar(name))
        yield NumberChange(str(name), name.unit, change, size(a.values, name))


def _twin(shaft: OneShaft, name: Quantity) -> bool:
    """Return True for an entry of the other plane that repeats that of the first plane."""
    if name not in TWINS or TWINS[name] not in shaft.values:
        return False
    twin = TWINS[name]
    difference = abs(abs(shaft.values[name]) - abs(shaft.values[twin]))
    return difference <= SAME * size(shaft.values, twin)


def _frequencies(
    a: OneShaft, b: OneShaft, pairs: Sequence[ModePair[BarredMode]]
) -> Iterable[NumberChange]:
    """Yield the first frequencies, each beside that of the partner of the mode."""
    partners = {p.a.name: (p.b.name, p.change) for p in pairs if p.a and p.b and p.change}
    for name in (q for q in QUANTITIES if q.is_frequency):
        mode = a.modes.named(name)
        if mode is None or str(mode.name) not in partners:
            continue
        partner_name, change = partners[str(mode.name)]
        partner = "" if partner_name == mode.name else partner_name
        yield NumberChange(str(name), "Hz", change, abs(change.a), partner)


def _paired(a: OneShaft, b: OneShaft) -> tuple[list[ModePair[BarredMode]], str]:
    """Return modes of both lists with their partners, and in words how they were paired."""
    modes_a, modes_b = (
        [shaft.seen(m) for m in shaft.modes.whole.modes if m.frequency_hz > 0] for shaft in (a, b)
    )
    same_shape: list[ModePair[BarredMode]] = []
    words = "by name, since the shafts are not divided at the same places along the axis"
    if _same_stations(a.modes, b.modes):
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


def _same_stations(a: ModeSet, b: ModeSet) -> bool:
    same = a.stations.shape == b.stations.shape
    return same and bool(np.allclose(a.stations, b.stations))


def sentences(shafts: TwoShafts, units: Units = ENGINEERING) -> list[str]:
    """Return the conclusions: which shaft is better in the numbers asked for, differences of the
    input, changes of numbers and which are resolved, and how both were solved.
    """
    return [
        *_asked(shafts, units),
        beside.inputs(shafts.inputs),
        *_numbers(shafts, units),
        *beside.modes(shafts.modes, "among the modes solved of the other"),
        *_alone(shafts),
        *_solved(shafts),
    ]


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
        better = f"{first} is better in {share}" if score[first] else NEITHER
        yield f"{better} asked for{second}, if stiffer and higher in frequency is better."


def _open_ranges(shafts: TwoShafts, number: NumberChange) -> str:
    """Return the ranges of a number by what the data of both leave open, and whether these exceed
    the difference.
    """
    records = [numbers.of(number.name) for numbers in shafts.open]
    ranges = {
        letter: interval(record.total)
        for letter, record in zip("AB", records)
        if record is not None
    }
    if not ranges:
        return ""
    words = " and ".join(f"{range_} in {letter}" for letter, range_ in ranges.items())
    widest = max(abs(end or 0.0) for r in records if r for end in (r.total.low, r.total.high))
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
    doubt = DOUBTS[number.verdict]
    return f"{name}from {values} ({percent(number.relative)}{bars}{doubt})"


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
    asked = {shaft.scene.ask.tolerance for shaft in shafts.both}
    smaller = "the smaller tolerance of both" if len(asked) > 1 else "the tolerance of both"
    yield f"{by}, to error bars of {percent(shafts.tolerance, signed=False)}: a tenth of {smaller}."
    for shaft in shafts.both:
        if not shaft.settled.reached:
            yield _not_reached(shaft)
    if any(b.catalogue is not None for shaft in shafts.both for b in shaft.scene.bearings):
        yield "Error bars are for mesh and solver, not for open data of catalogue bearings."


def _not_reached(shaft: OneShaft) -> str:
    largest = shaft.settled.largest
    if largest is None:
        return f"{shaft.letter} has no error bars."
    name, bar = largest
    width = percent(bar, signed=False) if is_number(bar) else "unknown"
    return f"Not reached by {shaft.letter}: the largest error bar is {width}, of {name}."


def results(shafts: TwoShafts) -> dict[str, Any]:
    """Return all numbers of the page as plain data that JSON can hold, SI."""
    return {
        "kind": "two shafts",
        "shafts": {shaft.letter.lower(): _shaft(shaft) for shaft in shafts.both},
        "tolerance": shafts.tolerance,
        "differences": plain(shafts.inputs),
        "sentences": sentences(shafts),
        "numbers": {number.name: _number(number) for number in shafts.changes},
        "asked": {number.name: number.better or None for number in shafts.asked},
        "open": {
            letter: numbers.model_dump(mode="json") for letter, numbers in zip("ab", shafts.open)
        },
        "paired": shafts.pairing,
        "modes": plain(shafts.modes),
        "alone": {letter.lower(): list(names) for letter, names in shafts.alone.items()},
        "cautions": shafts.cautions,
        "environment": environment(),
        "seconds_total": shafts.seconds,
    }


def _shaft(shaft: OneShaft) -> dict[str, Any]:
    return {
        "file": shaft.name,
        "title": shaft.scene.title or shaft.scene.name,
        "scene": shaft.scene.as_dict(),
        "solved": plain(shaft.settled),
    }


def _number(number: NumberChange) -> dict[str, Any]:
    out = plain(number.change) | {"relative": number.relative, "unit": number.unit}
    out["scale"] = number.scale if math.isfinite(number.scale) else None
    if number.partner:
        out["mode_of_b"] = number.partner
    return out
