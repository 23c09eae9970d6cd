"""Chart of how answers converge: distance from the extrapolated value over size or unknowns."""

from __future__ import annotations

from dataclasses import dataclass

from solidgear.judge.race.pareto import CHARTED
from solidgear.judge.record import BandRecord, LevelRecord, ModelRecord, Record
from solidgear.report.cells import whole_number
from solidgear.report.chart_style import as_svg, new_figure, percent_decades
from solidgear.report.reading import model_name
from solidgear.report.readout import readable
from solidgear.report.words import percent

#: what the meshes differ in -> label of the axis
AXIS = {
    "h": "representative element size h, mm",
    "order": "1 / order of the elements",
    "dofs": "unknowns",
}


@as_svg
def convergence_chart(record: Record):
    """Distance from the extrapolated value over mesh size or unknowns, log-log, with the band and
    both orders.
    """
    panels = []
    for key, model in record.models.items():
        panels += _panels(model_name(record, key), model)
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
    the axis, distance from the extrapolated value, mesh), ascending.
    """

    name: str
    model: ModelRecord
    quantity: str
    along: str
    spots: list[tuple[float, float, LevelRecord]]
    band: BandRecord


def _panels(name: str, model: ModelRecord) -> list[_Panel]:
    """The panels of one model: those of its quantities that two meshes or more distinguish."""
    if model.convergence is None:
        return []
    levels = model.convergence.levels
    along = _distinguished_by(levels)
    panels = []
    for quantity in CHARTED:
        band = model.convergence.quantities.get(quantity, BandRecord())
        if not band.extrapolated:
            continue
        spots = []
        for level in levels:
            place, value = _size(level, along), level.quantities.get(quantity)
            if place is None or value is None:
                continue
            distance = abs(value / band.extrapolated - 1)
            if distance > 0:
                spots.append((_on_axis(along, place), distance, level))
        if len(spots) >= 2:
            panels.append(
                _Panel(name, model, quantity, along, sorted(spots, key=lambda spot: spot[:2]), band)
            )
    return panels


def _size(level: LevelRecord, along: str) -> float | None:
    """What a mesh has along an axis."""
    if along == "h":
        return level.h
    return level.order if along == "order" else level.dofs


def _distinguished_by(levels: list[LevelRecord]) -> str:
    """What the meshes differ in: their size if all have one, else their order, else unknowns."""
    for along in ("h", "order"):
        if levels and all((_size(level, along) or 0) > 0 for level in levels):
            return along
    return "dofs"


def _on_axis(along: str, value: float) -> float:
    """Sizes in mm, orders as their inverse, so that finer is to the left."""
    if along == "order":
        return 1 / value
    return 1e3 * value if along == "h" else value


def _draw(ax, panel: _Panel) -> None:
    xs, ys, levels = zip(*panel.spots)
    colour, band = panel.model.colour, panel.band
    ax.loglog(xs, ys, panel.model.marker + "-", color=colour, ms=6, lw=1.2)
    told = {
        f"{panel.quantity}, from extrapolated": ("", [percent(y, signed=False) for y in ys]),
        "mesh": ("", [str(level.mesh.get("element") or "") for level in levels]),
        "size h": ("mm", [f"{1e3 * level.h:.3g}" if level.h else "" for level in levels]),
        "unknowns": ("", [whole_number(level.dofs) for level in levels]),
    }
    readable(ax, xs, ys, panel.name, told, colour=colour)
    low, high = min(ys) / 3, max(ys) * 3
    if band.gci is not None and band.gci > 0:
        low, high = min(low, band.gci / 3), max(high, band.gci * 2)
        _shade(ax, low, band, colour)
    if band.expected_order is not None and panel.along != "dofs":
        slope = [ys[-1] * (x / xs[-1]) ** band.expected_order for x in xs]
        ax.loglog(xs, slope, color="#888888", lw=0.9, ls=":")
    ax.set_ylim(low, high)
    _log_ticks(ax, xs, [_tick(panel.along, x) for x in xs])
    words = []
    if band.observed_order is not None:
        words.append(f"observed order {band.observed_order:.2f}")
    if band.expected_order is not None:
        words.append(f"expected {band.expected_order:.2f}")
    ax.set_title(f"{panel.name}, {panel.quantity}\n{', '.join(words)}")
    ax.set(xlabel=AXIS[panel.along], ylabel="distance from extrapolated")


def _shade(ax, low: float, band: BandRecord, colour: str) -> None:
    """The band, from the bottom of the panel up."""
    ax.axhspan(low, band.gci, color=colour, alpha=0.12, lw=0)
    ax.axhline(band.gci, color=colour, lw=0.8, ls="--")
    ax.annotate(
        f"band {percent(band.gci, signed=False)}, factor {band.factor}",
        (0.01, band.gci),
        xycoords=("axes fraction", "data"),
        xytext=(0, 2),
        textcoords="offset points",
        ha="left",
        va="bottom",
        fontsize=8,
    )


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
