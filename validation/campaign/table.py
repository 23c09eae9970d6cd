"""The one table: a score of rows, verdicts and costs as plain data, and any score as Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

import numpy as np

from validation.campaign.rows import (
    AGREES,
    CONTRADICTS,
    EDGE,
    FALSE_INVALID,
    FALSE_VALID,
    INVALID,
    LIKE_ONLY,
    UNCERTAIN,
    UNSOLVED,
    VALID,
    Cost,
    Found,
    Row,
    Verdict,
)

Score = list[dict[str, object]]
SORTS = (VALID, INVALID, FALSE_VALID, FALSE_INVALID, LIKE_ONLY, EDGE, UNSOLVED)
SAID = (AGREES, UNCERTAIN, CONTRADICTS)
#: of bar over error, of the bar, and of the error
RATIOS = {"least": 0.0, "5 %": 0.05, "median": 0.5, "90 %": 0.9, "98 %": 0.98}
WIDTHS = {"median": 0.5, "90 %": 0.9, "largest": 1.0}
ERRORS = {"median": 0.5, "largest": 1.0}
#: names of the tags, none, one or several, by which a table is parted
Parts = Sequence[tuple[str, ...]]


def bars(rows: Sequence[Row], parts: Parts = ((),)) -> Score:
    """Numbers that were judged and held, and how tightly, in all and parted by tags."""
    out: Score = []
    for names in parts:
        groups: dict[str, list[Row]] = {}
        for row in rows:
            groups.setdefault(", ".join(row.tags[name] for name in names), []).append(row)
        out += [_scored(key or "all", mine) for key, mine in sorted(groups.items())]
    return out


def _scored(name: str, rows: Sequence[Row]) -> dict[str, object]:
    sure = [row for row in rows if row.judged]
    small, beyond = sum(row.small for row in rows), [row for row in rows if row.beyond]
    ratios = [row.ratio for row in sure if row.ratio is not None and np.isfinite(row.ratio)]
    counts = {
        "numbers": name,
        "of": len(rows),
        "judged": len(sure),
        "not judgeable": len(rows) - sum(row.judged or row.small for row in rows),
        "rounding": small,
        "held": sum(bool(row.held) for row in sure),
    }
    ends = {
        "beyond tolerance": len(beyond),
        "of these promised": sum(row.promised for row in beyond),
        "wrong side": sum(row.wrong_side for row in rows),
    }
    told = _quantiles("bar / error", ratios, RATIOS)
    told |= _quantiles("bar", [row.bar for row in rows], WIDTHS)
    told |= _quantiles("error", [row.off for row in sure], ERRORS)
    return counts | told | ends


def _quantiles(
    of: str, values: Sequence[float], wanted: dict[str, float]
) -> dict[str, float | None]:
    found = np.quantile(values, list(wanted.values())) if values else [None] * len(wanted)
    return {
        f"{of}, {name}": None if value is None else float(f"{value:.3g}")
        for name, value in zip(wanted, found)
    }


def verdicts(found: Iterable[Verdict]) -> Score:
    """Sorts of verdicts, in all and by model and tolerance."""
    return _sorted_by(found, SORTS)


def checks(found: Iterable[Verdict]) -> Score:
    """The same of what `check` said beside `compare`."""
    return _sorted_by(found, SAID)


def _sorted_by(found: Iterable[Verdict], sorts: Sequence[str]) -> Score:
    mine = [v for v in found if v.sort in sorts]
    counts = Counter((v.model, v.tolerance, v.sort) for v in mine)
    total = Counter(v.sort for v in mine)
    keys = sorted({key[:2] for key in counts})
    out: Score = [{"model": "all", "tolerance": None} | {s: total[s] for s in sorts}] * bool(mine)
    return out + [
        {"model": model, "tolerance": tolerance} | {s: counts[model, tolerance, s] for s in sorts}
        for model, tolerance in keys
    ]


def costs(found: Iterable[Cost], name: str = "tolerance") -> Score:
    """Processor time of answers, parted by a tag."""
    groups: dict[str, list[Cost]] = {}
    for one in found:
        groups.setdefault(one.tags.get(name, "all"), []).append(one)
    out: Score = []
    for key, mine in groups.items():
        spent = [one.seconds for one in mine]
        told = {"sum, s": sum(spent), "median, s": np.median(spent), "largest, s": max(spent)}
        counts = {name: key, "bodies": len(mine)} | {k: round(float(v), 2) for k, v in told.items()}
        out.append(counts | {"reached": sum(one.reached for one in mine)})
    return out


# ------------------------------------------------------------------------------------------------
# - lines
def slowest(found: Iterable[Cost], count: int = 8) -> list[str]:
    """The answers that took the most processor time, in a line each."""
    return [
        f"{', '.join([one.body, *one.tags.values()])}: {one.seconds:.1f} s, {one.unknowns} unknowns, "
        f"{'reached' if one.reached else 'not reached'}"
        for one in sorted(found, key=lambda one: -one.seconds)[:count]
    ]


def misses(rows: Iterable[Row]) -> list[str]:
    """Numbers whose bar does not hold, whose side is wrong, or that are beyond a tolerance that
    was promised, in a line each.
    """
    bad = [r for r in rows if r.held is False or r.wrong_side or r.beyond and r.promised]
    return [
        f"{row.body}, {', '.join(row.tags.values())}, {row.quantity}: {_faults(row)}; "
        f"bar {row.bar:.1e}, error {row.error:+.1e} +- {row.doubt:.0e} ({row.how})"
        for row in sorted(bad, key=lambda row: (row.body, row.quantity))
    ]


def _faults(row: Row) -> str:
    faults = {
        "not held": row.held is False,
        "wrong side": row.wrong_side,
        "beyond": row.beyond and row.promised,
    }
    return ", ".join(word for word, there in faults.items() if there)


def cases(found: Iterable[Verdict]) -> list[str]:
    """Verdicts that somebody should look at, in a line each."""
    return [f"{v.sort}: {v.body}, {v.model} at {v.tolerance:g}: {v.why}" for v in found if v.why]


def unknown(rows: Iterable[Row]) -> list[str]:
    """Numbers that could not be judged, by body: how many, and how many bars surely hold anyway."""
    by_body: dict[str, list[Row]] = {}
    for row in rows:
        if not row.judged and not row.small:
            by_body.setdefault(row.body, []).append(row)
    return [
        f"{body}: {len(mine)} ({sum(row.surely_held for row in mine)} surely held, "
        f"{sum(row.error is None for row in mine)} without a true value)"
        for body, mine in sorted(by_body.items(), key=lambda item: -len(item[1]))
    ]


def markdown(score: Score) -> list[str]:
    """A score as a table, columns in order of first appearance; nothing of nothing."""
    if not score:
        return []
    columns = list(dict.fromkeys(name for row in score for name in row))
    lines = [columns, ["---"] * len(columns)]
    lines += [[_cell(row.get(name)) for name in columns] for row in score]
    return [f"| {' | '.join(line)} |" for line in lines]


def _cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def report(found: Found, parts: Parts, tag_of_costs: str = "tolerance") -> list[str]:
    """All of a campaign as lines."""
    sections = {
        "Bars": markdown(bars(found.rows, parts)),
        "Verdicts": markdown(verdicts(found.verdicts)),
        "What `check` said": markdown(checks(found.verdicts)),
        "Processor time": markdown(costs(found.costs, tag_of_costs)),
        "Slowest": slowest(found.costs),
        "Numbers that do not hold": misses(found.rows),
        "Verdicts to look at": cases(found.verdicts),
        "Failures": found.failures,
        "Numbers that could not be judged": unknown(found.rows),
        "Problems": found.problems,
    }
    return [line for title, lines in sections.items() if lines for line in ("", title, "", *lines)]
