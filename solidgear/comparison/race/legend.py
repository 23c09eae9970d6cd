"""Below the panels of a race: the legend, and where its numbers come from."""

from __future__ import annotations

from typing import Any

from solidgear.comparison.race.pareto import AUTOMATIC, Race
from solidgear.comparison.race.rows import left_out
from solidgear.comparison.race.style import FAMILIES, REFERENCE, family_name, looks
from solidgear.show.panel import INK, SHAPES, Axis, Panel
from solidgear.show.words import seconds

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
        _reference(race),
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


def _reference(race: Race) -> str:
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
