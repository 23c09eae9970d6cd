"""The run in a terminal: the final table, the verdict and matrices.

Everything fits 80 columns and says the same without colour.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.text import Text

from solidgear.core import C_ZZ, FIRST_BENDING, Quantity, Record
from solidgear.core.judge.record import ModelRecord, VerdictRecord
from solidgear.core.quantity import K_ZZ
from solidgear.show import reading, words
from solidgear.show.matrices import block
from solidgear.show.table import MARK, Column, Table, word
from solidgear.show.units import SI, Units, in_ascii, units_named

if TYPE_CHECKING:
    import numpy as np

NOT_RESOLVED = "n.r."
#: figures of a coupling that is next to nothing
WEAK = 3
#: validity -> how it is written in a narrow column
VALID = {"yes": "yes", "no": "NO", "open": "?", "unknown": "?"}


def final_table(record: Record) -> RenderableType:
    """Return one line per model in at most 80 columns, with notes and reasons below; missing parts
    are dashes.
    """
    chosen = units_named(record.shown_in)
    table = Table("", _columns(record, chosen), list(record.models), style="narrow")
    unresolved = any(NOT_RESOLVED in row for row in table.rows)
    notes = [*_notes(record, unresolved), *_further_points(record, chosen)]
    reasons = [_reason(record, key, model) for key, model in record.models.items()]
    return Group(table, *map(Text, notes), *(Text(reason) for reason in reasons if reason))


def _columns(record: Record, units: Units) -> list[Column]:
    """Return columns of the final table, by the key of a model."""
    models = record.models

    def entry(name: Quantity) -> Column:
        head = f"{name}\n{units.unit(name.unit)}"
        return Column(
            head, lambda key: units.number(reading.value_of(models[key], name), name.unit, 4)
        )

    def apart(head: str, name: Quantity) -> Column:
        return Column(head, lambda key: _against_reference(record, key, name))

    def bar(key: str) -> float | None:
        summary = models[key].band
        return summary.compliance if summary else None

    return [
        word("model", lambda key: reading.heading(record, key)[:10]),
        Column("valid", lambda key: VALID[reading.validity(models[key])], kind=MARK),
        entry(K_ZZ),
        entry(C_ZZ),
        Column(
            f"fb1\n{units.unit('Hz')}",
            lambda key: reading.first_frequency(models[key], "bending"),
            words.hertz,
        ),
        apart("dC_zz", C_ZZ),
        apart("dfb1", FIRST_BENDING),
        Column("bar\nC", bar, words.bar_percent),
        Column("DOFs", lambda key: models[key].dofs, words.count),
        Column(
            f"time\n{units.unit('s')}",
            lambda key: reading.answer_seconds(models[key]),
            words.seconds,
        ),
    ]


def _notes(record: Record, unresolved: bool) -> list[str]:
    """Return the meaning of the marks of the final table."""
    notes = []
    reference = reading.reference_of(record)
    if reference:
        notes.append(
            f"d: difference from the {reading.model_name(record, reference)} (ref.), with equal seats"
        )
    if any(reading.validity(m) == "open" for m in record.models.values()):
        notes.append("?: not judged, or too close to the tolerance to tell")
    if unresolved:
        notes.append("n.r.: difference smaller than the error bars")
    if record.models:
        notes.append(
            "fb1: first bending mode; bar C: widest error bar of a compliance; time: building and "
            "solving, without error bars"
        )
    if not record.complete:
        notes.append("INCOMPLETE: the run was interrupted; a dash shows what is missing")
    return notes


def _further_points(record: Record, units: Units) -> list[str]:
    """Return compliances at further lumped points, a line each, after the main point's name."""
    if not record.further_ports:
        return []
    lines = [f"the table is for {record.port.name if record.port else 'the first point'}"]
    for port in record.further_ports:
        values = []
        for key, model in record.models.items():
            name = C_ZZ.at(port.name)
            value = units.number(reading.value_of(model, name), name.unit, 4)
            difference = _against_reference(record, key, name)
            values.append(f"{reading.heading(record, key)} {value} ({difference})")
        lines.append(in_ascii(f"C_zz at {port.name}, {units.unit('m/N')}: {', '.join(values)}"))
    return lines


def _reason(record: Record, key: str, model: ModelRecord) -> str:
    """Return the reason why a model must not be trusted, or cannot be judged."""
    state = reading.validity(model)
    if state not in ("no", "open"):
        return ""
    reason = model.why_not or "not valid for this scene"
    return f"{VALID[state]:<4}{reading.model_name(record, key)}: {reason}"


def _against_reference(record: Record, key: str, quantity: str) -> str:
    """Return the difference of a model from the reference, for one cell."""
    if key == reading.reference_of(record):
        return "ref."
    row = reading.headline(record, key, quantity)
    if row is None:
        return words.DASH
    return words.percent(row.relative) if reading.is_resolved(row) else NOT_RESOLVED


def closing_lines(record: Record) -> list[str]:
    """Return lines below a verdict: cautions, modes counted, seconds and peak memory."""
    lines = [f"caution: {w}" for w in record.warnings]
    if ranges := reading.left_open(record):
        lines.append(ranges)
    trusted = record.verdict.trust
    counted = reading.model_of(record, trusted).evidence.complete
    if counted:
        name = reading.model_name(record, trusted)
        lines.append(f"{name[0].upper()}{name[1:]}: {counted[0].lower()}{counted[1:]}")
    if record.seconds_total is not None:
        lines.append(f"Solved in {words.seconds(record.seconds_total)} s{_memory(record)}.")
    return lines


def _memory(record: Record) -> str:
    """Return the peak memory beside its estimate."""
    if record.peak_mb is None:
        return ""
    peak = f", peak memory {record.peak_mb:.0f} MB"
    if record.expected_peak_mb is not None:
        peak += f" ({record.expected_peak_mb:.0f} MB estimated)"
    return peak


def verdict_text(record: Record) -> str:
    """Return the verdict in plain words, one statement a line (plain text: print it without
    markup).
    """
    verdict = record.verdict
    if verdict == VerdictRecord():
        return "No verdict: the run was interrupted before."
    trusted = "no model that ran"
    if verdict.trust:
        trusted = reading.model_name(record, verdict.trust)
    lines = [f"Trust: {trusted}"]
    if verdict.tolerance is not None:
        cheapest = "none below the reference"
        if verdict.cheapest:
            cheapest = reading.model_name(record, verdict.cheapest)
        lines.append(f"Cheapest model within {100 * verdict.tolerance:.4g} %: {cheapest}")
    return "\n".join(lines + [f"- {s}" for s in verdict.sentences])


def matrix_table(
    matrix: np.ndarray | Sequence[Sequence[float | None]],
    kind: str,
    units: str | Units = SI,
    title: str = "",
    sizes: Sequence[Sequence[float]] | None = None,
) -> Table:
    """Return a 6x6 with its units, titled by its kind; free components (None or NaN) are dashes."""
    chosen = units_named(units)
    rows = matrix.tolist() if hasattr(matrix, "tolist") else matrix
    # a weak coupling has few figures that mean something, and a row has 80 columns
    table = block(rows, kind, chosen, sizes=sizes, faint_digits=WEAK)
    table.title = f"{title or kind}, {chosen.title}"
    return table
