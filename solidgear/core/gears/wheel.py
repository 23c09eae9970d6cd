r"""Teeth of a cylindrical wheel in its transverse plane, exactly as a rack cuts them (ISO 21771:2007).

With the normal module m, ``z`` teeth, the helix angle beta and the pressure angle alpha of the rack,

    tan alpha_t = tan alpha / cos beta,  r = m z / (2 cos beta),  rb = r cos alpha_t,

a tooth at the radius rho is as thick as the angle 2 psi,

    psi = (pi m / (2 cos beta) + 2 x m tan alpha_t) / (2 r) + inv alpha_t - inv acos(rb / rho),

inv being tan minus angle: the profile shift x counts in *normal* modules.  Its fillet is what the
rounded corner of the rack leaves: while the wheel rolls by phi, the centre c of the corner moves along
the rack's line, and the corner touches the fillet where its normal passes through the pitch point, so
that the point is ``c + rho m c / |c|``, turned back by phi (Litvin and Fuentes, Gear Geometry and
Applied Theory, 2004, 5.4), and ``c - rho m c / |c|`` where a large shift lifts c beyond that line.
The corner is a circle in the transverse plane; of helical teeth it is an ellipse, which no
stiffness has been seen to feel.

A ring counts its teeth below zero.  Its teeth are the spaces of a wheel, their tips lie inside.  No
rack cuts a ring: its fillet is a circle that touches flank and root.

The frame of a wheel: tooth 0 on +y, x to the right, teeth numbered clockwise; the right flanks carry.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import atan, atan2, cos, hypot, pi, radians, sin, sqrt, tan

import numpy as np

#: points from which the length along a fillet is found
ALONG = 400
#: least radius of a fillet, modules: a corner cut by a sharp tool
SHARP = 0.02
#: modules of undercut that rounding makes
CUT = 1e-9


def involute(angle):
    """Return the involute function of an angle, tan minus angle, rad."""
    return np.tan(angle) - angle


def angle_of_involute(value: float, most: float) -> float:
    """Return the angle of an involute function, rad, from one above it down: the function is convex,
    so that Newton's steps never go too far.

    Examples
    --------
    >>> round(angle_of_involute(float(involute(0.35)), 1.2), 12)
    0.35
    """
    angle = most
    while (following := angle - (involute(angle) - value) / tan(angle) ** 2) < angle:
        angle = following
    return float(angle)


@dataclass(frozen=True)
class Rack:
    """The basic rack normal to the teeth, by default that of ISO 53, profile A.

    Attributes
    ----------
    pressure_angle : float
        rad.
    addendum, dedendum, root_radius : float
        In normal modules.

    Examples
    --------
    >>> stub = Rack(addendum=0.8)
    >>> round(1e3 * Wheel(23, 4e-3, rack=stub).tip, 3)
    49.2
    """

    pressure_angle: float = radians(20)
    addendum: float = 1.0
    dedendum: float = 1.25
    root_radius: float = 0.38


@dataclass(frozen=True)
class Wheel:
    """Teeth of one wheel, external or a ring.

    Attributes
    ----------
    teeth : int
        Below zero for a ring.
    module : float
        Normal, m.
    helix_angle : float
        At the reference cylinder, not below zero, rad.
    shift : float
        Profile shift in normal modules; of a ring positive towards its axis.
    rack : Rack
    tip_radius : float, optional
        m; by default an addendum beyond the shifted reference cylinder.
    face_width : float
        m.

    Examples
    --------
    >>> wheel = Wheel(23, 4e-3)
    >>> round(1e3 * wheel.tip, 3), round(1e3 * wheel.root, 3), wheel.is_undercut
    (50.0, 41.0, False)
    """

    teeth: int
    module: float
    helix_angle: float = 0.0
    shift: float = 0.0
    rack: Rack = Rack()
    tip_radius: float | None = None
    face_width: float = 0.0

    @property
    def count(self) -> int:
        """Number of teeth, of a ring as well."""
        return abs(self.teeth)

    @property
    def sign(self) -> int:
        """1, and -1 for a ring."""
        return 1 if self.teeth > 0 else -1

    @property
    def transverse_module(self) -> float:
        """Module in the transverse plane, m."""
        return self.module / cos(self.helix_angle)

    @property
    def transverse_angle(self) -> float:
        """Transverse pressure angle at the reference cylinder, rad."""
        return atan(tan(self.rack.pressure_angle) / cos(self.helix_angle))

    @property
    def radius(self) -> float:
        """Radius of the reference cylinder, m."""
        return self.transverse_module * self.count / 2

    @property
    def base(self) -> float:
        """Radius of the base cylinder, m."""
        return self.radius * cos(self.transverse_angle)

    @property
    def base_helix(self) -> float:
        """Helix angle at the base cylinder, rad."""
        return atan(tan(self.helix_angle) * cos(self.transverse_angle))

    @property
    def base_pitch(self) -> float:
        """Transverse pitch on the base cylinder, m."""
        return 2 * pi * self.base / self.count

    @property
    def pitch_angle(self) -> float:
        """Angle from tooth to tooth, rad."""
        return 2 * pi / self.count

    @property
    def tip(self) -> float:
        """Radius of the tips, of a ring the inner one, m."""
        if self.tip_radius is not None:
            return self.tip_radius
        return self.radius + self.sign * self.module * (self.rack.addendum + self.shift)

    @property
    def root(self) -> float:
        """Radius of the roots, of a ring the outer one, m."""
        return self.radius - self.sign * self.module * (self.rack.dedendum - self.shift)

    @property
    def thickness(self) -> float:
        """Transverse thickness of a tooth at the reference cylinder, m."""
        shifted = 2 * self.shift * self.module * tan(self.transverse_angle)
        return pi * self.transverse_module / 2 + shifted

    def half_angle(self, r):
        """Return half the angle of a tooth at radii r, m, between its flanks, rad."""
        turned = involute(self.transverse_angle) - involute(
            np.arccos(np.minimum(self.base / np.asarray(r, float), 1.0))
        )
        return self.thickness / (2 * self.radius) + self.sign * turned

    def flank_points(self, r) -> tuple[np.ndarray, np.ndarray]:
        """Return the (n, 2) points of tooth 0's right flank at radii r, (n,) m, and the (n, 2) unit
        normals into the tooth, which touch the base circle.
        """
        r = np.asarray(r, float)
        half = self.half_angle(r)
        lean = half - self.sign * np.arccos(np.minimum(self.base / r, 1.0))
        points = r[:, None] * np.column_stack([np.sin(half), np.cos(half)])
        return points, np.column_stack([-np.cos(lean), np.sin(lean)])

    @property
    def _corner(self) -> tuple[float, float]:
        """Centre of the rack's corner before rolling: beside the middle of the space and below the
        rolling line, m.
        """
        angle, m, rack = self.transverse_angle, self.module, self.rack
        aside = (
            pi * self.transverse_module / 4
            - rack.dedendum * m * tan(angle)
            - rack.root_radius * m * (1 - sin(angle)) / cos(angle)
        )
        return aside, (rack.dedendum - rack.root_radius - self.shift) * m

    @property
    def is_undercut(self) -> bool:
        """True where the rack cuts away flank near the root."""
        return self.missing_shift > CUT

    @cached_property
    def form(self) -> float:
        """Radius at which the flank ends and the fillet begins, m."""
        if self.teeth < 0:
            rho, _, along = self._ring_corner
            return hypot(self.base, along + rho)
        x, y = self._trochoid(np.array([self._last_roll]))[0]
        return max(hypot(x, y), self.base)

    @cached_property
    def _last_roll(self) -> float:
        """Roll at which the fillet meets the flank, rad."""
        aside, below = self._corner
        tangent = (below / tan(self.transverse_angle) - aside) / self.radius
        if not self.is_undercut:
            return tangent

        def beyond(roll: float) -> float:
            x, y = self._trochoid(np.array([roll]))[0]
            return atan2(x, y) - float(self.half_angle(hypot(x, y)))

        from scipy.optimize import brentq  # slow to import, and seldom needed

        # an undercut fillet crosses the flank before the rack's straight side would touch it
        rolls = np.linspace(-aside / self.radius, tangent, ALONG)
        points = self._trochoid(rolls)
        radii = np.hypot(points[:, 0], points[:, 1])
        outside = radii > self.base
        gaps = np.arctan2(points[:, 0], points[:, 1]) - self.half_angle(radii)
        crossed = np.flatnonzero(outside[:-1] & outside[1:] & (gaps[:-1] * gaps[1:] <= 0))
        if crossed.size == 0:
            return tangent
        first = int(crossed[0])
        return float(brentq(beyond, rolls[first], rolls[first + 1], xtol=1e-14))

    def _trochoid(self, roll: np.ndarray) -> np.ndarray:
        """Return the (n, 2) points of tooth 0's right fillet at the (n,) angles of rolling, rad."""
        aside, below = self._corner
        centre = np.column_stack([aside + self.radius * roll, np.full_like(roll, -below)])
        away = np.copysign(1.0, below) * centre / np.hypot(centre[:, 0], centre[:, 1])[:, None]
        x, y = (centre + self.rack.root_radius * self.module * away).T
        y = y + self.radius
        r = np.hypot(x, y)
        # the space stands on +y while it is cut, and half a pitch aside in the wheel's frame
        angle = pi / self.count - (np.arctan2(x, y) - roll)
        return np.column_stack([r * np.sin(angle), r * np.cos(angle)])

    @cached_property
    def _ring_corner(self) -> tuple[float, float, float]:
        """Radius of the fillet of a ring, the angle of its centre from the middle of the tooth, and
        the centre's length along the tangent of the base circle, m, rad, m.
        """
        from scipy.optimize import brentq  # slow to import, and seldom needed

        def angle_of(rho: float) -> float:
            # flanks at the distance rho are the same involutes, turned by rho / rb
            return float(self.half_angle(self.root - rho)) + rho / self.base

        rho, middle = self.rack.root_radius * self.module, pi / self.count
        if angle_of(rho) > middle:  # the space is too narrow: one circle rounds all of it
            least = SHARP * self.module
            if angle_of(least) > middle:
                rho = least
            else:
                rho = float(brentq(lambda r: angle_of(r) - middle, least, rho))
        along = sqrt(max((self.root - rho) ** 2 - self.base**2, 0.0))
        return rho, angle_of(rho), along

    def fillet(self, count: int) -> np.ndarray:
        """Return (count, 2) points of tooth 0's right fillet from the root to the flank, equally far
        from each other along it, m.
        """
        if self.teeth < 0:
            return self._ring_fillet(count)
        first = -self._corner[0] / self.radius
        rolls = first + (self._last_roll - first) * np.linspace(0, 1, ALONG) ** 1.5
        points = self._trochoid(rolls)
        steps = np.hypot(*np.diff(points, axis=0).T)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        at = np.interp(np.linspace(0, along[-1], count), along, rolls)
        return self._trochoid(at)

    def _ring_fillet(self, count: int) -> np.ndarray:
        rho, angle, _ = self._ring_corner
        distance = self.root - rho
        centre = distance * np.array([sin(angle), cos(angle)])
        (end,), _ = self.flank_points(np.array([self.form]))
        start = atan2(centre[0], centre[1])
        stop = atan2(end[0] - centre[0], end[1] - centre[1])
        turns = np.linspace(start, stop, count)
        return centre + rho * np.column_stack([np.sin(turns), np.cos(turns)])

    def thinned(self, face_width: float) -> Wheel:
        """Return the same wheel with another face width, m."""
        return replace(self, face_width=face_width)

    @property
    def tip_thickness(self) -> float:
        """Transverse thickness of a tooth at its tip, m; below zero where it is pointed."""
        if self.tip <= self.base:
            return self.module
        return 2 * self.tip * float(self.half_angle(self.tip))

    @property
    def point(self) -> float:
        """Radius at which both flanks of a tooth that is pointed before its tip meet, m."""
        from scipy.optimize import brentq  # slow to import, and seldom needed

        return float(brentq(lambda r: float(self.half_angle(r)), *sorted((self.form, self.tip))))

    @property
    def missing_shift(self) -> float:
        """Profile shift that the wheel lacks to have no undercut; below zero without any.

        The rack's straight side ends ``rho m (1 - sin alpha_t)`` before its root, and must not pass
        the base circle's tangent point.
        """
        if self.teeth < 0:
            return -1.0
        rack, angle = self.rack, self.transverse_angle
        straight = rack.dedendum - rack.root_radius * (1 - sin(angle))
        return straight - self.shift - self.radius * sin(angle) ** 2 / self.module
