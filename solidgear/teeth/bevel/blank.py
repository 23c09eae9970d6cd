r"""Blanks of a spiral bevel pair, as a drawing gives them, and what is estimated where it does not.

The pitch angles follow from the teeth and the shaft angle S (ISO 23509:2016, 6.2),

    tan dp = sin S / (zg / zp + cos S),   dg = S - dp,

and with them the cone distance ``A = rp / sin dp`` to the heel, the mean one ``Rm = A - b / 2`` and the
mean normal module ``mn = 2 rp / zp Rm / A cos beta``.  Depths grow with the distance from the apex (a
constant depth angle without tilt of the root), so that tips and pitch cones share the apex.  Teeth that
are not described otherwise have the proportions of ANSI/AGMA 2005-D03: a working depth of two mean
normal modules, of which the larger gear's addendum takes 0.21 + 0.29 / u^2, u = sqrt(zg cos dp / (zp
cos dg)) being the ratio of an equivalent pair at a right angle.

The tooth trace is the circle of the cutter on the flat crown gear, whose spiral angle at the distance R
from the apex is

    sin beta(R) = (R^2 + rc^2 - D^2) / (2 R rc),   D^2 = Rm^2 + rc^2 - 2 Rm rc sin beta;

where the right side leaves [-1, 1] the circle does not reach.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import atan2, cos, degrees, isfinite, pi, sin, sqrt, tan

from solidgear.core.errors import SceneError
from solidgear.core.gears.wheel import Rack, Wheel

#: rad; least and largest spiral angle at which teeth are cut
STEEPEST_SPIRAL = 1.2
#: rad; of pressure angles
PRESSURE = (0.17, 0.61)
#: least and largest cutter radius over the mean cone distance
CUTTER = (0.2, 20.0)
#: estimated where a file gives none: 20 degrees, working depth in mean normal modules
USUAL_PRESSURE, USUAL_DEPTH = pi / 9, 2.0
#: dedendum over half the working depth, and root radius in modules, of the virtual wheels
DEDENDUM, ROOT_RADIUS = 1.25, 0.3
#: teeth of a virtual wheel that is as good as a rack
STRAIGHT = 1000
#: rad; published pitch angles are rounded to three digits
ROUNDED = 5e-3
#: ways of cutting that leave other flanks, by the key that asks for them
UNSUPPORTED = {
    "offset": "makes a hypoid pair, whose flanks are other surfaces; give pairs whose axes meet",
    "tilt": "of the cutter makes other flanks than its untilted cone does; leave it out",
    "modified_roll": "makes other flanks than a constant ratio of roll does; leave it out",
    "face_hobbing": "makes extended epicycloids; flanks are those of face milling, tooth by tooth",
}


@dataclass(frozen=True)
class BevelBlank:
    """Both blanks of a spiral bevel pair and their cutter.

    Attributes
    ----------
    teeth : (int, int)
        Of pinion and gear.
    pitch_radius : float
        Of the pinion at the heel, m.
    face : float
        Face width along the pitch cone, m.
    spiral_angle : float
        At the middle of the face, rad; 0 for Zerol teeth.
    hand : {"left", "right"}
        Of the pinion; the gear has the other.
    loaded_side : {"concave", "convex"}
        Flank of the pinion that carries.
    pressure_angle : float
        Normal to the tooth, rad.
    cutter_radius : float
        At the pitch plane, m.
    gear_share : float
        Share of the gear's addendum in the working depth.
    working_depth : float
        At the middle of the face, in mean normal modules.
    shaft_angle : float
        rad.
    estimated : tuple of str
        Attributes that are estimated.
    notes : tuple of str
        On data that were not taken as they stand.

    Raises
    ------
    SceneError
        For data that make no flank.

    Examples
    --------
    >>> blank = BevelBlank((14, 45), 0.067, 0.063, 0.478, "left", "concave", 0.39, 0.15, 0.27)
    >>> round(blank.pitch_angles[0], 4), round(blank.mean_distance, 4)
    (0.3016, 0.194)
    """

    teeth: tuple[int, int]
    pitch_radius: float
    face: float
    spiral_angle: float
    hand: str
    loaded_side: str
    pressure_angle: float
    cutter_radius: float
    gear_share: float
    working_depth: float = USUAL_DEPTH
    shaft_angle: float = pi / 2
    estimated: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        problems = [*self._values_out_of_range()]
        problems = problems or [*self._shapes_that_fail()]
        if problems:
            raise SceneError.of(problems)

    # ---------------------------------------------------------------- derived
    @property
    def ratio(self) -> float:
        """Teeth of the gear over teeth of the pinion."""
        return self.teeth[1] / self.teeth[0]

    @property
    def pitch_angles(self) -> tuple[float, float]:
        """Between axis and pitch cone, of pinion and gear, rad."""
        pinion = atan2(sin(self.shaft_angle), self.ratio + cos(self.shaft_angle))
        return pinion, self.shaft_angle - pinion

    @property
    def heel_distance(self) -> float:
        """Distance from the apex to the heel along the pitch cone, m."""
        return self.pitch_radius / sin(self.pitch_angles[0])

    @property
    def mean_distance(self) -> float:
        """Distance from the apex to the middle of the face, m."""
        return self.heel_distance - self.face / 2

    @property
    def toe_distance(self) -> float:
        """Distance from the apex to the toe, m."""
        return self.heel_distance - self.face

    @property
    def module(self) -> float:
        """Normal module at the middle of the face, m."""
        transverse = 2 * self.pitch_radius / self.teeth[0] * self.mean_distance / self.heel_distance
        return transverse * cos(self.spiral_angle)

    @property
    def addenda(self) -> tuple[float, float]:
        """Addenda of pinion and gear at the middle of the face, m."""
        depth = self.working_depth * self.module
        return depth * (1 - self.gear_share), depth * self.gear_share

    @property
    def crown_teeth(self) -> float:
        """Teeth of the flat crown gear; seldom a whole number."""
        return self.teeth[0] / sin(self.pitch_angles[0])

    @property
    def hand_sign(self) -> int:
        """1 for a right-handed pinion, -1 for a left-handed."""
        return 1 if self.hand == "right" else -1

    @property
    def side(self) -> int:
        """1 where the pinion's concave flank carries, -1 where its convex one does."""
        return 1 if self.loaded_side == "concave" else -1

    def virtual_wheels(self, length: float) -> tuple[Wheel, Wheel]:
        """Return the spur wheels of the normal section at the middle of the face, which teeth of pinion
        and gear bend as (Tredgold), with a face of `length`, m.
        """
        pinion, gear = self.addenda
        shift = (pinion - gear) / (2 * self.module)
        half = self.working_depth / 2
        rack = Rack(self.pressure_angle, half, DEDENDUM * half, ROOT_RADIUS)
        steep = cos(self.spiral_angle) ** 3
        counts = [
            min(round(teeth / (cos(angle) * steep)), STRAIGHT)
            for teeth, angle in zip(self.teeth, self.pitch_angles)
        ]
        first, second = (
            Wheel(count, self.module, shift=x, rack=rack, face_width=length)
            for count, x in zip(counts, (shift, -shift))
        )
        return first, second

    # ---------------------------------------------------------------- refusals
    def _values_out_of_range(self) -> Iterator[SceneError]:
        """Yield problems of single values."""
        lengths = {"pitch_radius": self.pitch_radius, "face": self.face}
        for name, length in lengths.items():
            if not (isfinite(length) and length > 0):
                yield SceneError(f"is {length:g} m; give a length above zero", path=(name,))
        if min(self.teeth) < 3:
            yield SceneError(f"are {self.teeth}; no bevel gear has below 3", path=("teeth",))
        if not 0 < self.shaft_angle < pi:
            yield SceneError(
                "must lie between 0 and 180 degrees, both excluded; for parallel shafts describe a "
                "cylindrical pair",
                path=("shaft_angle",),
            )
        if not 0 <= self.spiral_angle < STEEPEST_SPIRAL:
            yield SceneError(
                f"is {degrees(self.spiral_angle):.4g} degrees; give 0 to "
                f"{degrees(STEEPEST_SPIRAL):.0f}, without sign, which is that of hand",
                path=("spiral_angle",),
            )
        least, most = PRESSURE
        if not least <= self.pressure_angle <= most:
            yield SceneError(
                f"is {degrees(self.pressure_angle):.4g} degrees; cutters have 10 to 35",
                path=("pressure_angle",),
            )
        for name, words in (("hand", ("left", "right")), ("loaded_side", ("concave", "convex"))):
            if getattr(self, name) not in words:
                yield SceneError(f"must be {words[0]} or {words[1]}", path=(name,))
        if not 0 < self.gear_share < 1:
            yield SceneError("must lie between 0 and 1, both excluded", path=("gear_share",))
        if not 0 < self.working_depth <= 3:
            yield SceneError(
                "must lie between 0 and 3 modules; 2 is usual", path=("working_depth",)
            )

    def _shapes_that_fail(self) -> Iterator[SceneError]:
        """Yield problems between values, each of which is possible alone."""
        widest = max(self.pitch_angles)
        if widest >= pi / 2:
            name = "gear" if widest == self.pitch_angles[1] else "pinion"
            yield SceneError(
                f"of {degrees(self.shaft_angle):.4g} degrees makes the {name} an internal one, of a "
                f"pitch angle of {degrees(widest):.4g} degrees",
                path=("shaft_angle",),
            )
            return
        if self.face >= self.heel_distance:
            yield SceneError(
                f"of {1e3 * self.face:.4g} mm is longer than the cone, "
                f"{1e3 * self.heel_distance:.4g} mm from the apex to the heel",
                path=("face",),
            )
            return
        low, high = (factor * self.mean_distance for factor in CUTTER)
        if not low <= self.cutter_radius <= high:
            yield SceneError(
                f"is {1e3 * self.cutter_radius:.4g} mm; straight teeth have no cutter circle, and "
                f"spiral ones of this pair between {1e3 * low:.4g} and {1e3 * high:.4g} mm",
                path=("cutter_radius",),
            )
            return
        for name, distance in (("toe", self.toe_distance), ("heel", self.heel_distance)):
            if not self._reaches(distance):
                yield SceneError(
                    f"of {1e3 * self.cutter_radius:.4g} mm does not reach across the face: its "
                    f"circle misses the {name}, {1e3 * distance:.4g} mm from the apex",
                    path=("cutter_radius",),
                )
                return

    def _reaches(self, distance: float) -> bool:
        """Return whether the circle, over the whole depth, crosses that distance from the apex."""
        rc, mean = self.cutter_radius, self.mean_distance
        square = mean**2 + rc**2 - 2 * mean * rc * sin(self.spiral_angle)
        scale = distance / mean
        for height in (-self.addenda[0] * scale, self.addenda[1] * scale):
            radius = rc - self.side * height * tan(self.pressure_angle)
            sine = (distance**2 + radius**2 - square) / (2 * distance * radius)
            if radius <= 0 or abs(sine) >= 1:
                return False
        return True


