"""Error bars of a 3D solid from one coarser mesh of it, by the rules of lists of meshes: of a shaft
whose mesh was set, and of a body without an axis.

Of a free block the coarser mesh has half as many cells along every edge: the finer one holds all
motions of the coarser, and both integrate exactly, so that frequencies come from above on both; a
third one, of a quarter as many, tells how fast they fall. All
else is of any shape, and faces that are held end in singular edges: what a step leaves rests on the
size of cells and on how sharp edges are, with the safety of other meshes in a sequence.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.bounds.safety import REFINEMENT
from solidgear.judge.bars import left_over, same_size, shrinkage, sizes_of, step_bars
from solidgear.judge.refinement import ONE_MESH
from solidgear.judge.sequence_bars import RIGID_EDGE, sharpest
from solidgear.judge.solving import Statics, numbers
from solidgear.ladder import build
from solidgear.meshing.corners import SHOULDER, is_notched
from solidgear.meshing.quality import MeshError
from solidgear.models.solid.plan import turns_of
from solidgear.scene.shaft import without_axis
from solidgear.solve.modes import ModeSet, modes

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.quantity import Quantity
    from solidgear.scene import Scene

Options = Mapping[str, Any]

#: refinement of the coarser mesh over that of the one that was set, by the shape of its cells: around
#: arcs and corners tetrahedra keep theirs, and 0.67 would leave three quarters of them
SHRINK = {"hex": 0.67, "tet": 0.45}
#: the same of a block
HALF = 0.5
#: least and largest share of the step from a mesh with half the cells along every edge that is taken
#: for what is left: errors of smooth modes fall to a sixteenth, which leaves a fifteenth of it; the
#: least is what errors that fall to an eighth leave, twice as much. Between them the step before it
#: decides: where two modes change places, or cells are few to a wave, steps fall by less
LEAST_LEFT, MOST_LEFT = 1 / 7, 1.0
#: the exponent of a body without an axis that has no concave edge
CONVEX = 1.5
#: shapes of the coarser mesh beyond those that are looked for: its order may be another
MORE = 6


def coarser_bars(scene: Scene, body: Body, found: ModeSet, options: Options) -> dict[str, float]:
    """Relative bars of the frequencies of a 3D solid by the names of their modes.

    A mode that the coarser mesh does not name has none, nor has one of several waves where both have
    the fewest cells around, and so have all where there is no coarser mesh.

    Parameters
    ----------
    options : mapping
        That the body was built with.
    """
    before = _before(scene, body, options)
    if before is None:
        return {}
    shapes = sum(mode.multiplicity for mode in found.modes if mode.frequency_hz > 0)
    coarse = modes(before, scene, shapes + MORE)
    nested = scene.body is not None and scene.body.kind == "block" and not scene.bearings
    falls = _falls(scene, before, coarse, options) if nested else {}
    unseen = body.mesh["element"].startswith("hex") and not _fewer_around(options)
    bars = {}
    for mode in found.modes:
        named = coarse.named(mode.name)
        if unseen and mode.family.startswith("ovalising"):
            continue
        if mode.frequency_hz > 0 and named is not None:
            step = named.frequency_hz / mode.frequency_hz - 1
            if nested:
                left = _left(max(step, 0.0), falls.get(str(mode.name)))
            else:
                left = REFINEMENT.steps[0] * _left_over(scene, before, body) * abs(step)
            bars[str(mode.name)] = left + mode.left + _shape(body)
    return bars


def _falls(scene: Scene, before: Body, coarse: ModeSet, options: Options) -> dict[str, float]:
    """Relative falls of frequencies of a block from a mesh of a quarter as many cells along every edge
    to one of half as many, which `before` is with its modes `coarse`, by the names of these.
    """
    half = {**options, "refinement": HALF * options.get("refinement", 1.0)}
    coarsest = _before(scene, before, half)
    if coarsest is None:
        return {}
    shapes = sum(mode.multiplicity for mode in coarse.modes if mode.frequency_hz > 0)
    quarter = modes(coarsest, scene, shapes)
    pairs = ((mode, quarter.named(mode.name)) for mode in coarse.modes)
    return {
        str(mode.name): named.frequency_hz / mode.frequency_hz - 1
        for mode, named in pairs
        if mode.frequency_hz > 0 and named is not None
    }


def _left(step: float, fall: float | None) -> float:
    """Share of a frequency that a step between nested meshes leaves, by the fall before it if known."""
    if fall is None or fall <= step:
        return MOST_LEFT * step
    return float(np.clip(step / (fall - step), LEAST_LEFT, MOST_LEFT)) * step


def static_bars(
    scene: Scene, body: Body, points: Sequence[str], options: Options
) -> dict[Quantity, float]:
    """Relative bars of compliances and stiffnesses at some points and between them; empty where there
    is no coarser mesh. Parameters as for :func:`coarser_bars`.
    """
    before = _before(scene, body, options)
    if before is None:
        return {}
    levels = [numbers(Statics.at(one, scene, points), None) for one in (before, body)]
    values, solver = [one.quantities for one in levels], levels[-1].solver
    share = _left_over(scene, before, body)
    bars = step_bars(values, solver, REFINEMENT, left_over=share, shape=_shape(body))
    return {name: bar.width for name, bar in bars.items()}


def no_bar(scene: Scene, body: Body, options: Options) -> str:
    """Reason for no bar of a body from mesh files."""
    before = _coarser(scene, body, options)
    return ONE_MESH if before is None else same_size(sizes_of(before.mesh), sizes_of(body.mesh))


def _before(scene: Scene, body: Body, options: Options) -> Body | None:
    """The body on a mesh whose cells are larger in every direction; None where there is none."""
    before = _coarser(scene, body, options)
    return before if before is not None and _shrunk(before, body) > 1 else None


def _coarser(scene: Scene, body: Body, options: Options) -> Body | None:
    """The body on the next coarser mesh; None where there is none, or none that can be made."""
    if scene.body is not None and scene.body.one_mesh:
        coarser = {"coarser": options.get("coarser", 0) + 1}
        if coarser["coarser"] > len(scene.body.coarser):
            return None
    else:
        shrink = HALF if without_axis(scene) else SHRINK[body.mesh["element"][:3]]
        coarser = {"refinement": shrink * options.get("refinement", 1.0)}
    try:
        return build(scene, body.fidelity, **{**options, **coarser})
    except MeshError:  # too coarse to be made
        return None


def _shrunk(before: Body, body: Body) -> float:
    return shrinkage(sizes_of(before.mesh), sizes_of(body.mesh))


def _shape(body: Body) -> float:
    """Share that second moments of a mesh are off by, which no coarser mesh shows."""
    return body.mesh.get("straightened", 0.0)


def _left_over(scene: Scene, before: Body, body: Body) -> float:
    """Share of a step between two meshes that it leaves, by the sharpest edge: without an axis concave
    ones, the ends of rigid patches, and of those in the mean, where pressure jumps.
    """
    shrunk = _shrunk(before, body)
    if not without_axis(scene):
        return left_over(shrunk, sharpest(scene))
    patches = [s for s in scene.stations if getattr(s, "patch", None) is not None]
    exponent = min(
        SHOULDER if is_notched(body.geometry.mesh) else CONVEX,  # type: ignore[union-attr]
        RIGID_EDGE if any(s.attachment == "rigid" for s in patches) else CONVEX,
        1.0 if patches else CONVEX,
    )
    return left_over(shrunk, exponent)


def _fewer_around(options: Options) -> bool:
    """True where the coarser one of two meshes of hexahedra has fewer cells around."""
    around, refinement = options.get("around", 12), options.get("refinement", 1.0)
    return turns_of(around, SHRINK["hex"] * refinement) < turns_of(around, refinement)
