"""A keyway."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Literal

from solidgear.core import TOUCH, PositiveLength, SceneError
from solidgear.core.scene.feature import SMALLEST
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.cut import Frame, Long

#: diameter of a disc mill over the depth that it cuts, at least
LEAST_MILL = 4


class Keyway(Long):
    """A slot with a flat floor along a cylinder.

    It begins at y (m) with a length that includes round ends, at an angle around the shaft, rad: 0 is
    +z, a quarter turn is +x.

    Examples
    --------
    >>> from solidgear.cuts.features import Keyway
    >>> key = Keyway(name="key", segment="shaft", y="120 mm", length="100 mm", width="25 mm",
    ...              depth="9 mm")
    >>> key.reach(0.045)
    (0.12, 0.22)
    """

    kind: Literal["keyway"] = "keyway"
    #: width, m
    width: PositiveLength
    #: depth below the crown of the cylinder, m (t1 of DIN 6885)
    depth: PositiveLength
    #: shape of both ends
    ends: Literal["round", "square"] = "round"
    #: radius at the edges of the floor, m, for stress alone: models have sharp ones
    radius: PositiveLength | None = None
    #: diameter of the disc mill that square ends run out with beyond the length, m, for stress alone
    mill: PositiveLength | None = None

    def _sized(self, segment: Segment) -> Iterator[SceneError]:
        yield from self._deep(segment)
        if self.width >= segment.outer0:
            yield SceneError(
                f"must not be wider than the radius, {segment.outer0:.6g} m",
                path=("width",),
            )
        elif self.width < SMALLEST * segment.outer0:
            yield SceneError(
                f"is under a hundredth of the radius, {segment.outer0:.6g} m", path=("width",)
            )
        # at the edges of the slot the surface lies lower than at its crown
        elif segment.outer0 - math.sqrt(segment.outer0**2 - self.width**2 / 4) >= self.depth:
            yield SceneError(
                "the surface at the sides of the keyway lies below its floor: it is too wide, or "
                "not deep enough",
                path=("depth",),
            )
        elif self.radius is not None and self.radius > min(self.depth, self.width / 2):
            yield SceneError(
                "the edges of the floor have radii up to the depth, and half the width",
                path=("radius",),
            )
        elif self.mill is not None and self.ends == "round":
            yield SceneError(
                'a disc mill runs out beyond square ends; write ends = "square"', path=("mill",)
            )
        elif self.mill is not None and self.mill < LEAST_MILL * self.depth:
            yield SceneError(
                f"a disc mill is larger than {LEAST_MILL} times the depth, {self.depth:.6g} m",
                path=("mill",),
            )
        elif self.ends == "round" and self.length <= self.width + TOUCH:
            yield SceneError(
                f"with round ends a keyway is longer than it is wide ({self.width:.6g} m)",
                path=("length",),
            )

    def half_width(self, radius: float) -> float:
        return self.width / 2

    @property
    def rounded(self) -> bool:
        return self.ends == "round"

    def tool(self, occ: Any, radius: float, top: float) -> int:
        lo, hi = self.reach(radius)
        floor, half = self.floor(radius), self.width / 2
        a, b = (lo + half, hi - half) if self.rounded else (lo, hi)
        places = ((-half, a), (half, a), (half, b), (-half, b))
        points = [occ.addPoint(x, y, floor) for x, y in places]
        sides = [occ.addLine(points[1], points[2]), occ.addLine(points[3], points[0])]
        if self.rounded:
            start = _half_circle(occ, points[0], points[1], (a, lo), floor)
            end = _half_circle(occ, points[2], points[3], (b, hi), floor)
        else:
            start = [occ.addLine(points[0], points[1])]
            end = [occ.addLine(points[2], points[3])]
        loop = occ.addCurveLoop([*start, sides[0], *end, sides[1]])
        drawn = occ.extrude([(2, occ.addPlaneSurface([loop]))], 0, 0, self.depth + top)
        return next(tag for dim, tag in drawn if dim == 3)

    def along(self, side: float, radius: float) -> float:
        half = self.width / 2
        if not self.rounded:
            return self.length
        return self.length - 2 * half + 2 * math.sqrt(half**2 - side * side)

    def edges(self, radius: float) -> tuple[float, float]:
        # half a circle of fewer than four edges is no end of a keyway: five leave room for them
        curved = math.pi * self.width / 10 if self.rounded else math.inf
        return min(self.depth, self.width / 2), curved

    def beside_edges(self, radius: float, frame: Frame) -> str:
        (lo, hi), half, num = self.reach(radius), self.width / 2, frame.num
        if self.rounded:
            along = frame.outside(lo + half, hi - half)
            return f"(Sqrt({frame.across}^2+{along}^2)-{num(half)})"
        aside, along = f"({frame.across}-{num(half)})", f"Max({num(lo)}-y,y-{num(hi)})"
        outside = f"Sqrt(Max(0,{aside})^2+Max(0,{along})^2)"
        return f"({outside}+Min(0,Max({aside},{along})))"


def _half_circle(
    occ: Any, first: int, last: int, y: tuple[float, float], floor: float
) -> list[int]:
    """Draw the end of a slot between two points by way of its tip, with middle and tip at `y`, and
    return the tags of both arcs.
    """
    middle, tip = (occ.addPoint(0, place, floor) for place in y)
    return [occ.addCircleArc(first, middle, tip), occ.addCircleArc(tip, middle, last)]
