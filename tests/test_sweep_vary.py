"""What --vary says, and the points it stands for."""

import re
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SceneError, SolidgearError
from solidgear.variants.sweep.bearing_task import bearing_task
from solidgear.variants.sweep.bearing_variants import bearing_variants
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.file_task import run
from solidgear.variants.sweep.scene_task import scene_task
from tests.counted import from_the_start

PATH = from_the_start("geometry/pinion_overhung.toml")
SCENE = sg.load(PATH)
GEAR = "geometry/gear_shaft.toml"


def values_of(text, path=PATH):
    """Values of the one column of a sweep."""
    variants = bearing_variants(path, [text])
    return [value for k in range(len(variants)) for value in variants.varied(k).values()]


@pytest.mark.parametrize(
    ("spec", "values"),
    [
        ("bearing.2.position=0.2 m:0.24 m:3", [0.2, 0.22, 0.24]),
        ("bearing.2.position=200 mm, 0.24", [0.2, 0.24]),
        ("bearing.1.kxx=log:1e8 N/m:1e10 N/m:3", [1e8, 1e9, 1e10]),
        ("bearing.1.kx_thz=0,-1e8 N/rad", [0.0, -1e8]),
        ("bearing.1.kthx=3.6e6 N*m/rad", [3.6e6]),
        ("bearing.1.kx_thz=log:-1e6:-1e8:3", [-1e6, -1e7, -1e8]),
        ("bearing.2.scale=2:1:3", [2.0, 1.5, 1.0]),
        ("bearing.2.scale=1,1,2", [1.0, 2.0]),
    ],
)
def test_values(spec, values):
    assert values_of(spec) == pytest.approx(values, rel=1e-14)


def test_a_bearing_goes_by_name_first_and_by_number_else():
    names = [
        bearing_variants(GEAR, [f"bearing.{word}.kxx=1e9"]).entries[0].label for word in ("4", "1")
    ]
    assert names == ["bearing.4.stiffness.kxx", "bearing.3.stiffness.kxx"]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("bearing.2.position", "write PATH=VALUES"),
        ("bearing.5.kxx=1e9", "there is no bearing.5"),
        ("bearing.0.kxx=1e9", "there is no bearing.0"),
        ("bearing.1.stiffness.kxq=1e9", "unknown stiffness entry"),
        ("bearing.1.kxx=1e9 N", "not a unit of force per length"),
        ("bearing.1.kxx=1e9 N/m:2e9 N/m", 'values are "a:b:n"'),
        ("bearing.1.kxx=1e9:2e9:1", "2 or more"),
        ("bearing.1.kxx=1e9:2e9:x", "2 or more"),
        ("bearing.1.kxx=log:0:2e9:3", "above zero"),
        ("bearing.1.kxx=log:-1:2e9:3", "above zero"),
        ("bearing.1.kxx=log:1e9,2e9", 'values are "a:b:n"'),
        ("bearing.1.kxx=", "such as"),
    ],
)
def test_a_text_that_cannot_be_read_is_refused_at_once(text, word):
    with pytest.raises(SolidgearError, match="(?s)" + re.escape(word)) as error:
        bearing_variants(PATH, [text]).first_sound()
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "text", ["bearing.1.kxx=nan", "bearing.1.kxx=1e999", "bearing.1.scale=2 m"]
)
def test_a_value_that_is_none_goes_to_no_sweep_of_bearings(text):
    """Neither words nor numbers without end are springs: the file's own rules refuse them."""
    with pytest.raises(SolidgearError):
        scene_task(PATH, Design((text,)), model="timoshenko")


def test_the_same_quantity_twice_and_none_are_refused():
    with pytest.raises(SolidgearError, match="varied already"):
        bearing_variants(PATH, ["bearing.1.kxx=1e9", "bearing.1.stiffness.kxx=2e9"])
    with pytest.raises(SolidgearError, match="nothing is varied"):
        bearing_variants(PATH, [])
    with pytest.raises(SolidgearError, match="more than"):
        bearing_variants(PATH, ["bearing.1.kxx=1:2:9999", "bearing.2.kxx=1:2:9999"])


