"""One solid on ever finer meshes, until the bands of what is asked are within a tolerance."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from solidgear.body import Body, as_supports
from solidgear.evidence.answer import ENOUGH, Numbers, numbers
from solidgear.evidence.bands import Band
from solidgear.evidence.quantities import AT, described, diagonals, size
from solidgear.evidence.sequence_bands import sequence_bands
from solidgear.fidelity import build
from solidgear.fidelity.rung import Rung
from solidgear.solve.families import FAMILIES
from solidgear.solve.modes import ModeSet, modes
from solidgear.solve.statics import Condensed, condense
from solidgear.solve.supported import decoupled, groups

if TYPE_CHECKING:
    from solidgear.scene import Scene

Progress = Callable[[str], None]

#: couplings by bearings may be left out where they move nothing by more than this part of the
#: tolerance
COUPLING = 0.01
#: options of a mesh that are reported, and in which words
SETTINGS = {
    "order": "order",
    "layers": "layers",
    "around": "cells around",
    "refinement": "refinement",
}
#: a frequency that rises with a finer mesh, by more than the eigensolver leaves, is rounding: the
#: bar is this many times the rise
RISE = 2.0
#: a coupling this small against its diagonal entries is zero
ROUNDING = 1e-9
#: sides on which the exact answer may lie
ABOVE, BELOW, BOTH = "above", "below", "both"
#: a bar has one side where the solver has left no more than this share of it
SOLVER_SHARE = 0.01


@dataclass(frozen=True)
class Value:
    """A number with its bar.

    Attributes
    ----------
    quantity, unit : str
    value : float
        SI.
    bar : float
        Relative; of couplings, to the geometric mean of their diagonal entries. Infinite where
        nothing is known.
    how : str
        Where the bar comes from.
    size : float
        What the bar is relative to, SI.
    side : str
        Where the exact answer of the model lies: ``above`` or ``below`` the value, or ``both`` where
        it may be either.
    """

    quantity: str
    value: float
    unit: str
    bar: float
    how: str
    size: float
    side: str = BOTH

    @property
    def zero(self) -> bool:
        """Whether it is nothing but rounding, as a coupling that symmetry forbids."""
        return abs(self.value) <= ROUNDING * self.size


@dataclass(frozen=True)
class Step:
    """Something that was tried, or passed over.

    Attributes
    ----------
    rung : str
    setting : str
        Of the mesh, in words.
    valid : bool
        Whether it could be an answer at all.
    why : str
        Why it was passed over, or what came after it.
    bar : float or None
        The largest over the quantities asked for; None where there is none yet.
    unknowns : int or None
    seconds : float
    chosen : bool
    """

    rung: str
    setting: str
    valid: bool
    why: str = ""
    bar: float | None = None
    unknowns: int | None = None
    seconds: float = 0.0
    chosen: bool = False


def _family_of(quantity: str) -> str:
    """The family of motion that a quantity belongs to."""
    _, place, _ = described(quantity)
    if isinstance(place, str):
        return place.split()[0]
    return next(name for name, components in FAMILIES.items() if set(place) <= set(components))


class Climb:
    """One solid on ever finer meshes; what the finest of them was solved with is kept."""

    def __init__(
        self,
        scene: Scene,
        rung: Rung,
        wanted: tuple[str, ...],
        tol: float,
        progress: Progress,
    ):
        self.scene, self.rung, self.wanted, self.tol = scene, rung, wanted, tol
        self.progress = progress
        assert rung.meshes is not None  # as every solid
        self.plan = rung.meshes_of(scene, {})
        self.levels: list[Numbers] = []
        self.sizes: list[float | None] = []
        self.steps: list[Step] = []
        self.bands: dict[str, Band] = {}
        self.families: tuple[str, ...] | None = None
        self.left_out = 0.0
        self.body: Body | None = None
        self.options: dict[str, Any] = {}
        self.statics: Condensed | None = None
        self.further: dict[str, Condensed] = {}
        self.modes: ModeSet | None = None

    def run(self) -> None:
        """Climb until every band is within the tolerance, or there is no finer mesh."""
        for level in self.plan.levels:
            start = time.perf_counter()
            self.progress(f"{self.rung.title}: {_words(level)}")
            body = self._body(level)
            self.sizes.append(body.mesh.get("representative_size"))
            self.levels.append(self._level(body))
            self.body, self.options = body, dict(level)
            if len(self.levels) == 1:
                self.families = self._needed(body)
            bar = self.judge()
            self.steps.append(
                Step(
                    self.rung.name,
                    _words(level),
                    True,
                    "",
                    bar,
                    body.size,
                    time.perf_counter() - start,
                )
            )
            if len(self.levels) == 2 and not self.values():
                self._choose("nothing that was asked for exists in this scene")
                return
            if bar is not None and bar <= self.tol:
                self._choose("")
                return
        only = self.plan.fixed and len(self.plan.levels) == 1
        self._choose(
            "the mesh is that of the file, and nothing finer tells how good it is"
            if only
            else "no finer mesh is calibrated"
        )

    def stop(self, why: str) -> None:
        """End with what there is."""
        self._choose(f"the next mesh could not be solved: {why}")

    def values(self) -> tuple[Value, ...]:
        """What was asked for, from the finest mesh."""
        finest = self.levels[-1].quantities
        out = []
        for name in self.wanted:
            if name in finest:
                bar = self.bar(name)
                count = len(self.levels)
                how = f"{count} meshes" if count > 1 else "one mesh only, not judged"
                unit = described(name)[2]
                scale, side = size(finest, name), self._side(name)
                out.append(Value(name, finest[name], unit, bar, how, scale, side))
        return tuple(out)

    def _side(self, name: str) -> str:
        """Where the exact answer lies.

        Of all admissible displacements the exact ones store the least energy under given motions of
        the ports, and the most under given loads; a Rayleigh quotient is least at the exact mode.
        """
        exact = self.rung.from_above and not self.scene.corners
        if not exact or diagonals(name) or name not in self.bands or self._rise(name):
            return BOTH
        # what the solver leaves, and couplings that were left out, may go either way
        if max(self.bands[name].solver, self.left_out) > SOLVER_SHARE * self.bar(name):
            return BOTH
        return ABOVE if described(name)[0] == "compliance" else BELOW

    def _body(self, level: Mapping[str, Any]) -> Body:
        options = dict(level)
        if self.families is not None and "families" in self.rung.options:
            options["families"] = self.families
        return build(self.scene, self.rung.name, **options)

    def _needed(self, body: Body) -> tuple[str, ...] | None:
        """Families that the question is about, and those that bearings couple to them."""
        if len(body.blocks) < len(FAMILIES):
            return None  # one block holds all motions
        supports = as_supports(self.scene)
        spring, self.left_out = decoupled(body, supports, COUPLING * self.tol)
        asked = {_family_of(q) for q in self.wanted}
        out: set[str] = set()
        for group in groups(body, supports, spring):
            components = {c for b in group for c in body.blocks[b].components}
            here = {name for name, own in FAMILIES.items() if components & set(own)}
            if here & asked:
                out |= here
        return tuple(name for name in FAMILIES if name in out)

    def _level(self, body: Body) -> Numbers:
        supports = as_supports(self.scene)
        if self.families is not None:
            supports = supports.on(c for f in self.families for c in FAMILIES[f])
        kinds = {described(q)[0] for q in self.wanted}
        statics: Condensed | None = None
        found: ModeSet | None = None
        if kinds & {"compliance", "stiffness"}:
            statics = condense(body, supports, self.scene.port.name)
            self.statics = statics
            points = dict.fromkeys(q.partition(AT)[2] for q in self.wanted if AT in q)
            self.further = {point: condense(body, supports, point) for point in points}
        if "frequency" in kinds:
            found = self.modes = modes(body, supports, self._shapes(), ovalising=False)
        return numbers(statics, found, self.further)

    def _shapes(self) -> int:
        """Elastic shapes that hold the modes asked for."""
        if self.families is None or len(self.families) > 1:
            return ENOUGH
        places = [int(q.split()[1]) for q in self.wanted if described(q)[0] == "frequency"]
        return 2 * max(places) + 2

    def judge(self) -> float | None:
        """Bands of the finest mesh, and the largest bar of what was asked for."""
        if len(self.levels) < 2:
            return None
        self.bands = self.bands_of(self.levels)
        bars = [self.bar(q) for q in self.wanted if q in self.levels[-1].quantities]
        return max(bars, default=None) if self.bands else None

    def bands_of(self, levels: list[Numbers]) -> dict[str, Band]:
        """Bands of the finest of two or more meshes of this rung."""
        assert self.rung.factors is not None  # as every solid
        values = [level.quantities for level in levels]
        return sequence_bands(
            self.scene, self.plan, self.rung.factors, values, levels[-1].solver, self.sizes
        )

    def bar(self, name: str) -> float:
        if name not in self.bands:
            return math.inf
        return max(self.bands[name].gci, RISE * self._rise(name))

    def _rise(self, name: str) -> float:
        """How much a frequency has risen at the last step, beyond what the solver leaves."""
        if described(name)[0] != "frequency" or len(self.levels) < 2:
            return 0.0
        before, last = self.levels[-2], self.levels[-1]
        if name not in before.quantities:
            return 0.0
        rise = last.quantities[name] / before.quantities[name] - 1
        allowed = before.solver.get(name, 0.0) + last.solver.get(name, 0.0)
        return max(0.0, rise - allowed)

    def _choose(self, why: str) -> None:
        if self.steps:
            self.steps[-1] = replace(self.steps[-1], why=why, chosen=True)


def _words(level: Mapping[str, Any]) -> str:
    """A mesh in a few words."""
    return ", ".join(f"{word} {level[name]}" for name, word in SETTINGS.items() if name in level)
