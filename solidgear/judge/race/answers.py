"""Answers of the rows of a chart of error against cost, that of the automatic choice among them.

What the automatic choice costs is the whole climb, every mesh that was tried included; what the other
lines cost is one mesh, of which nobody has shown that it will do.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.judge.answer import climbed
from solidgear.judge.climb import Climb
from solidgear.judge.lumped import preferred, sources
from solidgear.judge.race.cases import AUTO
from solidgear.judge.solving import Answer, Statics, solve
from solidgear.ladder.model import LUMPED
from solidgear.ladder.registry import LADDER
from solidgear.quantity import FIRST_BENDING, QUANTITIES
from solidgear.reduction.effective_mass import synthesise
from solidgear.solve.condensed import Condensed
from solidgear.solve.families import FAMILIES

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.scene import Scene


def answer(scene: Scene, model: str, options: dict, n: int) -> Answer:
    """Answer of one model, or of the automatic choice.

    Raises
    ------
    SolidgearError
        Where the model cannot be made.
    """
    if model == AUTO:
        return _automatic(scene, options["tol"])
    if LADDER[model].family == LUMPED:
        return _lumped(scene, options, n)
    return solve(scene, model, n, **options)


def _lumped(scene: Scene, options: dict, n: int) -> Answer:
    """The lumped model rests on the best beam, and has a first bending of its own."""
    found = solve(scene, sources()[0], n, **options)
    _, made = synthesise(found.body, scene, scene.port.name, found.modes)
    chosen = preferred(made)
    hertz = None if chosen is None else made[chosen].frequency_hz
    if hertz is None:
        raise SolidgearError(
            "no lumped mass is positive and has the first bending mode as its first"
        )
    return replace(found, quantities=found.quantities | {FIRST_BENDING: hertz})


def _automatic(scene: Scene, tol: float) -> Answer:
    climb, _ = climbed(scene, tol, QUANTITIES, _Charted, lambda _: None)
    assert climb.largest is not None and climb.modes is not None  # everything was asked
    values = {v.quantity: v.value for v in climb.values()}
    return Answer(climb.largest, Statics(_together(climb)), climb.modes, values)


class _Charted(Climb):
    """A climb that keeps the largest body it solved: the last one may be that of a small question,
    torsion alone, and a chart over unknowns would take its size for that of the whole answer.
    """

    largest: Body | None = None

    def _body(self, level: Mapping[str, Any], families: tuple[str, ...] | None) -> Body:
        body = super()._body(level, families)
        if self.largest is None or body.size > self.largest.size:
            self.largest = body
        return body


def _together(climb: Climb) -> Condensed:
    """Compliance of all families, each of the finest mesh that was solved for it."""
    coarse, *finer = climb.compliances.items()
    compliance = coarse[1].compliance.copy()
    for families, found in finer:
        own = [c for family in families for c in FAMILIES[family]]
        compliance[np.ix_(own, own)] = found.compliance[np.ix_(own, own)]
    return replace(coarse[1], compliance=compliance)
