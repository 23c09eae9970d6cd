"""Radial bands of the segments of a shaft, such that neighbours share mesh lines.

Bands are numbered from the axis outwards, the same in all segments: band k lies between boundaries
k and k + 1.  :func:`radial_bands` says which boundaries are surfaces (levels), spreads the others
evenly between them, and straightens those that would cross a segment too steeply.
"""

from __future__ import annotations

import numpy as np

from solidgear.core.scene.outline import Outline

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
    """Return the first of the neighbours of a segment that have a band, without a gap between."""
    while segment > 0 and bands[segment - 1][0] <= band < bands[segment - 1][1]:
        segment -= 1
    return segment


def radial_bands(
    outline: Outline,
) -> tuple[Bands, tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:
    """Return the bands of every segment, and the radii (m) of their boundaries at the left and at
    the right end.

    Where the outer radius jumps, the larger side gets at least one band more than
    the smaller one, whose bands it continues; likewise inwards where the bore jumps.

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
    bottoms, tops = _bores_above_surfaces(segments, lengths, bottoms, tops)
    bands = tuple(zip(bottoms, tops))

    left: dict[int, np.ndarray] = {}
    right: dict[int, np.ndarray] = {}
    for i in range(n - 1):
        a, b = segments[i], segments[i + 1]
        common = _common(bands, i)
        face_of_a, face_of_b = (
            dict(zip(common, outline.shared_face(i + 1, k))) for k in (i, i + 1)
        )
        right[i] = _spread({**face_of_a, bottoms[i]: a.inner1, tops[i]: a.outer1})
        left[i + 1] = _spread({**face_of_b, bottoms[i + 1]: b.inner0, tops[i + 1]: b.outer0})
    _straighten(segments, bands, left, right)
    # A free end divides its radius as the far end of the same segment does.
    for i, s in enumerate(segments):
        if i not in left and i not in right:
            left[i] = np.linspace(s.inner0, s.outer0, tops[i] - bottoms[i] + 1)
            right[i] = np.linspace(s.inner1, s.outer1, tops[i] - bottoms[i] + 1)
        elif i not in left:
            left[i] = _divided_alike(right[i], s.inner1, s.outer1, s.inner0, s.outer0)
        elif i not in right:
            right[i] = _divided_alike(left[i], s.inner0, s.outer0, s.inner1, s.outer1)
    return bands, tuple(left[i] for i in range(n)), tuple(right[i] for i in range(n))


def _common(bands, i: int) -> tuple[int, int]:
    """Return the lowest and the highest boundary of the face that segments i and i + 1 share."""
    return max(bands[i][0], bands[i + 1][0]), min(bands[i][1], bands[i + 1][1])


def _spread(radii: dict[int, float]) -> np.ndarray:
    """Return the radii of all boundaries from the lowest to the highest one of `radii`, evenly
    between those.
    """
    places = sorted(radii)
    return np.interp(np.arange(places[0], places[-1] + 1), places, [radii[k] for k in places])


def _divided_alike(radii, inner, outer, far_inner, far_outer) -> np.ndarray:
    """Return radii that divide the wall at the far end of a segment as `radii` divide this one."""
    return far_inner + (radii - inner) * (far_outer - far_inner) / (outer - inner)


def _levels(radii, lengths, tol: float) -> list[int]:
    """Return the boundary, from 0, that the surface of every segment is, by the radii at both ends
    (m, negative in bores): the least that will do.

    Of two neighbours the smaller one has the lower boundary, and the same where they meet. Where
    two surfaces face each other across larger segments between them, one boundary runs from the one
    to the other; in a thin disc that would be too steep, and each has a boundary of its own.
    """
    levels, _ = _least_levels(radii, tol, [])
    separate: list[tuple[int, int]] = []
    for _ in radii:
        steep = [pair for pair in _steep_pairs(radii, lengths, levels) if pair not in separate]
        if not steep:
            break
        raised, possible = _least_levels(radii, tol, [*separate, *steep])
        if not possible:  # cones that ask for one order on one side and the other on the other
            break
        levels, separate = raised, [*separate, *steep]
    return levels


def _least_levels(radii, tol: float, separate) -> tuple[list[int], bool]:
    """Return the least levels with level_i < level_j where i is the smaller neighbour of j or
    (i, j) is a pair of `separate`, and = where neighbours meet; and whether there are such levels.
    """
    n = len(radii)
    levels = [0] * n
    for _ in range(2 * n + len(separate) + 1):
        before = list(levels)
        for i in range(n - 1):
            step = radii[i][1] - radii[i + 1][0]
            if abs(step) <= tol:
                levels[i] = levels[i + 1] = max(levels[i], levels[i + 1])
            else:
                low, high = (i, i + 1) if step < 0 else (i + 1, i)
                levels[high] = max(levels[high], levels[low] + 1)
        for low, high in separate:
            levels[high] = max(levels[high], levels[low] + 1)
        if levels == before:
            return levels, True
    return levels, False


def _steep_pairs(radii, lengths, levels) -> list[tuple[int, int]]:
    """Return pairs of segments, smaller first, that face each other across larger ones and whose
    surfaces are one boundary, or boundaries of the other order, too steep for what lies between.
    """
    pairs = []
    for i in range(len(radii)):
        for j in range(i + 2, len(radii)):
            between = min(levels[i + 1 : j])
            if between <= levels[i]:
                break  # nothing beyond faces segment i across it
            if between <= levels[j]:
                continue
            rise = radii[j][0] - radii[i][1]
            low, high = (i, j) if rise > 0 else (j, i)
            if levels[low] >= levels[high] and abs(rise) > STEEPEST * sum(lengths[i + 1 : j]):
                pairs.append((low, high))
    return pairs


def _bores_above_surfaces(segments, lengths, bottoms, tops) -> tuple[list[int], list[int]]:
    """Return the boundaries of bores and of surfaces such that a bore that faces a smaller surface
    is the higher of the two: shaft and drum of a bell.

    Elsewhere every surface (1 at least) is higher than every bore (0 at most), as they come in.
    """
    facing = _facing_pairs(segments, lengths, bottoms, tops)
    if not facing:
        return bottoms, tops
    n = len(segments)
    low, high = list(bottoms), list(tops)
    for _ in range(4 * n * (len(facing) + 1)):
        before = [*low, *high]
        for i, j in facing:
            low[j] = max(low[j], high[i] + 1)
        for k in range(n):  # a segment has a wall, and a face that it shares with either neighbour
            high[k] = max(high[k], 1 + max(low[max(k - 1, 0) : k + 2]))
        _keep_order(low, bottoms)
        _keep_order(high, tops)
        if [*low, *high] == before:
            rank = {level: k for k, level in enumerate(sorted({*low, *high}))}
            return [rank[k] for k in low], [rank[k] for k in high]
    return bottoms, tops


def _facing_pairs(segments, lengths, bottoms, tops) -> list[tuple[int, int]]:
    """Return pairs of a segment and one whose bore faces the surface of the first across a disc,
    too far away for one boundary from the one to the other.
    """
    pairs, n = [], len(segments)
    for i in range(n):
        for j in (*range(i + 2, n), *range(i - 2, -1, -1)):
            between = range(min(i, j) + 1, max(i, j))
            a, b = segments[i], segments[j]
            rise = b.inner0 - a.outer1 if j > i else b.inner1 - a.outer0
            open_between = all(tops[k] > tops[i] and bottoms[k] < bottoms[j] for k in between)
            if open_between and rise > STEEPEST * sum(lengths[k] for k in between):
                pairs.append((i, j))
    return pairs


def _keep_order(levels: list[int], original: list[int]) -> None:
    """Raise levels where neighbours are not in the order of their original ones, or not alike."""
    for k in range(len(levels) - 1):
        if original[k] == original[k + 1]:
            levels[k] = levels[k + 1] = max(levels[k], levels[k + 1])
        else:
            lower, higher = (k, k + 1) if original[k] < original[k + 1] else (k + 1, k)
            levels[higher] = max(levels[higher], levels[lower] + 1)


def _straighten(segments, bands, left, right) -> None:
    """Move boundaries that would cross a segment too steeply and are no surface behind it.

    Boundaries that are no surface were spread evenly. In a thin disc that may take one from the
    surface of a neighbour on one side far up or down to the other, through cells so skewed that
    each further order takes away no more than half of the error.
    """
    joints = range(len(segments) - 1)
    # (joint, boundary): i is the joint of segments i and i + 1
    fixed = {(i, boundary) for i in joints for boundary in _surfaces(bands, i)}
    # the steepest first: a boundary that was moved stays where it is
    for limit in (STEEPEST, STRAIGHT):
        while _follow_fixed(segments, bands, left, right, fixed, limit):
            pass
    for i in joints:  # boundaries that end on the face of the larger of two neighbours
        low, high = _common(bands, i)
        for k, near_end, far_end in ((i, right, left), (i + 1, left, right)):
            bottom, top = bands[k]
            for first, last in ((bottom, low), (high, top)) if k in far_end else ():
                _straighten_stretch(
                    near_end[k], far_end[k], first - bottom, last - bottom, segments[k].length
                )


def _surfaces(bands, i: int) -> set[int]:
    """Return the boundaries that are a surface where segments i and i + 1 meet."""
    (a, b), (c, d) = bands[i], bands[i + 1]
    return {a, b, c, d, max(a, c), min(b, d)}


def _follow_fixed(segments, bands, left, right, fixed, limit: float) -> bool:
    """Move boundaries at joints to their radius at the next joint at which they are fixed, where
    they would be steeper than a limit, and fix them; return whether there were any.
    """
    moved = False
    joints = range(len(segments) - 1)
    for i in (*joints, *reversed(joints)):
        low, high = _common(bands, i)
        # views of the radii of the face that both segments share
        face = right[i][low - bands[i][0] : high - bands[i][0] + 1]
        face_of_next = left[i + 1][low - bands[i + 1][0] : high - bands[i + 1][0] + 1]
        for boundary in range(low + 1, high):
            for k, next_joint, far_end in ((i, i - 1, left), (i + 1, i + 1, right)):
                anchored = (next_joint, boundary) in fixed and k in far_end
                if (i, boundary) in fixed or not anchored:
                    continue
                wanted = far_end[k][boundary - bands[k][0]]
                if abs(face[boundary - low] - wanted) > limit * segments[k].length:
                    places = [b - low for b in range(low, high + 1) if (i, b) in fixed]
                    _move(face, places, boundary - low, wanted)
                    face_of_next[1:-1] = face[1:-1]
                    fixed.add((i, boundary))
                    moved = True
    return moved


def _straighten_stretch(radii, far_radii, first: int, last: int, length: float) -> None:
    """Move radii between two places of an end of a segment towards those at the far end, where
    boundaries would be steeper than `STRAIGHT`.
    """
    fixed = [first, last]
    for place in range(first + 1, last):
        if abs(radii[place] - far_radii[place]) > STRAIGHT * length:
            _move(radii, fixed, place, far_radii[place], far_radii)
            fixed.append(place)


def _move(radii, fixed: list[int], i: int, wanted: float, far_radii=None) -> None:
    """Move one of ascending radii as near to a wanted one as the nearest fixed ones leave room for,
    and spread those between evenly.

    Boundaries that lie closer to each other at the far end may do so here.
    """
    below, above = max(k for k in fixed if k < i), min(k for k in fixed if k > i)
    room = 2 * LEAST_SHARE * (radii[above] - radii[below]) / (above - below)
    room_below, room_above = room * (i - below), room * (above - i)
    if far_radii is not None:
        room_below = min(room_below, far_radii[i] - far_radii[below])
        room_above = min(room_above, far_radii[above] - far_radii[i])
    radius = min(max(wanted, radii[below] + room_below), radii[above] - room_above)
    radii[below : i + 1] = np.linspace(radii[below], radius, i - below + 1)
    radii[i : above + 1] = np.linspace(radius, radii[above], above - i + 1)
