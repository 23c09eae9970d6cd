"""Bands of the finest mesh of a sequence, by the rule that its meshes allow."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence as Listed
from typing import TYPE_CHECKING

from solidgear.evidence.bands import Band, layered_bands, refined_bands
from solidgear.fidelity.edges import sharpest_edge
from solidgear.meshing.corners import sharpest_corner

if TYPE_CHECKING:
    from solidgear.fidelity.levels import Sequence
    from solidgear.fidelity.rung import BandFactors
    from solidgear.scene import Scene

#: exponent at the end of a rigid seat, a clamp on a smooth surface (Williams 1952, clamped-free at
#: 180 degrees)
RIGID_EDGE = 0.5


def sequence_bands(
    scene: Scene,
    plan: Sequence,
    factors: BandFactors,
    levels: Listed[Mapping[str, float]],
    solver: Mapping[str, float],
    sizes: Listed[float | None],
    around: Mapping[str, float] | None = None,
) -> dict[str, Band]:
    """Bands of the finest of some meshes.

    Parameters
    ----------
    scene : Scene
        Tied as the levels are.
    plan : Sequence
        That the meshes are of: layered ones have bands from two levels on, others from three.
    factors : BandFactors
        Of the rung.
    levels : sequence of mappings
        Quantity to value, coarse to fine.
    solver : mapping
        Relative error the solver may have left in the finest level.
    sizes : sequence of float
        Representative size of the cells of every level, m.
    around : mapping, optional
        Relative error that the cells around leave.

    Returns
    -------
    dict of str to Band
        Empty where there are too few levels, or they are not ever finer; and for layered hexahedra
        beside a fillet or a chamfer, where no factors of bands hold.
    """
    if scene.corners and plan.turned is not None:  # what only layered hexahedra have
        return {}
    if plan.layered:
        if len(levels) < 2:
            return {}
        return layered_bands(levels, solver, factors, edge=sharpest_edge(scene), around=around)
    last = [size or 0.0 for size in sizes[-3:]]
    if len(levels) < 3 or not last[0] > last[1] > last[2] > 0:
        return {}
    held = any(s.attachment == "rigid" for s in scene.stations)
    exponent = min(sharpest_corner(scene)[1], RIGID_EDGE if held else 1.0)
    return refined_bands(levels, solver, last, exponent, singular=factors.singular)
