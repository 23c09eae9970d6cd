"""Automatic choice on random scenes: whether bars hold, how tight they are, and what they cost.

    python -m validation.choice [--scenes 30] [--seed 1] [--tolerance 0.1 0.01 0.001 0.0001]

Scenes are those of `validation.attack`, with its over-refined references.  For every scene and
tolerance `answer` is asked for all quantities and for first bending alone.  Counted are true errors
beyond the tolerance and beyond the bar, the ratio of bar to true error, and processor time over
that of the cheapest mesh of the same climb that is good enough, known with hindsight.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.evidence.quantities import QUANTITIES
from solidgear.fidelity.ladder import LADDER
from solidgear.machine.whole_file import whole
from solidgear.studies.answering import Answered, answer
from solidgear.studies.climb import Climb
from validation.attack.reference import FOLDER, Reference, coupling_scale, reference
from validation.attack.scenes import random_scene

REPORT = FOLDER.parent.parent / "choice.md"
#: errors below this are rounding, and say nothing of a bar
LEAST = 1e-7


@dataclass
class Tally:
    """What became of the answers at one tolerance."""

    answers: int = 0
    reached: int = 0
    wrong: list[str] = field(default_factory=list)
    short: list[str] = field(default_factory=list)
    ratios: list[float] = field(default_factory=list)
    numbers: int = 0
    seconds: list[float] = field(default_factory=list)
    cost: list[float] = field(default_factory=list)
    bending: list[float] = field(default_factory=list)


def error_of(values: dict[str, float], truth: Reference, name: str) -> float:
    """True relative error of a quantity, couplings on the scale of their diagonal entries."""
    return abs(values[name] - truth.values[name]) / coupling_scale(truth.values, name)


def judge(seed: int, tol: float, found: Answered, truth: Reference, tally: Tally) -> None:
    """Hold the bars of an answer against the truth."""
    values = {v.quantity: v.value for v in found.values}
    for row in found.values:
        if row.quantity not in truth.values:
            continue
        error = error_of(values, truth, row.quantity)
        known = truth.uncertainty.get(row.quantity, 0.0)
        tally.numbers += 1
        if found.reached and error - known > tol:
            tally.wrong.append(f"seed {seed}, {row.quantity}: {error:.2e} at {tol:g}")
        if error < LEAST or known > 0.2 * error:
            continue
        tally.ratios.append(row.bar / error)
        if error - known > row.bar:
            tally.short.append(f"seed {seed}, {row.quantity}: {error:.2e}, bar {row.bar:.2e}")


def hindsight(scene, tol: float, truth: Reference) -> tuple[float, float]:
    """Processor seconds of the cheapest mesh that is within the tolerance, and of all meshes up to
    the one that shows it.
    """
    climb = Climb(scene, LADDER["harmonic"], tuple(QUANTITIES), tol, lambda _: None)
    start = time.process_time()
    climb.run()
    spent = time.process_time() - start
    total = sum(step.seconds for step in climb.steps)
    for level, step in zip(climb.levels, climb.steps):
        known = [q for q in level.quantities if q in truth.values]
        if all(error_of(level.quantities, truth, q) <= tol for q in known):
            return spent * step.seconds / total, spent
    return spent * climb.steps[-1].seconds / total, spent


def try_scene(seed: int, tolerances: list[float], tallies: dict[float, Tally]) -> str:
    """One scene at every tolerance; a sentence where it could not be judged."""
    scene = random_scene(seed)
    goal = dict.fromkeys(QUANTITIES, min(tolerances) / 10)
    truth = reference(scene, goal)
    if truth is None:
        return "no reference: too many unknowns"
    for tol in tolerances:
        tally = tallies[tol]
        found = answer(scene, tol, list(QUANTITIES))
        cheapest, spent = hindsight(scene, tol, truth)
        start = time.process_time()
        part = answer(scene, tol, "bending")
        bending = time.process_time() - start
        tally.answers += 1
        tally.reached += found.reached
        tally.seconds.append(spent)
        tally.cost.append(spent / cheapest)
        tally.bending.append(bending / spent)
        judge(seed, tol, found, truth, tally)
        judge(seed, tol, part, truth, tally)
    return ""


def table(tallies: dict[float, Tally]) -> list[str]:
    """Markdown of all tolerances."""
    rows = [
        "| tolerance | answers | reached | numbers beyond it | beyond their bar | bar over error: "
        "5 %, median, 95 % | processor s, median | over the cheapest mesh that will do | bending "
        "alone |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for tol, tally in tallies.items():
        if not tally.answers:
            continue
        low, middle, high = np.quantile(tally.ratios or [np.nan], [0.05, 0.5, 0.95])
        rows.append(
            f"| {tol:g} | {tally.answers} | {tally.reached} | {len(tally.wrong)} of {tally.numbers} "
            f"| {len(tally.short)} of {len(tally.ratios)} | {low:.2g}, {middle:.2g}, {high:.2g} "
            f"| {np.median(tally.seconds):.2g} | {np.median(tally.cost):.2g} "
            f"| {np.median(tally.bending):.2g} |"
        )
    return rows


def main(arguments: list[str] | None = None) -> int:
    """Command line; the exit code is 1 if an answer was wrong."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--scenes", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tolerance", type=float, nargs="+", default=[0.1, 0.01, 1e-3, 1e-4])
    parser.add_argument("--out", type=Path, default=REPORT)
    options = parser.parse_args(arguments)
    tallies = {tol: Tally() for tol in options.tolerance}
    problems = []
    seeds = range(options.seed, options.seed + options.scenes)
    for seed in seeds:
        try:
            problem = try_scene(seed, options.tolerance, tallies)
        except (SolidgearError, ValueError, ArithmeticError) as error:
            problem = str(error).splitlines()[0]
        if problem:
            problems.append(f"seed {seed}: {problem}")
        print(f"{seed - options.seed + 1} of {len(seeds)}, seed {seed} {problem}", flush=True)
    lines = [
        "# Automatic choice on random scenes",
        "",
        f"Seeds {seeds[0]} to {seeds[-1]}; {len(problems)} not judged.",
        "",
        *table(tallies),
        "",
        "## Beyond the tolerance or the bar",
        "",
        *(f"- {text}" for tally in tallies.values() for text in tally.wrong + tally.short),
        "",
        "## Not judged",
        "",
        *(f"- {text}" for text in problems),
    ]
    text = "\n".join(lines) + "\n"
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with whole(options.out) as partial:
        partial.write_text(text)
    print(text)
    return int(any(tally.wrong for tally in tallies.values()))


if __name__ == "__main__":
    sys.exit(main())
