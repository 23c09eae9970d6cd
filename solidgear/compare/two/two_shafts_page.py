"""Page of two shafts beside each other: their sections, numbers and modes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.show import beside
from solidgear.show.open_words import interval
from solidgear.show.panel import GREY, Axis, Panel, Series, readout
from solidgear.show.plot import BETWEEN, NARROW, WIDE, Chart, in_columns
from solidgear.show.run_tables import pairs_of
from solidgear.show.sheet import Section
from solidgear.show.sketch import extent
from solidgear.show.sketch_page import sketch_svg
from solidgear.show.table import Cell, Column, Table, text, word
from solidgear.show.units import ENGINEERING, Units, in_ascii
from solidgear.show.words import hertz, is_number, percent
from solidgear.trains.page.chart import PAIR

SECTIONS = "Both to one scale."


def asked(found: Any, units: Units = ENGINEERING) -> Table:
    """Numbers that are asked for: both, their bars, what data leave open, and which is better."""
    columns = _columns(units)
    for letter, numbers in zip("AB", found.open):
        if numbers.inputs:
            ranges = partial(_open, numbers)
            columns.append(Column(f"open in {letter}", ranges))
    columns.append(word("better", lambda one: one.better or "-"))
    note = "Better: stiffer, or higher in frequency, by more than both bars; of a coupling neither."
    if any(numbers.inputs for numbers in found.open):
        note += (
            " Open: what bearings and other data of the file leave open of that design, by the "
            "Timoshenko beam, relative to its own number."
        )
    return Table(
        "Numbers asked for" if found.asks else "Usual numbers",
        columns,
        found.asked,
        note,
        style="ruled",
    )


def _open(numbers: Any, one: Any) -> str | None:
    """Range that data leave open of a number."""
    record = numbers.of(one.name)
    return None if record is None else interval(record.total)


def _columns(units: Units) -> list[Column]:
    """A number of both, with their bars."""
    return [
        text("number", lambda one: one.name + (f" (B: {one.partner})" if one.partner else "")),
        Column("A", lambda one: _value(one, one.change.a, units)),
        Column("B", lambda one: _value(one, one.change.b, units)),
        text("unit", lambda one: units.unit(one.unit)),
        Column("difference", _apart),
        Column("bar of A", lambda one: _bar(one, one.change.bar_a, one.scale)),
        Column("bar of B", lambda one: _bar(one, one.change.bar_b, one.scale)),
    ]


def numbers(found: Any, units: Units = ENGINEERING) -> Table:
    """Mass, compliances, stiffnesses and first frequencies side by side."""
    columns = [*_columns(units), word("", _verdict)]
    note = (
        "Differences and bars are relative to A, of couplings to the geometric mean of both diagonal "
        "entries of A. Resolved: more than the sum of both bars; not resolved is not agreement. The "
        "mass is that of the shaft alone; of a round one it is exact and has no bar."
    )
    return Table("Numbers", columns, found.changes, note, style="ruled")


def _exact_and_alike(one: Any) -> bool:
    """True for a number without error that both have alike: there is nothing to resolve."""
    return one.name == "mass" and one.change.difference == 0


def _apart(one: Any) -> str | Cell | None:
    return percent(0.0) if _exact_and_alike(one) else beside.apart(one.change, one.scale)


def _verdict(one: Any) -> str | None:
    return None if _exact_and_alike(one) else one.verdict


def _value(one: Any, value: float, units: Units) -> str:
    # a coupling that symmetry forbids is nothing but rounding
    return "0" if abs(value) <= 1e-9 * one.scale else units.number(value, one.unit, 6)


def _bar(one: Any, width: float | None, scale: float) -> str | None:
    if one.name == "mass" or not is_number(width) or not scale:
        return None
    return percent(width / scale, signed=False)


def write_two_shafts(found: Any, out: str | os.PathLike, units: Units) -> Path:
    """Write results.json and report.html; the path is that of the page."""
    return beside.write_beside(found, partial(_sections, found, units), out, units)


def _sections(found: Any, units: Units) -> list[Section]:
    shafts = zip(found.both, found.results["shafts"].items())
    scenes = [shaft["scene"] for shaft in found.results["shafts"].values()]
    longest, thickest = (max(sizes) for sizes in zip(*map(extent, scenes)))
    drawings = {
        f"{one.label}, section through the axis.": sketch_svg(
            f"shaft_{key}", shaft["scene"], (longest, thickest)
        )
        for one, (key, shaft) in shafts
    }
    solved = [pairs_of(_facts(one), f"Solution of {one.label}") for one in found.both]
    machine = pairs_of(found.results["environment"], "Environment of the run")
    shapes = partial(shapes_chart, found, units)
    same = "" if found.inputs else beside.SAME
    return [
        Section(
            "asked",
            "What was asked" if found.asks else "The usual numbers",
            tables=[asked(found, units)],
        ),
        Section("input", "Input", same, tables=[beside.inputs(found)]),
        Section("shafts", "Both shafts", SECTIONS, drawings=drawings),
        Section("numbers", "Numbers", tables=[numbers(found, units)]),
        Section("modes", "Modes", "", {"shapes": shapes}, [beside.modes(found)]),
        Section("run", "Run", tables=[*solved, machine]),
    ]


def printed(found: Any, units: Units) -> tuple[Any, ...]:
    """Sentences and tables for a terminal."""
    return (
        *map(in_ascii, found.told(units)),
        *([asked(found, units)] if found.asks else []),
        beside.inputs(found, beside.SHORT),
        numbers(found, units),
        beside.modes(found),
    )


def _facts(one: Any) -> dict[str, Any]:
    """Model, mesh and size."""
    return {
        "model": one.settled.rung,
        "mesh": one.settled.setting,
        "unknowns": one.settled.body.size,
        "bars asked for": percent(one.settled.tolerance, signed=False),
        "reached": "yes" if one.settled.reached else "no",
    }


#: components of section motions that show a family
SHOWN = {"bending": (0, 2), "axial": (1,), "torsion": (4,)}
#: pairs that are drawn, the lowest
MOST = 8


def shapes_chart(found: Any, units: Units = ENGINEERING, width: float = WIDE) -> Chart | None:
    """Motions of sections along both shafts in the lowest pairs of modes, each of largest one; None
    where no pair has a shape that sections show.
    """
    modes = [{str(m.name): m for m in one.modes.solved} for one in found.both]
    looks = {one.label: Series(colour) for one, colour in zip(found.both, PAIR)}
    drawn = []
    for pair in found.modes:
        own = [
            None if m is None else known.get(m.name) for m, known in zip((pair.a, pair.b), modes)
        ]
        if all(m is not None and m.family in SHOWN for m in own):
            drawn.append((pair, own))
    last = max(units.values(one.modes.stations, "m").max() for one in found.both)
    columns = 2 if width > NARROW and len(drawn) > 1 else 1
    legend = {"orient": "top", "columns": 2, "symbolType": "stroke", "symbolStrokeWidth": 3}
    panels = []
    for k, (pair, own) in enumerate(drawn[:MOST]):
        panel = Panel(
            Axis(f"y in {units.unit('m')}", (0.0, float(last))),
            Axis("", (-1.1, 1.1)),
            130.0,
            beside.names(pair),
            series=looks,
            legend=legend if k == 0 else None,
        )
        panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
        for label, stations, line, hz in _lines(found.both, own):
            said = readout(label, ("frequency", hertz(hz), "Hz"))
            rows = [
                {"x": float(x), "y": float(u)} for x, u in zip(units.values(stations, "m"), line)
            ]
            panel.draw("line", [{**row, "name": label} for row in rows])
            panel.read([{**row, "readout": said} for row in rows], looks[label].colour)
        panels.append(panel)
    if len(panels) % columns:  # as wide as those above it
        panels[-1].right += (width + BETWEEN) / columns
    return Chart(in_columns(panels, columns), width) if panels else None


def _lines(
    both: Sequence[Any], own: Sequence[Any]
) -> list[tuple[str, np.ndarray, np.ndarray, float]]:
    """Label, stations, shape and frequency of a mode of each, both with the same sign."""
    lines = [_line(mode) for mode in own]
    stations = [one.modes.stations for one in both]
    # along their lengths, which may differ
    across = np.interp(stations[1] / stations[1].max(), stations[0] / stations[0].max(), lines[0])
    if across @ lines[1] < 0:
        lines[1] = -lines[1]
    return [
        (one.label, y, line, mode.frequency_hz)
        for one, y, line, mode in zip(both, stations, lines, own)
    ]


def _line(mode: Any) -> np.ndarray:
    """Motions of sections in the plane of the largest, whose largest is one."""
    motions = mode.motions[0][:, SHOWN[mode.family]]
    line = motions @ np.linalg.svd(motions, full_matrices=False)[2][0]
    return line / max(np.abs(line).max(), 1e-300)
