"""A row of barrel-shaped rollers on a spherical outer raceway: a ring that tilts freely.

The normals of all contacts pass through the centre of the sphere, in the middle of the bearing: a
tilt of the ring presses no roller, and the rows of thx and thz of every stiffness are exactly zero.
With the radius ``R = Dpw / (2 cos a) + Dw / 2`` of the sphere, that of the rollers' contour
``r = R / (2 f_o)`` and that of the inner grooves ``2 f_i r``, a slice at x along a roller has

    P = x^2 / 2 (1/r - 1/R)     at the outer ring,      x^2 / 2 (1/r - 1/(2 f_i r))     at the inner,

less room than the middle, and presses by the law of slices of :mod:`solidgear.bearings.roller`.
Under light loads this is within 8 % of Hertz's ellipse of the same curvatures (approach; stiffness
within 10 %), and beyond a load at which that ellipse would reach the ends of the roller it becomes
the line contact that it then is.

The 22317 of Harris and Kotzalas (Essential Concepts, 5th ed., ch. 2: Dw 25, Dpw 135.077 mm, 12
degrees) has R = 81.585 and r = 79.959 mm: ``f = R / 2 r = 0.510``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.bearings.roller import RollerRow
from solidgear.bearings.row import felt


@dataclass(frozen=True, kw_only=True)
class SphericalRow(RollerRow):
    """One of the two rows of a spherical roller bearing."""

    #: inner, outer: groove radius over twice the radius of the rollers' contour; above 0.5
    inner: float = 0.51
    outer: float = 0.51

    @property
    def sphere(self) -> float:
        """Radius of the outer raceway, m."""
        return self.pitch / 2 / float(np.cos(self.angle)) + self.diameter / 2

    @property
    def contour(self) -> float:
        """Radius of the rollers' contour, m."""
        return self.sphere / (2 * self.outer)

    @cached_property
    def drop(self) -> np.ndarray:
        """(slices,) room at one ring, m: the mean of both."""
        rings = 2 - 1 / (2 * self.outer) - 1 / (2 * self.inner)
        return self.along**2 / 4 * rings / self.contour

    @cached_property
    def _normal(self) -> np.ndarray:
        """(count * slices, 5) motion along the contact normal: of all slices that of the middle."""
        radial, axial = felt(self.pitch / 2, 0.0, np.repeat(self.azimuth, self.slices))
        normal = np.cos(self.angle) * radial + self.side * np.sin(self.angle) * axial
        normal[:, 3:] = 0.0
        return normal
