"""Inner geometry of a row of rolling elements."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Inside:
    """Inner geometry of a row, m and rad."""

    elements: int
    #: diameter, length, pitch: `length` is 0 for balls
    diameter: float
    length: float
    pitch: float
    angle: float
    conformity: tuple[float, float]

    @property
    def thrust(self) -> bool:
        """Return whether the elements run on washers, at 90 degrees."""
        return self.angle > math.radians(89)

    @property
    def sphere(self) -> bool:
        """Whether balls run on a sphere about the middle of the bearing, wider than any groove."""
        return not self.length and self.conformity[1] > 1

    @property
    def gamma(self) -> float:
        """``Dw cos(a) / Dpw``."""
        return self.diameter * math.cos(self.angle) / self.pitch
