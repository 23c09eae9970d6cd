"""Errors against the reference, and what an error asked for costs along each line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from validation.common import ROOT, show
from validation.race.real_lines import CALCULIX, GRADED, NOTES, RAW, REFERENCE

FIGURES = ROOT / "validation" / "figures"
QUANTITIES = ("C_zz", "bending_1")
#: share of a change that is left after the next level: outside of these a sequence is not read as
#: one that converges, and its last member is the limit
SHRINKS = (0.05, 0.85)
#: meshes of a line from which its order is taken where the error asked for is beyond them
LAST = 3
#: a sparse factor in 3D takes at most this power of the unknowns in time and in memory (George
#: 1973); CalculiX, of which few meshes are there, is not said to grow faster
GROWTH = (2.0, 4 / 3)
RATIOS = ("raw / this", "CalculiX / this", "its modes / this")

Row = dict[str, Any]


def rows_of(records: dict[str, Row]) -> list[Row]:
    """Rows of all parts, of the records of a result."""
    return [
        {"part": part, **row}
        for part, record in records.items()
        for row in record["lanes"]
        if not row["error"]
    ]


def read(records: dict[str, Row], settings: dict[str, float]) -> None:
    """Print what the error asked for costs, as the rows of a page, and draw the charts."""
    from validation.race.real_chart import draw

    rows, target = rows_of(records), settings["target"]
    for part in records:
        try:
            truth = references(rows, part)
        except ValueError as error:
            print(error)
            continue
        said = [f"{q} {truth[q].value:.7g} within {truth[q].doubt:.1e}" for q in QUANTITIES]
        print(f"\n{part}: reference {', '.join(said)}. {NOTES[part]}")
        for what in ("both", *QUANTITIES):
            show(f"{part}, {what} to {target:g}", table(rows, part, target, what))
        print(*markdown(rows, part, target), sep="\n")
        draw(rows, part, FIGURES / f"real_{part}.png", target)


@dataclass(frozen=True)
class Limit:
    """What a sequence of meshes tends to, and how far its finest member is from it, relative."""

    value: float
    doubt: float


def limit(values: Sequence[float]) -> Limit:
    """Limit of values on meshes refined by equal steps.

    The last change goes on with the factor that the last two have (Aitken). Where that is not one
    of convergence, the last value stands, and all changes are its doubt.

    Parameters
    ----------
    values : sequence of float
        Three or more, coarse to fine.
    """
    a, b, c = values[-3:]
    shrink = (c - b) / (b - a) if b != a else 0.0
    if SHRINKS[0] < shrink < SHRINKS[1]:
        found = c + (c - b) * shrink / (1 - shrink)
        return Limit(found, abs(c / found - 1))
    return Limit(c, float(np.ptp([a, b, c]) / abs(c)))


def references(rows: Sequence[Row], part: str) -> dict[str, Limit]:
    """Reference and doubt of each quantity of a part.

    Raises
    ------
    ValueError
        Where rows of the reference are missing.
    """
    own = _of(rows, part, REFERENCE)
    if len(own) < 3:
        raise ValueError(f"{part}: {len(own)} rows of the reference, three are needed")
    return {name: limit([row[name] for row in own]) for name in QUANTITIES}


def _of(rows: Sequence[Row], part: str, line: str) -> list[Row]:
    return [row for row in rows if row["part"] == part and row["line"] == line]


def errors(rows: Sequence[Row], part: str, line: str, what: str = "both") -> np.ndarray:
    """Relative errors of a line, coarse to fine.

    Parameters
    ----------
    what : {'both', 'C_zz', 'bending_1'}
        Both: the larger one of each mesh.
    """
    truth = references(rows, part)
    names = QUANTITIES if what == "both" else (what,)
    return np.array(
        [
            max(abs(row[name] / truth[name].value - 1) for name in names)
            for row in _of(rows, part, line)
        ]
    )


@dataclass(frozen=True)
class Cost:
    """What an error costs along a line.

    Attributes
    ----------
    cpu_s, unknowns, peak_MB : float
        Infinite where the line does not lead there.
    how : {'between', 'at most', 'beyond', 'never'}
        Between two meshes; met by the coarsest mesh already; extrapolated; the error of the model
        itself is larger.
    """

    cpu_s: float
    unknowns: float
    peak_MB: float
    how: str


NEVER = Cost(np.inf, np.inf, np.inf, "never")


def cost(error: Sequence[float], costs: Sequence[Sequence[float]], target: float) -> Cost:
    """Cost of an error, by straight lines between meshes in logarithms.

    Parameters
    ----------
    error : (n,) sequence
        Coarse to fine.
    costs : (n, 3) sequence
        Processor seconds, unknowns, MB.
    """
    # An error counts as no smaller than those of finer meshes: it would be so by a lucky sign.
    reliable = np.maximum.accumulate(np.asarray(error, float)[::-1])[::-1]
    e, c = np.log(reliable), np.log(np.asarray(costs))
    goal = np.log(target)
    above = np.flatnonzero(e > goal)
    if not len(above):
        return Cost(*np.exp(c[0]), "at most")
    last = above[-1]
    if last + 1 < len(e):
        share = (e[last] - goal) / (e[last] - e[last + 1])
        return Cost(*np.exp(c[last] + share * (c[last + 1] - c[last])), "between")
    e, c = e[-LAST:], c[-LAST:]
    if len(e) < 2:
        return NEVER
    order = np.polyfit(c[:, 1], e, 1)[0]
    if order > -0.1:  # an error that doubling the unknowns hardly changes is the model's own
        return NEVER
    unknowns = c[-1, 1] + (goal - e[-1]) / order
    grown = [np.polyfit(c[:, 1], c[:, k], 1)[0] * (unknowns - c[-1, 1]) for k in (0, 2)]
    return Cost(
        float(np.exp(c[-1, 0] + grown[0])),
        float(np.exp(unknowns)),
        float(np.exp(c[-1, 2] + grown[1])),
        "beyond",
    )


def line_cost(
    rows: Sequence[Row],
    part: str,
    line: str,
    target: float,
    what: str = "both",
    seconds: str = "cpu s",
) -> Cost:
    """Cost of an error along a line of a part; CalculiX goes on as our solid on the same meshes.

    Parameters
    ----------
    what : {'both', 'C_zz', 'bending_1'}
    seconds : {'cpu s', 'cpu_of_modes_s'}
        The second: modes of CalculiX without its loads.
    """
    own = _of(rows, part, line)
    if not own:
        return NEVER
    e = errors(rows, part, line, what)
    costs = [[row[k] for k in (seconds, "unknowns", "peak_MB")] for row in own]
    if line != CALCULIX or e[-1] < target:
        return cost(e, costs, target)
    # The meshes are those of our graded whole, which goes further: only the cost is extrapolated.
    mesh = line_cost(rows, part, GRADED, target, what).unknowns
    if not np.isfinite(mesh) or len(own) < 2:
        return NEVER
    c = np.log(np.array(costs))[-LAST:]
    ahead = np.log(mesh) - c[-1, 1]
    powers = [min(np.polyfit(c[:, 1], c[:, k], 1)[0], most) for k, most in zip((0, 2), GROWTH)]
    cpu, peak = (np.exp(c[-1, k] + ahead * power) for k, power in zip((0, 2), powers))
    return Cost(float(cpu), float(mesh), float(peak), "beyond")


def cheapest_raw(rows: Sequence[Row], part: str, target: float, what: str = "both") -> Cost:
    """The cheaper one of our raw 3D lines."""
    found = [line_cost(rows, part, line, target, what) for line in RAW]
    return min(found, key=lambda c: c.cpu_s)


def table(rows: Sequence[Row], part: str, target: float, what: str = "both") -> list[dict]:
    """One row a line: cost of an error, and how many times as much raw 3D, CalculiX and
    its modes alone take.
    """
    raw = cheapest_raw(rows, part, target, what)
    peer = line_cost(rows, part, CALCULIX, target, what)
    peer_modes = line_cost(rows, part, CALCULIX, target, what, "cpu_of_modes_s")
    out = []
    for line in dict.fromkeys(r["line"] for r in rows if r["part"] == part):
        if line == REFERENCE:
            continue
        own = line_cost(rows, part, line, target, what)
        met = np.isfinite(own.cpu_s)
        out.append(
            {
                "line": line,
                "cpu_s": own.cpu_s,
                "unknowns": own.unknowns,
                "peak_MB": own.peak_MB,
                "how": own.how,
                "raw / this": raw.cpu_s / own.cpu_s if met else np.nan,
                "CalculiX / this": peer.cpu_s / own.cpu_s if met else np.nan,
                "its modes / this": peer_modes.cpu_s / own.cpu_s if met else np.nan,
            }
        )
    return out


def _two_digits(number: float) -> str:
    return f"{float(f'{number:.2g}'):,g}"


def markdown(rows: Sequence[Row], part: str, target: float = 1e-3) -> list[str]:
    """Table for a page: what the error asked for costs in both quantities."""
    head = "| line | processor s | 3D unknowns | peak MB"
    out = [head + " | raw 3D / this | CalculiX / this | its modes / this |", "| --- " * 7 + "|"]
    for row in table(rows, part, target):
        if row["how"] == "never":
            out.append(f"| {row['line']} | not reached | | | | | |")
            continue
        how = {"beyond": " (extrapolated)", "at most": " (or less)"}.get(row["how"], "")
        ratio = [_two_digits(row[k]) for k in RATIOS]
        numbers = [
            f"{_two_digits(row['cpu_s'])}{how}",
            f"{row['unknowns']:,.0f}",
            f"{row['peak_MB']:,.0f}",
        ]
        out.append("| " + " | ".join([row["line"], *numbers, *ratio]) + " |")
    return out
