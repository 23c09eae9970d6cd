"""The files of a response: a table, its chart as PNG and SVG, and a page to read it."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.machine.whole_file import whole
from solidgear.report import train_tables
from solidgear.report.order_chart import order_chart, write_crossings
from solidgear.report.plot import WIDE, Make
from solidgear.report.train_chart import label, response_chart
from solidgear.report.train_sheet import write_sheet
from solidgear.report.units import ENGINEERING, Units, units_named


def write_response(
    folder: Path,
    responses: Sequence[Any],
    title: str,
    teeth: int,
    band: float,
    notes: Mapping[str, Any],
    orders: Any = None,
    train: Mapping[str, Any] | None = None,
    units: str | Units = ENGINEERING,
) -> list[Path]:
    """``response.csv`` of the first response, ``response.png``, ``response.svg`` of all,
    ``response.json`` with peaks and what else is told, and ``orders`` as table and charts; with
    `train`, what is known of it as plain data, also the page ``response.html``.

    Charts and page are in `units`, all else in SI.

    Returns
    -------
    list of Path
    """
    folder.mkdir(parents=True, exist_ok=True)
    files = [folder / name for name in ("response.csv", "response.json")]
    write_table(files[0], responses[0], teeth)
    peaks = [
        {"pinion": r.pinion, "gear": r.gear, "peaks": [vars(p) for p in r.peaks]} for r in responses
    ]
    with whole(files[1]) as half:
        data = {"title": title, "responses": peaks, **notes}
        half.write_text(json.dumps(data, indent=1, allow_nan=False), encoding="utf-8")
    shown = units_named(units)
    charts: dict[str, Make] = {
        "response": partial(response_chart, responses, title, teeth, band, {}, shown)
    }
    if orders is not None:
        write_crossings(folder / "orders.csv", orders)
        files += [folder / "orders.csv"]
        charts["orders"] = partial(order_chart, orders, title, teeth, shown)
    for name, make in charts.items():
        files += write_charts(folder / name, make)
    if train is None:
        return files
    first = responses[0]
    tops = [(p.frequency_hz, p.force, p.mode) for p in first.peaks]
    tables = [train_tables.peaks(tops, "mesh force", "N", teeth, shown, label(first))]
    if orders is not None:
        crossings = [vars(c) for c in orders.crossings]
        tables.append(train_tables.crossings(crossings, shown))
    page = write_sheet(
        folder / "response.html",
        title,
        f"Steady response, {first.damping} losses; tables of {label(first)}.",
        [*tables, train_tables.facts(train, shown)],
        charts=charts,
        cautions=first.cautions,
    )
    return [page, *files]


def write_charts(stem: Path, make: Make) -> list[Path]:
    """A chart as PNG and SVG beside each other."""
    chart = make(WIDE)
    files = [stem.with_suffix(f".{kind}") for kind in ("png", "svg")]
    return [chart.write(file) for file in files] if chart else []


def write_table(path: Path, response: Any, teeth: int) -> None:
    """Amplitude and phase of every column over frequency; the unit stands in brackets."""
    hz = response.frequency_hz
    head, rows = ["frequency [Hz]", "pinion speed [rpm]"], [hz, 60 * hz / teeth]
    for name, value in response.columns.items():
        text, _, unit = name.partition(" [")
        head += [f"{text} [{unit}", f"{text} phase [deg]"]
        rows += [np.abs(value), np.degrees(np.angle(value))]
    with whole(path) as half, half.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(head)
        for line in np.column_stack(rows):
            writer.writerow([f"{v:.9g}" if np.isfinite(v) else "" for v in line])
