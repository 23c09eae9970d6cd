"""Files of geared trains: what they hold, and one sentence for each thing they cannot mean."""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.frames import cross_matrix
from solidgear.core.system.contact_cells import contact_wrench
from solidgear.core.system.gear_mesh import to_gear_frame
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.layout import contacts
from solidgear.trains.file.reading import load_train
from solidgear.trains.modes.modes import wrench_lines

GEOMETRY = Path(__file__).parent.parent / "geometry"
OVERHUNG = (GEOMETRY / "axle_overhung.toml").read_text()


def written(folder, *changes, text=OVERHUNG):
    """A train file with some texts replaced, in a folder of its own."""
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    for name in ("pinion_overhung", "gear_shaft"):
        text = text.replace(f'"{name}.toml"', f'"{GEOMETRY / name}.toml"')
    path = folder / "train.toml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("name", ["overhung", "straddle", "thesis"])
def test_shipped_trains_load_and_mesh_in_the_ratio_of_their_teeth(name):
    train = load_train(GEOMETRY / f"axle_{name}.toml")
    found = contacts(train)["mesh"]
    assert abs(found.gear.lever / found.pinion.lever) == pytest.approx(45 / 14, rel=1e-12)
    # one physical point and line, seen from both lumped points
    back = to_gear_frame(found.gear.point, -train.mesh.shaft_angle) + found.origin
    assert np.allclose(back, found.pinion.point, atol=1e-15)
    assert np.allclose(to_gear_frame(found.gear.normal, -np.pi / 2), found.pinion.normal)


PARALLEL = (
    ('pitch_angle = "0.391 rad"', "pitch_angle = 0"),
    ('shaft_angle = "90 deg"', "shaft_angle = 0"),
)


def test_parallel_shafts_have_cylindrical_gears(tmp_path):
    train = load_train(written(tmp_path, *PARALLEL))
    found, teeth = contacts(train)["mesh"], train.pinion
    # axes apart by both radii, levers by the transverse component of the line of action
    radius = teeth.pitch_radius
    assert np.allclose(found.origin, [-radius * (1 + train.ratio), 0, 0], rtol=1e-12, atol=1e-15)
    across = np.cos(train.mesh.pressure_angle) * np.cos(teeth.spiral_angle)
    assert abs(found.pinion.lever) == pytest.approx(radius * across, rel=1e-12)
    assert abs(found.gear.lever / found.pinion.lever) == pytest.approx(train.ratio, rel=1e-12)
    assert not any("pitch angle" in line for line in found.cautions)
    bevel = contacts(load_train(written(tmp_path, PARALLEL[1])))["mesh"]
    assert "45 teeth (0 rad)" in bevel.cautions[0]


def test_a_station_called_start_hides_no_datum(tmp_path):
    # the spring went to the station, without a word
    train = load_train(written(tmp_path))
    scene = train.pinion.scene
    port = scene.port.with_changes(name="start")
    spring = train.engine.spring.with_changes(at=None, position=0.01, seat_width=0.01)
    with pytest.raises(
        sg.SolidgearError, match="is the start of the pinion's shaft, and a station"
    ):
        train.with_changes(
            pinion=train.pinion.with_changes(scene=scene.with_changes(port=port)),
            engine=train.engine.with_changes(spring=spring),
        )


def test_values_that_no_source_gives_are_listed():
    found = load_train(GEOMETRY / "axle_overhung.toml").unpublished()
    assert found["mesh.stiffness"] == found["engine.spring.stiffness"] == "identified"
    assert found["mesh.transmission_error"] == "assumed"
    assert "engine.inertia" not in found


LINE = 'pressure_angle = "25 deg"'
GIVEN = (
    "line_of_action = [{}]\n"
    'point = ["{} mm", "0 mm", "0 mm"]\ngear_position = [-0.05499494, -0.17676944, 0.0]'
)


