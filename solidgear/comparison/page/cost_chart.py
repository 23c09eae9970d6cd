"""Chart of seconds against deviation from the reference, one point a model."""

from __future__ import annotations

from dataclasses import dataclass

from solidgear.comparison.race.pareto import CHARTED
from solidgear.core import Record
from solidgear.core.judge.record import ModelRecord
from solidgear.show.panel import PERCENT, SHAPES, Axis, Panel, readout, tolerance_line
from solidgear.show.plot import WIDE, Chart
from solidgear.show.reading import answer_seconds, headline, is_resolved, model_name, reference_of
from solidgear.show.words import grouped, percent, seconds


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
