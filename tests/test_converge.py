"""Grid convergence index on sequences whose limit is known, and the exponents of the corners that
cap its order.
"""

import math
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.judge.convergence import gci
from solidgear.meshing.corners import corner_exponent, sharpest_corner
from solidgear.scene import Scene, Segment

GEOMETRY = Path(__file__).parent.parent / "geometry"
# (coarse, middle, fine); all but the first with two different ratios
SIZES = [(4.0, 2.0, 1.0), (1.0, 0.6, 0.4), (1.0, 0.7, 0.35), (3e-3, 2.2e-3, 1.4e-3)]
LIMIT = 2.5


def manufactured(order, sizes, limit=LIMIT, share=0.05):
    """Values with the error ``share * limit`` at size 1 (of the coarsest), falling with ``order``."""
    return [limit * (1 + share * (h / sizes[0]) ** order) for h in sizes]


# --------------------------------------------------------------------------- sequences that converge
@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("order", [1.0, 1.09, 1.5, 2.0, 2.7, 3.0])
def test_order_and_limit_are_recovered(order, sizes):
    found = gci(manufactured(order, sizes), sizes, expected=1.09, highest=4.0, cap=3.5)
    # differences of 1e-3 and more carry rounding of 1e-16 / 1e-3; the root finder stops at 2e-12
    assert found.observed_order == pytest.approx(order, abs=1e-9)
    assert found.plausible and found.factor == 1.25
    assert found.used_order == found.observed_order
    # Richardson's extrapolation is exact for one term of the error: rounding only
    assert found.extrapolated == pytest.approx(LIMIT, rel=1e-11)


@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("order", [1.0, 1.5, 2.0, 2.7, 3.0])
@pytest.mark.parametrize("share", [0.05, -0.05])
def test_bar_is_the_true_error_times_the_factor(order, sizes, share):
    values = manufactured(order, sizes, share=share)
    found = gci(values, sizes, expected=1.09, highest=4.0, cap=3.5)
    true_error = abs(values[2] - LIMIT) / abs(values[2])
    # Roache's definition: with the right order the bar is 1.25 times the error, up to rounding of
    # the differences
    assert found.gci == pytest.approx(1.25 * true_error, rel=1e-9)


def test_scaling_values_or_sizes_changes_nothing():
    sizes = (1.0, 0.6, 0.4)
    values = manufactured(1.7, sizes)
    base = gci(values, sizes, expected=1.09, highest=4.0)
    other = gci([-1e-9 * v for v in values], [7.0 * h for h in sizes], expected=1.09, highest=4.0)
    # only ratios enter: rounding
    assert other.gci == pytest.approx(base.gci, rel=1e-9)
    assert other.observed_order == pytest.approx(base.observed_order, abs=1e-9)
    assert other.extrapolated == pytest.approx(-1e-9 * base.extrapolated, rel=1e-11)


# --------------------------------------------------------------------------- orders one should not believe
@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("order", [2.3, 3.0, 3.9])
def test_cap_widens_the_bar(order, sizes):
    values = manufactured(order, sizes)
    capped = gci(values, sizes, expected=1.09, highest=4.0)
    free = gci(values, sizes, expected=1.09, highest=4.0, cap=99.0)
    assert capped.observed_order == pytest.approx(order, abs=1e-9)  # what was seen is still told
    assert capped.used_order == 2.0 and capped.factor == 1.25
    # by definition: the same change, divided by r^2 - 1 instead of r^p - 1
    r = sizes[1] / sizes[2]
    assert capped.gci == pytest.approx(
        1.25 * abs(values[2] - values[1]) / abs(values[2]) / (r**2 - 1), rel=1e-12
    )
    assert capped.gci > free.gci > abs(values[2] - LIMIT) / values[2]


def test_cap_never_lies_below_the_expected_order():
    sizes = (4.0, 2.0, 1.0)
    found = gci(manufactured(3.5, sizes), sizes, expected=3.0, highest=4.0, cap=2.0)
    assert found.used_order == 3.0


@pytest.mark.parametrize(
    ("order", "expected", "highest"),
    [(0.7, 1.09, 4.0), (0.5, 1.09, 4.0), (5.0, 1.09, 4.0), (1.3, 2.0, 4.0)],
    ids=[
        "slower than the corner",
        "far slower",
        "faster than the element",
        "slower than a smooth case",
    ],
)
def test_implausible_order_falls_back_with_the_larger_factor(order, expected, highest):
    sizes = (4.0, 2.0, 1.0)
    values = manufactured(order, sizes)
    found = gci(values, sizes, expected=expected, highest=highest)
    assert found.observed_order == pytest.approx(order, abs=1e-9)
    assert not found.plausible and found.factor == 3.0 and found.used_order == expected
    # Roache's definition with factor 3 and the expected order
    assert found.gci == pytest.approx(
        3 * abs(values[2] - values[1]) / values[2] / (2**expected - 1), rel=1e-12
    )
    assert found.gci > abs(values[2] - LIMIT) / values[2]


