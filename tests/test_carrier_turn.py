"""A planetary stage at rest over a turn of its carrier: closed forms of load sharing."""

from dataclasses import replace
from math import cos, pi

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.frames import rotation

TORQUE, SHIFT = 20.0, 10e-6
#: N/m, N m/rad: members that stand still give by 1e-12 of what teeth give
STILL = 1e20
# a dozen unknowns beside springs 1e12 times as stiff
ROUNDING = 1e-10
TEETH = sg.PlanetaryTeeth(17, 34, 85, module=2.5e-3)
PATH = 5.15e7
#: on the base cylinders
HELIX = 0.3


def stage(planets=3, pin=2e8, sun_mesh=2e8, ring_mesh=3e8, sun=0.0):
    s, p, r = TEETH.base_radii
    return sg.PlanetaryStage(
        sg.CentralMember(0.2, 3e-5, s, bearing=sun),
        sg.CentralMember(2.0, 0.02, r, bearing=STILL, turning=STILL),
        sg.CentralMember(1.5, 5e-3, TEETH.pin_radius, bearing=STILL),
        sg.Planet(0.6, 5e-4, p, pin, sun_mesh, ring_mesh).spaced(planets),
        TEETH.pressure_angle,
    )


def test_ideal_bearings_share_the_load_at_every_position_and_torques_balance():
    turn = sg.carrier_turn(stage(), TORQUE)
    mean = TORQUE / (3 * TEETH.base_radii[0])
    assert turn.sun_mesh.shape == (72, 3)
    assert turn.sun_mesh == pytest.approx(mean, rel=ROUNDING)
    assert turn.ring_mesh == pytest.approx(mean, rel=ROUNDING)
    assert sum(turn.torque.values()) == pytest.approx(0, abs=ROUNDING * TORQUE)
    assert turn.torque["sun"] == pytest.approx(-TORQUE, rel=ROUNDING)
    assert turn.torque["carrier"] == pytest.approx(TEETH.speed_ratio * TORQUE, rel=ROUNDING)


@pytest.mark.parametrize("planets", [3, 4, 5])
@pytest.mark.parametrize("support", [1e7, 1e8])
def test_a_shifted_support_modulates_every_mesh_at_the_carrier_frequency(planets, support):
    own = stage(planets)
    path = own.path_stiffness[0]
    turn = sg.carrier_turn(own, TORQUE, {"sun": sg.FixedSupport(support, (0, SHIFT))})
    closed = path * SHIFT * support / (support + planets * path / 2)
    order = np.fft.rfft(turn.sun_mesh, axis=0) / 36
    assert turn.amplitude(1) == pytest.approx(closed, rel=ROUNDING)
    assert abs(order[2:]).max() < ROUNDING * closed
    behind = np.angle(order[1] / np.roll(order[1], 1))
    assert np.abs(behind) == pytest.approx(2 * pi / planets)
    assert turn.sun_mesh.sum(axis=1) == pytest.approx(TORQUE / TEETH.base_radii[0], rel=ROUNDING)
    assert turn.ring_mesh == pytest.approx(turn.sun_mesh, rel=ROUNDING)


def test_one_stiffness_through_the_planets_gives_both_figures_of_the_prototype():
    # 20 N m on a base circle of 20 mm: 333 N; 10 um off: 59 N on 1e7 N/m, 291 N on 1e8 N/m
    base = replace(stage(pin=STILL, sun_mesh=2 * PATH, ring_mesh=2 * PATH))
    torque = TORQUE * TEETH.base_radii[0] / 20e-3
    for support, wanted in ((1e7, 59), (1e8, 291)):
        turn = sg.carrier_turn(base, torque, {"sun": sg.FixedSupport(support, (SHIFT, 0))})
        assert round(float(turn.sun_mesh.mean())) == 333
        assert round(float(np.ptp(turn.sun_mesh[:, 0])) / 2) == wanted


