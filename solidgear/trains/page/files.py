"""The files of a response and of a receptance: numbers, charts as PNG and SVG, and a page to read
them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.show import speed_tables
from solidgear.show.plot import Make
from solidgear.show.sheet_files import write_files
from solidgear.show.table import Column, Table, exact, numbers
from solidgear.show.units import ENGINEERING, Units, units_named
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.chart import columns_chart, receptance_chart, response_chart
from solidgear.trains.response.measured_chart import measured_chart
from solidgear.trains.response.order_chart import order_chart


def write_response(
    folder: Path,
    responses: Sequence[Any],
    title: str,
    teeth: float,
    band: float,
    notes: Mapping[str, Any],
    orders: Any,
    train: Mapping[str, Any],
    units: str | Units = ENGINEERING,
    speed: Any = None,
) -> list[Path]:
    """``response.csv`` of the first response, ``response.png``, ``response.svg`` of all,
    ``response.json`` with peaks and what else is told, and the page ``response.html``, for which
    `train` is what is known of it as plain data; with `orders` these as table and charts; with
    `speed`, an :class:`solidgear.trains.response.at_speed.AtSpeed`, ``lines.csv`` and ``near.csv``, and
    of a measured spectrum ``peaks.csv`` and the chart ``measured``.

    Charts and page are in `units`, all else in SI.
    """
    first, shown, of = responses[0], units_named(units), train_tables.turned(teeth)
    tables = {"response": over_frequency(first, teeth)}
    charts: dict[str, Make] = {
        "response": partial(response_chart, responses, title, teeth, band, {}, shown)
    }
    tops = [(p.frequency_hz, p.force, p.mode) for p in first.peaks]
    told = [train_tables.peaks(tops, "mesh force", "N", teeth, shown, first.label)]
    if beside := train_tables.housing_columns(first):
        charts["housing"] = partial(columns_chart, responses, beside, teeth, shown)
        told.append(train_tables.housing(first, shown))
    if orders is not None:
        tables["orders"] = crossings(orders, of)
        charts["orders"] = partial(order_chart, orders, title, teeth, shown)
        told.append(train_tables.crossings([vars(c) for c in orders.crossings], shown, of))
    remarks: list[str] = []
    if speed is not None:
        tables["lines"] = speed_tables.all_lines(speed.lines)
        tables["near"] = speed_tables.all_coincidences(speed)
        found = [speed_tables.coincidences(speed), speed_tables.first_lines(speed.lines)]
        remarks, notes = speed.notes(), {**notes, "at_speed": speed.as_dict()}
        if speed.spectrum is not None:
            tables["peaks"] = speed_tables.measured_file(speed)
            make = partial(measured_chart, speed, first, title, shown)
            charts = {"measured": make, **charts}
            found = [speed_tables.measured(speed), *found]
        told = [*found, *told]
    peaks = [{**r.models, "peaks": [vars(p) for p in r.peaks]} for r in responses]
    return write_files(
        folder,
        "response",
        title,
        f"Steady response, {first.damping} losses; tables of {first.label}.",
        [*told, train_tables.facts(train, shown)],
        {"title": title, "responses": peaks, **notes},
        lines=tables,
        charts=charts,
        notes=remarks,
        cautions=notes.get("cautions", ()),
        verdict=notes["loudest"]["sentences"],
    )


def write_receptance(
    folder: Path,
    found: Sequence[Any],
    title: str,
    teeth: float,
    notes: Mapping[str, Any],
    train: Mapping[str, Any],
    units: str | Units = ENGINEERING,
) -> list[Path]:
    """``receptance.csv`` of the first model and ``receptance.json`` with the peaks and what else is
    told in SI, ``receptance.png``, ``receptance.svg`` and the page ``receptance.html`` of all in
    `units`. `train` is what is known of the train as plain data.
    """
    first, shown = found[0], units_named(units)
    unit, value = first.unit, first.value
    table = numbers(
        {
            **places(first.frequency_hz, teeth),
            f"amplitude [{unit}]": np.abs(value),
            "phase [deg]": np.degrees(np.angle(value)),
            f"real part [{unit}]": value.real,
            f"imaginary part [{unit}]": value.imag,
        }
    )
    charts: dict[str, Make] = {"receptance": partial(receptance_chart, found, title, teeth, shown)}
    data = {"title": title, "unit": unit, "models": [_plain(one) for one in found], **notes}
    return write_files(
        folder,
        "receptance",
        title,
        f"Steady motion for a unit force, {first.damping} losses; table of {first.label}.",
        [
            train_tables.peaks(first.peaks, "receptance", unit, teeth, shown),
            train_tables.facts(train, shown),
        ],
        data,
        lines={"receptance": table},
        charts=charts,
        cautions=notes.get("cautions", ()),
    )


def _plain(one: Any) -> dict[str, Any]:
    keys = ("frequency_hz", "amplitude", "mode")
    peaks = [dict(zip(keys, peak)) for peak in one.peaks]
    return {**one.models, "damping": one.damping, "peaks": peaks}


def over_frequency(response: Any, teeth: float) -> Table:
    """Amplitude and phase of every column over frequency; the unit stands in brackets."""
    columns = places(response.frequency_hz, teeth)
    for name, value in response.columns.items():
        what, _, unit = name.partition(" [")
        columns[f"{what} [{unit}"] = np.abs(value)
        columns[f"{what} phase [deg]"] = np.degrees(np.angle(value))
    return numbers(columns)


def crossings(orders: Any, of: str = "pinion") -> Table:
    """Table of crossings of order lines and natural frequencies, in SI."""
    columns = [
        Column("order", lambda c: c.line),
        Column("mode", lambda c: c.mode),
        Column("frequency [Hz]", lambda c: c.frequency_hz, exact),
        Column(f"{of} speed [rpm]", lambda c: c.rpm, exact),
        Column("mesh force [N]", lambda c: c.force, exact),
    ]
    return Table("", columns, orders.crossings)


def places(hz: np.ndarray, teeth: float) -> dict[str, np.ndarray]:
    """Columns of frequency and speed."""
    return {"frequency [Hz]": hz, f"{train_tables.turned(teeth)} speed [rpm]": 60 * hz / teeth}
