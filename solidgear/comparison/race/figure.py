"""A race as a figure: error against cost, one line of panels a quantity; below them the legend, and
where the numbers come from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from solidgear.comparison.race.race import AUTOMATIC, COSTS, Race, Row
from solidgear.core import Quantity
from solidgear.show.panel import GREY, INK, SHAPES, Panel, readout, tolerance_line
from solidgear.show.plot import WIDE, Chart
from solidgear.show.scales import Axis, in_percent, number, with_prefix
from solidgear.show.words import grouped, is_number, percent, seconds

QUANTITY = {"C_zz": "port compliance C_zz", "bending 1": "first bending frequency"}
#: the series whose orders are written beside its points
ORDERS = "harmonic p graded"
#: of texts in a panel
SMALL = {"fontSize": 10}
#: of a family that is not listed
UNLISTED = "#777777"
#: the reference itself and its error bar
REFERENCE = "#00603f"
#: families, in the order of the legend: name there, colour
FAMILIES = {
    "lumped": ("lumped", "#b3305c"),
    "beam": ("beams", "#0072b2"),
    "harmonic": ("harmonic solid", "#00805e"),
    "tetrahedra": ("3D, tetrahedra", "#d08a00"),
    "hexahedra": ("3D, hexahedra", "#5a3e8c"),
    AUTOMATIC: ("automatic choice", "#111111"),
}
#: series without its grading -> shape, by the letters of ``plot.SHAPES``
MARKERS = {
    "lumped": "P",
    AUTOMATIC: "*",
    "Euler": "v",
    "Timoshenko": "s",
    "harmonic h": "o",
    "harmonic p": "D",
    "TET4": "<",
    "TET10": "^",
    "HEX8": "s",
    "HEX20": "D",
    "HEX27": "h",
}
#: families that have no mesh to refine: they do not converge to the reference
SCATTERED = ("lumped", "beam")


@dataclass(frozen=True)
class Look:
    """Style of one series: dashed and pale for uniform meshes."""

    series: str
    family: str

    @property
    def colour(self) -> str:
        return FAMILIES[self.family][1] if self.family in FAMILIES else UNLISTED

    @property
    def converges(self) -> bool:
        """True where the levels refine one mesh."""
        return self.family not in SCATTERED

    @property
    def line(self) -> dict[str, Any]:
        """Looks of the line through the levels."""
        dash, width = ([5, 3], 1.0) if self.series.endswith("uniform") else ([1, 0], 1.5)
        return {"color": self.colour, "strokeDash": dash, "strokeWidth": width}

    @property
    def marks(self) -> dict[str, Any]:
        """Looks of the markers; empty ones mean like for like."""
        kind, fill = self.series.removesuffix(" uniform").removesuffix(" graded"), self.colour
        if self.series.endswith("uniform"):
            parts = (int(self.colour[k : k + 2], 16) for k in (1, 3, 5))
            fill = "#" + "".join(f"{round(0.35 * part + 0.65 * 255):02x}" for part in parts)
        look = {"type": "point", "stroke": self.colour, "fill": fill, "size": 45, "strokeWidth": 1}
        return look | {"shape": SHAPES[MARKERS.get(kind, "o")]}

    def level_name(self, row: Row) -> str:
        """Return the order or the tolerance of a level, written beside it."""
        if self.series == ORDERS:
            return f"p{row.options['order']}"
        return f"{100 * row.options['tol']:g} %" if self.family == AUTOMATIC else ""

    @property
    def name(self) -> str:
        """Name in the legend, below the family."""
        if self.family == AUTOMATIC:
            return "automatic, by tolerance:\nall meshes tried"
        name = self.series.replace("harmonic ", "")
        return name.replace("h ", "h, order 2, ").replace("p ", "p, order 1 up, ")


def race_chart(race: Race, width: float = WIDE) -> Chart:
    """Return panels of error over seconds and over unknowns, one line of panels a quantity,
    log-log.
    """
    panels = [[_Errors(race, q, cost).drawn() for cost in COSTS] for q in race.reference.values]
    title = race.scene.get("title") or race.scene.get("name", "")
    words = f"{title}: error against cost" + ("" if race.complete else " (interrupted)")
    return Chart([*panels, [legend(race, width)]], width, words, footer(race))


@dataclass
class _Errors:
    """A panel of errors of a quantity over a cost, log-log."""

    race: Race
    quantity: Quantity
    cost: str

    def __post_init__(self) -> None:
        self.bar = self.race.reference.bands[self.quantity]
        self.low, self.top = self._heights()
        costs = [row.costs[self.cost] for row in self.race.rows if row.status in ("ok", "failed")]
        positive = [value for value in costs if value] or [1.0]
        right = max(max(positive) * 2.2, 1.5 * self.race.reference.costs[self.cost])
        label = with_prefix if self.cost == "unknowns" else number
        error = f"error of {QUANTITY.get(self.quantity, self.quantity)}"
        self.panel = Panel(
            Axis(COSTS[self.cost], (min(positive) / 2.2, right), log=True, label=label),
            Axis(error, (self.low, self.top), log=True, label=in_percent),
            290.0,
            left=72.0,
        )

    def _heights(self) -> tuple[float, float]:
        """Return both ends of the axis of errors.

        An error bar far below every error is named at the bottom, so that it does not squeeze what
        there is to see.
        """
        errors = []
        for row in self.race.rows:
            error = self.race.error(row, self.quantity)
            if error is None:
                continue
            like = row.like_for_like.get(self.quantity) if error else None
            errors += [error, like or self.bar]
        positive = [error for error in errors if error > 0] or [1e-3]
        return max(self.bar / 2.5, min(positive) / 40), max(positive) * 4

    def drawn(self) -> Panel:
        """Return the panel with everything in it, from the back to the front."""
        race, panel = self.race, self.panel
        left, right = panel.x.ends
        self._draw_bar()
        tolerance = (race.scene.get("ask") or {}).get("tolerance")
        if is_number(tolerance) and self.low < tolerance < self.top:
            tolerance_line(panel, tolerance)
        self._draw_front()
        for name in dict.fromkeys(row.series for row in race.rows):
            self._draw_series([row for row in race.rows if row.series == name])
        self._draw_reference()
        setup = sum(race.setup.values())
        if self.cost == "seconds" and left < setup < right:
            panel.draw({"type": "rule", "color": GREY, "strokeDash": [1, 2]}, [{"x": setup}])
            look = {"type": "text", "angle": -90, "align": "right", "dx": -4, "dy": -6} | SMALL
            words = {"x": setup, "y": panel.y.ends[1], "text": "set-up, once a process"}
            panel.draw(look | {"color": GREY}, [words])
        return panel

    def _draw_bar(self) -> None:
        """Shade errors that the reference does not resolve, and name its error bar."""
        floor = max(self.bar, self.low)
        if self.bar > 0:
            shade = {"type": "rect", "color": "#00805e", "opacity": 0.13}
            self.panel.draw(shade, [{"y": self.low, "y2": floor}])
        below = "" if self.bar > self.low else ", below this axis"
        words = f"error bar of the reference {percent(self.bar, signed=False)}{below}"
        look = {"type": "text", "color": REFERENCE, "align": "left", "dx": 4, "dy": -7} | SMALL
        place = {"x": self.panel.x.ends[0], "y": floor}
        self.panel.draw(look, [{**place, "text": words}])

    def _draw_front(self) -> None:
        """Draw the Pareto front as steps, from the top of the panel to its right end."""
        steps = self.race.front(self.quantity, self.cost)
        if not steps:
            return
        xs = [row.costs[self.cost] for row in steps]
        ys = [self.race.sure_error(row, self.quantity) for row in steps]
        places = zip([xs[0], *xs, self.panel.x.ends[1]], [self.panel.y.ends[1], *ys, ys[-1]])
        look = {"type": "line", "interpolate": "step-after", **FRONT_LINE}
        self.panel.draw(look, [{"x": x, "y": y} for x, y in places])

    def _draw_reference(self) -> None:
        """Draw the reference at its own error bar."""
        reference = self.race.reference
        words = readout(
            f"reference, {reference.model}",
            ("own error bar", percent(self.bar, signed=False), ""),
            ("time", seconds(reference.seconds), "s"),
            ("unknowns", grouped(reference.unknowns), ""),
        )
        star = {"type": "point", "shape": SHAPES["*"], "size": 110, "stroke": REFERENCE}
        place = {"x": reference.costs[self.cost], "y": max(self.bar, self.low), "readout": words}
        self.panel.draw(star | {"fill": "#ffffff", "strokeWidth": 1}, [place])

    def _draw_series(self, rows: list[Row]) -> None:
        """Draw a line through the levels of a series, and their points; crosses at the top for
        those that failed, or have no such number.
        """
        look, panel = Look(rows[0].series, rows[0].family), self.panel
        spots = []
        for row in rows:
            error, x = self.race.error(row, self.quantity), row.costs[self.cost]
            if error is not None and x:
                words = readout(
                    look.series,
                    (f"error of {self.quantity}", self.race.error_text(row, self.quantity), ""),
                    ("time", seconds(row.seconds), "s"),
                    ("unknowns", grouped(row.unknowns), ""),
                    ("setting", row.setting, ""),
                )
                spots.append((row, {"x": x, "y": error, "readout": words}))
        opacity = 0.75 if look.series.endswith("uniform") else 1.0
        line = {"type": "line", "opacity": opacity} | look.line
        panel.draw(line, [{"x": spot["x"], "y": spot["y"]} for _, spot in spots])
        if self.cost == "seconds":
            several = [
                {"x": min(row.samples), "x2": max(row.samples), "y": spot["y"]}
                for row, spot in spots
                if len(row.samples) > 1
            ]
            panel.draw({"type": "rule", "color": look.colour, "opacity": 0.45}, several)
        panel.draw(look.marks, [spot for _, spot in spots])
        # arrows below points on the bar: the error may be smaller
        low = [
            {"x": spot["x"], "y": spot["y"]}
            for row, spot in spots
            if not self.race.resolved(row, self.quantity)
        ]
        head = {"type": "point", "shape": "triangle-down", "color": look.colour, "filled": True}
        panel.draw({**head, "size": 30, "yOffset": 13}, low)
        panel.draw({**head, "shape": "stroke", "angle": 90, "size": 60, "yOffset": 8}, low)
        label = {"type": "text", "color": look.colour} | SMALL
        names = [
            {"x": spot["x"], "y": spot["y"], "text": look.level_name(row)} for row, spot in spots
        ]
        panel.draw(
            label | {"align": "right", "dx": -6, "dy": 9}, [name for name in names if name["text"]]
        )
        if spots and not look.converges:
            self._draw_like_for_like(look, spots)
            # levels that do not converge to the reference coincide: one name will do, and that of
            # a lumped model, which lies close to that of a beam, below it
            place: dict[str, Any] = {"align": "left", "dx": 8, "dy": -8}
            if look.family == "lumped":
                place = {"align": "center", "dy": 16}
            panel.draw(label | place, [{**names[-1], "text": look.series}])
        cross = {"type": "point", "shape": SHAPES["x"], "stroke": look.colour, "strokeWidth": 2}
        missing = [
            {"x": row.costs[self.cost], "y": self.top / 1.5}
            for row in rows
            if row.status == "failed" or (row.status == "ok" and self.quantity not in row.errors)
        ]
        panel.draw({**cross, "size": 60}, missing)

    def _draw_like_for_like(self, look: Look, spots: list[tuple[Row, dict[str, Any]]]) -> None:
        """Draw errors against the solid with the same ties, hollow at the end of a dotted line."""
        pairs = [
            (spot, like) for row, spot in spots if (like := row.like_for_like.get(self.quantity))
        ]
        dots = {"type": "rule", "color": look.colour, "strokeDash": [2, 2]}
        self.panel.draw(dots, [{"x": spot["x"], "y": spot["y"], "y2": y2} for spot, y2 in pairs])
        hollow = [
            {
                "x": spot["x"],
                "y": y2,
                "readout": spot["readout"].replace("\n", ", like for like\n", 1),
            }
            for spot, y2 in pairs
        ]
        self.panel.draw({**look.marks, "fill": "#ffffff"}, hollow)


#: look of the Pareto front, and grey of marks that any family may have
FRONT_LINE, MARK = {"color": "#9a9a9a", "strokeWidth": 5, "opacity": 0.45}, "#555555"
#: px; of a line of the legend, and the least width of its columns
LINE, COLUMN = 17.0, 215.0


class Entry(NamedTuple):
    """A line of the legend: words, looks of a line and of a marker."""

    words: str
    line: dict[str, Any] | None = None
    marker: dict[str, Any] | None = None


#: what marks mean
MARKS = (
    Entry(
        "like for like:\nsection ties on both sides",
        {"color": FAMILIES["beam"][1], "strokeDash": [2, 2]},
        {"stroke": FAMILIES["beam"][1], "fill": "#ffffff", "shape": "square"},
    ),
    Entry("Pareto front,\ncancellations not counted", FRONT_LINE),
    Entry(
        "the reference itself",
        marker={"stroke": REFERENCE, "fill": "#ffffff", "shape": SHAPES["*"], "size": 80},
    ),
    Entry(
        "below the error bar: not resolved",
        marker={"fill": MARK, "stroke": MARK, "shape": "triangle-down"},
    ),
    Entry(
        "failed, or no such number",
        marker={"stroke": MARK, "shape": SHAPES["x"], "strokeWidth": 2},
    ),
)


def legend(race: Race, width: float) -> Panel:
    """Return a heading for each family with its series, then the meaning of marks, in columns."""
    by_family: dict[str, list[Look]] = {family: [] for family in FAMILIES}
    for row in race.rows:
        looks = by_family.setdefault(row.family, [])
        if (look := Look(row.series, row.family)) not in looks:
            looks.append(look)
    entries: list[Entry] = []
    for family, looks in by_family.items():
        if looks and family not in ("lumped", AUTOMATIC):  # their one series has their name
            entries.append(Entry(FAMILIES.get(family, (family,))[0].upper()))
        for look in looks:
            entries.append(Entry(look.name, look.line if look.converges else None, look.marks))
    entries += MARKS
    columns = max(1, int(width / COLUMN))
    counts = [entry.words.count("\n") + 1 for entry in entries]
    high = -(-sum(counts) // columns) + 1
    panel = Panel(
        Axis("", (0.0, columns), shown=False),
        Axis("", (high, -1.0), shown=False),
        LINE * (high + 1),
    )
    x, y = 0, 0
    text = {"type": "text", "align": "left", "color": INK}
    for entry, count in zip(entries, counts):
        if y + count > high:
            x, y = x + 1, 0
        if entry.line:
            panel.draw({"type": "rule", **entry.line}, [{"x": x, "x2": x + 0.12, "y": float(y)}])
        if entry.marker:
            point = {"size": 45, **entry.marker, "type": "point"}
            panel.draw(point, [{"x": x + 0.06, "y": float(y)}])
        indent = 0.15 if entry.line or entry.marker else 0.0
        panel.draw(text, [{"x": x + indent, "y": float(y), "text": entry.words}])
        y += count
    return panel


def footer(race: Race) -> str:
    """Return sentences on the reference, times, machine and skipped cases."""
    machine, reference = race.environment, race.reference
    lines = [
        f"Reference: {reference.model}, {reference.setting}, {reference.unknowns} unknowns, "
        f"{seconds(reference.seconds)} s a run; its error bar is that of `answer`.",
        _times(race),
        f"{machine.get('cpu')}, {machine.get('cores')} cores, {machine.get('date')}; "
        f"the whole chart took {race.seconds:.0f} s.",
    ]
    if race.left_out:
        lines.append(
            f"Skipped ({race.budget:g} s of processor time for the points): {race.left_out}; "
            "reasons in rows.csv."
        )
    return "\n".join(lines)


def _times(race: Race) -> str:
    runs = [len(row.samples) for row in race.rows if row.status == "ok"]
    words = f"Time: new body, six loads, {race.modes} modes; median of {race.runs} interleaved runs"
    if runs and min(runs) < race.runs:
        words += f" (slow cases down to {min(runs)})"
    if race.setup:
        setup = ", ".join(f"{name} {seconds(spent)} s" for name, spent in race.setup.items())
        words += f". Set-up, not in it: {setup}"
    return words + "."
