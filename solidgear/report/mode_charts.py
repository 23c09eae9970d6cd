"""Charts of the modes: frequencies side by side, and MAC matrices against the reference."""

from __future__ import annotations

from collections.abc import Mapping

from solidgear.judge.record import MacTable, ModelRecord, ModeRecord, Record
from solidgear.report.chart_style import as_svg, legend_columns, new_figure, paper_width
from solidgear.report.reading import model_name, model_of, reference_of, relative_change
from solidgear.report.readout import readable
from solidgear.report.words import hertz, percent

#: in; and how crowded a matrix is on narrow paper, where it has the whole width
WIDTH, ALONE = 10.4, 0.67
#: families of modes along the axis
FAMILIES = {"bending": 0, "axial": 1, "torsion": 2}


@as_svg
def mode_chart(record: Record):
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
    relative = base is not None and len(models) > 1
    if relative:
        figure = new_figure(WIDTH, 5.0)
        axes = list(figure.subplots(2, 1, sharex=True, height_ratios=(3, 2)))
    else:
        figure = new_figure(WIDTH, 3.2)
        axes = [figure.subplots()]
    step = 0.7 / max(len(models), 1)
    for k, key in enumerate(models):
        shift = (k - (len(models) - 1) / 2) * step
        spots = [(i + shift, name) for i, name in enumerate(names) if name in modes[key]]
        model = record.models[key]
        places = [x for x, _ in spots]
        frequencies = [modes[key][name].frequency_hz or 0.0 for _, name in spots]
        _stems(axes[0], model, places, frequencies, label=model_name(record, key))
        compared = base if key != reference and base is not None else {}
        told = _told([name for _, name in spots], modes[key], compared)
        readable(axes[0], places, frequencies, model_name(record, key), told, colour=model.colour)
        if relative and compared:
            shared = [(x, name) for x, name in spots if name in compared]
            told = _told([name for _, name in shared], modes[key], compared)
            at, apart = [x for x, _ in shared], _apart(shared, modes[key], compared)
            _stems(axes[1], model, at, apart)
            readable(axes[1], at, apart, model_name(record, key), told, colour=model.colour)
    axes[0].set(ylabel="frequency, Hz", ylim=(0, None))
    axes[0].legend(
        ncols=legend_columns(4), loc="lower left", bbox_to_anchor=(0, 1.02), borderaxespad=0
    )
    if relative and reference is not None:
        _as_differences(axes[1], record, reference)
    for ax in axes:
        _part_families(ax, [known[name].family for name in names])
    pairs = {name for key in models for name in _pairs(modes[key])}
    axes[-1].set_xticks(
        range(len(names)),
        [name + ("\n(pair)" if name in pairs else "") for name in names],
        rotation=0 if len(names) <= 10 else 40,
        fontsize=8.5,
    )
    axes[-1].set_xlim(-0.6, len(names) - 0.4)
    return figure


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


def _pairs(modes: Mapping[str, ModeRecord]) -> list[str]:
    return [name for name, mode in modes.items() if mode.multiplicity > 1]


def _stems(ax, model: ModelRecord, xs: list, ys: list, **label) -> None:
    ax.vlines(xs, 0, ys, color=model.colour, lw=1.4)
    ax.plot(xs, ys, model.marker, color=model.colour, ms=5, lw=0, **label)


def _apart(
    spots: list[tuple[float, str]],
    own: Mapping[str, ModeRecord],
    reference: Mapping[str, ModeRecord],
) -> list[float]:
    """How far frequencies of one model are from those of the reference, which both have."""
    changes = []
    for _, name in spots:
        change = relative_change(own[name].frequency_hz, reference[name].frequency_hz)
        changes.append(float("nan") if change is None else change)
    return changes


def _told(
    names: list[str], own: Mapping[str, ModeRecord], reference: Mapping[str, ModeRecord]
) -> dict[str, tuple[str, list[str]]]:
    """What is to be read of modes of one model."""
    from_reference = []
    for name in names:
        base = reference[name].frequency_hz if name in reference else None
        from_reference.append(percent(relative_change(own[name].frequency_hz, base), nothing=""))
    return {
        "mode": ("", names),
        "frequency": ("Hz", [hertz(own[name].frequency_hz) for name in names]),
        "from reference": ("", from_reference),
    }


