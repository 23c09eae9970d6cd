"""Slips of designers who write loads, cases and notches of a drawing, and shafts that are not round."""

import copy

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.loading import as_written
from solidgear.strength.stress.shaft import sharp_corners

BEARING = {"catalogue": {"designation": "6208"}, "seat_width": "18 mm"}
FILE = {
    "material": "C45",
    "segment": [
        {"kind": "cylinder", "name": "left", "length": "60 mm", "diameter": "40 mm"},
        {"kind": "cylinder", "name": "hub", "length": "60 mm", "diameter": "50 mm"},
        {"kind": "cylinder", "name": "right", "length": "80 mm", "diameter": "40 mm"},
    ],
    "bearing": [
        {"name": "A", "position": "15 mm", **BEARING},
        {"name": "B", "position": "180 mm", "support": "floating", **BEARING},
    ],
    "port": {"name": "gear", "on": "hub"},
    "load": [
        {"name": "gear", "on": "gear", "torque": "150 N*m", "pitch_diameter": "120 mm", "towards": "+z"},
        {"name": "coupling", "on": "right", "torque": "-150 N*m"},
    ],
    "case": [{"name": "full", "speed": "1500 rpm"}, {"name": "half", "factors": {"gear": 0.5, "coupling": 0.5}}],
}  # fmt: skip
KEY = {
    "kind": "keyway",
    "name": "key",
    "segment": "hub",
    "position": "8 mm",
    "length": "44 mm",
    "width": "14 mm",
    "depth": "5.5 mm",
}
FIT = {
    "kind": "press_fit",
    "name": "fit",
    "segment": "hub",
    "position": "5 mm",
    "length": "50 mm",
    "hub_diameter": "90 mm",
    "interference": "30 um",
}


def groove(name, position):
    return {
        "kind": "ring_groove",
        "name": name,
        "segment": "right",
        "position": position,
        "width": "1.85 mm",
        "depth": "1.25 mm",
    }


def relief(segment, side):
    return {
        "kind": "relief",
        "name": segment,
        "segment": segment,
        "side": side,
        "radius": "1 mm",
        "depth": "0.2 mm",
        "width": "2.5 mm",
    }


def changed(path, value, *features):
    """Return the tables with an entry changed."""
    tables = copy.deepcopy({**FILE, "feature": list(features)})
    entry = tables
    for key in path[:-1]:
        entry = entry[key]
    entry[path[-1]] = value
    return tables


@pytest.mark.parametrize(
    ("path", "value", "features", "words"),
    [
        (("load", 0, "pitch_diameter"), 120, (), ("load[1]", "pitch_diameter = 120", "wrong units")),
        (("load", 0, "towards"), 30, (), ("towards = 30", "more than a turn", "30 deg")),
        (("feature", 0, "hub_diameter"), 90, (FIT,), ("hub_diameter = 90", "wrong units")),
        (("feature", 0, "interference"), 30, (FIT,), ("interference = 30", "wrong units")),
        (
            ("feature", 1, "position"),
            "21 mm",
            (groove("first", "20 mm"), groove("second", "40 mm")),
            ('position = "21 mm"', "0.141 to 0.14285 m", '"first" (0.14 to 0.14185 m)'),
        ),
        (
            ("feature", 0, "position"),
            "1 mm",
            (groove("ring", "40 mm"), relief("right", "start")),
            ("side", "0.12 to 0.1225 m", '"ring"'),
        ),
        (("bearing", 0, "catalogue"), {"designation": 6208}, (), ("designation = 6208", "quotes")),
        (("bearing", 0, "catalogue"), {"designation": ""}, (), ('designation = ""', "quotes")),
        (("bearings",), "absent.csv", (), ('bearings = "absent.csv"', "no such file")),
    ],
)  # fmt: skip
def test_slip_is_one_sentence_with_field_and_value(path, value, features, words):
    with pytest.raises(sg.SceneError) as caught:
        as_written(changed(path, value, *features))
    assert len(caught.value.problems) == 1
    for word in words:
        assert word in str(caught.value)


def test_what_lies_at_a_limit_is_no_slip():
    tables = changed(("load", 0, "towards"), "360 deg", FIT, groove("first", "20 mm"))
    tables["feature"].append(groove("second", "21.85 mm"))  # touches the first
    assert len(as_written(tables).features) == 3


def test_absent_load_is_told_by_the_file(tmp_path):
    bare = {key: value for key, value in FILE.items() if key not in ("load", "case")}
    for solve in (sg.deflect, sg.stress):
        with pytest.raises(sg.SceneError, match=r'bearing\[1\] "A".catalogue = {"designation"'):
            solve(bare, "timoshenko")


def test_keyway_leaves_loads_of_bearings_over_cases():
    round_lives = sg.bearing(FILE).lives
    keyed_lives = sg.bearing(changed(("title",), "keyed", KEY)).lives
    assert [life.name for life in keyed_lives] == ["A", "B"]
    for keyed, plain in zip(keyed_lives, round_lives):
        basic = [[point.life.life.basic for point in lives.points] for lives in (keyed, plain)]
        # a keyway makes the shaft softer, which shifts little of the loads of two bearings
        np.testing.assert_allclose(*basic, rtol=1e-4)
        # half of the load lives 2^3 times as long (balls)
        assert basic[0][1] / basic[0][0] == pytest.approx(8.0, rel=0.02)


def test_undercut_shoulder_is_no_sharp_corner():
    corners = [corner.y for corner in sharp_corners(as_written(FILE))]
    assert corners == pytest.approx([0.06, 0.12])
    one = as_written(changed(("title",), "undercut", relief("right", "start")))
    assert [corner.y for corner in sharp_corners(one)] == pytest.approx([0.06])


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: sg.bearing(FILE, speed="fast"), "`speed` \"fast\""),
        (lambda: sg.bearing(FILE, case=3), "no case 3; there are 1 'full', 2 'half'"),
        (lambda: sg.stress(FILE, "timoshenko", tol="5 kg"), 'tol = "5 kg"'),
        (lambda: sg.stress(FILE, "timoshenko", conditions=["roughness"]), "`conditions` = ["),
        (lambda: sg.stress(FILE, "timoshenko", drive=5), "`drive` = 5"),
    ],
)  # fmt: skip
def test_argument_of_a_wrong_type_is_named(call, words):
    with pytest.raises(sg.SolidgearError) as caught:
        call()
    assert words in str(caught.value)


def test_case_is_chosen_by_its_number():
    assert as_written(FILE).with_case(2).cases[0].name == "half"
