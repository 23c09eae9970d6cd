"""Solve the cases, write their pages and the index, and say what is not within tolerance.

    python -m validation.manual [--case NAME ...] [--words]

With ``--words`` nothing is solved: pages are written anew with the values they have.
The exit code is 1 if a number is out of its tolerance or missing.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from solidgear.core.errors import SolidgearError
from validation.manual import CASES
from validation.manual.case import Answer, Case
from validation.manual.page import FOLDER, INDEX, index, lines, read, render


def solved(case: Case) -> dict[str, Answer]:
    """Answers by letter, each told on the way; a model that fails has none."""
    answers = {}
    for letter, model in case.lettered:
        start = time.perf_counter()
        try:
            answers[letter] = model.solve()
        except SolidgearError as error:
            print(f"{case.name} {letter}: {error}", flush=True)
        seconds = time.perf_counter() - start
        good = all(line.ok for at, line in lines(case, answers) if at == letter)
        word = "OK" if good else "NOT OK"
        print(f"{word:7s}{case.name} {letter} {model.name} ({seconds:.1f} s)", flush=True)
    return answers


def write(folder: Path, names: Sequence[str], words: bool = False) -> list[str]:
    """Solve the named cases, write their pages and the index; returns what is out of tolerance.

    Cases not named are told in the index as their pages on file have them; with ``words`` so are
    the named ones on their pages.
    """
    answers = {}
    for name, case in CASES.items():
        page = folder / f"{name}.md"
        answers[name] = read(page.read_text() if page.exists() else "", case)
        if name in names:
            page.write_text(render(case, answers[name] if words else solved(case)))
            answers[name] = read(page.read_text(), case)
    (folder / INDEX).write_text(index(CASES, answers))
    return [
        f"{name} {letter}: {line.reference.quantity} is {line.value} {line.reference.unit}, "
        f"reference {line.reference.value:.9g}, off by {100 * line.deviation:+.3g} % "
        f"(tolerance {100 * line.tolerance:.3g} %)"
        for name in names
        for letter, line in lines(CASES[name], answers[name])
        if not line.ok
    ]


def main(arguments: Sequence[str] | None = None, folder: Path = FOLDER) -> int:
    """Command line; the exit code is 1 if a number is not within its tolerance."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "--case",
        nargs="+",
        choices=CASES,
        default=[*CASES],
        metavar="NAME",
        help="of " + ", ".join(CASES),
    )
    parser.add_argument("--words", action="store_true", help="keep the values on the pages")
    options = parser.parse_args(arguments)
    wrong = write(folder, options.case, options.words)
    for sentence in wrong:
        print("NOT OK", sentence)
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
