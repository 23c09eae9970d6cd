"""Held seats: what is clamped or pinned moves as one rigid piece, unless the file asks for its mean."""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg

FOUND = Path(__file__).parent / "found"
#: m; a rod in a clamp of 20 mm
DIAMETER, FREE, SEAT = 0.04, 0.04, 0.02
#: first root of cos x cosh x = -1, of a cantilever
CANTILEVER = 1.87510407


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


def test_a_hold_that_comes_or_goes_takes_its_usual_attachment_along():
    held = stub().bearings[0]
    sprung = held.with_changes(hold=None, stiffness={"kzz": 1e8})
    assert (held.attachment, sprung.attachment) == ("rigid", "average")
    assert sprung.with_changes(hold="pinned").attachment == "rigid"
    assert held.with_changes(hold="pinned", attachment="average").attachment == "average"
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
