r"""Laws of force on a link: teeth with backlash, Hertzian contact, impacts, bearings with
clearance.

A law gives the force of a link over the stretch s and the rate. The linear stiffness of the link is
the tangent of the law at the operating point, so that motions that stay on one piece of a law are
those of the linear system.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.system.matrices import not_negative, positive

#: Pa; reduced modulus of steel on steel, 206 GPa and 0.3
STEEL = 206e9 / (2 * (1 - 0.3**2))
#: N s/m of damping in 1 N s/mm, over N/m^1.5 of stiffness in 1 N/mm^1.5
MM_DAMPER = 1e3 / 1e3**1.5


class Force(NamedTuple):
    """Force of r rows at T instants, with both tangents."""

    value: np.ndarray  #: (T, r)
    by_stretch: np.ndarray  #: (T, r, r)
    by_rate: np.ndarray  #: (T, r, r)


class Law(Protocol):
    """Interface of a law on the r rows of a link."""

    @property
    def pieces(self) -> bool:
        """Return whether the law has straight pieces alone, each with a tangent, which meet at
        ``edges``.
        """

    @property
    def edges(self) -> tuple[float, ...]:
        """Stretches at which pieces meet, ascending; empty for a law without pieces."""

    @property
    def drags(self) -> bool:
        """Return whether the force depends on the rate."""

    @property
    def kinks(self) -> tuple[tuple[float, float], ...]:
        """Stretches at which the slope jumps, for each row, and the jumps, N/m."""

    def force(self, stretch: np.ndarray, rate: np.ndarray) -> Force:
        """Return the force at T instants, from stretches and rates (T, r)."""

    def stiffness(self, force: float) -> float:
        """Return the tangent where the law carries a force, N/m."""

    def damping(self, force: float) -> float:
        """Return the tangent over the rate where the law carries a force, N s/m."""


@dataclass(frozen=True)
class Gap:
    r"""Contact on both sides of a gap: backlash of teeth, a stop, a seat with play.

    With the depth ``d = |s| - half_gap`` of the side that touches,

        k d^exponent + c(d) ds/dt        d > 0, else none,

    and c(d) grows from zero to `damper` over the depth `ramp` as ``3 u^2 - 2 u^3``, so that an
    impact begins without a jump; :meth:`impact` is the law of multi-body programs. A negative
    stiffness or gap, and an exponent below 1, are refused.

    Examples
    --------
    >>> teeth = Gap(2.5e8, 50e-6)
    >>> teeth.force(np.array([[70e-6], [0.0], [-60e-6]]), np.zeros((3, 1))).value[:, 0].round(6)
    array([ 5000.,     0., -2500.])
    >>> teeth.stiffness(5000.0)
    250000000.0
    """

    drive: float  #: stiffness k of the side of positive stretch, N/m^exponent
    half_gap: float  #: b, m: the gap is 2 b wide, around the stretch zero
    #: stiffness of the other side; that of the first without it, 0 for none
    coast: float | None = None
    exponent: float = 1.0  #: 1 for straight pieces, 1.5 for Hertz
    damper: float = 0.0  #: N s/m, in contact alone
    ramp: float = 0.0  #: depth of full damping, m
    #: width over which the edge is rounded, m; the force is then off by ``rounding / 2`` times its
    #: slope at most, at the edge itself
    rounding: float = 0.0
    #: whether the damper may hold back parting sides; without it sides that touch only ever press
    pulls: bool = True

    @classmethod
    def impact(
        cls,
        radius: float,
        mate_radius: float,
        half_gap: float = 0.0,
        *,
        internal: bool = False,
        share: float = 0.01,
        ramp: float = 1e-4,
        reduced_modulus: float = STEEL,
    ) -> Gap:
        """Return teeth in contact as the impact function of a multi-body program has them.

        ``K d^1.5 + c(d) d'``, never below zero, with ``K = 4/3 E* sqrt(R)`` and ``1 / R`` the sum
        of both curvatures, of an internal mesh their difference. Radii of curvature of both flanks
        are in m; `share` is the largest damping over K, as numbers in N, mm and s: it is no ratio,
        and the same number in N, m and s would be 32 times the damping. `ramp` is the depth of full
        damping, m, `reduced_modulus` is E*, Pa, by default of steel on steel.

        Examples
        --------
        >>> teeth = Gap.impact(6e-3, 12e-3)
        >>> f"{teeth.drive:.3g} N/m^1.5, {teeth.damper:.3g} N s/m"
        '9.54e+09 N/m^1.5, 3.02e+06 N s/m'
        """
        positive("the radius of a flank", radius)
        positive("the radius of a flank", mate_radius)
        curved = 1 / radius + (-1 if internal else 1) / mate_radius
        if not curved > 0:
            raise SolidgearError(
                f"a flank of {radius} m does not fit into one of {mate_radius} m; "
                "the first is that of the smaller gear"
            )
        drive = 4 / 3 * reduced_modulus * curved**-0.5
        damper = share * drive * MM_DAMPER
        return cls(drive, half_gap, exponent=1.5, damper=damper, ramp=ramp, pulls=False)

    def __post_init__(self):
        positive("the stiffness of the driving side", self.drive)
        for name in ("half_gap", "damper", "ramp", "rounding"):
            not_negative(f"{name.replace('_', ' ')} of a contact", getattr(self, name))
        if self.coast is not None:
            not_negative("the stiffness of the coast side", self.coast)
        if not 1 <= self.exponent <= 5:
            raise SolidgearError(
                f"the exponent of a contact is {self.exponent:g}; 1 is linear, 1.5 is Hertz"
            )

    @property
    def pieces(self) -> bool:
        """Return whether the law is linear on either side."""
        plain = self.damper == 0 or (self.ramp == 0 and self.pulls)
        return self.exponent == 1 and self.rounding == 0 and plain

    @property
    def drags(self) -> bool:
        """Return whether the law has a damper."""
        return self.damper > 0

    @property
    def kinks(self) -> tuple[tuple[float, float], ...]:
        """Both ends of the gap of straight sides; a curved one sets in without a jump."""
        if self.exponent > 1 or self.rounding:
            return ()
        coast = self.drive if self.coast is None else self.coast
        return (-self.half_gap, -coast), (self.half_gap, self.drive)

    @property
    def edges(self) -> tuple[float, ...]:
        """Both ends of the gap; one if it has no width."""
        if not self.pieces:
            return ()
        return (-self.half_gap, self.half_gap) if self.half_gap else (0.0,)

    def force(self, stretch: np.ndarray, rate: np.ndarray) -> Force:
        """Return the force and tangents; rows are independent of each other."""
        drive, coast = self.drive, self.drive if self.coast is None else self.coast
        side = np.where(stretch >= 0, 1.0, -1.0)
        stiffness = np.where(stretch >= 0, drive, coast)
        depth = side * stretch - self.half_gap
        if self.rounding:
            root = np.hypot(depth, self.rounding)
            slope = (1 + depth / root) / 2
            depth = (depth + root) / 2
        else:
            slope = (depth > 0).astype(float)
            depth = np.maximum(depth, 0.0)
        if self.exponent == 1:
            value, tangent = stiffness * depth, stiffness * slope
        else:
            power = stiffness * depth ** (self.exponent - 1)
            value, tangent = power * depth, self.exponent * power * slope
        value = side * value
        lost = np.zeros_like(value)
        if self.damper:
            part = np.minimum(depth / self.ramp, 1.0) if self.ramp else 1.0 * (depth > 0)
            active = (slope > 0) & (stiffness > 0)
            lost = self.damper * part * part * (3 - 2 * part) * active
            value = value + lost * rate
            if self.ramp:
                tangent = tangent + side * slope * active * rate * (
                    6 * self.damper * part * (1 - part) / self.ramp
                )
            if not self.pulls:
                presses = side * value > 0
                value, tangent, lost = (presses * part for part in (value, tangent, lost))
        eye = np.eye(stretch.shape[-1])
        return Force(value, tangent[..., None] * eye, lost[..., None] * eye)

    def depth(self, force: float) -> float:
        """Return the stretch at which it carries a force, m."""
        side = 1.0 if force >= 0 else -1.0
        stiffness = self.drive if force >= 0 or self.coast is None else self.coast
        return side * (self.half_gap + (abs(force) / stiffness) ** (1 / self.exponent))

    def _force_at(self, force: float) -> Force:
        if force < 0 and self.coast == 0:
            raise SolidgearError("a contact on one side only carries no force back")
        inside = self.depth(force) * (1 + 1e-12) if self.pieces else self.depth(force)
        return self.force(np.array([[inside]]), np.zeros((1, 1)))

    def stiffness(self, force: float) -> float:
        """Return the tangent where it carries a force; of straight pieces that of the side."""
        if self.pieces:
            return self.drive if force >= 0 or self.coast is None else self.coast
        return float(self._force_at(force).by_stretch[0, 0, 0])

    def damping(self, force: float) -> float:
        """Return the damper where it carries a force."""
        return self.damper if self.pieces else float(self._force_at(force).by_rate[0, 0, 0])


@dataclass(frozen=True)
class RadialGap:
    """Clearance all around, of a bearing or a seal that rubs, on two rows across each other.

    Examples
    --------
    >>> seat = RadialGap(1e7, 20e-6)
    >>> seat.force(np.array([[18e-6, 24e-6]]), np.zeros((1, 2))).value.round(9)
    array([[60., 80.]])
    """

    radial: float  #: stiffness of the contact, N/m
    clearance: float  #: m, from the middle to contact

    def __post_init__(self):
        positive("the stiffness of a seat with clearance", self.radial)
        not_negative("a radial clearance", self.clearance)

    @property
    def pieces(self) -> bool:
        """Return False: it has no straight pieces."""
        return False

    @property
    def drags(self) -> bool:
        """Return False: it has no damper."""
        return False

    @property
    def kinks(self) -> tuple[tuple[float, float], ...]:
        """Empty: no single row has a kink."""
        return ()

    @property
    def edges(self) -> tuple[float, ...]:
        """Empty: it has no pieces."""
        return ()

    def force(self, stretch: np.ndarray, rate: np.ndarray) -> Force:
        """Return the force along the motion from the middle."""
        distance = np.linalg.norm(stretch, axis=-1)
        touching = distance > self.clearance
        safe = np.where(touching, distance, 1.0)
        share = np.where(touching, 1 - self.clearance / safe, 0.0)
        outer = stretch[..., :, None] * stretch[..., None, :]
        bend = np.where(touching, self.clearance / safe**3, 0.0)[..., None, None] * outer
        tangent = self.radial * (share[..., None, None] * np.eye(2) + bend)
        return Force(self.radial * share[..., None] * stretch, tangent, np.zeros_like(tangent))

    def stiffness(self, force: float) -> float:
        """Return the stiffness of the contact, at any force."""
        return self.radial

    def damping(self, force: float) -> float:
        """Return zero: there is no damper."""
        return 0.0
