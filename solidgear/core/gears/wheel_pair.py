r"""Two cylindrical wheels at their centre distance: the path of contact (ISO 21771:2007, 5.4 and 5.5).

Contact lies on the common tangent of both base circles.  A place s on it counts from where it touches
the base circle of the first wheel, so that the radii are ``r1 = hypot(rb1, s)`` and ``r2 =
hypot(rb2, s2)`` with ``s2 = L - s`` and ``L = a sin alpha_wt``; of a ring, whose base circle the line
touches beyond, ``s2 = L + s``.  Both flanks there are as round as circles of the radii s and s2, so
that the relative radius is ``s s2 / L``, across the lines of helical teeth ``s s2 / (L cos beta_b)``.
The path begins at A, where the tip of the second wheel comes in, and ends at E, at the tip of the
first; at the time ``phase``, in pitches, contact line k stands at

    s = sC + (phase + k) p_bt + z tan beta_b

at the face place z: a line that lies nearer to the first wheel's tip has the larger k, and belongs to
its tooth k and to the tooth -k of the second (each in its wheel's frame).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import acos, cos, pi, sin, sqrt, tan

import numpy as np

from solidgear.core.errors import SceneError
from solidgear.core.gears.wheel import Wheel, angle_of_involute, involute

#: transverse pressure angle that no pair of wheels exceeds, rad
STEEPEST = 0.4 * pi


@dataclass(frozen=True)
class WheelPair:
    """Two wheels that mesh; the second may be a ring.

    Attributes
    ----------
    first, second : Wheel
    centre_distance : float, optional
        m, above zero; by default that without backlash.
    offset : float
        Face place of the middle of the second face, from that of the first, m.

    Raises
    ------
    SceneError
        For profile shifts that no pressure angle has, and a centre distance within the base circles.

    Examples
    --------
    >>> pair = WheelPair(Wheel(23, 4e-3), Wheel(57, 4e-3))
    >>> round(1e3 * pair.distance, 6), round(pair.contact_ratio, 4)
    (160.0, 1.6841)
    """

    first: Wheel
    second: Wheel
    centre_distance: float | None = None
    offset: float = 0.0

    @cached_property
    def tight(self) -> float:
        """Centre distance without backlash, m."""
        first, second = self.first, self.second
        total = first.teeth + second.teeth
        shifts = first.shift + second.shift
        angle = first.transverse_angle
        wanted = involute(angle) + 2 * tan(first.rack.pressure_angle) * shifts / total
        if not 0 < wanted < involute(STEEPEST):
            raise SceneError(
                "leaves no pressure angle, with that of the other wheel",
                path=("pinion", "profile_shift"),
            )
        return self._base_sum / cos(angle_of_involute(wanted, STEEPEST))

    @property
    def _base_sum(self) -> float:
        """Centre distance at which the base circles leave no pressure angle, m."""
        return self.second.base + self.second.sign * self.first.base

    @cached_property
    def distance(self) -> float:
        """Centre distance, m."""
        distance = self.tight if self.centre_distance is None else self.centre_distance
        if distance <= self._base_sum:
            sums = "sum" if self.second.sign > 0 else "difference"
            raise SceneError(
                f"is below {1e3 * self._base_sum:.6g} mm, the {sums} of the base radii of these "
                f"gears, which have no backlash at {1e3 * self.tight:.6g} mm",
                path=("mesh", "centre_distance"),
            )
        return distance

    @property
    def working_angle(self) -> float:
        """Transverse pressure angle at the centre distance, rad."""
        return acos(self._base_sum / self.distance)

    @property
    def base_helix(self) -> float:
        """Helix angle on the base cylinders, rad."""
        return self.first.base_helix

    @property
    def pitch(self) -> float:
        """Transverse base pitch, m."""
        return self.first.base_pitch

    @property
    def face_width(self) -> float:
        """Face width that both wheels share, m; below zero where their faces lie apart."""
        first, second = self.first.face_width, self.second.face_width
        return min(first, second, (first + second) / 2 - abs(self.offset))

    @property
    def face_middles(self) -> tuple[float, float]:
        """Face places of the middles of both faces, from the middle of the face that they share, m."""
        first, second = self.first.face_width / 2, self.second.face_width / 2
        low = max(-first, self.offset - second)
        middle = (low + min(first, self.offset + second)) / 2
        return -middle, self.offset - middle

    @property
    def reach(self) -> float:
        """Length L between the points where the line of action touches both base circles, m."""
        return self.distance * sin(self.working_angle)

    @property
    def pitch_point(self) -> float:
        """Place of the pitch point on the path, m."""
        return self.first.base * tan(self.working_angle)

    def second_length(self, s):
        """Return the length s2 along the line of action from the second base circle, m."""
        return self.reach - self.second.sign * np.asarray(s, float)

    def first_radius(self, s):
        """Return the radius on the first wheel, m."""
        return np.hypot(self.first.base, s)

    def second_radius(self, s):
        """Return the radius on the second wheel, m."""
        return np.hypot(self.second.base, self.second_length(s))

    def curvature_radius(self, s):
        """Return the relative radius of both flanks across the contact line, m."""
        return s * self.second_length(s) / (self.reach * cos(self.base_helix))

    @property
    def tip_ends(self) -> tuple[float, float]:
        """Ends of the path as the tips give them, m; the first is below zero where a tip reaches
        below the other's base circle.
        """
        second = sqrt(max(self.second.tip**2 - self.second.base**2, 0.0))
        start = self.second.sign * (self.reach - second)
        return start, sqrt(max(self.first.tip**2 - self.first.base**2, 0.0))

    @property
    def form_ends(self) -> tuple[float, float]:
        """Places on the path at which the fillets of the first and of the second wheel begin, m."""
        first = sqrt(max(self.first.form**2 - self.first.base**2, 0.0))
        second = sqrt(max(self.second.form**2 - self.second.base**2, 0.0))
        return first, self.second.sign * (self.reach - second)

    @cached_property
    def ends(self) -> tuple[float, float]:
        """Ends A and E of the path, m: at the tips, and no further than the flanks go."""
        (start, stop), (first, second) = self.tip_ends, self.form_ends
        return max(start, first), min(stop, second)

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio; below zero where tips do not meet."""
        start, stop = self.ends
        return (stop - start) / self.pitch

    @property
    def overlap_ratio(self) -> float:
        """Overlap ratio of the face width, by the helix."""
        return self.face_width * tan(self.base_helix) / self.pitch

    @property
    def backlash(self) -> float:
        """Gap between both flanks along the line of action, m; below zero where teeth overlap."""
        first, second = self.first, self.second
        grown = involute(self.working_angle) - involute(first.transverse_angle)
        shifts = first.shift + second.shift
        total = first.teeth + second.teeth
        pitches = total * grown - 2 * shifts * tan(first.rack.pressure_angle)
        at_base = first.transverse_module * cos(first.transverse_angle) * pitches
        return float(at_base * cos(self.base_helix))

    @property
    def clearances(self) -> tuple[float, float]:
        """Clearances between the tip of each wheel and the root of the other, m."""
        sign = self.second.sign
        between = self.distance - sign * self.first.tip - self.second.root
        other = self.distance - self.second.tip - sign * self.first.root
        return sign * between, sign * other
