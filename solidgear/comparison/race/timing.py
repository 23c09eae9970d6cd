"""Many discretisations of one scene, solved and timed in turns.

A time runs from the scene in memory to both answers, compliance at the lumped point and modes, on a
new body; costs that a process pays once (imports, first use of gmsh and MKL) are measured
separately, and each kind of model runs once unmeasured before.

Answers of the rows of a chart of error against cost, the automatic choice among them.

The cost of the automatic choice is the whole climb, every mesh that was tried included; that of the
other rows is one mesh, which nobody has shown to be sufficient.
"""

from __future__ import annotations

import gc
import json
import logging
import math
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.comparison.race.cases import AUTO
from solidgear.comparison.race.pareto import CHARTED, Race, Row
from solidgear.core import (
    BEAM,
    FIRST_BENDING,
    LADDER,
    QUANTITIES,
    Condensed,
    Quantity,
    SolidgearError,
    settle,
    synthesise,
)
from solidgear.core.judge.answer import solve_cheapest
from solidgear.core.judge.lumped import preferred, sources
from solidgear.core.judge.question import FamilySolver, build_families
from solidgear.core.judge.refinement import Refinement
from solidgear.core.judge.solving import Answer, Statics, solve
from solidgear.core.ladder.model import LUMPED
from solidgear.core.machine.meter import processor_seconds
from solidgear.core.solve.families import FAMILIES

if TYPE_CHECKING:
    from solidgear.core import Body, Scene


log = logging.getLogger(__name__)
#: relative error bar of the reference, below the gaps between models; one of a millionth
#: takes minutes on a shaft of ten edges
SURE, FULL_SURE = 3e-4, 1e-6
#: s of processor time for the points, the same number of them on a busy machine as on an idle one;
#: with the reference a chart of a common shaft is there in four minutes
BUDGET, FULL_BUDGET = 120.0, 3600.0
#: a case above these s of processor time gets no more runs than that
FEWER_RUNS = ((20.0, 1), (8.0, 3))
#: families that run once whatever the budget
CHEAP = (LUMPED, BEAM)
#: cost of the next level over the last one, before a series has shown its own growth
GROWTH = 3.0


def race(
    scene,
    rows: list[Row],
    *,
    runs: int = 5,
    budget: float = BUDGET,
    sure: float | None = None,
    setup: dict[str, float] | None = None,
    progress: Callable[[str], None] = lambda _: None,
    keep: Callable[[Race], None] = lambda _: None,
) -> Race:
    """Solve a scene in many ways, in turns, so that a noisy spell of the machine hits all equally;
    rows (:func:`solidgear.comparison.race.cases.plan`) are filled in. After Ctrl-C the finished runs are
    returned, with ``complete`` False.

    Parameters
    ----------
    runs : int
        Of each case; cases above 8 s of processor time get at most three, above 20 s one.
    budget : float
        Seconds of processor time for the rows; the reference is not limited. A level that would not
        fit in with all its runs, the first of a series with one, is left out, but for beams and
        lumped models, and the cheapest case where no other has an answer.
    sure : float, optional
        Relative error bar that the reference is refined to; 3e-4 by default.
    setup : dict of str to float, optional
        Start-up costs of a process, for the record.
    keep : callable
        Called with the race after every run, for writing it down.

    Raises
    ------
    SolidgearError
        If the reference fails or has none of the charted quantities with an error bar, or no row
        has an answer.
    """
    start = time.perf_counter()
    n = max(scene.ask.modes, 10)
    reference, compliance = _reference(scene, sure or SURE, n, progress)
    result = Race(
        scene=json.loads(json.dumps(scene.as_dict())),
        reference=reference,
        rows=rows,
        setup=setup or {},
        runs=runs,
        modes=n,
        budget=budget,
    )

    began = processor_seconds()

    def spent() -> float:
        result.seconds = time.perf_counter() - start
        return processor_seconds() - began

    def timed(row: Row, turn: int) -> None:
        progress(f"run {turn + 1} of {runs}: {row.series}, level {row.level}")
        _run(scene, row, n, reference, compliance)
        spent()
        keep(result)

    try:
        first = _warm_up(scene, result, n, progress, spent)
        while waiting := [row for row in result.rows if row.status == "waiting"]:
            # Cheapest first, so that one large solid does not use up the budget of many small
            # models.
            row = min(
                (
                    r
                    for r in waiting
                    if not any(w.series == r.series and w.level < r.level for w in waiting)
                ),
                key=lambda r: _guess(r, result, first),
            )
            _admit(row, result, first, spent())
            if row.status == "waiting":
                timed(row, 0)
        for turn in range(1, runs):
            for row in result.rows:
                if row.status != "ok" or len(row.processor_seconds) >= _most_runs(
                    row.processor_seconds[0], runs
                ):
                    continue
                if spent() + row.processor_seconds[0] > budget:
                    _note(row, f"the budget of {budget:g} s ended after run {len(row.samples)}")
                else:
                    timed(row, turn)
    except KeyboardInterrupt:
        result.complete = False
        progress("interrupted; keeping what is there")
        for row in result.rows:
            if row.status == "waiting":
                row.status, row.reason = "left out", "interrupted"
    spent()
    keep(result)
    if result.complete and not any(row.status == "ok" for row in result.rows):
        reason = next((row.reason for row in result.rows), "no case was given")
        raise SolidgearError(f"nothing to chart: no case has an answer; the first: {reason}")
    return result


