"""Two trains at rest under torque beside each other: sentences and tables of misalignment and of
bearing loads.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from math import degrees

from solidgear.core.judge.change import Change
from solidgear.show.sheet import Section
from solidgear.show.table import WORD, Cell, Column, Table, in_units, quantity, word
from solidgear.show.units import Units, plain_unit
from solidgear.strength.deflection.at_rest import Deflection
from solidgear.strength.deflection.shaft import BearingState
from solidgear.strength.deflection.sheet import meanings
from solidgear.trains.file.operation import OperatingPoint
from solidgear.two_designs.beside import NumberChange, band

#: train A and B, None where it is not deflected
Both = Sequence[Deflection | None]


def misalignment_changes(both: Both) -> Iterator[NumberChange]:
    """Yield the numbers of misalignment; none unless both are deflected."""
    a, b = both
    if a is None or b is None:
        return
    misalignment_b = {m.name: m for m in b.misalignment}
    for m in a.misalignment:
        if m.name in misalignment_b:
            partner = misalignment_b[m.name]
            change = Change(m.value, partner.value, m.bar, partner.bar)
            yield NumberChange(m.name, m.unit, change, abs(m.value))


def sentences(
    points: Sequence[OperatingPoint | None],
    both: Both,
    changes: Sequence[NumberChange],
    units: Units,
) -> Iterator[str]:
    """Yield the misalignment and its range by data of bearings, or the reason why nothing is
    compared.
    """
    a, b = points
    if a is None or b is None:
        if a is not b:
            letter = "B" if a is None else "A"
            yield f"Under torque nothing is compared: {letter} alone has an operating point."
        return
    if not changes:
        yield "Under torque nothing is compared: lumped shafts have no bearings of their own."
        return
    texts = [
        f"{n.name} {units.number(n.change.a, n.unit, 3)} to {units.text(n.change.b, n.unit, 3)}"
        + (f" ({n.verdict})" if n.change.band is not None else "")
        for n in changes
    ]
    place = a.label if a.label == b.label else f"{a.label} (A) and {b.label} (B)"
    yield f"Misalignment at {place}: {'; '.join(texts)}."
    letters_by_range: dict[str, str] = {}
    for letter, deflected in zip("AB", both):
        for m in deflected.misalignment if deflected else ():
            if m.open is not None:
                low, high = units.number(m.open[0], m.unit, 3), units.text(m.open[1], m.unit, 3)
                words = f"{m.name} {low} to {high}"
                letters_by_range[words] = letters_by_range.get(words, "") + letter
    if letters_by_range:
        ranges = [
            words if letters == "AB" else f"{words} ({letters})"
            for words, letters in letters_by_range.items()
        ]
        yield f"Range from the data of bearings, shared by both: {'; '.join(ranges)}."


def section(both: Both, changes: Sequence[NumberChange], units: Units) -> Section:
    """Return the section of the page, empty where nothing is compared."""
    words = []
    deflected = [train for train in both if train is not None and changes]
    for letter, train in zip("AB", deflected):
        forces = [
            units.text(size, "N", 4) + name.removeprefix("mesh")
            for name, size in train.mesh_forces.items()
        ]
        along = f"{', '.join(forces)} along the line of action"
        words.append(f"{letter} at {train.point.label}: {along}.")
    tables = [misalignment(deflected, changes, units), bearing_loads(deflected, units)]
    return Section("rest", "Under torque", " ".join(words), tables=tables if changes else ())


def misalignment(
    both: Sequence[Deflection], changes: Sequence[NumberChange], units: Units
) -> Table:
    """Return the misalignment of both trains."""
    columns = [
        word("of the axes", lambda n: f"{n.name}, {units.unit(n.unit)}"),
        Column("A", lambda n: in_units(n.change.a, n.unit, units, 3)),
        Column("B", lambda n: in_units(n.change.b, n.unit, units, 3)),
        Column("difference", partial(_difference, units)),
    ]
    shown = [
        {m.name: m for m in train.misalignment if m.name in [n.name for n in changes]}
        for train in both
    ]
    note = "".join(f"{meanings([*by_name.values()], units)}." for by_name in shown[:1])
    if any(n.change.band is not None for n in changes):
        columns.append(Column("both error bars", lambda n: band(n.change)))
        columns.append(Column("", lambda n: n.verdict, kind=WORD, name="verdict"))
        note += " Both error bars: sum of both mesh errors, relative to A."
    ranges = [
        {name: m.open for name, m in by_name.items() if m.open is not None} for by_name in shown
    ]
    for letter, by_name in zip("AB", ranges):
        if by_name:
            columns.append(Column(f"range, {letter}", partial(_range, by_name, units)))
    if any(ranges):
        note += (
            " Range: by estimated insides and classes of clearance of bearings, which both trains "
            "may share."
        )
    columns.append(Column("unit", lambda n: plain_unit(n.unit), hidden=True))
    return Table("Misalignment", columns, changes, note)


def _difference(units: Units, number: NumberChange) -> Cell:
    look = "unresolved" if number.verdict == "not resolved" else ""
    return in_units(number.change.difference, number.unit, units, 3, look)


def _range(
    ranges: dict[str, tuple[float, float]], units: Units, number: NumberChange
) -> str | None:
    if number.name not in ranges:
        return None
    low, high = (units.number(end, number.unit, 3) for end in ranges[number.name])
    return f"{low} to {high}"


def bearing_loads(both: Sequence[Deflection], units: Units) -> Table:
    """Return loads of all bearings of both trains."""
    sides = [
        (letter, {f"{s.name}.{b.name}": b for s in deflected.shafts for b in s.bearings})
        for letter, deflected in zip("AB", both)
    ]
    loads: tuple[tuple[str, str, Callable[[BearingState], float]], ...] = (
        ("radial", "N", lambda bearing: bearing.radial),
        ("axial", "N", lambda bearing: float(bearing.load[1])),
        ("moment", "N m", lambda bearing: bearing.moment),
    )
    columns = [word("bearing", str)]
    for title, si, load in loads:
        for letter, bearings in sides:
            of = partial(_load, bearings, load)
            columns.append(quantity(f"{title} {letter}", si, units, of, 4))
    for letter, bearings in sides:
        angle = partial(_load, bearings, lambda bearing: degrees(bearing.azimuth))
        columns.append(Column(f"radial {letter} at, deg", angle, "{:.0f}".format))
    note = (
        "Load of the shaft on the bearing; radial loads act at an angle from x towards z. They have "
        "no error bar."
    )
    names = list(dict.fromkeys(name for _, bearings in sides for name in bearings))
    return Table("Bearing loads", columns, names, note)


def _load(
    bearings: dict[str, BearingState], load: Callable[[BearingState], float], name: str
) -> float | None:
    return load(bearings[name]) if name in bearings else None
