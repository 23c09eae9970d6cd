"""Radial bands of the segments of a shaft, such that neighbours share mesh lines."""

from __future__ import annotations

import numpy as np

from solidgear.scene.outline import Outline

#: lowest band and end of every segment
Bands = tuple[tuple[int, int], ...]
#: two surfaces that face each other share a boundary unless it were steeper than this, radius over
#: length
STEEPEST = 1.5
#: a boundary inside that would be steeper than this runs on straight instead: against 1.5 errors of
#: shouldered shafts are halved
STRAIGHT = 0.2
#: of the room between two boundaries that stay, the share that a third leaves on either side
LEAST_SHARE = 0.15


def first_of_run(bands: Bands, band: int, segment: int) -> int:
    """First of the neighbours of a segment that have a band, as it does, without a gap between
    them.
    """
    while segment > 0 and bands[segment - 1][0] <= band < bands[segment - 1][1]:
        segment -= 1
    return segment


def _surfaces(bands, i: int) -> set[int]:
    """Boundaries that are a surface where segments i and i + 1 meet."""
    (a, b), (c, d) = bands[i], bands[i + 1]
    return {a, b, c, d, max(a, c), min(b, d)}


def _straighten(segments, bands, left, right, kept) -> None:
    """Move boundaries that would cross a segment too steeply, other than those, by segment and
    boundary, that are a surface behind it.

    Boundaries that are no surface were spread evenly. In a thin disc that may take one from the
    surface of a neighbour on one side far up or down to the other, through cells so skewed that
    each further order takes away no more than half of the error.
    """
    fixed = set(kept)
    # what is steepest first: a boundary that was moved stays where it is
    for limit in (STEEPEST, STRAIGHT):
        while _followed(segments, bands, left, right, fixed, limit):
            pass
    for i in range(len(segments) - 1):  # what ends on the face of the larger of two neighbours
        low, high = _common(bands, i)
        for k, own, other in ((i, right, left), (i + 1, left, right)):
            bottom, top = bands[k]
            for first, last in ((bottom, low), (high, top)):
                held = [first - bottom, last - bottom]
                for at in range(first - bottom + 1, last - bottom):
                    far = other[k][at] if k in other else own[k][at]
                    if abs(own[k][at] - far) > STRAIGHT * segments[k].length:
                        _move(own[k], held, at, far, other.get(k))
                        held.append(at)


def _followed(segments, bands, left, right, fixed, limit: float) -> bool:
    """Move boundaries to where they stay the same as at the next joint at which they are fixed,
    where they would be steeper than a limit; whether there were any.
    """
    moving = False
    joints = range(len(segments) - 1)
    for i in (*joints, *reversed(joints)):
        low, high = _common(bands, i)
        here, there = (slice(low - bands[k][0], high - bands[k][0] + 1) for k in (i, i + 1))
        for place in range(low + 1, high):
            for k, before, ends in ((i, i - 1, left), (i + 1, i + 1, right)):
                if (i, place) in fixed or (before, place) not in fixed or k not in ends:
                    continue
                far = ends[k][place - bands[k][0]]
                if abs(right[i][here][place - low] - far) > limit * segments[k].length:
                    held = [p - low for p in range(low, high + 1) if (i, p) in fixed]
                    _move(right[i][here], held, place - low, far)
                    left[i + 1][there][1:-1] = right[i][here][1:-1]
                    fixed.add((i, place))
                    moving = True
    return moving


def _common(bands, i: int) -> tuple[int, int]:
    """Lowest and highest boundary of the face that segments i and i + 1 share."""
    return max(bands[i][0], bands[i + 1][0]), min(bands[i][1], bands[i + 1][1])


def _move(radii, held, i: int, wanted: float, far=None) -> None:
    """Move one of ascending radii as near to what is wanted as the nearest ones that are held leave
    room for, and spread those between.

    What is as near to one of them at the far end may be so here.
    """
    below, above = max(h for h in held if h < i), min(h for h in held if h > i)
    room = 2 * LEAST_SHARE * (radii[above] - radii[below]) / (above - below)
    down, up = room * (i - below), room * (above - i)
    if far is not None:
        down, up = min(down, far[i] - far[below]), min(up, far[above] - far[i])
    least, most = radii[below] + down, radii[above] - up
    moved = min(max(wanted, least), most)
    radii[below : i + 1] = np.linspace(radii[below], moved, i - below + 1)
    radii[i : above + 1] = np.linspace(moved, radii[above], above - i + 1)


