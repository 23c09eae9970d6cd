"""One solid on ever finer meshes, until the error bars of some numbers are within a tolerance.

:func:`refine` is the loop, :class:`Refinement` the meshes that it has solved and the numbers and
error bars that they give. A :class:`Solver` says for which numbers the next mesh is solved, and
solves it: for single numbers or a whole body (:mod:`solidgear.core.judge.question`), or in all ways of
tying (:mod:`solidgear.core.judge.study`).

Every mesh gives its error bars by itself (:mod:`solidgear.core.judge.bounded`).  The meshes of a
harmonic solid follow them (:mod:`solidgear.core.bounds.refining`), those of 3D solids are listed, and
the list is left where the bars allow.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import numpy as np

from solidgear.core.body import Body
from solidgear.core.bounds.refining import MOST_MESHES, Meshed, refined
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.bounded import Bounded
from solidgear.core.judge.effort import HEAVY, cost_text
from solidgear.core.judge.quantities import in_order, size
from solidgear.core.judge.solving import Numbers
from solidgear.core.judge.steps import ABOVE, BELOW, BOTH, Step, Value
from solidgear.core.ladder.meshes import Sequence as Plan
from solidgear.core.ladder.model import Model
from solidgear.core.machine.memory import listening
from solidgear.core.meshing.quality import MeshError
from solidgear.core.quantity import COMPLIANCE, FREQUENCY, Quantity

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

Progress = Callable[[str], None]
R = TypeVar("R")
#: reasons for no narrower one
NO_FINER = "there is no finer mesh in the list"
FINER_FILE = "list a finer mesh beside those of the file"
INTERRUPTED = "interrupted on a finer mesh"


class Interrupted(KeyboardInterrupt):
    """Ctrl-C after a mesh was solved: a command shows its result, whatever else solves ends."""

    def __init__(self, result: Any):
        super().__init__()
        self.result = result


def uninterrupted(result: R, steps: Sequence[Step]) -> R:
    """Return the result of some steps; raise it where the last of them was cut off by Ctrl-C."""
    if steps[-1].why == INTERRUPTED:
        raise Interrupted(result)
    return result


#: a bar has one side where the solver has left no more than this share of it
SOLVER_SHARE = 0.01
#: ratio of the largest bar to that two meshes before, above which finer meshes do not help
FUTILE = 0.7
#: reported options of a mesh, and the words for them
SETTINGS = {
    "order": "order",
    "layers": "layers",
    "around": "cells around",
    "refinement": "refinement",
    "cuts": "cuts",
}
#: error bars of one mesh of a list over those of the next, where layers are added or cells shrink by
#: half an edge: what an edge leaves falls by no more
FALL = 3.0
#: quantities up to this number are listed by name
FEW = 3


@dataclass(frozen=True)
class Solved:
    """Solution of one mesh."""

    body: Body  #: the last one that was built on it
    numbers: Numbers
    unknowns: int  #: of all bodies
    #: (ne,) weights of the cells of a meridian by the error bars that exceed the tolerance
    score: np.ndarray | None = None
    #: largest distance that numbers may have from a reference, relative; zero where a difference is
    #: shown. Numbers that are not compared with one are missing.
    distances: Mapping[Quantity, float] = field(default_factory=dict)


class Solver(Protocol):
    """Solves the meshes of a refinement, with error bars, for the numbers of a question."""

    def next_quantities(self) -> tuple[Quantity, ...]:
        """Return the quantities that the next mesh is solved for."""

    def solve(self, options: Mapping[str, Any]) -> Solved:
        """Solve a mesh."""


@dataclass(eq=False)
class Refinement:
    """Meshes of one solid that were solved, coarse to fine, with the numbers that they give."""

    scene: Scene
    model: Model  #: a solid
    wanted: tuple[Quantity, ...]  #: quantities whose error bars are wanted
    tol: float  #: relative
    plan: Plan  #: meshes to be solved; of a harmonic solid the first, unless the mesh was set
    #: whether the body itself is wanted: all static numbers of it are judged, those of the other
    #: plane and of torsion included
    whole: bool = False
    #: whether a coupling is given in the middle of the error bar, and not as the body says it
    middles: bool = True
    most: int | None = None  #: largest number of meshes
    levels: list[Numbers] = field(default_factory=list)  #: of every mesh
    steps: list[Step] = field(default_factory=list)
    #: of every quantity, on the finest mesh that was solved for it
    error_bars: dict[Quantity, ErrorBar] = field(default_factory=dict)
    missing: set[Quantity] = field(default_factory=set)  #: do not exist in this scene
    options: dict[str, Any] = field(default_factory=dict)  #: of the last mesh
    last: Solved | None = None
    without_bars: str = ""  #: why the last mesh has none
    finer_helps: bool = False  #: whether a finer mesh may have some nevertheless
    no_room: bool = False  #: whether cells where most of the error bar comes from cannot be smaller
    #: bound on the change by couplings of families that were left out, relative
    left_out: float = 0.0
    mesh: Meshed = field(init=False)  #: of a harmonic solid, the first mesh and later the last

    def __post_init__(self):
        self.mesh = Meshed(fixed=self.plan.levels[0])

    @property
    def of_files(self) -> bool:
        """Whether the meshes are those of files."""
        return self.scene.body is not None and self.scene.body.one_mesh

    @property
    def may_go_on(self) -> bool:
        """Whether a finer mesh can follow the first."""
        several = self.model.follows or len(self.plan.levels) > 1
        return several and not self.plan.fixed and self.most != 1

    @property
    def body(self) -> Body | None:
        """The last body that was solved."""
        return None if self.last is None else self.last.body

    def add(self, solved: Solved, options: Mapping[str, Any], requested: set[Quantity]) -> None:
        """Add the solution of a mesh, solved for some quantities."""
        self.last = solved
        self.levels.append(solved.numbers)
        self.options = dict(options)
        self.missing = (self.missing | requested) - set(solved.numbers.quantities)

    def leave_without_bars(self, error: Exception) -> None:
        """Take the reason for no error bars on the last mesh."""
        self.without_bars = str(error)
        self.finer_helps = getattr(error, "finer_helps", False)

    def end(self, reason: str) -> None:
        """Take the last mesh, for a reason."""
        if self.steps:
            self.steps[-1] = replace(self.steps[-1], why=reason, chosen=True)

    def existing(self) -> list[Quantity]:
        """Return the quantities to be judged that exist."""
        wanted = [q for q in self.wanted if q not in self.missing and self._history(q)]
        if not self.whole:
            return wanted
        return [*wanted, *sorted(self._with_static() - set(self.wanted))]

    def _with_static(self) -> set[Quantity]:
        """Return the quantities wanted, and all static ones of the same kinds that were solved."""
        kinds = {q.kind for q in self.wanted} - {FREQUENCY}
        solved = (q for level in self.levels for q in level.quantities)
        return set(self.wanted) | {q for q in solved if q.kind in kinds and not q.repeats}

    def _history(self, name: Quantity) -> list[Numbers]:
        """Return the meshes that a quantity was solved on, coarse to fine."""
        return [level for level in self.levels if name in level.quantities]

    def unmet(self) -> list[Quantity]:
        """Return the quantities that exist and are not yet within the tolerance."""
        return [q for q in self.existing() if not self.doubt(q) <= self.tol]

    def doubt(self, name: Quantity) -> float:
        """Return the error bar of a quantity, or the distance from a reference where that is less."""
        distances = {} if self.last is None else self.last.distances
        return min(self.bar(name), distances.get(name, math.inf))

    def largest(self) -> float | None:
        """Return the largest error bar of all quantities to be judged; None without any."""
        bars = [self.bar(q) for q in self.existing()]
        return max(bars, default=None) if self.error_bars else None

    def bar(self, name: Quantity) -> float:
        """Return the relative error bar of a quantity; infinite where nothing is known."""
        if name not in self.error_bars:
            return math.inf
        bar = self.error_bars[name]
        width = bar.about_middle if self.middles else bar.width
        return width + self.left_out

    def bars(self) -> dict[Quantity, float]:
        """Return relative error bars of a whole body, those of the other plane and of torsion
        included.
        """
        names = [q for q in in_order(self.levels[-1].quantities) if q in self._with_static()]
        return {q: self.bar(q) for q in names}

    def so_far(self) -> str:
        """Return the first number wanted and the one with the largest error bar, in words."""
        values = self.values()
        if not any(map(math.isfinite, (v.bar for v in values))):
            return "no error bar"
        shown = dict.fromkeys((values[0], max(values, key=lambda v: v.bar)))
        return ", ".join(
            f"{v.quantity} {v.value:.4g} {v.unit} +- {100 * v.bar:.2g} %" for v in shown
        )

    def values(self) -> tuple[Value, ...]:
        """Return the numbers wanted, each from the finest mesh that was solved for it."""
        return tuple(self._value(name) for name in self.existing())

    def _value(self, name: Quantity) -> Value:
        history = self._history(name)
        finest = history[-1].quantities
        error_bar = self.error_bars.get(name)
        value, method = finest[name], ""
        if error_bar is not None:
            method = error_bar.method
            if error_bar.middle is not None and self.middles:
                value = error_bar.middle
        return Value(
            name,
            value,
            name.unit,
            self.bar(name),
            size(finest, name),
            self._side(name),
            method,
        )

    def _side(self, name: Quantity) -> str:
        """Return the side on which the exact answer lies.

        Of all admissible displacements the exact ones store the least energy under given motions of
        the ports, and the most under given loads; a Rayleigh quotient is least at the exact mode.
        """
        exact = self.model.follows and not self.scene.outline.corners
        if not exact or name.diagonals or name not in self.error_bars:
            return BOTH
        # errors of the solver, of geometry, and of couplings that were left out, may go either way
        bar = self.error_bars[name]
        if max(bar.solver, bar.geometry, self.left_out) > SOLVER_SHARE * self.bar(name):
            return BOTH
        return ABOVE if name.kind == COMPLIANCE else BELOW

    def score(self, judged: Bounded, names: Iterable[Quantity]) -> np.ndarray | None:
        """Return weights of the cells of a meridian by the error bars that exceed the tolerance, if
        any do.
        """
        wide = [q for q in names if q in judged.scores and not self.bar(q) <= self.tol]
        if not wide:
            return None
        return np.max([self.bar(q) * judged.scores[q] for q in wide], axis=0)

    def worst_place(self) -> str:
        """Return the place that holds most of the error bars that exceed the tolerance, in words."""
        # start-up: where the tolerance is not reached
        from solidgear.core.judge.cell_places import place_of_most

        assert self.last is not None and self.last.score is not None
        return place_of_most(self.scene, self.last.body, self.last.score)

    def no_further_mesh(self) -> str:
        """Return the reason why there is no further mesh."""
        if self.without_bars:
            return self.without_bars
        if not self.model.follows:
            reason = FINER_FILE if self.of_files else NO_FINER
            if self.last is None or self.last.score is None:
                return reason
            return f"{reason}; most of the error bar comes from {self.worst_place()}"
        place = f"most of the error bar comes from {self.worst_place()}"
        if self.no_room:
            return f"{place}, where cells cannot be smaller"
        count = len(self.levels)
        tried = "one mesh was" if count == 1 else f"{count} meshes were"
        return f"{tried} too coarse; {place}"

    def in_vain(self) -> str:
        """Return the reason why no finer mesh would help; empty if one may."""
        if self.without_bars and not self.finer_helps:
            return self.without_bars
        bars = [step.bar for step in self.steps if step.bar is not None]
        if self.model.follows and len(bars) > 3 and bars[-1] > FUTILE * bars[-3]:
            return f"finer meshes no longer help; most of the error bar comes from {self.worst_place()}"
        return ""


def refine(refinement: Refinement, solver: Solver, progress: Progress, label: str) -> None:
    """Solve finer and finer meshes until every error bar is within the tolerance or its number has
    been compared with a reference, or no finer mesh would help, or there is none; `progress` gets
    sentences on every mesh and its numbers that begin with `label`. Of a list, the first mesh is the
    coarsest that can be made; MeshError where none can.
    """

    def announce(unknowns: int, mb: float) -> None:
        if unknowns >= HEAVY:
            progress(f"{label}: {cost_text(unknowns, mb)}")

    wanted, failed = refinement.wanted, None
    for options in _meshes(refinement):
        start = time.perf_counter()
        requested = set(solver.next_quantities())
        only: tuple[Quantity, ...] = ()
        if len(requested) < len(wanted):
            only = tuple(q for q in wanted if q in requested)
        setting = mesh_words(options) + (f", for {few(only)}" if only else "")
        progress(f"{label}: {setting}")
        try:
            with listening(announce):
                solved = solver.solve(options)
        except MeshError as error:
            # elements that are large beside a small face fold, which smaller ones need not
            if refinement.levels or refinement.model.follows:
                raise
            failed = failed or error
            continue
        refinement.add(solved, options, requested)
        bar = refinement.largest()
        refinement.steps.append(
            Step(
                refinement.model.name,
                setting,
                valid=True,
                bar=bar,
                unknowns=solved.unknowns,
                seconds=time.perf_counter() - start,
                only=only,
                options=refinement.options,
            )
        )
        if not refinement.existing():
            refinement.end("nothing that was asked for exists in this scene")
            return
        if not refinement.unmet():
            refinement.end("")
            return
        if reason := refinement.in_vain():
            refinement.end(reason)
            return
        progress(f"{label}: so far {refinement.so_far()}")
    if failed is not None and not refinement.levels:
        raise failed
    refinement.end(refinement.no_further_mesh())


def _meshes(refinement: Refinement) -> Iterator[Mapping[str, Any]]:
    """Yield the options of all meshes, coarse to fine; those of a harmonic solid follow the score of
    the mesh before.
    """
    plan, most = refinement.plan, refinement.most
    if plan.fixed:
        yield from plan.levels
        return
    if not refinement.model.follows:
        yield from _listed(refinement, plan.levels[:most])
        return
    yield refinement.mesh.options()
    for _ in range((most or MOST_MESHES) - 1):
        last = refinement.last
        assert last is not None and last.score is not None
        finer = refined(refinement.scene, last.body, refinement.mesh, last.score, refinement.tol)
        if finer is None:
            refinement.no_room = True
            return
        refinement.mesh = finer
        last.body.cache.clear()  # its factor need not be held beside the next one
        yield refinement.mesh.options()


def _listed(
    refinement: Refinement, levels: Sequence[Mapping[str, Any]]
) -> Iterator[Mapping[str, Any]]:
    """Yield meshes of a list, without those that can be seen to be too coarse; until one could be made,
    those that add nothing to the cells of the first.
    """
    place, failed = 0, None
    while place < len(levels):
        level = levels[place]
        if not refinement.levels:
            level = {name: level[name] for name in levels[0]}
            if level == failed:
                place += 1
                continue
            failed = level
        yield level
        too_wide = max(map(refinement.doubt, refinement.unmet()), default=0.0) / refinement.tol
        jump = math.log(too_wide) / math.log(FALL) if 1 < too_wide < math.inf else 1.0
        place = max(place + 1, min(place + math.floor(jump), len(levels) - 1))


def mesh_words(options: Mapping[str, Any]) -> str:
    """Return the options of a mesh in a few words."""
    out = []
    for name, word in SETTINGS.items():
        if name == "layers" and "cuts" in options:
            continue
        if name == "cuts" and name in options:
            cuts, lines = sum(c for *_, c in options[name]), len(options.get("across", ()))
            if cuts:
                out.append(f"{cuts} cut{'s' if cuts > 1 else ''} at corners")
            if lines:
                out.append(f"{lines} line{'s' if lines > 1 else ''}")
        elif name in options:
            out.append(f"{word} {options[name]}")
    if "coarser" in options:
        back = options["coarser"]
        out.append(f"mesh file {back} before the last" if back else "the last mesh file")
    return ", ".join(out)


def few(names: Sequence[str]) -> str:
    """Return some names, or how many there are."""
    return ", ".join(names) if len(names) <= FEW else f"{len(names)} numbers"
