"""Chart of seconds against deviation from the reference, one point a model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from solidgear.report.chart_style import as_svg, colour_of, marker_of, new_figure, percent_decades
from solidgear.report.words import (
    answer_seconds,
    headline,
    is_number,
    is_resolved,
    model_name,
    reference_of,
)

#: quantity of a panel -> its band in the record of a model
BAND = {"C_zz": "compliance", "bending 1": "bending_1"}


@as_svg
def cost_chart(results):
    """Seconds against deviation from the reference, log-log, one point a model.

    The reference has no deviation; it stands at its own band, hollow, like every deviation that is
    not resolved.
    """
    from matplotlib.ticker import FuncFormatter, NullFormatter

    spots = {quantity: _spots(results, quantity) for quantity in BAND}
    if not any(spots.values()):
        return None
    figure = new_figure(10.4, 3.6)
    tolerance = (results.get("verdict") or {}).get("tolerance")
    if not is_number(tolerance) or tolerance <= 0:
        tolerance = None
    for ax, (quantity, points) in zip(figure.subplots(1, 2), spots.items()):
        for point in points:
            _draw(ax, point)
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
            ax.axhline(tolerance, color="#aa2222", lw=0.9, ls="--")
            ax.annotate(
                f"tolerance {100 * tolerance:.4g} %",
                (0.99, tolerance),
                xycoords=("axes fraction", "data"),
                xytext=(0, 2),
                textcoords="offset points",
                ha="right",
                fontsize=8,
                color="#aa2222",
            )
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

    key: str
    seconds: float
    error: float
    hollow: bool
    rejected: bool
    remarks: tuple[str, ...]


def _spots(results: Mapping, quantity: str) -> list[_Spot]:
    """The models of which both the time and the distance from the reference are known."""
    out = []
    for key, model in (results.get("models") or {}).items():
        total = answer_seconds(model)
        if not is_number(total) or total <= 0:
            continue
        rejected = model.get("valid") is False
        last = ("rejected",) if rejected else ()
        band = (model.get("band") or {}).get(BAND[quantity])
        row = headline(results, key, quantity)
        if key == reference_of(results) and is_number(band) and band > 0:
            out.append(_Spot(key, total, band, True, rejected, ("own band", *last)))
        elif row and is_number(row.get("relative")) and row["relative"] != 0:
            hollow = not is_resolved(row)
            first = ("not resolved",) if hollow else ()
            out.append(_Spot(key, total, abs(row["relative"]), hollow, rejected, first + last))
    return out


def _draw(ax, spot: _Spot) -> None:
    colour = colour_of(spot.key)
    ax.plot(
        [spot.seconds],
        [spot.error],
        "x" if spot.rejected else marker_of(spot.key),
        ms=8,
        color=colour,
        mfc="white" if spot.hollow else colour,
        mew=2 if spot.rejected or spot.hollow else 1,
    )
    remark = f"\n({', '.join(spot.remarks)})" if spot.remarks else ""
    ax.annotate(
        model_name(spot.key) + remark,
        (spot.seconds, spot.error),
        xytext=(9, 0),
        textcoords="offset points",
        ha="left",
        va="center",
        fontsize=8,
    )
