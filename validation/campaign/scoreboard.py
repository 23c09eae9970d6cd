"""The page of scores, from the results of campaigns."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from validation.campaign.cases import CASES
from validation.campaign.rows import EDGE, FALSE_INVALID, FALSE_VALID, UNSOLVED
from validation.campaign.table import SORTS, markdown
from validation.common import ROOT

PAGE: Path = ROOT / "docs" / "validation" / "scoreboard.md"
#: verdicts of which it is known if they are right
SORTED = [sort for sort in SORTS if sort not in (EDGE, UNSOLVED)]
HEAD = """\
# Scoreboard

How often error bars held, how wide they were, what was called valid falsely, and what it cost. \
Written by `python -m validation.campaign scoreboard` from `validation/results/`, whose files part \
every score by model, tolerance and kind of number. [Random scenes](random.md) says how campaigns judge.

A number is *judged* where its error is known well enough and is not rounding, *held* where its bar \
reaches the truth. *Bar / error* is how many times too wide a bar is. A *false valid* is a model \
called valid whose error is above the tolerance. Bars are relative; of spreads the median stands \
first and what nine in ten are below in brackets.
"""


def page(results: Iterable[dict]) -> str:
    """The whole page as Markdown."""
    names = list(CASES)
    ordered = sorted(results, key=lambda result: names.index(result["campaign"]))
    lines = [HEAD, *markdown([_summary(result) for result in ordered])]
    lines += ["", "## To look at", "", *filter(None, map(_remarks, ordered))]
    return "\n".join(lines) + "\n"


def _summary(result: dict) -> dict:
    """A line for all of a result."""
    bars, verdicts = (next(iter(result[name]), {}) for name in ("bars", "verdicts"))
    widths = bars if CASES[result["campaign"]].widths else {}
    spent = [f"{cost['median, s']:.3g}" for cost in result["costs"]]
    return {
        "campaign": result["campaign"],
        "asked": result["asked"],
        "held, of judged": f"{bars['held']} of {bars['judged']}" if bars else None,
        "false valid": _share(verdicts, FALSE_VALID),
        "false invalid": _share(verdicts, FALSE_INVALID),
        "bar": _spread(widths, "bar"),
        "bar / error": _spread(widths, "bar / error"),
        "s, median": ", ".join(spent),
        "failures": len(result["failures"]),
        "date, commit, machine": f"{result['date']}, {result['commit']}, {result['machine']}",
    }


def _spread(bars: dict, of: str) -> str | None:
    """Median, and what nine in ten are below."""
    middle, high = (bars.get(f"{of}, {name}") for name in ("median", "90 %"))
    return None if middle is None or high is None else f"{middle:.2g} ({high:.2g})"


def _share(verdicts: dict, sort: str) -> str | None:
    """Count of a sort, and of all verdicts that could be sorted."""
    if sort not in verdicts:
        return None
    total = verdicts.get("pairs") or sum(verdicts.get(one, 0) for one in SORTED)
    return f"{verdicts[sort]} of {total}" if total else str(verdicts[sort])


def _remarks(result: dict) -> str:
    """Faults of a campaign, what it could not have, and notes on its origin, in one line."""
    count = result["problems"]
    left = [f"{count} references, bodies or models could not be had."] if count else []
    told = [*result["misses"], *result["cases"], *result["failures"], *left, result.get("note", "")]
    said = " ".join(f"{line.rstrip('.')}." for line in told if line)
    return said and f"- *{result['campaign']}, {result['asked']}*: {said}"
