"""Where mesh lines go in a shaft of revolution: bands, breakpoints, grading.

Stress is singular at every shoulder and at every edge of a seat, so structured meshes are
graded geometrically towards all of them, axially and radially.  A refinement ``s`` multiplies the
number of cells of a fixed density, so that meshes with different ``s`` are similar.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.meshing.corners import corner_layers
from solidgear.scene import TOUCH


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
    fractions : dict of (band index, first segment of a run) -> (m + 1,) ndarray
        Subdivision of each band, 0 to 1 outwards, for every run of neighbours that have the band: a
        flange does not pass its rings on to a seat at the other end of the shaft.
    """

    y: np.ndarray
    segment: np.ndarray
    bands: tuple[tuple[int, int], ...]
    left: tuple[np.ndarray, ...]
    right: tuple[np.ndarray, ...]
    fractions: dict[tuple[int, int], np.ndarray]

    def radii(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Radii of all band boundaries of a segment at ``y`` (``span`` is its y0, y1)."""
        t = (y - span[0]) / (span[1] - span[0])
        return (1 - t) * self.left[segment] + t * self.right[segment]

    def divided(self, segment: int) -> list[np.ndarray]:
        """Subdivision of every band of a segment, from the inside."""
        lowest, end = self.bands[segment]
        return [
            self.fractions[band, first_of_run(self.bands, band, segment)]
            for band in range(lowest, end)
        ]

    @cached_property
    def _offsets(self) -> dict[int, int]:
        """Number of the innermost ring line of every band; bands count outwards through the whole
        shaft.
        """
        widest: dict[int, int] = {}
        for (band, _), lines in self.fractions.items():
            widest[band] = max(widest.get(band, 0), len(lines) - 1)
        out, count = {}, 0
        for band in sorted(widest):
            out[band] = count
            count += widest[band]
        out[max(widest) + 1] = count
        return out

    @property
    def ring_lines(self) -> int:
        """Ring lines are numbered below this."""
        return max(self._offsets.values()) + 1

    def ring_numbers(self, segment: int) -> np.ndarray:
        """Numbers of a segment's ring lines from the inside, the same as its neighbours' where they
        share a band.
        """
        lowest = self.bands[segment][0]
        parts = [
            self._offsets[lowest + k] + np.arange(len(lines) - 1)
            for k, lines in enumerate(self.divided(segment))
        ]
        return np.concatenate([*parts, [self._offsets[self.bands[segment][1]]]])

    def rings(self, segment: int, span: tuple[float, float], y: float) -> np.ndarray:
        """Radii of all ring lines of a segment at ``y``, from its bore (or the axis) outwards."""
        b = self.radii(segment, span, y)
        parts = [
            b[k] + lines[1:] * (b[k + 1] - b[k]) for k, lines in enumerate(self.divided(segment))
        ]
        return np.concatenate([b[:1], *parts])


def first_of_run(bands, band: int, segment: int) -> int:
    """First of the neighbours of a segment that have a band without a gap between them."""
    while segment > 0 and bands[segment - 1][0] <= band < bands[segment - 1][1]:
        segment -= 1
    return segment


#: where grading starts, in local lengths; one layer of ratio 0.2 begins at a twentieth of a radius
REACH = 0.25
#: of the wall, a shell's decay length is about sqrt(radius wall); a solid shaft's is its radius
SHELL = 2.0
#: lines nearer to the far end of an interval than this share of it are left out
ROOM_ONE, ROOM_TWO = 0.75, 0.45


@dataclass(frozen=True)
class Grading:
    """How fine a mesh is where, in local lengths, so that a small step at one place does not refine
    another.

    The local length of a segment is its outer radius, or the decay length of a shell where its wall
    is thin.

    Attributes
    ----------
    layers : int
        Geometric layers towards right-angled shoulders and rigid seat ends, the strongest
        singularities.
    edge_layers : int
        The same towards the ends of averaged seats.
    radial_layers : int
        As ``layers``, across the thickness, where a line costs more cells than along the shaft.
    ratio : float
        Size of a layer relative to the one before, 0.15 to 0.5.
    relative_size : float
        Size of a cell away from singular points, in local lengths.
    size : float or None
        Size of a cell away from singular points in m, in place of ``relative_size``.
    reach, radial_reach : float
        Where grading starts, in local lengths from the singular point, along the shaft and across.
    refinement : float
        Multiplies the number of cells everywhere.
    core : bool
        Start the band on the axis with one cell of half its width, room for the core of an O-grid.
    """

    layers: int = 3
    edge_layers: int = 1
    radial_layers: int | None = None
    ratio: float = 0.2
    relative_size: float = 1.0
    size: float | None = None
    reach: float = REACH
    radial_reach: float = REACH
    refinement: float = 1.0
    core: bool = False

    @property
    def across(self) -> int:
        """Layers across the thickness."""
        return self.layers if self.radial_layers is None else self.radial_layers

    @property
    def edge(self) -> int:
        """Layers towards the ends of averaged seats, never more than towards shoulders."""
        return min(self.edge_layers, self.layers)

    def cell(self, segment) -> tuple[float, float]:
        """Cell size (m) beside singular points of a segment and away from them."""
        if self.size is not None:
            return self.size, self.size
        far = self.relative_size * min(segment.outer0, segment.outer1)
        return min(self.relative_size, 1.0) * local_length(segment), far


def local_length(segment) -> float:
    """Length (m) over which what happens at a line of the surface dies away: the radius, or a
    shell's ``2 sqrt(r t)``.
    """
    wall = min(segment.outer0 - segment.inner0, segment.outer1 - segment.inner1)
    radius = min(segment.outer0, segment.outer1)
    return min(radius, SHELL * float(np.sqrt(radius * wall)))


def corner_length(segment) -> float:
    """Length (m) over which stress at a corner is singular: the wall, or the radius of a solid
    shaft.
    """
    return min(
        segment.outer0 - segment.inner0,
        segment.outer1 - segment.inner1,
        segment.outer0,
        segment.outer1,
    )


def layout(scene, grading: Grading, attachments: tuple[str, ...] | None = None) -> Layout:
    """Lay out bands and mesh lines for a scene.

    Parameters
    ----------
    scene : Scene
    grading : Grading
    attachments : tuple of str, optional
        Attachments every station will be built with; by default what the scene says.  Planes of section ties are lines of
        the mesh and graded, ends of rigid seats are graded like shoulders.
    """
    segments = scene.segments
    tol = 1e-9 * scene.length
    bands, left, right = _bands(segments)
    marks = _marks(scene, grading, attachments)
    lines = [np.array([0.0])]
    for a, b in zip(marks, marks[1:]):
        owner = next(s for s in segments if (a.y + b.y) / 2 < s.y1 + tol)
        reach = [
            grading.reach
            * min(corner_length(s) for s in segments if s.y0 < m.y + tol and m.y < s.y1 + tol)
            for m in (a, b)
        ]
        lines.append(
            a.y
            + graded(
                b.y - a.y,
                grading.cell(owner),
                grading.ratio,
                reach,
                grading.refinement,
                a.layers,
                b.layers,
            )[1:]
        )
    y = np.concatenate(lines)
    middle = (y[1:] + y[:-1]) / 2
    segment = np.minimum(np.searchsorted([s.y1 for s in segments], middle), len(segments) - 1)
    return Layout(
        y, segment, bands, left, right, _fractions(scene, grading, attachments, bands, left, right)
    )


@dataclass(frozen=True)
class _Mark:
    """An axial place that must be a line of the mesh, and the layers it needs on either side."""

    y: float
    layers: int


def _marks(scene, grading: Grading, attachments) -> list[_Mark]:
    """Ends, segment boundaries, seat ends and section planes; where several coincide the strongest
    counts.
    """
    segments, tol = scene.segments, 1e-9 * scene.length
    weight: dict[float, int] = {s.y0: 0 for s in segments} | {segments[-1].y1: 0}

    def add(y: float, layers: int) -> None:
        weight[y] = max(weight.get(y, 0), layers)

    for station in scene.stations:
        ties = attachments or (station.attachment,)
        held = "rigid" in ties
        for y in (station.lo, station.hi):
            at_face = min(abs(y), abs(y - scene.length)) <= tol
            # An averaged seat that ends at a face meets no edge there; a rigid one is clamped up to
            # the corner.
            add(y, grading.layers if held else 0 if at_face else grading.edge)
        planes = "section" in ties and tol < station.y < scene.length - tol
        add(station.y, max(grading.edge, grading.layers - 1) if planes else 0)
    for a, b in zip(segments, segments[1:]):
        add(b.y0, corner_layers(a, b, grading.layers))
    distinct = _distinct(sorted(weight), tol)
    return [_Mark(m, max(w for y, w in weight.items() if abs(y - m) <= tol)) for m in distinct]


def _fractions(
    scene, grading: Grading, attachments, bands, left, right
) -> dict[tuple[int, int], np.ndarray]:
    """Subdivision of every radial band, graded towards the surfaces that carry singular points."""
    segments = scene.segments
    needs = _radial_needs(scene, grading, attachments, bands)
    fractions = {}
    for band in range(min(b[0] for b in bands), max(b[1] for b in bands)):
        having = [k for k, b in enumerate(bands) if b[0] <= band < b[1]]
        for first in sorted({first_of_run(bands, band, k) for k in having}):
            run = [k for k in having if first_of_run(bands, band, k) == first]
            place = {k: band - bands[k][0] for k in run}
            thickness = max(
                float(max(np.diff(left[k])[i], np.diff(right[k])[i])) for k, i in place.items()
            )
            # The axis is the only band boundary that is no surface anywhere.
            on_axis = any(
                i == 0 and left[k][0] == 0.0 and right[k][0] == 0.0 for k, i in place.items()
            )
            sizes = [grading.cell(segments[k]) for k in run]
            cell = min(s[0] for s in sizes), min(s[1] for s in sizes)
            ends = [
                max(needs.get((edge, k), (0, thickness)) for k in run) for edge in (band, band + 1)
            ]
            layers, reach = [n for n, _ in ends], [r for _, r in ends]
            if on_axis:
                layers[0] = 0
            whole = not (on_axis and grading.core)
            part = thickness if whole else thickness / 2
            lines = graded(part, cell, grading.ratio, reach, grading.refinement, *layers)
            lines = lines if whole else np.concatenate([[0.0], part + lines])
            fractions[band, first] = lines / thickness
    return fractions


def _radial_needs(
    scene, grading: Grading, attachments, bands
) -> dict[tuple[int, int], tuple[int, float]]:
    """Layers and reach (m) that a band boundary needs in a segment."""
    segments = scene.segments
    needs: dict[tuple[int, int], tuple[int, float]] = {}

    def add(boundary: int, segment: int, layers: int, reach: float) -> None:
        if layers:
            needs[boundary, segment] = max(
                needs.get((boundary, segment), (0, 0.0)), (layers, reach)
            )

    for i, (a, b) in enumerate(zip(segments, segments[1:])):
        layers = corner_layers(a, b, grading.across)
        reach = grading.radial_reach * min(corner_length(a), corner_length(b))
        # A band boundary meets a shoulder where it is the surface of the smaller neighbour.
        for boundary in (min(bands[i][1], bands[i + 1][1]), max(bands[i][0], bands[i + 1][0])):
            for k in (i, i + 1):
                add(boundary, k, layers, reach)
    for station in scene.stations:
        held = "rigid" in (attachments or (station.attachment,))
        for i, s in enumerate(segments):
            if s.y0 < station.hi - TOUCH and station.lo + TOUCH < s.y1:
                layers = grading.across if held else min(grading.edge, grading.across)
                add(bands[i][1], i, layers, grading.radial_reach * corner_length(s))
    return needs


def graded(length, size, ratio, reach, refinement, low: int, high: int) -> np.ndarray:
    """Positions 0 .. length of mesh lines with geometric layers towards the two ends.

    Layers stand at ``reach ratio^k`` from their end, k = 0 .. layers, as far as there is room: a short interval between two
    singular points is a layer itself and is not filled with more.  Beyond ``reach`` cells go on growing by the same ratio up to the
    smaller size, from there with the distance.
    The density is that of refinement 1; other refinements sample it with proportionally more cells, which keeps meshes similar.

    Parameters
    ----------
    length : float
        m.
    size : float or (float, float)
        Largest cell, m; two sizes are those at the ends and far from them.
    ratio : float
    reach : float or (float, float)
        Distance at which grading starts, m, at both ends or at each.
    refinement : float
    low, high : int
        Layers at the two ends.
    """
    near, far = (size, size) if np.ndim(size) == 0 else size
    first, last = (reach, reach) if np.ndim(reach) == 0 else reach
    room = (ROOM_TWO if low and high else ROOM_ONE) * length
    places = {0.0, float(length)}
    for layers, start, place in ((low, first, lambda d: d), (high, last, lambda d: length - d)):
        if layers:
            beyond = max(
                0, int(np.ceil(np.log(near / start / (1 - ratio)) / -np.log(ratio) - 1e-6))
            )
            places |= {
                float(place(d)) for d in start * ratio ** np.arange(-beyond, layers + 1) if d < room
            }
    lines = np.array(_distinct(sorted(places), 1e-9 * length))
    lines[-1] = length  # a last layer thinner than that must not move the end
    filled = [lines[:1]]
    for a, b in zip(lines[:-1], lines[1:]):
        filled.append(_filled(a, b, length, near, far)[1:])
    lines = np.concatenate(filled)
    n = len(lines) - 1
    m = max(1, int(round(n * refinement)))
    return lines if m == n else np.interp(np.linspace(0, n, m + 1), np.arange(n + 1), lines)


def _filled(a: float, b: float, length: float, near: float, far: float) -> np.ndarray:
    """Lines from a to b no further apart than the local cell size: ``near``, or the distance to the
    nearer end where that is more, up to ``far``.
    """
    if near >= far:
        n = max(1, int(np.ceil((b - a) / far - 1e-6)))
        return np.linspace(a, b, n + 1)
    x = np.linspace(a, b, 257)
    size = np.minimum(np.maximum(near, np.minimum(x, length - x)), far)
    cells = np.concatenate([[0.0], np.cumsum(np.diff(x) * (1 / size[1:] + 1 / size[:-1]) / 2)])
    n = max(1, int(np.ceil(cells[-1] - 1e-6)))
    lines = np.interp(np.linspace(0, cells[-1], n + 1), cells, x)
    lines[0], lines[-1] = a, b
    return lines


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
    for i in range(n - 1):
        a, b = segments[i], segments[i + 1]
        low, high = max(bottoms[i], bottoms[i + 1]), min(tops[i], tops[i + 1])
        common = {low: max(a.inner1, b.inner0), high: min(a.outer1, b.outer0)}
        right[i] = spread(*bands[i], {**common, bottoms[i]: a.inner1, tops[i]: a.outer1})
        left[i + 1] = spread(
            *bands[i + 1], {**common, bottoms[i + 1]: b.inner0, tops[i + 1]: b.outer0}
        )
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
