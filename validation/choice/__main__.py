"""Command line of `validation.choice`."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from solidgear.errors import SolidgearError
from solidgear.evidence.quantities import QUANTITIES
from solidgear.machine.whole_file import whole
from solidgear.studies.answering import answer
from validation import choice
from validation.attack.reference import FOLDER
from validation.attack.scenes import random_scene
from validation.choice.members import MOST, collect
from validation.choice.walk import Tally, quantiles, table, walk

RESULTS = FOLDER.parent.parent
TOLERANCES = (0.1, 0.01, 1e-3, 1e-4)
#: at which bending alone is timed against everything
LIVE_AT = 1e-3


def alone(seeds: range) -> list[float]:
    """Processor seconds of bending alone over those of everything, on live answers."""
    out = []
    for seed in seeds:
        scene, spent = random_scene(seed), []
        for ask in (list(QUANTITIES), "bending"):
            start = time.process_time()
            try:
                answer(scene, LIVE_AT, ask)
            except SolidgearError:
                break
            spent.append(time.process_time() - start)
        if len(spent) == 2:
            out.append(spent[1] / spent[0])
    return out


def main(arguments: list[str] | None = None) -> int:
    """The exit code is 1 if an answer was wrong."""
    parser = argparse.ArgumentParser(
        description=choice.__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=50001)
    parser.add_argument(
        "--judged-from", type=int, help="first seed that had no part in the factors of bands"
    )
    parser.add_argument("--tolerance", type=float, nargs="+", default=list(TOLERANCES))
    parser.add_argument("--live", type=int, default=5, help="scenes to time bending alone on")
    parser.add_argument("--rows", type=Path, default=RESULTS / "choice" / "members.jsonl")
    parser.add_argument("--out", type=Path, default=RESULTS / "choice.md")
    parser.add_argument(
        "--most",
        type=int,
        default=MOST,
        help="unknowns of a mesh after which no finer one is solved",
    )
    options = parser.parse_args(arguments)
    seeds = range(options.seed, options.seed + options.scenes)
    rows = [
        row
        for row in collect(seeds, options.rows, lambda text: print(text, flush=True), options.most)
        if row.get("ref") and row["seed"] >= (options.judged_from or 0)
    ]
    tallies = {tol: Tally() for tol in options.tolerance}
    for row in rows:
        for tol, tally in tallies.items():
            walk(row, tol, tally)
    part = alone(seeds[: options.live])
    lines = [
        "# Automatic choice on random scenes",
        "",
        f"{len(rows)} scenes with a reference, seeds {options.judged_from or seeds[0]} to "
        f"{seeds[-1]}. Bending alone costs {quantiles(part, (0.5,))[0]:.2g} of everything "
        f"(median of {len(part)}, at {LIVE_AT:g}).",
        "",
        *table(tallies),
    ]
    for title, which in (("Beyond the tolerance", "wrong"), ("Beyond the bar", "short")):
        lines += ["", f"## {title}", ""]
        for tol, tally in tallies.items():
            lines += [f"- at {tol:g}: {text}" for text in getattr(tally, which)]
    text = "\n".join(lines) + "\n"
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with whole(options.out) as partial:
        partial.write_text(text)
    print(text)
    return int(any(tally.wrong for tally in tallies.values()))


if __name__ == "__main__":
    sys.exit(main())
