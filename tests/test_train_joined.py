"""Planetary stages beside loads that share the power and in a housing, against statics by hand."""

from math import cos

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SceneError
from solidgear.strength.deflection.at_rest import deflection
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.housing import BOX, mount_rows
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.load.operation import Operating
from tests.test_train_housing import carried
from tests.test_train_planetary import (
    CARRIER,
    PRESSURE,
    RIGID,
    SUN,
    planet_forces,
    scene_text,
    train_text,
)
from tests.test_train_power import in_balance

PINION = 0.03  # half of the wheel on the carrier, m
MESH = (
    '[[mesh]]\nbetween = ["carrier", "output"]\nshaft_angle = 0\nazimuth = 0.4\nstiffness = 3e8\n'
    f"pressure_angle = {PRESSURE}\ntransmission_error = 1e-6\n"
)
BOX_TEXT = "[housing]\nmass = 40.0\ninertia = [0.9, 0.7, 0.8]\ncentre = [0.05, 0.03, -0.02]\n"


def built(folder, text):
    places = {"sun": (SUN, "sun"), "carrier": (CARRIER, "flange"), "output": (SUN, "gear")}
    for name, (size, port) in places.items():
        (folder / f"{name}.toml").write_text(scene_text(*size, port))
    (folder / "train.toml").write_text(text)
    return sg.load_train(folder / "train.toml")


def geared(flank="left", more=""):
    """A stage whose carrier drives one load itself, and another over a mesh."""
    teeth = "teeth = {}\npitch_radius = {}\nspiral_angle = 0\nface_width = 0.02\n".format
    own = teeth(40, 2 * PINION) + f'loaded_side = "{flank}"\n'
    text = train_text(0.3).replace('"carrier.toml"\n', '"carrier.toml"\n' + own)
    text = text.replace(
        "[planetary.stage]",
        f'[shaft.output]\nscene = "output.toml"\n{teeth(20, PINION)}[planetary.stage]',
    )
    text, load = text.split("[load]\n")
    load = "share = 0.4\n" + load
    for name, (side, port, share) in {
        "near": ("carrier", "flange", 0.4),
        "far": ("output", "gear", 0.6),
    }.items():
        own = load.replace("[load.", f"[load.{name}.").replace('"carrier"', f'"{side}"')
        own = own.replace('"flange"', f'"{port}"').replace("0.4", str(share))
        text += f"[load.{name}]\n{own}"
    return text.replace("[engine]", more + MESH + "[engine]")


@pytest.mark.parametrize("flank", ["left", "right"])
@pytest.mark.parametrize("torque", [50.0, -50.0])
def test_a_stage_and_a_mesh_pass_what_two_loads_take_of_the_power(tmp_path, torque, flank):
    train = built(tmp_path, geared(flank))
    point = OperatingPoint(torque=torque, of="sun")
    state = Operating(Assembly(train), RIGID).at(point)
    teeth = train.stages[0].teeth
    lever = teeth.base_radii[0] * cos(teeth.base_helix)
    assert state.mesh_forces == pytest.approx(
        {
            "mesh stage": 50 / (3 * lever),
            "mesh carrier-output": 0.6 * 50 * 6 / (2 * PINION * cos(PRESSURE)),
        },
        rel=1e-10,
    )
    # planets press on a sun and a carrier that give way, and not all by as much
    assert planet_forces(state).mean(axis=1) == pytest.approx([50 / (3 * lever)] * 2, rel=1e-10)
    engine = state.outside["engine"][4]
    assert abs(engine) == pytest.approx(50, rel=1e-10)
    assert state.outside["near"][4] == pytest.approx(-0.4 * 6 * engine, rel=1e-10)
    assert state.outside["far"][4] == pytest.approx(0.6 * 6 / 2 * engine, rel=1e-10)
    assert in_balance(state, train.shafts)
    # a load on the left flank turns the carrier about +y: stage and engine drive it about -y
    assert np.sign(engine) == (-1 if (flank == "left") == (torque > 0) else 1)
    told = {side: point.torque_of(side, train.torque_turns) for side in train.shafts}
    assert told == pytest.approx({"sun": torque, "carrier": 6 * torque, "output": 1.8 * torque})


def test_loads_told_of_any_shaft_are_one_state(tmp_path):
    assembly = Assembly(built(tmp_path, geared()))
    one = Operating(assembly, RIGID).at(OperatingPoint(torque=50.0, of="sun"))
    other = Operating(assembly, RIGID).at(OperatingPoint(torque=90.0, of="output"))
    np.testing.assert_allclose(other.coordinates, one.coordinates, atol=1e-12)


def mounted(stiffness):
    keys = ("kxx", "kyy", "kzz", "kthx", "kthy", "kthz")
    named = ", ".join(f"{key} = {stiffness}" for key in keys)
    return f"[[housing.mount]]\nposition = [0.0, 0.0, -0.2]\nstiffness = {{{named}}}\n"


