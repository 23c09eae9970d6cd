"""Held seats and end faces: what is clamped or pinned moves as one rigid piece, unless the file asks
for its mean.
"""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg

FOUND = Path(__file__).parent / "found"
#: m; a rod in a clamp of 20 mm
DIAMETER, FREE, SEAT = 0.04, 0.04, 0.02
#: first root of cos x cosh x = -1, of a cantilever
CANTILEVER = 1.87510407
#: of a bar 0.1 m long and wide of E = 200 GPa, nu = 0.3, 7850 kg/m^3 on a clamped end face, solid and
#: with a bore of 60 mm: triangles of order 4 around the axis, written apart, layers of ratio 0.3 towards
#: all rims; known to `KNOWN`, by which eleven layers may differ from eight, and the last digits
ON_FACE = {
    0.0: {"C_zz": 5.119745e-10, "C_thx": 9.981263e-8, "C_yy": 6.203660e-11, "bending 1": 5030.8937},
    0.06: {
        "C_zz": 8.679197e-10,
        "C_thx": 1.149807e-7,
        "C_yy": 9.750068e-11,
        "bending 1": 4835.9746,
    },
}
KNOWN = 2e-7


def on_face(bore=0.0, **words):
    bar = {"kind": "cylinder", "name": "bar", "length": 0.1, "diameter": 0.1, "bore": bore}
    wall = {"name": "wall", "face": "start", "seat_width": 0.01, "hold": "clamped"}
    return sg.Scene.from_dict(
        {
            "material": {"E": 2e11, "nu": 0.3, "density": 7850},
            "segment": [bar],
            "bearing": [wall | words],
            "port": {"name": "tip", "at": "bar.end", "span": [0.08, 0.1], "attachment": "section"},
        }
    )


def stub(diameter=DIAMETER, free=FREE, **words):
    length = SEAT + free
    rod = sg.Segment.cylinder("rod", length=length, diameter=diameter, material="steel")
    clamp = sg.Bearing(
        name="clamp", position=SEAT / 2, seat_width=SEAT, **{"hold": "clamped"} | words
    )
    tip = sg.Port(name="tip", y=length, lo=length - free / 8, hi=length)
    return sg.Scene.from_parts([rod], bearings=[clamp], port=tip)


def first(scene, model, **options):
    return sg.modes(sg.build(scene, model, **options), scene, n=3).frequency_hz[0]


def test_the_clamped_foot_of_a_block_does_not_deform():
    # CalculiX, C3D20, all nodes of the foot held: 34 178 Hz; the mean of the foot held: 27 390 Hz
    scene = sg.load(FOUND / "parts/clamped_foot.toml")
    assert scene.bearings[0].attachment == "rigid"
    assert 34_100 < first(scene, "solid") < 1.01 * 34_178  # a mesh is stiffer, by less than its bar


def test_a_clamped_beam_is_a_cantilever_of_its_free_length():
    scene = stub(diameter=FREE / 10)
    steel = scene.segments[0].material
    radius_of_gyration = FREE / 40
    exact = (
        CANTILEVER**2
        * radius_of_gyration
        * np.sqrt(steel.E / steel.density)
        / FREE**2
        / (2 * np.pi)
    )
    # elements of an eighth of the diameter are exact to a few digits of 1e-6
    assert first(scene, "euler", rotary_inertia=False) == pytest.approx(exact, rel=1e-5)


@pytest.mark.parametrize("quantity", ["C_zz", "C_thy", "bending 1"])
def test_bars_of_a_clamped_stub_hold_at_the_sharp_end_of_its_seat(quantity):
    coarse, fine = (sg.answer(stub(), tol=tol, ask=quantity) for tol in (2e-2, 1e-3))
    off = abs(coarse[quantity] / fine[quantity] - 1)
    assert off < coarse.bar + fine.bar
    # the mean of the seat held is a tenth to a third softer, far beyond the bars
    softer = sg.answer(stub(attachment="average"), tol=2e-2, ask=quantity)
    assert abs(softer[quantity] / fine[quantity] - 1) > 0.1


def test_a_solid_and_the_harmonic_solid_agree_on_a_clamped_stub():
    three, round_ = (first(stub(), model) for model in ("solid", "harmonic"))
    assert three == pytest.approx(round_, rel=0.02)  # its own bar is 2.2 %


