"""Blanks of a bevel pair, and how its cutters differ, from a train file."""

from __future__ import annotations

from dataclasses import replace

from solidgear.core.errors import SceneError
from solidgear.teeth.bevel.blank import BevelBlank, completed_blank
from solidgear.teeth.bevel.flank import Mismatch, lengthwise
from solidgear.trains.file.pairs import Pair

#: words of a table of one member, and what the other has
OTHER = {"left": "right", "right": "left", "concave": "convex", "convex": "concave"}


def blank_of(pair: Pair) -> BevelBlank:
    """Return the blanks of two bevel gears of a train, completed by estimates.

    Raises
    ------
    SceneError
        For parallel shafts, missing data and data that make no flank.

    Examples
    --------
    >>> import solidgear as sg
    >>> blank = blank_of(sg.load_train("geometry/axle_thesis.toml").pairs[0])
    >>> blank.hand, blank.loaded_side, blank.estimated
    ('left', 'concave', ('cutter_radius', 'gear_share', 'working_depth'))
    >>> len(blank.notes)
    1
    """
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    if not mesh.shaft_angle:
        raise SceneError("is 0, that of a cylindrical pair", path=("mesh", "shaft_angle"))
    hand = pinion.hand or OTHER.get(gear.hand or "")
    side = pinion.loaded_side or OTHER.get(gear.loaded_side or "")
    wanted = {
        "pitch_radius": pinion.pitch_radius,
        "face_width": pinion.face_width,
        "spiral_angle": pinion.spiral_angle,
        "hand": hand,
        "loaded_side": side,
    }
    missing = [
        SceneError("is needed for the flanks of bevel teeth", path=("pinion", key))
        for key, value in wanted.items()
        if value is None
    ]
    if missing:
        raise SceneError.of(missing)
    assert pinion.pitch_radius and pinion.face_width and hand and side
    assert pinion.spiral_angle is not None
    return completed_blank(
        (pinion.teeth, gear.teeth),
        pinion.pitch_radius,
        pinion.face_width,
        pinion.spiral_angle,
        hand,
        side,
        pressure_angle=mesh.pressure_angle,
        cutter_radius=gear.cutter_radius or pinion.cutter_radius,
        gear_share=mesh.gear_share,
        working_depth=mesh.working_depth,
        shaft_angle=mesh.shaft_angle,
        pitch_angles=(pinion.pitch_angle, gear.pitch_angle),
    )


def mismatch_of(pair: Pair, blank: BevelBlank) -> Mismatch | None:
    """Return how the cutters of a pair of a train differ; None where the file does not say.

    Examples
    --------
    >>> import solidgear as sg
    >>> pair = sg.load_train("geometry/axle_thesis.toml").pairs[0]
    >>> mismatch_of(pair, blank_of(pair)) is None
    True
    """
    pinion, gear, ease_off = pair.pinion, pair.gear, pair.mesh.ease_off
    blade = (pinion.blade_curvature or 0.0) - (gear.blade_curvature or 0.0)
    if pinion.cutter_radius is not None and gear.cutter_radius is not None:
        excess = blank.side * (pinion.cutter_radius - gear.cutter_radius)
        return Mismatch(excess, blade)
    if ease_off is not None:
        return replace(lengthwise(blank, ease_off), blade_curvature=blade)
    return None
