"""A comparison in a terminal: a line a model, the verdict, cautions and cost.

Everything fits 80 columns and says the same without colour.
"""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Group
from rich.text import Text

from solidgear.comparison.page.tables import NOT_RESOLVED, apart
from solidgear.core import Quantity, Record
from solidgear.core.judge.record import ModelRecord, VerdictRecord
from solidgear.core.quantity import C_ZZ, FIRST_BENDING, K_ZZ
from solidgear.show import open_words
from solidgear.show.command import caution
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import MARK, Cell, Column, Table, word
from solidgear.show.units import Units, in_ascii, units_named
from solidgear.show.words import DASH, bar_percent, count, hertz, seconds

#: validity -> how it is written in a narrow column
VALID = {"yes": "yes", "no": "NO", "open": "?", "unknown": "?"}


def sheet(record: Record, files: Sequence[str] = (), exit_code: int = 0) -> Sheet:
    """Return the sheet of a comparison, with sentences on files; the report is a page of its own."""
    return Sheet(
        name="results",
        title=record.scene.get("title") or record.scene.get("name") or "shaft",
        lead="",
        tables=[],
        data=record.as_dict(),
        verdict=verdict_lines(record),
        terminal=Terminal(
            heading=[],
            tables=[final_table(record)],
            closing=[],
            unbroken=[*_closing(record), *files],
        ),
        exit_code=exit_code,
    )


def final_table(record: Record) -> Group:
    """Return one line per model in at most 80 columns, with notes and reasons below; missing parts
    are dashes.
    """
    units = units_named(record.shown_in)
    columns = [
        word("model"),
        Column("valid", kind=MARK),
        *(f"{name}\n{units.unit(name.unit)}" for name in (K_ZZ, C_ZZ)),
        Column(f"fb1\n{units.unit('Hz')}", write=hertz),
        "dC_zz",
        "dfb1",
        Column("bar\nC", write=bar_percent),
        Column("DOFs", write=count),
        Column(f"time\n{units.unit('s')}", write=seconds),
    ]
    rows = [
        [
            _heading(model, key)[:10],
            VALID[model.validity],
            *(_number(model, name, units) for name in (K_ZZ, C_ZZ)),
            model.first_frequency("bending"),
            apart(record, key, C_ZZ, narrow=True),
            apart(record, key, FIRST_BENDING, narrow=True),
            model.band.compliance if model.band else None,
            model.dofs,
            model.answer_seconds,
        ]
        for key, model in record.models.items()
    ]
    table = Table("", columns, rows, style="narrow")
    lines = _marks(record, any(NOT_RESOLVED in row for row in table.values))
    if record.further_ports:
        lines.append(f"the table is for {record.port.name if record.port else 'the first point'}")
    for port in record.further_ports:
        name = C_ZZ.at(port.name)
        values = []
        for key, model in record.models.items():
            difference = apart(record, key, name, narrow=True) or Cell(DASH)
            value = _number(model, name, units)
            values.append(f"{_heading(model, key)} {value} ({difference.value})")
        lines.append(in_ascii(f"C_zz at {port.name}, {units.unit('m/N')}: {', '.join(values)}"))
    for key, model in record.models.items():
        if model.validity in ("no", "open"):
            reason = model.why_not or "not valid for this scene"
            lines.append(f"{VALID[model.validity]:<4}{record.name(key)}: {reason}")
    return Group(table, *map(Text, lines))


def _heading(model: ModelRecord, key: str) -> str:
    """Return the name of a model at the head of a narrow column."""
    return model.short or model.title or key


def _number(model: ModelRecord, name: Quantity, units: Units) -> str:
    return units.number(model.value(name), name.unit, 4)


def _marks(record: Record, unresolved: bool) -> list[str]:
    """Return the meaning of the marks of the final table."""
    notes = []
    if record.reference:
        name = record.name(record.reference)
        notes.append(f"d: difference from the {name} (ref.), with equal seats")
    if any(model.validity == "open" for model in record.models.values()):
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


def verdict_lines(record: Record) -> list[str]:
    """Return the verdict in plain words (plain text: print it without markup)."""
    verdict = record.verdict
    if verdict == VerdictRecord():
        return ["No verdict: the run was interrupted before."]
    lines = [f"Trust: {record.name(verdict.trust) if verdict.trust else 'no model that ran'}"]
    if verdict.tolerance is not None:
        cheapest = "none below the reference"
        if verdict.cheapest:
            cheapest = record.name(verdict.cheapest)
        lines.append(f"Cheapest model within {100 * verdict.tolerance:.4g} %: {cheapest}")
    return lines + [f"- {sentence}" for sentence in verdict.sentences]


def _closing(record: Record) -> list[str]:
    """Return lines below a verdict: cautions, ranges, modes counted, seconds and peak memory."""
    lines = [record.load_case] if record.load_case else []
    lines += [caution(text) for text in record.warnings]
    ranges = ", ".join(" ".join(part) for part in open_words.parts(record.open, FIRST_BENDING))
    remark = open_words.remark(record.open)
    if ranges:
        lines.append(f"First bending: {ranges}. {remark}")
    elif remark:
        lines.append(remark)
    trusted = record.verdict.trust
    counted = record.model(trusted).evidence.complete
    if trusted and counted:
        lines.append(f"{record.title(trusted)}: {counted[0].lower()}{counted[1:]}")
    if record.seconds_total is not None:
        lines.append(_taken(record))
    return lines


def _taken(record: Record) -> str:
    """Return the sentence on seconds and peak memory of a run, and of its solution alone."""
    time, memory = f"Took {seconds(record.seconds_total)} s", ""
    if record.seconds_solved is not None:
        time += f" (solving: {seconds(record.seconds_solved)} s)"
    if record.peak_mb_total is not None and record.peak_mb is not None:
        memory = f", peak memory {record.peak_mb_total:.0f} MB (solving: {record.peak_mb:.0f} MB"
        if record.expected_peak_mb is not None:
            memory += f", {record.expected_peak_mb:.0f} MB estimated"
        memory += ")"
    return f"{time}{memory}."
