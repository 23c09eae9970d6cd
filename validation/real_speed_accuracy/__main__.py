"""Speed against accuracy on real parts.

    python -m validation.real_speed_accuracy [--part keyed] [--line sector] [--read]

Raw tetrahedra uniform and graded, halves, a sector, defect correction, the plain part and CalculiX
on the same mesh, each in a process of its own on one thread, from the scene to its 6x6 compliance
and eight modes. CalculiX is timed with its deck given. Rows that
validation/figures/real_speed_accuracy.csv has already are not measured again; charts go beside it.
"""

from __future__ import annotations

import argparse

from validation.common import ROOT, show, write_rows
from validation.peers.calculix import present
from validation.peers.process import PeerError
from validation.real_speed_accuracy.chart import draw
from validation.real_speed_accuracy.lines import CALCULIX, NOTES, PARTS, jobs
from validation.real_speed_accuracy.race import measured
from validation.real_speed_accuracy.ratios import (
    QUANTITIES,
    Row,
    markdown,
    read_rows,
    references,
    table,
)

FOLDER = ROOT / "validation" / "figures"
ROWS = FOLDER / "real_speed_accuracy.csv"


def main() -> None:
    """Measure what is missing, or read the rows that are there; draw and print."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--part", choices=PARTS)
    parser.add_argument("--line", default="", help="only lines whose name holds this")
    parser.add_argument("--read", action="store_true", help="measure nothing")
    parser.add_argument(
        "--page", action="store_true", help="print rows of docs/validation/speed.md"
    )
    parser.add_argument("--target", type=float, default=1e-3, help="error that ratios are taken at")
    given = parser.parse_args()
    parts = [given.part] if given.part else list(PARTS)
    if not given.read:
        for part in parts:
            _measure(part, given.line)
    rows = read_rows(ROWS)
    for part in parts:
        truth = references(rows, part)
        said = ", ".join(
            f"{q} {truth[q].value:.7g} within {truth[q].doubt:.1e}" for q in QUANTITIES
        )
        print(f"\n{part}: reference {said}. {NOTES[part]}")
        if given.page:
            print(*markdown(rows, part, given.target), sep="\n")
        for what in () if given.page else ("both", *QUANTITIES):
            show(f"{part}, {what} to {given.target:g}", table(rows, part, given.target, what))
        draw(rows, part, FOLDER / f"real_{part}.png", given.target)


def _measure(part: str, line: str) -> None:
    for job in jobs(part):
        place = (job.part, job.line, job.label)
        if line not in job.line or place in map(_place, _rows()):
            continue
        if job.line == CALCULIX and present():
            print(f"not measured: {job.line}: {present()}")
            continue
        try:
            row = measured(job)
        except PeerError as error:
            print(f"{place}: {error}", flush=True)
            continue
        print(row, flush=True)
        order = [(j.part, j.line, j.label) for p in PARTS for j in jobs(p)]
        # read again: another part may have been measured meanwhile
        rows = [*_rows(), row]
        rows.sort(key=lambda r: order.index(_place(r)) if _place(r) in order else len(order))
        write_rows(ROWS, rows)


def _rows() -> list[Row]:
    return read_rows(ROWS) if ROWS.exists() else []


def _place(row: Row) -> tuple[str, str, str]:
    return row["part"], row["line"], row["mesh"]


if __name__ == "__main__":
    main()
