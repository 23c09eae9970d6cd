"""Loads at several places of a shaft: forces of gears and belts, statics, deflection, torque."""

import json
import math
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.bearings.solved import solved as solved_bearings
from solidgear.comparison.two.loaded import loaded_changes
from solidgear.core.errors import SolidgearError
from solidgear.core.loading import as_written
from solidgear.core.scene.acting import acting_loads
from solidgear.core.scene.uncertain import with_scaled_entry
from solidgear.core.system.gear_mesh import line_of_action
from solidgear.cuts.features.keyway import Keyway
from solidgear.exchange.rexs.export.exporting import exported
from solidgear.exchange.rexs.importing import imported
from solidgear.show.remarks import load
from solidgear.strength.deflection.at_rest import deflection
from solidgear.strength.load import AT_REST
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.load.operation import scene_loads

GEOMETRY = Path(__file__).parent.parent / "geometry"
COUNTERSHAFT = GEOMETRY / "countershaft.toml"
INCH, POUND = 0.0254, 4.4482216152605
POUND_INCH = INCH * POUND


def countershaft():
    """Shigley, example 7-2 (9th edition, page 375): its forces as printed, in place of angles."""
    scene = as_written(COUNTERSHAFT)
    across, down = (540.0, -2431.0), (-197.0, -885.0)
    loads = [
        sg.ShaftLoad(name=f"{name}", on=name, x=x * POUND, z=z * POUND, torque=turn * POUND_INCH)
        for name, x, z, turn in zip(("gear 3", "gear 4"), across, down, (3240.0, -3240.0))
    ]
    return scene.with_changes(loads=loads)


def settled(scene, model="euler", case=None):
    assembly = Assembly.of(scene if case is None else scene.with_case(case), kept=6)
    return deflection(assembly, assembly.train.point or AT_REST, model)


def test_torque_runs_between_the_gears():
    solved = settled(countershaft())
    assert solved.statics.imbalance < 1e-10
    (stretch,) = solved.statics.torque
    assert (stretch.start / INCH, stretch.end / INCH) == pytest.approx((2.75, 8.5))


def beam(scene, reactions, loads, plane):
    """Deflection (m) and slope of a stepped beam at its stations in one plane, by singularity functions:
    M = sum F <y - a>, integrated piece by piece, with both supports moved as they are.
    """
    forces = [(y, f) for y, f, _ in reactions] + loads
    marks = sorted({0.0, *(s.y1 for s in scene.segments), *(y for y, _ in forces)})
    slope, place = [0.0], [0.0]
    for a, b in pairwise(marks):
        segment = next(s for s in scene.segments if s.y0 <= a and b <= s.y1 + 1e-12)
        stiff = segment.material.E * math.pi * segment.outer0**4 / 4
        # EI w'' = M: a load along +w bends the part beyond it towards -w
        at_a = sum(f * (a - y) for y, f in forces if y < a + 1e-12) / stiff
        rate = sum(f for y, f in forces if y < a + 1e-12) / stiff
        h = b - a
        place.append(place[-1] + slope[-1] * h + at_a * h**2 / 2 + rate * h**3 / 6)
        slope.append(slope[-1] + at_a * h + rate * h**2 / 2)
    raw = dict(zip(marks, zip(place, slope)))
    (y1, _, w1), (y2, _, w2) = reactions
    turn = ((w2 - raw[y2][0]) - (w1 - raw[y1][0])) / (y2 - y1)
    shift = w1 - raw[y1][0] - turn * y1
    return {y: (w + shift + turn * y, s + turn) for y, (w, s) in raw.items()}


def test_deflection_equals_a_beam_by_hand_in_both_planes():
    scene = countershaft()
    solved = settled(scene)
    places = {s.name: s.y for s in scene.stations}
    by_name = {b.name: b.load for b in solved.shafts[0].bearings}
    for k, tilt, sign in ((0, 5, -1.0), (2, 3, 1.0)):
        supports = [(places[n], -by_name[n][k], solved.shafts[0].ports[n][k]) for n in "AB"]
        loads = [(load.y, load.six[k]) for load in acting_loads(scene)]
        by_hand = beam(scene, supports, loads, k)
        for name, y in places.items():
            moved = solved.shafts[0].ports[name]
            expected = by_hand[y]
            assert moved[k] == pytest.approx(expected[0], rel=1e-6, abs=1e-13), (name, k)
            assert moved[tilt] == pytest.approx(sign * expected[1], rel=1e-6), (name, tilt)


