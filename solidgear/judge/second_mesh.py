"""Error bars of the frequencies of a 3D solid whose mesh was set, from a second, coarser one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from solidgear.bounds.safety import REFINEMENT
from solidgear.judge.body_bars import stepped_bars
from solidgear.judge.sequence_bars import sharpest
from solidgear.ladder import build
from solidgear.meshing.quality import MeshError
from solidgear.models.solid.plan import turns_of
from solidgear.scene.shaft import without_axis
from solidgear.solve.modes import ModeSet, modes

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.scene import Scene

#: refinement of the coarser mesh over that of the one that was set, by the shape of its cells: around
#: arcs and corners tetrahedra keep theirs, and 0.67 would leave three quarters of them
SHRINK = {"hex": 0.67, "tet": 0.45}
#: shapes of the coarser mesh beyond those that are looked for: its order may be another
MORE = 6


def second_bars(
    scene: Scene, body: Body, found: ModeSet, options: Mapping[str, Any]
) -> dict[str, float]:
    """Relative bars of the frequencies of a 3D solid by the names of their modes, from the step to a
    coarser mesh, or to the next coarser file of a list, by the rules of lists of meshes. A mode that
    the coarser mesh does not name has none, nor has one of several waves where both have the fewest
    cells around, and so have all of a single mesh file.

    Parameters
    ----------
    options : mapping
        That the body was built with.
    """
    if without_axis(scene):
        return stepped_bars(scene, body, found)
    shrink = SHRINK[body.mesh["element"][:3]]
    coarser = {"refinement": shrink * options.get("refinement", 1.0)}
    if scene.body is not None and scene.body.one_mesh:
        coarser = {"coarser": options.get("coarser", 0) + 1}
        if coarser["coarser"] > len(scene.body.coarser):
            return {}
    try:
        before = build(scene, body.fidelity, **{**options, **coarser})
    except MeshError:  # too coarse to be made
        return {}
    sizes = [one.mesh["representative_size"] for one in (before, body)]
    if not sizes[0] > sizes[1]:
        return {}
    factor = REFINEMENT.steps[0] / ((sizes[0] / sizes[1]) ** (2 * sharpest(scene)) - 1)
    shapes = sum(mode.multiplicity for mode in found.modes if mode.frequency_hz > 0)
    coarse = modes(before, scene, shapes + MORE)
    unseen = shrink == SHRINK["hex"] and not _fewer_around(options, shrink)
    bars = {}
    for mode in found.modes:
        named = coarse.named(mode.name)
        if unseen and mode.family.startswith("ovalising"):
            continue
        if mode.frequency_hz > 0 and named is not None:
            step = abs(named.frequency_hz / mode.frequency_hz - 1)
            bars[str(mode.name)] = factor * step + mode.error
    return bars


def _fewer_around(options: Mapping[str, Any], shrink: float) -> bool:
    """True where the coarser one of two meshes of hexahedra has fewer cells around."""
    around, refinement = options.get("around", 12), options.get("refinement", 1.0)
    return turns_of(around, shrink * refinement) < turns_of(around, refinement)
