"""Chart of a MAC matrix."""

from __future__ import annotations

from typing import Any

from solidgear.core.judge.record import MacTable
from solidgear.show.panel import INK, Panel, readout
from solidgear.show.scales import Axis

#: px; of a row of a matrix, and of the longest name of a mode beside it
ROW, LONGEST = 24.0, 76.0


def mac_panel(table: MacTable, name: str, reference: str) -> Panel:
    """Return one matrix, a mode of the model a row."""
    rows = table.rows or [""] * len(table.values)
    columns = table.columns or [""] * len(table.values[0])
    panel = Panel(
        Axis("", (-0.5, len(columns) - 0.5), ticks=_numbered(columns), grid=False),
        Axis("", (len(rows) - 0.5, -0.5), ticks=_numbered(rows), grid=False),
        ROW * len(rows),
        f"{name} (rows) against {reference}",
        left=LONGEST,
        turned=True,
    )
    cells = []
    for i, row in enumerate(table.values):
        for j, value in enumerate(row):
            if value is None:
                continue
            against = (f"against, of the {reference}", columns[j], "")
            words = readout(name, ("mode", rows[i], ""), against, ("MAC", f"{value:.4f}", ""))
            place: dict[str, Any] = {"x": j - 0.5, "x2": j + 0.5, "y": i - 0.5, "y2": i + 0.5}
            cells.append({**place, "readout": words, "fill": _blue(value)})
    panel.draw({"type": "rect", "stroke": "#ffffff", "strokeWidth": 0.5}, cells)
    for white in (False, True):
        text = {"type": "text", "color": "#ffffff" if white else INK}
        panel.draw(text | {"fontSize": 10}, _figures(table, white))
    return panel


def _numbered(names: list[str]) -> dict[float, str]:
    return {float(i): name for i, name in enumerate(names)}


def _figures(table: MacTable, white: bool) -> list[dict[str, Any]]:
    """Return figures of the dark cells of a map, or of the light ones; none for negligible values."""
    return [
        {"x": j, "y": i, "text": _mac_text(value)}
        for i, row in enumerate(table.values)
        for j, value in enumerate(row)
        if value is not None and value >= 0.005 and (value > 0.6) == white
    ]


def _blue(value: float) -> str:
    """Return a colour from nearly white at 0 to dark blue at 1."""
    ends = zip((247, 251, 255), (8, 48, 107))
    return "#" + "".join(f"{round(a + (b - a) * value):02x}" for a, b in ends)


def _mac_text(value: float) -> str:
    """Return a MAC in four characters; 0.998 must not round to a perfect 1.00."""
    if value >= 0.9995:
        return "1.00"
    return ">.99" if value >= 0.995 else f"{min(value, 0.99):.2f}"
