"""Ten searches of `optimise` beside brute force: active limits, lists, whole numbers, two goals.

    python -m validation.optimum
    python -m validation.optimum --only discs

Brute force solves a fine grid of the ranges in every combination of the lists, then three times a
finer one around the best of it; a design of a front is behind by as much as one of the grid beats it in both
goals. All by Timoshenko beams, which cost some hundredths of a second. Rows go to
validation/results/optimum.json.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, field
from time import process_time
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.variants.optimise.wish import Wish, limit_of, wish_of
from validation.common import ROOT, kept, stamp

MODEL = "timoshenko"
#: places of the grid around the best of the one before, by the number of ranges, and how often
FINER, TIMES = {1: 17, 2: 9, 3: 5}, 3


@dataclass(frozen=True)
class Range:
    """An entry that varies over a range, and the places of its grid."""

    path: str
    low: float
    high: float
    unit: str
    count: int


@dataclass(frozen=True)
class Problem:
    """A search, and the grid that stands beside it."""

    name: str
    source: Any
    goals: tuple[str, ...]
    ranges: tuple[Range, ...] = ()
    lists: dict[str, tuple[str, ...]] = field(default_factory=dict)
    keep: tuple[str, ...] = ()
    ask: tuple[str, ...] = ()  #: of the sweep

    @property
    def vary(self) -> list[str]:
        """Entries of the search."""
        ranges = [f"{r.path}={r.low} {r.unit}:{r.high} {r.unit}" for r in self.ranges]
        return [*ranges, *(f"{path}={','.join(words)}" for path, words in self.lists.items())]


STEPPED = str(ROOT / "geometry" / "shaft_stepped.toml")
CATALOGUE = str(ROOT / "geometry" / "gearbox_catalogue.toml")
TRAIN = str(ROOT / "geometry" / "gearbox_train.toml")
#: a shaft with a disc at either end, on which every seat has its own valley
DISCS: dict[str, Any] = {
    "material": {"E": "207 GPa", "nu": 0.3, "density": "7850 kg/m^3"},
    "segment": [
        {"kind": "cylinder", "name": "left", "length": "60 mm", "diameter": "120 mm"},
        {"kind": "cylinder", "name": "mid", "length": "500 mm", "diameter": "40 mm"},
        {"kind": "cylinder", "name": "right", "length": "60 mm", "diameter": "110 mm"},
    ],
    "bearing": [
        {
            "name": "A",
            "position": "250 mm",
            "seat_width": "20 mm",
            "stiffness": {"kxx": "2e8 N/m", "kyy": "2e8 N/m", "kzz": "2e8 N/m"},
        },
        {
            "name": "B",
            "position": "350 mm",
            "seat_width": "20 mm",
            "stiffness": {"kxx": "2e8 N/m", "kzz": "2e8 N/m"},
        },
    ],
    "port": {"at": "left.middle", "attach_to": "left"},
}
MIDDLE = Range("segment.middle.diameter", 60, 100, "mm", 21)
SEAT_B = Range("bearing.B.position", -60, -20, "mm", 21)
PROBLEMS = (
    Problem("span", STEPPED, ("min C_thx",), (Range("bearing.B.position", -75, -20, "mm", 56),)),
    Problem(
        "two limits",
        STEPPED,
        ("min mass",),
        (MIDDLE, SEAT_B),
        keep=("bending 1 > 780 Hz", "C_zz < 4 um/kN"),
    ),
    Problem(
        "three diameters",
        STEPPED,
        ("min mass",),
        (
            Range("segment.left.diameter", 40, 60, "mm", 7),
            Range("segment.middle.diameter", 60, 100, "mm", 9),
            Range("segment.right.diameter", 40, 70, "mm", 7),
        ),
        keep=("bending 1 > 800 Hz", "C_zz < 3.6 um/kN"),
    ),
    Problem(
        "discs, second bending",
        DISCS,
        ("max bending 2",),
        (Range("bearing.B.position", 75, 540, "mm", 94),),
    ),
    Problem(
        "discs, lowest of all",
        DISCS,
        ("max f1",),
        (
            Range("bearing.A.position", 75, 300, "mm", 24),
            Range("bearing.B.position", 320, 545, "mm", 24),
        ),
    ),
    Problem(
        "discs, both seats, a limit",
        DISCS,
        ("max bending 2",),
        (
            Range("bearing.A.position", 75, 300, "mm", 24),
            Range("bearing.B.position", 320, 545, "mm", 24),
        ),
        keep=("C_zz < 60 um/kN",),
    ),
    Problem(
        "designation and diameter",
        CATALOGUE,
        ("min mass",),
        (
            Range("segment.pinion.diameter", 50, 64, "mm", 8),
            Range("bearing.B.position", 130, 165, "mm", 8),
        ),
        {"bearing.A.catalogue.designation": ("NU 207", "NU 208", "NU 209", "NU 307", "6307")},
        ("A.life > 3e11",),
        ("bearing",),
    ),
    Problem(
        "lists alone, two goals",
        CATALOGUE,
        ("min mass", "max life"),
        (),
        {
            "bearing.A.catalogue.designation": ("NU 206", "NU 207", "NU 208", "NU 209", "NU 307"),
            "material": ("42CrMo4", "EN-GJS-700", "aluminium"),
        },
        (),
        ("bearing",),
    ),
    Problem("front", STEPPED, ("min mass", "min C_zz"), (MIDDLE, SEAT_B), keep=("f1 > 500 Hz",)),
    Problem(
        "teeth",
        TRAIN,
        ("min pinion.A.radial",),
        (Range("pinion.bearing.B.position", 130, 165, "mm", 15),),
        {"pinion.teeth": ("18", "19", "20", "21", "22", "23", "24")},
        ("misalignment_f_sh < 1 um",),
        ("deflect",),
    ),
)


def grid(
    problem: Problem, spans: Sequence[tuple[float, float, int]], words: dict[str, tuple[str, ...]]
) -> list[dict[str, Any]]:
    """Return the rows of all combinations of spans of the ranges and words of the lists."""
    texts = [
        f"{r.path}={low} {r.unit}:{high} {r.unit}:{count}"
        for r, (low, high, count) in zip(problem.ranges, spans)
    ]
    texts += [f"{path}={','.join(values)}" for path, values in words.items()]
    how: dict[str, Any] = {"n": 6}
    if problem.source == TRAIN:
        how |= {"models": {"pinion": MODEL, "gear": MODEL}}
    else:
        how |= {"model": MODEL}
    if problem.ask:
        how |= {"ask": problem.ask}
    swept = sg.sweep(problem.source, texts, **how)
    columns = dict(swept.columns)
    return [{name: values[k] for name, values in columns.items()} for k in range(len(swept))]


def value_of(wish: Wish, row: dict[str, Any]) -> float:
    """Return a number of a row, small where it is good; infinite where it has none."""
    number = wish.value([row]) if row["status"] == "ok" else None
    if number is None:
        return np.inf
    return -number[0] if wish.upward else number[0]


def keeps(problem: Problem, row: dict[str, Any]) -> bool:
    """Return True for a row within all limits."""
    if row["status"] != "ok":
        return False
    return all(limit_of(text).missing([row]) <= 0 for text in problem.keep)


def brute(problem: Problem) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return all rows of the grids, and the best of them by the first goal."""
    spans = [(r.low, r.high, r.count) for r in problem.ranges]
    goal = wish_of(problem.goals[0])
    rows = grid(problem, spans, problem.lists)
    best = _best(problem, goal, rows)
    words = {path: (_word(best[path]),) for path in problem.lists}
    for _ in range(TIMES if len(problem.goals) == 1 and problem.ranges else 0):
        spans = [
            _around(_in_unit(best[r.path], r.unit), r, span, FINER[len(spans)])
            for r, span in zip(problem.ranges, spans)
        ]
        rows += grid(problem, spans, words)
        best = _best(problem, goal, rows)
    return rows, best


