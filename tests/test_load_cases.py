"""Cases of the loads of a shaft: stress in each, and the commands that take one of them."""

from html import unescape
from pathlib import Path

import pytest
from command import command
from filleted import STRONG, shoulder

import solidgear as sg
from solidgear.core.loading import as_written, case_sentence, under_case
from solidgear.show.remarks import document_under, load

GEOMETRY = Path(__file__).parent.parent / "geometry"
CATALOGUE = GEOMETRY / "gearbox_catalogue.toml"
SAYS = 'catalogue bearings settle under the load case "full", one of 2; --case NAME'
CASES = """
[[case]]
name = "full"
[[case]]
name = "light"
factors = { load = 0.25 }
"""


@pytest.fixture
def file(tmp_path):
    """A shaft on catalogue bearings in two cases of its load."""
    path = tmp_path / "two.toml"
    path.write_text(CATALOGUE.read_text() + CASES)
    return path


def test_stress_shows_every_case_of_the_loads():
    cases = (sg.LoadCase(name="full"), sg.LoadCase(name="half", factors={"pull": -0.5}))
    pull = sg.ShaftLoad(name="pull", on="gear", z=-20e3)
    scene = shoulder(strength=STRONG).with_changes(loads=(pull,), cases=cases)
    result = sg.stress(scene, "timoshenko", tol=0.05)
    (notch,) = result.shafts[0].found.notches
    full, half = result.cases
    assert (full.label, full.notch, full.fillet) == ("full", notch.name, notch.name)
    assert (full.fatigue, full.yielding) == (notch.rating.fatigue, notch.rating.yielding)
    assert full.amplitude == notch.local.amplitude
    # all is linear in the load, and turning it round moves no amplitude
    assert half.largest_moment == pytest.approx(full.largest_moment / 2, rel=1e-6)
    assert half.amplitude == pytest.approx(full.amplitude / 2, rel=1e-6)
    assert half.fatigue == pytest.approx(2 * full.fatigue, rel=1e-6)
    assert half.yielding == pytest.approx(2 * full.yielding, rel=1e-6)
    table = result.sheet().tables[0]
    assert table.title == "Every case of the loads"
    assert [row[0] for row in table.values] == ["full", "half"]
    assert [case["notch"] for case in result.as_dict()["cases"]] == [notch.name] * 2
    assert not sg.stress(scene.with_changes(cases=()), "timoshenko", tol=0.05).cases


def test_a_case_stands_first_under_which_bearings_settle(file):
    first = sg.load(under_case(file, "light"))
    assert [case.name for case in first.cases] == ["light", "full"]
    assert first.bearings == sg.load(file).with_case("2").settled.bearings
    stiff = [scene.bearings[0].stiffness[0, 0] for scene in (sg.load(file), first)]
    assert abs(stiff[1] / stiff[0] - 1) > 0.01
    assert under_case(file, None).tables == as_written(file).as_read.tables
    with pytest.raises(sg.SolidgearError, match='two.toml: there is no case "night"; there are 1'):
        under_case(file, "night")
    with pytest.raises(
        sg.SolidgearError, match="`case` is for a shaft, and .*gearbox_train.toml is a"
    ):
        sg.check(GEOMETRY / "gearbox_train.toml", case="light")


def test_the_case_that_counts_is_printed_where_none_is_chosen(file, capsys):
    assert load(file).cases[0].name == "full"
    assert SAYS in capsys.readouterr().err
    assert load(file, "light").cases[0].name == "light"
    assert capsys.readouterr().err == ""
    document_under(file, None)
    assert SAYS in capsys.readouterr().err
    assert document_under(file, "light").tables["case"][0]["name"] == "light"
    assert capsys.readouterr().err == ""


SAYING = (
    ("stiffness", "FILE", "-f", "timoshenko"),
    ("budget", "FILE"),
    ("check", "FILE"),
    ("sweep", "FILE", "-f", "timoshenko", "--vary", "bearing.B.position=0.149,0.15"),
    ("compare", "FILE", "--models", "timoshenko", "--no-renders"),
)
#: one whose words are printed, and one that says them beside its progress
OFTEN = ("check", "compare")


@pytest.mark.parametrize(
    "words",
    [
        pytest.param(w, marks=pytest.mark.long if w[0] in OFTEN else pytest.mark.slow)
        for w in SAYING
    ],
    ids=lambda words: words[0],
)
def test_commands_say_which_case_counts(words, file, monkeypatch, no_charts):
    monkeypatch.chdir(file.parent)
    words = [file if word == "FILE" else word for word in words]
    plain = command(*words)
    says = plain.stdout if words[0] == "check" else plain.stderr
    assert SAYS.partition(";")[0] in " ".join(says.split())
    out = ("--out", "light.csv") if words[0] == "sweep" else ()
    chosen = command(*words, "--case", "light", *out)
    assert chosen.exit_code == plain.exit_code and chosen.stdout != plain.stdout
    assert "--case NAME" not in chosen.stderr
    if words[0] == "compare":  # a report is read without the command that made it
        page = (file.parent / "out" / "report.html").read_text("utf-8")
        assert 'load case "light", one of 2' in unescape(page)
        assert 'load case "light", one of 2' in " ".join(chosen.stdout.split())


def test_balls_turn_at_the_speed_of_the_case(file):
    """Their inertia is that of the case where it has a speed, else of the file: 20,000 rpm of a case
    loosen the pair by a quarter, with the same loads as 20,000 rpm of its data.
    """
    still = as_written(file).with_changes(lubrication=None)
    light, full = (case.with_changes(speed="20000 rpm") for case in still.cases)
    fast = still.with_changes(cases=(light, full))
    a, b = still.bearings
    stated = still.with_changes(
        bearings=(a, b.with_changes(catalogue=b.catalogue.with_changes(speed="20000 rpm")))
    )

    def pair(scene):
        return scene.settled.bearings[1].stiffness

    assert pair(fast)[2, 2] < 0.8 * pair(still)[2, 2]
    assert pair(fast) == pytest.approx(pair(stated), rel=1e-6, abs=1e3)
    loads = [
        {b.name: b.load for b in sg.deflect(scene, "timoshenko").judge.shafts[0].bearings}
        for scene in (fast, stated)
    ]
    assert loads[0]["B"] == pytest.approx(loads[1]["B"], rel=1e-6, abs=1e-3)
    # the loads at rest choose the mesh of one, those at speed that of the other
    facts = [sg.bearing(still, speed="20000 rpm")["B"], sg.bearing(fast)["B"]]
    assert facts[0].stiffness == pytest.approx(facts[1].stiffness, rel=2e-3, abs=1e3)


def test_a_case_is_no_choice_where_nothing_settles_under_it(file):
    scene = as_written(file)
    assert case_sentence(scene).startswith("catalogue bearings settle")
    assert case_sentence(scene.with_changes(cases=scene.cases[:1])) == ""
    stated = shoulder().with_changes(loads=(), cases=scene.cases[:1])
    assert case_sentence(stated) == ""
