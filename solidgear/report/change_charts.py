"""Bar charts of what a change alone does: one assumption switched, or another attachment."""

from __future__ import annotations

from collections.abc import Mapping

from solidgear.report.chart_style import QUANTITY_NAME, as_svg, new_figure
from solidgear.report.words import (
    is_number,
    model_name,
    percent,
)

QUANTITY_COLOUR = {"c_zz": "#1f5f99", "k_zz": "#9db8d2", "bending_1": "#c4541c"}


def _bars(ax, labels: list[str], columns: dict[str, list[float | None]]) -> None:
    """Groups of horizontal bars of relative changes, each with its figure."""
    from matplotlib.ticker import PercentFormatter

    height = 0.8 / max(len(columns), 1)
    sizes = [v for column in columns.values() for v in column if is_number(v)]
    reach = max((abs(v) for v in sizes), default=0) or 1.0
    for k, (name, values) in enumerate(columns.items()):
        shift = (k - (len(columns) - 1) / 2) * height
        spots = [(i + shift, v) for i, v in enumerate(values) if is_number(v)]
        ax.barh(
            [y for y, _ in spots],
            [v for _, v in spots],
            height=height * 0.86,
            color=QUANTITY_COLOUR[name],
            label=QUANTITY_NAME[name],
        )
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
    ax.set_xlim(
        low - 0.22 * reach * (low < 0) - 0.04 * reach,
        high + 0.22 * reach * (high > 0) + 0.04 * reach,
    )
    ax.set_yticks(range(len(labels)), labels)
    ax.set_ylim(len(labels) - 0.5, -0.5)
    ax.grid(axis="y", visible=False)
    ax.xaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))


@as_svg
def cause_chart(results):
    """What each assumption alone changes, as horizontal bars."""
    causes = results.get("causes") or []
    rows = [r for r in causes if any(is_number(r.get(q)) for q in QUANTITY_NAME)]
    if not rows:
        return None
    figure = new_figure(10.4, 0.7 + 0.58 * len(rows))
    ax = figure.subplots()
    columns = {q: [r.get(q) for r in rows] for q in QUANTITY_NAME}
    _bars(ax, [_cause(r) for r in rows], columns)
    ax.set_xlabel("relative change when this alone is switched")
    ax.legend(ncols=3, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1)
    return figure


def _cause(row: Mapping) -> str:
    model = row.get("model")
    name = "beam" if model == "beam" else model_name(model)
    return f"{row.get('cause', '')}, {name}\n({row.get('change', '')})"


@as_svg
def attachment_chart(results):
    """Rigid and section ties against averaged ones, for compliance and first bending."""
    solids = {k: a for k, a in (results.get("attachments") or {}).items() if a and a.get("average")}
    labels = []
    columns: dict[str, list[float | None]] = {"c_zz": [], "bending_1": []}
    for key, ties in solids.items():
        for tie in ("rigid", "section"):
            if not ties.get(tie):
                continue
            labels.append(f"{model_name(key)}\n{tie}")
            for column, value in (("c_zz", "c_zz"), ("bending_1", "bending_1_hz")):
                base, here = ties["average"].get(value), ties[tie].get(value)
                comparable = is_number(base) and base and is_number(here)
                columns[column].append(here / base - 1 if comparable else None)
    if not labels:
        return None
    figure = new_figure(10.4, 0.7 + 0.46 * len(labels))
    ax = figure.subplots()
    _bars(ax, labels, columns)
    ax.set_xlabel("relative to averaged ties of the same model")
    ax.legend(ncols=2, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1)
    return figure
