"""Results by name as Python has it: ``in``, ``list``, ``len``, ``dict``, and a KeyError."""

import inspect
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import NoSuchName
from solidgear.core.judge.answer import Answered
from solidgear.core.named import ByName, NamedModes
from solidgear.core.solve.modes import ModeSet
from solidgear.measured.identify import Identification
from solidgear.trains.load.bearing import SolvedBearings
from solidgear.trains.modes.study import SolvedModes
from solidgear.two_designs.beside import Beside
from solidgear.variants.sensitivity.run import OfNumber, Sensitivities
from solidgear.variants.sweep.file_task import Swept

GEOMETRY = Path(__file__).parents[1] / "geometry"
SCENE = sg.load(GEOMETRY / "shaft_stepped.toml")


@pytest.fixture(scope="module")
def answer():
    return sg.answer(SCENE, 0.05, ["C_zz", "bending"])


@pytest.fixture(scope="module")
def beam():
    return sg.build(SCENE, "timoshenko")


def test_all_results_with_brackets_do_alike():
    mappings = {Answered, SolvedBearings, OfNumber, Sensitivities, Beside, Identification}
    for kind in (*mappings, ModeSet, SolvedModes):
        base = ByName if kind in mappings else NamedModes
        assert issubclass(kind, base)
        for method in ("__getitem__", "__contains__", "__iter__", "__len__"):
            assert inspect.getattr_static(kind, method) is base.__dict__[method]


def test_an_answer_is_a_mapping_of_its_numbers(answer):
    assert list(answer) == ["C_zz", "bending 1"] == list(answer.keys()) and len(answer) == 2
    assert "C_zz" in answer and "f9" not in answer
    assert dict(answer) == {v.quantity: v.value for v in answer.values} == dict(answer.items())
    assert answer.get("f9") is None and answer.get("C_zz") == answer["C_zz"]
    with pytest.raises(KeyError) as caught:
        answer["C_zy"]
    assert isinstance(caught.value, sg.SolidgearError)
    assert str(caught.value).startswith("there is no 'C_zy'") and "C_zz" in str(caught.value)


def test_modes_are_a_list_with_names(beam):
    modes = sg.modes(beam, SCENE, n=6)
    assert len(modes) == len(modes.modes) and [*modes] == [*modes.modes]
    assert modes[-1] is modes.modes[-1] and modes[:2] == modes.modes[:2]
    assert modes["bending 1"] is modes.named("bending 1") and modes[0] in modes
    assert "bending 1" in modes and "bending 99" not in modes
    with pytest.raises(KeyError, match="there is no 'bendin 1'.*bending 1"):
        modes["bendin 1"]
    with pytest.raises(IndexError):
        modes[99]


def test_a_data_set_of_shapes_has_one_frequency_for_each(beam):
    pytest.importorskip("xarray")
    modes = sg.modes(beam, SCENE, n=6)
    data = modes.to_xarray()
    assert data["frequency"].dims == ("shape",) and data["motion"].ndim == 3
    shapes = [m.frequency_hz for m in modes for _ in range(m.multiplicity)]
    assert data["frequency"].values.tolist() == shapes


def test_rows_of_a_sweep_are_columns_as_in_a_data_frame():
    widths = np.linspace(0.045, 0.055, 3)
    by_array = sg.sweep(SCENE, {"segment.left.diameter": widths}, model="euler", n=1)
    by_text = sg.sweep(SCENE, "segment.left.diameter=45 mm:55 mm:3", model="euler", n=1)
    assert "C_zz" in by_array and list(by_array) == list(by_array.columns)
    assert len(by_array) == len(by_array.rows) == 3
    assert by_array.rows[1]["C_zz"] == by_array["C_zz"][1]
    # the same diameters but for the rounding of their texts
    assert by_array["C_zz"] == pytest.approx(by_text["C_zz"], rel=1e-12)
    assert dict(by_array)["segment.left.diameter"].tolist() == widths.tolist()
    with pytest.raises(KeyError, match="there is no 'Czz'"):
        by_array["Czz"]
    with pytest.raises(sg.SolidgearError, match="a list of numbers"):
        sg.sweep(SCENE, {"segment.left.diameter": [[0.04, 0.05]]})
    assert isinstance(by_array, Swept)


def test_other_results_refuse_a_name_in_a_sentence(beam):
    slopes = sg.sensitivities(SCENE, "euler", of="C_zz", by="material.E", coarser=False)
    assert list(slopes) == ["C_zz"] and list(slopes["C_zz"]) == ["material.E"]
    for wrong in (lambda: slopes["K_zz"], lambda: slopes["C_zz"]["material.nu"]):
        with pytest.raises(NoSuchName, match="there is no"):
            wrong()
    bearings = sg.bearing(GEOMETRY / "gearbox_catalogue.toml")
    assert [*bearings] == [b.name for b in bearings.facts] and "Q" not in bearings
    with pytest.raises(KeyError):
        bearings["Q"]


def test_numbers_of_a_scene_in_one_call_are_those_of_the_commands():
    """The command solves the same mesh: the numbers agree to the last digit."""
    from solidgear.core.judge.settle import settle

    settled = settle(SCENE, None, "stiffness")
    by_hand = sg.condense(settled.body, SCENE, SCENE.port.name)
    assert np.array_equal(sg.stiffness(SCENE).stiffness, by_hand.stiffness)
    loose = sg.modes(SCENE, n=4, tol=0.1)
    body = settle(SCENE, 0.1, "modes").body
    rigid, *elastic = sg.modes(body, SCENE, n=4)
    assert [m.name for m in loose] == [rigid.name, *(m.name for m in elastic)]
    # the same body, solved with room above the list or without: each to its own rounding
    for mode in elastic:
        assert loose[mode.name].frequency_hz == pytest.approx(mode.frequency_hz, rel=1e-9)


def test_frequencies_alone_are_measured_resonances():
    rod = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.6, diameter=0.02)])
    alone = sg.load_measured([251.95, 690.85])
    assert [mode.frequency for mode in alone.modes] == [251.95, 690.85]
    pairs = sg.correlate(rod, np.array([251.95, 690.85])).pairs
    assert [pair.computed.name for pair in pairs] == ["bending 1", "bending 2"]


def test_a_gearbox_in_rexs_becomes_files(tmp_path):
    file = tmp_path / "box.rexs"
    sg.export(GEOMETRY / "gearbox_train.toml", file)
    box = sg.import_rexs(file, tmp_path / "train")
    assert sg.load_train(box.paths[0]).shafts.keys() == {"pinion", "gear"}
    with pytest.raises(sg.SolidgearError, match="such a file already"):
        sg.import_rexs(file, tmp_path / "train")
    sg.import_rexs(file, tmp_path / "train", force=True)
