"""Tables of the evidence: deviations, causes, attachments, error bars, algebraic checks, modes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from solidgear.core import C_ZZ, COMPLIANCE, FIRST_BENDING, SCENE, STIFFNESS, Quantity, Record
from solidgear.core.judge.correlation import FOREIGN
from solidgear.core.judge.record import DeviationRecord, EvidenceRecord, PartnerRecord
from solidgear.core.quantity import FREQUENCY, K_ZZ
from solidgear.show.reading import is_resolved, model_name, reference_of, relative_change
from solidgear.show.table import Cell, Column, Table, quantity, text, word
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.words import bar_percent, capital, grouped, hertz, percent, short_percent, small

unsigned = partial(percent, signed=False)

#: quantities shown of causes and attachments -> how a column calls them
SHOWN = {C_ZZ: C_ZZ, K_ZZ: K_ZZ, FIRST_BENDING: "first bending"}
#: the order of the kinds of quantities
RANKS = (COMPLIANCE, STIFFNESS, FREQUENCY)


def _named(record: Record, key: str) -> str:
    """Return the name of a model at the beginning of a cell."""
    return capital(model_name(record, key))


def deviations(record: Record, units: Units = ENGINEERING) -> Table:
    """Return all models against the reference, a quantity a row, as tied and like for like."""
    reference, tolerance = reference_of(record), record.verdict.tolerance
    pairs = list(dict.fromkeys((r.model, r.attachment) for r in record.deviations))
    by_key = {(r.model, r.attachment, r.quantity): r for r in record.deviations}

    def first(name: Quantity) -> DeviationRecord:
        """Return the deviation that the value of a quantity is taken from."""
        rows_of_name = [r for r in record.deviations if r.quantity == name]
        return next((r for r in rows_of_name if r.attachment == SCENE), rows_of_name[0])

    def apart(model: str, tie: str) -> Column:
        return Column(
            f"{_named(record, model)}, {_ties(tie)}",
            lambda name: _deviation(by_key.get((model, tie, name)), tolerance),
            percent,
        )

    columns = [
        Column("quantity", lambda name: name),
        word("unit", lambda name: units.unit(name.unit)),
        Column(
            model_name(record, reference),
            lambda name: _figure(first(name).reference_value, name.unit, units),
        ),
        *(apart(model, tie) for model, tie in pairs),
    ]
    within = f" Bold: beyond the {short_percent(tolerance)} asked for." if tolerance else ""
    return Table(
        f"Differences from the {model_name(record, reference)}",
        columns,
        sorted(
            dict.fromkeys(r.quantity for r in record.deviations), key=lambda q: RANKS.index(q.kind)
        ),
        "In brackets and italics: not resolved, smaller than the error bars of both models."
        + within,
    )


def _ties(attachment: str) -> str:
    """Return the name of the ties with which two models were compared."""
    return "as tied" if attachment == SCENE else f"{attachment} ties"


def _deviation(row: DeviationRecord | None, tolerance: float | None) -> Any:
    """Return the cell of one difference."""
    if row is None:
        return None
    if not is_resolved(row):
        return Cell(f"not resolved ({percent(row.relative)})", "unresolved")
    beyond = tolerance is not None and row.relative is not None and abs(row.relative) > tolerance
    return Cell(row.relative, "bad" if beyond else "")


def causes(record: Record) -> Table:
    """Return the table of causes: the change by each assumption alone."""
    columns = [
        Column("cause", lambda cause: cause.cause),
        text("what is switched", lambda cause: cause.change),
        text("in", lambda cause: model_name(record, cause.model)),
        *(_changed(name, title) for name, title in SHOWN.items()),
    ]
    return Table("One assumption switched at a time", columns, record.causes)


def _changed(name: Quantity, title: str) -> Column:
    return Column(title, lambda cause: cause.quantities.get(name), percent)


def attachments(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the table of attachments: the change by each way of holding the seats."""
    rows = [(key, tie) for key, ties in record.attachments.items() for tie in ties]

    def value(name: Quantity, key: str, tie: str) -> float | None:
        record_of_tie = record.attachments[key].get(tie)
        return record_of_tie.quantities.get(name) if record_of_tie else None

    def change(name: Quantity, key: str, tie: str) -> float | None:
        if tie == "average":
            return None
        return relative_change(value(name, key, tie), value(name, key, "average"))

    def both(name: Quantity, called: str) -> list[Column]:
        figure = partial(_figure, si=name.unit, units=units)
        return [
            Column(f"{called}, {units.unit(name.unit)}", lambda row: value(name, *row), figure),
            Column("change", lambda row: change(name, *row), percent),
        ]

    columns = [Column("model, ties", lambda row: f"{_named(record, row[0])}, {row[1]}")]
    columns += [column for name, title in SHOWN.items() for column in both(name, title)]
    return Table("Three ways to hold the same surfaces", columns, rows)


def _figure(value: float | None, si: str, units: Units) -> str:
    """Return a value for a column that names its unit."""
    return hertz(value) if si == "Hz" else units.number(value, si)


