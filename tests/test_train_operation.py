"""Operating points: mesh force, settled bearings, displacements, misalignment and their bars."""

import json
from math import cos, pi
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SceneError, SolidgearError
from solidgear.core.scene.gravity import GRAVITY
from solidgear.strength.deflection.at_rest import deflect, deflection
from solidgear.strength.deflection.misalignment import misalignment
from solidgear.strength.load import AT_REST
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.load.operation import Operating, at_point
from solidgear.trains.modes.modes import train_modes

GEOMETRY = Path(__file__).parent.parent / "geometry"
GEARBOX = GEOMETRY / "gearbox_train.toml"
HAND = {"left": "right", "right": "left"}

SHAFT = """
[material]
E = "206 GPa"
nu = 0.29
density = "7830 kg/m^3"
[[segment]]
kind = "cylinder"
name = "a"
length = "70 mm"
diameter = "35 mm"
[[segment]]
kind = "cylinder"
name = "wheel"
length = "40 mm"
diameter = "62 mm"
[[segment]]
kind = "cylinder"
name = "b"
length = "110 mm"
diameter = "35 mm"
[[bearing]]
name = "{0}1"
position = "20 mm"
seat_width = "1 mm"
attachment = "section"
stiffness = {{kxx = "2e8 N/m", kyy = "9e7 N/m", kzz = "2.4e8 N/m", kthx = "2e4 N*m/rad", kthz = "1.5e4 N*m/rad"}}
[[bearing]]
name = "{0}2"
position = "-25 mm"
from = "end"
seat_width = "1 mm"
attachment = "section"
stiffness = {{kxx = "1.6e8 N/m", kzz = "1.8e8 N/m"}}
[port]
name = "{0}"
at = "wheel.middle"
attach_to = "wheel"
attachment = "section"
"""

