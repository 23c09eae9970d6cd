"""Features of a drawing on a shaft: read, refused, left out by models, rated where they are worst."""

import json
import math

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.ladder import build
from solidgear.cuts.features import PressFit
from solidgear.cuts.sector.smearing import smearing
from solidgear.guards.details import details
from solidgear.show.sketch import draw
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.norm.steels import strength_of
from solidgear.strength.stress.shaft import shaft_stress

SHAFT = """
title = "Countershaft"
material = "42CrMo4"
segment = [
  { kind = "cylinder", name = "left", length = "60 mm", diameter = "35 mm" },
  { kind = "cylinder", name = "seat", length = "70 mm", diameter = "40 mm" },
  { kind = "cylinder", name = "collar", length = "15 mm", diameter = "48 mm" },
  { kind = "cylinder", name = "right", length = "80 mm", diameter = "35 mm" },
  { kind = "cylinder", name = "tail", length = "25 mm", diameter = "30 mm" },
]
port = { name = "wheel", at = "seat.middle", span = ["65 mm", "125 mm"] }
load = { x = "4 kN", z = "1.5 kN" }

[[bearing]]
name = "A"
position = "20 mm"
seat_width = "16 mm"
stiffness = { kxx = "3e8 N/m", kzz = "3e8 N/m" }

[[bearing]]
name = "B"
position = "190 mm"
seat_width = "16 mm"
stiffness = { kxx = "3e8 N/m", kyy = "2e8 N/m", kzz = "3e8 N/m" }
"""
KEY = (
    'kind = "keyway", name = "key", segment = "seat", position = "10 mm", length = "45 mm", '
    'width = "12 mm", depth = "5 mm"'
)
HUB = (
    'kind = "press_fit", name = "hub", segment = "seat", position = "5 mm", length = "60 mm", '
    'hub_diameter = "90 mm", interference = "40 um", hub_yield_point = "300 MPa"'
)
RING = (
    'kind = "ring_groove", name = "ring", segment = "right", position = "20 mm", '
    'width = "1.6 mm", diameter = "33 mm", radius = "0.1 mm"'
)
UNDERCUT = (
    'kind = "relief", name = "undercut", segment = "right", side = "start", form = "F", '
    'radius = "0.8 mm", depth = "0.4 mm", width = "2.5 mm"'
)
NUT = 'kind = "thread", name = "nut", segment = "tail", size = "M30x1.5"'
ROUND = (
    'kind = "round_groove", name = "groove", segment = "left", position = "40 mm", '
    'radius = "1 mm", depth = "1 mm"'
)
SHARP = 'kind = "v_groove", name = "v", segment = "left", position = "30 mm", depth = "2 mm"'
OIL = 'kind = "cross_hole", name = "oil", segment = "left", position = "50 mm", diameter = "4 mm"'
FLAT = 'kind = "flat", name = "flat", segment = "tail", length = "10 mm", depth = "2 mm"'
#: loads of statics: 4 kN and 1.5 kN at 95 mm between bearings at 20 and 190 mm
FORCE = math.hypot(4000, 1500)


def shaft(tmp_path, *features):
    path = tmp_path / "shaft.toml"
    tables = "\n".join(f"[[feature]]\n{table.replace(', ', chr(10))}" for table in features)
    path.write_text(SHAFT + tables)
    return path


def stressed(scene, torque=300.0, **conditions):
    """Stress under the load at the wheel and a torque from B to it."""
    load = np.array([4000.0, 0, 1500.0, 0, 0, 0])
    first, second = -load * 95 / 170, -load * 75 / 170
    twist = torque * np.eye(6)[4]
    loads = {"wheel": load - twist, "A": first, "B": second + twist}
    return shaft_stress(scene, loads, tolerance=0.05, conditions=Conditions(**conditions))


def drawn(tmp_path, *features, **how):
    found = stressed(sg.load(shaft(tmp_path, *features)), **how)
    return {each.name: each for each in found.drawn}


