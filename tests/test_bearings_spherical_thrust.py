"""Spherical roller bearings and thrust balls: equilibria by hand, limits, ratings, what is refused."""

import math

import numpy as np
import pytest
from scipy.optimize import fsolve

from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.catalogued import catalogued, state
from solidgear.bearings.designation import boundary
from solidgear.bearings.equivalent import factors, static_factors
from solidgear.bearings.geometry import inner_geometry
from solidgear.bearings.hertz import line_constant, point_contact
from solidgear.bearings.life import life
from solidgear.bearings.rating import ball_rating, static_ball_rating
from solidgear.bearings.spherical import SphericalRow
from solidgear.core.errors import SceneError

#: Harris and Kotzalas, Essential Concepts, ch. 2: a 22317
HARRIS = SphericalRow(14, 25e-3, 135.077e-3, length=20.76e-3, angle=math.radians(12))
GIVEN = {
    "elements": 14,
    "element_diameter": "25 mm",
    "element_length": "20.76 mm",
    "pitch_diameter": "135.077 mm",
    "contact_angle": "12 deg",
    "conformity": 0.51,
}
#: a maker's ratings, C and C_0, N, and the balls whose ISO ratings they are
THRUST = (("51110", 28.8e3, 75.5e3, 24, 7.144), ("51210", 48.5e3, 111e3, 17, 10.319))


def test_a_spherical_roller_bearing_in_equilibrium_by_hand():
    """Two rows of rollers, each roller's force by its own sum over its length."""
    clear, n = 60e-6, 30
    data = Catalogue(
        designation="22317 E",
        clearance=clear,
        load={"x": "9 kN", "y": "6 kN", "z": "-25 kN"},
        **GIVEN,
    )
    assert data.estimated == ()
    found = catalogued(data)
    angle, length = math.radians(12), 20.76e-3
    sphere = 135.077e-3 / 2 / math.cos(angle) + 12.5e-3
    assert sphere == pytest.approx(81.585e-3, rel=1e-3)  # as published
    contour = sphere / 1.02
    along = length * ((np.arange(n) + 0.5) / n - 0.5)
    room = along**2 / 2 * (2 / contour - 1 / sphere - 1 / (1.02 * contour))

    def carried(ring):
        total = np.zeros(3)
        for row in (0, 1):
            for roller in range(14):
                azimuth = (roller + row / 2) * 2 * math.pi / 14
                across = math.cos(angle)
                up = math.sin(angle) * (1 if row else -1)
                normal = np.array([across * math.cos(azimuth), up, across * math.sin(azimuth)])
                near = normal @ ring - clear / 2 * across - room
                # N and mm, ISO/TS 16281: 35948 l^(8/9) delta^(10/9)
                slices = 35948 / n * (1e3 * length) ** (8 / 9) * (1e3 * near.clip(0)) ** (10 / 9)
                total += normal * slices.sum()
        return total

    load = np.array([9e3, 6e3, -25e3])
    ring = 1e-6 * fsolve(lambda u: carried(1e-6 * u) - load, [30.0, 90.0, -80.0], xtol=1e-12)
    assert state(data, found)[:3] == pytest.approx(ring, rel=1e-7)


def test_a_spherical_row_feels_no_tilt():
    motion = np.array([4e-5, 2e-5, -3e-5, 0, 0, 0])
    tilted = motion + [0, 0, 0, 5e-3, 0, -8e-3]
    assert np.array_equal(HARRIS.load(tilted), HARRIS.load(motion))
    stiffness = HARRIS.tangent(tilted)
    assert not stiffness[3:].any() and stiffness[0, 1] != 0.0


