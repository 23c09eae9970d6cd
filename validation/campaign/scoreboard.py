"""The page of scores, from the results of campaigns."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby
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

How often error bars held, how wide they were, what was called valid falsely, and what it cost: every \
campaign with its date, commit, seeds and machine. The page is written by \
`python -m validation.campaign scoreboard` from `validation/results/`; [Random scenes](random.md) says \
how campaigns judge and what they found.

A number is *judged* where its error is known well enough and is not rounding, *held* where its bar \
reaches the truth; *bar / error* is how many times too wide a bar is, a *false valid* a model called \
valid whose error is above the tolerance. Bars are relative.
"""


def page(results: Iterable[dict]) -> str:
    """The whole page as Markdown."""
    names = list(CASES)
    ordered = sorted(results, key=lambda result: names.index(result["campaign"]))
    lines = [HEAD, *markdown([_summary(result) for result in ordered])]
    for name, mine in groupby(ordered, key=lambda result: result["campaign"]):
        question = CASES[name].question
        lines += ["", f"## {question[0].upper()}{question[1:]}"]
        for result in mine:
            lines += ["", f"({result['name']})=", f"### {result['asked']}", ""]
            lines += [_origin(result), *_tables(result)]
    return "\n".join(lines) + "\n"


def _summary(result: dict) -> dict:
    """A line for all of a result."""
    bars, verdicts = (next(iter(result[name]), {}) for name in ("bars", "verdicts"))
    widths = bars if CASES[result["campaign"]].widths else {}
    spent = [f"{cost['median, s']:.3g}" for cost in result["costs"]]
    return {
        "campaign": f"[{result['campaign']}](#{result['name']})",
        "asked": result["asked"],
        "date": result["date"],
        "held, of judged": f"{bars['held']} of {bars['judged']}" if bars else None,
        "false valid, of verdicts": _share(verdicts, FALSE_VALID),
        "false invalid": _share(verdicts, FALSE_INVALID),
        "bar, median (90 %)": _spread(widths, "bar"),
        "bar / error, median (90 %)": _spread(widths, "bar / error"),
        "s, median": ", ".join(spent),
        "failures": len(result["failures"]),
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


def _origin(result: dict) -> str:
    """Origin of a result, in a sentence or three."""
    known = f"{result['date']}, commit {result['commit']}, {result['machine']}."
    count = result["problems"]
    left = f" {count} references, bodies or models could not be had." if count else ""
    note = f" {result['note']}" if result.get("note") else ""
    return known + left + note


def _tables(result: dict) -> list[str]:
    out: list[str] = []
    for name in ("bars", "verdicts", "checks", "costs"):
        if result[name]:
            out += ["", *markdown(result[name])]
    wrong = [*result["misses"], *result["cases"], *result["failures"]]
    if wrong:
        out += ["", "To look at:", "", *(f"- {line}" for line in wrong)]
    return out
