"""The body of revolution inside a part: what of its surface is round about y, as frusta end to end.

Known of the part are points on its surface, in triangles. A triangle whose corners lie on one line
of the meridian (radius against y) lies on a cone or a cylinder; triangles of one line are one
surface where they go around for more than half of the way. A torus is as round, and is told as
short cones of its volume. Between such surfaces, and where there are none, rays from the axis give
mean radii, that of a circle with the area of the section.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from solidgear.meshing.round_arcs import arcs, cone_volume
from solidgear.scene.outline import Frustum, Torus

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
#: a chord of eight to a turn lies this share of the radius inside its circle
CHORD = 0.08
#: rad; facets of a mesh of something round: about twelve or more to a turn, and none that many times
#: as wide as the others (a bar of six or eight edges is none, nor is a shaft with a flat)
WIDEST, MUCH_WIDER = 0.6, 3.0
#: of the volume beside flat facets: what curved ones leave at most, six to a turn and more
CURVED = 0.02


class Lathe(NamedTuple):
    """A round surface: from (y0, r0) to (y1, r1), m, and the share of a turn it covers; a cone of a
    torus lies beside triangles on it by up to ``beside``, m.
    """

    y0: float
    y1: float
    r0: float
    r1: float
    share: float
    beside: float = 0.0

    def radius(self, y):
        """Radius at y, m."""
        return self.r0 + (self.r1 - self.r0) * (y - self.y0) / (self.y1 - self.y0)


@dataclass(frozen=True)
class RoundPart:
    """The recognised part."""

    walls: tuple[Frustum, ...]  #: end to end
    surfaces: tuple[Lathe, ...]  #: round surfaces, outer ones and bores
    share: float  #: share of the surface that is round, faces across the axis left out
    #: volume that a mesh may lack beside the round surfaces, m^3: that outside flat triangles with
    #: corners on them, or a small part of it where they are so wide that the part itself may be
    #: many-sided, and no facet but a curved one speaks for something round
    facets: float = 0.0
    beside_arcs: float = 0.0  #: largest distance of walls from the arc of a torus, m
    tori: tuple[Torus, ...] = ()  #: that walls follow as cones


def round_part(points: np.ndarray, triangles: np.ndarray) -> RoundPart:
    """Recognise the body of revolution inside a part.

    Parameters
    ----------
    points : (3, n) ndarray
        On the surface, m; y is the axis.
    triangles : (3, t) ndarray of int
        Closed.

    Returns
    -------
    RoundPart
        Without walls where nothing of it is round.

    Examples
    --------
    A prism of 64 sides is round but for the sagitta of its sides:

    >>> turn = 2 * np.pi * np.arange(64) / 64
    >>> ring = np.array([np.cos(turn), 0 * turn, np.sin(turn)])
    >>> points = np.hstack([ring, ring + [[0], [3], [0]], [[0, 0], [0, 3], [0, 0]]])
    >>> here, there = np.arange(64), (np.arange(64) + 1) % 64
    >>> sides = [[here, there, 64 + here], [there, 64 + there, 64 + here]]
    >>> ends = [[here, there, 128 + 0 * here], [64 + here, 64 + there, 129 + 0 * here]]
    >>> found = round_part(points, np.hstack(sides + ends))
    >>> [round(float(v), 9) for v in found.walls[0]]
    [0.0, 3.0, 1.0, 1.0, 0.0, 0.0]
    """
    y, r = points[1], np.hypot(points[0], points[2])
    largest, length = r.max(), np.ptp(y)
    a, b, c = (points[:, t] for t in triangles)
    area = np.linalg.norm(np.cross((b - a).T, (c - a).T), axis=1) / 2
    flat = np.ptp(y[triangles], axis=0) <= 1e-7 * length
    groups = list(_lines(y[triangles], r[triangles], area, ~flat, largest))
    surfaces, on, facets = [], np.zeros(len(area), bool), 0.0
    for members in groups:
        for own in _runs(y[triangles], members, SAME_PLACE * length):
            found = _lathe(y[triangles[:, own]], r[triangles[:, own]], area[own], largest)
            if found is not None and found.share > MOST_OF_A_TURN:
                surfaces.append(found)
                on[own] = True
                facets += _between(points, triangles[:, own], [found])
    rest = np.flatnonzero(~on & ~flat)
    beside_arcs = 0.0
    tori: list[Torus] = []
    for members, arc in arcs(y, r, triangles[:, rest], ON_LINE * largest):
        own, (along, across, off) = rest[members], arc[:3]
        sides = np.pi * (across[1:] + across[:-1]) * np.hypot(np.diff(along), np.diff(across))
        turn = float(area[own].sum() / sides.sum())
        if turn > MOST_OF_A_TURN:
            # where an arc is steep, radii by chords and by the arc differ by a part of its size
            beside = float(np.hypot(np.ptp(along), np.ptp(across))) / 4
            cones = [
                Lathe(float(y0), float(y1), float(r0), float(r1), turn, beside)
                for y0, y1, r0, r1 in zip(along, along[1:], across, across[1:])
            ]
            surfaces += cones
            on[own] = True
            facets += _between(points, triangles[:, own], cones)
            beside_arcs = max(beside_arcs, off)
            ends = float(along[0]), float(along[-1])
            tori.append(Torus(*ends, *arc.centre, arc.radius, arc.side < 0))
    if not surfaces:
        return RoundPart((), (), 0.0)
    walls, by_rays = _walls(points, triangles, surfaces, y.min(), y.max())
    share = float(area[on].sum() / area[~flat].sum())
    if by_rays:  # mean radii have the volume of the part, whatever its surface is
        facets = 0.0
    elif not _fine_around(points, triangles[:, on], ON_LINE * largest):
        facets *= CURVED
    return RoundPart(tuple(walls), tuple(surfaces), share, facets, beside_arcs, tuple(tori))


def _between(points, triangles, surfaces: list[Lathe]) -> float:
    """Volume between round surfaces end to end and their triangles, m^3, by the flux of (x, z) / 2."""
    a, b, c = (points[:, t] for t in triangles)
    normal = np.cross((b - a).T, (c - a).T).T / 2
    middle = (a + b + c) / 3
    flat = np.abs((middle[[0, 2]] * normal[[0, 2]]).sum(axis=0) / 2).sum()
    whole = sum(cone_volume(np.array([s.y0, s.y1]), np.array([s.r0, s.r1])) for s in surfaces)
    return abs(float(whole - flat))


def _fine_around(points, triangles, near) -> bool:
    """True where triangles are as narrow around the axis as those of a mesh of something round."""
    x, z = points[0][triangles], points[2][triangles]
    turn = np.where(np.hypot(x, z) > near, np.arctan2(x, z), np.nan)
    gaps = np.abs((turn - np.roll(turn, 1, axis=0) + np.pi) % (2 * np.pi) - np.pi)
    spans = np.nanmax(gaps, axis=0)
    return bool(spans.max() <= min(WIDEST, MUCH_WIDER * np.median(spans)))


def _lines(y, r, area, free, largest) -> Iterator[np.ndarray]:
    """Triangles by the line of the meridian that their corners lie on, the largest surface first."""
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
    """Middle of some points and the slope of their line."""
    middle, height = y.mean(), r.mean()
    spread = ((y - middle) ** 2).sum()
    slope = ((y - middle) * (r - height)).sum() / spread if spread else 0.0
    return middle, height, slope


def _distance(y, r, other_y, other_r) -> np.ndarray:
    """Distance of other points from the line through some."""
    middle, height, slope = _fit(y, r)
    return np.abs(other_r - height - slope * (other_y - middle)) / np.hypot(1.0, slope)


def _runs(y, members, near) -> Iterator[np.ndarray]:
    """Members in stretches along y without a gap."""
    low, high = y[:, members].min(axis=0), y[:, members].max(axis=0)
    order = np.argsort(low)
    reach = np.maximum.accumulate(high[order])
    starts = np.flatnonzero(low[order][1:] > reach[:-1] + near) + 1
    yield from (members[part] for part in np.split(order, starts))


def _lathe(y, r, area, largest) -> Lathe | None:
    """The surface of some triangles on one line."""
    y0, y1 = float(y.min()), float(y.max())
    middle, height, slope = _fit(y, r)
    r0, r1 = (float(height + slope * (end - middle)) for end in (y0, y1))
    if abs(r1 - r0) < 0.1 * ON_LINE * largest:
        r0 = r1 = float(np.median(r))
    # chords lie inside the circle, so that even a whole turn covers a little less
    whole = np.pi * (r0 + r1) * np.hypot(y1 - y0, r1 - r0)
    if not whole > 0 or min(r0, r1) < -ON_LINE * largest:
        return None
    return Lathe(y0, y1, max(r0, 0.0), max(r1, 0.0), float(area.sum() / whole))


def _walls(points, triangles, surfaces, first, last) -> tuple[list[Frustum], bool]:
    """Frusta end to end between the places where something begins or ends, and whether some of
    them are of mean radii.
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
        here = [s for s in surfaces if s.y0 < y0 + near and s.y1 > y1 - near]
        middle = _inside(y0, y1)
        crossed = _crossed(points, triangles, middle)
        if crossed is None:
            continue
        _, (outer, inner) = crossed
        # a round surface that most rays meet, else what they say on the mean
        out = max(_at_radius(here, middle, outer), key=lambda s: s.radius(middle), default=None)
        rest = [s for s in _at_radius(here, middle, inner) if s is not out]
        bore = min(rest, key=lambda s: s.radius(middle), default=None)
        if out is not None and (bore is not None or inner == 0.0):
            ends = [s.radius(e) if s else 0.0 for s in (out, bore) for e in (y0, y1)]
            walls.append(Frustum(float(y0), float(y1), *map(float, ends)))
        else:
            walls += _sliced(points, triangles, y0, y1, out, bore)
            by_rays = True
    return _joined(walls, near), by_rays


