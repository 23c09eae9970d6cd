"""From the solutions of a comparison to its record."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

from solidgear.frames import DOF_NAMES
from solidgear.judge.at_rest import spin_caution
from solidgear.judge.bars import ErrorBar
from solidgear.judge.completeness import completeness, cut_short, split_apart
from solidgear.judge.correlation import correlate
from solidgear.judge.deviations import Deviation, deviations
from solidgear.judge.hidden import COMPLETE, less_widest
from solidgear.judge.lumped import drawn, model_record
from solidgear.judge.quantities import usual
from solidgear.judge.record import (
    BarRecord,
    BarSummary,
    CauseRecord,
    ConvergenceRecord,
    CoupledRecord,
    DeviationRecord,
    EvidenceRecord,
    GuardRecord,
    LumpedRecord,
    MacRecord,
    ModelRecord,
    ModeRecord,
    PointRecord,
    PortRecord,
    Record,
    VariantRecord,
)
from solidgear.judge.solution import Solution
from solidgear.judge.solving import ENOUGH, Answer, Statics
from solidgear.judge.ties import SCENE
from solidgear.judge.verdict import Judgement, judge, percent, trusted
from solidgear.ladder.model import LUMPED, SOLID
from solidgear.ladder.registry import LADDER
from solidgear.machine.environment import environment
from solidgear.quantity import COMPLIANCE, FIRST_BENDING
from solidgear.solve.mixtures import mixtures

if TYPE_CHECKING:
    from solidgear.scene import Scene


def recorded(
    scene: Scene,
    solutions: dict[str, Solution],
    failed: dict[str, str],
    causes: list[CauseRecord],
    lumped: dict[str, LumpedRecord],
    guards: list[GuardRecord],
    complete: bool,
) -> Record:
    """Record of a comparison.

    Parameters
    ----------
    failed : dict of str to str
        Models that could not be solved, and why.
    complete : bool
        False after an interrupt.
    """
    trust, _ = trusted(solutions, scene.ask.tolerance, usual(scene))
    # Where nothing may judge, the distances are still reported; they are no judgement.
    reference = trust or next((m for m in LADDER.judges if m in solutions), None)
    gaps = deviations(solutions, reference) if reference else []
    verdict, validity = judge(scene, solutions, gaps, guards)
    verdict.reference = reference
    models: dict[str, ModelRecord] = {}
    for model in LADDER.bodies:
        if model in solutions:
            models[model] = _model_record(solutions[model], validity[model])
        elif model in failed:
            models[model] = ModelRecord(**drawn(model), valid=False, why_not=failed[model])
    out = Record(
        complete=complete,
        scene=scene.as_dict(),
        port=_port_record(scene, solutions, 0),
        further_ports=[
            _port_record(scene, solutions, k) for k in range(1, len(scene.ports)) if solutions
        ],
        attachments=_attachments(solutions),
        mac=_mac(solutions, reference),
        deviations=[_deviation_record(gap) for gap in gaps],
        causes=causes,
        lumped=lumped,
        verdict=verdict,
        guards=guards,
        environment=environment(),
        models=models,
        missing=[LADDER[model].title for model in LADDER.fit(scene) if model not in models],
    )
    if lumped and reference:
        _add_lumped(out, solutions[reference], guards, scene.ask.tolerance, scene.ask.lumped)
    out.warnings = _warnings(solutions, guards, out.models)
    if listed := solutions.get(reference or next(reversed(solutions), "")):
        own = {str(q): bar.width for q, bar in listed.error_bars.get(SCENE, {}).items()}
        out.warnings += spin_caution(scene, listed.body, listed.modes.modes, own)
        n = max(scene.ask.modes, ENOUGH)
        out.warnings += cut_short(listed.modes.modes, n, scene.ask.max_frequency)
    return out


def _port_record(scene: Scene, solutions: dict[str, Solution], k: int) -> PortRecord:
    port, first = scene.ports[k], next(iter(solutions.values()), None)
    found = None if first is None else first.ties[SCENE].statics
    there = None if found is None else [found.main, *found.further.values()][k]
    return PortRecord(
        name=port.name,
        y=port.y,
        attachment=port.attachment,
        order=list(DOF_NAMES),
        free=list(there.free_names) if there else [],
    )


def _deviation_record(gap: Deviation) -> DeviationRecord:
    return DeviationRecord(**asdict(gap), unit=gap.quantity.unit, verdict=gap.verdict)


def _attachments(solutions: dict[str, Solution]) -> dict[str, dict[str, VariantRecord]]:
    return {
        model: {name: _variant_record(found) for name, found in solution.variants.items()}
        for model, solution in solutions.items()
        if solution.variants
    }


def _warnings(
    solutions: dict[str, Solution], guards: list[GuardRecord], models: dict[str, ModelRecord]
) -> list[str]:
    out = []
    for notice in guards:
        # What speaks against a model that is out anyway is in the record, and nobody's concern.
        about = [m for m in notice.models if m in models and models[m].valid]
        if about or not notice.models:
            named = ", ".join(models[m].title for m in about)
            out.append(f"{named}: {notice.sentence}" if about else notice.sentence)
    out += [
        f"{LADDER[m].title}: {what}: {why}"
        for m, r in solutions.items()
        for what, why in r.failed.items()
    ]
    for model, solution in solutions.items():
        out += [f"{LADDER[model].title}: {one}" for one in split_apart(solution.modes.evidence)]
        out += [f"{LADDER[model].title}: {one.sentence}" for one in mixtures(solution.modes)]
    return out


def _add_lumped(
    record: Record, base: Solution, guards: list[GuardRecord], tolerance: float, synthesis: bool
) -> None:
    """The lumped model among the models; what every synthesis is worth only where it is asked."""
    bar = base.error_bars.get(SCENE, {}).get(FIRST_BENDING)
    own = model_record(
        record.lumped,
        record.models,
        base.quantities.get(FIRST_BENDING),
        tolerance,
        bar.width if bar else None,
        guards,
    )
    if own is None:
        return
    (name,) = LADDER.of(LUMPED)
    record.models = {name: own, **record.models}
    verdict = record.verdict
    source = LADDER[own.source or name]
    masses = f"{own.variant} masses on the stiffness of the {source.title}"
    if own.valid and source.family == SOLID:
        verdict.sentences.append(
            f"A {LADDER[name].title} ({masses}) is within {percent(tolerance)} too, for first "
            "bending and below only, and costs as much as what it rests on."
        )
    elif own.valid:
        verdict.cheapest = name
        verdict.sentences = [s for s in verdict.sentences if not s.startswith("Cheapest model")]
        verdict.sentences.append(
            f"Cheapest model within {percent(tolerance)}: {LADDER[name].title} "
            f"({masses}), for first bending and below only."
        )
    made = record.lumped[base.model].variants if base.model in record.lumped else {}
    if not made or verdict.trust is None or not synthesis:
        return
    errors = [
        f"{n} {_error(v.frequency_error)}"
        for n, v in made.items()
        if v.feasible and v.frequency_error is not None
    ]
    verdict.sentences.append(
        f"First bending of lumped models made from the {LADDER[base.model].title}: "
        f"{', '.join(errors)}."
    )
    if not made["thesis"].feasible:
        verdict.sentences.append(
            "The thesis's equations 52 and 53 have no usable solution here: "
            f"{made['thesis'].verdict}."
        )


def _error(relative: float) -> str:
    return "exact" if abs(relative) < 1e-9 else f"{100 * relative:+.2g} %"


def _model_record(solution: Solution, judgement: Judgement) -> ModelRecord:
    return ModelRecord(
        **drawn(solution.model),
        valid=judgement.valid,
        open=judgement.open,
        why_not=judgement.why_not,
        compliance=solution.condensed.compliance,
        stiffness=solution.condensed.stiffness,
        points={
            name: PointRecord.model_validate(there)
            for name, there in solution.ties[SCENE].statics.further.items()
        },
        coupled=_coupled(solution.ties[SCENE].statics),
        modes=[ModeRecord.model_validate(m) for m in solution.modes.modes],
        band=_bar_summary(solution),
        convergence=_convergence(solution),
        dofs=solution.body.size,
        seconds=solution.meter.total(),
        peak_mb=solution.meter.peak_mb,
        backend=solution.condensed.evidence["backend"],
        mesh=solution.body.mesh,
        evidence=_evidence(solution),
    )


def _coupled(found: Statics) -> CoupledRecord | None:
    both = found.coupled
    if both is None:
        return None
    return CoupledRecord(
        ports=list(both.ports),
        stiffness=both.stiffness,
        compliance=both.compliance,
        stiffness_error=both.evidence["stiffness_error"],
    )


def _bar_summary(solution: Solution) -> BarSummary | None:
    own = solution.error_bars.get(SCENE, {})
    if not own:
        return None
    method = next(iter(own.values())).method
    return BarSummary(
        compliance=max((b.width for q, b in own.items() if q.kind == COMPLIANCE), default=None),
        method=f"{method}, {len(solution.levels)} meshes",
        each={name: bar.width for name, bar in own.items()},
    )


def _convergence(solution: Solution) -> ConvergenceRecord | None:
    own = solution.error_bars.get(SCENE, {})
    if not own:
        return None
    return ConvergenceRecord(
        levels=solution.levels,
        quantities={name: _bar_record(bar) for name, bar in own.items()},
    )


def _bar_record(bar: ErrorBar) -> BarRecord:
    facts = asdict(bar)
    return BarRecord(gci=facts.pop("width"), **facts)


def _evidence(solution: Solution) -> EvidenceRecord:
    statics = solution.condensed.evidence
    own = solution.error_bars.get(SCENE, {})
    found = less_widest(
        solution.modes.evidence, [bar.width for q, bar in own.items() if q.is_frequency]
    )
    return EvidenceRecord(
        asymmetry=statics["asymmetry"],
        refinement_residual=statics["residual"],
        rigid_residual=solution.body.rigid_residual(),
        modal_residual=found["residual"],
        orthogonality=found["orthogonality"],
        eigensolver=found["method"],
        mode_count=found.get("count", []),
        complete_below_hz=found.get(COMPLETE),
        families=found.get("families", []),
        complete=completeness(found, solution.model) if "count" in found else "",
        rigid_modes=found["rigid_modes"],
        coupling_bound=found["coupling_bound"],
        shift_rad2=float(found["shift_rad2"]),
    )


def _variant_record(found: Answer) -> VariantRecord:
    return VariantRecord(
        quantities=found.quantities,
        stiffness=found.statics.main.stiffness,
        compliance=found.statics.main.compliance,
        modes=[ModeRecord.model_validate(m) for m in found.modes.modes],
    )


def _mac(solutions: dict[str, Solution], reference: str | None) -> MacRecord | None:
    if reference is None:
        return None
    base = solutions[reference].modes
    tables = {
        model: correlate(solution.modes, base)
        for model, solution in solutions.items()
        if model != reference
    }
    return MacRecord(reference=reference, stations=base.stations.tolist(), models=tables)
