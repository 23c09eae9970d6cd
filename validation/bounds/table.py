"""Tables of what a campaign found."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from validation.bounds.judging import COUPLING, MODE, STATIC, Row

HEAD = (
    *("numbers", "of", "judged", "not judgeable", "rounding", "held"),
    *("bar / error: least", "5 %", "median", "90 %", "98 %"),
    *("beyond tolerance", "of these promised", "wrong side"),
)
#: processor time of answers
COSTS = ("tolerance", "bodies", "sum, s", "median, s", "largest, s", "reached")
QUANTILES = (0.0, 0.05, 0.5, 0.9, 0.98)


def table(rows: Sequence[Row]) -> list[str]:
    """Markdown: how many numbers were judged, held, and how tightly, in all and by kind and
    tolerance.

    Parameters
    ----------
    rows : sequence of Row
    """
    tolerances = sorted({row.tolerance for row in rows}, reverse=True)
    kinds = (STATIC, COUPLING, MODE)
    parts: list[tuple[str, Callable[[Row], bool]]] = [("all", lambda row: True)]
    parts += [(kind, lambda row, kind=kind: row.kind == kind) for kind in kinds]
    parts += [(f"at {tol:g}", lambda row, tol=tol: row.tolerance == tol) for tol in tolerances]
    parts += [
        (
            f"{kind} at {tol:g}",
            lambda row, kind=kind, tol=tol: (row.kind, row.tolerance) == (kind, tol),
        )
        for tol in tolerances
        for kind in kinds
    ]
    lines = [_line(name, [row for row in rows if mine(row)]) for name, mine in parts]
    return [*_head(HEAD), *(line for line in lines if line)]


def _line(name: str, rows: list[Row]) -> str:
    if not rows:
        return ""
    sure = [row for row in rows if row.judged]
    small = sum(row.small for row in rows)
    held = sum(bool(row.held) for row in sure)
    beyond = [row for row in rows if row.beyond]
    ratios = [row.ratio for row in sure if row.ratio is not None and np.isfinite(row.ratio)]
    tight = [f"{q:.3g}" for q in np.quantile(ratios, QUANTILES)] if ratios else [""] * 5
    cells = (
        *(name, len(rows), len(sure), len(rows) - len(sure) - small, small),
        f"{100 * held / len(sure):.1f} % ({held})" if sure else "none judged",
        *tight,
        *(len(beyond), sum(row.promised for row in beyond), sum(row.wrong_side for row in rows)),
    )
    return _cells(cells)


def seconds(rows: Iterable[Row]) -> list[str]:
    """Markdown: processor time of the answers behind rows."""
    once = {(row.body, row.tolerance): row for row in rows}
    return costs(
        {"tolerance": row.tolerance, "seconds": row.seconds, "reached": row.reached}
        for row in once.values()
    )


def costs(answers: Iterable[dict]) -> list[str]:
    """Markdown: processor time of answers, by tolerance.

    Parameters
    ----------
    answers : iterable of dict
        ``tolerance``, ``seconds`` and ``reached`` of each.
    """
    answers = list(answers)
    out = _head(COSTS)
    for tolerance in sorted({one["tolerance"] for one in answers}, reverse=True):
        mine = [one for one in answers if one["tolerance"] == tolerance]
        spent = [one["seconds"] for one in mine]
        cells = (f"{tolerance:g}", len(mine), f"{sum(spent):.1f}", f"{np.median(spent):.2f}")
        out.append(_cells((*cells, f"{max(spent):.1f}", sum(one["reached"] for one in mine))))
    return out


def slowest(rows: Iterable[Row], count: int = 8) -> list[str]:
    """The bodies that took the most processor time, in a line each."""
    once = {(row.body, row.tolerance): row for row in rows}
    ordered = sorted(once.values(), key=lambda row: -row.seconds)[:count]
    return [
        f"{row.body} at {row.tolerance:g}: {row.seconds:.1f} s, {row.unknowns} unknowns, "
        f"{'reached' if row.reached else 'not reached'}"
        for row in ordered
    ]


def misses(rows: Iterable[Row]) -> list[str]:
    """Numbers whose bar does not hold, whose side is wrong, or that are beyond a tolerance that
    was promised, in a line each.
    """
    bad = [r for r in rows if r.held is False or r.wrong_side or r.beyond and r.promised]
    return [
        f"{row.body} at {row.tolerance:g}, {row.quantity}: {_faults(row)}; bar {row.bar:.1e}, "
        f"error {row.error:+.1e} +- {row.doubt:.0e} ({row.how})"
        for row in sorted(bad, key=lambda row: (row.body, -row.tolerance, row.quantity))
    ]


def _faults(row: Row) -> str:
    faults = {
        "not held": row.held is False,
        "wrong side": row.wrong_side,
        "beyond": row.beyond and row.promised,
    }
    return ", ".join(word for word, there in faults.items() if there)


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


def page(rows: Sequence[Row], date: str, drawn: str) -> str:
    """The tables as a page.

    Parameters
    ----------
    rows : sequence of Row
    date : str
    drawn : str
        Which bodies these are, in a sentence.
    """
    lines = [
        "# Error bars of the harmonic solid, judged",
        "",
        f"{date}. {drawn}",
        "",
        "An error is judged where it is above 1e-7 and above three times the uncertainty of the "
        "reference; ratios are of the bar to the error.",
        "",
        *table(rows),
        "",
        "Processor time of the answers:",
        "",
        *seconds(rows),
        "",
        "## Numbers that do not hold",
        "",
        *(f"- {line}" for line in misses(rows) or ["none"]),
    ]
    return "\n".join(lines) + "\n"


def _head(names: Sequence[str]) -> list[str]:
    return [_cells(names), _cells(["---"] * len(names))]


def _cells(cells: Iterable[object]) -> str:
    return f"| {' | '.join(map(str, cells))} |"
