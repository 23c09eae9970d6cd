"""The files of a receptance: a table, its peaks, a chart as PNG and SVG, and a page to read it."""

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
from solidgear.report.train_chart import label, receptance_chart
from solidgear.report.train_files import write_charts
from solidgear.report.train_sheet import write_sheet
from solidgear.report.units import ENGINEERING, Units, units_named

STEM = "receptance"


def write_receptance(
    folder: Path,
    found: Sequence[Any],
    title: str,
    teeth: int,
    notes: Mapping[str, Any],
    train: Mapping[str, Any] | None = None,
    units: str | Units = ENGINEERING,
) -> list[Path]:
    """``receptance.csv`` of the first model, ``receptance.png``, ``receptance.svg`` of all, and
    ``receptance.json`` with the peaks and what else is told; with `train` also the page
    ``receptance.html``.

    Parameters
    ----------
    folder : Path
    found : sequence of TrainReceptance
        Of the same two ends.
    title : str
    teeth : int
        Of the pinion.
    notes : mapping
    train : mapping, optional
        What is known of the train, as plain data.
    units : str or Units
        Of chart and page; all else is SI.

    Returns
    -------
    list of Path
    """
    folder.mkdir(parents=True, exist_ok=True)
    first = found[0]
    files = [folder / f"{STEM}.{kind}" for kind in ("csv", "json")]
    hz, unit, value = first.frequency_hz, first.unit, first.value
    head = ["frequency [Hz]", "pinion speed [rpm]", f"amplitude [{unit}]", "phase [deg]"]
    head += [f"real part [{unit}]", f"imaginary part [{unit}]"]
    polar = [np.abs(value), np.degrees(np.angle(value))]
    rows = np.column_stack([hz, 60 * hz / teeth, *polar, value.real, value.imag])
    with whole(files[0]) as half, half.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(head)
        writer.writerows([f"{v:.9g}" for v in row] for row in rows)
    with whole(files[1]) as half:
        data = {"title": title, "unit": unit, "models": [_plain(one) for one in found], **notes}
        half.write_text(json.dumps(data, indent=1, allow_nan=False), encoding="utf-8")
    shown = units_named(units)

    draw = partial(receptance_chart, found, title, teeth, shown)
    files += write_charts(folder / STEM, draw)
    if train is None:
        return files
    page = write_sheet(
        folder / f"{STEM}.html",
        title,
        f"Steady motion for a unit force, {first.damping} losses; table of {label(first)}.",
        [
            train_tables.peaks(first.peaks, "receptance", unit, teeth, shown),
            train_tables.facts(train, shown),
        ],
        charts={STEM: draw},
        cautions=notes.get("cautions", ()),
    )
    return [page, *files]


def _plain(one: Any) -> dict[str, Any]:
    keys = ("frequency_hz", "amplitude", "mode")
    peaks = [dict(zip(keys, peak)) for peak in one.peaks]
    return {"pinion": one.pinion, "gear": one.gear, "damping": one.damping, "peaks": peaks}
