"""One solid on ever finer meshes, until the bars of what is asked are within a tolerance.

The meshes of a harmonic solid follow its bars (:mod:`solidgear.bounds.refining`), which every mesh
tells by itself (:mod:`solidgear.judge.bounded`); of other solids two of a list make a bar. What a
mesh is solved for, and how, is up to those who want to know: single numbers
(:mod:`solidgear.judge.climb`), a whole body (:mod:`solidgear.judge.settle`) or all ways of tying
(:mod:`solidgear.judge.study`).
"""

from __future__ import annotations

import math
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.body import Body
from solidgear.bounds.refining import MOST_MESHES, Meshed, refined
from solidgear.errors import SolidgearError
from solidgear.judge.bars import ErrorBar, moves_freely, same_size
from solidgear.judge.bounded import Bounded
from solidgear.judge.effort import HEAVY, cost_text
from solidgear.judge.quantities import Values, size
from solidgear.judge.question import Solved, few, mesh_words, most_of
from solidgear.judge.sequence_bars import feature_effect, sequence_bars
from solidgear.judge.solving import Numbers
from solidgear.judge.steps import ABOVE, BELOW, BOTH, Step, Value
from solidgear.ladder.model import Model
from solidgear.machine.memory import listening
from solidgear.quantity import COMPLIANCE, Quantity

if TYPE_CHECKING:
    from solidgear.scene import Scene

Progress = Callable[[str], None]
#: reason for no bar
ONE_MESH = "the mesh is that of the file, and nothing finer tells how good it is"
#: reasons for no narrower one
NO_FINER = "no finer mesh is calibrated"
FINER_FILE = "list a finer mesh beside those of the file"

#: a frequency that rises with a finer mesh of a list, by more than the eigensolver leaves, is
#: rounding: the bar is this many times the rise
RISE = 2.0
#: a bar has one side where the solver has left no more than this share of it
SOLVER_SHARE = 0.01
#: what two meshes must leave of the largest bar at most to go on
FUTILE = 0.7


