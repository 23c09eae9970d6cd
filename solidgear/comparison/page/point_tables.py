"""Tables of scenes with several lumped points: each of the further ones, and what is between them."""

from __future__ import annotations

from typing import Any

from solidgear.comparison.page.result_tables import across, apart
from solidgear.core import C_ZZ, COMPLIANCE, STIFFNESS, Quantity, Record
from solidgear.show.matrices import block as matrix
from solidgear.show.reading import LUMPED, block, entry, model_name, value_of
from solidgear.show.table import Table
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.words import capital, plus_minus

#: what is told of every point in the summary
SUMMED = (C_ZZ, Quantity("C_yy"), Quantity("C_thx"))


def points(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the further points in short: quantities down, models across."""
    rows: list[list[Any]] = []
    main = record.port.name if record.port else ""
    models = record.models.values()

    def add(quantity: Quantity, label: str) -> None:
        cells = [units.number(value_of(m, quantity), quantity.unit) for m in models]
        rows.append([f"{label}, {units.unit(quantity.unit)}", *cells])
        rows.append(["against reference", *(apart(record, k, quantity) for k in record.models)])
        bars = [m.band.each.get(quantity) if m.band else None for m in models]
        rows.append(["error bar", *(None if bar is None else plus_minus(bar) for bar in bars)])

    for port in record.further_ports:
        for name in SUMMED:
            add(name.at(port.name), f"{name} at {port.name}")
    for a, b in _pairs(record):
        for name in SUMMED:
            load = "a moment" if any(name.loads[1][3:]) else "a load"
            add(name.at(a, b), f"{name}, {a} for {load} on {b}")
    note = (
        f"Headlines, lumped models and attachments above are for {main}, the main point; "
        "compliances of every point are judged unless the scene asks for others. Error bars and "
        "differences between points are relative to the geometric mean of the two points' own "
        "entries."
    )
    return across(record, "Further lumped points", rows, note, "quantity")


def matrices(record: Record, units: Units = ENGINEERING) -> list[tuple[str, list[Table]]]:
    """Return the matrices of every further point and between points, a heading and its matrices."""
    out: list[tuple[str, list[Table]]] = []
    models = {k: m for k, m in record.models.items() if m.family != LUMPED and m.coupled}
    for port in record.further_ports:
        blocks = []
        for key, model in models.items():
            point = model.points.get(port.name)
            for kind in (STIFFNESS, COMPLIANCE) if point else ():
                values = getattr(point, kind)
                if values:
                    caption = f"{model_name(record, key)}: {kind} at {port.name}"
                    blocks.append(matrix(values, kind, units, capital(caption), port.free))
        out.append((f"At {port.name}", blocks))
    for a, b in _pairs(record):
        blocks = []
        for key, model in models.items():
            for kind in (STIFFNESS, COMPLIANCE):
                between = block(model.coupled, a, b, kind)
                diagonals = [block(model.coupled, name, name, kind) for name in (a, b)]
                sizes = [[entry(name, k, k) for k in range(6)] for name in diagonals]
                words = ["load on", "motion of"]
                first, second = words if kind == STIFFNESS else reversed(words)
                caption = f"{model_name(record, key)}: {kind}, {first} {a}, {second} {b}"
                if between and any(v is not None for row in between for v in row):
                    blocks.append(matrix(between, kind, units, capital(caption), sizes=sizes))
        out.append((f"Between {a} and {b}", blocks))
    return out


def _pairs(record: Record) -> list[tuple[str, str]]:
    """Return names of points, two by two."""
    names = [port.name for port in (record.port, *record.further_ports) if port is not None]
    return [(a, b) for k, a in enumerate(names) for b in names[k + 1 :]]
