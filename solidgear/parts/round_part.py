"""The body of revolution inside a part: the share of the surface that is round about y, as frusta
end to end.

Known of the part are points on the surface, in triangles. A triangle whose corners lie on one line
of the meridian (radius against y) lies on a cone or a cylinder; triangles of one line are one
surface where they go around for more than half of the way. A torus, such as a fillet, is as round,
and becomes short cones of the same volume. Between such surfaces, and where there are none, rays
from the axis give mean radii, that of a circle with the area of the section.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solidgear.core.scene.outline import Frustum, Torus

#: distance from a line of the meridian, over the largest radius, at which a point is on it: mesh
#: files carry six digits and more
ON_LINE = 2e-5
#: share of a turn from which a surface counts as round
MOST_OF_A_TURN = 0.5
#: surfaces looked for, and the share of all area below which none is
MOST_SURFACES, LEAST_SHARE = 300, 2e-5
#: two places along y nearer than this part of the length are one
SAME_PLACE = 2e-6
#: rays around the axis, and slices of a stretch that is not round
RAYS, SLICES = 180, 6
#: shares of a stretch at which its section is looked at, one after the other until it is round
PLACES = (0.4837, 0.1371, 0.8629)
#: a chord of eight to a turn lies this share of the radius inside its circle
CHORD = 0.08
#: rad; facets of a mesh of something round: about twelve or more to a turn, and none that many times
#: as wide as the others (a bar of six or eight edges is none, nor is a shaft with a flat)
WIDEST, MUCH_WIDER = 0.6, 3.0
#: largest share of the volume beside flat facets that curved ones leave, six to a turn and more
CURVED = 0.02
#: cones to a quarter of a turn of the arc
TO_A_QUARTER = 6
#: least points on an arc: three lie on one always
LEAST_POINTS = 12


class Lathe(NamedTuple):
    """A round surface: a cone from (y0, r0) to (y1, r1), m."""

    y0: float
    y1: float
    r0: float
    r1: float
    share: float  #: of a turn that it covers
    deviation: float = 0.0  #: distance up to which a cone of a torus lies beside its triangles, m

    def radius(self, y):
        """Return the radius at y, m."""
        return self.r0 + (self.r1 - self.r0) * (y - self.y0) / (self.y1 - self.y0)


@dataclass(frozen=True)
class RoundPart:
    """The body of revolution that was recognised inside a part."""

    walls: tuple[Frustum, ...]  #: end to end
    surfaces: tuple[Lathe, ...]  #: round surfaces, outer ones and bores
    share: float  #: share of the surface that is round, faces across the axis left out
    #: volume that a mesh may lack beside the round surfaces, m^3: that outside flat triangles with
    #: corners on them, or a small part of it where they are so wide that the part itself may be
    #: many-sided, and no facet but a curved one speaks for something round
    facets: float = 0.0
    arc_deviation: float = 0.0  #: largest distance of walls from the arc of a torus, m
    tori: tuple[Torus, ...] = ()  #: fillets and the like that walls follow as cones
    #: stretches along y, m, in which a part of the surface is not round
    uneven: tuple[tuple[float, float], ...] = ()


def round_part(points: np.ndarray, triangles: np.ndarray) -> RoundPart:
    """Recognise the body of revolution inside a part, from (3, n) points on the surface, m, with y
    as the axis, and closed (3, t) triangles; without walls where no part of the surface is round.

    Examples
    --------
    A prism of 64 sides is round but for the sagitta of its sides:

    >>> turn = 2 * np.pi * np.arange(64) / 64
    >>> ring = np.array([np.cos(turn), 0 * turn, np.sin(turn)])
    >>> points = np.hstack([ring, ring + [[0], [3], [0]], [[0, 0], [0, 3], [0, 0]]])
    >>> k, after = np.arange(64), (np.arange(64) + 1) % 64
    >>> sides = [[k, after, 64 + k], [after, 64 + after, 64 + k]]
    >>> ends = [[k, after, 128 + 0 * k], [64 + k, 64 + after, 129 + 0 * k]]
    >>> body = round_part(points, np.hstack(sides + ends))
    >>> [round(float(v), 9) for v in body.walls[0]]
    [0.0, 3.0, 1.0, 1.0, 0.0, 0.0]
    """
    y, r = points[1], np.hypot(points[0], points[2])
    largest, length = r.max(), np.ptp(y)
    a, b, c = (points[:, t] for t in triangles)
    area = np.linalg.norm(np.cross((b - a).T, (c - a).T), axis=1) / 2
    flat = np.ptp(y[triangles], axis=0) <= 1e-7 * length
    surfaces, is_round, facets = [], np.zeros(len(area), bool), 0.0
    lines = list(_triangles_by_line(y[triangles], r[triangles], area, ~flat, largest))
    for on_line in lines:
        for members in _runs(y[triangles], on_line, SAME_PLACE * length):
            y_of, r_of = y[triangles[:, members]], r[triangles[:, members]]
            surface = _fitted_lathe(y_of, r_of, area[members], largest)
            if surface is not None and surface.share > MOST_OF_A_TURN:
                surfaces.append(surface)
                is_round[members] = True
                facets += _volume_beside(points, triangles[:, members], [surface])
    remaining = np.flatnonzero(~is_round & ~flat)
    arc_deviation = 0.0
    tori: list[Torus] = []
    for places, arc in _arcs(y, r, triangles[:, remaining], ON_LINE * largest):
        members, along, across = remaining[places], arc.y, arc.r
        sides = np.pi * (across[1:] + across[:-1]) * np.hypot(np.diff(along), np.diff(across))
        share = float(area[members].sum() / sides.sum())
        if share > MOST_OF_A_TURN:
            # where an arc is steep, radii by chords and by the arc differ by a part of its size
            deviation = float(np.hypot(np.ptp(along), np.ptp(across))) / 4
            cones = [
                Lathe(float(y0), float(y1), float(r0), float(r1), share, deviation)
                for y0, y1, r0, r1 in zip(along, along[1:], across, across[1:])
            ]
            surfaces += cones
            is_round[members] = True
            facets += _volume_beside(points, triangles[:, members], cones)
            arc_deviation = max(arc_deviation, arc.deviation)
            start, end = float(along[0]), float(along[-1])
            tori.append(Torus(start, end, *arc.centre, arc.radius, arc.side < 0))
    if not surfaces:
        return RoundPart((), (), 0.0)
    walls, by_rays = _walls(points, triangles, surfaces, y.min(), y.max())
    share = float(area[is_round].sum() / area[~flat].sum())
    if by_rays:  # mean radii have the volume of the part, whatever its surface is
        facets = 0.0
    elif not _fine_around(points, triangles[:, is_round], ON_LINE * largest):
        facets *= CURVED
    uneven = tuple(_stretches(y[triangles[:, ~is_round & ~flat]], SAME_PLACE * length))
    return RoundPart(
        tuple(walls), tuple(surfaces), share, facets, arc_deviation, tuple(tori), uneven
    )


def _stretches(y: np.ndarray, near: float) -> Iterator[tuple[float, float]]:
    """Yield the stretches that triangles with corners y (3, t) cover together, m."""
    for members in _runs(y, np.arange(y.shape[1]), near) if y.size else ():
        yield float(y[:, members].min()), float(y[:, members].max())


def _volume_beside(points, triangles, surfaces: list[Lathe]) -> float:
    """Return the volume between round surfaces end to end and their triangles, m^3, by the flux of
    (x, z) / 2.
    """
    a, b, c = (points[:, t] for t in triangles)
    normal = np.cross((b - a).T, (c - a).T).T / 2
    middle = (a + b + c) / 3
    flat = np.abs((middle[[0, 2]] * normal[[0, 2]]).sum(axis=0) / 2).sum()
    cones = sum(_cone_volume(np.array([s.y0, s.y1]), np.array([s.r0, s.r1])) for s in surfaces)
    return abs(float(cones - flat))


def _fine_around(points, triangles, near) -> bool:
    """Return whether triangles are as narrow around the axis as those of a mesh of something
    round.
    """
    x, z = points[0][triangles], points[2][triangles]
    turn = np.where(np.hypot(x, z) > near, np.arctan2(x, z), np.nan)
    gaps = np.abs((turn - np.roll(turn, 1, axis=0) + np.pi) % (2 * np.pi) - np.pi)
    spans = np.nanmax(gaps, axis=0)
    return bool(spans.max() <= min(WIDEST, MUCH_WIDER * np.median(spans)))


def _triangles_by_line(y, r, area, free, largest) -> Iterator[np.ndarray]:
    """Yield the triangles on each line of the meridian, by their corners y and r (3, t), the
    largest surface first.
    """
    free = free.copy()
    total = area.sum()
    # a long seed has a sure slope
    worth = area * np.ptp(y, axis=0)
    for _ in range(MOST_SURFACES):
        seed = int(np.argmax(np.where(free, worth, -1.0)))
        if not free[seed] or area[seed] < LEAST_SHARE * total * 1e-2:
            return
        members = np.array([seed])
        for _ in range(3):
            if _distance(y[:, members], r[:, members], y[:, members], r[:, members]).max() > (
                ON_LINE * largest
            ):
                members = np.zeros(0, int)
                break
            gap = _distance(y[:, members], r[:, members], y[:, free], r[:, free]).max(axis=0)
            members = np.flatnonzero(free)[gap <= ON_LINE * largest]
        free[seed] = False
        if len(members):
            free[members] = False
            if area[members].sum() > LEAST_SHARE * total:
                yield members


def _fit(y, r) -> tuple[float, float, float]:
    """Return the mean y and r of some points, and the slope of the line through them."""
    middle, height = y.mean(), r.mean()
    spread = ((y - middle) ** 2).sum()
    slope = ((y - middle) * (r - height)).sum() / spread if spread else 0.0
    return middle, height, slope


def _distance(y, r, points_y, points_r) -> np.ndarray:
    """Return the distance of points from the line through y and r."""
    middle, height, slope = _fit(y, r)
    return np.abs(points_r - height - slope * (points_y - middle)) / np.hypot(1.0, slope)


def _runs(y, members, near) -> Iterator[np.ndarray]:
    """Yield members in stretches along y without a gap."""
    low, high = y[:, members].min(axis=0), y[:, members].max(axis=0)
    order = np.argsort(low)
    reach = np.maximum.accumulate(high[order])
    starts = np.flatnonzero(low[order][1:] > reach[:-1] + near) + 1
    yield from (members[part] for part in np.split(order, starts))


def _fitted_lathe(y, r, area, largest) -> Lathe | None:
    """Return the round surface of some triangles on one line; None where it has no area or crosses
    the axis.
    """
    y0, y1 = float(y.min()), float(y.max())
    middle, height, slope = _fit(y, r)
    r0, r1 = (float(height + slope * (end - middle)) for end in (y0, y1))
    if abs(r1 - r0) < 0.1 * ON_LINE * largest:
        r0 = r1 = float(np.median(r))
    # chords lie inside the circle, so that even a whole turn covers a little less
    turn = np.pi * (r0 + r1) * np.hypot(y1 - y0, r1 - r0)
    if not turn > 0 or min(r0, r1) < -ON_LINE * largest:
        return None
    return Lathe(y0, y1, max(r0, 0.0), max(r1, 0.0), float(area.sum() / turn))


def _walls(points, triangles, surfaces, first, last) -> tuple[list[Frustum], bool]:
    """Return frusta end to end between the places where a surface begins or ends, and whether some
    of them are of mean radii.
    """
    near = SAME_PLACE * (last - first)
    places = [first, *sorted(p for s in surfaces for p in (s.y0, s.y1)), last]
    cuts = [first]
    for place in places:
        if place > cuts[-1] + near:
            cuts.append(place)
    cuts[-1] = last
    walls: list[Frustum] = []
    by_rays = False
    for y0, y1 in zip(cuts, cuts[1:]):
        crossing = [s for s in surfaces if s.y0 < y0 + near and s.y1 > y1 - near]
        out, bore, outer_alone = _round_at(points, triangles, crossing, y0, y1)
        if out is not None and (bore is not None or outer_alone):
            ends = [s.radius(e) if s else 0.0 for s in (out, bore) for e in (y0, y1)]
            walls.append(Frustum(float(y0), float(y1), *map(float, ends)))
        else:
            walls += _sliced(points, triangles, y0, y1, out, bore)
            by_rays = True
    return _joined(walls, near), by_rays


def _round_at(
    points, triangles, crossing: list[Lathe], y0, y1
) -> tuple[Lathe | None, Lathe | None, bool]:
    """Return the round surfaces outside and in the bore of a stretch, that most rays meet at the first
    place where they do, and whether there is no bore: a slot may take away the middle of it.
    """
    usual: tuple[Lathe | None, Lathe | None, bool] | None = None
    for share in PLACES:
        middle = _inside(y0, y1, share)
        section = _section_radii(points, triangles, middle)
        if section is None:
            continue
        outer, inner = section.middle
        out = max(_at_radius(crossing, middle, outer), key=lambda s: s.radius(middle), default=None)
        inward = [s for s in _at_radius(crossing, middle, inner) if s is not out]
        bore = min(inward, key=lambda s: s.radius(middle), default=None)
        at_place = out, bore, inner == 0.0
        if out is not None or not crossing:
            return at_place
        usual = usual or at_place
    return usual or (None, None, False)


def _inside(y0, y1, share: float = PLACES[0]) -> float:
    """Return a place between two others on which nodes of a mesh hardly lie."""
    return y0 + share * (y1 - y0)


def _at_radius(surfaces, middle, radius) -> list[Lathe]:
    """Return the surfaces at the radius that rays reach, which is that of chords; none at zero."""
    at_radius = []
    for surface in surfaces if radius else ():
        gap = surface.radius(middle) - radius
        if -1e-3 * radius <= gap + surface.deviation and gap - surface.deviation <= CHORD * radius:
            at_radius.append(surface)
    return at_radius


def _sliced(points, triangles, y0, y1, out, bore) -> list[Frustum]:
    """Return frusta of mean radii where the surface is not round."""
    edges = np.linspace(y0, y1, SLICES + 1)
    places, means = [], []
    for a, b in zip(edges, edges[1:]):
        section = _section_radii(points, triangles, _inside(a, b))
        if section is not None:
            places.append((float(a), float(b)))
            means.append(section.mean)
    walls = []
    for (a, b), (outer, inner) in zip(places, _evened(np.array(means))):
        ends = [
            s.radius(e) if s is not None else mean
            for s, mean in ((out, outer), (bore, inner))
            for e in (a, b)
        ]
        walls.append(Frustum(a, b, *map(float, ends)))
    return walls


def _evened(radii: np.ndarray) -> np.ndarray:
    """Return radii (slices, 2) of one section all along as one, where they differ by less than a ray
    more or less.
    """
    if len(radii) and (np.ptp(radii, axis=0) <= radii.max(axis=0) / RAYS).all():
        return np.broadcast_to(np.sqrt((radii**2).mean(axis=0)), radii.shape)
    return radii


def _joined(walls, near) -> list[Frustum]:
    """Join neighbours on one line to one wall: a cut that a bore made is none for the outer
    surface, but both must be in line. Radii of mean circles that differ by rounding are one.
    """
    out: list[Frustum] = []
    for wall in walls:
        if out:
            last = out[-1]
            outer = _going_on(last.outer1, wall.outer0, wall.outer1, near)
            inner = _going_on(last.inner1, wall.inner0, wall.inner1, near)
            wall = Frustum(wall.y0, wall.y1, *outer, *inner)
        if out and _in_line(out[-1], wall):
            before = out.pop()
            wall = Frustum(
                before.y0, wall.y1, before.outer0, wall.outer1, before.inner0, wall.inner1
            )
        out.append(wall)
    return out


def _going_on(before: float, start: float, end: float, near: float) -> tuple[float, float]:
    """Return the radii of a wall, m, from that which the wall before ends with if it is as near."""
    if abs(start - before) > near:
        return start, end
    return before, before if start == end else end


def _in_line(a: Frustum, b: Frustum) -> bool:
    """Return whether two frusta end to end have one outer surface and one bore."""
    for a0, a1, b0, b1 in (
        (a.outer0, a.outer1, b.outer0, b.outer1),
        (a.inner0, a.inner1, b.inner0, b.inner1),
    ):
        slope_a = (a1 - a0) / (a.y1 - a.y0)
        slope_b = (b1 - b0) / (b.y1 - b.y0)
        if abs(a1 - b0) > 1e-6 * a.outer0 or abs(slope_a - slope_b) > 1e-5:
            return False
    return True


class Section(NamedTuple):
    """Outer radius and bore of a section, m."""

    mean: tuple[float, float]  #: of circles of the same area
    middle: tuple[float, float]  #: that half of the rays reach; zero where these miss the part


def _section_radii(points, triangles, y) -> Section | None:
    """Return the radii of a section by rays from the axis; None where no ray meets a surface."""
    cut = _cut_at(points, triangles, y)
    if cut is None:
        return None
    (x0, z0), (x1, z1) = cut
    outer, inner = np.zeros((2, RAYS))
    for k, angle in enumerate(2 * np.pi * (np.arange(RAYS) + 0.37) / RAYS):
        c, s = np.cos(angle), np.sin(angle)
        side0, side1 = c * z0 - s * x0, c * z1 - s * x1
        crossing = (side0 < 0) != (side1 < 0)
        t = side0[crossing] / (side0[crossing] - side1[crossing])
        along = (c * x0 + s * z0)[crossing] * (1 - t) + (c * x1 + s * z1)[crossing] * t
        met = np.sort(along[along > 0])
        if len(met):
            outer[k] = met[-1]
            # an even number of surfaces leaves the axis outside
            inner[k] = met[0] if len(met) % 2 == 0 else 0.0
    reached = outer > 0
    if not reached.any():
        return None
    if 2 * reached.sum() < RAYS:
        # pins and claws: a disc of their area
        return Section((float(np.sqrt((outer**2 - inner**2).mean())), 0.0), (0.0, 0.0))
    middle = float(np.median(outer[reached])), float(np.median(inner[reached]))
    mean = float(np.sqrt((outer**2).mean()))
    hollow = float(np.sqrt((inner**2).mean())) if middle[1] > 0 else 0.0
    return Section((mean, hollow), middle)


def _cut_at(points, triangles, y) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the ends (2, k), x and z in m, of the lines in which triangles cross a plane; None
    where none does.
    """
    heights = points[1][triangles]
    crossing = np.flatnonzero((heights.min(axis=0) < y) & (heights.max(axis=0) > y))
    if not len(crossing):
        return None
    corners = points[:, triangles[:, crossing]]  # (3, corner, t)
    ends = np.zeros((2, 2, len(crossing)))
    count = np.zeros(len(crossing), int)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        p, q = corners[:, i], corners[:, j]
        t = np.divide(y - p[1], q[1] - p[1], out=np.full(len(crossing), -1.0), where=q[1] != p[1])
        hit = (t >= 0) & (t <= 1)
        place = (p + np.clip(t, 0, 1) * (q - p))[[0, 2]]
        for k in (0, 1):
            new = hit & (count == k)
            ends[k][:, new] = place[:, new]
        count += hit
    ok = count >= 2
    return ends[0][:, ok], ends[1][:, ok]