@pytest.mark.parametrize(
    ("order", "plausible"), [(0.75, False), (0.78, True), (4.45, True), (4.6, False)]
)
def test_edges_of_plausible(order, plausible):
    sizes = (4.0, 2.0, 1.0)
    # 0.7 * 1.09 = 0.763 below, 4 + 0.5 above
    assert gci(manufactured(order, sizes), sizes, expected=1.09, highest=4.0).plausible is plausible


@pytest.mark.parametrize("sizes", SIZES)
def test_oscillation_has_no_order_and_a_bar_from_the_larger_change(sizes):
    values = [LIMIT * (1 + s * 0.05 * (h / sizes[0])) for s, h in zip((1, -1, 1), sizes)]
    found = gci(values, sizes, expected=1.0, highest=4.0)
    assert found.observed_order is None and not found.plausible and found.factor == 3.0
    larger = max(abs(values[1] - values[0]), abs(values[2] - values[1]))
    # definition, with the larger of both changes
    assert found.gci == pytest.approx(3 * larger / values[2] / (sizes[1] / sizes[2] - 1), rel=1e-12)
    assert found.gci > abs(values[2] - LIMIT) / values[2]


def test_lull_before_a_jump_does_not_narrow_the_bar():
    # the finer pair hardly moves, the coarser one moves the other way: the smaller change must not
    # be believed
    found = gci((1.0, 1.1, 1.0999), (4.0, 2.0, 1.0), expected=1.0, highest=4.0)
    assert found.observed_order is None
    # 3 * 0.1 / 1.0999 / (2 - 1)
    assert found.gci == pytest.approx(0.3 / 1.0999, rel=1e-12)


def test_divergence_has_no_order():
    found = gci((1.0, 1.1, 1.3), (4.0, 2.0, 1.0), expected=1.0, highest=4.0)
    assert found.observed_order is None and not found.plausible
    # three times the last and larger change
    assert found.gci == pytest.approx(3 * 0.2 / 1.3, rel=1e-12)


def test_stalled_sequence_keeps_the_change_it_saw():
    found = gci((1.0, 1.5, 1.5), (4.0, 2.0, 1.0), expected=1.09, highest=4.0)
    assert found.observed_order is None and found.extrapolated == 1.5
    # half a unit of 1.5 moved between the coarse two: the bar says so, exactly
    assert found.gci == pytest.approx(1 / 3, rel=1e-15)


def test_exact_sequence_has_no_bar_to_speak_of():
    found = gci((LIMIT, LIMIT, LIMIT), (4.0, 2.0, 1.0), expected=1.09, highest=4.0)
    assert (
        found.gci == 0.0
        and found.extrapolated == LIMIT
        and found.observed_order is None
        and found.plausible
    )
    assert gci((0.0, 0.0, 0.0), (4.0, 2.0, 1.0), expected=1.09, highest=4.0).gci == 0.0


@pytest.mark.parametrize(
    ("values", "sizes"),
    [
        ((1.0, 2.0), (2.0, 1.0)),
        ((1.0, 2.0, 3.0), (2.0, 1.0)),
        ((1.0, 2.0, 3.0, 4.0), (4.0, 3.0, 2.0, 1.0)),
        ((1.0, 2.0, 3.0), (1.0, 2.0, 4.0)),
        ((1.0, 2.0, 3.0), (2.0, 2.0, 1.0)),
        ((1.0, 2.0, 3.0), (2.0, 1.0, 0.0)),
        ((1.0, 2.0, 3.0), (2.0, 1.0, float("nan"))),
    ],
)
def test_other_than_three_ever_finer_meshes_is_refused(values, sizes):
    with pytest.raises(ValueError, match="three results on ever finer meshes"):
        gci(values, sizes, expected=1.09, highest=4.0)


def test_middle_value_of_zero():
    # a coupling term may pass through zero between two meshes; the bar itself is well defined:
    # 1.25 * 1 / (2^p - 1), p = log2 3
    assert gci((3.0, 0.0, -1.0), (4.0, 2.0, 1.0), expected=1.09, highest=4.0).gci == pytest.approx(
        0.625, rel=1e-9
    )


# --------------------------------------------------------------------------- corners
@pytest.mark.parametrize(
    ("degrees", "exponent", "tolerance"),
    [
        (90, 1.0, 0),  # not re-entrant
        (180, 1.0, 0),
        (225, 0.6736, 5e-5),  # literature, four digits
        (270, 0.5444837, 5e-8),  # Williams (1952), seven digits
        (360, 0.5, 1e-9),  # crack
    ],
)
def test_corner_exponent(degrees, exponent, tolerance):
    assert corner_exponent(math.radians(degrees)) == pytest.approx(exponent, abs=tolerance)


@pytest.mark.parametrize("degrees", range(185, 360, 5))
def test_corner_exponent_solves_the_characteristic_equation(degrees):
    w = math.radians(degrees)
    found = corner_exponent(w)
    # root to the finder's 2e-12, slope of the equation below 10
    assert abs(abs(math.sin(found * w)) - abs(found * math.sin(w))) < 1e-10
    # and the smallest one: no sign change of either branch below it
    below = np.linspace(1e-6, found - 1e-6, 5000)
    for sign in (1, -1):
        f = np.sin(below * w) + sign * below * np.sin(w)
        assert np.all(f[1:] * f[:-1] > 0)