def parallel(tmp_path, pinion="", gear="", mesh=""):
    """The contact of a pair on parallel shafts, with keys added to its tables; 14 and 45 teeth, 67 mm
    and 0.478 rad on the pinion.
    """
    changes = (
        ("[gear]\n", f"[gear]\n{gear}\n"),
        ("[pinion]\n", f"[pinion]\n{pinion}\n"),
        ("[mesh]\n", f"[mesh]\n{mesh}\n"),
    )
    return contacts(load_train(written(tmp_path, *PARALLEL, *changes)))["mesh"]


@pytest.mark.parametrize(
    "key, agrees, told, refused",
    [
        ("pitch_radius", '"215.36 mm"', '"218 mm"', '"21.5 mm"'),
        ("pitch_angle", "0", "0.02", "0.3"),
        ("spiral_angle", '"0.478 rad"', '"0.50 rad"', '"18 deg"'),
        ("face_width", '"60 mm"', '"40 mm"', None),
    ],
)
def test_numbers_of_the_gear_agree_with_the_pinion_or_it_is_told(
    tmp_path, key, agrees, told, refused
):
    before = parallel(tmp_path).cautions
    assert parallel(tmp_path, gear=f"{key} = {agrees}").cautions == before
    more = parallel(tmp_path, gear=f"{key} = {told}").cautions
    assert len(more) == len(before) + 1 and f"{key} of the gear" in more[0]
    if refused is not None:
        with pytest.raises(sg.SceneError, match=f"gear.{key}: "):
            parallel(tmp_path, gear=f"{key} = {refused}")


def test_numbers_of_the_gear_refuse_nothing_where_the_line_is_given(tmp_path):
    given = GIVEN.format(NORMAL, -54.99494)
    changes = (LINE, given), ("[gear]\n", '[gear]\npitch_radius = "100 mm"\n')
    found = contacts(load_train(written(tmp_path, *changes)))["mesh"]
    assert any("pitch_radius of the gear: is 1.493 times" in line for line in found.cautions)


def test_the_right_flank_is_right_of_a_tooth_with_its_tip_up_seen_from_the_apex(tmp_path):
    along, tip = np.array([0.0, 1.0, 0.0]), np.array([-1.0, 0.0, 0.0])  # the pinion meshes at -x
    right = np.cross(along, tip)
    old = 'loaded_side = "concave"'
    for word, sign in (("right", -1), ("left", 1)):
        change = old, f'loaded_side = "{word}"'
        changes = *PARALLEL, change, ('loaded_side = "convex"', "# ")
        push = contacts(load_train(written(tmp_path, *changes)))["mesh"].pinion.normal
        assert np.sign(push @ right) == sign, word  # a force on a flank points into the tooth


def test_words_of_bevel_flanks_mean_the_flanks_of_helical_ones(tmp_path):
    # left-handed teeth, seen from the apex, lean to the left: their concave flank faces there
    for word, same in (("left", "concave"), ("right", "convex")):
        found = []
        for side in (word, same):
            bare = 'loaded_side = "convex"', "# "
            changes = bare, ('loaded_side = "concave"', f'loaded_side = "{side}"')
            train = load_train(written(tmp_path, *PARALLEL, *changes))
            found.append(contacts(train)["mesh"].pinion.vector)
            assert train.pinion.flank == word
        assert np.array_equal(*found)


def test_spur_gears_need_no_hand_where_the_flank_is_named(tmp_path):
    changes = [
        *PARALLEL,
        ('loaded_side = "concave"', 'loaded_side = "left"'),
        ('hand = "left"', "# "),
        ('hand = "right"', "# "),
        ('loaded_side = "convex"', "# "),
        ('spiral_angle = "0.478 rad"', "spiral_angle = 0"),
    ]
    push = contacts(load_train(written(tmp_path, *changes)))["mesh"].pinion.normal
    assert push[1] == 0 and push[2] == pytest.approx(np.cos(np.radians(25)))


