"""Tables of a train at one speed: its orders, natural frequencies near them, and measured peaks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from solidgear.show.table import Cell, Column, Table, exact, text
from solidgear.show.words import DASH, hertz, whole


def first_lines(lines: Sequence[Any]) -> Table:
    """Return first harmonics of all shafts, meshes and bearings."""
    first = [line for line in lines if line.kind != "sideband" and line.name.endswith(" 1")]
    columns = [
        text("order", lambda line: line.name.removesuffix(" 1")),
        Column("Hz", lambda line: line.frequency_hz, hertz),
        Column("from", lambda line: _end(line, line.low_hz), hertz),
        Column("to", lambda line: _end(line, line.high_hz), hertz),
    ]
    return Table("First orders at this speed", columns, first, style="ruled")


def _end(line: Any, hz: float) -> float | None:
    return None if line.exact else hz


def all_lines(lines: Sequence[Any]) -> Table:
    """Return every order with its error bar and formula, in SI."""
    columns = [
        Column("kind", lambda line: line.kind),
        text("order", lambda line: line.name),
        Column("frequency [Hz]", lambda line: line.frequency_hz, exact),
        Column("from [Hz]", lambda line: line.low_hz, exact),
        Column("to [Hz]", lambda line: line.high_hz, exact),
        text("source", lambda line: line.source),
    ]
    return Table("", columns, lines)


def coincidences(at_speed: Any, most: int | None = None) -> Table:
    """Return orders near natural frequencies, meshes and shafts before sidebands; the first
    `most`.
    """
    columns = [
        text("order", lambda row: row.line),
        Column("Hz", lambda row: row.line_hz, hertz),
        text("mode", lambda row: row.mode),
        Column("Hz of it", lambda row: row.mode_hz, hertz),
        Column("off, %", lambda row: f"{100 * row.off:+.1f}"),
        Column(f"meet at {at_speed.shaft} rpm", lambda row: row.rpm, whole),
    ]
    title = f"Orders within {100 * at_speed.within:g} % of a natural frequency"
    rows = at_speed.coincidences[:most]
    more = len(at_speed.coincidences) - len(rows)
    note = f"{more} more, sidebands and bearings last, are in near.csv." if more else ""
    return Table(title, columns, rows, note, style="ruled")


def all_coincidences(at_speed: Any) -> Table:
    """Return all orders near natural frequencies, in SI, for a file."""
    columns = [
        text("order", lambda row: row.line),
        Column("frequency [Hz]", lambda row: row.line_hz, exact),
        text("mode", lambda row: row.mode),
        Column("frequency of the mode [Hz]", lambda row: row.mode_hz, exact),
        Column("off [1]", lambda row: row.off, exact),
        Column(f"{at_speed.shaft} speed where they meet [rpm]", lambda row: row.rpm, exact),
    ]
    return Table("", columns, at_speed.coincidences)


def measured(at_speed: Any, most: int | None = None) -> Table:
    """Return measured peaks with their orders by frequency; the `most` largest alone."""
    peaks = sorted(at_speed.peaks, key=lambda peak: -peak.amplitude)[:most]
    unit = at_speed.spectrum.unit
    columns = [
        Column("Hz", lambda peak: peak.frequency_hz, hertz),
        Column(f"amplitude, {unit or 'unit not given'}", lambda peak: f"{peak.amplitude:.4g}"),
        text("order", lambda peak: Cell(peak.name, "" if peak.line else "quiet")),
        Column("Hz of it", lambda peak: line_place(peak.line)),
        text("also", lambda peak: _also(peak.others)),
    ]
    more = len(at_speed.peaks) - len(peaks)
    note = f"The {len(peaks)} largest; {more} more are in peaks.csv." if more else ""
    rows = sorted(peaks, key=lambda peak: peak.frequency_hz)
    return Table(f"Peaks of {at_speed.spectrum.name}", columns, rows, note, style="ruled")


def line_place(line: Any) -> str | None:
    """Return the frequency of an order, Hz, or the ends of its error bar."""
    if line is None:
        return None
    if line.exact:
        return hertz(line.frequency_hz)
    return f"{hertz(line.low_hz)} to {hertz(line.high_hz)}"


def _also(names: Sequence[str]) -> str:
    """Return two further names, and how many more there are."""
    if not names:
        return DASH
    more = len(names) - 2
    return ", ".join(names[:2]) + (f" and {more} more" if more > 0 else "")


def measured_file(at_speed: Any) -> Table:
    """Return every measured peak with its orders, for a file."""
    unit = f" [{at_speed.spectrum.unit}]" if at_speed.spectrum.unit else ""
    columns = [
        Column("frequency [Hz]", lambda peak: peak.frequency_hz, exact),
        Column(f"amplitude{unit}", lambda peak: peak.amplitude, exact),
        text("order", lambda peak: peak.name),
        Column("order [Hz]", lambda peak: peak.line and peak.line.frequency_hz, exact),
        Column("from [Hz]", lambda peak: peak.line and peak.line.low_hz, exact),
        Column("to [Hz]", lambda peak: peak.line and peak.line.high_hz, exact),
        text("others", lambda peak: "; ".join(peak.others)),
    ]
    return Table("", columns, at_speed.peaks)
