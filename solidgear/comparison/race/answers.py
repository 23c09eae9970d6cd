"""Answers of the rows of a chart of error against cost, the automatic choice among them.

The cost of the automatic choice is the whole climb, every mesh that was tried included; that of the
other rows is one mesh, which nobody has shown to be sufficient.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.comparison.race.cases import AUTO
from solidgear.core import FIRST_BENDING, LADDER, QUANTITIES, SolidgearError, synthesise
from solidgear.core.judge.answer import solve_cheapest
from solidgear.core.judge.lumped import preferred, sources
from solidgear.core.judge.question import FamilySolver, build_families
from solidgear.core.judge.refinement import Refinement
from solidgear.core.judge.solving import Answer, Statics, solve
from solidgear.core.ladder.model import LUMPED
from solidgear.core.solve.condensed import Condensed
from solidgear.core.solve.families import FAMILIES

if TYPE_CHECKING:
    from solidgear.core import Body, Scene


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
