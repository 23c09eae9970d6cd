"""Many discretisations of one scene, solved and timed in turns, the automatic choice among them.

A time runs from the scene in memory to both answers, compliance at the lumped point and modes, on a
new body; costs that a process pays once (imports, first use of gmsh and MKL) are measured
separately, and each kind of model runs once unmeasured before. The cost of the automatic choice is
the whole climb, every mesh that was tried included; that of the other rows is one mesh, which
nobody has shown to be sufficient.
"""

from __future__ import annotations

import gc
import json
import logging
import math
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from solidgear.comparison.race.race import AUTOMATIC, CHARTED, WHOLE, Race, Reference, Row
from solidgear.core import (
    BEAM,
    LADDER,
    QUANTITIES,
    Body,
    Quantity,
    Scene,
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
from solidgear.core.machine.patience import Patience
from solidgear.core.quantity import FIRST_BENDING
from solidgear.core.solve.condensed import Condensed
from solidgear.core.solve.families import FAMILIES

log = logging.getLogger(__name__)
#: name of the automatic choice among models in rows of a chart, and its tolerances
AUTO = "auto"
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4)
#: s of processor time that a fresh interpreter may take for its imports
SETUP = 120.0
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


def plan(scene: Scene, full: bool = False) -> list[Row]:
    """List series of every family, uniform and graded, level by level, and the automatic choice by
    tolerances; of a model that does not fit the scene one row with the reason. With more levels
    when full, up to solids of several hundred thousand unknowns.
    """
    rows = [
        Row(family, label, level, model.name, options)
        for model in LADDER
        if model.can_model(scene)
        for family, label, all_options in model.series(scene, full)
        for level, options in enumerate(all_options, start=1)
    ]
    for model in LADDER:
        if model.concerns(scene) and (reason := model.unfit(scene)):
            rows.append(Row(model.family, model.heading, 1, model.name, {}, "failed", reason))
    rows += [
        Row(AUTOMATIC, AUTOMATIC, level, AUTO, {"tol": tol})
        for level, tol in enumerate(TOLERANCES, start=1)
    ]
    return sorted(rows, key=lambda row: row.level)


_SETUP = """
import json, time
seconds, start = {}, time.perf_counter()
def lap(name):
    global start
    now = time.perf_counter()
    seconds[name], start = now - start, now
from solidgear.core.machine.threads import pin
pin()
import numpy, scipy.sparse.linalg, scipy.optimize
lap("numpy and scipy")
import solidgear.core.models.harmonic.body, solidgear.core.models.solid.body, solidgear.core.models.beam.body
import solidgear.core.solve.modes, solidgear.core.scene.file
lap("solidgear and scikit-fem")
try:
    import gmsh
    gmsh.initialize(["gmsh", "-noenv"], readConfigFiles=False, interruptible=False)
    lap("gmsh, first use")
    import pypardiso
    pypardiso.PyPardisoSolver(mtype=2)
    lap("MKL, first use")
except Exception:
    pass
print(json.dumps(seconds))
"""


def setup_seconds() -> dict[str, float]:
    """Measure the seconds that a fresh interpreter pays once before the first model, by purpose;
    empty where none can be started.
    """
    try:
        with subprocess.Popen(
            [sys.executable, "-c", _SETUP],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        ) as child:
            assert child.stdout is not None
            Patience(SETUP).wait(child)
            return json.loads(child.stdout.read().splitlines()[-1])
    except (OSError, ValueError, IndexError) as error:
        log.info("set-up costs: %s", error)
        return {}


