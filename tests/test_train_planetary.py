"""Planetary stages in a train file, against matrices written by hand from rigid bodies and textbook
forces, closed forms and statics.
"""

import re
from math import atan, cos, pi, radians, sin, tan

import numpy as np
import pytest
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.errors import SceneError
from solidgear.strength.deflection.at_rest import deflection
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.kinematics import train_orders
from solidgear.trains.assembly.layout import mesh_forces
from solidgear.trains.assembly.stages import mesh_row
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.planetary import MATES
from solidgear.trains.file.train import with_carrier_turned
from solidgear.trains.load.operation import Operating
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.respond import respond
from validation.reducer.design import FACE, Design

REDUCER, RIGID = "geometry/reducer.toml", "rigid/timoshenko"
#: both are eigenvalues of the same coordinates, whose stiffness spans five decades
ROUNDING = 1e-9
TEETH, MODULE, PRESSURE = (17, 34, 85), 2e-3, radians(20)
#: length and diameter, m; density
SUN, CARRIER, DENSITY = (0.04, 0.03), (0.03, 0.16), 7850.0
BEARING = [8e7, 5e7, 9e7, 2e4, 0.0, 3e4]
#: between x and z of both bearings, so that no mirror leaves them as they are
ACROSS = 3e7
PLANET = {"mass": 0.6, "torsional": 4e-4, "bending": 2.5e-4}
PIN = {"radial": 1e8, "axial": 3e7, "tilting": 2e4}
RING = {"mass": 2.0, "torsional": 0.02, "bending": 0.012}
SUPPORT = {"radial": 2e8, "axial": 1e8, "tilting": 3e5, "turning": 4e5}
UNEQUAL = f"angles = [0.0, {2 * pi * 33 / 102}, {2 * pi * 70 / 102}]"
MESHES, ROTORS = {"sun": 2e8, "ring": 3e8}, {"engine": (0.01, 3e3), "load": (0.5, 4e4)}


def scene_text(length, diameter, port, bearing=BEARING):
    keys = ("kxx", "kyy", "kzz", "kthx", "kthy", "kthz")
    springs = ", ".join(f"{key} = {value}" for key, value in zip(keys, bearing))
    springs += f", kxz = {ACROSS}" * (bearing is BEARING)
    return (
        f'[material]\nE = "206 GPa"\nnu = 0.3\ndensity = {DENSITY}\n'
        f'[[segment]]\nkind = "cylinder"\nname = "s"\nlength = {length}\ndiameter = {diameter}\n'
        f'[[bearing]]\nname = "b"\nposition = {length / 2}\nseat_width = 0.01\n'
        f"stiffness = {{{springs}}}\n"
        f'[port]\nname = "{port}"\nposition = {length / 2}\nspan = [{length / 4}, {3 * length / 4}]\n'
    )


def table(name, values):
    return f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in values.items())


def train_text(helix=0.0, planets="planets = 3", ring=False, position=0.0, teeth=TEETH):
    stage = "planetary.stage"
    out = f'[shaft.sun]\nscene = "sun.toml"\nteeth = {teeth[0]}\nmodule = {MODULE}\n'
    out += f'helix_angle = {helix}\nhand = "right"\n' if helix else ""
    out += '[shaft.carrier]\nscene = "carrier.toml"\n'
    out += f'[{stage}]\nsun = "sun"\ncarrier = "carrier"\nring_teeth = {teeth[2]}\n{planets}\n'
    out += f"position = {position}\n" if position else ""
    out += table(f"{stage}.planet", {"teeth": teeth[1], **PLANET})
    out += table(f"{stage}.planet.pin", PIN)
    stiff = {f"{mate}_stiffness": value for mate, value in MESHES.items()}
    out += table(f"{stage}.mesh", {**stiff, "pressure_angle": PRESSURE, "transmission_error": 1e-6})
    if ring:
        out += table(f"{stage}.ring", RING) + table(f"{stage}.ring.support", SUPPORT)
    for name, (inertia, spring) in ROTORS.items():
        side, port = ("sun", "sun") if name == "engine" else ("carrier", "flange")
        out += f'[{name}]\nshaft = "{side}"\ninertia = {inertia}\n'
        out += f'[{name}.spring]\nstiffness = {spring}\nat = "{port}"\n'
    return out