def test_left_and_right_flanks_are_of_parallel_shafts_and_touch_their_own(tmp_path):
    left = 'loaded_side = "concave"', 'loaded_side = "left"'
    with pytest.raises(sg.SceneError, match="pinion.loaded_side = .left.: left and right flanks"):
        load_train(written(tmp_path, left))
    with pytest.raises(sg.SceneError, match="is the right flank, but the left one is loaded on"):
        right = 'loaded_side = "convex"', 'loaded_side = "right"'
        load_train(written(tmp_path, *PARALLEL, left, right))


NORMAL = "0.23183445, 0.5465063, 0.80472583"
# file text to replace, by what, and what the sentence must hold
BAD = {
    "off the gears": (LINE, GIVEN.format(NORMAL, -90.0), "off the pinion"),
    "levers": (LINE, GIVEN.format(NORMAL, -45.0), "the teeth need 3.2143"),
    "a harmonic of ports": (LINE, LINE + "\nlocal_harmonics = [1, 2]", "local_harmonics"),
    "a harmonic twice": (LINE, LINE + "\nlocal_harmonics = [2, 2]", "names a harmonic twice"),
    "no unit": (LINE, GIVEN.format("0.24, 0.54, 0.80", -55), "unit vector of this direction is"),
    "wrong frame": (LINE, GIVEN.format("0.5465063, -0.23183445, 0.80472583", -55), "gear's frame"),
    "hands": ('hand = "right"', 'hand = "left"', "needs one of each hand"),
    "ratio": (LINE, LINE + "\nratio = 3.0", "a ratio of 3.2143"),
    "teeth": ("teeth = 14 ", "teeth = 14.5 ", "pinion.teeth"),
    "a spring misspelt": ("[engine.spring]", "[engine.sprint]", 'did you mean "spring"'),
    "no stiffness of it": ('stiffness = "1.159e4 N*m/rad"', "", "stiffness"),
    "port": ('at = "gear"', 'at = "5"', "known here: gear, 3, 4"),
    "per cent": ("mesh = 0.12", "mesh = 12", "12 per cent is written 0.12"),
    "unit of an inertia": ('"2.734 kg*m^2"', '"2.734 kg"', "kg*m^2"),
    "nothing turns": (LINE, GIVEN.format("1, 0, 0", -55), "transmits no torque"),
    "no file": ('"gear_shaft.toml"', '"gear_shift.toml"', "no such file"),
    "no key of geometry": ("spiral_angle =", "# spiral_angle =", "spiral_angle: is missing"),
    "a table that descends": (
        '"2 um" ',
        '{frequency = [200, 100], amplitude = ["1 um", "2 um"]} ',
        "must ascend",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_told_in_one_sentence(case, tmp_path):
    old, new, words = BAD[case]
    if case == "nothing turns":  # a flat line cannot be judged by the teeth: they are left out
        changes = [(old, new), ("spiral_angle", "# spiral_angle")]
    else:
        changes = [(old, new)]
    with pytest.raises(sg.SceneError) as caught:
        contacts(load_train(written(tmp_path, *changes)))["mesh"]
    text = str(caught.value)
    assert words in text
    assert "\n" not in text


def test_a_given_line_and_point_are_those_of_the_geometry(tmp_path):
    path = written(tmp_path, (LINE, GIVEN.format(NORMAL, -54.99494)))
    found, usual = (
        contacts(load_train(path))["mesh"],
        contacts(load_train(GEOMETRY / "axle_overhung.toml"))["mesh"],
    )
    assert np.allclose(found.gear.vector, usual.gear.vector, atol=1e-7)


def test_an_apex_at_the_other_end_turns_the_mesh_with_the_shaft(tmp_path):
    usual = contacts(load_train(written(tmp_path)))["mesh"]
    text = OVERHUNG.replace('apex = "start"', 'apex = "end"')
    turned = contacts(load_train(written(tmp_path, text=text)))["mesh"]
    half = np.array([-1, -1, 1])
    assert np.array_equal(turned.pinion.normal, half * usual.pinion.normal)
    assert turned.pinion.lever == pytest.approx(-usual.pinion.lever)


CELLS = np.array([[-0.052, -0.004, 0.001], [-0.055, 0.001, 0.0], [-0.058, 0.006, -0.002]])
ANGLES = np.array([[0.23, 0.55, 0.80], [0.20, 0.58, 0.79], [0.28, 0.50, 0.82]])
ANGLES = ANGLES / np.linalg.norm(ANGLES, axis=1)[:, None]
FORCES = np.array([800.0, 1100.0, 800.0])


def test_a_wrench_leaves_its_pitch_and_nothing_else():
    wrench = contact_wrench(CELLS, ANGLES, FORCES)
    # by hand, one cell at a time, by the matrix of the cross product
    moment = sum(f * cross_matrix(r) @ n for r, n, f in zip(CELLS, ANGLES, FORCES))
    assert np.allclose(wrench.moment, moment)
    must = abs(wrench.pitch) * np.linalg.norm(wrench.force)
    assert wrench.left_over(wrench.point) == pytest.approx(must, rel=1e-9)
    assert must > 1e-3  # different normals: no point carries it all
    around = wrench.point + 1e-3 * np.random.default_rng(1).normal(size=(50, 3))
    assert min(map(wrench.left_over, around)) >= must * (1 - 1e-12)
    assert wrench.left_over(wrench.thesis_point) > must


def test_the_point_of_the_thesis_balances_two_moments_and_leaves_that_about_x():
    """Hua (2010), 3.2.1, equation 3, with its own sums over cells."""
    wrench = contact_wrench(CELLS, ANGLES, FORCES)
    x, y, z = wrench.thesis_point
    (rx, ry, rz), (nx, ny, nz) = CELLS.T, ANGLES.T
    total = FORCES @ ANGLES
    assert y == pytest.approx(FORCES @ ry / FORCES.sum())
    assert z * total[0] - x * total[2] == pytest.approx(FORCES @ (nx * rz - nz * rx))
    assert x * total[1] - y * total[0] == pytest.approx(FORCES @ (ny * rx - nx * ry))
    left = wrench.moment - np.cross([x, y, z], total)
    assert abs(left[0]) > 1e6 * np.abs(left[1:]).max()


@pytest.mark.parametrize("axis", ["x", "y"])
def test_the_formulas_of_the_thesis_need_a_force_to_divide_by(axis):
    normal = {"x": [0.0, 0.6, 0.8], "y": [0.6, 0.0, 0.8]}[axis]
    with pytest.raises(sg.SolidgearError, match=f"the force along {axis}"):
        _ = contact_wrench(CELLS, [normal] * 3, FORCES).thesis_point


def test_cells_of_one_normal_close_to_rounding():
    wrench = contact_wrench(CELLS, np.tile(ANGLES[0], (3, 1)), FORCES)
    assert wrench.left_over(wrench.point) < 1e-12 * np.linalg.norm(wrench.moment)
    assert wrench.left_over(wrench.thesis_point) < 1e-12 * np.linalg.norm(wrench.moment)


def cells_file(folder, rows):
    path = folder / "cells.csv"
    path.write_text("x,y,z,nx,ny,nz,force\n" + "\n".join(rows))
    return path


def test_a_mesh_from_contact_cells(tmp_path):
    rows = [",".join(f"{v:.12g}" for v in (*r, *n, f)) for r, n, f in zip(CELLS, ANGLES, FORCES)]
    cells_file(tmp_path, rows)
    old = 'stiffness = "2.5e8 N/m" '
    new = 'loaded_error = "25 um"\nunloaded_error = "14 um" '
    cells = 'contact_cells = "cells.csv"'
    found = contacts(load_train(written(tmp_path, (LINE, cells), (old, new))))["mesh"]
    wrench = contact_wrench(CELLS, ANGLES, FORCES)
    assert found.stiffness == pytest.approx(np.linalg.norm(wrench.force) / 11e-6)
    assert np.allclose(found.pinion.point, wrench.point, atol=1e-12)
    told = wrench_lines(found)
    assert (
        "N m about the line of action remain at any mesh point" in told[1]
        and "thesis's formulas" in told[2]
    )


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("0,0,0,0,0,2,1", "line 2: the normal has length 2"),
        ("0,0,0,0,0,1,-1", "teeth push"),
        ("0,0,0,0,0,1,one", 'force = "one"'),
        ("0,0,0,0,0,1,0", "no cell carries a force"),
        ("", "0 contact cells"),
    ],
)
def test_bad_cells_are_told_in_one_sentence(row, words, tmp_path):
    cells_file(tmp_path, [row] if row else [])
    with pytest.raises(sg.SceneError, match=words):
        load_train(written(tmp_path, (LINE, 'contact_cells = "cells.csv"')))


