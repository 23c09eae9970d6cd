"""Two shafts beside each other: what differs in them is told, signs are those of mechanics, and
nothing inside the bars is called a difference.
"""

import json
import re
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.core.quantity import QUANTITIES
from solidgear.core.scene.uncertain import with_ranges
from solidgear.show.sketch import draw, extent
from solidgear.two_designs.differences import differences, scene_differences
from solidgear.two_designs.two_shafts import two_shafts
from tests.command import command, page_of

GEOMETRY = Path(__file__).parent.parent / "geometry"
SCENE, OTHER, TRAIN = (
    GEOMETRY / f"{name}.toml" for name in ("pinion_overhung", "gear_shaft", "axle_overhung")
)
STATIC = ("m/N", "rad/N", "rad/(N m)", "N/m", "N/rad", "N m/rad")


def loose(scene):
    """It asks for a fifth, so that coarse meshes do."""
    return scene.with_changes(ask=scene.ask.with_changes(tolerance=0.2))


def copied(folder, old='diameter = "90 mm"', new='diameter = "94.5 mm"'):
    """The overhung pinion with another entry: by default a shaft 5 % thicker."""
    text = SCENE.read_text()
    assert old in text
    (folder / "b.toml").write_text(text.replace(old, new))
    return folder / "b.toml"


@pytest.fixture(scope="module")
def thicker(tmp_path_factory):
    folder = tmp_path_factory.mktemp("two")
    done = command("compare", SCENE, copied(folder), "--out", folder / "out", "--json")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout), folder / "out"


# --------------------------------------------------------------------------- numbers
@pytest.mark.long
def test_a_thicker_shaft_is_heavier_stiffer_and_all_of_it_is_resolved(thicker):
    told, _ = thicker
    assert [d["path"] for d in told["differences"]] == ["segment.shaft.diameter"]
    assert told["sentences"][0] == "Changed: segment.shaft.diameter from 90 mm to 94.5 mm."
    assert [told["shafts"][key]["file"] for key in "ab"] == ["pinion_overhung", "b"]
    numbers = told["numbers"]
    assert set(numbers) == {"mass", *map(str, QUANTITIES)}
    up = ("mass", "K_zz", "K_thx", "K_yy", "bending 1", "torsion 1")
    for name in up:
        assert numbers[name]["difference"] > 0, name
    for name in ("C_zz", "C_thx", "C_yy"):
        assert numbers[name]["difference"] < 0, name
    assert {one["verdict"] for one in numbers.values()} == {"resolved"}
    # the shaft is 208 mm of 90 mm, 7850 kg/m^3: pi/4 (94.5^2 - 90^2) mm^2 more
    assert numbers["mass"]["difference"] == pytest.approx(1.0649, rel=1e-3)


def mounted(diameter):
    """A rod on two bearings that are known to half and twice their stiffness."""
    scene = sg.Scene.from_parts(
        [sg.Segment.cylinder("rod", length=0.2, diameter=diameter)],
        bearings=[
            sg.Bearing(name=name, y=y, seat_width=0.02, stiffness=dict(kxx=1e8, kyy=1e8, kzz=1e8))
            for name, y in (("a", 0.02), ("b", 0.18))
        ],
        port=sg.Port(name="gear", y=0.07, lo=0.05, hi=0.09),
        ask=sg.Ask(quantities=["bending 1", "C_z,thx", "C_zz"], tolerance=0.2),
    )
    return with_ranges(scene, {f"bearing.{name}.stiffness": "0.5 : 2" for name in "ab"})


def test_what_is_asked_stands_first_with_the_better_of_both_and_what_bearings_leave_open():
    found = sg.compare(mounted(0.050), mounted(0.052))
    # the thicker rod is stiffer, but swings lower on its springs, being heavier; of a coupling neither
    # is better
    assert found.results["asked"] == {"bending 1": "A", "C_z,thx": None, "C_zz": "B"}
    first, _, _, score = found.sentences[:4]
    assert first.startswith("bending 1: A is better, from ")
    assert score.startswith("A is better in 1 of 3 numbers asked for and B in 1, if stiffer")
    # half to twice the stiffness of what it rests on moves the frequency by far more than 4 % of diameter
    assert "range from the data -" in first and first.endswith(
        ", which is more than the difference."
    )
    assert found.results["open"]["a"]["inputs"]


