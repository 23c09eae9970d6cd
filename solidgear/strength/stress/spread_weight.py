"""Weight of a shaft, spread along it as its mass is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.frames import shift
from solidgear.core.scene.closed_form import mass_between

if TYPE_CHECKING:
    from solidgear.core import Outline
    from solidgear.core.scene import Segment


@dataclass(frozen=True)
class SpreadWeight:
    """Weight of a shaft of revolution; material removed by features still counts."""

    outline: Outline[Segment]
    gravity: np.ndarray  #: (3,) m/s^2

    @property
    def joints(self) -> list[float]:
        """Places where one segment ends and the next begins, m."""
        return [segment.y1 for segment in self.outline.segments[:-1]]

    def between(self, lo: float, hi: float, about: float) -> np.ndarray:
        """Return the weight (6,) between two places about a third on the axis, m; N and N m."""
        mass, first = mass_between(self.outline, lo, hi)
        force, moment = np.zeros(6), np.zeros(6)
        force[:3], moment[:3] = mass * self.gravity, first * self.gravity
        # a force at y is one at zero with the moment of its first moment: linear in both
        arm = shift([0.0, 1.0, 0.0]).T - np.eye(6)
        return force + arm @ (moment - about * force)
