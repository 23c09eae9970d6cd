"""A race on file: ``rows.csv`` and ``machine.json``, written and read."""

from __future__ import annotations

import csv
import json
import logging
from collections.abc import Iterable, Mapping
from dataclasses import asdict, fields
from operator import itemgetter
from pathlib import Path

from solidgear.comparison.race.pareto import CHARTED, Race, Row
from solidgear.core import whole
from solidgear.show.table import Column, Table
from solidgear.show.words import percent

log = logging.getLogger(__name__)
ROWS, MACHINE, PICTURE = "rows.csv", "machine.json", "speed_accuracy.png"
COSTS = {"seconds": "wall time from scene to both answers, s (median)", "unknowns": "unknowns"}
#: fields of a row that are spread over several columns, or written as text
FOLDED = ("options", "samples", "taken", "values", "errors", "like_for_like")
#: kinds of error in rows.csv besides those charted
WHOLE = "C 6x6"


def write_rows(race: Race, folder: Path) -> None:
    """Write ``rows.csv`` and ``machine.json`` into a folder, each in one step.

    What an earlier race left goes first: its record and its picture must not stand beside these
    rows, should the run be killed.
    """
    record = {f.name: getattr(race, f.name) for f in fields(race) if f.name != "rows"}
    if sum(len(row.samples) for row in race.rows) <= 1:
        for name in (MACHINE, PICTURE):
            (folder / name).unlink(missing_ok=True)
    _table(race).write(folder / ROWS)
    with whole(folder / MACHINE) as half:
        half.write_text(json.dumps(record, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def read_race(folder) -> Race | None:
    """Return the race that `write_rows` left in a folder; None where there is none that can be
    read.
    """
    folder = Path(folder)
    if not (folder / MACHINE).exists() or not (folder / ROWS).exists():
        return None
    try:
        record = dict(json.loads((folder / MACHINE).read_text(encoding="utf-8")))
        with open(folder / ROWS, encoding="utf-8", newline="") as lines:
            race = Race(**record, rows=[_row(line) for line in csv.DictReader(lines)])
        records(race)  # what is not whole shows here, and not in the middle of a page
        return race
    except (OSError, ValueError, KeyError, TypeError) as error:
        log.warning("%s in %s cannot be read: %s", ROWS, folder, error)
        return None


def records(race: Race) -> list[dict]:
    """Return one flat record a row, as in ``rows.csv``; missing values are None."""
    fronts = {(q, cost): race.front(q, cost) for q in race.reference["values"] for cost in COSTS}
    out = []
    for row in race.rows:
        record = {name: value for name, value in asdict(row).items() if name not in FOLDED}
        record["options"] = options_text(row)
        record["runs"] = len(row.samples)
        record["seconds_min"] = min(row.samples, default=None)
        record["seconds_median"] = row.seconds
        record["seconds_max"] = max(row.samples, default=None)
        record["samples"] = " ".join(repr(s) for s in row.samples)
        for q in CHARTED:
            record[_column(q)] = row.values.get(q)
        for quantity in (*CHARTED, WHOLE):
            record[f"error_{_column(quantity)}"] = row.errors.get(quantity)
        for q in CHARTED:
            record[f"like_for_like_{_column(q)}"] = row.like_for_like.get(q)
        for q in race.reference["values"]:
            record[f"resolved_{_column(q)}"] = _resolved(race, row, q)
            on = [cost for cost in COSTS if any(row is member for member in fronts[q, cost])]
            record[f"front_{_column(q)}"] = " ".join(on)
        out.append(record)
    return out


def _resolved(race: Race, row: Row, quantity: str) -> str:
    """Return ``yes`` for an error above the reference's error bar, else ``no``; empty without an
    error.
    """
    if quantity not in row.errors:
        return ""
    return "yes" if race.resolved(row, quantity) else "no"


def options_text(row: Row) -> str:
    """Return the builder options as they follow ``--set``."""
    parts = []
    for name, value in row.options.items():
        parts.append(f"{name}={value:.6g}" if isinstance(value, float) else f"{name}={value}")
    return " ".join(parts)


def error_text(race: Race, row: Row, quantity: str) -> str:
    """Return the error of a row in per cent, with a beam's like for like after a slash."""
    error = race.error(row, quantity)
    if error is None:
        return row.reason or row.status if row.status != "ok" else f"found no {quantity}"
    text = percent(error, signed=False)
    if not race.resolved(row, quantity):
        text = f"< {text}"
    like = row.like_for_like.get(quantity)
    return text if like is None else f"{text} / {percent(like, signed=False)}"


def _column(quantity: str) -> str:
    return quantity.replace(" ", "_")


def _table(race: Race) -> Table:
    rows = records(race)
    columns = [Column(name, itemgetter(name), str) for name in (rows[0] if rows else ())]
    return Table("", columns, rows)


def _row(line: Mapping[str, str]) -> Row:
    options = dict(pair.split("=", 1) for pair in line["options"].split())
    return Row(
        family=line["family"],
        series=line["series"],
        level=int(line["level"]),
        model=line["model"],
        options={name: _value(text) for name, text in options.items()},
        status=line["status"],
        reason=line["reason"],
        unknowns=int(line["unknowns"]) if line["unknowns"] else None,
        samples=[float(s) for s in line["samples"].split()],
        values=_numbers(line, CHARTED, ""),
        errors=_numbers(line, (*CHARTED, WHOLE), "error_"),
        like_for_like=_numbers(line, CHARTED, "like_for_like_"),
    )


def _numbers(line: Mapping[str, str], quantities: Iterable[str], prefix: str) -> dict[str, float]:
    """Return the numbers of a line, by quantity; empty cells are left out."""
    numbers = {}
    for quantity in quantities:
        text = line.get(prefix + _column(quantity))
        if text:
            numbers[quantity] = float(text)
    return numbers


def _value(text: str):
    try:
        return json.loads(text)
    except ValueError:
        return text


def left_out(race: Race) -> str:
    """Return the levels that were left out, in a line; empty when there are none."""
    first: dict[str, int] = {}
    for r in race.rows:
        if r.status == "left out":
            first[r.series] = min(r.level, first.get(r.series, r.level))
    return ", ".join(f"{series} from level {level}" for series, level in first.items())
