r"""Cylindrical gears by module, helix, profile shift and centre distance (ISO 21771).

At the centre distance both wheels roll on cylinders in the ratio of their teeth, where the working
pressure angle alpha_wt of the pair is, ``r_w = rb / cos alpha_wt`` and ``tan beta_w = tan beta_b / cos
alpha_wt`` (ISO 21771:2007, 5.3 and 5.4).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import atan, cos, isclose, tan
from typing import TYPE_CHECKING, Any

from solidgear.core import SceneError
from solidgear.core.gears.wheel import Rack, Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.core.scene.units import TYPED
from solidgear.trains.file.flanks import Flanks

if TYPE_CHECKING:
    from solidgear.trains.file.gears import Member
    from solidgear.trains.file.tables import Mesh

#: relative difference of a pitch radius that is typed with three digits
RADIUS = 5e-3
#: keys of cylindrical gears, by table
WORDS = {
    "pinion": ("module", "helix_angle", "profile_shift", "angle", *Flanks.model_fields),
    "gear": ("module", "helix_angle", "profile_shift", "angle", *Flanks.model_fields),
    "mesh": ("centre_distance",),
}
#: keys of bevel gears alone, by table
BEVEL_WORDS = {
    "pinion": ("cutter_radius", "blade_curvature"),
    "gear": ("cutter_radius", "blade_curvature"),
    "mesh": ("ease_off", "gear_share", "working_depth"),
}


@dataclass(frozen=True)
class Working:
    """Working pitch cylinders of two cylindrical gears."""

    radii: tuple[float, float]  #: of pinion and gear, m
    #: helix_angle, pressure_angle: at these cylinders, the latter normal to the tooth, rad
    helix_angle: float
    pressure_angle: float
    without_backlash: float  #: centre distance without backlash, m


def working_cylinders(
    teeth: Sequence[int],
    module: float,
    helix_angle: float,
    pressure_angle: float,
    shift: Sequence[float] = (0.0, 0.0),
    centre_distance: float | None = None,
) -> Working:
    """Compute the working cylinders of a pair of cylindrical gears.

    Parameters
    ----------
    teeth : (int, int)
    module : float
        Normal, m.
    helix_angle, pressure_angle : float
        At the reference cylinder, the latter normal to the tooth, rad.
    shift : (float, float)
        Profile shifts x, in modules.
    centre_distance : float, optional
        m; by default that without backlash.

    Raises
    ------
    SceneError
        For a centre distance below that at which the base circles leave no pressure angle, or
        profile shifts that no pressure angle has.

    Examples
    --------
    The spur gears of the Gear Technical Reference of Kohara (2015), table 4.3: 26.0886 degrees at
    56.4999 mm.

    >>> from math import degrees, radians
    >>> wheels = working_cylinders((12, 24), 3e-3, 0.0, radians(20), shift=(0.6, 0.36))
    >>> round(degrees(wheels.pressure_angle), 4), round(1e3 * sum(wheels.radii), 4)
    (26.0886, 56.4999)
    """
    rack = Rack(pressure_angle)
    first, second = (Wheel(count, module, helix_angle, x, rack) for count, x in zip(teeth, shift))
    pair = WheelPair(first, second, centre_distance)
    radii = first.base / cos(pair.working_angle), second.base / cos(pair.working_angle)
    helix = atan(tan(pair.base_helix) / cos(pair.working_angle))
    return Working(radii, helix, atan(tan(pair.working_angle) * cos(helix)), pair.tight)


def cylindrical_problems(pinion: Member, gear: Member, mesh: Mesh) -> Iterator[SceneError]:
    """Yield problems between keys of cylindrical gears, and with those of bevel gears."""
    tables = {"pinion": pinion, "gear": gear, "mesh": mesh}
    if mesh.shaft_angle:
        for table, keys in WORDS.items():
            for key in keys:
                if getattr(tables[table], key):
                    yield SceneError(
                        "is for parallel shafts; write shaft_angle = 0 under [mesh], or the "
                        "pitch_radius and spiral_angle of a bevel gear",
                        path=(table, key),
                    )
        radii = pinion.cutter_radius, gear.cutter_radius
        if mesh.ease_off is not None and None not in radii:
            yield SceneError(
                "follows from the cutter_radius of both gears; leave one of the three out",
                path=("mesh", "ease_off"),
            )
        return
    for table, keys in BEVEL_WORDS.items():
        for key in keys:
            if getattr(tables[table], key) is not None:
                yield SceneError("is for bevel gears; these shafts are parallel", path=(table, key))
    for side, member in (("pinion", pinion), ("gear", gear)):
        for key, bevel_key in (("helix_angle", "spiral_angle"), ("module", "pitch_radius")):
            if getattr(member, key) is not None and getattr(member, bevel_key) is not None:
                reason = f"and {bevel_key} say the same; for a cylindrical gear write {key} alone"
                yield SceneError(reason, path=(side, key))
    for key in ("module", "helix_angle"):
        first, second = getattr(pinion, key), getattr(gear, key)
        if None not in (first, second) and not isclose(first, second, rel_tol=TYPED, abs_tol=1e-9):
            reason = (
                f"is {second:.6g}, but the pinion's is {first:.6g} (SI); write one value for both "
                "wheels"
            )
            yield SceneError(reason, path=("gear", key))
    distance = mesh.centre_distance
    for side, member in (("pinion", pinion), ("gear", gear)):
        due = (distance or 0.0) * member.teeth / (pinion.teeth + gear.teeth)
        if (
            distance
            and member.pitch_radius
            and not isclose(member.pitch_radius, due, rel_tol=RADIUS)
        ):
            reason = (
                f"and centre_distance contradict: wheels of {pinion.teeth} and {gear.teeth} teeth "
                f"{1e3 * distance:.6g} mm apart roll at {1e3 * due:.6g} mm; correct or leave out one"
            )
            yield SceneError(reason, path=(side, "pitch_radius"))
    shifted = [
        side for side, member in (("pinion", pinion), ("gear", gear)) if member.profile_shift
    ]
    if shifted and pinion.module is None and gear.module is None:
        yield SceneError("counts in modules; give the module", path=(shifted[0], "profile_shift"))


def rolling_fields(pinion: Member, gear: Member, mesh: Mesh) -> dict[str, Any]:
    """Return `pinion`, `gear` and `mesh` of parallel shafts with pitch radii and angles as bevel gears
    have them, where the wheels roll on each other; nothing for other shafts.
    """
    if mesh.shaft_angle:
        return {}
    wheels = pinion, gear
    helix = first_given(*(w.helix_angle for w in wheels), *(w.spiral_angle for w in wheels))
    if helix is None and not any(w.hand for w in wheels):
        helix = 0.0  # straight teeth have no hand
    angle, radii = helix, (pinion.pitch_radius, gear.pitch_radius)
    pressure, module = mesh.pressure_angle, first_given(pinion.module, gear.module)
    if module is not None and pressure is not None:
        shift = pinion.profile_shift, gear.profile_shift
        teeth = pinion.teeth, gear.teeth
        cylinders = working_cylinders(
            teeth, module, helix or 0.0, pressure, shift, mesh.centre_distance
        )
        radii, pressure = cylinders.radii, cylinders.pressure_angle
        angle = None if helix is None else cylinders.helix_angle
    elif mesh.centre_distance is not None:
        share = mesh.centre_distance / (pinion.teeth + gear.teeth)
        radii = radii[0] or share * pinion.teeth, radii[1] or share * gear.teeth
    cones = [w.pitch_angle for w in wheels]
    if cones == [None, None]:
        cones = [0.0, 0.0]
    plain = {"module": None, "helix_angle": None, "profile_shift": 0.0}
    changed = [
        w.with_changes(
            **plain,
            pitch_radius=radius,
            spiral_angle=angle if w.spiral_angle is None else w.spiral_angle,
            pitch_angle=cone,
        )
        for w, radius, cone in zip(wheels, radii, cones)
    ]
    working_mesh = mesh.with_changes(pressure_angle=pressure, centre_distance=None)
    return {"pinion": changed[0], "gear": changed[1], "mesh": working_mesh}


def first_given(*values: float | None) -> float | None:
    """Return the first value that is given."""
    return next((value for value in values if value is not None), None)
