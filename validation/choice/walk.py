"""The program's climb, walked over numbers that are there already."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.evidence.answer import Numbers
from solidgear.evidence.quantities import QUANTITIES, described, size
from solidgear.fidelity.edges import sharpest_edge
from solidgear.fidelity.ladder import LADDER
from solidgear.studies.climb import Climb, Question, family_of
from validation.attack.scenes import random_scene
from validation.choice.members import options_of

#: errors below this are rounding, and say nothing of a bar
LEAST = 1e-7
#: the truth must be known this much better than an error to judge its bar
KNOWN = 0.2


@dataclass
class Tally:
    """What became of the answers at one tolerance; ``worst`` are largest bars over largest errors of
    a scene, ``cost`` what the climb takes over the cheapest mesh that will do, ``fixed`` what the
    solid's usual mesh takes over the climb.
    """

    scenes: int = 0
    reached: int = 0
    wrong: list[str] = field(default_factory=list)
    short: list[str] = field(default_factory=list)
    ratios: list[float] = field(default_factory=list)
    worst: list[float] = field(default_factory=list)
    numbers: int = 0
    cost: list[float] = field(default_factory=list)
    first: list[int] = field(default_factory=list)
    fixed: list[float] = field(default_factory=list)


def error_of(values: dict[str, float], truth: dict[str, float], name: str) -> float:
    """True relative error of a quantity, couplings on the scale of their diagonal entries."""
    return abs(values[name] - truth[name]) / size(truth, name)


def cheapest(row: dict[str, Any], tol: float) -> float | None:
    """Seconds of the cheapest mesh that is within a tolerance; None where none is."""
    truth = row["ref"]["values"]
    good = []
    for member in row["members"]:
        if "error" in member:
            continue
        known = [q for q in member["q"] if q in truth]
        if all(error_of(member["q"], truth, q) <= tol for q in known):
            good.append(sum(member["t"]))
    return min(good, default=None)


class Replay(Climb):
    """The climb over the meshes of a row, which are not solved again."""

    def __init__(self, row: dict[str, Any], tol: float):
        scene = random_scene(row["seed"])
        super().__init__(scene, LADDER["harmonic"], tuple(QUANTITIES), tol, lambda _: None)
        self.row, self.spent = row, 0.0
        groups = [tuple(group) for group in row["groups"]]
        self.groups = groups if len(groups) > 1 else None

    def _solve(self, level: Mapping[str, Any], questions: list[Question]) -> int:
        member = next((m for m in self.row["members"] if _is(m, level)), None)
        if member is None:
            raise SolidgearError("this mesh was not solved")
        values: dict[str, float] = {}
        for families, names in questions:
            kinds = {described(q)[0] == "frequency" for q in names}
            own = families if self.groups and len(self.levels) > 1 else None
            seconds = member["t"] if own is None else member["parts"][self.groups.index(own)]
            self.spent += seconds[0] + seconds[1] * (False in kinds) + seconds[2] * (True in kinds)
            values |= {
                q: value
                for q, value in member["q"].items()
                if (own is None or family_of(q) in own)
                and (described(q)[0] == "frequency") in kinds
            }
        self.levels.append(Numbers(values, member["solver"]))
        self.sizes.append(None)
        return member["size"]


def _is(member: dict[str, Any], level: Mapping[str, Any]) -> bool:
    return "error" not in member and options_of(member["member"]) == level


def walk(row: dict[str, Any], tol: float, tally: Tally) -> None:
    """Climb until the bars are within the tolerance, and judge what comes out."""
    truth, unsure = row["ref"]["values"], row["ref"]["uncertainty"]
    if max(unsure.get(q, 0.0) for q in truth) > tol / 3:
        return  # the truth is not known well enough
    scene = random_scene(row["seed"])
    climb = Replay(row, tol)
    tally.scenes += 1
    with contextlib.suppress(SolidgearError):
        climb.run()
    values = climb.values()
    if not climb.bands:
        return
    reached = all(v.bar <= tol for v in values)
    tally.reached += reached
    best = cheapest(row, tol)
    if reached and best is not None:
        tally.cost.append(climb.spent / best)
        tally.first.append(len(climb.levels))
    if reached and "t" in row.get("fixed", ()):
        tally.fixed.append(sum(row["fixed"]["t"]) / climb.spent)
    edge = sharpest_edge(scene)
    errors, bars = [LEAST], [0.0]
    for value in values:
        name, own = value.quantity, value.bar
        if name not in truth:
            continue
        error = error_of({name: value.value}, truth, name)
        known = unsure.get(name, 0.0)
        tally.numbers += 1
        errors.append(error)
        bars.append(own)
        words = f"seed {row['seed']} ({edge}), {name}: error {error:.2e}, bar {own:.2e}"
        if reached and error - known > tol:
            tally.wrong.append(words)
        if error < LEAST or known > KNOWN * error:
            continue
        tally.ratios.append(own / error)
        if error - known > own:
            tally.short.append(words)
    tally.worst.append(max(bars) / max(errors))


def table(tallies: dict[float, Tally]) -> list[str]:
    """Markdown of all tolerances."""
    rows = [
        "| tolerance | scenes | reached | numbers beyond it | beyond their bar | bar over error: "
        "5 %, median, 95 % | the same, largest of a scene | meshes tried, median | cost over the cheapest mesh that will do: "
        "median, 90 % | the solid's usual mesh over the climb, median |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for tol, tally in tallies.items():
        if not tally.scenes:
            continue
        low, middle, high = quantiles(tally.ratios, (0.05, 0.5, 0.95))
        shortest, usual, longest = quantiles(tally.worst, (0.05, 0.5, 0.95))
        half, most = quantiles(tally.cost, (0.5, 0.9))
        tried = quantiles(tally.first, (0.5,))[0]
        rows.append(
            f"| {tol:g} | {tally.scenes} | {tally.reached} | {len(tally.wrong)} of {tally.numbers} "
            f"| {len(tally.short)} of {len(tally.ratios)} | {low:.2g}, {middle:.2g}, {high:.2g} "
            f"| {shortest:.2g}, {usual:.2g}, {longest:.2g} "
            f"| {tried:g} | {half:.2g}, {most:.2g} | {quantiles(tally.fixed, (0.5,))[0]:.2g} |"
        )
    return rows


def quantiles(values: Sequence[float], at: Sequence[float]) -> list[float]:
    """Quantiles; NaN of nothing."""
    return [float(v) for v in np.quantile(list(values) or [np.nan], at)]
