"""Files of a deflection: lines, numbers, chart and page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.report import deflection_tables as tables
from solidgear.report.panel import GREY, Axis, Panel, Series, readout
from solidgear.report.plot import NARROW, WIDE, Chart, in_columns
from solidgear.report.sheet_files import write_files
from solidgear.report.table import Table
from solidgear.report.train_chart import COLOURS
from solidgear.report.units import ENGINEERING, Units, units_named


def write_deflection(
    folder: Path,
    models: Mapping[str, Sequence[Any]],
    data: Mapping[str, Any],
    title: str,
    lead: str,
    told: Sequence[Table] = (),
    cautions: Sequence[str] = (),
    units: str | Units = ENGINEERING,
    turns: Sequence[Any] = (),
) -> list[Path]:
    """Write a deflection into a folder.

    Parameters
    ----------
    models : mapping of str to sequence of ShaftDeflection
        Shafts by model, the judge last.
    data : mapping
        Everything as plain data in SI, which becomes ``deflection.json``.
    told : sequence of Table
        Before those of displacements and bearings.
    units : str or Units
        Of chart and page.
    turns : sequence of StageTurn
        Of planetary stages.

    Returns
    -------
    list of Path
        ``deflection.html`` first, then a CSV a shaft with its line by the judge, the JSON, the chart.
    """
    shown = units_named(units)
    judge = list(models.values())[-1]
    charts = {"deflection": partial(deflection_chart, models, title, shown)}
    lines = {f"deflection_{shaft.name}": tables.line(shaft) for shaft in judge}
    for turn in turns:
        charts[f"turn_{turn.stage}"] = partial(turn_chart, turn, shown)
        lines[f"turn_{turn.stage}"] = tables.turn_lines(turn)
    return write_files(
        folder,
        "deflection",
        title,
        lead,
        [*told, *tables.bearings(judge, shown), tables.displacements(judge, shown)],
        data,
        lines=lines,
        charts=charts,
        cautions=cautions,
    )


def turn_chart(turn: Any, units: Units = ENGINEERING, width: float = WIDE) -> Chart:
    """Mesh force of every planet of a stage over a turn of the carrier."""
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
        legend={"orient": "top", "columns": 6, "symbolType": "stroke", "symbolStrokeWidth": 3},
    )
    for name, own in zip(names, force.T):
        rows = [{"x": float(a), "y": float(f)} for a, f in zip(angle, own)]
        panel.draw("line", [{**row, "name": name} for row in rows])
        told = [
            readout(name, ("at", f"{r['x']:.0f}", "°"), ("", f"{r['y']:.4g}", unit)) for r in rows
        ]
        panel.read([{**row, "readout": say} for row, say in zip(rows, told)], looks[name].colour)
    return Chart(
        in_columns([panel], 1), width, f"Mesh forces over a turn of the carrier ({turn.stage})"
    )


#: planes by the translation and the rotation that belong to each
PLANES = {"x": (0, 5), "z": (2, 3)}


def deflection_chart(
    found: Mapping[str, Sequence[Any]],
    title: str,
    units: Units = ENGINEERING,
    width: float = WIDE,
) -> Chart:
    """Deflection of every shaft in both planes.

    Parameters
    ----------
    found : mapping of str to sequence of ShaftDeflection
        Shafts of each model, by its name; the last is the reference.
    width : float
        px.
    """
    looks = {name: Series(COLOURS[k % len(COLOURS)]) for k, name in enumerate(found)}
    names = [shaft.name for shaft in next(iter(found.values()))]
    panels = [
        _panel(found, looks, k, plane, units, width, first=k == 0 and plane == "x")
        for k in range(len(names))
        for plane in PLANES
    ]
    columns = 2 if width > NARROW else 1
    return Chart(in_columns(panels, columns), width, title)


def _panel(
    found: Mapping[str, Sequence[Any]],
    looks: Mapping[str, Series],
    k: int,
    plane: str,
    units: Units,
    width: float,
    first: bool,
) -> Panel:
    """One shaft in one plane."""
    component = PLANES[plane][0]
    shafts = {name: own[k] for name, own in found.items()}
    reference = list(shafts.values())[-1]
    along = {name: units.values(s.stations, "m") for name, s in shafts.items()}
    moved = {name: units.values(s.line[:, component], "m moved") for name, s in shafts.items()}
    ends = _ends(np.concatenate(list(moved.values())))
    legend = {"orient": "top", "columns": 4, "symbolType": "stroke", "symbolStrokeWidth": 3}
    length, unit = units.unit("m"), units.unit("m moved")
    last = float(along[list(shafts)[-1]][-1])
    panel = Panel(
        Axis(f"y of {reference.name} in {length}", (0.0, last)),
        Axis(f"{plane} in {unit}", ends),
        190.0,
        f"{reference.name}, {plane}",
        series=looks,
        legend=legend if first else None,
    )
    panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
    for bearing in reference.bearings:
        place = float(units.values(np.array([bearing.place]), "m")[0])
        panel.draw({"type": "rule", "color": GREY, "strokeDash": [2, 3]}, [{"x": place}])
        name = {"type": "text", "color": GREY, "align": "left", "dx": 3, "dy": -85}
        panel.draw(name, [{"x": place, "text": bearing.name}], y={"value": 95})
    for model in shafts:
        rows: list[dict[str, Any]] = [
            {
                "x": float(x),
                "y": float(y),
                "name": model,
                "readout": readout(model, ("y", f"{x:.1f}", length), (plane, f"{y:.3g}", unit)),
            }
            for x, y in zip(along[model], moved[model])
        ]
        panel.draw("line", [{k: v for k, v in row.items() if k != "readout"} for row in rows])
        panel.read(
            [{k: v for k, v in row.items() if k != "name"} for row in rows], looks[model].colour
        )
    return panel


def _ends(values: np.ndarray) -> tuple[float, float]:
    """Ends of an axis that holds all values and zero, with room."""
    low, high = min(values.min(), 0.0), max(values.max(), 0.0)
    room = 0.12 * (high - low) or 1.0
    return float(low - room), float(high + room)
