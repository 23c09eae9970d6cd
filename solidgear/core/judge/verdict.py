"""Verdict in words: the models to trust, and the cheapest that will do.

A model is judged twice by the reference: as the scene is tied, and like for like with section means
at every station (:mod:`solidgear.core.judge.deviations`). Without an error bar of the reference there is
no judgement.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.core.judge.deviations import BEYOND, OPEN, TIES, WITHIN, Deviation, select_gaps
from solidgear.core.judge.quantities import in_words, judged, usual
from solidgear.core.judge.record import GuardRecord, VerdictRecord
from solidgear.core.judge.solution import Solution
from solidgear.core.judge.ties import SCENE, SECTION
from solidgear.core.ladder.model import BEAM, SOLID
from solidgear.core.ladder.registry import LADDER
from solidgear.core.quantity import COMPLIANCE, FIRST_BENDING, Quantity

if TYPE_CHECKING:
    from solidgear.core.scene import Scene


@dataclass(frozen=True)
class Judgement:
    """Worth of a model: ``valid`` only if nothing speaks against it, ``open`` if that is undecided."""

    valid: bool
    why_not: str | None = None
    open: bool = False


def trusted(
    solutions: dict[str, Solution], tolerance: float, names: Iterable[Quantity]
) -> tuple[str | None, str]:
    """Return the model that may judge the others, a solid whose error bars of some quantities are
    inside the tolerance, or None and the reason why there is none.
    """
    names = tuple(names)
    reason = "no solid was run, and a beam has no error bar"
    for model in LADDER.of(SOLID):
        if model not in solutions:
            continue
        worst = solutions[model].worst_bar(names)
        if worst is None:
            reason = f"the {LADDER[model].title} has no error bar ({_reason(solutions[model])})"
        elif worst > tolerance:
            reason = (
                f"the {LADDER[model].title} itself may be {percent(worst)} off, more than the "
                f"{percent(tolerance)} asked for"
            )
        else:
            return model, ""
    return None, reason


def _reason(solution: Solution) -> str:
    return "; ".join(dict.fromkeys(solution.failed.values())) or "none of its numbers is bounded"


def judge(
    scene: Scene,
    solutions: dict[str, Solution],
    gaps: list[Deviation],
    notices: Sequence[GuardRecord] = (),
) -> tuple[VerdictRecord, dict[str, Judgement]]:
    """Judge every model and write the verdict in sentences, from the gaps (:func:`deviations`) to
    the model that :func:`trusted` names or, where there is none, the best there is.
    """
    tolerance = scene.ask.tolerance
    names = judged(scene)
    reference, reason = trusted(solutions, tolerance, usual(scene))
    validity = {
        m: _judged(m, solutions, reference, reason, gaps, names, tolerance, notices)
        for m in solutions
    }
    cheapest = next((m for m in LADDER.bodies if m in solutions and validity[m].valid), None)
    sentences = []
    if not solutions:
        sentences = ["No model could be solved."]
    elif reference is None:
        sentences = [f"Not judged: {reason}."]
    else:
        sentences = [
            *_trust(solutions, reference, gaps, names, tolerance),
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


def objections(model: str, notices: Iterable[GuardRecord]) -> list[str]:
    """Return the sentences of the guards that put a model out."""
    return [n.sentence for n in notices if model in n.models and n.level in ("avoid", "fault")]


def _judged(
    model: str,
    solutions: dict[str, Solution],
    reference: str | None,
    reason: str,
    gaps: list[Deviation],
    judged: Sequence[Quantity],
    tolerance: float,
    notices: Sequence[GuardRecord],
) -> Judgement:
    against = objections(model, notices)
    if reference is None:
        return Judgement(False, f"not judged: {reason}", open=True)
    if against:
        return Judgement(False, against[0])
    if model == reference:
        return _judged_by_itself(solutions[model], judged, tolerance)
    model_gaps = select_gaps(gaps, model, judged)
    paired = {gap.quantity for gap in model_gaps}
    missing = [q for q in judged if q in solutions[reference].quantities and q not in paired]
    if missing:
        return Judgement(
            False,
            f"nothing in it corresponds to {' and '.join(missing)} of the {LADDER[reference].title}",
            open=True,
        )
    worst_first = sorted(model_gaps, key=lambda gap: -(gap.size + (gap.bar or 0.0)))
    for kind in (BEYOND, OPEN):
        for gap in worst_first:
            if gap.standing(tolerance) == kind:
                return Judgement(
                    False, _gap_reason(gap, solutions, kind, tolerance), open=kind == OPEN
                )
    return Judgement(True)


def _judged_by_itself(
    solution: Solution, judged: Sequence[Quantity], tolerance: float
) -> Judgement:
    """Judge the reference by its error bars; what is asked for may be more than it was chosen by."""
    worst = solution.worst_bar(judged)
    if worst is not None and worst <= tolerance:
        return Judgement(True)
    text = "it has no error bar" if worst is None else f"its own error may be {percent(worst)}"
    reason = f"{text}, and {percent(tolerance)} is asked for ({_reason(solution)})"
    return Judgement(False, reason, open=True)


def _quantity_text(gap: Deviation, solutions: dict[str, Solution]) -> str:
    """Return the quantity of a gap in words, with the lumped point where there are several."""
    statics = solutions[gap.reference].ties[SCENE].statics
    return in_words(gap.quantity, statics.main.port if statics.further else "")


def _gap_reason(gap: Deviation, solutions: dict[str, Solution], kind: str, tolerance: float) -> str:
    text = (
        f"{_quantity_text(gap, solutions)} is {percent(gap.size)} {gap.side} against the "
        f"{LADDER[gap.reference].title}{TIES[gap.attachment]}"
    )
    if gap.pairing:
        text += f" ({gap.pairing})"
    if kind == BEYOND:
        return f"{text}, more than the {percent(tolerance)} asked for"
    return (
        f"{text}, and with an error bar of {percent(gap.reference_bar)} may or may not be within "
        f"the {percent(tolerance)} asked for"
    )


def percent(x: float) -> str:
    """Return a share in per cent to two figures, never with an exponent."""
    if 0 < abs(x) < 1e-6:
        return "less than 0.0001 %"
    return f"{100 * x:.2g} %" if abs(x) < 0.995 else f"{100 * x:.0f} %"


def _trust(solutions, reference, gaps, judged, tolerance) -> list[str]:
    base = solutions[reference]
    error_bars = base.error_bars[SCENE]
    size = []
    c = max(
        (error_bars[q].width for q in judged if q.kind == COMPLIANCE and q in error_bars),
        default=None,
    )
    f = error_bars[FIRST_BENDING].width if FIRST_BENDING in error_bars else None
    if c is not None:
        size.append(f"{percent(c)} in compliance")
    if f is not None:
        size.append(f"{percent(f)} in first bending")
    errors = f": own error {', '.join(size)}" if size else ""
    out = [f"Trust the {LADDER[reference].title}{errors}."]
    for model in LADDER.of(SOLID):
        if model in solutions and model != reference:
            same_mesh = all("sectors" in solutions[m].body.mesh for m in (model, reference))
            kind = (
                "copies of the same mesh" if same_mesh else "another mesh and another formulation"
            )
            out += _other_solid(model, kind, solutions[model], gaps, judged)
            out += _check(model, solutions[model], base, gaps, judged, tolerance)
    return out


def _other_solid(
    model: str, kind: str, solution: Solution, gaps: list[Deviation], judged: Sequence[Quantity]
) -> list[str]:
    """Compare a solid that does not judge with the one that does."""
    model_gaps = select_gaps(gaps, model, judged, SCENE)
    if not model_gaps:
        return []
    worst = max(gap.size for gap in model_gaps)
    text = (
        f"The {LADDER[model].title}, {kind}, is within {percent(worst)} of it in every judged "
        "number"
    )
    # a number without an error bar of its own may err by all of a gap
    error_bars = solution.error_bars.get(SCENE, {})
    unknown = [gap.quantity for gap in model_gaps if gap.quantity not in error_bars]
    if len(unknown) == len(model_gaps):
        return [f"{text}; it has no error bars, so it is not known which of both is off."]
    outside = [
        g.quantity for g in model_gaps if g.quantity in error_bars and g.verdict == "resolved"
    ]
    text += f", beyond the error bars in {', '.join(outside)}" if outside else ""
    if unknown:
        return [f"{text}; it has no error bar for {', '.join(unknown)}."]
    return [
        f"{text}{'; all differences lie inside the error bars (not resolved)' if not outside else ''}."
    ]


def _check(
    model: str,
    solution: Solution,
    base: Solution,
    gaps: list[Deviation],
    judged: Sequence[Quantity],
    tolerance: float,
) -> list[str]:
    """Say where the meshes of a solid ended that only checks the one that judges."""
    if not solution.check:
        return []
    within = f"within {percent(tolerance)} of the {LADDER[base.model].title}"
    model_gaps = select_gaps(gaps, model, judged, SCENE)
    if all(gap.standing(tolerance) == WITHIN for gap in model_gaps):
        end = f"whose numbers are {within}"
    else:
        end = f"on which each number is {within}, or beyond both error bars on two meshes, or sure"
    worst = solution.worst_bar(judged)
    bar = (
        "it has no error bar" if worst is None else f"its own error bar is wider, {percent(worst)}"
    )
    return [f"The {LADDER[model].title} is a check: it ended at a mesh {end}; {bar}."]


def _points(scene: Scene, names: Sequence[Quantity]) -> list[str]:
    """Say at which of several lumped points models are judged."""
    if not scene.further_ports:
        return []
    of_points = [name for name in names if not name.is_frequency]
    pairs = [name.pair for name in of_points if name.pair]
    judged_points = {next(iter(q.points), scene.port.name) for q in of_points if not q.pair}
    judged_names = [port.name for port in scene.ports if port.name in judged_points]
    other_names = [port.name for port in scene.ports if port.name not in judged_points]
    clauses = [f"at {_all_of(judged_names)}"] if judged_names else []
    clauses += [f"between {a} and {b}" for a, b in dict.fromkeys(pairs)]
    sentence = (
        f"Compliances are judged {', '.join(clauses)}" if clauses else "No compliance is judged"
    )
    return [f"{sentence}{'; not at ' if other_names else ''}{_all_of(other_names)}."]


def _all_of(names: list[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _cheapest(solutions, cheapest, tolerance) -> list[str]:
    if not cheapest:
        return [f"No model was shown to be within {percent(tolerance)}; one may still be."]
    return [
        f"Cheapest model within {percent(tolerance)}: {LADDER[cheapest].title} ({_cost(solutions[cheapest])})."
    ]


def _beams(solutions, gaps, judged, tolerance) -> list[str]:
    """Return sentences on beams that fail or pass only by the tie at a seat, and not by their own
    theory.
    """
    out = []
    for model in LADDER.of(BEAM):
        if model not in solutions:
            continue
        scene, like = (
            max(select_gaps(gaps, model, judged, tie), key=lambda gap: gap.size, default=None)
            for tie in (SCENE, SECTION)
        )
        if scene is None or like is None:
            continue
        seat_gap, section_gap = scene.size, like.size
        if seat_gap > tolerance >= section_gap:
            out.append(
                f"The seats, not the beam, put the {LADDER[model].title} out: "
                f"{_quantity_text(scene, solutions)} is {percent(seat_gap)} off as the scene is "
                f"tied, and nothing is more than {percent(section_gap)} off like for like."
            )
        elif seat_gap <= tolerance < section_gap:
            out.append(
                f"The {LADDER[model].title} agrees within {percent(seat_gap)} by luck: like for "
                f"like it is {percent(section_gap)} off in {_quantity_text(like, solutions)}, and "
                "soft seats, which a beam leaves out, cancel that at this seat width."
            )
    return out


def _cost(solution: Solution) -> str:
    # The price of an answer is building and solving it; bars and variants are evidence on top.
    seconds = sum(solution.meter.seconds.get(k, 0.0) for k in ("build", "statics", "modes"))
    return f"{solution.body.size} unknowns, {seconds:.2g} s"