TRAIN = """
[pinion]
scene = "p.toml"
teeth = 23
hand = "left"
loaded_side = "concave"
pitch_radius = "31 mm"
pitch_angle = 0.0
spiral_angle = "18 deg"
face_width = "40 mm"
[gear]
scene = "g.toml"
teeth = 57
hand = "right"
pitch_radius = "76.826 mm"
[gear.head]
mass = "6.4 kg"
torsional = "0.0195 kg*m^2"
bending = "0.0104 kg*m^2"
[mesh]
shaft_angle = 0
stiffness = "3.2e8 N/m"
pressure_angle = "20 deg"
transmission_error = "1 um"
[engine]
inertia = "0.03 kg*m^2"
[engine.spring]
stiffness = "4e3 N*m/rad"
at = "p1"
[load]
inertia = "0.3 kg*m^2"
[load.spring]
stiffness = "9e3 N*m/rad"
at = "g2"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    where = tmp_path_factory.mktemp("helical")
    for name in "pg":
        (where / f"{name}.toml").write_text(SHAFT.format(name))
    (where / "train.toml").write_text(TRAIN)
    return where


@pytest.fixture(scope="module")
def helical(folder):
    return sg.load_train(folder / "train.toml")


@pytest.fixture(scope="module")
def gearbox():
    return Assembly(sg.load_train(GEARBOX))


def settled_at(train, torque, **more):
    return Operating(Assembly(train), "timoshenko").at(OperatingPoint(torque=torque, **more))


# ----------------------------------------------------------------------- equilibrium
def test_displacement_of_a_helical_pinion_is_that_of_an_independent_model(helical):
    # figures of a beam model of its own, told with six digits; it lets the teeth pull along the
    # same line, so that all signs are turned round against a pair of teeth that push
    moved = settled_at(helical, 100.0).motion("pinion.p")
    told = np.array([8.937, 11.944, 20.293, 66.18, -56.95]) * 1e-6
    assert moved[[0, 1, 2, 3, 5]] == pytest.approx(told, rel=5e-4)  # the last digit of each


def test_every_shaft_is_in_balance(gearbox):
    state = Operating(gearbox, "timoshenko").at(gearbox.train.operation[0])
    forces = state.forces()
    for side in ("pinion", "gear"):
        total, size = np.zeros(6), 0.0
        for station in gearbox.scenes[side].stations:
            six = forces.get(f"{side}.{station.name}")
            if six is not None:
                total[:3] += six[:3]
                total[3:] += six[3:] + np.cross([0.0, station.y, 0.0], six[:3])
                size = max(size, np.linalg.norm(six[:3]))
        # N and N m at arms below one metre: what Newton's search and rounding leave
        assert np.abs(total).max() < 1e-10 * size


def test_mesh_force_is_that_of_the_torque_and_stretches_the_teeth(gearbox):
    state = Operating(gearbox, "timoshenko").at(gearbox.train.operation[0])
    radius = 0.030
    of_teeth = 115.0 / radius / cos(np.radians(20)) / cos(np.radians(15))
    assert state.mesh_force == pytest.approx(of_teeth, rel=1e-12)
    met = gearbox.contact
    ends = zip(("pinion.pinion", "gear.wheel"), (met.pinion, met.gear))
    approach = [vector.vector @ state.motion(end) for end, vector in ends]
    assert met.stiffness * (approach[1] - approach[0]) == pytest.approx(of_teeth, rel=1e-8)


def test_a_mirrored_train_gives_mirrored_answers(helical):
    other = helical.with_changes(
        pinion=helical.pinion.with_changes(hand=HAND[helical.pinion.hand]),
        gear=helical.gear.with_changes(hand=HAND[helical.gear.hand]),
    )
    mirror = np.array([1, 1, -1, -1, -1, 1])  # at the plane z = 0
    for torque in (100.0, -40.0):
        here, there = settled_at(helical, torque), settled_at(other, torque)
        for end in ("pinion.p", "gear.g", "pinion.p2", "gear.g1"):
            size = 1e-10 * abs(here.motion(end)).max()  # rounding of a system of 140 coordinates
            assert there.motion(end) == pytest.approx(mirror * here.motion(end), abs=size)


def test_a_negative_torque_is_carried_by_the_other_flank(helical):
    other = helical.with_changes(pinion=helical.pinion.with_changes(loaded_side="convex"))
    here, there = settled_at(helical, -100.0), settled_at(other, 100.0)
    for end in ("pinion.p", "gear.g2"):
        assert here.motion(end) == pytest.approx(there.motion(end), abs=1e-15)
    # teeth of straight shafts push apart on either flank
    assert here.motion("pinion.p")[0] > 0 < settled_at(helical, 100.0).motion("pinion.p")[0]


def test_bevel_flanks_mirror_at_the_pitch_cone():
    train = sg.load_train(GEOMETRY / "axle_overhung.toml")
    convex = train.with_changes(pinion=train.pinion.with_changes(loaded_side="convex"))
    coast = Assembly(train).on_flank(True).contact.pinion.normal
    assert coast == pytest.approx(Assembly(convex).contact.pinion.normal, abs=1e-15)


def test_without_torque_clearance_is_told_and_no_stiffness_is_made_up(gearbox):
    state = Operating(gearbox, "timoshenko").at(OperatingPoint(torque=0.0))
    assert set(state.equilibrium.lost) == {"pinion.A", "gear.D"}
    assert not state.equilibrium.tangent["pinion.A"].any()
    assert any("pinion.A carries no load" in note for note in state.notes)
    resting = at_point(gearbox.train.with_changes(operation=({"torque": 0.0},)))
    assert resting.unloaded == ("pinion.A", "gear.D")
    assert any("pinion.A carries no load" in c for c in Assembly(resting).cautions())


def test_weight_is_carried_by_the_bearings(helical):
    found = settled_at(helical, 0.0, weight="-z").equilibrium
    pinion = helical.pinion.scene
    volume = sum(pi / 4 * (2 * s.outer0) ** 2 * s.length for s in pinion.segments)
    carried = sum(v[2] for end, v in found.load.items() if end.startswith("pinion"))
    assert carried == pytest.approx(-7830 * volume * GRAVITY, rel=1e-9)
    on_gear = sum(v[2] for end, v in found.load.items() if end.startswith("gear"))
    assert on_gear == pytest.approx(-(7830 * volume + 6.4) * GRAVITY, rel=1e-9)


def test_a_belt_joins_the_mesh_force(helical):
    pull = {"at": "gear.g2", "x": "800 N"}
    alone, pulled = settled_at(helical, 50.0), settled_at(helical, 50.0, force=(pull,))
    both = [
        sum(v[0] for end, v in s.equilibrium.load.items() if end.startswith("gear"))
        for s in (alone, pulled)
    ]
    assert both[1] - both[0] == pytest.approx(800.0, rel=1e-9)


def test_stiffness_follows_the_torque(gearbox):
    operating, last = Operating(gearbox, "timoshenko"), None
    stiffness = []
    for torque in (10.0, 50.0, 115.0, 300.0):
        last = operating.at(OperatingPoint(torque=torque), last)
        alone = Operating(gearbox, "timoshenko").at(OperatingPoint(torque=torque))
        # where the search begins does not matter: the equilibrium is one
        assert last.motion("pinion.A") == pytest.approx(alone.motion("pinion.A"), abs=1e-13)
        stiffness.append(last.equilibrium.tangent["pinion.A"][2, 2])
    assert stiffness == sorted(stiffness) and stiffness[-1] > 2 * stiffness[0]


def test_modes_are_those_of_the_point():
    train = sg.load_train(GEARBOX)
    found = {
        torque: train_modes(
            Assembly(at_point(train.with_changes(operation=({"torque": torque},)))),
            "timoshenko",
            "timoshenko",
            max_frequency=2000.0,
        )
        for torque in (10.0, 115.0)
    }
    # of the pinion, whose bearings are those of a prototype of its own that shares no code:
    # 1275 Hz at 10 N m, 1680 Hz at 115 N m on another wheel shaft
    first = [
        next(m.frequency_hz for m in found[t].modes if m.name.startswith("pinion bending"))
        for t in (10.0, 115.0)
    ]
    assert first[1] > 1.2 * first[0]
    assert "115 N m" in found[115.0].train


# ----------------------------------------------------------------------- displacements
def alone(scene, model):
    """Deflection of a shaft under the load of its scene."""
    return deflection(Assembly.of(scene), AT_REST, model).shafts[0]


def simply_bent(lengths, diameters, E, load, at, ends):
    """Deflection under a load on a stepped beam between two springs, by Castigliano's integral."""
    a, b = ends[0][0], ends[1][0]
    share = (b - at) / (b - a)
    edges = np.unique(np.r_[np.cumsum([0.0, *lengths]), a, at, b])
    total = 0.0
    points, weights = np.polynomial.legendre.leggauss(4)  # squares of straight lines: exact
    for low, high in zip(edges, edges[1:]):
        middle = (low + high) / 2
        if not a < middle < b:
            continue
        k = int(np.searchsorted(np.cumsum(lengths), middle))
        inertia = pi / 64 * diameters[k] ** 4
        y = middle + points * (high - low) / 2
        moment = np.where(y < at, share * (y - a), (1 - share) * (b - y))
        total += (high - low) / 2 * float(weights @ moment**2) / (E * inertia)
    for (_, stiffness), part in zip(ends, (share, 1 - share)):
        total += part**2 / stiffness
    return load * total


