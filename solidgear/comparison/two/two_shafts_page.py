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


def asked(pair: Any, units: Units = ENGINEERING) -> Table:
    """Return numbers asked for: both values, error bars, ranges by open data, and which is better."""
    columns = _columns(units)
    for letter, numbers in zip("AB", pair.open):
        if numbers.inputs:
            ranges = partial(_open, numbers)
            columns.append(Column(f"open in {letter}", ranges))
    columns.append(word("better", lambda change: change.better or "-"))
    note = (
        "Better: stiffer, or higher in frequency, by more than both error bars; couplings have "
        "none."
    )
    if any(numbers.inputs for numbers in pair.open):
        note += (
            " Open: range by bearings and other open data of that design, by the Timoshenko beam, "
            "relative to its number."
        )
    return Table(
        "Numbers asked for" if pair.asks else "Usual numbers",
        columns,
        pair.asked,
        note,
        style="ruled",
    )


def _open(numbers: Any, change: Any) -> str | None:
    """Return the range of a number by open data."""
    record = numbers.of(change.name)
    return None if record is None else interval(record.total)


def _columns(units: Units) -> list[Column]:
    """Return columns of both numbers with their error bars."""
    return [
        text(
            "number",
            lambda change: change.name + (f" (B: {change.partner})" if change.partner else ""),
        ),
        Column("A", lambda change: _value(change, change.change.a, units)),
        Column("B", lambda change: _value(change, change.change.b, units)),
        text("unit", lambda change: units.unit(change.unit)),
        Column("difference", _apart),
        Column("error bar of A", lambda change: _bar(change, change.change.bar_a, change.scale)),
        Column("error bar of B", lambda change: _bar(change, change.change.bar_b, change.scale)),
    ]


def numbers(pair: Any, units: Units = ENGINEERING) -> Table:
    """Return the mass, compliances, stiffnesses and first frequencies side by side."""
    columns = [*_columns(units), word("", _verdict)]
    note = (
        "Differences and error bars are relative to A, for couplings to the geometric mean of "
        "both diagonal entries of A. Resolved: more than the sum of both error bars; not resolved "
        "is not agreement. The mass is the shaft's alone, and exact for a round one."
    )
    return Table("Numbers", columns, pair.changes, note, style="ruled")


def _exact_and_alike(change: Any) -> bool:
    """Return True for an exact number that both share."""
    return change.name == "mass" and change.change.difference == 0


def _apart(change: Any) -> str | Cell | None:
    return percent(0.0) if _exact_and_alike(change) else beside.apart(change.change, change.scale)


def _verdict(change: Any) -> str | None:
    return None if _exact_and_alike(change) else change.verdict


def _value(change: Any, value: float, units: Units) -> str:
    # a coupling that symmetry forbids is nothing but rounding
    return "0" if abs(value) <= 1e-9 * change.scale else units.number(value, change.unit, 6)


def _bar(change: Any, width: float | None, scale: float) -> str | None:
    if change.name == "mass" or not is_number(width) or not scale:
        return None
    return percent(width / scale, signed=False)


def write_two_shafts(pair: Any, out: str | os.PathLike, units: Units) -> Path:
    """Write results.json and report.html; the path is that of the page."""
    return beside.write_beside(pair, partial(_sections, pair, units), out, units)


def _sections(pair: Any, units: Units) -> list[Section]:
    shafts = zip(pair.both, pair.results["shafts"].items())
    scenes = [shaft["scene"] for shaft in pair.results["shafts"].values()]
    longest, thickest = (max(sizes) for sizes in zip(*map(extent, scenes)))
    drawings = {
        f"{side.label}, section through the axis.": sketch_svg(
            f"shaft_{key}", shaft["scene"], (longest, thickest)
        )
        for side, (key, shaft) in shafts
    }
    solved = [pairs_of(_facts(side), f"Solution of {side.label}") for side in pair.both]
    machine = pairs_of(pair.results["environment"], "Environment of the run")
    shapes = partial(shapes_chart, pair, units)
    same = "" if pair.inputs else beside.SAME
    return [
        Section(
            "asked",
            "What was asked" if pair.asks else "The usual numbers",
            tables=[asked(pair, units)],
        ),
        Section("input", "Input", same, tables=[beside.inputs(pair)]),
        Section("shafts", "Both shafts", SECTIONS, drawings=drawings),
        Section("numbers", "Numbers", tables=[numbers(pair, units)]),
        Section("modes", "Modes", "", {"shapes": shapes}, [beside.modes(pair)]),
        Section("run", "Run", tables=[*solved, machine]),
    ]