def test_a_spring_may_sit_anywhere_on_its_shaft(tmp_path):
    place = 'position = "-5 mm"\nfrom = "end"\nseat_width = "8 mm"'
    train = load_train(written(tmp_path, ('at = "gear"', place)))
    station = train.shaft("gear").bearings[-1]
    assert station.y == pytest.approx(train.gear.scene.length - 0.005)
    assert not station.stiffness.any()
    off = place.replace("-5", "5")
    with pytest.raises(sg.SceneError, match="not a place on the gear's shaft"):
        load_train(written(tmp_path, ('at = "gear"', off)))


# --------------------------------------------------------------------------- parallel shafts
def test_parallel_shafts_are_a_train_too():
    """Spur gears: the rotation of the train keeps the ratio of the base radii, and nothing of the
    mesh acts along the shafts.
    """
    from validation.manual.cases.spur_train import GENERATOR, TURBINE, spur_train

    train = spur_train()
    assembly = Assembly(train, settings={"timoshenko": {"elements": 20}})
    met = assembly.contact
    assert abs(met.pinion.lever) == pytest.approx(TURBINE["base_radius"], rel=1e-12)
    assert abs(met.gear.lever) == pytest.approx(GENERATOR["base_radius"], rel=1e-12)
    system = assembly.system("timoshenko", "timoshenko")
    turn = np.array([system.motion(name)[4] for name in ("engine", "load")]) @ system.free
    ratio = turn[0] @ turn[0] / (turn[1] @ turn[0])  # of the one free motion that turns
    # external gears turn against each other
    assert ratio == pytest.approx(-GENERATOR["base_radius"] / TURBINE["base_radius"], rel=1e-6)
    assert met.pinion.vector[1] == met.gear.vector[1] == 0.0
    assert np.allclose(system.parts["gear"].rotation, np.eye(3))