def test_deflection_of_a_stepped_shaft_is_that_of_castigliano(folder):
    scene = sg.load(folder / "p.toml")
    soft = [
        b.with_changes(matrix=np.diag([k, 9e7 * (b.name == "p1"), k, 0, 0, 0]))
        for b, k in zip(scene.bearings, (2e8, 1.6e8))
    ]
    scene = scene.with_changes(bearings=tuple(soft), load={"z": 1000.0})
    found = alone(scene, "euler")
    ends = [(0.020, 2e8), (0.195, 1.6e8)]
    told = simply_bent([0.07, 0.04, 0.11], [0.035, 0.062, 0.035], 206e9, 1000.0, 0.09, ends)
    assert found.ports["p"][2] == pytest.approx(told, rel=1e-8)
    at = int(np.argmin(abs(found.stations - 0.09)))
    assert found.line[at, 2] == pytest.approx(told, rel=1e-8)


@pytest.mark.long
def test_a_solid_deflects_as_the_harmonic_solid_does():
    firm = {"kxx": 1e9, "kyy": 1e8, "kzz": 1e9}
    scene = sg.Scene.from_parts(
        [sg.Segment.cylinder("rod", length=0.1, diameter=0.05)],
        bearings=[
            sg.Bearing(name=name, y=y, seat_width=0.02, stiffness=firm)
            for name, y in (("a", 0.015), ("b", 0.085))
        ],
        port=sg.Port(name="p", y=0.05, lo=0.04, hi=0.06),
    ).with_changes(load={"z": 1000.0, "y": 500.0})
    models = [alone(scene, model) for model in ("timoshenko", "harmonic", "solid")]
    beam, harmonic, solid = (shaft.ports["p"][[1, 2, 3]] for shaft in models)
    # a coarse mesh of the 3D solid is some tenths of a per cent stiff; beams are off by more
    assert solid == pytest.approx(harmonic, rel=1e-2)
    assert abs(beam[1] / harmonic[1] - 1) > 1e-2


