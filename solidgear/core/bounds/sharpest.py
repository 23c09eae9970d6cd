"""The exponent of displacement at the sharpest edge of a body."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from math import pi
from typing import TYPE_CHECKING

from solidgear.core.bounds.wedge import Wedge, wedge_exponent
from solidgear.core.meshing.corners import SHOULDER, sharpest_corner

if TYPE_CHECKING:
    from solidgear.core.scene import Scene
    from solidgear.core.scene.outline import Edge

#: at the end of an averaged seat, where the load on a smooth surface ends
LOAD_EDGE = 1.0


def sharpest_exponent(scene: Scene, rigid: Collection[str] | None = None) -> float:
    """Return the exponent of displacement at the sharpest edge: of shoulders, features, joints of
    materials and ends of seats; `rigid` are names of stations, unless those that the scene says.

    Examples
    --------
    >>> import solidgear as sg
    >>> round(sharpest_exponent(sg.load("geometry/shaft_stepped.toml")), 4)
    0.5445
    """
    if rigid is None:
        rigid = [s.name for s in scene.stations if s.attachment == "rigid"]
    return min(_exponents(scene, rigid))


def _exponents(scene: Scene, rigid: Collection[str]) -> Iterator[float]:
    """Yield the exponents of all edges."""
    yield LOAD_EDGE
    yield sharpest_corner(scene)[1]
    if any(feature.notched for feature in scene.features):
        yield SHOULDER
    joints = [edge for edge in scene.outline.edges if edge.r > 0]
    for edge in joints:
        low, high = scene.segments[edge.joint - 1 : edge.joint + 1]
        if low.material != high.material:
            yield wedge_exponent(_at_joint(scene, edge))
    for station in scene.stations:
        if station.name in rigid:
            for wedges in _at_ends(scene, station.lo, station.hi):
                yield wedge_exponent(wedges, held=True)


def _at_joint(scene: Scene, edge: Edge) -> list[Wedge]:
    """Return what meets on the surface that lies deeper, along the shaft: the segment whose wall is
    larger there has a plane face.
    """
    low, high = (s.material for s in scene.segments[edge.joint - 1 : edge.joint + 1])
    wall = edge.after - edge.before if edge.surface == "outer" else edge.before - edge.after
    before, after = pi / 2 - edge.slopes[0], pi / 2 + edge.slopes[1]
    if edge.steps:
        before, after = (before, pi) if wall > 0 else (pi, after)
    return [(before, low), (after, high)]


def _at_ends(scene: Scene, lo: float, hi: float) -> Iterator[list[Wedge]]:
    """Yield what meets at both ends of the surface of a seat, the wedge under it first."""
    near = 1e-9 * scene.length
    edges = {edge.joint: edge for edge in scene.outline.edges if edge.surface == "outer"}
    for end, side in ((lo, -1), (hi, 1)):
        under = [s.y0 < end - side * 2 * near < s.y1 for s in scene.segments].index(True)
        segment = scene.segments[under]
        end_of_segment = segment.y1 if side > 0 else segment.y0
        if abs(end - end_of_segment) < near:
            yield _beyond(scene, edges.get(under + (side > 0)), under, side)
        else:
            yield [(pi, segment.material)]


def _beyond(scene: Scene, edge: Edge | None, segment: int, side: int) -> list[Wedge]:
    """Return what meets at the end of a segment under a seat: with the next segment if its surface
    goes on or rises there, else with its own face; the edge is None at an end of the shaft.
    """
    if edge is None:
        shape = scene.segments[segment]
        slope = (shape.outer1 - shape.outer0) / (shape.y1 - shape.y0)
        return [(pi / 2 - side * slope, shape.material)]
    wedges = _at_joint(scene, edge)[::side]
    rises = side * (edge.after - edge.before) > 0
    if rises or not edge.steps:
        return wedges
    slope = edge.slopes[0] if side > 0 else edge.slopes[1]
    return [(pi / 2 - side * slope, scene.segments[segment].material)]
