"""The automatic choice as one more line in a chart of error against cost.

What it costs is the whole climb, every mesh that was tried included; what the other lines cost is
one mesh, of which nobody has shown that it will do.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.judge.answer import climbed
from solidgear.judge.climb import Climb
from solidgear.judge.race.pareto import AUTOMATIC, Row
from solidgear.judge.race.timing import answer
from solidgear.judge.solving import Answer, Statics
from solidgear.quantity import QUANTITIES
from solidgear.solve.condensed import Condensed
from solidgear.solve.families import FAMILIES

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.scene import Scene

#: name of the model in rows of a chart
AUTO = "auto"
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4)


def automatic_rows() -> list[Row]:
    """One row a tolerance.

    Examples
    --------
    >>> [(row.level, row.options["tol"]) for row in automatic_rows()]
    [(1, 0.1), (2, 0.01), (3, 0.001), (4, 0.0001)]
    """
    return [
        Row(AUTOMATIC, AUTOMATIC, level, AUTO, {"tol": tol})
        for level, tol in enumerate(TOLERANCES, start=1)
    ]


def solved(scene: Scene, model: str, options: dict, n: int) -> Answer:
    """Answer of a row of a chart, the automatic ones included; a solver for
    :func:`solidgear.judge.race.timing.race`.

    Raises
    ------
    SolidgearError
        Where the model cannot be made.
    """
    if model != AUTO:
        return answer(scene, model, options, n)
    climb, _ = climbed(scene, options["tol"], QUANTITIES, _Charted, lambda _: None)
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
