"""The main job: one scene, every rung, one verdict."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import asdict, dataclass, field

import numpy as np

from solidgear.body import as_supports
from solidgear.errors import SolidgearError
from solidgear.evidence.causes import attachment_causes, beam_causes, shoulder_cause
from solidgear.evidence.converge import gci, sharpest_corner
from solidgear.evidence.correlate import correlate
from solidgear.evidence.quantities import QUANTITIES, change, measure
from solidgear.fidelity import FIDELITIES, build
from solidgear.frames import DOF_NAMES
from solidgear.lumped.rung import model_record, synthesise_all
from solidgear.meter import Meter
from solidgear.solve.modes import ModeSet, modes
from solidgear.solve.statics import Condensed, condense
from solidgear.verdict import deviations, judge

log = logging.getLogger(__name__)
Progress = Callable[[str], None]

#: coarser relatives for the band; the run itself is the finest of the three
SOLID_LEVELS = (0.35, 0.65)
ATTACHMENTS = ("average", "rigid", "section")
MODELS = ("lumped", *FIDELITIES)


@dataclass
class Rung:
    """One fidelity, solved."""

    body: object
    condensed: Condensed
    modes: ModeSet
    quantities: dict[str, float]
    meter: Meter
    bands: dict[str, dict] = field(default_factory=dict)
    variants: dict[str, tuple[Condensed, ModeSet]] = field(default_factory=dict)
    levels: list[dict] = field(default_factory=list)
    failed: dict[str, str] = field(default_factory=dict)


@dataclass
class Comparison:
    """Everything a comparison found.

    Attributes
    ----------
    scene : Scene
    results : dict
        Plain data, what ``results.json`` holds.
    rungs : dict of str to Rung
        The bodies and mode shapes behind it.
    """

    scene: object
    results: dict
    rungs: dict[str, Rung]

    def write_report(self, out, *, renders: bool = True, progress: Progress = lambda _: None):
        """Write results.json, report.html, mode_*.png and modes_*.vtu into a folder.

        Returns
        -------
        pathlib.Path
            The folder.

        Raises
        ------
        SolidgearError
            If the folder cannot be written.
        """
        from solidgear.report.write import write_all

        return write_all(self, out, renders=renders, progress=progress)


def compare(
    scene,
    models: tuple[str, ...] = MODELS,
    *,
    settings: dict[str, dict] | None = None,
    progress: Progress = lambda _: None,
) -> Comparison:
    """Solve a scene with several fidelities and hold them against each other.

    Parameters
    ----------
    scene : Scene
    models : tuple of str
        Any of lumped, euler, timoshenko, harmonic, solid; lumped needs one of the others to rest on.
    settings : dict, optional
        Builder options per model, such as ``{"harmonic": {"order": 8}}``.
    progress : callable
        Told in words what is going on.

    Returns
    -------
    Comparison
        After Ctrl-C with what there was, ``results["complete"]`` False.

    Raises
    ------
    SolidgearError
        For an unknown model.  A model that fails is reported as not valid, and the others go on.
    """
    check_models(models)
    options = {m: dict((settings or {}).get(m, {})) for m in FIDELITIES}
    rungs: dict[str, Rung] = {}
    failed: dict[str, str] = {}
    causes: list = []
    lumped: dict = {}
    complete = True
    overall = Meter()
    with overall.stage("all"):
        try:
            for model in (m for m in FIDELITIES if m in models):
                try:
                    rungs[model] = rung = _solve(scene, model, options[model], progress)
                    # Evidence on top: an interrupt from here on leaves the solution itself.
                    if model in ("harmonic", "solid"):
                        _add_variants(scene, rung, model, options[model], progress)
                        _add_band(scene, rung, model, options[model], progress)
                except (SolidgearError, MemoryError) as error:
                    why = str(error) or "not enough memory"
                    log.warning("%s failed: %s", model, why)
                    if model in rungs:
                        rungs[model].failed["evidence"] = why
                    else:
                        failed[model] = why
            if "lumped" in models:
                progress("lumped: synthesis from every body")
                lumped = synthesise_all(scene, rungs, log.info)
            causes = _causes(scene, rungs, options, progress)
        except KeyboardInterrupt:
            complete = False
            progress("interrupted; keeping what is there")
    results = _results(scene, rungs, failed, causes, lumped, complete)
    results["seconds_total"] = overall.seconds["all"]
    return Comparison(scene, results, rungs)


def check_models(models: tuple[str, ...]) -> None:
    """Refuse unknown models, and the lumped one alone, in one sentence."""
    unknown = [m for m in models if m not in MODELS]
    if unknown or not set(models) & set(FIDELITIES):
        raise SolidgearError(f"models: {', '.join(unknown or models) or 'none given'}; choose from {', '.join(MODELS)}, lumped not alone")


def _shared(scene, model: str) -> tuple[str, ...] | None:
    """Attachments that can be built on one mesh: means over seats and over sections are only rows on the same matrices."""
    given = {s.attachment for s in scene.stations}
    if model in ("harmonic", "solid") and len(given) == 1 and given <= {"average", "section"}:
        return (*given, *({"average", "section"} - given))
    return None


def _solve(scene, model: str, options: dict, progress: Progress) -> Rung:
    meter = Meter()
    ask = scene.ask
    supports = as_supports(scene)
    shared = _shared(scene, model)
    extra = {"attachments": shared} if shared else {}
    progress(f"{model}: build")
    with meter.stage("build"):
        body = build(scene, model, **options, **extra)
    progress(f"{model}: statics ({body.size} unknowns)")
    with meter.stage("statics"):
        condensed = condense(body, supports, scene.port.name)
    progress(f"{model}: modes")
    with meter.stage("modes"):
        found = modes(body, supports, max(ask.modes, 10), max_frequency=ask.max_frequency, count=True)
    # Evidence, not part of the answer: kept apart from what the modes cost.
    meter.move("modes", "count", found.evidence["count_seconds"])
    return Rung(body, condensed, found, measure(condensed, found), meter)


def _add_variants(scene, rung: Rung, model, options, progress: Progress):
    """The same scene with every other attachment."""
    given, shared = {s.attachment for s in scene.stations}, _shared(scene, model)
    supports = as_supports(scene)
    port = scene.port.name
    n = max(scene.ask.modes, 10)
    with rung.meter.stage("attachments"):
        for attachment in ATTACHMENTS:
            progress(f"{rung.body.fidelity}: attachment {attachment}")
            try:
                if given == {attachment}:
                    rung.variants[attachment] = (rung.condensed, rung.modes)
                elif shared and attachment != "rigid":
                    held = supports.with_attachment(attachment)
                    rung.variants[attachment] = (condense(rung.body, held, port, attachment), modes(rung.body, held, n))
                else:
                    changed = rigid_seats(scene) if attachment == "rigid" else scene.with_attachment(attachment)
                    body = build(changed, model, **options)
                    rung.variants[attachment] = (condense(body, supports, port), modes(body, supports, n))
            except SolidgearError as error:
                rung.failed[f"attachment {attachment}"] = str(error)


def rigid_seats(scene):
    """The scene with rigid bearing seats; the lumped point keeps its mean attachment.

    Only seats are compared in the literature on RBE2 against RBE3; a rigid head would be another model.
    """
    return scene.with_changes(bearings=tuple(b.with_changes(attachment="rigid") for b in scene.bearings))


def _add_band(scene, rung: Rung, model, options, progress: Progress):
    """Two coarser solutions and the grid convergence index of every compared number."""
    angle, exponent = sharpest_corner(scene)
    if model == "harmonic":
        top = rung.body.mesh["order"]
        if top < 3:
            levels = [{**options, "refinement": options.get("refinement", 1.0) * s} for s in (0.4, 0.65)]
            sizes = None
        else:
            levels = [{**options, "order": p} for p in (top - 2, top - 1)]
            sizes = [1 / p for p in (top - 2, top - 1, top)]
        # A p-sequence on a corner converges twice as fast as an h-sequence (Babuska and Suri 1987).
        expected = 4 * exponent if sizes else 2 * exponent
        highest, cap = 20.0, expected if sizes else 2.0
    else:
        levels = [{**options, "refinement": options.get("refinement", 1.0) * s} for s in SOLID_LEVELS]
        sizes = None
        expected, highest = 2 * exponent, 4.0
        # Tetrahedra are refined by the same factor everywhere: nothing lifts them above the order of the corner.
        cap = expected if rung.body.mesh["element"].startswith("tet") else 2.0
    runs = []
    with rung.meter.stage("band"):
        for level in levels:
            progress(f"{model}: coarser relative {len(runs) + 1} of {len(levels)}")
            try:
                body = build(scene, model, **level)
                found = modes(body, scene, 10)
                runs.append((body, measure(condense(body, scene, scene.port.name), found)))
            except SolidgearError as error:
                rung.failed["band"] = str(error)
                return
    runs.append((rung.body, rung.quantities))
    by_order = sizes is not None
    sizes = sizes or [b.mesh["representative_size"] for b, _ in runs]
    for (body, values), size in zip(runs, sizes):
        h = None if by_order else size
        rung.levels.append({"dofs": body.size, "h": h, "order": body.mesh.get("order"), "c_zz": values.get("C_zz"), "bending_1_hz": values.get("bending 1"), "mesh": body.mesh})
    for name in QUANTITIES:
        values = [q.get(name) for _, q in runs]
        if None in values:
            continue
        try:
            found = gci(values, sizes, expected, highest, cap)
            # With a capped order the check only shows that the sequence converges faster than the band assumes.
            capped = found.observed_order is not None and found.used_order < found.observed_order
            inside = None if found.asymptotic is None or capped else 0.8 <= found.asymptotic <= 1.25
            extra = {"corner_deg": float(np.degrees(angle)), "asymptotic": inside, "asymptotic_ratio": found.asymptotic}
            rung.bands[name] = found.as_dict() | extra
        except ValueError as error:
            rung.failed["band"] = str(error)
            return


def _causes(scene, rungs: dict[str, Rung], options, progress: Progress) -> list:
    out = []
    progress("causes: switching assumptions one at a time")
    try:
        if "timoshenko" in rungs:
            out += beam_causes(scene)
        for model in ("harmonic", "solid"):
            if model in rungs:
                variants = {a: measure(*v) for a, v in rungs[model].variants.items()}
                out += attachment_causes(variants, model)
        harmonic = rungs.get("harmonic")
        if harmonic and "timoshenko" in rungs and "section" in harmonic.variants:
            section = measure(*harmonic.variants["section"])
            gap = {name: change(rungs["timoshenko"].quantities, section, name) for name in ("C_zz", "K_zz", "bending 1")}
            found = shoulder_cause(scene, gap, {**options["harmonic"], "order": 3}, progress)
            out += [found] if found else []
    except SolidgearError as error:
        log.warning("causes left out: %s", error)
    return out


def _results(scene, rungs: dict[str, Rung], failed: dict[str, str], causes, lumped: dict, complete: bool) -> dict:
    reference = next((m for m in ("harmonic", "solid", "timoshenko", "euler") if m in rungs), None)
    gaps = deviations(rungs, reference) if reference else []
    verdict, validity = judge(scene, rungs, reference, gaps)
    models = {}
    for model in FIDELITIES:
        if model in rungs:
            valid, why_not = validity[model]
            models[model] = _model_record(rungs[model], valid, why_not)
        elif model in failed:
            models[model] = {"valid": False, "why_not": failed[model], "modes": []}
    if lumped:
        best = rungs[reference].quantities.get("bending 1") if reference else None
        record = model_record(lumped, models, best, scene.ask.tolerance)
        if record:
            models = {"lumped": record, **models}
            _add_lumped(verdict, record, lumped, reference, best)
    warnings = [f"{m}: {what}: {why}" for m, r in rungs.items() for what, why in r.failed.items()]
    torn = [(m, *pair) for m, r in rungs.items() for pair in r.modes.evidence.get("torn_pairs", ())]
    warnings += [f"{m}: {one} and {other} are twins that the mesh has split by {gap:.1e}: refine it, or use hexahedra" for m, one, other, gap in torn]
    free = list(next(iter(rungs.values())).condensed.free_names) if rungs else []
    from solidgear.environment import environment

    return {
        "schema": 1,
        "complete": complete,
        "scene": scene.as_dict(),
        "port": {"name": scene.port.name, "y": scene.port.y, "attachment": scene.port.attachment, "order": list(DOF_NAMES), "free": free},
        "models": models,
        "attachments": {m: {a: _variant_record(*v) for a, v in r.variants.items()} for m, r in rungs.items() if r.variants},
        "mac": _mac(rungs, reference),
        "deviations": gaps,
        "causes": [asdict(c) for c in causes],
        "lumped": lumped,
        "verdict": verdict,
        "environment": environment(),
        "images": {},
        "warnings": warnings,
    }


def _add_lumped(verdict: dict, record: dict, lumped: dict, reference: str, best: float | None) -> None:
    """What the lumped models are worth, in the verdict."""
    if record["valid"]:
        verdict["cheapest"] = "lumped"
        verdict["sentences"] = [s for s in verdict["sentences"] if not s.startswith("Cheapest model")]
        verdict["sentences"].append(
            f"Cheapest model within {100 * verdict['tolerance']:g} %: lumped ({record['variant']} masses on the {record['source']} stiffness), for first bending and below only."
        )
    own = lumped.get(reference, {}).get("variants", {})
    if own:
        errors = [f"{n} {_error(v['frequency_error'])}" for n, v in own.items() if v["feasible"] and v["frequency_error"] is not None]
        verdict["sentences"].append(f"First bending of lumped models made from the {reference} solid itself: {', '.join(errors)}.")
        if not own["thesis"]["feasible"]:
            verdict["sentences"].append(f"The thesis's equations 52 and 53 have no usable solution here: {own['thesis']['verdict']}.")


def _error(relative: float) -> str:
    return "exact" if abs(relative) < 1e-9 else f"{100 * relative:+.2g} %"


def _matrix(a) -> list:
    """Nested lists with None where a component is free."""
    return [[None if not np.isfinite(v) else float(v) for v in row] for row in a]


def _model_record(rung: Rung, valid: bool, why_not: str | None) -> dict:
    bands = {k: v["gci"] for k, v in rung.bands.items()}
    compliance = [v for k, v in bands.items() if k.startswith("C_")]
    band = None
    if bands:
        band = {"compliance": max(compliance, default=None), "bending_1": bands.get("bending 1"), "method": "GCI on three meshes", "each": bands}
    evidence = {
        "asymmetry": rung.condensed.evidence["asymmetry"],
        "refinement_residual": rung.condensed.evidence["residual"],
        "rigid_residual": rung.body.rigid_residual(),
        "modal_residual": rung.modes.evidence["residual"],
        "orthogonality": rung.modes.evidence["orthogonality"],
        "eigensolver": rung.modes.evidence["method"],
        "mode_count": rung.modes.evidence["count"],
        "rigid_modes": rung.modes.evidence["rigid_modes"],
        "coupling_bound": rung.modes.evidence["coupling_bound"],
        "shift_rad2": float(rung.modes.evidence["shift_rad2"]),
    }
    convergence = {"levels": rung.levels, **{k.replace(" ", "_").lower(): v for k, v in rung.bands.items()}} if rung.bands else None
    return {
        "valid": valid,
        "why_not": why_not,
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
        "evidence": evidence,
    }


def _mode_record(m) -> dict:
    return {"name": m.name, "family": m.family, "frequency_hz": m.frequency_hz, "multiplicity": m.multiplicity, "captured": m.captured}


def _variant_record(condensed: Condensed, found: ModeSet) -> dict:
    values = measure(condensed, found)
    return {
        "c_zz": values.get("C_zz"),
        "k_zz": values.get("K_zz"),
        "bending_1_hz": values.get("bending 1"),
        "stiffness": _matrix(condensed.stiffness),
        "compliance": _matrix(condensed.compliance),
        "modes": [_mode_record(m) for m in found.modes],
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


__all__ = ["Comparison", "Rung", "compare"]
