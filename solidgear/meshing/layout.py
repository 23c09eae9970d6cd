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

    def first_ring(self, segment: int) -> int:
        """Number of a segment's innermost ring line; ring lines are counted outwards through all bands of the shaft."""
        lowest = self.bands[segment][0]
        return sum(len(f) - 1 for band, f in self.fractions.items() if band < lowest)

    @property
    def ring_lines(self) -> int:
        """Number of ring lines of the whole shaft."""
        return sum(len(f) - 1 for f in self.fractions.values()) + 1

    def rings(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Radii of all ring lines of a segment at ``y``, from its bore (or the axis) outwards."""
        b, (lowest, end) = self.radii(segment, span, y), self.bands[segment]
        parts = [b[k] + self.fractions[lowest + k][1:] * (b[k + 1] - b[k]) for k in range(end - lowest)]
        return np.concatenate([b[:1], *parts])


def layout(
    scene,
    *,
    size: float,
    layers: int,
    edge_layers: int | None = None,
    ratio: float,
    refinement: float = 1.0,
    reach: float | None = None,
    radial_layers: int | None = None,
    radial_reach: float | None = None,
    core: bool = False,
) -> Layout:
    """Lay out bands and mesh lines for a scene.

    Parameters
    ----------
    scene : Scene
    size : float
        Cell size away from singular points at refinement 1, m.
    layers : int
        Geometric layers towards shoulders, the strongest singularity; 0 is uniform.
    edge_layers : int, optional
        Geometric layers towards seat ends; as many as ``layers`` by default.
    ratio : float
        Size of a layer relative to the one before, 0.15 to 0.5.
    refinement : float
        Multiplies the number of cells everywhere.
    reach : float, optional
        Where grading starts, distance from the singular line in m; by default ``size``.
    radial_layers, radial_reach : optional
        The same across the thickness, where a line costs more cells than along the shaft.
    core : bool
        Start the band on the axis with one cell of half its width, room for the core of an O-grid.
    """
    segments = scene.segments
    edge_layers = layers if edge_layers is None else min(edge_layers, layers)
    bands, left, right = _bands(segments)
    reach = reach or size
    radial_reach = radial_reach or reach
    across = layers if radial_layers is None else radial_layers
    tol = 1e-9 * scene.length

    # Seat ends and shoulders are singular; end faces and kinks that bulge outwards are not.
    ends = {0.0, segments[-1].y1}
    weight = {y: 0 for y in ends} | {s.y: 0 for s in scene.stations} | {s.y0: 0 for s in segments}
    for station in scene.stations:
        weight |= {y: edge_layers for y in (station.lo, station.hi) if y not in ends}
    corners = [(a, b) for a, b in zip(segments, segments[1:]) if _singular(a, b)]
    weight |= {b.y0: layers for _, b in corners}
    marks = _distinct(sorted(weight), tol)
    strength = [max(w for y, w in weight.items() if abs(y - m) <= tol) for m in marks]
    lines = [np.array([marks[0]])]
    for a, b, low, high in zip(marks, marks[1:], strength, strength[1:]):
        lines.append(a + graded(b - a, size, ratio, reach, refinement, low, high)[1:])
    y = np.concatenate(lines)
    middle = (y[1:] + y[:-1]) / 2
    segment = np.minimum(np.searchsorted([s.y1 for s in segments], middle), len(segments) - 1)

    # A band boundary meets a shoulder where it is the surface of the smaller neighbour; other surfaces carry seats.
    strong = set()
    for i, (a, b) in enumerate(zip(segments, segments[1:])):
        if _singular(a, b):
            strong |= {min(bands[i][1], bands[i + 1][1]), max(bands[i][0], bands[i + 1][0])}
    fractions = {}
    for band in range(min(b[0] for b in bands), max(b[1] for b in bands)):
        here = [(b, l, r) for b, l, r in zip(bands, left, right) if b[0] <= band < b[1]]
        thickness = max(max(np.diff(l)[band - b[0]], np.diff(r)[band - b[0]]) for b, l, r in here)
        low, high = (across if k in strong else min(edge_layers, across) for k in (band, band + 1))
        # The axis is the only band boundary that is no surface anywhere.
        on_axis = any(b[0] == band and l[0] == 0.0 and r[0] == 0.0 for b, l, r in here)
        if on_axis and core:
            outside = graded(thickness / 2, size, ratio, radial_reach, refinement, 0, high)
            lines = np.concatenate([[0.0], thickness / 2 + outside])
        else:
            lines = graded(thickness, size, ratio, radial_reach, refinement, 0 if on_axis else low, high)
        fractions[band] = lines / thickness
    return Layout(y, segment, bands, left, right, fractions)


def _singular(a, b) -> bool:
    """Whether the outline has a re-entrant corner or a change of material where segment b follows a."""
    tol = 1e-9 * a.length
    if a.material != b.material or abs(a.outer1 - b.outer0) > tol or abs(a.inner1 - b.inner0) > tol:
        return True
    outside = (b.outer1 - b.outer0) / b.length - (a.outer1 - a.outer0) / a.length
    inside = (b.inner1 - b.inner0) / b.length - (a.inner1 - a.inner0) / a.length
    return outside > 1e-6 or inside < -1e-6


def graded(length, size, ratio, reach, refinement, low: int, high: int) -> np.ndarray:
    """Positions 0 .. length of mesh lines with ``low`` and ``high`` geometric layers towards the two ends.

    The density is that of refinement 1; other refinements sample it with
    proportionally more cells, which keeps meshes similar.
    """
    start = min(reach, length / 2 if low and high else length)
    lines = {0.0, float(length)}
    for layers, place in ((low, lambda d: d), (high, lambda d: length - d)):
        lines |= {float(place(start * ratio**k)) for k in range(layers + 1)} if layers else set()
    lines = np.array(_distinct(sorted(lines), 1e-9 * length))
    lines[-1] = length  # a last layer thinner than that must not move the end
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
