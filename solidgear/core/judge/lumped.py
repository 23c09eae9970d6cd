"""Lumped model of a comparison: every synthesis from every body, and the representative one."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.body import as_supports
from solidgear.core.body.mode_names import ModeName
from solidgear.core.errors import SolidgearError
from solidgear.core.judge.deviations import BEYOND, OPEN, gap_verdict
from solidgear.core.judge.record import (
    GuardRecord,
    LumpedRecord,
    LumpedVariant,
    ModelRecord,
    ModeRecord,
)
from solidgear.core.judge.verdict import Judgement, objections
from solidgear.core.ladder.model import BEAM, LUMPED, SOLID
from solidgear.core.ladder.registry import LADDER
from solidgear.core.reduction.effective_mass import Synthesis, synthesise

if TYPE_CHECKING:
    from solidgear.core.judge.solution import Solution
    from solidgear.core.scene import Scene

#: variants that may stand for the lumped model, the preferred one first
PREFERRED = ("mode-matched", "guyan")


def synthesise_all(
    scene: Scene, solutions: Mapping[str, Solution], tell: Callable[[str], None] = lambda _: None
) -> dict[str, LumpedRecord]:
    """Synthesise lumped models of every solved body, by model; stiffness and first bending are
    those of the z plane.
    """
    out: dict[str, LumpedRecord] = {}
    for model, solution in solutions.items():
        start = time.perf_counter()
        try:
            supports = as_supports(scene).on_stations(scene.stations)
            point, variants = synthesise(solution.body, supports, scene.port.name, solution.modes)
        except SolidgearError as error:
            tell(f"lumped from {model}: {error}")
            out[model] = LumpedRecord(why_not=str(error))
            continue
        out[model] = LumpedRecord(
            stiffness=point.stiffness,
            motion=point.motion,
            frequency_hz=point.omega / (2 * np.pi),
            static_share=point.static_share,
            total_mass=point.total_mass,
            seconds=time.perf_counter() - start,
            variants={
                name: LumpedVariant.model_validate(s).model_copy(update=s.numbers)
                for name, s in variants.items()
            },
        )
    return out


def sources() -> tuple[str, ...]:
    """Return the models whose bodies the lumped one may rest on, the usual one of a
    lumped-parameter program first: the best beam.
    """
    return (*reversed(LADDER.of(BEAM)), *LADDER.of(SOLID))


def representative(lumped: Mapping[str, LumpedRecord]) -> tuple[str, str] | None:
    """Return the (source model, variant) that represents the lumped model."""
    for source in sources():
        variant = preferred(lumped[source].variants) if source in lumped else None
        if variant is not None:
            return source, variant
    return None


def preferred(variants: Mapping[str, Synthesis] | Mapping[str, LumpedVariant]) -> str | None:
    """Return the variant that represents the lumped model: mode-matched where it is physical and
    gives the mode as the first, else Guyan; None where neither does.
    """
    good = (
        name
        for name in PREFERRED
        if name in variants and variants[name].feasible and variants[name].first
    )
    return next(good, None)


def model_facts(model: str) -> dict[str, str]:
    """Return facts of a model that a record keeps: names, theory, family, and how charts draw it."""
    ladder_model = LADDER[model]
    return {
        "title": ladder_model.title,
        "short": ladder_model.heading,
        "theory": ladder_model.theory,
        "family": ladder_model.family,
        "colour": ladder_model.colour,
        "marker": ladder_model.marker,
    }


def model_record(
    lumped: Mapping[str, LumpedRecord],
    models: Mapping[str, ModelRecord],
    reference_hz: float | None,
    tolerance: float,
    bar: float | None,
    notices: Iterable[GuardRecord] = (),
) -> ModelRecord | None:
    """Build the record of the lumped model, with the stiffness of the source model; `reference_hz`
    is the first bending of the reference model, and `bar` the error bar of it, None where nothing
    may judge.
    """
    chosen = representative(lumped)
    if chosen is None:
        return None
    source, variant = chosen
    base, lumped_record = models[source], lumped[source]
    lumped_variant = lumped_record.variants[variant]
    judged = _judged(
        lumped_variant, base, lumped_record, source, reference_hz, tolerance, bar, notices
    )
    # The price of its source comes first: there is no lumped model without a body to condense.
    seconds = {k: base.seconds.get(k) or 0.0 for k in ("build", "statics", "modes")}
    seconds["synthesis"] = lumped_record.seconds or 0.0
    seconds["total"] = sum(seconds.values())
    return ModelRecord(
        **model_facts(*LADDER.of(LUMPED)),
        valid=judged.valid,
        open=judged.open,
        why_not=judged.why_not,
        source=source,
        variant=variant,
        compliance=base.compliance,
        stiffness=base.stiffness,
        points=base.points,
        coupled=base.coupled,
        modes=[
            ModeRecord(
                name=ModeName("bending 1"),
                family="bending",
                frequency_hz=lumped_variant.frequency_hz,
                multiplicity=2,
                captured=None,
            )
        ],
        dofs=6,
        seconds=seconds,
        peak_mb=base.peak_mb,
        backend=base.backend,
        mesh={"element": f"{variant} masses on the stiffness of the {LADDER[source].title}"},
    )


def _judged(
    variant: LumpedVariant,
    base: ModelRecord,
    lumped_record: LumpedRecord,
    source: str,
    reference_hz: float | None,
    tolerance: float,
    bar: float | None,
    notices: Iterable[GuardRecord],
) -> Judgement:
    """Judge the lumped model by the stiffness of the source model and by the first bending."""
    if not base.valid:
        state = base.why_not if base.open else f"which is not valid: {base.why_not}"
        reason = f"it has the stiffness of the {LADDER[source].title}, {state}"
        return Judgement(False, reason, open=base.open)
    if against := objections("lumped", notices):
        return Judgement(False, against[0])
    if (
        not reference_hz
        or bar is None
        or variant.frequency_hz is None
        or lumped_record.frequency_hz is None
    ):
        reason = "not judged: no trusted model has a first bending mode"
        return Judgement(False, reason, open=True)
    gap = variant.frequency_hz / reference_hz - 1
    kind = gap_verdict(gap, bar, tolerance)
    if kind == BEYOND:
        reason = (
            f"its first bending is {100 * gap:+.1f} % off, "
            f"more than the {100 * tolerance:g} % asked for"
        )
        lowest = lumped_record.frequency_hz / reference_hz - 1
        if gap_verdict(lowest, bar, tolerance) == BEYOND:
            reason += ": masses are lumped in the z plane, and this shaft first bends in another"
        return Judgement(False, reason)
    if kind == OPEN:
        reason = (
            f"not judged: its first bending is {100 * gap:+.1f} % off, and with the reference's "
            f"error bar may or may not be within the {100 * tolerance:g} % asked for"
        )
        return Judgement(False, reason, open=True)
    return Judgement(True)
