"""Table and chart of a search for the best design."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from solidgear.show.panel import GREY, Axis, Panel, Series, readout
from solidgear.show.plot import WIDE, Chart
from solidgear.show.sheet_files import write_files
from solidgear.show.table import NUMBER, Column, Table, text

KEPT, MISSED, BEST = "keeps every limit", "misses a limit", "best"
#: looks of designs
LOOKS = {
    KEPT: Series("#00805e"),
    MISSED: Series("#b3305c", "square"),
    BEST: Series("#0072b2", "diamond"),
}


def designs(found: Any) -> Table:
    """All designs in the order in which they were solved."""
    columns = [Column("", lambda d: d.number, kind=NUMBER)]
    columns += [
        Column(label, partial(_value, label), "{:.6g}".format, kind=NUMBER)
        for label in found.path[0].values
    ]
    columns += [
        Column(found.goal.name, lambda d: d.value, "{:.6g}".format, kind=NUMBER),
        Column("bar", lambda d: d.bar, "{:.2g}".format, kind=NUMBER),
        text("", partial(_said, found)),
    ]
    note = "SI. Design 0 is the file as it is."
    return Table("Designs", columns, found.path, note, style="ruled")


def _value(label: str, one: Any) -> Any:
    return one.values[label]


def _said(found: Any, one: Any) -> str:
    if one.status != "ok":
        return str(one.status)[:60]
    look = _look(found, one)
    return "" if look == KEPT else look


def _look(found: Any, one: Any) -> str:
    if found.best is not None and one.number == found.best.number:
        return BEST
    return KEPT if one.kept else MISSED


def designs_chart(found: Any, title: str, width: float = WIDE) -> Chart:
    """The goal over the one entry that varies, or over the number of the design."""
    told = [one for one in found.path if one.value is not None]
    labels = list(found.path[0].values)
    over = labels[0] if len(labels) == 1 else "design"
    x = [one.values[over] if len(labels) == 1 else one.number for one in told]
    low = min(one.value - (one.bar or 0.0) for one in told)
    high = max(one.value + (one.bar or 0.0) for one in told)
    room = 0.08 * (high - low) or abs(high)
    edge = 0.03 * (max(x) - min(x)) or 1.0
    panel = Panel(
        Axis(over if len(labels) > 1 else f"{over}, SI", (min(x) - edge, max(x) + edge)),
        Axis(f"{found.goal.name}, SI", (low - room, high + room)),
        300.0,
        series=LOOKS,
        legend={"orient": "top"},
    )
    bars = [
        {"x": a, "y": one.value - one.bar, "y2": one.value + one.bar}
        for a, one in zip(x, told)
        if one.bar
    ]
    panel.draw({"type": "rule", "color": GREY, "strokeWidth": 2}, bars)
    rows = []
    for a, one in zip(x, told):
        facts = [(label, f"{value:.6g}", "") for label, value in one.values.items()]
        goal = (found.goal.name, f"{one.value:.6g}", "")
        rows.append(
            {
                "x": a,
                "y": one.value,
                "name": _look(found, one),
                "readout": readout(f"design {one.number}", *facts, goal),
            }
        )
    panel.draw({"type": "point", "filled": True, "size": 60}, rows)
    return Chart([[panel]], width, title)


def write_optimum(folder: Path, found: Any) -> list[Path]:
    """Page, data, table and chart of a search."""
    title = f"{found.scene}: {found.goal}"
    lead = "Every design solved by the cheapest mesh whose bars are within the tolerance."
    return write_files(
        folder,
        "optimum",
        title,
        lead,
        [designs(found)],
        found.results,
        lines={"designs": designs(found)},
        charts={"designs": partial(designs_chart, found, title)},
        notes=found.sentences,
    )