# ----------------------------------------------------------------------- where, and of what section
def test_each_notch_is_rated_in_the_section_where_it_is_worst(tmp_path):
    """A keyway under the wheel has the moment there, and torque on one side of it."""
    found = drawn(tmp_path, KEY, RING, OIL)
    arm = FORCE * 95 / 170 * 0.075
    key = found["key"]
    assert key.y == pytest.approx(0.095)
    assert key.nominal.bending == pytest.approx(32 * arm / (math.pi * 0.04**3), rel=1e-9)
    assert key.nominal.torsion == pytest.approx(16 * 300 / (math.pi * 0.04**3), rel=1e-9)
    # a groove between wheel and B is worst on the side of the wheel, on its floor of 33 mm
    ring = found["ring"]
    there = FORCE * 75 / 170 * (0.190 - 0.165)
    assert ring.y == pytest.approx(0.165)
    assert ring.nominal.bending == pytest.approx(32 * there / (math.pi * 0.033**3), rel=1e-9)
    # a hole takes its strip out of the section: W = pi d^3/32 - r d^2/3
    oil = found["oil"]
    there = FORCE * 95 / 170 * 0.032
    modulus = math.pi * 0.035**3 / 32 - 0.002 * 0.035**2 / 3
    assert oil.nominal.bending == pytest.approx(there / modulus, rel=1e-9)


def test_every_kind_has_its_rating_or_its_reason(tmp_path):
    found = stressed(sg.load(shaft(tmp_path, KEY, RING, UNDERCUT, NUT, ROUND, SHARP, OIL, FLAT)))
    rated = {each.name for each in found.drawn if each.rating is not None}
    assert rated == {"key", "ring", "undercut", "nut", "groove", "v", "oil"}
    assert [each.name for each in found.unrated] == ["flat"]
    for each in found.drawn:
        assert all(entry.source for entry in each.rating.entries)
        assert each.factors["bending"] >= 1
    safeties = [each.rating.worst for each in found.worst]
    assert safeties == sorted(safeties)


def test_a_key_under_a_pressed_hub_has_the_excess_of_both(tmp_path):
    alone = drawn(tmp_path, KEY) | drawn(tmp_path, HUB)
    both = drawn(tmp_path, KEY, HUB)
    for load in ("bending", "torsion"):
        expected = alone["key"].factors[load] + alone["hub"].factors[load] - 1
        for name in ("key", "hub"):
            assert both[name].factors[load] == pytest.approx(expected, rel=1e-12)
    assert "no factor for both" in both["key"].remark
    assert "beta" in both["key"].rating.assumed


def test_two_keyways_side_by_side_are_one_notch_of_two(tmp_path):
    second = KEY.replace('name = "key"', 'name = "second", angle = "180 deg"')
    alone, both = drawn(tmp_path, KEY), drawn(tmp_path, KEY, second)
    ratio = both["key"].factors["bending"] / alone["key"].factors["bending"]
    assert ratio == pytest.approx(1.15, rel=0.02)


def test_a_steel_by_name_has_the_strength_of_the_norm():
    rod = sg.Segment.cylinder("rod", length=0.1, diameter=0.04, material="16MnCr5")
    found = strength_of(rod)
    assert (found.ultimate, found.yield_point) == (1000e6, 695e6)
    assert strength_of(sg.Segment.cylinder("rod", length=0.1, diameter=0.04)) is None


# ----------------------------------------------------------------------- the command
def test_the_headline_and_json_speak_of_all_notches(run, tmp_path):
    file = shaft(tmp_path, KEY, OIL, FLAT)
    words = ("stress", file, "--drive", "B=300 N*m", "-f", "timoshenko")
    code, said, _ = run(*words)
    flat = " ".join(said.split())
    assert code == 0
    assert 'Worst of 2 notches at keyway "key":' in flat
    corners = "sharp corners at y = 60.000 mm, 130.00 mm, 145.00 mm, 225.00 mm"
    assert f'Not rated: {corners}, flat "flat".' in flat
    assert 'not rated: flat "flat": DIN 743 has no notch factor for a flat.' in flat
    data = json.loads(run(*words, "--json")[1])
    (found,) = [each["found"] for each in data["shafts"].values()]
    assert [each["name"] for each in found["drawn"]] == ["key", "oil"]
    assert data["shafts"]["shaft"]["worst"] == "key"
    (key, _) = found["drawn"]
    assert f"safety {key['rating']['fatigue']:.2f} against fatigue" in flat
    assert "of the tests" in said and "K_3" in said


DUTY = """
[[load]]
name = "gear"
on = "wheel"
x = "40 kN"
[[case]]
name = "heavy"
speed = "1500 rpm"
hours = 0.2
[[case]]
name = "usual"
speed = "1500 rpm"
hours = 2000
factors = { gear = 0.3 }
"""


