"""Floating and locating bearings, and pairs in O and X by one word."""

import numpy as np
import pytest

import solidgear as sg
from solidgear.bearings.balance import Mounted
from solidgear.bearings.ball import BallRow
from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.equilibrium import equilibrium
from solidgear.bearings.rolling import RollingBearing
from solidgear.bearings.solved import solved
from solidgear.bearings.spinning import SpinningBalls
from solidgear.core.errors import SceneError
from solidgear.core.scene.file import load as read
from solidgear.core.scene.support import sliding

FELT = [0, 1, 2, 3, 5]
ACROSS = np.ix_([0, 2, 3, 5], [0, 2, 3, 5])
GROOVE = (BallRow(9, 12e-3, 60e-3, clearance=12e-6),)
ROWS = {
    "deep groove": GROOVE,
    "at speed": (SpinningBalls(GROOVE[0], 1000.0),),
    "preloaded pair": tuple(
        BallRow(14, 11.9e-3, 60e-3, 0.698, side, preload=4e-6, height=9e-3 * -side)
        for side in (1, -1)
    ),
}
SHAFT = """
material = "steel"
{word}
segment = [{{ kind = "cylinder", name = "rod", length = "300 mm", diameter = "40 mm" }}]
port = {{ name = "gear", at = "rod.middle", span = ["140 mm", "160 mm"] }}
load = {{ x = "1 kN", y = "400 N", z = "2 kN" }}
[[bearing]]
name = "A"
position = "{a}"
seat_width = "18 mm"
catalogue = {{ designation = "7208 B", preload = "400 N"{first} }}
[[bearing]]
name = "B"
position = "{b}"
seat_width = "18 mm"
catalogue = {{ designation = "7208 B", preload = "400 N"{second} }}
"""


def shaft(tmp_path, word="", first="", second="", a="40 mm", b="260 mm", more=""):
    path = tmp_path / "shaft.toml"
    path.write_text(SHAFT.format(word=word, first=first, second=second, a=a, b=b) + more)
    return path


@pytest.mark.parametrize("rows", ROWS.values(), ids=ROWS)
def test_a_floating_bearing_is_the_same_bearing_under_its_other_loads_alone(rows):
    """Its stiffness is that of the ring where nothing presses it along y, wherever the seat is."""
    load = [1000.0, 0.0, 2000.0, 5.0, 0.0, -3.0]
    fixed, floating = RollingBearing(rows), RollingBearing(rows, floats=True)
    there = fixed.motion(load)  # five equations, y one of them
    soft = np.linalg.inv(fixed.tangent(there)[np.ix_(FELT, FELT)])
    alone = np.linalg.inv(soft[np.ix_([0, 2, 3, 4], [0, 2, 3, 4])])  # y gives
    for along in (-2e-4, 0.0, 3e-5):
        moved = there.copy()
        moved[1] += along
        found = floating.tangent(moved)
        assert np.allclose(found[ACROSS], alone, rtol=1e-8, atol=1e-9 * alone.max())
        assert not found[1].any() and not found[:, 1].any()
        carried = floating.load(moved)
        assert carried[1] == 0.0 and carried[FELT] == pytest.approx(np.array(load)[FELT], abs=1e-6)


def test_a_thrust_elsewhere_leaves_a_floating_bearing_as_it_is():
    rod = sg.Segment.cylinder("rod", length=0.4, diameter=0.04)
    seat = {"seat_width": 0.01, "stiffness": {"kxx": 1e8}}
    seats = [sg.Bearing(name=n, y=y, **seat) for n, y in (("A", 0.02), ("B", 0.38))]
    port = sg.Port(name="mesh", y=0.25, lo=0.24, hi=0.26)
    body = sg.build(sg.Scene.from_parts([rod], bearings=seats, port=port), "euler")
    mounts = [
        Mounted("A", RollingBearing(ROWS["preloaded pair"])),
        Mounted("B", RollingBearing(GROOVE, floats=True)),
    ]
    found = equilibrium(body, mounts, {"mesh": [0, 1500.0, 2000.0, 0, 0, 0]})
    pushed = found.load["B"]
    assert pushed[1] == 0.0 and found.load["A"][1] == pytest.approx(1500.0, rel=1e-9)
    fixed = RollingBearing(GROOVE)
    alone = fixed.tangent(fixed.motion(pushed))
    along = alone - np.outer(alone[:, 1], alone[1]) / alone[1, 1]
    assert np.allclose(found.tangent["B"][ACROSS], along[ACROSS], rtol=1e-6, atol=1.0)


def test_a_spring_that_floats_gives_with_what_couples_it_to_y():
    K = np.diag([8e8, 4e8, 9e8, 2e5, 0.0, 2e5])
    K[0, 1] = K[1, 0] = 1e8
    given = {"name": "A", "y": 0.1, "seat_width": 0.02, "stiffness": K}
    found = sg.Bearing(**given, support="floating").stiffness
    soft = np.linalg.inv(K[np.ix_(FELT, FELT)])
    expected = np.linalg.inv(soft[np.ix_([0, 2, 3, 4], [0, 2, 3, 4])])
    assert np.allclose(found[ACROSS], expected, rtol=1e-12)
    assert not found[1].any() and np.array_equal(sliding(found), found)
    assert np.array_equal(sg.Bearing(**given, support="locating").stiffness, K)


