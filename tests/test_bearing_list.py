"""A list of bearings of one's own, which designations are looked up in first."""

import math
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.bearings.bearing_list import read_list
from solidgear.bearings.catalogue import Catalogue
from solidgear.core import SceneError

HEAD = "designation;kind;d [mm];D [mm];B [mm];C [kN];C0 [kN];Pu [kN];Z;Dw [mm];Dpw [mm];alpha [deg];e;Y\n"
#: five bearings: of one's own number, a standard one with ratings, one with its whole inside, a
#: cone with the e of its maker, and a thin one with a name that is a series of ISO
FIVE = HEAD + (
    "MX-4711;deep_groove;42;78;17,5;31,2;18;0,8;9;11,9;60;;;\n"
    "6208;;;;;30,7;19;0,8;;;;;;\n"
    "7208 BEP;;;;;36,5;26;1,1;14;11,9;60;40;;\n"
    "32210 XL;;;;;82,5;100;11,4;;;;;0,42;1,43\n"
    "61908;angular_contact;40;62;12;14,5;11,8;0,5;20;6,35;51;25;;\n"
)
SCENE = """bearings = "list.csv"
material = { E = "206 GPa", nu = 0.3, density = "7850 kg/m^3" }
segment = [{ name = "shaft", kind = "cylinder", length = "200 mm", diameter = "42 mm" }]
port = { position = "100 mm", from = "start", span = ["90 mm", "110 mm"] }
load = { z = "1 kN" }

[[bearing]]
name = "A"
position = "20 mm"
from = "start"
catalogue = { designation = "mx 4711" }

[[bearing]]
name = "B"
position = "180 mm"
from = "start"
catalogue = { designation = "MX-4711/C3", fatigue_limit = "0.9 kN" }
"""