def test_a_support_of_two_stiffnesses_is_that_of_a_stage_built_at_every_position():
    matrix, shift = np.array([[4e7, 1e7], [1e7, 9e6]]), np.array([7e-6, -4e-6])
    own = stage()
    uneven = replace(own, planets=(replace(own.planets[0], sun_mesh=5e7), *own.planets[1:]))
    turn = sg.carrier_turn(uneven, TORQUE, {"sun": sg.FixedSupport(matrix, shift)}, positions=5)
    for k, angle in enumerate(turn.angle):
        back = np.array([[cos(angle), -np.sin(angle)], [np.sin(angle), cos(angle)]])
        seen = np.zeros((6, 6))
        seen[np.ix_([0, 2], [0, 2])] = back @ matrix @ back.T
        built = sg.System(
            uneven.parts, {**uneven.links, "support": sg.BearingSpring("sun.centre", seen)}
        )
        push = back @ matrix @ shift
        load = built.load(
            {
                "sun.centre": [push[0], 0, push[1], 0, TORQUE, 0],
                "carrier.centre": [0, 0, 0, 0, -TORQUE * TEETH.speed_ratio, 0],
            }
        )
        rows, where = built.strains
        for planet, one in enumerate(uneven.planets, 1):
            stretch = (rows[where[f"planet {planet} sun mesh"]] @ built.static(load))[0]
            assert turn.sun_mesh[k, planet - 1] == pytest.approx(
                np.sqrt(one.sun_mesh) * stretch, rel=1e-8
            )
    assert np.ptp(turn.shift["sun"][:, 0]) > 1e-8  # the sun does not stand still


def in_space(helix=0.0):
    """The stage with six motions of every member; ring and carrier stand still."""
    flat, still = stage(), STILL * np.diag([1.0, 1, 1, 1, 0, 1])
    held = {"sun": 0.0, "ring": still, "carrier": still}
    central = {n: getattr(flat, n) for n in held}
    central = {
        n: replace(m, bearing=held[n], diametral=0.6 * m.inertia) for n, m in central.items()
    }
    pin = np.diag([2e8, 8e7, 2e8, 4e4, 0, 4e4])
    planets = tuple(replace(p, pin=pin, diametral=0.6 * p.inertia) for p in flat.planets)
    return replace(flat, **central, planets=planets, base_helix=helix, face_width=20e-3)


def test_a_spur_stage_in_space_turns_as_in_the_plane():
    held = np.diag([1e7, 3e6, 1e7, 2e3, 0, 2e3])
    shift = np.array([SHIFT, 0, 0, 0, 0, 0])
    errors = [sg.PlanetError((5e-6, 9e-6), tilt=(1e-4, 0)), sg.PlanetError(), sg.PlanetError()]
    wide = sg.carrier_turn(in_space(), TORQUE, {"sun": sg.FixedSupport(held, shift)}, errors)
    flat = sg.carrier_turn(stage(), TORQUE, {"sun": sg.FixedSupport(1e7, shift[:2])}, errors)
    for name in ("sun_mesh", "ring_mesh", "pin"):
        assert getattr(wide, name) == pytest.approx(getattr(flat, name), rel=ROUNDING, abs=1e-7)
    assert wide.shift["sun"][:, [0, 2]] == pytest.approx(flat.shift["sun"][:, [0, 2]], abs=1e-15)


def test_a_helical_sun_that_cannot_tilt_is_modulated_in_closed_form():
    support, across = 3e7, cos(HELIX)
    own = in_space(HELIX)
    own = replace(own, face_width=0.0)
    path = own.path_stiffness[0]
    assert path < 0.9 * stage().path_stiffness[0]  # planets tilt on their pins
    hard = replace(own.planets[0], pin=np.diag([1e20, 1e20, 1e20, 4e4, 0, 4e4]))
    assert (
        path < replace(own, planets=(hard,)).path_stiffness[0] < 1.2e8
    )  # 1 / (1/2 + 1/3), tilting
    held = np.diag([support, STILL, support, STILL, 0, STILL])
    fixed = sg.FixedSupport(held, [0, 0, SHIFT, 0, 0, 0])
    turn = sg.carrier_turn(own, TORQUE, {"sun": fixed})
    closed = path * across * SHIFT * support / (support + 3 * path * across**2 / 2)
    assert turn.amplitude(1) == pytest.approx(closed, rel=1e-9)
    mean = TORQUE / (3 * across * TEETH.base_radii[0])
    assert turn.sun_mesh.mean(axis=0) == pytest.approx(mean, rel=ROUNDING)
    # a right-handed sun that drives about +y is pushed along +y
    assert turn.support["sun"][:, 1] == pytest.approx(3 * mean * np.sin(HELIX), rel=ROUNDING)
    assert sum(turn.torque.values()) == pytest.approx(0, abs=ROUNDING * TORQUE)


