"""Conclusions of the comparison of two shafts in sentences, and all of it as plain data."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from solidgear.ladder.registry import LADDER
from solidgear.machine.environment import environment
from solidgear.report.open_words import interval
from solidgear.report.units import ENGINEERING, Units
from solidgear.report.words import is_number, percent
from solidgear.studies import beside

if TYPE_CHECKING:
    from solidgear.studies.one_shaft import OneShaft
    from solidgear.studies.two_shafts import NumberChange, TwoShafts

#: numbers that a sentence names as not resolved
NAMED = 4


def sentences(found: TwoShafts, units: Units = ENGINEERING) -> list[str]:
    """Conclusions: which is better in what is asked, what differs, what that does, what of it is
    resolved, and how it was solved.
    """
    return [
        *_asked(found, units),
        beside.inputs(found.inputs),
        *_numbers(found, units),
        *beside.modes(found.modes, "among the modes solved of the other"),
        *_alone(found),
        *_solved(found),
    ]


def _asked(found: TwoShafts, units: Units) -> Iterator[str]:
    """The numbers that were asked for, one a sentence, and which design is better in how many."""
    if not found.asks:
        return
    for one in found.asked:
        verdict = f"{one.better} is better" if one.better else "neither is better"
        yield f"{one.name}: {verdict}, {_told(one, units).removeprefix(f'{one.name}, ')}{_left_open(found, one)}."
    if count := len(found.asked):
        score = {letter: sum(one.better == letter for one in found.asked) for letter in "AB"}
        first, last = sorted(score, key=lambda letter: -score[letter])
        whole = {1: "the number", 2: "both numbers"}.get(count, f"all {count} numbers")
        many = whole if score[first] == count else f"{score[first]} of {count} numbers"
        other = f" and {last} in {score[last]}" if score[last] else ""
        who = f"{first} is better in {many}" if score[first] else "Neither is better in the numbers"
        yield f"{who} asked for{other}, if stiffer and higher in frequency is better."


def _left_open(found: TwoShafts, one: NumberChange) -> str:
    """Ranges that the data of both leave open of a number, and whether they may turn the order."""
    records = [numbers.of(one.name) for numbers in found.open]
    ranges = {
        letter: interval(record.total)
        for letter, record in zip("AB", records)
        if record is not None
    }
    if not ranges:
        return ""
    words = " and ".join(f"{range_} in {letter}" for letter, range_ in ranges.items())
    widest = max(abs(end or 0.0) for r in records if r for end in (r.total.low, r.total.high))
    less = widest > _size(one)
    return f"; data leave open {words}{', more than the difference' * less}"


def _numbers(found: TwoShafts, units: Units) -> Iterator[str]:
    statics = [one for one in found.changes if one.unit not in ("Hz", "kg")]
    yield from beside.resolved([one.change for one in statics], "compliances and stiffnesses")
    moved = [one for one in statics if one.verdict != "not resolved" and one.relative is not None]
    if moved:
        yield f"Moves most of them: {_told(max(moved, key=_size), units)}."
    unsure = [
        one for one in found.changes if one.verdict == "not resolved" and one.change.difference
    ]
    if unsure:
        names = ", ".join(one.name for one in unsure[:NAMED])
        more = f" and {len(unsure) - NAMED} more" if len(unsure) > NAMED else ""
        yield f"Not resolved, for both bars hold their differences: {names}{more}."
    yield f"Mass of the shaft: {_told(found['mass'], units)}."


def _size(one: NumberChange) -> float:
    return abs(one.relative or 0.0)


def _told(one: NumberChange, units: Units) -> str:
    change = one.change
    if change.difference == 0.0:
        return f"{units.text(change.a, one.unit, 5)} in both"
    values = f"{units.number(change.a, one.unit, 5)} to {units.text(change.b, one.unit, 5)}"
    band = f", both bars {percent(change.band / one.scale, signed=False)}" if change.band else ""
    band = "" if one.unit == "kg" else band
    name = "" if one.unit == "kg" else f"{one.name}, "
    return f"{name}from {values} ({percent(one.relative)}{band}; {one.verdict})"


def _alone(found: TwoShafts) -> Iterator[str]:
    for letter, names in found.alone.items():
        if names:
            yield f"Only {letter} has {', '.join(names)}: the other has no such motion that is held, or no such mode."
    points = [one.scene.port.name for one in found.both]
    if points[0] != points[1]:
        yield f"The lumped point is {points[0]} of A and {points[1]} of B."


def _solved(found: TwoShafts) -> Iterator[str]:
    titles = [LADDER[one.settled.rung].title for one in found.both]
    by = f"Both by the {titles[0]}"
    if titles[0] != titles[1]:
        by = f"A by the {titles[0]}, B by the {titles[1]}"
    asked = {one.scene.ask.tolerance for one in found.both}
    smaller = "the smaller tolerance of both" if len(asked) > 1 else "the tolerance of both"
    yield f"{by}, to bars of {percent(found.tolerance, signed=False)}: a tenth of {smaller}."
    for one in found.both:
        if not one.settled.reached:
            yield _not_reached(one)
    if any(b.catalogue is not None for one in found.both for b in one.scene.bearings):
        yield "Bars are those of mesh and solver, not what data of catalogue bearings leave open."


def _not_reached(one: OneShaft) -> str:
    largest = one.settled.largest
    if largest is None:
        return f"{one.letter} has no bars."
    name, bar = largest
    width = percent(bar, signed=False) if is_number(bar) else "unknown"
    return f"Not reached by {one.letter}: the largest bar is {width}, of {name}."


def results(found: TwoShafts) -> dict[str, Any]:
    """Plain data that JSON can hold, SI: all numbers of the page."""
    return {
        "kind": "two shafts",
        "shafts": {one.letter.lower(): _shaft(one) for one in found.both},
        "tolerance": found.tolerance,
        "differences": [asdict(one) for one in found.inputs],
        "sentences": sentences(found),
        "numbers": {one.name: _plain(one) for one in found.changes},
        "asked": {one.name: one.better or None for one in found.asked},
        "open": {
            letter: numbers.model_dump(mode="json") for letter, numbers in zip("ab", found.open)
        },
        "paired": found.pairing,
        "modes": [beside.plain_pair(pair) for pair in found.modes],
        "alone": {letter.lower(): list(names) for letter, names in found.alone.items()},
        "cautions": found.cautions,
        "environment": environment(),
        "seconds_total": found.seconds,
    }


def _shaft(one: OneShaft) -> dict[str, Any]:
    return {
        "file": one.name,
        "title": one.scene.title or one.scene.name,
        "scene": one.scene.as_dict(),
        "solved": one.settled.as_dict(),
    }


def _plain(one: NumberChange) -> dict[str, Any]:
    told = one.change.as_dict() | {"relative": one.relative, "unit": one.unit}
    scale = one.scale if math.isfinite(one.scale) else None
    return told | {"scale": scale} | ({"mode_of_b": one.partner} if one.partner else {})