def test_twist_equals_that_of_shafts_in_a_row():
    scene = countershaft()
    twisted = settled(scene).shafts[0].ports
    torque, angle = 3240.0 * POUND_INCH, 0.0
    start, end = 2.75 * INCH, 8.5 * INCH
    for s in scene.segments:
        length = min(s.y1, end) - max(s.y0, start)
        if length > 0:
            shear = s.material.E / (2 + 2 * s.material.nu)
            angle += torque * length / (shear * math.pi * s.outer0**4 / 2)
    assert twisted["gear 4"][4] == pytest.approx(0, abs=1e-12)
    assert twisted["gear 3"][4] == pytest.approx(angle, rel=1e-9)


def mounted(name, place, turning=0.0):
    stiffness = dict.fromkeys(("kxx", "kyy", "kzz"), 1e9) | ({"kthy": turning} if turning else {})
    return sg.Bearing(name=name, y=place, seat_width=0.02, stiffness=stiffness)


def rod(*loads, bearings=(), **rest):
    """A rod of 0.4 m on two bearings, with a gear in its middle."""
    return sg.Scene.from_parts(
        [sg.Segment.cylinder("rod", length=0.4, diameter=0.04)],
        bearings=bearings or (mounted("A", 0.05), mounted("B", 0.35)),
        port=sg.Port(name="gear", y=0.2, lo=0.18, hi=0.22),
        loads=loads,
        **rest,
    )


def test_bearings_that_hold_the_shaft_share_a_torque_by_stiffness():
    torque = sg.ShaftLoad(name="drive", on="gear", torque=300.0)
    single = settled(rod(torque, bearings=[mounted("A", 0.05, 2e5), mounted("B", 0.35)]))
    (a, b) = single.shafts[0].bearings
    assert (a.load[4], b.load[4]) == pytest.approx((300.0, 0.0))
    assert single.shafts[0].ports["A"][4] == pytest.approx(300.0 / 2e5)
    assert single.statics.imbalance < 1e-10

    scene = rod(torque, bearings=[mounted("A", 0.05, 2e5), mounted("B", 0.35, 5e5)])
    double = settled(scene.with_attachment("section"))
    (a, b) = double.shafts[0].bearings
    polar = math.pi * 0.02**4 / 2
    shaft = sg.STEEL.E / (2 + 2 * sg.STEEL.nu) * polar / 0.15  # from the gear to either bearing
    soft = [1 / 2e5 + 1 / shaft, 1 / 5e5 + 1 / shaft]  # springs in series, two ways in parallel
    share = soft[1] / sum(soft)
    assert a.load[4] == pytest.approx(300.0 * share, rel=1e-8)
    assert a.load[4] + b.load[4] == pytest.approx(300.0)
    assert double.shafts[0].ports["B"][4] == pytest.approx(b.load[4] / 5e5)


def test_a_load_with_a_place_of_its_own_is_no_lumped_point():
    pulley = sg.ShaftLoad(name="pulley", position=0.39, seat_width=0.02, x=1000.0)
    scene = rod(pulley)
    assert [s.name for s in scene.stations] == ["gear", "A", "B", "pulley"]
    assert [port.name for port in scene.ports] == ["gear"]
    moved = settled(scene).shafts[0]
    assert moved.ports["pulley"][0] > 0
    assert [b.load[0] for b in moved.bearings] == pytest.approx(
        [-1000 * 0.04 / 0.3, 1000 * 0.34 / 0.3]
    )
    assert scene.to_dict()["load"] == [
        {"name": "pulley", "x": 1000.0, "span": [0.38, 0.4]},
    ]
    assert sg.Scene.from_dict(scene.to_dict()) == scene
    spread = rod(sg.ShaftLoad(on="rod", z=1.0), sg.ShaftLoad(on="A", x=1.0)).loads
    assert [(load.name, load.station, load.lo, load.hi) for load in spread] == [
        ("rod", "rod", 0.0, 0.4),
        ("A", "A", None, None),
    ]


