"""Spiral bevel flanks in closed form beside real flanks, real rotations and rules of spur teeth."""

from dataclasses import replace
from math import cos, pi, radians, sin

import numpy as np
import pytest

from solidgear.core.errors import SceneError
from solidgear.core.gears.wheel import Rack, Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.core.system.gear_mesh import line_of_action
from solidgear.teeth.bevel.blank import BevelBlank, completed_blank
from solidgear.teeth.bevel.flank import BevelFlanks, Mismatch, lengthwise
from solidgear.teeth.bevel.misalignment import Misalignment
from tests.bevel_flanks import RealFlank, cone_angle, distance

#: Hua (2010), table 1, with assumed pressure angle, cutter and addendum
BLANK = BevelBlank(
    (14, 45), 0.067, 0.063, 0.478, "left", "concave", radians(22.5), 0.1524, gear_share=0.27
)
KINDS = [(hand, side) for hand in ("left", "right") for side in ("concave", "convex")]


def of_kind(hand, side):
    return replace(BLANK, hand=hand, loaded_side=side)


def on_line(flanks, pitches, count):
    """Some points of a contact line that lie on the flanks, one after another."""
    blank, roll = flanks.blank, pitches * flanks.pitch
    points = flanks.line(np.linspace(blank.toe_distance, blank.heel_distance, 40), roll)
    inside = np.flatnonzero(np.all(flanks.room(points) >= 0, axis=0))
    return flanks.points(np.linspace(*points.place[inside[[0, -1]]], count), roll)


def real_gaps(flanks, points):
    """Distances between the real flanks at points of contact lines, m."""
    gaps = []
    for k in range(len(points.place)):
        theta = cone_angle(flanks.gear_cutter, points.point[k], points.roll[k])
        gaps.append(distance(flanks, theta, points.height[k], points.roll[k], points.normal[k])[0])
    return np.array(gaps)


# ---------------------------------------------------------------- flanks
@pytest.mark.parametrize("hand, side", KINDS)
def test_the_normal_at_the_mean_point_is_the_line_of_action_of_force_formulas(hand, side):
    flanks = BevelFlanks(of_kind(hand, side))
    point = flanks.points(flanks.blank.mean_distance, 0.0)
    angles = flanks.blank.pitch_angles[0], flanks.blank.spiral_angle, flanks.blank.pressure_angle
    expected = line_of_action(*angles, hand, side)
    assert flanks.pinion_frame @ point.normal == pytest.approx(expected, abs=1e-14)
    radius = 0.067 * flanks.blank.mean_distance / flanks.blank.heel_distance
    place = flanks.pinion_frame @ point.point
    assert place == pytest.approx([-radius, radius * 45 / 14, 0.0], abs=1e-15)
    # a force turns the pinion about +y by what its z does at -x
    assert np.sign(point.lever) == flanks.turn == np.sign(expected[2])
    assert point.lever == pytest.approx(radius * expected[2], rel=1e-12)


@pytest.mark.parametrize("hand, side", KINDS[:3])
def test_real_flanks_of_one_cone_touch_along_the_line(hand, side):
    flanks = BevelFlanks(of_kind(hand, side))
    assert np.abs(real_gaps(flanks, on_line(flanks, -0.6, 4))).max() < 1e-13
    points = on_line(flanks, 0.3, 30)
    assert np.abs(flanks.gap(points)).max() < 1e-15


@pytest.mark.parametrize("side", ["concave", "convex"])
def test_the_gap_by_mismatch_is_that_of_real_flanks(side):
    """To the first order: within 0.05 um of up to 300 um."""
    mismatch = Mismatch(12e-3, blade_curvature=0.05, spiral_angle=1e-3)
    flanks = BevelFlanks(of_kind("left", side), mismatch)
    points = on_line(flanks, -0.5, 5)
    gap = flanks.gap(points)
    assert gap.max() > 150e-6
    assert real_gaps(flanks, points) == pytest.approx(gap, abs=5e-8)


