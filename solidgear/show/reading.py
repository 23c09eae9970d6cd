"""Readings of a record, shared by tables and charts."""

from __future__ import annotations

from collections.abc import Sequence

from solidgear.core import FIRST_BENDING, SCENE, Quantity, Record
from solidgear.core.body.mode_names import meant
from solidgear.core.judge.record import (
    CoupledRecord,
    DeviationRecord,
    Matrix,
    ModelRecord,
    ModeRecord,
)
from solidgear.core.judge.ties import SECTION
from solidgear.show import open_words
from solidgear.show.words import DASH, is_number

#: families of models, as the ladder has them
LUMPED, BEAM = "lumped", "beam"
#: below this share of the geometric mean of its diagonal entries a coupling is next to nothing
FAINT = 1e-6


def model_of(record: Record, key: str | None) -> ModelRecord:
    """Return the record of a model; an empty one where there is none."""
    return record.models.get(key or "") or ModelRecord()


def model_name(record: Record, key: str | None) -> str:
    """Return the name of a model in a sentence, its key if it has no title."""
    return model_of(record, key).title or key or DASH


def left_open(record: Record) -> str:
    """Return the sentence on the range of first bending by open inputs; empty without any."""
    ranges = ", ".join(" ".join(part) for part in open_words.parts(record.open, FIRST_BENDING))
    remark = open_words.remark(record.open)
    return f"First bending: {ranges}. {remark}" if ranges else remark


def heading(record: Record, key: str) -> str:
    """Return the name of a model at the head of a narrow column."""
    model = model_of(record, key)
    return model.short or model.title or key


def is_beam(record: Record, key: str) -> bool:
    """Return True where a model is a beam."""
    return model_of(record, key).family == BEAM


def entry(matrix: Sequence[Sequence[float | None]] | None, i: int, j: int) -> float | None:
    """Return one entry of a matrix; None if there is none."""
    if matrix is None or i >= len(matrix) or j >= len(matrix[i]):
        return None
    return matrix[i][j]


def value_of(model: ModelRecord, quantity: Quantity) -> float | None:
    """Return the value of an entry of a matrix, at the main point, a further one or between
    points.
    """
    if quantity.pair:
        matrix = block(model.coupled, *quantity.pair, quantity.kind)
    else:
        point = model.points.get(quantity.points[0]) if quantity.points else model
        matrix = getattr(point, quantity.kind, None)
    return None if matrix is None else quantity.of(matrix)


def block(coupled: CoupledRecord | None, a: str, b: str, kind: str) -> Matrix | None:
    """Return the 6x6 of two points; None where there is none."""
    values = getattr(coupled, kind, None)
    if coupled is None or values is None or not {a, b} <= set(coupled.ports):
        return None
    i, j = 6 * coupled.ports.index(a), 6 * coupled.ports.index(b)
    return [row[j : j + 6] for row in values[i : i + 6]]


def is_nothing(value: float | None, first: float | None, second: float | None) -> bool:
    """Return True where a coupling is negligible beside two entries of its size."""
    if value is None or first is None or second is None:
        return False
    return abs(value) <= FAINT * abs(first * second) ** 0.5


def first_mode(model: ModelRecord, family: str) -> ModeRecord | None:
    """Return the lowest elastic mode of a family ('bending', 'axial', 'torsion'), or None."""
    for mode in model.modes:
        of_family = family in (mode.family, mode.name.family)
        if of_family and not mode.name.rigid and mode.frequency_hz is not None:
            return mode
    return None


def mode_of(model: ModelRecord, name: str) -> ModeRecord | None:
    """Return the mode that a name such as 'bending 2' means, or None."""
    modes = sorted(model.modes, key=lambda mode: mode.frequency_hz or 0.0)
    place = meant(name, [mode.name for mode in modes])
    return None if place is None else modes[place]


def first_frequency(model: ModelRecord, family: str) -> float | None:
    """Return the frequency of `first_mode`, Hz."""
    mode = first_mode(model, family)
    return mode.frequency_hz if mode else None


def headline(record: Record, model: str, quantity: str) -> DeviationRecord | None:
    """Return the deviation that represents a model: like for like for a beam, as tied for a solid.

    A beam has no seat surface: its fair partner is the solid with section ties. A solid is compared
    as the scene has it.
    """
    rows = [r for r in record.deviations if r.model == model and r.quantity == quantity]
    tie = SECTION if is_beam(record, model) else SCENE
    for row in rows:
        if row.attachment == tie:
            return row
    return rows[0] if rows else None


def is_resolved(row: DeviationRecord) -> bool:
    """Return True unless a deviation lies inside the error bars of both models."""
    if row.verdict is not None:
        return row.verdict != "not resolved"
    if row.band is None or row.relative is None:
        return True
    return abs(row.relative) > row.band


def answer_seconds(model: ModelRecord) -> float | None:
    """Return seconds for building and solving, without error bars and variants."""
    total = 0.0
    for stage in ("build", "statics", "modes"):
        spent = model.seconds.get(stage)
        if spent is None:
            return model.seconds.get("total")
        total += spent
    return total


def validity(model: ModelRecord) -> str:
    """Return ``yes``, ``no``, ``open`` (not judged, or too close) or ``unknown``."""
    if model.valid is True:
        return "yes"
    if model.open:
        return "open"
    return "no" if model.valid is False else "unknown"


def reference_of(record: Record) -> str | None:
    """Return the key of the reference model."""
    if record.verdict.reference:
        return record.verdict.reference
    return record.mac.reference if record.mac else None


def relative_change(value: float | None, base: float | None) -> float | None:
    """Return `value` over `base` less one; None where either is missing, or the base is zero."""
    if not is_number(value) or not is_number(base) or base == 0:
        return None
    return value / base - 1