@pytest.mark.parametrize("hand", ["left", "right"])
@pytest.mark.parametrize("torque", [120.0, -120.0])
@pytest.mark.parametrize(("cone", "spiral"), [(0.0, 0.0), (0.0, 0.35), (0.4, 0.0), (0.6, 0.5)])
def test_tooth_forces_point_along_the_line_of_action(hand, torque, cone, spiral):
    gear = {"pitch_diameter": 0.08, "pressure_angle": "20 deg", "towards": "-x"}
    gear |= {"helix_angle": spiral, "hand": hand} if spiral else {}
    gear |= {"pitch_angle": cone, "apex": "-y"} if cone else {}
    force, moment = np.split(sg.ShaftLoad(name="g", on="g", torque=torque, **gear).six(), 2)
    side = "left" if torque > 0 else "right"
    normal = line_of_action(cone, spiral, math.radians(20), hand, side)
    assert force / np.linalg.norm(force) == pytest.approx(normal, abs=1e-12)
    assert moment == pytest.approx(np.cross([-0.04, 0.0, 0.0], force))
    assert moment[1] == pytest.approx(torque)
    # turned half round with its shaft about z: the apex lies at +y, and the torque the other way
    turned = gear | {"towards": "+x"} | ({"apex": "+y"} if cone else {})
    back = sg.ShaftLoad(name="g", on="g", torque=-torque, **turned).six()
    assert back == pytest.approx(np.concatenate([force, moment]) * [-1, -1, 1, -1, -1, 1])


def test_pulls_of_a_belt_follow_from_any_two_words():
    words_of_belt = {"torque": 50.0, "tight": 750.0, "slack": 250.0, "pull_ratio": 3.0}
    words = [*words_of_belt]
    for k, first in enumerate(words):
        for second in words[k + 1 :]:
            known = {word: words_of_belt[word] for word in (first, second)}
            sense = {} if "torque" in known else {"sense": "driven"}
            belt = sg.ShaftLoad(name="b", on="b", diameter=0.2, towards="30 deg", **known, **sense)
            x, y, z, thx, thy, thz = belt.six()
            assert (x, z) == pytest.approx((1000 * math.cos(math.pi / 6), 500.0))
            assert (y, thx, thy, thz) == pytest.approx((0, 0, 50.0, 0))
    belt = sg.ShaftLoad(name="b", on="b", diameter=0.2, towards="+z", torque=50.0, slack=0)
    assert belt.six(-2.0).tolist() == [0, 0, 1000, 0, -100, 0]


def test_a_torque_turned_round_takes_the_other_flanks():
    gear = sg.ShaftLoad(name="g", on="g", torque=100.0, pitch_diameter=0.1, towards="+z")
    forth, back = gear.six(1.0), gear.six(-0.5)
    assert back[[0, 4]] == pytest.approx(-0.5 * forth[[0, 4]])
    assert back[2] == pytest.approx(0.5 * forth[2]) and forth[2] < 0
    driving = gear.with_changes(sense="driving")
    assert driving.six(turns=1.0) == pytest.approx(gear.six(-1.0))
    assert driving.six(turns=-1.0) == pytest.approx(gear.six())


