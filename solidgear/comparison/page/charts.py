"""The list of charts in the report: each an SVG in bytes, None where there is nothing to draw.

The same results give the same bytes. What draws them is imported when the first one is drawn: a
terminal run has no use for it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from solidgear.comparison.race.race import CHARTED
from solidgear.core import COMPLIANCE, Quantity, Record
from solidgear.core.judge.record import LevelRecord, ModelRecord, ModeRecord, relative_change
from solidgear.core.registry import addition
from solidgear.show.mode_charts import mac_panel
from solidgear.show.panel import GREY, SHAPES, Panel, Series, readout, tolerance_line, wrapped
from solidgear.show.plot import NARROW, WIDE, Chart, in_columns, page_svg
from solidgear.show.scales import Axis, in_percent
from solidgear.show.sketch import sketch_svg
from solidgear.show.where_chart import where_chart
from solidgear.show.words import grouped, hertz, percent, seconds, small

#: what the meshes differ in -> label of the axis
AXIS = {
    "h": "representative element size h, mm",
    "order": "1 / order of the elements",
    "dofs": "unknowns",
}
#: families of modes along the axis
FAMILIES = {"bending": 0, "axial": 1, "torsion": 2}
#: px; height of frequencies, and of differences
TALL, LOW = 215.0, 130.0


def convergence_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart the distance from the extrapolated value over mesh size or unknowns, log-log, with
    error bars.
    """
    panels = [
        _convergence(record.name(key), model, quantity)
        for key, model in record.models.items()
        for quantity in CHARTED
    ]
    drawn = [panel for panel in panels if panel is not None]
    return Chart(in_columns(drawn, 2), width) if drawn else None


def _convergence(name: str, model: ModelRecord, quantity: Quantity) -> Panel | None:
    """Draw one quantity of one model over its meshes; None unless two of them distinguish it."""
    levels = model.convergence.levels if model.convergence else []
    bar = model.convergence.quantities.get(quantity) if model.convergence else None
    if bar is None or not bar.extrapolated:
        return None
    along = next((a for a in ("h", "order") if all(_place(level, a) for level in levels)), "dofs")
    colour = model.colour
    spots: list[dict[str, Any]] = []
    for level in levels:
        x, value = _place(level, along), level.quantities.get(quantity)
        if x is None or value is None:
            continue
        y = abs(value / bar.extrapolated - 1)
        if y == 0:
            continue
        words = readout(
            name,
            (f"{quantity}, from extrapolated", percent(y, signed=False), ""),
            ("mesh", str(level.mesh.get("element") or ""), ""),
            ("size h", f"{1e3 * level.h:.3g}" if level.h else "", "mm"),
            ("unknowns", grouped(level.dofs), ""),
        )
        spots.append({"x": x, "y": y, "readout": words})
    if len(spots) < 2:
        return None
    spots.sort(key=lambda spot: (spot["x"], spot["y"]))
    xs, ys = [spot["x"] for spot in spots], [spot["y"] for spot in spots]
    low, high = min(ys) / 3, 3 * max(ys)
    if bar.gci:
        low, high = min(low, bar.gci / 3), max(high, bar.gci * 2)
    ticks = {x: _tick(along, x) for x in xs}  # at the meshes: three seldom span a decade
    panel = Panel(
        Axis(AXIS[along], (min(xs) / 1.25, max(xs) * 1.25), log=True, ticks=ticks),
        Axis("distance from extrapolated", (low, high), log=True, label=in_percent),
        180,
        f"{name}, {quantity}",
    )
    if bar.gci:
        # shaded from the bottom of the panel up
        panel.draw({"type": "rect", "color": colour, "opacity": 0.12}, [{"y": low, "y2": bar.gci}])
        panel.draw({"type": "rule", "color": colour, "strokeDash": [5, 3]}, [{"y": bar.gci}])
        factor = "" if bar.factor is None else f", factor {small(bar.factor)}"
        label = {
            "x": panel.x.ends[0],
            "y": bar.gci,
            "text": f"error bar {percent(bar.gci, signed=False)}{factor}",
        }
        panel.draw({"type": "text", "align": "left", "dy": -7, "dx": 4}, [label])
    line = {"type": "line", "color": colour, "strokeWidth": 1.5}
    panel.draw(line, [{"x": spot["x"], "y": spot["y"]} for spot in spots])
    point = {"type": "point", "filled": True, "color": colour, "size": 55}
    panel.draw({**point, "shape": SHAPES.get(model.marker, "circle")}, spots)
    return panel


def _place(level: LevelRecord, along: str) -> float | None:
    """Return the place of a mesh on an axis: its size in mm, one over its order, so that finer is
    to the left, or its unknowns.
    """
    if along == "h":
        return 1e3 * level.h if level.h else None
    if along == "order":
        return 1 / level.order if level.order else None
    return level.dofs


