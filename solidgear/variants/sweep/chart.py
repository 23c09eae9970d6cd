"""Curves of a sweep over the number that varies, and their table."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from solidgear.show.panel import Axis, Panel, Series, readout
from solidgear.show.plot import NARROW, WIDE, Chart, in_columns
from solidgear.show.table import NUMBER, Column, Table, text
from solidgear.show.units import ENGINEERING, Units, plain
from solidgear.trains.page.chart import COLOURS

#: px; names at the right ends of curves, and the least distance of two
NAMES, APART = 150.0, 13.0
#: natural frequencies in the table of a train without operating points
MOVING = 4
#: mode that is shown whether it moves or not
FIRST = "bending 1"
#: of the largest value of a column
ROUNDING = 1e-9
#: colour of curves with their names beside them
LINE = "#00805e"


def sweep_chart(curves: Any, title: str, units: Units = ENGINEERING, width: float = WIDE) -> Chart:
    """Draw natural frequencies and all other curves of the rows over the number that varies; width in
    px.
    """
    lengths = [curve for curve in curves.misalignment if curve.unit == "m moved"]
    angles = [curve for curve in curves.misalignment if curve.unit != "m moved"]
    first = _panel(
        curves, curves.frequencies, "natural frequency", units, 380.0, named=width > NARROW
    )
    others = [
        _panel(curves, curves.peak_force, "largest mesh force", units),
        _panel(curves, lengths, "misalignment", units),
        _panel(curves, angles, "misalignment", units),
        _panel(curves, curves.radial, "radial load of bearings", units),
        _panel(curves, curves.axial, "axial load of bearings", units),
    ]
    panels = [panel for panel in others if panel is not None]
    rows = [[first]] if first is not None else []
    return Chart(rows + in_columns(panels, 2 if width > NARROW else 1), width, title)


def sweep_table(curves: Any, units: Units = ENGINEERING) -> Table:
    """Return the table of every row: of a train the operating point and the largest peak of the mesh
    force, else the stiffness at the lumped point and the modes that move most, by their names.
    """
    columns = [text("point", lambda k: curves.labels[k])] if curves.labels else []
    last = curves.over.rpartition(".")[2]
    columns.append(
        Column(f"{last}\n{curves.unit or 'SI'}", lambda k: f"{curves.x[k]:.6g}", kind=NUMBER)
    )
    of_train = [*curves.mesh_force, *curves.misalignment]
    modes = _by_name(curves.frequencies)
    shown = {} if of_train else _moving_most(modes)
    columns += [_column(curve.name, curve, units) for curve in (*of_train, *curves.statics)]
    columns += [_values(name, values, "Hz", units) for name, values in shown.items()]
    for hz, force in zip(curves.peak_hz, curves.peak_force):
        columns += [
            _column("peak", hz, units),
            _column("peak", force, units),
            text("mode", partial(_words, hz)),
        ]
    notes = ["Peak: largest of the mesh force."] if curves.peak_hz else []
    if len(shown) < len(modes) and shown:
        notes.append("Modes that change most; the file has all.")
    style = "bare" if len(curves.mesh_force) < 2 else "ruled"  # names of meshes fill their columns
    return Table(f"Over {curves.over}", columns, range(len(curves.x)), " ".join(notes), style=style)


def _by_name(frequencies: Sequence[Any]) -> dict[str, np.ndarray]:
    """Return the natural frequencies of all rows by the names of modes, the lowest first."""
    modes: dict[str, np.ndarray] = {}
    for curve in frequencies:
        for k, name in enumerate(curve.words):
            if name:
                row = modes.setdefault(name, np.full(len(curve.values), np.nan))
                row[k] = curve.values[k] if np.isnan(row[k]) else row[k]
    return dict(sorted(modes.items(), key=lambda mode: float(np.nanmin(mode[1]))))


def _moving_most(modes: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return first bending and the modes that change most, in their order."""
    compared = {name: values for name, values in modes.items() if np.isfinite(values).sum() > 1}
    change = {name: np.nanmax(values) / np.nanmin(values) for name, values in compared.items()}
    most = sorted(change, key=lambda name: (name != FIRST, -change[name]))[:MOVING]
    return {name: values for name, values in modes.items() if name in (most or modes)}


