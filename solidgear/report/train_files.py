"""The files of a response: a table, and its chart as PNG and SVG."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.machine.whole_file import whole
from solidgear.report.order_chart import order_figure, write_crossings
from solidgear.report.train_chart import response_figure


def write_response(
    folder: Path,
    responses: Sequence[Any],
    title: str,
    teeth: int,
    band: float,
    notes: Mapping[str, Any],
    orders: Any = None,
) -> list[Path]:
    """``response.csv`` of the first response, ``response.png``, ``response.svg`` of all,
    ``response.json`` with peaks and what else is told, and ``orders`` as table and charts.

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
    with whole(files[1]) as partial:
        data = {"title": title, "responses": peaks, **notes}
        partial.write_text(json.dumps(data, indent=1, allow_nan=False), encoding="utf-8")
    files += write_charts(folder / "response", response_figure(responses, title, teeth, band, {}))
    if orders is not None:
        write_crossings(folder / "orders.csv", orders)
        files += [folder / "orders.csv"]
        files += write_charts(folder / "orders", order_figure(orders, title, teeth))
    return files


def write_charts(stem: Path, figure: Any) -> list[Path]:
    """A figure as PNG and SVG beside each other."""
    files = [stem.with_suffix(f".{kind}") for kind in ("png", "svg")]
    for target in files:
        with whole(target) as partial:
            figure.savefig(partial, format=target.suffix[1:], dpi=150)
    return files


def write_table(path: Path, response: Any, teeth: int) -> None:
    """Amplitude and phase of every column over frequency; the unit stands in brackets."""
    hz = response.frequency_hz
    head, rows = ["frequency [Hz]", "pinion speed [rpm]"], [hz, 60 * hz / teeth]
    for name, value in response.columns.items():
        text, _, unit = name.partition(" [")
        head += [f"{text} [{unit}", f"{text} phase [deg]"]
        rows += [np.abs(value), np.degrees(np.angle(value))]
    with whole(path) as partial, partial.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(head)
        for line in np.column_stack(rows):
            writer.writerow([f"{v:.9g}" if np.isfinite(v) else "" for v in line])