@pytest.mark.parametrize("side", ["concave", "convex"])
def test_the_relative_curvature_is_that_of_real_flanks(side):
    """The gap grows from the line with the square of the distance: its part that is even."""
    flanks = BevelFlanks(of_kind("right", side))
    points = on_line(flanks, 0.4, 30)
    for k in (3, 15, 26):
        theta = cone_angle(flanks.gear_cutter, points.point[k], points.roll[k])
        along = points.point[k + 1] - points.point[k - 1]
        across = np.cross(along / np.linalg.norm(along), points.normal[k])
        curved = []
        for step in (-2e-4, 2e-4):
            gap, point = distance(
                flanks, theta, points.height[k] + step, points.roll[k], points.normal[k]
            )
            curved.append(2 * gap / ((point - points.point[k]) @ across) ** 2)
        assert np.mean(curved) == pytest.approx(1 / points.radius[k], rel=3e-3)
    assert points.speeds[0].min() < 0.9  # where sliding counts


def test_a_line_runs_along_its_points():
    flanks = BevelFlanks(BLANK)
    step = 1e-4
    points = flanks.points(np.array([-1, 0, 1]) * step + 0.2, -0.7 * flanks.pitch)
    way = (points.point[2] - points.point[0]) / (2 * step)
    assert points.along[1] == pytest.approx(way, abs=1e-6)
    assert points.stretch[1] == pytest.approx(np.linalg.norm(way), rel=1e-6)


def test_a_mirrored_pair_is_the_mirrored_pair():
    flanks = [
        BevelFlanks(of_kind(hand, "concave"), Mismatch(4e-3, 0.02, 1e-3))
        for hand in ("left", "right")
    ]
    place = np.linspace(0.16, 0.23, 21)
    left, right = flanks[0].points(place, 0.05), flanks[1].points(place, -0.05)
    mirror = np.array([1.0, -1.0, 1.0])
    assert right.point * mirror == pytest.approx(left.point, abs=1e-15)
    assert right.normal * mirror == pytest.approx(left.normal, abs=1e-14)
    assert -right.lever == pytest.approx(left.lever, rel=1e-12)
    assert right.radius == pytest.approx(left.radius, rel=1e-11)
    assert flanks[1].gap(right) == pytest.approx(flanks[0].gap(left), rel=1e-11, abs=1e-15)
    assert flanks[0].contact_ratio == pytest.approx(flanks[1].contact_ratio, rel=1e-11)


def opened(flanks, points, misalignment):
    """What a misalignment opens at points: motion of the pinion along the normals."""
    point, normal = (vector @ flanks.pinion_frame.T for vector in (points.point, points.normal))
    rows = np.hstack([normal, np.cross(point, normal)])
    return rows @ misalignment.motion(flanks.blank.shaft_angle)


class Moved(RealFlank):
    """The pinion's real flank, moved as a rigid body."""

    motion = None

    def at(self, theta, z, position, near):
        point, normal = super().at(theta, z, position, near)
        return (self.motion(point), normal) if self.axis[2] > 0 else (point, normal)


@pytest.mark.parametrize(
    "name, size", [("offset", 50e-6), ("pinion_axial", 50e-6), ("shaft_angle", 2e-4)]
)
def test_a_misalignment_opens_what_it_moves_real_flanks_by(monkeypatch, name, size):
    flanks = BevelFlanks(BLANK)
    y = np.array([0.0, 1.0, 0.0])
    axis = flanks.axes[0]
    motions = {
        "offset": lambda point: point + size * y,
        "pinion_axial": lambda point: point + size * axis,
        "shaft_angle": lambda point: point - size * np.cross(y, point),
    }
    monkeypatch.setattr(Moved, "motion", staticmethod(motions[name]))
    monkeypatch.setattr("tests.bevel_flanks.RealFlank", Moved)
    points = on_line(flanks, -0.2, 3)
    opening = opened(flanks, points, Misalignment(**{name: size}))
    assert np.abs(opening).max() > 10e-6
    assert real_gaps(flanks, points) == pytest.approx(opening, abs=0.02 * np.abs(opening).max())
    # E along +z, P away from the apex, a larger angle between the axes
    turned = axis - 1e-6 * np.cross(y, axis)
    assert turned @ flanks.axes[1] < axis @ flanks.axes[1]
    assert flanks.pinion_frame @ y == pytest.approx([0, 0, 1])


