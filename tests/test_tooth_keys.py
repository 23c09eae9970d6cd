"""Keys of teeth in a train file: what is read from it, what is refused, and who gives a mesh its stiffness."""

import re
from math import cos, hypot, pi, radians, sin
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.core import SolidgearError
from solidgear.core.errors import SceneError
from solidgear.core.gears.wheel import Rack, Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.core.registry import _PLACES, addition, register
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_stiffness import USUAL, asks_for_teeth
from solidgear.trains.file.tooth_fit import fit_cautions, fit_line, path_cuts
from solidgear.trains.judge.check import _facts
from solidgear.trains.load.operation import at_point

GEOMETRY = Path(__file__).parent.parent / "geometry"
TEXT = (GEOMETRY / "gearbox_train.toml").read_text()
GRID = (
    "z, diameter, deviation\n-0.02, 0.058, 0\n-0.02, 0.065, 1e-6\n0.02, 0.058, 0\n0.02, 0.065, 3e-6"
)
#: stiffness that the stand-in for a solved contact gives, N/m
STAND_IN = 7.5e8
solved_at = []


def stand_in(train):
    """Put numbers in the place of "teeth", and remember the torque at which this was asked for."""
    solved_at.append(train.point.torque if train.point else None)
    meshes = tuple(
        m.with_changes(stiffness=STAND_IN, transmission_error=2e-6) if m.stiffness == "teeth" else m
        for m in train.meshes
    )
    return train.with_changes(meshes=meshes)


def unchanged(train):
    return train


@pytest.fixture
def solving():
    before = _PLACES.get("mesh stiffness", {}).copy()
    register("mesh stiffness", "teeth", f"{__name__}:stand_in")
    solved_at.clear()
    yield solved_at
    _PLACES["mesh stiffness"] = before
    addition.cache_clear()


def written(folder, text, **files):
    for name in ("gearbox_catalogue", "gearbox_wheel", "gearbox_middle", "gearbox_output"):
        (folder / f"{name}.toml").write_text((GEOMETRY / f"{name}.toml").read_text())
    for name, content in files.items():
        (folder / f"{name}.csv").write_text(content)
    path = folder / "train.toml"
    path.write_text(text)
    return path


def with_lines(pinion="", mesh="", text=TEXT):
    text = text.replace("[pinion]", f"[pinion]\n{pinion}", 1)
    return text.replace("[mesh]", f"[mesh]\n{mesh}", 1)


def with_teeth(text=TEXT):
    return text.replace('stiffness = "3.2e8 N/m"', 'stiffness = "teeth"', 1)


def test_every_key_is_read_in_its_unit(tmp_path):
    keys = """
rack = {addendum = 1.1, dedendum = 1.3, root_radius = 0.3}
tip_diameter = "66 mm"
face_offset = "2 mm"
relief = {tip = "10 um", from = "64 mm", root = "4 um", root_from = "58 mm"}
crowning = "5 um"
helix_slope = "-8 um"
measured_flank = "grid.csv"
"""
    pinion = sg.load_train(written(tmp_path, with_lines(keys), grid=GRID)).pinion
    assert pinion.rack.dedendum == 1.3 and pinion.tip_diameter == pytest.approx(66e-3)
    assert pinion.face_offset == pytest.approx(2e-3)
    assert (pinion.relief.tip, pinion.relief.from_) == pytest.approx((10e-6, 64e-3))
    assert (pinion.relief.root, pinion.relief.root_from) == pytest.approx((4e-6, 58e-3))
    assert (pinion.crowning, pinion.helix_slope) == pytest.approx((5e-6, -8e-6))
    assert pinion.measured_flank.diameter == (0.058, 0.065)
    assert pinion.measured_flank.deviation == ((0.0, 1e-6), (0.0, 3e-6))


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        (
            'relief = {tip = "10 mm"}',
            r"pinion\.relief\.tip = .10 mm.: is deeper than half the tooth",
        ),
        ('relief = {tip = "10 um", from = "70 mm"}', r"pinion\.relief\.from.*lies off the flank"),
        ('relief = {from = "64 mm"}', r"relief\.from.*needs tip"),
        ('crowning = "5 mm"', r"pinion\.crowning.*deeper than half the tooth"),
        ('helix_slope = "-5 mm"', r"pinion\.helix_slope.*deeper than half the tooth"),
        ('tip_diameter = "50 mm"', r"pinion\.tip_diameter.*leaves no flank: flanks begin at"),
        ('tip_diameter = "75 mm"', r"pinion\.tip_diameter.*beyond the point"),
        ("rack = {root_radius = 0.6}", r"rack\.root_radius.*0\.4\d+ modules at most"),
        ('measured_flank = "none.csv"', "places of a flank cannot be read"),
        ("measured_flank = 3", "names a CSV file with the columns z, roll or diameter"),
    ],
)
def test_what_no_tooth_can_be_is_refused_in_a_sentence(tmp_path, keys, words):
    with pytest.raises(SceneError) as error:
        sg.load_train(written(tmp_path, with_lines(keys)))
    assert any(re.search(words, line) for line in str(error.value).splitlines()), str(error.value)


