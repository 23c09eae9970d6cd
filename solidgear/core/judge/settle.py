"""The cheapest body that answers a whole question within a tolerance.

:func:`solidgear.core.judge.answer.answer` gives single numbers and builds no more than they need. Here
the body itself is wanted, with all families of motion: for the 6x6 at the lumped point, for a list
of modes, or for a sweep over its bearings.

The error of a compliance matrix of displacement elements is positive semidefinite, and so is that
of a stiffness matrix, from the other side: no entry errs by more than the geometric mean of its two
diagonal entries' errors. Error bars of all six diagonal entries therefore hold all of the matrix.
:data:`~solidgear.core.quantity.QUANTITIES` names one bending plane and axial motion; where bearings
differ between planes, the other one may rest on the mesh far more than the first, so it is measured
as well, and torsion with it (:data:`~solidgear.core.quantity.ACROSS`).
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from solidgear.core.body import Body, as_supports
from solidgear.core.bounds.harmonic import is_beside_many
from solidgear.core.bounds.refining import Meshed
from solidgear.core.errors import NoBounds
from solidgear.core.judge.answer import read_tolerance, solve_cheapest
from solidgear.core.judge.bounded import (
    NOTHING_BEYOND,
    mode_bars,
    static_bars,
    with_all_for_bars,
)
from solidgear.core.judge.quantities import at_points, between
from solidgear.core.judge.question import FamilySolver, Listing, build_families
from solidgear.core.judge.refinement import (
    FINER_FILE,
    INTERRUPTED,
    NO_FINER,
    Interrupted,
    Progress,
    Refinement,
    mesh_words,
    uninterrupted,
)
from solidgear.core.judge.steps import Step
from solidgear.core.ladder import build
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine.memory import NoRoom
from solidgear.core.machine.threads import pinned
from solidgear.core.quantity import COMPLIANCE, FREQUENCY, QUANTITIES, STIFFNESS, Quantity
from solidgear.core.safety import ROOM
from solidgear.core.scene.shaft import without_axis
from solidgear.core.solve.modes import ModeSet, modes

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: questions to a body, and the kinds of quantities by which it is judged
QUESTIONS: dict[str, tuple[str, ...]] = {
    "stiffness": (COMPLIANCE, STIFFNESS),
    "modes": (FREQUENCY,),
    "all": (COMPLIANCE, STIFFNESS, FREQUENCY),
}
#: bars closer than this part of themselves are equal
SAME = 1e-6


@dataclass(frozen=True)
class Settled:
    """A body on the cheapest mesh that answers a question, with error bars."""

    plain_names = (
        ("model", "rung"),
        *("setting", "options", "tolerance", "bars", "reached", "judged_on"),
    )

    scene: str
    tolerance: float
    rung: str
    options: dict[str, Any]  #: of the builder: with these, the model gives the same body again
    body: Body  #: with all families of motion
    #: relative; of couplings, to the geometric mean of their diagonal entries. Infinite where
    #: nothing is known.
    bars: dict[Quantity, float]
    steps: tuple[Step, ...]  #: models and meshes that were passed over and tried
    #: whether every bar is within the tolerance. A scene that nothing holds has a stiffness of
    #: exactly zero, and no bar to meet.
    reached: bool
    missing: tuple[Quantity, ...]  #: those that do not exist for this scene
    judged_on: int = 1  #: number of bearing variants that the error bars are maximal over
    point: str = ""  #: the main lumped point
    mesh: Meshed | None = None  #: of a harmonic solid

    @property
    def setting(self) -> str:
        """The mesh in words."""
        return next(step.setting for step in self.steps if step.chosen)

    @property
    def largest(self) -> tuple[Quantity, float] | None:
        """Quantity with the largest error bar, and the bar; None where nothing is judged."""
        return widest(self.bars)


def _main_point(scene: Scene) -> str:
    """Return the name of the main lumped point; empty without one."""
    return next((port.name for port in scene.ports), "")


def widest(bars: Mapping[Quantity, float]) -> tuple[Quantity, float] | None:
    """Return the quantity with the largest error bar, and the bar; None without any.

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
    only: str = "",
    listing: Listing | None = None,
    progress: Progress = lambda _: None,
) -> Settled:
    """Solve the cheapest body whose error bars of all numbers asked for are within a tolerance;
    after the last mesh that could be solved, where none is.

    Parameters
    ----------
    tol : float or str, optional
        Relative; by default the tolerance of the scene.
    ask : {'all', 'stiffness', 'modes'}
        Compliances and stiffnesses at the lumped point in all six directions, the first frequencies
        of every family, or both.
    points : sequence of str
        Further lumped points at which, and between which, the same is asked.
    before : Settled, optional
        Result for the same shaft with other bearings in the same seats: a harmonic solid is judged
        on that body first, with the data that are kept with it.
    only : str, optional
        The solid to solve; by default the cheapest that holds the scene.
    listing : callable, optional
        Takes a body and supports, and returns the modes whose error bars are asked for next.

    Raises
    ------
    SolidgearError
        For a tolerance that is none or that arithmetic does not allow, or a scene that no model can
        answer.
    """
    tol = read_tolerance(scene.ask.tolerance if tol is None else tol)
    main = () if ask == "modes" else (scene.port.name,)
    if without_axis(scene):
        return _settled_body(scene, tol, ask, (*main, *points), progress)
    wanted = tuple(q for q in QUANTITIES if q.kind in QUESTIONS[ask])
    if points:
        names = {*main, *points}
        crossed = between(wanted, [port.name for port in scene.ports if port.name in names])
        wanted = (*at_points(wanted, points), *crossed)

    def solver_of(refinement: Refinement) -> FamilySolver:
        if before is None or before.rung != refinement.model.name:
            return FamilySolver(refinement, listing=listing)
        if before.mesh is not None:
            refinement.mesh = before.mesh

        def build_body(options: Mapping[str, Any], families: tuple[str, ...] | None) -> Body:
            if dict(options) == before.options:
                return before.body
            return build_families(scene, refinement.model, options, families)

        return FamilySolver(refinement, build_body, listing)

    try:
        solver, steps = solve_cheapest(
            scene, tol, wanted, progress, solver_of, whole=True, only=only
        )
    except Interrupted as stop:
        solver, steps = stop.result
    refinement = solver.refinement
    assert refinement.body is not None  # a model without a single mesh is passed over
    bars = refinement.bars()
    judged = bool(bars) or ask == "stiffness"
    found = Settled(
        scene=scene.name,
        tolerance=tol,
        rung=refinement.model.name,
        options=refinement.options,
        body=refinement.body,
        bars=bars,
        steps=tuple(steps),
        reached=judged and all(bar <= tol for bar in bars.values()),
        missing=tuple(q for q in wanted if q not in bars),
        point=_main_point(scene),
        mesh=refinement.mesh if refinement.model.follows else None,
    )
    return uninterrupted(found, steps)


