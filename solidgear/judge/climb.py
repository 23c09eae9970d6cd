"""Single numbers on ever finer meshes: all that is asked is solved first, later only what is still
open; the rest keeps its value and its bar.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from solidgear.body import Body, as_supports
from solidgear.judge.bars import sizes_of
from solidgear.judge.bounded import bounded
from solidgear.judge.question import (
    Question,
    Solved,
    coupled_families,
    family_of,
    shapes,
)
from solidgear.judge.refinement import Loop
from solidgear.judge.solving import Numbers, Statics, numbers, searched
from solidgear.ladder import build
from solidgear.quantity import Quantity
from solidgear.solve.condensed import Condensed
from solidgear.solve.families import FAMILIES
from solidgear.solve.modes import ModeSet
from solidgear.solve.statics import SOLVED, flexibility

#: couplings by bearings are left out where they move less than this part of the tolerance
COUPLING = 0.01


class Climb(Loop):
    """A loop that solves families of motion apart; what the last of them was solved with is kept.

    Attributes
    ----------
    compliances : dict of tuple of str to Condensed
        Statics at the main point by families of motion, on the finest mesh that was solved for them.
    modes : ModeSet or None
        The last ones.
    """

    def __init__(self, *args: Any, **options: Any):
        super().__init__(*args, **options)
        self.groups: list[tuple[str, ...]] | None = None
        self.compliances: dict[tuple[str, ...], Condensed] = {}
        self.modes: ModeSet | None = None

    def _asked(self) -> tuple[Quantity, ...]:
        return tuple(q for _, names in self._questions() for q in names)

    def _questions(self) -> list[Question]:
        """Questions that the next mesh is solved for."""
        if not self._started():
            families = None if self.groups is None else tuple(f for g in self.groups for f in g)
            return [(families, self.wanted)]
        floors = self.floors()
        open_ = [q for q in self._open() if not floors.get(q, 0.0) > self.tol]
        if self.groups is None:
            return [(None, tuple(open_))]
        by_group = [(g, tuple(q for q in open_ if family_of(q) in g)) for g in self.groups]
        return [(group, names) for group, names in by_group if names]

    def _solve(self, level: Mapping[str, Any]) -> Solved:
        values: dict[Quantity, float] = {}
        solver: dict[Quantity, float] = {}
        unknowns, body, score = 0, None, None
        cells: tuple[float, ...] = ()
        for families, names in self._questions():
            body = self._body(level, families)
            if not self.levels and self.groups is None:
                self.groups = self.needed(body)
            found, share = self._numbers(body, families, names)
            values |= found.quantities
            solver |= found.solver
            if share is not None:
                score = share if score is None else np.maximum(score, share)
            unknowns, cells = unknowns + body.size, sizes_of(body.mesh)
        assert body is not None  # there is something to ask for
        return Solved(body, Numbers(values, solver), unknowns, cells, score)

    def _body(self, level: Mapping[str, Any], families: tuple[str, ...] | None) -> Body:
        options = dict(level)
        if families is not None and "families" in self.model.options:
            options["families"] = families
        return build(self.scene, self.model.name, **options)

    def needed(self, body: Body) -> list[tuple[str, ...]] | None:
        """Families that the question is about, each with those that bearings couple to it."""
        if len(body.blocks) < len(FAMILIES) or "families" not in self.model.options:
            return None  # one block holds all motions, or the builder makes all of them at once
        found, self.left_out = coupled_families(self.scene, body, COUPLING * self.tol)
        asked = {family_of(q) for q in self.wanted}
        return [group for group in found if set(group) & asked]

    def _numbers(
        self, body: Body, families: tuple[str, ...] | None, names: tuple[Quantity, ...]
    ) -> tuple[Numbers, np.ndarray | None]:
        """Values of a body, and where its open bars come from."""
        supports = as_supports(self.scene)
        if families is not None:
            supports = supports.on(c for f in families for c in FAMILIES[f])
        wanted = [q for q in names if q.is_frequency]
        statics: Statics | None = None
        found: ModeSet | None = None
        if len(wanted) < len(names):
            if self.model.bounded:
                flexibility(body, SOLVED)
            statics = Statics.of(self.scene, body, supports, names)
            self.compliances[families or tuple(FAMILIES)] = statics.main
        if wanted:
            found = self.modes = searched(
                body,
                supports,
                shapes(families, names),
                wanted,
                spare=self.model.bounded,
                ovalising=False,
            )
        values = numbers(statics, found)
        if not self.model.bounded:
            return values, None
        here = self._judged_names(values, names)
        judged = bounded(self.scene, body, supports, statics, found, here, values.solver)
        self.error_bars |= {q: judged.error_bars[q] for q in here}
        # no value without its bar
        kept = {q: v for q, v in values.quantities.items() if q in here or not q.is_frequency}
        values = Numbers(kept, values.solver)
        return values, self.score(judged, here)

    def _judged_names(self, found: Numbers, names: tuple[Quantity, ...]) -> list[Quantity]:
        """Numbers that are there and get a bar: those of this question, and all of statics that are
        wanted, for which nothing more is solved.
        """
        static = (q for q in self.wanted if not q.is_frequency)
        return [q for q in dict.fromkeys((*names, *static)) if q in found.quantities]