def _tick(along: str, x: float) -> str:
    if along == "order":
        return f"1/{1 / x:.0f}"
    return f"{x:.3g}" if x < 1e4 else f"{x / 1e3:.3g}k"


def mode_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart natural frequencies of all models side by side, and below them their differences from
    the reference.
    """
    modes: dict[str, dict[str, ModeRecord]] = {
        key: {mode.name: mode for mode in model.modes if (mode.frequency_hz or 0.0) > 0}
        for key, model in record.models.items()
        if model.modes
    }
    base = modes.get(record.reference or "")
    # every mode by name, from the reference, else from the last model that has it
    references: dict[str, ModeRecord] = {}
    for by_name in (*modes.values(), base or {}):
        references |= by_name
    names = sorted(references, key=lambda name: _rank(references[name]))
    if not names:
        return None
    step = 0.7 / len(modes)
    rows: list[dict[str, Any]] = []
    for k, (key, by_name) in enumerate(modes.items()):
        shift = (k - (len(modes) - 1) / 2) * step
        for i, name in enumerate(names):
            if name not in by_name:
                continue
            hz, change = by_name[name].frequency_hz, None
            if base is not None and name in base and key != record.reference:
                change = relative_change(hz, base[name].frequency_hz)
            words = readout(
                record.name(key),
                ("mode", name, ""),
                ("frequency", hertz(hz), "Hz"),
                ("from reference", percent(change) if change is not None else "", ""),
            )
            place = {"x": i + shift, "y": hz or 0.0, "apart": change}
            rows.append({**place, "name": record.name(key), "readout": words})
    series = {}
    for key in modes:
        model = record.models[key]
        series[record.name(key)] = Series(model.colour, SHAPES.get(model.marker, "circle"))
    pairs = {n for by_name in modes.values() for n, m in by_name.items() if m.multiplicity > 1}
    labels = {
        float(i): name + ("\n(pair)" if name in pairs else "") for i, name in enumerate(names)
    }
    families = [references[name].family for name in names]
    legend = {"orient": "top", "columns": 5 if width > NARROW else 2}
    turned = len(names) > (9 if width > NARROW else 3)
    relative = base is not None and len(modes) > 1
    axis = Axis("frequency, Hz", (0.0, 1.06 * max(row["y"] for row in rows)))
    hidden = dict.fromkeys(labels, "") if relative else labels
    panels = [_stems(axis, TALL, hidden, families, rows, series, legend, turned)]
    if relative:
        differences = [{**row, "y": row["apart"]} for row in rows if row["apart"] is not None]
        sizes = [0.0, *(row["y"] for row in differences)]
        reach = 0.08 * (max(sizes) - min(sizes)) or 1.0
        words, ends = f"against {record.name(record.reference)}", (min(sizes), max(sizes))
        axis = Axis(words, (ends[0] - reach, ends[1] + reach), label=in_percent)
        panels.append(_stems(axis, LOW, labels, families, differences, series, None, turned))
    return Chart(in_columns(panels, 1), width)


def _rank(mode: ModeRecord) -> tuple:
    """Order along the axis: by family, the usual ones first, then by frequency."""
    return FAMILIES.get(mode.family, len(FAMILIES)), mode.family, mode.frequency_hz


def _stems(
    axis: Axis,
    height: float,
    labels: Mapping[float, str],
    families: list[str],
    rows: list[dict[str, Any]],
    series: Mapping[str, Series],
    legend: Mapping[str, Any] | None,
    turned: bool,
) -> Panel:
    """Draw a stem with its marker for every row, and a dotted line between families."""
    along = Axis("", (-0.6, len(labels) - 0.4), ticks=labels, grid=False)
    panel = Panel(along, axis, height, series=series, legend=legend, turned=turned)
    ends = [i - 0.5 for i in range(1, len(families)) if families[i] != families[i - 1]]
    panel.draw({"type": "rule", "color": GREY, "strokeDash": [2, 3]}, [{"x": x} for x in ends])
    panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
    stems = [{"x": row["x"], "y": 0.0, "y2": row["y"], "name": row["name"]} for row in rows]
    panel.draw({"type": "rule", "strokeWidth": 1.4}, stems)
    points = [{key: row[key] for key in ("x", "y", "name", "readout")} for row in rows]
    panel.draw({"type": "point", "filled": True, "size": 60}, points)
    return panel


def mac_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Return MAC matrices against the reference as annotated heat maps."""
    if record.mac is None:
        return None
    reference = record.name(record.mac.reference)
    panels = [
        mac_panel(table, record.name(key), reference)
        for key, table in record.mac.models.items()
        if table.values and table.values[0]
    ]
    return Chart(in_columns(panels, 3), width) if panels else None


