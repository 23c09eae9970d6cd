"""Conclusions of the comparison of two trains in sentences, and all of it as plain data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.ladder.registry import LADDER
from solidgear.machine.environment import environment
from solidgear.report.units import ENGINEERING, Units
from solidgear.report.words import hertz, percent
from solidgear.studies import beside
from solidgear.studies.train.comparison import described
from solidgear.studies.train.modes import unpublished_lines
from solidgear.studies.train.shaft import told_mix

if TYPE_CHECKING:
    from solidgear.studies.train.two_trains import OneTrain, PeakPair, TwoTrains

#: peaks that a verdict tells, the loudest in either train
LOUDEST = 3


def sentences(found: TwoTrains, units: Units = ENGINEERING) -> list[str]:
    """Conclusions: what the change does, what of it is resolved, and by which models."""
    return [
        beside.inputs(found.inputs),
        _models(found),
        *_largest_force(found, units),
        *_loudest(found, units),
        *beside.modes(found.modes, "in the other train"),
        *_largest_reactions(found, units),
        *_at_rest(found, units),
        _sure(found),
    ]


def _models(found: TwoTrains) -> str:
    titles = {s: LADDER[m].title if m in LADDER.bodies else m for s, m in found.models.items()}
    words = told_mix(titles)
    if len({*found.models.values()}) == 1:
        every, (title, *_) = found.a.workshop.train.every, titles.values()
        of_bodies = {*found.models.values()} <= {*LADDER.bodies}
        words = f"{every} shafts as {title}s" if of_bodies else f"{every} {title}"
    driver = found.a.workshop.train.named_mesh(found.mesh)
    words += f", driven by the {driver.name}" if driver.label else ""
    damping = found.a.response.damping
    asked = {one.workshop.train.ask.max_frequency for one in found.both}
    lower = " (the lower of what both files ask for)" if len(asked) > 1 else ""
    return (
        f"Models of both trains: {words}, {damping} losses, up to {found.highest_hz:g} Hz{lower}."
    )


def _largest_force(found: TwoTrains, units: Units) -> Iterator[str]:
    for column, name in found.forces.items():
        tops = [_top(one, column) for one in found.both]
        told = [
            f"{units.text(size, 'N', 4)} at {hertz(hz)} Hz in {one.letter}{_of_mode(one, hz)}"
            for one, (hz, size) in zip(found.both, tops)
        ]
        yield f"Largest {name}: {' and '.join(told)}{_in_decibels(tops)}."


def _top(one: OneTrain, column: str) -> tuple[float, float]:
    """Hz and size of the largest amplitude of a column that there is."""
    top = one.largest(column)
    assert top is not None
    return top


def _of_mode(one: OneTrain, hz: float) -> str:
    """The mode that makes a peak, in brackets; the end of a range is told as such."""
    mode = next((p.mode for p in one.response.peaks if p.frequency_hz == hz), "")
    if hz == one.response.frequency_hz[-1]:
        mode = "the end of the range"
    return f" ({mode})" if mode else ""


def _in_decibels(tops: Sequence[Any]) -> str:
    change = beside.decibels(tops[0][1], tops[1][1])
    return "" if change is None else f", {change:+.1f} dB"


def _loudest(found: TwoTrains, units: Units) -> Iterator[str]:
    def size(pair: PeakPair) -> float:
        return max(p.force for p in (pair.a, pair.b) if p is not None)

    loud = sorted(found.peaks, key=size, reverse=True)[:LOUDEST]
    for pair in [p for p in found.peaks if p in loud]:
        if pair.a is None or pair.b is None:
            one, peak = (found.a, pair.a) if pair.a is not None else (found.b, pair.b)
            assert peak is not None
            force = units.text(peak.force, "N", 4)
            yield f"A peak of {one.letter} alone: {peak.mode}, {hertz(peak.frequency_hz)} Hz, {force}."
            continue
        a, b = pair.a, pair.b
        shift = percent(b.frequency_hz / a.frequency_hz - 1)
        forces = f"{units.number(a.force, 'N', 4)} to {units.text(b.force, 'N', 4)}"
        yield (
            f"The peak of {beside.both_names(a.mode, b.mode)} moves from {hertz(a.frequency_hz)} to "
            f"{hertz(b.frequency_hz)} Hz ({shift}), its mesh force from {forces} "
            f"({pair.decibels:+.1f} dB)."
        )


def _largest_reactions(found: TwoTrains, units: Units) -> Iterator[str]:
    told, tops = [], []
    for one in found.both:
        forces = [c for c in one.response.columns if " bearing " in c and c.endswith(" [N]")]
        if not forces:
            return
        column = max(forces, key=lambda c: _top(one, c)[1])
        hz, size = _top(one, column)
        tops.append((hz, size))
        place = column.removesuffix(" [N]")
        told.append(f"{place}, {units.text(size, 'N', 4)} at {hertz(hz)} Hz in {one.letter}")
    yield f"Largest dynamic force on a bearing: {'; '.join(told)}{_in_decibels(tops)}."


def _at_rest(found: TwoTrains, units: Units) -> Iterator[str]:
    points = [one.workshop.train.point for one in found.both]
    if points[0] is None and points[1] is None:
        return
    if points[0] is None or points[1] is None:
        alone = found.b if points[0] is None else found.a
        yield f"Under torque nothing is compared: {alone.letter} alone has an operating point."
        return
    changes = found.misalignment()
    if not changes:
        yield "Under torque nothing is compared: lumped shafts have no bearings of their own."
        return
    told = [
        f"{name} {units.number(c.a, unit, 3)} to {units.text(c.b, unit, 3)}"
        + (f" ({c.verdict})" if c.band is not None else "")
        for name, unit, _, c in changes
    ]
    label = points[0].label
    where = label if label == points[1].label else f"{label} (A) and {points[1].label} (B)"
    yield f"Misalignment at {where}: {'; '.join(told)}."
    opened: dict[str, list[str]] = {}
    for one in found.both:
        for m in one.loaded.misalignment if one.loaded else ():
            if m.open is not None:
                low, high = units.number(m.open[0], m.unit, 3), units.text(m.open[1], m.unit, 3)
                opened.setdefault(f"{m.name} {low} to {high}", []).append(one.letter)
    if opened:
        letters = [one.letter for one in found.both]
        ranges = [r if of == letters else f"{r} ({of[0]})" for r, of in opened.items()]
        yield f"Data of bearings leave open, alike in both: {'; '.join(ranges)}."


def _sure(found: TwoTrains) -> str:
    bars = [m.bar for p in found.modes for m in (p.a, p.b) if m is not None and m.bar is not None]
    hang = "amplitudes have none, and hang on losses and transmission error as both files give them"
    if not bars:
        return (
            "No error bars: without a harmonic shaft there are none, so that no difference is "
            f"called resolved; {hang}."
        )
    stations = [b for one in found.both for s in one.workshop.scenes.values() for b in s.bearings]
    catalogued = any(getattr(b, "catalogue", None) is not None for b in stations)
    left_out = ", not what data of catalogue bearings leave open" * catalogued
    return (
        f"Error bars are those of frequencies, {percent(max(bars), signed=False)} at most (meshes of "
        f"harmonic shafts, reduction{left_out}); {hang}."
    )


def results(found: TwoTrains) -> dict[str, Any]:
    """Plain data that JSON can hold, SI: all numbers of the page and the curves of its charts."""
    both = dict(zip("ab", found.both))
    loaded = {key: one.loaded.as_dict() for key, one in both.items() if one.loaded is not None}
    return {
        "kind": "two trains",
        "trains": {key: {"file": one.name, **described(one.workshop)} for key, one in both.items()},
        "models": found.models,
        **({"mesh": found.mesh} if len(found.forces) > 1 else {}),
        "highest_hz": found.highest_hz,
        "differences": [asdict(one) for one in found.inputs],
        "sentences": sentences(found),
        "paired": found.pairing,
        "modes": [beside.plain_pair(pair) for pair in found.modes],
        "peaks": [
            {
                "a": None if pair.a is None else asdict(pair.a),
                "b": None if pair.b is None else asdict(pair.b),
                "decibels": pair.decibels,
            }
            for pair in found.peaks
        ],
        "largest": {column: _largest(found, column) for column in found.columns},
        "responses": {key: _curves(one) for key, one in both.items()},
        "misalignment": {
            name: {"unit": unit.split()[0], **change.as_dict()}
            for name, unit, _, change in found.misalignment()
        },
        "at_rest": loaded,
        "cautions": found.cautions,
        "unpublished": found.unpublished,
        "unpublished_lines": unpublished_lines(found.unpublished),
        "environment": environment(),
        "seconds_total": found.seconds,
    }


def _largest(found: TwoTrains, column: str) -> dict[str, Any]:
    tops = [one.largest(column) for one in found.both]
    told: dict[str, Any] = {
        key: None if top is None else dict(zip(("frequency_hz", "size"), top))
        for key, top in zip("ab", tops)
    }
    return told | {"decibels": found.decibels(column)}


def _curves(one: OneTrain) -> dict[str, Any]:
    def numbers(values: np.ndarray) -> list[float | None]:
        return [value if np.isfinite(value) else None for value in np.abs(values).tolist()]

    return {
        "frequency_hz": one.response.frequency_hz.tolist(),
        "amplitude": {name: numbers(values) for name, values in one.response.columns.items()},
    }