@pytest.mark.parametrize(
    ("grid", "words"),
    [
        ("z, height, deviation\n0, 0, 0", "no column roll"),
        (GRID.replace("3e-6", "3"), "larger than a millimetre"),
        (GRID.replace("0.058", "58").replace("0.065", "65"), "lies off the flank"),
        (GRID.replace("0.02", "20"), "from the middle of a face that is 50 mm wide"),
        (GRID.rsplit("\n", 1)[0], r"has no row for z = 0\.02, diameter = 0\.065"),
        (GRID + "\n0.02, 0.065, 0", "line 6: z = 0.02, diameter = 0.065 is there twice"),
        (GRID.replace("1e-6", "much"), "line 3, deviation"),
    ],
)
def test_a_grid_that_is_no_measured_flank_is_refused(tmp_path, grid, words):
    with pytest.raises(SceneError, match=words):
        sg.load_train(written(tmp_path, with_lines('measured_flank = "grid.csv"'), grid=grid))


def test_tips_that_do_not_reach_each_other_are_refused(tmp_path):
    text = with_lines('tip_diameter = "57.5 mm"').replace(
        "[gear]", '[gear]\ntip_diameter = "170 mm"', 1
    )
    with pytest.raises(SceneError, match="tips at 28.75 mm and 85 mm do not reach"):
        sg.load_train(written(tmp_path, text))


def test_faces_that_lie_apart_are_refused(tmp_path):
    with pytest.raises(SceneError, match="share nothing") as error:
        sg.load_train(written(tmp_path, with_lines('face_offset = "60 mm"')))
    assert "60 mm apart" in str(error.value)


def test_keys_of_cylindrical_gears_are_refused_on_bevel_gears():
    train = sg.load_train(GEOMETRY / "axle_overhung.toml")
    with pytest.raises(SceneError, match="parallel shafts") as error:
        train.with_changes(pinion=train.pinion.with_changes(crowning=5e-6))
    assert error.value.problems[0].path == ("pinion", "crowning")


def test_teeth_that_give_a_stiffness_need_a_face(tmp_path):
    text = with_teeth(TEXT.replace('face_width = "50 mm"', "", 1))
    with pytest.raises(SceneError, match='face_width.*stiffness = "teeth"'):
        sg.load_train(written(tmp_path, text))


def test_other_words_than_teeth_are_no_stiffness(tmp_path):
    text = TEXT.replace('stiffness = "3.2e8 N/m"', 'stiffness = "tooth"', 1)
    with pytest.raises(SceneError, match="mesh.stiffness"):
        sg.load_train(written(tmp_path, text))


def test_an_assembly_solves_the_teeth_at_its_operating_point(tmp_path, solving):
    train = sg.load_train(written(tmp_path, with_teeth()))
    assert asks_for_teeth(train) and solving == []  # bearings settle with a usual stiffness
    assembly = Assembly(train)
    assert assembly.contact.stiffness == STAND_IN and solving == [115.0]
    assert assembly.train.mesh.transmission_error.orders == (2e-6,)
    assert assembly.asked_train.mesh.stiffness == "teeth"
    Assembly(at_point(train, "coast"))
    assert solving == [115.0, -30.0]


def test_the_same_numbers_typed_make_the_same_train(tmp_path, solving):
    teeth = Assembly(sg.load_train(written(tmp_path, with_teeth())))
    typed = TEXT.replace("3.2e8 N/m", f"{STAND_IN} N/m", 1)
    given = Assembly(sg.load_train(written(tmp_path, typed)))
    one, two = (a.system("euler").modes(6).frequency_hz for a in (teeth, given))
    assert one == pytest.approx(two, rel=1e-9)


