"""Study of one model of a scene for a comparison: a solid on as many meshes as its error bars need,
every mesh solved with the ties of the scene and like for like.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Mapping
from collections.abc import Sequence as Listed
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Body, as_supports
from solidgear.core.bounds.harmonic import Later
from solidgear.core.errors import NoBounds, SolidgearError
from solidgear.core.judge.bounded import Bounded, bounded
from solidgear.core.judge.hidden import complete_list, first_above
from solidgear.core.judge.quantities import judged, usual
from solidgear.core.judge.record import LevelRecord
from solidgear.core.judge.reference_check import ReferenceCheck
from solidgear.core.judge.refinement import Progress, Refinement, Solved, refine
from solidgear.core.judge.solution import Solution
from solidgear.core.judge.solving import Answer, Numbers, numbers, with_all_solved
from solidgear.core.judge.tied import (
    Tied,
    modes_of,
    solved_modes,
    solved_ties,
    tied_by,
    tied_statics,
)
from solidgear.core.judge.ties import SCENE, SECTION, attached
from solidgear.core.ladder import build
from solidgear.core.ladder.model import SOLID
from solidgear.core.ladder.registry import LADDER
from solidgear.core.machine.memory import NoRoom
from solidgear.core.machine.meter import Meter
from solidgear.core.machine.processes import give_back
from solidgear.core.models.options import ATTACHMENTS
from solidgear.core.quantity import C_ZZ, FIRST_BENDING, Quantity

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

log = logging.getLogger(__name__)
Keep = Callable[[Solution], None]


def study(
    scene: Scene,
    model: str,
    options: Mapping[str, Any] | None = None,
    *,
    share: float | None = None,
    most: int | None = None,
    evidence: bool = True,
    counted: bool = True,
    progress: Progress = lambda _: None,
    keep: Keep = lambda _: None,
    reference: Solution | None = None,
) -> Solution:
    """Solve one model of a scene, a solid on as many meshes as its error bars need.

    A solid that checks a reference needs no narrow bars of its own: it ends with the first mesh on
    which every judged number is within the tolerance at the far end of the reference's error bar,
    or differs by more than both error bars as on the mesh before, or has a bar within the tolerance.

    Parameters
    ----------
    options : mapping, optional
        Of the builder; where they concern the mesh, that mesh is solved.
    share : float, optional
        Error bars of the judged quantities are wanted below the tolerance of the scene divided by
        this; by default the share of the model, 10 for the harmonic solid, which judges.
    most : int, optional
        Levels to stop at.
    evidence : bool
        Count the modes, unless `counted` is False, and solve the other attachments.
    keep : callable
        Called with the solution so far after every mesh, to be kept after an interrupt.
    reference : Solution, optional
        A solid with error bars within the tolerance, which this model checks.

    Raises
    ------
    SolidgearError
        If the first mesh cannot be solved; later ones that cannot are in ``failed``.
    """
    options, ladder_model = dict(options or {}), LADDER[model]
    count_modes = evidence and counted
    if ladder_model.family != SOLID:
        meter = Meter()
        progress(f"{model}: build, statics, modes")
        tied = tied_statics(scene, model, options, meter)
        ties = solved_ties(scene, tied, model, options, meter, 0 if count_modes else math.inf)
        solution = Solution(model, ties, meter, options=options)
        keep(solution)
    else:
        refinement = Refinement(
            scene,
            ladder_model,
            wanted=usual(scene),
            tol=scene.ask.tolerance / (share or ladder_model.share),
            plan=ladder_model.meshes_of(scene, options),
            middles=False,
            most=most,
        )
        check: ReferenceCheck | None = None
        if reference is not None:
            refinement.wanted, refinement.tol = judged(scene), scene.ask.tolerance
            check = ReferenceCheck(reference, refinement.wanted, refinement.tol)
        solution = TiedSolver(refinement, progress, count_modes, keep, check).study()
    if evidence:
        _add_variants(scene, solution, progress)
    return solution


class TiedSolver:
    """Solves meshes in all ways of tying, a :class:`~solidgear.core.judge.refinement.Solver`."""

    def __init__(
        self,
        refinement: Refinement,
        progress: Progress,
        count_modes: bool,
        keep: Keep,
        check: ReferenceCheck | None = None,
    ):
        self.refinement, self.progress = refinement, progress
        self.count_modes, self.keep = count_modes, keep
        self.check = check  #: of a reference, which is all that this solid is for
        #: options of the first mesh, where its statics alone show that a finer one follows
        self.passed_over: Mapping[str, Any] | None = None
        self.solution: Solution | None = None  #: of the last mesh
        self.meter = Meter()
        self.failed: dict[str, str] = {}  #: part left out -> reason
        self.meshes: list[LevelRecord] = []

    def study(self) -> Solution:
        """Refine, and return the solution of the last mesh that could be solved."""
        refinement, model = self.refinement, self.refinement.model
        fixed = refinement.plan.fixed
        try:
            refine(refinement, self, self.progress, model.name)
        except (SolidgearError, MemoryError) as error:
            if self.solution is None and self.passed_over is not None:
                self.solve(self.passed_over)
            if self.solution is None or fixed:
                raise
            self.failed["finer mesh"] = _reason(error)
        except KeyboardInterrupt:
            if self.solution is None and refinement.steps:
                raise KeyboardInterrupt(self._left_at_statics()) from None
            raise
        assert self.solution is not None
        bar = refinement.largest()
        too_wide = bar is None or bar > refinement.tol
        self.solution.check = self.check is not None and too_wide and not refinement.unmet()
        reason = refinement.steps[-1].why
        if reason and refinement.most is None and not fixed and not refinement.without_bars:
            self.failed["narrower bars"] = reason
        self._finish(self.solution)
        return self.solution

    def next_quantities(self) -> tuple[Quantity, ...]:
        """Return the quantities that the next mesh is solved for: all."""
        return self.refinement.wanted

    def solve(self, options: Mapping[str, Any]) -> Solved:
        """Solve a mesh in all ways of tying."""
        refinement = self.refinement
        before = dict(self.meter.seconds)
        if self.solution is not None:
            self.solution.body.cache.clear()  # its factor need not be held beside the next one
            give_back()
        scene, name = refinement.scene, refinement.model.name
        tied = tied_statics(scene, name, options, self.meter)
        if solved := self._too_coarse(tied):
            self.passed_over = options
            self.meshes.append(_level_of(solved.body, solved.numbers.quantities))
            return solved
        ties = solved_ties(scene, tied, name, options, self.meter, spare=True)
        _book_as_evidence(self.meter, before)
        answer = ties[SCENE]
        solution = Solution(refinement.model.name, ties, self.meter, failed=self.failed)
        solution.levels, solution.options = self.meshes, dict(options)
        give_back()
        with self.meter.stage("band"):
            score = self._judge_mesh(solution)
        self.meshes.append(_level_of(answer.body, answer.quantities))
        self.solution = solution
        self.keep(solution)
        bars = refinement.error_bars
        # no frequency without an error bar
        barred = {q: v for q, v in answer.quantities.items() if q in bars or not q.is_frequency}
        return Solved(
            answer.body,
            Numbers(barred, answer.numbers.solver),
            answer.body.size,
            score,
            {} if self.check is None else self.check.distances(solution),
        )

    def _too_coarse(self, tied: Tied) -> Solved | None:
        """Return what statics alone tell of a first mesh, where they show that a finer one follows: its
        modes need not be solved.
        """
        refinement, check = self.refinement, self.check
        first = self.passed_over is None and self.solution is None
        if not first or not refinement.may_go_on:
            return None
        values = numbers(tied.statics, None)
        if check is not None:
            distances = check.distances_beyond(tied.statics.values())
            if not distances:
                return None
            tied.body.cache.clear()
            give_back()
            return Solved(tied.body, values, tied.body.size, None, distances)
        if not refinement.model.follows:
            return None
        with self.meter.stage("band"):
            score = self._score_of_statics(tied, values)
        return None if score is None else Solved(tied.body, values, tied.body.size, score)

    def _left_at_statics(self) -> str:
        """Return in words what an interrupt leaves of a solid whose first mesh was passed over."""
        refinement, check = self.refinement, self.check
        doubts = {q: refinement.doubt(q) for q in refinement.unmet()}
        name = max(doubts, key=doubts.__getitem__)
        from_what = "off" if check is None else f"from the {LADDER[check.reference.model].title}"
        return (
            f"interrupted; its first mesh, {refinement.steps[0].setting}, was solved for statics "
            f"alone, in which {name} may be {100 * doubts[name]:.2g} % {from_what}"
        )

    def _score_of_statics(self, tied: Tied, values: Numbers) -> np.ndarray | None:
        """Return weights of the cells of a mesh by the error bars of static numbers that are too wide;
        None where none is known to be.
        """
        refinement, names = self.refinement, list(values.quantities)
        try:
            judged = bounded(
                refinement.scene, tied.body, tied.supports, tied.statics, None, names, values.solver
            )
        except (NoBounds, NoRoom):
            return None  # told of the mesh with its modes
        refinement.error_bars = judged.error_bars
        return refinement.score(judged, refinement.wanted)

    def _judge_mesh(self, solution: Solution) -> np.ndarray | None:
        """Add the error bars of a mesh to its solution; return weights of its cells by those that
        are too wide. Where bars of the first mesh find no room, it is shown without them.
        """
        refinement, ties = self.refinement, solution.ties
        unbounded = (NoBounds,) if refinement.levels else (NoBounds, NoRoom)
        try:
            judged = _judged(refinement.scene, ties[SCENE], refinement.wanted, self._later(ties))
        except unbounded as error:
            refinement.leave_without_bars(error)
            self.failed["error bar"] = refinement.without_bars
            return None
        refinement.without_bars = ""
        self.failed.pop("error bar", None)
        solution.error_bars, solution.scores = {SCENE: judged.error_bars}, judged.scores
        refinement.error_bars = judged.error_bars
        return refinement.score(judged, refinement.wanted)

    def _later(self, ties: Mapping[str, Answer]) -> list[Later]:
        """Return the modes of a mesh whose error bars are computed next, should it be the last: those
        with section ties, and the first above the list, which bound what it hides.
        """
        answer, sections = ties[SCENE], ties.get(SECTION)
        later: list[Later] = []
        if sections is not None and sections.body is answer.body:
            later.append((sections.modes, [q for q in answer.quantities if q.is_frequency]))
        if self.count_modes:
            above = [mode.name for mode in first_above(answer.modes) or ()]
            later.append((with_all_solved(answer.modes), above))
        return later

    def _finish(self, solution: Solution) -> None:
        """Add error bars with section ties, and count modes."""
        refinement, scene = self.refinement, self.refinement.scene
        answer, section_answer = solution.ties[SCENE], solution.ties.get(SECTION)
        self.progress(f"{refinement.model.name}: section ties")
        # a mesh may have no error bars
        if section_answer is not None and SCENE in solution.error_bars:
            tied_scene = scene.with_attachment("section")
            with self.meter.stage("band"):
                error_bars = solution.error_bars[SCENE]
                if section_answer is not answer:
                    error_bars = _judged(tied_scene, section_answer, refinement.wanted).error_bars
            solution.error_bars[SECTION] = error_bars
        if self.count_modes:
            assert answer.supports is not None  # of the answer just found
            with self.meter.stage("count"):
                answer.modes = modes_of(scene, answer.body, answer.supports, count=True, spare=True)
                complete = complete_list(scene, answer.body, answer.supports, answer.modes)
                answer.modes = replace(answer.modes, evidence=complete.evidence)


def _reason(error: Exception) -> str:
    return str(error) or "not enough memory"


def _judged(
    scene: Scene, answer: Answer, names: Listed[Quantity], later: Listed[Later] = ()
) -> Bounded:
    """Return error bars of an answer on its mesh, with what those asked for later share with them."""
    existing = [q for q in dict.fromkeys((*names, *answer.quantities)) if q in answer.quantities]
    assert answer.supports is not None  # of the answer just found
    return bounded(
        scene,
        answer.body,
        answer.supports,
        answer.statics,
        answer.modes,
        existing,
        answer.numbers.solver,
        later,
    )


def _level_of(body: Body, values: Mapping[Quantity, float]) -> LevelRecord:
    """Build the record of one mesh of a list, which may be solved for statics alone."""
    order = body.mesh.get("order")
    return LevelRecord(
        dofs=body.size,
        h=None if order else body.mesh.get("representative_size"),
        order=order,
        quantities={name: values[name] for name in (C_ZZ, FIRST_BENDING) if name in values},
        mesh=body.mesh,
    )


def _book_as_evidence(meter: Meter, before: dict[str, float]) -> None:
    """Book the cost of coarser levels as evidence; the price of the answer is that of the last
    level.
    """
    earlier = {stage: before.get(stage, 0.0) for stage in ("build", "statics", "modes", "count")}
    for stage, seconds in earlier.items():
        meter.move(stage, "band", seconds)


def _add_variants(scene: Scene, solution: Solution, progress: Progress) -> None:
    """Solve the scene with each attachment everywhere, a 3D solid only with those in its mesh."""
    attachments = {s.attachment for s in scene.stations}
    unbooked = Meter()
    progress(f"{solution.model}: attachments")
    with solution.meter.stage("attachments"):
        for attachment in ATTACHMENTS:
            try:
                if attachments == {attachment}:
                    solution.variants[attachment] = solution.ties[SCENE]
                elif attachment == "section" and SECTION in solution.ties:
                    solution.variants[attachment] = solution.ties[SECTION]
                elif LADDER[solution.model].section_ties:
                    variant = attached(scene, attachment)
                    body = build(variant, solution.model, **solution.options)
                    tied = tied_by(variant, body, as_supports(variant), None, unbooked)
                    solution.variants[attachment] = solved_modes(variant, tied, unbooked)
                    body.cache.clear()  # its numbers are all that is asked of it
            except SolidgearError as error:
                log.info("%s: attachment %s skipped: %s", solution.model, attachment, error)
