"""The bearing whose inside leaves most open: in one line, and what to ask its maker."""

import re

import pytest

import solidgear as sg
from solidgear.bearings.catalogue import Catalogue
from solidgear.bearings.geometry import inner_geometry
from solidgear.bearings.rating import ratings, ratings_of_one
from solidgear.show.open_words import remark
from solidgear.strength.deflection.at_rest import deflect
from solidgear.trains.assembly.assembly import Assembly
from solidgear.variants.budget.budget import Budget, Points, beside, budget, open_inputs
from solidgear.variants.budget.chart import budget_sheet
from solidgear.variants.budget.questions import questions

KNOWN = (
    ', elements = 14, element_diameter = "11.9 mm", pitch_diameter = "60 mm", conformity = 0.52, '
    'contact_angle = "40 deg"'
)
SHAFT = """
name = "two cones"
arrangement = "O"
material = {{ E = "206 GPa", nu = 0.3, density = "7850 kg/m^3" }}
segment = [{{ name = "shaft", kind = "cylinder", length = "160 mm", diameter = "40 mm" }}]
port = {{ position = "80 mm", from = "start", span = ["60 mm", "100 mm"] }}
load = {{ y = "900 N", z = "4 kN" }}

[[bearing]]
name = "A"
position = "15 mm"
catalogue = {{ designation = "7208 B", preload = "500 N"{first} }}

[[bearing]]
name = "B"
position = "145 mm"
catalogue = {{ designation = "7208 B"{second} }}
"""


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    def of(first, second):
        path = tmp_path_factory.mktemp("scenes") / "scene.toml"
        path.write_text(SHAFT.format(first=first, second=second), encoding="utf-8")
        return sg.load(path)

    return of


@pytest.fixture(scope="module")
def ranges(scene):
    return beside(scene("", KNOWN))


LED = (
    "100 % of what is open in C_yy comes from the inside of bearing A (7208 B): its maker knows it"
)


def test_one_bearing_that_leads_is_named_in_one_line(scene, ranges):
    one = ranges
    assert LED in remark(one) and "solidgear budget lists what to ask" in remark(one)
    # of the numbers that are asked for the widest
    assert "open in bending 1 comes from the inside of bearing A" in remark(one, ["bending 1"])
    # two that share it: none leads
    shared = one.model_copy(deep=True)
    for number in shared.numbers:
        number.by_input["bearing.B.inside"] = number.by_input["bearing.A.inside"]
    assert "comes from the inside" not in remark(shared)
    assert "See: solidgear budget." in remark(shared)


def test_questions_to_a_maker_and_what_each_narrows(scene, ranges):
    shaft = scene("", KNOWN)
    inputs = open_inputs(shaft)
    asked_for = questions(Points(shaft, inputs), ranges, [0])
    result = Budget(scene=shaft.name, questions=asked_for, **dict(ranges))
    asked = {question.key: question for question in result.questions}
    assert [*asked][0] == "load_rating" and asked["load_rating"].in_catalogue
    assert {"elements", "element_diameter", "conformity"} <= {*asked}
    assert "pitch_diameter" not in asked  # nothing of this range comes from it
    assert asked["elements"].asked == "number of rolling elements in a row"
    assert {q.designation for q in result.questions} == {"7208 B"}
    # the same by a file that says so, on the way of any other scene
    question = asked["elements"]
    answered = scene(f", elements = {question.middle.split()[0]}", KNOWN)
    points = Points(answered, open_inputs(answered))
    ends = [points.numbers([place])[question.number] for place in (0.0, 0.5, 1.0)]
    width = (max(ends) - min(ends)) / abs(ends[1])
    assert question.left == pytest.approx(width / question.width, rel=1e-9)
    assert 0.1 < question.left < 0.9
    (table,) = [t for t in budget_sheet(result).tables if t.name == "questions"]
    text = str(table)
    assert "basic dynamic load rating C, kN" in text and "A (7208 B)" in text


def test_a_shaft_whose_bearings_are_known_asks_nothing(scene):
    with pytest.raises(sg.SolidgearError, match="no input is open"):
        budget(scene(KNOWN, KNOWN))


def test_the_maker_of_a_pair_is_asked_for_numbers_of_one_bearing():
    result = budget(sg.load("geometry/gearbox_wheel.toml"))
    assert {question.bearing for question in result.questions} == {"C", "D"}
    for question in result.questions:
        middle, *ends = map(float, re.findall(r"[0-9.]+", question.middle))
        if ends and question.key != "conformity":
            assert ends[0] <= middle <= ends[1]
    pair = Catalogue(designation="7208 B", arrangement="back_to_back")
    single = Catalogue(designation="7208 B", holds="+y")
    inside = inner_geometry(pair).middle
    assert ratings_of_one(pair, inside) == ratings(single, inside)
    assert ratings(pair, inside).static == 2 * ratings(single, inside).static


def test_a_deflection_names_the_bearing_that_leads(scene):
    led = deflect(Assembly.of(scene("", KNOWN)), models=["timoshenko"]).judge.led
    assert "comes from the inside of bearing A (7208 B)" in led