def scaled_error(compliance: np.ndarray, reference: np.ndarray) -> float | None:
    """Return the largest ``|dC_ij| / sqrt(C_ii C_jj)`` over the motions that something resists in
    both; None if there are none.
    """
    keep = np.isfinite(np.diag(compliance)) & np.isfinite(np.diag(reference))
    if not keep.any():
        return None
    a, b = compliance[np.ix_(keep, keep)], reference[np.ix_(keep, keep)]
    size = np.sqrt(np.diag(b))
    return float(np.abs((a - b) / np.outer(size, size)).max())


def _reference(scene, sure: float, n: int, progress) -> tuple[dict, np.ndarray]:
    """Solve the model that judges the scene, refined to an error bar; return the record and the
    compliance.
    """
    progress(f"reference: refined to an error bar of {sure:g}")
    settled = settle(scene, sure, progress=progress)
    model = LADDER[settled.rung]
    start = time.perf_counter()
    reference_answer = answer(scene, model.name, settled.options, n)
    seconds, values = time.perf_counter() - start, reference_answer.quantities
    have = [q for q in CHARTED if q in values and math.isfinite(settled.bars.get(q, math.inf))]
    if not have:
        raise SolidgearError(
            f"nothing to chart: the reference, the {model.title}, has neither "
            f"{' nor '.join(CHARTED)} at port {scene.port.name!r} with an error bar (bearings "
            "must resist z there)"
        )
    like: dict[Quantity, float] = {}
    if model.bounded:  # beams are of revolution, as it is; section ties ask less of its mesh
        progress("reference with section ties")
        like = answer(scene.with_attachment("section"), model.name, settled.options, n).quantities
    record = {
        "model": model.title,
        "options": json.loads(json.dumps(settled.options)),
        "setting": settled.setting,
        "unknowns": reference_answer.body.size,
        "seconds": seconds,
        "values": {q: values[q] for q in have},
        "bands": {q: settled.bars[q] for q in have},
        "like_for_like": {q: like[q] for q in have if q in like},
    }
    return record, reference_answer.statics.main.compliance


def _run(scene, row: Row, n: int, reference: dict, compliance: np.ndarray) -> None:
    """Run a row once more; the first run fills in the numbers."""
    gc.collect()
    start, began = time.perf_counter(), processor_seconds()
    try:
        result = answer(scene, row.model, row.options, n)
    except Exception as error:  # whatever stops a model is a finding about it, and the others go on
        row.samples = [time.perf_counter() - start]
        row.status, row.reason = "failed", _failure(error)
        log.info(
            "%s, level %d: %s",
            row.series,
            row.level,
            row.reason,
            exc_info=not isinstance(error, SolidgearError),
        )
        return
    row.samples.append(time.perf_counter() - start)
    row.processor_seconds.append(processor_seconds() - began)
    if row.status == "ok":
        return
    row.status, values = "ok", result.quantities
    row.unknowns = 6 if row.family == LUMPED else result.body.size
    row.values = {q: values[q] for q in reference["values"] if q in values}
    row.errors = {q: abs(v / reference["values"][q] - 1) for q, v in row.values.items()}
    if row.family in CHEAP and reference["like_for_like"]:
        like = answer(scene.with_attachment("section"), row.model, row.options, n).quantities
        row.like_for_like = {
            q: abs(like[q] / v - 1) for q, v in reference["like_for_like"].items() if q in like
        }
    missing = [q for q in reference["values"] if q not in values]
    if missing:
        _note(row, f"found no {' and no '.join(missing)}")
    compliance_error = scaled_error(result.statics.main.compliance, compliance)
    if compliance_error is not None:
        row.errors["C 6x6"] = compliance_error


def _failure(error: Exception) -> str:
    if isinstance(error, SolidgearError):
        return str(error)
    if isinstance(error, MemoryError):
        return "not enough memory"
    return f"{type(error).__name__}: {error}"


def _note(row: Row, text: str) -> None:
    if text not in row.reason:
        row.reason = "; ".join(t for t in (row.reason, text) if t)


def _kind(row: Row) -> tuple:
    return row.model, row.options.get("element"), row.options.get("order", 0) > 2