@pytest.fixture
def written(tmp_path):
    def write(text, sun=BEARING, carrier=BEARING):
        (tmp_path / "sun.toml").write_text(scene_text(*SUN, "sun", sun))
        (tmp_path / "carrier.toml").write_text(scene_text(*CARRIER, "flange", carrier))
        (tmp_path / "train.toml").write_text(text)
        return tmp_path / "train.toml"

    return write


def cylinder(length, diameter):
    mass, radius = DENSITY * pi * diameter**2 / 4 * length, diameter / 2
    across = mass * (3 * radius**2 + length**2) / 12
    return [mass] * 3 + [across, mass * radius**2 / 2, across]


def by_hand(helix, azimuths, ring, way=1.0):
    """Natural frequencies, Hz, of rigid bodies with six motions each in the axes of the sun, the
    sun driving about ``way`` y: a spring pushes along n at p with ``n . (u + t x (p - c))``.
    """
    normal = atan(tan(PRESSURE) / cos(helix))
    base = atan(tan(helix) * cos(normal))
    pitch = [MODULE / cos(helix) * z / 2 for z in TEETH]
    y = np.array([0.0, 1.0, 0.0])
    mass = cylinder(*SUN) + cylinder(*CARRIER)
    mass += [RING["mass"]] * 3 + [RING["bending"], RING["torsional"], RING["bending"]]
    for _ in azimuths:
        mass += [PLANET["mass"]] * 3 + [PLANET["bending"], PLANET["torsional"], PLANET["bending"]]
    mass += [inertia for inertia, _ in ROTORS.values()]
    one = np.eye(len(mass))
    sun, carrier, rim = one[:6], one[6:12], one[12:18]
    alone = BEARING - ACROSS * np.array([1, 0, 1, 0, 0, 0])
    springs = [(k, row) for body in (sun, carrier) for k, row in zip(alone, body)]
    springs += [(ACROSS, body[0] + body[2]) for body in (sun, carrier)]
    still = [SUPPORT[k] for k in "radial axial radial tilting turning tilting".split()]
    springs += list(zip(still, rim))
    for body, rotor, (_, stiffness) in zip((sun, carrier), one[-2:], ROTORS.values()):
        springs.append((stiffness, body[4] - rotor))

    def moved(body, centre, point, n):
        return n @ body[:3] + np.cross(point - centre, n) @ body[3:]

    nought = np.zeros(3)
    for k, psi in enumerate(azimuths):
        planet = one[18 + 6 * k : 24 + 6 * k]
        out = np.array([cos(psi), 0.0, -sin(psi)])
        forward = way * np.cross(y, out)
        centre = (pitch[0] + pitch[1]) * out
        # teeth of a right-handed sun run along cos y + sin (y x out): their force is across
        lean = way * sin(base) * y
        at_sun = cos(base) * (cos(normal) * forward + sin(normal) * out) - lean
        at_ring = cos(base) * (cos(normal) * forward - sin(normal) * out) + lean
        for stiff, mate, n, point in (
            (MESHES["sun"], sun, at_sun, pitch[0] * out),
            (MESHES["ring"], rim, at_ring, pitch[2] * out),
        ):
            row = moved(planet, centre, point, n)
            grounded = mate is rim and not ring
            springs.append((stiff, row if grounded else row - moved(mate, nought, point, n)))
        for axis, k_moves, k_turns in (
            (out, PIN["radial"], PIN["tilting"]),
            (y, PIN["axial"], 0.0),
            (forward, PIN["radial"], PIN["tilting"]),
        ):
            row = moved(planet, centre, centre, axis) - moved(carrier, nought, centre, axis)
            springs += [(k_moves, row), (k_turns, axis @ (planet[3:] - carrier[3:]))]
    keep = [i for i in range(len(mass)) if ring or not 12 <= i < 18]
    stiffness = sum(k * np.outer(row, row) for k, row in springs)[np.ix_(keep, keep)]
    found = sla.eigvalsh(stiffness, np.diag(np.array(mass)[keep]))
    return np.sqrt(np.abs(found[1:])) / (2 * pi)  # the first turns freely


