"""Radial bands of the segments of a shaft, such that neighbours share mesh lines."""

from __future__ import annotations

import numpy as np

#: steepest that a boundary inside may cross a segment, radius over length
STEEPEST = 1.5
#: of the room between its neighbours that a boundary leaves to each
LEAST_SHARE = 0.15


def first_of_run(bands, band: int, segment: int) -> int:
    """First of the neighbours of a segment that have a band without a gap between them.

    Parameters
    ----------
    bands : sequence of (int, int)
        Lowest band and end of every segment, from :func:`radial_bands`.
    band : int
    segment : int
        One that has the band.

    Returns
    -------
    int
    """
    while segment > 0 and bands[segment - 1][0] <= band < bands[segment - 1][1]:
        segment -= 1
    return segment


def _kept(bands, i: int) -> set[int]:
    """Boundaries that are a surface where segments i and i + 1 meet."""
    (a, b), (c, d) = bands[i], bands[i + 1]
    return {a, b, c, d, max(a, c), min(b, d)}


def _straighten(segments, bands, left, right, kept, i: int) -> None:
    """Move boundaries where segments i and i + 1 meet that would cross one of them too steeply.

    Boundaries that are no surface there were spread evenly.  In a thin disc that may take one from
    the surface of a neighbour on one side far up or down to the other, through cells so skewed that
    each further order takes away no more than half of the error.

    Parameters
    ----------
    segments : sequence of Segment
    bands : tuple of (int, int)
    left, right : dict of int to ndarray
        Radii, which are changed.
    kept : set of (int, int)
        Boundaries that are a surface behind a segment, by segment and boundary.
    i : int
    """
    low, high = max(bands[i][0], bands[i + 1][0]), min(bands[i][1], bands[i + 1][1])
    for place in range(low + 1, high):
        here, there = place - bands[i][0], place - bands[i + 1][0]
        for k, before, ends in ((i, i - 1, left), (i + 1, i + 1, right)):
            if (i, place) in kept or (before, place) not in kept or k not in ends:
                continue
            far = ends[k][place - bands[k][0]]
            if abs(right[i][here] - far) > STEEPEST * segments[k].length:
                below, above = right[i][here - 1], right[i][here + 1]
                room = LEAST_SHARE * (above - below)
                moved = min(max(far, below + room), above - room)
                right[i][here] = left[i + 1][there] = moved
                break


def radial_bands(segments, raised=None):
    """Radial bands of every segment such that neighbours share mesh lines.

    Where the outer radius jumps, the larger side gets at least one band more than
    the smaller one, whose bands it continues; likewise inwards where the bore jumps.

    Parameters
    ----------
    segments : sequence of Segment
    raised : dict of (segment, end, boundary) to float, optional
        Where the surface of a smaller neighbour meets the end ('left' or 'right') of a segment at
        another radius, by so much, m; the boundary is 'high' outside and 'low' in the bore.

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
    >>> bands, left, right = radial_bands([thin, thick])
    >>> bands, left[1]
    (((0, 1), (0, 2)), array([0.  , 0.02, 0.03]))
    """
    n, raised = len(segments), raised or {}
    tol = 1e-9 * max(max(s.outer0, s.outer1) for s in segments)

    def levels(end, start):
        """Least integers with level_i < level_j where i is the smaller neighbour, = where they
        meet.
        """
        level = [0] * n
        for _ in range(n + 1):
            changed = False
            for i in range(n - 1):
                d = end(segments[i]) - start(segments[i + 1])
                lo, hi = (i, i + 1) if d < -tol else (i + 1, i)
                need = level[lo] + (1 if abs(d) > tol else 0)
                if level[hi] < need:
                    level[hi], changed = need, True
                if abs(d) <= tol and level[lo] < level[hi]:
                    level[lo], changed = level[hi], True
            if not changed:
                return level
        return level

    tops = [t + 1 for t in levels(lambda s: s.outer1, lambda s: s.outer0)]
    bottoms = [-b for b in levels(lambda s: -s.inner1, lambda s: -s.inner0)]
    bands = tuple(zip(bottoms, tops))

    def spread(lo, hi, known):
        """Radii of boundaries lo..hi from the known ones, evenly between."""
        keys = sorted(known)
        return np.interp(np.arange(lo, hi + 1), keys, [known[k] for k in keys])

    left: dict[int, np.ndarray] = {}
    right: dict[int, np.ndarray] = {}
    kept = {(i, place) for i in range(n - 1) for place in _kept(bands, i)}
    for i in range(n - 1):
        a, b = segments[i], segments[i + 1]
        low, high = max(bottoms[i], bottoms[i + 1]), min(tops[i], tops[i + 1])
        common = {low: max(a.inner1, b.inner0), high: min(a.outer1, b.outer0)}
        here, there = (
            {
                low: common[low] + raised.get((k, end, "low"), 0.0),
                high: common[high] + raised.get((k, end, "high"), 0.0),
            }
            for k, end in ((i, "right"), (i + 1, "left"))
        )
        right[i] = spread(*bands[i], {**here, bottoms[i]: a.inner1, tops[i]: a.outer1})
        left[i + 1] = spread(
            *bands[i + 1], {**there, bottoms[i + 1]: b.inner0, tops[i + 1]: b.outer0}
        )
    for i in range(n - 1):
        _straighten(segments, bands, left, right, kept, i)
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