def _warm_up(
    scene, chart: Race, n: int, progress, spent: Callable[[], float]
) -> dict[tuple, float]:
    """Run the first case of every kind once, outside the rows: first calls pay for imports and
    caches; return processor seconds by kind, infinite for those that half the budget does not
    reach.
    """
    first: dict[tuple, float] = {}
    for row in chart.rows:
        if row.status != "waiting" or _kind(row) in first:
            continue
        if row.family not in CHEAP and spent() > chart.budget / 2:
            first[_kind(row)] = math.inf
            continue
        progress(f"warm-up: {row.series}")
        began = processor_seconds()
        try:
            answer(scene, row.model, row.options, n)
        except Exception as error:  # reported when its own turn comes
            log.debug("warm-up of %s: %s", row.series, error)
        first[_kind(row)] = processor_seconds() - began
    return first


def _guess(row: Row, chart: Race, first: dict[tuple, float]) -> float:
    """Estimate the processor seconds of one run of a row, from the levels before it in the series;
    the first level costs as much as the warm-up of that kind did.
    """
    times = [
        r.processor_seconds[0]
        for r in chart.rows
        if r.series == row.series and r.level < row.level and r.status == "ok"
    ]
    growth = min(max(times[-1] / times[-2], 1.5), 10.0) if len(times) > 1 else GROWTH
    return times[-1] * growth if times else first.get(_kind(row), 0.0)


def _admit(row: Row, chart: Race, first: dict[tuple, float], spent: float) -> None:
    """Leave a row out if the budget would not suffice for it beside all runs of all admitted rows;
    the cheapest is kept where no other has an answer.
    """
    if any(
        r.status == "left out" for r in chart.rows if r.series == row.series and r.level < row.level
    ):
        row.status, row.reason = "left out", "the level before it was left out"
        return
    cheap = any(r.family in CHEAP and r.status == "waiting" for r in chart.rows)
    if row.family in CHEAP or not (cheap or any(r.status == "ok" for r in chart.rows)):
        return
    guess = _guess(row, chart, first)
    owed = sum(
        r.processor_seconds[0]
        * (_most_runs(r.processor_seconds[0], chart.runs) - len(r.processor_seconds))
        for r in chart.rows
        if r.status == "ok"
    )
    # a series with one point, run once, is worth more than further runs of others
    runs = 1 if row.level == 1 else _most_runs(guess, chart.runs)
    if spent + owed + guess * runs > chart.budget:
        row.status = "left out"
        row.reason = f"it does not fit into the budget of {chart.budget:g} s" + (
            f" (about {guess:.2g} s a run)" if math.isfinite(guess) else ""
        )


def _most_runs(seconds: float, runs: int) -> int:
    return next((min(most, runs) for limit, most in FEWER_RUNS if seconds > limit), runs)


def answer(scene: Scene, model: str, options: dict, n: int) -> Answer:
    """Return the answer of one model, or of the automatic choice; SolidgearError where the model
    cannot be made.
    """
    if model == AUTO:
        return _automatic(scene, options["tol"])
    if LADDER[model].family == LUMPED:
        return _lumped(scene, options, n)
    return solve(scene, model, n, **options)


def _lumped(scene: Scene, options: dict, n: int) -> Answer:
    """Answer with the lumped model on the best beam, by its first bending."""
    beam_answer = solve(scene, sources()[0], n, **options)
    _, variants = synthesise(beam_answer.body, scene, scene.port.name, beam_answer.modes)
    chosen = preferred(variants)
    hertz = None if chosen is None else variants[chosen].frequency_hz
    if hertz is None:
        raise SolidgearError(
            "no lumped mass is positive and has the first bending mode as its first"
        )
    return replace(beam_answer, quantities=beam_answer.quantities | {FIRST_BENDING: hertz})


def _automatic(scene: Scene, tol: float) -> Answer:
    """Answer with the automatic choice, with the largest body of it: the last one may be that of a
    small question, torsion alone, and a chart over unknowns would take its size for that of the
    whole answer.
    """
    largest: Body | None = None

    def solver_of(refinement: Refinement) -> FamilySolver:
        nonlocal largest
        largest = None  # of this model

        def build_body(options: Mapping[str, Any], families: tuple[str, ...] | None) -> Body:
            nonlocal largest
            body = build_families(scene, refinement.model, options, families)
            if largest is None or body.size > largest.size:
                largest = body
            return body

        return FamilySolver(refinement, build_body)

    solver, _ = solve_cheapest(scene, tol, QUANTITIES, lambda _: None, solver_of)
    assert largest is not None and solver.modes is not None  # all quantities were wanted
    values = {v.quantity: v.value for v in solver.refinement.values()}
    return Answer(largest, Statics(_together(solver)), solver.modes, values)


def _together(solver: FamilySolver) -> Condensed:
    """Return the compliance of all families, each on the finest mesh that was solved for it."""
    coarse, *finer = solver.compliances.items()
    compliance = coarse[1].compliance.copy()
    for families, condensed in finer:
        components = [c for family in families for c in FAMILIES[family]]
        entries = np.ix_(components, components)
        compliance[entries] = condensed.compliance[entries]
    return replace(coarse[1], compliance=compliance)