def test_a_power_is_a_torque_at_the_speed_of_the_case():
    """5.5 kW at 1500 rpm are 35.01 N m, at 500 rpm three times as much; brought to a shaft that
    turns about -y, they turn it about -y.
    """
    hub = sg.ShaftLoad(name="hub", on="gear", power="5.5 kW")
    cases = [sg.LoadCase(name=f"{n}", speed=f"{n} rpm") for n in (1500, 500)]
    for turns, sign in ((None, 1), ("+y", 1), ("-y", -1)):
        shaft = rod(hub, cases=cases).with_changes(turns=turns, torque_at="A")
        for case, torque in zip(shaft.cases, (35.0141, 105.0423)):
            load, *_ = acting_loads(shaft, case)
            assert load.six[4] == pytest.approx(sign * torque, rel=1e-5)
    teeth = {"pitch_diameter": 0.08, "towards": "+x", "sense": "driving"}
    gear = sg.ShaftLoad(name="gear", on="gear", power=5500.0, **teeth)
    same = sg.ShaftLoad(name="gear", on="gear", torque=5500.0 / 157.0796, **teeth)
    for turns in (1.0, -1.0):
        six = gear.six(turns=turns, speed=157.0796)
        assert six == pytest.approx(same.six(turns=turns), rel=1e-9)
    with pytest.raises(SolidgearError, match=r"load\[1\].power.* a torque at a speed"):
        acting_loads(rod(hub))
    with pytest.raises(SolidgearError, match="either torque or power"):
        sg.ShaftLoad(on="gear", power="1 kW", torque="2 N*m")


@pytest.mark.parametrize("written", [6000, "6000 h", "250 day", "360000 min", "2.16e7 s"])
def test_hours_are_plain_or_with_a_unit_of_time(written):
    assert sg.LoadCase(name="a", hours=written).hours == pytest.approx(6000, rel=1e-12)


@pytest.mark.parametrize(("written", "says"), [("6000", "hours"), ("6 kg", "6000 h"), (-1, "zero")])
def test_hours_without_a_unit_of_time_are_refused(written, says):
    with pytest.raises(SolidgearError, match=says):
        sg.LoadCase(name="a", hours=written)


BAD = {
    "off the shaft": (
        'name = "gear 3"\non = "gear 3"\ntangential_force',
        'name = "wheel"\nposition = "290 mm"\nseat_width = "20 mm"\ntangential_force',
        "reaches from 0.28 to 0.3 m, which must lie inside the shaft (0 to 0.2921 m)",
    ),
    "unknown place": ('on = "gear 3"\ntang', 'on = "gear 5"\ntang', 'did you mean "gear 4"'),
    "no width": (
        'on = "gear 3"\ntang',
        'position = "70 mm"\ntang',
        "seat_width: this key is missing",
    ),
    "a station and a place": (
        'on = "gear 3"\ntang',
        'on = "gear 3"\nposition = "70 mm"\ntang',
        "a load on a station has that of the station",
    ),
    "torque that is left": (
        "-2431 lbf",
        "-2000 lbf",
        "366.071 N m of gear 3, -301.331 N m of gear 4 leave 64.7403 N m; give the load that takes "
        "-64.7403 N m, write torque_at",
    ),
    "two ways": (
        'towards = "+z"',
        'towards = "+z"\ndiameter = "5 in"',
        "pitch_diameter makes it a gear, diameter a belt or chain",
    ),
    "torque and force": ("tangential_force =", 'torque = "1 N*m"\ntangential_force =', "not both"),
    "about the axis": ("tangential_force =", "thy = 3\ntangential_force =", "is written torque"),
    "no direction": ('towards = "+z"\n', "", "towards: this key is missing; a gear needs towards"),
    "strange direction": ('towards = "+z"', 'towards = "up"', "an angle from x towards z"),
    "no hand": ('towards = "+z"', 'towards = "+z"\nhelix_angle = "15 deg"', "with helix_angle"),
    "no sense of turning": ('towards = "+z"', 'towards = "+z"\nsense = "driven"', 'turns = "+y"'),
    "unknown load of a case": (
        "[[load]]",
        '[[case]]\nname = "a"\nfactors = { "gear 5" = 2 }\n[[load]]',
        'case[1] "a".factors."gear 5" = 2: there is no load "gear 5"',
    ),
    "share above one": ("[[load]]", '[[case]]\nname = "a"\nshare = 1.5\n[[load]]', "share = 1.5"),
    "shares above one": (
        "[[load]]",
        '[[case]]\nname = "a"\nshare = 0.7\n[[case]]\nname = "b"\nshare = 0.7\n[[load]]',
        "the shares of 2 cases sum to 1.4",
    ),
    "torque of a case": (
        "[[load]]",
        '[[case]]\nname = "a"\nloads = ["gear 3"]\n[[load]]',
        'in the case "a"',
    ),
}