def race(
    scene: Scene,
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
    rows (:func:`plan`) are filled in, and `keep` is called with the race after every run.

    `budget` (processor time, s) is for the rows; the reference, refined to the relative error bar
    `sure`, is not limited. A level that would not fit in with all its runs, the first of a series
    with one, is left out, but for beams and lumped models, and the cheapest case where no other has
    an answer. After Ctrl-C the finished runs are returned, with ``complete`` False.

    SolidgearError if the reference fails or has none of the charted quantities with an error bar,
    or no row has an answer.
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
            lowest = [row for row in waiting if not any(other.before(row) for other in waiting)]
            row = min(lowest, key=lambda row: _guess(row, result, first))
            _admit(row, result, first, spent())
            if row.status == "waiting":
                timed(row, 0)
        for turn in range(1, runs):
            for row in result.rows:
                if row.status != "ok" or _runs_left(row, runs) <= 0:
                    continue
                if spent() + row.processor_seconds[0] > budget:
                    row.note(f"the budget of {budget:g} s ended after run {len(row.samples)}")
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


def _reference(
    scene: Scene, sure: float, n: int, progress: Callable[[str], None]
) -> tuple[Reference, np.ndarray]:
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
    if model.section_ties:  # beams are of revolution, as it is; section ties ask less of its mesh
        progress("reference with section ties")
        like = answer(scene.with_attachment("section"), model.name, settled.options, n).quantities
    record = Reference(
        model=model.title,
        options=json.loads(json.dumps(settled.options)),
        setting=settled.setting,
        unknowns=reference_answer.body.size,
        seconds=seconds,
        values={q: values[q] for q in have},
        bands={q: settled.bars[q] for q in have},
        like_for_like={q: like[q] for q in have if q in like},
    )
    return record, reference_answer.statics.main.compliance


def _run(scene: Scene, row: Row, n: int, reference: Reference, compliance: np.ndarray) -> None:
    """Run a row once more; the first run fills in the numbers."""
    gc.collect()
    start, began = time.perf_counter(), processor_seconds()
    try:
        result = answer(scene, row.model, row.options, n)
    except Exception as error:  # whatever stops a model is a finding about it, and the others go on
        row.samples = [time.perf_counter() - start]
        known = isinstance(error, SolidgearError)
        row.status, row.reason = (
            "failed",
            str(error) if known else f"{type(error).__name__}: {error}",
        )
        if isinstance(error, MemoryError):
            row.reason = "not enough memory"
        log.info("%s, level %d: %s", row.series, row.level, row.reason, exc_info=not known)
        return
    row.samples.append(time.perf_counter() - start)
    row.processor_seconds.append(processor_seconds() - began)
    if row.status == "ok":
        return
    row.status, values = "ok", result.quantities
    row.unknowns = 6 if row.family == LUMPED else result.body.size
    row.values = {q: values[q] for q in reference.values if q in values}
    row.errors = {q: abs(values[q] / v - 1) for q, v in reference.values.items() if q in values}
    if row.family in CHEAP and reference.like_for_like:
        like = answer(scene.with_attachment("section"), row.model, row.options, n).quantities
        row.like_for_like = {
            q: abs(like[q] / v - 1) for q, v in reference.like_for_like.items() if q in like
        }
    missing = [q for q in reference.values if q not in values]
    if missing:
        row.note(f"found no {' and no '.join(missing)}")
    compliance_error = scaled_error(result.statics.main.compliance, compliance)
    if compliance_error is not None:
        row.errors[WHOLE] = compliance_error


def _kind(row: Row) -> tuple:
    return row.model, row.options.get("element"), row.options.get("order", 0) > 2


def _warm_up(
    scene: Scene,
    chart: Race,
    n: int,
    progress: Callable[[str], None],
    spent: Callable[[], float],
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
    times = [r.processor_seconds[0] for r in chart.rows if r.before(row) and r.status == "ok"]
    growth = min(max(times[-1] / times[-2], 1.5), 10.0) if len(times) > 1 else GROWTH
    return times[-1] * growth if times else first.get(_kind(row), 0.0)


def _admit(row: Row, chart: Race, first: dict[tuple, float], spent: float) -> None:
    """Leave a row out if the budget would not suffice for it beside all runs of all admitted rows;
    the cheapest is kept where no other has an answer.
    """
    if any(r.status == "left out" for r in chart.rows if r.before(row)):
        row.status, row.reason = "left out", "the level before it was left out"
        return
    cheap = any(r.family in CHEAP and r.status == "waiting" for r in chart.rows)
    if row.family in CHEAP or not (cheap or any(r.status == "ok" for r in chart.rows)):
        return
    guess = _guess(row, chart, first)
    solved = [r for r in chart.rows if r.status == "ok"]
    owed = sum(r.processor_seconds[0] * _runs_left(r, chart.runs) for r in solved)
    # a series with one point, run once, is worth more than further runs of others
    runs = 1 if row.level == 1 else _most_runs(guess, chart.runs)
    if spent + owed + guess * runs > chart.budget:
        row.status = "left out"
        row.reason = f"it does not fit into the budget of {chart.budget:g} s" + (
            f" (about {guess:.2g} s a run)" if math.isfinite(guess) else ""
        )


def _most_runs(seconds: float, runs: int) -> int:
    return next((min(most, runs) for limit, most in FEWER_RUNS if seconds > limit), runs)


def _runs_left(row: Row, runs: int) -> int:
    return _most_runs(row.processor_seconds[0], runs) - len(row.processor_seconds)


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
