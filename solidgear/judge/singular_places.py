"""Places in a shaft where stress is singular on its model: re-entrant corners, ends of seats,
planes of section ties, changes of material.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.meshing.grading import corner_length
from solidgear.scene.attached import attached_stations

if TYPE_CHECKING:
    from solidgear.scene import Scene, Segment
    from solidgear.scene.outline import Edge

#: a surface that turns by less than this (rad) from one segment to the next counts as smooth
SMOOTH = 0.05


@dataclass(frozen=True)
class Place:
    """A point of the meridian where stress is singular, or jumps."""

    what: str  #: in a sentence: ``the {what} at y = ...``
    #: y, r: m
    y: float
    r: float
    #: how far it rules the displacements around it, m: the wall there, or the radius of a solid
    #: shaft; for the end of a seat the width of the seat, if that is less
    reach: float


def singular_places(scene: Scene, attachments: tuple[str, ...] | None = None) -> tuple[Place, ...]:
    """All of a scene, those that are listed first naming a point that several share.

    Parameters
    ----------
    attachments : tuple of str, optional
        How every station is tied; by default as the scene says.

    Examples
    --------
    >>> import solidgear as sg
    >>> places = singular_places(sg.load("geometry/shaft_stepped.toml"))
    >>> [(p.what, round(1e3 * p.y), round(1e3 * p.r)) for p in places[:2]]
    [('shoulder', 120, 25), ('shoulder', 280, 30)]
    """
    found: list[Place] = []
    for edge in scene.outline.edges:
        what = _corner(edge)
        if what:
            a, b = scene.segments[edge.joint - 1 : edge.joint + 1]
            found.append(Place(what, edge.y, edge.r, min(corner_length(a), corner_length(b))))
    for corner in (c for c in scene.outline.corners if c.root):
        r, y = corner.middle
        found.append(Place(f"{corner.kind} {corner.name}", y, r, corner.axial + corner.radial))
    for a, b in zip(scene.segments, scene.segments[1:]):
        if a.material != b.material:
            reach = min(corner_length(a), corner_length(b))
            found += _around("change of material", a.y1, min(a.outer1, b.outer0), a, b, reach)
    for station in scene.stations:
        ties = [tie for _, tie in attached_stations([station], attachments)]
        if "section" in ties:
            here = _segment(scene, station.y)
            r = here.radius_at(station.y)[1]
            what = f"section plane of {station.name}"
            found += _around(what, station.y, r, here, here, corner_length(here))
        if {"average", "rigid"} & set(ties):
            # also where its surface ends: the shear that the seat carries meets a face that is free
            # of it, and rotations go with the logarithm of the distance
            for y in (station.lo, station.hi):
                here = _segment(scene, y, inside=station.y)
                what = f"seat end of {station.name}"
                reach = min(corner_length(here), station.hi - station.lo)
                found.append(Place(what, y, here.radius_at(y)[1], reach))
    return _distinct(found, 1e-9 * scene.length)


def _corner(edge: Edge) -> str:
    """A re-entrant corner in words: a step, or a surface that turns; empty where there is none."""
    outer = edge.surface == "outer"
    if edge.root:
        return ""
    if edge.steps:
        return "shoulder" if outer else "step of the bore"
    if edge.r > 0 and edge.bend > SMOOTH:
        return f"concave kink of the {'surface' if outer else 'bore'}"
    return ""


def _around(what: str, y: float, r: float, a: Segment, b: Segment, reach: float) -> list[Place]:
    """Ends of a line across the wall: on the outer surface, and on the bore where there is one."""
    out = [Place(what, y, r, reach)]
    bore = max(a.radius_at(y)[0], b.radius_at(y)[0])
    if bore > 0:
        out.append(Place(f"{what} in the bore", y, bore, reach))
    return out


def _segment(scene: Scene, y: float, inside: float | None = None) -> Segment:
    """The segment at a place; of two that meet there, the one towards `inside`."""
    toward = y if inside is None else y + 1e-6 * (inside - y)
    return next((s for s in scene.segments if toward <= s.y1), scene.segments[-1])


def _distinct(found: list[Place], tolerance: float) -> tuple[Place, ...]:
    """One of several that share a point: the first."""
    out: list[Place] = []
    for place in found:
        if all(np.hypot(place.y - p.y, place.r - p.r) > tolerance for p in out):
            out.append(place)
    return tuple(out)
