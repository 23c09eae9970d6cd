"""What Python is answered: arguments by their names, texts as names, sentences for wrong types."""

import inspect
import json
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.arguments import arguments_of, fits
from solidgear.core.errors import SolidgearError

STEPPED = "geometry/shaft_stepped.toml"
SEGMENTS = [
    sg.Segment.cylinder("left seat", length="22 mm", diameter="40 mm"),
    sg.Segment.cylinder("body", length=0.12, diameter=0.052, bore=0.012),
    sg.Segment.cylinder("right seat", length="22 mm", diameter="40 mm"),
]
CATALOGUE = sg.Scene.from_parts(
    SEGMENTS,
    "steel",
    bearings=[
        sg.Bearing(name="A", on="left seat", designation="6208"),
        sg.Bearing(name="B", on="right seat", designation="6208"),
    ],
    port=sg.Port(name="gear", on="body"),
    load={"x": "2 kN"},
)
BEAM = sg.build(CATALOGUE, "timoshenko")
TRAIN = "geometry/axle_straddle.toml"
#: arguments that a function looks at itself, or of types of other libraries
FOREIGN = {"scene", "source", "mesh"}


@pytest.mark.parametrize(
    "wrong, kind, words",
    [
        (lambda: sg.Segment("a"), TypeError, "^Segment takes its values by name"),
        (lambda: sg.Port("a"), TypeError, "^Port takes its values by name"),
        (lambda: sg.Segment(name="a", length=1), sg.SceneError, "Segment.cylinder"),
        (lambda: sg.answer(None), SolidgearError, "^answer: `scene` = None: give the path"),
        (lambda: sg.Scene.from_dict([]), SolidgearError, r"^\[\]: give the tables of a scene"),
        (lambda: sg.Train.from_dict("x"), SolidgearError, "^'x': give the tables of a train"),
        (lambda: sg.modes(3), SolidgearError, "^modes: `body` = 3: give the path"),
        (lambda: sg.modes(CATALOGUE, CATALOGUE), SolidgearError, "`supports` are those of the"),
        (lambda: sg.modes(CATALOGUE, n=0), SolidgearError, "n = 0: give 1 to"),
        (lambda: sg.modes(BEAM, tol=0.1), SolidgearError, "a body has its mesh"),
        (lambda: sg.condense(CATALOGUE, (), "gear"), SolidgearError, "`body` = a Scene"),
        (lambda: sg.build(STEPPED, "euler"), SolidgearError, "first, by sg.load"),
        (lambda: sg.deflect(CATALOGUE, load={"q": 1}), SolidgearError, "unknown key"),
        (
            lambda: sg.bearing(CATALOGUE, load=3),
            SolidgearError,
            "`load` = 3: give a text or a dict",
        ),
        (lambda: sg.port_matrices(STEPPED, speed="3 kg"), SolidgearError, "no.* unit of speed"),
        (
            lambda: sg.deflect(STEPPED, models=3),
            SolidgearError,
            "`models` = 3: give a text or a list",
        ),
        (lambda: sg.modes(BEAM, 3), SolidgearError, "`supports` = 3: give .*Scene"),
        (lambda: sg.answer(STEPPED, ask=[1]), SolidgearError, "`ask` = \\[1\\]"),
        (lambda: sg.optimise(STEPPED, 3, "max f1"), SolidgearError, "`vary` = 3: give a text"),
        (lambda: sg.line_of_action(0.1, 0.2, "20", "left", "left"), SolidgearError, "a number"),
        (lambda: sg.modes(BEAM, progress=3), TypeError, r"^modes\(\) got an unexpected"),
        (lambda: sg.system_modes(TRAIN, kep=3), TypeError, '"kept"'),
        (lambda: sg.system_modes(TRAIN, kept="3"), SolidgearError, "`kept` = .*whole number"),
        (lambda: sg.sweep(STEPPED, "material.E=2e11,3e11", n="x"), SolidgearError, "`n` = "),
        (lambda: sg.turn(BEAM, 3), SolidgearError, "a ModeSet, which solidgear.modes makes"),
        (lambda: sg.receptance(TRAIN, ("a",), "b"), SolidgearError, "a pair"),
        (lambda: sg.condense(BEAM, CATALOGUE, ("A", "B"), ["section"]), SolidgearError, "one for"),
        (lambda: sg.export(STEPPED, "x.abc"), SolidgearError, "of no format.* ross"),
    ],
)
def test_wrong_types_end_in_a_sentence(wrong, kind, words):
    with pytest.raises(kind, match=words):
        wrong()


@pytest.mark.parametrize("name", [n for n in dir(sg) if inspect.isfunction(getattr(sg, n))])
def test_every_function_says_what_its_arguments_may_be(name):
    function = getattr(sg, name)
    hints = arguments_of(inspect.unwrap(function))
    words = {key for key in inspect.signature(function).parameters if key not in FOREIGN}
    assert {key for key in words if hints.get(key, Any) is Any} <= {"options", "how", "wanted"}
    assert pickle.loads(pickle.dumps(function)) is function