def test_barrels_press_in_ellipses_and_then_in_lines():
    """Light loads by Hertz's point contact, heavy ones by the line that all of a roller makes."""
    gamma = 25 * math.cos(HARRIS.angle) / 135.077
    curved = 1 / 79.959e-3 - 1 / 81.585e-3
    soft = [
        point_contact(2 / 25e-3 * (1 + ring), curved).constant ** (-2 / 3)
        for ring in (gamma / (1 - gamma), -gamma / (1 + gamma))
    ]

    def push(approach):
        return np.array([approach / math.cos(HARRIS.angle), 0, 0, 0, 0, 0])

    for press in (1e3, 3e3):  # its ellipses are 10 and 15 mm long, the roller 20.8
        near = sum(soft) * press ** (2 / 3)
        assert HARRIS.contacts(push(near)).load[0] == pytest.approx(press, rel=0.10)
    near, step = 90e-6, 1e-8  # 30 kN: longer than the roller
    slope = (
        HARRIS.contacts(push(near + step)).load[0] - HARRIS.contacts(push(near)).load[0]
    ) / step
    line = line_constant(20.76e-3)
    press = HARRIS.contacts(push(near)).load[0]
    assert slope == pytest.approx(10 / 9 * line**0.9 * press**0.1, rel=5e-3)


def test_catalogue_factors_of_a_spherical_roller_bearing():
    # makers give e 0.24, Y1 2.8, Y2 4.2, Y0 2.8 for the 22210
    data = Catalogue(designation="22210 E")
    inside = inner_geometry(data).middle
    found = factors(data, inside, 0.0)
    assert found.e == pytest.approx(0.24, rel=1e-9)
    told = (found.low[1], found.high[1], 2 * static_factors(data, inside)[1])
    assert told == pytest.approx((2.8, 4.2, 2.8), abs=0.06)


def test_thrust_balls_in_closed_form():
    data = Catalogue(
        designation="51110", holds="+y", load={"y": "4.8 kN"}, elements=24,
        element_diameter="7.144 mm", pitch_diameter="60 mm", conformity=0.54,
    )  # fmt: skip
    made = catalogued(data)
    along = state(data, made)[1]
    # both washers alike: curvatures across 2/D (1 - 1/1.08), rolling 2/D
    ball = 2 / 7.144e-3
    washer = point_contact(ball, ball * (1 - 1 / 1.08)).constant
    assert 24 * washer / 2**1.5 * along**1.5 == pytest.approx(4.8e3, rel=1e-9)
    # Palmgren, N and mm: 5.24e-4 (Q^2 / Dw)^(1/3)
    assert along * 1e3 == pytest.approx(5.24e-4 * (200.0**2 / 7.144) ** (1 / 3), rel=0.05)
    stiffness = made.bearing.tangent(np.array([0, along, 0, 0, 0, 0]))
    assert stiffness[1, 1] == pytest.approx(1.5 * 4.8e3 / along, rel=1e-9)
    assert stiffness[3, 3] == pytest.approx(stiffness[1, 1] * 30e-3**2 / 2, rel=1e-9)
    assert not stiffness[[0, 2]].any()


def test_a_tilted_thrust_bearing_in_equilibrium_by_hand():
    data = Catalogue(designation="51110", holds="-y", load={"y": "-3 kN", "thx": 30, "thz": -10})
    made = catalogued(data)
    row = made.bearing.rows[0]
    azimuth = 2 * math.pi * np.arange(row.count) / row.count
    lever = row.pitch / 2

    def carried(u):
        y, thx, thz = u * [1e-6, 1e-3, 1e-3]
        up = y + lever * (thz * np.cos(azimuth) - thx * np.sin(azimuth))
        press = -row.constant * (-up).clip(0) ** 1.5
        return [
            press.sum() + 3000,
            -lever * (press @ np.sin(azimuth)) - 30,
            lever * (press @ np.cos(azimuth)) + 10,
        ]

    y, thx, thz = fsolve(carried, [-8.0, 0.2, -0.1], xtol=1e-12) * [1e-6, 1e-3, 1e-3]
    assert state(data, made)[[1, 3, 5]] == pytest.approx([y, thx, thz], rel=1e-7)
    assert 0 < np.count_nonzero(row.contacts(state(data, made)).load) <= row.count


