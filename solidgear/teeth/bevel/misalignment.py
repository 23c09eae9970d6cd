"""How a bevel pair is mounted beside where its flanks were cut to run: E, P, G and the shaft angle."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np


@dataclass(frozen=True)
class Misalignment:
    """Small motions of pinion and gear from where their flanks were cut to run.

    Attributes
    ----------
    offset : float
        E: of the pinion's axis along z, m.
    pinion_axial, gear_axial : float
        P and G: of each member along its axis, away from the apex, m.
    shaft_angle : float
        Excess of the angle between the axes, rad.
    """

    offset: float = 0.0
    pinion_axial: float = 0.0
    gear_axial: float = 0.0
    shaft_angle: float = 0.0

    def motion(self, shaft_angle: float) -> np.ndarray:
        """Return the (6,) motion of the pinion less that of the gear, at the apex in the pinion's frame,
        m, rad, of axes that were to cross at an angle, rad.

        Examples
        --------
        >>> motion = Misalignment(offset=1e-5, gear_axial=2e-5).motion(np.pi / 2)
        >>> [round(1e5 * float(value), 12) + 0.0 for value in motion]
        [2.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        """
        # the gear lies at -x and its axis leaves the apex towards there
        gear = self.gear_axial * np.array([-sin(shaft_angle), cos(shaft_angle), 0.0])
        moved = np.array([0.0, self.pinion_axial, self.offset]) - gear
        # away from the gear's axis: about -z, which takes y to +x
        return np.concatenate([moved, [0.0, 0.0, -self.shaft_angle]])