def test_a_wheel_that_is_a_rigid_mass_needs_its_pitch_radius():
    from validation.manual.cases.spur_train import spur_train

    train = spur_train()
    bare = train.with_changes(gear=train.gear.with_changes(pitch_radius=None))
    with pytest.raises(sg.SceneError, match="gear.pitch_radius: is missing.* a rigid head"):
        Assembly(bare)


def test_catalogue_bearings_of_a_shaft_get_their_stiffness(tmp_path):
    """At the load of the shaft's own file, as solidgear.load gives it."""
    name = '"pinion_overhung.toml"'
    catalogue = f'"{GEOMETRY / "gearbox_catalogue.toml"}"'
    size = ('pitch_radius = "67 mm"', 'pitch_radius = "30 mm"')
    width = ('face_width = "63 mm"', 'face_width = "20 mm"')
    train = sg.load_train(written(tmp_path, (name, catalogue), size, width))
    alone = sg.load(GEOMETRY / "gearbox_catalogue.toml")
    for mine, its in zip(train.pinion.scene.bearings, alone.bearings, strict=True):
        assert np.array_equal(mine.stiffness, its.stiffness)
    assert Assembly(train).system("euler", "euler").modes(3).frequency_hz[0] == 0.0


def test_an_apex_that_contradicts_its_scene_is_told(tmp_path):
    """The pinion's bevel head has its toe at the start of the shaft; parallel shafts have no apex."""
    start, end = 'apex = "start" ', 'apex = "end" '
    for changes, told in (
        (((start, start),), False),
        (((start, end),), True),
        (((start, end), *PARALLEL), False),
    ):
        cautions = contacts(load_train(written(tmp_path, *changes)))["mesh"].cautions
        found = [line for line in cautions if "contradicts its scene" in line]
        assert bool(found) == told, changes
    pinion = 'apex = "end" of the pinion contradicts its scene'
    line = contacts(load_train(written(tmp_path, (start, end))))["mesh"].cautions[1]
    assert line.startswith(pinion) and 'only with apex = "start"' in line


