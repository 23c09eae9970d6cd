"""A row of balls: Hertz point contact, contact angle by geometry at every ball.

The centres of curvature of both grooves are ``A = (f_i + f_o - 1) D`` apart when a ball just
touches both rings.  With s the vector between them in the plane of a ball, radial and axial,

    s = s0 + (radial, axial) motion of the inner groove's centre,     delta = |s| - A,

the ball presses along s with ``Q = c delta^(3/2)``.  This is Jones's and ISO/TS 16281's statics;
that of de Mul, Vree and Maas (1989) and of Lim and Singh (1990) is the same formula in other
symbols.  Of the tangent ``Q' n n' + (Q / |s|) (1 - n n')`` the second part is the turning of the
contact angle.

A groove with a contact angle has one shoulder: beyond the bottom it runs on as a cylinder, so that
a ball is then pressed radially, and nothing holds the shaft the other way.  A deep groove has both.

The load acts on the inner ring along the line through both centres, so that the moment has the
lever of the inner groove's centre.  ISO/TS 16281 takes half the pitch diameter in the moment
equation and the groove's centre in the kinematics: that stiffness is not symmetric, by
``(2 f_i - 1) D / D_pw``, 1 % of the tilt.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solidgear.bearings.hertz import POINT_POWER, Point, point_contact
from solidgear.bearings.row import FELT, Contacts, Elements, felt, products, six, symmetric


@dataclass(frozen=True, kw_only=True)
class BallRow(Elements):
    """One row of balls."""

    #: inner, outer: groove radius over ball diameter; above 0.5
    inner: float = 0.52
    outer: float = 0.53

    @property
    def free(self) -> float:
        """Distance of the centres of curvature when a ball just touches, m."""
        return (self.inner + self.outer - 1) * self.diameter

    @cached_property
    def start(self) -> np.ndarray:
        """(2,) vector from the outer to the inner centre of curvature at rest, radial and axial."""
        radial = self.free * np.cos(self.angle) - self.clearance / 2
        axial = self.side * (self.free * np.sin(self.angle) + self.preload)
        return np.array([radial, axial])

    @cached_property
    def rings(self) -> tuple[Point, Point]:
        """Contacts at the inner and the outer ring."""
        gamma = self.diameter * np.cos(self.angle) / self.pitch
        ball = 2 / self.diameter
        contacts = []
        for groove, ring in ((self.inner, gamma / (1 - gamma)), (self.outer, -gamma / (1 + gamma))):
            rolling = ball * (1 + ring)
            across = ball * (1 - 1 / (2 * groove))
            contacts.append(point_contact(rolling, across, self.E, self.nu))
        return contacts[0], contacts[1]

    @cached_property
    def constant(self) -> float:
        """Of both contacts in series, N/m^(3/2)."""
        power = -1 / POINT_POWER
        return sum(ring.constant**power for ring in self.rings) ** -POINT_POWER

    @cached_property
    def _felt(self) -> np.ndarray:
        centre_offset = (self.inner - 0.5) * self.diameter
        radius = self.pitch / 2 + centre_offset * np.cos(self.angle)
        height = self.height + self.side * centre_offset * np.sin(self.angle)
        return felt(radius, height, self.azimuth)

    @cached_property
    def _products(self) -> np.ndarray:
        radial, axial = self._felt
        mixed = products(radial, axial)
        return np.concatenate([products(radial, radial), 2 * mixed, products(axial, axial)])

    def centres(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the vectors (..., n) between the centres at every ball, radial and axial, m: zero
        along a way on which the groove has ended.
        """
        felt_motion = np.asarray(motion, float)[..., FELT]
        radial = np.maximum(self.start[0] + felt_motion @ self._felt[0].T, 0.0)
        axial = self.start[1] + felt_motion @ self._felt[1].T
        if self.angle:
            axial = self.side * np.maximum(self.side * axial, 0.0)
        return radial, axial

    def turns(self, radial: np.ndarray, axial: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return whether vectors between the centres (..., n) move radially, and along y."""
        return radial > 0, (self.side * axial > 0) if self.angle else np.ones_like(axial, bool)

    def _stretch(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return the unit vector and the distance between the centres, and the approach of every
        ball.
        """
        radial, axial = self.centres(motion)
        length = np.hypot(radial, axial)
        safe = np.where(length > 0, length, 1.0)
        return radial / safe, axial / safe, safe, np.maximum(length - self.free, 0.0)

    def load(self, motion: np.ndarray) -> np.ndarray:
        """Return the load that holds the inner ring at motions (..., 6), N and N m."""
        radial, axial, _, approach = self._stretch(motion)
        press = self.constant * approach**POINT_POWER
        return six((press * radial) @ self._felt[0] + (press * axial) @ self._felt[1])

    def tangent(self, motion: np.ndarray) -> np.ndarray:
        """Return the derivative of the load, (..., 6, 6), exact."""
        radial, axial, length, approach = self._stretch(motion)
        root = np.sqrt(approach)
        along = POINT_POWER * self.constant * root
        turning = self.constant * approach * root / length
        # where the groove has ended nothing turns
        outwards, along_y = self.turns(radial, axial)
        weights = np.concatenate(
            [
                along * radial**2 + turning * axial**2 * outwards,
                (along - turning) * radial * axial,
                along * axial**2 + turning * radial**2 * along_y,
            ],
            axis=-1,
        )
        return symmetric(weights @ self._products)

    def contacts(self, motion: np.ndarray) -> Contacts:
        """Return loads, angles and pressures of the balls at motions (..., 6)."""
        radial, axial, _, approach = self._stretch(motion)
        load = self.constant * approach**POINT_POWER
        angle = np.where(load > 0, np.arctan2(axial, radial), np.nan)
        inner, outer = (ring.pressure(load) for ring in self.rings)
        slices = load[..., None]
        return Contacts(self.azimuth, load, angle, inner, outer, slices, slices)


@dataclass(frozen=True)
class ThrustBallRow(BallRow):
    """Balls between two washers, at a contact angle of 90 degrees.

    The washers are free across the shaft: a motion there presses no ball, and moves no angle.
    """

    def _stretch(self, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return the same as for any row, without motions across the shaft."""
        felt_motion = np.asarray(motion, float)[..., FELT]
        axial = self.side * np.maximum(
            self.side * (self.start[1] + felt_motion @ self._felt[1].T), 0.0
        )
        length = np.abs(axial)
        safe = np.where(length > 0, length, 1.0)
        return np.zeros_like(axial), axial / safe, safe, np.maximum(length - self.free, 0.0)


@dataclass(frozen=True)
class AligningBallRow(BallRow):
    """One of two rows of balls on a spherical outer raceway: a ring that tilts freely.

    The sphere is a groove whose centre of curvature is the middle of the bearing; ``outer`` is its
    radius over the ball diameter, ``(1 / g + 1) / 2``.  All normals pass through the middle, so that
    a tilt presses no ball.
    """

    @cached_property
    def _felt(self) -> np.ndarray:
        radial, axial = felt(self.pitch / 2, 0.0, self.azimuth)
        both = np.stack([radial, axial])
        both[..., 3:] = 0.0
        return both
