"""Questions to a solid: single numbers, for which only the families of motion that they need are
solved, or a whole body with all families.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Body, Supports, as_supports
from solidgear.core.body.mode_names import ModeName
from solidgear.core.errors import NoBounds
from solidgear.core.judge.bounded import bounded, elastic_names
from solidgear.core.judge.refinement import Refinement, Solved
from solidgear.core.judge.solving import ENOUGH, Numbers, Statics, numbers, search_modes
from solidgear.core.ladder import build
from solidgear.core.quantity import FREQUENCY, Quantity
from solidgear.core.solve.condensed import Condensed
from solidgear.core.solve.coupling import decoupled, groups
from solidgear.core.solve.families import FAMILIES
from solidgear.core.solve.modes import ModeSet
from solidgear.core.solve.statics import SOLVED, flexibility

if TYPE_CHECKING:
    from solidgear.core.ladder.model import Model
    from solidgear.core.scene import Scene

#: couplings by bearings are left out where they move less than this part of the tolerance
COUPLING = 0.01
#: families of motion that are solved together, None for all of them, and the quantities asked for
Question = tuple[tuple[str, ...] | None, tuple[Quantity, ...]]
#: options of a mesh and families, None for all of them -> body
BuildBody = Callable[[Mapping[str, Any], tuple[str, ...] | None], Body]
#: body, supports -> modes whose error bars are asked for next, with all that these rest on, should the
#: mesh be the last: their local problems are solved with those of the question
Listing = Callable[[Body, Supports], ModeSet]


class FamilySolver:
    """Solves meshes for the numbers of a refinement, a :class:`~solidgear.core.judge.refinement.Solver`.

    The first mesh is solved for all quantities wanted; of single numbers, later meshes only for
    those still open, by groups of families of motion. A whole body has all families on every mesh.
    """

    def __init__(
        self,
        refinement: Refinement,
        build_body: BuildBody | None = None,
        listing: Listing | None = None,
    ):
        self.refinement = refinement
        self.listing = listing
        self.build_body = build_body or partial(build_families, refinement.scene, refinement.model)
        #: groups of families that bearings couple, as far as quantities need them; None where all
        #: families are solved together
        self.groups: list[tuple[str, ...]] | None = None
        #: statics at the main point by families, on the finest mesh that was solved for them
        self.compliances: dict[tuple[str, ...], Condensed] = {}
        self.modes: ModeSet | None = None  #: of the last mesh that was solved for modes

    def next_quantities(self) -> tuple[Quantity, ...]:
        """Return the quantities that the next mesh is solved for."""
        return tuple(q for _, names in self.questions() for q in names)

    def questions(self) -> list[Question]:
        """Return the families that the next mesh is solved for, and the quantities of each."""
        refinement = self.refinement
        if refinement.whole:
            return [(None, refinement.wanted)]
        if not refinement.levels:
            families = None if self.groups is None else tuple(f for g in self.groups for f in g)
            return [(families, refinement.wanted)]
        unmet = tuple(refinement.unmet())
        if self.groups is None:
            return [(None, unmet)]
        by_group = [(g, tuple(q for q in unmet if family_of(q) in g)) for g in self.groups]
        return [(group, names) for group, names in by_group if names]

    def solve(self, options: Mapping[str, Any]) -> Solved:
        """Solve a mesh for all open questions, with error bars."""
        values: dict[Quantity, float] = {}
        solver: dict[Quantity, float] = {}
        unknowns, body, score = 0, None, None
        for families, names in self.questions():
            body = self.build_body(options, families)
            if not self.refinement.levels and self.groups is None and not self.refinement.whole:
                self.groups = self._needed_groups(body)
            solved, weights = self._numbers(body, families, names)
            values |= solved.quantities
            solver |= solved.solver
            if weights is not None:
                score = weights if score is None else np.maximum(score, weights)
            unknowns += body.size
        assert body is not None  # there is something to ask for
        return Solved(body, Numbers(values, solver), unknowns, score)

    def _needed_groups(self, body: Body) -> list[tuple[str, ...]] | None:
        """Return the groups of families that the quantities wanted need, each with all families that
        bearings couple to it.
        """
        refinement = self.refinement
        if len(body.blocks) < len(FAMILIES) or "families" not in refinement.model.options:
            return None  # one block holds all motions, or the builder makes all of them at once
        coupled, refinement.left_out = coupled_families(
            refinement.scene, body, COUPLING * refinement.tol
        )
        needed = {family_of(q) for q in refinement.wanted}
        return [group for group in coupled if set(group) & needed]

    def _numbers(
        self, body: Body, families: tuple[str, ...] | None, names: tuple[Quantity, ...]
    ) -> tuple[Numbers, np.ndarray | None]:
        """Return the numbers of a body, and weights of the cells by error bars that are too wide."""
        refinement, scene = self.refinement, self.refinement.scene
        supports = as_supports(scene)
        if families is not None:
            supports = supports.on(c for f in families for c in FAMILIES[f])
        frequencies = [q for q in names if q.is_frequency]
        statics: Statics | None = None
        modes: ModeSet | None = None
        if len(frequencies) < len(names):
            if refinement.model.follows:
                flexibility(body, SOLVED)
            statics = Statics.for_quantities(scene, body, supports, names)
            self.compliances[families or tuple(FAMILIES)] = statics.main
        if frequencies:
            modes = self.modes = search_modes(
                body,
                supports,
                shapes(families, names),
                frequencies,
                spare=True,
                ovalising=False,
            )
        values = numbers(statics, modes, frequencies)
        judged_names = self._judged_names(values, names)
        later = []
        if frequencies and self.listing is not None:
            listed = self.listing(body, supports)
            later.append((listed, elastic_names(listed)))
        try:
            judged = bounded(
                scene, body, supports, statics, modes, judged_names, values.solver, later
            )
        except NoBounds as error:
            refinement.leave_without_bars(error)
            return values, None
        refinement.without_bars = ""
        barred = [q for q in judged_names if q in judged.error_bars]
        refinement.error_bars |= {q: judged.error_bars[q] for q in barred}
        # no frequency without an error bar
        quantities = {
            q: v for q, v in values.quantities.items() if q in judged_names or not q.is_frequency
        }
        return Numbers(quantities, values.solver), refinement.score(judged, barred)

    def _judged_names(self, values: Numbers, names: tuple[Quantity, ...]) -> list[Quantity]:
        """Return the numbers that get an error bar: those asked for, and all static ones that are
        wanted, for which nothing more is solved.
        """
        if self.refinement.whole:
            kinds = {q.kind for q in names} - {FREQUENCY}
            return [q for q in values.quantities if q in names or q.kind in kinds and not q.repeats]
        static = (q for q in self.refinement.wanted if not q.is_frequency)
        return [q for q in dict.fromkeys((*names, *static)) if q in values.quantities]


def build_families(
    scene: Scene, model: Model, options: Mapping[str, Any], families: tuple[str, ...] | None
) -> Body:
    """Build a body with some families of motion, all for None or where the model makes all at once."""
    builder_options = dict(options)
    if families is not None and "families" in model.options:
        builder_options["families"] = families
    return build(scene, model.name, **builder_options)


def family_of(quantity: Quantity) -> str:
    """Return the family of motion that a quantity belongs to."""
    if quantity.is_frequency:
        return ModeName(quantity).family
    components = quantity.components
    return next(name for name, members in FAMILIES.items() if components <= set(members))


def coupled_families(
    scene: Scene, body: Body, tolerance: float
) -> tuple[list[tuple[str, ...]], float]:
    """Return the families that bearings couple, and a bound on the change by the couplings left out,
    relative, which is within the tolerance; the body has a block for every family.
    """
    supports = as_supports(scene)
    spring, left_out = decoupled(body, supports, tolerance)
    together: list[set[str]] = []
    for group in groups(body, supports, spring):
        components = {c for b in group for c in body.blocks[b].components}
        families = {name for name, members in FAMILIES.items() if components & set(members)}
        # bending in one plane and in the other are two groups of one family
        disjoint = [f for f in together if not f & families]
        together = [*disjoint, families.union(*(f for f in together if f & families))]
    return [tuple(f for f in FAMILIES if f in families) for families in together], left_out


def shapes(families: tuple[str, ...] | None, names: Iterable[Quantity]) -> int:
    """Return the number of elastic shapes that hold the modes asked for."""
    if families is None or len(families) > 1:
        return ENOUGH
    places = [ModeName(q).number or 1 for q in names if q.is_frequency]
    return 2 * max(places) + 2