def test_without_anyone_to_solve_teeth_a_number_is_asked_for(tmp_path, solving):
    _PLACES["mesh stiffness"].clear()
    addition.cache_clear()
    train = sg.load_train(written(tmp_path, with_teeth()))
    with pytest.raises(SolidgearError, match="room of teeth"):
        Assembly(train)


def test_a_mesh_that_stays_without_a_number_is_refused(tmp_path, solving):
    register("mesh stiffness", "teeth", f"{__name__}:unchanged")
    train = sg.load_train(written(tmp_path, with_teeth()))
    with pytest.raises(SolidgearError, match="give a number there"):
        Assembly(train)


def test_check_solves_nothing_and_says_what_it_takes(tmp_path, solving):
    train = sg.load_train(written(tmp_path, with_teeth(with_lines('crowning = "5 um"'))))
    assembly = Assembly(train, solves_teeth=False)
    assert assembly.contact.stiffness == pytest.approx(USUAL * 50e-3, rel=5e-3)  # of 206 to 207 GPa
    facts = " ".join(_facts(assembly, 4000.0))
    for words in (
        "1.002e+09 N/m",
        "20 N/(mm um)",
        "contact ratio 1.589",
        "assumed of the teeth: normal",
    ):
        assert words in facts
    assert "flanks of the gear without modification" in facts
    assert solving == []


def test_planets_ask_for_their_teeth_as_well():
    train = sg.load_train(GEOMETRY / "reducer.toml")
    (stage,) = train.stages
    mesh = stage.table.mesh.with_changes(sun_stiffness="teeth")
    planetary = {stage.called: stage.table.with_changes(mesh=mesh)}
    with pytest.raises(SceneError, match="wheel.sun, needs its face_width") as error:
        train.with_changes(planetary=planetary)
    assert error.value.problems[0].path == ("planetary", stage.called, "sun")
    side, port = stage.shafts[0], stage.ports[0]
    gears = train.shafts[side].gears
    wide = gears[port].with_changes(face_width=30e-3)
    shaft = train.shafts[side].with_changes(gears={**gears, port: wide})
    asking = train.with_changes(shafts={**train.shafts, side: shaft}, planetary=planetary)
    assert asks_for_teeth(asking)
    with pytest.raises(SolidgearError, match="not solved yet"):
        asking.stages[0].stiffness("sun")
    taken = Assembly(asking, solves_teeth=False).train.planetary[stage.called].mesh
    assert taken.sun_stiffness == pytest.approx(USUAL * 30e-3)
    assert taken.ring_stiffness == mesh.ring_stiffness


def test_tips_of_planets_and_offsets_of_a_ring_are_held_against_their_neighbours():
    train = sg.load_train(GEOMETRY / "reducer.toml")
    (stage,) = train.stages
    side, port = stage.shafts[0], stage.ports[0]
    gears, deep = train.shafts[side].gears, {"dedendum": 1.6, "root_radius": 0.2}
    wide = {**gears, port: gears[port].with_changes(face_width=30e-3, rack=deep)}
    shafts = {**train.shafts, side: train.shafts[side].with_changes(gears=wide)}

    def with_table(**changes):
        table = stage.table.with_changes(**{"ring_flanks": {"rack": deep}} | changes)
        return train.with_changes(shafts=shafts, planetary={stage.called: table})

    # 26 and 34 of 102 teeth apart: axes of planets 51 sin(91.76 deg / 2) = 36.6 modules apart
    angles = tuple(2 * pi * place / 102 for place in (0, 26, 60))
    module, planet = stage.sun.module, stage.table.planet
    long, longer = (planet.with_changes(tip_diameter=module * tip) for tip in (36.5, 36.7))
    with_table(planet=long, planets=None, angles=angles)
    with_table(planet=longer)
    for changes, words, key in (
        ({"planet": longer, "planets": None, "angles": angles}, "lets planets overlap", "planet"),
        ({"ring_flanks": {"face_offset": 31e-3}}, "share nothing", "ring_flanks"),
        ({"ring_flanks": {"tip_diameter": 0.2}}, "leaves no flank", "ring_flanks"),
    ):
        with pytest.raises(SceneError, match=words) as error:
            with_table(**changes)
        assert error.value.problems[0].path[:3] == ("planetary", stage.called, key)


