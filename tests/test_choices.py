"""Lists of a sweep or search: what follows a designation, a material or a number of teeth, numbers of a
shaft under load, and what is refused.
"""

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.bearings.study import bearing_facts
from solidgear.strength.stress.rating import Rating
from solidgear.variants.sweep.shaft_numbers import lesser
from tests.command import command
from validation.common import read_result
from validation.optimum import PROBLEMS, beside

GEOMETRY = Path(__file__).parent.parent / "geometry"
CATALOGUE, TRAIN = GEOMETRY / "gearbox_catalogue.toml", GEOMETRY / "gearbox_train.toml"
DESIGNATION = "bearing.A.catalogue.designation"
BEAM = {"model": "timoshenko"}
BEAMS = {"pinion": "timoshenko", "gear": "timoshenko"}


def tables(path=CATALOGUE):
    return tomllib.loads(path.read_text())


@pytest.fixture(scope="module")
def rows():
    return sg.sweep(
        CATALOGUE,
        f"{DESIGNATION}=NU 207,NU 208,6307,NU 212",
        ask=["answer", "deflect", "bearing"],
        n=1,
        **BEAM,
    )


def test_a_seat_and_the_data_of_a_bearing_follow_its_designation(rows):
    """The row of another bearing is that of the file edited by hand."""
    assert rows["status"][:3].tolist() == ["ok"] * 3
    assert rows["segment.left.diameter"][:3].tolist() == [0.035, 0.04, 0.035]
    edited = tables()
    edited["segment"][0]["diameter"] = "40 mm"
    edited["bearing"][0]["seat_width"] = "18 mm"
    edited["bearing"][0]["catalogue"] = {
        "designation": "NU 208",
        "clearance": "CN",
        "shaft_interference": "10 um",
    }
    scene = sg.load(edited)
    body = sg.build(scene, "timoshenko")
    stiffness = sg.condense(body, scene, scene.port.name).stiffness
    assert rows["K_zz"][1] == pytest.approx(stiffness[2, 2], rel=1e-9)
    facts = {fact.name: fact for fact in bearing_facts(scene, body)}
    lives = {name: fact.life.lives["modified"] for name, fact in facts.items()}
    assert rows["A.life"][1] == pytest.approx(lives["A"], rel=1e-9)
    assert rows["life"][1] == pytest.approx(min(lives.values()), rel=1e-9)
    hours = min(lives.values()) / (1500 * 60)
    assert rows["life_hours"][1] == pytest.approx(hours, rel=1e-9)
    deflected = sg.deflect(edited, "timoshenko").judge
    x, z = (deflected.displacement["pinion"][k].value for k in (0, 2))
    assert rows["deflection_pinion"][1] == pytest.approx((x**2 + z**2) ** 0.5, rel=1e-6)


def test_the_bearing_of_the_file_keeps_all_that_is_given_of_it(rows):
    facts = {fact.name: fact for fact in bearing_facts(*_as_it_is())}
    assert rows["A.life"][0] == pytest.approx(facts["A"].life.lives["modified"], rel=1e-9)
    assert rows["A.static_safety"][0] == pytest.approx(facts["A"].life.life.static_safety, rel=1e-9)


def _as_it_is():
    scene = sg.load(CATALOGUE)
    return scene, sg.build(scene, "timoshenko")


def test_a_bearing_that_leaves_no_shoulder_is_refused(rows):
    assert "its bore of 60 mm leaves no shoulder at 'pinion' (60 mm)" in rows["status"][3]


def test_what_followed_is_said(rows):
    (sentence,) = rows.task.variants.followed
    assert "segment.left.diameter follows its bore; seat_width follows its width" in sentence
    assert 'load_rating, static_rating of the file belong to "NU 207"' in sentence


