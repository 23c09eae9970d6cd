"""What --vary says, and the points it stands for."""

import re
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.errors import SceneError, SolidgearError
from solidgear.studies.sweep import vary
from solidgear.studies.sweep.bearing_sweep import sweep, variants_of

SCENE = sg.load("geometry/pinion_overhung.toml")
GEAR = sg.load("geometry/gear_shaft.toml")


def one(text, scene=SCENE):
    return vary.axes(scene, [text])[0]


@pytest.mark.parametrize(
    ("spec", "values"),
    [
        ("bearing.2.position=0.2 m:240 mm:3", [0.2, 0.22, 0.24]),
        ("bearing.2.position=200 mm, 0.24", [0.2, 0.24]),
        ("bearing.1.kxx=log:1e8 N/m:1e10:3", [1e8, 1e9, 1e10]),
        ("bearing.1.kx_thz=0,-1e8 N/rad", [0.0, -1e8]),
        ("bearing.1.kthx=3.6e6 N*m/rad", [3.6e6]),
        ("bearing.1.kx_thz=log:-1e6:-1e8:3", [-1e6, -1e7, -1e8]),
        ("bearing.2.scale=2:1:3", [2.0, 1.5, 1.0]),
        ("bearing.2.scale=1,1,2", [1.0, 2.0]),
    ],
)
def test_values(spec, values):
    assert one(spec).values == pytest.approx(values, rel=1e-14)


def test_a_bearing_goes_by_name_first_and_by_number_else():
    assert one("bearing.4.kxx=1e9", GEAR).bearing == 1  # called "4"
    assert one("bearing.1.kxx=1e9", GEAR).bearing == 0  # the first, called "3"
    assert one("bearing.1.kxx=1e9", GEAR).label == "bearing.3.kxx"


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("bearing.2.position", "write bearing.NAME.FIELD=VALUES"),
        ("housing.axial=1", "the scene has no [housing]; give it one"),
        ("housing=1", "write bearing.NAME.FIELD=VALUES"),
        ("bearing.5.kxx=1e9", "no bearing '5'"),
        ("bearing.0.kxx=1e9", "no bearing '0'"),
        ("bearing.1.kxq=1e9", "unknown field 'kxq'"),
        ("bearing.1.kxx=1e9 N", "not a unit of force per length"),
        ("bearing.1.kxx=1e9 N/m:2e9 N/m", 'values are "a:b:n"'),
        ("bearing.1.kxx=1e9:2e9:1", "2 or more"),
        ("bearing.1.kxx=1e9:2e9:x", "2 or more"),
        ("bearing.1.kxx=log:0:2e9:3", "above zero"),
        ("bearing.1.kxx=log:-1:2e9:3", "above zero"),
        ("bearing.1.kxx=log:1e9,2e9", 'values are "a:b:n"'),
        ("bearing.1.kxx=nan", "finite"),
        ("bearing.1.kxx=1e999", "finite"),
        ("bearing.1.kxx=", "such as"),
        ("bearing.1.scale=2 m", "ratio"),
    ],
)
def test_a_text_that_cannot_be_read_is_refused_at_once(text, word):
    with pytest.raises(SolidgearError, match="(?s)" + re.escape(word)) as error:
        one(text)
    assert text in str(error.value) and "\n" not in str(error.value)


def test_the_same_quantity_twice_and_none_are_refused():
    with pytest.raises(SolidgearError, match="varied already"):
        vary.axes(SCENE, ["bearing.1.kxx=1e9", "bearing.1.kxx=2e9"])
    with pytest.raises(SolidgearError, match="nothing is varied"):
        vary.axes(SCENE, [])
    with pytest.raises(SolidgearError, match="more than"):
        vary.product(vary.axes(SCENE, ["bearing.1.kxx=1:2:9999", "bearing.2.kxx=1:2:9999"]))


def test_the_product_runs_its_last_axis_fastest():
    axes = vary.axes(SCENE, ["bearing.1.scale=1,2", "bearing.2.scale=3:5:3"])
    np.testing.assert_array_equal(
        vary.product(axes), [[1, 3], [1, 4], [1, 5], [2, 3], [2, 4], [2, 5]]
    )


def test_a_sample_is_a_latin_hypercube():
    axes = vary.axes(
        SCENE,
        [
            "bearing.1.kxx=log:1e8:1e10:2",
            "bearing.2.scale=1:3:2",
            "bearing.2.position=0.22:0.24:3",
            "bearing.1.kyy=1e8,2e8",
        ],
    )
    points = vary.sample(axes, 60, seed=3)
    # one point in each of 60 equal strata of each range
    assert sorted((np.log10(points[:, 0] / 1e8) * 30).astype(int)) == list(range(60))
    assert sorted(((points[:, 1] - 1) * 30).astype(int)) == list(range(60))
    # seats are meshed, so a position is one of those listed; equally often
    assert np.unique(points[:, 2], return_counts=True)[1].tolist() == [20, 20, 20]
    assert np.unique(points[:, 3], return_counts=True)[1].tolist() == [30, 30]
    np.testing.assert_array_equal(points, vary.sample(axes, 60, seed=3))
    assert np.any(points != vary.sample(axes, 60, seed=4))
    for count, seed in ((0, 0), (5, -1)):
        with pytest.raises(SolidgearError):
            vary.sample(axes, count, seed)


