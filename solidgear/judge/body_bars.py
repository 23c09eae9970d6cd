"""Error bars of a body without an axis, from two meshes of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from solidgear.body import Body
from solidgear.bounds.safety import REFINEMENT
from solidgear.judge.bars import step_bars
from solidgear.judge.sequence_bars import RIGID_EDGE
from solidgear.judge.solving import Statics, numbers
from solidgear.ladder import build
from solidgear.meshing.corners import SHOULDER, is_notched
from solidgear.quantity import Quantity
from solidgear.solve.modes import ModeSet, modes

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: the only model that holds a body without an axis
MODEL = "solid"
#: share of the step from a mesh with half the cells along an edge that is taken for what is left:
#: errors of smooth modes fall to a sixteenth, which leaves a fifteenth of it; this is what errors
#: that fall to an eighth leave, twice as much
LEFT = 1 / 7
#: the exponent of that, where a mesh file has no concave edge
CONVEX = 1.5


def stepped_bars(scene: Scene, body: Body, found: ModeSet) -> dict[str, float]:
    """Relative bars of the frequencies of a body without an axis, from those of the next coarser mesh
    at the same places of the list; empty where there is none.

    Of a free block that mesh has half as many cells along every edge: the finer one holds all motions
    of the coarser, and both integrate exactly, so that frequencies come from above on both. Mesh files
    are of any shape, and faces that are held end in singular edges: what a step leaves rests on the
    size of cells and on how sharp edges are, with the safety of other meshes in a sequence.
    """
    elastic = [mode for mode in found.modes if mode.frequency_hz > 0]
    before = _before(scene, body)
    if before is None:
        return {}
    coarse = modes(before, scene, len(elastic))
    above = [mode.frequency_hz for mode in coarse.modes if mode.frequency_hz > 0]
    if "coarser" in body.mesh or scene.bearings:
        factor = REFINEMENT.steps[0] * _left_over(scene, before, body)
        changes = [abs(hertz / mode.frequency_hz - 1) for mode, hertz in zip(elastic, above)]
    else:
        factor = LEFT
        changes = [max(hertz / mode.frequency_hz - 1, 0) for mode, hertz in zip(elastic, above)]
    return {str(mode.name): factor * change + mode.error for mode, change in zip(elastic, changes)}


def static_bars(scene: Scene, body: Body, points: tuple[str, ...]) -> dict[Quantity, float]:
    """Relative bars of compliances and stiffnesses of a body without an axis at some points and
    between them, from the next coarser mesh; empty where there is none.
    """
    before = _before(scene, body)
    if before is None:
        return {}
    levels = []
    for one in (before, body):
        levels.append(numbers(Statics.at(one, scene, points), None))
    values, solver = [one.quantities for one in levels], levels[-1].solver
    bars = step_bars(values, solver, REFINEMENT, left_over=_left_over(scene, before, body))
    return {name: bar.width for name, bar in bars.items()}


def _left_over(scene: Scene, before: Body, body: Body) -> float:
    """Share of a step between two meshes that it leaves, by the sharpest edge: concave ones, the ends
    of rigid patches, and of those in the mean, where pressure jumps.
    """
    sizes = (before.mesh["representative_size"], body.mesh["representative_size"])
    if not sizes[0] > sizes[1]:
        return math.inf
    patches = [s for s in scene.stations if getattr(s, "patch", None) is not None]
    exponent = min(
        SHOULDER if is_notched(body.geometry.mesh) else CONVEX,  # type: ignore[union-attr]
        RIGID_EDGE if any(s.attachment == "rigid" for s in patches) else CONVEX,
        1.0 if patches else CONVEX,
    )
    return 1 / ((sizes[0] / sizes[1]) ** (2 * exponent) - 1)


def _before(scene: Scene, body: Body) -> Body | None:
    """The body on the next coarser mesh; None where that of a file is the coarsest."""
    assert scene.body is not None  # that is without an axis
    given = {"element": body.mesh["element"]}
    if "coarser" not in body.mesh:
        return build(scene, MODEL, **given, refinement=body.mesh["refinement"] / 2)
    if body.mesh["coarser"] == len(scene.body.coarser):
        return None
    return build(scene, MODEL, **given, coarser=body.mesh["coarser"] + 1)