def test_a_support_of_six_stiffnesses_is_that_of_a_helical_stage_built_at_every_position():
    root = np.random.default_rng(34).normal(size=(6, 5)) * np.array([3e3, 2e3, 3e3, 40, 40])
    root[3:] *= 0.02
    root[4] = 0.0
    support, shift = root @ root.T, np.array([7e-6, 2e-6, -4e-6, 3e-5, 0, -1e-5])
    own = in_space(HELIX)
    turn = sg.carrier_turn(own, TORQUE, {"sun": sg.FixedSupport(support, shift)}, positions=3)
    for k, angle in enumerate(turn.angle):
        back = rotation(1, -angle)
        seen = sg.BearingSpring("sun.centre", back @ support @ back.T)
        built = sg.System(own.parts, {**own.links, "support": seen})
        load = built.load(
            {
                "sun.centre": back @ support @ shift + [0, 0, 0, 0, TORQUE, 0],
                "carrier.centre": [0, 0, 0, 0, -TORQUE * TEETH.speed_ratio, 0],
            }
        )
        moved = built.static(load)
        rows, where = built.strains
        for planet, one in enumerate(own.planets, 1):
            strain = rows[where[f"planet {planet} sun mesh"]] @ moved
            force = np.sqrt(one.sun_mesh / 2) * strain.sum()
            assert turn.sun_mesh[k, planet - 1] == pytest.approx(force, rel=1e-8)
        at = back.T @ built.motion("sun.centre") @ moved
        assert turn.shift["sun"][k, [0, 1, 2, 3, 5]] == pytest.approx(at[[0, 1, 2, 3, 5]], rel=1e-6)


def test_a_helical_sun_without_a_thrust_bearing_is_told():
    with pytest.raises(SolidgearError, match="the load works on a motion that nothing resists"):
        sg.carrier_turn(in_space(HELIX), TORQUE, {"sun": sg.FixedSupport(1e7)})


@pytest.mark.parametrize("floats", ["sun", "carrier"])
def test_a_floating_member_gives_three_planets_one_share_whatever_the_pins(floats):
    errors = [sg.PlanetError((5e-6, 40e-6)), sg.PlanetError(sun_tooth=8e-6), sg.PlanetError()]
    own = stage(sun=0.0 if floats == "sun" else STILL)
    if floats == "carrier":
        own = replace(own, carrier=replace(own.carrier, bearing=0.0))
    turn = sg.carrier_turn(own, TORQUE, errors=errors, positions=1)
    assert turn.sun_mesh == pytest.approx(TORQUE / (3 * TEETH.base_radii[0]), rel=1e-9)


@pytest.mark.parametrize("error, thicker", [("pin", 2 * cos(pi / 9)), ("sun_tooth", 1.0)])
def test_errors_share_out_as_rank_says(error, thicker):
    # turning takes the mean of a stretch along the line of action, floating the first harmonic: of
    # one planet in four, a floating sun leaves 1/4 with changing sign, a held one 3/4 and -1/4
    size = 6e-6
    value = (0.0, -size) if error == "pin" else size
    errors = [sg.PlanetError(**{error: value}), *[sg.PlanetError()] * 3]
    mean = TORQUE / (4 * TEETH.base_radii[0])
    for sun, pattern in ((0.0, [1, -1, 1, -1]), (STILL, [3, -1, -1, -1])):
        own = stage(4, sun=sun)
        change = own.path_stiffness[0] * size * thicker * np.array(pattern) / 4
        turn = sg.carrier_turn(own, TORQUE, errors=errors, positions=1)
        assert turn.sun_mesh[0] - mean == pytest.approx(change, rel=1e-7)


