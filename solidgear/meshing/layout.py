"""Where mesh lines go in a shaft of revolution: bands, breakpoints, grading.

Stress is singular at every shoulder and at every edge of a seat, so structured meshes are
graded geometrically towards all of them, axially and radially.  A refinement ``s`` multiplies the
number of cells of a fixed density, so that meshes with different ``s`` are similar.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Layout:
    """Structured layout of the meridian.

    Attributes
    ----------
    y : (ny + 1,) ndarray
        Axial mesh lines, m.
    segment : (ny,) ndarray of int
        Segment of each axial cell.
    bands : tuple of (lowest, end) per segment
        Radial bands a segment occupies, as indices into ``fractions``.
    left, right : tuple of ndarray per segment
        Radii of the band boundaries ``lowest .. end`` at the two ends of the segment, m.
    fractions : dict of band index -> (m + 1,) ndarray
        Subdivision of each band, 0 to 1 outwards.
    """

    y: np.ndarray
    segment: np.ndarray
    bands: tuple[tuple[int, int], ...]
    left: tuple[np.ndarray, ...]
    right: tuple[np.ndarray, ...]
    fractions: dict[int, np.ndarray]

    def radii(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Radii of all band boundaries of a segment at ``y`` (``span`` is its y0, y1)."""
        t = (y - span[0]) / (span[1] - span[0])
        return (1 - t) * self.left[segment] + t * self.right[segment]


def layout(scene, *, size: float, layers: int, ratio: float, refinement: float = 1.0, reach: float | None = None, core: bool = False) -> Layout:
    """Lay out bands and mesh lines for a scene.

    Parameters
    ----------
    scene : Scene
    size : float
        Cell size away from singular points at refinement 1, m.
    layers : int
        Geometric layers towards each singular line; 0 is uniform.
    ratio : float
        Size of a layer relative to the one before, 0.15 to 0.5.
    refinement : float
        Multiplies the number of cells everywhere.
    reach : float, optional
        Where grading starts, distance from the singular line in m; by default ``size``.
    core : bool
        Start the band on the axis with one cell of half its width, room for the core of an O-grid.
    """
    segments = scene.segments
    bands, left, right = _bands(segments)
    reach = reach or size
    top = max(b[1] for b in bands)
    bottom = min(b[0] for b in bands)
    fractions = {}
    for band in range(bottom, top):
        thickness = max(
            max(l[band - b[0] + 1] - l[band - b[0]], r[band - b[0] + 1] - r[band - b[0]])
            for b, l, r in zip(bands, left, right)
            if b[0] <= band < b[1]
        )
        # The axis is the only band boundary that is no surface anywhere.
        on_axis = any(b[0] == band and l[0] == 0.0 and r[0] == 0.0 for b, l, r in zip(bands, left, right))
        if on_axis and core:
            outside = graded(thickness / 2, size, layers, ratio, reach, refinement, low=False, high=True)
            fractions[band] = np.concatenate([[0.0], thickness / 2 + outside]) / thickness
        else:
            fractions[band] = graded(thickness, size, layers, ratio, reach, refinement, low=not on_axis, high=True) / thickness
    sharp = {s.y0 for s in segments} | {segments[-1].y1}
    for station in scene.stations:
        sharp |= {station.lo, station.hi}
    plain = {s.y for s in scene.stations}
    marks = _distinct(sorted(sharp | plain), 1e-9 * scene.length)
    tol = 1e-9 * scene.length
    is_sharp = [any(abs(y - s) <= tol for s in sharp) for y in marks]
    lines = [np.array([marks[0]])]
    for i in range(len(marks) - 1):
        a, b = marks[i], marks[i + 1]
        lines.append(a + graded(b - a, size, layers, ratio, reach, refinement, is_sharp[i], is_sharp[i + 1])[1:])
    y = np.concatenate(lines)
    middle = (y[1:] + y[:-1]) / 2
    ends = np.array([s.y1 for s in segments])
    segment = np.minimum(np.searchsorted(ends, middle), len(segments) - 1)
    return Layout(y, segment, bands, left, right, fractions)


def graded(length, size, layers, ratio, reach, refinement, low=True, high=True) -> np.ndarray:
    """Positions 0 .. length of mesh lines, graded towards the ends flagged ``low`` and ``high``.

    The density is that of refinement 1; other refinements sample it with
    proportionally more cells, which keeps meshes similar.
    """
    ends = int(low) + int(high)
    start = min(reach, length / 2 if ends == 2 else length) if ends else 0.0
    powers = start * ratio ** np.arange(layers, 0, -1.0)
    near = np.concatenate([powers, [start]]) if layers else np.zeros(0)
    lines = {0.0, float(length)}
    if low:
        lines |= set(near.tolist())
    if high:
        lines |= set((length - near).tolist())
    lines = np.array(_distinct(sorted(lines), 1e-9 * length))
    # Fill gaps that are longer than a cell.
    filled = [lines[:1]]
    for a, b in zip(lines[:-1], lines[1:]):
        n = max(1, int(np.ceil((b - a) / size - 1e-6)))
        filled.append(np.linspace(a, b, n + 1)[1:])
    lines = np.concatenate(filled)
    n = len(lines) - 1
    m = max(1, int(round(n * refinement)))
    return lines if m == n else np.interp(np.linspace(0, n, m + 1), np.arange(n + 1), lines)


def _distinct(values, tol):
    out = [values[0]]
    for v in values[1:]:
        if v - out[-1] > tol:
            out.append(v)
    return out


def _bands(segments):
    """Radial bands of every segment such that neighbours share mesh lines.

    Where the outer radius jumps, the larger side gets at least one band more than
    the smaller one, whose bands it continues; likewise inwards where the bore jumps.
    """
    n = len(segments)
    tol = 1e-9 * max(max(s.outer0, s.outer1) for s in segments)

    def levels(end, start):
        """Least integers with level_i < level_j where i is the smaller neighbour, = where they meet."""
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

    left, right = [None] * n, [None] * n
    for i in range(n - 1):
        a, b = segments[i], segments[i + 1]
        low, high = max(bottoms[i], bottoms[i + 1]), min(tops[i], tops[i + 1])
        common = {low: max(a.inner1, b.inner0), high: min(a.outer1, b.outer0)}
        right[i] = spread(*bands[i], {**common, bottoms[i]: a.inner1, tops[i]: a.outer1})
        left[i + 1] = spread(*bands[i + 1], {**common, bottoms[i + 1]: b.inner0, tops[i + 1]: b.outer0})
    # A free end divides its radius as the far end of the same segment does.
    for i, s in enumerate(segments):
        if left[i] is None and right[i] is None:
            left[i] = np.linspace(s.inner0, s.outer0, tops[i] - bottoms[i] + 1)
            right[i] = np.linspace(s.inner1, s.outer1, tops[i] - bottoms[i] + 1)
        elif left[i] is None:
            left[i] = s.inner0 + (right[i] - s.inner1) * (s.outer0 - s.inner0) / (s.outer1 - s.inner1)
        elif right[i] is None:
            right[i] = s.inner1 + (left[i] - s.inner0) * (s.outer1 - s.inner1) / (s.outer0 - s.inner0)
    return bands, tuple(left), tuple(right)
