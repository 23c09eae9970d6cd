"""Tables of scenes with several lumped points: each of the further ones, and what is between them."""

from __future__ import annotations

from solidgear.judge.record import Record
from solidgear.quantity import C_ZZ, COMPLIANCE, STIFFNESS, Quantity
from solidgear.report.cells import DASH, capital
from solidgear.report.reading import LUMPED, block, entry, model_name, value_of
from solidgear.report.result_tables import Cell, MatrixTable, apart, matrix
from solidgear.report.table import Table
from solidgear.report.units import ENGINEERING, Units
from solidgear.report.words import band_percent

#: what is told of every point in the summary
SUMMED = (C_ZZ, Quantity("C_yy"), Quantity("C_thx"))


def points(record: Record, units: Units = ENGINEERING) -> Table:
    """The further points in short: quantities down, models across."""
    rows: list[list[Cell]] = []
    main = record.port.name if record.port else ""
    for port in record.further_ports:
        for name in SUMMED:
            rows += _told(record, units, name.at(port.name), f"{name} at {port.name}")
    for a, b in _pairs(record):
        for name in SUMMED:
            load = "a moment" if name.place[1] > 2 else "a load"
            rows += _told(record, units, name.at(a, b), f"{name}, {a} for {load} on {b}")
    note = (
        f"Headlines, lumped models and attachments above are those of {main}, the main point; "
        "compliances of every point are judged unless the scene asks for others. Bars and "
        "differences of terms between points are shares of the geometric mean of what both points "
        "have of their own, for such a term may vanish."
    )
    return Table(
        "Further lumped points",
        ["quantity", *(capital(model_name(record, key)) for key in record.models)],
        rows,
        note,
        css="summary",
    )


def matrices(record: Record, units: Units = ENGINEERING) -> list[tuple[str, list[MatrixTable]]]:
    """The matrices of every further point and between points, a heading and its matrices."""
    out: list[tuple[str, list[MatrixTable]]] = []
    models = {k: m for k, m in record.models.items() if m.family != LUMPED and m.coupled}
    for port in record.further_ports:
        shown = []
        for key, model in models.items():
            found = model.points.get(port.name)
            for kind in (STIFFNESS, COMPLIANCE) if found else ():
                values = getattr(found, kind)
                if values:
                    caption = f"{model_name(record, key)}: {kind} at {port.name}"
                    shown.append(matrix(caption, kind, values, port.free, units))
        out.append((f"At {port.name}", shown))
    for a, b in _pairs(record):
        shown = []
        for key, model in models.items():
            for kind in (STIFFNESS, COMPLIANCE):
                there = block(model.coupled, a, b, kind)
                own = [block(model.coupled, one, one, kind) for one in (a, b)]
                sizes = [[entry(one, k, k) for k in range(6)] for one in own]
                words = ("load on", "motion of")
                first, second = words if kind == STIFFNESS else reversed(words)
                caption = f"{model_name(record, key)}: {kind}, {first} {a}, {second} {b}"
                if there and any(v is not None for row in there for v in row):
                    shown.append(matrix(caption, kind, there, [], units, sizes))
        out.append((f"Between {a} and {b}", shown))
    return out


def _pairs(record: Record) -> list[tuple[str, str]]:
    """Names of points, two by two."""
    names = [port.name for port in (record.port, *record.further_ports) if port is not None]
    return [(a, b) for k, a in enumerate(names) for b in names[k + 1 :]]


def _told(record: Record, units: Units, quantity: Quantity, label: str) -> list[list[Cell]]:
    """A quantity by every model, how far each is from the reference, and how sure of its own."""
    values = [value_of(model, quantity) for model in record.models.values()]
    bands = [m.band.each.get(quantity) if m.band else None for m in record.models.values()]
    bars: list[Cell] = [f"± {band_percent(bar)}" if bar is not None else DASH for bar in bands]
    return [
        [
            f"{label}, {units.unit(quantity.unit)}",
            *(units.number(value, quantity.unit, nothing=DASH) for value in values),
        ],
        ["against reference", *(apart(record, key, quantity) for key in record.models)],
        ["bar", *bars],
    ]
