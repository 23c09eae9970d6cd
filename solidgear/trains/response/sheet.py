"""Sheets of a response and of a receptance: sentences, tables, charts and files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from solidgear.core import Sheeted, listed
from solidgear.core.plain import plain
from solidgear.show.command import caution
from solidgear.show.plot import Make
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import Cell, Column, Table, numbers, text
from solidgear.show.units import Units, in_ascii
from solidgear.show.words import DASH, hertz, whole
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.orders import OrderMap
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.assembly.tooth_stiffness import of_teeth
from solidgear.trains.judge.comparison import train_data
from solidgear.trains.modes.modes import unpublished_lines
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.chart import columns_chart, receptance_chart, response_chart
from solidgear.trains.page.files import crossings, over_frequency, places
from solidgear.trains.response.at_speed import AtSpeed, Line, MeasuredPeak
from solidgear.trains.response.loudest import Loudest
from solidgear.trains.response.measured_chart import measured_chart
from solidgear.trains.response.order_chart import order_chart
from solidgear.trains.response.receptance import TrainReceptance
from solidgear.trains.response.response import TrainResponse
from solidgear.trains.response.spectrum import Spectrum

#: rows of tables on a terminal
MOST, MOST_NEAR = 30, 10
#: what charts say
WORDS = {
    "response": "Dynamic mesh force and transmission error of each model.",
    "orders": (
        "Orders of the mesh and of {0} shafts over the speed of the {1}, and the natural "
        "frequencies they meet. Colour: mesh force along orders of the transmission error."
    ),
    "housing": (
        "Loads on the mounts of the housing and accelerations of its points, over all three "
        "directions."
    ),
    "measured": (
        "The measured spectrum, its peaks named by their orders at this speed, above the computed "
        "mesh force. Grey lines: natural frequencies."
    ),
}


@dataclass(frozen=True, eq=False, repr=False)
class Responses(Sheeted):
    """Responses of a train by several mixes of models, and what the first one meets."""

    sheeted: ClassVar[str] = "trains.response.sheet:response_sheet"

    assembly: Assembly
    title: str
    teeth: float  #: of the mesh that drives the train
    responses: Sequence[TrainResponse]
    loudest: Loudest
    orders: OrderMap | None  #: None where a force on a port drives the train
    speed: AtSpeed | None


def response_sheet(result: Responses, units: Units) -> Sheet:
    """Return the sheet of the response of a train."""
    first, teeth, title, speed = result.responses[0], result.teeth, result.title, result.speed
    shaft, unpublished = train_tables.turned(teeth), result.assembly.train.unpublished()
    slips = unit_slips(result.assembly)
    lines = {"response": over_frequency(first, teeth)}
    band = result.assembly.train.ask.decibels
    charts: dict[str, Make] = {
        "response": partial(response_chart, result.responses, title, teeth, band, {}, units)
    }
    tops = [(p.frequency_hz, p.force, p.mode) for p in first.peaks]
    tables = [train_tables.peaks(tops, "mesh force", "N", teeth, units, first.label, first.bars)]
    printed = _peaks_or_none(tops, "mesh force", "N", teeth, units, first.bars)
    if housing := train_tables.housing_columns(first.columns):
        charts["housing"] = partial(columns_chart, result.responses, housing, teeth, units)
        tables.append(train_tables.housing(first, units))
    if result.orders is not None:
        lines["orders"] = crossings(result.orders, shaft)
        charts["orders"] = partial(order_chart, result.orders, title, teeth, units)
        tables.append(train_tables.crossings(result.orders.crossings, units, shaft))
    data: dict[str, Any] = {
        "title": title,
        "responses": [
            {**r.models, "peaks": plain(r.peaks), "bars": r.bars} for r in result.responses
        ],
        "damping": first.damping,
        "unpublished": unpublished,
        "cautions": [*slips, *first.cautions],
        "loudest": result.loudest.as_dict(),
    }
    if speed is not None:
        data["at_speed"] = speed.as_dict()
        lines |= {"lines": every_line(speed.lines), "near": every_coincidence(speed)}
        tables = [coincidences(speed), first_lines(speed.lines), *tables]
        near = coincidences(speed, MOST_NEAR)
        printed += [first_lines(speed.lines), near or f"{near.title}: none."]
        if speed.spectrum is not None:
            lines["peaks"] = every_peak(speed, speed.spectrum)
            chart = partial(measured_chart, speed, speed.spectrum, first, title, units)
            charts = {"measured": chart, **charts}
            tables = [measured(speed, speed.spectrum), *tables]
            peaks = measured(speed, speed.spectrum, MOST)
            printed.append(peaks or f"{peaks.title}: none stands out of the noise.")
    notes = [] if speed is None else speed.notes()
    shafts = "both" if len(result.assembly.train.shafts) == 2 else "all"
    return Sheet(
        name="response",
        title=title,
        lead=f"Steady response, {first.damping} losses; tables of {first.label}.",
        tables=[*tables, train_tables.facts(train_data(result.assembly), units)],
        data=data,
        charts=charts,
        lines=lines,
        verdict=result.loudest.sentences(),
        notes=notes,
        cautions=data["cautions"],
        terminal=Terminal(
            heading=[
                f"{title}: {first.label}, {first.damping} losses",
                *result.loudest.sentences(),
                *map(caution, slips),
            ],
            tables=printed,
            results=(),
            closing=[
                *notes,
                *map(in_ascii, of_teeth(result.assembly, units)),
                *unpublished_lines(unpublished),
                *map(caution, first.cautions),
            ],
            lines="whole",
        ),
        words={**WORDS, "orders": WORDS["orders"].format(shafts, shaft)},
    )


@dataclass(frozen=True, eq=False, repr=False)
class Receptances(Sheeted):
    """Receptances of a train by several mixes of models."""

    sheeted: ClassVar[str] = "trains.response.sheet:receptance_sheet"

    assembly: Assembly
    receptances: Sequence[TrainReceptance]
    teeth: float  #: of the mesh whose speeds are shown


def receptance_sheet(result: Receptances, units: Units) -> Sheet:
    """Return the sheet of the receptance between two ports of a train, by several mixes of models."""
    assembly, receptances, teeth = result.assembly, result.receptances, result.teeth
    first = receptances[0]
    unit, value, damping = first.unit, first.value, first.damping
    from_, to = ":".join(first.from_), ":".join(first.to)
    title = f"{assembly.train.called}: {to} for a unit force on {from_}"
    unpublished, slips = assembly.train.unpublished(), unit_slips(assembly)
    said = assembly.cautions(*first.models.values())
    cautions = [*slips, *said]
    keys = ("frequency_hz", "amplitude", "mode")
    models = [
        {**r.models, "damping": r.damping, "peaks": [dict(zip(keys, peak)) for peak in r.peaks]}
        for r in receptances
    ]
    columns = {
        **places(first.frequency_hz, teeth),
        f"amplitude [{unit}]": np.abs(value),
        "phase [deg]": np.degrees(np.angle(value)),
        f"real part [{unit}]": value.real,
        f"imaginary part [{unit}]": value.imag,
    }
    return Sheet(
        name="receptance",
        title=title,
        lead=f"Steady motion for a unit force, {damping} losses; table of {first.label}.",
        tables=[
            train_tables.peaks(first.peaks, "receptance", unit, teeth, units),
            train_tables.facts(train_data(assembly), units),
        ],
        data={
            "title": title,
            "unit": unit,
            "models": models,
            "from": from_,
            "to": to,
            "unpublished": unpublished,
            "cautions": cautions,
        },
        charts={"receptance": partial(receptance_chart, receptances, title, teeth, units)},
        lines={"receptance": numbers(columns, axes=1)},
        cautions=cautions,
        terminal=Terminal(
            heading=[f"{title}; {first.label}, {damping} losses", *map(caution, slips)],
            tables=_peaks_or_none(first.peaks, "receptance", unit, teeth, units),
            closing=[
                *map(in_ascii, of_teeth(assembly, units)),
                *unpublished_lines(unpublished),
                *map(caution, said),
            ],
            lines="whole",
        ),
        words={"receptance": "Amplitude and phase of the receptance of every model."},
    )


def _peaks_or_none(
    tops: Sequence[tuple[float, float, str]],
    name: str,
    si: str,
    teeth: float,
    units: Units,
    bars: Mapping[str, float] = MappingProxyType({}),
) -> list[Table | str]:
    """Return peaks (Hz, size in an SI unit, mode) for a terminal, or that there is none."""
    table = train_tables.peaks(tops, name, si, teeth, units, bars=bars)
    return [table or f"{table.title}: none in this range."]


def first_lines(lines: Sequence[Line]) -> Table:
    """Return first harmonics of all shafts, meshes and bearings."""
    first = [line for line in lines if line.kind != "sideband" and line.name.endswith(" 1")]
    bars = [(None, None) if line.exact else (line.low_hz, line.high_hz) for line in first]
    rows = [
        [line.name.removesuffix(" 1"), line.frequency_hz, low, high]
        for line, (low, high) in zip(first, bars)
    ]
    heads = [text("order"), *(Column(h, write=hertz, unit="Hz") for h in ("Hz", "from", "to"))]
    return Table("First orders at this speed", heads, rows, style="ruled")


def every_line(lines: Sequence[Line]) -> Table:
    """Return every order with its error bar and formula, in SI, for a file."""
    return numbers(
        {
            "kind": [line.kind for line in lines],
            "order": [line.name for line in lines],
            "frequency [Hz]": [line.frequency_hz for line in lines],
            "from [Hz]": [line.low_hz for line in lines],
            "to [Hz]": [line.high_hz for line in lines],
            "source": [line.source for line in lines],
        }
    )


def coincidences(speed: AtSpeed, most: int | None = None) -> Table:
    """Return orders near natural frequencies, meshes and shafts before sidebands; the first
    `most`.
    """
    heads = [
        text("order"),
        Column("Hz", write=hertz),
        text("mode"),
        Column("Hz of it", write=hertz, name="frequency of the mode", unit="Hz"),
        Column("off, %", name="off", unit="1"),
        Column(f"meet at {speed.shaft} rpm", write=whole, name="speed", unit="rpm"),
    ]
    rows = [
        [
            near.line,
            near.line_hz,
            near.mode,
            near.mode_hz,
            Cell(near.off, "", f"{100 * near.off:+.1f}"),
            near.rpm,
        ]
        for near in speed.coincidences[:most]
    ]
    title = f"Orders within {100 * speed.within:g} % of a natural frequency"
    more = len(speed.coincidences) - len(rows)
    note = f"{more} more, sidebands and bearings last, are in near.csv." if more else ""
    return Table(title, heads, rows, note, style="ruled")


def every_coincidence(speed: AtSpeed) -> Table:
    """Return all orders near natural frequencies, in SI, for a file."""
    near = speed.coincidences
    return numbers(
        {
            "order": [pair.line for pair in near],
            "frequency [Hz]": [pair.line_hz for pair in near],
            "mode": [pair.mode for pair in near],
            "frequency of the mode [Hz]": [pair.mode_hz for pair in near],
            "off [1]": [pair.off for pair in near],
            f"{speed.shaft} speed where they meet [rpm]": [pair.rpm for pair in near],
        }
    )


def measured(speed: AtSpeed, spectrum: Spectrum, most: int | None = None) -> Table:
    """Return measured peaks with their orders by frequency; the `most` largest alone."""
    largest = sorted(speed.peaks, key=lambda peak: -peak.amplitude)[:most]
    heads = [
        Column("Hz", write=hertz),
        Column(
            f"amplitude, {spectrum.unit or 'unit not given'}",
            name="amplitude",
            unit=spectrum.unit,
        ),
        text("order"),
        Column("Hz of it", name="frequency of the order", unit="Hz"),
        text("also"),
    ]
    rows = [_peak_row(peak) for peak in sorted(largest, key=lambda peak: peak.frequency_hz)]
    more = len(speed.peaks) - len(rows)
    note = f"The {len(rows)} largest; {more} more are in peaks.csv." if more else ""
    return Table(f"Peaks of {spectrum.name}", heads, rows, note, style="ruled")


def _peak_row(peak: MeasuredPeak) -> list[Any]:
    order = Cell(peak.name, "" if peak.line else "quiet")
    place, also = peak.line and peak.line.place, listed(peak.others, 2) or DASH
    height = Cell(peak.amplitude, "", f"{peak.amplitude:.4g}")
    return [peak.frequency_hz, height, order, place, also]


def every_peak(speed: AtSpeed, spectrum: Spectrum) -> Table:
    """Return every measured peak with its orders, for a file."""
    peaks, lines = speed.peaks, [peak.line for peak in speed.peaks]
    unit = f" [{spectrum.unit}]" if spectrum.unit else ""
    return numbers(
        {
            "frequency [Hz]": [peak.frequency_hz for peak in peaks],
            f"amplitude{unit}": [peak.amplitude for peak in peaks],
            "order": [peak.name for peak in peaks],
            "order [Hz]": [line.frequency_hz if line else None for line in lines],
            "from [Hz]": [line.low_hz if line else None for line in lines],
            "to [Hz]": [line.high_hz if line else None for line in lines],
            "others": ["; ".join(peak.others) for peak in peaks],
        }
    )