def cased(tmp_path, *changes):
    """A keyed shaft with a duty table of two cases."""
    path = shaft(tmp_path, KEY)
    text = path.read_text().replace('load = { x = "4 kN", z = "1.5 kN" }', "") + DUTY
    for old, new in changes:
        text = text.replace(old, new)
    path.write_text(text)
    return path


def test_a_duty_table_is_the_spectrum_of_its_cases(tmp_path):
    """1500 rpm for 0.2 and 2000 h turn 18 000 and 180 000 000 times; every case settles anew."""
    file = cased(tmp_path)
    spectrum = {"spectrum": "1:18000, 0.3:1.8e8"}
    over, same, endless = (
        sg.stress(file, "timoshenko", tol=0.05, **how).shafts[0].found.drawn[0].rating
        for how in ({"duty": True}, {"conditions": spectrum}, {})
    )
    assert over.fatigue == pytest.approx(same.fatigue, rel=1e-6)
    assert over.elementary == pytest.approx(same.elementary, rel=1e-6)
    assert over.fatigue > endless.fatigue and over.yielding == pytest.approx(endless.yielding)
    shares = [("hours = 0.2", "share = 0.0001"), ("hours = 2000", "share = 0.9999")]
    by_share = cased(tmp_path, *shares)
    halves = sg.stress(by_share, "timoshenko", duty=True, conditions={"hours": 2000.2}, tol=0.05)
    found = halves.shafts[0].found.drawn[0].rating
    assert found.fatigue == pytest.approx(over.fatigue, rel=1e-3)


@pytest.mark.parametrize(
    "changes, words, says",
    [
        ([('speed = "1500 rpm"', "")], (), "cycles of bending are turns of the shaft"),
        ([("hours = 0.2", ""), ("hours = 2000", "")], (), "needs share or hours"),
        ([("hours = 0.2", "share = 0.1"), ("hours = 2000", "share = 0.9")], (), "give the life by"),
        ([], ("--cycles", "1e5"), "a duty table gives the cycles"),
    ],
)
def test_a_duty_table_without_times_or_speeds_is_refused(run, tmp_path, changes, words, says):
    file = cased(tmp_path, *changes)
    code, _, refused = run("-q", "stress", file, "-f", "timoshenko", "--duty", *words)
    assert code == 1 and says in " ".join(refused.split())


def test_models_leave_details_out_and_check_says_so(tmp_path):
    plain, detailed = (sg.load(shaft(tmp_path, *f)) for f in ((), (RING, UNDERCUT, NUT)))
    first, second = (build(scene, "timoshenko").blocks for scene in (plain, detailed))
    assert all((one.stiffness != other.stiffness).nnz == 0 for one, other in zip(first, second))
    (notice,) = details(detailed)
    assert notice.sentence.endswith(
        'thread "nut": no model has them; solidgear stress rates them by DIN 743'
    )
    assert not [*details(plain)] and not [*smearing(detailed)]


def test_a_drawing_marks_grooves_threads_and_hubs(tmp_path):
    scene = sg.load(shaft(tmp_path, HUB, RING, UNDERCUT, NUT))
    text = draw(scene.as_dict()).svg("wide", "a-")
    for label in ("press fit hub", "ring groove ring", "relief undercut", "thread nut"):
        assert label in text


def test_features_are_written_and_read_again(tmp_path):
    scene = sg.load(shaft(tmp_path, KEY, HUB, RING, UNDERCUT, NUT, ROUND, SHARP))
    again = sg.Scene.from_dict(scene.to_dict())
    assert again.features == scene.features
    assert again.features[4].size == "M30x1.5"


# ----------------------------------------------------------------------- pressed hubs
def test_the_pressure_of_a_hub_is_that_of_thick_rings():
    """Two rings with u = A r + B/r each, solved for the same radius less the interference."""
    fit = PressFit(
        name="hub", segment="seat", y=0.0, hub_diameter=0.09, interference=4e-5, hub_E=1.2e11
    )
    bored = sg.Segment(name="seat", y1=0.07, outer0=0.02, outer1=0.02, inner0=0.005, inner1=0.005)
    a, b, c = 0.005, 0.02, 0.045

    def ring(modulus, nu, inner, outer):
        """Rows of radial displacement and stress by A and B, at both radii (plane stress)."""
        move = [[r, 1 / r] for r in (inner, outer)]
        press = [[modulus / (1 - nu), -modulus / (1 + nu) / r**2] for r in (inner, outer)]
        return np.array(move), np.array(press)

    move_s, press_s = ring(bored.material.E, bored.material.nu, a, b)
    move_h, press_h = ring(1.2e11, 0.3, b, c)
    zero = np.zeros(2)
    rows = np.array(
        [
            np.r_[press_s[0], zero],
            np.r_[zero, press_h[1]],
            np.r_[press_s[1], -press_h[0]],
            np.r_[-move_s[1], move_h[0]],
        ]
    )
    constants = np.linalg.solve(rows, [0, 0, 0, 2e-5])
    assert fit.pressure(bored) == pytest.approx(-(press_h[0] @ constants[2:]), rel=1e-9)