def test_both_axial_motions_make_up_one_along_the_pitch_line():
    flanks = BevelFlanks(BLANK)
    points = on_line(flanks, 0.1, 5)
    pinion, gear = BLANK.pitch_angles
    ease = Misalignment(pinion_axial=sin(gear), gear_axial=-sin(pinion))
    # the axes times sin dg and sin dp make up e, and the gear's motion counts the other way
    moved = opened(flanks, points, ease)
    assert moved == pytest.approx(points.normal[:, 0], rel=1e-12)


# ---------------------------------------------------------------- extent
def test_straight_narrow_teeth_have_the_contact_ratio_of_their_virtual_spur_wheels():
    """Tredgold: the back cone unrolled, exact for narrow faces far from the apex."""
    blank = BevelBlank((30, 40), 0.3, 2e-3, 0.0, "left", "concave", radians(20), 9.0, 0.4)
    flanks = BevelFlanks(blank)
    rack = Rack(radians(20))
    wheels = [
        Wheel(teeth / cos(angle), blank.module, shift=shift, rack=rack)
        for teeth, angle, shift in zip(blank.teeth, blank.pitch_angles, (0.2, -0.2))
    ]
    assert wheels[0].tip - wheels[0].radius == pytest.approx(blank.addenda[0], rel=1e-9)
    distance = wheels[0].radius + wheels[1].radius
    spur = WheelPair(wheels[0], wheels[1], distance).contact_ratio
    assert flanks.contact_ratio == pytest.approx(spur, rel=5e-3)


@pytest.mark.parametrize("share, fails", [(0.97, False), (1.03, True)])
def test_undercut_begins_where_it_does_on_the_virtual_spur_wheels(share, fails):
    """The tip of the second wheel may reach the point where the line of action leaves the first base
    circle, and no further.
    """
    teeth, angle = (12, 40), radians(20)
    pinion = np.arctan2(*teeth)
    radii = np.array(teeth) / (2 * np.array([cos(pinion), sin(pinion)]))  # modules
    furthest = np.hypot(radii[1] * cos(angle), radii.sum() * sin(angle)) - radii[1]
    blank = BevelBlank(teeth, 0.05, 2e-3, 0.0, "left", "concave", angle, 2.0, share * furthest / 2)
    flanks = BevelFlanks(blank)
    if fails:
        with pytest.raises(SceneError, match="leaves the pinion undercut within its flank"):
            flanks.refuse_undercut()
    else:
        flanks.refuse_undercut()


def test_teeth_on_the_far_side_of_the_axis_do_not_touch():
    """Few crown teeth: a contact line comes back after half a turn, where it would pull."""
    blank = BevelBlank((14, 14), 0.096, 0.0187, 1.0, "right", "concave", 0.284, 1.0, 0.56)
    flanks = BevelFlanks(blank)
    first, last = flanks.rolls
    assert -2 < first / flanks.pitch < 0 < last / flanks.pitch < 2
    points, on_flank = flanks.surface
    assert np.all(flanks.turn * points.lever[on_flank] > 0)


@pytest.mark.parametrize("ease_off", [50e-6, 300e-6])
def test_the_ease_off_wanted_is_that_of_the_flanks(ease_off):
    mismatch = lengthwise(BLANK, ease_off)
    assert BevelFlanks(BLANK, mismatch).ease_off() == pytest.approx(ease_off, rel=1e-2)
    convex = of_kind("left", "convex")
    mismatch = lengthwise(convex, ease_off)
    assert mismatch.cutter_radius > 0
    assert BevelFlanks(convex, mismatch).ease_off() == pytest.approx(ease_off, rel=1e-2)