@pytest.mark.parametrize("tol", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("bore", ON_FACE)
def test_bars_of_a_clamped_face_hold_finite_elements_of_another_code(bore, tol):
    found = sg.answer(on_face(bore), tol, ask=list(ON_FACE[bore]))
    assert found.reached
    for value in found.values:
        off = (ON_FACE[bore][value.quantity] / value.value - 1) * (-1 if value.unit == "Hz" else 1)
        assert -KNOWN < off < value.bar + KNOWN  # a mesh is too stiff


def test_a_face_held_by_its_mean_warps():
    right = ON_FACE[0.0]["bending 1"]
    softer = sg.answer(on_face(attachment="average"), 1e-4, ask="bending 1")
    assert 1 - softer["bending 1"] / right == pytest.approx(0.018, abs=0.001)  # as the guide says
    beams = [first(on_face(**words), "timoshenko") for words in ({}, {"attachment": "average"})]
    assert beams[0] == pytest.approx(beams[1], rel=1e-9)  # a beam knows a point alone


TABLES = {
    "material": "steel",
    "segment": [{"kind": "cylinder", "name": "rod", "length": 0.06, "diameter": 0.04}],
    "bearing": [{"name": "A", "position": 0.01, "seat_width": 0.02, "hold": "pinned"}],
    "port": {"at": "rod.end", "span": [0.05, 0.06]},
}


@pytest.mark.parametrize(
    ("more", "of_table", "attachment"),
    [
        ({}, {}, "rigid"),
        ({}, {"attachment": "average"}, "average"),
        ({"attachment": "section"}, {}, "section"),
        ({"attachment": "section"}, {"attachment": "rigid"}, "rigid"),
    ],
)
def test_a_mean_is_held_where_the_file_asks(more, of_table, attachment):
    bearing = TABLES["bearing"][0] | of_table
    scene = sg.Scene.from_dict(TABLES | more | {"bearing": [bearing]})
    assert scene.bearings[0].attachment == attachment
    assert scene.port.attachment == more.get("attachment", "average")
    assert sg.Scene.from_dict(scene.to_dict()) == scene


@pytest.mark.parametrize(
    ("words", "attachment"),
    [
        ({}, "rigid"),
        ({"attachment": "average"}, "section"),
        ({"hold": None, "stiffness": {"kzz": 1e8}}, "section"),
        ({"hold": None, "stiffness": {"kzz": 1e8}, "attachment": "rigid"}, "rigid"),
    ],
)
def test_of_a_face_what_is_held_is_rigid_and_the_mean_is_that_of_the_section(words, attachment):
    wall = on_face().bearings[0].with_changes(**words)
    assert wall.attachment == attachment
    scene = on_face().with_changes(bearings=[wall])
    assert sg.Scene.from_dict(scene.to_dict()) == scene
    ties = [scene.with_attachment(way).bearings[0].attachment for way in ("average", "rigid")]
    assert ties == ["section", "rigid"]


def test_a_hold_that_comes_or_goes_takes_its_usual_attachment_along():
    held = stub().bearings[0]
    sprung = held.with_changes(hold=None, stiffness={"kzz": 1e8})
    assert (held.attachment, sprung.attachment) == ("rigid", "average")
    assert sprung.with_changes(hold="pinned").attachment == "rigid"
    assert held.with_changes(hold="pinned", attachment="average").attachment == "average"
    on_end = on_face().bearings[0].with_changes(hold=None, stiffness={"kzz": 1e8})
    assert on_end.with_changes(hold="pinned").attachment == "rigid"
    section = stub(attachment="section").bearings[0]
    assert section.with_changes(hold="pinned").attachment == "section"


def test_a_held_seat_made_by_words_in_python_is_rigid():
    on_rod = sg.Bearing(name="A", on="rod", hold="clamped")
    assert stub().with_changes(bearings=[on_rod]).bearings[0].attachment == "rigid"


def test_the_text_of_a_file_whose_hold_changes_its_tie_reads_back(tmp_path):
    path = tmp_path / "held.toml"
    path.write_text(sg.Scene.from_dict(TABLES).to_toml())
    scene = sg.load(path)
    for attachment in ("average", "rigid"):
        tied = scene.with_attachment(attachment)
        (tmp_path / "tied.toml").write_text(tied.to_toml())
        assert sg.load(tmp_path / "tied.toml").bearings == tied.bearings


def test_a_check_does_not_advise_to_let_a_clamp_deform():
    assert not any("rigid seats at" in text for text in sg.check(stub()).cautions)
