"""A race as a table in the terminal and as a section of the report."""

from __future__ import annotations

from collections.abc import Mapping

from solidgear.comparison.race.figure import race_chart
from solidgear.comparison.race.pareto import Race, Row
from solidgear.comparison.race.rows import error_text, options_text, read_race
from solidgear.show.plot import page_svg
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


def front_rows(race: Race) -> list[tuple[Row, list[str]]]:
    """Return rows on a front over seconds, cheapest first, and their quantities."""
    on = {q: race.front(q) for q in race.reference["values"]}
    rows = []
    for row in race.rows:
        names = [q for q, front in on.items() if any(row is member for member in front)]
        if names:
            rows.append((row, names))
    return sorted(rows, key=lambda pair: pair[0].seconds or 0.0)


def front_columns(race: Race, narrow: bool = False) -> list[Column]:
    """Return columns of the front, for a page or, narrow, for a terminal."""
    names = {"bending 1": "f1"} if narrow else {}

    def error(q: str) -> Column:
        def of(row: tuple[Row, list[str]]) -> str:
            text_ = error_text(race, row[0], q)
            if not narrow:
                return text_
            return text_.replace(" %", "%") + ("*" if q in row[1] else " ")

        return Column(f"error {'' if narrow else 'of '}{names.get(q, q)}", of)

    columns = [
        word("model", lambda row: row[0].series),
        text("options", lambda row: options_text(row[0]) or "default"),
        Column(
            "DOFs" if narrow else "unknowns",
            lambda row: row[0].unknowns,
            count if narrow else grouped,
        ),
        Column("s" if narrow else "seconds", lambda row: row[0].seconds, seconds),
        *map(error, race.reference["values"]),
    ]
    if narrow:
        return columns
    return [*columns, text("on the front of", lambda row: ", ".join(row[1]))]


def front_table(race: Race) -> tuple[Table, str]:
    """Return the Pareto front over seconds in 80 columns, and the meaning of its marks."""
    title = "Pareto front over wall time"
    notes = (
        "*: on the front of this quantity; <: below the error bar of the reference\nafter the "
        "slash: like for like, section ties on both sides; cancellations do not count"
    )
    return Table(title, front_columns(race, True), front_rows(race), style="narrow"), notes


def chart(folder, scene: Mapping) -> bytes | None:
    """Return the chart of a race in its folder for the report; None without a race of this scene."""
    race = _of_scene(folder, scene)
    return None if race is None else page_svg("speed", lambda width: race_chart(race, width))


def _of_scene(folder, scene: Mapping) -> Race | None:
    race = read_race(folder) if folder is not None else None
    return race if race is not None and race.scene == scene else None


def section(folder, scene: Mapping) -> dict | None:
    """Return words and tables of a race in its folder; None without a race of this scene."""
    race = _of_scene(folder, scene)
    if race is None:
        return None
    note = (
        "“<”: below the error bar of the reference, which is shown instead. After the slash: like "
        "for like, with section ties on both sides. Cancellations do not count."
    )
    lost = [
        word("case", lambda r: f"{r.series}, level {r.level}"),
        text("options", options_text),
        Column("status", lambda r: r.status),
        text("reason", lambda r: r.reason),
    ]
    return {
        "caption": CAPTION,
        "tables": [
            Table("The Pareto front over wall time", front_columns(race), front_rows(race), note),
            Table(
                "Set-up, once a process and in none of the times",
                ["what", Column("seconds", write=seconds)],
                list(race.setup.items()),
            ),
            Table(
                "Failed, skipped, or incomplete",
                lost,
                [r for r in race.rows if r.status != "ok" or r.reason],
            ),
        ],
    }
