"""The files of a response and of a receptance: numbers, charts as PNG and SVG, and a page to read
them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.plain import plain
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
    """Write responses as CSV, JSON, charts and ``response.html``, with orders and measured spectra
    where given.

    Charts and page are in `units`, all else in SI.
    """
    first, chosen_units, shaft = responses[0], units_named(units), train_tables.turned(teeth)
    tables = {"response": over_frequency(first, teeth)}
    charts: dict[str, Make] = {
        "response": partial(response_chart, responses, title, teeth, band, {}, chosen_units)
    }
    shown_tables = [
        train_tables.peaks(first.peaks, "mesh force", "N", teeth, chosen_units, first.label)
    ]
    if housing := train_tables.housing_columns(first):
        charts["housing"] = partial(columns_chart, responses, housing, teeth, chosen_units)
        shown_tables.append(train_tables.housing(first, chosen_units))
    if orders is not None:
        tables["orders"] = crossings(orders, shaft)
        charts["orders"] = partial(order_chart, orders, title, teeth, chosen_units)
        shown_tables.append(train_tables.crossings(orders.crossings, chosen_units, shaft))
    remarks: list[str] = []
    if speed is not None:
        tables["lines"] = speed_tables.all_lines(speed.lines)
        tables["near"] = speed_tables.all_coincidences(speed)
        speed_rows = [speed_tables.coincidences(speed), speed_tables.first_lines(speed.lines)]
        remarks, notes = speed.notes(), {**notes, "at_speed": speed.as_dict()}
        if speed.spectrum is not None:
            tables["peaks"] = speed_tables.measured_file(speed)
            make = partial(measured_chart, speed, first, title, chosen_units)
            charts = {"measured": make, **charts}
            speed_rows = [speed_tables.measured(speed), *speed_rows]
        shown_tables = [*speed_rows, *shown_tables]
    peaks = [{**r.models, "peaks": plain(r.peaks)} for r in responses]
    return write_files(
        folder,
        "response",
        title,
        f"Steady response, {first.damping} losses; tables of {first.label}.",
        [*shown_tables, train_tables.facts(train, chosen_units)],
        {"title": title, "responses": peaks, **notes},
        lines=tables,
        charts=charts,
        notes=remarks,
        cautions=notes.get("cautions", ()),
        verdict=notes["loudest"]["sentences"],
    )


def write_receptance(
    folder: Path,
    receptances: Sequence[Any],
    title: str,
    teeth: float,
    notes: Mapping[str, Any],
    train: Mapping[str, Any],
    units: str | Units = ENGINEERING,
) -> list[Path]:
    """Write receptances as CSV, JSON, charts and ``receptance.html``."""
    first, chosen_units = receptances[0], units_named(units)
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
    charts: dict[str, Make] = {
        "receptance": partial(receptance_chart, receptances, title, teeth, chosen_units)
    }
    data = {
        "title": title,
        "unit": unit,
        "models": [_plain(receptance) for receptance in receptances],
        **notes,
    }
    return write_files(
        folder,
        "receptance",
        title,
        f"Steady motion for a unit force, {first.damping} losses; table of {first.label}.",
        [
            train_tables.peaks(first.peaks, "receptance", unit, teeth, chosen_units),
            train_tables.facts(train, chosen_units),
        ],
        data,
        lines={"receptance": table},
        charts=charts,
        cautions=notes.get("cautions", ()),
    )


def _plain(receptance: Any) -> dict[str, Any]:
    keys = ("frequency_hz", "amplitude", "mode")
    peaks = [dict(zip(keys, peak)) for peak in receptance.peaks]
    return {**receptance.models, "damping": receptance.damping, "peaks": peaks}


def over_frequency(response: Any, teeth: float) -> Table:
    """Return amplitude and phase of every column over frequency, units in brackets."""
    columns = places(response.frequency_hz, teeth)
    for name, value in response.columns.items():
        quantity, _, unit = name.partition(" [")
        columns[f"{quantity} [{unit}"] = np.abs(value)
        columns[f"{quantity} phase [deg]"] = np.degrees(np.angle(value))
    return numbers(columns)


def crossings(orders: Any, of: str = "pinion") -> Table:
    """Return the table of crossings of order lines and natural frequencies, in SI."""
    columns = [
        Column("order", lambda c: c.line),
        Column("mode", lambda c: c.mode),
        Column("frequency [Hz]", lambda c: c.frequency_hz, exact),
        Column(f"{of} speed [rpm]", lambda c: c.rpm, exact),
        Column("mesh force [N]", lambda c: c.force, exact),
    ]
    return Table("", columns, orders.crossings)


def places(hz: np.ndarray, teeth: float) -> dict[str, np.ndarray]:
    """Return columns of frequency and speed."""
    return {"frequency [Hz]": hz, f"{train_tables.turned(teeth)} speed [rpm]": 60 * hz / teeth}
