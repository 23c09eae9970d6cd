"""Changing the reference point of motions, loads and stiffnesses, against vector algebra written
out by hand.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from solidgear.core.frames import cross_matrix, rotation, shift

# Every identity here is a handful of products of numbers of order one: 1e-14 is fifty roundings.
ROUNDING = 1e-14


@pytest.fixture
def rng():
    return np.random.default_rng(7)


def test_cross_matrix_is_the_cross_product(rng):
    r, v = rng.standard_normal((2, 3))
    assert np.allclose(cross_matrix(r) @ v, np.cross(r, v), rtol=0, atol=ROUNDING)


def test_shifted_motion_is_that_of_a_rigid_body(rng):
    offset, translation, turn = rng.standard_normal((3, 3))
    moved = shift(offset) @ np.concatenate([translation, turn])
    assert np.allclose(moved[:3], translation + np.cross(turn, offset), rtol=0, atol=ROUNDING)
    assert np.array_equal(moved[3:], turn)


def test_signs_along_the_shaft_are_those_of_the_house():
    # A tilt thx lifts what lies further along y in +z, a tilt thz pushes it to -x.
    t = shift((0.0, 2.0, 0.0))
    assert t[2, 3] == 2.0
    assert t[0, 5] == -2.0


def test_shifts_form_a_commutative_group(rng):
    a, b = rng.standard_normal((2, 3))
    assert np.allclose(shift(a) @ shift(b), shift(a + b), rtol=0, atol=ROUNDING)
    assert np.allclose(shift(a) @ shift(b), shift(b) @ shift(a), rtol=0, atol=ROUNDING)
    assert np.allclose(np.linalg.inv(shift(a)), shift(-a), rtol=0, atol=ROUNDING)


def test_load_moves_by_the_transpose(rng):
    # A force at the new point is the same force at the old one, plus its moment about the old
    # point.
    offset, force, moment = rng.standard_normal((3, 3))
    old = shift(offset).T @ np.concatenate([force, moment])
    assert np.allclose(old[:3], force, rtol=0, atol=ROUNDING)
    assert np.allclose(old[3:], moment + np.cross(offset, force), rtol=0, atol=ROUNDING)


def test_power_does_not_depend_on_the_reference_point(rng):
    offset = rng.standard_normal(3)
    motion, load_new = rng.standard_normal((2, 6))
    t = shift(offset)
    assert (t @ motion) @ load_new == pytest.approx(
        motion @ (t.T @ load_new), rel=1e-13
    )  # two sums of a dozen products


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_rotation_is_right_handed(axis):
    # scipy's rotations are the independent reference
    expected = Rotation.from_rotvec(0.7 * np.eye(3)[axis]).as_matrix()
    q = rotation(axis, 0.7)
    assert np.allclose(q[:3, :3], expected, rtol=0, atol=ROUNDING)
    assert np.allclose(q[3:, 3:], expected, rtol=0, atol=ROUNDING)
    assert not q[:3, 3:].any() and not q[3:, :3].any()


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_rotation_is_orthogonal_and_adds_up(axis):
    assert np.allclose(
        rotation(axis, 0.4) @ rotation(axis, 0.4).T, np.eye(6), rtol=0, atol=ROUNDING
    )
    assert np.allclose(
        rotation(axis, 0.4) @ rotation(axis, 0.5), rotation(axis, 0.9), rtol=0, atol=ROUNDING
    )


def test_rotating_and_shifting_exchange(rng):
    # Turning the body and the offset together is turning the result.
    offset, q = rng.standard_normal(3), rotation(1, 0.6)
    assert np.allclose(q @ shift(offset) @ q.T, shift(q[:3, :3] @ offset), rtol=0, atol=ROUNDING)