@pytest.mark.parametrize(
    "helix, planets, ring, position",
    [
        (0.0, "planets = 3", False, 0.0),
        (0.3, "planets = 3", True, 0.2),
        (0.3, UNEQUAL, False, 0.0),
    ],
)
def test_a_stage_on_rigid_shafts_has_the_frequencies_of_matrices_written_by_hand(
    written, helix, planets, ring, position
):
    train = sg.load_train(written(train_text(helix, planets, ring, position)))
    azimuths = np.array(train.stages[0].teeth.azimuths) + position
    found = Assembly(train).system(RIGID).modes()
    assert found.rigid == 1
    known = by_hand(helix, azimuths, ring)
    np.testing.assert_allclose(found.frequency_hz[1:], known, rtol=ROUNDING)


def test_teeth_of_planets_push_by_the_other_flank_where_the_sun_is_driven_back(written):
    train = sg.load_train(written(train_text(0.3, UNEQUAL)))
    azimuths = train.stages[0].teeth.azimuths
    found = Assembly(train).on_flank(True).system(RIGID).modes().frequency_hz[1:]
    known = by_hand(0.3, azimuths, False, way=-1.0)
    np.testing.assert_allclose(found, known, rtol=ROUNDING)
    assert abs(found / by_hand(0.3, azimuths, False) - 1).max() > 1e-3  # not the drive flank's


def test_speeds_ratio_and_mean_forces_are_those_of_the_teeth():
    train = sg.load_train(REDUCER)
    point, turns = train.point, train.turns
    assert train.ratio == pytest.approx(10, rel=1e-14)
    carrier = point.speed_of("output", turns) / (2 * pi)
    assert carrier == pytest.approx(8000 / 60 / 10, rel=1e-14)
    hertz = {order.name: order.per_turn * 8000 / 60 for order in train_orders(train)}
    assert hertz["mesh stage 1"] == pytest.approx(85 * carrier, rel=1e-14)
    assert hertz["stage planets 1"] == pytest.approx(3 * carrier, rel=1e-14)
    assert hertz["stage planet 1"] == pytest.approx(85 / 34 * carrier, rel=1e-14)
    forces = mesh_forces(train, Assembly(train).contacts, point)
    base = 1.25e-3 * 17 * cos(radians(20)) / 2
    assert forces["mesh stage"] == pytest.approx(4 * 25 / 15 / (3 * base), rel=1e-10)


def planet_forces(state, planets=3):
    rows = [
        mesh_row(state.system, f"mesh stage {m} {k}") for m in MATES for k in range(1, planets + 1)
    ]
    return np.array([k * (row @ state.coordinates) for row, k in rows]).reshape(2, planets)


def test_equal_planets_on_a_train_that_holds_the_sun_share_equally_and_torques_balance(written):
    point = OperatingPoint(torque=50.0, of="sun")
    train = sg.load_train(written(train_text(0.3)), point)
    state = Operating(Assembly(train), RIGID).at(point)
    base = train.stages[0].teeth.base_radii[0] * cos(train.stages[0].teeth.base_helix)
    np.testing.assert_allclose(planet_forces(state), 50 / (3 * base), rtol=1e-10)
    assert state.outside["engine"][4] == pytest.approx(50, rel=1e-10)
    assert state.outside["load"][4] == pytest.approx(-50 * 6, rel=1e-10)


