"""A hole across the shaft."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

import numpy as np

from solidgear.core import Length, PositiveLength, Range, SceneError, SignedAngle
from solidgear.core.scene.feature import SMALLEST
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.cut import Cut, Frame

#: inclination beyond which the rim of the mouth is a wedge of less than 30 degrees, which no mesh
#: resolves
STEEPEST = math.radians(60)
#: places across a hole at which its ends are looked for; the largest of them is off by their square
PLACES = 2001


class CrossHole(Cut):
    """A hole drilled across the shaft, all the way through; y (m) is where it passes the axis.

    Examples
    --------
    >>> from solidgear.cuts.features import CrossHole
    >>> hole = CrossHole(name="oil", segment="shaft", y="50 mm", diameter="8 mm")
    >>> [round(y, 3) for y in hole.reach(0.03)]
    [0.046, 0.054]
    >>> oblique = hole.with_changes(inclination="45 deg")
    >>> [round(y, 4) for y in oblique.reach(0.03)]
    [0.0143, 0.0857]
    """

    notched: ClassVar[bool] = False

    kind: Literal["cross_hole"] = "cross_hole"
    #: diameter of the hole, m
    diameter: PositiveLength

    #: angle of its axis to the plane at right angles to the shaft, rad: where it looks to, it
    #: leans towards the end of the shaft
    inclination: Annotated[
        SignedAngle,
        Range(
            "must lie between -60 and 60 degrees (-1.047 and 1.047 rad): the angle of the hole to "
            "the plane at right angles to the shaft",
            least=-STEEPEST * (1 + 1e-9),
            most=STEEPEST * (1 + 1e-9),
        ),
    ] = 0.0
    #: distance by which its axis passes that of the shaft, m, a quarter turn on from where it
    #: looks to: at the angle 0 towards +x
    offset: Length = 0.0

    def reach(self, radius: float) -> tuple[float, float]:
        # line by line of the wall, where it leaves the shaft
        half = self.diameter / 2
        side = np.clip(self.offset + half * np.linspace(-1, 1, PLACES), -radius, radius)
        along = np.sqrt(half**2 - np.clip(side - self.offset, -half, half) ** 2)
        lean = np.sqrt(radius**2 - side**2) * math.tan(abs(self.inclination))
        away = float((lean + along / math.cos(self.inclination)).max())
        return self.y - away, self.y + away

    def mirrored(self, across: bool) -> bool:
        return not self.inclination if across else not self.offset

    def _sized(self, segment: Segment) -> Iterator[SceneError]:
        least = SMALLEST * segment.outer0
        lo, hi = self.reach(segment.outer0)
        gap, room = min(lo - segment.y0, segment.y1 - hi), least * math.tan(abs(self.inclination))
        if self.diameter >= segment.outer0:
            yield SceneError(
                f"a cross hole wider than the radius, {segment.outer0:.6g} m, leaves no shaft",
                path=("diameter",),
            )
        elif self.diameter < 2 * least:
            yield SceneError(
                f"is under a hundredth of the diameter, {2 * segment.outer0:.6g} m",
                path=("diameter",),
            )
        elif self.offset and abs(self.offset) + self.diameter / 2 > segment.outer0 - least:
            yield SceneError(
                "the hole runs out of the side of the shaft: with its diameter the offset may be "
                f"{segment.outer0 - least - self.diameter / 2:.6g} m at most",
                path=("offset",),
            )
        elif segment.inner0 and abs(abs(self.offset) - self.diameter / 2 - segment.inner0) < least:
            yield SceneError(
                f"the wall of the hole grazes the bore, of radius {segment.inner0:.6g} m: let it cross "
                "the bore, or pass beside it",
                path=("offset",),
            )
        elif gap < room:
            yield SceneError(
                f"the rim of the oblique hole lies {max(gap, 0.0):.3g} m from an end of "
                f'"{segment.name}", where a shoulder may stand: leave {room:.3g} m or more',
                path=("y",),
            )

    def tool(self, occ: Any, radius: float, top: float) -> int:
        if self.inclination:
            # no further out than its ends need, since a shoulder may stand beside them
            top = SMALLEST * radius
        half, lean = self.diameter / 2, self.inclination
        far = (radius + top) / math.cos(lean) + half * math.tan(abs(lean))
        height, along = far * math.cos(lean), far * math.sin(lean)
        return occ.addCylinder(self.offset, self.y - along, -height, 0, 2 * along, 2 * height, half)

    def volume(self, outer: float, inner: float) -> float:
        return self._moment(outer, inner, 0)

    def centre(self, outer: float, inner: float) -> tuple[float, float]:
        if not self.offset:
            return 0.0, 0.0
        return self._moment(outer, inner, 1) / self._moment(outer, inner, 0), 0.0

    def _moment(self, outer: float, inner: float, power: int) -> float:
        """Return the integral of a power of the distance from the middle plane over the hole."""
        from scipy.integrate import quad

        half = self.diameter / 2

        def section(side: float) -> float:
            x = self.offset + side
            wall = math.sqrt(outer**2 - x * x) - math.sqrt(max(inner**2 - x * x, 0.0))
            return 4 * x**power * math.sqrt(half**2 - side**2) * wall

        bore_sides = (side - self.offset for side in (-inner, inner))
        kinks = [side for side in bore_sides if abs(side) < half] or None
        # of the moment about the axis, both sides may cancel
        least = 1e-10 * outer ** (3 + power)
        area = quad(section, -half, half, points=kinks, epsabs=least * power, epsrel=1e-10)[0]
        return area / math.cos(self.inclination)

    def edges(self, radius: float) -> tuple[float, float]:
        # a circle of fewer than eight edges is no hole: it loses a fifteenth of its volume; mouths
        # are ellipses, and narrower by the inclination
        return math.inf, math.pi * self.diameter / 8 * math.cos(self.inclination)

    def distance(self, radius: float, frame: Frame) -> str:
        num, along = frame.num, f"(y-{frame.num(self.y)})"
        aside = f"({frame.side}-{num(self.offset)})" if self.offset else frame.across
        if self.inclination:
            c, s = num(math.cos(self.inclination)), num(math.sin(self.inclination))
            along = f"({along}*{c}-{frame.up}*{s})"
        return f"Max(0,Sqrt({aside}^2+{along}^2)-{num(self.diameter / 2)})"

    def lines(self, radius: float) -> tuple[float, float]:
        return 4 * radius / math.cos(self.inclination), self.diameter / 2
