"""Chart of how answers converge: distance from the extrapolated value over size or unknowns."""

from __future__ import annotations

from dataclasses import dataclass

from solidgear.comparison.race.pareto import CHARTED
from solidgear.core import Record
from solidgear.core.judge.record import BarRecord, LevelRecord, ModelRecord
from solidgear.show.panel import PERCENT, SHAPES, Axis, Panel, readout
from solidgear.show.plot import WIDE, Chart, in_columns
from solidgear.show.reading import model_name
from solidgear.show.words import grouped, percent, small

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
        Chart(in_columns([_panel(quantity) for quantity in quantities], 2), width)
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


def _panel(quantity: _Quantity) -> Panel:
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
