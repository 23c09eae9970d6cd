"""The run in a terminal: the final table, the verdict, matrices and modes.

Everything fits 80 columns and says the same without colour. Texts out of a scene go through
`rich.text.Text`, so that a name with brackets in it stays a name.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from solidgear.frames import DOF_NAMES
from solidgear.judge.record import ModelRecord, ModeRecord, Record, VerdictRecord
from solidgear.quantity import BLOCK_UNITS, C_ZZ, FIRST_BENDING
from solidgear.report import reading, words
from solidgear.report.border import as_record
from solidgear.report.units import SI, Units, in_ascii, units_named
from solidgear.report.words import NOTHING

if TYPE_CHECKING:
    import numpy as np

NOT_RESOLVED = "n.r."
#: figures of a coupling that is next to nothing
WEAK = 3
#: validity -> how it is written in a narrow column
VALID = {"yes": "yes", "no": "NO", "open": "?", "unknown": "?"}
#: heads of the columns of numbers in the final table, and their units in SI
COLUMNS = {
    "K_zz": "N/m",
    "C_zz": "m/N",
    "f1": "Hz",
    "dC_zz": "",
    "df1": "",
    "band C": "",
    "DOFs": "",
    "time": "s",
}


def final_table(
    found: Record | Mapping[str, Any], units: str | Units | None = None
) -> RenderableType:
    """One line a model: validity, K_zz, C_zz, first bending, deviation from the reference, band,
    size, time.

    Parameters
    ----------
    found : Record or mapping
        What a run found; missing parts show as a dash.
    units : str or Units, optional
        ``engineering``, ``si`` or ``us``; by default what the record was shown in.

    Returns
    -------
    rich renderable
        A table of at most 80 columns, and below it what its marks mean and why a model must not be
        trusted.

    Raises
    ------
    SolidgearError
        For plain data that is no record of this version, or unknown units.
    """
    record = as_record(found)
    chosen = units_named(units or record.shown_in)
    table = Table(box=box.SIMPLE_HEAD, padding=0, pad_edge=False)
    table.add_column("model", no_wrap=True)
    table.add_column("valid", justify="center", no_wrap=True)
    for name, si in COLUMNS.items():
        head = f"{name}\n{in_ascii(chosen.unit(si))}" if si else name.replace(" ", "\n")
        table.add_column(head, justify="right", no_wrap=True)
    unresolved = False
    for key, model in record.models.items():
        cells = [_against_reference(record, key, quantity) for quantity in (C_ZZ, FIRST_BENDING)]
        unresolved = unresolved or NOT_RESOLVED in cells
        table.add_row(
            Text(reading.heading(record, key)[:10]),
            VALID[reading.validity(model)],
            in_ascii(chosen.number(reading.entry(model.stiffness, 2, 2), "N/m", 4)),
            in_ascii(chosen.number(reading.entry(model.compliance, 2, 2), "m/N", 4)),
            words.hertz(reading.first_frequency(model, "bending")),
            *cells,
            words.band_percent(model.band.compliance if model.band else None),
            words.count(model.dofs),
            words.seconds(reading.answer_seconds(model)),
        )
    notes = [Text(note) for note in _notes(record, unresolved)]
    notes += [Text(line) for line in _further_points(record, chosen)]
    reasons = [_reason(record, key, model) for key, model in record.models.items()]
    return Group(table, *notes, *(reason for reason in reasons if reason is not None))


def _notes(record: Record, unresolved: bool) -> list[str]:
    """What the marks of the final table mean."""
    notes = []
    reference = reading.reference_of(record)
    if reference:
        notes.append(
            f"d: difference from the {reading.model_name(record, reference)} (ref.); "
            "a beam's is taken with section ties on both sides"
        )
    if any(reading.validity(m) == "open" for m in record.models.values()):
        notes.append("?: not judged, or too close to the tolerance to tell")
    if unresolved:
        notes.append("n.r.: not resolved, the difference lies inside the bands of the two models")
    if record.models:
        notes.append(
            "band: mesh uncertainty of the worst compliance; "
            "time: building and solving, without the evidence"
        )
    if not record.complete:
        notes.append("INCOMPLETE: the run was interrupted; what is missing shows as a dash")
    return notes


def _further_points(record: Record, units: Units) -> list[str]:
    """Compliance at further lumped points, a line each, and the main point by name."""
    if not record.further_ports:
        return []
    lines = [f"the table is of {record.port.name if record.port else 'the first point'}"]
    for port in record.further_ports:
        told = []
        for key, model in record.models.items():
            found = model.points.get(port.name)
            own = reading.entry(found.compliance, 2, 2) if found else None
            value = in_ascii(units.number(own, "m/N", 4))
            apart = _against_reference(record, key, C_ZZ.at(port.name))
            told.append(f"{reading.heading(record, key)} {value} ({apart})")
        lines.append(f"C_zz at {port.name}, {in_ascii(units.unit('m/N'))}: {', '.join(told)}")
    return lines


def _reason(record: Record, key: str, model: ModelRecord) -> Text | None:
    """Why a model must not be trusted, or cannot be judged."""
    worth = reading.validity(model)
    if worth not in ("no", "open"):
        return None
    why = model.why_not or "not valid for this scene"
    return Text(f"{VALID[worth]:<4}{reading.model_name(record, key)}: {why}")


def _against_reference(record: Record, key: str, quantity: str) -> str:
    """The difference of a model from the reference, for one cell."""
    if key == reading.reference_of(record):
        return "ref."
    row = reading.headline(record, key, quantity)
    if row is None:
        return NOTHING
    return words.percent(row.relative) if reading.is_resolved(row) else NOT_RESOLVED


def closing_lines(found: Record | Mapping[str, Any]) -> list[str]:
    """What else a reader must know: cautions, which modes were counted, seconds and peak memory
    (plain text).
    """
    record = as_record(found)
    lines = [f"caution: {w}" for w in record.warnings]
    if bearings := reading.left_open(record):
        lines.append(f"{bearings}.")
    trusted = record.verdict.trust
    counted = reading.model_of(record, trusted).evidence.complete
    if counted:
        name = reading.model_name(record, trusted)
        lines.append(f"{name[0].upper()}{name[1:]}: {counted[0].lower()}{counted[1:]}")
    if record.seconds_total is not None:
        lines.append(f"Solved in {words.seconds(record.seconds_total)} s{_memory(record)}.")
    return lines


def _memory(record: Record) -> str:
    """Peak memory beside its estimate."""
    if record.peak_mb is None:
        return ""
    peak = f", peak memory {record.peak_mb:.0f} MB"
    if record.expected_peak_mb is not None:
        peak += f" ({record.expected_peak_mb:.0f} MB estimated)"
    return peak


def verdict_text(found: Record | Mapping[str, Any]) -> str:
    """The verdict in plain words, one statement a line (plain text: print it without markup)."""
    record = as_record(found)
    verdict = record.verdict
    if verdict == VerdictRecord():
        return "No verdict: the run did not get that far."
    trusted = "none of the models that ran"
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
    """A 6x6 with its units; free components (None or NaN) show as a dash.

    Parameters
    ----------
    matrix : (6, 6) array_like
        SI, order x y z thx thy thz.
    kind : {'stiffness', 'compliance'}
    units : str or Units
        To show it in.
    title : str
        By default the kind.
    sizes : two lists of six numbers, optional
        Diagonal entries beside which a coupling may be next to nothing, of rows and of columns; by
        default those of the matrix.

    Returns
    -------
    rich.table.Table
    """
    chosen = units_named(units)
    same, mixed, turn = BLOCK_UNITS[kind]
    rows = matrix.tolist() if hasattr(matrix, "tolist") else matrix
    table = Table(
        box=box.SIMPLE_HEAD,
        padding=0,
        pad_edge=False,
        title=Text(
            f"{title or kind}, {chosen.title}",
            "table.title",
        ),
        title_justify="left",
    )
    table.add_column("")
    for name in DOF_NAMES:
        table.add_column(name, justify="right", no_wrap=True)
    for block, pair in enumerate(((same, mixed), (mixed, turn))):
        left, right = (in_ascii(chosen.unit(si)) for si in pair)
        table.add_row("", "", left, "", "", right, "", style="dim")
        for i in range(3 * block, 3 * block + 3):
            cells = []
            for j, value in enumerate(rows[i]):
                # a weak coupling has few figures that mean something, and a row has 80 columns
                faint = (
                    reading.is_nothing(value, sizes[0][i], sizes[1][j])
                    if sizes
                    else reading.is_faint(rows, i, j)
                )
                digits = WEAK if not chosen.exponents and faint else 5
                cells.append(in_ascii(chosen.number(value, pair[j // 3], digits)))
            table.add_row(DOF_NAMES[i], *cells, end_section=i == 2)
    return table


def modes_table(
    modes: Sequence[ModeRecord | Mapping[str, Any]], bars: Mapping[str, float] | None = None
) -> Table:
    """Natural frequencies with names and multiplicity, and relative bars by name where there are
    any.
    """
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("mode")
    table.add_column("family")
    table.add_column("frequency, Hz", justify="right")
    table.add_column("shapes", justify="right")
    if bars:
        table.add_column("bar", justify="right")
    for mode in map(ModeRecord.model_validate, modes):
        bar = (bars or {}).get(mode.name or "")
        table.add_row(
            Text(mode.name or NOTHING),
            Text(mode.family or NOTHING),
            words.hertz(mode.frequency_hz),
            str(mode.multiplicity),
            *(["" if bar is None else words.percent(bar, signed=False)] * bool(bars)),
        )
    return table