def test_a_bore_without_a_seat_to_follow_is_refused():
    """The seat of the file fits, and where it may not change, others do not fit it."""
    vary = [f"{DESIGNATION}=NU 207,NU 208", "segment.left.diameter=35 mm,40 mm"]
    rows = sg.sweep(CATALOGUE, vary, n=1, **BEAM)
    sound = [status == "ok" for status in rows["status"]]
    assert sound == [True, True, False, True]  # a bearing of the file may sit loose, with a caution
    assert "has a bore of 40 mm and sits on a diameter of 35 mm" in rows["status"][2]


def test_a_seat_that_another_bearing_shares_does_not_grow_under_it():
    edited = tables()
    edited["segment"][0]["diameter"] = edited["segment"][1]["diameter"] = "40 mm"
    edited["bearing"][0]["catalogue"] = {"designation": "NU 208", "clearance": "CN"}
    edited["bearing"][0] |= {"position": "100 mm", "seat_width": "18 mm"}
    rows = sg.sweep(edited, f"{DESIGNATION}=NU 208,NU 209", n=1, **BEAM)
    assert rows["status"][0] == "ok"
    assert (
        "bearing 'B' (7208 B) has a bore of 40 mm and sits on a diameter of 45" in rows["status"][1]
    )


def test_teeth_take_their_pitch_radius_along():

    rows = sg.sweep(TRAIN, "pinion.teeth=20:21", ask=["deflect"], **BEAMS)
    assert rows["pinion.teeth"].tolist() == [20, 21]
    assert rows["pinion.pitch_radius"] == pytest.approx([0.03, 0.0315])
    edited = tables(TRAIN)
    for side in ("pinion", "gear"):
        edited[side]["scene"] = str(GEOMETRY / edited[side]["scene"])
    edited["pinion"] |= {"teeth": 21, "pitch_radius": "31.5 mm"}
    by_hand = sg.deflect(edited, "timoshenko").judge
    (f_sh,) = (m.value for m in by_hand.misalignment if m.name == "f_sh")
    assert rows["misalignment_f_sh"][1] == pytest.approx(f_sh, rel=1e-6)


def test_materials_are_chosen_by_name():
    rows = sg.sweep(CATALOGUE, "material=42CrMo4,aluminium", n=1, **BEAM)
    steel, light = rows["mass"]
    assert light / steel == pytest.approx(2700 / 7850)


@pytest.mark.long
def test_a_search_over_lists_finds_the_best_row_of_a_sweep():
    lists = [f"{DESIGNATION}=NU 206,NU 207,NU 307", "material=42CrMo4,EN-GJS-700"]
    keep = "A.static_safety > 16"
    found = sg.optimise(CATALOGUE, lists, "min mass", keep, **BEAM)
    rows = sg.sweep(CATALOGUE, lists, ask=["bearing"], n=1, **BEAM)
    kept = rows["A.static_safety"] > 16
    assert 0 < kept.sum() < len(rows)
    assert found.best.value == pytest.approx(rows["mass"][kept].min(), rel=1e-12)
    assert found.trace.whole and "all 6 combinations" in " ".join(found.sentences)


@pytest.mark.parametrize(
    ("vary", "said"),
    [
        (f"{DESIGNATION}=NU 207,NU 299", "NU 299.*is not understood"),
        (f"{DESIGNATION}=NU 207", "holds one value alone"),
        (f"{DESIGNATION}=", "PATH=A,B,C"),
        (f"{DESIGNATION}=NU 207,,6307", "a value of the list is empty"),
        ("material=42CrMo4,unobtainium", "unobtainium.*not known"),
        ("segment.left.diameter=35 mm:35 mm", "both ends are the same"),
    ],
)
def test_what_is_no_choice_is_refused_in_a_sentence(vary, said):
    with pytest.raises(sg.SolidgearError, match=said) as error:
        sg.optimise(CATALOGUE, vary, "min mass", **BEAM)
    assert "\n" not in str(error.value)


