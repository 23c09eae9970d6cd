"""Defect correction: the harmonic solid and the 3D mesh finer together."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from solidgear.core.ladder.meshes import FREE, Sequence
from solidgear.core.ladder.model import Options, Series
from solidgear.core.ladder.solid import PER_TETRAHEDRON, Volume
from solidgear.core.models.kinds import CUTS
from solidgear.core.models.options import CORRECTED_OPTIONS

if TYPE_CHECKING:
    from solidgear.core import Body
    from solidgear.core.models.size import Size
    from solidgear.core.scene.shaft import Shaft

#: free modes kept on the coarsest mesh, whose supported modes err by more than those left out give
FEWER = 10
CORRECTED: tuple[dict[str, Any], ...] = (
    {"order": 3, "layers": 1, "edge_layers": 1, "refinement": 0.35, "modes": FEWER},
    *(
        {"order": order, "layers": layers, "edge_layers": edges, "refinement": refinement}
        for order, layers, edges, refinement in (
            (4, 2, 2, 0.5),
            (5, 3, 2, 0.7),
            (6, 4, 3, 1.0),
        )
    ),
)


class Corrected(Volume):
    """The harmonic solid of the plain part, corrected by the change that features cause in 3D."""

    name = "corrected"
    title = "corrected harmonic solid"
    heading = "corrected"
    theory = "exact 3D elasticity of the plain part, corrected by what features change in 3D"
    colour = "#a05a00"
    marker = "^"
    options = CORRECTED_OPTIONS
    at_rest = {"modes": 0}
    coarser = "lower refinement, order or layers"
    holds = (CUTS,)
    for_features = True
    bars_by = "one order more, with features and without"
    share = 3.0
    _nature = "made of two meshes, with cuts and without,"

    def builder(self) -> Callable[..., Body]:
        from solidgear.cuts.corrected.body import corrected

        return corrected

    def _size(self, scene: Shaft, options: dict[str, Any]) -> Size:
        from solidgear.cuts.corrected.mesh import corrected_size

        return corrected_size(scene, options["refinement"], options["attachments"])

    def rough_unknowns(self, scene: Shaft, options: Options) -> float:
        """Estimate the unknowns of one of the 3D solids."""
        from solidgear.core.models.solid.plan import tetrahedra_of
        from solidgear.cuts.corrected.mesh import plan_of

        full_options = self.defaults() | self.given(scene, options)
        plan = plan_of(scene, full_options["refinement"], full_options["attachments"])
        return PER_TETRAHEDRON * tetrahedra_of(scene, plan, full_options["refinement"], edges=True)

    def meshes(self, options: Options) -> Sequence:
        """Return the mesh that was asked for, or the usual list."""
        if set(options) - set(FREE):
            return Sequence(({**CORRECTED[1], **options},), True)
        return Sequence(tuple({**level, **options} for level in CORRECTED), False)

    def series(self, scene: Shaft, full: bool) -> list[Series]:
        """Return the meshes, for a scene with such features."""
        if not self.concerns(scene):
            return []
        return [("solid", self.title, [dict(x) for x in CORRECTED[: None if full else 3]])]