def test_the_product_runs_its_last_entry_fastest():
    variants = bearing_variants(PATH, ["bearing.1.scale=1,2", "bearing.2.scale=3:5:3"])
    rows = [list(variants.varied(k).values()) for k in range(len(variants))]
    assert rows == [[1, 3], [1, 4], [1, 5], [2, 3], [2, 4], [2, 5]]


def test_a_sample_is_a_latin_hypercube():
    texts = [
        "bearing.1.kxx=log:1e8:1e10:2",
        "bearing.2.scale=1:3:2",
        "bearing.2.position=0.22:0.24:3",
        "bearing.1.kyy=1e8,2e8",
    ]
    points = bearing_variants(PATH, texts, 60, seed=3).values
    # one point in each of 60 equal strata of each range
    assert sorted((np.log10(points[:, 0] / 1e8) * 30).astype(int)) == list(range(60))
    assert sorted(((points[:, 1] - 1) * 30).astype(int)) == list(range(60))
    # seats are meshed, so a position is one of those listed; equally often
    assert np.unique(points[:, 2], return_counts=True)[1].tolist() == [20, 20, 20]
    assert np.unique(points[:, 3], return_counts=True)[1].tolist() == [30, 30]
    np.testing.assert_array_equal(points, bearing_variants(PATH, texts, 60, seed=3).values)
    assert np.any(points != bearing_variants(PATH, texts, 60, seed=4).values)
    for count, seed in ((0, 0), (5, -1)):
        with pytest.raises(SolidgearError):
            bearing_variants(PATH, texts, count, seed)


def test_a_variant_is_the_scene_a_file_would_give():
    variants = bearing_variants(
        PATH,
        [
            "bearing.2.position=0.23",
            "bearing.2.scale=3",
            "bearing.2.kxx=9e9",
            "bearing.1.kx_thz=1e8",
        ],
    )
    got = variants.variant(0)
    second = (
        SCENE.bearings[1]
        .with_changes(y=0.23, matrix={**_entries(SCENE.bearings[1]), "kxx": 9e9})
        .scaled(3)
    )
    np.testing.assert_allclose(got.bearings[1].stiffness, second.stiffness, rtol=1e-14)
    assert got.bearings[0].matrix[0][5] == got.bearings[0].matrix[5][0] == 1e8
    assert got.with_changes(bearings=SCENE.bearings) == SCENE


def _entries(bearing):
    from solidgear.core.scene.bearing_stiffness import stiffness_entries

    return stiffness_entries(bearing.matrix)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("bearing.2.position=0.9", "inside the shaft"),
        ("bearing.2.position=0.12", 'overlaps that of "1"'),
        ("bearing.1.position=0.07", "across the step"),
        ("bearing.1.kxx=1e7", "the stiffness is indefinite"),
        ("bearing.2.scale=0", "greater than zero"),
        ("bearing.2.scale=-1", "greater than zero"),
    ],
)
def test_what_a_scene_file_would_refuse_is_refused_as_a_variant(text, word):
    with pytest.raises(SceneError, match=word):
        bearing_variants(PATH, [text]).variant(0)


def test_one_shaft_carries_all_seats_once_each_however_they_overlap():
    variants = bearing_variants(
        PATH,
        [
            "bearing.2.position=0.10,0.20,0.22,0.9",
            "bearing.1.scale=1,2,3",
            "bearing.1.position=0.1,0.2",
        ],
    )
    shaft = variants.shaft()
    # 0.1 and 0.2 are seats of either bearing, 0.9 of none
    assert [round(s.y, 6) for s in shaft.stations[1:]] == [0.1, 0.2, 0.22]
    assert shaft.length == SCENE.length and shaft.stations[0] == SCENE.port
    _, supports = variants.supports(1)  # bearings 1 and 2 at 0.2 and 0.1
    assert supports.ports == (shaft.stations[2].name, shaft.stations[1].name)


