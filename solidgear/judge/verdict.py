"""The models to trust, and the cheapest that will do, in words.

A model is judged twice by the reference: as the scene is tied, and like for like with section means
at every station (:mod:`solidgear.judge.deviations`). Without an error bar of the reference there is
no judgement.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.judge.deviations import BEYOND, OPEN, TIES, Deviation, about
from solidgear.judge.quantities import in_words, judged, usual
from solidgear.judge.record import GuardRecord, VerdictRecord
from solidgear.judge.solution import Solution
from solidgear.judge.ties import SCENE, SECTION
from solidgear.ladder.model import BEAM, SOLID
from solidgear.ladder.registry import LADDER
from solidgear.quantity import COMPLIANCE, FIRST_BENDING, Quantity

if TYPE_CHECKING:
    from solidgear.scene import Scene


@dataclass(frozen=True)
class Judgement:
    """Worth of a model: ``valid`` only if nothing speaks against it, ``open`` if that is not
    decided.
    """

    valid: bool
    why_not: str | None = None
    open: bool = False


def trusted(
    solutions: dict[str, Solution], tolerance: float, names: Iterable[Quantity]
) -> tuple[str | None, str]:
    """The model that may judge the others, and why there is none: a solid whose error bars of some
    quantities are inside the tolerance.
    """
    names = tuple(names)
    why = "no solid was run, and a beam cannot judge itself"
    for model in LADDER.of(SOLID):
        if model not in solutions:
            continue
        worst = solutions[model].worst_bar(names)
        if worst is None:
            why = f"the {LADDER[model].title} has no error bar of its own ({_reason(solutions[model])})"
        elif worst > tolerance:
            why = (
                f"the own error of the {LADDER[model].title} may be {percent(worst)}, more than the "
                f"{percent(tolerance)} asked for"
            )
        else:
            return model, ""
    return None, why


def _reason(solution: Solution) -> str:
    return "; ".join(dict.fromkeys(solution.failed.values())) or "it was solved on one mesh only"


def judge(
    scene: Scene,
    solutions: dict[str, Solution],
    gaps: list[Deviation],
    notices: Sequence[GuardRecord] = (),
) -> tuple[VerdictRecord, dict[str, Judgement]]:
    """Validity of every model and the verdict in sentences, from the gaps (:func:`deviations`) to the model
    that :func:`trusted` names or, where there is none, the best there is.
    """
    tolerance = scene.ask.tolerance
    names = judged(scene)
    reference, why = trusted(solutions, tolerance, usual(scene))
    validity = {
        m: _judged(m, solutions, reference, why, gaps, names, tolerance, notices) for m in solutions
    }
    cheapest = next((m for m in LADDER.bodies if m in solutions and validity[m].valid), None)
    sentences = []
    if not solutions:
        sentences = ["No model could be solved."]
    elif reference is None:
        sentences = [f"Not judged: {why}."]
    else:
        sentences = [
            *_trust(solutions, reference, gaps, names),
            *_points(scene, names),
            *_cheapest(solutions, cheapest, tolerance),
            *_beams(solutions, gaps, names, tolerance),
        ]
    verdict = VerdictRecord(
        trust=reference,
        reference=reference,
        cheapest=cheapest,
        tolerance=tolerance,
        judged=list(names),
        sentences=sentences,
    )
    return verdict, validity


def spoken_against(model: str, notices: Iterable[GuardRecord]) -> list[str]:
    """Sentences of the guards that put a model out."""
    return [n.sentence for n in notices if model in n.models and n.level in ("avoid", "fault")]


def _judged(
    model: str,
    solutions: dict[str, Solution],
    reference: str | None,
    why: str,
    gaps: list[Deviation],
    judged: Sequence[Quantity],
    tolerance: float,
    notices: Sequence[GuardRecord],
) -> Judgement:
    against = spoken_against(model, notices)
    if reference is None:
        return Judgement(False, f"not judged: {why}", open=True)
    if against:
        return Judgement(False, against[0])
    solution = solutions[model]
    if LADDER[model].family == SOLID:
        worst = solution.worst_bar(judged)
        if worst is None or worst > tolerance:
            text = (
                "it has no error bar of its own"
                if worst is None
                else f"its own error may be {percent(worst)}"
            )
            return Judgement(
                False,
                f"{text}, and {percent(tolerance)} is asked for ({_reason(solution)})",
                open=True,
            )
    if model == reference:
        return Judgement(True)
    mine = about(gaps, model, judged)
    found = {gap.quantity for gap in mine}
    missing = [q for q in judged if q in solutions[reference].quantities and q not in found]
    if missing:
        return Judgement(
            False,
            f"nothing in it corresponds to {' and '.join(missing)} of the {LADDER[reference].title}",
            open=True,
        )
    worst_first = sorted(mine, key=lambda gap: -(gap.size + (gap.band or 0.0)))
    for kind in (BEYOND, OPEN):
        for gap in worst_first:
            if gap.standing(tolerance) == kind:
                return Judgement(False, _why(gap, solutions, kind, tolerance), open=kind == OPEN)
    return Judgement(True)


def _said(gap: Deviation, solutions: dict[str, Solution]) -> str:
    """The quantity of a gap; with its lumped point where there are several."""
    found = solutions[gap.reference].ties[SCENE].statics
    return in_words(gap.quantity, found.main.port if found.further else "")


def _why(gap: Deviation, solutions: dict[str, Solution], kind: str, tolerance: float) -> str:
    text = (
        f"{_said(gap, solutions)} is {percent(gap.size)} {gap.side} against the "
        f"{LADDER[gap.reference].title} {TIES[gap.attachment]}"
    )
    if gap.pairing:
        text += f" ({gap.pairing})"
    if kind == BEYOND:
        return f"{text}, more than the {percent(tolerance)} asked for"
    return (
        f"{text}, which with an error bar of {percent(gap.band or 0.0)} may or may not be within the "
        f"{percent(tolerance)} asked for"
    )


def percent(x: float) -> str:
    """A share in per cent to two figures, never with an exponent."""
    if 0 < abs(x) < 1e-6:
        return "less than 0.0001 %"
    return f"{100 * x:.2g} %" if abs(x) < 0.995 else f"{100 * x:.0f} %"


def _trust(solutions, reference, gaps, judged) -> list[str]:
    base = solutions[reference]
    own = base.error_bars[SCENE]
    size = []
    c = max((own[q].width for q in judged if q.kind == COMPLIANCE and q in own), default=None)
    f = own[FIRST_BENDING].width if FIRST_BENDING in own else None
    if c is not None:
        size.append(f"{percent(c)} in compliance")
    if f is not None:
        size.append(f"{percent(f)} in first bending")
    told = f": own error {', '.join(size)}" if size else ""
    out = [f"Trust the {LADDER[reference].title}{told}."]
    for model in LADDER.of(SOLID):
        if model in solutions and model != reference:
            same = all("sectors" in solutions[m].body.mesh for m in (model, reference))
            kind = "copies of the same mesh" if same else "another mesh and another formulation"
            out += _other_solid(model, kind, solutions[model], gaps, judged)
    return out


def _other_solid(
    model: str, kind: str, solution: Solution, gaps: list[Deviation], judged: Sequence[Quantity]
) -> list[str]:
    """Distance of a solid that does not judge from the one that does."""
    mine = about(gaps, model, judged, SCENE)
    if not mine:
        return []
    worst = max(gap.size for gap in mine)
    text = f"The {LADDER[model].title}, {kind}, is within {percent(worst)} of it in every judged number"
    # what has no error bar of its own may err by all of a gap
    own = solution.error_bars.get(SCENE, {})
    unknown = [gap.quantity for gap in mine if gap.quantity not in own]
    if len(unknown) == len(mine):
        return [f"{text}; it has no error bars of its own, which would tell whose the gaps are."]
    beyond = [g.quantity for g in mine if g.quantity in own and g.verdict == "resolved"]
    text += f", beyond the error bars in {', '.join(beyond)}" if beyond else ""
    if unknown:
        return [f"{text}; of {', '.join(unknown)} it has no error bar of its own."]
    return [f"{text}{'; all gaps lie inside the error bars (not resolved)' if not beyond else ''}."]


def _points(scene: Scene, names: Sequence[Quantity]) -> list[str]:
    """Those of several lumped points at which models are judged."""
    if not scene.further_ports:
        return []
    of_points = [name for name in names if not name.is_frequency]
    pairs = [name.pair for name in of_points if name.pair]
    asked = {next(iter(q.points), scene.port.name) for q in of_points if not q.pair}
    at = [port.name for port in scene.ports if port.name in asked]
    left = [port.name for port in scene.ports if port.name not in asked]
    told = [f"at {_all_of(at)}"] if at else []
    told += [f"between {a} and {b}" for a, b in dict.fromkeys(pairs)]
    where = f"Compliances are judged {', '.join(told)}" if told else "No compliance is judged"
    return [f"{where}{'; not at ' if left else ''}{_all_of(left)}."]


def _all_of(names: list[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _cheapest(solutions, cheapest, tolerance) -> list[str]:
    if not cheapest:
        return [f"No model is known to be within {percent(tolerance)}."]
    return [
        f"Cheapest model within {percent(tolerance)}: {LADDER[cheapest].title} ({_cost(solutions[cheapest])})."
    ]


def _beams(solutions, gaps, judged, tolerance) -> list[str]:
    """Beams that fail on a seat they do not know, and not on their own theory: the tie, not the
    beam.
    """
    out = []
    for model in LADDER.of(BEAM):
        if model not in solutions:
            continue
        scene, like = (
            max(about(gaps, model, judged, tie), key=lambda gap: gap.size, default=None)
            for tie in (SCENE, SECTION)
        )
        if scene is None or like is None:
            continue
        here, fair = scene.size, like.size
        if here > tolerance >= fair:
            out.append(
                f"What puts the {LADDER[model].title} out is the tie, not the beam: "
                f"{_said(scene, solutions)} is {percent(here)} off at the scene's seats, which "
                f"distort sections, and nothing is more than {percent(fair)} off like for like."
            )
        elif here <= tolerance < fair:
            out.append(
                f"The {LADDER[model].title} looks within {percent(here)} at the scene's seats but "
                f"is {percent(fair)} off in {_said(like, solutions)} like for like: "
                "seat flexibility, which a beam has not, hides part of its excess stiffness."
            )
    return out


def _cost(solution: Solution) -> str:
    # The price of an answer is building and solving it; bars and variants are evidence on top.
    seconds = sum(solution.meter.seconds.get(k, 0.0) for k in ("build", "statics", "modes"))
    return f"{solution.body.size} unknowns, {seconds:.2g} s"
