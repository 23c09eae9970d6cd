"""Table 1 of the thesis as an inverse question."""

import math

import numpy as np
import pytest

from solidgear.bearings.roller import RollerRow
from validation.thesis.bearings import PAGE, PUBLISHED, REAL, demand, inverse, real_stiffness


def test_the_inverse_finds_the_row_that_made_a_matrix():
    row = RollerRow(22, 14e-3, 0.13, length=30e-3, angle=0.24, profile="straight", slices=400)
    stiffness = row.tangent(np.array([0, 20e-6, 0, 0, 0, 0]))
    found = inverse(stiffness[0, 0], stiffness[1, 1], stiffness[0, 5], stiffness[5, 5])
    assert found.angle == pytest.approx(0.24, rel=1e-12)
    assert found.pitch == pytest.approx(0.13, rel=1e-12)
    assert found.length == pytest.approx(30e-3, rel=1e-5)  # 400 slices: 1/n^2
    assert found.together == pytest.approx(22 * stiffness[1, 1] / 22 / math.sin(0.24) ** 2)
    # and the load that belongs to it
    load = demand(found, 0.09, 22)
    assert load.force == pytest.approx(row.load(np.array([0, 20e-6, 0, 0, 0, 0]))[1], rel=1e-4)


def test_bearings_1_and_3_are_beyond_any_preload_by_usual_proportions():
    shares = {name: demand(inverse(*row[:4]), row[4]).share for name, row in PUBLISHED.items()}
    assert shares["1"] > 5 and shares["3"] > 5
    assert shares["2"] < 1 and shares["4"] < 1


def test_real_bearings_of_that_seat_are_softer():
    # 1 to 5 % of the static rating is a preload in use: two to five times softer than Table 1
    for name in REAL:
        for share in (0.01, 0.05):
            assert 1.9 < PUBLISHED["1"][0] / real_stiffness(name, share)[0, 0] < 5.5


def test_the_page_says_what_the_numbers_say():
    text = PAGE.read_text()
    for name, (*entries, bore) in PUBLISHED.items():
        found, load = inverse(*entries), demand(inverse(*entries), bore)
        assert f"| {name} | {math.degrees(found.angle):.2f} | {1e3 * found.pitch:.1f} |" in text
        assert f"| {load.rating / 1e3:.0f} | {load.share:.3g} |" in text