def test_a_rigid_seat_cannot_move(tmp_path):
    rigid = tmp_path / "rigid.toml"
    rigid.write_text(PATH.read_text().replace('attachment = "average"', 'attachment = "rigid"'))
    with pytest.raises(SolidgearError, match="a rigid seat stiffens the shaft"):
        bearing_variants(rigid, ["bearing.2.position=0.2,0.24"]).shaft()
    bearing_variants(rigid, ["bearing.2.scale=1,2"]).shaft()
    with pytest.raises(SolidgearError, match="no variant can be solved"):
        bearing_variants(PATH, ["bearing.2.position=0.8,0.9"]).shaft()


GEARBOX = "geometry/gearbox_catalogue.toml"
CATALOGUE = sg.load(GEARBOX)


def stiffness_at(scene, name):
    return np.array(next(b for b in scene.bearings if b.name == name).matrix)


def test_catalogue_bearings_that_move_carry_what_the_load_brings_them_there(tmp_path):
    # Bearing A at 20 mm in place of 15 mm is a shorter span: both bearings carry other loads. The
    # same scene read from a file finds its equilibrium there by itself.
    text = Path("geometry/gearbox_catalogue.toml").read_text()
    assert text.count('position = "15 mm"') == 1
    (tmp_path / "moved.toml").write_text(text.replace('position = "15 mm"', 'position = "20 mm"'))
    there = sg.load(tmp_path / "moved.toml")
    swept = bearing_variants(GEARBOX, ["bearing.A.position=15 mm,20 mm"])
    for name in ("A", "B"):
        want = stiffness_at(there, name)
        assert stiffness_at(swept.variant(1), name) == pytest.approx(want, rel=1e-6)
        # the load is not what it was, by far more than the equilibrium leaves open
        here = stiffness_at(CATALOGUE, name)
        assert abs(want[0, 0] / here[0, 0] - 1) > 3e-3
        assert stiffness_at(swept.variant(0), name) == pytest.approx(here, rel=1e-6)


def test_what_multiplies_a_catalogue_bearing_leaves_its_load_as_it_is():
    swept = bearing_variants(GEARBOX, ["bearing.A.position=15 mm,20 mm", "bearing.A.scale=1,2"])
    (once, other), (twice, same) = (
        [b.stiffness for b in swept.variant(k).bearings] for k in (2, 3)
    )
    assert twice == pytest.approx(2 * once, rel=1e-12)
    assert same == pytest.approx(other, rel=1e-12)


def test_a_sweep_says_at_which_load_catalogue_bearings_are_taken(tmp_path):
    def settling(path, *texts):
        variants = bearing_variants(path, texts)
        task = bearing_task(variants, model="timoshenko")
        return run(task, tmp_path / "r.csv", overwrite=True).settling

    assert settling(GEARBOX, "bearing.A.position=15 mm,20 mm") == (
        "Catalogue bearings A, B: stiffness under the loads, found anew for every variant."
    )
    assert "bearing.A.scale multiplies it and leaves the loads as they are" in settling(
        GEARBOX, "bearing.A.scale=1,2"
    )
    assert settling(PATH, "bearing.1.scale=1,2") == ""


def test_an_entry_that_catalogue_data_stand_for_is_refused_with_what_to_write():
    with pytest.raises(SolidgearError, match="from its catalogue data; vary bearing.A.scale, or"):
        bearing_variants(GEARBOX, ["bearing.A.kxx=1e8,2e8"])


@pytest.mark.parametrize("spec", ["1e8:4e8:3", "1e8 N/m:4e8 N/m:3", "1e8,2.5e8,4e8"])
def test_numbers_take_the_place_of_a_word_in_the_file(spec):
    """A mesh stiffness is a number or "teeth"; a range of one is no word of the other."""
    box = Path(__file__).parent / "found" / "people" / "my_box.toml"
    beams = {"pinion": "euler", "gear": "euler", "ask": "system-modes", "n": 1}
    swept = sg.sweep(box, f"mesh.stiffness={spec}", **beams)
    assert list(swept["mesh.stiffness"]) == [1e8, 2.5e8, 4e8]
    assert np.all(np.diff(swept["f1_hz"].astype(float)) > 0)