def _inside(y0, y1) -> float:
    """A place between two others on which nodes of a mesh hardly lie."""
    return y0 + 0.4837 * (y1 - y0)


def _at_radius(surfaces, middle, radius) -> list[Lathe]:
    """Surfaces at the radius that rays tell, which is that of chords."""
    return (
        [
            s
            for s in surfaces
            if -1e-3 * radius <= s.radius(middle) - radius + s.beside
            and s.radius(middle) - radius - s.beside <= CHORD * radius
        ]
        if radius
        else []
    )


def _sliced(points, triangles, y0, y1, out, bore) -> list[Frustum]:
    """Frusta by mean radii where the surface is not round."""
    edges = np.linspace(y0, y1, SLICES + 1)
    walls = []
    for a, b in zip(edges, edges[1:]):
        crossed = _crossed(points, triangles, _inside(a, b))
        if crossed is None:
            continue
        (outer, inner), _ = crossed
        ends = [
            s.radius(e) if s is not None else mean
            for s, mean in ((out, outer), (bore, inner))
            for e in (a, b)
        ]
        walls.append(Frustum(float(a), float(b), *map(float, ends)))
    return walls


def _joined(walls, near) -> list[Frustum]:
    """Neighbours on one line are one wall: a cut that a bore made is none for the outer surface,
    but both are asked.
    """
    out: list[Frustum] = []
    for wall in walls:
        if out and _in_line(out[-1], wall):
            before = out.pop()
            wall = Frustum(
                before.y0, wall.y1, before.outer0, wall.outer1, before.inner0, wall.inner1
            )
        out.append(wall)
    return out


