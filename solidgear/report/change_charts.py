"""Bar charts of what a change alone does: one assumption switched, or another attachment."""

from __future__ import annotations

from solidgear.judge.record import CauseRecord, Record
from solidgear.report.chart_style import as_svg, legend_columns, new_figure, paper_width
from solidgear.report.reading import model_name, relative_change
from solidgear.report.readout import readable
from solidgear.report.words import percent

#: quantity -> colour of its bars
SHOWN = {"C_zz": "#1f5f99", "K_zz": "#9db8d2", "bending 1": "#c4541c"}
#: in; and room for the figure beside a bar, of the longest bar
WIDTH, FIGURES = 10.4, 0.22
#: ways of tying that are held against averaged ones
TIES = ("rigid", "section")


def _bars(ax, labels: list[str], columns: dict[str, list[float | None]]) -> None:
    """Groups of horizontal bars of relative changes, each with its figure."""
    from matplotlib.ticker import PercentFormatter

    height = 0.8 / max(len(columns), 1)
    sizes = [v for column in columns.values() for v in column if v is not None]
    reach = max((abs(v) for v in sizes), default=0) or 1.0
    for k, (name, values) in enumerate(columns.items()):
        shift = (k - (len(columns) - 1) / 2) * height
        spots = [(i + shift, v) for i, v in enumerate(values) if v is not None]
        ax.barh(
            [y for y, _ in spots],
            [v for _, v in spots],
            height=height * 0.86,
            color=SHOWN[name],
            label=name,
        )
        told = {
            "case": (
                "",
                [labels[i].replace("\n", " ") for i, v in enumerate(values) if v is not None],
            ),
            f"change of {name}": ("", [percent(v) for _, v in spots]),
        }
        ys, ends = [y for y, _ in spots], [v for _, v in spots]
        readable(ax, ends, ys, name, told, colour=SHOWN[name])
        for y, v in spots:
            ax.annotate(
                percent(v),
                (v, y),
                xytext=(3 if v >= 0 else -3, 0),
                textcoords="offset points",
                ha="left" if v >= 0 else "right",
                va="center",
                fontsize=7.5,
            )
    ax.axvline(0, color="#444444", lw=0.8)
    low, high = min([*sizes, 0.0]), max([*sizes, 0.0])
    room = FIGURES * reach * WIDTH / paper_width(WIDTH)  # for the figures beside the bars
    ax.set_xlim(
        low - room * (low < 0) - 0.04 * reach,
        high + room * (high > 0) + 0.04 * reach,
    )
    ax.set_yticks(range(len(labels)), labels)
    ax.set_ylim(len(labels) - 0.5, -0.5)
    ax.grid(axis="y", visible=False)
    ax.xaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))


@as_svg
def cause_chart(record: Record):
    """What each assumption alone changes, as horizontal bars."""
    rows = []
    for cause in record.causes:
        if any(cause.quantities.get(name) is not None for name in SHOWN):
            rows.append(cause)
    if not rows:
        return None
    figure = new_figure(WIDTH, 0.7 + 0.58 * len(rows))
    ax = figure.subplots()
    columns = {name: [cause.quantities.get(name) for cause in rows] for name in SHOWN}
    _bars(ax, [_label(record, cause) for cause in rows], columns)
    ax.set_xlabel("relative change when this alone is switched")
    ax.legend(ncols=legend_columns(3), loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1)
    return figure


def _label(record: Record, cause: CauseRecord) -> str:
    return f"{cause.cause}, {model_name(record, cause.model)}\n({cause.change})"


@as_svg
def attachment_chart(record: Record):
    """Rigid and section ties against averaged ones, for compliance and first bending."""
    labels = []
    columns: dict[str, list[float | None]] = {"C_zz": [], "bending 1": []}
    for key, ties in record.attachments.items():
        if "average" not in ties:
            continue
        average = ties["average"].quantities
        for tie in TIES:
            if tie not in ties:
                continue
            own = ties[tie].quantities
            labels.append(f"{model_name(record, key)}\n{tie}")
            for name, column in columns.items():
                column.append(relative_change(own.get(name), average.get(name)))
    if not labels:
        return None
    figure = new_figure(WIDTH, 0.7 + 0.46 * len(labels))
    ax = figure.subplots()
    _bars(ax, labels, columns)
    ax.set_xlabel("relative to averaged ties of the same model")
    ax.legend(ncols=legend_columns(2), loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1)
    return figure