@pytest.mark.parametrize("ring", [False, True])
def test_a_stage_in_a_housing_on_rigid_mounts_is_the_same_on_ground(tmp_path, ring):
    """Mounts of 1e15 give by 1e-6 of what the ring's springs do, and of all else by less."""
    text = train_text(0.3, ring=ring)
    bare, housed = (
        Assembly(built(tmp_path, text + more)) for more in ("", BOX_TEXT + mounted(1e15))
    )
    hz = bare.system(RIGID).modes().frequency_hz[1:]
    np.testing.assert_allclose(
        housed.system(RIGID).modes().frequency_hz[1 : 1 + len(hz)], hz, rtol=1e-6
    )
    point = OperatingPoint(torque=50.0, of="sun", force=({"at": "sun.sun", "x": 800.0},))
    one, other = (Operating(assembly, RIGID).at(point) for assembly in (bare, housed))
    np.testing.assert_allclose(planet_forces(other), planet_forces(one), rtol=1e-6)
    told = deflection(housed, point, RIGID)
    assert not told.turns and any("over a turn" in note for note in told.notes)


@pytest.mark.parametrize("torque", [50.0, -50.0])
@pytest.mark.parametrize("ring", [False, True])
def test_a_ring_stands_in_the_housing_whose_mounts_carry_its_torque(tmp_path, ring, torque):
    text = train_text(0.3, ring=ring) + BOX_TEXT
    train = built(tmp_path, text + mounted(1e6))
    state = Operating(Assembly(train), RIGID).at(OperatingPoint(torque=torque, of="sun"))
    (rows,) = mount_rows(train, state.system).values()
    six = rows @ state.coordinates
    # about the axis of the sun, by the force of the mount at z = -0.2
    about = six[4] - 0.2 * six[0]
    assert about == pytest.approx(torque * (1 - 6), rel=1e-9)
    # without mounts nothing joins the ring to ground: the train moves as one body
    free = Assembly(built(tmp_path, text)).on_flank(torque < 0).system(RIGID)
    assert free.modes(8).rigid == 7 and np.linalg.matrix_rank(free.motion(BOX) @ free.free) == 6


@pytest.mark.parametrize("lacking", [False, True])
def test_an_elastic_housing_holds_the_ring_at_a_point_of_its_own(tmp_path, lacking):
    """Lumps on springs to the first, free: rigid motions of all of it strain no teeth."""
    places = {
        "sun.b": (0.0, SUN[0] / 2, 0.0),
        "carrier.b": (0.0, SUN[0] / 2, 0.0),
        "stage.ring": (0.02, 0.05, -0.09),
    }
    if lacking:
        places.pop("stage.ring")
    at, size = np.array([*places.values()]), 6 * len(places)
    stiffness = np.zeros((size, size))
    for k in range(1, len(places)):
        across = np.eye(size)[6 * k : 6 * k + 6]
        across[:, :6] -= carried(at[k] - at[0])
        stiffness += across.T @ np.diag([2e8, 1e8, 3e8, 1e6, 2e6, 1e6]) @ across
    mass = np.diag([9.0, 9.0, 9.0, 0.03, 0.02, 0.04] * len(places))
    arrays = {"mass": mass, "stiffness": stiffness, "points": [*places], "positions": at}
    np.savez(tmp_path / "box.npz", **arrays)
    text = train_text(0.3) + '[housing]\nmatrices = "box.npz"\n'
    if lacking:
        with pytest.raises(SceneError, match="has no point 'stage.ring'.*where that ring stands"):
            built(tmp_path, text)
        return
    system = Assembly(built(tmp_path, text)).system(RIGID)
    assert system.modes(9).rigid == 7
    assert system.links["mesh stage ring 1"].ends[1] == "stage planet 1.centre"
    assert system.links["mesh stage ring 1"].ends[0] == "housing.stage.ring"


def test_a_loop_over_a_stage_is_refused_in_one_sentence(tmp_path):
    more = MESH.replace('"carrier", "output"', '"sun", "output"')
    with pytest.raises(SceneError, match="closes a loop: other teeth join the sun and the carrier"):
        built(tmp_path, geared(more=more))


def test_flanks_on_both_sides_of_a_stage_that_turn_against_each_other_are_refused(tmp_path):
    """The stage itself takes either way; of the meshes before and behind it one must give in."""
    more = MESH.replace('"carrier", "output"', '"first", "sun"')
    first = '[shaft.first]\nscene = "output.toml"\nteeth = 17\npitch_radius = 0.0178\n'
    first += 'spiral_angle = 0\nface_width = 0.02\nloaded_side = "left"\n'
    told = []
    for flank in ("left", "right"):
        text = first + geared(flank, more).replace('shaft = "sun"', 'shaft = "first"')
        text = text.replace("helix_angle = 0.3\n", "").replace('hand = "right"\n', "")
        text = text.replace(
            '[engine.spring]\nstiffness = 3000.0\nat = "sun"',
            '[engine.spring]\nstiffness = 3000.0\nat = "gear"',
        )
        train = built(tmp_path, text)
        try:
            state = Operating(Assembly(train), RIGID).at(OperatingPoint(torque=50.0, of="first"))
            assert in_balance(state, train.shafts) and planet_forces(state).min() > 0
            told.append("")
        except SceneError as error:
            told.append(str(error))
    assert sorted(map(bool, told)) == [False, True]
    assert "turn the carrier the same way, so that no torque passes" in max(told)