def _as_differences(ax, record: Record, reference: str) -> None:
    from matplotlib.ticker import PercentFormatter

    ax.axhline(0, color=model_of(record, reference).colour, lw=1.2)
    ax.set_ylabel(f"against {model_name(record, reference)}")
    ax.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=None, symbol=" %"))


def _part_families(ax, families: list[str]) -> None:
    """A dotted line wherever the next family of modes begins."""
    ax.grid(axis="x", visible=False)
    for i in range(1, len(families)):
        if families[i] != families[i - 1]:
            ax.axvline(i - 0.5, color="#999999", lw=0.7, ls=":")


@as_svg
def mac_chart(record: Record):
    """MAC matrices against the reference as annotated heat maps."""
    if record.mac is None:
        return None
    models = {key: m for key, m in record.mac.models.items() if m.values and m.values[0]}
    if not models:
        return None
    across = min(len(models), 3)
    rows = -(-len(models) // across)
    widest = max(len(m.values[0]) for m in models.values())
    tallest = max(len(m.values) for m in models.values())
    figure = new_figure(WIDTH, rows * min(max(1.2 + 0.33 * tallest, 2.6), 6.5))
    axes = figure.subplots(rows, across, squeeze=False).ravel()
    size = _text_size(widest * ALONE if paper_width(WIDTH) < WIDTH else widest)
    reference = model_name(record, record.mac.reference)
    for ax, (key, found) in zip(axes, models.items()):
        _draw_mac(ax, found, size, model_name(record, key), reference)
        ax.set_title(f"{model_name(record, key)} (rows) against {reference}", fontsize=8.5)
    for ax in axes[len(models) :]:
        ax.axis("off")
    return figure


def _draw_mac(ax, found: MacTable, size: float, name: str, reference: str) -> None:
    """One matrix, a mode of the model a row; figures of `size` pt in its cells."""
    values = [[float("nan") if v is None else v for v in row] for row in found.values]
    ax.pcolormesh(values, cmap="Blues", vmin=0, vmax=1, edgecolors="white", linewidth=0.5)
    ax.invert_yaxis()
    spots = [(i, j) for i, row in enumerate(values) for j in range(len(row))]
    rows = found.rows or [""] * len(values)
    columns = found.columns or [""] * len(values[0])
    told = {
        "mode": ("", [rows[i] for i, _ in spots]),
        f"against, of the {reference}": ("", [columns[j] for _, j in spots]),
        "MAC": ("", [f"{values[i][j]:.4f}" for i, j in spots]),
    }
    places = [j + 0.5 for _, j in spots], [i + 0.5 for i, _ in spots]
    readable(ax, *places, name, told, colour="#1f5f99")
    for i, row in enumerate(values):
        for j, value in enumerate(row):
            if value >= 0.005:
                ax.text(
                    j + 0.5,
                    i + 0.5,
                    _mac_text(value),
                    ha="center",
                    va="center",
                    fontsize=size,
                    color="white" if value > 0.6 else "#222222",
                )
    ax.set_xticks(
        [j + 0.5 for j in range(len(values[0]))],
        columns,
        rotation=60,
        ha="right",
        rotation_mode="anchor",
        fontsize=7.5,
    )
    ax.set_yticks(
        [i + 0.5 for i in range(len(values))],
        rows,
        fontsize=7.5,
    )
    ax.grid(visible=False)


def _text_size(columns: float) -> float:
    """Size of the figures in a map of so many columns, pt."""
    if columns <= 9:
        return 7.5
    return 6 if columns <= 12 else 5


def _mac_text(value: float) -> str:
    """A MAC in four characters; 0.998 must not round to a perfect 1.00."""
    if value >= 0.9995:
        return "1.00"
    return ">.99" if value >= 0.995 else f"{min(value, 0.99):.2f}"