class Arc(NamedTuple):
    """Cones end to end along an arc of the meridian."""

    y: np.ndarray  #: (n,) ends of the cones, m
    r: np.ndarray  #: (n,) m
    deviation: float  #: largest distance of the cones from the arc, m
    centre: tuple[float, float]  #: middle of the arc, y and r, m
    radius: float  #: of the arc, m
    side: float  #: 1 where it lies beyond its middle, seen from the axis, -1 below


def _arcs(y, r, triangles, near) -> Iterator[tuple[np.ndarray, Arc]]:
    """Yield pieces of a surface on one arc of the meridian: their triangles, and the cones.

    `y` and `r` are of points, (n,), m; `triangles` are (3, t), and a point nearer than `near` is on
    the arc. The volume of the cones is that of the arc.
    """
    a, b, c = triangles
    links = coo_array((np.ones(2 * len(a)), (np.r_[a, b], np.r_[b, c])), shape=(len(y), len(y)))
    piece = connected_components(links, directed=False)[1][a]
    for number in np.unique(piece):
        members = np.flatnonzero(piece == number)
        used = np.unique(triangles[:, members])
        arc = _fitted_arc(y[used], r[used], near) if len(used) >= LEAST_POINTS else None
        if arc is not None:
            yield members, arc


def _fitted_arc(y, r, near) -> Arc | None:
    """Return the cones along the arc of some points; None where they are on none."""
    middle, height = y.mean(), r.mean()
    u, v = y - middle, r - height
    matrix = np.column_stack([2 * u, 2 * v, np.ones_like(u)])
    (cu, cv, power), _, rank, _ = np.linalg.lstsq(matrix, u * u + v * v, rcond=1e-9)
    square = power + cu * cu + cv * cv
    if rank < 3 or not square > 0:
        return None
    yc, rc, radius = middle + cu, height + cv, float(np.sqrt(square))
    side = 1.0 if height > rc else -1.0
    # a meridian that turns back has two radii at one place
    if np.abs(np.hypot(y - yc, r - rc) - radius).max() > near or (side * (r - rc)).min() < -near:
        return None
    first, last = (np.arcsin(np.clip((end - yc) / radius, -1, 1)) for end in (y.min(), y.max()))
    count = max(2, int(np.ceil(TO_A_QUARTER * (last - first) / (np.pi / 2) - 1e-3)))
    angle = np.linspace(first, last, count + 1)

    def ends(wider: float) -> tuple[np.ndarray, np.ndarray]:
        size = np.r_[radius, np.full(count - 1, radius * (1 + wider)), radius]
        along = np.clip(yc + size * np.sin(angle), y.min(), y.max())
        along[0], along[-1] = y.min(), y.max()
        return along, np.maximum(rc + side * size * np.cos(angle), 0.0)

    volume = _volume_under(angle[-1], rc, radius, side) - _volume_under(angle[0], rc, radius, side)
    low, high = 0.0, 1e-6
    for _ in range(20):  # the secant, of a volume that is all but linear
        errors = [_cone_volume(*ends(w)) - volume for w in (low, high)]
        if errors[0] == errors[1] or low == high:
            break
        low, high = high, high - errors[1] * (high - low) / (errors[1] - errors[0])
    along, across = ends(high)
    if not (np.diff(along) > 0).all():
        return None
    chords = np.hypot((along[1:] + along[:-1]) / 2 - yc, (across[1:] + across[:-1]) / 2 - rc)
    deviation = float(np.abs(chords - radius).max())
    return Arc(along, across, deviation, (float(yc), float(rc)), radius, side)


def _volume_under(angle, rc, radius, side) -> float:
    """Return the volume below an arc up to an angle, m^3."""
    s, c = np.sin(angle), np.cos(angle)
    straight = (rc * rc + radius * radius) * radius * s - (radius * s) ** 3 / 3
    return float(np.pi * (straight + side * rc * radius**2 * (angle + s * c)))


def _cone_volume(y, r) -> float:
    """Return the volume of cones end to end, m^3."""
    a, b = r[:-1], r[1:]
    return float((np.pi * np.diff(y) * (a * a + a * b + b * b) / 3).sum())