def test_a_clamped_shaft_deflects_as_its_compliance_says():
    """Held seats are as stiff as Newton's search resolves: a millionth of the shaft's flexibility."""
    scene = sg.load(GEOMETRY / "rotor_disc.toml").with_changes(load={"z": 1000.0, "y": 100.0})
    found = alone(scene, "timoshenko")
    body = sg.build(scene, "timoshenko")
    told = sg.condense(body, scene, port="fan").compliance @ np.array(scene.load.six)
    assert found.ports["fan"] == pytest.approx(told, rel=1e-5, abs=1e-6 * np.abs(told).max())
    assert sum(b.load for b in found.bearings)[[1, 2]] == pytest.approx([100.0, 1000.0])


def test_a_shaft_without_bearings_is_refused():
    scene = sg.load(GEOMETRY / "cylinder_free.toml").with_changes(load={"z": 1000.0})
    with pytest.raises(SolidgearError, match="it has no bearing"):
        alone(scene, "euler")


# ----------------------------------------------------------------------- misalignment
def port_y(train):
    """The middle of the pinion's face."""
    return train.pinion.scene.port.y


def test_with_one_shaft_rigid_the_misalignment_is_the_slope_of_the_other(helical):
    stiff = [
        b.with_changes(matrix=np.array(b.stiffness) * 1e6) for b in helical.gear.scene.bearings
    ]
    gear = helical.gear.with_changes(scene=helical.gear.scene.with_changes(bearings=tuple(stiff)))
    assembly = Assembly(helical.with_changes(gear=gear))
    found = deflection(assembly, OperatingPoint(torque=100.0), "timoshenko", "rigid/euler")
    tilt = np.array([m.value for m in found.displacement["pinion"]])[3:]
    slope = np.cross(tilt, [0.0, 1.0, 0.0])
    normal = assembly.contact.pinion.normal * [1, 0, 1]
    normal = normal / np.linalg.norm(normal)
    told = {m.name: m.value for m in found.misalignment}
    # bearings of the gear give by a millionth of what those of the pinion do
    assert told["in plane"] == pytest.approx(slope @ normal, rel=1e-4)
    wound = told["f_sh"] - told["wind-up"]
    assert wound == pytest.approx(0.040 * told["in plane"], rel=1e-12)
    # T b / (2 G J) of the pinion alone, for the gear is rigid, at the transverse lever
    segment = next(s for s in helical.pinion.scene.segments if s.y0 <= port_y(helical) <= s.y1)
    shear = segment.material.E / (2 * (1 + segment.material.nu))
    twist = 100.0 * 0.040 / (2 * shear * np.pi / 2 * segment.outer0**4)
    vector = assembly.contact.pinion
    lever = abs(vector.lever) / np.hypot(vector.normal[0], vector.normal[2])
    assert abs(told["wind-up"]) == pytest.approx(lever * twist, rel=1e-9)


