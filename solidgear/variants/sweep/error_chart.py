"""Chart and table of the transmission error over the torque, a curve for each relief."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from solidgear.show.panel import Panel, Series, curve, lines_legend, readout
from solidgear.show.plot import NARROW, WIDE, Chart
from solidgear.show.scales import Axis
from solidgear.show.table import NUMBER, Column, Table
from solidgear.show.units import ENGINEERING, Units
from solidgear.trains.page.chart import COLOURS
from solidgear.variants.sweep.error_curves import ErrorCurves

#: columns of the legend, on wide and narrow pages
LEGEND = 4, 2


def error_chart(
    meshes: Sequence[ErrorCurves], title: str, units: Units = ENGINEERING, width: float = WIDE
) -> Chart:
    """Draw the transmission error of every mesh over the torque, a curve for each label; width in
    px.
    """
    panels = [[_panel(mesh, units, LEGEND[width <= NARROW])] for mesh in meshes]
    return Chart(panels, width, title)


def _panel(mesh: ErrorCurves, units: Units, columns: int) -> Panel:
    unit, errors = units.unit("m moved"), units.values(mesh.error, "m moved")
    looks = {label: Series(colour) for label, colour in zip(mesh.labels, COLOURS)}
    low, high = float(np.nanmin(mesh.torque)), float(np.nanmax(mesh.torque))
    panel = Panel(
        Axis(f"{mesh.over}, {mesh.unit}", (min(low, 0.0), max(high, 0.0))),
        Axis(f"{mesh.name}, {unit}", (0.0, 1.06 * float(np.nanmax(errors)))),
        300.0,
        series=looks,
        legend=lines_legend(columns),
    )
    for label, error in zip(mesh.labels, errors):
        rows = curve(mesh.torque, error, name=label)
        panel.draw({"type": "line", "point": {"size": 14}}, rows)
        read = curve(mesh.torque, error)
        for row in read:
            torque = "torque", f"{row['x']:.6g}", mesh.unit
            row["readout"] = readout(label, torque, (mesh.name, f"{row['y']:.4g}", unit))
        panel.read(read, looks[label].colour)
    return panel


def error_table(mesh: ErrorCurves, units: Units = ENGINEERING) -> Table:
    """Return the transmission error at every torque, a column for each label."""
    unit, errors = units.unit("m moved"), units.values(mesh.error, "m moved")
    columns = [
        Column(f"torque\n{mesh.unit}", lambda k: f"{mesh.torque[k]:.6g}", kind=NUMBER),
        *(
            Column(f"{label}\n{unit}", partial(_written, values), kind=NUMBER)
            for label, values in zip(mesh.labels, errors)
        ),
    ]
    title = f"{mesh.name}, peak to peak"
    return Table(title[0].upper() + title[1:], columns, range(len(mesh.torque)), style="bare")


def _written(values: np.ndarray, k: int) -> str:
    return f"{values[k]:.3g}" if np.isfinite(values[k]) else "-"
