"""One figure a part: errors over processor seconds and over peak memory."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from solidgear.show.panel import SHAPES, Panel, Series, tolerance_line
from solidgear.show.plot import Chart
from solidgear.show.scales import Axis, in_percent
from validation.race import real_lines as lines
from validation.race.real_costs import QUANTITIES, Row, errors, references

LOOK = {
    lines.UNIFORM: ("#9a86b8", "v"),
    lines.GRADED: ("#5a3e8c", "D"),
    lines.HALVES: ("#0072b2", "s"),
    lines.SECTOR: ("#c2185b", "h"),
    lines.CORRECTED: ("#a05a00", "^"),
    lines.DIFFERENCE: ("#a05a00", "^"),
    lines.HEAVY: ("#c98a00", "P"),
    lines.PLAIN: ("#00805e", "o"),
    lines.CALCULIX: ("#222222", "<"),
}
TITLES = {"keyed": "Keyed pinion", "toothed": "Toothed pinion", "step": "Shaft from a STEP file"}
WORDS = {"C_zz": "error of C_zz", "bending_1": "error of first bending"}
#: of the errors drawn
HEIGHTS = (3e-5, 6e-2)
COSTS = {"cpu s": "processor seconds, scene to answer, one thread", "peak_MB": "peak memory, MB"}


def draw(rows: Sequence[Row], part: str, path: Path, target: float = 1e-3) -> None:
    """Write the figure of a part.

    Parameters
    ----------
    target : float
        The error that ratios are taken at.
    """
    truth = references(rows, part)
    own = [r for r in rows if r["part"] == part and r["line"] in lines.LINES[part]]
    own = [r for r in own if r["line"] != lines.REFERENCE]
    series = {
        line: Series(colour, SHAPES[marker])
        for line, (colour, marker) in LOOK.items()
        if any(r["line"] == line for r in own)
    }
    panels = []
    for what in QUANTITIES:
        panels.append([])
        for cost, words in COSTS.items():
            costs = [r[cost] for r in own]
            panel = Panel(
                Axis(words, (min(costs) / 1.5, max(costs) * 1.5), log=True),
                Axis(WORDS[what], HEIGHTS, log=True, label=in_percent),
                250.0,
                series=series,
                legend=None if len(panels) > 1 or panels[0] else {"orient": "top", "columns": 2},
            )
            floor = [{"y": HEIGHTS[0], "y2": max(truth[what].doubt, HEIGHTS[0])}]
            panel.draw({"type": "rect", "color": "#e8e8e8"}, floor)
            tolerance_line(panel, target)
            for line in series:
                levels = [r for r in own if r["line"] == line]
                found = zip(levels, errors(rows, part, line, what))
                places = [{"x": r[cost], "y": error, "name": line} for r, error in found]
                panel.draw({"type": "line", "strokeWidth": 1.2}, places)
                panel.draw({"type": "point", "filled": True, "size": 40, "clip": True}, places)
            panels[-1].append(panel)
    said = "grey: the reference knows no better"
    Chart(panels, title=f"{TITLES[part]}: error against cost ({said})").write(path)