def test_sharper_corners_are_more_singular():
    found = [corner_exponent(math.radians(d)) for d in range(180, 361)]
    assert np.all(np.diff(found) < 0)
    # no jump where the first root enters the search: a degree moves the exponent by 0.011 near 180
    # degrees
    assert np.max(-np.diff(found)) < 0.012


def chain(*parts):
    """A scene of (length, outer0, outer1, inner0, inner1)."""
    segments, y = [], 0.0
    for k, (length, a, b, *bore) in enumerate(parts):
        i, j = bore or (0.0, 0.0)
        segments.append(
            Segment(
                name=f"s{k}", y0=y, y1=round(y + length, 9), outer0=a, outer1=b, inner0=i, inner1=j
            )
        )
        y = segments[-1].y1
    return Scene.from_parts(segments)


def mirrored(parts):
    return [(length, b, a, *reversed(bore)) for length, a, b, *bore in reversed(parts)]


SLOPE = math.atan(0.2)  # 0.02 over 0.1
CORNERS = {
    "plain": ([(0.1, 0.05, 0.05)], math.pi),
    "two equal cylinders": ([(0.1, 0.05, 0.05), (0.1, 0.05, 0.05)], math.pi),
    "shoulder": ([(0.1, 0.05, 0.05), (0.1, 0.03, 0.03)], 1.5 * math.pi),
    "cone widens after a cylinder": ([(0.1, 0.03, 0.03), (0.1, 0.03, 0.05)], math.pi + SLOPE),
    "cone ends in a cylinder of its large end": ([(0.1, 0.03, 0.05), (0.1, 0.05, 0.05)], math.pi),
    "cone narrows to a cylinder": ([(0.1, 0.05, 0.03), (0.1, 0.03, 0.03)], math.pi + SLOPE),
    "cone narrows after a cylinder": ([(0.1, 0.05, 0.05), (0.1, 0.05, 0.03)], math.pi),
    "waist of two cones": ([(0.1, 0.05, 0.03), (0.1, 0.03, 0.05)], math.pi + 2 * SLOPE),
    "step down to a widening cone": ([(0.1, 0.08, 0.08), (0.1, 0.03, 0.05)], 1.5 * math.pi + SLOPE),
    "step down to a narrowing cone": (
        [(0.1, 0.08, 0.08), (0.1, 0.05, 0.03)],
        1.5 * math.pi - SLOPE,
    ),
    "step in the bore": (
        [(0.1, 0.08, 0.08, 0.02, 0.02), (0.1, 0.08, 0.08, 0.04, 0.04)],
        1.5 * math.pi,
    ),
    "bore that narrows after a cylinder": (
        [(0.1, 0.08, 0.08, 0.04, 0.04), (0.1, 0.08, 0.08, 0.04, 0.02)],
        math.pi + SLOPE,
    ),
    "bore that widens after a cylinder": (
        [(0.1, 0.08, 0.08, 0.02, 0.02), (0.1, 0.08, 0.08, 0.02, 0.04)],
        math.pi,
    ),
    "blind bore that widens to its bottom": (
        [(0.1, 0.08, 0.08, 0.02, 0.04), (0.1, 0.08, 0.08)],
        1.5 * math.pi + SLOPE,
    ),
    "blind bore that narrows to its bottom": (
        [(0.1, 0.08, 0.08, 0.04, 0.02), (0.1, 0.08, 0.08)],
        1.5 * math.pi - SLOPE,
    ),
    "shoulder and waist": (
        [(0.1, 0.05, 0.05), (0.1, 0.03, 0.03), (0.1, 0.03, 0.05)],
        1.5 * math.pi,
    ),
}


@pytest.mark.parametrize("flip", [False, True], ids=["", "mirrored"])
@pytest.mark.parametrize("name", CORNERS)
def test_sharpest_corner(name, flip):
    parts, angle = CORNERS[name]
    found, exponent = sharpest_corner(chain(*(mirrored(parts) if flip else parts)))
    # plane geometry of the outline: rounding
    assert found == pytest.approx(angle, abs=1e-12)
    assert exponent == corner_exponent(found)


def test_sharpest_corner_of_shipped_scenes():
    # shoulder behind the backcone
    angle, exponent = sharpest_corner(sg.load(GEOMETRY / "pinion_overhung.toml"))
    assert angle == pytest.approx(1.5 * math.pi, abs=1e-12)  # rounding
    assert exponent == pytest.approx(0.5444837, abs=5e-8)  # seven digits of the literature
    assert sharpest_corner(sg.load(GEOMETRY / "cylinder_free.toml")) == (math.pi, 1.0)
    # 40 mm to 60 mm of radius over 60 mm
    angle, _ = sharpest_corner(sg.load(GEOMETRY / "shaft_hollow.toml"))
    assert angle == pytest.approx(math.pi + math.atan(20 / 60), abs=1e-12)  # rounding
