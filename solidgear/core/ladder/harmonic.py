"""The harmonic solid: error bars come from each mesh by itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from solidgear.core.ladder.meshes import FREE, Sequence, levels
from solidgear.core.ladder.model import SOLID, Model, Options, Series
from solidgear.core.models.options import HARMONIC_OPTIONS

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.scene.shaft import Shaft


class Harmonic(Model):
    """Elasticity of a body of revolution on the meridian, wave by wave around the axis."""

    name = "harmonic"
    title = "harmonic solid"
    heading = "harmonic"
    family = SOLID
    theory = "exact 3D elasticity of a body of revolution"
    colour = "#00805e"
    marker = "o"
    options = HARMONIC_OPTIONS
    coarser = (
        "lower order, refinement or layers, or raise size, or ask for fewer ovalising harmonics"
    )
    bars_by = "local problems"
    follows = True
    share = 10.0
    most_seats = 60

    def builder(self) -> Callable[..., Body]:
        from solidgear.core.models.harmonic.body import harmonic

        return harmonic

    def meshes(self, options: Options) -> Sequence:
        """Return the mesh that was asked for, or the start of refinement by error bars
        (:mod:`solidgear.core.bounds.refining`).
        """
        return Sequence((dict(options),), bool(set(options) - set(FREE)))

    def series(self, scene: Shaft, full: bool) -> list[Series]:
        """Return refinement at order 2 and rising orders, each on uniform and on graded meshes."""
        flat = {"layers": 0, "edge_layers": 0, "size": scene.outline.least_radius}
        graded = {"layers": 3, "edge_layers": 1}
        orders = levels((1, 2, 3, 4, 5, 6), (7, 8), full)
        uniform_steps = levels((0.5, 1.0, 2.0, 4.0), (8.0,), full)
        graded_steps = levels((0.5, 1.0, 2.0), (3.0,), full)
        lines = {
            "h uniform": [{"order": 2, **flat, "refinement": s} for s in uniform_steps],
            "h graded": [
                {"order": 2, "layers": 4, "edge_layers": 2, "refinement": s} for s in graded_steps
            ],
            "p uniform": [{"order": p, **flat} for p in orders],
            "p graded": [{"order": p, **graded} for p in orders],
        }
        return [("harmonic", f"harmonic {name}", levels) for name, levels in lines.items()]
