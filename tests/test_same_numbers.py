"""What tells whether two states of the source give the same numbers sees every kind of change."""

import pytest

from validation.same_numbers import differences, lost, renamed

RECORD = {"a": [1.0, {"f": 2.0}], "text": "x", "none": None, "seconds": 1.0}


def test_the_same_is_the_same_whatever_it_took():
    assert not list(differences(RECORD, RECORD | {"seconds": 2.0}, 1e-12))


@pytest.mark.parametrize(
    "other",
    [
        RECORD | {"a": [1.0, {"f": 2.0 + 1e-11}]},
        RECORD | {"a": [1.0]},
        RECORD | {"text": "y"},
        RECORD | {"none": 0.0},
        RECORD | {"more": 1},
        {k: v for k, v in RECORD.items() if k != "text"},
    ],
)
def test_a_change_is_seen(other):
    assert len(list(differences(RECORD, other, 1e-12))) == 1


def test_new_names_of_old_numbers_are_no_difference():
    old = {
        "schema": 2,
        "models": {
            "solid": {
                "band": {"bending_1": 0.1, "each": {"C_zz": 0.2, "bending 1": 0.1}},
                "convergence": {
                    "levels": [{"c_zz": 1.0, "bending_1_hz": 2.0, "dofs": 3}],
                    "c_zz": {"gci": 0.2},
                    "bending_1": {"gci": 0.1},
                },
            }
        },
        "attachments": {"solid": {"rigid": {"c_zz": 1.0, "k_zz": 2.0, "bending_1_hz": 3.0}}},
        "causes": [{"cause": "shear", "c_zz": 1.0, "k_zz": None, "bending_1": 2.0}],
        "lumped": {"solid": {"first_bending_hz": 5.0}},
    }
    new = renamed(old)
    assert new["models"]["solid"]["convergence"]["quantities"]["bending 1"] == {"gci": 0.1}
    assert new["models"]["solid"]["convergence"]["levels"][0]["quantities"]["C_zz"] == 1.0
    assert new["attachments"]["solid"]["rigid"]["quantities"]["bending 1"] == 3.0
    assert new["causes"][0]["quantities"] == {"C_zz": 1.0, "K_zz": None, "bending 1": 2.0}
    assert new["lumped"]["solid"]["frequency_hz"] == 5.0
    assert renamed(new) == new


def test_what_is_only_there_now_is_no_loss():
    assert not lost(differences(RECORD, RECORD | {"more": 1}, 1e-12))
    assert lost(differences(RECORD | {"more": 1}, RECORD, 1e-12))
