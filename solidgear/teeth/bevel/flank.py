r"""Flanks of a spiral bevel pair as envelopes of the cutter's cone on the flat crown gear, in closed form.

The frame of the crown gear: apex 0, pitch plane z = 0, the pitch line e = x, in which both pitch cones
touch, the pinion's axis (cos dp, 0, sin dp) and the gear's (cos dg, 0, -sin dg).  While the crown turns
by phi about z, the pinion turns by phi / sin dp about its axis and the gear by -phi / sin dg: against
the crown both turn about e, by cot dp and -cot dg.  So a surface that the crown carries touches what it
envelops where its normal meets e, and touches both members in the same line.

**Contact lines.**  The blades sweep a cone with the centre C, the radius ``rho = r - s T z`` and T = tan
alpha, s = 1 for the pinion's concave flank and -1 for its convex one; its material lies outside the cone
for s = 1 and inside for s = -1.  The normal of the cone at P leaves the pitch plane at

    N = C + (r - s z / (sin alpha cos alpha)) u,     P = N + z (s cot alpha u + k),

u being the direction from the axis of the cutter.  In the position phi the centre has turned with the
crown, and N lies on e, at the distance l from the apex: u is the direction from C to l e, and z = s sin
alpha cos alpha (r - |l e - C|).  So l alone gives a point of a contact line, without iteration.

**Rolling.**  With D = |l e - C|, g the cone's generator and t its tangent, the surface gradient of the
crown's angle at which a point touches is

    grad phi = (s u_y / sin alpha g - D u_x / rho t) / l,

and along the line P moves by ``-(s sin alpha u_x g + rho u_y / D t) dl``.  A unit force along the
normal n turns pinion and gear with the levers ``l n_y sin dp`` and ``l n_y sin dg``.

**Curvature.**  A contact line runs across the crown's flank with the speed 1 / |grad phi|, across the
pinion's and the gear's, which slide over it, with (1 - cot dp w) and (1 + cot dg w) times that, w = grad
phi . (e x P).  The derivative of the equation of meshing gives the relative curvature of two flanks that
share a line, times both speeds (Litvin and Fuentes, Gear Geometry and Applied Theory, 2004, 8.4):

    1 / R = l sin alpha |grad phi|^2 (cot dp + cot dg) / ((1 - cot dp w) (1 + cot dg w)).

Where a factor falls to zero the line stands still on that flank: it is undercut.

**Mismatch.**  The flanks are conjugate where one cone makes both.  Else the pinion's cone has another
radius, blade and spiral angle through the same mean point; on the contact line of the gear the flanks
stand as far apart as the cones, to the first order.

The pinion's frame is that of :mod:`solidgear.core.system.gear_mesh`: y along its axis from the apex, the
mesh on the side of -x, and z, which is y here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, pi, sin, tan

import numpy as np

from solidgear.core.errors import SceneError
from solidgear.teeth.bevel.blank import BevelBlank

#: distances from the apex and positions at which a whole flank is looked at
ALONG, POSITIONS = 61, 81
#: largest roll of the crown that is looked at, in its pitches
FARTHEST = 8.0
#: steps of Newton to a distance from the apex
STEPS = 5
#: relative difference of the cutter radius from which the ease-off is taken in proportion
STEP = 1e-3


@dataclass(frozen=True)
class Mismatch:
    """How the pinion's cutter differs from the gear's; what is above zero opens the flanks away from
    the mean point.

    Attributes
    ----------
    cutter_radius : float
        Excess of the radius that cuts the concave flank, m: crowning along the tooth.
    blade_curvature : float
        Curvature of the pinion's blade, 1/m: crowning of the profile.
    spiral_angle : float
        Excess of the pinion's spiral angle, rad.
    """

    cutter_radius: float = 0.0
    blade_curvature: float = 0.0
    spiral_angle: float = 0.0


@dataclass(frozen=True)
class FlankPoints:
    """Points of contact, arrays of one shape ``s``, in the crown gear's frame; lengths in m.

    Attributes
    ----------
    roll, place : s
        Turn of the crown, rad, and distance from the apex of where the normal meets the pitch line.
    point, normal : (*s, 3)
        The unit normal points into the pinion.
    distance, height : s
        Distance from the crown's axis and height above the pitch plane.
    lift : (2, *s)
        Heights above the pitch cones of pinion and gear, brought to the middle of the face.
    lever : s
        Torque about the pinion's axis of a unit force along the normal.
    radius : s
        Relative radius of curvature across the line.
    along : (*s, 3)
        Way along the line per change of place.
    speeds : (2, *s)
        Speed of the line over the flanks of pinion and gear, over that across the crown's.
    """

    roll: np.ndarray
    place: np.ndarray
    point: np.ndarray
    normal: np.ndarray
    distance: np.ndarray
    height: np.ndarray
    lift: np.ndarray
    lever: np.ndarray
    radius: np.ndarray
    along: np.ndarray
    speeds: np.ndarray

    @property
    def stretch(self) -> np.ndarray:
        """Length along the line per change of place."""
        return np.linalg.norm(self.along, axis=-1)


@dataclass(frozen=True)
class Cutter:
    """Cone that the blades sweep, in the pitch plane of the crown at rest.

    Attributes
    ----------
    radius : float
        In the pitch plane, m.
    centre : (2,) ndarray
        m.
    slope : float
        Of the radius against the height, at the pitch plane.
    curvature : float
        Of the radius over the height, 1/m.
    """

    radius: float
    centre: np.ndarray
    slope: float
    curvature: float = 0.0

    def outside(self, points: FlankPoints) -> np.ndarray:
        """Return how far points lie outside the cone, along its normal, m."""
        turned = _turned(self.centre, points.roll)
        across = points.point[..., :2] - turned
        radius = self.radius + self.slope * points.height + self.curvature * points.height**2 / 2
        slope = self.slope + self.curvature * points.height
        return (np.hypot(across[..., 0], across[..., 1]) - radius) / np.sqrt(1 + slope**2)


def _turned(vector: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return a vector (2,) of the pitch plane, turned by angles of shape s: (*s, 2)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]], -1)


@dataclass(frozen=True)
class BevelFlanks:
    """The flanks of a pair that carry.

    Raises
    ------
    SceneError
        For undercut flanks, and teeth that part before the next ones touch.

    Examples
    --------
    >>> blank = BevelBlank((14, 45), 0.067, 0.063, 0.478, "left", "concave", 0.3927, 0.1524, 0.27)
    >>> flanks = BevelFlanks(blank)
    >>> round(flanks.contact_ratio, 2)
    2.48
    """

    blank: BevelBlank
    mismatch: Mismatch = Mismatch()

    # ---------------------------------------------------------------- cutters
    def _cutter(self, radius: float, spiral_angle: float, curvature: float = 0.0) -> Cutter:
        """Return the cone through the mean point."""
        blank = self.blank
        outward = np.array([sin(spiral_angle), -blank.hand_sign * cos(spiral_angle)])
        centre = np.array([blank.mean_distance, 0.0]) - radius * outward
        return Cutter(radius, centre, -blank.side * tan(blank.pressure_angle), curvature)

    @cached_property
    def gear_cutter(self) -> Cutter:
        """Cone that cuts the gear."""
        return self._cutter(self.blank.cutter_radius, self.blank.spiral_angle)

    @cached_property
    def pinion_cutter(self) -> Cutter:
        """Cone that cuts the pinion."""
        blank, mismatch = self.blank, self.mismatch
        return self._cutter(
            blank.cutter_radius + blank.side * mismatch.cutter_radius,
            blank.spiral_angle + mismatch.spiral_angle,
            blank.side * mismatch.blade_curvature,
        )

    # ---------------------------------------------------------------- contact
    @cached_property
    def axes(self) -> np.ndarray:
        """Unit vectors (2, 3) along the axes of pinion and gear, away from the apex."""
        pinion, gear = self.blank.pitch_angles
        return np.array([[cos(pinion), 0.0, sin(pinion)], [cos(gear), 0.0, -sin(gear)]])

    @property
    def turn(self) -> int:
        """Sense in which the force on the pinion turns it about its axis."""
        return -self.blank.side * self.blank.hand_sign

    @property
    def pitch(self) -> float:
        """Turn of the crown from tooth to tooth, rad."""
        return 2 * pi / self.blank.crown_teeth

    def points(self, place, roll) -> FlankPoints:
        """Return the points of contact whose normals meet the pitch line at places, m, in positions of
        the crown, rad; both broadcast.
        """
        blank, cutter = self.blank, self.gear_cutter
        place, roll = np.broadcast_arrays(np.asarray(place, float), np.asarray(roll, float))
        side, alpha = blank.side, blank.pressure_angle
        sine, cosine = sin(alpha), cos(alpha)
        away = -_turned(cutter.centre, roll)
        away[..., 0] += place
        length = np.hypot(away[..., 0], away[..., 1])
        ux, uy = away[..., 0] / length, away[..., 1] / length
        z = side * sine * cosine * (cutter.radius - length)
        rho = cutter.radius + cutter.slope * z
        lean = side * z / tan(alpha)
        point = np.stack([place + lean * ux, lean * uy, z], -1)
        normal = np.stack([side * cosine * ux, side * cosine * uy, np.full_like(ux, sine)], -1)
        # surface gradient of the roll: along the generator, along the circle
        generating, around = side * uy / (sine * place), -length * ux / (rho * place)
        generator = np.stack([-side * sine * ux, -side * sine * uy, np.full_like(ux, cosine)], -1)
        tangent = np.stack([-uy, ux, np.zeros_like(ux)], -1)
        gradient = generating[..., None] * generator + around[..., None] * tangent
        slide = gradient[..., 2] * point[..., 1] - gradient[..., 1] * z
        cot_pinion, cot_gear = (1 / tan(angle) for angle in blank.pitch_angles)
        speeds = np.stack([1 - cot_pinion * slide, 1 + cot_gear * slide])
        steep = generating**2 + around**2
        with np.errstate(divide="ignore"):  # an undercut flank has no radius
            radius = speeds[0] * speeds[1] / (place * sine * steep * (cot_pinion + cot_gear))
        return FlankPoints(
            roll,
            place,
            point,
            normal,
            np.hypot(point[..., 0], point[..., 1]),
            z,
            np.stack([self._lift(point, member) for member in (0, 1)]),
            place * normal[..., 1] * sin(blank.pitch_angles[0]),
            radius,
            -(side * sine * ux)[..., None] * generator - (rho * uy / length)[..., None] * tangent,
            speeds,
        )

    def _lift(self, point: np.ndarray, member: int) -> np.ndarray:
        """Return heights above the pitch cone of a member at the middle of the face, m."""
        along = point @ self.axes[member]
        across = np.sqrt(np.sum(point**2, axis=-1) - along**2)
        angle = np.arctan2(across, along)
        return self.blank.mean_distance * np.tan(angle - self.blank.pitch_angles[member])

    def room(self, points: FlankPoints) -> np.ndarray:
        """Return how far points lie below the tips of pinion and gear, (2, *s) m."""
        addenda = np.array(self.blank.addenda).reshape(2, *(1,) * points.roll.ndim)
        return addenda - points.lift

    def gap(self, points: FlankPoints) -> np.ndarray:
        """Return what the mismatch leaves open at points, m."""
        return -self.blank.side * self.pinion_cutter.outside(points)

    # ---------------------------------------------------------------- whole flank
    def line(self, distance, roll) -> FlankPoints:
        """Return the points of contact lines at distances from the crown's axis, m, in positions of the
        crown, rad; both broadcast.  Newton does not get to distances that a line does not reach.
        """
        low, high = 0.2 * self.blank.toe_distance, 3 * self.blank.heel_distance
        distance, roll = np.broadcast_arrays(np.asarray(distance, float), np.asarray(roll, float))
        points = self.points(distance, roll)
        for _ in range(STEPS):
            slope = np.sum(points.point[..., :2] * points.along[..., :2], -1) / points.distance
            step = (points.distance - distance) / np.maximum(slope, 0.1)
            points = self.points(np.clip(points.place - step, low, high), roll)
        return points

    def _all_lines(self, rolls: np.ndarray) -> tuple[FlankPoints, np.ndarray]:
        """Return the points of the contact lines in positions of the crown, and their least room below
        the tips, both (positions, distances).
        """
        blank = self.blank
        distance = np.linspace(blank.toe_distance, blank.heel_distance, ALONG)
        points = self.line(distance, rolls[:, None])
        room = self.room(points).min(axis=0)
        reached = np.abs(points.distance - distance) < 1e-9 * distance
        return points, np.where(reached, room, -blank.module)

    @cached_property
    def rolls(self) -> tuple[float, float]:
        """First and last position of the crown in which a tooth touches, rad."""
        rolls = np.linspace(-FARTHEST, FARTHEST, 2 * POSITIONS) * self.pitch
        for _ in range(2):  # coarse, then where the flank lies
            _, room = self._all_lines(rolls)
            most = room.max(axis=1)
            middle = int(np.argmin(np.abs(rolls)))  # the mean point touches in position 0
            clear = np.flatnonzero(most < 0)
            first = int(np.max(clear[clear < middle], initial=0)) + 1
            last = int(np.min(clear[clear > middle], initial=rolls.size - 1)) - 1
            ends = [
                float(np.interp(0.0, most[[k, k + 1]][::step], rolls[[k, k + 1]][::step]))
                for k, step in ((first - 1, 1), (last, -1))
            ]
            step = rolls[1] - rolls[0]
            rolls = np.linspace(ends[0] - step, ends[1] + step, POSITIONS)
        return ends[0], ends[1]

    @cached_property
    def surface(self) -> tuple[FlankPoints, np.ndarray]:
        """Points of all contact lines, and which lie on the flanks, both (positions, places)."""
        points, room = self._all_lines(np.linspace(*self.rolls, POSITIONS))
        return points, room >= 0

    @property
    def contact_ratio(self) -> float:
        """Total contact ratio."""
        first, last = self.rolls
        return (last - first) / self.pitch

    def refuse_undercut(self) -> None:
        """Refuse flanks that are undercut where they touch, and teeth that part too soon."""
        points, on_flank = self.surface
        for member, name in enumerate(("pinion", "gear")):
            slowest = np.where(on_flank, points.speeds[member], np.inf).min()
            if slowest <= 0:
                raise SceneError(
                    f"of {degrees(self.blank.pressure_angle):.4g} degrees leaves the {name} "
                    "undercut within its flank; raise it, the number of teeth or the addendum's "
                    "share",
                    path=("pressure_angle",),
                )
        if self.contact_ratio < 1:
            raise SceneError(
                f"leaves a contact ratio of {self.contact_ratio:.2f}: teeth part before the next "
                "ones touch",
                path=("working_depth",),
            )

    def ease_off(self) -> float:
        """Return the largest gap by mismatch on the flanks, m."""
        points, on_flank = self.surface
        gaps = self.gap(points)[on_flank]
        return float(gaps.max() - gaps.min())

    @property
    def pinion_frame(self) -> np.ndarray:
        """Rows (3, 3): the axes of the pinion's frame in the crown gear's."""
        pinion = self.blank.pitch_angles[0]
        return np.array(
            [[-sin(pinion), 0.0, cos(pinion)], [cos(pinion), 0.0, sin(pinion)], [0.0, 1.0, 0.0]]
        )


def lengthwise(blank: BevelBlank, ease_off: float) -> Mismatch:
    """Return the difference of cutter radii that leaves the largest gap of `ease_off`, m.

    Examples
    --------
    >>> blank = BevelBlank((14, 45), 0.067, 0.063, 0.478, "left", "concave", 0.3927, 0.1524, 0.27)
    >>> 3e-3 < lengthwise(blank, 100e-6).cutter_radius < 5e-3
    True
    """
    # to first order the gap grows with the difference of the circles' curvatures
    trial = Mismatch(STEP * blank.cutter_radius)
    curvature = 1 / blank.cutter_radius
    grown = curvature - 1 / (blank.cutter_radius + blank.side * trial.cutter_radius)
    wanted = grown * ease_off / BevelFlanks(blank, trial).ease_off()
    radius = 1 / (curvature - wanted)
    return Mismatch(blank.side * (radius - blank.cutter_radius))