def _word(value: str | float) -> str:
    """Return a value of a list as a file has it."""
    return value if isinstance(value, str) else f"{value:g}"


def _best(problem: Problem, goal: Wish, rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    return min((row for row in rows if keeps(problem, row)), key=lambda row: value_of(goal, row))


def _in_unit(value: float, unit: str) -> float:
    return value / {"mm": 1e-3}[unit]


def _around(
    value: float, whole: Range, span: tuple[float, float, int], finer: int
) -> tuple[float, float, int]:
    """Return a finer span, of one step to both sides, within the range."""
    step = (span[1] - span[0]) / (span[2] - 1)
    return max(value - step, whole.low), min(value + step, whole.high), finer


def beside(problem: Problem) -> dict[str, Any]:
    """Return what the search and brute force have found, and how far the search is behind."""
    start = process_time()
    optimum = sg.optimise(problem.source, problem.vary, problem.goals, problem.keep, model=MODEL)
    between = process_time()
    rows, best = brute(problem)
    end = process_time()
    goals = [wish_of(text) for text in problem.goals]
    if len(goals) == 1:
        ours = -optimum.best.value if goals[0].upward else optimum.best.value
        theirs = value_of(goals[0], best)
        behind = (ours - theirs) / abs(theirs)
    else:
        ours, theirs, behind = (
            optimum.best.value,
            value_of(goals[0], best),
            _front(problem, optimum, rows),
        )
    return {
        "problem": problem.name,
        "goal": " and ".join(problem.goals),
        "keep": list(problem.keep),
        "vary": problem.vary,
        "search": abs(ours),
        "grid": abs(theirs),
        "behind_percent": 100 * behind,
        "front": len(optimum.front),
        "designs": len(optimum.path),
        "grid_designs": len(rows),
        "search_s": between - start,
        "grid_s": end - between,
        "words": list(optimum.sentences),
    }


def _front(problem: Problem, optimum: Any, rows: Sequence[dict[str, Any]]) -> float:
    """Return by how much a design of the front is beaten at most: in both goals by one design of the
    grid, relative, by the lesser of the two.
    """
    goals = [wish_of(text) for text in problem.goals]
    sound = [row for row in rows if keeps(problem, row)]
    points = np.array([[value_of(goal, row) for goal in goals] for row in sound])
    worst = -np.inf
    for design in optimum.front:
        ours = np.array(
            [
                -number.value if goal.upward else number.value
                for goal, number in zip(goals, design.goals)
            ]
        )
        beaten = ((ours - points) / np.abs(ours)).min(axis=1)
        worst = max(worst, float(beaten.max()))
    return worst


def main() -> None:
    """Run the problems, keep the rows and print them."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--only", default="", help="problems whose name holds these letters")
    asked = parser.parse_args()
    for problem in PROBLEMS:
        if asked.only not in problem.name:
            continue
        row = beside(problem)
        kept("optimum", {problem.name: row, "made": stamp()})
        print(
            f"{row['problem']:28} search {row['search']:.8g}  grid {row['grid']:.8g}  behind "
            f"{row['behind_percent']:+.4f} %  designs {row['designs']} and {row['grid_designs']}  "
            f"{row['search_s']:.1f} s and {row['grid_s']:.1f} s",
            flush=True,
        )


if __name__ == "__main__":
    main()