def _levels(surface, lengths, tol: float) -> list[int]:
    """Boundary that the surface of every segment is, from 0, by its radii at both ends (negative in
    bores) and lengths, m: the least that will do.

    Of two neighbours the smaller one has the lower boundary, and the same where they meet. Where
    two surfaces face each other across larger segments between them, one boundary runs from the one
    to the other; in a thin disc that would be too steep, and each has a boundary of its own.
    """
    level, _ = _raised(surface, tol, [])
    apart: list[tuple[int, int]] = []
    for _ in surface:
        steep = [pair for pair in _steep(surface, lengths, level) if pair not in apart]
        if not steep:
            break
        more, there = _raised(surface, tol, [*apart, *steep])
        if not there:  # cones that ask for one order on one side and the other on the other
            break
        level, apart = more, [*apart, *steep]
    return level


def _steep(surface, lengths, level) -> list[tuple[int, int]]:
    """Pairs of segments, smaller first, that face each other across larger ones and whose surfaces
    are one boundary, or boundaries of the other order, where that is too steep for what is between.
    """
    out = []
    for i in range(len(surface)):
        for j in range(i + 2, len(surface)):
            between = min(level[i + 1 : j])
            if between <= level[i]:
                break  # nothing beyond is seen across it
            if between <= level[j]:
                continue
            rise = surface[j][0] - surface[i][1]
            low, high = (i, j) if rise > 0 else (j, i)
            if level[low] >= level[high] and abs(rise) > STEEPEST * sum(lengths[i + 1 : j]):
                out.append((low, high))
    return out


def _raised(surface, tol: float, apart) -> tuple[list[int], bool]:
    """Least levels with level_i < level_j where i is the smaller neighbour or stands before j in a
    pair that must be apart, and = where neighbours meet; and whether there are such levels.
    """
    n = len(surface)
    pairs = [(i, i + 1, surface[i][1] - surface[i + 1][0]) for i in range(n - 1)]
    level = [0] * n
    for _ in range(2 * n + len(apart) + 1):
        before = list(level)
        for i, j, d in pairs:
            if abs(d) <= tol:
                level[i] = level[j] = max(level[i], level[j])
            else:
                low, high = (i, j) if d < 0 else (j, i)
                level[high] = max(level[high], level[low] + 1)
        for low, high in apart:
            level[high] = max(level[high], level[low] + 1)
        if level == before:
            return level, True
    return level, False


def _facing(segments, lengths, bottoms, tops) -> list[tuple[int, int]]:
    """Pairs of a segment and one whose bore faces the surface of the first across a disc, too far
    away for one boundary from the one to the other: shaft and drum of a bell.
    """
    out, n = [], len(segments)
    for i in range(n):
        for j in (*range(i + 2, n), *range(i - 2, -1, -1)):
            between = range(min(i, j) + 1, max(i, j))
            a, b = segments[i], segments[j]
            rise = b.inner0 - a.outer1 if j > i else b.inner1 - a.outer0
            seen = all(tops[k] > tops[i] and bottoms[k] < bottoms[j] for k in between)
            if seen and rise > STEEPEST * sum(lengths[k] for k in between):
                out.append((i, j))
    return out