@pytest.mark.parametrize("kind", BAD)
def test_refused_in_a_sentence(kind, tmp_path):
    text = COUNTERSHAFT.read_text(encoding="utf-8")
    old, new, says = BAD[kind]
    assert old in text
    path = tmp_path / "spoilt.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(SolidgearError) as caught:
        as_written(path)
    message = str(caught.value)
    assert says in message and message.count("\n") == 0 and "spoilt.toml: " in message, message


# ------------------------------------------------------------------------------------------- cases
def catalogued(*cases, **rest):
    """The rod on deep groove ball bearings with a spur gear, which a torque at its end turns."""
    bearings = [
        sg.Bearing(name="A", y=0.05, bore=0.04, designation="6208", clearance="0 um"),
        sg.Bearing(
            name="B", y=0.35, bore=0.04, designation="6208", clearance="0 um", support="floating"
        ),
    ]
    gear = sg.ShaftLoad(
        name="teeth", on="gear", torque=150.0, pitch_diameter=0.12, towards="+x", **rest
    )
    hub = sg.ShaftLoad(name="coupling", position=0.39, seat_width=0.02, torque=-150.0)
    return rod(gear, hub, bearings=bearings, cases=cases)


FULL = sg.LoadCase(name="full", speed="1500 rpm", share=0.25)
HALF = sg.LoadCase(
    name="half", factors={"teeth": 0.5, "coupling": 0.5}, speed="3000 rpm", share=0.75
)
BACK = sg.LoadCase(name="back", factors={"teeth": -1, "coupling": -1}, speed="600 rpm")


def test_lives_in_all_cases_add_their_damage():
    result = sg.bearing(catalogued(FULL, HALF))
    assert result.case == "full" and [fact.name for fact in result.facts] == ["A", "B"]
    assert result.facts[0].life.speed == pytest.approx(50 * math.pi)
    (a, _) = result.lives
    full, half = (point.life for point in a.points)
    assert [point.label for point in a.points] == ["full (1500 rpm)", "half (3000 rpm)"]
    # half the load of a ball bearing is eight times the life, but for its small moment
    assert half.life.basic / full.life.basic == pytest.approx(8.0, rel=0.02)
    damage = [
        0.25 * 1500 * 60 / full.life.reference,
        0.75 * 3000 * 60 / half.life.reference,
    ]
    assert a.duty.hours == pytest.approx(1 / sum(damage))
    assert a.duty.damage == pytest.approx([part / sum(damage) for part in damage])
    assert [row["at"] for row in result.as_dict()["cases"][0]["points"]] == [
        "full (1500 rpm)",
        "half (3000 rpm)",
    ]
    assert result["A"] is result.facts[0]
    key = Keyway(name="key", segment="rod", position=0.17, length=0.03, width=0.008, depth=0.004)
    keyed = sg.bearing(catalogued(FULL, HALF).with_changes(features=(key,)))
    # the shaft with its keyway is softer, which shifts little of the loads of two bearings
    hours = [life.duty.hours for life in result.lives]
    assert [life.duty.hours for life in keyed.lives] == pytest.approx(hours, rel=1e-3)
    chosen = sg.bearing(catalogued(FULL, HALF), "B", case="2")
    assert chosen.case == "half" and chosen.facts[0].load == pytest.approx(
        result.facts[1].load / 2, rel=0.02, abs=1.0
    )


def test_bearings_settle_under_the_first_case_and_anew_under_another():
    scene = catalogued(FULL, HALF)
    stiff = [s.settled.bearings[0].stiffness[2, 2] for s in (scene, scene.with_case("half"))]
    assert stiff[1] < stiff[0]
    assert all(b.matrix is None for b in scene.settled.with_case("half").bearings)
    loads = tuple(load.with_changes(torque=load.torque / 2) for load in scene.loads)
    slow = (FULL.with_changes(speed=HALF.speed), HALF)  # balls have inertia
    halved = scene.with_changes(loads=loads, cases=slow).settled.bearings[0].stiffness[2, 2]
    assert halved == pytest.approx(stiff[1], rel=1e-9)
    assert load(scene, "half").bearings[0].stiffness[2, 2] == stiff[1]  # as of --case


