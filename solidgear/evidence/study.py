"""One model of one scene, solved with the ties of the scene and like for like, with the band of a
solid.

The *ties of the scene* are what its bearings and its port say.  *Like for like* means mean motions
of cross-sections at every station: what a beam knows of a solid.  A solid is solved on ever finer
meshes (:mod:`solidgear.fidelity.levels`) until its bands (:mod:`solidgear.evidence.bands`) meet
what is asked for.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Iterable, Mapping
from collections.abc import Sequence as Listed
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.body import Body, as_supports
from solidgear.errors import SolidgearError
from solidgear.evidence.answer import ENOUGH, Answer, Numbers, searched
from solidgear.evidence.bands import Band
from solidgear.evidence.bounded import Bounded, Statics, bounded
from solidgear.evidence.quantities import JUDGED, change, usual
from solidgear.evidence.sequence_bands import sequence_bands
from solidgear.evidence.tied import facts_of, judged_modes, solved_ties, tied_answer
from solidgear.evidence.ties import SCENE, SECTION, rigid_seats
from solidgear.fidelity import build
from solidgear.fidelity.ladder import LADDER
from solidgear.fidelity.levels import HEAVY, LIGHT_JUDGE, Sequence
from solidgear.fidelity.options import ATTACHMENTS
from solidgear.fidelity.refining import MOST_MESHES, Meshed, refined
from solidgear.machine.meter import Meter
from solidgear.solve.modes import ModeSet
from solidgear.solve.statics import Condensed

if TYPE_CHECKING:
    from solidgear.scene import Scene

log = logging.getLogger(__name__)
Progress = Callable[[str], None]


@dataclass
class Solution:
    """One rung of one scene, solved with its evidence.

    Attributes
    ----------
    model : str
        The rung.
    ties : dict of str to Answer
        ``as scene`` and ``section``, as far as they could be solved.
    bands : dict of str to dict of str to Band
        The same keys; empty for a model without a band of its own.
    variants : dict of str to Answer
        The scene with each attachment everywhere: ``average``, ``rigid`` (bearing seats only),
        ``section``.
    levels : list of dict
        Facts about every mesh, coarse to fine.
    failed : dict of str to str
        What was left out, and why.
    """

    model: str
    ties: dict[str, Answer]
    meter: Meter
    bands: dict[str, dict[str, Band]] = field(default_factory=dict)
    variants: dict[str, Answer] = field(default_factory=dict)
    levels: list[dict] = field(default_factory=list)
    failed: dict[str, str] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)

    @property
    def body(self) -> Body:
        """The finest body, tied as in the scene."""
        return self.ties[SCENE].body

    @property
    def condensed(self) -> Condensed:
        """Statics with the ties of the scene."""
        return self.ties[SCENE].condensed

    @property
    def modes(self) -> ModeSet:
        """Modes with the ties of the scene."""
        return self.ties[SCENE].modes

    @property
    def quantities(self) -> dict[str, float]:
        """Compared numbers with the ties of the scene."""
        return self.ties[SCENE].quantities

    def worst_band(self, names: Iterable[str] = JUDGED) -> float | None:
        """Largest band with the ties of the scene over some quantities; None where there is none."""
        own = self.bands.get(SCENE, {})
        return max((own[n].gci for n in names if n in own), default=None)


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
    keep: Callable[[Solution], None] = lambda _: None,
) -> Solution:
    """Solve one model of a scene, a solid on as many meshes as its bands need.

    Parameters
    ----------
    scene : Scene
    model : str
        A fidelity.
    options : mapping, optional
        Builder options; where they speak of the mesh, that mesh and two coarser ones are solved.
    share : float, optional
        Bands of the judged quantities are wanted below the tolerance of the scene divided by this;
        by default what its rung asks for, 20 for the harmonic solid, which judges.
    most : int, optional
        Levels to stop at.
    evidence : bool
        Count the modes, and solve the other attachments.
    counted : bool
        Whether modes are counted as part of it.
    progress : callable
        Told in words what is going on.
    keep : callable
        Given what there is after every mesh, for an interrupt to leave it.

    Raises
    ------
    SolidgearError
        If the first mesh cannot be solved; later ones that cannot are in ``failed``.
    """
    options = dict(options or {})
    meter = Meter()
    own = LADDER[model]
    if own.meshes is None:
        progress(f"{model}: build, statics, modes")
        ties = solved_ties(scene, model, options, meter, 0 if evidence and counted else math.inf)
        rung = Solution(model, ties, meter, options=options)
        keep(rung)
    elif own.bounded:
        rung = _refined(
            scene,
            model,
            own.meshes_of(scene, options),
            meter,
            scene.ask.tolerance / (share or own.share),
            most,
            evidence and counted,
            progress,
            keep,
        )
    else:
        rung = _climbed(
            scene,
            model,
            own.meshes_of(scene, options),
            meter,
            scene.ask.tolerance / (share or own.share),
            most,
            evidence and counted,
            progress,
            keep,
        )
    if evidence:
        _add_variants(scene, rung, progress)
    return rung


def _refined(
    scene: Scene,
    model: str,
    plan: Sequence,
    meter: Meter,
    target: float,
    most: int | None,
    counted: bool,
    progress: Progress,
    keep: Callable[[Solution], None],
) -> Solution:
    """On meshes that follow where the bars come from, or on the one that was asked for."""
    mesh = Meshed(given={} if plan.fixed else plan.levels[0])
    level = plan.levels[-1] if plan.fixed else mesh.options()
    facts: list[dict] = []
    rung: Solution | None = None
    names = usual(scene)
    for k in range(1 if plan.fixed else most or MOST_MESHES):
        progress(f"{model}: mesh {k + 1}")
        before = dict(meter.seconds)
        try:
            ties = solved_ties(scene, model, level, meter, spare=True)
        except (SolidgearError, MemoryError) as error:
            if rung is None:
                raise
            rung.failed["finer mesh"] = str(error) or "not enough memory"
            break
        if rung is not None:
            _book_as_evidence(meter, before)
        facts.append(facts_of(ties[SCENE]))
        failed = rung.failed if rung else {}
        rung = Solution(model, ties, meter, levels=facts, failed=failed, options=dict(level))
        with meter.stage("band"):
            told = _judged(scene, ties[SCENE], names)
        rung.bands = {SCENE: told.bands}
        keep(rung)
        open_ = [q for q in names if q in told.bands and told.bands[q].gci > target]
        if not open_ or k == (0 if plan.fixed else (most or MOST_MESHES) - 1):
            break
        score = np.max([told.bands[q].gci * told.scores[q] for q in open_], axis=0)
        mesh = refined(scene, rung.body, mesh, score, target)
        level = mesh.options()
        rung.body.kept.clear()  # its factor need not be held beside the next one
    assert rung is not None
    _finished(scene, rung, names, counted, progress)
    return rung


def _finished(
    scene: Scene, rung: Solution, names: Listed[str], counted: bool, progress: Progress
) -> None:
    """Bars with section ties, and modes counted."""
    progress(f"{rung.model}: section ties")
    tied = rung.ties.get(SECTION)
    if tied is not None:
        same = tied is rung.ties[SCENE]
        with rung.meter.stage("band"):
            plain = scene.with_attachment("section")
            rung.bands[SECTION] = rung.bands[SCENE] if same else _judged(plain, tied, names).bands
    if counted:
        found = rung.ties[SCENE]
        assert found.supports is not None  # of what was just answered
        with rung.meter.stage("count"):
            found.modes = searched(
                found.body,
                found.supports,
                max(scene.ask.modes, ENOUGH),
                judged_modes(scene),
                max_frequency=scene.ask.max_frequency,
                count=True,
                ovalising=True,
            )


def _judged(scene: Scene, found: Answer, names: Listed[str]) -> Bounded:
    """Bars of an answer by local problems."""
    numbers = found.numbers
    statics = Statics(found.condensed, found.further, found.coupled)
    known = [q for q in dict.fromkeys((*names, *found.quantities)) if q in found.quantities]
    assert found.supports is not None  # of what was just answered
    return bounded(scene, found.body, found.supports, statics, found.modes, known, numbers.solver)


def _climbed(
    scene: Scene,
    model: str,
    plan: Sequence,
    meter: Meter,
    target: float,
    most: int | None,
    counted: bool,
    progress: Progress,
    keep: Callable[[Solution], None],
) -> Solution:
    """The finest of the levels that were needed, or that could be had."""
    levels = plan.levels if plan.fixed else plan.levels[:most]
    rung: Solution | None = None
    solved: list[dict[str, Numbers]] = []
    facts: list[dict] = []
    failed: dict[str, str] = {}
    around: dict[str, dict[str, float]] = {}
    for k, level in enumerate(levels):
        progress(f"{model}: mesh {k + 1}")
        if rung is not None:
            rung.body.kept.clear()  # its factor need not be held beside the next one
        before = dict(meter.seconds)
        last = k == len(levels) - 1 if plan.fixed else k >= 2
        # the second level is counted as well where a third one may be too dear to be solved
        least = 0 if last else HEAVY + 1 if not plan.fixed and k == 1 else math.inf
        try:
            ties = solved_ties(scene, model, level, meter, least if counted else math.inf)
        except (SolidgearError, MemoryError) as error:
            why = str(error) or "not enough memory"
            if plan.fixed and k < len(levels) - 1:
                failed["band"] = why
                continue
            if plan.fixed or rung is None:
                raise
            failed["finer mesh"] = why
            break
        if rung is not None:
            _book_as_evidence(meter, before)
        solved.append({tie: found.numbers for tie, found in ties.items()})
        facts.append(facts_of(ties[SCENE]))
        if plan.turned is not None and not around:
            progress(f"{model}: mesh {k + 1} with more cells around")
            around = _around(scene, model, plan, solved[0], meter)
        rung = Solution(model, ties, meter, levels=facts, failed=failed, options=dict(level))
        rung.bands = _bands(scene, model, plan, solved, facts, around)
        keep(rung)
        worst = rung.worst_band(usual(scene))
        enough = target if k >= 2 else max(target, scene.ask.tolerance / LIGHT_JUDGE)
        if (
            not plan.fixed
            and (k >= 2 or k == 1 and rung.body.size > HEAVY)
            and worst is not None
            and worst <= enough
        ):
            break
    assert rung is not None
    return rung


def _book_as_evidence(meter: Meter, before: dict[str, float]) -> None:
    """What coarser levels cost is evidence; the price of the answer is that of the last level."""
    earlier = {stage: before.get(stage, 0.0) for stage in ("build", "statics", "modes", "count")}
    for stage, seconds in earlier.items():
        meter.move(stage, "band", seconds)


def _around(
    scene: Scene, model: str, plan: Sequence, ties: dict[str, Numbers], meter: Meter
) -> dict[str, dict[str, float]]:
    """Relative error that the cells around leave, per way of tying and quantity."""
    spare = Meter()
    with meter.stage("band"):
        turned = solved_ties(scene, model, plan.turned or {}, spare)
    out = {}
    for tie in set(ties) & set(turned):
        finer = turned[tie].quantities
        changes = {q: change(ties[tie].quantities, finer, q) for q in finer}
        out[tie] = {q: plan.left_around * abs(c) for q, c in changes.items() if c is not None}
    return out


def _bands(
    scene: Scene,
    model: str,
    plan: Sequence,
    solved: list[dict[str, Numbers]],
    facts: list[dict],
    around,
) -> dict[str, dict[str, Band]]:
    """Bands of the finest level for every way of tying that all of the last levels have."""
    out = {}
    for tie in (SCENE, SECTION):
        known = [s for s in solved if tie in s]
        if len(known) < 2 or tie not in solved[-1]:
            continue
        values, solver = [s[tie].quantities for s in known], known[-1][tie].solver
        sizes = [f["mesh"].get("representative_size") for f in facts]
        tied = scene if tie == SCENE else scene.with_attachment("section")
        found = sequence_bands(tied, plan, LADDER[model], values, solver, sizes, around.get(tie))
        if found:
            out[tie] = found
    return out


def _add_variants(scene: Scene, rung: Solution, progress: Progress) -> None:
    """The same scene with each attachment everywhere; a 3D solid only with those its mesh carries."""
    given = {s.attachment for s in scene.stations}
    spare = Meter()
    progress(f"{rung.model}: attachments")
    with rung.meter.stage("attachments"):
        for attachment in ATTACHMENTS:
            try:
                if given == {attachment}:
                    rung.variants[attachment] = rung.ties[SCENE]
                elif attachment == "section" and SECTION in rung.ties:
                    rung.variants[attachment] = rung.ties[SECTION]
                elif LADDER[rung.model].section_ties:
                    changed = (
                        rigid_seats(scene)
                        if attachment == "rigid"
                        else scene.with_attachment(attachment)
                    )
                    body = build(changed, rung.model, **rung.options)
                    rung.variants[attachment] = tied_answer(
                        changed, body, as_supports(changed), None, spare, False
                    )
            except SolidgearError as error:
                log.info("%s: attachment %s left out: %s", rung.model, attachment, error)
