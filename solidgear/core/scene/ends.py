"""Ends of seats: moved onto a face or step that they miss by a hair, and away from steps under masses.

Positions that are rounded in the last digit leave gaps of nanometres, which no assembly makes: a
cell in such a gap is 1e7 times shorter than its neighbours, drowns soft modes in rounding, and is no
line to a CAD kernel.  A hub has one bore: the seat of a mass that a step divides is its longest
piece, and the mass stays in place.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, TypeVar

from solidgear.core.scene.limits import TOUCH
from solidgear.core.scene.outline import Outline

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Segment
    from solidgear.core.scene.point_mass import PointMass
    from solidgear.core.scene.stations import Bearing, Port

#: largest gap that is closed, m, or over the length of the shaft if that is more: the CAD kernel
#: has no lines of 1e-7 m, and the least seat is a millionth of the length
HAIR, HAIR_OF_LENGTH = 1.5e-7, 5e-7
#: largest such gap over the seat
SHARE = 0.25

Station = TypeVar("Station", "Bearing", "Port", "PointMass")


def snap_seats(stations: Sequence[Station], segments: Sequence[Segment]) -> tuple[Station, ...]:
    """Return stations with ends of seats moved onto the faces and joints that they miss by a hair."""
    marks = [segments[0].y0, *(s.y1 for s in segments)]
    return tuple(_snapped(station, marks) for station in stations)


def seat_masses(
    masses: Sequence[PointMass], segments: Sequence[Segment], stations: Collection[str]
) -> tuple[PointMass, ...]:
    """Return masses with names, each on the longest piece of its seat between steps; one on a segment,
    which is no station of that name, sits on all of it.
    """
    steps = Outline(segments).steps if masses else ()
    by_name = {segment.name: segment for segment in segments if segment.name not in stations}
    return tuple(_seated(_on_segment(mass, by_name), steps, k) for k, mass in enumerate(masses, 1))


def _on_segment(mass: PointMass, segments: Mapping[str, Segment]) -> PointMass:
    segment = segments.get(mass.on or "")
    if segment is None:
        return mass
    middle = (segment.y0 + segment.y1) / 2
    return mass.model_copy(update={"on": None, "y": middle, "seat_width": segment.length})


def _seated(mass: PointMass, steps: Sequence[float], number: int) -> PointMass:
    if not mass.name:
        mass = mass.model_copy(update={"name": f"mass {number}"})
    if mass.seat_width is None:
        return mass
    between = [y for y in steps if mass.lo + TOUCH < y < mass.hi - TOUCH]
    if not between:
        return mass
    lo, hi = max(pairwise([mass.lo, *between, mass.hi]), key=lambda piece: piece[1] - piece[0])
    y, (x, along, z) = (lo + hi) / 2, mass.offset
    moved = {"y": y, "seat_width": hi - lo, "offset": (x, along + mass.y - y, z)}
    return mass.model_copy(update=moved)


def _snapped(station: Station, marks: Sequence[float]) -> Station:
    # a mass on another's seat, or faces of a body without an axis
    if getattr(station, "seat_width", 0.0) is None or getattr(station, "patch", None):
        return station
    hair = min(
        max(HAIR, HAIR_OF_LENGTH * (marks[-1] - marks[0])), SHARE * (station.hi - station.lo)
    )
    ends = []
    for y in (station.lo, station.hi):
        nearest = min(marks, key=lambda mark: abs(mark - y))
        ends.append(nearest if abs(nearest - y) <= hair else y)
    lo, hi = ends
    if (lo, hi) == (station.lo, station.hi):
        return station
    if "lo" in type(station).model_fields:
        return station.model_copy(update={"lo": lo, "hi": hi})
    return station.model_copy(update={"y": (lo + hi) / 2, "seat_width": hi - lo})
