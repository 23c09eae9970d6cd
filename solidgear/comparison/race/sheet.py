"""A race as its command shows it: in the terminal and as a section of the report."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from solidgear.comparison.race.figure import race_chart
from solidgear.comparison.race.race import PICTURE, ROWS, Race, Row, records
from solidgear.core import Quantity
from solidgear.core.plain import plain
from solidgear.core.quantity import FIRST_BENDING
from solidgear.show.command import caution
from solidgear.show.sheet import Section, Sheet, Terminal
from solidgear.show.table import Column, Table, text, word
from solidgear.show.words import count, grouped, seconds

CAPTION = (
    "Error against the refined reference with the attachments of the scene, over wall time "
    "and over unknowns. Solid lines: meshes graded to shoulders and seat ends; dashed and pale: "
    "uniform. Thin bars: fastest and slowest run. Beams tie to nodes and cannot average over a "
    "seat: filled is the error a user of this scene makes, tie included; hollow, at the other end "
    "of the dotted line, the error against the solid with section ties, like for like; where the "
    "hollow one lies higher, errors cancel. A sharp dip of a curve is a change of sign, not a "
    "good mesh. The grey steps are the Pareto front, on which no cancellation counts: a beam "
    "stands there with the larger of its two errors, a mesh with the largest of its own and those "
    "of finer meshes of its series. Black stars: the automatic choice at the tolerance beside it, "
    "all meshes that it tried in its time and the largest system that it solved in its unknowns; "
    "it knows its error, the others do not. Points with an "
    "arrow, on the edge of the shade, lie "
    "below what the reference resolves. Crosses at the top failed, or found no such number; the "
    "reason is in rows.csv."
)


def sheet(race: Race, out: Path, reported: bool, cautions: Sequence[str] = ()) -> Sheet:
    """Return the sheet of a race whose files are in a folder, and in a report there or not."""
    part = section(race)
    notes = [
        "*: on the front of this quantity; <: below the error bar of the reference\nafter the "
        "slash: like for like, section ties on both sides; cancellations do not count"
    ]
    for row in race.rows:
        if row.status == "failed":
            notes.append(f"failed: {row.series}, level {row.level}: {row.reason}")
    lines = []
    if race.left_out:
        lines.append(
            f"left out ({race.budget:g} s of processor time for the points; reasons in "
            f"{out / ROWS}): {race.left_out}"
        )
    written = f", and in {out / 'report.html'}" if reported else ""
    return Sheet(
        name="chart",
        title=part.title,
        lead=part.words,
        tables=part.tables,
        data={
            "scene": race.scene["name"],
            "complete": race.complete,
            "reference": plain(race.reference),
            "setup": race.setup,
            "seconds": race.seconds,
            "rows": records(race),
            "cautions": cautions,
        },
        cautions=cautions,
        sections=[part],
        terminal=Terminal(
            heading=[],
            tables=[_front(race, narrow=True)],
            closing=[*notes, *map(caution, cautions)],
            unbroken=[*lines, f"Chart: {out / PICTURE}{written}"],
        ),
        exit_code=0 if race.complete else 130,
    )


def front_rows(race: Race) -> list[tuple[Row, list[Quantity]]]:
    """Return rows on a front over seconds, cheapest first, and their quantities."""
    on = {q: race.front(q) for q in race.reference.values}
    rows = []
    for row in race.rows:
        names = [q for q, front in on.items() if any(row is member for member in front)]
        if names:
            rows.append((row, names))
    return sorted(rows, key=lambda pair: pair[0].seconds or 0.0)


def _front(race: Race, narrow: bool) -> Table:
    """Return the Pareto front over seconds, for a page or, narrow, in 80 columns."""
    quantities = list(race.reference.values)
    columns = [word("model"), text("options")]
    if narrow:
        heads = {FIRST_BENDING: "f1"}
        columns += [Column("DOFs", write=count), Column("s", write=seconds)]
        columns += [Column(f"error {heads.get(q, q)}") for q in quantities]
    else:
        columns += [Column("unknowns", write=grouped), Column("seconds", write=seconds)]
        columns += [*(Column(f"error of {q}") for q in quantities), text("on the front of")]
    rows = []
    for row, names in front_rows(race):
        errors = [race.error_text(row, q) for q in quantities]
        if narrow:
            marks = ["*" if q in names else " " for q in quantities]
            errors = [f"{error.replace(' %', '%')}{mark}" for error, mark in zip(errors, marks)]
        cells = [row.series, row.setting or "default", row.unknowns, row.seconds]
        rows.append([*cells, *errors, ", ".join(names)])
    if narrow:
        return Table("Pareto front over wall time", columns, rows, style="narrow")
    note = (
        "“<”: below the error bar of the reference, which is shown instead. After the slash: like "
        "for like, with section ties on both sides. Cancellations do not count."
    )
    return Table("The Pareto front over wall time", columns, rows, note)


def section(race: Race) -> Section:
    """Return the section of the report on a race."""
    lost = [
        [f"{row.series}, level {row.level}", row.setting, row.status, row.reason]
        for row in race.rows
        if row.status != "ok" or row.reason
    ]
    setup = "Set-up, once a process and in none of the times"
    columns = [word("case"), text("options"), "status", text("reason")]
    return Section(
        anchor="speed",
        title="Speed against accuracy",
        words=CAPTION,
        charts={"speed": partial(race_chart, race)},
        tables=[
            _front(race, narrow=False),
            Table(setup, ["what", Column("seconds", write=seconds)], list(race.setup.items())),
            Table("Failed, skipped, or incomplete", columns, lost),
        ],
    )
