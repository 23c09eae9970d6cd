"""Random scenes against an over-refined reference, and one report of what held.

    python -m validation.attack --scenes 100 --seed 1 [--solid 30] [--tolerance 0.01 0.05 0.1]

Outcomes and references are kept in validation/results/attack/: a run that was stopped goes on
where it was, and after a change of the product only the product is run again.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.machine.whole_file import whole
from validation.attack.bands import BandTable
from validation.attack.campaign import LANES, collect, described, problem_of, scene_of, truth_for
from validation.attack.outcome import stamp
from validation.attack.reference import FOLDER
from validation.attack.scenes import distribution
from validation.attack.verdicts import VerdictTable

REPORT = FOLDER.parent.parent / "attack.md"


class Tally:
    """What became of the scenes of all lanes."""

    def __init__(self):
        self.bands, self.verdicts = BandTable(), VerdictTable()
        self.problems: list[str] = []
        self.judged = self.skipped = 0

    def add(self, row: dict) -> None:
        """Judge one outcome."""
        if problem := problem_of(row):
            self.problems.append(f"seed {row['seed']}, {row['lane']}: {problem}")
            return
        traits = described(row)
        try:
            reference = truth_for(row)
            fair = truth_for(row, "section") if row["lane"] == "all" else None
        except (SolidgearError, ValueError, ArithmeticError, np.linalg.LinAlgError) as error:
            self.problems.append(f"seed {row['seed']}, no reference: {error}")
            return
        if reference is None:
            self.skipped += 1
            return
        self.judged += 1
        if row["lane"] == "all":
            self.bands.add(row, traits, reference, "harmonic")
            self.verdicts.add(row, traits, reference, fair)
        else:
            self.bands.add(row, traits, reference, "solid", row["lane"])
        for model in ("harmonic", "solid"):
            found = row["models"].get(model)
            if found and not found["bands"]:
                why = found["why_not"] or "no reason told"
                self.problems.append(
                    f"seed {row['seed']}, {row['lane']}: no band of {model}: {why}"
                )


def report(tally: Tally, seeds) -> str:
    """The whole as Markdown."""
    drawn = distribution([scene_of(seed, None) for seed in seeds])
    lines = [
        "# Random scenes against an over-refined reference",
        "",
        f"{len(seeds)} scenes, seeds {seeds[0]} to {seeds[-1]}, product {stamp()}; "
        f"{tally.judged} outcomes judged, {tally.skipped} without a reference "
        f"(too many unknowns), {len(tally.problems)} with problems.",
        "",
        "| drawn | |",
        "| --- | --- |",
        *(f"| {name} | {told} |" for name, told in drawn),
        "",
        "## Bands",
        "",
        "An error counts where it is above 1e-7 and the truth is known well enough to tell.",
        "Ratios are of the band to the true error.",
        *tally.bands.lines(),
        "",
        "## Verdicts",
        "",
        *tally.verdicts.lines(),
        "",
        f"## Problems: {len(tally.problems)}",
        "",
        *(f"- {p}" for p in tally.problems),
    ]
    return "\n".join(lines) + "\n"


def main(arguments: list[str] | None = None) -> int:
    """Command line; the exit code is 1 if a valid verdict was false."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1, help="of the first scene; the others follow")
    parser.add_argument(
        "--solid",
        type=int,
        default=0,
        help="scenes for the bands of the 3D solid, each with HEX20 and with TET10",
    )
    parser.add_argument(
        "--tolerance",
        type=float,
        nargs="+",
        default=[None],
        help="each in turn, instead of the scenes' own",
    )
    parser.add_argument(
        "--timeout", type=float, default=600.0, help="seconds a comparison may take"
    )
    parser.add_argument("--out", type=Path, default=REPORT)
    options = parser.parse_args(arguments)
    seeds = range(options.seed, options.seed + options.scenes)
    start = time.monotonic()

    def tell(text: str) -> None:
        print(f"{time.monotonic() - start:7.0f} s  {text}", flush=True)

    tally = Tally()
    try:
        for lane, tolerance in ((lane, t) for lane in LANES for t in options.tolerance):
            mine = (
                seeds
                if lane == "all"
                else seeds[: options.solid]
                if tolerance == options.tolerance[0]
                else ()
            )
            rows = collect(mine, tolerance, lane, options.timeout, tell)
            for k, row in enumerate(rows):
                tally.add(row)
                tell(f"{lane}: {k + 1} of {len(rows)} judged, seed {row['seed']}")
    except KeyboardInterrupt:
        tell("interrupted; reporting what there is")
    text = report(tally, seeds)
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with whole(options.out) as partial:
        partial.write_text(text)
    print(text)
    return 1 if tally.verdicts.total("false valid") else 0


if __name__ == "__main__":
    sys.exit(main())
