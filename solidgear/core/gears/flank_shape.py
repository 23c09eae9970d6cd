r"""What is missing of an involute flank by intent or by error: relief, crowning, slope, a measured grid.

Amounts are those of drawings and of measuring machines: lengths in the transverse plane along the
tangent to the base circle (ISO 1328-1, profile and helix deviations), so that a gap normal to the flank
is ``cos beta_b`` times as wide.  Places are the roll length s, from where that tangent touches the
wheel's base circle, and the face place z.  With the face from ``zm - b/2`` to ``zm + b/2`` (tip and root
relief, crowning and helix slope of ISO 21771:2007):

    relief      C (s - s0) / (s1 - s0), from where it begins to the tip or the root, no less than 0
    crowning    C (2 (z - zm) / b)^2, missing at both ends
    slope       f (z - zm) / b, half of f missing at one end and half too much at the other
    grid        linear between measured places, constant beyond them

and all that is missing adds up.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import cos

import numpy as np

from solidgear.core.gears.wheel_pair import WheelPair


@dataclass(frozen=True)
class Relief:
    """Material missing along one end of a profile, growing evenly.

    Attributes
    ----------
    amount : float
        At the end, m.
    start, end : float
        Roll lengths at which it begins and at which it reaches its amount, m; of a root the second
        is the shorter.
    """

    amount: float
    start: float
    end: float

    def missing(self, s):
        """Return what is missing at roll lengths, m."""
        return self.amount * np.clip((s - self.start) / (self.end - self.start), 0.0, 1.0)


@dataclass(frozen=True)
class FlankGrid:
    """Deviations of a measured flank.

    Attributes
    ----------
    z : tuple of float
        Face places, ascending, m.
    roll : tuple of float
        Roll lengths, ascending, m.
    missing : tuple of tuple of float
        By face place, then by roll length; positive where material is missing, m.
    """

    z: tuple[float, ...]
    roll: tuple[float, ...]
    missing: tuple[tuple[float, ...], ...]

    @cached_property
    def _table(self):
        from scipy.interpolate import RegularGridInterpolator  # slow to import, and seldom needed

        return RegularGridInterpolator((self.z, self.roll), np.array(self.missing))

    def interpolated(self, s, z):
        """Return what is missing at roll lengths and face places, m."""
        places = np.clip(z, self.z[0], self.z[-1]), np.clip(s, self.roll[0], self.roll[-1])
        return self._table(places)

    def reversed(self) -> FlankGrid:
        """Return the same grid seen from the other end of the face."""
        return FlankGrid(tuple(-z for z in self.z[::-1]), self.roll, self.missing[::-1])


@dataclass(frozen=True)
class FlankShape:
    """Modifications of the flanks of one wheel, all alike.

    Attributes
    ----------
    base_helix : float
        Helix angle at the base cylinder, rad.
    face_width : float
        m.
    middle : float
        Face place of the middle of the face, m.
    tip, root : Relief, optional
    crowning : float
        Missing at both ends of the face, m.
    slope : float
        Missing at the end of larger z more than at the other, m.
    grid : FlankGrid, optional
        Its face places count from the middle of the face.

    Examples
    --------
    >>> shape = FlankShape(face_width=20e-3, crowning=5e-6, tip=Relief(10e-6, 20e-3, 25e-3))
    >>> (1e6 * shape.deviation([18e-3, 25e-3], [10e-3, 0.0])).round(6).tolist()
    [5.0, 10.0]
    """

    base_helix: float = 0.0
    face_width: float = 0.0
    middle: float = 0.0
    tip: Relief | None = None
    root: Relief | None = None
    crowning: float = 0.0
    slope: float = 0.0
    grid: FlankGrid | None = None

    @property
    def is_involute(self) -> bool:
        """True where nothing is modified."""
        reliefs = any(relief and relief.amount for relief in (self.tip, self.root))
        return not (reliefs or self.crowning or self.slope or self.grid)

    def deviation(self, s, z) -> np.ndarray:
        """Return the gap that the flank leaves to its involute, normal to it, m.

        Parameters
        ----------
        s : (n,) array_like
            Roll lengths from the tangent point of the wheel's base circle, m.
        z : (n,) array_like
            Face places, m.

        Returns
        -------
        (n,) ndarray
            Below zero where there is more material than an involute has.
        """
        s, z = np.broadcast_arrays(np.asarray(s, float), np.asarray(z, float))
        from_middle = z - self.middle
        missing = np.zeros(s.shape)
        for relief in (self.tip, self.root):
            if relief is not None:
                missing += relief.missing(s)
        if self.crowning or self.slope:
            share = from_middle / self.face_width
            missing += self.crowning * (2 * share) ** 2 + self.slope * share
        if self.grid is not None:
            missing += self.grid.interpolated(s, from_middle)
        return missing * cos(self.base_helix)

    def reversed(self) -> FlankShape:
        """Return the same flank with face places counted the other way."""
        grid = None if self.grid is None else self.grid.reversed()
        return replace(self, middle=-self.middle, slope=-self.slope, grid=grid)


def shape_gap(
    wheels: WheelPair, shapes: tuple[FlankShape, FlankShape], place: np.ndarray, z: np.ndarray
) -> np.ndarray:
    """Return what the shapes of both flanks leave between them along the normal, (n,) m, at (n,) places
    of the path and of the face.
    """
    first, second = shapes
    return first.deviation(place, z) + second.deviation(wheels.second_length(place), z)


def shape_opening(wheels: WheelPair, shapes: tuple[FlankShape, FlankShape]) -> float:
    """Return how far the shapes of both flanks open over the shared face towards larger face places, at
    the pitch point in the transverse plane, m.
    """
    ends = np.array([-0.5, 0.5]) * wheels.face_width
    start, stop = shape_gap(wheels, shapes, np.full(2, wheels.pitch_point), ends)
    return float(stop - start) / cos(wheels.base_helix)