def bars_of_modes(
    scene: Scene,
    body: Body,
    mode_set: ModeSet,
    settled: Settled | None,
    extended: ModeSet | None = None,
) -> dict[str, float]:
    """Return relative error bars of frequencies of a solid by the names of their modes; those that
    its mesh was chosen by keep the bar it was chosen with. `extended` is the list with all that bars
    rest on, where it is known.
    """
    bars = mode_bars(scene, body, as_supports(scene), mode_set, extended)
    if settled is None or without_axis(scene):
        return bars
    judged = [name for name in map(Quantity, mode_set.names) if name in settled.bars]
    return bars | {name: settled.bars[name] for name in judged}


#: the only model that holds a body without an axis
MODEL = "solid"
#: refinements of the meshes of a block
REFINEMENTS = (0.5, 1.0, 2.0, 4.0)


def _settled_body(
    scene: Scene, tol: float, ask: str, points: tuple[str, ...], progress: Progress
) -> Settled:
    """Settle a body without an axis on the first mesh whose error bars of the lowest modes, and of
    statics at some points, are within a tolerance: of a block on meshes made here, else of its files.
    """
    steps: list[Step] = []
    assert scene.body is not None  # that is without an axis
    block = scene.body.kind == "block"
    files = len(scene.body.coarser)
    meshes = [{"refinement": r} for r in REFINEMENTS]
    if not block:
        meshes = [{"coarser": k} for k in range(files, -1, -1)]
    for mesh in meshes:
        start = time.perf_counter()
        level = {**LADDER[MODEL].given(scene, {}), **mesh}
        progress(f"{LADDER[MODEL].title}: {mesh_words(level)}")
        try:
            body, bars, without_bars, ended = _judged_body(scene, ask, points, level)
        except (NoRoom, MemoryError) as error:
            if not steps:
                raise
            reason = f"the next mesh could not be solved: {error or 'not enough memory'}"
            steps[-1] = replace(steps[-1], why=reason, chosen=True)
            break
        except KeyboardInterrupt:
            if not steps:
                raise
            steps[-1] = replace(steps[-1], why=INTERRUPTED, chosen=True)
            break
        options = level
        largest = max(bars.values(), default=math.inf)
        reached = largest <= tol and not without_bars
        chosen = reached or mesh is meshes[-1] or ended
        reason = ""
        if chosen and not reached:
            reason = without_bars or (NO_FINER if block else FINER_FILE)
        steps.append(
            Step(
                MODEL,
                mesh_words(options),
                valid=True,
                why=reason,
                bar=largest,
                unknowns=body.size,
                seconds=time.perf_counter() - start,
                chosen=chosen,
                options=options,
            )
        )
        if chosen:
            break
    found = Settled(
        scene=scene.name,
        tolerance=tol,
        rung=MODEL,
        options=options,
        body=body,
        bars=bars,
        steps=tuple(steps),
        reached=reached,
        missing=(),
        point=_main_point(scene),
    )
    return uninterrupted(found, steps)


def _judged_body(
    scene: Scene, ask: str, points: tuple[str, ...], options: dict[str, Any]
) -> tuple[Body, dict[Quantity, float], str, bool]:
    """Build the body on one mesh, and return the error bars of the numbers asked for, or the reason
    for none, and whether no finer mesh would have any.
    """
    body, supports = build(scene, MODEL, **options), as_supports(scene)
    bars: dict[Quantity, float] = {}
    try:
        if ask != "modes":
            bars |= static_bars(scene, body, supports, points)
        if ask != "stiffness":
            # with the room that the list of the command `modes` has, which goes on from here
            listed = modes(body, scene, scene.ask.modes, room=ROOM)
            extended = with_all_for_bars(body, supports, listed)
            by_name = mode_bars(scene, body, supports, listed, extended)
            bars |= {Quantity(name): bar for name, bar in by_name.items()}
            elastic = [mode for mode in listed.modes if mode.frequency_hz > 0]
            if elastic and not by_name:
                # finer cells do not part modes that lie side by side
                ended = all(is_beside_many(extended, mode) for mode in elastic)
                return body, bars, NOTHING_BEYOND, ended
    except NoBounds as error:
        return body, {}, str(error), False
    return body, bars, "", False
