"""A shaft of revolution drawn in gmsh.

The meridian (the half section, radius against y) is drawn once as a planar map in which
neighbouring slabs share their edges, and the whole map is turned about the axis: what was shared
stays shared, so interfaces and planes are conforming without any boolean operation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from math import pi
from typing import TYPE_CHECKING, Any

from solidgear.core.scene.corner import SURFACES, Surface
from solidgear.core.scene.outline import Frustum, Outline, Shape, radii_of

if TYPE_CHECKING:
    from solidgear.core.scene.corner import Corner

Point = tuple[float, float]
#: tangents of two slabs that differ by less are one
STRAIGHT = 1e-6


def tolerance_of(segments: Sequence[Shape]) -> float:
    """Return the length (m) below which two positions are one."""
    return 1e-9 * (segments[-1].y1 - segments[0].y0)


def draw_revolved(
    gmsh: Any,
    outline: Outline,
    planes: Sequence[float],
    circles: Sequence[float],
    start: float = 0.0,
    turn: float = 2.0 * pi,
) -> None:
    """Draw the meridian with shared edges and turn it about y by an angle, from one from +x towards
    -z on, rad. Cross-sections at ``planes`` become element faces, and the outer surface is split
    along circles; both are places y, m.
    """
    occ = gmsh.model.occ
    tolerance = tolerance_of(outline.segments)
    points: dict[Point, int] = {}
    lines: dict[tuple[int, int], int] = {}
    faces = []

    def point(r: float, y: float) -> int:
        for (r0, y0), tag in points.items():
            if abs(r - r0) <= tolerance and abs(y - y0) <= tolerance:
                return tag
        points[r, y] = occ.addPoint(r, y, 0.0)
        return points[r, y]

    def line(a: int, b: int) -> int:
        if (b, a) in lines:
            return -lines[b, a]
        if (a, b) not in lines:
            lines[a, b] = curve(a, b)
        return lines[a, b]

    def curve(a: int, b: int) -> int:
        for corner in outline.corners:
            if corner.centre and {a, b} == {point(*corner.on_face), point(*corner.on_cylinder)}:
                middle = occ.addPoint(*corner.centre, 0.0)
                arc = occ.addCircleArc(a, middle, b)
                occ.remove([(0, middle)])
                return arc
        return occ.addLine(a, b)

    slabs = _slabs(outline.segments, planes, tolerance)
    rows = [
        _rows_between(below, above, outline, tolerance)
        for below, above in zip([None, *slabs], [*slabs, None])
    ]
    for slab, (_, first), (last, _) in zip(slabs, rows, rows[1:]):
        side = first.outer + _cuts(slab, circles, tolerance) + last.outer
        # the bore closes the loop from the last point to the first
        loop = first.bore + first.points + side + last.points[::-1] + last.bore
        tags = list(dict.fromkeys(point(r, y) for r, y in loop))
        curves = [line(a, b) for a, b in zip(tags, tags[1:] + tags[:1])]
        faces.append((2, occ.addPlaneSurface([occ.addCurveLoop(curves)])))
    if start:
        occ.rotate(faces, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, start)
    occ.revolve(faces, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, turn)
    if turn == 2.0 * pi:  # else they bound the volumes
        occ.remove(faces, recursive=True)
    occ.synchronize()
    _embed_tips(gmsh, tolerance)


def _embed_tips(gmsh: Any, tolerance: float) -> None:
    """Make the tip of a conical bore a node of the disc it touches: the two share a point, but no
    curve.
    """
    ends = [(tag, gmsh.model.getValue(0, tag, [])) for _, tag in gmsh.model.getEntities(0)]
    tips = {tag: y for tag, (x, y, _) in ends if abs(x) <= tolerance}
    for _, face in gmsh.model.getEntities(2) if tips else ():
        y = gmsh.model.occ.getCenterOfMass(2, face)[1]
        if gmsh.model.getType(2, face) == "Plane" and len(gmsh.model.getBoundary([(2, face)])) == 1:
            touching = [tag for tag, tip in tips.items() if abs(tip - y) <= 10.0 * tolerance]
            gmsh.model.mesh.embed(0, touching, 2, face)


def _slabs(segments: Sequence[Shape], planes: Iterable[float], tolerance: float) -> list[Frustum]:
    """Return the segments cut at planes."""
    slabs = []
    start = segments[0].y0
    for s in segments:
        inside = {y for y in planes if s.y0 + tolerance < y < s.y1 - tolerance}
        cuts = [s.y0, *sorted(inside), s.y1]
        for a, b in zip(cuts, cuts[1:]):
            if b - a <= tolerance:
                continue
            u, v = (a - s.y0) / (s.y1 - s.y0), (b - s.y0) / (s.y1 - s.y0)
            radii = []
            for low, high in (radii_of(s, surface) for surface in SURFACES):
                radii += [low + u * (high - low), low + v * (high - low)]
            # the end of one slab is the very float that starts the next
            slabs.append(Frustum(start, b, *radii))
            start = b
    return slabs


def _cuts(slab: Frustum, circles: Iterable[float], tolerance: float) -> list[Point]:
    """Return (radius, y) of circles inside a slab, on the outer surface, ascending in y."""
    inside = sorted(y for y in circles if slab.y0 + tolerance < y < slab.y1 - tolerance)
    return [(_radius_at(slab, "outer", y), y) for y in inside]


def _radius_at(slab: Frustum, surface: Surface, y: float) -> float:
    a, b = radii_of(slab, surface)
    return a + (b - a) * (y - slab.y0) / (slab.y1 - slab.y0)


@dataclass(frozen=True)
class _Row:
    """Points (radius, y) of one end of a slab."""

    points: list[Point]  #: from the bore outwards
    #: bore, outer: point at which a rim meets the bore or the outer surface
    bore: list[Point] = field(default_factory=list)
    outer: list[Point] = field(default_factory=list)


def _rows_between(
    below: Frustum | None, above: Frustum | None, outline: Outline, tolerance: float
) -> tuple[_Row, _Row]:
    """Return the points of the end of one slab and of the start of the next; None beyond an end
    face.
    """
    rounded = [c for c in outline.corners if abs(c.y - _place(below, above)) <= tolerance]
    if rounded:
        shared = _shared_face(below, above, rounded, tolerance) if below and above else []
        return (
            _rounded_row(below, -1, shared, rounded, tolerance),
            _rounded_row(above, 1, shared, rounded, tolerance),
        )
    ends = [
        sorted(radii_of(slab, surface)[end] for surface in SURFACES) if slab else []
        for slab, end in ((below, 1), (above, 0))
    ]
    y = _place(below, above)
    rows = []
    for radii, neighbour in zip(ends, reversed(ends)):
        between = {r for r in neighbour if radii and radii[0] < r < radii[1]}
        rows.append(_Row([(r, y) for r in sorted({*radii, *between})]))
    return rows[0], rows[1]


def _shared_face(
    below: Frustum, above: Frustum, rounded: Sequence[Corner], tolerance: float
) -> list[Point]:
    """Return the ends of the face that two slabs share, in the bore and outside.

    It runs from where one fillet meets its cylinder to where the other does, so that no sharp edge
    of a slab lies at a fillet. A surface without a step has its end as far along as the other.
    """
    roots = {c.surface: c for c in rounded if c.root}
    points = []
    ways: Sequence[tuple[Surface, Surface, Callable]] = (
        ("bore", "outer", max),
        ("outer", "bore", min),
    )
    for surface, opposite, deeper in ways:
        before, after = radii_of(below, surface)[1], radii_of(above, surface)[0]
        if surface in roots:
            points.append(roots[surface].on_cylinder)
        elif abs(before - after) > tolerance or opposite not in roots:
            points.append((deeper(before, after), below.y1))
        else:
            root = roots[opposite]
            y = root.on_cylinder[1]
            points.append((_radius_at(above if root.side > 0 else below, surface, y), y))
    return points


def _rounded_row(
    slab: Frustum | None,
    side: int,
    shared: Sequence[Point],
    rounded: Sequence[Corner],
    tolerance: float,
) -> _Row:
    """Return one end of a slab with fillets or chamfers: the face that it shares, and the faces
    beyond.
    """
    if slab is None:
        return _Row([])
    y, end = (slab.y1, 1) if side < 0 else (slab.y0, 0)
    roots = {c.surface: [c.on_face] for c in rounded if c.root}
    rims = {c.surface: c for c in rounded if not c.root and c.side == side}
    edges = {
        surface: rims[surface].on_face if surface in rims else (radii_of(slab, surface)[end], y)
        for surface in SURFACES
    }
    points = list(shared)
    if not shared or radii_of(slab, "outer")[end] > shared[1][0] + tolerance:
        points = [*points, *roots.get("outer", []), edges["outer"]]
    if not shared or radii_of(slab, "bore")[end] < shared[0][0] - tolerance:
        points = [edges["bore"], *roots.get("bore", []), *points]
    on_cylinders = {surface: [rim.on_cylinder] for surface, rim in rims.items()}
    return _Row(points, on_cylinders.get("bore", []), on_cylinders.get("outer", []))


def graded_corners(
    outline: Outline, planes: Iterable[float], circles: Sequence[float], convex: bool = True
) -> list[Point]:
    """Return points (y, radius) of the meridian to grade the size of elements at, m: circles on the
    surface, and where the outline turns, unless `convex` only inwards.

    A fillet or chamfer leaves no corner, but for the two ends of a chamfer at a root.
    """
    tolerance = tolerance_of(outline.segments)
    slabs = _slabs(outline.segments, planes, tolerance)
    corners = [(y, r) for slab in slabs for r, y in _cuts(slab, circles, tolerance)]
    on_end = [y for y in circles if not _near(y, [y for y, _ in corners], tolerance)]
    kinks = _kinks(slabs, on_end, tolerance)
    if not convex:
        kinks = [
            (y, r)
            for y, r in kinks
            if _near(y, on_end, tolerance) or _turns_inwards(y, r, outline, tolerance)
        ]
    corners += kinks
    sharp = [
        (y, r)
        for y, r in corners
        if all(abs(y - c.y) > tolerance or abs(r - c.r) > tolerance for c in outline.corners)
    ]
    chamfered = [c for c in outline.corners if c.root and c.kind == "chamfer"]
    return sharp + [(y, r) for c in chamfered for r, y in (c.on_face, c.on_cylinder)]


def _turns_inwards(y: float, r: float, outline: Outline, tolerance: float) -> bool:
    """Return whether the material around a point of the outline takes more than half a turn."""
    return any(
        edge.angle > pi and _near(y, [edge.y], tolerance) and _near(r, [edge.r], tolerance)
        for edge in outline.edges
    )


def _kinks(slabs: Sequence[Frustum], circles: Sequence[float], tolerance: float) -> list[Point]:
    """Return (y, radius) where the outline turns, and where a circle falls on a slab end."""
    kinks: list[Point] = []
    for below, above in zip([None, *slabs], [*slabs, None]):
        y = _place(below, above)
        for surface in SURFACES:
            radii, slopes = set(), []
            for slab, end in ((below, 1), (above, 0)):
                if slab:
                    ends = radii_of(slab, surface)
                    radii.add(ends[end])
                    slopes.append((ends[1] - ends[0]) / (slab.y1 - slab.y0))
            turns = (
                len(slopes) == 1
                or max(radii) - min(radii) > tolerance
                or abs(slopes[0] - slopes[1]) > STRAIGHT
            )
            if turns or (surface == "outer" and _near(y, circles, tolerance)):
                kinks += [(y, r) for r in radii - {0.0}]
    return kinks


def _place(below: Frustum | None, above: Frustum | None) -> float:
    """Return the place where one slab ends and the next begins."""
    if below:
        return below.y1
    assert above is not None
    return above.y0


def _near(y: float, places: Iterable[float], tolerance: float) -> bool:
    return any(abs(y - place) <= tolerance for place in places)
