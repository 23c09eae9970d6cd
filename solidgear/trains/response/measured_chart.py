"""Chart of a measured spectrum over a computed response, both over one axis of frequency."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from solidgear.show.panel import GREY, INK, Panel, Series, curve, read_places, readout
from solidgear.show.plot import NARROW, WIDE, Chart
from solidgear.show.scales import Axis
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.show.words import hertz
from solidgear.trains.assembly.shaft import mix_label
from solidgear.trains.response.at_speed import AtSpeed, MeasuredPeak
from solidgear.trains.response.response import TrainResponse
from solidgear.trains.response.spectrum import Spectrum

#: looks of a peak by what it is called after
MARKS = {
    "mesh": Series("#00805e", "circle"),
    "shaft": Series("#b3305c", "square"),
    "sideband": Series("#0072b2", "diamond"),
    "bearing": Series("#c98a00", "triangle-up"),
    "not ours": Series(GREY, "circle"),
}
MODE, LINE = "#9aa4ad", "#00805e"
#: px between names of peaks, columns of a spectrum, and places that are read
APART, COLUMNS, PLACES = 15.0, 1200, 80
#: share of the panel's height that names of peaks stand in
NAMES = 0.32


def measured_chart(
    speed: AtSpeed,
    spectrum: Spectrum,
    response: TrainResponse,
    title: str,
    units: Units = ENGINEERING,
    width: float = WIDE,
) -> Chart:
    """Chart the measured spectrum with the orders of its peaks, above the computed mesh force."""
    last = float(spectrum.frequency_hz[-1])
    last_peak = max((peak.frequency_hz for peak in speed.peaks), default=0.0) * 1.02
    ends = (0.0, min(last, max(float(response.frequency_hz[-1]), last_peak)))
    panels = [_measured(speed, spectrum, ends, width), _computed(speed, response, ends, units)]
    return Chart([[panel] for panel in panels], width, title)


def _measured(speed: AtSpeed, spectrum: Spectrum, ends: tuple[float, float], width: float) -> Panel:
    inside = spectrum.frequency_hz <= ends[1]
    hz, size = spectrum.frequency_hz[inside], spectrum.amplitude[inside]
    low, high = _room(size, spectrum.in_decibels)
    quantity = spectrum.what or "amplitude"
    panel = Panel(
        Axis("", ends),
        Axis(
            f"{quantity}, {spectrum.unit or 'unit not given'}",
            (low, high),
            log=not spectrum.in_decibels,
        ),
        300.0,
        title=f"Measured: {spectrum.name}, at {speed.rpm:.6g} rpm of the {speed.shaft}",
        series=MARKS,
        legend={"orient": "top", "columns": 2 if width <= NARROW else 5},
    )
    _modes(panel, speed, ends, name=False)
    outlined = outline(hz, size)
    panel.draw(
        {"type": "line", "color": INK, "strokeWidth": 1}, curve(hz[outlined], size[outlined])
    )
    rows = []
    for peak in (p for p in speed.peaks if p.frequency_hz <= ends[1]):
        facts = (
            ("frequency", hertz(peak.frequency_hz), "Hz"),
            ("amplitude", plain(peak.amplitude, 4), spectrum.unit),
            ("order at", peak.line.place if peak.line else "", "Hz"),
            ("also within the bar of", ", ".join(peak.others[:3]), ""),
        )
        words = readout(peak.name, *facts)
        rows.append(
            {"x": peak.frequency_hz, "y": peak.amplitude, "name": _kind(peak), "readout": words}
        )
    panel.draw({"type": "point", "filled": True, "size": 34}, rows)
    _names(panel, speed.peaks, ends, width)
    return panel


def _kind(peak: MeasuredPeak) -> str:
    """Return the series of a peak."""
    if peak.line is None:
        return "not ours"
    return peak.line.kind if peak.line.exact else "bearing"


def _room(size: np.ndarray, decibels: bool) -> tuple[float, float]:
    """Return ends of the axis of amplitudes, with room for names above."""
    if decibels:
        low, high = float(size.min()), float(size.max())
        return low, high + NAMES / (1 - NAMES) * max(high - low, 1.0)
    # dips of noise reach any depth, and tell nothing
    low, high = float(np.percentile(size[size > 0], 1)), float(size.max())
    low = max(low, 1e-6 * high) / 2
    return low, high * (high / low) ** (NAMES / (1 - NAMES))


def outline(x: np.ndarray, y: np.ndarray, columns: int = COLUMNS) -> np.ndarray:
    """Return places of a curve that draw it the same as all do: ends, and extremes of every
    column.

    Examples
    --------
    >>> outline(np.arange(8.0), np.array([0, 3, 1, 2, 5, 4, 7, 6]), columns=2)
    array([0, 1, 5, 6, 7])
    """
    column = np.minimum((columns * (x - x[0]) / (x[-1] - x[0])).astype(int), columns - 1)
    first = np.flatnonzero(np.diff(column, prepend=-1))
    parts = np.split(np.arange(len(x)), first[1:])
    ends = [(part[y[part].argmin()], part[y[part].argmax()]) for part in parts]
    return np.unique([0, len(x) - 1, *np.ravel(ends)])


def _names(
    panel: Panel, peaks: Sequence[MeasuredPeak], ends: tuple[float, float], width: float
) -> None:
    """Draw names over the largest peaks; those that would overlap are left to the table."""
    pixel = (ends[1] - ends[0]) / (width - panel.beside - panel.right)
    labels: list[dict[str, Any]] = []
    for peak in sorted(peaks, key=lambda peak: -peak.amplitude):
        free = all(abs(peak.frequency_hz - label["x"]) >= APART * pixel for label in labels)
        if free and peak.frequency_hz <= ends[1]:
            labels.append({"x": peak.frequency_hz, "y": peak.amplitude, "text": peak.name})
    look = {"type": "text", "angle": -90, "align": "left", "dx": 7}
    panel.draw(look | {"fontSize": 10}, labels)


def _computed(
    speed: AtSpeed, response: TrainResponse, ends: tuple[float, float], units: Units
) -> Panel:
    hz, force = response.frequency_hz, units.values(np.abs(response.force), "N")
    inside = (hz <= ends[1]) & (force > 0)
    hz, force = hz[inside], force[inside]
    unit = units.unit("N")
    low, high = (0.6 * force.min(), 4.0 * force.max()) if len(force) else (0.5, 2.0)
    panel = Panel(
        Axis("frequency in Hz", ends),
        Axis(f"mesh force in {unit}", (low, high), log=True),
        240.0,
        title=f"Computed: mesh force, {mix_label(response.models)}; "
        "dashed orders of the mesh, grey natural frequencies",
    )
    _modes(panel, speed, ends, name=True)
    orders = [line for line in speed.lines if line.kind == "mesh" and line.frequency_hz <= ends[1]]
    dashed = {"type": "rule", "color": LINE, "strokeDash": [6, 4]}
    panel.draw(dashed, [{"x": line.frequency_hz} for line in orders])
    for align, aside in (("left", 3), ("right", -3)):  # the last name stays on the paper
        lines = [line for line in orders if (line.frequency_hz > 0.9 * ends[1]) == (aside < 0)]
        names = [{"x": line.frequency_hz, "y": high, "text": line.name} for line in lines]
        panel.draw({"type": "text", "color": LINE, "align": align, "dx": aside, "dy": 7}, names)
    panel.draw({"type": "line", "color": INK, "strokeWidth": 1.6}, curve(hz, force))
    rows = []
    for k in read_places(hz, force, PLACES) if len(hz) > 2 else []:
        facts = (
            ("frequency", hertz(float(hz[k])), "Hz"),
            ("mesh force", plain(float(force[k]), 4), unit),
        )
        rows.append({"x": hz[k], "y": force[k], "readout": readout("computed", *facts)})
    panel.read(rows, INK)
    return panel


def _modes(panel: Panel, speed: AtSpeed, ends: tuple[float, float], name: bool) -> None:
    """Draw natural frequencies as upright lines; where named, they can be read at their feet."""
    inside = [(mode, hz) for mode, hz in speed.modes if hz <= ends[1]]
    panel.draw({"type": "rule", "color": MODE}, [{"x": hz} for _, hz in inside])
    if name:
        low = panel.y.ends[0]
        words = [
            {"x": hz, "y": low, "readout": readout(mode, ("natural frequency", hertz(hz), "Hz"))}
            for mode, hz in inside
        ]
        panel.read(words, MODE)
