r"""Teeth of two cylindrical gears at their centre distance: backlash, clearance, contact ratio.

Everything is exact in the transverse plane (ISO 21771:2007, 5.4 and 5.5), for teeth of the basic
rack of ISO 53 without allowances: tips one module beyond the reference circle, roots a module and
a quarter within it, both moved out by the profile shift.  A ring counts its teeth below zero, and
so do its radii and the centre distance.  With the working pressure angle alpha_wt of the centre
distance a,

    cos alpha_wt = (rb1 + rb2) / a,
    j = mt cos alpha_t ((z1 + z2) (inv alpha_wt - inv alpha_t) - 2 (x1 + x2) tan alpha) cos beta_b

is the gap between both flanks along the line of action, inv being tan minus angle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import acos, atan, copysign, cos, pi, sin, sqrt, tan
from typing import TYPE_CHECKING

from solidgear.core import SceneError
from solidgear.trains.file.cylindrical import working_cylinders

if TYPE_CHECKING:
    from solidgear.trains.file.pairs import Pair

#: modules that a tooth reaches beyond its reference circle and within it (ISO 53)
ADDENDUM, DEDENDUM = 1.0, 1.25
#: modules of overlap that two digits of the profile shifts leave open, and that the usual thinning
#: of both wheels takes up (DIN 3967, cd25): no caution below the first, refused above the second
ROUNDED, THINNED = 5e-3, 0.05
#: modules of backlash above which no drawing asks for it: ISO/TR 10064-2 recommends 0.04 to 0.13
LOOSE = 0.25
#: modules of undercut without a caution: that of a wheel of 14 teeth without profile shift
PASSED = 0.185


def involute(angle: float) -> float:
    """Return the involute function of an angle, rad."""
    return tan(angle) - angle


@dataclass(frozen=True)
class ToothFit:
    """Teeth of two cylindrical gears where they meet.

    Examples
    --------
    The spur gears of Kohara's Gear Technical Reference (2015), table 4.3, have no backlash at
    56.4999 mm; half a millimetre further out they have.

    >>> from math import radians
    >>> fit = ToothFit((12, 24), 3e-3, 0.0, radians(20), (0.6, 0.36), 57.0e-3)
    >>> round(1e6 * fit.backlash), round(fit.contact_ratio, 2)
    (448, 1.22)
    """

    teeth: tuple[int, int]  #: of a ring, which comes second, below zero
    module: float  #: normal, m
    #: helix_angle, pressure_angle: at the reference cylinder, the latter normal to the tooth, rad
    helix_angle: float
    pressure_angle: float
    shift: tuple[float, float]  #: profile shifts, in modules
    centre_distance: float  #: m; below zero with a ring
    face_width: float = 0.0  #: that both share, m; zero where it is not known

    @property
    def transverse(self) -> float:
        """Transverse pressure angle at the reference cylinder, rad."""
        return atan(tan(self.pressure_angle) / cos(self.helix_angle))

    @property
    def radii(self) -> tuple[float, float]:
        """Radii of the reference circles, m."""
        first, second = (self.module * z / (2 * cos(self.helix_angle)) for z in self.teeth)
        return first, second

    @property
    def base_radii(self) -> tuple[float, float]:
        """Radii of the base circles, m."""
        first, second = (radius * cos(self.transverse) for radius in self.radii)
        return first, second

    @property
    def tips(self) -> tuple[float, float]:
        """Radii of the tip circles, m."""
        first, second = (
            radius + self.module * (ADDENDUM + x) for radius, x in zip(self.radii, self.shift)
        )
        return first, second

    @property
    def roots(self) -> tuple[float, float]:
        """Radii of the root circles, m."""
        first, second = (
            radius - self.module * (DEDENDUM - x) for radius, x in zip(self.radii, self.shift)
        )
        return first, second

    @property
    def at_work(self) -> float:
        """Transverse pressure angle at the centre distance, rad."""
        return acos(sum(self.base_radii) / self.centre_distance)

    @property
    def backlash(self) -> float:
        """Gap between both flanks along the line of action, m; below zero where teeth overlap."""
        grown = involute(self.at_work) - involute(self.transverse)
        pitches = sum(self.teeth) * grown - 2 * sum(self.shift) * tan(self.pressure_angle)
        at_base = self.module / cos(self.helix_angle) * cos(self.transverse) * pitches
        base_helix = atan(tan(self.helix_angle) * cos(self.transverse))
        return at_base * cos(base_helix)

    @property
    def tight(self) -> float:
        """Centre distance without backlash of two wheels with outer teeth, m."""
        cylinders = working_cylinders(
            self.teeth, self.module, self.helix_angle, self.pressure_angle, self.shift
        )
        return cylinders.without_backlash

    @property
    def clearances(self) -> tuple[float, float]:
        """Clearances between the tip of each wheel and the root of the other, m."""
        (tip, other_tip), (root, other_root) = self.tips, self.roots
        a = self.centre_distance
        return a - tip - other_root, a - other_tip - root

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio, as far as involutes go; below zero where tips do not meet."""
        reach = self.centre_distance * sin(self.at_work)
        lengths = [
            copysign(sqrt(max(0.0, tip**2 - base**2)), tip)
            for tip, base in zip(self.tips, self.base_radii)
        ]
        if reach > 0:
            lengths = [min(length, reach) for length in lengths]
        pitch = pi * self.module / cos(self.helix_angle) * cos(self.transverse)
        return (sum(lengths) - reach) / pitch

    @property
    def overlap_ratio(self) -> float:
        """Overlap ratio of the face width, by the helix."""
        return self.face_width * sin(abs(self.helix_angle)) / (pi * self.module)

    def undercut(self, k: int) -> float:
        """Return the profile shift that wheel k lacks to have no undercut; below zero without any."""
        if self.teeth[k] < 0:
            return -1.0
        straight = self.teeth[k] * sin(self.transverse) ** 2 / (2 * cos(self.helix_angle))
        return ADDENDUM - self.shift[k] - straight

    def tip_thickness(self, k: int) -> float:
        """Return the transverse tooth thickness of wheel k at the tip, m; below zero if pointed."""
        tip, base, teeth = self.tips[k], self.base_radii[k], self.teeth[k]
        if abs(tip) <= abs(base):
            return self.module
        half = (pi / 2 + 2 * self.shift[k] * tan(self.pressure_angle)) / teeth
        return 2 * tip * (half + involute(self.transverse) - involute(acos(base / tip)))