def test_a_force_on_the_sun_modulates_every_mesh_by_the_closed_form(written):
    # the carrier gives by 1e-6 of what the sun's support does, and springs that stiff leave 1e-7
    springs, load, still = 4e7, 800.0, 1e14
    sun = [springs, 1e8, springs, 1e5, 0.0, 1e5]
    carrier = [still, still, still, still, 0.0, still]
    force = {"at": "sun.sun", "x": load}
    point = OperatingPoint(torque=300.0, of="sun", force=(force,))
    train = sg.load_train(written(train_text(), sun, carrier), point)
    (turn,) = deflection(Assembly(train), point, RIGID).turns
    shift, path = load / springs, path_stiffness()
    once = path * shift * springs / (springs + 3 / 2 * path)
    assert [planet.once for planet in turn.planets] == pytest.approx([once] * 3, rel=1e-5)
    mean = 300 / (3 * train.stages[0].teeth.base_radii[0])
    assert [planet.mean for planet in turn.planets] == pytest.approx([mean] * 3, rel=1e-10)


def test_over_a_turn_of_its_carrier_the_reducer_is_what_it_is_at_rest_at_every_position():
    train = sg.load_train(REDUCER)
    assembly = Assembly(train)
    (turn,) = deflection(assembly, train.point, "timoshenko").turns
    assert turn.planets[0].once > 0.03 * turn.planets[0].mean  # the sun hangs on a cantilever
    assert turn.planets[0].once == pytest.approx(turn.planets[2].once, rel=1e-6)
    for k in (0, 25):  # bearings settle anew, and carry the same
        there = assembly.with_train(with_carrier_turned(train, "stage", turn.angle[k]))
        state = Operating(there, "timoshenko").at(train.point)
        np.testing.assert_allclose(planet_forces(state), [turn.force[k]] * 2, rtol=1e-7)


def path_stiffness():
    """Through one planet with sun, ring and carrier at rest, whose pin carries both tooth forces."""
    give = 1 / MESHES["sun"] + 1 / MESHES["ring"] + (2 + 2 * cos(2 * PRESSURE)) / PIN["radial"]
    return 1 / give


#: N/m and N m/rad: what springs that stiff give is 1e-6 of what pins do
STILL = [1e14, 1e14, 1e14, 1e14, 0.0, 1e14]


def test_the_weight_of_a_planet_presses_its_teeth_by_what_its_pin_gives(written):
    # both tooth forces F together push along the carrier's way by 2 F cos a, and the pin gives by
    # (W + 2 F cos a) / k_pin there, so that F (1 / k_e) = 2 cos a W / k_pin
    train = sg.load_train(written(train_text(ring=False), STILL, STILL))
    point = OperatingPoint(torque=300.0, of="sun", weight="-z")
    (turn,) = deflection(Assembly(train), point, RIGID).turns
    pressed = 2 * cos(PRESSURE) * PLANET["mass"] * 9.80665 / PIN["radial"]
    once = path_stiffness() * pressed
    assert [planet.once for planet in turn.planets] == pytest.approx([once] * 3, rel=1e-5)


def test_the_carrier_bears_what_flings_planets_at_unequal_angles(written):
    train = sg.load_train(written(train_text(planets=UNEQUAL), STILL, STILL))
    azimuths = np.array(train.stages[0].teeth.azimuths)
    at_rest, turning = (
        Operating(Assembly(train), RIGID).at(OperatingPoint(torque=300.0, of="sun", speed=speed))
        for speed in (None, 600.0)
    )
    more = turning.equilibrium.load["carrier.b"] - at_rest.equilibrium.load["carrier.b"]
    each = PLANET["mass"] * (600.0 / 6) ** 2 * MODULE * (17 + 34) / 2
    away = np.array([np.cos(azimuths), np.zeros(3), -np.sin(azimuths)]).sum(axis=1)
    # nothing gives but pins, away from the sun, where both teeth of a planet press as before
    np.testing.assert_allclose(more[:3], each * away, atol=1e-5 * each)


@pytest.mark.parametrize("planets", ["planets = 3", UNEQUAL])
def test_with_weight_and_at_speed_a_turn_of_the_carrier_is_what_is_at_rest_at_every_position(
    written, planets
):
    train = sg.load_train(written(train_text(0.3, planets, ring=True)))
    point = OperatingPoint(torque=50.0, of="sun", weight="-z", speed=2000.0)
    (turn,) = deflection(Assembly(train), point, RIGID).turns
    assert turn.planets[0].once > 5.0
    for k in (0, 25):
        there = Assembly(with_carrier_turned(train, "stage", turn.angle[k]))
        found = planet_forces(Operating(there, RIGID).at(point))
        np.testing.assert_allclose(found, [turn.force[k]] * 2, rtol=1e-9)