def test_misalignment_of_parallel_shafts_is_that_of_both(helical):
    assembly = Assembly(helical)
    found = deflection(assembly, OperatingPoint(torque=100.0), "timoshenko", "timoshenko")
    tilt = [np.array([m.value for m in found.displacement[s]])[3:] for s in ("pinion", "gear")]
    slope = np.cross(tilt[0] - tilt[1], [0.0, 1.0, 0.0])
    normal = assembly.contact.pinion.normal * [1, 0, 1]
    told = {m.name: m.value for m in found.misalignment}
    assert told["in plane"] == pytest.approx(slope @ normal / np.linalg.norm(normal), rel=1e-9)


@pytest.fixture(scope="module")
def bevel():
    return Assembly(sg.load_train(GEOMETRY / "axle_overhung.toml"))


@pytest.mark.parametrize(
    "motion, told",
    [
        ([0, 1, 0, 0, 0, 0], {"P": 1.0}),  # the pinion along its axis, away from the apex
        ([0, 0, 1, 0, 0, 0], {"E": 1.0}),
        ([0, 0, 0, 0, 1, 0], {}),  # turning about its axis misaligns nothing
        ([0, 0, 0, 0, 0, 1], {"shaft angle": -1.0}),
    ],
)
def test_misalignment_of_bevel_gears_by_rigid_motions(bevel, motion, told):
    """Motions about the crossing point of the axes, x_p = -y_g, of the overhung pair."""
    system = bevel.system("rigid/euler")
    found = {m.name: m.row for m in misalignment(bevel, system)}
    port = system.port("pinion.pinion")
    # the pinion's own axis passes the crossing at x = z = 0, beneath the gear's lumped point
    crossing = np.array([0.0, system.port("gear.gear").point[1], 0.0])
    arm = port.point - crossing
    u, t = np.array(motion[:3], float), np.array(motion[3:], float)
    at_port = np.r_[u + np.cross(t, arm), t]
    coordinates = np.zeros(system.size)
    place = system.place("pinion")
    coordinates[place] = np.linalg.lstsq(port.rows[:, place], at_port, rcond=None)[0]
    expected = dict.fromkeys(found, 0.0) | told
    for name, row in found.items():
        assert row @ coordinates == pytest.approx(expected[name], abs=1e-9), name


# ----------------------------------------------------------------------- bars and verdict
@pytest.mark.slow
def test_bars_hold_what_a_finer_mesh_changes(helical):
    point = OperatingPoint(torque=100.0)
    coarse = Assembly(helical, kept=6, settings={"harmonic": {"order": 2, "layers": 1}})
    finer = Assembly(helical, kept=6, settings={"harmonic": {"order": 3, "layers": 1}})
    here, there = (deflection(w, point, "harmonic", "harmonic") for w in (coarse, finer))
    pairs = [*zip(here.misalignment, there.misalignment)]
    pairs += zip(here.displacement["pinion"][:4], there.displacement["pinion"][:4])
    for mine, fine in pairs:
        if mine.name == "wind-up":  # by the force, which no mesh moves
            assert mine.value == pytest.approx(fine.value, rel=1e-9)
            continue
        assert 0 < abs(mine.value - fine.value) <= mine.bar + fine.bar, mine.name
        assert fine.bar < mine.bar < 0.05 * abs(mine.value), mine.name


