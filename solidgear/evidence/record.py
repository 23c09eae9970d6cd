"""What ``results.json`` holds: plain data from the rungs of a comparison."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np

from solidgear.evidence.completeness import completeness
from solidgear.evidence.correlate import correlate
from solidgear.evidence.lumped import model_record as lumped_record
from solidgear.evidence.quantities import measure
from solidgear.evidence.study import Rung, Tied
from solidgear.evidence.ties import SCENE
from solidgear.evidence.verdict import Judgement, deviations, judge, percent, trusted
from solidgear.fidelity.ladder import LADDER
from solidgear.frames import DOF_NAMES
from solidgear.machine.environment import environment

if TYPE_CHECKING:
    from solidgear.scene import Scene


def record(
    scene: Scene,
    rungs: dict[str, Rung],
    failed: dict[str, str],
    causes: list,
    lumped: dict,
    guards: list[dict],
    complete: bool,
) -> dict:
    """Results of a comparison as plain data.

    Parameters
    ----------
    scene : Scene
    rungs : dict of str to Rung
    failed : dict of str to str
        Models that could not be solved, and why.
    causes : list of Cause
    lumped : dict
        From :func:`solidgear.evidence.lumped.synthesise_all`.
    guards : list of dict
        What the guards said: ``guard``, ``level``, ``models``, ``sentence``.
    complete : bool
        False after an interrupt.
    """
    trust, _ = trusted(rungs, scene.ask.tolerance)
    # Where nothing may judge, the distances are still told; they are no judgement.
    reference = trust or next((m for m in LADDER.judges if m in rungs), None)
    gaps = deviations(rungs, reference) if reference else []
    verdict, validity = judge(scene, rungs, gaps, guards)
    verdict["reference"] = reference
    models: dict[str, dict] = {}
    for model in LADDER.bodies:
        if model in rungs:
            models[model] = _model_record(rungs[model], validity[model])
        elif model in failed:
            models[model] = {"valid": False, "open": False, "why_not": failed[model], "modes": []}
    if lumped and reference:
        best = rungs[reference].quantities.get("bending 1")
        band = rungs[reference].bands.get(SCENE, {}).get("bending 1")
        own = lumped_record(
            lumped, models, best, scene.ask.tolerance, band.gci if band else None, guards
        )
        if own:
            models = {"lumped": own, **models}
            _add_lumped(verdict, own, lumped, reference)
    free = list(next(iter(rungs.values())).condensed.free_names) if rungs else []
    return {
        "schema": 2,
        "complete": complete,
        "scene": scene.as_dict(),
        "port": {
            "name": scene.port.name,
            "y": scene.port.y,
            "attachment": scene.port.attachment,
            "order": list(DOF_NAMES),
            "free": free,
        },
        "models": models,
        "attachments": {
            m: {a: _variant_record(v) for a, v in r.variants.items()}
            for m, r in rungs.items()
            if r.variants
        },
        "mac": _mac(rungs, reference),
        "deviations": gaps,
        "causes": [asdict(c) for c in causes],
        "lumped": lumped,
        "verdict": verdict,
        "guards": guards,
        "environment": environment(),
        "images": {},
        "warnings": _warnings(rungs, guards, models),
    }


def _warnings(rungs: dict[str, Rung], guards: list[dict], models: dict[str, dict]) -> list[str]:
    out = []
    for notice in guards:
        # What speaks against a model that is out anyway is in the record, and nobody's concern.
        about = [m for m in notice["models"] if models.get(m, {}).get("valid")]
        if about or not notice["models"]:
            out.append(f"{', '.join(about)}: {notice['sentence']}" if about else notice["sentence"])
    out += [f"{m}: {what}: {why}" for m, r in rungs.items() for what, why in r.failed.items()]
    for model, rung in rungs.items():
        for one, other, gap in rung.modes.evidence.get("torn_pairs", ()):
            out.append(
                f"{model}: {one} and {other} are twins that the mesh has split by {gap:.1e}: refine it, or use hexahedra"
            )
    return out


def _add_lumped(verdict: dict, own: dict, lumped: dict, reference: str) -> None:
    """What the lumped models are worth, in the verdict."""
    if own["valid"]:
        verdict["cheapest"] = "lumped"
        verdict["sentences"] = [
            s for s in verdict["sentences"] if not s.startswith("Cheapest model")
        ]
        verdict["sentences"].append(
            f"Cheapest model within {percent(verdict['tolerance'])}: lumped ({own['variant']} masses on the {own['source']} stiffness), for first bending and below only."
        )
    made = lumped.get(reference, {}).get("variants", {})
    if not made or verdict["trust"] is None:
        return
    errors = [
        f"{n} {_error(v['frequency_error'])}"
        for n, v in made.items()
        if v["feasible"] and v["frequency_error"] is not None
    ]
    verdict["sentences"].append(
        f"First bending of lumped models made from the {LADDER[reference].title} itself: {', '.join(errors)}."
    )
    if not made["thesis"]["feasible"]:
        verdict["sentences"].append(
            f"The thesis's equations 52 and 53 have no usable solution here: {made['thesis']['verdict']}."
        )


def _error(relative: float) -> str:
    return "exact" if abs(relative) < 1e-9 else f"{100 * relative:+.2g} %"


def _matrix(a) -> list:
    """Nested lists with None where a component is free."""
    return [[None if not np.isfinite(v) else float(v) for v in row] for row in a]


def _model_record(rung: Rung, judgement: Judgement) -> dict:
    own = rung.bands.get(SCENE, {})
    each = {name: band.gci for name, band in own.items()}
    compliance = [v for k, v in each.items() if k.startswith("C_")]
    band = None
    if each:
        method = next(iter(own.values())).method
        band = {
            "compliance": max(compliance, default=None),
            "bending_1": each.get("bending 1"),
            "method": f"{method}, {len(rung.levels)} meshes",
            "each": each,
        }
    convergence = (
        {
            "levels": rung.levels,
            **{k.replace(" ", "_").lower(): v.as_dict() for k, v in own.items()},
        }
        if own
        else None
    )
    return {
        "valid": judgement.valid,
        "open": judgement.open,
        "why_not": judgement.why_not,
        "compliance": _matrix(rung.condensed.compliance),
        "stiffness": _matrix(rung.condensed.stiffness),
        "modes": [_mode_record(m) for m in rung.modes.modes],
        "band": band,
        "convergence": convergence,
        "dofs": rung.body.size,
        "seconds": rung.meter.total(),
        "peak_mb": rung.meter.peak_mb,
        "backend": rung.condensed.evidence["backend"],
        "mesh": rung.body.mesh,
        "evidence": _evidence(rung),
    }


def _evidence(rung: Rung) -> dict:
    statics, found = rung.condensed.evidence, rung.modes.evidence
    return {
        "asymmetry": statics["asymmetry"],
        "refinement_residual": statics["residual"],
        "rigid_residual": rung.body.rigid_residual(),
        "modal_residual": found["residual"],
        "orthogonality": found["orthogonality"],
        "eigensolver": found["method"],
        "mode_count": found.get("count", []),
        "families": found.get("families", []),
        "complete": completeness(found, rung.model) if "count" in found else "",
        "rigid_modes": found["rigid_modes"],
        "coupling_bound": found["coupling_bound"],
        "shift_rad2": float(found["shift_rad2"]),
    }


def _mode_record(m) -> dict:
    return {
        "name": m.name,
        "family": m.family,
        "frequency_hz": m.frequency_hz,
        "multiplicity": m.multiplicity,
        "captured": m.captured,
        "error": getattr(m, "error", 0.0),
    }


def _variant_record(tied: Tied) -> dict:
    values = measure(tied.condensed, tied.modes)
    return {
        "c_zz": values.get("C_zz"),
        "k_zz": values.get("K_zz"),
        "bending_1_hz": values.get("bending 1"),
        "stiffness": _matrix(tied.condensed.stiffness),
        "compliance": _matrix(tied.condensed.compliance),
        "modes": [_mode_record(m) for m in tied.modes.modes],
    }


def _mac(rungs: dict[str, Rung], reference: str | None) -> dict | None:
    if reference is None:
        return None
    base = rungs[reference].modes
    out = {}
    for model, rung in rungs.items():
        if model == reference:
            continue
        c = correlate(rung.modes, base)
        out[model] = {
            "rows": list(c.rows),
            "columns": list(c.columns),
            "values": c.values.tolist(),
            "pairs": [asdict(p) for p in c.partners],
        }
    return {"reference": reference, "stations": base.stations.tolist(), "models": out}