def levels(record: Record, units: Units = ENGINEERING) -> Table:
    """Return the table of the meshes that the error bars come from."""
    rows = [
        (f"{_named(record, key)}, {n}", level)
        for key, model in record.models.items()
        for n, level in enumerate(model.convergence.levels if model.convergence else [], start=1)
    ]
    columns = [
        Column("model", lambda row: row[0]),
        Column("degrees of freedom", lambda row: row[1].dofs, grouped),
        quantity("element size h", "m", units, lambda row: row[1].h, 4),
        Column("element order", lambda row: row[1].order or None),
        quantity("C_zz", "m/N", units, lambda row: row[1].quantities.get(C_ZZ), 7),
        Column(
            "first bending, Hz",
            lambda row: row[1].quantities.get(FIRST_BENDING),
            lambda hz: f"{hz:.3f}",
        ),
    ]
    return Table("The discretisations", columns, rows)


def orders(record: Record) -> Table:
    """Return changes from mesh to mesh, and the error bars made of them."""
    rows = []
    for key, model in record.models.items():
        bars = model.convergence.quantities if model.convergence else {}
        judged = record.verdict.judged
        for name, bar in bars.items():
            if not judged or name in judged:
                label = f"{name}, Hz" if Quantity(name).is_frequency else name
                rows.append((f"{_named(record, key)}: {label}", bar))
    columns = [
        Column("quantity", lambda row: row[0]),
        word("error bar from", lambda row: row[1].method or None),
        Column("last change", lambda row: row[1].change, unsigned),
        Column("over the one before", lambda row: row[1].reduction, small),
        Column("factor", lambda row: row[1].factor, small),
        Column("of the solver", lambda row: row[1].solver, unsigned),
        Column("error bar", lambda row: row[1].gci, bar_percent),
    ]
    return Table(
        "Changes and error bars",
        columns,
        rows,
        "With layers errors shrink by a nearly fixed share; the factor is measured on random "
        "shafts. Couplings: relative to the geometric mean of both diagonal entries.",
    )


def algebra(record: Record) -> Table:
    """Return residuals and counts that need no second mesh."""
    rows = [
        (_named(record, key), model.evidence)
        for key, model in record.models.items()
        if model.evidence != EvidenceRecord()
    ]
    columns = [
        Column("model", lambda row: row[0]),
        Column("asymmetry of the flexibility", lambda row: row[1].asymmetry, small),
        Column("rigid motion, residual", lambda row: row[1].rigid_residual, small),
        Column("modes, residual", lambda row: row[1].modal_residual, small),
        Column("modes, M-orthogonality", lambda row: row[1].orthogonality, small),
        Column("rigid modes found", lambda row: row[1].rigid_modes, small),
        text("eigensolver", lambda row: row[1].eigensolver or None),
        Column("no mode missed below, Hz", lambda row: _counted_below(row[1])),
    ]
    return Table(
        "Algebraic checks of this run (relative, smaller is better, except for counts)",
        columns,
        rows,
        "No mode missed: a second factorisation (Sylvester) counts as many eigenvalues below as "
        "were found, less the error bars of modes above.",
    )


def _counted_below(evidence: EvidenceRecord) -> str:
    """Return the frequency below which no mode is missed, of the body or else of its mesh."""
    parts = evidence.mode_count
    if not parts or not all(part.get("checked") for part in parts):
        return "not counted"
    if evidence.complete_below_hz is not None:
        return f"{evidence.complete_below_hz:.0f}"
    return f"{min(part['below_hz'] for part in parts):.0f} (of this mesh)"


def pairs(record: Record) -> Table:
    """Return modes of every model beside those of the reference, a mode a row."""
    if record.mac is None:
        return Table("", [])
    reference = model_name(record, record.mac.reference)
    partners = {
        key: {pair.mode: pair for pair in table.pairs}
        for key, table in record.mac.models.items()
        if table.pairs
    }

    def partner_in(partners_of_model: dict[str, PartnerRecord]) -> Callable[[str], str | None]:
        return lambda name: _pair(partners_of_model.get(name))

    columns = [
        Column("mode", lambda name: name),
        *(
            Column(_named(record, key), partner_in(partners_of_model))
            for key, partners_of_model in partners.items()
        ),
    ]
    return Table(
        f"MAC of every mode with its partner in the {reference}",
        columns,
        list(
            dict.fromkeys(
                name for partners_of_model in partners.values() for name in partners_of_model
            )
        ),
        f"In brackets: the partner, where it has another name; a MAC below {FOREIGN:g} makes none.",
    )


def _pair(pair: PartnerRecord | None) -> str | None:
    """Return the MAC of a mode and its partner, with the partner's name where it differs."""
    if pair is None or pair.mac is None:
        return None
    if pair.mac < FOREIGN:
        return f"{pair.mac:.4f} (none)"
    partner = "" if pair.partner == pair.mode else f" ({pair.partner or 'none'})"
    return f"{pair.mac:.4f}{partner}"
