"""Chart of the range of every number by every open input, from the lowest to the highest."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING, Any

from solidgear.core import OpenNumbers, Record
from solidgear.show.open_words import ALL, SHOWN, interval
from solidgear.show.open_words import budget as budget_table
from solidgear.show.panel import GREY, Panel, Series, readout
from solidgear.show.plot import NARROW, WIDE, Chart
from solidgear.show.scales import Axis, in_percent
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import Cell, Column, Table, text
from solidgear.show.units import ENGINEERING, Units

if TYPE_CHECKING:
    from solidgear.variants.budget.budget import Budget

#: in the order of the inputs, the colours in turn
COLOURS = ("#0072b2", "#d55e00", "#00805e", "#8a6d3b", "#b3305c", "#5a3e8c", "#9cc9e6", "#e0a030")
#: px of a bar, between numbers, of their names, and of an entry of the legend
BAR, BETWEEN, NAMES, PLACE = 9.0, 10.0, 80.0, 230.0


def budget_chart(
    ranges: OpenNumbers,
    width: float = WIDE,  # px
    asked: Iterable[str] = (),  # numbers; by default those that are judged
) -> Chart | None:
    """Draw bars by every input and by all, a group for each number; None where nothing is open."""
    numbers = [n for name in (tuple(asked) or SHOWN) if (n := ranges.of(name)) is not None]
    if not numbers:
        return None
    paths = [open_input.path for open_input in ranges.inputs]
    series = {path: Series(COLOURS[k % len(COLOURS)]) for k, path in enumerate(paths)}
    series[ALL] = Series(GREY)
    thick = 0.84 / len(series)
    pieces: list[dict[str, Any]] = []
    for k, number in enumerate(numbers):
        parts = {**{path: number.by_input[path] for path in paths}, ALL: number.total}
        for i, (name, part) in enumerate(parts.items()):
            y = k + (i - (len(parts) - 1) / 2) * thick
            words = readout(number.quantity, (name, interval(part), ""))
            ends = {"x": part.low, "x2": part.high, "y": y - 0.45 * thick, "y2": y + 0.45 * thick}
            pieces.append({**ends, "name": name, "readout": words})
    low, high = min(p["x"] for p in pieces), max(p["x2"] for p in pieces)
    room = 0.03 * (high - low) or 0.01
    panel = Panel(
        Axis("change of the number", (low - room, high + room), label=in_percent),
        Axis(
            "",
            (len(numbers) - 0.5, -0.5),
            ticks={float(k): number.quantity for k, number in enumerate(numbers)},
            grid=False,
        ),
        (BAR * len(series) + BETWEEN) * len(numbers),
        series=series,
        legend={"orient": "top", "columns": max(1, int(width / PLACE)), "symbolType": "square"},
        left=NAMES if width > NARROW else 0.8 * NAMES,
    )
    panel.draw({"type": "rule", "color": GREY}, [{"x": 0.0}])
    panel.draw({"type": "rect", "strokeWidth": 0}, pieces)
    return Chart([[panel]], width)


def budget_sheet(ranges: Budget, units: Units = ENGINEERING, asked: Iterable[str] = ()) -> Sheet:
    """Return the sheet of all ranges, or of numbers asked for, and of questions to makers."""
    tables = [budget_table(ranges, asked)]
    if ranges.questions:
        tables.append(_questions(ranges))
    return Sheet(
        name="budget",
        title=f"{ranges.title or ranges.scene}: ranges by open inputs",
        lead="",
        tables=tables,
        data=ranges.model_dump(mode="json"),
        cautions=ranges.cautions,
        charts={"budget": partial(budget_chart, ranges, asked=asked)},
        terminal=Terminal(heading=()),
        words={"budget": "Range of every number by every open input."},
    )


def _questions(ranges: Budget) -> Table:
    """Return what to ask makers, and what each answer leaves of a range."""
    columns = [
        *map(text, ("bearing", "its maker knows", "estimated here")),
        Column("of", kind="word"),
        Column("range now", name="width", unit="1"),
        Column("left of it", name="left", unit="1"),
        Column("in catalogues", kind="word"),
    ]
    rows, before = [], ""
    for question in ranges.questions:
        name = f"{question.bearing} ({question.designation or 'no designation'})"
        left = f"{100 * question.left:.0f} %"
        rows.append(
            [
                Cell(name, "", "" if name == before else name),
                question.asked,
                question.middle,
                question.number,
                Cell(question.width, "", f"{100 * question.width:.2g} %"),
                Cell(question.left, "", left),
                "yes" if question.in_catalogue else "",
            ]
        )
        before = name
    note = (
        "Left: width of the range by this inside once that one number is known, at the middle of its "
        "estimate. Send the list to the maker and write the answers into [bearing.catalogue], or into "
        "a list of bearings."
    )
    return Table("Questions to makers", columns, rows, note, name="questions")


def of_record(record: Record, width: float) -> Chart | None:
    """Draw the chart of a record; None also where ranges have no parts."""
    return budget_chart(record.open, width)