def test_a_stage_whose_circles_do_not_fit_is_refused():
    own = stage()
    own = replace(own, carrier=replace(own.carrier, radius=1.01 * TEETH.pin_radius))
    with pytest.raises(SolidgearError, match=r"lines of action that should be one are 0\.\d+ mm"):
        sg.carrier_turn(own, TORQUE)


def test_what_is_no_support_or_error_is_told():
    with pytest.raises(SolidgearError, match="'planet 1' has no support; sun, ring, carrier may"):
        sg.carrier_turn(stage(), TORQUE, {"planet 1": sg.FixedSupport(1e7)})
    with pytest.raises(SolidgearError, match="2 errors for 3 planets; give each its own"):
        sg.carrier_turn(stage(), TORQUE, errors=[sg.PlanetError()] * 2)
    with pytest.raises(SolidgearError, match="'planet 4' is no member to be loaded; sun, ring"):
        sg.carrier_turn(stage(), TORQUE, weights={"planet 4": [0, 0, -9.0, 0, 0, 0]})
    with pytest.raises(
        SolidgearError, match=r"the load of ring has shape \(3,\); it must be \(6,\)"
    ):
        sg.carrier_turn(stage(), TORQUE, carried={"ring": [0, 0, -9.0]})
    with pytest.raises(SolidgearError, match="the stiffness of a support has -1 on its diagonal"):
        sg.FixedSupport(-1.0)
    with pytest.raises(SolidgearError, match="the torque on the sun contains NaN or infinity"):
        sg.carrier_turn(stage(), np.nan)
    with pytest.raises(SolidgearError, match="order 36 is not among those of 72 positions"):
        sg.carrier_turn(stage(), TORQUE).amplitude(36)


@pytest.mark.parametrize(
    "teeth, more, words",
    [
        ((17, 34, 86), {}, "a ring of 86 teeth does not fit .* around one axis it has 85"),
        ((17, 34, 85), {"planets": 4}, r"17 \+ 85 teeth are no multiple of 4; 2, 3, 6 would"),
        ((17, 34, 85), {"planets": (0, 2, 4)}, "planet 2 does not assemble at 114.592 deg; the "),
        ((17, 34, 85), {"planets": 6}, "planets 60 deg apart overlap: their axes are"),
        ((17, 34, 85), {"ratio": 5.9}, r"a ratio of 5.9 is not .*: 1 \+ 85/17 = 6"),
        ((17, 34.5, 86), {}, "planet has 34.5 teeth; give a whole number"),
    ],
)
def test_teeth_that_do_not_fit_are_told_in_one_sentence(teeth, more, words):
    with pytest.raises(SolidgearError, match=words):
        sg.PlanetaryTeeth(*teeth, module=1e-3, **more)


def test_unequal_angles_that_assemble_are_taken():
    tooth = 2 * pi / (17 + 85)
    assert len(sg.PlanetaryTeeth(17, 34, 85, 1e-3, (0, 35 * tooth, 69 * tooth)).azimuths) == 3


def test_tips_of_helical_planets_count_in_normal_modules():
    """16 and 89 teeth at 30 degrees: axes 90.933 transverse modules apart, tips 89 + 2 cos 30 deg
    across; a straight addendum of two modules would touch.
    """
    helical = sg.PlanetaryTeeth(16, 89, 194, 1e-3, helix=np.radians(30))
    assert helical.spacing == pytest.approx(105e-3 * np.sin(np.pi / 3), rel=1e-12)
    assert (89 + 2 * np.cos(np.radians(30))) * 1e-3 < helical.spacing < 91e-3
    with pytest.raises(SolidgearError, match="overlap"):
        sg.PlanetaryTeeth(16, 89, 194, 1e-3)
    assert sg.PlanetaryTeeth(17, 34, 85, 1e-3, planets=1).spacing == np.inf