def test_a_tolerance_is_a_number_or_a_text():
    for study in (
        lambda tol: sg.stress(STEPPED, "euler", load="x=1 kN", tol=tol),
        lambda tol: sg.sweep(STEPPED, "segment.left.diameter=45 mm,50 mm", tolerance=tol),
        lambda tol: sg.optimise(STEPPED, "segment.left.diameter=45 mm:50 mm", "max f1", tol=tol),
        lambda tol: sg.correlate(STEPPED, {"mode": [{"frequency": 800.0}]}, tol),
        lambda tol: sg.identify(STEPPED, {"mode": [{"frequency": 800.0}]}, "material.E", tol=tol),
    ):
        for wrong in ("5 kg", -0.1, float("nan")):
            with pytest.raises(SolidgearError, match="tol = .* is not usable"):
                study(wrong)
    assert sg.stress(STEPPED, "euler", load="x=1 kN", tol="5%").shafts


def test_kinds_of_rows_stand_with_commas_or_one_by_one():
    paths = "segment.left.diameter=45 mm,50 mm"
    rows = sg.sweep(STEPPED, paths, model="euler", ask="answer, deflect", n=1)
    assert {*rows.columns} == {
        *sg.sweep(STEPPED, paths, model="euler", ask=["answer", "deflect"], n=1).columns
    }
    with pytest.raises(SolidgearError, match='of a shaft give one .* did you mean "stress"'):
        sg.sweep(STEPPED, paths, ask="stres")


def test_a_resonance_below_all_modes_ends_in_a_sentence():
    with pytest.raises(SolidgearError, match="no elastic mode up to 572 Hz"):
        sg.identify(STEPPED, {"mode": [{"frequency": 520.0}]}, "material.E", tol=0.05)


def test_numbers_of_other_libraries_are_numbers():
    assert fits(np.int64(3), int) and fits(np.float32(0.1), float) and fits(np.array(2.0), float)
    assert not fits(True, float) and not fits(np.array([2.0]), float) and not fits(3.0, int)
    point = sg.deflect("geometry/gearbox_train.toml", "euler", point=1).judge
    assert point.shafts


def test_a_text_is_a_name_and_no_row_of_letters():
    number = sg.sensitivities(STEPPED, "timoshenko", of="bending 1", by="bearing.A")
    assert [of.name for of in number.of] == ["bending 1"]
    assert [*sg.port_matrices(STEPPED, ports="A").positions] == ["A"]
    with pytest.raises(SolidgearError, match="segment.x"):
        sg.optimise(STEPPED, "segment.x.diameter=1 mm:2 mm", "max bending 1")
    with pytest.raises(SolidgearError, match="material.X"):
        sg.identify(STEPPED, {"mode": [{"frequency": 500.0}]}, "material.X")


def test_a_speed_is_a_text_with_its_unit_or_radians_in_a_second():
    by_text = sg.port_matrices(STEPPED, speed="30 rpm")
    by_number = sg.port_matrices(STEPPED, speed=np.pi)
    assert np.allclose(by_text.gyroscopic, by_number.gyroscopic, rtol=1e-12, atol=1e-15)
    assert abs(by_text.gyroscopic).max() > 1e-6
    assert "\n" not in repr(by_text) and "A" in repr(by_text)


def test_derivatives_of_a_shaft_made_in_python_are_those_of_its_file():
    by = "segment.body.diameter"
    fresh = sg.sensitivities(CATALOGUE, "timoshenko", of="bending 1", by=by, coarser=False)
    settled = sg.sensitivities(
        CATALOGUE.settled, "timoshenko", of="bending 1", by=by, coarser=False
    )
    assert not fresh.without
    assert fresh["bending 1"][by].by == settled["bending 1"][by].by != 0


def test_lengths_are_written_with_the_digits_that_a_person_gave():
    tables = CATALOGUE.to_dict()
    assert [table["length"] for table in tables["segment"]] == [0.022, 0.12, 0.022]
    assert sg.Scene.from_dict(tables) == CATALOGUE


def test_a_hollow_shaft_has_a_rotor_file_for_ross(tmp_path):
    sg.export(CATALOGUE, tmp_path / "rotor.py", "ross")
    rows = [
        row for row in (tmp_path / "rotor.py").read_text().splitlines() if "BeamElement(" in row
    ]
    assert sum("0.012, 0.05" in row for row in rows) > 8


@pytest.mark.parametrize(
    "young, density", [("210e3 N/mm2", "7850 kg/m3"), ("21e6 N/cm**2", "7.85 g/cm3")]
)
def test_areas_and_volumes_may_go_without_a_sign_of_power(young, density):
    steel = sg.Material(E=young, nu=0.3, density=density)
    assert (steel.E, steel.density) == pytest.approx((210e9, 7850.0))
    schema = json.loads(
        Path(sg.__file__).with_name("show").joinpath("schema/scene.json").read_text()
    )
    patterns = schema["properties"]["material"]["properties"]
    assert re.fullmatch(patterns["E"]["pattern"], young)
    assert re.fullmatch(patterns["density"]["pattern"], density)


def test_a_load_is_a_text_or_its_components():
    texts, components = "x=1 kN, z=500", {"x": "1 kN", "z": 500.0}
    by_text, by_dict = (sg.bearing(CATALOGUE, load=load)["A"] for load in (texts, components))
    assert np.array_equal(by_text.motion, by_dict.motion) and by_text.motion.any()
