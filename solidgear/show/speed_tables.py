"""Tables of a train at one speed: its orders, natural frequencies near them, and measured peaks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from solidgear.show.table import Cell, Column, Table, exact, text
from solidgear.show.words import DASH, hertz, whole


def first_lines(found: Sequence[Any]) -> Table:
    """First harmonics of everything that turns, meshes and rolls."""
    shown = [line for line in found if line.kind != "sideband" and line.name.endswith(" 1")]
    columns = [
        text("order", lambda line: line.name.removesuffix(" 1")),
        Column("Hz", lambda line: line.frequency_hz, hertz),
        Column("from", lambda line: _end(line, line.low_hz), hertz),
        Column("to", lambda line: _end(line, line.high_hz), hertz),
    ]
    return Table("First orders at this speed", columns, shown, style="ruled")


def _end(line: Any, hz: float) -> float | None:
    return None if line.exact else hz


def all_lines(found: Sequence[Any]) -> Table:
    """Every order with its bar and its formula, in SI, for a file."""
    columns = [
        Column("kind", lambda line: line.kind),
        text("order", lambda line: line.name),
        Column("frequency [Hz]", lambda line: line.frequency_hz, exact),
        Column("from [Hz]", lambda line: line.low_hz, exact),
        Column("to [Hz]", lambda line: line.high_hz, exact),
        text("source", lambda line: line.source),
    ]
    return Table("", columns, found)


def coincidences(found: Any, most: int | None = None) -> Table:
    """Orders near natural frequencies, those of meshes and shafts before sidebands and bearings; the
    first alone where there is a `most`.
    """
    columns = [
        text("order", lambda one: one.line),
        Column("Hz", lambda one: one.line_hz, hertz),
        text("mode", lambda one: one.mode),
        Column("Hz of it", lambda one: one.mode_hz, hertz),
        Column("off, %", lambda one: f"{100 * one.off:+.1f}"),
        Column(f"meet at {found.shaft} rpm", lambda one: one.rpm, whole),
    ]
    title = f"Orders within {100 * found.within:g} % of a natural frequency"
    shown = found.coincidences[:most]
    left = len(found.coincidences) - len(shown)
    note = f"{left} more, sidebands and bearings last, are in near.csv." if left else ""
    return Table(title, columns, shown, note, style="ruled")


def all_coincidences(found: Any) -> Table:
    """All orders near natural frequencies, in SI, for a file."""
    columns = [
        text("order", lambda one: one.line),
        Column("frequency [Hz]", lambda one: one.line_hz, exact),
        text("mode", lambda one: one.mode),
        Column("frequency of the mode [Hz]", lambda one: one.mode_hz, exact),
        Column("off [1]", lambda one: one.off, exact),
        Column(f"{found.shaft} speed where they meet [rpm]", lambda one: one.rpm, exact),
    ]
    return Table("", columns, found.coincidences)


def measured(found: Any, most: int | None = None) -> Table:
    """Measured peaks and whose they are, by frequency; of the largest alone where there is a
    `most`.
    """
    peaks = sorted(found.peaks, key=lambda peak: -peak.amplitude)[:most]
    unit = found.spectrum.unit
    columns = [
        Column("Hz", lambda peak: peak.frequency_hz, hertz),
        Column(f"amplitude, {unit or 'unit not told'}", lambda peak: f"{peak.amplitude:.4g}"),
        text("order", lambda peak: Cell(peak.name, "" if peak.line else "quiet")),
        Column("Hz of it", lambda peak: line_place(peak.line)),
        text("also", lambda peak: _also(peak.others)),
    ]
    left = len(found.peaks) - len(peaks)
    note = f"The {len(peaks)} largest; {left} more are in peaks.csv." if left else ""
    rows = sorted(peaks, key=lambda peak: peak.frequency_hz)
    return Table(f"Peaks of {found.spectrum.name}", columns, rows, note, style="ruled")


def line_place(line: Any) -> str | None:
    """Frequency of an order, Hz, or the ends of its bar."""
    if line is None:
        return None
    if line.exact:
        return hertz(line.frequency_hz)
    return f"{hertz(line.low_hz)} to {hertz(line.high_hz)}"


def _also(names: Sequence[str]) -> str:
    """Two further names, and how many more there are."""
    if not names:
        return DASH
    left = len(names) - 2
    return ", ".join(names[:2]) + (f" and {left} more" if left > 0 else "")


def measured_file(found: Any) -> Table:
    """Every measured peak and whose it is, for a file."""
    unit = f" [{found.spectrum.unit}]" if found.spectrum.unit else ""
    columns = [
        Column("frequency [Hz]", lambda peak: peak.frequency_hz, exact),
        Column(f"amplitude{unit}", lambda peak: peak.amplitude, exact),
        text("order", lambda peak: peak.name),
        Column("order [Hz]", lambda peak: peak.line and peak.line.frequency_hz, exact),
        Column("from [Hz]", lambda peak: peak.line and peak.line.low_hz, exact),
        Column("to [Hz]", lambda peak: peak.line and peak.line.high_hz, exact),
        text("others", lambda peak: "; ".join(peak.others)),
    ]
    return Table("", columns, found.peaks)
