"""Charts of a search: the goal of every design, and the front of two goals."""

from __future__ import annotations

from typing import Any

from solidgear.show.panel import GREY, INK, Panel, Series, readout
from solidgear.show.plot import WIDE, Chart
from solidgear.show.scales import Axis
from solidgear.show.units import ENGINEERING, Units
from solidgear.variants.optimise.outcome import Outcome
from solidgear.variants.optimise.pool import Design
from solidgear.variants.optimise.sentences import value_text

KEPT, MISSED, BEST, FRONT = "keeps every limit", "misses a limit", "best", "beaten by none in both"
LOOKS = {
    KEPT: Series("#00805e"),
    MISSED: Series("#b3305c", "square"),
    BEST: Series("#0072b2", "diamond"),
}
FRONT_LOOKS = {KEPT: LOOKS[KEPT], MISSED: LOOKS[MISSED], FRONT: Series("#0072b2", "diamond")}
#: of the span, left free beside the outermost marks
ROOM, EDGE = 0.08, 0.03


def look_of(optimum: Outcome, design: Design) -> str:
    """Return the series of a design."""
    if optimum.front:
        if any(design is member for member in optimum.front):
            return FRONT
    elif design is optimum.best:
        return BEST
    return KEPT if design.kept else MISSED


def designs_chart(optimum: Outcome, title: str, width: float = WIDE) -> Chart:
    """Draw the goal over the one range that varies, or over the number of the design."""
    alone = len(optimum.entries) == 1 and optimum.entries[0].numeric
    label = optimum.entries[0].label
    solved = [
        (design, design.value, design.bar or 0.0)
        for design in optimum.path
        # the file as it is may not hold the entry
        if design.value is not None and (not alone or design.values[label] is not None)
    ]
    x = [float(d.values[label]) if alone else float(d.number) for d, _, _ in solved]
    y_axis = _axis(
        f"{optimum.goal.name}, SI", [v - b for _, v, b in solved] + [v + b for _, v, b in solved]
    )
    panel = Panel(
        _axis(f"{label}, SI" if alone else "design", x, EDGE),
        y_axis,
        300.0,
        series=LOOKS,
        legend={"orient": "top"},
    )
    bars = [
        {"x": place, "y": value - bar, "y2": value + bar}
        for place, (_, value, bar) in zip(x, solved)
        if bar
    ]
    panel.draw({"type": "rule", "color": GREY, "strokeWidth": 2}, bars)
    points = [
        {
            "x": place,
            "y": value,
            "name": look_of(optimum, design),
            "readout": _facts(optimum, design),
        }
        for place, (design, value, _) in zip(x, solved)
    ]
    panel.draw({"type": "point", "filled": True, "size": 60}, points)
    return Chart([[panel]], width, title)


def front_chart(
    optimum: Outcome, title: str, units: Units = ENGINEERING, width: float = WIDE
) -> Chart:
    """Draw the second goal over the first, with the front as a line and error bars as rules."""
    first, second = optimum.goals
    solved = [design for design in optimum.path if design.goals]

    def spot(design: Design) -> tuple[float, float]:
        x, y = (
            units.value(number.value, goal.unit)
            for goal, number in zip(optimum.goals, design.goals)
        )
        assert x is not None and y is not None
        return x, y

    def half(design: Design, k: int) -> float:
        return units.value(design.goals[k].bar, optimum.goals[k].unit) or 0.0

    drawn = [design for design in solved if design.kept] or solved
    names = [f"{goal.name}, {units.unit(goal.unit)}".removesuffix(", ") for goal in (first, second)]
    places = [spot(design) for design in drawn]
    panel = Panel(
        _axis(names[0], [x for x, _ in places], EDGE),
        _axis(names[1], [y for _, y in places]),
        340.0,
        series=FRONT_LOOKS,
        legend={"orient": "top"},
    )
    line = [dict(zip("xy", spot(design))) for design in optimum.front]
    panel.draw({"type": "line", "color": INK, "strokeWidth": 1}, line)
    bars: list[dict[str, Any]] = []
    for design in optimum.front:
        (x, y), across, along = spot(design), half(design, 0), half(design, 1)
        bars += [{"x": x - across, "x2": x + across, "y": y, "y2": y}] if across else []
        bars += [{"x": x, "y": y - along, "y2": y + along}] if along else []
    panel.draw({"type": "rule", "color": GREY, "strokeWidth": 2}, bars)
    for on_front, size in ((False, 25), (True, 90)):  # the front above all others
        points = [
            {**dict(zip("xy", spot(d))), "name": look_of(optimum, d), "readout": _facts(optimum, d)}
            for d in drawn
            if (look_of(optimum, d) == FRONT) == on_front
        ]
        panel.draw({"type": "point", "filled": True, "size": size, "clip": True}, points)
    return Chart([[panel]], width, title)


def _axis(name: str, values: list[float], room: float = ROOM) -> Axis:
    """Return the axis of values, with room beside them."""
    low, high = min(values), max(values)
    margin = room * (high - low) or abs(high) or 1.0
    return Axis(name, (low - margin, high + margin))


def _facts(optimum: Outcome, design: Design) -> str:
    """Return the words on a design that a chart shows where it is pointed at."""
    entries = {entry.label: entry for entry in optimum.entries}
    values = [
        (label, value_text(entries.get(label), value), "") for label, value in design.values.items()
    ]
    goals = [
        (goal.name, f"{number.value:.6g}", "") for goal, number in zip(optimum.goals, design.goals)
    ]
    return readout(f"design {design.number}", *values, *goals)
