"""Chart of seconds against deviation from the reference, one point a model."""

from __future__ import annotations

from dataclasses import dataclass

from solidgear.judge.race.pareto import CHARTED
from solidgear.judge.record import ModelRecord, Record
from solidgear.report.cells import whole_number
from solidgear.report.chart_style import as_svg, new_figure, percent_decades, tolerance_line
from solidgear.report.reading import (
    answer_seconds,
    headline,
    is_resolved,
    model_name,
    reference_of,
)
from solidgear.report.readout import readable
from solidgear.report.words import percent, seconds


@as_svg
def cost_chart(record: Record):
    """Seconds against deviation from the reference, log-log, one point a model.

    The reference has no deviation; it stands at its own band, hollow, like every deviation that is
    not resolved.
    """
    from matplotlib.ticker import FuncFormatter, NullFormatter

    spots = {quantity: _spots(record, quantity) for quantity in CHARTED}
    if not any(spots.values()):
        return None
    figure = new_figure(10.4, 3.6)
    tolerance = record.verdict.tolerance
    if tolerance is not None and tolerance <= 0:
        tolerance = None
    for ax, (quantity, points) in zip(figure.subplots(1, 2), spots.items()):
        for point in points:
            _draw(ax, point, quantity)
        ax.set(
            xscale="log",
            yscale="log",
            xlabel="building and solving, s",
            ylabel=f"{quantity}: distance from reference",
        )
        ax.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
        ax.xaxis.set_minor_formatter(NullFormatter())
        percent_decades(ax)
        if tolerance is not None:
            tolerance_line(ax, tolerance, lw=0.9, ls="--")
        if points:
            times, errors = [p.seconds for p in points], [p.error for p in points]
            if tolerance is not None:
                errors.append(tolerance)
            ax.set_xlim(min(times) / 3, max(times) * 15)  # room for the last label
            ax.set_ylim(min(errors) / 2.5, max(errors) * 5)
    return figure


@dataclass(frozen=True)
class _Spot:
    """One model in one panel: a hollow marker is a band and no deviation."""

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
    """The models of which both the time and the distance from the reference are known."""
    out = []
    for key, model in record.models.items():
        total = answer_seconds(model)
        if total is None or total <= 0:
            continue
        name = model_name(record, key)
        band = _own_band(model, quantity) if key == reference_of(record) else None
        row = headline(record, key, quantity)
        if band:
            out.append(_Spot(name, model, total, band, True, "own band"))
        elif row is not None and row.relative:
            hollow = not is_resolved(row)
            remark = "not resolved" if hollow else ""
            out.append(_Spot(name, model, total, abs(row.relative), hollow, remark))
    return out


def _own_band(model: ModelRecord, quantity: str) -> float | None:
    """The band of a quantity, for compliances that of the worst; None where there is none."""
    if model.band is None:
        return None
    band = model.band.each.get(quantity)
    if quantity.startswith("C_"):
        band = model.band.compliance
    return band if band is not None and band > 0 else None


def _draw(ax, spot: _Spot, quantity: str) -> None:
    colour = spot.model.colour
    ax.plot(
        [spot.seconds],
        [spot.error],
        "x" if spot.rejected else spot.model.marker,
        ms=8,
        color=colour,
        mfc="white" if spot.hollow else colour,
        mew=2 if spot.rejected or spot.hollow else 1,
    )
    remarks = [spot.remark] if spot.remark else []
    if spot.rejected:
        remarks.append("rejected")
    told = {
        f"{quantity}, from reference": ("", [percent(spot.error, signed=False)]),
        "building and solving": ("s", [seconds(spot.seconds)]),
        "unknowns": ("", [whole_number(spot.model.dofs)]),
        "remark": ("", [", ".join(remarks)]),
    }
    readable(ax, [spot.seconds], [spot.error], spot.name, told, colour=colour)
    remark = f"\n({', '.join(remarks)})" if remarks else ""
    ax.annotate(
        spot.name + remark,
        (spot.seconds, spot.error),
        xytext=(9, 0),
        textcoords="offset points",
        ha="left",
        va="center",
        fontsize=8,
    )