def test_a_variant_is_the_scene_a_file_would_give():
    variants = variants_of(
        SCENE,
        [
            "bearing.2.position=0.23",
            "bearing.2.scale=3",
            "bearing.2.kxx=9e9",
            "bearing.1.kx_thz=1e8",
        ],
    )
    got = variants.of(0)
    second = (
        SCENE.bearings[1]
        .with_changes(y=0.23, matrix={**_entries(SCENE.bearings[1]), "kxx": 9e9})
        .scaled(3)
    )
    assert got.bearings[1] == second and second.axial_series == (3 * 4.1e8,)
    assert got.bearings[0].matrix[0][5] == got.bearings[0].matrix[5][0] == 1e8
    assert got.with_changes(bearings=SCENE.bearings) == SCENE


def _entries(bearing):
    from solidgear.scene.bearing_stiffness import stiffness_entries

    return stiffness_entries(bearing.matrix)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("bearing.2.position=0.9", "inside the shaft"),
        ("bearing.2.position=0.12", 'overlaps that of "1"'),
        ("bearing.1.position=0.07", "across the step"),
        ("bearing.1.kxx=1e7", 'bearing "1": the stiffness is indefinite'),
        ("bearing.2.scale=0", "greater than zero"),
        ("bearing.2.scale=-1", "greater than zero"),
    ],
)
def test_what_a_scene_file_would_refuse_is_refused_as_a_variant(text, word):
    with pytest.raises(SceneError, match=word):
        variants_of(SCENE, [text]).of(0)


def test_one_shaft_carries_all_seats_once_each_however_they_overlap():
    variants = variants_of(
        SCENE,
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


def test_a_rigid_seat_cannot_move():
    rigid = SCENE.with_attachment("rigid")
    with pytest.raises(SolidgearError, match="a rigid seat stiffens the shaft"):
        variants_of(rigid, ["bearing.2.position=0.2,0.24"]).shaft()
    variants_of(rigid, ["bearing.2.scale=1,2"]).shaft()
    with pytest.raises(SolidgearError, match="no variant can be solved"):
        variants_of(SCENE, ["bearing.2.position=0.8,0.9"]).shaft()


CATALOGUE = sg.load("geometry/gearbox_catalogue.toml")


def stiffness_at(scene, name):
    return np.array(next(b for b in scene.bearings if b.name == name).matrix)


def test_catalogue_bearings_that_move_carry_what_the_load_brings_them_there(tmp_path):
    # Bearing A at 20 mm in place of 15 mm is a shorter span: both bearings carry other loads. The
    # same scene read from a file finds its equilibrium there by itself.
    text = Path("geometry/gearbox_catalogue.toml").read_text()
    assert text.count('position = "15 mm"') == 1
    (tmp_path / "moved.toml").write_text(text.replace('position = "15 mm"', 'position = "20 mm"'))
    there = sg.load(tmp_path / "moved.toml")
    swept = variants_of(CATALOGUE, ["bearing.A.position=15 mm,20 mm"])
    for name in ("A", "B"):
        want = stiffness_at(there, name)
        assert stiffness_at(swept.of(1), name) == pytest.approx(want, rel=1e-6)
        # the load is not what it was, by far more than the equilibrium leaves open
        here = stiffness_at(CATALOGUE, name)
        assert abs(want[0, 0] / here[0, 0] - 1) > 3e-3
        assert stiffness_at(swept.of(0), name) == pytest.approx(here, rel=1e-6)


def test_what_varies_of_a_catalogue_bearing_itself_varies_from_its_tangent():
    swept = variants_of(CATALOGUE, ["bearing.A.position=15 mm,20 mm", "bearing.A.scale=1,2"])
    once, twice = (stiffness_at(swept.of(k), "A") for k in (2, 3))
    assert twice == pytest.approx(2 * once, rel=1e-12)
    assert stiffness_at(swept.of(2), "B") == pytest.approx(stiffness_at(swept.of(3), "B"))


def test_a_sweep_says_at_which_load_catalogue_bearings_are_taken(tmp_path):
    def settling(*texts):
        rows = sweep(CATALOGUE, texts, tmp_path / "r.csv", fidelity="timoshenko", overwrite=True)
        return rows.settling

    assert "bearings A, B: the tangent under [load], found anew" in settling(
        "bearing.A.position=15 mm,20 mm"
    )
    assert "bearing.A.scale varies from there, with the loads" in settling("bearing.A.scale=1,2")
    plain = sweep(SCENE, ["bearing.1.scale=1,2"], tmp_path / "p.csv", fidelity="timoshenko")
    assert plain.settling == ""