@pytest.mark.long
def test_frequencies_hang_on_the_position_of_unequal_planets_alone(written):
    train = sg.load_train(written(train_text(0.3)))
    at = [
        Assembly(with_carrier_turned(train, "stage", by)).system(RIGID).modes().frequency_hz
        for by in (0.0, 0.7)
    ]
    np.testing.assert_allclose(at[1][1:], at[0][1:], rtol=ROUNDING)
    assert "do not depend on the position" in train_modes(Assembly(train), RIGID).turn
    pair = sg.load_train(written(train_text(planets="planets = 2")))
    told = train_modes(Assembly(pair), RIGID).turn
    assert "solved at 6 positions" in told
    share = float(told.split(" up to ")[1].split(" %")[0]) / 100
    hz = [
        Assembly(with_carrier_turned(pair, "stage", k * pi / 3))
        .system(RIGID)
        .modes()
        .frequency_hz[1:]
        for k in range(6)
    ]
    count = len(train_modes(Assembly(pair), RIGID).modes) - 1
    assert share == pytest.approx((np.ptp(hz, axis=0) / hz[0])[:count].max(), rel=0.05)
    assert share > 1e-3


def test_modes_of_planets_are_named_as_the_theory_does(written):
    train = sg.load_train(written(train_text(planets="planets = 6", teeth=(30, 18, 66)) + ASK))
    modes = train_modes(Assembly(train), RIGID).modes
    words = {"train", "sun", "carrier", "stage", "load", "engine"}
    assert {mode.name.split()[0] for mode in modes} <= words
    own = [mode for mode in modes if mode.name.startswith("stage planet ")]
    hz = [mode.frequency_hz for mode in own]
    # each three times, for six planets at equal angles leave 6 - 3 phases in which all else rests
    assert len(hz) == 9 and hz[::3] == pytest.approx(hz[2::3], rel=ROUNDING)
    assert {mode.strained.split(" ")[0] for mode in own} <= {"mesh", "stage"}


ASK = "[ask]\nmax_frequency = 20e3\n"
BAD = {
    "ring_teeth = 85": ("ring_teeth = 86", "a ring of 86 teeth does not fit a sun of 17"),
    "planets = 3": ("planets = 4", "4 planets at equal angles do not assemble: 17 + 85 teeth"),
    "planets = 3 ": ("angles = [0.0, 2.05, 4.1]", "planet 2 does not assemble at 117.456 deg"),
    "planets = 3  ": ("angles = [0.0, 1.4784, 3.69599]", "planets 84.71 deg apart overlap"),
    "planets = 3    ": ("angles = [0, 2.1, 240]", 'degrees are written as "120 deg"'),
    "planets = 3   ": ("", "give either planets, how many at equal angles, or the angles"),
    "ring_teeth = 85 ": ("ring_teeth = 85\nratio = 5.0", "1 + 85/17 = 6"),
    'sun = "sun"': ('sun = "sun.b"', "the sun has no gear at 'b'; it has sun"),
    'sun = "sun" ': ('sun = "shaft"', "names no shaft 'shaft'"),
    'carrier = "carrier"': ('carrier = "career"', "names no shaft 'career'"),
    'carrier = "carrier" ': ('carrier = "sun"', "sun and carrier are one shaft"),
    'carrier = "carrier"  ': ('carrier = "carrier.rim"', "has no lumped point at 'rim'"),
    f"module = {MODULE}\n": ("", "the gear sun.sun, the sun, needs its module"),
    f"teeth = {TEETH[0]}\nmodule = {MODULE}\n": ("", "the sun carries no gear; write teeth and"),
    "radial = 100000000.0": ("radial = 0.0", "must be greater than zero"),
    "[planetary.stage.planet.pin]": ("[planetary.stage.ring.pin]", "planets have no pins"),
}