def printed(pair: Any, units: Units) -> tuple[Any, ...]:
    """Return sentences and tables for a terminal."""
    return (
        *map(in_ascii, pair.told(units)),
        *([asked(pair, units)] if pair.asks else []),
        beside.inputs(pair, beside.SHORT),
        numbers(pair, units),
        beside.modes(pair),
    )


def _facts(shaft: Any) -> dict[str, Any]:
    """Return the model, mesh and size."""
    return {
        "model": shaft.settled.rung,
        "mesh": shaft.settled.setting,
        "unknowns": shaft.settled.body.size,
        "error bars asked for": percent(shaft.settled.tolerance, signed=False),
        "reached": "yes" if shaft.settled.reached else "no",
    }


#: components of section motions that show a family
SHOWN = {"bending": (0, 2), "axial": (1,), "torsion": (4,)}
#: pairs that are drawn, the lowest
MOST = 8


def shapes_chart(shafts: Any, units: Units = ENGINEERING, width: float = WIDE) -> Chart | None:
    """Chart motions of sections along both shafts in the lowest pairs of modes, scaled to one."""
    modes = [{str(m.name): m for m in shaft.modes.solved} for shaft in shafts.both]
    looks = {shaft.label: Series(colour) for shaft, colour in zip(shafts.both, PAIR)}
    drawn = []
    for pair in shafts.modes:
        partners = [
            None if m is None else by_name.get(m.name)
            for m, by_name in zip((pair.a, pair.b), modes)
        ]
        if all(m is not None and m.family in SHOWN for m in partners):
            drawn.append((pair, partners))
    last = max(units.values(shaft.modes.stations, "m").max() for shaft in shafts.both)
    columns = 2 if width > NARROW and len(drawn) > 1 else 1
    legend = {"orient": "top", "columns": 2, "symbolType": "stroke", "symbolStrokeWidth": 3}
    panels = []
    for k, (pair, partners) in enumerate(drawn[:MOST]):
        panel = Panel(
            Axis(f"y in {units.unit('m')}", (0.0, float(last))),
            Axis("", (-1.1, 1.1)),
            130.0,
            beside.names(pair),
            series=looks,
            legend=legend if k == 0 else None,
        )
        panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
        for label, stations, line, hz in _lines(shafts.both, partners):
            text_ = readout(label, ("frequency", hertz(hz), "Hz"))
            rows = [
                {"x": float(x), "y": float(u)} for x, u in zip(units.values(stations, "m"), line)
            ]
            panel.draw("line", [{**row, "name": label} for row in rows])
            panel.read([{**row, "readout": text_} for row in rows], looks[label].colour)
        panels.append(panel)
    if len(panels) % columns:  # as wide as those above it
        panels[-1].right += (width + BETWEEN) / columns
    return Chart(in_columns(panels, columns), width) if panels else None


def _lines(
    shafts: Sequence[Any], modes: Sequence[Any]
) -> list[tuple[str, np.ndarray, np.ndarray, float]]:
    """Return label, stations, shape and frequency of a mode of each, with the same sign."""
    lines = [_line(mode) for mode in modes]
    stations = [shaft.modes.stations for shaft in shafts]
    # along their lengths, which may differ
    across = np.interp(stations[1] / stations[1].max(), stations[0] / stations[0].max(), lines[0])
    if across @ lines[1] < 0:
        lines[1] = -lines[1]
    return [
        (shaft.label, y, line, mode.frequency_hz)
        for shaft, y, line, mode in zip(shafts, stations, lines, modes)
    ]


def _line(mode: Any) -> np.ndarray:
    """Return motions of sections in the plane of the largest, scaled to one."""
    motions = mode.motions[0][:, SHOWN[mode.family]]
    line = motions @ np.linalg.svd(motions, full_matrices=False)[2][0]
    return line / max(np.abs(line).max(), 1e-300)
