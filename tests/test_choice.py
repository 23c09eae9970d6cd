"""What judges automatic choice sees an answer that is wrong and a bar that is too short."""

from types import SimpleNamespace

import pytest

from solidgear.studies.climb import Value
from validation.choice import Tally, judge, main

TRUTH = SimpleNamespace(values={"C_zz": 2.0e-9, "C_thx": 1e-7}, uncertainty={"C_zz": 1e-6})


def answered(value, bar, reached=True):
    row = Value("C_zz", value, "m/N", bar, "2 meshes")
    return SimpleNamespace(values=(row,), reached=reached)


@pytest.mark.parametrize(
    ("value", "bar", "wrong", "short"),
    [
        (2.001e-9, 1e-3, 0, 0),  # 5e-4 off, within both
        (2.001e-9, 4e-4, 0, 1),  # beyond its bar
        (2.01e-9, 4e-3, 1, 1),  # 5e-3 off: beyond the tolerance as well
        (2.01e-9, 6e-3, 1, 0),
    ],
)
def test_errors_beyond_bar_and_tolerance_are_counted(value, bar, wrong, short):
    tally = Tally()
    judge(1, 1e-3, answered(value, bar), TRUTH, tally)
    assert (len(tally.wrong), len(tally.short), tally.numbers) == (wrong, short, 1)


def test_what_was_not_reached_is_not_called_wrong():
    tally = Tally()
    judge(1, 1e-3, answered(2.01e-9, 6e-3, reached=False), TRUTH, tally)
    assert not tally.wrong


@pytest.mark.slow
def test_two_random_scenes(tmp_path):
    # bars hold in 98 % of numbers; of some fifty here none should be beyond the tolerance
    out = tmp_path / "choice.md"
    assert main(["--scenes", "2", "--seed", "3", "--tolerance", "0.01", "--out", str(out)]) == 0
    assert "0 of" in out.read_text()
