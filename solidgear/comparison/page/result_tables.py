"""Tables of the solutions: which models may be used, their summary, 6x6 matrices and natural
frequencies.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from solidgear.core import C_ZZ, FIRST_BENDING, Quantity, Record
from solidgear.core.judge.record import ModelRecord, ModeRecord
from solidgear.core.quantity import K_ZZ
from solidgear.show.matrices import block
from solidgear.show.reading import (
    LUMPED,
    answer_seconds,
    first_frequency,
    headline,
    is_beam,
    is_resolved,
    mode_of,
    model_name,
    model_of,
    reference_of,
    relative_change,
    validity,
    value_of,
)
from solidgear.show.table import Cell, Column, Table, text, word
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.words import (
    bar_percent,
    by_plane,
    capital,
    grouped,
    hertz,
    percent,
    plus_minus,
    seconds,
    short_percent,
)

#: a frequency of a motion without strain
RIGID = "0 (rigid)"
#: validity -> cell
WORTH = {
    "yes": Cell("yes", "good"),
    "no": Cell("no", "bad"),
    "open": Cell("not judged", "quiet"),
    "unknown": Cell(None),
}


def across(record: Record, title: str, rows: list[list[Any]], note: str, head: str) -> Table:
    """Return a table with quantities down and models across."""
    names = [capital(model_name(record, key)) for key in record.models]
    return Table(title, [head, *names], rows if names else [], note, "summary")


def summary(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the results of every model in short."""

    def row(label: str, cell: Callable[[str, ModelRecord], Any]) -> list[Any]:
        return [label, *(cell(key, model) for key, model in record.models.items())]

    def value(name: Quantity) -> list[Any]:
        return row(
            f"{name}, {units.unit(name.unit)}",
            lambda _, m: units.number(value_of(m, name), name.unit),
        )

    def bar(key: str, model: ModelRecord, name: str = "") -> Any:
        if model.band is None:
            # beams are solved on one mesh
            return Cell("none given", "quiet") if is_beam(record, key) else None
        return bar_percent(model.band.each.get(name) if name else model.band.compliance)

    rows = [
        row("valid for this scene", lambda _, m: WORTH[validity(m)]),
        *map(value, (K_ZZ, C_ZZ, Quantity("K_yy"), Quantity("K_thx"))),
        row("C_zz against reference", lambda key, _: apart(record, key, C_ZZ)),
        row("first bending against reference", lambda key, _: apart(record, key, FIRST_BENDING)),
        row("error bar, worst compliance", bar),
        row("error bar, first bending", lambda key, m: bar(key, m, FIRST_BENDING)),
        row("degrees of freedom", lambda _, m: grouped(m.dofs)),
    ]
    note = (
        "“Against reference” compares beams like for like, with section ties on both sides, where "
        "that is known, and solids as the scene is tied."
    )
    return across(
        record, "Results at the lumped point, attachments of the scene", rows, note, "quantity"
    )


def models(record: Record) -> Table:
    """Return models that may be used, and why others may not, a model a row."""
    records, tolerance = record.models, short_percent(record.verdict.tolerance)
    columns = [
        Column("model", lambda key: capital(model_name(record, key))),
        Column(
            f"within {tolerance}" if tolerance else "valid",
            lambda key: WORTH[validity(records[key])],
        ),
        Column("first bending, Hz", lambda key: first_frequency(records[key], "bending"), hertz),
        Column("first bending off", lambda key: apart(record, key, FIRST_BENDING)),
        Column("C_zz off", lambda key: apart(record, key, C_ZZ)),
        Column("time, s", lambda key: answer_seconds(records[key]), seconds),
        text("why not", lambda key: records[key].why_not or ""),
    ]
    return Table("Models of this scene", columns, list(records))


def apart(record: Record, key: str, quantity: str) -> Cell | None:
    """Return the deviation of a model from the reference, weaker where error bars do not resolve
    it.
    """
    if key == reference_of(record):
        return Cell("reference", "quiet")
    deviation = headline(record, key, quantity)
    if deviation is None:
        return None
    difference = percent(deviation.relative)
    if is_resolved(deviation):
        return Cell(difference)
    return Cell(f"not resolved ({difference})", "quiet")


def matrices(record: Record, units: Units = ENGINEERING) -> dict[str, list[Table]]:
    """Return the matrices of every model but the lumped one, which has another's."""
    out = {}
    for key, model in record.models.items():
        if model.family == LUMPED:
            continue
        name = model_name(record, key)
        kinds = (("stiffness", model.stiffness), ("compliance", model.compliance))
        free = record.port.free if record.port else []
        tables = [
            block(values, kind, units, capital(f"{name}: {kind}"), free)
            for kind, values in kinds
            if values
        ]
        if tables:
            out[key] = tables
    return out


def own_frequencies(record: Record, key: str | None) -> Table:
    """Return natural frequencies of one model with their error bars."""
    model = model_of(record, key)
    each = model.band.each if model.band else {}
    # in two planes that differ, the first ones of both are judged
    judged = {id(mode_of(model, name)): name for name in each}
    columns = [
        Column("mode", lambda m: m.name),
        Column("Hz", lambda m: RIGID if m.frequency_hz == 0 else m.frequency_hz, hertz),
        Column("shapes", lambda m: m.multiplicity),
        Column("error bar", lambda m: each.get(judged.get(id(m), m.name)), plus_minus),
    ]
    table = Table(
        f"Natural frequencies of the {model_name(record, key)}", columns, in_order(model.modes)
    )
    table.note = "Two shapes: a pair of the same frequency in two planes."
    if any(bar is None and hz != RIGID for _, hz, _, bar in table.rows):
        table.note += " A dash: no error bar; higher modes need finer meshes."
    table.note += by_plane(mode.name for mode in model.modes)
    return table


def in_order(modes: Iterable[ModeRecord]) -> list[ModeRecord]:
    """Return modes from the lowest up."""
    return sorted(modes, key=lambda m: m.frequency_hz or 0.0)


def frequencies(record: Record) -> Table:
    """Return the natural frequencies, a mode a row and a model a column."""
    reference = reference_of(record)
    modes = {key: {m.name: m for m in model.modes} for key, model in record.models.items()}
    # a mode stands where the reference has it, else where the first model that has it does
    ordered: dict[str, ModeRecord] = {}
    for key in sorted(modes, key=lambda k: k != reference):
        for name, mode in modes[key].items():
            ordered.setdefault(name, mode)

    def column(key: str) -> Column:
        base = {} if key == reference else modes.get(reference or "", {})
        return Column(
            capital(model_name(record, key)),
            lambda mode: _frequency(modes[key].get(mode.name), base.get(mode.name)),
        )

    columns = [
        Column("mode", lambda mode: mode.name),
        word("family", lambda mode: mode.family or None),
        Column("shapes", lambda mode: mode.multiplicity),
        *map(column, modes),
    ]
    note = ""
    if reference:
        note = (
            f"In brackets: against the {model_name(record, reference)}. Two shapes: a pair of the "
            "same frequency in two planes. A dash: not among the modes asked for."
        )
        note += by_plane(ordered)
    title = "Natural frequencies in Hz, attachments as in the scene"
    return Table(title, columns, in_order(ordered.values()), note)


def _frequency(mode: ModeRecord | None, base: ModeRecord | None) -> str | None:
    """Return the frequency of a mode, and in brackets its difference from `base`."""
    if mode is None:
        return None
    if mode.frequency_hz == 0:
        return RIGID
    apart = relative_change(mode.frequency_hz, base.frequency_hz if base else None)
    return hertz(mode.frequency_hz) + ("" if apart is None else f" ({percent(apart)})")