def _above(segments, lengths, bottoms, tops) -> tuple[list[int], list[int]]:
    """Boundaries of bores (0 at most) and surfaces (1 at least) such that a bore that faces a
    smaller surface is the higher boundary of the two; elsewhere every surface is higher than every
    bore, as they were given.
    """
    facing = _facing(segments, lengths, bottoms, tops)
    if not facing:
        return bottoms, tops
    n = len(segments)
    low, high = list(bottoms), list(tops)
    order = [
        (level, *((k, k + 1) if given[k] <= given[k + 1] else (k + 1, k)), given[k] == given[k + 1])
        for given, level in ((bottoms, low), (tops, high))
        for k in range(n - 1)
    ]
    for _ in range(4 * n * (len(facing) + 1)):
        before = *low, *high
        for i, j in facing:
            low[j] = max(low[j], high[i] + 1)
        for k in range(n):  # a segment has a wall, and a face that it shares with either neighbour
            high[k] = max(high[k], *(low[i] + 1 for i in (k - 1, k, k + 1) if 0 <= i < n))
        for level, lower, higher, same in order:
            level[higher] = max(level[higher], level[lower] + (not same))
            if same:
                level[lower] = level[higher]
        if before == (*low, *high):
            rank = {level: k for k, level in enumerate(sorted({*low, *high}))}
            return [rank[k] for k in low], [rank[k] for k in high]
    return bottoms, tops


def radial_bands(
    outline: Outline,
) -> tuple[Bands, tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:
    """Radial bands of every segment such that neighbours share mesh lines.

    Where the outer radius jumps, the larger side gets at least one band more than
    the smaller one, whose bands it continues; likewise inwards where the bore jumps.

    Returns
    -------
    bands : tuple of (int, int)
        Lowest band and end of every segment.
    left, right : tuple of ndarray
        Radii of the band boundaries at the two ends of every segment, m.

    Examples
    --------
    >>> from solidgear import Segment
    >>> thin = Segment.cylinder("thin", length=0.1, diameter=0.04)
    >>> thick = Segment.cylinder("thick", length=0.1, diameter=0.06, y0=0.1)
    >>> bands, left, right = radial_bands(Outline([thin, thick]))
    >>> bands, left[1]
    (((0, 1), (0, 2)), array([0.  , 0.02, 0.03]))
    """
    segments, n = outline.segments, len(outline.segments)
    tol = 1e-9 * outline.largest_radius

    lengths = [s.y1 - s.y0 for s in segments]
    outer = [(s.outer0, s.outer1) for s in segments]
    bore = [(-s.inner0, -s.inner1) for s in segments]
    tops = [level + 1 for level in _levels(outer, lengths, tol)]
    bottoms = [-level for level in _levels(bore, lengths, tol)]
    bottoms, tops = _above(segments, lengths, bottoms, tops)
    bands = tuple(zip(bottoms, tops))

    def spread(lo, hi, known):
        """Radii of boundaries lo..hi from the known ones, evenly between."""
        keys = sorted(known)
        return np.interp(np.arange(lo, hi + 1), keys, [known[k] for k in keys])

    left: dict[int, np.ndarray] = {}
    right: dict[int, np.ndarray] = {}
    kept = {(i, place) for i in range(n - 1) for place in _surfaces(bands, i)}
    for i in range(n - 1):
        a, b = segments[i], segments[i + 1]
        low, high = _common(bands, i)
        here, there = (dict(zip((low, high), outline.shared_face(i + 1, k))) for k in (i, i + 1))
        right[i] = spread(*bands[i], {**here, bottoms[i]: a.inner1, tops[i]: a.outer1})
        left[i + 1] = spread(
            *bands[i + 1], {**there, bottoms[i + 1]: b.inner0, tops[i + 1]: b.outer0}
        )
    _straighten(segments, bands, left, right, kept)
    # A free end divides its radius as the far end of the same segment does.
    for i, s in enumerate(segments):
        if i not in left and i not in right:
            left[i] = np.linspace(s.inner0, s.outer0, tops[i] - bottoms[i] + 1)
            right[i] = np.linspace(s.inner1, s.outer1, tops[i] - bottoms[i] + 1)
        elif i not in left:
            left[i] = s.inner0 + (right[i] - s.inner1) * (s.outer0 - s.inner0) / (
                s.outer1 - s.inner1
            )
        elif i not in right:
            right[i] = s.inner1 + (left[i] - s.inner0) * (s.outer1 - s.inner1) / (
                s.outer0 - s.inner0
            )
    return bands, tuple(left[i] for i in range(n)), tuple(right[i] for i in range(n))