def usual_gear_share(teeth: tuple[int, int], shaft_angle: float) -> float:
    """Return the share of the gear's addendum in the working depth by ANSI/AGMA 2005-D03.

    Examples
    --------
    >>> round(usual_gear_share((14, 45), pi / 2), 3)
    0.238
    """
    pinion = atan2(sin(shaft_angle), teeth[1] / teeth[0] + cos(shaft_angle))
    ratio = sqrt(teeth[1] / teeth[0] * cos(pinion) / cos(shaft_angle - pinion))
    larger = 0.21 + 0.29 / max(ratio, 1 / ratio) ** 2
    return larger if ratio >= 1 else 1 - larger


def completed_blank(
    teeth: tuple[int, int],
    pitch_radius: float,
    face: float,
    spiral_angle: float,
    hand: str,
    loaded_side: str = "concave",
    *,
    pressure_angle: float | None = None,
    cutter_radius: float | None = None,
    gear_share: float | None = None,
    working_depth: float | None = None,
    shaft_angle: float = pi / 2,
    pitch_angles: tuple[float | None, float | None] = (None, None),
    settings: Mapping[str, object] | None = None,
) -> BevelBlank:
    """Return a blank whose missing data are estimated, and named as estimated.

    Parameters
    ----------
    teeth, pitch_radius, face, spiral_angle, hand, loaded_side, shaft_angle
        As of `BevelBlank`.
    pressure_angle, cutter_radius, gear_share, working_depth : float, optional
        Estimated where they are left out: 20 degrees, the mean cone distance, the proportions of
        ANSI/AGMA 2005-D03.
    pitch_angles : (float, float), optional
        As published, rad; noted where they are not those of the teeth, which are taken.
    settings : mapping, optional
        Further keys; what makes other flanks is refused.

    Raises
    ------
    SceneError
        For data that make no flank, and for hypoid offset, tilt, modified roll and face hobbing.

    Examples
    --------
    >>> blank = completed_blank((14, 45), 0.067, 0.063, 0.478, "left")
    >>> blank.estimated
    ('pressure_angle', 'cutter_radius', 'gear_share', 'working_depth')
    """
    refused = [key for key, setting in (settings or {}).items() if setting and key in UNSUPPORTED]
    if refused:
        raise SceneError.of([SceneError(UNSUPPORTED[key], path=(key,)) for key in refused])
    pinion = atan2(sin(shaft_angle), teeth[1] / teeth[0] + cos(shaft_angle))
    mean = pitch_radius / sin(pinion) - face / 2
    usual = {
        "pressure_angle": USUAL_PRESSURE,
        "cutter_radius": mean,
        "gear_share": usual_gear_share(teeth, shaft_angle),
        "working_depth": USUAL_DEPTH,
    }
    data = {
        "pressure_angle": pressure_angle,
        "cutter_radius": cutter_radius,
        "gear_share": gear_share,
        "working_depth": working_depth,
    }
    values = {key: usual[key] if value is None else value for key, value in data.items()}
    return BevelBlank(
        teeth,
        pitch_radius,
        face,
        spiral_angle,
        hand,
        loaded_side,
        shaft_angle=shaft_angle,
        estimated=tuple(key for key, value in data.items() if value is None),
        notes=tuple(_pitch_angle_notes(pitch_angles, (pinion, shaft_angle - pinion))),
        **values,
    )


def _pitch_angle_notes(
    published: tuple[float | None, float | None], of_teeth: tuple[float, float]
) -> Iterator[str]:
    """Yield a note where published pitch angles are not those of the teeth."""
    pairs = [
        (name, angle, due)
        for name, angle, due in zip(("pinion", "gear"), published, of_teeth)
        if angle is not None and abs(angle - due) > ROUNDED
    ]
    if pairs:
        words = " and ".join(
            f"{angle:.4g} rad of the {name} ({due:.4g})" for name, angle, due in pairs
        )
        total = [angle for angle in published if angle is not None]
        sums = f", {degrees(sum(total)):.1f} degrees in all" if len(total) == 2 else ""
        yield f"pitch angles follow from teeth and shaft angle, in place of {words}{sums}"
