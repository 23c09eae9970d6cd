"""The catalogue of singular places of a shaft: re-entrant corners, joints of materials, ends of seats,
planes of section ties. All that refines, judges or names such places reads it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import atan2, pi
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from solidgear.core.errors import NoBounds
from solidgear.core.meshing.grading import corner_length
from solidgear.core.meshing.meeting import SAME, Meeting, meeting
from solidgear.core.meshing.wedge import SAME_ANGLE, wedge_exponent
from solidgear.core.safety import LOAD_EDGE, UNRESOLVED
from solidgear.core.scene.coned import coned
from solidgear.core.scene.corner import SURFACES
from solidgear.core.scene.limits import TOUCH
from solidgear.core.scene.shaft import attached_stations, on_face

if TYPE_CHECKING:
    from solidgear.core.scene import Scene, Segment
    from solidgear.core.scene.feature import OnSegment
    from solidgear.core.scene.outline import Edge
    from solidgear.core.scene.parts import Material
    from solidgear.core.scene.shaft import Station

#: share of the reach of a place that no drawing is meant to, and of its energy that may lie within
DETAIL, DECIDING = 0.01, 0.1


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
    round: bool = False  #: a fillet, where stress is large and not singular

    @property
    def sharp(self) -> bool:
        """Whether stress is singular there, and does not just jump."""
        return self.exponent < LOAD_EDGE

    def within(self, distance: float) -> float:
        """Return the share of the energy that stress at the place stores which lies no farther from it,
        m.
        """
        return share_within(distance / self.reach, self.exponent)

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Return the distance (n,) of points (3, n) from it, m."""
        return np.hypot(np.hypot(points[0], points[2]) - self.r, points[1] - self.y)

    def nearest(self, point: np.ndarray) -> np.ndarray:
        """Return what of it (3,) is nearest to a point, m."""
        x, _, z = point
        angle = np.arctan2(z, x)
        return np.array([self.r * np.cos(angle), self.y, self.r * np.sin(angle)])


def singular_places(
    scene: Scene, ties: Iterable[tuple[Station, str]] | None = None
) -> tuple[Place, ...]:
    """Return the singular places of a scene, with stations tied as the scene says or as given, each
    with the exponent of what meets there; where several share a point, the first listed names it.

    Examples
    --------
    >>> import solidgear as sg
    >>> places = singular_places(sg.load("geometry/shaft_stepped.toml"))
    >>> [(p.what, round(1e3 * p.y), round(1e3 * p.r), round(p.exponent, 3)) for p in places[:2]]
    [('shoulder', 120, 25, 0.544), ('shoulder', 280, 30, 0.544)]
    """
    tied = list(attached_stations(scene.stations) if ties is None else ties)
    rigid = [station for station, tie in tied if tie == "rigid"]
    shape, tol = coned(scene), SAME * scene.length
    places: list[Place] = []
    for spot in (*_blends(scene, shape), *_corners(shape), *_joints(shape), *_loaded(shape, tied)):
        if any(np.hypot(spot.y - p.y, spot.r - p.r) <= tol for p in places):
            continue
        meets = spot.meets or meeting(shape.segments, spot.y, spot.r, rigid)
        what = spot.what if meets is None else _named(spot, meets, rigid, tol)
        exponent = LOAD_EDGE if meets is None else meets.exponent
        is_round = spot.meets is not None and spot.meets.angle == pi and not any(spot.meets.held)
        places.append(Place(what, spot.y, spot.r, spot.reach, exponent, is_round))
    return tuple(places)


def feature_exponent(features: Iterable[OnSegment], scene: Scene) -> float:
    """Return the exponent of displacement at some features of a scene: those with notches are cut at
    right angles.
    """
    notched = any(feature.notched for feature in features)
    return wedge_exponent([((1.5 if notched else 1.0) * pi, scene.segments[0].material)])


def share_within(distance: float, exponent: float) -> float:
    """Return the share of the energy that stress at a place stores which lies no farther from it, in
    reaches of the place: it goes with the power 2 a.
    """
    return min(distance, 1.0) ** (2 * exponent)


def refuse_unresolved(what: str, share: float) -> None:
    """Refuse bars where so large a share of the energy at a place lies nearer than any cell."""
    if share > UNRESOLVED:
        raise NoBounds(
            f"no mesh resolves the {what}, so much softer is the material under what is held there: to "
            "the last micrometre the place decides numbers; let it end elsewhere, or use "
            'attachment = "average"'
        )


def sharpest_exponent(scene: Scene, rigid: Collection[str] | None = None) -> float:
    """Return the exponent of displacement at the sharpest edge: of shoulders, features, joints of
    materials and ends of seats; `rigid` are names of stations, unless those that the scene says.

    Examples
    --------
    >>> import solidgear as sg
    >>> round(sharpest_exponent(sg.load("geometry/shaft_stepped.toml")), 4)
    0.5445
    """
    ties = attached_stations(scene.stations)
    if rigid is not None:
        ties = ((s, "rigid" if s.name in rigid else "average") for s in scene.stations)
    return min(
        LOAD_EDGE,
        feature_exponent(scene.features, scene),
        *(place.exponent for place in singular_places(scene, ties)),
    )


def end_exponent(scene: Scene, station: Station, rigid: Sequence[Station]) -> float:
    """Return the exponent of displacement at the sharper end of a seat, with those of some stations
    rigid.
    """
    segments = coned(scene).segments
    ends = [(y, _segment(scene, y, station.y).radius_at(y)[1]) for y in (station.lo, station.hi)]
    meets = [meeting(segments, y, r, rigid) for y, r in ends]
    return min((m.exponent for m in meets if m is not None), default=LOAD_EDGE)


