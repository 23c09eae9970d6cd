"""Modified flanks beside figures worked out by hand and shapes that are built another way."""

from math import cos, radians

import numpy as np
import pytest

from solidgear.core.gears.flank_shape import FlankGrid, FlankShape, Relief

TIP, ROOT = Relief(10e-6, 20e-3, 25e-3), Relief(4e-6, 8e-3, 6e-3)
GRID = FlankGrid((-5e-3, 5e-3), (10e-3, 20e-3), ((1e-6, 3e-6), (5e-6, 11e-6)))


def test_relief_grows_evenly_from_its_start_to_the_end_of_the_profile():
    shape = FlankShape(tip=TIP, root=ROOT)
    s = np.array([5e-3, 6e-3, 7e-3, 8e-3, 15e-3, 20e-3, 22.5e-3, 25e-3, 26e-3])
    due = np.array([4, 4, 2, 0, 0, 0, 5, 10, 10]) * 1e-6
    assert shape.deviation(s, 0.0) == pytest.approx(due, abs=1e-18)


def test_crowning_is_missing_at_both_ends_and_a_slope_at_the_far_one():
    z = np.array([-8e-3, 2e-3, 12e-3])  # both ends and the middle of a face that lies off
    crowned = FlankShape(face_width=20e-3, middle=2e-3, crowning=6e-6)
    sloped = FlankShape(face_width=20e-3, middle=2e-3, slope=6e-6)
    assert crowned.deviation(15e-3, z) == pytest.approx([6e-6, 0.0, 6e-6], abs=1e-18)
    assert sloped.deviation(15e-3, z) == pytest.approx([-3e-6, 0.0, 3e-6], abs=1e-18)
    # a parabola: a quarter at half way
    assert crowned.deviation(15e-3, 7e-3) == pytest.approx(1.5e-6, rel=1e-12)


def test_a_grid_is_linear_between_its_places_and_constant_beyond():
    shape = FlankShape(face_width=10e-3, middle=1e-3, grid=GRID)
    assert shape.deviation([15e-3], [1e-3]) == pytest.approx((1 + 3 + 5 + 11) / 4 * 1e-6)
    assert shape.deviation([30e-3], [9e-3]) == pytest.approx(11e-6)


def test_what_is_missing_adds_up_and_is_narrower_normal_to_a_helix():
    parts = {"tip": TIP, "crowning": 5e-6, "slope": -7e-6, "grid": GRID}
    s, z = np.linspace(5e-3, 26e-3, 7), np.linspace(-6e-3, 7e-3, 7)
    helix = radians(14)
    shape = FlankShape(base_helix=helix, face_width=12e-3, **parts)
    by_part = [FlankShape(face_width=12e-3, **{key: parts[key]}).deviation(s, z) for key in parts]
    assert shape.deviation(s, z) == pytest.approx(cos(helix) * sum(by_part), rel=1e-12)


def test_seen_from_the_other_end_a_flank_is_the_same():
    shape = FlankShape(0.2, 12e-3, 1e-3, TIP, ROOT, 5e-6, -7e-6, GRID)
    s, z = np.linspace(5e-3, 26e-3, 9), np.linspace(-6e-3, 7e-3, 9)
    turned = shape.reversed()
    assert turned.deviation(s, -z) == pytest.approx(shape.deviation(s, z), rel=1e-12)
    assert np.abs(turned.deviation(s, z) - shape.deviation(s, z)).max() > 1e-6
    assert turned.reversed() == shape


def test_only_an_involute_is_an_involute():
    assert FlankShape(face_width=1e-2, tip=Relief(0.0, 1e-2, 2e-2)).is_involute
    parts = {"tip": TIP, "root": ROOT, "crowning": 1e-6, "slope": 1e-6, "grid": GRID}
    for key, value in parts.items():
        assert not FlankShape(face_width=1e-2, **{key: value}).is_involute