def fit_of(pair: Pair) -> ToothFit | None:
    """Return the teeth of a pair of cylindrical gears; None where the file does not give them.

    Raises
    ------
    SceneError
        As :func:`solidgear.trains.file.cylindrical.working_cylinders`.
    """
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    module = pinion.module or gear.module
    if mesh.shaft_angle or module is None or mesh.pressure_angle is None:
        return None
    helix = pinion.helix_angle or gear.helix_angle or 0.0
    teeth, shift = (pinion.teeth, gear.teeth), (pinion.profile_shift, gear.profile_shift)
    pressure = mesh.pressure_angle
    wheels = working_cylinders(teeth, module, helix, pressure, shift, mesh.centre_distance)
    faces = [wheel.face_width for wheel in (pinion, gear) if wheel.face_width]
    return ToothFit(
        teeth=teeth,
        module=module,
        helix_angle=helix,
        pressure_angle=pressure,
        shift=shift,
        centre_distance=sum(wheels.radii),
        face_width=min(faces, default=0.0),
    )


def fit_problems(pair: Pair) -> Iterator[SceneError]:
    """Yield problems of teeth that do not fit the centre distance, or have no root."""
    try:
        fit = fit_of(pair)
    except SceneError as error:
        yield from error.problems
        return
    if fit is None:
        return
    yield from _distance(pair, fit)
    for k, (side, wheel) in enumerate(pair.members.items()):
        y, root = wheel.scene.port.y, fit.roots[k]
        bore = min(s.radius_at(y)[0] for s in wheel.scene.segments if s.y0 <= y <= s.y1)
        if root <= bore:
            yield SceneError(
                f"puts the roots of its teeth at {_mm(root)} from the axis, inside the bore of "
                f"its shaft, {_mm(bore)}; correct the teeth, the module, the profile shift or the "
                "bore",
                path=(side, "teeth"),
            )


