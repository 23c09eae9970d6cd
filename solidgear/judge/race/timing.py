"""Many discretisations of one scene, solved and timed in turns.

A time runs from the scene in memory to both answers, compliance at the lumped point and modes, on a
new body; what a process pays once (imports, first use of gmsh and MKL) is measured apart, and each
kind of model runs once unmeasured before.
"""

from __future__ import annotations

import gc
import json
import logging
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.judge.lumped import preferred, sources
from solidgear.judge.race.pareto import CHARTED, Race, Row
from solidgear.judge.settle import settle
from solidgear.judge.solving import Answer, solve
from solidgear.ladder.model import BEAM, LUMPED
from solidgear.ladder.registry import LADDER
from solidgear.quantity import FIRST_BENDING
from solidgear.reduction.effective_mass import synthesise

log = logging.getLogger(__name__)
#: relative error bar of the reference
SURE = 1e-6
#: good to about 3e-5, far below the error of any beam
LIKE_FOR_LIKE = {"order": 4, "layers": 3, "edge_layers": 1}
BUDGET, FULL_BUDGET = 240.0, 3600.0
#: a case above these seconds gets no more runs than that
FEWER_RUNS = ((20.0, 1), (8.0, 3))
#: cost of the next level over the last one, before a series has shown its own growth
GROWTH = 3.0


#: solves a scene as a row asks for it: scene, name of the model, its options, elastic shapes
Solve = Callable[[Any, str, dict, int], Answer]


def race(
    scene,
    rows: list[Row],
    *,
    solver: Solve | None = None,
    runs: int = 5,
    budget: float = BUDGET,
    sure: float | None = None,
    setup: dict[str, float] | None = None,
    progress: Callable[[str], None] = lambda _: None,
    keep: Callable[[Race], None] = lambda _: None,
) -> Race:
    """Solve a scene in many ways, in turns, so that a noisy spell of the machine hits all alike.

    Parameters
    ----------
    scene : Scene
    rows : list of Row
        Such as :func:`solidgear.judge.race.cases.plan` makes; they are filled in.
    solver : callable, optional
        Of the rows, where they have models that the ladder does not know; by default
        :func:`answer`.
    runs : int
        Of each case; cases above 8 s get at most three, above 20 s one.
    budget : float
        Seconds for all, the reference included.  A level that would not fit in with all its runs is left out.
    sure : float, optional
        Relative error bar that the reference is refined to; 1e-6 by default.
    setup : dict of str to float, optional
        What a process pays once, for the record.
    progress : callable
        Told in words what is going on.
    keep : callable
        Given the race after every run, for writing it down.

    Returns
    -------
    Race
        After Ctrl-C with what there was, ``complete`` False.

    Raises
    ------
    SolidgearError
        If ``runs`` or ``budget`` are not positive, or the reference fails or has none of the
        charted quantities.
    """
    if runs < 1:
        raise SolidgearError(f"runs = {runs} is not usable; give a whole number of at least 1")
    if not budget > 0 or not np.isfinite(budget):
        raise SolidgearError(f"budget = {budget:g} is not usable; give seconds above 0")
    start = time.perf_counter()
    solver = solver or answer
    n = max(scene.ask.modes, 10)
    against, compliance = _reference(scene, sure or SURE, n, progress)
    found = Race(
        json.loads(json.dumps(scene.as_dict())), against, rows, setup or {}, runs, n, budget
    )

    def spent() -> float:
        found.seconds = time.perf_counter() - start
        return found.seconds

    def timed(row: Row, turn: int) -> None:
        progress(f"run {turn + 1} of {runs}: {row.series}, level {row.level}")
        _run(scene, row, n, against, compliance, solver)
        spent()
        keep(found)

    try:
        first = _warm_up(scene, found.rows, n, progress, solver)
        while waiting := [row for row in found.rows if row.status == "waiting"]:
            # Cheapest first, so that one large solid does not use up the budget of many small
            # models.
            row = min(
                (
                    r
                    for r in waiting
                    if not any(w.series == r.series and w.level < r.level for w in waiting)
                ),
                key=lambda r: _guess(r, found, first),
            )
            _admit(row, found, first, spent())
            if row.status == "waiting":
                timed(row, 0)
        for turn in range(1, runs):
            for row in found.rows:
                if row.status != "ok" or len(row.samples) >= _most_runs(row.samples[0], runs):
                    continue
                if spent() + row.samples[0] > budget:
                    _note(row, f"the budget of {budget:g} s ended after run {len(row.samples)}")
                else:
                    timed(row, turn)
    except KeyboardInterrupt:
        found.complete = False
        progress("interrupted; keeping what is there")
        for row in found.rows:
            if row.status == "waiting":
                row.status, row.reason = "left out", "interrupted"
    spent()
    keep(found)
    return found


def answer(scene, model: str, options: dict, n: int) -> Answer:
    """Answer of one model; the lumped one rests on the best beam, and has a first bending of its
    own.

    Raises
    ------
    SolidgearError
        Where the model cannot be made.
    """
    if LADDER[model].family != LUMPED:
        return solve(scene, model, n, **options)
    found = solve(scene, sources()[0], n, **options)
    _, made = synthesise(found.body, scene, scene.port.name, found.modes)
    chosen = preferred(made)
    if chosen is None or chosen.frequency_hz is None:
        raise SolidgearError(
            "no lumped mass is positive and has the first bending mode as its first"
        )
    return replace(found, quantities={**found.quantities, FIRST_BENDING: chosen.frequency_hz})


