"""Places in a shaft where stress is singular on its model: re-entrant corners, ends of seats,
planes of section ties, changes of material.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.meshing.corners import filled_at
from solidgear.meshing.grading import corner_length
from solidgear.scene.attached import attached_stations

if TYPE_CHECKING:
    from solidgear.scene import Scene, Segment

#: a surface that turns by less than this (rad) from one segment to the next counts as smooth
SMOOTH = 0.05


@dataclass(frozen=True)
class Place:
    """A point of the meridian where stress is singular, or jumps.

    Attributes
    ----------
    what : str
        In a sentence: ``the {what} at y = ...``.
    y, r : float
        m.
    reach : float
        How far it rules the displacements around it, m: the wall there, or the radius of a solid
        shaft; for the end of a seat the width of the seat, if that is less.
    """

    what: str
    y: float
    r: float
    reach: float


def singular_places(scene: Scene, attachments: tuple[str, ...] | None = None) -> tuple[Place, ...]:
    """All of a scene, those that are listed first naming a point that several share.

    Parameters
    ----------
    scene : Scene
    attachments : tuple of str, optional
        How every station is tied; by default as the scene says.

    Returns
    -------
    tuple of Place

    Examples
    --------
    >>> import solidgear as sg
    >>> places = singular_places(sg.load("geometry/shaft_stepped.toml"))
    >>> [(p.what, round(1e3 * p.y), round(1e3 * p.r)) for p in places[:2]]
    [('shoulder', 120, 25), ('shoulder', 280, 30)]
    """
    found: list[Place] = []
    for a, b in zip(scene.segments, scene.segments[1:]):
        found += _corners(a, b, filled_at(scene, b.y0))
    for corner in (c for c in scene.corners if c.root):
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
            r = _outer(here, station.y)
            what = f"section plane of {station.name}"
            found += _around(what, station.y, r, here, here, corner_length(here))
        if {"average", "rigid"} & set(ties):
            # also where its surface ends: the shear that the seat carries meets a face that is free
            # of it, and rotations go with the logarithm of the distance
            for y in (station.lo, station.hi):
                here = _segment(scene, y, inside=station.y)
                what = f"seat end of {station.name}"
                reach = min(corner_length(here), station.hi - station.lo)
                found.append(Place(what, y, _outer(here, y), reach))
    return _distinct(found, 1e-9 * scene.length)


def _corners(a: Segment, b: Segment, filled: tuple[str, ...]) -> list[Place]:
    """Re-entrant corners where one segment follows another: steps, and surfaces that turn."""
    reach = min(corner_length(a), corner_length(b))
    out = []
    if "outer" in filled:
        pass
    elif abs(a.outer1 - b.outer0) > 1e-9 * a.length:
        out.append(Place("shoulder", a.y1, min(a.outer1, b.outer0), reach))
    elif _slope(b, "outer") - _slope(a, "outer") > SMOOTH:
        out.append(Place("concave kink of the surface", a.y1, b.outer0, reach))
    if "bore" in filled:
        pass
    elif abs(a.inner1 - b.inner0) > 1e-9 * a.length:
        out.append(Place("step of the bore", a.y1, max(a.inner1, b.inner0), reach))
    elif max(b.inner0, a.inner1) > 0 and _slope(a, "inner") - _slope(b, "inner") > SMOOTH:
        out.append(Place("concave kink of the bore", a.y1, b.inner0, reach))
    return out


def _slope(segment: Segment, side: str) -> float:
    """Angle (rad) of a surface to the axis."""
    rise = getattr(segment, f"{side}1") - getattr(segment, f"{side}0")
    return float(np.arctan(rise / segment.length))


def _around(what: str, y: float, r: float, a: Segment, b: Segment, reach: float) -> list[Place]:
    """Ends of a line across the wall: on the outer surface, and on the bore where there is one."""
    out = [Place(what, y, r, reach)]
    bore = max(_inner(a, y), _inner(b, y))
    if bore > 0:
        out.append(Place(f"{what} in the bore", y, bore, reach))
    return out


def _segment(scene: Scene, y: float, inside: float | None = None) -> Segment:
    """The segment at a place; of two that meet there, the one towards `inside`."""
    toward = y if inside is None else y + 1e-6 * (inside - y)
    return next((s for s in scene.segments if toward <= s.y1), scene.segments[-1])


def _outer(segment: Segment, y: float) -> float:
    t = (y - segment.y0) / segment.length
    return (1 - t) * segment.outer0 + t * segment.outer1


def _inner(segment: Segment, y: float) -> float:
    t = (y - segment.y0) / segment.length
    return (1 - t) * segment.inner0 + t * segment.inner1


def _distinct(found: list[Place], tolerance: float) -> tuple[Place, ...]:
    """One of several that share a point: the first."""
    out: list[Place] = []
    for place in found:
        if all(np.hypot(place.y - p.y, place.r - p.r) > tolerance for p in out):
            out.append(place)
    return tuple(out)
