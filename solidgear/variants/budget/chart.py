"""Chart of what every open input leaves open of every number: bars from its lowest to its highest."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from solidgear.core.judge.open_record import OpenNumbers
from solidgear.core.judge.record import Record
from solidgear.show.open_words import ALL, SHOWN, interval
from solidgear.show.panel import GREY, PERCENT, Axis, Panel, Series, readout
from solidgear.show.plot import NARROW, WIDE, Chart

#: in the order of the inputs, the colours in turn
COLOURS = ("#0072b2", "#d55e00", "#00805e", "#8a6d3b", "#b3305c", "#5a3e8c", "#9cc9e6", "#e0a030")
#: px of a bar, between numbers, of their names, and of an entry of the legend
BAR, BETWEEN, NAMES, PLACE = 9.0, 10.0, 80.0, 230.0


def budget_chart(
    found: OpenNumbers, width: float = WIDE, asked: Iterable[str] = ()
) -> Chart | None:
    """Bars by every input and by all, a group for each number; None where nothing is open.

    Parameters
    ----------
    width : float
        px.
    asked : iterable of str
        Numbers; by default those that are judged.
    """
    shown = [one for name in (tuple(asked) or SHOWN) if (one := found.of(name)) is not None]
    if not shown:
        return None
    paths = [one.path for one in found.inputs]
    series = {path: Series(COLOURS[k % len(COLOURS)]) for k, path in enumerate(paths)}
    series[ALL] = Series(GREY)
    thick = 0.84 / len(series)
    pieces: list[dict[str, Any]] = []
    for k, one in enumerate(shown):
        parts = {**{path: one.by_input[path] for path in paths}, ALL: one.total}
        for i, (name, part) in enumerate(parts.items()):
            y = k + (i - (len(parts) - 1) / 2) * thick
            words = readout(one.quantity, (name, interval(part), ""))
            ends = {"x": part.low, "x2": part.high, "y": y - 0.45 * thick, "y2": y + 0.45 * thick}
            pieces.append({**ends, "name": name, "readout": words})
    low, high = min(p["x"] for p in pieces), max(p["x2"] for p in pieces)
    room = 0.03 * (high - low) or 0.01
    panel = Panel(
        Axis("change of the number", (low - room, high + room), label=PERCENT),
        Axis(
            "",
            (len(shown) - 0.5, -0.5),
            ticks={float(k): one.quantity for k, one in enumerate(shown)},
            grid=False,
        ),
        (BAR * len(series) + BETWEEN) * len(shown),
        series=series,
        legend={"orient": "top", "columns": max(1, int(width / PLACE)), "symbolType": "square"},
        left=NAMES if width > NARROW else 0.8 * NAMES,
    )
    panel.draw({"type": "rule", "color": GREY}, [{"x": 0.0}])
    panel.draw({"type": "rect", "strokeWidth": 0}, pieces)
    return Chart([[panel]], width)


def of_record(record: Record, width: float) -> Chart | None:
    """The same of a record; None also where ranges have no parts."""
    return budget_chart(record.open, width)
