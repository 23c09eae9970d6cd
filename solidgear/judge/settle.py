"""The cheapest body that answers a whole question within a tolerance.

:func:`solidgear.judge.answer.answer` gives single numbers and builds no more than they need.
Here the body itself is wanted, with all families of motion: for the 6x6 at the lumped point, for a
list of modes, or for a sweep over its bearings.

The error of a compliance matrix of displacement elements is positive semidefinite, and so is that
of a stiffness matrix, from the other side: no entry errs by more than the geometric mean of its two
diagonal entries' errors.  Error bars of all six diagonal entries therefore hold all of the matrix.
:data:`~solidgear.quantity.QUANTITIES` names one bending plane and axial motion; where
bearings differ between planes, the other one may rest on the mesh far more than the first, so it is
measured as well, and torsion with it (:data:`~solidgear.quantity.ACROSS`).
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from solidgear.body import Body, as_supports
from solidgear.bounds.refining import Meshed
from solidgear.errors import SolidgearError
from solidgear.judge.answer import climbed, usable
from solidgear.judge.bounded import mode_bars
from solidgear.judge.climb import Climb
from solidgear.judge.coarser_mesh import coarser_bars, no_bar, static_bars
from solidgear.judge.quantities import at_points, between, in_order
from solidgear.judge.question import Question, mesh_words
from solidgear.judge.refinement import FINER_FILE, NO_FINER, Progress
from solidgear.judge.solving import Numbers
from solidgear.judge.steps import Step
from solidgear.ladder import build
from solidgear.ladder.registry import LADDER
from solidgear.machine.memory import NoRoom
from solidgear.machine.threads import pinned
from solidgear.quantity import COMPLIANCE, FREQUENCY, QUANTITIES, STIFFNESS, Quantity
from solidgear.scene.shaft import without_axis
from solidgear.solve.modes import ModeSet, modes

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: what may be asked of a body, and the kinds of quantities by which it is judged
QUESTIONS: dict[str, tuple[str, ...]] = {
    "stiffness": (COMPLIANCE, STIFFNESS),
    "modes": (FREQUENCY,),
    "all": (COMPLIANCE, STIFFNESS, FREQUENCY),
}
#: bars closer than this part of themselves are equal
SAME = 1e-6


@dataclass(frozen=True)
class Settled:
    """A body, and how sure it is of what was asked."""

    scene: str
    tolerance: float
    rung: str
    options: dict[str, Any]  #: of the builder: with these, the model gives the same body again
    body: Body  #: with all families of motion
    #: relative; of couplings, to the geometric mean of their diagonal entries. Infinite where
    #: nothing is known.
    bars: dict[Quantity, float]
    steps: tuple[Step, ...]  #: what was passed over and tried
    #: whether every bar is within the tolerance. A scene that nothing holds has a stiffness of
    #: exactly zero, and no bar to meet.
    reached: bool
    missing: tuple[Quantity, ...]  #: those that do not exist for this scene
    judged_on: int = 1  #: bearing sets that the bars were taken over
    point: str = ""  #: the main lumped point
    mesh: Meshed | None = None  #: of a harmonic solid

    @property
    def setting(self) -> str:
        """The mesh in words."""
        return next(step.setting for step in self.steps if step.chosen)

    @property
    def largest(self) -> tuple[Quantity, float] | None:
        """The quantity with the largest bar, and the bar; None where nothing is judged."""
        return widest(self.bars)

    def as_dict(self) -> dict[str, Any]:
        """Plain data, without the body."""
        return {
            "rung": self.rung,
            "setting": self.setting,
            "options": self.options,
            "tolerance": self.tolerance,
            "bars": {q: bar if math.isfinite(bar) else None for q, bar in self.bars.items()},
            "reached": self.reached,
            "judged_on": self.judged_on,
        }


def widest(bars: Mapping[Quantity, float]) -> tuple[Quantity, float] | None:
    """The quantity with the largest bar, and the bar; None without any.

    Twins of the two planes have equal bars but for rounding: the first listed is named.
    """
    if not bars:
        return None
    top = max(bars.values())
    return next((q, bar) for q, bar in bars.items() if bar >= top * (1 - SAME))


@pinned
def settle(
    scene: Scene,
    tol: float | str | None = None,
    ask: str = "all",
    *,
    points: Sequence[str] = (),
    before: Settled | None = None,
    progress: Progress = lambda _: None,
) -> Settled:
    """The cheapest body whose error bars of all that is asked are within a tolerance; after the last mesh
    that could be solved, where none is.

    Parameters
    ----------
    tol : float or str, optional
        Relative; by default the tolerance of the scene.
    ask : {'all', 'stiffness', 'modes'}
        Compliances and stiffnesses at the lumped point in all six directions, the first frequencies
        of every family, or both.
    points : sequence of str
        Further lumped points at which the same is asked, and between which.
    before : Settled, optional
        What the same shaft was settled on with other bearings in the same seats: a harmonic solid is
        judged on that body first, with what was already worked out for it.

    Raises
    ------
    SolidgearError
        For a tolerance that is none or that arithmetic does not allow, or a scene that no model can
        answer.
    """
    tol = usable(scene.ask.tolerance if tol is None else tol)
    if without_axis(scene):
        if ask != "modes" and scene.port.patch is None:
            raise SolidgearError(
                f"{scene.name} names no lumped point to be stiff at: give it a [[port]] with a patch, "
                "or ask for modes"
            )
        return _settled_body(scene, tol, ask, (scene.port.name, *points), progress)
    wanted = tuple(q for q in QUANTITIES if q.kind in QUESTIONS[ask])
    if points:
        both = {scene.port.name, *points}
        crossed = between(wanted, [port.name for port in scene.ports if port.name in both])
        wanted = (*at_points(wanted, points), *crossed)
    climb, steps = climbed(scene, tol, wanted, partial(Whole, before=before), progress)
    assert climb.body is not None  # a model without a single mesh is passed over
    bars = climb.bars()
    judged = bool(bars) or ask == "stiffness"
    return Settled(
        scene.name,
        tol,
        climb.model.name,
        climb.options,
        climb.body,
        bars,
        tuple(steps),
        judged and all(bar <= tol for bar in bars.values()),
        tuple(q for q in wanted if q not in bars),
        point=scene.port.name,
        mesh=climb.mesh if climb.model.bounded else None,
    )


def bars_of_modes(
    scene: Scene, body: Body, found: ModeSet, settled: Settled | None
) -> dict[str, float]:
    """Relative bars of frequencies by the names of their modes: of a harmonic solid of all, of
    others of those that were judged, and none of a mesh that was set, which may be as large as one
    likes.
    """
    if settled is None:
        return {}
    if without_axis(scene):
        return coarser_bars(scene, body, found, settled.options)
    bars: dict[str, float] = {}
    if LADDER[body.fidelity].bounded:
        bars = mode_bars(scene, body, as_supports(scene), found)
    # what the mesh was chosen by keeps the bar it was chosen with
    asked = [name for name in map(Quantity, found.names) if name in settled.bars]
    return bars | {name: settled.bars[name] for name in asked}


#: the only model that holds a body without an axis
MODEL = "solid"
#: refinements of the nested meshes of a block, each of which tells the next one's bar
NESTED = (0.5, 1.0, 2.0, 4.0)


def _settled_body(
    scene: Scene, tol: float, ask: str, points: tuple[str, ...], progress: Progress
) -> Settled:
    """A body without an axis on the first of its meshes whose bars of the lowest modes, and of what
    is static at some points, are within a tolerance: of a block on nested ones, else on the last one
    of its files.
    """
    steps: list[Step] = []
    assert scene.body is not None  # that is without an axis
    block = scene.body.kind == "block"
    meshes = [{"refinement": r} for r in NESTED[1:]] if block else [{"coarser": 0}]
    for mesh in meshes:
        start = time.perf_counter()
        level = {**LADDER[MODEL].given(scene, {}), **mesh}
        progress(f"{LADDER[MODEL].title}: {mesh_words(level)}")
        try:
            body, bars = _judged_body(scene, ask, points, level)
        except (NoRoom, MemoryError) as error:
            if not steps:
                raise
            why = f"the next mesh could not be solved: {error or 'not enough memory'}"
            steps[-1] = replace(steps[-1], why=why, chosen=True)
            break
        options = level
        largest = max(bars.values(), default=math.inf)
        reached = largest <= tol
        done = reached or mesh is meshes[-1]
        why = ""
        if done and not reached:
            why = NO_FINER if block else FINER_FILE if bars else no_bar(scene, body, options)
        spent = time.perf_counter() - start
        steps.append(
            Step(
                MODEL,
                mesh_words(options),
                True,
                why,
                largest,
                body.size,
                spent,
                chosen=done,
                options=options,
            )
        )
        if done:
            break
    point = scene.port.name
    return Settled(
        scene.name, tol, MODEL, options, body, bars, tuple(steps), reached, (), point=point
    )


def _judged_body(
    scene: Scene, ask: str, points: tuple[str, ...], options: dict[str, Any]
) -> tuple[Body, dict[Quantity, float]]:
    """The body on one mesh, and the bars of what is asked."""
    body = build(scene, MODEL, **options)
    bars = static_bars(scene, body, points, options) if ask != "modes" else {}
    if ask != "stiffness":
        found = modes(body, scene, scene.ask.modes)
        told = coarser_bars(scene, body, found, options)
        bars |= {Quantity(name): bar for name, bar in told.items()}
    return body, bars


class Whole(Climb):
    """A climb on which every mesh carries all families, judged in all six directions.

    Parameters
    ----------
    before : Settled, optional
        Of the same shaft, on whose mesh and body it begins.
    """

    #: the body is given, with its own couplings
    middles = False

    def __init__(self, *args: Any, before: Settled | None = None):
        super().__init__(*args)
        self.before = before if before and before.rung == self.model.name else None
        if self.before and self.before.mesh is not None:
            self.mesh = self.before.mesh

    def _body(self, level: Mapping[str, Any], families: tuple[str, ...] | None) -> Body:
        if self.before and dict(level) == self.before.options:
            return self.before.body
        return super()._body(level, families)

    def bars(self) -> dict[Quantity, float]:
        """Relative bars, those of the other plane and of torsion included."""
        names = [q for q in in_order(self.levels[-1].quantities) if q in self._wanted_here()]
        return {q: self.bar(q) for q in names}

    def _wanted_here(self) -> set[Quantity]:
        """Quantities asked for, and all static ones that come with them."""
        static = {q.kind for q in self.wanted} - {FREQUENCY}
        every = (q for level in self.levels for q in level.quantities)
        return set(self.wanted) | {q for q in every if q.kind in static and not q.repeats}

    def _known(self) -> list[Quantity]:
        known = super()._known()
        return [*known, *sorted(self._wanted_here() - set(self.wanted))]

    def _open(self) -> list[Quantity]:
        # the body is wanted, and one number that no mesh makes sure enough is enough to refuse it
        floors, open_ = self.floors(), super()._open()
        return [q for q in open_ if floors.get(q, 0.0) > self.tol] or open_

    def needed(self, body: Body) -> None:
        return None

    def _questions(self) -> list[Question]:
        return [(None, self.wanted)]

    def _judged_names(self, found: Numbers, names: tuple[Quantity, ...]) -> list[Quantity]:
        static = {q.kind for q in names} - {FREQUENCY}
        return [q for q in found.quantities if q in names or q.kind in static and not q.repeats]
