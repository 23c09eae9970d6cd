"""Places in a shaft where stress is singular on its model: re-entrant corners, ends of seats,
planes of section ties, changes of material.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.meshing.grading import corner_length
from solidgear.core.scene.shaft import attached_stations

if TYPE_CHECKING:
    from solidgear.core.scene import Scene, Segment
    from solidgear.core.scene.outline import Edge

#: a surface that turns by less than this (rad) from one segment to the next counts as smooth
SMOOTH = 0.05


@dataclass(frozen=True)
class Place:
    """A point of the meridian where stress is singular, or jumps."""

    what: str  #: in a sentence: ``the {what} at y = ...``
    #: y, r: m
    y: float
    r: float
    #: distance to which it rules the displacements, m: the wall there, or the radius of a solid
    #: shaft; for the end of a seat the width of the seat, if that is less
    reach: float


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
            places.append(Place(kind, edge.y, edge.r, min(corner_length(a), corner_length(b))))
    for corner in (c for c in scene.outline.corners if c.root):
        r, y = corner.middle
        places.append(Place(f"{corner.kind} {corner.name}", y, r, corner.axial + corner.radial))
    for a, b in zip(scene.segments, scene.segments[1:]):
        if a.material != b.material:
            reach = min(corner_length(a), corner_length(b))
            places += _wall_places("change of material", a.y1, min(a.outer1, b.outer0), a, b, reach)
    for station in scene.stations:
        ties = [tie for _, tie in attached_stations([station], attachments)]
        if "section" in ties:
            segment = _segment(scene, station.y)
            r = segment.radius_at(station.y)[1]
            kind = f"section plane of {station.name}"
            places += _wall_places(kind, station.y, r, segment, segment, corner_length(segment))
        if {"average", "rigid"} & set(ties):
            # also where its surface ends: the shear that the seat carries meets a face that is free
            # of it, and rotations go with the logarithm of the distance
            for y in (station.lo, station.hi):
                segment = _segment(scene, y, inside=station.y)
                kind = f"seat end of {station.name}"
                reach = min(corner_length(segment), station.hi - station.lo)
                places.append(Place(kind, y, segment.radius_at(y)[1], reach))
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
    kind: str, y: float, r: float, a: Segment, b: Segment, reach: float
) -> list[Place]:
    """Return the ends of a line across the wall: on the outer surface, and on the bore where there
    is one.
    """
    out = [Place(kind, y, r, reach)]
    bore = max(a.radius_at(y)[0], b.radius_at(y)[0])
    if bore > 0:
        out.append(Place(f"{kind} in the bore", y, bore, reach))
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
