"""A row of rollers, cylindrical, tapered or needle: line contact in slices, with a profile.

ISO/TS 16281:2008, 5.3: a roller of effective length l is cut into n slices, and a slice at x along
the roller presses with ``q = (c / n) delta^(10/9)``, where

    delta = (motion of the inner ring along the contact normal, at x) - clearance - 2 P(x)

and P is the drop of the roller's profile.  Both contacts are one spring: a roller settles half way
between its rings.  The normal of a tapered roller stands at one angle, that of the catalogue; the
angle of a roller's own cone and the force of the rib are left out (the rib carries the sine of the
cone's angle, some 3 %, of the load).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from solidgear.bearings.hertz import LINE_POWER, line_constant, line_pressure
from solidgear.bearings.row import FELT, Contacts, Elements, felt, products, six, symmetric

Profile = Literal["logarithmic", "straight"]

#: of the motion of a ring: approaches below it are rounding, the equilibrium being known no better.
#: Their load is nothing, but stiffness goes with their ninth root: 1e-22 m would have 1 % of that of
#: 5 micrometres.
ROUNDING = 1e-12


@dataclass(frozen=True, kw_only=True)
class RollerRow(Elements):
    """One row of rollers."""

    length: float  #: effective length of a roller
    profile: Profile = "logarithmic"  #: that of ISO/TS 16281, 5.3.3, or none
    slices: int = 30  #: ISO/TS 16281 asks for 30 or more

    @cached_property
    def along(self) -> np.ndarray:
        """(slices,) middles of the slices along a roller, m."""
        return ((np.arange(self.slices) + 0.5) / self.slices - 0.5) * self.length

    @cached_property
    def drop(self) -> np.ndarray:
        """(slices,) profile, m: ISO/TS 16281:2008, equations (42) to (44)."""
        if self.profile == "straight":
            return np.zeros(self.slices)
        if self.angle:
            return -0.00045 * self.diameter * np.log1p(-((2 * self.along / self.length) ** 2))
        if self.length <= 2.5 * self.diameter:
            return -0.00035 * self.diameter * np.log1p(-((2 * self.along / self.length) ** 2))
        # long rollers are straight in the middle, and drop over 1.25 diameters at each end
        end = 2.5 * self.diameter
        from_end = np.maximum(2 * np.abs(self.along) - (self.length - end), 0.0)
        return -0.0005 * self.diameter * np.log1p(-((from_end / end) ** 2))

    @cached_property
    def constant(self) -> float:
        """Constant of a whole roller between both rings, N/m^(10/9)."""
        return line_constant(self.length, self.E, self.nu)

    @cached_property
    def _normal(self) -> np.ndarray:
        """(count * slices, 5) motion along the contact normal; slices vary fastest."""
        c, s = np.cos(self.angle), self.side * np.sin(self.angle)
        radius = self.pitch / 2 - self.along * s
        height = self.height + self.along * c
        azimuth = np.repeat(self.azimuth, self.slices)
        radial, axial = felt(np.tile(radius, self.count), np.tile(height, self.count), azimuth)
        return c * radial + s * axial

    @cached_property
    def _start(self) -> np.ndarray:
        gap = self.clearance / 2 * np.cos(self.angle) - self.preload * np.sin(self.angle)
        return np.tile(-gap - 2 * self.drop, self.count)

    @cached_property
    def _products(self) -> np.ndarray:
        return products(self._normal, self._normal)

    @cached_property
    def _reach(self) -> np.ndarray:
        """(5,) largest approach that a unit motion brings to any slice."""
        return np.abs(self._normal).max(axis=0)

    def _approach(self, motion: np.ndarray) -> np.ndarray:
        felt_motion = np.asarray(motion, float)[..., FELT]
        approach = self._start + felt_motion @ self._normal.T
        largest = np.abs(felt_motion) @ self._reach
        return np.where(
            approach > ROUNDING * (largest[..., None] + np.abs(self._start)), approach, 0.0
        )

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return the load that holds the inner ring at motions (..., 6), N and N m."""
        press = self.constant / self.slices * self._approach(motion) ** LINE_POWER
        return six(press @ self._normal)

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return the derivative of the load, (..., 6, 6), exact."""
        factor = self.constant / self.slices * LINE_POWER
        weights = factor * self._approach(motion) ** (LINE_POWER - 1)
        return symmetric(weights @ self._products)

    def contacts(self, motion: np.ndarray) -> Contacts:
        """Return loads, angles and pressures of the rollers at motions (..., 6)."""
        press = self.constant / self.slices * self._approach(motion) ** LINE_POWER
        press = press.reshape(*press.shape[:-1], self.count, self.slices)
        load = press.sum(axis=-1)
        gamma = self.diameter * np.cos(self.angle) / self.pitch
        most = press.max(axis=-1)
        inner, outer = (
            line_pressure(
                most, self.length / self.slices, 2 / self.diameter / (1 + ring), self.E, self.nu
            )
            for ring in (-gamma, gamma)
        )
        angle = np.where(load > 0, self.side * self.angle, np.nan)
        return Contacts(self.azimuth, load, angle, inner, outer, press, press)