def undecided_ends(scene: Scene) -> Iterator[str]:
    """Yield a sentence on every place whose energy lies so near to it that details of a drawing decide
    numbers: where a rigid seat ends with a much softer material under it.
    """
    for place in singular_places(scene):
        detail = DETAIL * place.reach
        share = place.within(detail)
        if share > DECIDING:
            yield (
                f"where exactly the {place.what} lies (y = {1e3 * place.y:.4g} mm) decides numbers: the "
                f"softer material lies under that seat, and {100 * share:.0f} % of what its end gives "
                f"way comes from within {1e3 * detail:.2g} mm; make sure of the place, or use "
                'attachment = "average"'
            )


class _Spot(NamedTuple):
    """A point of the meridian, m, at which stress may be singular."""

    what: str
    y: float
    r: float
    reach: float
    #: at a blend that segments have not; None where segments meet
    meets: Meeting | None = None


def _named(spot: _Spot, meets: Meeting, rigid: Iterable[Station], tol: float) -> str:
    """Return a spot in words; where a rigid seat ends on a joint of materials, by both."""
    if not meets.joined or sum(meets.held) != 1:
        return spot.what
    seats = [s.name for s in rigid if s.lo - tol <= spot.y <= s.hi + tol]
    return f"seat end of {seats[0]} at a change of material"


def _blends(scene: Scene, shape: Scene) -> Iterator[_Spot]:
    """Yield fillets and chamfers in shoulders: a chamfer at both of its corners, which are those of a
    cone in the shape wherever it has room for one.
    """
    for corner in scene.outline.corners:
        if not corner.root:
            continue
        what, reach = f"{corner.kind} {corner.name}", corner.axial + corner.radial
        material = shape.segments[corner.owner].material
        if corner.centre is not None:
            yield _Spot(what, *corner.middle[::-1], reach, _wedge(pi, material))
            continue
        slope, is_cone = atan2(corner.radial, corner.axial), shape is not scene
        for (r, y), turn in ((corner.on_face, pi / 2 - slope), (corner.on_cylinder, slope)):
            yield _Spot(what, y, r, reach, None if is_cone else _wedge(pi + turn, material))


def _wedge(angle: float, material: Material, held: bool = False) -> Meeting:
    """Return one material of an angle, rad, with one face held or none."""
    return Meeting(((angle, material),), (held, False))


def _corners(scene: Scene) -> Iterator[_Spot]:
    """Yield re-entrant corners of the outline."""
    for edge in scene.outline.edges:
        kind = _corner(edge)
        if kind:
            a, b = scene.segments[edge.joint - 1 : edge.joint + 1]
            yield _Spot(kind, edge.y, edge.r, min(corner_length(a), corner_length(b)))


def _corner(edge: Edge) -> str:
    """Return a re-entrant corner in words: a step, or a surface that turns; empty where there is
    none.
    """
    outer = edge.surface == "outer"
    if edge.root:
        return ""
    if edge.steps:
        return "shoulder" if outer else "step of the bore"
    if edge.r > 0 and edge.bend > SAME_ANGLE:
        return f"concave kink of the {'surface' if outer else 'bore'}"
    return ""


def _joints(scene: Scene) -> Iterator[_Spot]:
    """Yield the ends of joints of two materials."""
    for joint, (a, b) in enumerate(zip(scene.segments, scene.segments[1:]), 1):
        if a.material == b.material:
            continue
        reach = min(corner_length(a), corner_length(b))
        for edge in sorted(scene.outline.edges_at(joint), key=lambda e: e.surface != "outer"):
            where = "" if edge.surface == "outer" else " in the bore"
            r = edge.root.on_face[0] if edge.root else edge.r
            if r > 0:
                yield _Spot(f"change of material{where}", edge.y, r, reach)


def _loaded(scene: Scene, ties: Iterable[tuple[Station, str]]) -> Iterator[_Spot]:
    """Yield the ends of seats, also where the surface ends: the shear that the seat carries meets a
    face that is free of it, and rotations go with the logarithm of the distance; and the ends of
    planes and faces that carry a load.
    """
    for station, tie in ties:
        if tie == "section" or on_face(station):
            plane = "section plane" if tie == "section" else "rim of the held face"
            yield from _rings(scene, station.y, f"{plane} of {station.name}", tie == "rigid")
            continue
        for y in (station.lo, station.hi):
            segment = _segment(scene, y, inside=station.y)
            reach = min(corner_length(segment), station.hi - station.lo)
            yield _Spot(f"seat end of {station.name}", y, segment.radius_at(y)[1], reach)


def _rings(scene: Scene, y: float, kind: str, held: bool) -> Iterator[_Spot]:
    """Yield the rings at which a plane ends, or an end face, held or not: at a rim that is rounded off or
    cut, where the blend begins.
    """
    segment = _segment(scene, y)
    reach = corner_length(segment)
    rims = {c.surface: c for c in scene.outline.corners if not c.root and abs(c.y - y) < TOUCH}
    for surface, r in zip(SURFACES, segment.radius_at(y)[::-1]):
        what = kind if surface == "outer" else f"{kind} in the bore"
        if rim := rims.get(surface):
            turn = 0.0 if rim.centre else atan2(rim.axial, rim.radial)
            yield _Spot(what, y, rim.on_face[0], reach, _wedge(pi - turn, segment.material, held))
        elif r > 0:
            yield _Spot(what, y, r, reach)


def _segment(scene: Scene, y: float, inside: float | None = None) -> Segment:
    """Return the segment at a place; of two that meet there, the one towards `inside`."""
    toward = y if inside is None else y + 1e-6 * (inside - y)
    return next((s for s in scene.segments if toward <= s.y1), scene.segments[-1])