def cost_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart seconds against deviation from the reference, log-log, one point a model.

    The reference has no deviation; it stands at its own error bar, hollow, like every deviation that is
    not resolved.
    """
    panels = [_cost(record, quantity) for quantity in CHARTED]
    drawn = [panel for panel in panels if panel is not None]
    return Chart([drawn], width) if drawn else None


def _cost(record: Record, quantity: Quantity) -> Panel | None:
    """Draw the models with known time and distance from the reference; None without any."""
    spots = []
    for key, model in record.models.items():
        total, row = model.answer_seconds, record.headline(key, quantity)
        if total is None or total <= 0:
            continue
        bar = None
        if key == record.reference and model.band:
            # for compliances that of the worst
            is_compliance = quantity.kind == COMPLIANCE
            bar = model.band.compliance if is_compliance else model.bars.get(quantity)
        if bar and bar > 0:
            spots.append((key, total, bar, "own error bar"))
        elif row is not None and row.relative:
            spots.append((key, total, abs(row.relative), "" if row.resolved else "not resolved"))
    if not spots:
        return None
    times, errors = [total for _, total, *_ in spots], [error for _, _, error, _ in spots]
    tolerance = record.verdict.tolerance or 0.0
    if tolerance > 0:
        errors.append(tolerance)
    panel = Panel(
        # with room for the last name
        Axis("building and solving, s", (min(times) / 3, max(times) * 15), log=True),
        Axis(
            f"{quantity}: distance from reference",
            (min(errors) / 2.5, max(errors) * 5),
            log=True,
            label=in_percent,
        ),
        230,
    )
    if tolerance > 0:
        tolerance_line(panel, tolerance)
    for key, total, error, hollow in spots:
        name, model = record.name(key), record.models[key]
        rejected = model.valid is False
        remarks = ", ".join(filter(None, (hollow, "rejected" if rejected else "")))
        words = readout(
            name,
            (f"{quantity}, from reference", percent(error, signed=False), ""),
            ("building and solving", seconds(total), "s"),
            ("unknowns", grouped(model.dofs), ""),
            ("remark", remarks, ""),
        )
        place = {"x": total, "y": error}
        mark = {
            "type": "point",
            "shape": SHAPES["x"] if rejected else SHAPES.get(model.marker, "circle"),
            "stroke": model.colour,
            "fill": "#ffffff" if hollow else model.colour,
            "strokeWidth": 2,
            "size": 80,
        }
        panel.draw(mark, [{**place, "readout": words}])
        text = {"type": "text", "align": "left", "dx": 10}
        panel.draw(text, [{**place, "text": name + (f"\n({remarks})" if remarks else "")}])
    return panel


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
        Axis(words, ends, label=in_percent),
        Axis("", (len(labels) - 0.5, -0.5), ticks=names, grid=False),
        max(BAR * len(columns) + 6, 15 * lines) * len(labels),
        series={name: Series(colour) for name, colour in SHOWN.items() if name in columns},
        legend={"orient": "top", "direction": "horizontal"},
        left=margin,
    )
    bars: list[dict[str, Any]] = []
    figures: list[dict[str, Any]] = []
    thick = 0.8 / len(columns)
    for k, (name, values) in enumerate(columns.items()):
        for i, value in enumerate(values):
            if value is None:
                continue
            y, change = i + (k - (len(columns) - 1) / 2) * thick, percent(value)
            case = labels[i].replace("\n", " ")
            place = {"x": 0.0, "x2": value, "y": y - 0.43 * thick, "y2": y + 0.43 * thick}
            facts = readout(name, ("case", case, ""), (f"change of {name}", change, ""))
            bars.append({**place, "name": name, "readout": facts})
            figures.append({"x": value, "y": y, "text": change})
    panel.draw({"type": "rect", "strokeWidth": 0}, bars)
    panel.draw({"type": "rule", "color": GREY}, [{"x": 0}])
    text = {"type": "text"}
    right = [figure for figure in figures if figure["x"] >= 0]
    left = [figure for figure in figures if figure["x"] < 0]
    panel.draw(text | {"align": "left", "dx": 3}, right)
    panel.draw(text | {"align": "right", "dx": -3}, left)
    return Chart([[panel]], width)


def cause_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart changes by each assumption alone, as horizontal bars."""
    causes = [c for c in record.causes if any(c.quantities.get(q) is not None for q in SHOWN)]
    columns = {name: [cause.quantities.get(name) for cause in causes] for name in SHOWN}
    labels = [f"{c.cause}, {record.name(c.model)}\n({c.change})" for c in causes]
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
            labels.append(f"{record.name(key)}\n{tie}")
            for name, column in columns.items():
                column.append(relative_change(quantities.get(name), average.get(name)))
    return _bars(labels, columns, "relative to averaged ties of the same model", width)


def _budget_chart(record: Record, width: float) -> Chart | None:
    """Return the chart of what open inputs leave open."""
    chart = addition("chart", "budget")
    return chart(record, width) if chart else None


#: those of panels, for a page of a width
DESCRIBED: dict[str, Callable[[Record, float], Chart | None]] = {
    "budget": _budget_chart,
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
