"""The exponent of displacement at the sharpest edge of a body."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from solidgear.core.meshing.corners import SHOULDER, sharpest_corner

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: exponent at the end of a rigid seat, a clamp on a smooth surface (Williams 1952, clamped-free at
#: 180 degrees)
RIGID_EDGE = 0.5
#: exponents where two materials meet at a smooth surface, and at a shoulder
JOINT, JOINT_AT_SHOULDER = 0.6, 0.5


def sharpest_exponent(scene: Scene) -> float:
    """Return the exponent of displacement at the sharpest edge: of shoulders, features, rigid seats
    and joints of materials; 1 where there is none, for the ends of averaged seats.
    """
    rigid_seat = any(s.attachment == "rigid" for s in scene.stations)
    notched = any(f.notched for f in scene.features)
    exponents = [
        sharpest_corner(scene)[1],
        RIGID_EDGE if rigid_seat else 1.0,
        SHOULDER if notched else 1.0,
    ]
    for a, b in pairwise(scene.segments):
        if a.material != b.material:
            exponents.append(JOINT if a.outer1 == b.outer0 else JOINT_AT_SHOULDER)
    return min(exponents)
