"""Fineness of a mesh from place to place: local lengths, cell sizes, and lines graded towards the
two ends.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, log
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.scene.limits import TOUCH
from solidgear.core.scene.shaft import on_face

if TYPE_CHECKING:
    from solidgear.core.scene import Bearing, PointMass, Port, Segment

    Station = Port | Bearing | PointMass

#: thin or thick end of a segment: the lesser or the larger of two lengths
End = Callable[[float, float], float]
#: where grading starts, in local lengths; one layer of ratio 0.2 begins at a twentieth of a radius
REACH = 0.25
#: of the wall, a shell's decay length is about sqrt(radius wall); a solid shaft's is its radius
SHELL = 2.0
#: lines nearer to the far end of an interval than this share of it are left out
ROOM_ONE, ROOM_TWO = 0.75, 0.45

#: least size of cells of a cone, over that of a cylinder as thick as its thick end
FLOOR = 0.5
#: seats narrower than this many cells' depths indent the shaft unseen by the cells: after two meshes a
#: plain bar with a seat as wide as its radius was 2.5e-3 off, one of two radii 1e-4
DEEP = 2.5
#: of a number of layers that is whole but for it
ROUNDING = 1e-9


@dataclass(frozen=True)
class Grading:
    """Fineness of a mesh from place to place, in local lengths, so that a small step at one place
    does not refine another.

    The local length of a segment is its outer radius, or the decay length of a shell where its wall
    is thin.
    """

    #: geometric layers towards right-angled shoulders and rigid seat ends, the strongest
    #: singularities
    layers: int = 3
    edge_layers: int = 1  #: the same towards the ends of averaged seats
    #: as ``layers``, across the thickness, where a line costs more cells than along the shaft
    radial_layers: int | None = None
    ratio: float = 0.2  #: size of a layer relative to the one before, 0.15 to 0.5
    relative_size: float = 1.0  #: size of a cell away from singular points, in local lengths
    #: size of a cell away from singular points in m, in place of ``relative_size``
    size: float | None = None
    #: reach, radial_reach: where grading starts, in local lengths from the singular point, along
    #: the shaft and across
    reach: float = REACH
    radial_reach: float = REACH
    refinement: float = 1.0  #: multiplies the number of cells everywhere
    #: start the band on the axis with one cell of half its width, room for the core of an O-grid
    core: bool = False
    corner_cells: int = 1  #: cells along either half of a fillet, at refinement 1
    #: whether nothing narrow or thin asks for lines of its own: those come later, where the error
    #: is
    plain: bool = False

    @property
    def across(self) -> int:
        """Layers across the thickness."""
        return self.layers if self.radial_layers is None else self.radial_layers

    @property
    def edge(self) -> int:
        """Layers towards the ends of averaged seats, never more than towards shoulders."""
        return min(self.edge_layers, self.layers)

    def seat_layers(
        self, station: Station, segments: Sequence[Segment], ties: Sequence[str]
    ) -> int:
        """Return the further layers towards the ends of a narrow seat that is built with some ties.

        A load on a ring indents the shaft over a few widths of the ring, which cells that know of
        the radius only do not see: two coarse meshes then agree on an error of both. The layers are
        as many as bring the last one down to the width of the seat; none where grading starts
        within it, on a line, or under sections, which spread no load on it. Where no shoulder
        grades the surface (:func:`ungraded_depth`) one for a seat that is narrower than two and a
        half depths of its cells.
        """
        width = station.hi - station.lo
        seat_segments = segments_under(station, segments)
        if self.plain or width <= 2 * TOUCH or not seat_segments or set(ties) <= {"section"}:
            return 0
        start = self.reach * max(corner_length(segments[k]) for k in seat_segments)
        more = ceil(log(width / start) / log(self.ratio) - ROUNDING)
        graded = self.layers if "rigid" in ties else self.edge
        if more > 0 or graded or not self.layers:
            return max(0, more)
        return int(
            width < DEEP * max(ungraded_depth(segments, k) for k in seat_segments) * (1 - ROUNDING)
        )

    @property
    def along_corner(self) -> int:
        """Cells along either half of a fillet."""
        return max(1, round(self.corner_cells * self.refinement))

    def cell(self, segment: Segment, across: bool = False) -> tuple[float, float]:
        """Return the cell sizes of a segment beside singular points and away from them, m, along the
        shaft or across; of a slender cone by no less than half its thick end. Along, cells grow from
        a thin end with the distance.
        """
        if self.size is not None:
            return self.size, self.size
        near = local_length(segment)
        far = max(_radius(segment), FLOOR * _radius(segment, max))
        if across:
            near = max(near, FLOOR * local_length(segment, max))
        return min(self.relative_size, 1.0) * near, self.relative_size * far


def local_length(segment: Segment, end: End = min) -> float:
    """Return the length over which the effect of a line on the surface dies away, m: the radius, or
    a shell's ``2 sqrt(r t)``.

    Examples
    --------
    >>> from solidgear import Segment
    >>> solid = Segment.cylinder("solid", length=0.3, diameter=0.1)
    >>> tube = Segment.cylinder("tube", length=0.3, diameter=0.1, bore=0.096)
    >>> local_length(solid), round(local_length(tube), 6)
    (0.05, 0.02)
    """
    radius = _radius(segment, end)
    return min(radius, SHELL * float(np.sqrt(radius * _wall(segment, end))))


def corner_length(segment: Segment) -> float:
    """Return the length over which stress at a corner is singular, m: the wall, or the radius of a
    solid shaft.
    """
    return min(_wall(segment), _radius(segment))


def joint_length(segments: Sequence[Segment], k: int) -> float:
    """Return the length over which stress at the corners where segment k ends is singular, m.

    The least of the walls on both sides, and of a disc that stands out further than it is thick,
    its thickness.

    Examples
    --------
    >>> from solidgear import Segment
    >>> shaft = Segment.cylinder("shaft", length=0.3, diameter=0.1)
    >>> disc = Segment.cylinder("disc", y0=0.3, length=0.01, diameter=0.5)
    >>> [round(joint_length(pair, 0), 6) for pair in ((shaft, shaft), (shaft, disc))]
    [0.05, 0.01]
    """
    length = min(corner_length(segments[k]), corner_length(segments[k + 1]))
    for surface in (_outer, _bore):
        before, after = surface(segments[k])[1], surface(segments[k + 1])[0]
        standing = segments[k + 1 :] if after > before else segments[k::-1]
        thickness = _thickness(standing, surface, min(before, after))
        if TOUCH < thickness < abs(after - before):
            length = min(length, thickness)
    return length


def _thickness(segments, surface, low: float) -> float:
    """Return the length of the first segments whose surface stays above a level, m."""
    total = 0.0
    for segment in segments:
        if min(surface(segment)) <= low + TOUCH:
            break
        total += segment.length
    return total


def _outer(segment) -> tuple[float, float]:
    return segment.outer0, segment.outer1


def _bore(segment) -> tuple[float, float]:
    """Return the bore, the higher the further it stands in."""
    return -segment.inner0, -segment.inner1


def segments_under(station: Station, segments: Sequence[Segment]) -> list[int]:
    """Return the places of the segments that a seat lies on, or that end at a face."""
    lo, hi = station.lo + TOUCH, station.hi - TOUCH
    if on_face(station):
        lo, hi = hi, lo
    return [k for k, s in enumerate(segments) if s.y0 < hi and lo < s.y1]


def ungraded_depth(segments: Sequence[Segment], k: int) -> float:
    """Return the depth of the cells of a coarse mesh under the surface of segment k, m; zero where
    the surface itself is graded.

    A shoulder grades the surface of its smaller side, and lines run on from there into the larger
    one: between them and a surface that no shoulder ends at there is nothing.

    Examples
    --------
    >>> from solidgear import Segment
    >>> thin, thick = (
    ...     Segment.cylinder(n, y0=y, length=0.1, diameter=d)
    ...     for n, y, d in (("a", 0.0, 0.04), ("b", 0.1, 0.1))
    ... )
    >>> [round(ungraded_depth((thin, thick), k), 6) for k in (0, 1)]
    [0.0, 0.03]
    >>> ungraded_depth((thin,), 0)
    0.02
    """
    depth = corner_length(segments[k])
    after = [(a.outer1, b.outer0) for a, b in zip(segments[k:], segments[k + 1 :])]
    before = [(b.outer0, a.outer1) for a, b in zip(segments[:k], segments[1 : k + 1])]
    for pairs in (after, reversed(before)):
        step = next(((near, far) for near, far in pairs if abs(near - far) > TOUCH), None)
        if step:
            depth = min(depth, max(step[0] - step[1], 0.0))
    return depth


def _radius(segment, end: End = min) -> float:
    return end(segment.outer0, segment.outer1)


def _wall(segment, end: End = min) -> float:
    return end(segment.outer0 - segment.inner0, segment.outer1 - segment.inner1)


def graded(length, size, ratio, reach, refinement, low: int, high: int) -> np.ndarray:
    """Return positions 0 .. length of mesh lines, ascending, m, with geometric layers towards the
    two ends.

    Layers stand at ``reach ratio^k`` from their end, k = 0 .. layers, as far as there is room: a
    short interval between two singular points is a layer itself and is not filled with more. Beyond
    ``reach`` cells go on growing by the same ratio up to the smaller size, from there with the
    distance. The density is that of refinement 1; other refinements sample it with proportionally
    more cells, which keeps meshes similar.

    `size` is the largest cell, m, or two sizes at the ends and far from them; `ratio` that of a
    layer to the one before; `reach` the distance at which grading starts, m, at both ends or at
    each; `low` and `high` are the layers at the two ends.

    Examples
    --------
    Two layers towards the low end, at 0.1 x 0.2^k:

    >>> lines = graded(1.0, size=0.5, ratio=0.2, reach=0.1, refinement=1.0, low=2, high=0)
    >>> [round(float(y), 6) for y in lines[:4]]
    [0.0, 0.004, 0.02, 0.1]
    """
    near, far = (size, size) if np.ndim(size) == 0 else size
    first, last = (reach, reach) if np.ndim(reach) == 0 else reach
    room = (ROOM_TWO if low and high else ROOM_ONE) * length
    places = {0.0, float(length)}
    if low:
        places |= {float(d) for d in _layers(low, first, near, ratio) if d < room}
    if high:
        places |= {float(length - d) for d in _layers(high, last, near, ratio) if d < room}
    lines = np.array(distinct(sorted(places), 1e-9 * length))
    lines[-1] = length  # a last layer thinner than that must not move the end
    stretches = [lines[:1]]
    for a, b in zip(lines[:-1], lines[1:]):
        stretches.append(_filled(a, b, length, near, far)[1:])
    lines = np.concatenate(stretches)
    n = len(lines) - 1
    m = max(1, int(round(n * refinement)))
    return lines if m == n else np.interp(np.linspace(0, n, m + 1), np.arange(n + 1), lines)


def _layers(count: int, start: float, near: float, ratio: float) -> np.ndarray:
    """Return distances of lines from an end: the layers, and beyond ``start`` up to cells of
    ``near``.
    """
    growing = max(0, int(np.ceil(np.log(near / start / (1 - ratio)) / -np.log(ratio) - 1e-6)))
    return start * ratio ** np.arange(-growing, count + 1)


def _filled(a: float, b: float, length: float, near: float, far: float) -> np.ndarray:
    """Return lines from a to b no further apart than the local cell size: ``near``, or the distance
    to the nearer end where that is more, up to ``far``.
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


def distinct(values: Sequence[float], tol: float) -> list[float]:
    """Return ascending values without those that repeat the one before, to a tolerance.

    Examples
    --------
    >>> distinct([0.0, 1e-12, 0.5], 1e-9)
    [0.0, 0.5]
    """
    out = [values[0]]
    for v in values[1:]:
        if v - out[-1] > tol:
            out.append(v)
    return out
