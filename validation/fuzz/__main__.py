"""Broken input until something is found.

    python -m validation.fuzz [scenes] [--cases 10000] [--seed 1] [--words]

Without a name the cases are shared out among all kinds. Findings are printed as they come, and
their files kept in validation/results/fuzz/; the exit code is 1 if there are any. Counts go to
validation/results/fuzz.json.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter

from validation.common import kept, results_folder, show, stamp
from validation.fuzz.case import Fuzz, Outcome, put, run
from validation.fuzz.commands import COMMAND_LINES
from validation.fuzz.parts import LINES_OF_DECKS, PARTS
from validation.fuzz.scenes import SCENES

KINDS = {fuzz.name: fuzz for fuzz in (SCENES, COMMAND_LINES, PARTS, LINES_OF_DECKS)}


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("name", nargs="?", choices=KINDS, help="one kind; all by default")
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--words", action="store_true", help="print every case")
    given = parser.parse_args()
    counts = {given.name: given.cases}
    if not given.name:
        counts = {name: round(fuzz.share * given.cases) for name, fuzz in KINDS.items()}
    records = [campaign(KINDS[n], count, given.seed, given.words) for n, count in counts.items()]
    show(f"seed {given.seed}", records)
    kept("fuzz", {record["kind"]: record | stamp() for record in records})
    return int(any(record["findings"] for record in records))


def campaign(fuzz: Fuzz, cases: int, seed: int, words: bool = False) -> dict:
    """Run the cases of a kind, keep the files of its findings, and show what came of it."""
    slowest, clock = 0.0, time.perf_counter()

    def progress(outcome: Outcome) -> None:
        nonlocal slowest, clock
        clock, before = time.perf_counter(), clock
        slowest = max(slowest, clock - before)
        if outcome.kind == "finding":
            folder = results_folder("fuzz") / f"{fuzz.name}_{seed}_{outcome.number}"
            folder.mkdir(exist_ok=True)
            put(fuzz.case(seed, outcome.number), folder)
        if words or outcome.kind == "finding":
            print(f"{outcome.kind}: {fuzz.name}, {outcome.told()}", flush=True)

    found = run(fuzz, cases, seed, progress)
    sorts = Counter(
        (o.kind, o.stage, o.detail if o.kind == "refused" else o.sentence[:70]) for o in found
    )
    rows = [
        {"outcome": kind, "stage": stage, "sentence": sentence, "cases": count}
        for (kind, stage, sentence), count in sorted(sorts.items(), key=lambda s: (s[0][0], -s[1]))
    ]
    show(f"{fuzz.name}: {len(found)} cases, seed {seed}", rows)
    total = Counter(outcome.kind for outcome in found)
    return {
        "kind": fuzz.name,
        "cases": len(found),
        "seed": seed,
        "accepted": total["accepted"],
        "refused": total["refused"],
        "sorts of sentence": sum(kind == "refused" for kind, *_ in sorts),
        "findings": total["finding"],
        "slowest s": round(slowest, 1),
    }


if __name__ == "__main__":
    sys.exit(main())
