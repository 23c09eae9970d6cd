"""A flat."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Literal

from solidgear.core import PositiveLength, SceneError
from solidgear.core.scene.parts import Segment
from solidgear.cuts.features.cut import Frame, Long


class Flat(Long):
    """A flat cut across a cylinder, with place, length and angle as of :class:`Keyway`."""

    kind: Literal["flat"] = "flat"
    #: depth below the crown of the cylinder, m
    depth: PositiveLength

    def _sized(self, segment: Segment) -> Iterator[SceneError]:
        yield from self._deep(segment)

    def half_width(self, radius: float) -> float:
        return math.sqrt(radius**2 - self.floor(radius) ** 2)

    def tool(self, occ: Any, radius: float, top: float) -> int:
        (lo, hi), wide, floor = self.reach(radius), 2 * (radius + top), self.floor(radius)
        return occ.addBox(-wide / 2, lo, floor, wide, hi - lo, radius + top - floor)

    def edges(self, radius: float) -> tuple[float, float]:
        return self.half_width(radius) / 2, math.inf

    def beside_edges(self, radius: float, frame: Frame) -> str:
        (lo, hi), half = self.reach(radius), frame.num(self.half_width(radius))
        ends = f"Min(Sqrt((y-{frame.num(lo)})^2),Sqrt((y-{frame.num(hi)})^2))"
        return f"Sqrt({ends}^2+Max(0,{frame.across}-{half})^2)"