def test_locating_is_what_a_bearing_does_without_a_word():
    scene = read("geometry/gearbox_wheel.toml")
    said = scene.with_changes(bearings=[b.with_changes(support="locating") for b in scene.bearings])
    body = sg.build(scene, "euler")
    silent, told = (solved(one, body).scene.bearings for one in (scene, said))
    assert [b.matrix for b in silent] == [b.matrix for b in told]
    floating = [told[0].unsettled, told[1].with_changes(support="floating", matrix=None)]
    found = solved(scene.with_changes(bearings=floating), body)
    assert found.equilibrium.load["D"][1] == 0.0 and found.equilibrium.load["C"][1] != 0.0


@pytest.mark.parametrize("a, b", [("40 mm", "260 mm"), ("260 mm", "40 mm")])
def test_one_word_stands_for_the_directions_of_both_bearings(tmp_path, a, b):
    """By their places along the shaft, in whichever order the file has them."""
    for word, lower, upper in (("O", "+y", "-y"), ("X", "-y", "+y")):
        first, second = (lower, upper) if a == "40 mm" else (upper, lower)
        holds = (f', holds = "{way}"' for way in (first, second))
        plain = read(shaft(tmp_path, "", *holds, a=a, b=b))
        for said in (f'"{word}"', f'{{ {word} = ["B", "A"] }}'):
            assert read(shaft(tmp_path, f"arrangement = {said}", a=a, b=b)) == plain


def test_a_pair_within_one_bearing_takes_the_same_words():
    for word, known in (("O", "back_to_back"), ("X", "face_to_face"), ("back to back",) * 2):
        data = Catalogue(designation="7208 B", arrangement=word)
        assert data.arrangement == known.replace(" ", "_")


NO_PAIR = (
    ('"Q"', "", r'must be "O" \(back to back\) or "X"'),
    ("[[3]]", "", r'must be "O" \(back to back\) or "X"'),
    ('"back_to_bcak"', "", 'did you mean "back_to_back"'),
    ('{ O = ["A", "C"] }', "", r'no bearing is called "C"; there are A, B'),
    ('{ O = ["A"] }', "", "write the names of two bearings"),
    ('{ O = ["A", "B"], X = ["A", "B"] }', "", "is in two pairs"),
    ('{ O = ["A", "B"] }', ', holds = "+y"', "leave one of them out"),
    ('"O"', ', holds = "+y"', r"this scene has 1: B; name two"),
)  # fmt: skip


@pytest.mark.parametrize("said, first, sentence", NO_PAIR, ids=[s for *_, s in NO_PAIR])
def test_words_that_name_no_pair_end_in_one_sentence(tmp_path, said, first, sentence):
    with pytest.raises(SceneError, match=sentence) as refused:
        read(shaft(tmp_path, f"arrangement = {said}", first))
    assert "shaft.toml: arrangement" in str(refused.value)
    assert len(refused.value.problems) == 1  # and no bearing lacks holds as well


def test_a_bearing_that_is_wrong_by_itself_is_told_alone(tmp_path):
    with pytest.raises(SceneError, match="must be one of the classes") as refused:
        read(shaft(tmp_path, 'arrangement = "O"', ', clearance = "C9"'))
    assert [one.path[:2] for one in refused.value.problems] == [("bearing", 0)]


SEAT = {"name": "A", "y": 0.1, "seat_width": 0.02}
NO_SUPPORT = (
    ({"support": "floatign", "stiffness": {"kxx": 1e8}}, 'did you mean "floating"'),
    ({"catalogue": {"designation": "6208", "support": "floating"}}, "not to its catalogue data"),
    (
        {"support": "locating", "catalogue": {"designation": "NU 207"}},
        "without ribs carries nothing along y: leave support out, or take one with ribs",
    ),
    ({"support": "locating", "stiffness": {"kxx": 1e8}}, "holds nothing along y: write kyy"),
    ({"support": "floating", "hold": "pinned"}, "holds y as well"),
    (
        {"support": "floating", "catalogue": {"designation": "7208 B", "holds": "+y"}},
        'as one bearing with arrangement = "O"',
    ),
    (
        {"support": "floating", "axial_series": [1e8], "stiffness": {"kyy": 1e8}},
        "presses no spring along y",
    ),
    (
        {"support": "floating", "catalogue": {"designation": "6208", "load": {"y": "1 kN"}}},
        "carries nothing along y",
    ),
)


@pytest.mark.parametrize("more, sentence", NO_SUPPORT, ids=[s for _, s in NO_SUPPORT])
def test_a_support_that_cannot_be_ends_in_one_sentence(more, sentence):
    with pytest.raises(SceneError, match=sentence) as refused:
        sg.Bearing(**SEAT, **more)
    assert len(refused.value.problems) == 1


def test_cylindrical_rollers_float_with_and_without_the_word():
    for word in (None, "floating"):
        assert sg.Bearing(**SEAT, catalogue={"designation": "NU 207"}, support=word).floats
    assert not sg.Bearing(**SEAT, catalogue={"designation": "6207"}).floats