@pytest.mark.long
def test_verdict_names_the_cheapest_model_that_holds(helical):
    loose = helical.with_changes(ask=helical.ask.with_changes(tolerance=0.5))
    assembly = Assembly(loose, kept=6, settings={"harmonic": {"order": 2, "layers": 0}})
    found = deflect(assembly, OperatingPoint(torque=100.0))
    standing = {one.model: one.verdict for one in found.standings}
    assert standing["timoshenko"] == "within" and found.cheapest is not None
    assert found.cheapest.model in found.verdict()


# ----------------------------------------------------------------------- refusals
def written(folder, operation, **members):
    text = TRAIN
    for key, line in members.items():
        text = text.replace(f"[{key}]\n", f"[{key}]\n{line}\n")
    (folder / "op.toml").write_text(text + operation)
    return folder / "op.toml"


@pytest.mark.parametrize(
    "operation, words",
    [
        ('[operation]\ntorque = "115 mm"', 'operation.torque = "115 mm"'),
        ('[operation]\nspeed = "3000 rpm"', "operation.torque"),
        (
            '[operation]\ntorque = "100 N*m"\noutput_torque = "90 N*m"',
            "are balanced by 247.826 N m on the gear",
        ),
        (
            '[operation]\ntorque = "1 N*m"\nspeed = "3000 rpm"\noutput_speed = "3000 rpm"',
            "the teeth turn the gear at 1210.53 rpm",
        ),
        (
            '[[operation]]\ntorque = "1 N*m"\nshare = 0.5\n[[operation]]\ntorque = "2 N*m"\nshare = 0.4',
            "sum to 0.9",
        ),
        (
            '[[operation]]\ntorque = "1 N*m"\nhours = 5\n[[operation]]\ntorque = "2 N*m"',
            "other operating points have hours, so that each needs it",
        ),
        (
            '[operation]\ntorque = "1 N*m"\nforce = [{at = "gear.p1", x = "5 N"}]',
            "names no port of a shaft",
        ),
    ],
)
def test_a_wrong_operation_is_refused_in_one_sentence(folder, operation, words):
    with pytest.raises(SceneError) as error:
        sg.load_train(written(folder, operation))
    assert words in str(error.value) and "op.toml" in str(error.value)
    assert len(str(error.value).splitlines()) == 1


def test_a_torque_needs_a_shaft_that_turns(folder):
    held = SHAFT.format("p").replace('kyy = "9e7 N/m"', 'kyy = "9e7 N/m", kthy = "1e5 N*m/rad"')
    (folder / "p_held.toml").write_text(held)
    path = written(folder, '[operation]\ntorque = "10 N*m"')
    path.write_text(path.read_text().replace('"p.toml"', '"p_held.toml"'))
    with pytest.raises(SceneError, match="p1 of its scene holds its rotation"):
        sg.load_train(path)


def test_a_load_that_is_not_the_mesh_force_is_refused_with_both(folder):
    (folder / "p_loaded.toml").write_text(SHAFT.format("p") + '[load]\nx = "9 kN"\n')
    path = written(folder, '[operation]\ntorque = "100 N*m"')
    text = path.read_text().replace('"p.toml"', '"p_loaded.toml"')
    path.write_text(text)
    with pytest.raises(SceneError, match=r"\(9000, 0, 0\) N .* and the mesh force is \(") as error:
        sg.load_train(path)
    assert "scene_load" in str(error.value)
    path.write_text(text.replace("[pinion]\n", '[pinion]\nscene_load = "added"\n'))
    train = sg.load_train(path)
    state = Operating(Assembly(train), "timoshenko").at(train.operation[0])
    assert any("added" in note for note in state.notes)
    carried = sum(v[0] for end, v in state.equilibrium.load.items() if end.startswith("pinion"))
    alone = settled_at(sg.load_train(folder / "train.toml"), 100.0).equilibrium.load
    assert carried - sum(v[0] for e, v in alone.items() if e.startswith("pinion")) == pytest.approx(
        9000, rel=1e-9
    )


