"""What two commands say of one thing is the same: the short version of ``validation.agree``."""

from pathlib import Path

from validation.agree import described, nested, same_number
from validation.agree.commands import OF_A_BEAM, answered
from validation.agree.relation import Number, failed, meeting

ROOT = Path(__file__).parent.parent
STEPPED = ROOT / "geometry" / "shaft_stepped.toml"
CATALOGUE = ROOT / "geometry" / "gearbox_catalogue.toml"


def all_hold(relations, at_least):
    relations = list(relations)
    assert len(relations) >= at_least  # a command that is refused would say nothing
    assert failed(relations) == []


def test_two_numbers_meet_where_their_intervals_do():
    wide = Number.within(1.0, 0.1)
    assert wide.meets(Number.within(1.15, 0.06))
    assert not wide.meets(Number.within(1.15, 0.04))
    # a bound from one side claims nothing on the other
    assert not Number.within(1.0, 0.1, side="above").meets(Number.within(0.95, 0.01))
    assert Number.within(2.0, 0.1).times(-0.5).meets(Number.within(-1.0, 0.0))
    claims = {"one": {"C_zz": wide}, "other": {"C_zz": Number.within(2.0, 0.1)}}
    assert [r.holds for r in meeting("file", "kind", claims)] == [False]


def test_a_beam_is_one_number_by_every_command():
    claims = {
        name: {key: n for key, n in function(STEPPED, "-f", "timoshenko").items() if "C_" in key}
        for name, function in OF_A_BEAM.items()
    }
    all_hold(meeting("shaft_stepped", same_number.KIND, claims), at_least=10)


def test_answers_at_several_tolerances_do_not_exclude_each_other():
    all_hold(nested.of_scene(STEPPED, tolerances=(3e-2, 1e-3)), at_least=6)


def test_answers_that_exclude_each_other_or_move_to_the_other_side_are_found():
    said = {"quantity": "C_zz", "value": 1.0, "bar": 0.01, "size": 1.0, "side": "above"}
    finer = answered([said | {"value": 1.02, "bar": 0.001}])
    lower = answered([said | {"value": 0.999, "bar": 0.02}])
    said = answered([said])
    wrong = {
        name: [r.name for r in failed(nested.beside("shaft", {"1e-2": said, "1e-3": other}))]
        for name, other in {"same": said, "finer": finer, "lower": lower}.items()
    }
    assert wrong == {
        "same": [],
        "finer": ["C_zz: 1e-2, 1e-3"],
        "lower": ["C_zz never falls: 1e-2, 1e-3"],
    }


def test_a_shaft_described_otherwise_has_the_same_numbers():
    all_hold(described.of_scene(STEPPED, tol=0.05), at_least=50)


def test_a_factor_that_is_wrong_is_seen(monkeypatch):
    # frequencies of a shaft four times as heavy are halved; without the factor they must not agree
    heavier = next(r for r in described.REWRITINGS if r.name == "four times as heavy")
    wrong = described.Rewriting(heavier.name, heavier.change)
    monkeypatch.setattr(described, "REWRITINGS", (wrong,))
    seen = failed(described.of_scene(STEPPED, tol=0.05))
    assert len(seen) == 3 and all("four times as heavy" in relation.name for relation in seen)


def test_bearings_have_one_load_and_one_life_by_every_command():
    # another model of the shaft would move a life by 4 %: loads are those of the mesh that is trusted
    all_hold(same_number.lives(CATALOGUE, sheet=False), at_least=8)


def test_bearings_under_their_preload_alone_have_one_life():
    # without a load the shaft gives way nowhere: a row had a preload less 2 %, and a life 6 % longer
    preloaded = ROOT / "geometry" / "reducer_output.toml"
    all_hold(same_number.lives(preloaded, sheet=False), at_least=2)