def _distance(pair: Pair, fit: ToothFit) -> Iterator[SceneError]:
    """Yield problems of the centre distance."""
    if pair.mesh.centre_distance is None:
        return
    path, teeth_label = ("mesh", "centre_distance"), f"{fit.teeth[0]} and {fit.teeth[1]} teeth of "
    teeth_label += f"{_mm(fit.module)} module with profile shifts that sum to {sum(fit.shift):.4g}"
    if fit.backlash < -THINNED * fit.module:
        yield SceneError(
            f"is too short: {teeth_label} overlap there by {_um(-fit.backlash)} along the line of "
            f"action; they have no backlash at {_mm(fit.tight)}; correct the distance, the teeth, "
            "the module, the helix angle or the profile shifts",
            path=path,
        )
    elif fit.contact_ratio <= 0:
        yield SceneError(
            f"is too long: {teeth_label} do not reach each other, for their tips lie at "
            f"{_mm(fit.tips[0])} and {_mm(fit.tips[1])}; correct the distance, the teeth, the "
            "module, the helix angle or the profile shifts",
            path=path,
        )


def fit_cautions(fit: ToothFit, sides: tuple[str, str]) -> Iterator[str]:
    """Yield cautions on wheels whose tips reach too far or not far enough; `sides` name the shafts."""
    for clearance, side, mate in zip(fit.clearances, sides, sides[::-1]):
        if clearance < 0:
            yield (
                f"tips of the {side} reach {_um(-clearance)} into the roots of the {mate}, "
                "with teeth of ISO 53: profile shifts and centre distance ask for shorter tips"
            )
    if fit.contact_ratio + fit.overlap_ratio < 1:
        helical = f" and {fit.overlap_ratio:.2f} by their helix" if fit.helix_angle else ""
        yield (
            f"the contact ratio is {fit.contact_ratio:.2f}{helical}, below 1: no teeth touch for a "
            "part of each pitch; correct centre distance, profile shifts, module or teeth"
        )


def wheel_cautions(fit: ToothFit, k: int, side: str) -> Iterator[str]:
    """Yield cautions on the teeth of wheel k on the shaft `side`."""
    if fit.undercut(k) > PASSED:
        yield (
            f"the {fit.teeth[k]} teeth of the {side} are undercut by their rack: without "
            f"undercut their profile shift is at least {fit.shift[k] + fit.undercut(k):.2f}"
        )
    if fit.tip_thickness(k) < 0:
        yield (
            f"teeth of the {side} end in a point before their tip circle: a profile shift of "
            f"{fit.shift[k]:g} is too much for {fit.teeth[k]} teeth"
        )


def backlash_cautions(fit: ToothFit, file_backlash: float | None) -> Iterator[str]:
    """Yield cautions on a backlash that is large, or contradicts that of the file, m."""
    gap, loose = fit.backlash, LOOSE * fit.module
    place = f"teeth without allowances leave {_um(gap)} along the line of action at"
    place += f" {_mm(abs(fit.centre_distance))}"
    if gap < -ROUNDED * fit.module:
        yield (
            f"teeth without allowances overlap by {_um(-gap)} along the line of action at "
            f"{_mm(fit.centre_distance)}: they need allowances larger than that; they have no "
            f"backlash at {_mm(fit.tight)}"
        )
    if gap > loose:
        yield (
            f"the backlash is large: {place}, which is {gap / fit.module:.2g} modules; check centre "
            "distance, profile shifts, module and teeth"
        )
    if file_backlash is None:
        return
    if file_backlash < gap - ROUNDED * fit.module:
        yield (
            f"backlash = {_um(file_backlash)} is less than the teeth have: {place}, and allowances only "
            "add to it; correct one of them"
        )
    elif file_backlash > max(gap, 0.0) + loose:
        yield (
            f"backlash = {_um(file_backlash)} is far more than the teeth have: {place}; correct one "
            "of them"
        )


def fit_line(fit: ToothFit) -> str:
    """Return the backlash and the contact ratio in a sentence."""
    ratio = f"{fit.contact_ratio:.3f}"
    if fit.overlap_ratio:
        ratio += f" and {fit.overlap_ratio:.3f} by their helix"
    return (
        f"axes {_mm(abs(fit.centre_distance))} apart: backlash of teeth without allowances "
        f"{_um(fit.backlash)} along the line of action, contact ratio {ratio}"
    )


def _mm(length: float) -> str:
    return f"{1e3 * length:.6g} mm"


def _um(length: float) -> str:
    if length >= 1e-3:
        return f"{1e3 * length:.4g} mm"
    return f"{round(1e6 * length, 1) + 0.0:.4g} um"