def test_a_load_that_pulls_the_teeth_apart_is_refused(tmp_path):
    text = GEARBOX.read_text().replace('scene_load = "replaced"', "")
    text = text[: text.index("# Operating points.")]
    for name in ("gearbox_catalogue.toml", "gearbox_wheel.toml"):
        (tmp_path / name).write_text((GEOMETRY / name).read_text())
    wheel = tmp_path / "gearbox_wheel.toml"
    push = sg.load_train(GEARBOX)
    push = Assembly(push).contact.gear.normal  # the teeth push the wheel against it
    pull = "\n".join(f"{d} = {1000 * v}" for d, v in zip("xyz", push))
    unloaded, _, _ = wheel.read_text().partition("[load]")
    wheel.write_text(f"{unloaded}[load]\n{pull}\n")
    (tmp_path / "train.toml").write_text(text)
    with pytest.raises(SceneError, match="pulls the teeth apart"):
        Assembly(sg.load_train(tmp_path / "train.toml"))


def test_a_new_load_drops_the_stiffness_of_the_old_one():
    scene = sg.load(GEOMETRY / "gearbox_catalogue.toml")
    other = scene.with_changes(load={"z": 100.0})
    assert [b.matrix for b in other.bearings] == [None, None]
    assert [b.matrix for b in scene.with_changes(title="x").bearings] == [
        b.matrix for b in scene.bearings
    ]


def test_a_point_that_is_not_there_is_named(gearbox):
    with pytest.raises(SolidgearError, match="there are 1 'full', 2 'coast'"):
        at_point(gearbox.train, "idle")


# ----------------------------------------------------------------------- command
@pytest.mark.long
def test_deflect_writes_what_it_says(tmp_path, run):
    data = json.loads(run("deflect", GEARBOX, "-f", "euler", "-f", "timoshenko", "--json")[1])
    how = "-f", "euler", "-f", "timoshenko", "--out", tmp_path
    said = run("deflect", GEARBOX, *how)[1]
    model = data["models"]["timoshenko"]
    six = model["displacement"]["pinion"]
    assert list(six) == ["x", "y", "z", "thx", "thy", "thz"]
    state = Operating(Assembly(sg.load_train(GEARBOX)), "timoshenko").at(
        sg.load_train(GEARBOX).operation[0]
    )
    assert six["z"]["value"] == pytest.approx(state.motion("pinion.pinion")[2], rel=1e-9)
    assert len(model["shafts"]["pinion"]["bearings"][0]["rows"][0]["element_load"]) == 13
    assert "f_sh" in said and "Mesh force 4223.3 N" in said
    assert (tmp_path / "deflection.html").exists() and (tmp_path / "deflection_gear.csv").exists()
    written = json.loads((tmp_path / "deflection.json").read_text())
    assert written["standings"] == data["standings"] and written.keys() == data.keys()


@pytest.mark.long
def test_every_point_of_a_train_is_told_as_it_is_alone(run):
    """Points are settled one after the other, and no answer hangs on the one before."""
    both = json.loads(run("deflect", GEARBOX, "-f", "timoshenko", "--json")[1])["points"]
    alone = run("deflect", GEARBOX, "-f", "timoshenko", "--point", "coast", "--json")[1]
    assert json.loads(alone)["points"] == []
    lies = json.loads(alone)["models"]["timoshenko"]["misalignment"]
    assert [one["point"]["name"] for one in both] == ["full", "coast"]
    assert both[1]["misalignment"]["f_sh"]["value"] == pytest.approx(
        lies["f_sh"]["value"], rel=1e-8
    )
    told = run("deflect", GEARBOX, "-f", "timoshenko")[1]
    assert "Misalignment over the operating points" in told and "coast (-30 N m" in told


def test_a_motion_that_is_none_is_no_small_number(run):
    """The engine's spring port does not turn; rounding of it is no figure to be read."""
    told = run("deflect", GEARBOX, "-f", "timoshenko", "--point", "coast")[1]
    rows = map(str.split, told.partition("Displacements")[2].splitlines())
    assert next(row for row in rows if row[:1] == ["pinion.B"])[5] == "0"
