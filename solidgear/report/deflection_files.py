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

    Returns
    -------
    list of Path
        ``deflection.html`` first, then a CSV a shaft with its line by the judge, the JSON, the chart.
    """
    shown = units_named(units)
    judge = list(models.values())[-1]
    charts = {"deflection": partial(deflection_chart, models, title, shown)}
    lines = {f"deflection_{shaft.name}": tables.line(shaft) for shaft in judge}
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
