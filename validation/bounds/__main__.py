"""Error bars of `answer` held against references, on drawn bodies, random shafts and scene files.

    python -m validation.bounds                                   the drawn bodies
    python -m validation.bounds --words ring cone                 some of them
    python -m validation.bounds --seeds 95001 95020 --scenes mine/*.toml
    python -m validation.bounds --costs --seeds 95001 95030 --tolerance 1e-3 1e-4

Rows and references are kept in validation/results/bounds/: a run that was stopped goes on where
it was, and another version of the product is judged by the same references.
"""

from __future__ import annotations

import argparse
import datetime
import sys
from pathlib import Path

from validation.bounds import table
from validation.bounds.bodies import BODIES
from validation.bounds.campaign import FINEST, LIMIT, SECONDS, Campaign
from validation.common import ROOT, results_folder

PAGE = ROOT / "docs" / "validation" / "bounds_table.md"


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--words", nargs="*", help="drawn bodies whose names have one of these words; default all")
    add("--no-drawn", action="store_true", help="leave the drawn bodies out")
    add("--seeds", type=int, nargs=2, metavar=("FIRST", "LAST"), help="random shafts")
    add("--scenes", nargs="*", default=[], help="scene files")
    add("--tolerance", type=float, nargs="+", default=[1e-2, 1e-3])
    add("--seconds", type=float, default=SECONDS, help="that an answer or a reference may take")
    add("--limit", type=int, default=LIMIT, help="unknowns of a reference")
    add(
        "--finest",
        type=float,
        default=FINEST,
        help="uncertainty that a reference need not be below",
    )
    add("--triangles", action="store_true", help="references of triangles too")
    add("--folder", type=Path, help="of rows and references")
    add("--again", action="store_true", help="ask again what has rows of this version")
    add("--costs", action="store_true", help="processor time of answers alone; no reference")
    add("--write", action="store_true", help=f"the table to {PAGE.relative_to(ROOT)}")
    add("--page", type=Path, default=PAGE, help=argparse.SUPPRESS)
    return parser.parse_args(arguments)


def bodies_of(options: argparse.Namespace) -> list[str]:
    """Names of all bodies of a run; with ``--costs`` the drawn ones only if words select them."""
    drawn = list(BODIES)
    if options.words:
        drawn = [name for name in drawn if any(word in name for word in options.words)]
    elif options.no_drawn or options.costs:
        drawn = []
    first, last = options.seeds or (0, -1)
    return [*drawn, *(f"random {seed}" for seed in range(first, last + 1)), *options.scenes]


def described(options: argparse.Namespace, bodies: list[str]) -> str:
    """Which bodies these are, in a sentence."""
    drawn = sum(name in BODIES for name in bodies)
    parts = [f"{drawn} drawn bodies"] if drawn else []
    if options.seeds:
        parts.append("random shafts of seeds {} to {}".format(*options.seeds))
    if options.scenes:
        parts.append(f"{len(options.scenes)} scene files")
    tolerances = ", ".join(f"{one:g}" for one in options.tolerance)
    return f"{'; '.join(parts)}; tolerances {tolerances}."


def main(arguments: list[str] | None = None) -> int:
    """Command line; the exit code is 1 if a bar did not hold."""
    options = _options(arguments)
    bodies = bodies_of(options)
    campaign = Campaign(
        tolerances=tuple(options.tolerance),
        seconds=options.seconds,
        limit=options.limit,
        finest=options.finest,
        triangles=options.triangles,
        folder=options.folder or results_folder("bounds"),
        again=options.again,
        tell=lambda text: print(text, flush=True),
    )
    if options.costs:
        print("\n".join(table.costs(campaign.costs(bodies))))
        return 0
    rows = campaign.run(bodies)
    parts = {
        "": table.table(rows),
        "Processor time of the answers": table.seconds(rows),
        "Slowest": table.slowest(rows),
        "Numbers that do not hold": table.misses(rows),
        "Numbers that could not be judged": table.unknown(rows),
        "Problems": campaign.problems,
    }
    for title, lines in parts.items():
        print("\n".join(["", *([title, ""] if title else []), *(lines or ["none"])]))
    if options.write:
        date = datetime.date.today().isoformat()
        options.page.write_text(table.page(rows, date, described(options, bodies)))
    return int(any(row.held is False for row in rows))


if __name__ == "__main__":
    sys.exit(main())
