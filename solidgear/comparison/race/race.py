"""Error against cost: discretisations of one scene, and those that no other beats in both; on file
as ``rows.csv`` and ``machine.json``.

The error is that against the model that judges the scene, refined; the error bar of that model is
the floor: no smaller error is resolved.
"""

from __future__ import annotations

import csv
import json
import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from solidgear.core import Quantity, environment
from solidgear.core.plain import plain
from solidgear.core.quantity import C_ZZ, FIRST_BENDING
from solidgear.show.sheet import write_json
from solidgear.show.table import Column, Table
from solidgear.show.words import percent

log = logging.getLogger(__name__)

#: charted quantities, as named in `quantities`
CHARTED = (C_ZZ, FIRST_BENDING)
#: the family and the series of the automatic choice
AUTOMATIC = "automatic"
ROWS, MACHINE, PICTURE = "rows.csv", "machine.json", "speed_accuracy.png"
COSTS = {"seconds": "wall time from scene to both answers, s (median)", "unknowns": "unknowns"}
#: kinds of error in rows.csv besides those charted
WHOLE = "C 6x6"


@dataclass
class Row:
    """One discretisation and the result."""

    family: str  #: lumped, beam, harmonic, tetrahedra or hexahedra
    series: str  #: cases of ever higher cost belong to one series, such as ``HEX20 graded``
    level: int  #: place in the series, from 1
    model: str  #: lumped, euler, timoshenko, harmonic or solid
    options: dict[str, Any]  #: of the builder
    status: str = "waiting"  #: ``waiting``, ``ok``, ``failed`` or ``left out``
    reason: str = ""  #: why it failed, was left out, lacks a number or has fewer runs
    unknowns: int | None = None
    #: wall seconds of every run; of a failed case the seconds until it failed
    samples: list[float] = field(default_factory=list)
    #: values, errors, like_for_like: by quantity: SI value; ``|value / reference - 1|``; for beams
    #: and lumped models the same against the reference with section ties. ``errors`` also has ``C
    #: 6x6``: the largest ``|dC_ij| / sqrt(C_ii C_jj)`` over the motions that something resists.
    values: dict[str, float] = field(default_factory=dict)
    errors: dict[str, float] = field(default_factory=dict)
    like_for_like: dict[str, float] = field(default_factory=dict)
    #: s of processor time of every run, which a budget counts; not written
    processor_seconds: list[float] = field(default_factory=list, compare=False)

    @property
    def seconds(self) -> float | None:
        """Median wall time, s."""
        return median(self.samples) if self.samples else None

    def before(self, row: Row) -> bool:
        """Return whether this is a coarser level of the same series."""
        return self.series == row.series and self.level < row.level

    def note(self, text: str) -> None:
        """Add to the reason."""
        if text not in self.reason:
            self.reason = "; ".join(filter(None, (self.reason, text)))

    @property
    def costs(self) -> dict[str, float | None]:
        """Costs by their names in ``COSTS``."""
        return {"seconds": self.seconds, "unknowns": self.unknowns}

    @property
    def setting(self) -> str:
        """The builder options as they follow ``--set``."""
        options = {k: f"{v:.6g}" if isinstance(v, float) else v for k, v in self.options.items()}
        return " ".join(f"{name}={value}" for name, value in options.items())


@dataclass
class Reference:
    """The model that errors are against, solved on a mesh refined to an error bar."""

    model: str  #: its title
    options: dict[str, Any]
    setting: str
    unknowns: int
    seconds: float
    values: dict[Quantity, float]  #: by quantity
    bands: dict[Quantity, float]  #: relative error bar by quantity
    like_for_like: dict[Quantity, float] = field(default_factory=dict)  #: values with section ties

    @property
    def costs(self) -> dict[str, float]:
        """Costs by their names in ``COSTS``."""
        return {"seconds": self.seconds, "unknowns": self.unknowns}


@dataclass
class Race:
    """Rows of a chart of error against cost, and their reference."""

    scene: dict[str, Any]
    reference: Reference
    rows: list[Row] = field(repr=False)
    setup: dict[str, float]  #: seconds a process pays once, by purpose
    #: runs, modes: runs asked for; elastic shapes that every model is asked for
    runs: int
    modes: int
    budget: float  #: allowed for the rows, s of processor time
    seconds: float = 0.0  #: used for all, the reference included
    complete: bool = True  #: false after an interrupt
    environment: dict[str, Any] = field(default_factory=environment)

    def error(self, row: Row, quantity: Quantity) -> float | None:
        """Return the error of a row, never below the error bar of the reference; None where the row
        has none.
        """
        error = row.errors.get(quantity)
        if row.status != "ok" or error is None:
            return None
        return max(error, self.reference.bands[quantity])

    def sure_error(self, row: Row, quantity: Quantity) -> float | None:
        """Return the largest of the error a user makes, the one like for like, and those of finer
        levels of the series.

        A cancellation of errors earns no place on the front: neither a tie that makes up for a
        beam's stiffness, nor a coarse mesh whose error changes sign and so beats finer ones of the
        same series.
        """
        error = self.error(row, quantity)
        if error is None:
            return None
        finer = [self.error(r, quantity) or 0.0 for r in self.rows if row.before(r)]
        return max(error, row.like_for_like.get(quantity, 0.0), *finer)

    def resolved(self, row: Row, quantity: Quantity) -> bool:
        """Return whether the error of a row lies above the error bar of the reference."""
        return row.errors.get(quantity, 0.0) > self.reference.bands[quantity]

    def error_text(self, row: Row, quantity: Quantity) -> str:
        """Return the error of a row in per cent, with a beam's like for like after a slash."""
        error = self.error(row, quantity)
        if error is None:
            return row.reason or row.status if row.status != "ok" else f"found no {quantity}"
        text = percent(error, signed=False)
        if not self.resolved(row, quantity):
            text = f"< {text}"
        like = row.like_for_like.get(quantity)
        return text if like is None else f"{text} / {percent(like, signed=False)}"

    def front(self, quantity: Quantity, cost: str = "seconds") -> list[Row]:
        """Return the rows on the Pareto front of a quantity over ``seconds`` or ``unknowns``,
        cheapest first.
        """
        places = front(
            [row.costs[cost] for row in self.rows],
            [self.sure_error(row, quantity) for row in self.rows],
        )
        return [self.rows[k] for k in places]

    @property
    def left_out(self) -> str:
        """The levels that were left out, in a line; empty when there are none."""
        first: dict[str, int] = {}
        for row in self.rows:
            if row.status == "left out":
                first[row.series] = min(row.level, first.get(row.series, row.level))
        return ", ".join(f"{series} from level {level}" for series, level in first.items())


