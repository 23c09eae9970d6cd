"""Wheels and pairs of wheels beside printed figures and geometry that is computed another way."""

from math import cos, hypot, pi, radians, sin, sqrt

import numpy as np
import pytest

from solidgear.core.errors import SceneError
from solidgear.core.gears.wheel import Rack, Wheel, involute
from solidgear.core.gears.wheel_pair import WheelPair

SPUR = WheelPair(Wheel(23, 4e-3, face_width=20e-3), Wheel(57, 4e-3, face_width=20e-3))
HELICAL = WheelPair(
    Wheel(17, 4e-3, radians(15), 0.145, face_width=30e-3),
    Wheel(103, 4e-3, radians(15), face_width=30e-3),
)
RING = WheelPair(Wheel(34, 2e-3, face_width=15e-3), Wheel(-85, 2e-3, face_width=15e-3))


def test_printed_pairs():
    """Kohara, Gear Technical Reference (2015), tables 4.3 (spur, shifted) and 4.8 (ring)."""
    pair = WheelPair(Wheel(12, 3e-3, shift=0.6), Wheel(24, 3e-3, shift=0.36))
    assert 1e3 * pair.distance == pytest.approx(56.4999, abs=5e-5)
    assert np.degrees(pair.working_angle) == pytest.approx(26.0886, abs=5e-5)
    pair = WheelPair(Wheel(16, 3e-3), Wheel(-24, 3e-3, shift=-0.5))
    # printed with the ring's shift of the other sign, 0.5
    assert 1e3 * pair.distance == pytest.approx(13.1683, abs=5e-5)
    assert np.degrees(pair.working_angle) == pytest.approx(31.0937, abs=1e-4)


def test_contact_ratio_of_the_pair_of_23_and_57_teeth():
    assert SPUR.contact_ratio == pytest.approx(1.6841, abs=5e-5)


@pytest.mark.parametrize("pair", [SPUR, HELICAL, RING], ids=["spur", "helical", "ring"])
def test_both_flanks_touch_along_the_path(pair):
    """Turned by the ratio of the teeth, points of both flanks at one place s lie in one point, with
    opposite normals: their base circles placed at the centre distance, by coordinates alone.
    """
    centre = np.array([0.0, pair.distance]) * pair.second.sign
    for s in np.linspace(*pair.ends, 7):
        first, second = pair.first_radius(s), pair.second_radius(s)
        # the point from both centres: two circles cross beside the line of centres
        y = (pair.distance**2 + first**2 - second**2) / (2 * pair.distance) * pair.second.sign
        x = sqrt(first**2 - y**2)
        assert hypot(x - centre[0], y - centre[1]) == pytest.approx(second, rel=1e-12)
        # from the pitch point the line of action leaves at the working pressure angle
        radius = pair.first.base / cos(pair.working_angle)
        distance = hypot(x, y - radius)
        assert distance == pytest.approx(abs(s - pair.pitch_point), rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    "teeth, shift, helix",
    [(23, 0.0, 0), (12, 0.5, 0), (17, 0.3, 30), (10, 0.0, 0), (-85, 0.0, 0), (-40, 0.3, 0)],
)
def test_a_fillet_runs_from_the_root_to_the_flank_without_a_corner(teeth, shift, helix):
    wheel = Wheel(teeth, 2e-3, radians(helix), shift)
    points = wheel.fillet(200)
    radii = np.hypot(points[:, 0], points[:, 1])
    assert radii[0] == pytest.approx(wheel.root, rel=1e-9)
    assert np.all(wheel.sign * np.diff(radii) > 0)
    (end,), (normal,) = wheel.flank_points(np.array([wheel.form]))
    assert points[-1] == pytest.approx(end, abs=1e-9)
    step = points[-1] - points[-2]
    if not wheel.is_undercut:  # an undercut fillet crosses the flank at an angle
        assert abs(step @ normal) < 0.02 * hypot(step[0], step[1])