def written(folder, text=FIVE, name="list.csv"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return str(path)


def test_five_bearings_of_a_list(tmp_path):
    result = read_list(written(tmp_path), Catalogue)
    assert [*result] == ["MX4711", "6208", "7208BEP", "32210XL", "61908"]
    bearings = {
        name: Catalogue(
            **data, **({"holds": "+y"} if data["kind"] in ("angular_contact", "tapered") else {})
        )
        for name, data in result.items()
    }
    bearing = bearings["MX4711"]
    assert (bearing.bore, bearing.outer_diameter, bearing.width) == (0.042, 0.078, 0.0175)
    assert bearing.load_rating == 31.2e3 and bearing.estimated == ("conformity",)
    assert bearings["6208"].outer_diameter == 0.08 and bearings["6208"].fatigue_limit == 800
    assert bearings["7208BEP"].contact_angle == pytest.approx(math.radians(40))
    # e = 1.5 tan a (ISO 281)
    assert math.tan(bearings["32210XL"].contact_angle) == pytest.approx(0.28)
    # what the list says holds against ISO
    assert bearings["61908"].kind == "angular_contact"
    assert bearing.listed == "list.csv, line 2"


@pytest.mark.parametrize("separator, comma", [(";", ","), (",", "."), ("\t", ",")])
def test_separators_decimal_commas_and_units(tmp_path, separator, comma):
    head = separator.join(
        ("designation", "bore [in]", "D [cm]", "width [mm]", "kind", "C [N]", "maker")
    )
    line = separator.join(("A 1", "1", f"5{comma}2", f"1{comma}5E1", "Deep Groove", "14e3", "us"))
    data = read_list(written(tmp_path, f"\ufeff# ours\n{head}\n\n{line}\n"), Catalogue)["A1"]
    assert data["bore"] == pytest.approx(0.0254) and data["outer_diameter"] == pytest.approx(0.052)
    assert data["width"] == pytest.approx(0.015) and data["load_rating"] == pytest.approx(14e3)


def test_a_scene_looks_its_designations_up(tmp_path):
    written(tmp_path)
    path = tmp_path / "scene.toml"
    path.write_text(SCENE, encoding="utf-8")
    a, b = sg.load(path).bearings
    assert a.catalogue.load_rating == b.catalogue.load_rating == 31.2e3
    assert a.catalogue.fatigue_limit == 800 and b.catalogue.fatigue_limit == 900  # the scene's
    assert b.catalogue.clearance == "C3" and a.seat_width == 0.0175
    assert a.stiffness[2, 2] > 0
    # what is written needs no list
    again = sg.load(sg.load(path).to_dict())
    assert again.bearings[0].catalogue == a.catalogue


def test_a_list_for_all_by_a_variable(tmp_path, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_BEARINGS", written(tmp_path))
    assert Catalogue(designation="MX 4711").bore == 0.042
    assert Catalogue(designation="6208").static_rating == 19e3
    assert Catalogue(designation="6308").static_rating is None
    monkeypatch.setenv("SOLIDGEAR_BEARINGS", "none.csv")
    with pytest.raises(SceneError, match="SOLIDGEAR_BEARINGS: none.csv: cannot be read"):
        Catalogue(designation="6308")


def test_a_train_has_one_list_for_its_shafts(tmp_path):
    written(tmp_path, HEAD + "MX 99;deep_groove;99;180;34;122;93;3;;;;;;\n")
    pinion = Path("geometry/pinion_overhung.toml").read_text(encoding="utf-8")
    start, end = pinion.index("[bearing.stiffness]"), pinion.index('[[bearing]]\nname = "2"')
    bearing = '[bearing.catalogue]\ndesignation = "MX 99"\nload = { z = "5 kN" }\n'
    (tmp_path / "shaft.toml").write_text(pinion[:start] + bearing + pinion[end:], encoding="utf-8")
    gear = Path("geometry/gear_shaft.toml").read_text(encoding="utf-8")
    (tmp_path / "gear_shaft.toml").write_text(gear, encoding="utf-8")
    train = Path("geometry/axle_overhung.toml").read_text(encoding="utf-8")
    train = train.replace("pinion_overhung.toml", "shaft.toml")
    path = tmp_path / "train.toml"
    path.write_text('bearings = "list.csv"\n' + train, encoding="utf-8")
    bearing = sg.load_train(path).pinion.scene.bearings[0]
    assert bearing.catalogue.load_rating == 122e3 and bearing.stiffness[2, 2] > 1e8
    path.write_text('bearings = "other.csv"\n' + train, encoding="utf-8")
    with pytest.raises(
        SceneError, match=r'train.toml: bearings = "other.csv": there is no such file'
    ):
        sg.load_train(path)


WRONG = (
    ("designation;bore [mm]\n", "holds no bearings: write a head"),
    ("designation;bore\nX;1\n", r'line 1, column 2: "bore" has no unit: write it as bore \[mm\]'),
    ("designation;bore [kg]\nX;1\n", 'has the unit "kg", which is none here: write one such as mm'),
    ("designation;colour\nX;red\n", 'line 1, column 2: "colour" is no column of a list of bearings'),
    ("d [mm]\n40\n", "has no column designation"),
    ("designation;C [kN]\nX;12\n", "line 2, column designation: \"X\" is no designation that is known"),
    ("designation;C [kN]\n6208;abc\n", r'line 2, column C \[kN\]: "abc" is no number'),
    ("designation;C [kN]\n6208;-3\n", r"line 2, column C \[kN\]: .*must be greater than zero"),
    ("designation;Z\n6208;8,5\n", 'line 2, column Z: "8,5" is no whole number of elements'),
    ("designation;Z;Dw [mm]\n6208;40;12\n", "line 2, column Z: .*more than fit on the pitch circle"),
    ("designation;C [kN]\n6208;30\n6208;31\n", 'line 3: "6208" is in line 2 as well'),
    ("designation,C [kN]\n6208,30,7\n", "line 2: has 3 cells under 2 columns; a decimal comma needs"),
    ("designation;e;Y\n32210;0,42;2,5\n", 'line 2, column Y: "2,5" does not fit e = 0.42'),
)  # fmt: skip


@pytest.mark.parametrize("text, sentence", WRONG, ids=[s for _, s in WRONG])
def test_wrong_lines_are_named(tmp_path, text, sentence):
    with pytest.raises(SceneError, match=sentence) as refused:
        read_list(written(tmp_path, text), Catalogue)
    assert len(refused.value.problems) == 1 and "list.csv" in str(refused.value)


def test_all_wrong_lines_are_named_at_once(tmp_path):
    text = "designation;C [kN]\n6208;30\nX;12\n6210;zwölf\n"
    with pytest.raises(SceneError) as refused:
        read_list(written(tmp_path, text), Catalogue)
    assert [str(p).split("list.csv: ")[1][:6] for p in refused.value.problems] == [
        "line 3",
        "line 4",
    ]


def test_the_list_of_the_guide_is_read(tmp_path):
    page = Path("docs/guide/designations.md").read_text(encoding="utf-8")
    text = page.split("```text\n")[1].split("```")[0]
    assert len(read_list(written(tmp_path, text), Catalogue)) == 3
