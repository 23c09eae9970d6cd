"""The outline of a shaft in plain floats: slabs between cuts, and the corners to grade towards."""

from dataclasses import dataclass, field
from typing import NamedTuple


class Frustum(NamedTuple):
    """The shape of a segment in plain floats (m), so that formulas can be written from them."""

    y0: float
    y1: float
    outer0: float
    outer1: float
    inner0: float
    inner1: float

    @classmethod
    def of(cls, segment):
        """The shape of a `segment`."""
        return cls(*(float(getattr(segment, name)) for name in cls._fields))


def tolerance_of(segments):
    """Length (m) below which two positions are one."""
    return 1e-9 * (segments[-1].y1 - segments[0].y0)


def cuts_of(slab, circles, tolerance):
    """Circles inside a slab, on its outer surface.

    Parameters
    ----------
    slab : tuple of float
        From :func:`slabs_between`.
    circles : sequence of float
        Positions y, m.
    tolerance : float
        m.

    Returns
    -------
    list of (float, float)
        (radius, y), ascending in y.
    """
    y0, y1, outer0, outer1 = slab[:4]
    cuts = sorted(y for y in circles if y0 + tolerance < y < y1 - tolerance)
    return [(outer0 + (outer1 - outer0) * (y - y0) / (y1 - y0), y) for y in cuts]


def corners_of(slabs, circles, tolerance, blends=()):
    """Points of the meridian to grade at: circles on the surface and kinks of the outline.

    Parameters
    ----------
    slabs : list of tuple
        From :func:`slabs_between`.
    circles : sequence of float
        Positions y, m.
    tolerance : float
        m.
    blends : sequence of Corner
        Edges that are no corners any more; those that a chamfer at a root leaves are.

    Returns
    -------
    list of (float, float)
        (y, radius), m.
    """
    corners = [(y, r) for slab in slabs for r, y in cuts_of(slab, circles, tolerance)]
    cut = [y for y, _ in corners]
    on_station = [y for y in circles if not _near(y, cut, tolerance)]
    corners += _kinks(slabs, on_station, tolerance)
    gone = [(b.y, b.r) for b in blends]
    left = [
        (y, r)
        for y, r in corners
        if all(abs(y - a) > tolerance or abs(r - b) > tolerance for a, b in gone)
    ]
    chamfered = [b for b in blends if b.root and b.kind == "chamfer"]
    return left + [p[::-1] for b in chamfered for p in (b.on_face, b.on_cylinder)]


@dataclass(frozen=True)
class Row:
    """The points of one end of a slab, from the bore outwards.

    Attributes
    ----------
    points : list of (float, float)
        (radius, y), m.
    bore, outer : list of (float, float)
        Where a rim meets the surface beside it; of one point at most.
    """

    points: list[tuple[float, float]]
    bore: list[tuple[float, float]] = field(default_factory=list)
    outer: list[tuple[float, float]] = field(default_factory=list)