def test_a_fit_gives_the_largest_interference():
    """40 H7/s6: 43 + 16 um; 65 H7/u6 is in the range to 65, 87 + 19 um."""
    fit = PressFit(name="hub", segment="s", y=0.0, hub_diameter=0.2, fit="H7/s6")
    for diameter, other, most in (
        (0.04, fit, 59e-6),
        (0.065, fit.with_changes(fit="H7/u6"), 106e-6),
    ):
        seat = sg.Segment(name="s", y1=0.07, outer0=diameter / 2, outer1=diameter / 2)
        assert other.most(seat) == pytest.approx(most, rel=1e-9)


# ----------------------------------------------------------------------- refusals
@pytest.mark.parametrize(
    "table, says",
    [
        (KEY.replace("45 mm", "70 mm"), "the keyway reaches from 0.07 to 0.14 m, outside"),
        (f'{KEY}, mill = "60 mm"', "a disc mill runs out beyond square ends"),
        (f'{KEY}, radius = "7 mm"', "radii up to the depth"),
        (RING.replace('diameter = "33 mm"', 'depth = "18 mm"'), "cuts through the radius"),
        (RING.replace("33 mm", "36 mm"), 'lies below the surface of "right"'),
        (RING.replace('diameter = "33 mm", ', ""), "depth"),
        (RING.replace("0.1 mm", "2 mm"), "have radii up to"),
        (NUT.replace("M30x1.5", "M30x8"), "too coarse for a diameter of 30 mm"),
        (NUT.replace("M30x1.5", "M36x1.5"), "is cut into a cylinder of 0.036 m"),
        (NUT.replace("M30x1.5", "30 mm"), "is no metric thread"),
        (HUB.replace("40 um", "90 um"), "the hub yields at 139 MPa (DIN 7190-1): it bears 66 um"),
        (HUB.replace("90 mm", "38 mm"), "is thicker than it"),
        (HUB.replace('interference = "40 um"', 'fit = "H7/u6"'), "it bears 66 um at most"),
        (HUB.replace('interference = "40 um"', 'fit = "h6/S7"'), "is no fit that is known here"),
        (HUB.replace(', interference = "40 um"', ""), "interference"),
        (UNDERCUT.replace('"start"', '"end"'), "no shoulder stands at the end"),
        (SHARP.replace("2 mm", "0.05 mm"), "is above the depth"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(run, tmp_path, table, says):
    file = shaft(tmp_path, table)
    code, said, refused = run("-q", "stress", file)
    assert code == 1 and said == "" and says in " ".join(refused.split())
    assert str(file.name) in refused


@pytest.mark.parametrize(
    "words, says",
    [
        (("--cycles", "500"), "finite life begins at 1000 cycles"),
        (("--cycles", "1e5", "--spectrum", "1:1e4"), "not both"),
        (("--spectrum", "1;1e4"), "is no level; write factors of the load"),
        (("--surface-strength", "2000 MPa"), "say hard_surface too"),
        (("--hard-surface", "--cycles", "1e5"), "the slope of others is not known"),
        (("--overload", "0.5"), "--overload"),
    ],
)
def test_conditions_that_contradict_are_refused(run, tmp_path, words, says):
    code, _, refused = run("-q", "stress", shaft(tmp_path, KEY), *words)
    assert code == 1 and says in " ".join(refused.split())


def test_factors_outside_of_the_norm_are_not_extrapolated(tmp_path):
    shallow = ROUND.replace('depth = "1 mm"', 'depth = "0.3 mm"')
    deep = SHARP.replace("2 mm", "6 mm")
    found = stressed(sg.load(shaft(tmp_path, shallow, deep)))
    reasons = {each.name: each.reason for each in found.unrated}
    assert reasons["groove"].endswith("d/D = 0.9829 is above 0.98")
    assert "t/d from 0.05 to 0.2" in reasons["v"]
    assert found.drawn == ()