def _column(head: str, curve: Any, units: Units) -> Column:
    return _values(head, curve.values, curve.unit, units)


def _values(head: str, numbers: np.ndarray, si: str, units: Units) -> Column:
    write = partial(units.number, si=si, digits=4)
    # numbers that are negligible beside the others are rounding
    least = ROUNDING * float(np.nanmax(np.abs(numbers)))
    values = np.where(np.abs(numbers) < least, 0.0, numbers).tolist()
    return Column(f"{head}\n{units.unit(si)}", values.__getitem__, write)


def _words(curve: Any, k: int) -> str | None:
    return curve.words[k] or None


def _panel(
    curves: Any,
    lines: Sequence[Any],
    title: str,
    units: Units,
    height: float = 230.0,
    named: bool = False,
) -> Panel | None:
    """Draw curves of one unit; None where there is none. Named ones have their words at their ends, the
    others a legend where there are several.
    """
    if not lines:
        return None
    unit = units.unit(lines[0].unit)
    if len(lines) == 1 and not lines[0].words:
        title = f"{title} {lines[0].name}"
    values = [units.values(curve.values, curve.unit) for curve in lines]
    several = len(lines) > 1 and not lines[0].words
    series = {curve.name: Series(COLOURS[k % len(COLOURS)]) for k, curve in enumerate(lines)}
    over = f"{curves.over}, {curves.unit}" if curves.unit else curves.over
    panel = Panel(
        Axis(over, _ends(curves.x, 0.0, curves.log), log=curves.log),
        Axis(f"{title} in {unit}", _ends(np.concatenate(values), 0.06)),
        height,
        series=series if several else {},
        legend={"orient": "top", "columns": 4, "symbolType": "stroke", "symbolStrokeWidth": 3},
        right=NAMES if named else 8.0,
    )
    for curve, y in zip(lines, values):
        look = {"name": curve.name} if several else {}
        colour = series[curve.name].colour if several else LINE
        fixed_colour = {} if several else {"color": LINE}
        line = {"type": "line", "point": {"size": 14, **fixed_colour}, **fixed_colour}
        # a curve is broken where a variant was refused
        parts = zip(curves.x.tolist(), y.tolist(), np.cumsum(~np.isfinite(y)).tolist())
        panel.draw(line, [{"x": a, "y": b, "detail": part, **look} for a, b, part in parts])
        panel.read(_readouts(curves, curve, y, title, unit), colour)
    if named:
        _draw_names(panel, curves, lines, values)
    return panel


def _readouts(
    curves: Any, curve: Any, y: np.ndarray, title: str, unit: str
) -> list[dict[str, Any]]:
    """Return the words on every place of a curve."""
    rows = []
    for k, (a, b) in enumerate(zip(curves.x.tolist(), y.tolist())):
        label = curves.labels[k] if curves.labels else curve.name
        words = curve.words[k] if curve.words else curve.name
        over = curves.over, f"{a:.6g}", curves.unit
        rows.append(
            {"x": a, "y": b, "readout": readout(words or label, over, (title, plain(b, 5), unit))}
        )
    return rows


def _draw_names(
    panel: Panel, curves: Any, lines: Sequence[Any], values: Sequence[np.ndarray]
) -> None:
    """Draw the words of the last place of each curve beside it, unless they would lie on others."""
    low, high = panel.y.ends
    step = APART * (high - low) / panel.height
    rows, last = [], -np.inf
    for curve, y in zip(lines, values):
        if np.isfinite(y[-1]) and y[-1] >= last + step:
            last = float(y[-1])
            rows.append({"x": float(curves.x[-1]), "y": last, "text": curve.words[-1]})
    look = {"type": "text", "align": "left", "baseline": "middle", "dx": 6, "fontSize": 10}
    panel.draw(look, rows)


def _ends(values: np.ndarray, room: float, log: bool = False) -> tuple[float, float]:
    """Return the ends of an axis that holds all values."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    more = room * (high - low) if high > low else 0.5 * abs(high) or 1.0
    if log:
        return (low, high) if high > low else (low / 2, high * 2)
    return (low - more if low < 0 else max(low - more, 0.0)), high + more