def test_tips_that_meet_fillets_are_told():
    """A longer addendum on the gear meets fillets of the pinion, which a usual rack has cut: its straight
    side is 1.25 - 0.38 (1 - sin 20 deg) modules long.
    """
    fit = WheelPair(Wheel(20, 3e-3), Wheel(57, 3e-3, rack=Rack(addendum=1.135)))
    (caution,) = [c for c in fit_cautions(fit, ("pinion", "gear")) if "fillets" in c]
    assert caution.startswith("tips of the gear meet the fillets of the pinion")
    sine, base = sin(radians(20)), 30 * cos(radians(20))
    start = 30 * sine - 3 * (1.25 - 0.38 * (1 - sine)) / sine
    assert f"end at {hypot(start, base):.6g} mm" in caution
    tips = 115.5 * sine - ((85.5 + 3.405) ** 2 - (85.5 * cos(radians(20))) ** 2) ** 0.5
    assert path_cuts(fit) == pytest.approx((1e-3 * (start - tips), 0.0), rel=1e-6)
    lost = f"{1e6 * path_cuts(fit)[0]:.1f} um of the path lost at fillets"
    assert fit_line(fit).endswith(lost)
    assert "lost" not in fit_line(WheelPair(fit.first, Wheel(57, 3e-3)))
    # undercut by its rack, a wheel of 12 teeth ends the path before tips would
    assert "lost at fillets" in fit_line(WheelPair(Wheel(12, 3e-3), Wheel(57, 3e-3)))
    assert not any(
        "fillets" in c for c in fit_cautions(WheelPair(fit.first, Wheel(57, 3e-3)), "ab")
    )


def test_bevel_gears_have_cutters_and_cylindrical_gears_have_none():
    axle = sg.load_train(GEOMETRY / "axle_overhung.toml")
    cut = {"cutter_radius": "152.4 mm", "blade_curvature": 0.05}
    mesh = axle.mesh.with_changes(gear_share=0.27, working_depth=1.9, ease_off="120 um")
    train = axle.with_changes(pinion=axle.pinion.with_changes(**cut), mesh=mesh)
    assert train.pinion.cutter_radius == pytest.approx(0.1524)
    assert train.mesh.ease_off == pytest.approx(120e-6)
    with pytest.raises(SceneError, match="leave one of the three out"):
        train.with_changes(gear=axle.gear.with_changes(**cut))
    gearbox = sg.load_train(GEOMETRY / "gearbox_train.toml")
    with pytest.raises(SceneError, match="is for bevel gears") as error:
        gearbox.with_changes(gear=gearbox.gear.with_changes(cutter_radius="100 mm"))
    assert error.value.problems[0].path == ("gear", "cutter_radius")


@pytest.mark.parametrize(
    ("table", "key", "value"),
    [
        ("pinion", "blade_curvature", 11.0),
        ("mesh", "gear_share", 1.0),
        ("mesh", "working_depth", 3.5),
        ("mesh", "ease_off", -1e-6),
    ],
)
def test_settings_of_no_cutter_are_refused(table, key, value):
    axle = sg.load_train(GEOMETRY / "axle_overhung.toml")
    with pytest.raises(SceneError, match=key):
        axle.with_changes(**{table: getattr(axle, table).with_changes(**{key: value})})


def test_a_hand_of_straight_teeth_is_what_to_leave_out(tmp_path):
    text = re.sub(r"spiral_angle = .*\n", "", TEXT)
    with pytest.raises(SceneError, match="helix_angle: is missing; .* leave hand out for straight"):
        _ = Assembly(sg.load_train(written(tmp_path, text))).contact


@pytest.mark.parametrize("table", ["", ".gears.wheel"])
def test_problems_name_the_only_gear_of_a_shaft_as_the_file_has_it(tmp_path, table):
    """In the table of the shaft or in one of its own, while the file is read and later."""
    text = (GEOMETRY / "gearbox_two_stage.toml").read_text()
    words, before = 'scene_load = "replaced"\nteeth = 55\n', 'hand = "right"\nmodule = "4 mm"'
    assert words in text and before in text
    head = f"[shaft.output{table}]\n" if table else ""
    text = text.replace(words, f'scene_load = "replaced"\n{head}teeth = 55\n')
    text = text.replace("[shaft.output.head]", f"[shaft.output{table}.head]")
    wrong = text.replace(before, 'hand = "left"\nmodule = "4 mm"')
    with pytest.raises(SceneError, match=f"shaft.output{table}.hand = .* both wheels are left"):
        sg.load_train(written(tmp_path, wrong))
    train = sg.load_train(written(tmp_path, text))
    pair = train.pairs[1]
    assert ".".join(pair.paths["gear"]) == f"shaft.output{table}"
