"""Deviations between rungs, and in words which to trust and which is the cheapest that will do."""

from __future__ import annotations

from solidgear.evidence.quantities import QUANTITIES, change, measure
from solidgear.fidelity import FIDELITIES

# Compliances and the frequencies a gear designer reads; stiffnesses follow from compliances and are shown, not judged:
# inverting spreads a small change of one entry over all of them.
JUDGED = ("C_zz", "C_thx", "C_yy", "bending 1", "axial 1")


def deviations(rungs: dict, reference: str) -> list[dict]:
    """Relative deviations from the reference, once with the attachments of the scene and once like for like.

    A beam node moves like the mean of a cross-section, so the fair partner of a beam is the solid with
    section-mean attachments.  A gap inside the sum of both bands is "not resolved", which is not agreement.
    """
    base = rungs[reference]
    out = []
    for model, rung in rungs.items():
        if model == reference:
            continue
        pairs = [("as scene", rung.quantities, base.quantities)]
        if "section" in base.variants and base.condensed.attachment != "section":
            theirs = measure(*base.variants["section"])
            mine = measure(*rung.variants["section"]) if "section" in rung.variants else rung.quantities
            if "section" in rung.variants or model in ("euler", "timoshenko"):
                pairs.append(("section", mine, theirs))
        for attachment, mine, theirs in pairs:
            for name, (_, _, unit) in QUANTITIES.items():
                relative = change(mine, theirs, name)
                if relative is None:
                    continue
                bands = [r.bands[name]["gci"] for r in (base, rung) if name in r.bands]
                band = sum(bands) if bands else None
                resolved = "resolved" if band is not None and abs(relative) > band else "not resolved" if band is not None else "no band"
                out.append(
                    {
                        "model": model,
                        "reference": reference,
                        "attachment": attachment,
                        "quantity": name,
                        "unit": unit,
                        "value": mine[name],
                        "reference_value": theirs[name],
                        "relative": relative,
                        "band": band,
                        "verdict": resolved,
                    }
                )
    return out


def judge(scene, rungs: dict, reference: str | None, gaps: list[dict]) -> tuple[dict, dict[str, tuple[bool, str | None]]]:
    """Validity of every rung and the verdict in sentences.

    A rung is valid when, with the attachments of the scene and like for like, none of the judged numbers is further from
    the reference than the tolerance asked for; agreement in one of the two alone can be a cancellation.
    """
    tolerance = scene.ask.tolerance
    validity: dict[str, tuple[bool, str | None]] = {}
    for model, rung in rungs.items():
        validity[model] = (True, None)
        if model == reference:
            continue
        worst = max(
            (g for g in gaps if g["model"] == model and g["quantity"] in JUDGED), key=lambda g: abs(g["relative"]), default=None
        )
        if worst and abs(worst["relative"]) > tolerance:
            how = "with the attachments of the scene" if worst["attachment"] == "as scene" else "like for like (section means)"
            why = (
                f"{worst['quantity']} is {100 * abs(worst['relative']):.1f} % {_side(worst)} against the {reference} model {how}, "
                f"more than the {100 * tolerance:g} % asked for"
            )
            validity[model] = (False, why)
    if reference is None:
        return {"trust": None, "reference": None, "cheapest": None, "tolerance": tolerance, "sentences": ["No model could be solved."]}, validity
    cheapest = next((m for m in FIDELITIES if m in rungs and validity[m][0]), None)
    sentences = [*_trust(rungs, reference, gaps), *_cheapest(rungs, reference, cheapest, tolerance, gaps)]
    return {"trust": reference, "reference": reference, "cheapest": cheapest, "tolerance": tolerance, "sentences": sentences}, validity


def _side(gap: dict) -> str:
    """What the sign of a gap means to an engineer."""
    if gap["quantity"].startswith("C_"):
        return "too small (too stiff)" if gap["relative"] < 0 else "too large (too soft)"
    return "too high" if gap["relative"] > 0 else "too low"


def _percent(x: float) -> str:
    return f"{100 * x:.2g} %"


def _trust(rungs, reference, gaps) -> list[str]:
    base = rungs[reference]
    if not base.bands:
        return [f"The {reference} model is the best one that was run, but it has no band of its own: run a solid rung to judge it."]
    c = max((v["gci"] for k, v in base.bands.items() if k.startswith("C_")), default=None)
    f = base.bands.get("bending 1", {}).get("gci")
    size = [f"{_percent(v)} in {what}" for v, what in ((c, "compliance"), (f, "first bending")) if v is not None]
    band = " and ".join(size) or "on the numbers it has"
    kind = "exact 3D elasticity of a body of revolution" if reference == "harmonic" else "full 3D elasticity"
    out = [f"Trust the {reference} solid: {kind}, sure of itself to {band} (three refinements)."]
    mine = [g for g in gaps if g["model"] == "solid" and g["attachment"] == "as scene" and g["quantity"] in JUDGED]
    if mine:
        worst = max(mine, key=lambda g: abs(g["relative"]))
        open_ones = [g for g in mine if g["verdict"] == "resolved"]
        text = f"The full 3D solid, another mesh and another formulation, is within {_percent(abs(worst['relative']))} of it in every judged number"
        text += "; all gaps lie inside the bands (not resolved)." if not open_ones else f", beyond the bands in {', '.join(g['quantity'] for g in open_ones)}."
        out.append(text)
    return out


def _cheapest(rungs, reference, cheapest, tolerance, gaps) -> list[str]:
    out = []
    if cheapest:
        out.append(f"Cheapest model within {100 * tolerance:g} %: {cheapest} ({_cost(rungs[cheapest])}).")
    if "timoshenko" in rungs and reference != "timoshenko":
        here = {g["attachment"]: g["relative"] for g in gaps if g["model"] == "timoshenko" and g["quantity"] == "bending 1"}
        if len(here) == 2 and abs(here["as scene"]) < 0.5 * abs(here["section"]):
            out.append(
                f"Timoshenko's first bending looks {_percent(abs(here['as scene']))} off with the scene's seats but is {_percent(abs(here['section']))} off "
                "like for like: seat flexibility, which a beam has not, hides part of its excess stiffness."
            )
    return out


def _cost(rung) -> str:
    # The price of an answer is building and solving it; bands and variants are evidence on top.
    seconds = sum(rung.meter.seconds.get(k, 0.0) for k in ("build", "statics", "modes"))
    return f"{rung.body.size} unknowns, {seconds:.2g} s"
