"""Tables of scenes with several lumped points: each of the further ones, and what is between them."""

from __future__ import annotations

from solidgear.judge.record import ModelRecord, Record
from solidgear.report.cells import DASH, capital
from solidgear.report.reading import LUMPED, block, entry, model_name
from solidgear.report.result_tables import Cell, apart, matrix
from solidgear.report.table import Table
from solidgear.report.units import ENGINEERING, Units
from solidgear.report.words import band_percent

#: what is told of every point in the summary: quantity, unit, place
SUMMED = (("C_zz", "m/N", (2, 2)), ("C_yy", "m/N", (1, 1)), ("C_thx", "rad/(N m)", (3, 3)))


def points(record: Record, units: Units = ENGINEERING) -> Table:
    """The further points in short: quantities down, models across."""
    rows: list[list[Cell]] = []
    main = record.port.name if record.port else ""
    for port in record.further_ports:
        for name, unit, place in SUMMED:
            at = f"{name}@{port.name}"
            values = [_entry(m, port.name, place) for m in record.models.values()]
            cells = [units.number(value, unit, nothing=DASH) for value in values]
            rows.append([f"{name} at {port.name}, {units.unit(unit)}", *cells])
            rows += _beside(record, at)
    for a, b in _pairs(record):
        for name, unit, (i, j) in SUMMED:
            blocks = [block(m.coupled, a, b, "compliance") for m in record.models.values()]
            values = [entry(one, i, j) for one in blocks]
            cells = [units.number(value, unit, nothing=DASH) for value in values]
            moment = "a moment" if i > 2 else "a load"
            rows.append([f"{name}, {a} for {moment} on {b}, {units.unit(unit)}", *cells])
            rows += _beside(record, f"{name}@{a}@{b}")
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


def matrices(record: Record, units: Units = ENGINEERING) -> list[tuple[str, list[dict]]]:
    """The matrices of every further point and between points, a heading and its matrices."""
    out: list[tuple[str, list[dict]]] = []
    models = {k: m for k, m in record.models.items() if m.family != LUMPED and m.coupled}
    for port in record.further_ports:
        shown = []
        for key, model in models.items():
            found = model.points.get(port.name)
            for kind in ("stiffness", "compliance") if found else ():
                values = getattr(found, kind)
                if values:
                    caption = f"{model_name(record, key)}: {kind} at {port.name}"
                    shown.append(matrix(caption, kind, values, port.free, units))
        out.append((f"At {port.name}", shown))
    for a, b in _pairs(record):
        shown = []
        for key, model in models.items():
            for kind in ("stiffness", "compliance"):
                there = block(model.coupled, a, b, kind)
                own = [block(model.coupled, one, one, kind) for one in (a, b)]
                sizes = [[entry(one, k, k) for k in range(6)] for one in own]
                first, second = (
                    ("load on", "motion of")
                    if kind == "stiffness"
                    else (
                        "motion of",
                        "load on",
                    )
                )
                caption = f"{model_name(record, key)}: {kind}, {first} {a}, {second} {b}"
                if there and any(v is not None for row in there for v in row):
                    shown.append(matrix(caption, kind, there, [], units, sizes))
        out.append((f"Between {a} and {b}", shown))
    return out


def _pairs(record: Record) -> list[tuple[str, str]]:
    """Names of points, two by two."""
    names = [port.name for port in (record.port, *record.further_ports) if port is not None]
    return [(a, b) for k, a in enumerate(names) for b in names[k + 1 :]]


def _entry(model: ModelRecord, port: str, place: tuple[int, int]) -> float | None:
    found = model.points.get(port)
    return entry(found.compliance, *place) if found else None


def _beside(record: Record, quantity: str) -> list[list[Cell]]:
    """How far every model is from the reference in a quantity, and how sure each is of its own."""
    bands = [m.band.each.get(quantity) if m.band else None for m in record.models.values()]
    bars: list[Cell] = [f"± {band_percent(bar)}" if bar is not None else DASH for bar in bands]
    return [
        ["against reference", *(apart(record, key, quantity) for key in record.models)],
        ["bar", *bars],
    ]
