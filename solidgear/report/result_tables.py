"""Tables of what was solved: which models may be used, their summary, 6x6 matrices and natural
frequencies.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from solidgear.frames import DOF_NAMES
from solidgear.judge.record import Matrix, ModelRecord, ModeRecord, Record
from solidgear.quantity import BLOCK_UNITS, C_ZZ, FIRST_BENDING, K_ZZ, Quantity
from solidgear.report.cells import DASH, capital, pct, short_percent, whole_number
from solidgear.report.reading import (
    LUMPED,
    answer_seconds,
    entry,
    first_frequency,
    headline,
    is_beam,
    is_nothing,
    is_resolved,
    mode_of,
    model_name,
    model_of,
    reference_of,
    relative_change,
    validity,
    value_of,
)
from solidgear.report.table import Table
from solidgear.report.units import ENGINEERING, Units
from solidgear.report.words import band_percent, by_plane, hertz, seconds

#: a text, or a text and its css class
Cell = str | tuple[str, str]

#: validity -> cell
WORTH: dict[str, Cell] = {
    "yes": ("yes", "good"),
    "no": ("no", "bad"),
    "open": ("not judged", "quiet"),
    "unknown": DASH,
}


def summary(record: Record, units: Units = ENGINEERING) -> Table:
    """Quantities down, models across: four models fit a page, thirteen columns do not."""

    def row(label: str, cell: Callable[[ModelRecord], Cell]) -> list[Cell]:
        return [label, *(cell(model) for model in record.models.values())]

    def value(name: Quantity) -> list[Cell]:
        return row(
            f"{name}, {units.unit(name.unit)}",
            lambda m: units.number(value_of(m, name), name.unit, nothing=DASH),
        )

    def from_reference(label: str, quantity: Quantity) -> list[Cell]:
        return [label, *(apart(record, key, quantity) for key in record.models)]

    def band(label: str, values: list[float | None]) -> list[Cell]:
        pairs = zip(record.models, values)
        return [label, *(_band(record, key, value) for key, value in pairs)]

    bands = [model.band for model in record.models.values()]
    rows = [
        row("valid for this scene", lambda m: WORTH[validity(m)]),
        *map(value, (K_ZZ, C_ZZ, Quantity("K_yy"), Quantity("K_thx"))),
        from_reference("C_zz against reference", C_ZZ),
        from_reference("first bending against reference", FIRST_BENDING),
        band("band, worst compliance", [b.compliance if b else None for b in bands]),
        band("band, first bending", [b.each.get(FIRST_BENDING) if b else None for b in bands]),
        row("degrees of freedom", lambda m: whole_number(m.dofs)),
    ]
    note = (
        "“Against reference” compares beams with section ties on both sides, where they have a "
        "like-for-like partner, and solids as the scene has them."
    )
    return Table(
        "Results at the lumped point, attachments of the scene",
        ["quantity", *(capital(model_name(record, key)) for key in record.models)],
        rows if record.models else [],
        note,
        css="summary",
    )


def models(record: Record) -> Table:
    """Which models may be used, and why the others not: a model a row."""
    rows = []
    for key, model in record.models.items():
        rows.append(
            [
                capital(model_name(record, key)),
                WORTH[validity(model)],
                hertz(first_frequency(model, "bending"), DASH),
                apart(record, key, FIRST_BENDING),
                apart(record, key, C_ZZ),
                seconds(answer_seconds(model), DASH),
                (model.why_not or "", "text"),
            ]
        )
    tolerance = short_percent(record.verdict.tolerance)
    head = [
        "model",
        f"within {tolerance}" if tolerance else "valid",
        "first bending, Hz",
        "first bending off",
        "C_zz off",
        "time, s",
        "why not",
    ]
    return Table("Models of this scene", head, rows)


def apart(record: Record, key: str, quantity: str) -> Cell:
    """How far a model is from the reference.

    Parameters
    ----------
    record : Record
    key : str
        Of the model.
    quantity : str
        ``C_zz@gear`` at a further point, ``C_zz@wheel@pinion`` between two.

    Returns
    -------
    str or (str, str)
        A cell, said with less weight where bars do not tell the models apart.
    """
    if key == reference_of(record):
        return ("reference", "quiet")
    found = headline(record, key, quantity)
    if found is None:
        return DASH
    difference = pct(found.relative)
    return difference if is_resolved(found) else (f"not resolved ({difference})", "quiet")


def _band(record: Record, key: str, value: float | None) -> Cell:
    """A band of a model; beams are solved on one mesh and have none."""
    if record.models[key].band is None and is_beam(record, key):
        return ("none given", "quiet")
    return band_percent(value, DASH)


class MatrixTable(NamedTuple):
    """A 6x6 as a page shows it: units and rows of cells of its upper and its lower half."""

    caption: str
    names: tuple[str, ...]
    blocks: list[tuple[tuple[str, str], list[tuple[str, list[Cell]]]]]


def matrices(record: Record, units: Units = ENGINEERING) -> dict[str, list[MatrixTable]]:
    """The matrices of every model; the lumped one stands on those of another, shown there."""
    out = {}
    for key, model in record.models.items():
        if model.family == LUMPED:
            continue
        name = model_name(record, key)
        both = (("stiffness", model.stiffness), ("compliance", model.compliance))
        free = record.port.free if record.port else []
        shown = [
            matrix(f"{name}: {kind}", kind, values, free, units) for kind, values in both if values
        ]
        if shown:
            out[key] = shown
    return out


def matrix(
    caption: str,
    kind: str,
    values: Matrix,
    free: list[str],
    units: Units = ENGINEERING,
    sizes: Any = None,
) -> MatrixTable:
    """A 6x6 with a unit over each of its four blocks.

    Parameters
    ----------
    caption : str
    kind : {'stiffness', 'compliance'}
    values : (6, 6) rows of numbers
    free : list of str
        Components that are shown as a dash.
    units : Units
    sizes : two lists of six numbers, optional
        Entries of the diagonal beside which a coupling may be next to nothing; by default those of
        the matrix.
    """
    own = [entry(values, k, k) for k in range(6)]
    across, along = sizes or (own, own)
    same, mixed, turn = BLOCK_UNITS[kind]
    rows = []
    for i, direction in enumerate(DOF_NAMES):
        cells: list[Cell] = []
        for j, other in enumerate(DOF_NAMES):
            value = entry(values, i, j)
            if value is None or direction in free or other in free:
                cells.append((DASH, "quiet"))
                continue
            faint = (i != j or sizes is not None) and is_nothing(value, across[i], along[j])
            si = mixed if (i < 3) != (j < 3) else same if i < 3 else turn
            # without exponents a coupling of nothing would fill its cell with zeros
            text = "0" if faint and not units.exponents else units.number(value, si)
            cells.append((text, "faint" if faint else ""))
        rows.append((direction, cells))
    same, mixed, turn = (units.unit(si) for si in (same, mixed, turn))
    halves = [((same, mixed), rows[:3]), ((mixed, turn), rows[3:])]
    return MatrixTable(capital(caption), DOF_NAMES, halves)


def own_frequencies(record: Record, key: str | None) -> Table:
    """Natural frequencies of one model with their bars."""
    model = model_of(record, key)
    each, rows = model.band.each if model.band else {}, []
    # in two planes that differ, the first ones of both are judged
    judged = {id(mode_of(model, name)): name for name in each}
    for mode in sorted(model.modes, key=lambda m: m.frequency_hz or 0.0):
        bar = each.get(judged.get(id(mode), mode.name))
        told = "0 (rigid)" if mode.frequency_hz == 0 else hertz(mode.frequency_hz, DASH)
        cell = DASH if bar is None else f"± {band_percent(bar)}"
        rows.append([mode.name, told, str(mode.multiplicity), cell])
    note = "Two shapes: a pair of the same frequency in two planes."
    if any(row[-1] == DASH and row[1] != "0 (rigid)" for row in rows):
        note += " A dash: no bar of its own; the higher a mode, the more it asks of a mesh."
    note += by_plane(mode.name for mode in model.modes)
    return Table(
        f"Natural frequencies of the {model_name(record, key)}",
        ["mode", "Hz", "shapes", "bar"],
        rows,
        note,
    )


def frequencies(record: Record) -> Table:
    """Natural frequencies, a mode a row and a model a column."""
    reference = reference_of(record)
    modes = {key: {m.name: m for m in model.modes} for key, model in record.models.items()}
    # a mode stands where the reference has it, else where the first model that has it does
    ordered: dict[str, ModeRecord] = {}
    for key in sorted(modes, key=lambda k: k != reference):
        for name, mode in modes[key].items():
            ordered.setdefault(name, mode)
    rows = []
    for mode in sorted(ordered.values(), key=lambda m: m.frequency_hz or 0.0):
        base = modes.get(reference or "", {}).get(mode.name)
        cells: list[Any] = [
            mode.name,
            (mode.family or DASH, "word text"),
            str(mode.multiplicity),
        ]
        for key, own in modes.items():
            partner = None if key == reference else base
            cells.append(_frequency(own.get(mode.name), partner))
        rows.append(cells)
    note = ""
    if reference:
        note = (
            f"In brackets: against the {model_name(record, reference)}. Two shapes: a pair of the "
            "same frequency in two planes. A dash: not among the modes asked for."
        )
        note += by_plane(ordered)
    return Table(
        "Natural frequencies in Hz, attachments as in the scene",
        ["mode", "family", "shapes", *(capital(model_name(record, key)) for key in modes)],
        rows,
        note,
    )


def _frequency(mode: ModeRecord | None, base: ModeRecord | None) -> str:
    """The frequency of a mode, and in brackets how far it is from that of `base`."""
    if mode is None:
        return DASH
    if mode.frequency_hz == 0:
        return "0 (rigid)"
    apart = relative_change(mode.frequency_hz, base.frequency_hz if base else None)
    return hertz(mode.frequency_hz, DASH) + ("" if apart is None else f" ({pct(apart)})")
