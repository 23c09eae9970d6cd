"""Charts of the modes: frequencies side by side, and MAC matrices against the reference."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.core import Record
from solidgear.core.judge.record import MacTable, ModelRecord, ModeRecord
from solidgear.show.panel import GREY, INK, PERCENT, SHAPES, Axis, Panel, Series, readout
from solidgear.show.plot import NARROW, WIDE, Chart, in_columns
from solidgear.show.reading import model_name, reference_of, relative_change
from solidgear.show.words import hertz, percent

#: families of modes along the axis
FAMILIES = {"bending": 0, "axial": 1, "torsion": 2}
#: px; height of frequencies, of differences, and of a row of a matrix
TALL, LOW, ROW = 215.0, 130.0, 24.0
#: px; of the longest name of a mode beside a matrix
LONGEST = 76.0


def mode_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart natural frequencies of all models side by side, and below them their differences from
    the reference.
    """
    models = [key for key, model in record.models.items() if model.modes]
    modes = {key: _elastic_by_name(record.models[key]) for key in models}
    reference = reference_of(record)
    references = _known(modes, reference)
    names = sorted(references, key=lambda name: _place(references[name]))
    if not names:
        return None
    base = modes.get(reference or "")
    step = 0.7 / max(len(models), 1)
    rows: list[dict[str, Any]] = []
    for k, key in enumerate(models):
        shift = (k - (len(models) - 1) / 2) * step
        compared = base if key != reference and base is not None else {}
        for i, name in enumerate(names):
            if name in modes[key]:
                rows.append(
                    {"x": i + shift, **_row(model_name(record, key), modes[key][name], compared)}
                )
    series = {
        model_name(record, key): Series(model.colour, SHAPES.get(model.marker, "circle"))
        for key, model in record.models.items()
        if key in models
    }
    pairs = {name for key in models for name, m in modes[key].items() if m.multiplicity > 1}
    labels = {
        float(i): name + ("\n(pair)" if name in pairs else "") for i, name in enumerate(names)
    }
    families = [references[name].family for name in names]
    legend = {"orient": "top", "columns": 5 if width > NARROW else 2}
    turned = len(names) > (9 if width > NARROW else 3)
    relative = base is not None and len(models) > 1
    axis = Axis("frequency, Hz", (0.0, 1.06 * max(row["y"] for row in rows)))
    hidden = dict.fromkeys(labels, "") if relative else labels
    panels = [_stems(axis, TALL, hidden, families, rows, series, legend, turned)]
    if relative and reference is not None:
        differences = [{**row, "y": row["apart"]} for row in rows if row["apart"] is not None]
        sizes = [row["y"] for row in differences] or [0.0]
        reach = 0.08 * (max(0.0, *sizes) - min(0.0, *sizes)) or 1.0
        ends = min(0.0, *sizes) - reach, max(0.0, *sizes) + reach
        words = f"against {model_name(record, reference)}"
        panels.append(
            _stems(
                Axis(words, ends, label=PERCENT),
                LOW,
                labels,
                families,
                differences,
                series,
                None,
                turned,
            )
        )
    return Chart(in_columns(panels, 1), width)


def _row(model: str, mode: ModeRecord, reference: Mapping[str, ModeRecord]) -> dict[str, Any]:
    """Return one mode of one model: frequency, difference from the reference, and readout."""
    base = reference[mode.name].frequency_hz if mode.name in reference else None
    change = relative_change(mode.frequency_hz, base)
    words = readout(
        model,
        ("mode", mode.name, ""),
        ("frequency", hertz(mode.frequency_hz), "Hz"),
        ("from reference", percent(change) if change is not None else "", ""),
    )
    return {"y": mode.frequency_hz or 0.0, "apart": change, "name": model, "readout": words}


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


def _elastic_by_name(model: ModelRecord) -> dict[str, ModeRecord]:
    return {mode.name: mode for mode in model.modes if (mode.frequency_hz or 0.0) > 0}


def _known(
    modes: Mapping[str, dict[str, ModeRecord]], reference: str | None
) -> dict[str, ModeRecord]:
    """Return every mode by name, from the reference, else from the last model that has it."""
    references: dict[str, ModeRecord] = {}
    for record in modes.values():
        references |= record
    return references if reference is None else references | modes.get(reference, {})


def _place(mode: ModeRecord) -> tuple:
    """Order along the axis: by family, the usual ones first, then by frequency."""
    return FAMILIES.get(mode.family, len(FAMILIES)), mode.family, mode.frequency_hz


def mac_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Return MAC matrices against the reference as annotated heat maps."""
    if record.mac is None:
        return None
    reference = model_name(record, record.mac.reference)
    panels = [
        mac_panel(table, model_name(record, key), reference)
        for key, table in record.mac.models.items()
        if table.values and table.values[0]
    ]
    return Chart(in_columns(panels, 3), width) if panels else None


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
        text = {"type": "text", "color": "#ffffff" if white else INK, "baseline": "middle"}
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