@pytest.mark.parametrize("designation, dynamic, static, count, diameter", THRUST)
def test_ratings_and_inside_of_thrust_balls_are_a_makers(
    designation, dynamic, static, count, diameter
):
    data = Catalogue(
        designation=designation, holds="+y", load={"y": "5 kN"},
        load_rating=dynamic, static_rating=static,
    )  # fmt: skip
    inside = inner_geometry(data).middle
    assert inside.elements == count
    assert inside.diameter * 1e3 == pytest.approx(diameter, rel=3e-3)
    assert ball_rating(inside) == pytest.approx(dynamic, rel=1e-6)
    assert static_ball_rating(inside) == pytest.approx(static, rel=5e-3)  # makers round
    # evenly loaded, both lives are one: (C / Fa)^3
    made = catalogued(data)
    found = life(data, made, state(data, made))
    assert found.reference == pytest.approx(found.basic, rel=1e-9)
    assert found.basic == pytest.approx(1e6 * (dynamic / 5e3) ** 3, rel=1e-9)


@pytest.mark.parametrize(
    "written, kind, sizes, clearance",
    [
        ("22210 E/C3", "spherical", (50, 90, 23), "C3"),
        ("22312-E1-XL", "spherical", (60, 130, 46), None),
        ("21308 CC/W33", "spherical", (40, 90, 23), None),
        ("23222 CC/W33", "spherical", (110, 200, 69.8), None),
        ("24024 CC/C4", "spherical", (120, 180, 60), "C4"),
        ("51106", "thrust_ball", (30, 47, 11), None),
        ("51220", "thrust_ball", (100, 150, 38), None),
    ],
)
def test_designations_tell_boundary_dimensions(written, kind, sizes, clearance):
    found = boundary(written)
    told = (found.bore, found.outer_diameter, found.width)
    assert (found.kind, found.clearance) == (kind, clearance)
    assert [1e3 * one for one in told] == pytest.approx(sizes)


SPHERICAL, WASHER = {"designation": "22210 E"}, {"designation": "51110", "holds": "+y"}
BAD = (
    ({"designation": "51110"}, r'write holds = "\+y"'),
    ({"designation": "22210 EK"}, 'tapered bore, K.* write it, as clearance = "20 um"'),
    ({"designation": "22201"}, 'did you mean "22210"'),
    (SPHERICAL | {"arrangement": "O"}, "has two rows of its own"),
    (SPHERICAL | {"preload": "100 N"}, "by a negative clearance and not along y"),
    (SPHERICAL | {"profile": "straight"}, "has barrels"),
    (SPHERICAL | {"speed": "100 rpm"}, "belongs to balls"),
    (WASHER | {"arrangement": "X"}, "write holds at each"),
    (WASHER | {"clearance": "C3"}, "no clearance across the shaft"),
    (WASHER | {"speed": "100 rpm"}, "at rest only"),
    (WASHER | {"contact_angle": "60 deg"}, "stands at 90 degrees"),
    (WASHER | {"load": {"z": "1 kN"}}, "nothing holds it in z"),
    (WASHER | {"load": {"y": "-1 kN"}}, r"holds the shaft towards \+y only"),
)


@pytest.mark.parametrize("data, sentence", BAD, ids=[s for _, s in BAD])
def test_bad_data_end_in_one_sentence(data, sentence):
    with pytest.raises(SceneError, match=sentence) as refused:
        state(Catalogue(**data), catalogued(Catalogue(**data)))
    assert len(refused.value.problems) == 1


def test_insides_that_are_estimated_have_a_range():
    for data in (
        Catalogue(**SPHERICAL, load={"z": "10 kN"}),
        Catalogue(**WASHER, load={"y": "10 kN"}),
    ):
        ends = [catalogued(data, end) for end in ("softer", "middle", "stiffer")]
        stiff = [np.trace(made.bearing.tangent(state(data, made))[:3, :3]) for made in ends]
        assert stiff[0] < stiff[1] < stiff[2] < 2 * stiff[0]
        assert "elements" in data.estimated and "conformity" in data.estimated
    # an angle that a series alone tells is open by 15 %, and stiffness along y goes with its square
    pushed = Catalogue(**SPHERICAL, load={"y": "1 kN", "z": "1 kN"})
    low, high = (catalogued(pushed, end) for end in ("softer", "stiffer"))
    along = [made.bearing.tangent(state(pushed, made))[1, 1] for made in (low, high)]
    assert along[1] > (1.15 / 0.85) ** 2 * along[0]
    known = inner_geometry(pushed.with_changes(contact_angle="9 deg"))
    assert known.softer.angle == known.stiffer.angle == pytest.approx(math.radians(9))
