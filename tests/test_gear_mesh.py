"""Line of action, mesh point and mesh vector: textbook force identities and vector algebra."""

import itertools

import numpy as np
import pytest

from solidgear.core.errors import SolidgearError
from solidgear.core.system.gear_mesh import (
    MeshVector,
    line_of_action,
    mean_radius,
    mesh_point,
    to_gear_frame,
)

# A dozen products of numbers of order one.
ROUNDING = 1e-14
HANDS, SIDES, MEMBERS = ("left", "right"), ("concave", "convex"), ("pinion", "gear")
ALL = list(itertools.product(HANDS, SIDES, MEMBERS))
PITCH, SPIRAL, PRESSURE = 0.391, 0.478, np.radians(25.0)


def parts(n, member):
    """Axial, towards the axis, and in the direction of growing rotation about +y."""
    side = -1.0 if member == "pinion" else 1.0
    return n[1], -side * n[0], -side * n[2]


def test_pinion_of_the_thesis():
    # Left hand, concave side loaded. The reference is given to two digits: half a unit of the last
    # one, and a bit.
    n = line_of_action(PITCH, SPIRAL, PRESSURE, "left", "concave")
    assert np.allclose(n, [0.23, 0.55, 0.81], rtol=0, atol=0.0055)


@pytest.mark.parametrize("hand, side, member", ALL)
def test_components_are_the_textbook_ones(hand, side, member):
    # Axial and radial thrust per unit of tangential load, as printed in gear handbooks; the two
    # flanks differ in a sign.
    n = line_of_action(PITCH, SPIRAL, PRESSURE, hand, side, member)
    axial, inward, tangential = parts(n, member)
    sign = 1 if side == "concave" else -1
    tan, sin, cos = np.tan(PRESSURE), np.sin(PITCH), np.cos(PITCH)
    assert axial / abs(tangential) == pytest.approx(
        (tan * sin + sign * np.sin(SPIRAL) * cos) / np.cos(SPIRAL), rel=1e-13
    )
    assert inward / abs(tangential) == pytest.approx(
        (tan * cos - sign * np.sin(SPIRAL) * sin) / np.cos(SPIRAL), rel=1e-13
    )
    assert (tangential > 0) == ((hand, side) in {("left", "concave"), ("right", "convex")})


@pytest.mark.parametrize("pitch", [0.302, 0.391, np.pi / 4])
@pytest.mark.parametrize("hand, side", list(itertools.product(HANDS, SIDES)))
def test_gear_feels_the_opposite_of_the_pinion(pitch, hand, side):
    # Two independent evaluations of the formulas, tied by Newton's third law in a common frame.
    shaft_angle = np.pi / 2 if pitch != 0.391 else 0.391 + 1.282
    other_hand, other_side = HANDS[hand == "left"], SIDES[side == "concave"]
    pinion = line_of_action(pitch, SPIRAL, PRESSURE, hand, side)
    gear = line_of_action(shaft_angle - pitch, SPIRAL, PRESSURE, other_hand, other_side, "gear")
    assert np.allclose(to_gear_frame(pinion, shaft_angle), -gear, rtol=0, atol=ROUNDING)


def test_both_mesh_points_are_one_point():
    r_p, r_g = 0.0577, 0.1853
    pinion = mesh_point(r_p, axial=r_g, height=0.01)
    gear = mesh_point(np.hypot(pinion[1], 0.01), axial=-pinion[0], height=0.01, member="gear")
    # From the apex, with axes that cross at 90 degrees, and exactly so because the frames are
    # turned by 90 degrees.
    assert np.allclose(to_gear_frame(pinion), gear, rtol=0, atol=ROUNDING)


def test_lever_is_radius_times_tangential_component():
    n = line_of_action(PITCH, SPIRAL, PRESSURE, "left", "concave")
    pinion = MeshVector(n, mesh_point(0.06))
    gear = MeshVector(to_gear_frame(n), mesh_point(0.18, member="gear"))
    assert pinion.lever == pytest.approx(0.06 * n[2], rel=1e-14)
    # Meshing gears turn in opposite senses about axes that both point away from the apex.
    assert gear.lever == pytest.approx(-0.18 * n[2], rel=1e-14)


def test_mesh_vector_is_the_rows_of_equation_22():
    n, (x, y, z) = np.array([2.0, 3.0, 6.0]) / 7, (0.3, -0.5, 0.7)
    want = [*n, y * n[2] - z * n[1], z * n[0] - x * n[2], x * n[1] - y * n[0]]
    assert np.allclose(MeshVector(n, [x, y, z]).vector, want, rtol=0, atol=ROUNDING)


def test_mean_radius():
    assert mean_radius(0.067, 0.391, 0.063) == pytest.approx(0.067 - 0.0315 * 0.38111, abs=1e-6)


def test_a_mesh_vector_cannot_be_changed_afterwards():
    with pytest.raises(ValueError):
        MeshVector([0, 1, 0], [0, 0, 0]).normal[0] = 2.0


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: MeshVector([0, 1, 2e-3], [0, 0, 0]), "unit vector"),
        (lambda: MeshVector([0, 1], [0, 0, 0]), "three components"),
        (lambda: line_of_action(2.0, 0.4, 0.4, "left", "concave"), "pitch_angle is 2.0 rad"),
        (lambda: line_of_action(0.4, 0.4, 0.4, "Left", "concave"), "write 'right' or 'left'"),
        (
            lambda: line_of_action(0.4, 0.4, 0.4, "left", "concave", "wheel"),
            "write 'pinion' or 'gear'",
        ),
        (lambda: mesh_point(0.0), "mean_radius > |height|"),
        (lambda: mesh_point(0.05, height=0.05), "mean_radius > |height|"),
        (lambda: mean_radius(0.01, 0.4, 0.063), "past the apex"),
    ],
)
def test_bad_input_is_one_sentence(make, words):
    with pytest.raises(SolidgearError) as caught:
        make()
    text = str(caught.value)
    assert words in text
    assert "\n" not in text and len(text) < 200
