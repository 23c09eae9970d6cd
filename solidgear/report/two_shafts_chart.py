"""Chart of mode shapes of two shafts over one another, a panel for every pair."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from solidgear.report.panel import GREY, Axis, Panel, Series, readout
from solidgear.report.plot import BETWEEN, NARROW, WIDE, Chart, in_columns
from solidgear.report.train_chart import PAIR
from solidgear.report.units import ENGINEERING, Units
from solidgear.report.words import hertz

#: components of section motions that show a family
SHOWN = {"bending": (0, 2), "axial": (1,), "torsion": (4,)}
#: pairs that are drawn, the lowest
MOST = 8


def shapes_chart(found: Any, units: Units = ENGINEERING, width: float = WIDE) -> Chart | None:
    """Motions of sections along both shafts in the lowest pairs of modes, each of largest one; None
    where no pair has a shape that sections show.
    """
    modes = [{str(m.name): m for m in one.modes.solved} for one in found.both]
    looks = {one.label: Series(colour) for one, colour in zip(found.both, PAIR)}
    drawn = []
    for pair in found.modes:
        own = [
            None if m is None else known.get(m.name) for m, known in zip((pair.a, pair.b), modes)
        ]
        if all(m is not None and m.family in SHOWN for m in own):
            drawn.append((pair, own))
    last = max(units.values(one.modes.stations, "m").max() for one in found.both)
    columns = 2 if width > NARROW and len(drawn) > 1 else 1
    legend = {"orient": "top", "columns": 2, "symbolType": "stroke", "symbolStrokeWidth": 3}
    panels = []
    for k, (pair, own) in enumerate(drawn[:MOST]):
        panel = Panel(
            Axis(f"y in {units.unit('m')}", (0.0, float(last))),
            Axis("", (-1.1, 1.1)),
            130.0,
            pair.a.name + (f" (B: {pair.b.name})" if pair.a.name != pair.b.name else ""),
            series=looks,
            legend=legend if k == 0 else None,
        )
        panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
        for label, stations, line, hz in _lines(found.both, own):
            said = readout(label, ("frequency", hertz(hz), "Hz"))
            rows = [
                {"x": float(x), "y": float(u)} for x, u in zip(units.values(stations, "m"), line)
            ]
            panel.draw("line", [{**row, "name": label} for row in rows])
            panel.read([{**row, "readout": said} for row in rows], looks[label].colour)
        panels.append(panel)
    if len(panels) % columns:  # as wide as those above it
        panels[-1].right += (width + BETWEEN) / columns
    return Chart(in_columns(panels, columns), width) if panels else None


def _lines(
    both: Sequence[Any], own: Sequence[Any]
) -> list[tuple[str, np.ndarray, np.ndarray, float]]:
    """Label, stations, shape and frequency of a mode of each, both with the same sign."""
    lines = [_line(mode) for mode in own]
    stations = [one.modes.stations for one in both]
    # along their lengths, which may differ
    across = np.interp(stations[1] / stations[1].max(), stations[0] / stations[0].max(), lines[0])
    if across @ lines[1] < 0:
        lines[1] = -lines[1]
    return [
        (one.label, y, line, mode.frequency_hz)
        for one, y, line, mode in zip(both, stations, lines, own)
    ]


def _line(mode: Any) -> np.ndarray:
    """Motions of sections in the plane of the largest, whose largest is one."""
    motions = mode.motions[0][:, SHOWN[mode.family]]
    line = motions @ np.linalg.svd(motions, full_matrices=False)[2][0]
    return line / max(np.abs(line).max(), 1e-300)