def _in_line(a: Frustum, b: Frustum) -> bool:
    for a0, a1, b0, b1 in ((a[2], a[3], b[2], b[3]), (a[4], a[5], b[4], b[5])):
        slope = (a1 - a0) / (a.y1 - a.y0)
        other = (b1 - b0) / (b.y1 - b.y0)
        if abs(a1 - b0) > 1e-6 * a[2] or abs(slope - other) > 1e-5:
            return False
    return True


def _crossed(points, triangles, y) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Outer radius and bore of a section: those of circles of the same area, and those that half
    of the rays reach; None where hardly a ray meets a surface.
    """
    here = points[1][triangles]
    cut = np.flatnonzero((here.min(axis=0) < y) & (here.max(axis=0) > y))
    if not len(cut):
        return None
    corners = points[:, triangles[:, cut]]  # (3, corner, t)
    sides = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        p, q = corners[:, i], corners[:, j]
        t = np.divide(y - p[1], q[1] - p[1], out=np.full(len(cut), -1.0), where=q[1] != p[1])
        place = p + np.clip(t, 0, 1) * (q - p)
        sides.append((np.where((t >= 0) & (t <= 1), 1, 0), place[[0, 2]]))
    ends = np.zeros((2, 2, len(cut)))
    count = np.zeros(len(cut), int)
    for hit, place in sides:
        for k in (0, 1):
            new = (hit == 1) & (count == k)
            ends[k][:, new] = place[:, new]
        count += hit
    ok = count >= 2
    (x0, z0), (x1, z1) = ends[0][:, ok], ends[1][:, ok]
    outer, inner = [], []
    for angle in 2 * np.pi * (np.arange(RAYS) + 0.37) / RAYS:
        c, s = np.cos(angle), np.sin(angle)
        side0, side1 = c * z0 - s * x0, c * z1 - s * x1
        crossing = (side0 < 0) != (side1 < 0)
        t = side0[crossing] / (side0[crossing] - side1[crossing])
        along = (c * x0 + s * z0)[crossing] * (1 - t) + (c * x1 + s * z1)[crossing] * t
        met = np.sort(along[along > 0])
        if len(met):
            outer.append(met[-1])
            # an even number of surfaces leaves the axis outside
            inner.append(met[0] if len(met) % 2 == 0 else 0.0)
    if len(outer) < RAYS / 2:
        return None
    middle = float(np.median(outer)), float(np.median(inner))
    mean = float(np.sqrt(np.square(outer).sum() / RAYS))
    hollow = float(np.sqrt(np.square(inner).sum() / RAYS)) if middle[1] > 0 else 0.0
    return (mean, hollow), middle
