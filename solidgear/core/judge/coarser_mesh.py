"""Error bars of a 3D solid from one coarser mesh, by the rules of lists of meshes: of a shaft whose
mesh was set, and of a body without an axis.

Of a free block the coarser mesh has half as many cells along every edge: the finer one holds all
motions of the coarser, and both integrate exactly, so that frequencies come from above on both; a
third one, of a quarter as many, shows how fast they fall. All else is of any shape, and faces that
are held end in singular edges: the error after a step rests on the size of cells and on how sharp
edges are, with the safety of other meshes in a sequence.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.bounds.safety import REFINEMENT
from solidgear.core.judge.bars import left_over, same_size, shrinkage, sizes_of, step_bars
from solidgear.core.judge.refinement import ONE_MESH
from solidgear.core.judge.sequence_bars import RIGID_EDGE, sharpest
from solidgear.core.judge.solving import Statics, numbers
from solidgear.core.ladder import build
from solidgear.core.meshing.corners import SHOULDER, is_notched
from solidgear.core.meshing.quality import MeshError
from solidgear.core.models.solid.plan import turns_of
from solidgear.core.scene.shaft import without_axis
from solidgear.core.solve.modes import ModeSet, modes

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.quantity import Quantity
    from solidgear.core.scene import Scene

Options = Mapping[str, Any]

#: refinement of the coarser mesh over that of the one that was set, by the shape of its cells: around
#: arcs and corners tetrahedra keep theirs, and 0.67 would leave three quarters of them
SHRINK = {"hex": 0.67, "tet": 0.45}
#: the same of a block
HALF = 0.5
#: least and largest share of the step from a mesh with half the cells along every edge that is taken
#: for the remaining error: those of smooth modes fall to a sixteenth, which leaves a fifteenth of it; the
#: least is for errors that fall to an eighth, twice as much. Between them the step before it
#: decides: where two modes change places, or cells are few to a wave, steps fall by less
LEAST_LEFT, MOST_LEFT = 1 / 7, 1.0
#: the exponent of a body without an axis that has no concave edge
CONVEX = 1.5
#: shapes of the coarser mesh beyond those that are looked for: its order may be another
MORE = 6


def coarser_bars(scene: Scene, body: Body, listed: ModeSet, options: Options) -> dict[str, float]:
    """Compute relative error bars of the frequencies of a 3D solid, built with `options`, by the
    names of their modes.

    A mode that the coarser mesh does not name has none, nor has one of several waves where both
    have the fewest cells around, and so have all where there is no coarser mesh.
    """
    coarser = _clearly_coarser(scene, body, options)
    if coarser is None:
        return {}
    shapes = sum(mode.multiplicity for mode in listed.modes if mode.frequency_hz > 0)
    coarse = modes(coarser, scene, shapes + MORE)
    nested = scene.body is not None and scene.body.kind == "block" and not scene.bearings
    falls = _falls(scene, coarser, coarse, options) if nested else {}
    unseen = body.mesh["element"].startswith("hex") and not _fewer_around(options)
    bars = {}
    for mode in listed.modes:
        coarse_mode = coarse.named(mode.name)
        if unseen and mode.family.startswith("ovalising"):
            continue
        if mode.frequency_hz > 0 and coarse_mode is not None:
            step = coarse_mode.frequency_hz / mode.frequency_hz - 1
            if nested:
                share = _remaining_share(max(step, 0.0), falls.get(str(mode.name)))
            else:
                share = REFINEMENT.steps[0] * _remaining_of_step(scene, coarser, body) * abs(step)
            bars[str(mode.name)] = share + mode.left + _shape(body)
    return bars


def _falls(scene: Scene, coarser: Body, coarse: ModeSet, options: Options) -> dict[str, float]:
    """Compute relative falls of frequencies of a block from a mesh of a quarter as many cells along
    every edge to one of half as many, which `coarser` is with the modes `coarse`, by the names of
    these.
    """
    half = {**options, "refinement": HALF * options.get("refinement", 1.0)}
    coarsest = _clearly_coarser(scene, coarser, half)
    if coarsest is None:
        return {}
    shapes = sum(mode.multiplicity for mode in coarse.modes if mode.frequency_hz > 0)
    quarter = modes(coarsest, scene, shapes)
    pairs = ((mode, quarter.named(mode.name)) for mode in coarse.modes)
    return {
        str(mode.name): quarter_mode.frequency_hz / mode.frequency_hz - 1
        for mode, quarter_mode in pairs
        if mode.frequency_hz > 0 and quarter_mode is not None
    }


def _remaining_share(step: float, fall: float | None) -> float:
    """Return the share of a frequency that a step between nested meshes leaves, by the fall before
    it if known.
    """
    if fall is None or fall <= step:
        return MOST_LEFT * step
    return float(np.clip(step / (fall - step), LEAST_LEFT, MOST_LEFT)) * step


def static_bars(
    scene: Scene, body: Body, points: Sequence[str], options: Options
) -> dict[Quantity, float]:
    """Compute relative error bars of compliances and stiffnesses at some points and between them;
    empty where there is no coarser mesh. Parameters as for :func:`coarser_bars`.
    """
    coarser = _clearly_coarser(scene, body, options)
    if coarser is None:
        return {}
    levels = [numbers(Statics.at_points(b, scene, points), None) for b in (coarser, body)]
    values, solver = [level.quantities for level in levels], levels[-1].solver
    share = _remaining_of_step(scene, coarser, body)
    bars = step_bars(values, solver, REFINEMENT, left_over=share, shape=_shape(body))
    return {name: bar.width for name, bar in bars.items()}


def no_bar(scene: Scene, body: Body, options: Options) -> str:
    """Return the reason why a body from mesh files has no error bar."""
    coarser = _coarser(scene, body, options)
    return ONE_MESH if coarser is None else same_size(sizes_of(coarser.mesh), sizes_of(body.mesh))


def _clearly_coarser(scene: Scene, body: Body, options: Options) -> Body | None:
    """Build the body on a mesh whose cells are larger in every direction; None where there is none."""
    coarser = _coarser(scene, body, options)
    return coarser if coarser is not None and _shrunk(coarser, body) > 1 else None


def _coarser(scene: Scene, body: Body, options: Options) -> Body | None:
    """Build the body on the next coarser mesh; None where there is none, or none that can be made."""
    if scene.body is not None and scene.body.one_mesh:
        mesh = {"coarser": options.get("coarser", 0) + 1}
        if mesh["coarser"] > len(scene.body.coarser):
            return None
    else:
        shrink = HALF if without_axis(scene) else SHRINK[body.mesh["element"][:3]]
        mesh = {"refinement": shrink * options.get("refinement", 1.0)}
    try:
        return build(scene, body.fidelity, **{**options, **mesh})
    except MeshError:  # too coarse to be made
        return None


def _shrunk(coarser: Body, body: Body) -> float:
    return shrinkage(sizes_of(coarser.mesh), sizes_of(body.mesh))


def _shape(body: Body) -> float:
    """Return the share that second moments of a mesh are off by, which no coarser mesh shows."""
    return body.mesh.get("geometry", 0.0)


def _remaining_of_step(scene: Scene, coarser: Body, body: Body) -> float:
    """Return the share of a step between two meshes that remains as error, by the sharpest edge:
    without an axis concave ones, the ends of rigid patches, and of averaged ones, where pressure
    jumps.
    """
    shrunk = _shrunk(coarser, body)
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
    """Return whether the coarser one of two meshes of hexahedra has fewer cells around."""
    around, refinement = options.get("around", 12), options.get("refinement", 1.0)
    return turns_of(around, SHRINK["hex"] * refinement) < turns_of(around, refinement)