@pytest.mark.long
def test_both_sections_are_drawn_to_one_scale(thicker):
    _, folder = thicker
    assert "Both to one scale." in (folder / "report.html").read_text(encoding="utf-8")
    both = [sg.load(path).as_dict() for path in (SCENE, OTHER)]
    lengths, radii = zip(*map(extent, both))
    drawings = [draw(one, room=(max(lengths), max(radii))).svg() for one in both]
    # the line of the axis, the one of dashes and dots, passes 0.3 in beyond either end
    axis = re.compile(r'd="M([\d.]+),[\d.]+L([\d.]+),[\d.]+"[^>]*stroke-dasharray="9.6,2.4,')
    ends = [tuple(map(float, axis.search(drawing).groups())) for drawing in drawings]
    drawn = [last - first - 0.6 * 72 for first, last in ends]
    # places are written to a hundredth of a point
    assert drawn[0] / drawn[1] == pytest.approx(lengths[0] / lengths[1], abs=1e-4)
    assert lengths[0] != lengths[1]


@pytest.mark.long
def test_numbers_are_those_of_each_shaft_alone_within_both_bars(thicker):
    told, _ = thicker
    alone = sg.answer(sg.load(SCENE), 0.01, "C_zz,K_zz,bending")
    for value in alone.values:
        mine = told["numbers"][value.quantity]
        band = mine["bar_a"] + value.bar * value.size
        assert abs(mine["a"] - value.value) <= band


@pytest.mark.long
def test_every_bar_is_within_a_tenth_of_the_tolerance(thicker):
    told, _ = thicker
    assert told["tolerance"] == pytest.approx(sg.load(SCENE).ask.tolerance / 10)
    for name, one in told["numbers"].items():
        if name != "mass":
            assert 0 < one["bar_a"] <= told["tolerance"] * one["scale"]


@pytest.mark.long
def test_a_shaft_beside_itself_differs_nowhere_and_nothing_is_resolved():
    scene = loose(sg.load(SCENE))
    found = sg.compare(scene, scene)
    assert found.inputs == () and len(found.changes) == 13
    assert "A: pinion_overhung beside B: pinion_overhung" in repr(found)
    assert {one.verdict for one in found.changes} == {"not resolved"}
    assert all(one.change.difference == 0.0 for one in found.changes)
    for pair in found.modes:
        assert pair.a.name == pair.b.name and pair.mac == pytest.approx(1.0)
    assert found.sentences[0] == "Nothing differs in the input."
    assert any(
        one.startswith("None of") and "by more than their error bars" in one
        for one in found.sentences
    )
    assert not any("Largest change" in one for one in found.sentences)


@pytest.mark.long
def test_a_diameter_changed_by_1e_7_moves_nothing_beyond_the_bars(tmp_path):
    path = copied(tmp_path, new='diameter = "90.000009 mm"')
    both = [loose(sg.load(file)) for file in (SCENE, path)]
    found = two_shafts(both, inputs=differences(SCENE, path))
    assert [one.path for one in found.inputs] == ["segment.shaft.diameter"]
    numbers = [one for one in found.changes if one.name != "mass"]
    assert all(one.verdict == "not resolved" for one in numbers)
    assert any(one.change.difference != 0.0 for one in numbers)
    assert found["mass"].verdict == "resolved"  # a closed form has no bar but rounding
    assert any("Changed by less than both error bars" in one for one in found.sentences)


@pytest.mark.long
def test_springs_of_the_other_plane_alone_are_seen():
    scene = sg.Scene.from_parts(
        [sg.Segment.cylinder("rod", length=0.2, diameter=0.05)],
        bearings=[
            sg.Bearing(name=name, y=y, seat_width=0.02, stiffness=dict(kxx=1e8, kyy=1e8, kzz=1e8))
            for name, y in (("a", 0.02), ("b", 0.18))
        ],
        port=sg.Port(name="gear", y=0.1, lo=0.08, hi=0.12),
    )
    stiffness = scene.bearings[0].stiffness.copy()
    stiffness[0, 0] *= 1.2
    harder = scene.bearings[0].with_changes(matrix=stiffness.tolist())
    found = sg.compare(scene, scene.with_changes(bearings=(harder, scene.bearings[1])))
    assert found["C_xx"].relative < 0 and found["C_xx"].verdict == "resolved"
    assert abs(found["C_zz"].relative) < 1e-6 and found["C_zz"].verdict == "not resolved"