def test_the_command_draws_a_front(tmp_path):
    words = ["--vary", f"{DESIGNATION}=NU 206,NU 207,NU 307", "-f", "timoshenko"]
    goals = ["--goal", "min mass", "--goal", "max life"]
    shown = command("optimise", CATALOGUE, *words, *goals, "-o", tmp_path)
    assert shown.exit_code == 0, shown.output
    assert "beaten by no other in both mass and life" in " ".join(shown.output.split())
    assert "all 3 combinations, so that the front is whole" in " ".join(shown.output.split())
    assert (tmp_path / "front.svg").read_text().count("design ") >= 2


# ------------------------------------------------------------------------------- beside brute force
@pytest.mark.parametrize(
    "name",
    [
        pytest.param("lists alone, two goals", marks=pytest.mark.long),
        pytest.param("span", marks=pytest.mark.slow),
        pytest.param("two limits", marks=pytest.mark.slow),
    ],
)
def test_a_search_is_no_worse_than_a_fine_grid(name):
    (problem,) = (problem for problem in PROBLEMS if problem.name == name)
    # a list of three is searched as one of five
    few = {path: words[:3] for path, words in problem.lists.items()}
    row = beside(replace(problem, lists=few))
    assert row["behind_percent"] < 0.1
    assert row["designs"] < row["grid_designs"] + 2


def test_all_ten_searches_are_kept_beside_their_grids():
    rows = [row for key, row in read_result("optimum").items() if key != "made"]
    assert {row["problem"] for row in rows} == {problem.name for problem in PROBLEMS}
    for row in rows:
        assert row["behind_percent"] < 0.1 or "Stopped at" in " ".join(row["words"]), row["problem"]


def test_the_least_safety_of_several_notches_counts():
    known = {"fatigue_safety": 2.0, "yield_safety": 1.5, "worst_notch": "step"}
    rating = Rating((), 1.8, 3.0, None, 0.1, (), (1.2, 2.0), None)
    assert lesser(known, rating, "groove") == {
        "fatigue_safety": 1.8,
        "fatigue_safety bar": 0.1,
        "worst_notch": "groove",
        "fatigue_safety_least": 1.2,
        "yield_safety_least": 2.0,
    }


@pytest.mark.slow
def test_the_worst_notch_in_the_worst_case_counts():
    """The least safety of all notches in the case that is worse, as it has it by itself."""
    edited = tables(GEOMETRY / "pinion_filleted.toml") | {"material": "42CrMo4"}
    edited["load"] = [{"name": "teeth", "on": "pinion", "z": "10 kN"}]
    edited["case"] = [{"name": "high"}, {"name": "low", "factors": {"teeth": 0.4}}]
    vary = "bearing.1.seat_width=39 mm,40 mm"
    rows = sg.sweep(edited, vary, ask=["stress", "deflect"], **BEAM)
    (worst, *_) = sg.stress(edited, "timoshenko").shafts[0].found.worst
    assert rows["worst_notch"][1] == worst.name
    assert rows["fatigue_safety"][1] == pytest.approx(worst.rating.fatigue, rel=1e-9)
    assert rows["yield_safety"][1] == pytest.approx(worst.rating.yielding, rel=1e-9)
    moved = sg.deflect(edited, "timoshenko").judge.displacement["pinion"]
    size = (moved[0].value ** 2 + moved[2].value ** 2) ** 0.5
    assert rows["deflection_pinion"][1] == pytest.approx(size, rel=1e-9)


def test_lives_of_a_train_hold_for_its_duty_table():
    rows = sg.sweep(TRAIN, "pinion.bearing.A.position=15 mm,16 mm", ask=["bearing"])
    lives = sg.bearing(TRAIN).lives
    # another tolerance may choose another mesh, which moves loads by 1e-4 and lives by three times that
    hours = min(bearing.duty.hours for bearing in lives)
    assert rows["life_hours"][0] == pytest.approx(hours, rel=1e-3)
    assert rows["pinion.A.life"][0] == pytest.approx(lives[0].duty.revolutions, rel=1e-3)
    assert rows["mass"][0] == pytest.approx(rows["mass"][1])