def scaled_error(compliance: np.ndarray, reference: np.ndarray) -> float | None:
    """Largest ``|dC_ij| / sqrt(C_ii C_jj)`` over the motions that something resists in both; None
    if there are none.
    """
    keep = np.isfinite(np.diag(compliance)) & np.isfinite(np.diag(reference))
    if not keep.any():
        return None
    a, b = compliance[np.ix_(keep, keep)], reference[np.ix_(keep, keep)]
    size = np.sqrt(np.diag(b))
    return float(np.abs((a - b) / np.outer(size, size)).max())


def _reference(scene, sure: float, n: int, progress) -> tuple[dict, np.ndarray]:
    """Record of the harmonic solid refined to an error bar, and its compliance."""
    progress("reference: refined harmonic solid")
    made = settle(scene, sure, progress=progress)
    start = time.perf_counter()
    found = answer(scene, "harmonic", made.options, n)
    seconds, values = time.perf_counter() - start, found.quantities
    have = [q for q in CHARTED if q in values and q in made.bars]
    if not have:
        raise SolidgearError(
            f"nothing to chart: the reference has neither {' nor '.join(CHARTED)} at port "
            f"{scene.port.name!r} (bearings must resist z there)"
        )
    progress("reference with section ties")
    like = answer(scene.with_attachment("section"), "harmonic", LIKE_FOR_LIKE, n).quantities
    record = {
        "options": json.loads(json.dumps(made.options)),
        "setting": made.setting,
        "unknowns": found.body.size,
        "seconds": seconds,
        "values": {q: values[q] for q in have},
        "bands": {q: made.bars[q] for q in have},
        "like_for_like": {q: like[q] for q in have if q in like},
        "like_for_like_options": LIKE_FOR_LIKE,
    }
    return record, found.condensed.compliance


def _run(scene, row: Row, n: int, against: dict, compliance: np.ndarray, solver: Solve) -> None:
    """One more run of a row; the first fills in its numbers."""
    gc.collect()
    start = time.perf_counter()
    try:
        found = solver(scene, row.model, row.options, n)
    except Exception as error:  # whatever stops a model is a finding about it, and the others go on
        row.samples = [time.perf_counter() - start]
        row.status, row.reason = "failed", _why(error)
        log.info(
            "%s, level %d: %s",
            row.series,
            row.level,
            row.reason,
            exc_info=not isinstance(error, SolidgearError),
        )
        return
    row.samples.append(time.perf_counter() - start)
    if row.status == "ok":
        return
    row.status, values = "ok", found.quantities
    row.unknowns = 6 if row.family == LUMPED else found.body.size
    row.values = {q: values[q] for q in against["values"] if q in values}
    row.errors = {q: abs(v / against["values"][q] - 1) for q, v in row.values.items()}
    if row.family in (LUMPED, BEAM):
        like = solver(scene.with_attachment("section"), row.model, row.options, n).quantities
        row.like_for_like = {
            q: abs(like[q] / v - 1) for q, v in against["like_for_like"].items() if q in like
        }
    missing = [q for q in against["values"] if q not in values]
    if missing:
        _note(row, f"found no {' and no '.join(missing)}")
    whole = scaled_error(found.condensed.compliance, compliance)
    if whole is not None:
        row.errors["C 6x6"] = whole


def _why(error: Exception) -> str:
    if isinstance(error, SolidgearError):
        return str(error)
    return (
        "not enough memory"
        if isinstance(error, MemoryError)
        else f"{type(error).__name__}: {error}"
    )


def _note(row: Row, text: str) -> None:
    if text not in row.reason:
        row.reason = "; ".join(t for t in (row.reason, text) if t)


def _kind(row: Row) -> tuple:
    return row.model, row.options.get("element"), row.options.get("order", 0) > 2


def _warm_up(scene, rows: list[Row], n: int, progress, solver: Solve) -> dict[tuple, float]:
    """The first case of every kind once, outside the rows: first calls pay for imports and caches;
    seconds by kind.
    """
    spent: dict[tuple, float] = {}
    for row in rows:
        if _kind(row) in spent:
            continue
        progress(f"warm-up: {row.series}")
        start = time.perf_counter()
        try:
            solver(scene, row.model, row.options, n)
        except Exception as error:  # reported when its own turn comes
            log.debug("warm-up of %s: %s", row.series, error)
        spent[_kind(row)] = time.perf_counter() - start
    return spent


def _guess(row: Row, found: Race, first: dict[tuple, float]) -> float:
    """Seconds of one run of a row, from the levels before it in its series; the first level costs
    what the warm-up of its kind did.
    """
    times = [
        r.samples[0]
        for r in found.rows
        if r.series == row.series and r.level < row.level and r.status == "ok"
    ]
    growth = min(max(times[-1] / times[-2], 1.5), 10.0) if len(times) > 1 else GROWTH
    return times[-1] * growth if times else first.get(_kind(row), 0.0)


def _admit(row: Row, found: Race, first: dict[tuple, float], spent: float) -> None:
    """Leave a row out if the budget would not hold all runs of all admitted rows and of this one."""
    if any(
        r.status == "left out" for r in found.rows if r.series == row.series and r.level < row.level
    ):
        row.status, row.reason = "left out", "the level before it was left out"
        return
    guess = _guess(row, found, first)
    owed = sum(
        r.samples[0] * (_most_runs(r.samples[0], found.runs) - len(r.samples))
        for r in found.rows
        if r.status == "ok"
    )
    if spent + owed + guess * _most_runs(guess, found.runs) > found.budget:
        row.status = "left out"
        row.reason = (
            f"the budget of {found.budget:g} s would not hold it (about {guess:.2g} s a run)"
        )


def _most_runs(seconds: float, runs: int) -> int:
    return next((min(most, runs) for limit, most in FEWER_RUNS if seconds > limit), runs)
