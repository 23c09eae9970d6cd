"""Places in a shaft where stress is singular on its model: re-entrant corners, ends of seats,
planes of section ties, changes of material.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Protocol

import numpy as np

from solidgear.core.bounds.refining import EXPONENT, corner_strength
from solidgear.core.meshing.grading import corner_length
from solidgear.core.scene.shaft import attached_stations

if TYPE_CHECKING:
    from solidgear.core.scene import Scene, Segment
    from solidgear.core.scene.outline import Edge

#: a surface that turns by less than this (rad) from one segment to the next counts as smooth
SMOOTH = 0.05


class Singular(Protocol):
    """A place where stress is singular, or jumps."""

    @property
    def what(self) -> str:
        """What it is, in a sentence: ``the {what} at y = ...``."""

    @property
    def reach(self) -> float:
        """Distance to which it rules the displacements, m."""

    @property
    def exponent(self) -> float:
        """Exponent of displacement there: the less, the sharper."""

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Return the distance (n,) of points (3, n) from it, m."""

    def nearest(self, point: np.ndarray) -> np.ndarray:
        """Return what of it (3,) is nearest to a point, m."""


@dataclass(frozen=True)
class Place:
    """A circle around the axis where stress is singular, or jumps."""

    what: str
    #: y, r: m
    y: float
    r: float
    #: m: the wall there, or the radius of a solid shaft; for the end of a seat the width of the
    #: seat, if that is less
    reach: float
    exponent: float = 1.0

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Return the distance (n,) of points (3, n) from it, m."""
        return np.hypot(np.hypot(points[0], points[2]) - self.r, points[1] - self.y)

    def nearest(self, point: np.ndarray) -> np.ndarray:
        """Return what of it (3,) is nearest to a point, m."""
        x, _, z = point
        angle = np.arctan2(z, x)
        return np.array([self.r * np.cos(angle), self.y, self.r * np.sin(angle)])


def singular_places(scene: Scene, attachments: tuple[str, ...] | None = None) -> tuple[Place, ...]:
    """Return the singular places of a scene, with all stations tied by `attachments` or as the
    scene says; where several share a point, the first listed names it.

    Examples
    --------
    >>> import solidgear as sg
    >>> places = singular_places(sg.load("geometry/shaft_stepped.toml"))
    >>> [(p.what, round(1e3 * p.y), round(1e3 * p.r)) for p in places[:2]]
    [('shoulder', 120, 25), ('shoulder', 280, 30)]
    """
    places: list[Place] = []
    for edge in scene.outline.edges:
        kind = _corner(edge)
        if kind:
            a, b = scene.segments[edge.joint - 1 : edge.joint + 1]
            reach = min(corner_length(a), corner_length(b))
            exponent = corner_strength("re-entrant", edge.angle)
            places.append(Place(kind, edge.y, edge.r, reach, exponent))
    for corner in (c for c in scene.outline.corners if c.root):
        r, y = corner.middle
        places.append(Place(f"{corner.kind} {corner.name}", y, r, corner.axial + corner.radial))
    for a, b in zip(scene.segments, scene.segments[1:]):
        if a.material != b.material:
            reach = min(corner_length(a), corner_length(b))
            r, exponent = min(a.outer1, b.outer0), EXPONENT["material"]
            places += _wall_places("change of material", a.y1, r, a, b, reach, exponent)
    for station in scene.stations:
        ties = [tie for _, tie in attached_stations([station], attachments)]
        if "section" in ties:
            segment = _segment(scene, station.y)
            r = segment.radius_at(station.y)[1]
            kind = f"section plane of {station.name}"
            reach, exponent = corner_length(segment), EXPONENT["section"]
            places += _wall_places(kind, station.y, r, segment, segment, reach, exponent)
        if {"average", "rigid"} & set(ties):
            # also where its surface ends: the shear that the seat carries meets a face that is free
            # of it, and rotations go with the logarithm of the distance
            for y in (station.lo, station.hi):
                segment = _segment(scene, y, inside=station.y)
                kind = f"seat end of {station.name}"
                reach = min(corner_length(segment), station.hi - station.lo)
                exponent = corner_strength("rigid" if "rigid" in ties else "load", pi)
                places.append(Place(kind, y, segment.radius_at(y)[1], reach, exponent))
    return _distinct(places, 1e-9 * scene.length)


def _corner(edge: Edge) -> str:
    """Return a re-entrant corner in words: a step, or a surface that turns; empty where there is
    none.
    """
    outer = edge.surface == "outer"
    if edge.root:
        return ""
    if edge.steps:
        return "shoulder" if outer else "step of the bore"
    if edge.r > 0 and edge.bend > SMOOTH:
        return f"concave kink of the {'surface' if outer else 'bore'}"
    return ""


def _wall_places(
    kind: str, y: float, r: float, a: Segment, b: Segment, reach: float, exponent: float
) -> list[Place]:
    """Return the ends of a line across the wall: on the outer surface, and on the bore where there
    is one.
    """
    out = [Place(kind, y, r, reach, exponent)]
    bore = max(a.radius_at(y)[0], b.radius_at(y)[0])
    if bore > 0:
        out.append(Place(f"{kind} in the bore", y, bore, reach, exponent))
    return out


def _segment(scene: Scene, y: float, inside: float | None = None) -> Segment:
    """Return the segment at a place; of two that meet there, the one towards `inside`."""
    toward = y if inside is None else y + 1e-6 * (inside - y)
    return next((s for s in scene.segments if toward <= s.y1), scene.segments[-1])


def _distinct(places: list[Place], tolerance: float) -> tuple[Place, ...]:
    """Return the first of all places that share a point."""
    out: list[Place] = []
    for place in places:
        if all(np.hypot(place.y - p.y, place.r - p.r) > tolerance for p in out):
            out.append(place)
    return tuple(out)
