"""The list of charts in the report: each an SVG in bytes, None where there is nothing to draw.

The same results give the same bytes. What draws them is imported when the first one is drawn: a
terminal run has no use for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from solidgear.comparison.race.pareto import CHARTED
from solidgear.core import Record
from solidgear.core.judge.record import BarRecord, LevelRecord, ModelRecord
from solidgear.show.mode_charts import mac_chart, mode_chart
from solidgear.show.panel import (
    GREY,
    PERCENT,
    SHAPES,
    Axis,
    Panel,
    Series,
    readout,
    tolerance_line,
    wrapped,
)
from solidgear.show.plot import NARROW, WIDE, Chart, in_columns, page_svg
from solidgear.show.reading import (
    answer_seconds,
    headline,
    is_resolved,
    model_name,
    reference_of,
    relative_change,
)
from solidgear.show.sketch_page import sketch_svg
from solidgear.show.where_chart import where_chart
from solidgear.show.words import grouped, percent, seconds, small
from solidgear.variants.budget.chart import of_record as budget_chart

#: what the meshes differ in -> label of the axis
AXIS = {
    "h": "representative element size h, mm",
    "order": "1 / order of the elements",
    "dofs": "unknowns",
}


def convergence_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart the distance from the extrapolated value over mesh size or unknowns, log-log, with
    error bars.
    """
    quantities = []
    for key, model in record.models.items():
        quantities += _quantities(model_name(record, key), model)
    return (
        Chart(in_columns([_convergence_panel(quantity) for quantity in quantities], 2), width)
        if quantities
        else None
    )


@dataclass(frozen=True)
class _Quantity:
    """One quantity of one model over its meshes.

    ``along`` is what the meshes differ in: ``h``, ``order`` or ``dofs``; ``spots`` are (place along
    the axis, distance from the extrapolated value, mesh), ascending.
    """

    name: str
    model: ModelRecord
    quantity: str
    along: str
    spots: list[tuple[float, float, LevelRecord]]
    bar: BarRecord


def _quantities(name: str, model: ModelRecord) -> list[_Quantity]:
    """Return quantities of a model that two meshes or more distinguish."""
    if model.convergence is None:
        return []
    levels = model.convergence.levels
    along = _distinguished_by(levels)
    quantities = []
    for quantity in CHARTED:
        bar = model.convergence.quantities.get(quantity, BarRecord())
        if not bar.extrapolated:
            continue
        spots = []
        for level in levels:
            place, value = _size(level, along), level.quantities.get(quantity)
            if place is None or value is None:
                continue
            distance = abs(value / bar.extrapolated - 1)
            if distance > 0:
                spots.append((_on_axis(along, place), distance, level))
        if len(spots) >= 2:
            spots.sort(key=lambda spot: spot[:2])
            quantities.append(_Quantity(name, model, quantity, along, spots, bar))
    return quantities


def _size(level: LevelRecord, along: str) -> float | None:
    """Return the value of a mesh along an axis: its size, its order or its unknowns."""
    if along == "h":
        return level.h
    return level.order if along == "order" else level.dofs


def _distinguished_by(levels: list[LevelRecord]) -> str:
    """Return the difference between the meshes: their size if all have one, else their order, else
    unknowns.
    """
    for along in ("h", "order"):
        if levels and all((_size(level, along) or 0) > 0 for level in levels):
            return along
    return "dofs"


def _on_axis(along: str, value: float) -> float:
    """Return sizes in mm, orders as their inverse, so that finer is to the left."""
    if along == "order":
        return 1 / value
    return 1e3 * value if along == "h" else value


def _convergence_panel(quantity: _Quantity) -> Panel:
    xs, ys, _ = zip(*quantity.spots)
    low, high = min(ys) / 3, max(ys) * 3
    bar = quantity.bar.gci
    if bar:
        low, high = min(low, bar / 3), max(high, bar * 2)
    ticks = {x: _tick(quantity.along, x) for x in xs}  # at the meshes: three seldom span a decade
    ends = min(xs) / 1.25, max(xs) * 1.25
    panel = Panel(
        Axis(AXIS[quantity.along], ends, log=True, ticks=ticks),
        Axis("distance from extrapolated", (low, high), log=True, label=PERCENT),
        180,
        f"{quantity.name}, {quantity.quantity}",
    )
    if bar:
        _shade(panel, low, quantity)
    colour, shape = quantity.model.colour, SHAPES.get(quantity.model.marker, "circle")
    rows = [
        {"x": x, "y": y, "readout": _words(quantity, y, level)} for x, y, level in quantity.spots
    ]
    line = {"type": "line", "color": colour, "strokeWidth": 1.5}
    panel.draw(line, [{"x": x, "y": y} for x, y, _ in quantity.spots])
    panel.draw({"type": "point", "filled": True, "color": colour, "shape": shape, "size": 55}, rows)
    return panel


