"""Tables of two trains beside each other, for the page and for terminals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import degrees
from typing import Any

from solidgear.show.beside import band, its, names
from solidgear.show.table import Cell, Column, Table, quantity, text, word
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.words import hertz, percent
from solidgear.strength.deflection.tables import meanings

#: of a share that is shown: less is no place of a mode
LEAST_SHARE = 0.0005


def peaks(pair: Any, units: Units = ENGINEERING) -> Table:
    """Return peaks of the mesh force side by side."""
    columns = [
        text("its mode", lambda p: names(p, "mode")),
        Column("A, Hz", lambda p: its(p.a, "frequency_hz"), hertz),
        Column("B, Hz", lambda p: its(p.b, "frequency_hz"), hertz),
        Column("difference", _shift),
        quantity("A", "N", units, lambda p: its(p.a, "force"), 4),
        quantity("B", "N", units, lambda p: its(p.b, "force"), 4),
        Column("B over A", lambda p: _decibels(p.decibels)),
    ]
    note = "Peaks of the same mode share a row. A dash: no peak in the other train."
    return Table("Peaks of the mesh force", columns, pair.peaks, note, style="ruled")


def _shift(pair: Any) -> str | None:
    if pair.a is None or pair.b is None:
        return None
    return percent(pair.b.frequency_hz / pair.a.frequency_hz - 1)


def _decibels(value: float | None) -> str | None:
    return None if value is None else f"{value:+.1f} dB"


#: what columns of a unit are
KINDS = {
    "N": "forces",
    "N m": "moments",
    "m": "motions",
    "rad": "rotations",
    "m/s²": "accelerations",
}


def largest(
    pair: Any, columns: Sequence[tuple[str, str]], units: Units = ENGINEERING
) -> list[Table]:
    """Return largest amplitudes of columns of the responses, a table for every unit."""
    out = []
    for si, title in KINDS.items():
        dimension = f"{si} moved" if si in ("m", "rad") else si
        rows = [
            (name, *(train.largest(column) for train in pair.both), pair.decibels(column))
            for column, name in columns
            if column.endswith(f" [{si}]")
        ]
        heads: list[Column] = [text("", lambda row: row[0])]
        for k, letter in ((1, "A"), (2, "B")):
            heads.append(quantity(letter, dimension, units, partial(_top, k, 1), 4))
            heads.append(Column(f"{letter}, at Hz", partial(_top, k, 0), hertz))
        heads.append(Column("B over A", lambda row: _decibels(row[3])))
        out.append(Table(f"Largest {title} over frequency", heads, rows))
    return [table for table in out if table]


def _top(k: int, i: int, row: Any) -> float | None:
    return None if row[k] is None else row[k][i]


def shares(trains: Any) -> Table:
    """Return strain energy of every mode by part, A and B in turn."""
    rows = [
        (pair, mode, letter)
        for pair in trains.modes
        for letter, mode in (("A", pair.a), ("B", pair.b))
        if mode is not None
    ]
    places = list(dict.fromkeys(place for _, mode, _ in rows for place in mode.shares))
    columns = [
        text("mode", lambda row: f"{row[2]}: {row[1].name}"),
        Column("Hz", lambda row: row[1].frequency_hz, hertz),
        *(Column(f"{place}, %", partial(_share, place)) for place in places),
    ]
    return Table("Strain energy", columns, rows)


def _share(place: str, row: Any) -> str | None:
    share = row[1].shares.get(place, 0.0)
    return f"{100 * share:.1f}" if share >= LEAST_SHARE else None


def misalignment(pair: Any, units: Units = ENGINEERING) -> Table:
    """Return the misalignment of both trains at rest under load."""
    opens = [{m.name: m.open for m in train.loaded.misalignment} for train in pair.both]
    columns = [
        word("of the axes", lambda row: f"{row[0]}, {units.unit(row[1])}"),
        *(Column(letter, partial(_value, key, units)) for letter, key in (("A", "a"), ("B", "b"))),
        Column("difference", lambda row: _apart(row, units)),
    ]
    rows = pair.misalignment()
    shown_names = {row[0] for row in rows}
    measures = [m for m in pair.a.loaded.misalignment if m.name in shown_names] if rows else []
    note = f"{meanings(measures, units)}."
    if any(change.band is not None for *_, change in rows):
        columns.append(Column("both error bars", lambda row: band(row[3])))
        columns.append(word("", lambda row: row[3].verdict))
        note += " Both error bars: sum of both mesh errors, relative to A."
    for letter, ranges in zip("AB", opens):
        if any(ranges[row[0]] is not None for row in rows):
            columns.append(Column(f"range, {letter}", partial(_range, ranges, units)))
    if any(ranges[row[0]] is not None for row in rows for ranges in opens):
        note += (
            " Range: by estimated insides and classes of clearance of bearings, which both trains "
            "may share."
        )
    return Table("Misalignment", columns, rows, note)


def _value(key: str, units: Units, row: Any) -> str:
    return units.number(getattr(row[3], key), row[1], 3)


def _apart(row: Any, units: Units) -> str | Cell:
    difference = units.number(row[3].difference, row[1], 3)
    return Cell(difference, "unresolved") if row[3].verdict == "not resolved" else difference


def _range(ranges: Any, units: Units, row: Any) -> str | None:
    if ranges[row[0]] is None:
        return None
    low, high = (units.number(v, row[1], 3) for v in ranges[row[0]])
    return f"{low} to {high}"


def bearing_loads(pair: Any, units: Units = ENGINEERING) -> Table:
    """Return loads of all bearings of both trains at rest under load."""
    loads = [
        {f"{s.name}.{b.name}": b for s in train.loaded.shafts for b in s.bearings}
        for train in pair.both
    ]
    columns = [word("bearing", lambda name: name)]
    for title, si, component in (
        ("radial", "N", lambda b: b.radial),
        ("axial", "N", lambda b: float(b.load[1])),
        ("moment", "N m", lambda b: b.moment),
    ):
        for letter, side_loads in zip("AB", loads):
            columns.append(
                quantity(f"{title} {letter}", si, units, partial(_load, side_loads, component), 4)
            )
    for letter, side_loads in zip("AB", loads):
        columns.append(Column(f"radial {letter} at, deg", partial(_azimuth, side_loads)))
    note = (
        "Load of the shaft on the bearing; radial loads act at an angle from x towards z. They have "
        "no error bar."
    )
    return Table("Bearing loads", columns, list(dict.fromkeys([*loads[0], *loads[1]])), note)


def _load(loads: dict[str, Any], component: Callable[[Any], float], name: str) -> float | None:
    return component(loads[name]) if name in loads else None


def _azimuth(loads: dict[str, Any], name: str) -> str | None:
    return f"{degrees(loads[name].azimuth):.0f}" if name in loads else None