def test_every_case_is_shown_and_a_reversed_one_presses_the_other_flanks(run, tmp_path):
    path = tmp_path / "rod.toml"
    scene = catalogued(FULL.with_changes(share=None), BACK)
    scene.to_toml(path)
    said = run("deflect", path, "-f", "euler")[1]
    assert "In the case full, under" in said and "Torque along the shaft" in said
    rows = [line.split() for line in said.splitlines() if line.startswith((" full (", " back ("))]
    assert [row[0] for row in rows] == ["full", "back"] + ["full", "full", "back", "back"]
    full, back = (np.array(row[4:7], float) for row in rows[:2])  # um of the gear
    assert back[2] == pytest.approx(-full[2], rel=0.02) and back[0] == pytest.approx(
        full[0], rel=0.02
    )
    data = json.loads(run("deflect", path, "-f", "euler", "--case", "back", "--json")[1])
    assert data["case"] == "back" and data["points"] == []
    by_name = {load["name"]: load for load in data["loads"]}
    assert by_name["teeth"]["factor"] == -1 and by_name["teeth"]["six"][4] == pytest.approx(-150)
    assert data["models"]["euler"]["statics"]["imbalance"] < 1e-9
    code, _, refused = run("-q", "deflect", path, "-f", "euler", "--case", "forth")
    assert code == 1 and "there is no case \"forth\"; there are 1 'full', 2 'back'" in refused


def test_a_drive_leaves_where_the_file_says():
    scene = rod(torque_at="B")
    result = sg.deflect(scene, "euler", load="z=1 kN", drive={"A": "40 N*m"}).judge
    assert [(load.name, load.station) for load in result.load.acting] == [
        ("load", "gear"),
        ("drive at A", "A"),
        ("torque at B", "B"),
    ]
    (stretch,) = result.statics.torque
    assert (stretch.start, stretch.end, stretch.torque) == pytest.approx((0.05, 0.35, -40.0))
    # as the torques of the scene, which stress sees as well
    stressed = sg.stress(scene, "euler", load="z=1 kN", drive={"A": 40.0})
    assert stressed.shafts[0].found.forces.at(0.1)[4] == pytest.approx(-40.0)


# ------------------------------------------------------------------------------------------- files
def test_loads_and_cases_go_through_files_of_any_kind(tmp_path):
    scene = catalogued(FULL, HALF).with_changes(
        turns="-y", torque_at="gear", name="rod", weight="x"
    )
    assert sg.Scene.from_dict(scene.to_dict()) == scene
    scene.to_toml(tmp_path / "rod.toml")
    assert as_written(tmp_path / "rod.toml") == scene
    out = exported(scene)
    assert {"load", "case", "turns", "torque_at"} <= {*dict(out.without_place)["rod"]}
    again = sg.Scene.from_dict(tomllib.loads(imported(out.document, "rod").files["rod.toml"]))
    for key in ("loads", "cases", "turns", "torque_at", "weight"):
        assert getattr(again, key) == getattr(scene, key), key


def test_entries_of_loads_vary_and_may_have_ranges(tmp_path):
    scene = catalogued().with_changes(
        torque_at="A", bearings=(mounted("A", 0.05), mounted("B", 0.35))
    )
    vary = "load.teeth.torque=100 N*m,200 N*m"
    rows = sg.sweep(scene, vary, model="euler", n=1)
    assert rows["load.teeth.torque"].tolist() == [100.0, 200.0]
    ranged = sg.Scene.from_dict({**scene.to_dict(), "uncertain": {"load.teeth.torque": "± 10 %"}})
    (entry,) = ranged.uncertain
    scaled = with_scaled_entry(ranged, entry.path, entry.high)
    assert scaled.loads[0].torque == pytest.approx(165.0)
    assert scaled.loads[1] == ranged.loads[1]