def _words(quantity: _Quantity, distance: float, level: LevelRecord) -> str:
    """Return words shown at the point of one mesh."""
    return readout(
        quantity.name,
        (f"{quantity.quantity}, from extrapolated", percent(distance, signed=False), ""),
        ("mesh", str(level.mesh.get("element") or ""), ""),
        ("size h", f"{1e3 * level.h:.3g}" if level.h else "", "mm"),
        ("unknowns", grouped(level.dofs), ""),
    )


def _shade(panel: Panel, low: float, quantity: _Quantity) -> None:
    """Shade the error bar, from the bottom of the panel up."""
    bar, colour = quantity.bar.gci, quantity.model.colour
    panel.draw({"type": "rect", "color": colour, "opacity": 0.12}, [{"y": low, "y2": bar}])
    panel.draw({"type": "rule", "color": colour, "strokeDash": [5, 3]}, [{"y": bar}])
    factor = "" if quantity.bar.factor is None else f", factor {small(quantity.bar.factor)}"
    words = f"error bar {percent(bar, signed=False)}{factor}"
    name = {"type": "text", "align": "left", "dy": -7, "dx": 4}
    panel.draw(name, [{"y": bar, "text": words}], x={"value": 0})


def _tick(along: str, x: float) -> str:
    if along == "order":
        return f"1/{1 / x:.0f}"
    return f"{x:.3g}" if x < 1e4 else f"{x / 1e3:.3g}k"


def cost_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart seconds against deviation from the reference, log-log, one point a model.

    The reference has no deviation; it stands at its own error bar, hollow, like every deviation that is
    not resolved.
    """
    spots = {quantity: _spots(record, quantity) for quantity in CHARTED}
    tolerance = record.verdict.tolerance
    if tolerance is not None and tolerance <= 0:
        tolerance = None
    panels = [_panel(quantity, points, tolerance) for quantity, points in spots.items() if points]
    return Chart([panels], width) if panels else None


@dataclass(frozen=True)
class _Spot:
    """One model in one panel: a hollow marker is an error bar and no deviation."""

    name: str
    model: ModelRecord
    seconds: float
    error: float
    hollow: bool
    remark: str

    @property
    def rejected(self) -> bool:
        return self.model.valid is False


def _spots(record: Record, quantity: str) -> list[_Spot]:
    """Return the models with known time and distance from the reference."""
    out = []
    for key, model in record.models.items():
        total = answer_seconds(model)
        if total is None or total <= 0:
            continue
        name = model_name(record, key)
        bar = _own_bar(model, quantity) if key == reference_of(record) else None
        row = headline(record, key, quantity)
        if bar:
            out.append(_Spot(name, model, total, bar, True, "own error bar"))
        elif row is not None and row.relative:
            hollow = not is_resolved(row)
            remark = "not resolved" if hollow else ""
            out.append(_Spot(name, model, total, abs(row.relative), hollow, remark))
    return out


def _own_bar(model: ModelRecord, quantity: str) -> float | None:
    """Return the error bar of a quantity, for compliances that of the worst; None where there is
    none.
    """
    if model.band is None:
        return None
    bar = model.band.each.get(quantity)
    if quantity.startswith("C_"):
        bar = model.band.compliance
    return bar if bar is not None and bar > 0 else None


def _panel(quantity: str, spots: list[_Spot], tolerance: float | None) -> Panel:
    times, errors = [spot.seconds for spot in spots], [spot.error for spot in spots]
    if tolerance is not None:
        errors.append(tolerance)
    panel = Panel(
        # with room for the last name
        Axis("building and solving, s", (min(times) / 3, max(times) * 15), log=True),
        Axis(
            f"{quantity}: distance from reference",
            (min(errors) / 2.5, max(errors) * 5),
            log=True,
            label=PERCENT,
        ),
        230,
    )
    if tolerance is not None:
        tolerance_line(panel, tolerance)
    for spot in spots:
        _draw(panel, spot, quantity)
    return panel


def _draw(panel: Panel, spot: _Spot, quantity: str) -> None:
    remarks = [spot.remark] if spot.remark else []
    if spot.rejected:
        remarks.append("rejected")
    words = readout(
        spot.name,
        (f"{quantity}, from reference", percent(spot.error, signed=False), ""),
        ("building and solving", seconds(spot.seconds), "s"),
        ("unknowns", grouped(spot.model.dofs), ""),
        ("remark", ", ".join(remarks), ""),
    )
    colour, place = spot.model.colour, {"x": spot.seconds, "y": spot.error}
    mark = {
        "type": "point",
        "shape": SHAPES["x"] if spot.rejected else SHAPES.get(spot.model.marker, "circle"),
        "stroke": colour,
        "fill": "#ffffff" if spot.hollow else colour,
        "strokeWidth": 2,
        "size": 80,
    }
    panel.draw(mark, [{**place, "readout": words}])
    name = spot.name + (f"\n({', '.join(remarks)})" if remarks else "")
    text = {"type": "text", "align": "left", "baseline": "middle", "dx": 10}
    panel.draw(text, [{**place, "text": name}])


#: quantity -> colour of its bars
SHOWN = {"C_zz": "#1f5f99", "K_zz": "#9db8d2", "bending 1": "#c4541c"}
#: px of a bar; and of the names of cases on a wide and on a narrow page
BAR, NAMES, NARROW_NAMES = 15.0, 260.0, 140.0
#: room for the figure beside a bar, of the longest bar
FIGURES = 0.3
#: ways of tying that are held against averaged ones
TIES = ("rigid", "section")


def _bars(
    labels: list[str], columns: dict[str, list[float | None]], words: str, width: float
) -> Chart | None:
    """Draw groups of horizontal bars of relative changes, each with its figure."""
    sizes = [v for column in columns.values() for v in column if v is not None]
    if not sizes:
        return None
    reach, low, high = max(map(abs, sizes)) or 1.0, min(0.0, *sizes), max(0.0, *sizes)
    room = FIGURES * reach * (1 if width > NARROW else 2.2)
    ends = low - room * (low < 0) - 0.04 * reach, high + room * (high > 0) + 0.04 * reach
    margin = NAMES if width > NARROW else NARROW_NAMES
    names = {float(i): "\n".join(wrapped(name, margin - 10)) for i, name in enumerate(labels)}
    lines = max(name.count("\n") + 1 for name in names.values())
    panel = Panel(
        Axis(words, ends, label=PERCENT),
        Axis("", (len(labels) - 0.5, -0.5), ticks=names, grid=False),
        max(BAR * len(columns) + 6, 15 * lines) * len(labels),
        series={name: Series(colour) for name, colour in SHOWN.items() if name in columns},
        legend={"orient": "top", "direction": "horizontal"},
        left=margin,
    )
    rows = list(_rows(labels, columns))
    panel.draw({"type": "rect", "strokeWidth": 0}, [bar for bar, _ in rows])
    panel.draw({"type": "rule", "color": GREY}, [{"x": 0}])
    for sign, align in ((1, "left"), (-1, "right")):
        figures = [figure for _, figure in rows if (figure["x"] >= 0) == (sign > 0)]
        text = {"type": "text", "align": align, "baseline": "middle", "dx": 3 * sign}
        panel.draw(text, figures)
    return Chart([[panel]], width)


def _rows(labels: list[str], columns: dict[str, list[float | None]]):
    """Return a bar and a figure for every case and quantity."""
    thick = 0.8 / max(len(columns), 1)
    for k, (name, values) in enumerate(columns.items()):
        for i, value in enumerate(values):
            if value is None:
                continue
            y, change = i + (k - (len(columns) - 1) / 2) * thick, percent(value)
            case = labels[i].replace("\n", " ")
            words = readout(name, ("case", case, ""), (f"change of {name}", change, ""))
            bar = {"x": 0.0, "x2": value, "y": y - 0.43 * thick, "y2": y + 0.43 * thick}
            yield {**bar, "name": name, "readout": words}, {"x": value, "y": y, "text": change}


def cause_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart changes by each assumption alone, as horizontal bars."""
    causes = [c for c in record.causes if any(c.quantities.get(q) is not None for q in SHOWN)]
    columns = {name: [cause.quantities.get(name) for cause in causes] for name in SHOWN}
    labels = [f"{c.cause}, {model_name(record, c.model)}\n({c.change})" for c in causes]
    return _bars(labels, columns, "relative change when only this is switched", width)


