"""The lumped model of a comparison: every synthesis from every body, and the one that stands for
them.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from solidgear.body import as_supports
from solidgear.body.mode_names import ModeName
from solidgear.errors import SolidgearError
from solidgear.judge.deviations import BEYOND, OPEN, gap_verdict
from solidgear.judge.record import GuardRecord, LumpedRecord, LumpedVariant, ModelRecord, ModeRecord
from solidgear.judge.verdict import Judgement, spoken_against
from solidgear.ladder.model import BEAM, LUMPED, SOLID
from solidgear.ladder.registry import LADDER
from solidgear.reduction.effective_mass import Synthesis, synthesise

if TYPE_CHECKING:
    from solidgear.judge.solution import Solution
    from solidgear.scene import Scene

#: variants that may stand for the lumped model, the preferred one first
PREFERRED = ("mode-matched", "guyan")


def synthesise_all(
    scene: Scene, solutions: Mapping[str, Solution], tell: Callable[[str], None] = lambda _: None
) -> dict[str, LumpedRecord]:
    """Lumped models of every solved body, by model; stiffness and first bending are those of the z plane."""
    out: dict[str, LumpedRecord] = {}
    for model, solution in solutions.items():
        start = time.perf_counter()
        try:
            supports = as_supports(scene).on_stations(scene.stations)
            point, found = synthesise(solution.body, supports, scene.port.name, solution.modes)
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
                for name, s in found.items()
            },
        )
    return out


def sources() -> tuple[str, ...]:
    """Models whose bodies the lumped one may rest on, the usual one of a lumped-parameter program
    first: the best beam.
    """
    return (*reversed(LADDER.of(BEAM)), *LADDER.of(SOLID))


def representative(lumped: Mapping[str, LumpedRecord]) -> tuple[str, str] | None:
    """(source model, variant) that stands for the lumped model."""
    for source in sources():
        variant = preferred(lumped[source].variants) if source in lumped else None
        if variant is not None:
            return source, variant
    return None


def preferred(made: Mapping[str, Synthesis] | Mapping[str, LumpedVariant]) -> str | None:
    """The variant that stands for the lumped model: mode-matched where it is physical and holds the
    mode as its first, else Guyan; None where neither does.
    """
    good = (name for name in PREFERRED if name in made and made[name].feasible and made[name].first)
    return next(good, None)


def drawn(model: str) -> dict[str, str]:
    """Facts of a model that a record keeps: its names, what it solves, and how charts draw it."""
    known = LADDER[model]
    return {
        "title": known.title,
        "short": known.heading,
        "theory": known.theory,
        "family": known.family,
        "colour": known.colour,
        "marker": known.marker,
    }


def model_record(
    lumped: Mapping[str, LumpedRecord],
    models: Mapping[str, ModelRecord],
    reference_hz: float | None,
    tolerance: float,
    bar: float | None,
    notices: Iterable[GuardRecord] = (),
) -> ModelRecord | None:
    """Record of the lumped model among the others; its stiffness is its source's.

    Parameters
    ----------
    reference_hz : float or None
        First bending of the reference model.
    bar : float or None
        Of the reference's first bending; None where nothing may judge.
    """
    chosen = representative(lumped)
    if chosen is None:
        return None
    source, variant = chosen
    base, made = models[source], lumped[source]
    own = made.variants[variant]
    judged = _judged(own, base, made, source, reference_hz, tolerance, bar, notices)
    # The price of its source comes first: there is no lumped model without a body to condense.
    seconds = {k: base.seconds.get(k) or 0.0 for k in ("build", "statics", "modes")}
    seconds["synthesis"] = made.seconds or 0.0
    seconds["total"] = sum(seconds.values())
    return ModelRecord(
        **drawn(*LADDER.of(LUMPED)),
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
                frequency_hz=own.frequency_hz,
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
    own: LumpedVariant,
    base: ModelRecord,
    made: LumpedRecord,
    source: str,
    reference_hz: float | None,
    tolerance: float,
    bar: float | None,
    notices: Iterable[GuardRecord],
) -> Judgement:
    """Judge the lumped model by its source's stiffness and its own first bending."""
    if not base.valid:
        state = base.why_not if base.open else f"which is out: {base.why_not}"
        why = f"its stiffness is that of the {LADDER[source].title}, {state}"
        return Judgement(False, why, open=base.open)
    if against := spoken_against("lumped", notices):
        return Judgement(False, against[0])
    if not reference_hz or bar is None or own.frequency_hz is None or made.frequency_hz is None:
        why = "not judged: there is no first bending of a trusted model to hold it against"
        return Judgement(False, why, open=True)
    gap = own.frequency_hz / reference_hz - 1
    kind = gap_verdict(gap, bar, tolerance)
    if kind == BEYOND:
        why = (
            f"its first bending is {100 * gap:+.1f} % off, "
            f"more than the {100 * tolerance:g} % asked for"
        )
        lowest = made.frequency_hz / reference_hz - 1
        if gap_verdict(lowest, bar, tolerance) == BEYOND:
            why += (
                ": masses are lumped in the z plane, and the first bending of this shaft "
                "is not in it"
            )
        return Judgement(False, why)
    if kind == OPEN:
        why = (
            f"not judged: its first bending is {100 * gap:+.1f} % off, and with the error bar of the "
            f"reference that may be more or less than the {100 * tolerance:g} % asked for"
        )
        return Judgement(False, why, open=True)
    return Judgement(True)
