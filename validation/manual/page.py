"""Pages of the manual: a case and the values of its models as Markdown, and back.

A page is a function of its case and of the values *as they are printed*: :func:`read` takes them
from a page, and :func:`render` with them gives the same page again.  So a page on file can be held
against its case without solving anything, and its values against fresh ones by tolerance.

Values are printed to a hundredth of their tolerance, at most nine digits: no processor, thread
count or library moves those.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path

from validation.common import markdown
from validation.manual.case import Answer, Case, Line, Model

FOLDER = Path(__file__).resolve().parent
INDEX = "README.md"
DIGITS = 9
#: over the table of examples of books, and its columns
PRINTED = (
    "Shafts under several loads, notches and bearings of books, catalogues and solved "
    "examinations. A number is equal where it rounds to the printed one."
)
EXAMPLE = ("example", "by", "equal", "farthest from print", "why", "")
#: unknowns may move with the version of the mesh generator
SAME_SIZE = 0.1


def render(case: Case, answers: Mapping[str, Answer]) -> str:
    """Page of a case; ``answers`` by letter, without those that could not be solved."""
    parts = [
        f"# {case.title}",
        _section("Problem", case.problem),
        _section("Geometry", case.geometry),
        _section("Material", case.material),
        _section("Supports and loads", case.supports),
        _section("What is asked", case.asked),
        _section("Reference solution", _references(case)),
    ]
    for letter, model in case.lettered:
        answer = answers.get(letter, Answer({}, 0))
        parts.append(_section(f"Modelling {letter}: {model.name}", _modelling(case, model, answer)))
    if case.remarks:
        parts.append(_section("Remarks", case.remarks))
    return "\n\n".join(parts) + "\n"


def read(page: str, case: Case) -> dict[str, Answer]:
    """Values and sizes by letter, as a page tells them."""
    answers = {}
    for section in re.split(r"^## ", page, flags=re.MULTILINE):
        heading = re.match(r"Modelling ([A-Z]): ", section)
        if not heading:
            continue
        values = {}
        for row in re.findall(r"^\| (.+) \|$", section, flags=re.MULTILINE):
            cells = row.split(" | ")
            if cells[0] in case.quantities and cells[2] != "none":
                values[cells[0]] = float(cells[2])
        size = re.search(r"^Unknowns: (\d+)\.", section, flags=re.MULTILINE)
        answers[heading[1]] = Answer(values, int(size[1]) if size else 0)
    return answers


def index(cases: Mapping[str, Case], answers: Mapping[str, Mapping[str, Answer]]) -> str:
    """Page that lists the cases, each with its models and how much of the tolerance they use."""
    head = [
        "# Validation manual",
        "",
        "Every case states a problem whose answer is known from elsewhere, and holds models to it. "
        "`python -m validation.manual` solves all, writes these pages and ends with exit code 1 if "
        "a number is out of tolerance; `tests/test_manual.py` runs the same cases.",
        "",
        "A reference is a closed form, a published value or another program's: this is "
        "verification, and comparison with published models; nothing is held against an "
        "experiment. Where a model is known to deviate by its assumptions, the tolerance lies "
        "around the known deviation. *Most of a tolerance used* is the largest of a case; above 1 "
        "it is NOT OK.",
        "",
    ]
    columns = ("case", "references", "modellings", "most of a tolerance used", "")
    rows = [_entry(case, answers[case.name]) for case in cases.values() if not case.printed]
    examples = [
        _example(case, letter, model, answers[case.name].get(letter, Answer({}, 0)))
        for case in cases.values()
        if case.printed
        for letter, model in case.lettered
    ]
    parts = [*head, *markdown(columns, rows)]
    if examples:
        parts += ["", "## Printed examples", "", PRINTED, "", *markdown(EXAMPLE, examples)]
    return "\n".join(parts) + "\n"


def lines(case: Case, answers: Mapping[str, Answer]) -> list[tuple[str, Line]]:
    """All judged numbers of a case, with the letters of their models."""
    return [
        (letter, line)
        for letter, model in case.lettered
        for line in case.lines(model, answers.get(letter, Answer({}, 0)).values)
    ]


def verdict(ok: bool) -> str:
    """The word of a table."""
    return "OK" if ok else "NOT OK"


def as_printed(line: Line) -> str:
    """Value of a line to a hundredth of its tolerance, at most nine digits."""
    if line.value is None:
        return "none"
    if not math.isfinite(line.value):
        return str(line.value)
    leading = math.floor(math.log10(abs(line.reference.value)))
    last = math.floor(math.log10(abs(line.reference.value) * line.tolerance / 100))
    digits = min(leading - last + 1, DIGITS)
    return f"{line.value:#.{digits}g}".rstrip(".")


def _example(case: Case, letter: str, model: Model, answer: Answer) -> list[str]:
    """Row of a printed example: how many numbers are equal to the digits, and the farthest one."""
    judged = case.lines(model, answer.values)
    same = sum(abs(line.deviation) <= line.reference.uncertainty for line in judged)
    farthest = max(judged, key=lambda line: abs(line.deviation))
    name = farthest.reference.quantity
    return [
        f"[{case.title}]({case.name}.md)",
        f"{letter} {model.name}",
        f"{same} of {len(judged)}",
        f"{name}: {_per_cent(farthest.deviation, farthest.tolerance)} %",
        model.why,
        verdict(all(line.ok for line in judged)),
    ]


def _section(title: str, text: str) -> str:
    return f"## {title}\n\n{text.strip()}"


def _references(case: Case) -> str:
    cells = []
    sources: dict[str, list[str]] = {}
    for r in case.references:
        kind = r.kind.replace("_", " ")
        value = f"{r.value:.{DIGITS}g}"
        cells.append((r.quantity, value, r.unit, f"{r.uncertainty:.1g}", kind))
        told = f"{r.source}. Uncertainty: {r.limits}."
        sources.setdefault(told, []).append(r.quantity)
    rows = markdown(("quantity", "value", "unit", "uncertainty", "kind"), cells)
    if len(sources) == 1:
        return "\n".join([*rows, "", *sources])
    listed = [f"- {_named(names)}: {source}" for source, names in sources.items()]
    return "\n".join([*rows, "", *listed])


def _named(quantities: list[str], most: int = 6) -> str:
    """All of a few quantities, the ends of many."""
    if len(quantities) <= most:
        return ", ".join(quantities)
    return f"{len(quantities)} quantities, {quantities[0]} to {quantities[-1]}"


def _modelling(case: Case, model: Model, answer: Answer) -> str:
    lines = case.lines(model, answer.values)
    shifted = any(line.known for line in lines)
    known = ["known per cent"] if shifted else []
    head = ["quantity", "reference", "value", "per cent", *known, "tolerance, per cent", ""]
    told = [
        f"Unknowns: {answer.unknowns}. Declared time: {model.seconds:g} s.",
        "",
        f"Tolerance: {model.why}.",
        "",
        *markdown(head, (_row(line, shifted) for line in lines)),
    ]
    return "\n".join(told)


def _row(line: Line, shifted: bool) -> list[str]:
    # judged and told as printed: the page says no more than can be checked on it
    text = as_printed(line)
    printed = line
    if line.value is not None:
        printed = Line(line.reference, float(text), line.tolerance, line.known)
    cells = [
        line.reference.quantity,
        f"{line.reference.value:.{DIGITS}g}",
        text,
        _per_cent(printed.deviation, line.tolerance),
    ]
    if shifted:
        cells.append(_per_cent(line.known, line.tolerance))
    return [*cells, f"{100 * line.tolerance:.3g}", verdict(printed.ok)]


def _per_cent(relative: float, tolerance: float) -> str:
    """To a fiftieth of the tolerance; no sign on a zero."""
    if not math.isfinite(relative):
        return "none"
    decimals = max(0, math.ceil(-math.log10(100 * tolerance / 50)))
    text = f"{100 * relative:+.{decimals}f}"
    return text if float(text) else text[1:]


def _entry(case: Case, answers: Mapping[str, Answer]) -> list[str]:
    judged = lines(case, answers)
    letters = ", ".join(f"{letter} {model.name}" for letter, model in case.lettered)
    kinds = sorted({r.kind.replace("_", " ") for r in case.references})
    shares = [line.share for _, line in judged]
    most = f"{max(shares):.1g}" if all(map(math.isfinite, shares)) else "none"
    return [
        f"[{case.title}]({case.name}.md)",
        ", ".join(kinds),
        letters,
        most,
        verdict(all(line.ok for _, line in judged)),
    ]
