"""Charts of the modes: frequencies side by side, and MAC matrices against the reference."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from solidgear.core.judge.record import MacTable, ModelRecord, ModeRecord, Record
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
    """Natural frequencies of all models side by side, and below them how far each is from the
    reference.
    """
    models = [key for key, model in record.models.items() if model.modes]
    modes = {key: _elastic_by_name(record.models[key]) for key in models}
    reference = reference_of(record)
    known = _known(modes, reference)
    names = sorted(known, key=lambda name: _place(known[name]))
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
    families = [known[name].family for name in names]
    legend = {"orient": "top", "columns": 5 if width > NARROW else 2}
    turned = len(names) > (9 if width > NARROW else 3)
    relative = base is not None and len(models) > 1
    over = Axis("frequency, Hz", (0.0, 1.06 * max(row["y"] for row in rows)))
    hidden = dict.fromkeys(labels, "") if relative else labels
    panels = [_stems(over, TALL, hidden, families, rows, series, legend, turned)]
    if relative and reference is not None:
        apart = [{**row, "y": row["apart"]} for row in rows if row["apart"] is not None]
        sizes = [row["y"] for row in apart] or [0.0]
        reach = 0.08 * (max(0.0, *sizes) - min(0.0, *sizes)) or 1.0
        ends = min(0.0, *sizes) - reach, max(0.0, *sizes) + reach
        words = f"against {model_name(record, reference)}"
        panels.append(
            _stems(
                Axis(words, ends, label=PERCENT), LOW, labels, families, apart, series, None, turned
            )
        )
    return Chart(in_columns(panels, 1), width)


def _row(model: str, mode: ModeRecord, reference: Mapping[str, ModeRecord]) -> dict[str, Any]:
    """One mode of one model: its frequency, how far it is from that of the reference, and what is
    to be read of it.
    """
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
    over: Axis,
    height: float,
    labels: Mapping[float, str],
    families: list[str],
    rows: list[dict[str, Any]],
    series: Mapping[str, Series],
    legend: Mapping[str, Any] | None,
    turned: bool,
) -> Panel:
    """A stem with its marker for every row, and a dotted line wherever the next family begins."""
    along = Axis("", (-0.6, len(labels) - 0.4), ticks=labels, grid=False)
    panel = Panel(along, over, height, series=series, legend=legend, turned=turned)
    ends = [i - 0.5 for i in range(1, len(families)) if families[i] != families[i - 1]]
    panel.draw({"type": "rule", "color": GREY, "strokeDash": [2, 3]}, [{"x": x} for x in ends])
    panel.draw({"type": "rule", "color": GREY}, [{"y": 0.0}])
    stems = [{"x": row["x"], "y": 0.0, "y2": row["y"], "name": row["name"]} for row in rows]
    panel.draw({"type": "rule", "strokeWidth": 1.4}, stems)
    kept = [{key: row[key] for key in ("x", "y", "name", "readout")} for row in rows]
    panel.draw({"type": "point", "filled": True, "size": 60}, kept)
    return panel


def _elastic_by_name(model: ModelRecord) -> dict[str, ModeRecord]:
    return {mode.name: mode for mode in model.modes if (mode.frequency_hz or 0.0) > 0}


def _known(
    modes: Mapping[str, dict[str, ModeRecord]], reference: str | None
) -> dict[str, ModeRecord]:
    """Every mode by its name, as the reference has it, else the last model that has it."""
    known: dict[str, ModeRecord] = {}
    for found in modes.values():
        known |= found
    return known if reference is None else known | modes.get(reference, {})


def _place(mode: ModeRecord) -> tuple:
    """Order along the axis: by family, the usual ones first, then by frequency."""
    return FAMILIES.get(mode.family, len(FAMILIES)), mode.family, mode.frequency_hz


def mac_chart(record: Record, width: float = WIDE) -> Chart | None:
    """MAC matrices against the reference as annotated heat maps."""
    if record.mac is None:
        return None
    reference = model_name(record, record.mac.reference)
    panels = [
        mac_panel(found, model_name(record, key), reference)
        for key, found in record.mac.models.items()
        if found.values and found.values[0]
    ]
    return Chart(in_columns(panels, 3), width) if panels else None


def mac_panel(found: MacTable, name: str, reference: str) -> Panel:
    """One matrix, a mode of the model a row."""
    rows = found.rows or [""] * len(found.values)
    columns = found.columns or [""] * len(found.values[0])
    panel = Panel(
        Axis("", (-0.5, len(columns) - 0.5), ticks=_numbered(columns), grid=False),
        Axis("", (len(rows) - 0.5, -0.5), ticks=_numbered(rows), grid=False),
        ROW * len(rows),
        f"{name} (rows) against {reference}",
        left=LONGEST,
        turned=True,
    )
    cells = []
    for i, row in enumerate(found.values):
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
        panel.draw(text | {"fontSize": 10}, _figures(found, white))
    return panel


def _numbered(names: list[str]) -> dict[float, str]:
    return {float(i): name for i, name in enumerate(names)}


def _figures(found: MacTable, white: bool) -> list[dict[str, Any]]:
    """Figures of the dark cells of a map, or of the others; none where there is next to nothing."""
    return [
        {"x": j, "y": i, "text": _mac_text(value)}
        for i, row in enumerate(found.values)
        for j, value in enumerate(row)
        if value is not None and value >= 0.005 and (value > 0.6) == white
    ]


def _blue(value: float) -> str:
    """From nearly white at 0 to dark blue at 1."""
    ends = zip((247, 251, 255), (8, 48, 107))
    return "#" + "".join(f"{round(a + (b - a) * value):02x}" for a, b in ends)


def _mac_text(value: float) -> str:
    """A MAC in four characters; 0.998 must not round to a perfect 1.00."""
    if value >= 0.9995:
        return "1.00"
    return ">.99" if value >= 0.995 else f"{min(value, 0.99):.2f}"
