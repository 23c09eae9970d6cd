"""The outline of a shaft in plain floats: slabs between cuts, and the corners to grade towards."""

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


def blended_loop(ends, bottom, side, top, blends, tolerance):
    """The outline of a slab with fillets and chamfers.

    Parameters
    ----------
    ends : (float, float)
        First and last y of the slab, m.
    bottom, top : list of float
        Radii of the points of its two ends, ascending, m.
    side : list of (float, float)
        (radius, y) of points on its outer surface, ascending in y.
    blends : sequence of Corner
    tolerance : float
        m.

    Returns
    -------
    bottom, side, top : list of (float, float)
        (radius, y); the bore is closed from the last of `top` to the first of `bottom`.
    """
    rows = []
    for y, radii, inward in ((ends[0], bottom, 1), (ends[1], top, -1)):
        row, before, after = [(r, y) for r in radii], [], []
        for blend in (b for b in blends if abs(b.y - y) <= tolerance):
            if blend.side != inward:
                if blend.root:  # seen from the face it stands on
                    row = sorted({*row, (blend.on_face[0], y)})
                continue
            first, last = (row[0], row[-1])
            if blend.surface == "outer":
                row = row if blend.root else row[:-1]
                row, after = [*row, (blend.on_face[0], y)], [blend.on_cylinder]
                assert abs(last[0] - blend.r) <= tolerance
            else:
                row = row if blend.root else row[1:]
                row, before = [(blend.on_face[0], y), *row], [blend.on_cylinder]
                assert abs(first[0] - blend.r) <= tolerance
        rows.append((row, before, after))
    (low, low_bore, low_side), (high, high_bore, high_side) = rows
    return low_bore + low, low_side + side + high_side, high_bore + high


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
