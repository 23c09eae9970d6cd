"""Files of a deflection: lines, numbers, chart and page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.show.panel import GREY, Axis, Panel, Series, curve, lines_legend, readout
from solidgear.show.plot import NARROW, WIDE, Chart, in_columns
from solidgear.show.sheet_files import write_files
from solidgear.show.table import Table
from solidgear.show.units import ENGINEERING, Units, units_named
from solidgear.strength.deflection import tables
from solidgear.trains.page.chart import COLOURS


def write_deflection(
    folder: Path,
    models: Mapping[str, Sequence[Any]],
    data: Mapping[str, Any],
    title: str,
    lead: str,
    summaries: Sequence[Table] = (),
    cautions: Sequence[str] = (),
    units: str | Units = ENGINEERING,
    turns: Sequence[Any] = (),
) -> list[Path]:
    """Write page, data, charts and a CSV per shaft; `data` is in SI, chart and page in `units`."""
    chosen_units = units_named(units)
    judge = list(models.values())[-1]
    charts = {"deflection": partial(deflection_chart, models, title, chosen_units)}
    lines = {f"deflection_{shaft.name}": tables.line(shaft) for shaft in judge}
    for turn in turns:
        charts[f"turn_{turn.stage}"] = partial(turn_chart, turn, chosen_units)
        lines[f"turn_{turn.stage}"] = tables.turn_lines(turn)
    return write_files(
        folder,
        "deflection",
        title,
        lead,
        [
            *summaries,
            *tables.bearings(judge, chosen_units),
            tables.displacements(judge, chosen_units),
        ],
        data,
        lines=lines,
        charts=charts,
        cautions=cautions,
    )


def turn_chart(turn: Any, units: Units = ENGINEERING, width: float = WIDE) -> Chart:
    """Chart the mesh force of every planet of a stage over a turn of the carrier."""
    names = [f"planet {k}" for k in range(1, turn.force.shape[1] + 1)]
    looks = {name: Series(COLOURS[k % len(COLOURS)]) for k, name in enumerate(names)}
    angle = np.degrees(np.append(turn.angle, 2 * np.pi))
    force = units.values(np.vstack([turn.force, turn.force[:1]]), "N")
    unit, room = units.unit("N"), 0.12 * np.ptp(force) or 0.12 * np.abs(force).max()
    panel = Panel(
        Axis(
            "carrier in degrees", (0.0, 360.0), ticks={a: f"{a:g}" for a in np.arange(0.0, 361, 60)}
        ),
        Axis(f"mesh force in {unit}", (force.min() - room, force.max() + room)),
        230.0,
        series=looks,
        legend=lines_legend(6),
    )
    for name, values in zip(names, force.T):
        panel.draw("line", curve(angle, values, name=name))
        read = curve(angle, values)
        for row in read:
            position, size = ("at", f"{row['x']:.0f}", "°"), ("", f"{row['y']:.4g}", unit)
            row["readout"] = readout(name, position, size)
        panel.read(read, looks[name].colour)
    return Chart([[panel]], width, f"Mesh forces over a turn of the carrier ({turn.stage})")


#: planes by the translation and the rotation that belong to each
PLANES = {"x": (0, 5), "z": (2, 3)}


def deflection_chart(
    shafts: Mapping[str, Sequence[Any]],
    title: str,
    units: Units = ENGINEERING,
    width: float = WIDE,
) -> Chart:
    """Chart the deflection of every shaft in both planes by every model, the last of them the
    reference.
    """
    looks = {name: Series(COLOURS[k % len(COLOURS)]) for k, name in enumerate(shafts)}
    names = [shaft.name for shaft in next(iter(shafts.values()))]
    panels = [
        _panel(shafts, looks, k, plane, units, width, first=k == 0 and plane == "x")
        for k in range(len(names))
        for plane in PLANES
    ]
    columns = 2 if width > NARROW else 1
    return Chart(in_columns(panels, columns), width, title)


def _panel(
    by_model: Mapping[str, Sequence[Any]],
    looks: Mapping[str, Series],
    k: int,
    plane: str,
    units: Units,
    width: float,
    first: bool,
) -> Panel:
    """Return the panel of one shaft in one plane."""
    component = PLANES[plane][0]
    shafts = {name: lines[k] for name, lines in by_model.items()}
    reference = list(shafts.values())[-1]
    along = {name: units.values(s.stations, "m") for name, s in shafts.items()}
    moved = {name: units.values(s.line[:, component], "m moved") for name, s in shafts.items()}
    ends = _ends(np.concatenate(list(moved.values())))
    length, unit = units.unit("m"), units.unit("m moved")
    last = float(along[list(shafts)[-1]][-1])
    panel = Panel(
        Axis(f"y of {reference.name} in {length}", (0.0, last)),
        Axis(f"{plane} in {unit}", ends),
        190.0,
        f"{reference.name}, {plane}",
        series=looks,
        legend=lines_legend(4) if first else None,
    )
    panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
    for bearing in reference.bearings:
        place = float(units.values(np.array([bearing.place]), "m")[0])
        panel.draw({"type": "rule", "color": GREY, "strokeDash": [2, 3]}, [{"x": place}])
        name = {"type": "text", "color": GREY, "align": "left", "dx": 3, "dy": -85}
        panel.draw(name, [{"x": place, "text": bearing.name}], y={"value": 95})
    for model in shafts:
        panel.draw("line", curve(along[model], moved[model], name=model))
        read = curve(along[model], moved[model])
        for row in read:
            abscissa, size = ("y", f"{row['x']:.1f}", length), (plane, f"{row['y']:.3g}", unit)
            row["readout"] = readout(model, abscissa, size)
        panel.read(read, looks[model].colour)
    return panel


def _ends(values: np.ndarray) -> tuple[float, float]:
    """Return ends of an axis that holds all values and zero, with room."""
    low, high = min(values.min(), 0.0), max(values.max(), 0.0)
    room = 0.12 * (high - low) or 1.0
    return float(low - room), float(high + room)