# ---------------------------------------------------------------- blanks
def test_the_blank_of_table_1():
    """Both pitch cones share the apex and the heel's cone distance."""
    pinion, gear = BLANK.pitch_angles
    assert pinion + gear == pytest.approx(pi / 2)
    assert BLANK.heel_distance * sin(gear) == pytest.approx(0.067 * 45 / 14, rel=1e-12)
    assert BLANK.module == pytest.approx(
        2 * 0.067 / 14 * cos(0.478) * 0.194038 / 0.225538, rel=1e-5
    )
    assert sum(BLANK.addenda) == pytest.approx(2 * BLANK.module)
    first, second = BLANK.virtual_wheels(0.07)
    assert (first.teeth, second.teeth) == (21, 216)
    assert first.tip - first.radius == pytest.approx(BLANK.addenda[0])
    assert second.tip - second.radius == pytest.approx(BLANK.addenda[1])


def test_what_a_file_leaves_out_is_estimated_and_named():
    blank = completed_blank((14, 45), 0.067, 0.063, 0.478, "left", pressure_angle=radians(22.5))
    assert blank.estimated == ("cutter_radius", "gear_share", "working_depth")
    assert blank.cutter_radius == pytest.approx(blank.mean_distance)
    assert blank.pressure_angle == radians(22.5)


def test_published_pitch_angles_that_are_not_those_of_the_teeth_are_noted():
    sizes = (14, 45), 0.067, 0.063, 0.478, "left"
    blank = completed_blank(*sizes, pitch_angles=(0.391, 1.282))
    assert blank.pitch_angles[0] == pytest.approx(0.3016, abs=5e-5)
    (note,) = blank.notes
    assert "0.391 rad of the pinion (0.3016)" in note and "95.9 degrees in all" in note
    assert completed_blank(*sizes, pitch_angles=(0.302, 1.269)).notes == ()


REFUSED = {
    "is longer than the cone": {"face": 0.23},
    "of 45 mm does not reach across the face: its circle misses the heel": {"cutter_radius": 0.045},
    "straight teeth have no cutter circle": {"cutter_radius": float("inf")},
    "between 0 and 180 degrees": {"shaft_angle": 0.0},
    "makes the gear an internal one": {"shaft_angle": radians(170), "teeth": (14, 20)},
    "give 0 to 69": {"spiral_angle": 1.3},
    "cutters have 10 to 35": {"pressure_angle": 0.7},
    "must be left or right": {"hand": "both"},
    "must be concave or convex": {"loaded_side": "left"},
    "no bevel gear has below 3": {"teeth": (2, 45)},
    "give a length above zero": {"pitch_radius": -1.0},
    "must lie between 0 and 1": {"gear_share": 1.0},
    "2 is usual": {"working_depth": 4.0},
}


@pytest.mark.parametrize("words", REFUSED)
def test_data_that_make_no_flank_are_refused(words):
    with pytest.raises(SceneError, match=words) as refused:
        replace(BLANK, **REFUSED[words])
    assert len(refused.value.problems) == 1
    assert str(refused.value).count(". ") <= 1


def test_teeth_that_part_before_the_next_ones_touch_are_refused():
    flanks = BevelFlanks(replace(BLANK, working_depth=0.7, face=4e-3))
    with pytest.raises(SceneError, match="teeth part before the next ones touch"):
        flanks.refuse_undercut()


@pytest.mark.parametrize("key", ["offset", "tilt", "modified_roll", "face_hobbing"])
def test_other_ways_of_cutting_are_refused(key):
    sizes = (14, 45), 0.067, 0.063, 0.478, "left"
    with pytest.raises(SceneError, match=key):
        completed_blank(*sizes, settings={key: True})
    assert completed_blank(*sizes, settings={key: 0.0}).teeth == (14, 45)
