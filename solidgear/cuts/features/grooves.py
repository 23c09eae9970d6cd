"""Grooves around a cylinder: rectangular, round and V grooves."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from solidgear.core import PositiveLength, Range, SceneError, SignedAngle
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.detail import Detail, floor_problems


class Groove(Detail):
    """A groove around a cylinder, with its floor by depth or diameter."""

    needs: ClassVar = (("depth", "diameter"),)

    #: depth below the cylinder, m
    depth: PositiveLength | None = None
    #: diameter of the floor, m, in place of the depth
    diameter: PositiveLength | None = None

    def depth_in(self, radius: float) -> float:
        """Return the depth in a cylinder of a radius, m."""
        return self.depth if self.depth is not None else radius - (self.diameter or 0.0) / 2

    def _sized(self, segment: Segment) -> Iterator[SceneError]:
        problems = list(floor_problems(self.what, segment, self.depth, self.diameter))
        yield from problems or self._shaped(self.depth_in(segment.outer0))

    def _shaped(self, depth: float) -> Iterator[SceneError]:
        """Yield problems of the shape of a groove of a depth, m."""
        raise NotImplementedError


class RingGroove(Groove):
    """A rectangular groove, such as that of a retaining ring; y (m) is where it begins.

    Examples
    --------
    >>> groove = RingGroove(name="ring", segment="rod", y="0.1 m", width="1.85 mm", depth="1.25 mm")
    >>> [round(y, 5) for y in groove.reach(0.02)]
    [0.1, 0.10185]
    """

    kind: Literal["ring_groove"] = "ring_groove"
    #: width along the shaft, m
    width: PositiveLength
    #: radius of both corners of the floor, m; sharp where none is given
    radius: PositiveLength | None = None

    def reach(self, radius: float) -> tuple[float, float]:
        return self.y, self.y + self.width

    def _shaped(self, depth: float) -> Iterator[SceneError]:
        most = min(depth, self.width / 2)
        if self.radius is not None and self.radius > most:
            yield SceneError(
                f"the corners of a groove of this depth and width have radii up to {most:.6g} m; a "
                'larger one is that of kind = "round_groove"',
                path=("radius",),
            )


class RoundGroove(Groove):
    """A groove with a round floor; y (m) is its middle.

    Examples
    --------
    >>> groove = RoundGroove(name="groove", segment="rod", y=0.1, radius="2 mm", depth="1 mm")
    >>> [round(y, 5) for y in groove.reach(0.02)]  # half of the chord is sqrt(2^2 - 1^2) mm
    [0.09827, 0.10173]
    """

    kind: Literal["round_groove"] = "round_groove"
    #: radius of the floor, m
    radius: PositiveLength

    def reach(self, radius: float) -> tuple[float, float]:
        over = max(self.radius - self.depth_in(radius), 0.0)
        half = math.sqrt(self.radius**2 - over**2)
        return self.y - half, self.y + half

    def _shaped(self, depth: float) -> Iterator[SceneError]:
        yield from ()


class VGroove(Groove):
    """A groove with straight flanks at an angle, and a small radius at their root; y (m) is its
    middle.

    Examples
    --------
    >>> groove = VGroove(name="v", segment="rod", y=0.1, depth="2 mm")
    >>> [round(y, 5) for y in groove.reach(0.02)]
    [0.09879, 0.10121]
    """

    kind: Literal["v_groove"] = "v_groove"
    #: radius of the root, m
    radius: PositiveLength = 1e-4
    #: angle between the flanks, rad
    flank_angle: Annotated[
        SignedAngle,
        Range(
            "the flanks of a V groove stand at 30 to 120 degrees (0.524 to 2.094 rad)",
            least=math.radians(30) * (1 - 1e-9),
            most=math.radians(120) * (1 + 1e-9),
        ),
    ] = math.radians(60)

    def reach(self, radius: float) -> tuple[float, float]:
        lean = math.tan(self.flank_angle / 2)
        # flanks meet below the round root
        below = self.radius * (1 / math.sin(self.flank_angle / 2) - 1)
        half = (self.depth_in(radius) + below) * lean
        return self.y - half, self.y + half

    def _shaped(self, depth: float) -> Iterator[SceneError]:
        if self.radius > depth:
            yield SceneError(
                f"is above the depth, {depth:.6g} m; write a round groove", path=("radius",)
            )