def front(cost: Sequence[float | None], error: Sequence[float | None]) -> list[int]:
    """Return the places of the points that no other beats: none is at least as good in both and
    better in one.

    In ascending order of cost; points with None or NaN take no part, and the first of equal ones
    counts.
    """
    points = [
        (c, e, k)
        for k, (c, e) in enumerate(zip(cost, error))
        if c is not None and e is not None and np.isfinite(c) and np.isfinite(e)
    ]
    out, best = [], np.inf
    for _, e, k in sorted(points):
        if e < best:
            out.append(k)
            best = e
    return out


def write_rows(race: Race, folder: Path) -> None:
    """Write ``rows.csv`` and ``machine.json`` into a folder, each in one step.

    What an earlier race left goes first: its record and its picture must not stand beside these
    rows, should the run be killed.
    """
    if sum(len(row.samples) for row in race.rows) <= 1:
        for name in (MACHINE, PICTURE):
            (folder / name).unlink(missing_ok=True)
    rows = records(race)
    heads = list(rows[0]) if rows else []
    lines = [list(row.values()) for row in rows]
    Table("", [Column(head, write=str) for head in heads], lines).write(folder / ROWS)
    write_json(folder / MACHINE, plain(race))


def race_of(folder: Path, scene: Mapping[str, Any]) -> Race | None:
    """Return the race of a scene in a folder; None without one."""
    race = read_race(folder)
    return race if race is not None and race.scene == scene else None


def read_race(folder: Path) -> Race | None:
    """Return the race that `write_rows` left in a folder; None where there is none that can be
    read.
    """
    if not (folder / MACHINE).exists() or not (folder / ROWS).exists():
        return None
    try:
        record = dict(json.loads((folder / MACHINE).read_text(encoding="utf-8")))
        record["reference"] = Reference(**record["reference"])
        with open(folder / ROWS, encoding="utf-8", newline="") as lines:
            race = Race(**record, rows=[_row(line) for line in csv.DictReader(lines)])
        records(race)  # what is not whole shows here, and not in the middle of a page
        return race
    except (OSError, ValueError, KeyError, TypeError) as error:
        log.warning("%s in %s cannot be read: %s", ROWS, folder, error)
        return None


def records(race: Race) -> list[dict[str, Any]]:
    """Return one flat record a row, as in ``rows.csv``; missing values are None."""
    judged = list(race.reference.values)
    fronts = {(q, cost): race.front(q, cost) for q in judged for cost in COSTS}
    out = []
    for row in race.rows:
        record: dict[str, Any] = {
            "family": row.family,
            "series": row.series,
            "level": row.level,
            "model": row.model,
            "status": row.status,
            "reason": row.reason,
            "unknowns": row.unknowns,
            "options": row.setting,
            "runs": len(row.samples),
            "seconds_min": min(row.samples, default=None),
            "seconds_median": row.seconds,
            "seconds_max": max(row.samples, default=None),
            "samples": " ".join(map(repr, row.samples)),
        }
        for prefix, by_quantity, names in _spread(row):
            record |= {_column(prefix, q): by_quantity.get(q) for q in names}
        for q in judged:
            resolved = "yes" if race.resolved(row, q) else "no"
            on = [cost for cost in COSTS if any(row is member for member in fronts[q, cost])]
            record[_column("resolved_", q)] = resolved if q in row.errors else ""
            record[_column("front_", q)] = " ".join(on)
        out.append(record)
    return out


def _spread(row: Row) -> list[tuple[str, dict[str, float], tuple[str, ...]]]:
    """Return numbers of a row that have a column for every quantity, with the head's beginning."""
    return [
        ("", row.values, CHARTED),
        ("error_", row.errors, (*CHARTED, WHOLE)),
        ("like_for_like_", row.like_for_like, CHARTED),
    ]


def _column(prefix: str, quantity: str) -> str:
    return prefix + quantity.replace(" ", "_")


def _row(line: Mapping[str, str]) -> Row:
    options = dict(pair.split("=", 1) for pair in line["options"].split())
    row = Row(
        family=line["family"],
        series=line["series"],
        level=int(line["level"]),
        model=line["model"],
        options={name: _value(text) for name, text in options.items()},
        status=line["status"],
        reason=line["reason"],
        unknowns=int(line["unknowns"]) if line["unknowns"] else None,
        samples=[float(s) for s in line["samples"].split()],
    )
    for prefix, by_quantity, names in _spread(row):
        cells = {q: line.get(_column(prefix, q)) for q in names}
        by_quantity |= {q: float(text) for q, text in cells.items() if text}
    return row


def _value(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return text
