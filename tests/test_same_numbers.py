"""What tells whether two states of the source give the same numbers sees every kind of change."""

import pytest

from validation.same_numbers import differences, lost

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


def test_what_is_only_there_now_is_no_loss():
    assert not lost(differences(RECORD, RECORD | {"more": 1}, 1e-12))
    assert lost(differences(RECORD | {"more": 1}, RECORD, 1e-12))
