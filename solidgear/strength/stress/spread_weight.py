"""Weight of a shaft, spread along it as its mass is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.frames import shift
from solidgear.core.scene.closed_form import mass_between
from solidgear.core.scene.own_mass import Beside, beside

if TYPE_CHECKING:
    from solidgear.core import Outline, Scene
    from solidgear.core.scene import Segment


@dataclass(frozen=True)
class SpreadWeight:
    """Weight of a shaft: that of its body of revolution, and of what it has beside that or lacks of
    it.
    """

    outline: Outline[Segment]
    gravity: np.ndarray  #: (3,) m/s^2
    beside: tuple[Beside, ...] = ()

    @classmethod
    def of(cls, scene: Scene, gravity: np.ndarray) -> SpreadWeight:
        """Return the weight of the shaft of a scene."""
        return cls(scene.outline, gravity, beside(scene))

    @property
    def joints(self) -> list[float]:
        """Places where one segment ends and the next begins, and ends of what is beside, m."""
        joints = [segment.y1 for segment in self.outline.segments[:-1]]
        return sorted([*joints, *(end for part in self.beside for end in (part.lo, part.hi))])

    def between(self, lo: float, hi: float, about: float) -> np.ndarray:
        """Return the weight (6,) between two places about a third on the axis, m; N and N m."""
        parts = [part.between(lo, hi) for part in self.beside]
        mass, first = np.sum([mass_between(self.outline, lo, hi), *parts], axis=0)
        force, moment = np.zeros(6), np.zeros(6)
        force[:3], moment[:3] = mass * self.gravity, first * self.gravity
        # a force at y is one at zero with the moment of its first moment: linear in both
        arm = shift([0.0, 1.0, 0.0]).T - np.eye(6)
        return force + arm @ (moment - about * force)
