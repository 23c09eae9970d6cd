"""Curves of a sweep of a train over the number that varies, and their table."""

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
#: what is told whether it moves or not
FIRST = "bending 1"
#: of the largest value of a column
ROUNDING = 1e-9
#: colour of curves that their names tell apart
LINE = "#00805e"


def sweep_chart(found: Any, title: str, units: Units = ENGINEERING, width: float = WIDE) -> Chart:
    """Natural frequencies over the number that varies, and what else the rows tell.

    Parameters
    ----------
    width : float
        px.
    """
    lengths = [one for one in found.misalignment if one.unit == "m moved"]
    angles = [one for one in found.misalignment if one.unit != "m moved"]
    first = _panel(
        found, found.frequencies, "natural frequency", units, 380.0, named=width > NARROW
    )
    others = [
        _panel(found, found.peak_force, "largest mesh force", units),
        _panel(found, lengths, "misalignment", units),
        _panel(found, angles, "misalignment", units),
        _panel(found, found.radial, "radial load of bearings", units),
        _panel(found, found.axial, "axial load of bearings", units),
    ]
    panels = [panel for panel in others if panel is not None]
    rows = [[first]] if first is not None else []
    return Chart(rows + in_columns(panels, 2 if width > NARROW else 1), width, title)


def sweep_table(found: Any, units: Units = ENGINEERING) -> Table:
    """Table of every row: of a train the operating point and the largest peak of the mesh force, else
    the stiffness at the lumped point and the modes that move most, by their names.
    """
    columns = [text("point", lambda k: found.labels[k])] if found.labels else []
    last = found.over.rpartition(".")[2]
    columns.append(
        Column(f"{last}\n{found.unit or 'SI'}", lambda k: f"{found.x[k]:.6g}", kind=NUMBER)
    )
    told = [*found.mesh_force, *found.misalignment]
    named = _by_name(found.frequencies)
    shown = {} if told else _moving_most(named)
    columns += [_column(one.name, one, units) for one in (*told, *found.statics)]
    columns += [_values(name, values, "Hz", units) for name, values in shown.items()]
    for hz, force in zip(found.peak_hz, found.peak_force):
        peak = [_column("peak", hz, units), _column("peak", force, units)]
        columns += [*peak, text("mode", partial(_said, hz))]
    notes = ["Peak: largest of the mesh force."] if found.peak_hz else []
    if len(shown) < len(named) and shown:
        notes.append("Modes that change most; the file has all.")
    style = "bare" if len(found.mesh_force) < 2 else "ruled"  # names of meshes fill their columns
    return Table(f"Over {found.over}", columns, range(len(found.x)), " ".join(notes), style=style)


def _by_name(frequencies: Sequence[Any]) -> dict[str, np.ndarray]:
    """Natural frequencies of all rows by the names of their modes, the lowest first."""
    found: dict[str, np.ndarray] = {}
    for one in frequencies:
        for k, name in enumerate(one.words):
            if name:
                row = found.setdefault(name, np.full(len(one.values), np.nan))
                row[k] = one.values[k] if np.isnan(row[k]) else row[k]
    return dict(sorted(found.items(), key=lambda mode: float(np.nanmin(mode[1]))))


def _moving_most(named: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """First bending, and the modes that change most, in their order."""
    whole = {name: values for name, values in named.items() if np.isfinite(values).sum() > 1}
    change = {name: np.nanmax(values) / np.nanmin(values) for name, values in whole.items()}
    most = sorted(change, key=lambda name: (name != FIRST, -change[name]))[:MOVING]
    return {name: values for name, values in named.items() if name in (most or named)}


def _column(head: str, one: Any, units: Units) -> Column:
    return _values(head, one.values, one.unit, units)


def _values(head: str, given: np.ndarray, si: str, units: Units) -> Column:
    write = partial(units.number, si=si, digits=4)
    # what is next to nothing beside the others is rounding
    least = ROUNDING * float(np.nanmax(np.abs(given)))
    values = np.where(np.abs(given) < least, 0.0, given).tolist()
    return Column(f"{head}\n{units.unit(si)}", values.__getitem__, write)


def _said(one: Any, k: int) -> str | None:
    return one.words[k] or None


def _over(found: Any) -> str:
    return f"{found.over}, {found.unit}" if found.unit else found.over


def _panel(
    found: Any,
    lines: Sequence[Any],
    what: str,
    units: Units,
    height: float = 230.0,
    named: bool = False,
) -> Panel | None:
    """Curves of one unit; None where there is none. Named ones have their words at their ends, the
    others a legend where there are several.
    """
    if not lines:
        return None
    unit = units.unit(lines[0].unit)
    if len(lines) == 1 and not lines[0].words:
        what = f"{what} {lines[0].name}"
    values = [units.values(one.values, one.unit) for one in lines]
    several = len(lines) > 1 and not lines[0].words
    series = {one.name: Series(COLOURS[k % len(COLOURS)]) for k, one in enumerate(lines)}
    panel = Panel(
        Axis(_over(found), _ends(found.x, 0.0, found.log), log=found.log),
        Axis(f"{what} in {unit}", _ends(np.concatenate(values), 0.06)),
        height,
        series=series if several else {},
        legend={"orient": "top", "columns": 4, "symbolType": "stroke", "symbolStrokeWidth": 3},
        right=NAMES if named else 8.0,
    )
    for one, y in zip(lines, values):
        look = {"name": one.name} if several else {}
        colour = series[one.name].colour if several else LINE
        one_colour = {} if several else {"color": LINE}
        line = {"type": "line", "point": {"size": 14, **one_colour}, **one_colour}
        # a curve is broken where a variant was refused
        parts = zip(found.x.tolist(), y.tolist(), np.cumsum(~np.isfinite(y)).tolist())
        panel.draw(line, [{"x": a, "y": b, "detail": part, **look} for a, b, part in parts])
        panel.read(_places(found, one, y, what, unit), colour)
    if named:
        _names(panel, found, lines, values)
    return panel


def _places(found: Any, one: Any, y: np.ndarray, what: str, unit: str) -> list[dict[str, Any]]:
    """Words on every place of a curve."""
    rows = []
    for k, (a, b) in enumerate(zip(found.x.tolist(), y.tolist())):
        named = found.labels[k] if found.labels else one.name
        said = one.words[k] if one.words else one.name
        facts = (found.over, f"{a:.6g}", found.unit), (what, plain(b, 5), unit)
        rows.append({"x": a, "y": b, "readout": readout(said or named, *facts)})
    return rows


def _names(panel: Panel, found: Any, lines: Sequence[Any], values: Sequence[np.ndarray]) -> None:
    """Words of the last place of each curve beside it; one that would lie on another is left out."""
    low, high = panel.y.ends
    step = APART * (high - low) / panel.height
    rows, last = [], -np.inf
    for one, y in zip(lines, values):
        if np.isfinite(y[-1]) and y[-1] >= last + step:
            last = float(y[-1])
            rows.append({"x": float(found.x[-1]), "y": last, "text": one.words[-1]})
    look = {"type": "text", "align": "left", "baseline": "middle", "dx": 6, "fontSize": 10}
    panel.draw(look, rows)


def _ends(values: np.ndarray, room: float, log: bool = False) -> tuple[float, float]:
    """Ends of an axis that holds all values."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    more = room * (high - low) if high > low else 0.5 * abs(high) or 1.0
    if log:
        return (low, high) if high > low else (low / 2, high * 2)
    return (low - more if low < 0 else max(low - more, 0.0)), high + more
