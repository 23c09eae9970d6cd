"""One solid on ever finer meshes, until the bars of what is asked are within a tolerance.

The meshes of a harmonic solid follow its bars (:mod:`solidgear.fidelity.refining`), which every mesh
tells by itself (:mod:`solidgear.evidence.bounded`); of other solids two of a list make a bar. All that
is asked is solved first, later only what is still open: the rest keeps its value and its bar.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.body import Body, Supports, as_supports
from solidgear.evidence.answer import Numbers, numbers, searched
from solidgear.evidence.bands import Band, moves_freely
from solidgear.evidence.bounded import Statics, bounded
from solidgear.evidence.quantities import AT, described, diagonals, points_of, size
from solidgear.evidence.sequence_bands import feature_effect, sequence_bands
from solidgear.fidelity import build
from solidgear.fidelity.refining import MOST_MESHES, Meshed, refined
from solidgear.fidelity.rung import Rung
from solidgear.solve.condensed import Condensed
from solidgear.solve.families import FAMILIES
from solidgear.solve.modes import ModeSet
from solidgear.solve.statics import SOLVED, condense, flexibility
from solidgear.studies.asked import (
    Question,
    Solved,
    coupled_families,
    family_of,
    few,
    is_frequency,
    mesh_words,
    most_of,
    shapes,
)
from solidgear.studies.effort import foretold
from solidgear.studies.steps import ABOVE, BELOW, BOTH, Step, Value

if TYPE_CHECKING:
    from solidgear.scene import Scene

Progress = Callable[[str], None]

#: couplings by bearings are left out where they move less than this part of the tolerance
COUPLING = 0.01
#: a frequency that rises with a finer mesh of a list, by more than the eigensolver leaves, is
#: rounding: the bar is this many times the rise
RISE = 2.0
#: a bar has one side where the solver has left no more than this share of it
SOLVER_SHARE = 0.01
#: what two meshes must leave of the largest bar at most to go on
FUTILE = 0.7


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

    #: whether a coupling is given in the middle of its bar, and not as the body says it
    middles = True

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
        self.last: Solved | None = None
        self.options: dict[str, Any] = {}
        self.compliances: dict[tuple[str, ...], Condensed] = {}
        self.modes: ModeSet | None = None

    @property
    def body(self) -> Body | None:
        """The last body that was solved."""
        return None if self.last is None else self.last.body

    def run(self) -> None:
        """Climb until every band is within the tolerance, or there is no finer mesh."""
        for level in self._meshes():
            start = time.perf_counter()
            questions = self._questions()
            asked = {q for _, names in questions for q in names}
            part = len(asked) < len(self.wanted)
            only = tuple(q for q in self.wanted if part and q in asked)
            setting = mesh_words(level) + (f", for {few(only)}" if only else "")
            cost = "" if self.rung.unfit(self.scene) else foretold(self.scene, self.rung, level)
            self.progress(f"{self.rung.title}: {setting}{cost}")
            self.last = self._solve(level, questions)
            self.levels.append(self.last.numbers)
            self.sizes.append(self.last.cell)
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
                    unknowns=self.last.unknowns,
                    seconds=spent,
                    only=only,
                    options=self.options,
                )
            )
            if (self.rung.bounded or len(self.levels) == 2) and not self.values():
                self._choose("nothing that was asked for exists in this scene")
                return
            if bar is not None and bar <= self.tol:
                self._choose("")
                return
            if bar is not None and (why := self._in_vain()):
                self._choose(why)
                return
        self._choose(self._stopped())

    def _meshes(self) -> Iterator[Mapping[str, Any]]:
        """All meshes, coarse to fine."""
        if not self.rung.bounded:
            yield from self.plan.levels
            return
        if self.plan.fixed:
            yield from self.plan.levels
            return
        mesh = Meshed(given=self.plan.levels[0])
        yield mesh.options()
        for _ in range(MOST_MESHES - 1):
            assert self.last is not None and self.last.score is not None
            mesh = refined(self.scene, self.last.body, mesh, self.last.score, self.tol)
            self.last.body.kept.clear()  # its factor need not be held beside the next one
            yield mesh.options()

    def _stopped(self) -> str:
        """Why there is no further mesh."""
        if not self.rung.bounded:
            only_one = self.plan.fixed and len(self.plan.levels) == 1
            return (
                "the mesh is that of the file, and nothing finer tells how good it is"
                if only_one
                else "no finer mesh is calibrated"
            )
        return f"{MOST_MESHES} meshes did not do; most of the bar comes from {self.stops_at()}"

    def stops_at(self) -> str:
        """The place that holds most of the bars that are not within the tolerance, in words."""
        assert self.last is not None and self.last.score is not None
        return most_of(self.scene, self.last.body, self.last.score)

    def stop(self, why: str) -> None:
        """End with what there is."""
        self._choose(f"the next mesh could not be solved: {why}")

    def values(self) -> tuple[Value, ...]:
        """What was asked for, each from the finest mesh that was solved for it."""
        out = []
        for name in self._known():
            history = self._history(name)
            finest = history[-1].quantities
            unit, scale = described(name)[2], size(finest, name)
            band = self.bands.get(name)
            given = band.middle if band is not None and self.middles else None
            value = finest[name] if given is None else given
            how = band.method if band else ""
            meshes = 1 if self.rung.bounded else len(history)
            out.append(
                Value(name, value, unit, self.bar(name), meshes, scale, self._side(name), how)
            )
        return tuple(out)

    def _known(self) -> list[str]:
        """What was asked for and is there."""
        return [q for q in self.wanted if q not in self.missing and self._history(q)]

    def _history(self, name: str) -> list[Numbers]:
        """The meshes that a quantity was solved on, coarse to fine."""
        return [level for level in self.levels if name in level.quantities]

    def _side(self, name: str) -> str:
        """Where the exact answer lies.

        Of all admissible displacements the exact ones store the least energy under given motions of
        the ports, and the most under given loads; a Rayleigh quotient is least at the exact mode.
        """
        exact = self.rung.bounded and not self.scene.corners
        if not exact or diagonals(name) or name not in self.bands:
            return BOTH
        # what the solver leaves, and couplings that were left out, may go either way
        if max(self.bands[name].solver, self.left_out) > SOLVER_SHARE * self.bar(name):
            return BOTH
        return ABOVE if described(name)[0] == "compliance" else BELOW

    def _questions(self) -> list[Question]:
        """What the next mesh is solved for."""
        if not self._started():
            families = None if self.groups is None else tuple(f for g in self.groups for f in g)
            return [(families, self.wanted)]
        floors = self.floors()
        open_ = [q for q in self._open() if not floors.get(q, 0.0) > self.tol]
        if self.groups is None:
            return [(None, tuple(open_))]
        by_group = [(g, tuple(q for q in open_ if family_of(q) in g)) for g in self.groups]
        return [(group, names) for group, names in by_group if names]

    def _started(self) -> bool:
        """Whether there is a bar of everything already."""
        return len(self.levels) >= (1 if self.rung.bounded else 2)

    def _open(self) -> list[str]:
        """What is there, and not yet within the tolerance."""
        return [q for q in self._known() if not self.bar(q) <= self.tol]

    def floors(self) -> dict[str, float]:
        """Least bars on the finest mesh: a share of what features change, where the rung has one."""
        safety = self.rung.safety
        if safety is None or not safety.share:
            return {}
        for level in self.levels[len(self._changes) :]:
            self._changes.append(feature_effect(self.scene, safety, level.quantities))
        finest = {name: change for level in self._changes for name, change in level.items()}
        meshes = len(self.plan.levels)
        return {q: safety.least_share(moves_freely(q), meshes) * c for q, c in finest.items()}

    def _in_vain(self) -> str:
        """Why no finer mesh would help, if none would."""
        bars = [step.bar for step in self.steps if step.bar is not None]
        if self.rung.bounded and len(bars) > 3 and bars[-1] > FUTILE * bars[-3]:
            return f"finer meshes no longer help; most of the bar comes from {self.stops_at()}"
        floors, open_ = self.floors(), self._open()
        if not open_ or not all(floors.get(q, 0.0) > self.tol for q in open_):
            return ""
        top = max(open_, key=floors.__getitem__)
        return (
            f"no mesh makes bars of {few(tuple(open_))} as narrow: the {self.rung.title} is sure "
            "of a quantity to a share of what features change of it, here to "
            f"{100 * floors[top]:.2g} % of {top} at best"
        )

    def _solve(self, level: Mapping[str, Any], questions: list[Question]) -> Solved:
        """Solve a mesh for some questions."""
        values: dict[str, float] = {}
        solver: dict[str, float] = {}
        unknowns, cells, body, score = 0, None, None, None
        for families, names in questions:
            body = self._body(level, families)
            if not self.levels and self.groups is None:
                self.groups = self.needed(body)
            found, share = self._numbers(body, families, names)
            values |= found.quantities
            solver |= found.solver
            score = share if score is None or share is None else np.maximum(score, share)
            unknowns, cells = unknowns + body.size, body.mesh.get("representative_size")
        assert body is not None  # there is something to ask for
        return Solved(body, Numbers(values, solver), unknowns, cells, score)

    def _body(self, level: Mapping[str, Any], families: tuple[str, ...] | None) -> Body:
        options = dict(level)
        if families is not None and "families" in self.rung.options:
            options["families"] = families
        return build(self.scene, self.rung.name, **options)

    def needed(self, body: Body) -> list[tuple[str, ...]] | None:
        """Families that the question is about, each with those that bearings couple to it."""
        if len(body.blocks) < len(FAMILIES) or "families" not in self.rung.options:
            return None  # one block holds all motions, or the builder makes all of them at once
        found, self.left_out = coupled_families(self.scene, body, COUPLING * self.tol)
        asked = {family_of(q) for q in self.wanted}
        return [group for group in found if set(group) & asked]

    def _numbers(
        self, body: Body, families: tuple[str, ...] | None, names: tuple[str, ...]
    ) -> tuple[Numbers, np.ndarray | None]:
        """Values of a body, and where its open bars come from."""
        supports = as_supports(self.scene)
        if families is not None:
            supports = supports.on(c for f in families for c in FAMILIES[f])
        kinds = {described(q)[0] for q in names}
        statics: Statics | None = None
        found: ModeSet | None = None
        if kinds & {"compliance", "stiffness"}:
            statics = self._statics(body, supports, names)
            self.compliances[families or tuple(FAMILIES)] = statics.main
        if "frequency" in kinds:
            wanted = [place for q in names if isinstance(place := described(q)[1], str)]
            found = self.modes = searched(
                body,
                supports,
                shapes(families, names),
                wanted,
                spare=self.rung.bounded,
                ovalising=False,
            )
        values = numbers(
            statics.main if statics else None,
            found,
            statics.further if statics else {},
            statics.coupled if statics else None,
        )
        if statics is not None:
            values = Numbers(
                values.quantities | statics.values(),
                {q: statics.main.evidence["residual"] for q in statics.values()} | values.solver,
            )
        if not self.rung.bounded:
            return values, None
        here = self._judged_names(values, names)
        judged = bounded(self.scene, body, supports, statics, found, here, values.solver)
        self.bands |= {q: judged.bands[q] for q in here}
        # no value without its bar
        kept = {q: v for q, v in values.quantities.items() if q in here or not is_frequency(q)}
        values = Numbers(kept, values.solver)
        score = np.zeros(body.geometry.meridian.cells.shape[1])  # type: ignore[union-attr]
        for q in here:
            if not self.bar(q) <= self.tol:
                score = np.maximum(score, self.bar(q) * judged.scores[q])
        return values, score

    def _judged_names(self, found: Numbers, names: tuple[str, ...]) -> list[str]:
        """Numbers that are there and get a bar: those of this question, and all of statics that are
        wanted, for which nothing more is solved.
        """
        static = (q for q in self.wanted if not is_frequency(q))
        return [q for q in dict.fromkeys((*names, *static)) if q in found.quantities]

    def _statics(self, body: Body, supports: Supports, names: tuple[str, ...]) -> Statics:
        """Condensed to the main point, to further ones that are asked for, and between points."""
        if self.rung.bounded:
            flexibility(body, SOLVED)
        main = condense(body, supports, self.scene.port.name)
        points = dict.fromkeys(q.partition(AT)[2] for q in names if AT in q and not points_of(q))
        further = {point: condense(body, supports, point) for point in points}
        pairs = {point for q in names for point in points_of(q) or ()}
        both = tuple(port.name for port in self.scene.ports if port.name in pairs)
        return Statics(main, further, condense(body, supports, both) if pairs else None)

    def judge(self) -> float | None:
        """Bands of what the finest mesh was solved for, and the largest bar of all that was asked."""
        if not self._started():
            return None
        if not self.rung.bounded:
            self.bands |= self.bands_of(self.levels)
        bars = [self.bar(q) for q in self._known()]
        return max(bars, default=None) if self.bands else None

    def bands_of(self, levels: list[Numbers]) -> dict[str, Band]:
        """Bands of the finest of two or more meshes of a list."""
        values = [x.quantities for x in levels], levels[-1].solver
        return sequence_bands(self.scene, self.plan, self.rung, *values, self.sizes)

    def bar(self, name: str) -> float:
        """Relative bar of a quantity; infinite where nothing is known."""
        if name not in self.bands:
            return math.inf
        band = self.bands[name]
        width = band.about_middle if self.middles else band.gci
        return max(width, RISE * self._rise(name)) + self.left_out

    def _rise(self, name: str) -> float:
        """How much a frequency has risen at the last step of a list, beyond what the solver leaves."""
        history = self._history(name)
        if self.rung.bounded or described(name)[0] != "frequency" or len(history) < 2:
            return 0.0
        before, last = history[-2:]
        rise = last.quantities[name] / before.quantities[name] - 1
        allowed = before.solver.get(name, 0.0) + last.solver.get(name, 0.0)
        return max(0.0, rise - allowed)

    def _choose(self, why: str) -> None:
        if self.steps:
            self.steps[-1] = replace(self.steps[-1], why=why, chosen=True)