def attachment_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart rigid and section ties against averaged ones, for compliance and first bending."""
    labels = []
    columns: dict[str, list[float | None]] = {"C_zz": [], "bending 1": []}
    for key, ties in record.attachments.items():
        if "average" not in ties:
            continue
        average = ties["average"].quantities
        for tie in TIES:
            if tie not in ties:
                continue
            quantities = ties[tie].quantities
            labels.append(f"{model_name(record, key)}\n{tie}")
            for name, column in columns.items():
                column.append(relative_change(quantities.get(name), average.get(name)))
    return _bars(labels, columns, "relative to averaged ties of the same model", width)


#: those that are described in Vega-Lite, for a page of a width
DESCRIBED: dict[str, Callable[[Record, float], Chart | None]] = {
    "budget": budget_chart,
    "modes": mode_chart,
    "mac": mac_chart,
    "convergence": convergence_chart,
    "where": where_chart,
    "causes": cause_chart,
    "cost": cost_chart,
    "attachments": attachment_chart,
}


def _drawn(name: str, record: Record) -> bytes | None:
    """Return a chart for the page."""
    return page_svg(name, partial(DESCRIBED[name], record))


#: heading -> chart, in the order of the report; what each picture says in words is up to the page
CHARTS: dict[str, Callable[[Record], bytes | None]] = {
    "sketch": lambda record: sketch_svg("sketch", record.scene),
    **{name: partial(_drawn, name) for name in DESCRIBED},
}
