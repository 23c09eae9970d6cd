"""The exponent of displacement at the sharpest edge of a body."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

from solidgear.core.meshing.corners import SHOULDER, sharpest_corner

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: at the end of an averaged seat, where the load on a smooth surface ends
LOAD_EDGE = 1.0
#: at the end of a rigid seat, a clamp on a smooth surface (Williams 1952, clamped-free at 180
#: degrees), and in a shoulder (clamped-free at 270 degrees)
RIGID_EDGE, RIGID_CORNER = 1 / 2, 1 / 3
#: where two materials meet at a smooth surface, and at a shoulder
JOINT, JOINT_AT_SHOULDER = 0.6, 0.5


def sharpest_exponent(scene: Scene) -> float:
    """Return the exponent of displacement at the sharpest edge: of shoulders, features, ends of seats
    and joints of materials.

    Examples
    --------
    >>> import solidgear as sg
    >>> round(sharpest_exponent(sg.load("geometry/shaft_stepped.toml")), 4)
    0.5445
    """
    return min(_exponents(scene))


def _exponents(scene: Scene) -> Iterator[float]:
    """Yield the exponents of all edges."""
    yield LOAD_EDGE
    yield sharpest_corner(scene)[1]
    if any(feature.notched for feature in scene.features):
        yield SHOULDER
    for station in scene.stations:
        if station.attachment == "rigid":
            ends = (station.lo, station.hi)
            near = 1e-9 * scene.length
            notched = any(
                abs(edge.y - end) < near
                for edge in scene.outline.edges
                if edge.steps
                for end in ends
            )
            yield RIGID_CORNER if notched else RIGID_EDGE
    for a, b in pairwise(scene.segments):
        if a.material != b.material:
            yield JOINT if a.outer1 == b.outer0 else JOINT_AT_SHOULDER
