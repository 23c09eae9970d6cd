"""A race as a table in the terminal and as a section of the report."""

from __future__ import annotations

from collections.abc import Mapping

from solidgear.judge.race.pareto import Race, Row
from solidgear.report.cells import whole_number
from solidgear.report.plot import page_svg
from solidgear.report.race_figure import race_chart
from solidgear.report.race_rows import error_text, options_text, read_race
from solidgear.report.table import Table
from solidgear.report.words import count, seconds

CAPTION = (
    "Error against the refined harmonic solid with the attachments of the scene, over wall time "
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
    "arrow, on the edge of the shaded band, lie "
    "below what the reference resolves. Crosses at the top failed, or found no such number; the "
    "reason is in rows.csv."
)


def front_rows(race: Race) -> list[tuple[Row, list[str]]]:
    """Rows on a front over seconds, cheapest first, and of which quantities."""
    on = {q: race.front(q) for q in race.reference["values"]}
    rows = []
    for row in race.rows:
        names = [q for q, front in on.items() if any(row is other for other in front)]
        if names:
            rows.append((row, names))
    return sorted(rows, key=lambda pair: pair[0].seconds or 0.0)


def front_table(race: Race):
    """The Pareto front over seconds as a rich table of 80 columns."""
    from rich import box
    from rich.console import Group
    from rich.table import Table as RichTable
    from rich.text import Text

    names = {"bending 1": "f1"}
    table = RichTable(
        box=box.SIMPLE_HEAD,
        padding=0,
        collapse_padding=True,
        pad_edge=False,
        title="Pareto front over wall time",
        title_justify="left",
    )
    table.add_column("model", no_wrap=True)
    table.add_column("options")
    for head in ("DOFs", "s", *(f"error {names.get(q, q)}" for q in race.reference["values"])):
        table.add_column(head, justify="right", no_wrap=True)
    for row, on in front_rows(race):
        errors = []
        for q in race.reference["values"]:
            mark = "*" if q in on else " "
            errors.append(error_text(race, row, q).replace(" %", "%") + mark)
        table.add_row(
            Text(row.series),
            Text(options_text(row) or "default"),
            count(row.unknowns),
            seconds(row.seconds),
            *errors,
        )
    notes = (
        "*: on the front of this quantity; <: below the band of the reference\n"
        "after the stroke: like for like, section ties on both sides; no cancellation counts"
    )
    return Group(table, Text(notes))


def chart(folder, scene: Mapping) -> bytes | None:
    """The chart of a race in its folder, ready to stand in the report; None where there is none of
    this scene.
    """
    race = _of_scene(folder, scene)
    return None if race is None else page_svg("speed", lambda width: race_chart(race, width))


def _of_scene(folder, scene: Mapping) -> Race | None:
    race = read_race(folder) if folder is not None else None
    return race if race is not None and race.scene == scene else None


def section(folder, scene: Mapping) -> dict | None:
    """What the report shows of a race in its folder beside its chart: words and tables; None where
    there is none of this scene.
    """
    race = _of_scene(folder, scene)
    if race is None:
        return None
    head = [
        "model",
        "options",
        "unknowns",
        "seconds",
        *(f"error of {q}" for q in race.reference["values"]),
        "on the front of",
    ]
    note = (
        "“<”: below the band of the reference, which is shown instead. After the stroke: "
        "like for like, with section ties on both sides. No cancellation counts on the front."
    )
    rows = []
    for r, on in front_rows(race):
        errors = (error_text(race, r, q) for q in race.reference["values"])
        rows.append(
            [
                r.series,
                (options_text(r) or "default", "text"),
                whole_number(r.unknowns),
                seconds(r.seconds),
                *errors,
                (", ".join(on), "text"),
            ]
        )
    lost = [
        [f"{r.series}, level {r.level}", (options_text(r), "text"), r.status, (r.reason, "text")]
        for r in race.rows
        if r.status != "ok" or r.reason
    ]
    return {
        "caption": CAPTION,
        "tables": [
            Table("The Pareto front over wall time", head, rows, note),
            Table(
                "Set-up, once a process and in none of the times",
                ["what", "seconds"],
                [[k, seconds(v)] for k, v in race.setup.items()],
            ),
            Table(
                "Failed, left out, or with something missing",
                ["case", "options", "status", "reason"],
                lost,
            ),
        ],
    }
