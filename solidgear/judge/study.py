"""Study of one model of a scene for a comparison, a solid on as many meshes as its error bars
need.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Mapping
from collections.abc import Sequence as Listed
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from solidgear.body import as_supports
from solidgear.errors import SolidgearError
from solidgear.judge.bars import ErrorBar, sizes_of
from solidgear.judge.bounded import Bounded, bounded
from solidgear.judge.hidden import complete_list
from solidgear.judge.quantities import change, usual
from solidgear.judge.question import Solved, mesh_words
from solidgear.judge.record import LevelRecord
from solidgear.judge.refinement import Loop, Progress
from solidgear.judge.sequence_bars import sequence_bars
from solidgear.judge.solution import Solution
from solidgear.judge.solving import ENOUGH, Answer, Numbers, searched
from solidgear.judge.tied import judged_modes, level_of, solved_ties, tied_answer
from solidgear.judge.ties import SCENE, SECTION, attached
from solidgear.ladder import build
from solidgear.ladder.meshes import HEAVY
from solidgear.ladder.model import SOLID
from solidgear.ladder.registry import LADDER
from solidgear.machine.meter import Meter
from solidgear.models.options import ATTACHMENTS
from solidgear.quantity import Quantity

if TYPE_CHECKING:
    from solidgear.scene import Scene

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
) -> Solution:
    """Solve one model of a scene, a solid on as many meshes as its error bars need.

    Parameters
    ----------
    options : mapping, optional
        Of the builder; where they speak of the mesh, that mesh is solved, and of a solid on a list of
        meshes two coarser ones.
    share : float, optional
        Error bars of the judged quantities are wanted below the tolerance of the scene divided by
        this; by default what its model asks for, 10 for the harmonic solid, which judges.
    most : int, optional
        Levels to stop at.
    evidence : bool
        Count the modes, and solve the other attachments.
    counted : bool
        Whether modes are counted as part of it.
    keep : callable
        Given what there is after every mesh, for an interrupt to leave it.

    Raises
    ------
    SolidgearError
        If the first mesh cannot be solved; later ones that cannot are in ``failed``.
    """
    options, own = dict(options or {}), LADDER[model]
    if own.family != SOLID:
        meter = Meter()
        progress(f"{model}: build, statics, modes")
        ties = solved_ties(scene, model, options, meter, 0 if evidence and counted else math.inf)
        solution = Solution(model, ties, meter, options=options)
        keep(solution)
    else:
        tol = scene.ask.tolerance / (share or own.share)
        loop = Tied(scene, own, usual(scene), tol, progress, options, most)
        loop.counted, loop.keep = evidence and counted, keep
        solution = loop.studied()
    if evidence:
        _add_variants(scene, solution, progress)
    return solution


class Tied(Loop):
    """A loop on which every mesh is solved with the ties of the scene and like for like.

    Attributes
    ----------
    counted : bool
        Whether modes are counted on the last mesh.
    keep : callable
        Given what there is after every mesh.
    """

    middles = False
    counted = False
    solution: Solution | None = None  #: of the last mesh

    def __init__(self, *args: Any):
        super().__init__(*args)
        self.keep: Keep = lambda _: None
        self.meter = Meter()
        self.failed: dict[str, str] = {}
        self.solved: list[dict[str, Numbers]] = []
        self.meshes: list[LevelRecord] = []
        self.around: dict[str, dict[Quantity, float]] = {}

    @property
    def called(self) -> str:
        return self.model.name

    def studied(self) -> Solution:
        """Solution of the last mesh that could be solved."""
        try:
            self.run()
        except (SolidgearError, MemoryError) as error:
            if self.solution is None or self.plan.fixed:
                raise
            self.failed["finer mesh"] = str(error) or "not enough memory"
        assert self.solution is not None
        if self.model.bounded:
            if why := self.steps[-1].why * (self.most is None and not self.plan.fixed):
                self.failed["narrower bars"] = why
            self._finish(self.solution)
        elif self.of_files and len(self.sizes) > 1 and not self.error_bars:
            self.failed["error bar"] = self._stopped()
        return self.solution

    def _solve(self, level: Mapping[str, Any]) -> Solved:
        k, before = len(self.levels), dict(self.meter.seconds)
        if self.solution is not None:
            self.solution.body.cache.clear()  # its factor need not be held beside the next one
        counted_from = self._counted_from(k)
        ties = solved_ties(
            self.scene, self.model.name, level, self.meter, counted_from, self.model.bounded
        )
        if self.solution is not None:
            _book_as_evidence(self.meter, before)
        found = ties[SCENE]
        self.solved.append({tie: one.numbers for tie, one in ties.items()})
        self.meshes.append(level_of(found))
        self.solution = solution = Solution(self.model.name, ties, self.meter)
        solution.levels, solution.failed, solution.options = self.meshes, self.failed, dict(level)
        score = None
        with self.meter.stage("band"):
            if self.model.bounded:
                told = _judged(self.scene, found, self.wanted, ties.get(SECTION))
                solution.error_bars, solution.scores = {SCENE: told.error_bars}, told.scores
                self.error_bars = told.error_bars
                score = self.score(told, self.wanted)
            else:
                self._turn()
                solution.error_bars = self._error_bars()
        self.keep(solution)
        return Solved(found.body, found.numbers, found.body.size, sizes_of(found.body.mesh), score)

    def _counted_from(self, k: int) -> float:
        """Unknowns from which on modes of a mesh of a list are counted."""
        if not self.counted or self.model.bounded:
            return math.inf
        if self.plan.fixed:
            return 0 if k == len(self.plan.levels) - 1 else math.inf
        if k >= 2:
            return 0
        # the second level is counted as well where a third one may be too dear to be solved
        return HEAVY + 1 if k == 1 else math.inf

    def judge(self) -> float | None:
        if not self.model.bounded:
            assert self.solution is not None
            self.error_bars = self.solution.error_bars.get(SCENE, {})
        bars = [bar.width for name, bar in self.error_bars.items() if name in self.wanted]
        return max(bars, default=None) if self._enough() else None

    def _enough(self) -> bool:
        """Tell whether there are meshes enough for bars to end the loop: of a list three, or two
        large ones.
        """
        k = len(self.levels)
        if self.model.bounded or self.plan.fixed:
            return self.model.bounded or k == len(self.plan.levels)
        return k > 2 or k == 2 and self.last is not None and self.last.unknowns > HEAVY

    def _spared(self, level: Mapping[str, Any], error: Exception) -> bool:
        coarser = self.plan.fixed and level is not self.plan.levels[-1]
        if coarser:
            self.failed["error bar"] = str(error) or "not enough memory"
        return coarser

    def _turn(self) -> None:
        """Measure what the cells around leave, on the first mesh."""
        turned = self.plan.turned
        if turned is None or self.around:
            return
        self.progress(f"{self.called}: {mesh_words(turned)}")
        ties = solved_ties(self.scene, self.model.name, turned, Meter())
        for tie in set(self.solved[0]) & set(ties):
            finer = ties[tie].quantities
            changes = {q: change(self.solved[0][tie].quantities, finer, q) for q in finer}
            left = self.plan.left_around
            self.around[tie] = {q: left * abs(c) for q, c in changes.items() if c is not None}

    def _error_bars(self) -> dict[str, dict[Quantity, ErrorBar]]:
        """Error bars of the finest mesh of a list by way of tying, of those the last ones have."""
        out = {}
        for tie in (SCENE, SECTION):
            known = [s for s in self.solved if tie in s]
            if len(known) < 2 or tie not in self.solved[-1]:
                continue
            values, solver = [s[tie].quantities for s in known], known[-1][tie].solver
            sizes = [sizes_of(level.mesh) for level in self.meshes]
            tied = self.scene if tie == SCENE else self.scene.with_attachment("section")
            around = self.around.get(tie)
            shape = self.meshes[-1].mesh.get("straightened", 0.0)
            found = sequence_bars(tied, self.plan, self.model, values, solver, sizes, around, shape)
            if found:
                out[tie] = found
        return out

    def _finish(self, solution: Solution) -> None:
        """Bars with section ties, and modes counted."""
        scene, found, tied = self.scene, solution.ties[SCENE], solution.ties.get(SECTION)
        self.progress(f"{self.called}: section ties")
        if tied is not None:
            plain = scene.with_attachment("section")
            with self.meter.stage("band"):
                own = (
                    solution.error_bars[SCENE]
                    if tied is found
                    else _judged(plain, tied, self.wanted).error_bars
                )
            solution.error_bars[SECTION] = own
        if self.counted:
            assert found.supports is not None  # of what was just answered
            with self.meter.stage("count"):
                found.modes = searched(
                    found.body,
                    found.supports,
                    max(scene.ask.modes, ENOUGH),
                    judged_modes(scene),
                    max_frequency=scene.ask.max_frequency,
                    count=True,
                    ovalising=True,
                )
                whole = complete_list(scene, found.body, found.supports, found.modes)
                found.modes = replace(found.modes, evidence=whole.evidence)


def _judged(
    scene: Scene, found: Answer, names: Listed[Quantity], later: Answer | None = None
) -> Bounded:
    """Bars of an answer by local problems, and of the modes of another one of the same body what they
    have in common.
    """
    known = [q for q in dict.fromkeys((*names, *found.quantities)) if q in found.quantities]
    assert found.supports is not None  # of what was just answered
    left = found.numbers.solver
    others = later.modes if later is not None and later.body is found.body else None
    return bounded(
        scene, found.body, found.supports, found.statics, found.modes, known, left, others
    )


def _book_as_evidence(meter: Meter, before: dict[str, float]) -> None:
    """Book the cost of coarser levels as evidence; the price of the answer is that of the last
    level.
    """
    earlier = {stage: before.get(stage, 0.0) for stage in ("build", "statics", "modes", "count")}
    for stage, seconds in earlier.items():
        meter.move(stage, "band", seconds)


def _add_variants(scene: Scene, solution: Solution, progress: Progress) -> None:
    """The same scene with each attachment everywhere; a 3D solid only with those its mesh carries."""
    given = {s.attachment for s in scene.stations}
    spare = Meter()
    progress(f"{solution.model}: attachments")
    with solution.meter.stage("attachments"):
        for attachment in ATTACHMENTS:
            try:
                if given == {attachment}:
                    solution.variants[attachment] = solution.ties[SCENE]
                elif attachment == "section" and SECTION in solution.ties:
                    solution.variants[attachment] = solution.ties[SECTION]
                elif LADDER[solution.model].section_ties:
                    changed = attached(scene, attachment)
                    body = build(changed, solution.model, **solution.options)
                    solution.variants[attachment] = tied_answer(
                        changed, body, as_supports(changed), None, spare, False
                    )
            except SolidgearError as error:
                log.info("%s: attachment %s left out: %s", solution.model, attachment, error)