def test_loads_of_a_shaft_in_a_train_act_where_they_are():
    train = sg.load_train(GEOMETRY / "gearbox_train.toml")
    pull = sg.ShaftLoad(name="pull", on="A", x=700.0)
    scene = train.pinion.scene.with_changes(load=None, loads=(pull,))
    shaft = train.shafts["pinion"].with_changes(scene=scene, scene_load="added")
    assembly = Assembly(train.with_changes(pinion=shaft))
    loads, notes = scene_loads(assembly, "pinion", {}, AT_REST)
    assert {name: six.tolist() for name, six in loads.items()} == {"A": [700.0, 0, 0, 0, 0, 0]}
    assert "is added to the mesh force" in notes[0]


def test_two_shafts_are_compared_under_their_loads():
    single, double = (rod(sg.ShaftLoad(on="gear", z=f"{k} kN")) for k in (1, 2))
    changes, reason = loaded_changes([single, double])
    by_name = {number.name: number for number in changes}
    assert not reason and [*by_name] == [
        "deflection of gear",
        "radial load of A",
        "radial load of B",
    ]
    moved = by_name["deflection of gear"]
    assert moved.change.b == pytest.approx(2 * moved.change.a) and moved.verdict == "resolved"
    assert by_name["radial load of A"].change.a == pytest.approx(500.0)
    assert loaded_changes([single, rod()]) == ((), "")
    loose = [rod(sg.ShaftLoad(on="gear", y=1e3), bearings=[mounted("A", 0.05)])] * 2
    free = [
        s.with_changes(bearings=[s.bearings[0].with_changes(support="floating")]) for s in loose
    ]
    assert "no bearing holds shaft in y" in loaded_changes(free)[1]


# ------------------------------------------------------------------------------------------ weight
def test_a_shaft_bends_under_its_weight():
    """A rod on two supports near its ends: 5 q l^4 / (384 E I) less what both overhangs lift."""
    supports = [mounted("A", 0.01), mounted("B", 0.39)]
    scene = rod(bearings=supports, weight="-z").with_attachment("section")
    solved = settled(scene)
    area, inertia = math.pi * 0.02**2, math.pi * 0.02**4 / 4
    q, stiff = sg.STEEL.density * area * 9.80665, sg.STEEL.E * inertia
    span, over = 0.38, 0.01
    sag = 5 * q * span**4 / 384 / stiff - q * over**2 / 2 * span**2 / 8 / stiff
    sag += q * 0.4 / 2 / 1e9  # of the bearings
    assert solved.displacement["gear"][2].value == pytest.approx(-sag, rel=1e-6)
    assert [b.load[2] for b in solved.shafts[0].bearings] == pytest.approx([-q * 0.2] * 2)
    assert solved.statics.imbalance < 1e-9 and solved.load.acting[0].name == "weight"


def test_bearings_settle_alike_under_weight_by_either_equilibrium():
    """The shaft seen from its ports, and the system that carries its own mass."""
    disc = sg.PointMass(name="disc", mass=40.0, on="gear", offset=[0.0, 0.03, 0.0])
    scene = catalogued().with_changes(weight="-x", masses=(disc,))
    solved = settled(scene, "timoshenko")
    seen = solved_bearings(scene, sg.build(scene, "timoshenko")).scene
    by_name = {b.name: b for b in seen.bearings}
    for bearing in solved.shafts[0].bearings:
        tangent = bearing.stiffness
        assert by_name[bearing.name].matrix == pytest.approx(
            (tangent + tangent.T) / 2, rel=1e-6, abs=1e-6 * np.abs(tangent).max()
        )
    light = catalogued().settled.bearings[0]
    assert abs(light.stiffness[0, 0] / by_name["A"].stiffness[0, 0] - 1) > 0.01
    assert solved.statics.imbalance < 1e-9


def test_weight_is_whole_on_a_beam_without_fillets():
    scene = as_written(GEOMETRY / "pinion_filleted.toml").with_changes(weight="-z")
    assert scene.blends and settled(scene).statics.imbalance < 1e-9
