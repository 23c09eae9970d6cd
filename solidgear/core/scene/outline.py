"""Outline of a shaft: lines and arcs of the meridian (r, y), outside and in the bore.

Every line and arc belongs to a segment and a surface.  A fillet or chamfer is a piece like others:
it lies beside the step or rim that it rounds, on the segment whose cylinder it runs into.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from math import atan, atan2, pi
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeAlias, TypeVar

from solidgear.core.scene.corner import SURFACES, Corner, Surface
from solidgear.core.scene.limits import TOUCH

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Segment


class Frustum(NamedTuple):
    """Shape of a segment in plain floats, m."""

    y0: float
    y1: float
    outer0: float
    outer1: float
    inner0: float
    inner1: float

    @classmethod
    def of_segment(cls, segment: Segment) -> Frustum:
        """Return the shape of a segment."""
        return cls(*(float(getattr(segment, name)) for name in cls._fields))


class Torus(NamedTuple):
    """Arc of the meridian of a part from y0 to y1 about a middle (y, r), m."""

    y0: float
    y1: float
    y: float
    r: float
    radius: float
    hollow: bool  #: whether the arc lies between its middle and the axis


Shape: TypeAlias = "Segment | Frustum"
S = TypeVar("S", bound=Shape)


def radii_of(shape: Shape, surface: Surface) -> tuple[float, float]:
    """Return the radii of a surface at both ends of a segment, m."""
    if surface == "outer":
        return shape.outer0, shape.outer1
    return shape.inner0, shape.inner1


class Piece(NamedTuple):
    """A line of the outline, or the arc or line of a fillet or chamfer, along y; m."""

    surface: Surface
    segment: int
    y0: float
    y1: float
    r0: float
    r1: float
    corner: Corner | None = None


@dataclass(frozen=True)
class Edge:
    """Outline of one surface at the joint of two segments."""

    joint: int  #: segment that begins there
    surface: Surface
    y: float  #: m
    #: before, after: radii on both sides, m
    before: float
    after: float
    #: angles to the axis on both sides, rad, positive where the wall grows thicker
    slopes: tuple[float, float]
    root: Corner | None  #: fillet or chamfer that fills the re-entrant corner

    @property
    def r(self) -> float:
        """Radius of the surface that lies deeper in the material, m."""
        return (min if self.surface == "outer" else max)(self.before, self.after)

    @property
    def steps(self) -> bool:
        """True where the radius jumps."""
        return abs(self.after - self.before) > TOUCH

    @property
    def bend(self) -> float:
        """Angle by which a surface without a step turns, rad, positive into the material."""
        return self.slopes[1] - self.slopes[0]

    @property
    def sharp_angle(self) -> float:
        """Material angle without the fillet or chamfer, rad, pi at least."""
        if not self.steps:
            return max(pi, pi + self.bend)
        # the face of the larger segment is vertical, the smaller one's surface leaves it
        rises = (self.after > self.before) == (self.surface == "outer")
        return max(pi, 1.5 * pi - self.slopes[0] if rises else 1.5 * pi + self.slopes[1])

    @property
    def angle(self) -> float:
        """Largest remaining material angle, rad, pi at least: a chamfer leaves two corners."""
        if self.root is None:
            return self.sharp_angle
        if self.root.centre:
            return pi
        slope = atan2(self.root.radial, self.root.axial)
        return pi + max(slope, pi / 2 - slope)


class Outline(Generic[S]):
    """Outline of segments end to end with fillets and chamfers.

    Examples
    --------
    >>> import solidgear as sg
    >>> outline = sg.load("geometry/pinion_filleted.toml").outline
    >>> [(p.segment, p.corner.name) for p in outline.pieces if p.corner]
    [(2, 'head fillet'), (2, 'end chamfer')]
    >>> [(edge.joint, edge.steps, edge.root is None) for edge in outline.edges if edge.r > 0]
    [(1, False, True), (2, True, False)]
    """

    def __init__(self, segments: Iterable[S], corners: Iterable[Corner] = ()):
        self.segments, self.corners = tuple(segments), tuple(corners)
        self._at = {(c.joint, c.surface, c.root, c.side): c for c in self.corners}

    def root(self, joint: int, surface: Surface) -> Corner | None:
        """Return the fillet or chamfer in the step where a segment begins."""
        corners = (self._at.get((joint, surface, True, side)) for side in (1, -1))
        return next((corner for corner in corners if corner), None)

    def rim(self, segment: int, surface: Surface, side: int) -> Corner | None:
        """Return the fillet or chamfer at the rim of a segment, at its start (side 1) or end (-1)."""
        return self._at.get((segment + (side < 0), surface, False, side))

    def shared_face(self, joint: int, segment: int) -> tuple[float, float]:
        """Return the radii in the bore and outside between which the end of a segment at a joint is
        covered by its neighbour, or by a filled corner, m.
        """
        low, high = self.segments[joint - 1], self.segments[joint]
        radii = {
            "bore": max(low.inner1, high.inner0),
            "outer": min(low.outer1, high.outer0),
        }
        for surface in SURFACES:
            root = self.root(joint, surface)
            if root and root.face_owner == segment:
                radii[surface] = root.on_face[0]
        return radii["bore"], radii["outer"]

    @property
    def least_radius(self) -> float:
        """Least outer radius, m."""
        return min(min(s.outer0, s.outer1) for s in self.segments)

    @property
    def largest_radius(self) -> float:
        """Largest outer radius, m."""
        return max(max(s.outer0, s.outer1) for s in self.segments)

    @property
    def steps(self) -> tuple[float, ...]:
        """Places where the outer radius jumps, m, end faces left out."""
        return tuple(e.y for e in self.edges if e.surface == "outer" and e.steps)

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Lines and arcs, surface by surface along y; plane faces across the axis lie between."""
        return tuple(self._pieces())

    def _pieces(self) -> Iterator[Piece]:
        for surface in SURFACES:
            for k, shape in enumerate(self.segments):
                r0, r1 = radii_of(shape, surface)
                y0, y1 = shape.y0, shape.y1
                first, last = (self._corner_on(k, surface, side) for side in (1, -1))
                if first:
                    (face, y0), (r0, end) = first.on_face, first.on_cylinder
                    yield Piece(surface, k, y0, end, face, r0, first)
                    y0 = end
                if last:
                    y1 = last.on_cylinder[1]
                yield Piece(surface, k, y0, y1, r0, r1)
                if last:
                    yield Piece(surface, k, y1, last.y, r1, last.on_face[0], last)

    def _corner_on(self, segment: int, surface: Surface, side: int) -> Corner | None:
        """Return the fillet or chamfer that lies on a segment at its start (side 1) or end (-1)."""
        joint = segment + (side < 0)
        corners = (self._at.get((joint, surface, root, side)) for root in (True, False))
        return next((corner for corner in corners if corner), None)

    @cached_property
    def edges(self) -> tuple[Edge, ...]:
        """Both surfaces at every joint of two segments, along y."""
        return tuple(self._edges())

    def edges_at(self, joint: int) -> tuple[Edge, ...]:
        """Return the edges where a segment begins."""
        return self.edges[2 * joint - 2 : 2 * joint]

    def _edges(self) -> Iterator[Edge]:
        for k, (low, high) in enumerate(zip(self.segments, self.segments[1:]), start=1):
            for surface in SURFACES:
                sign = 1.0 if surface == "outer" else -1.0
                ends = [radii_of(shape, surface) for shape in (low, high)]
                slopes = [
                    atan(sign * (b - a) / (shape.y1 - shape.y0))
                    for shape, (a, b) in zip((low, high), ends)
                ]
                yield Edge(
                    joint=k,
                    surface=surface,
                    y=low.y1,
                    before=ends[0][1],
                    after=ends[1][0],
                    slopes=(slopes[0], slopes[1]),
                    root=self.root(k, surface),
                )
