"""A race as a figure: error against cost, one line of panels a quantity; below them the legend, and
where the numbers come from."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from solidgear.comparison.race.pareto import AUTOMATIC, Race, Row
from solidgear.comparison.race.rows import COSTS, error_text, left_out, options_text
from solidgear.comparison.race.style import FAMILIES, REFERENCE, Look, family_name, looks
from solidgear.show.panel import (
    COUNT,
    GREY,
    INK,
    NUMBER,
    PERCENT,
    SHAPES,
    Axis,
    Panel,
    readout,
    tolerance_line,
)
from solidgear.show.plot import WIDE, Chart
from solidgear.show.words import grouped, is_number, percent, seconds

QUANTITY = {"C_zz": "port compliance C_zz", "bending 1": "first bending frequency"}
#: the series whose orders are written beside its points
ORDERS = "harmonic p graded"


def draw(race: Race, path) -> Path:
    """Draw a race as a PNG."""
    return race_chart(race).write(Path(path))


def race_chart(race: Race, width: float = WIDE) -> Chart:
    """Return panels of error over seconds and over unknowns, one line of panels a quantity,
    log-log.
    """
    panels = [[_panel(race, q, cost) for cost in COSTS] for q in race.reference["values"]]
    title = race.scene.get("title") or race.scene.get("name", "")
    words = f"{title}: error against cost" + ("" if race.complete else " (interrupted)")
    return Chart([*panels, [legend(race, width)]], width, words, footer(race))


def _panel(race: Race, quantity: str, cost: str) -> Panel:
    low, top = _heights(race, quantity)
    bar, setup = race.reference["bands"][quantity], sum(race.setup.values())
    panel = Panel(
        Axis(
            COSTS[cost], _reach(race, cost), log=True, label=COUNT if cost == "unknowns" else NUMBER
        ),
        Axis(f"error of {QUANTITY.get(quantity, quantity)}", (low, top), log=True, label=PERCENT),
        290.0,
        left=72.0,
    )
    left, high = panel.x.ends
    _bar(panel, bar, low)
    tolerance = (race.scene.get("ask") or {}).get("tolerance")
    if is_number(tolerance) and low < tolerance < top:
        tolerance_line(panel, tolerance)
    _front(panel, race, quantity, cost)
    for name in dict.fromkeys(row.series for row in race.rows):
        rows = [row for row in race.rows if row.series == name]
        _series(panel, race, rows, quantity, cost)
        _crosses(panel, rows, quantity, cost, top / 1.5)
    if cost in race.reference:
        _reference(panel, race, quantity, cost, max(bar, low))
    if cost == "seconds" and left < setup < high:
        _setup(panel, setup)
    return panel


def _reach(race: Race, cost: str) -> tuple[float, float]:
    """Return both ends of the axis of a cost."""
    costs = [getattr(row, cost) for row in race.rows if row.status in ("ok", "failed")]
    positive = [value for value in costs if value] or [1.0]
    return min(positive) / 2.2, max(max(positive) * 2.2, 1.5 * race.reference.get(cost, 0.0))


def _heights(race: Race, quantity: str) -> tuple[float, float]:
    """Return both ends of the axis of errors.

    An error bar far below every error is named at the bottom, so that it does not squeeze what there is
    to see.
    """
    bar = race.reference["bands"][quantity]
    errors = []
    for row in race.rows:
        error = race.error(row, quantity)
        if error is None:
            continue
        like = row.like_for_like.get(quantity) if error else None
        errors += [error, like or bar]
    positive = [error for error in errors if error > 0] or [1e-3]
    return max(bar / 2.5, min(positive) / 40), max(positive) * 4


def _bar(panel: Panel, bar: float, low: float) -> None:
    """Shade errors that the reference does not resolve, and name its error bar."""
    floor = max(bar, low)
    if bar > 0:
        panel.draw({"type": "rect", "color": "#00805e", "opacity": 0.13}, [{"y": low, "y2": floor}])
    below = "" if bar > low else ", below this axis"
    words = f"error bar of the reference {percent(bar, signed=False)}{below}"
    look = {"type": "text", "color": REFERENCE, "align": "left", "dx": 4, "dy": -7, "fontSize": 10}
    panel.draw(look, [{"y": floor, "text": words}], x={"value": 0})


def _reference(panel: Panel, race: Race, quantity: str, cost: str, floor: float) -> None:
    """Draw the reference at its own error bar."""
    words = readout(
        f"reference, {race.reference['model']}",
        ("own error bar", percent(race.reference["bands"][quantity], signed=False), ""),
        ("time", seconds(race.reference["seconds"]), "s"),
        ("unknowns", grouped(race.reference["unknowns"]), ""),
    )
    star = {"type": "point", "shape": SHAPES["*"], "size": 110, "stroke": REFERENCE}
    place = {"x": race.reference[cost], "y": floor, "readout": words}
    panel.draw(star | {"fill": "#ffffff", "strokeWidth": 1}, [place])


def _front(panel: Panel, race: Race, quantity: str, cost: str) -> None:
    """Draw the Pareto front as steps, from the top of the panel to its right end."""
    steps = race.front(quantity, cost)
    if not steps:
        return
    xs = [getattr(row, cost) for row in steps]
    ys = [race.sure_error(row, quantity) for row in steps]
    places = zip([xs[0], *xs, panel.x.ends[1]], [panel.y.ends[1], *ys, ys[-1]])
    look = {"type": "line", "interpolate": "step-after", "color": FRONT}
    panel.draw(look | {"strokeWidth": 5, "opacity": 0.45}, [{"x": x, "y": y} for x, y in places])


def _setup(panel: Panel, spent: float) -> None:
    """Draw the time that a process pays once, as an upright line."""
    panel.draw({"type": "rule", "color": GREY, "strokeDash": [1, 2]}, [{"x": spent}])
    name = {"type": "text", "angle": -90, "align": "right", "dy": -6, "fontSize": 10, "color": GREY}
    panel.draw(name, [{"x": spent, "text": "set-up, once a process"}], y={"value": 4})


def _series(panel: Panel, race: Race, rows: list[Row], quantity: str, cost: str) -> None:
    """Draw a line through the levels of a series, and their points."""
    look = Look(rows[0].series, rows[0].family)
    spots = []
    for row in rows:
        error = race.error(row, quantity)
        if error is not None and getattr(row, cost):
            place = {"x": getattr(row, cost), "y": error}
            spots.append((row, {**place, "readout": _words(race, row, look.series, quantity)}))
    line = {"type": "line", "color": look.colour, "strokeWidth": look.width}
    line |= {"strokeDash": look.dash, "opacity": 0.75 if look.uniform else 1.0}
    panel.draw(line, [{"x": spot["x"], "y": spot["y"]} for _, spot in spots])
    if cost == "seconds":
        panel.draw(
            {"type": "rule", "color": look.colour, "opacity": 0.45},
            [
                {"x": min(row.samples), "x2": max(row.samples), "y": spot["y"]}
                for row, spot in spots
                if len(row.samples) > 1
            ],
        )
    panel.draw(look.marks, [spot for _, spot in spots])
    unresolved = [spot for row, spot in spots if not race.resolved(row, quantity)]
    _arrows(panel, unresolved, look.colour)
    partners = [(spot, _beside(look, row)) for row, spot in spots]
    text = {"type": "text", "color": look.colour, "fontSize": 10}
    names = [{"x": spot["x"], "y": spot["y"], "text": words} for spot, words in partners if words]
    panel.draw(text | {"align": "right", "dx": -6, "dy": 9}, names)
    if spots and not look.converges:
        _like_for_like(panel, race, look, spots, quantity)
        # levels that do not converge to the reference coincide: one name will do, and that of a
        # lumped model, which lies close to that of a beam, below it
        place = {"align": "left", "dx": 8, "dy": -8}
        if look.family == "lumped":
            place = {"align": "center", "dy": 16}
        spot = spots[-1][1]
        panel.draw(text | place, [{"x": spot["x"], "y": spot["y"], "text": look.series}])


def _words(race: Race, row: Row, name: str, quantity: str) -> str:
    """Return words shown at the point of one level of a series."""
    return readout(
        name,
        (f"error of {quantity}", error_text(race, row, quantity), ""),
        ("time", seconds(row.seconds), "s"),
        ("unknowns", grouped(row.unknowns), ""),
        ("setting", options_text(row), ""),
    )


def _beside(look: Look, row: Row) -> str:
    """Return the order or the tolerance of a level, written beside it."""
    if look.series == ORDERS:
        return f"p{row.options['order']}"
    return f"{100 * row.options['tol']:g} %" if look.family == AUTOMATIC else ""


def _arrows(panel: Panel, spots: list[dict[str, Any]], colour: str) -> None:
    """Draw arrows below points on the bar: the error may be smaller."""
    head = {"type": "point", "shape": "triangle-down", "color": colour, "filled": True, "size": 30}
    for size, dy in ((head, 13), ({**head, "shape": "stroke", "angle": 90, "size": 60}, 8)):
        panel.draw({**size, "yOffset": dy}, [{"x": spot["x"], "y": spot["y"]} for spot in spots])


def _like_for_like(panel: Panel, race: Race, look: Look, spots: list, quantity: str) -> None:
    """Draw errors against the solid with the same ties, hollow at the end of a dotted line."""
    rows = [
        {
            "x": spot["x"],
            "y": spot["y"],
            "y2": row.like_for_like.get(quantity),
            "readout": spot["readout"],
        }
        for row, spot in spots
    ]
    pairs = [row for row in rows if row["y2"]]
    dots = {"type": "rule", "color": look.colour, "strokeDash": [2, 2]}
    panel.draw(dots, [{key: row[key] for key in ("x", "y", "y2")} for row in pairs])
    hollow = [
        {
            "x": row["x"],
            "y": row["y2"],
            "readout": row["readout"].replace("\n", ", like for like\n", 1),
        }
        for row in pairs
    ]
    panel.draw({**look.marks, "fill": "#ffffff"}, hollow)


def _crosses(panel: Panel, rows: list[Row], quantity: str, cost: str, height: float) -> None:
    """Draw rows that failed, or have no such number, at the top."""
    colour = Look(rows[0].series, rows[0].family).colour
    missing = [
        {"x": getattr(row, cost), "y": height}
        for row in rows
        if row.status == "failed" or (row.status == "ok" and quantity not in row.errors)
    ]
    cross = {"type": "point", "shape": SHAPES["x"], "stroke": colour, "strokeWidth": 2, "size": 60}
    panel.draw(cross, missing)


#: grey of the Pareto front, and of marks that any family may have
FRONT, MARK = "#9a9a9a", "#555555"
#: px; of a line of the legend, and the least width of its columns
LINE, COLUMN = 17.0, 215.0
#: what marks mean: words, line, marker, both in Vega-Lite
MARKS: tuple[tuple[str, Any, Any], ...] = (
    (
        "like for like:\nsection ties on both sides",
        {"color": FAMILIES["beam"][1], "strokeDash": [2, 2]},
        {"stroke": FAMILIES["beam"][1], "fill": "#ffffff", "shape": "square"},
    ),
    (
        "Pareto front,\ncancellations not counted",
        {"color": FRONT, "strokeWidth": 5, "opacity": 0.45},
        None,
    ),
    (
        "the reference itself",
        None,
        {"stroke": REFERENCE, "fill": "#ffffff", "shape": SHAPES["*"], "size": 80},
    ),
    (
        "below the error bar: not resolved",
        None,
        {"fill": MARK, "stroke": MARK, "shape": "triangle-down"},
    ),
    ("failed, or no such number", None, {"stroke": MARK, "shape": SHAPES["x"], "strokeWidth": 2}),
)


def legend(race: Race, width: float) -> Panel:
    """Return a heading for each family with its series, then the meaning of marks, in columns."""
    entries: list[tuple[str, Any, Any]] = []
    for family, series in looks(race).items():
        if family not in ("lumped", AUTOMATIC):  # their one series has their name
            entries.append((family_name(family).upper(), None, None))
        for look in series:
            line = {"color": look.colour, "strokeDash": look.dash, "strokeWidth": look.width}
            entries.append((look.name, line if look.converges else None, look.marks))
    entries += MARKS
    columns = max(1, int(width / COLUMN))
    lines = [entry[0].count("\n") + 1 for entry in entries]
    high = -(-sum(lines) // columns) + 1
    panel = Panel(
        Axis("", (0.0, columns), shown=False),
        Axis("", (high, -1.0), shown=False),
        LINE * (high + 1),
    )
    column, row = 0, 0
    for (words, line, marker), count in zip(entries, lines):
        if row + count > high:
            column, row = column + 1, 0
        _entry(panel, column, float(row), words, line, marker)
        row += count
    return panel


def _entry(panel: Panel, x: float, y: float, words: str, line: Any, marker: Any) -> None:
    if line:
        panel.draw({"type": "rule", **line}, [{"x": x, "x2": x + 0.12, "y": y}])
    if marker:
        panel.draw({"size": 45, **marker, "type": "point"}, [{"x": x + 0.06, "y": y}])
    text = {"type": "text", "align": "left", "baseline": "middle", "color": INK}
    panel.draw(text, [{"x": x + (0.15 if line or marker else 0.0), "y": y, "text": words}])


def footer(race: Race) -> str:
    """Return sentences on the reference, times, machine and skipped cases."""
    machine = race.environment
    lines = [
        _reference_text(race),
        _times(race),
        f"{machine.get('cpu')}, {machine.get('cores')} cores, {machine.get('date')}; "
        f"the whole chart took {race.seconds:.0f} s.",
    ]
    if left_out(race):
        lines.append(
            f"Skipped ({race.budget:g} s of processor time for the points): {left_out(race)}; "
            "reasons in rows.csv."
        )
    return "\n".join(lines)


def _reference_text(race: Race) -> str:
    reference = race.reference
    return (
        f"Reference: {reference['model']}, {reference['setting']}, {reference['unknowns']} "
        f"unknowns, {seconds(reference['seconds'])} s a run; its error bar is that of `answer`."
    )


def _times(race: Race) -> str:
    runs = [len(row.samples) for row in race.rows if row.status == "ok"]
    words = f"Time: new body, six loads, {race.modes} modes; median of {race.runs} interleaved runs"
    if runs and min(runs) < race.runs:
        words += f" (slow cases down to {min(runs)})"
    if race.setup:
        setup = ", ".join(f"{name} {seconds(spent)} s" for name, spent in race.setup.items())
        words += f". Set-up, not in it: {setup}"
    return words + "."