def test_all_that_a_line_of_action_lacks_is_told_at_once(tmp_path):
    lacking = (('hand = "left"', "# "), ('loaded_side = "concave"', "# "))
    with pytest.raises(sg.SceneError) as error:
        contacts(load_train(written(tmp_path, *lacking)))["mesh"]
    assert len(error.value.problems) == 2
    straight = (*lacking, ('spiral_angle = "0.478 rad"', "spiral_angle = 0"))
    with pytest.raises(sg.SceneError, match="both together say which flank is loaded"):
        contacts(load_train(written(tmp_path, *straight)))["mesh"]


def test_wheels_of_one_hand_are_called_what_they_are(tmp_path):
    alike = ('hand = "left"', 'hand = "right"')
    for changes, pair in (((), "a spiral bevel pair"), (PARALLEL, "a helical pair on parallel")):
        with pytest.raises(sg.SceneError, match=pair):
            load_train(written(tmp_path, alike, *changes))


def test_a_spring_is_tied_as_its_shaft_is(tmp_path):
    """As all bearings and lumped points of the scene are, where they are tied alike."""
    place = 'position = "20 mm"\nseat_width = "10 mm"'
    train = load_train(written(tmp_path, ('at = "pinion"', place)))
    scene = train.pinion.scene
    first, *rest = (b.with_changes(attachment="section") for b in scene.bearings)
    mixed = scene.with_changes(bearings=(first, *scene.bearings[1:]))
    for own, tie in (
        (scene, "average"),
        (scene.with_attachment("section"), "section"),
        (mixed, "average"),
    ):
        shaft = train.with_changes(pinion=train.pinion.with_changes(scene=own)).shaft("pinion")
        assert shaft.bearings[-1].name == "engine spring"
        assert shaft.bearings[-1].attachment == tie


def test_all_that_is_wrong_with_a_train_is_told_at_once(tmp_path):
    text = (GEOMETRY / "gearbox_train.toml").read_text(encoding="utf-8")
    text = text.replace('scene = "', f'scene = "{GEOMETRY}/')
    for right, wrong in (
        ("[engine.spring]", "[engine.motor]"),
        ("teeth = 20", "teeth = 20.5"),
        ('stiffness = "3.2e8 N/m"', 'stiffness = "3.2e8 kg"'),
    ):
        text = text.replace(right, wrong, 1)
    path = tmp_path / "train.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(sg.SceneError) as refused:
        load_train(path)
    told = [".".join(map(str, one.path)) for one in refused.value.problems]
    assert {"engine.spring", "pinion.teeth", "mesh.stiffness"} <= set(told)
    assert len(told) == len(set(told)) and "torsional spring between the engine" in str(
        refused.value
    )
