"""Charts of a train over frequency, every model in one figure: mesh force and transmission error, or
a receptance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from solidgear.show.panel import Panel, Series, curve, lines_legend, read_places, readout
from solidgear.show.plot import BETWEEN, NARROW, WIDE, Chart, in_columns
from solidgear.show.scales import Axis, log_ticks
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.show.words import hertz
from solidgear.trains.page.tables import turned
from solidgear.trains.response.receptance import TrainReceptance
from solidgear.trains.response.response import TrainResponse

COLOURS = ("#00805e", "#0072b2", "#c98a00", "#b3305c", "#5a3e8c", "#444444", "#1f9bb8", "#8a6d3b")
#: of two responses beside each other, told apart by everyone
PAIR = ("#0072b2", "#c98a00")
#: of the band around the first model
BAND = "#d0e8e1"
#: px; names of peaks that are closer would lie on one another, and what one takes over the curves
APART, ROOM = 14.0, 130.0
#: largest over least amplitude that a panel of several shows: dips go deeper
DEEPEST = 1e4
#: column of a response, its name on a panel, and its SI unit
PANELS = (
    ("mesh force [N]", "mesh force", "N"),
    ("dynamic transmission error [m]", "dynamic transmission error", "m moved"),
)


def response_chart(
    responses: Sequence[TrainResponse],
    title: str,
    teeth: float | None,
    band: float | None,
    marks: Mapping[str, float],
    units: Units = ENGINEERING,
    width: float = WIDE,
) -> Chart:
    """Chart mesh force and dynamic transmission error over frequency, the first response the
    reference.

    Parameters
    ----------
    teeth : int or None
        Of the pinion, for the upper axis in rpm; None where the responses do not share them.
    band : float or None
        Drawn around the first where there are others, dB.
    marks : mapping of str to float
        Where a model leaves the band, Hz, by label.
    """
    last = responses[0].frequency_hz[-1]
    # where models differ is the upper end; below half the first departure they are one line
    first = max(responses[0].frequency_hz[0], min(marks.values(), default=0.0) / 2)
    band = band if len(responses) > 1 else None
    models, panels = _models(responses, PAIR if band is None else COLOURS), []
    if band is not None:
        models |= {f"{band:g} dB around it": Series(BAND)}
    words = f"mesh frequency in Hz{_cut(responses[0], first)}"
    for k, (column, name, si) in enumerate(PANELS):
        unit, top = units.unit(si), k == 0
        curves = _amplitudes(responses, column, name, si, units)
        height = 340.0 if top else 200.0
        ends = _ends([line.y[line.hz >= first] for line in curves])
        panel = Panel(
            Axis("" if top else words, (first, last), log=True),
            Axis(f"{name} in {unit}", _with_room(ends, height) if top else ends, log=True),
            height,
            series=models,
            legend=lines_legend(3 if width > NARROW else 1) if top else None,
            upper=_speed(teeth, (first, last)) if top and teeth else None,
        )
        if band is not None:
            _shade(panel, curves[0], band)
        _curves(panel, curves, teeth, width)
        if top:
            dots = {"type": "rule", "strokeDash": [2, 3], "strokeWidth": 1.4}
            lines = [{"x": hz, "y": ends[0], "y2": ends[1], "name": n} for n, hz in marks.items()]
            panel.draw(dots, [line for line in lines if line["name"] in models])
            _peaks(panel, responses, si, units, teeth, name, width)
        panels.append(panel)
    return Chart(in_columns(panels, 1), width, title)


def columns_chart(
    responses: Sequence[TrainResponse],
    columns: Sequence[tuple[str, str]],
    teeth: float | None,
    units: Units = ENGINEERING,
    width: float = WIDE,
) -> Chart | None:
    """Chart amplitudes of columns over frequency, a panel each; None where none moves."""
    ends = responses[0].frequency_hz[0], responses[0].frequency_hz[-1]
    models, panels = _models(responses, PAIR), []
    moving = [c for c in columns if any(np.any(r.columns.get(c[0])) for r in responses)]
    in_row = 2 if width > NARROW and len(moving) > 1 else 1
    for k, (column, title) in enumerate(moving):
        si = column.partition(" [")[2].rstrip("]")
        si = f"{si} moved" if si in ("m", "rad") else si
        curves = _amplitudes(responses, column, title, si, units)
        low, high = _ends([line.y for line in curves])
        panel = Panel(
            Axis("mesh frequency in Hz" if k >= len(moving) - in_row else "", ends, log=True),
            Axis(units.unit(si), (max(low, high / DEEPEST), high), log=True),
            140.0,
            title,
            series=models,
            legend=lines_legend(3 if width > NARROW else 1) if k == 0 else None,
        )
        _curves(panel, curves, teeth, width / in_row / 2)
        panels.append(panel)
    if len(panels) % in_row:  # as wide as those above it
        panels[-1].right += (width + BETWEEN) / in_row
    return Chart(in_columns(panels, in_row), width) if panels else None


def _cut(response: TrainResponse, first: float) -> str:
    """Return a remark on the part below the axis; empty if there is none."""
    if first <= response.frequency_hz[0]:
        return ""
    below = sum(peak.frequency_hz < first for peak in response.peaks)
    peaks = {0: "", 1: "; 1 peak lies below"}.get(below, f"; {below} peaks lie below")
    return f", from half the frequency where the first model leaves the tolerance{peaks}"


def receptance_chart(
    receptances: Sequence[TrainReceptance],
    title: str,
    teeth: float,
    units: Units = ENGINEERING,
    width: float = WIDE,
) -> Chart:
    """Chart amplitude and phase of receptances between two ends, with the first model's peaks
    named.
    """
    unit, models = units.unit(receptances[0].unit), _models(receptances)
    sizes = [units.values(np.abs(receptance.value), receptance.unit) for receptance in receptances]
    phases = [np.degrees(np.angle(receptance.value)) for receptance in receptances]
    ends = receptances[0].frequency_hz[0], receptances[0].frequency_hz[-1]
    amplitude = Panel(
        Axis("", ends, log=True),
        Axis(f"receptance in {unit}", _with_room(_ends(sizes), 360.0), log=True),
        360.0,
        series=models,
        legend=lines_legend(3 if width > NARROW else 1),
        upper=_speed(teeth, ends),
    )
    turns = {float(v): str(v) for v in (-180, -90, 0, 90, 180)}
    phase = Panel(
        Axis("frequency in Hz", ends, log=True),
        Axis("phase in degrees", (-185.0, 185.0), ticks=turns),
        150.0,
        series=models,
    )
    for panel, values in ((amplitude, sizes), (phase, phases)):
        curves = [
            _Curve(
                receptance.label,
                receptance.frequency_hz,
                value,
                (("receptance", unit, size), ("phase", "degrees", angle)),
            )
            for receptance, value, size, angle in zip(receptances, values, sizes, phases)
        ]
        _curves(panel, curves, teeth, width, 180.0 if panel is phase else np.inf)
    _peaks(amplitude, receptances, receptances[0].unit, units, teeth, "receptance", width)
    return Chart(in_columns([amplitude, phase], 1), width, title)


class _Curve(NamedTuple):
    """A model over frequency; ``read`` is (what, unit, values) at every place."""

    name: str
    hz: np.ndarray
    y: np.ndarray
    read: tuple[tuple[str, str, np.ndarray], ...]


def _amplitudes(
    responses: Sequence[TrainResponse], column: str, name: str, si: str, units: Units
) -> list[_Curve]:
    """Return the amplitude of a column of those responses that have it."""
    out = []
    for response in responses:
        if column in response.columns:
            size = units.values(np.abs(response.columns[column]), si)
            read = ((name, units.unit(si), size),)
            out.append(_Curve(response.label, response.frequency_hz, size, read))
    return out


def _models(
    curves: Sequence[TrainResponse | TrainReceptance], colours: Sequence[str] = COLOURS
) -> dict[str, Series]:
    """Return models by their labels, the colours in turn."""
    colours = colours if len(curves) == len(PAIR) else COLOURS
    return {item.label: Series(colours[k % len(colours)]) for k, item in enumerate(curves)}


def _speed(teeth: float, ends: tuple[float, float]) -> Axis:
    """Return the upper axis: round speeds of the shaft, at its mesh frequencies."""
    rounds = log_ticks(60 * ends[0] / teeth, 60 * ends[1] / teeth)
    ticks = {rpm * teeth / 60: f"{rpm:g}" for rpm in rounds}
    words = f"{turned(teeth)} speed in rpm at which the teeth mesh at it"
    return Axis(words, ends, log=True, ticks=ticks, grid=False)


def _ends(sizes: Sequence[np.ndarray]) -> tuple[float, float]:
    """Return the least and largest amplitude, with room."""
    values = np.concatenate(sizes)
    values = values[values > 0] if np.any(values > 0) else np.ones(1)
    return 0.6 * values.min(), 1.8 * values.max()


def _with_room(ends: tuple[float, float], height: float) -> tuple[float, float]:
    """Return ends of an axis with room for names over the curves."""
    low, high = ends
    return low, high * (high / low) ** (ROOM / (height - ROOM))


def _words(name: str, hz: float, teeth: float | None, *facts: tuple[str, str, str]) -> str:
    """Return the words on a place of a model over frequency."""
    speed = (f"{turned(teeth)} speed", f"{60 * hz / teeth:.0f}" if teeth else "", "rpm")
    return readout(name, ("frequency", hertz(hz), "Hz"), speed, *facts)


def _curves(
    panel: Panel, curves: Sequence[_Curve], teeth: float | None, width: float, jump: float = np.inf
) -> None:
    """Draw curves, the first in front, with places to be read; broken where one jumps."""
    first, last = panel.x.ends
    for k, line in reversed(list(enumerate(curves))):
        inside = np.flatnonzero((line.hz >= first) & (line.hz <= last))
        x, y = line.hz[inside], line.y[inside]
        turns = np.cumsum(np.abs(np.diff(y, prepend=y[0])) > jump)
        rows = curve(x, y, name=line.name)
        for row, part in zip(rows, turns.tolist()):
            row["detail"] = part
        panel.draw({"type": "line", "strokeWidth": 1.8 if k == 0 else 1.1}, rows)
        read = []
        for i in read_places(x, y, int(width / APART), log=True):
            facts = [(name, _figure(name, v[inside[i]]), unit) for name, unit, v in line.read]
            words = _words(line.name, float(x[i]), teeth, *facts)
            read.append({"x": x[i], "y": y[i], "readout": words})
        panel.read(read, panel.series[line.name].colour)


def _figure(name: str, value: float) -> str:
    return f"{value:.1f}" if name == "phase" else plain(float(value), 4)


def _shade(panel: Panel, line: _Curve, band: float) -> None:
    """Draw the tolerance in decibels around a curve."""
    factor, inside = 10 ** (band / 20), line.hz >= panel.x.ends[0]
    rows = [
        {"x": x, "y": y / factor, "y2": y * factor, "name": f"{band:g} dB around it"}
        for x, y in zip(line.hz[inside].tolist(), line.y[inside].tolist())
    ]
    panel.draw({"type": "area", "opacity": 0.7}, rows)


def _peaks(
    panel: Panel,
    models: Sequence[TrainResponse | TrainReceptance],
    si: str,
    units: Units,
    teeth: float | None,
    name: str,
    width: float,
) -> None:
    """Draw the peaks of every model, and names of the first model's that do not overlap."""
    for model in models:
        rows = []
        for hz, size, mode in model.peaks:
            y = units.value(size, si)
            facts = ("peak of", mode, ""), (name, plain(y, 4), units.unit(si))
            rows.append({"x": hz, "y": y, "readout": _words(model.label, hz, teeth, *facts)})
        panel.read(rows, panel.series[model.label].colour)
    first, last = panel.x.ends
    pixel = np.log(last / first) / (width - panel.beside - panel.right)
    labelled, before = [], -np.inf
    for hz, size, mode in models[0].peaks:
        if hz >= first and np.log(hz) - before >= APART * pixel:
            before = np.log(hz)
            labelled.append({"x": hz, "y": units.value(size, si), "text": f"{mode}  {hz:.0f} Hz"})
    look = {"type": "text", "angle": -90, "align": "left", "dx": 7}
    panel.draw(look | {"fontSize": 10}, labelled)