@pytest.mark.parametrize("right", BAD)
def test_a_stage_that_cannot_be_is_refused_in_one_sentence(written, right):
    wrong, said = BAD[right]
    text = train_text().replace(right.rstrip(" "), wrong, 1)
    with pytest.raises(SceneError, match=re.escape(said)) as found:
        sg.load_train(written(text))
    lines = [line for line in str(found.value).splitlines() if said in line]
    assert len(lines) == 1 and "train.toml: planetary.stage" in lines[0]


def test_the_speeds_of_an_operating_point_are_held_against_the_stage(written):
    text = (
        train_text() + '[operation]\ntorque = 50.0\nspeed = "600 rpm"\noutput_speed = "120 rpm"\n'
    )
    with pytest.raises(SceneError, match="the teeth turn the carrier at 100 rpm"):
        sg.load_train(written(text))


def test_a_carrier_may_drive_and_stages_follow_one_another(written, tmp_path):
    text = train_text(0.2)
    for name, old, new in (("engine", "sun", "carrier"), ("load", "carrier", "sun")):
        text = text.replace(f'[{name}]\nshaft = "{old}"', f'[{name}]\nshaft = "{new}"')
    text = text.replace('at = "sun"', 'at = "x"').replace('at = "flange"', 'at = "sun"')
    train = sg.load_train(written(text.replace('at = "x"', 'at = "flange"')))
    for torque in (60.0, -60.0):  # the engine turns about +y, and so do sun and carrier
        point = OperatingPoint(torque=torque, of="carrier", force=({"at": "sun.sun", "x": 5e3},))
        state = Operating(Assembly(train), RIGID).at(point)
        assert state.outside["load"][4] == pytest.approx(-torque / 6, rel=1e-10)
        (turn,) = deflection(Assembly(train), point, RIGID).turns
        there = Assembly(with_carrier_turned(train, "stage", turn.angle[20]))
        found = planet_forces(Operating(there, RIGID).at(point))
        np.testing.assert_allclose(found, [turn.force[20]] * 2, rtol=1e-7)
        assert np.ptp(turn.force[20]) > 100 and turn.force.mean() > 0  # teeth press either way
    stage = train_text().split("[planetary.stage]")[1].split("[engine]")[0]
    between = scene_text(0.08, 0.05, "flange").replace("[port]", "[[port]]")
    between += '[[port]]\nname = "next"\nposition = 0.07\nspan = [0.065, 0.075]\n'
    (tmp_path / "between.toml").write_text(between)
    text = train_text().replace(
        "[shaft.carrier]",
        '[shaft.between]\nscene = "between.toml"\n[shaft.between.gears.next]\nteeth = 17\n'
        "module = 0.003\n[shaft.carrier]",
    )
    text = text.replace('carrier = "carrier"', 'carrier = "between.flange"')
    last = stage.replace("planetary.stage", "planetary.last").replace('"sun"', '"between"')
    text = text.replace("[engine]", f"[planetary.last]{last}[engine]")
    train = sg.load_train(written(text))
    assert train.ratio == pytest.approx(36, rel=1e-14)
    state = Operating(Assembly(train), RIGID).at(OperatingPoint(torque=10.0, of="sun"))
    assert state.outside["load"][4] == pytest.approx(-360, rel=1e-10)
    row, stiffness = mesh_row(state.system, "mesh last ring 2")
    base = train.stages[1].teeth.base_radii[0]
    assert stiffness * (row @ state.coordinates) == pytest.approx(60 / (3 * base), rel=1e-9)


@pytest.mark.parametrize("teeth, still, moved", [((18, 33, 84), "xz", "thy"), (TEETH, "thy", "xz")])
def test_phases_of_planets_let_a_mesh_turn_the_shafts_or_shift_them(written, teeth, still, moved):
    """Errors in phase cancel across the axis, those that follow one another cancel about it
    (Parker, Journal of Sound and Vibration 236, 2000).
    """
    train = sg.load_train(written(train_text(teeth=teeth)))
    found = respond(Assembly(train), RIGID, mesh="stage sun", frequency_hz=np.array([150.0, 900.0]))
    across = {dof: found.columns[f"sun {dof} [m]"] for dof in ("x", "z")}
    about = found.columns["sun thy [rad]"] * MODULE * teeth[0] / 2
    size = {"xz": np.hypot(*map(abs, across.values())), "thy": np.abs(about)}
    assert np.all(size[still] < 1e-9 * size[moved])


