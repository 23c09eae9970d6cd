r"""What two flanks give way by between their surface and the depth at which finite elements are read.

A line load q on both flanks, of relative radius R, presses over the half-width a (Hertz),

    a^2 = 4 q R / (pi E*),      1 / E* = sum (1 - nu^2) / E,

and the surface of each side approaches its point at the depth h by

    d = 2 q (1 - nu^2) / (pi E) G(h / a),
    G(t) = asinh t - nu / (1 - nu) t / (sqrt(1 + t^2) + t),

on the axis of the pressure: the strain there (Johnson, Contact Mechanics, 1985, 4.44 to 4.49) along
depth, integrated.  For a deep point it is ``ln(2 h / a) - nu / (2 (1 - nu))``, the usual form, which
falls below zero where a comes near h; this one does not, so that slivers of contact lines do no harm.
The tangent follows from ``d (q G) / dq = G - t G' d ln a / d ln q``, where a goes as ``q^1/2``.

**At the corner of a tip** flanks touch on one side only, over a width b, and lean against each other by
an angle beta.  Both as half-planes that part by ``beta x + x^2 / (2 R)`` from the corner on have the
pressure ``E* / 2 (beta + (x + b / 2) / R) sqrt((b - x) / x)``, that of a punch at its edge (Johnson, 2.8;
zero at b), so that

    q / E* = pi beta b / 4 + 3 pi b^2 / (16 R).

With the share w of the second term, the logarithmic mean of the distances from the corner is that of a
Hertz pressure from its middle if ``a = b / 2 exp((w - 1) / 2)``.  So much narrower a contact gives way
more.  That the tip's corner is less than a half-plane is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from solidgear.core.gears.norm import STEEL

#: least line load of a cell, N/m: the Hertz law has no slope at zero
LEAST_LOAD = 1e-3


@dataclass(frozen=True)
class Elasticity:
    """Elastic constants of the teeth of one wheel."""

    youngs: float = STEEL  #: N/m^2
    poisson: float = 0.3

    @property
    def plane(self) -> float:
        """Modulus in plane strain, ``E / (1 - nu^2)``, N/m^2."""
        return self.youngs / (1 - self.poisson**2)


@dataclass(frozen=True)
class LineContact:
    """Approach of two flanks under a line load, each from its surface to its depth.

    Examples
    --------
    Steel flanks of a relative radius of 10 mm under 300 N/mm touch over twice 0.184 mm.

    >>> law = LineContact((Elasticity(), Elasticity()), (1e-3, 1e-3))
    >>> round(1e6 * float(law.half_width(3e5, 10e-3)))
    184
    """

    materials: tuple[Elasticity, Elasticity]  #: of both wheels
    depths: tuple[float, float]  #: below both flanks, m

    def half_width(self, load, radius):
        """Return half the width of contact, m, under line loads, N/m, with relative radii, m."""
        softness = sum(1 / material.plane for material in self.materials)
        return np.sqrt(4 * np.asarray(load) * radius * softness / pi)

    def pressure(self, load, radius):
        """Return the largest Hertz pressure, N/m^2, under line loads, N/m, with relative radii, m."""
        load = np.maximum(load, 0.0)
        width = np.maximum(self.half_width(load, radius), np.finfo(float).tiny)
        return 2 * load / (pi * width)

    def _widths(self, load, radius, lean) -> tuple[np.ndarray, np.ndarray]:
        """Return half the width of a contact and its growth ``d ln a / d ln q``, at corners that of a
        Hertz pressure that gives way alike.
        """
        width = self.half_width(load, radius)
        growth = np.full_like(width, 0.5)
        if lean is None:
            return width, growth
        pressed = load * sum(1 / material.plane for material in self.materials)
        straight, rounded = pi / 4 * lean, 3 * pi / (16 * radius)
        wide = 2 * pressed / (straight + np.sqrt(straight**2 + 4 * rounded * pressed))
        share = rounded * wide**2 / pressed
        corner = wide / 2 * np.exp((share - 1) / 2)
        faster = (1 + share * (1 - share) / 2) / (1 + share)
        at_corner = np.isfinite(lean)
        return np.where(at_corner, corner, width), np.where(at_corner, faster, growth)

    def compliances(self, load, radius, lean=None) -> tuple[np.ndarray, np.ndarray]:
        """Return secant and tangent approach per line load, m per N/m.

        Parameters
        ----------
        load : (n,) array_like
            Line loads, N/m.
        radius : (n,) array_like
            Relative radii, m.
        lean : (n,) ndarray, optional
            Angles at which flanks lean against each other at corners of tips, rad; no number where
            there is none.
        """
        load = np.maximum(load, LEAST_LOAD)
        width, growth = self._widths(load, radius, lean)
        secant, tangent = np.zeros_like(width), np.zeros_like(width)
        for material, depth in zip(self.materials, self.depths):
            scale = 2 / (pi * material.plane)
            side = material.poisson / (1 - material.poisson)
            t = depth / width
            root = np.sqrt(1 + t * t)
            approach = np.arcsinh(t) - side * t / (root + t)
            slope = 1 / root - side / (root * (root + t) ** 2)
            secant += scale * approach
            tangent += scale * (approach - t * slope * growth)
        return secant, tangent