def rows_between(below, above, blends, tolerance):
    """Points of the end of one slab and of the start of the next.

    What two slabs share runs from where one fillet meets its cylinder, so that no sharp edge of a
    slab lies at a fillet.

    Parameters
    ----------
    below, above : tuple of float or None
        From :func:`slabs_between`; None beyond an end face.
    blends : sequence of Corner
        Those of the whole shaft.
    tolerance : float
        m.

    Returns
    -------
    Row, Row
        Of ``below`` and of ``above``; empty for None.
    """
    y = below[1] if below else above[0]
    here = {(b.surface, b.root, b.side): b for b in blends if abs(b.y - y) <= tolerance}
    walls = [(s[5], s[3]) if k == 0 else (s[4], s[2]) for k, s in enumerate((below, above)) if s]
    if not here:
        others = [radii for wall in walls for radii in wall] if below and above else ()
        return tuple(
            Row([(r, y) for r in radii_between(*wall, others)]) if s else Row([])
            for s, wall in ((below, walls[0]), (above, walls[-1]))
        )
    roots = {surface: b for (surface, root, _), b in here.items() if root}
    shared = []
    if below and above:
        shifts = [roots[x].side * roots[x].axial if x in roots else None for x in ("bore", "outer")]
        steps = [abs(walls[0][k] - walls[1][k]) > tolerance for k in (0, 1)]
        for k, pick in ((0, max), (1, min)):
            shift = shifts[k]
            if shift is None:
                shift = 0.0 if steps[k] else shifts[1 - k] or 0.0
            radius = pick(walls[0][k], walls[1][k])
            if shift and k not in [i for i, x in enumerate(("bore", "outer")) if x in roots]:
                radius = _radius_at(above if shift > 0 else below, k, y + shift)
            shared.append((radius, y + shift))
    rows = []
    for slab, side in ((below, -1), (above, 1)):
        if not slab:
            rows.append(Row([]))
            continue
        inner, outer = walls[0] if side < 0 else walls[-1]
        bore_rim, rim = here.get(("bore", False, side)), here.get(("outer", False, side))
        points = list(shared)
        if not shared or outer > shared[1][0] + tolerance:
            face = [roots["outer"].on_face] if shared and "outer" in roots else []
            points = [*points, *face, rim.on_face if rim else (outer, y)]
        if not shared or inner < shared[0][0] - tolerance:
            face = [roots["bore"].on_face] if shared and "bore" in roots else []
            points = [bore_rim.on_face if bore_rim else (inner, y), *face, *points]
        rows.append(
            Row(
                points,
                [bore_rim.on_cylinder] if bore_rim else [],
                [rim.on_cylinder] if rim else [],
            )
        )
    return tuple(rows)


def _radius_at(slab, which, y):
    """Radius of the bore (0) or of the outer surface (1) of a slab."""
    a, b = slab[4 - 2 * which], slab[5 - 2 * which]
    return a + (b - a) * (y - slab[0]) / (slab[1] - slab[0])


def slabs_between(segments, planes, tolerance):
    """Segments cut at planes.

    Parameters
    ----------
    segments : sequence of Frustum
    planes : sequence of float
        Positions y, m.
    tolerance : float
        m.

    Returns
    -------
    list of tuple
        (y0, y1, outer0, outer1, inner0, inner1), m.

    Examples
    --------
    >>> slabs_between([Frustum(0.0, 1.0, 0.2, 0.4, 0.0, 0.0)], [0.5], 1e-9)[0]
    (0.0, 0.5, 0.2, 0.30000000000000004, 0.0, 0.0)
    """
    slabs = []
    start = segments[0].y0
    for s in segments:
        inside = {y for y in planes if s.y0 + tolerance < y < s.y1 - tolerance}
        cuts = [s.y0, *sorted(inside), s.y1]
        for a, b in zip(cuts, cuts[1:]):
            if b - a <= tolerance:
                continue
            u, v = (a - s.y0) / (s.y1 - s.y0), (b - s.y0) / (s.y1 - s.y0)
            outer, inner = s.outer1 - s.outer0, s.inner1 - s.inner0
            # the end of one slab is the very float that starts the next
            slabs.append(
                (
                    start,
                    b,
                    s.outer0 + u * outer,
                    s.outer0 + v * outer,
                    s.inner0 + u * inner,
                    s.inner0 + v * inner,
                )
            )
            start = b
    return slabs


def radii_between(low, high, others):
    """Two radii and those of others that fall between them, ascending, m."""
    return sorted({low, high} | {r for r in others if low < r < high})


def _kinks(slabs, circles, tolerance):
    """(y, radius) where the outline turns, and where a circle falls on a slab end."""
    found = []
    for i in range(len(slabs) + 1):
        below = slabs[i - 1] if i else None
        above = slabs[i] if i < len(slabs) else None
        y = below[1] if below else slabs[0][0]
        for outer in (True, False):
            column = 2 if outer else 4
            r0 = below[column + 1] if below else None
            r1 = above[column] if above else None
            turns = (
                r0 is None
                or r1 is None
                or abs(r0 - r1) > tolerance
                or abs(_slope(below, column) - _slope(above, column)) > 1e-6
            )
            if turns or (outer and _near(y, circles, tolerance)):
                found += [(y, r) for r in {r0, r1} - {None, 0.0}]
    return found


def _near(y, places, tolerance) -> bool:
    return any(abs(y - place) <= tolerance for place in places)


def _slope(slab, column):
    return (slab[column + 1] - slab[column]) / (slab[1] - slab[0])