@pytest.mark.long
def test_shafts_of_other_lengths_have_their_modes_paired_by_name_and_it_is_told():
    rods = [sg.Segment.cylinder("rod", length=x, diameter=0.02) for x in (0.6, 0.3)]
    found = sg.compare(*(sg.Scene.from_parts([rod]) for rod in rods))
    assert "by name" in found.pairing and {pair.mac for pair in found.modes} == {None}
    assert {one.name for one in found.changes} == {
        "mass", "bending 1", "bending 2", "axial 1", "torsion 1",
    }  # fmt: skip
    # half as long: axial and torsion of a rod twice as high, bending of a slender one nearly 4 times
    for name in ("axial 1", "torsion 1"):
        assert found[name].relative == pytest.approx(1.0, abs=5e-3)
    assert 2.8 < found["bending 1"].relative < 3.0


def test_fields_of_scenes_made_in_python_are_told_by_their_paths():
    scene = sg.load(SCENE)
    moved = scene.with_port(y=0.05)
    assert {one.path for one in scene_differences(scene, moved)} >= {"port.y"}
    assert scene_differences(scene, scene) == ()


# --------------------------------------------------------------------------- page and files
@pytest.mark.long
def test_the_page_holds_the_numbers_of_the_json_and_needs_no_other_file(thicker):
    told, out = thicker
    page, text = page_of(out, told, told["sentences"])
    for one in told["numbers"].values():
        if one["unit"] == "Hz":
            assert f"{one['a']:.2f}" in text and f"{one['b']:.2f}" in text
        assert one["verdict"] in text
    for pair in told["modes"]:
        assert pair["a"]["name"] in text and f"{pair['a']['frequency_hz']:.1f}" in text
    for word in ("segment.shaft.diameter", "90 mm", "94.5 mm", "section through the axis"):
        assert word in text
    # both sections are drawn, wide and for a phone
    drawn = {f"shaft_{key}-{kind}" for key in "ab" for kind in ("wide", "narrow")}
    assert drawn == set(re.findall(r'id="(shaft_[ab]-(?:wide|narrow))-', page))
    # and the modes over one another, told apart when they are read
    assert {"A: pinion_overhung", "B: b"} <= set(re.findall(r'aria-label="([^"&]*)&#xA;', page))


@pytest.mark.parametrize(
    "words, said",
    [
        ([SCENE, OTHER, SCENE], "compare takes one file, or two scenes or two trains; 3 are given"),
        ([SCENE, TRAIN], "is a train and .* one shaft: compare two trains, two shafts"),
        ([TRAIN, SCENE], "is a train and .* one shaft: compare two trains, two shafts"),
        ([SCENE, OTHER, "--models", "euler"], "--models does not apply to two shafts"),
        ([SCENE, OTHER, "--set", "harmonic.order=3"], "--set does not apply to two shafts"),
        ([SCENE, OTHER, "--pinion", "euler"], "--pinion does not apply to two shafts"),
        ([SCENE, "missing.toml"], "there is no such file"),
    ],
    ids=lambda w: "" if isinstance(w, list) else w[:30],
)
def test_what_cannot_be_compared_is_refused_in_a_sentence(words, said, tmp_path):
    done = command("compare", *words, "--out", tmp_path / "out")
    assert done.exit_code == 1 and re.search(said, str(done.exception))
    assert not (tmp_path / "out").exists()


def test_settings_of_two_scenes_and_trains_are_refused():
    scene = sg.load(SCENE)
    for pair in ((scene, sg.load_train(TRAIN)), (sg.load_train(TRAIN), scene)):
        with pytest.raises(sg.SolidgearError, match="is a train and .* one shaft"):
            sg.compare(*pair)
    with pytest.raises(sg.SolidgearError, match="for two the program chooses"):
        sg.compare(scene, scene, settings={"harmonic": {"order": 2}})


def test_one_file_given_twice_is_told_so_and_nothing_is_solved(tmp_path):
    done = command("compare", SCENE, SCENE, "--out", tmp_path / "out", "--json")
    told = json.loads(done.stdout)
    assert told["kind"] == "two shafts" and "nothing differs" in told["sentences"][0]
    assert not (tmp_path / "out").exists()
