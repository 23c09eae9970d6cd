"""Bar charts of what a change alone does: one assumption switched, or another attachment."""

from __future__ import annotations

from solidgear.core import Record
from solidgear.core.judge.record import CauseRecord
from solidgear.show.panel import GREY, PERCENT, Axis, Panel, Series, readout, wrapped
from solidgear.show.plot import NARROW, WIDE, Chart
from solidgear.show.reading import model_name, relative_change
from solidgear.show.words import percent

#: quantity -> colour of its bars
SHOWN = {"C_zz": "#1f5f99", "K_zz": "#9db8d2", "bending 1": "#c4541c"}
#: px of a bar; and of the names of cases on a wide and on a narrow page
BAR, NAMES, NARROW_NAMES = 15.0, 260.0, 140.0
#: room for the figure beside a bar, of the longest bar
FIGURES = 0.3
#: ways of tying that are held against averaged ones
TIES = ("rigid", "section")


def _bars(
    labels: list[str], columns: dict[str, list[float | None]], words: str, width: float
) -> Chart | None:
    """Draw groups of horizontal bars of relative changes, each with its figure."""
    sizes = [v for column in columns.values() for v in column if v is not None]
    if not sizes:
        return None
    reach, low, high = max(map(abs, sizes)) or 1.0, min(0.0, *sizes), max(0.0, *sizes)
    room = FIGURES * reach * (1 if width > NARROW else 2.2)
    ends = low - room * (low < 0) - 0.04 * reach, high + room * (high > 0) + 0.04 * reach
    margin = NAMES if width > NARROW else NARROW_NAMES
    names = {float(i): "\n".join(wrapped(name, margin - 10)) for i, name in enumerate(labels)}
    lines = max(name.count("\n") + 1 for name in names.values())
    panel = Panel(
        Axis(words, ends, label=PERCENT),
        Axis("", (len(labels) - 0.5, -0.5), ticks=names, grid=False),
        max(BAR * len(columns) + 6, 15 * lines) * len(labels),
        series={name: Series(colour) for name, colour in SHOWN.items() if name in columns},
        legend={"orient": "top", "direction": "horizontal"},
        left=margin,
    )
    rows = list(_rows(labels, columns))
    panel.draw({"type": "rect", "strokeWidth": 0}, [bar for bar, _ in rows])
    panel.draw({"type": "rule", "color": GREY}, [{"x": 0}])
    for sign, align in ((1, "left"), (-1, "right")):
        figures = [figure for _, figure in rows if (figure["x"] >= 0) == (sign > 0)]
        text = {"type": "text", "align": align, "baseline": "middle", "dx": 3 * sign}
        panel.draw(text, figures)
    return Chart([[panel]], width)


def _rows(labels: list[str], columns: dict[str, list[float | None]]):
    """Return a bar and a figure for every case and quantity."""
    thick = 0.8 / max(len(columns), 1)
    for k, (name, values) in enumerate(columns.items()):
        for i, value in enumerate(values):
            if value is None:
                continue
            y, change = i + (k - (len(columns) - 1) / 2) * thick, percent(value)
            case = labels[i].replace("\n", " ")
            words = readout(name, ("case", case, ""), (f"change of {name}", change, ""))
            bar = {"x": 0.0, "x2": value, "y": y - 0.43 * thick, "y2": y + 0.43 * thick}
            yield {**bar, "name": name, "readout": words}, {"x": value, "y": y, "text": change}


def cause_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart changes by each assumption alone, as horizontal bars."""
    causes = [c for c in record.causes if any(c.quantities.get(q) is not None for q in SHOWN)]
    columns = {name: [cause.quantities.get(name) for cause in causes] for name in SHOWN}
    labels = [_label(record, cause) for cause in causes]
    return _bars(labels, columns, "relative change when only this is switched", width)


def _label(record: Record, cause: CauseRecord) -> str:
    return f"{cause.cause}, {model_name(record, cause.model)}\n({cause.change})"


def attachment_chart(record: Record, width: float = WIDE) -> Chart | None:
    """Chart rigid and section ties against averaged ones, for compliance and first bending."""
    labels = []
    columns: dict[str, list[float | None]] = {"C_zz": [], "bending 1": []}
    for key, ties in record.attachments.items():
        if "average" not in ties:
            continue
        average = ties["average"].quantities
        for tie in TIES:
            if tie not in ties:
                continue
            quantities = ties[tie].quantities
            labels.append(f"{model_name(record, key)}\n{tie}")
            for name, column in columns.items():
                column.append(relative_change(quantities.get(name), average.get(name)))
    return _bars(labels, columns, "relative to averaged ties of the same model", width)
