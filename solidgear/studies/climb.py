"""One solid on ever finer meshes, until the bands of what is asked are within a tolerance.

A bar needs two solutions: those of the two coarsest meshes, or, where a rung has pairs, of two orders
on one mesh.  They are solved for everything that is asked, all further ones only for what is still
open: what is within the tolerance keeps its value and its bar.  A first torsion that needs a finer
mesh than all else then costs the torsion of that mesh alone.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from solidgear.body import Body, as_supports
from solidgear.evidence.answer import ENOUGH, Numbers, numbers
from solidgear.evidence.bands import Band
from solidgear.evidence.quantities import AT, described, diagonals, points_of, size
from solidgear.evidence.sequence_bands import feature_effect, pair_bands, sequence_bands
from solidgear.fidelity import build
from solidgear.fidelity.edges import crowded, thin_disc
from solidgear.fidelity.rung import Rung
from solidgear.solve.condensed import Condensed, Coupled
from solidgear.solve.families import FAMILIES
from solidgear.solve.modes import ModeSet, modes
from solidgear.solve.statics import condense
from solidgear.solve.supported import decoupled, groups
from solidgear.studies.effort import foretold
from solidgear.studies.steps import ABOVE, BELOW, BOTH, Step, Value

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
#: what a mesh was solved for is named up to so many numbers
FEW = 3
#: a bar has one side where the solver has left no more than this share of it
SOLVER_SHARE = 0.01


#: families of motion that are solved together, None for all of them, and what is asked of them
Question = tuple[tuple[str, ...] | None, tuple[str, ...]]


def family_of(quantity: str) -> str:
    """The family of motion that a quantity belongs to."""
    _, place, _ = described(quantity)
    if isinstance(place, str):
        return place.split()[0]
    return next(name for name, components in FAMILIES.items() if set(place) <= set(components))


class Climb:
    """One solid on ever finer meshes; what the last of them was solved with is kept.

    Attributes
    ----------
    levels : list of Numbers
        Of every mesh, coarse to fine: what was solved for on it.
    bands : dict of str to Band
        Of every quantity, on the finest mesh that was solved for it.
    compliances : dict of tuple of str to Condensed
        Statics at the main point by families of motion, on the finest mesh that was solved for them.
    """

    #: place of the first pair of orders that may be tried
    least_pair = 0

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
        self.missing: set[str] = set()
        self.groups: list[tuple[str, ...]] | None = None
        self._changes: list[Mapping[str, float]] = []
        self.left_out = 0.0
        self.body: Body | None = None
        self.options: dict[str, Any] = {}
        self._places: list[int] = []
        self._last: tuple[Body | None, dict[str, Any]] = (None, {})
        self.compliances: dict[tuple[str, ...], Condensed] = {}
        self.modes: ModeSet | None = None

    def run(self) -> None:
        """Climb until every band is within the tolerance, or there is no finer mesh."""
        for level in self._meshes():
            start = time.perf_counter()
            questions = self._questions()
            asked = {q for _, names in questions for q in names}
            only = (
                tuple(q for q in self.wanted if q in asked) if len(asked) < len(self.wanted) else ()
            )
            setting = _words(level) + (f", for {_few(only)}" if only else "")
            cost = "" if self.rung.unfit(self.scene) else foretold(self.scene, self.rung, level)
            self.progress(f"{self.rung.title}: {setting}{cost}")
            unknowns = self._solve(level, questions)
            self.options = dict(level)
            self.missing = (self.missing | asked) - set(self.levels[-1].quantities)
            bar = self.judge()
            spent = time.perf_counter() - start
            self.steps.append(
                Step(
                    self.rung.name,
                    setting,
                    valid=True,
                    bar=bar,
                    unknowns=unknowns,
                    seconds=spent,
                    only=only,
                    options=self.options,
                )
            )
            if len(self.levels) == 2 and not self.values():
                self._choose("nothing that was asked for exists in this scene")
                return
            if bar is not None and bar <= self.tol:
                self._choose("")
                return
            if bar is not None and (why := self._in_vain()):
                self._choose(why)
                return
        only_one = self.plan.fixed and len(self.plan.levels) == 1
        self._choose(
            "the mesh is that of the file, and nothing finer tells how good it is"
            if only_one
            else "no finer mesh is calibrated"
        )

    def _meshes(self) -> Iterator[Mapping[str, Any]]:
        """All meshes, coarse to fine."""
        if not self.plan.pairs:
            yield from self.plan.levels
            return
        # what neither order tells without layers: a thin disc bends towards its free edge, and shafts
        # strain between seats that all but touch
        blind = thin_disc(self.scene) or crowded(self.scene)
        least = max(self.least_pair, 1 if blind else 0)
        for place, orders in self.plan.pairs_for(self.tol, least).items():
            self._places.append(place)
            yield from orders

    def stop(self, why: str) -> None:
        """End with what there is: the lower order of a pair is nothing that could be judged."""
        if self._last[0] is not None:
            self.body, self.options = self._last
        self._choose(f"the next mesh could not be solved: {why}")

    def values(self) -> tuple[Value, ...]:
        """What was asked for, each from the finest mesh that was solved for it."""
        out = []
        for name in self._known():
            history = self._history(name)
            finest = history[-1].quantities
            unit, scale = described(name)[2], size(finest, name)
            bar, side = self.bar(name), self._side(name)
            orders = self._orders(name)
            rests_on = len(orders) or len(history)
            out.append(Value(name, finest[name], unit, bar, rests_on, scale, side, orders))
        return tuple(out)

    def _orders(self, name: str) -> tuple[int, ...]:
        """Orders of the pair that a quantity's value and bar come from."""
        known = [k for k, level in enumerate(self._judged(self.levels)) if name in level.quantities]
        if not self.plan.pairs or len(known) < 2:
            return ()
        return tuple(mesh["order"] for mesh in self.plan.pairs[self._places[known[-1] // 2]])

    def _known(self) -> list[str]:
        """What was asked for and is there."""
        return [q for q in self.wanted if q not in self.missing and self._history(q)]

    def _history(self, name: str) -> list[Numbers]:
        """The meshes that a quantity was solved on, coarse to fine."""
        return [level for level in self._judged(self.levels) if name in level.quantities]

    def _judged(self, levels: list[Numbers]) -> list[Numbers]:
        """Without the lower order of a pair that is not whole."""
        odd = self.plan.pairs and len(levels) % 2 and len(levels) > 1
        return levels[:-1] if odd else levels

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

    def _questions(self) -> list[Question]:
        """What the next mesh is solved for."""
        if len(self.levels) < 2:
            families = None if self.groups is None else tuple(f for g in self.groups for f in g)
            return [(families, self.wanted)]
        floors = self.floors()
        open_ = [q for q in self._open() if not floors.get(q, 0.0) > self.tol]
        if self.groups is None:
            return [(None, tuple(open_))]
        by_group = [(g, tuple(q for q in open_ if family_of(q) in g)) for g in self.groups]
        return [(group, names) for group, names in by_group if names]

    def _open(self) -> list[str]:
        """What is there, and not yet within the tolerance."""
        return [q for q in self._known() if not self.bar(q) <= self.tol]

    def floors(self) -> dict[str, float]:
        """Least bars on the finest mesh: a share of what features change, where the rung has one."""
        factors = self.rung.factors
        if factors is None or not factors.effect:
            return {}
        for level in self.levels[len(self._changes) :]:
            self._changes.append(feature_effect(self.scene, factors, level.quantities))
        finest = {name: change for level in self._changes for name, change in level.items()}
        meshes = len(self.plan.levels)
        return {q: factors.least_share(q.partition(AT)[0], meshes) * c for q, c in finest.items()}

    def _in_vain(self) -> str:
        """Why no finer mesh would help, if none would: all that is open is at its floor."""
        floors, open_ = self.floors(), self._open()
        if not open_ or not all(floors.get(q, 0.0) > self.tol for q in open_):
            return ""
        top = max(open_, key=floors.__getitem__)
        return (
            f"no mesh makes bars of {_few(tuple(open_))} as narrow: the {self.rung.title} is sure "
            "of a quantity to a share of what features change of it, here to "
            f"{100 * floors[top]:.2g} % of {top} at best"
        )

    def _solve(self, level: Mapping[str, Any], questions: list[Question]) -> int:
        """Solve a mesh for some questions; its unknowns."""
        values: dict[str, float] = {}
        solver: dict[str, float] = {}
        unknowns, cells = 0, None
        for families, names in questions:
            body = self._body(level, families)
            found = self._numbers(body, families, names)
            values |= found.quantities
            solver |= found.solver
            unknowns, cells = unknowns + body.size, body.mesh.get("representative_size")
            self.body = body
        if not self.levels:
            assert self.body is not None  # there is something to ask for
            self.groups = self.needed(self.body)
        self.levels.append(Numbers(values, solver))
        self.sizes.append(cells)
        return unknowns

    def _body(self, level: Mapping[str, Any], families: tuple[str, ...] | None) -> Body:
        options = dict(level)
        if families is not None and "families" in self.rung.options:
            options["families"] = families
        return build(self.scene, self.rung.name, **options)

    def needed(self, body: Body) -> list[tuple[str, ...]] | None:
        """Families that the question is about, each with those that bearings couple to it."""
        if len(body.blocks) < len(FAMILIES) or "families" not in self.rung.options:
            return None  # one block holds all motions, or the builder makes all of them at once
        supports = as_supports(self.scene)
        spring, self.left_out = decoupled(body, supports, COUPLING * self.tol)
        asked = {family_of(q) for q in self.wanted}
        together: list[set[str]] = []
        for group in groups(body, supports, spring):
            components = {c for b in group for c in body.blocks[b].components}
            here = {name for name, own in FAMILIES.items() if components & set(own)}
            # bending in one plane and in the other are two groups of one family
            apart = [families for families in together if not families & here]
            together = [*apart, here.union(*(f for f in together if f & here))]
        return [tuple(f for f in FAMILIES if f in here) for here in together if here & asked]

    def _numbers(
        self, body: Body, families: tuple[str, ...] | None, names: tuple[str, ...]
    ) -> Numbers:
        supports = as_supports(self.scene)
        if families is not None:
            supports = supports.on(c for f in families for c in FAMILIES[f])
        kinds = {described(q)[0] for q in names}
        statics: Condensed | None = None
        found: ModeSet | None = None
        further: dict[str, Condensed] = {}
        coupled: Coupled | None = None
        if kinds & {"compliance", "stiffness"}:
            statics = condense(body, supports, self.scene.port.name)
            alone = [q for q in names if AT in q and not points_of(q)]
            points = dict.fromkeys(q.partition(AT)[2] for q in alone)
            further = {point: condense(body, supports, point) for point in points}
            pairs = {point for q in names for point in points_of(q) or ()}
            if pairs:
                both = tuple(port.name for port in self.scene.ports if port.name in pairs)
                coupled = condense(body, supports, both)
            self._keep_statics(families, statics, further, coupled)
        if "frequency" in kinds:
            count = shapes(families, names)
            found = self.modes = modes(body, supports, count, ovalising=False)
        return numbers(statics, found, further, coupled)

    def _keep_statics(
        self,
        families: tuple[str, ...] | None,
        statics: Condensed,
        further: Mapping[str, Condensed],
        coupled: Coupled | None,
    ) -> None:
        """Remember statics at the main point, at further ones and between points."""
        self.compliances[families or tuple(FAMILIES)] = statics

    def judge(self) -> float | None:
        """Bands of what the finest mesh was solved for, and the largest bar of all that was asked."""
        if len(self.levels) < 2:
            return None
        self.bands |= self.bands_of(self.levels)
        if self._judged(self.levels) is self.levels:
            self._last = self.body, self.options
        bars = [self.bar(q) for q in self._known()]
        return max(bars, default=None) if self.bands else None

    def bands_of(self, levels: list[Numbers]) -> dict[str, Band]:
        """Bands of the finest of two or more meshes of this rung."""
        assert self.rung.factors is not None  # as every solid
        levels = self._judged(levels)
        values = [level.quantities for level in levels]
        if self.plan.pairs:
            place = self._places[len(levels) // 2 - 1]
            return pair_bands(self.scene, self.rung.factors, place, values[-2:], levels[-1].solver)
        return sequence_bands(
            self.scene, self.plan, self.rung.factors, values, levels[-1].solver, self.sizes
        )

    def bar(self, name: str) -> float:
        if name not in self.bands:
            return math.inf
        return max(self.bands[name].gci, RISE * self._rise(name))

    def _rise(self, name: str) -> float:
        """How much a frequency has risen at the last step, beyond what the solver leaves."""
        history = self._history(name)
        if described(name)[0] != "frequency" or len(history) < 2:
            return 0.0
        before, last = history[-2:]
        rise = last.quantities[name] / before.quantities[name] - 1
        allowed = before.solver.get(name, 0.0) + last.solver.get(name, 0.0)
        return max(0.0, rise - allowed)

    def _choose(self, why: str) -> None:
        if self.steps:
            self.steps[-1] = replace(self.steps[-1], why=why, chosen=True)


def _words(level: Mapping[str, Any]) -> str:
    """A mesh in a few words."""
    return ", ".join(f"{word} {level[name]}" for name, word in SETTINGS.items() if name in level)


def _few(names: tuple[str, ...]) -> str:
    """Some names, or how many there are."""
    return ", ".join(names) if len(names) <= FEW else f"{len(names)} numbers"


def shapes(families: tuple[str, ...] | None, names: tuple[str, ...]) -> int:
    """Elastic shapes that hold the modes asked for."""
    if families is None or len(families) > 1:
        return ENOUGH
    places = [int(q.split()[1]) for q in names if described(q)[0] == "frequency"]
    return 2 * max(places) + 2
