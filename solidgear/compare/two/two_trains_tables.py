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


def peaks(found: Any, units: Units = ENGINEERING) -> Table:
    """Peaks of the mesh force side by side."""
    columns = [
        text("mode that makes it", lambda p: names(p, "mode")),
        Column("A, Hz", lambda p: its(p.a, "frequency_hz"), hertz),
        Column("B, Hz", lambda p: its(p.b, "frequency_hz"), hertz),
        Column("difference", _shift),
        quantity("A", "N", units, lambda p: its(p.a, "force"), 4),
        quantity("B", "N", units, lambda p: its(p.b, "force"), 4),
        Column("B over A", lambda p: _decibels(p.decibels)),
    ]
    note = "Peaks of one mode stand in one row. A dash: no peak there in the other train."
    return Table("Peaks of the mesh force", columns, found.peaks, note, style="ruled")


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
    found: Any, columns: Sequence[tuple[str, str]], units: Units = ENGINEERING
) -> list[Table]:
    """Largest amplitudes of columns of the responses, each by its name with the unit and what it is
    called; a table for every unit.
    """
    out = []
    for si, title in KINDS.items():
        shown = f"{si} moved" if si in ("m", "rad") else si
        rows = [
            (name, *(one.largest(column) for one in found.both), found.decibels(column))
            for column, name in columns
            if column.endswith(f" [{si}]")
        ]
        heads: list[Column] = [text("", lambda row: row[0])]
        for k, letter in ((1, "A"), (2, "B")):
            heads.append(quantity(letter, shown, units, partial(_top, k, 1), 4))
            heads.append(Column(f"{letter}, at Hz", partial(_top, k, 0), hertz))
        heads.append(Column("B over A", lambda row: _decibels(row[3])))
        out.append(Table(f"Largest {title} over frequency", heads, rows))
    return [table for table in out if table]


def _top(k: int, i: int, row: Any) -> float | None:
    return None if row[k] is None else row[k][i]


def shares(found: Any) -> Table:
    """Strain energy of every mode by what it is in, A and B in turn."""
    rows = [
        (pair, one, letter)
        for pair in found.modes
        for letter, one in (("A", pair.a), ("B", pair.b))
        if one is not None
    ]
    places = list(dict.fromkeys(place for _, one, _ in rows for place in one.shares))
    columns = [
        text("mode", lambda row: f"{row[2]}: {row[1].name}"),
        Column("Hz", lambda row: row[1].frequency_hz, hertz),
        *(Column(f"{place}, %", partial(_share, place)) for place in places),
    ]
    return Table("Strain energy", columns, rows)


def _share(place: str, row: Any) -> str | None:
    share = row[1].shares.get(place, 0.0)
    return f"{100 * share:.1f}" if share >= LEAST_SHARE else None


def misalignment(found: Any, units: Units = ENGINEERING) -> Table:
    """Misalignment of both trains at rest under load."""
    opens = [{m.name: m.open for m in one.loaded.misalignment} for one in found.both]
    columns = [
        word("of the axes", lambda row: f"{row[0]}, {units.unit(row[1])}"),
        *(Column(letter, partial(_value, key, units)) for letter, key in (("A", "a"), ("B", "b"))),
        Column("difference", lambda row: _apart(row, units)),
    ]
    told = found.misalignment()
    shown = {row[0] for row in told}
    both = [m for m in found.a.loaded.misalignment if m.name in shown] if told else []
    note = f"{meanings(both, units)}."
    if any(change.band is not None for *_, change in told):
        columns.append(Column("both bars", lambda row: band(row[3])))
        columns.append(word("", lambda row: row[3].verdict))
        note += " Both bars: the sum of what the meshes of both leave, relative to A."
    for letter, ranges in zip("AB", opens):
        if any(ranges[row[0]] is not None for row in told):
            columns.append(Column(f"left open, {letter}", partial(_range, ranges, units)))
    if any(ranges[row[0]] is not None for row in told for ranges in opens):
        note += (
            " Left open: by estimated insides and classes of clearance of bearings, which both trains "
            "may share."
        )
    return Table("Misalignment", columns, told, note)


def _value(key: str, units: Units, row: Any) -> str:
    return units.number(getattr(row[3], key), row[1], 3)


def _apart(row: Any, units: Units) -> str | Cell:
    told = units.number(row[3].difference, row[1], 3)
    return Cell(told, "unresolved") if row[3].verdict == "not resolved" else told


def _range(ranges: Any, units: Units, row: Any) -> str | None:
    if ranges[row[0]] is None:
        return None
    low, high = (units.number(v, row[1], 3) for v in ranges[row[0]])
    return f"{low} to {high}"


def bearing_loads(found: Any, units: Units = ENGINEERING) -> Table:
    """Loads of all bearings of both trains at rest under load."""
    loads = [
        {f"{s.name}.{b.name}": b for s in one.loaded.shafts for b in s.bearings}
        for one in found.both
    ]
    columns = [word("bearing", lambda name: name)]
    for what, si, of in (
        ("radial", "N", lambda b: b.radial),
        ("axial", "N", lambda b: float(b.load[1])),
        ("moment", "N m", lambda b: b.moment),
    ):
        for letter, own in zip("AB", loads):
            columns.append(quantity(f"{what} {letter}", si, units, partial(_load, own, of), 4))
    for letter, own in zip("AB", loads):
        columns.append(Column(f"radial {letter} at, deg", partial(_azimuth, own)))
    note = (
        "Load of the shaft on the bearing; radial loads act at an angle from x towards z. They have "
        "no error bar."
    )
    return Table("Bearing loads", columns, list(dict.fromkeys([*loads[0], *loads[1]])), note)


def _load(own: dict[str, Any], of: Callable[[Any], float], name: str) -> float | None:
    return of(own[name]) if name in own else None


def _azimuth(own: dict[str, Any], name: str) -> str | None:
    return f"{degrees(own[name].azimuth):.0f}" if name in own else None
