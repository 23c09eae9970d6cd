"""Chart of how answers converge: distance from the extrapolated value over mesh size or unknowns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from solidgear.report.chart_style import (
    QUANTITY_NAME,
    as_svg,
    colour_of,
    marker_of,
    new_figure,
    percent_decades,
)
from solidgear.report.words import (
    is_number,
    model_name,
    percent,
)

#: what the meshes differ in -> label of the axis
AXIS = {
    "h": "representative element size h, mm",
    "order": "1 / order of the elements",
    "dofs": "unknowns",
}


@as_svg
def convergence_chart(results):
    """Distance from the extrapolated value over mesh size or unknowns, log-log, with the band and
    both orders.
    """
    panels = []
    for key, model in (results.get("models") or {}).items():
        panels += _panels(key, model.get("convergence") or {})
    if not panels:
        return None
    columns = min(len(panels), 2)
    rows = -(-len(panels) // columns)
    figure = new_figure(10.4, 2.9 * rows)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax, panel in zip(axes, panels):
        _draw(ax, panel)
    for ax in axes[len(panels) :]:
        ax.axis("off")
    return figure


@dataclass(frozen=True)
class _Panel:
    """One quantity of one model over its meshes.

    ``along`` is what the meshes differ in: ``h``, ``order`` or ``dofs``; ``spots`` are (place along
    the axis, distance from the extrapolated value), ascending.
    """

    key: str
    quantity: str
    along: str
    spots: list[tuple[float, float]]
    estimate: Mapping


def _panels(key: str, convergence: Mapping) -> list[_Panel]:
    """The panels of one model: those of its quantities that two meshes or more tell apart."""
    levels = convergence.get("levels") or []
    along = _told_apart_by(levels)
    panels = []
    for quantity, column in (("c_zz", "c_zz"), ("bending_1", "bending_1_hz")):
        estimate = convergence.get(quantity) or {}
        limit = estimate.get("extrapolated")
        if not is_number(limit) or limit == 0:
            continue
        known = [v for v in levels if is_number(v.get(along)) and is_number(v.get(column))]
        distances = [(v[along], abs(v[column] / limit - 1)) for v in known]
        spots = [(_on_axis(along, x), y) for x, y in distances if y > 0]
        if len(spots) >= 2:
            panels.append(_Panel(key, quantity, along, sorted(spots), estimate))
    return panels


def _told_apart_by(levels: list[Mapping]) -> str:
    """What tells the meshes apart: their size if all have one, else their order, else unknowns."""
    for along in ("h", "order"):
        if levels and all(is_number(v.get(along)) and v[along] > 0 for v in levels):
            return along
    return "dofs"


def _on_axis(along: str, value: float) -> float:
    """Sizes in mm, orders as their inverse, so that finer is to the left."""
    if along == "order":
        return 1 / value
    return 1e3 * value if along == "h" else value


def _draw(ax, panel: _Panel) -> None:
    xs, ys = zip(*panel.spots)
    colour, estimate = colour_of(panel.key), panel.estimate
    ax.loglog(xs, ys, marker_of(panel.key) + "-", color=colour, ms=6, lw=1.2)
    low, high = min(ys) / 3, max(ys) * 3
    band = estimate.get("gci")
    if is_number(band) and band > 0:
        low, high = min(low, band / 3), max(high, band * 2)
        ax.axhspan(low, band, color=colour, alpha=0.12, lw=0)
        ax.axhline(band, color=colour, lw=0.8, ls="--")
        ax.annotate(
            f"band {percent(band, signed=False)}, factor {estimate.get('factor')}",
            (0.01, band),
            xycoords=("axes fraction", "data"),
            xytext=(0, 2),
            textcoords="offset points",
            ha="left",
            va="bottom",
            fontsize=8,
        )
    expected = estimate.get("expected_order")
    if is_number(expected) and panel.along != "dofs":
        slope = [ys[-1] * (x / xs[-1]) ** expected for x in xs]
        ax.loglog(xs, slope, color="#888888", lw=0.9, ls=":")
    ax.set_ylim(low, high)
    _log_ticks(ax, xs, [_tick(panel.along, x) for x in xs])
    words = []
    for label, key in (("observed order", "observed_order"), ("expected", "expected_order")):
        if is_number(estimate.get(key)):
            words.append(f"{label} {estimate[key]:.2f}")
    title = f"{model_name(panel.key)}, {QUANTITY_NAME[panel.quantity]}"
    ax.set_title(f"{title}\n{', '.join(words)}")
    ax.set(xlabel=AXIS[panel.along], ylabel="distance from extrapolated")


def _tick(along: str, x: float) -> str:
    if along == "order":
        return f"1/{1 / x:.0f}"
    return f"{x:.3g}" if x < 1e4 else f"{x / 1e3:.3g}k"


def _log_ticks(ax, xs, labels) -> None:
    """Ticks at the meshes themselves: three meshes seldom span a decade."""
    from matplotlib.ticker import NullFormatter, NullLocator

    ax.set_xticks(list(xs), labels)
    ax.xaxis.set_minor_locator(NullLocator())
    ax.xaxis.set_minor_formatter(NullFormatter())
    percent_decades(ax)
    ax.set_xlim(min(xs) / 1.25, max(xs) * 1.25)