class Loop(ABC):
    """One solid on ever finer meshes.

    Parameters
    ----------
    model : Model
        A solid.
    wanted : tuple of Quantity
        Those whose bars are wanted.
    tol : float
        Relative.
    progress : callable
        Told of every mesh.
    options : mapping, optional
        Of the builder; where they speak of the mesh, that mesh is solved, and of a list coarser ones.
    most : int, optional
        Meshes at most.

    Attributes
    ----------
    levels : list of Numbers
        Of every mesh, coarse to fine: what was solved for on it.
    error_bars : dict of Quantity to ErrorBar
        Of every quantity, on the finest mesh that was solved for it.
    """

    #: whether a coupling is given in the middle of its bar, and not as the body says it
    middles = True
    #: what couplings of families that were left out may move at most, relative
    left_out = 0.0

    def __init__(
        self,
        scene: Scene,
        model: Model,
        wanted: tuple[Quantity, ...],
        tol: float,
        progress: Progress,
        options: Mapping[str, Any] | None = None,
        most: int | None = None,
    ):
        self.scene, self.model, self.wanted, self.tol = scene, model, wanted, tol
        self.progress = progress
        self.plan = model.meshes_of(scene, options or {})
        self.most = most
        #: of a harmonic solid, the one it begins with, and later the last one
        self.mesh = Meshed(fixed=self.plan.levels[0])
        self.levels: list[Numbers] = []
        self.sizes: list[tuple[float, ...]] = []
        self.steps: list[Step] = []
        self.error_bars: dict[Quantity, ErrorBar] = {}
        self.missing: set[Quantity] = set()
        self._changes: list[Values] = []
        self.last: Solved | None = None
        self.options: dict[str, Any] = {}

    @abstractmethod
    def _solve(self, level: Mapping[str, Any]) -> Solved:
        """Solve a mesh; of a harmonic solid with its error bars."""

    def _spared(self, level: Mapping[str, Any], error: Exception) -> bool:
        """Tell whether the loop goes on without a mesh that could not be solved."""
        return False

    def _asked(self) -> tuple[Quantity, ...]:
        """Quantities that the next mesh is solved for."""
        return self.wanted

    @property
    def called(self) -> str:
        """Name of what is solved, as it is told."""
        return self.model.title

    @property
    def of_files(self) -> bool:
        """True where the meshes are those of files."""
        return self.scene.body is not None and self.scene.body.one_mesh

    @property
    def body(self) -> Body | None:
        """The last body that was solved."""
        return None if self.last is None else self.last.body

    def run(self) -> None:
        """Climb until every error bar is within the tolerance, or there is no finer mesh."""
        for level in self._meshes():
            start = time.perf_counter()
            asked = set(self._asked())
            part = len(asked) < len(self.wanted)
            only = tuple(q for q in self.wanted if part and q in asked)
            setting = mesh_words(level) + (f", for {few(only)}" if only else "")
            self.progress(f"{self.called}: {setting}")
            try:
                with listening(self._tell):
                    self.last = self._solve(level)
            except (SolidgearError, MemoryError) as error:
                if not self._spared(level, error):
                    raise
                continue
            self.levels.append(self.last.numbers)
            self.sizes.append(self.last.cells)
            self.options = dict(level)
            self.missing = (self.missing | asked) - set(self.levels[-1].quantities)
            bar = self.judge()
            spent = time.perf_counter() - start
            self.steps.append(
                Step(
                    self.model.name,
                    setting,
                    valid=True,
                    bar=bar,
                    unknowns=self.last.unknowns,
                    seconds=spent,
                    only=only,
                    options=self.options,
                )
            )
            if (self.model.bounded or len(self.levels) == 2) and not self.values():
                self._choose("nothing that was asked for exists in this scene")
                return
            if bar is not None and bar <= self.tol:
                self._choose("")
                return
            if bar is not None and (why := self._in_vain()):
                self._choose(why)
                return
        self._choose(self._stopped())

    def _tell(self, unknowns: int, mb: float) -> None:
        """Tell what a heavy factor will cost, before it is made."""
        if unknowns >= HEAVY:
            self.progress(f"{self.called}: {cost_text(unknowns, mb)}")

    def _meshes(self) -> Iterator[Mapping[str, Any]]:
        """All meshes, coarse to fine."""
        if not self.model.bounded or self.plan.fixed:
            yield from self.plan.levels if self.plan.fixed else self.plan.levels[: self.most]
            return
        yield self.mesh.options()
        for _ in range((self.most or MOST_MESHES) - 1):
            assert self.last is not None and self.last.score is not None
            self.mesh = refined(self.scene, self.last.body, self.mesh, self.last.score, self.tol)
            self.last.body.cache.clear()  # its factor need not be held beside the next one
            yield self.mesh.options()

    def _stopped(self) -> str:
        """Reason for no further mesh."""
        if not self.model.bounded:
            if not self.of_files or not self.sizes:
                return NO_FINER
            if len(self.plan.levels) == 1:
                return ONE_MESH
            return FINER_FILE if self.error_bars else same_size(*self.sizes[-2:])
        count = len(self.levels)
        tried = "one mesh" if count == 1 else f"{count} meshes"
        return f"{tried} did not do; most of the bar comes from {self.stops_at()}"

    def stops_at(self) -> str:
        """The place that holds most of the bars that are not within the tolerance, in words."""
        assert self.last is not None and self.last.score is not None
        return most_of(self.scene, self.last.body, self.last.score)

    def stop(self, why: str) -> None:
        """End with what there is."""
        self._choose(f"the next mesh could not be solved: {why}")

    def values(self) -> tuple[Value, ...]:
        """Numbers asked for, each from the finest mesh that was solved for it."""
        out = []
        for name in self._known():
            history = self._history(name)
            finest = history[-1].quantities
            unit, scale = name.unit, size(finest, name)
            bar = self.error_bars.get(name)
            given = bar.middle if bar is not None and self.middles else None
            value = finest[name] if given is None else given
            how = bar.method if bar else ""
            meshes = 1 if self.model.bounded else len(history)
            out.append(
                Value(name, value, unit, self.bar(name), meshes, scale, self._side(name), how)
            )
        return tuple(out)

    def _known(self) -> list[Quantity]:
        """Quantities asked for that are there."""
        return [q for q in self.wanted if q not in self.missing and self._history(q)]

    def _history(self, name: Quantity) -> list[Numbers]:
        """The meshes that a quantity was solved on, coarse to fine."""
        return [level for level in self.levels if name in level.quantities]

    def _side(self, name: Quantity) -> str:
        """Side on which the exact answer lies.

        Of all admissible displacements the exact ones store the least energy under given motions of
        the ports, and the most under given loads; a Rayleigh quotient is least at the exact mode.
        """
        exact = self.model.bounded and not self.scene.outline.corners
        if not exact or name.diagonals or name not in self.error_bars:
            return BOTH
        # what the solver leaves, and couplings that were left out, may go either way
        if max(self.error_bars[name].solver, self.left_out) > SOLVER_SHARE * self.bar(name):
            return BOTH
        return ABOVE if name.kind == COMPLIANCE else BELOW

    def _started(self) -> bool:
        """Tell whether there is a bar of everything already."""
        return len(self.levels) >= (1 if self.model.bounded else 2)

    def _open(self) -> list[Quantity]:
        """Quantities that are there, and not yet within the tolerance."""
        return [q for q in self._known() if not self.bar(q) <= self.tol]

    def floors(self) -> dict[Quantity, float]:
        """Least bars on the finest mesh: a share of what features change, where the model has one."""
        safety = self.model.safety
        if safety is None or not safety.share:
            return {}
        for level in self.levels[len(self._changes) :]:
            self._changes.append(feature_effect(self.scene, safety, level.quantities))
        finest = {name: change for level in self._changes for name, change in level.items()}
        meshes = len(self.plan.levels)
        return {q: safety.least_share(moves_freely(q), meshes) * c for q, c in finest.items()}

    def _in_vain(self) -> str:
        """Reason for which no finer mesh would help, if none would."""
        bars = [step.bar for step in self.steps if step.bar is not None]
        if self.model.bounded and len(bars) > 3 and bars[-1] > FUTILE * bars[-3]:
            return f"finer meshes no longer help; most of the bar comes from {self.stops_at()}"
        floors, open_ = self.floors(), self._open()
        if not open_ or not all(floors.get(q, 0.0) > self.tol for q in open_):
            return ""
        top = max(open_, key=floors.__getitem__)
        return (
            f"no mesh makes bars of {few(open_)} as narrow: the {self.model.title} is sure "
            "of a quantity to a share of what features change of it, here to "
            f"{100 * floors[top]:.2g} % of {top} at best"
        )

    def score(self, judged: Bounded, names: Iterable[Quantity]) -> np.ndarray | None:
        """Weights of the cells of a meridian by the bars beyond the tolerance, if any."""
        open_ = [q for q in names if q in judged.scores and not self.bar(q) <= self.tol]
        if not open_:
            return None
        return np.max([self.bar(q) * judged.scores[q] for q in open_], axis=0)

    def judge(self) -> float | None:
        """Error bars of what the finest mesh was solved for; the largest of all that was asked."""
        if not self._started():
            return None
        if not self.model.bounded:
            values, solver = [x.quantities for x in self.levels], self.levels[-1].solver
            shape = self.last.body.mesh.get("straightened", 0.0) if self.last else 0.0
            self.error_bars |= sequence_bars(
                self.scene, self.plan, self.model, values, solver, self.sizes, shape=shape
            )
        bars = [self.bar(q) for q in self._known()]
        return max(bars, default=None) if self.error_bars else None

    def bar(self, name: Quantity) -> float:
        """Relative bar of a quantity; infinite where nothing is known."""
        if name not in self.error_bars:
            return math.inf
        bar = self.error_bars[name]
        width = bar.about_middle if self.middles else bar.width
        return max(width, RISE * self._rise(name)) + self.left_out

    def _rise(self, name: Quantity) -> float:
        """Rise of a frequency at the last step of a list, beyond what the solver leaves."""
        history = self._history(name)
        if self.model.bounded or not name.is_frequency or len(history) < 2:
            return 0.0
        before, last = history[-2:]
        rise = last.quantities[name] / before.quantities[name] - 1
        allowed = before.solver.get(name, 0.0) + last.solver.get(name, 0.0)
        return max(0.0, rise - allowed)

    def _choose(self, why: str) -> None:
        if self.steps:
            self.steps[-1] = replace(self.steps[-1], why=why, chosen=True)