@pytest.mark.parametrize("shift", [0.2, 1.1])
def test_a_fillet_is_what_the_rack_leaves(shift):
    """No point of it lies in the rack, which is rolled in small steps: distances to the corner's
    circle are its radius at least, and somewhere no more. A large shift lifts the corner's centre
    beyond the rolling line.
    """
    wheel = Wheel(23, 4e-3, radians(15), shift)
    rack, m, angle = wheel.rack, wheel.module, wheel.transverse_angle
    aside = (
        pi * wheel.transverse_module / 4
        - rack.dedendum * m * np.tan(angle)
        - rack.root_radius * m * (1 - sin(angle)) / cos(angle)
    )
    below = (rack.dedendum - rack.root_radius - wheel.shift) * m
    rolls = np.linspace(-0.6, 0.6, 20001)
    x, y = aside + wheel.radius * rolls, wheel.radius - below
    turn = pi / wheel.count  # from the space on +y to the tooth
    corner = (x + 1j * y) * np.exp(1j * rolls) * np.exp(1j * turn)
    corner = -corner.real + 1j * corner.imag  # to the right side of the tooth
    for point in wheel.fillet(9)[1:-1]:
        distance = np.abs(corner - complex(point[0], point[1])).min()
        assert distance == pytest.approx(rack.root_radius * m, rel=1e-5)


def test_undercut_begins_where_the_straight_side_passes_the_base_circle():
    """17.097 teeth at 20 degrees: 2 / sin^2 (ISO 21771, of a rack whose straight side is a module)."""
    rack = Rack(root_radius=0.25 / (1 - sin(radians(20))))
    assert Wheel(17, 1e-3, rack=rack).missing_shift == pytest.approx(1 - 17 / 17.0973, abs=1e-5)
    assert not Wheel(18, 1e-3, rack=rack).is_undercut
    assert Wheel(17, 1e-3, rack=rack).is_undercut


def test_teeth_of_a_ring_are_the_spaces_of_a_wheel():
    wheel, ring = Wheel(60, 2e-3, shift=0.1), Wheel(-60, 2e-3, shift=-0.1)
    r = np.linspace(58.5e-3, 61e-3, 5)
    assert ring.half_angle(r) == pytest.approx(pi / 60 - wheel.half_angle(r), rel=1e-12)


def test_backlash_is_what_the_thicknesses_leave_of_the_pitch():
    pair = WheelPair(Wheel(23, 4e-3), Wheel(57, 4e-3), 160.2e-3)
    working = pair.first.base / cos(pair.working_angle)
    other = pair.second.base / cos(pair.working_angle)
    pitch = 2 * pi * working / 23
    thick = 2 * working * pair.first.half_angle(working) + 2 * other * pair.second.half_angle(other)
    assert pair.backlash == pytest.approx((pitch - thick) * cos(pair.working_angle), rel=1e-9)


def test_a_planet_nearer_to_its_ring_has_less_backlash():
    """By thicknesses on the circles that roll, with a ring whose teeth are thinned by a shift."""
    for distance in (50.9e-3, 51e-3, 51.1e-3):
        pair = WheelPair(Wheel(34, 2e-3), Wheel(-85, 2e-3, shift=-0.05), distance)
        working, other = (w.base / cos(pair.working_angle) for w in (pair.first, pair.second))
        thick = 2 * working * pair.first.half_angle(working)
        thick += 2 * other * pair.second.half_angle(other)
        due = (2 * pi * working / 34 - thick) * cos(pair.working_angle)
        assert pair.backlash == pytest.approx(due, abs=1e-12)


def test_faces_that_lie_off_each_other_share_what_both_cover():
    first, second = Wheel(23, 4e-3, face_width=24e-3), Wheel(57, 4e-3, face_width=20e-3)
    # from -12 to 12 and from -4 to 16: shared from -4 to 12, about 4
    pair = WheelPair(first, second, offset=6e-3)
    assert pair.face_width == pytest.approx(16e-3, rel=1e-12)
    assert pair.face_middles == pytest.approx((-4e-3, 2e-3), rel=1e-12)
    assert WheelPair(first, second, offset=1e-3).face_width == 20e-3
    assert WheelPair(first, second, offset=-30e-3).face_width < 0


def test_shifts_without_a_pressure_angle_and_axes_too_near_are_refused():
    with pytest.raises(SceneError, match="leaves no pressure angle"):
        _ = WheelPair(Wheel(10, 1e-3, shift=-1.2), Wheel(10, 1e-3, shift=-1.2)).distance
    with pytest.raises(SceneError, match="no backlash at 160 mm"):
        _ = WheelPair(Wheel(23, 4e-3), Wheel(57, 4e-3), 0.150).distance
    assert involute(0.0) == 0.0
