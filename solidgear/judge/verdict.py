"""Deviations between rungs, and in words which to trust and which is the cheapest that will do.

A rung is judged twice by the reference: as the scene is tied, and like for like with section means
at every station.  A gap counts with the bands of both sides: within the tolerance even at their far
end it is *within*, beyond it even at their near end it is *beyond*, else the question is *open*.
Without a band of the reference there is no judgement.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.judge.partners import Partners
from solidgear.judge.quantities import (
    AT,
    JUDGED,
    QUANTITIES,
    change,
    described,
    diagonals,
    in_words,
    judged,
    points_of,
    repeats,
    usual,
)
from solidgear.judge.solution import Solution
from solidgear.judge.ties import SCENE, SECTION
from solidgear.ladder.model import BEAM, SOLID
from solidgear.ladder.registry import LADDER

if TYPE_CHECKING:
    from solidgear.scene import Scene

WITHIN, OPEN, BEYOND = "within", "open", "beyond"
TIES = {
    SCENE: "with the attachments of the scene",
    SECTION: "like for like (section means everywhere)",
}


@dataclass(frozen=True)
class Judgement:
    """What a rung is worth: ``valid`` only if nothing speaks against it, ``open`` if that is not
    decided.
    """

    valid: bool
    why_not: str | None = None
    open: bool = False


def gap_verdict(gap: float, band: float, tolerance: float) -> str:
    """``within``, ``open`` or ``beyond`` a tolerance, for a gap known to within a band."""
    if abs(gap) + band <= tolerance:
        return WITHIN
    return BEYOND if abs(gap) - band > tolerance else OPEN


def deviations(rungs: dict[str, Solution], reference: str) -> list[dict]:
    """Relative deviations from the reference, once with the attachments of the scene and once like
    for like.

    Couplings are related to the geometric mean of their diagonal entries, frequencies are those of
    the modes with the same shape. A gap inside the sum of both bands is "not resolved", which is
    not agreement.
    """
    base = rungs[reference]
    out: list[dict] = []
    for model, rung in rungs.items():
        if model == reference:
            continue
        for tie in (SCENE, SECTION):
            if (
                tie not in rung.ties
                or tie not in base.ties
                or (tie == SECTION and rung.ties[SECTION] is rung.ties[SCENE])
            ):
                continue
            out += _deviations(model, reference, tie, rung, base)
    return out


def _deviations(
    model: str, reference: str, tie: str, rung: Solution, base: Solution
) -> Iterable[dict]:
    mine, theirs = rung.ties[tie], base.ties[tie]
    partners = Partners(mine.modes, theirs.modes)
    further = [name for name in mine.quantities if AT in name and not repeats(name)]
    for name in (*QUANTITIES, *further):
        _, place, unit = described(name)
        value, how = mine.quantities.get(name), ""
        if isinstance(place, str):
            value, how = partners.frequency(place)
        if value is None or name not in theirs.quantities:
            continue
        relative = change({**mine.quantities, name: value}, theirs.quantities, name)
        if relative is None:
            continue
        bands = [r.bands[tie][name].gci for r in (base, rung) if name in r.bands.get(tie, {})]
        band = sum(bands) if bands else None
        resolved = (
            "no band" if band is None else "resolved" if abs(relative) > band else "not resolved"
        )
        yield {
            "model": model,
            "reference": reference,
            "attachment": tie,
            "quantity": name,
            "unit": unit,
            "value": value,
            "reference_value": theirs.quantities[name],
            "relative": relative,
            "band": band,
            "verdict": resolved,
            "pairing": how,
        }


def trusted(
    rungs: dict[str, Solution], tolerance: float, names: Iterable[str] = JUDGED
) -> tuple[str | None, str]:
    """The rung that may judge the others, and why there is none: a solid whose bands of some
    quantities are inside the tolerance.
    """
    names = tuple(names)
    why = "no solid was run, and a beam cannot judge itself"
    for model in LADDER.of(SOLID):
        if model not in rungs:
            continue
        worst = rungs[model].worst_band(names)
        if worst is None:
            why = f"the {LADDER[model].title} has no band of its own ({_reason(rungs[model])})"
        elif worst > tolerance:
            why = (
                f"the {LADDER[model].title} is sure of itself to no better than {percent(worst)}, "
                f"more than the {percent(tolerance)} asked for"
            )
        else:
            return model, ""
    return None, why


def _reason(rung: Solution) -> str:
    return "; ".join(dict.fromkeys(rung.failed.values())) or "it was solved on one mesh only"


def judge(
    scene: Scene, rungs: dict[str, Solution], gaps: list[dict], notices: Iterable[dict] = ()
) -> tuple[dict, dict[str, Judgement]]:
    """Validity of every rung and the verdict in sentences.

    Parameters
    ----------
    scene : Scene
    rungs : dict of str to Solution
    gaps : list of dict
        From :func:`deviations`, against the rung that :func:`trusted` names or, where there is
        none, the best there is.
    notices : iterable of dict
        What the guards say: ``level``, ``models``, ``sentence``.
    """
    tolerance = scene.ask.tolerance
    names = judged(scene)
    reference, why = trusted(rungs, tolerance, usual(scene))
    notices = list(notices)
    validity = {
        m: _judged(m, rungs, reference, why, gaps, names, tolerance, notices) for m in rungs
    }
    cheapest = next((m for m in LADDER.bodies if m in rungs and validity[m].valid), None)
    sentences = []
    if not rungs:
        sentences = ["No model could be solved."]
    elif reference is None:
        sentences = [f"Not judged: {why}."]
    else:
        sentences = [
            *_trust(rungs, reference, gaps, names),
            *_points(scene, names),
            *_cheapest(rungs, cheapest, tolerance),
            *_beams(rungs, gaps, names, tolerance),
        ]
    verdict = {
        "trust": reference,
        "reference": reference,
        "cheapest": cheapest,
        "tolerance": tolerance,
        "judged": list(names),
        "sentences": sentences,
    }
    return verdict, validity


def spoken_against(model: str, notices: Iterable[dict]) -> list[str]:
    """Sentences of the guards that put a model out."""
    return [
        n["sentence"] for n in notices if model in n["models"] and n["level"] in ("avoid", "fault")
    ]


def _judged(model, rungs, reference, why, gaps, judged, tolerance, notices) -> Judgement:
    against = spoken_against(model, notices)
    if reference is None:
        return Judgement(False, f"not judged: {why}", open=True)
    if against:
        return Judgement(False, against[0])
    rung = rungs[model]
    if LADDER[model].family == SOLID:
        worst = rung.worst_band(judged)
        if worst is None or worst > tolerance:
            text = (
                "it has no band of its own"
                if worst is None
                else f"it is sure of itself to no better than {percent(worst)}"
            )
            return Judgement(
                False, f"{text}, and {percent(tolerance)} is asked for ({_reason(rung)})", open=True
            )
    if model == reference:
        return Judgement(True)
    mine = [g for g in gaps if g["model"] == model and g["quantity"] in judged]
    missing = [
        q
        for q in judged
        if q in rungs[reference].quantities and not any(g["quantity"] == q for g in mine)
    ]
    if missing:
        return Judgement(
            False,
            f"nothing in it corresponds to {' and '.join(missing)} of the {LADDER[reference].title}",
            open=True,
        )
    worst_first = sorted(mine, key=lambda g: -(abs(g["relative"]) + (g["band"] or 0.0)))
    for kind in (BEYOND, OPEN):
        for gap in worst_first:
            if gap_verdict(gap["relative"], gap["band"] or 0.0, tolerance) == kind:
                return Judgement(
                    False, _why(gap, rungs, reference, kind, tolerance), open=kind == OPEN
                )
    return Judgement(True)


def _said(gap: dict, rungs: dict[str, Solution]) -> str:
    """The quantity of a gap; with its lumped point where there are several."""
    found = rungs[gap["reference"]].ties[SCENE]
    return in_words(gap["quantity"], found.condensed.port if found.further else "")


def _why(gap: dict, rungs: dict[str, Solution], reference: str, kind: str, tolerance: float) -> str:
    text = (
        f"{_said(gap, rungs)} is {percent(abs(gap['relative']))} {_side(gap)} against the "
        f"{LADDER[reference].title} {TIES[gap['attachment']]}"
    )
    if gap["pairing"]:
        text += f" ({gap['pairing']})"
    if kind == BEYOND:
        return f"{text}, more than the {percent(tolerance)} asked for"
    return (
        f"{text}, which with a band of {percent(gap['band'])} may or may not be within the "
        f"{percent(tolerance)} asked for"
    )


def _side(gap: dict) -> str:
    """What the sign of a gap means to an engineer."""
    if diagonals(gap["quantity"]):
        return "off (of the geometric mean of the two diagonal entries)"
    if gap["quantity"].startswith("C_"):
        return "too small (too stiff)" if gap["relative"] < 0 else "too large (too soft)"
    return "too high" if gap["relative"] > 0 else "too low"


def percent(x: float) -> str:
    """A share in per cent to two figures, never with an exponent."""
    if 0 < abs(x) < 1e-6:
        return "less than 0.0001 %"
    return f"{100 * x:.2g} %" if abs(x) < 0.995 else f"{100 * x:.0f} %"


def _trust(rungs, reference, gaps, judged) -> list[str]:
    base = rungs[reference]
    own = base.bands[SCENE]
    size = []
    c = max((own[q].gci for q in judged if q.startswith("C_") and q in own), default=None)
    f = own["bending 1"].gci if "bending 1" in own else None
    if c is not None:
        size.append(f"{percent(c)} in compliance")
    if f is not None:
        size.append(f"{percent(f)} in first bending")
    band = " and ".join(size) or "the numbers it has"
    out = [
        f"Trust the {LADDER[reference].title}: {LADDER[reference].theory}, sure of itself to "
        f"{band} ({len(base.levels)} meshes)."
    ]
    for model in LADDER.of(SOLID):
        if model in rungs and model != reference:
            same = all("sectors" in rungs[m].body.mesh for m in (model, reference))
            kind = "copies of the same mesh" if same else "another mesh and another formulation"
            out += _other_solid(model, kind, rungs[model], gaps, judged)
    return out


def _other_solid(model: str, kind: str, rung: Solution, gaps: list[dict], judged) -> list[str]:
    """How far a solid that does not judge is from the one that does."""
    mine = [
        g
        for g in gaps
        if g["model"] == model and g["attachment"] == SCENE and g["quantity"] in judged
    ]
    if not mine:
        return []
    worst = max(mine, key=lambda g: abs(g["relative"]))
    text = (
        f"The {LADDER[model].title}, {kind}, is within "
        f"{percent(abs(worst['relative']))} of it in every judged number"
    )
    # what has no band of its own may err by all of a gap
    own = rung.bands.get(SCENE, {})
    unknown = [g["quantity"] for g in mine if g["quantity"] not in own]
    if len(unknown) == len(mine):
        return [f"{text}; it has no bands of its own, which would tell whose the gaps are."]
    beyond = [g["quantity"] for g in mine if g["quantity"] in own and g["verdict"] == "resolved"]
    text += f", beyond the bands in {', '.join(beyond)}" * bool(beyond)
    if unknown:
        return [f"{text}; of {', '.join(unknown)} it has no band of its own."]
    return [f"{text}{'; all gaps lie inside the bands (not resolved)' * (not beyond)}."]


def _points(scene: Scene, names) -> list[str]:
    """At which of several lumped points models are judged."""
    if not scene.further_ports:
        return []
    of_points = [name for name in names if name[:2] in ("C_", "K_")]
    pairs = [pair for pair in map(points_of, of_points) if pair]
    asked = {q.partition(AT)[2] or scene.port.name for q in of_points if not points_of(q)}
    at = [port.name for port in scene.ports if port.name in asked]
    left = [port.name for port in scene.ports if port.name not in asked]
    told = [f"at {_all_of(at)}"] if at else []
    told += [f"between {a} and {b}" for a, b in dict.fromkeys(pairs)]
    where = f"Compliances are judged {', '.join(told)}" if told else "No compliance is judged"
    return [f"{where}{'; not at ' * bool(left)}{_all_of(left)}."]


def _all_of(names: list[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _cheapest(rungs, cheapest, tolerance) -> list[str]:
    if not cheapest:
        return [f"No model is known to be within {percent(tolerance)}."]
    return [
        f"Cheapest model within {percent(tolerance)}: {LADDER[cheapest].title} ({_cost(rungs[cheapest])})."
    ]


def _beams(rungs, gaps, judged, tolerance) -> list[str]:
    """Where a beam fails on a seat it does not know, and not on its own theory: the tie, not the
    beam.
    """
    out = []
    for model in LADDER.of(BEAM):
        if model not in rungs:
            continue
        worst = {}
        for tie in (SCENE, SECTION):
            mine = [
                g
                for g in gaps
                if g["model"] == model and g["attachment"] == tie and g["quantity"] in judged
            ]
            worst[tie] = max(mine, key=lambda g: abs(g["relative"]), default=None)
        scene, like = worst[SCENE], worst[SECTION]
        if scene is None or like is None:
            continue
        here, fair = abs(scene["relative"]), abs(like["relative"])
        if here > tolerance >= fair:
            out.append(
                f"What puts the {LADDER[model].title} out is the tie, not the beam: "
                f"{_said(scene, rungs)} is {percent(here)} off at the scene's seats, which "
                f"distort sections, and nothing is more than {percent(fair)} off like for like."
            )
        elif here <= tolerance < fair:
            out.append(
                f"The {LADDER[model].title} looks within {percent(here)} at the scene's seats but "
                f"is {percent(fair)} off in {_said(like, rungs)} like for like: "
                "seat flexibility, which a beam has not, hides part of its excess stiffness."
            )
    return out


def _cost(rung: Solution) -> str:
    # The price of an answer is building and solving it; bands and variants are evidence on top.
    seconds = sum(rung.meter.seconds.get(k, 0.0) for k in ("build", "statics", "modes"))
    return f"{rung.body.size} unknowns, {seconds:.2g} s"