def test_a_planet_alone_drives_as_a_part_of_all_together(written):
    assembly = Assembly(sg.load_train(written(train_text())))
    hz = np.array([400.0])
    alone = [respond(assembly, RIGID, mesh=f"stage ring {k}", frequency_hz=hz) for k in (1, 2, 3)]
    every = respond(assembly, RIGID, mesh="stage ring", frequency_hz=hz)
    behind = np.exp(-1j * TEETH[0] * 2 * pi / 3 * np.arange(3))
    for name in ("sun x [m]", "carrier z [m]", "mesh force stage sun 2 [N]"):
        parts = [turn * one.columns[name] for turn, one in zip(behind, alone)]
        np.testing.assert_allclose(every.columns[name], np.sum(parts, axis=0), rtol=1e-9)
    drive = Drive(assembly, RIGID, mesh="stage ring")
    own = np.sum([turn * one.columns["mesh force stage ring 3 [N]"] for turn, one in
                  zip(behind[:2], alone[:2])], axis=0) + behind[2] * alone[2].force  # fmt: skip
    np.testing.assert_allclose(drive.columns(hz)["mesh force stage ring 3 [N]"], own, rtol=1e-9)


@pytest.mark.long
def test_a_reducer_put_together_by_hand_modulates_as_that_of_the_file():
    """Balance of one shaft between bearing laws and a spring for all planets, by `validation`."""
    design = Design(teeth=(15, 25, 17, 34, 85), hand="right", stiffening=206 / 210)
    train = sg.load_train(REDUCER)
    cone = atan(15 / 25)
    flanks = {"pitch_angle": cone, "face_width": FACE * 19.5e-3 / sin(cone)}
    pinion, wheel, output = train.shafts.values()
    gear = pinion.gears["pinion"].with_changes(**flanks)
    *others, sun = wheel.scene.segments  # up to the roots of its teeth, as the design has it
    root = design.module * (17 - 2.5)
    sun = sun.with_changes(outer0=root / 2, outer1=root / 2)
    still = np.diag([1e14, 1e14, 1e14, 1e14, 0.0, 1e14]).tolist()
    held = [b.with_changes(catalogue=None, matrix=still) for b in output.scene.bearings]
    train = train.with_changes(
        pinion=pinion.with_changes(gears={"pinion": gear}),
        wheel=wheel.with_changes(scene=wheel.scene.with_changes(segments=(*others, sun))),
        output=output.with_changes(scene=output.scene.with_changes(bearings=tuple(held))),
    )
    models = "rigid/timoshenko", "timoshenko", "rigid/timoshenko"
    point = train.point.with_changes(
        speed=None, output_speed=None
    )  # balls of the design have no inertia
    (turn,) = deflection(Assembly(train.with_changes(operation=[point])), point, *models).turns
    # the design's shaft goes on to a third seat, so that its beam has other elements
    assert turn.planets[1].once == pytest.approx(design.modulation(third=False), rel=1e-4)
    assert turn.planets[1].mean == pytest.approx(design.mean_force, rel=1e-10)


def test_a_carrier_without_gears_is_lumped_at_its_main_point():
    """Guyan's shapes are fewer (Rayleigh and Ritz): no frequency is lower than with the body, and a
    rigid body on its bearings below the first bending leaves little to them.
    """
    assembly = Assembly(sg.load_train(REDUCER))
    lumped, whole = (
        assembly.system("timoshenko", "timoshenko", model).modes(6).frequency_hz[1:]
        for model in ("lumped/timoshenko", "timoshenko")
    )
    assert (lumped >= whole * (1 - ROUNDING)).all()
    assert lumped == pytest.approx(whole, rel=5e-2)
    assert assembly.shaft_model("output", "lumped/timoshenko").part.mass.shape == (6, 6)
