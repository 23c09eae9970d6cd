"""Record of a comparison, built from the solutions or read from a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from pydantic import ValidationError

from solidgear.core import (
    COMPLIANCE,
    DOF_NAMES,
    LADDER,
    OpenNumbers,
    Quantity,
    Record,
    Scene,
    SolidgearError,
    Solution,
    environment,
    number_cautions,
)
from solidgear.core.judge.bars import ErrorBar
from solidgear.core.judge.completeness import completeness, cut_short, split_apart
from solidgear.core.judge.correlation import correlate
from solidgear.core.judge.deviations import Deviation, deviations
from solidgear.core.judge.hidden import COMPLETE, less_bars
from solidgear.core.judge.lumped import model_facts, model_record
from solidgear.core.judge.quantities import usual
from solidgear.core.judge.record import (
    SCHEMA,
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
    VariantRecord,
    WhereRecord,
)
from solidgear.core.judge.solving import ENOUGH, Answer
from solidgear.core.judge.ties import SCENE
from solidgear.core.judge.verdict import Judgement, judge, percent, trusted
from solidgear.core.judge.where import recorded_places
from solidgear.core.ladder.model import LUMPED, SOLID
from solidgear.core.quantity import FIRST_BENDING
from solidgear.core.solve.mixtures import mixtures
from solidgear.show.remarks import load_case


@dataclass
class Findings:
    """Findings of a comparison so far; an interrupt leaves them whole."""

    solutions: dict[str, Solution] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)  #: why models could not be solved
    causes: list[CauseRecord] = field(default_factory=list)
    lumped: dict[str, LumpedRecord] = field(default_factory=dict)
    guards: list[GuardRecord] = field(default_factory=list)
    where: WhereRecord | None = None  #: of the harmonic solid
    where_solid: WhereRecord | None = None  #: of the first 3D solid
    open_: OpenNumbers = field(default_factory=OpenNumbers)
    complete: bool = True  #: False after an interrupt

    def add_places(self, scene: Scene, solution: Solution) -> None:
        """Add the places of the error of a solid."""
        if solution.model == "harmonic":
            self.where = recorded_places(scene, solution)
        elif self.where_solid is None:
            self.where_solid = recorded_places(scene, solution)


def recorded(scene: Scene, findings: Findings) -> Record:
    """Build the record of a comparison."""
    solutions, guards = findings.solutions, findings.guards
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
        elif why_not := findings.failed.get(model):
            models[model] = ModelRecord(**model_facts(model), valid=False, why_not=why_not)
    ports = _port_records(scene, solutions)
    out = Record(
        complete=findings.complete,
        scene=scene.as_dict(),
        load_case=load_case(scene),
        port=ports[0],
        further_ports=ports[1:],
        attachments={
            model: {tie: _variant_record(answer) for tie, answer in solution.variants.items()}
            for model, solution in solutions.items()
            if solution.variants
        },
        mac=_mac(solutions, reference),
        deviations=[_deviation_record(gap) for gap in gaps],
        causes=findings.causes,
        lumped=findings.lumped,
        verdict=verdict,
        guards=guards,
        where=findings.where,
        where_solid=findings.where_solid,
        open=findings.open_,
        environment=environment(),
        models=models,
        missing=[LADDER[model].title for model in LADDER.fit(scene) if model not in models],
    )
    if out.lumped and reference:
        _add_lumped(out, solutions[reference], scene)
    out.warnings = _warnings(solutions, guards, out.models)
    by = reference or next(reversed(solutions), "")
    if listed := solutions.get(by):
        error_bars = {str(q): bar.width for q, bar in listed.error_bars.get(SCENE, {}).items()}
        shown = [str(mode.name) for mode in listed.modes.modes if mode.frequency_hz > 0]
        out.warnings += number_cautions(scene, {n: error_bars.get(n) for n in shown}, by)
        n = max(scene.ask.modes, ENOUGH)
        out.warnings += cut_short(listed.modes.modes, n, scene.ask.max_frequency)
    return out


def _port_records(scene: Scene, solutions: dict[str, Solution]) -> list[PortRecord]:
    """Return all lumped points; before anything is solved the main one."""
    free: list[list[str]] = [[]]
    if solutions:
        statics = next(iter(solutions.values())).ties[SCENE].statics
        free = [list(at.free_names) for at in (statics.main, *statics.further.values())]
    return [
        PortRecord(
            name=port.name, y=port.y, attachment=port.attachment, order=list(DOF_NAMES), free=names
        )
        for port, names in zip(scene.ports, free)
    ]


def _deviation_record(gap: Deviation) -> DeviationRecord:
    facts = asdict(gap)
    return DeviationRecord(
        band=facts.pop("bar"), **facts, unit=gap.quantity.unit, verdict=gap.verdict
    )


def _warnings(
    solutions: dict[str, Solution], guards: list[GuardRecord], models: dict[str, ModelRecord]
) -> list[str]:
    out = []
    for notice in guards:
        # What speaks against a model that is out anyway is in the record, and nobody's concern.
        about = [m for m in notice.models if m in models and models[m].valid]
        if about or not notice.models:
            titles = ", ".join(models[m].title for m in about)
            out.append(f"{titles}: {notice.sentence}" if about else notice.sentence)
    for model, solution in solutions.items():
        failed = [f"{part}: {reason}" for part, reason in solution.failed.items()]
        out += [f"{LADDER[model].title}: {sentence}" for sentence in failed]
    for model, solution in solutions.items():
        bars = {str(q): bar.width for q, bar in solution.error_bars.get(SCENE, {}).items()}
        sentences = [*split_apart(solution.modes, bars)]
        sentences += [mixture.sentence for mixture in mixtures(solution.modes)]
        out += [f"{LADDER[model].title}: {sentence}" for sentence in sentences]
    return out


def _add_lumped(record: Record, base: Solution, scene: Scene) -> None:
    """Add the lumped model to the models, and the errors of every synthesis only where they are
    asked for.
    """
    bar, tolerance = base.error_bars.get(SCENE, {}).get(FIRST_BENDING), scene.ask.tolerance
    lumped_model = model_record(
        record.lumped,
        record.models,
        base.quantities.get(FIRST_BENDING),
        tolerance,
        bar.width if bar else None,
        record.guards,
    )
    if lumped_model is None:
        return
    (name,) = LADDER.of(LUMPED)
    record.models = {name: lumped_model, **record.models}
    verdict = record.verdict
    source = LADDER[lumped_model.source or name]
    masses = f"{lumped_model.variant} masses on the stiffness of the {source.title}"
    within, only = percent(tolerance), "for first bending and below only"
    if lumped_model.valid and source.family == SOLID:
        verdict.sentences.append(
            f"A {LADDER[name].title} ({masses}) is within {within} too, {only}, and costs as much "
            "as the solid it is made from."
        )
    elif lumped_model.valid:
        verdict.cheapest = name
        verdict.sentences = [s for s in verdict.sentences if not s.startswith("Cheapest model")]
        cheapest = f"{LADDER[name].title} ({masses})"
        verdict.sentences.append(f"Cheapest model within {within}: {cheapest}, {only}.")
    variants = record.lumped[base.model].variants if base.model in record.lumped else {}
    if not variants or verdict.trust is None or not scene.ask.lumped:
        return
    errors = []
    for name, variant in variants.items():
        error = variant.frequency_error
        if variant.feasible and error is not None:
            errors.append(f"{name} exact" if abs(error) < 1e-9 else f"{name} {100 * error:+.2g} %")
    verdict.sentences.append(
        f"First bending of lumped models made from the {LADDER[base.model].title}: "
        f"{', '.join(errors)}."
    )
    if not variants["thesis"].feasible:
        verdict.sentences.append(
            "The thesis's equations 52 and 53 have no usable solution here: "
            f"{variants['thesis'].verdict}."
        )


def _model_record(solution: Solution, judgement: Judgement) -> ModelRecord:
    statics, coupled = solution.ties[SCENE].statics, solution.ties[SCENE].statics.coupled
    bars = solution.error_bars.get(SCENE, {})
    record = ModelRecord(
        **model_facts(solution.model),
        valid=judgement.valid,
        open=judgement.open,
        why_not=judgement.why_not,
        compliance=solution.condensed.compliance,
        stiffness=solution.condensed.stiffness,
        points={name: PointRecord.model_validate(c) for name, c in statics.further.items()},
        modes=[ModeRecord.model_validate(m) for m in solution.modes.modes],
        dofs=solution.body.size,
        seconds=solution.meter.total(),
        peak_mb=solution.meter.peak_mb,
        backend=solution.condensed.evidence["backend"],
        mesh=solution.body.mesh,
        evidence=_evidence(solution, bars),
    )
    if coupled is not None:
        record.coupled = CoupledRecord(
            ports=list(coupled.ports),
            stiffness=coupled.stiffness,
            compliance=coupled.compliance,
            stiffness_error=coupled.evidence["stiffness_error"],
        )
    if bars:
        method = next(iter(bars.values())).method
        record.band = BarSummary(
            compliance=max(
                (bar.width for q, bar in bars.items() if q.kind == COMPLIANCE), default=None
            ),
            method=method,
            each={name: bar.width for name, bar in bars.items()},
        )
        record.convergence = ConvergenceRecord(
            levels=solution.levels,
            quantities={name: _bar_record(bar) for name, bar in bars.items()},
        )
    return record


def _bar_record(bar: ErrorBar) -> BarRecord:
    facts = asdict(bar)
    return BarRecord(gci=facts.pop("width"), **facts)


def _evidence(solution: Solution, bars: Mapping[Quantity, ErrorBar]) -> EvidenceRecord:
    statics = solution.condensed.evidence
    widths = {str(q): bar.width for q, bar in bars.items() if q.is_frequency}
    evidence = less_bars(solution.modes.evidence, widths)
    return EvidenceRecord(
        asymmetry=statics["asymmetry"],
        refinement_residual=statics["residual"],
        rigid_residual=solution.body.rigid_residual(),
        modal_residual=evidence["residual"],
        orthogonality=evidence["orthogonality"],
        eigensolver=evidence["method"],
        mode_count=evidence.get("count", []),
        complete_below_hz=evidence.get(COMPLETE),
        families=evidence.get("families", []),
        complete=completeness(evidence, solution.model) if "count" in evidence else "",
        rigid_modes=evidence["rigid_modes"],
        coupling_bound=evidence["coupling_bound"],
        shift_rad2=float(evidence["shift_rad2"]),
    )


def _variant_record(answer: Answer) -> VariantRecord:
    return VariantRecord(
        quantities=answer.quantities,
        stiffness=answer.statics.main.stiffness,
        compliance=answer.statics.main.compliance,
        modes=[ModeRecord.model_validate(m) for m in answer.modes.modes],
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


def as_record(data: Mapping[str, Any], name: str = "the results") -> Record:
    """Return plain data, such as ``results.json`` has it, as a record; parts may be missing, and data
    without a ``schema`` is taken for current. SolidgearError, which calls it `name`, for data of
    another version of the layout, or data that is no record.

    Examples
    --------
    >>> as_record({"verdict": {"trust": "harmonic"}}).verdict.trust
    'harmonic'
    >>> as_record({"schema": 2}, "out/results.json")
    Traceback (most recent call last):
    solidgear.core.errors.SolidgearError: out/results.json: written by an older version of solidgear (layout 2; this version reads 5); run solidgear compare again
    """
    version = data.get("schema")
    if version is not None and version != SCHEMA:
        older = isinstance(version, int) and version < SCHEMA
        raise SolidgearError(
            f"{name}: written by {'an older' if older else 'another'} version of solidgear "
            f"(layout {version}; this version reads {SCHEMA}); run solidgear compare again"
        )
    try:
        return Record.model_validate(data)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"])
        raise SolidgearError(
            f"{name}: {place} cannot be read ({first['msg']}); run solidgear compare again"
        ) from None
