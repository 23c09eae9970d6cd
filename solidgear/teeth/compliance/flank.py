"""What the teeth of a wheel give way by, seen from its flanks.

A concentrated force on a surface moves the point below it without bound as a mesh is refined.  So what
finite elements give is read at a depth h below the flank, along the normal there, and what gives way
between the flank and the depth is added in closed form (:mod:`solidgear.teeth.contact.local`): the sum
does not depend on h (Vijayakar, International Journal for Numerical Methods in Engineering 31, 1991,
p. 525-545).
"""

from __future__ import annotations

from typing import Protocol

import numpy as np


class FlankCompliance(Protocol):
    """Compliance between places on the flanks of one wheel, in the frame of
    :mod:`solidgear.core.gears.wheel`, without the motion of its body.
    """

    @property
    def depth(self) -> float:
        """Depth below the flank at which the motion is read, m."""
        ...

    def matrix(self, tooth: np.ndarray, r: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the (n, n) normal motion at the depth below each place per normal force on each, m/N.

        Parameters
        ----------
        tooth : (n,) ndarray of int
            Teeth, numbered clockwise.
        r : (n,) ndarray
            Radii on the right flank, m.
        z : (n,) ndarray
            Places along the face from its middle, m.
        """
        ...
