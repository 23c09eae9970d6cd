"""The mutation check of the suite: its list still fits the source (fast), and every mutation is
caught (slow).
"""

from pathlib import Path

import pytest

from validation.mutations import MUTATIONS, Mutation, caught, healthy, place

ROOT = Path(__file__).parent.parent

IDS = [m.name.replace(" ", "_") for m in MUTATIONS]


def test_there_are_enough_and_each_has_its_own_line():
    assert len(MUTATIONS) >= 20
    assert len({(m.file, m.where, m.old, m.new) for m in MUTATIONS}) == len(MUTATIONS)


def test_every_mutation_still_applies():
    """A mutation whose expression has gone from the source would be reported as caught by nobody."""
    for mutation in MUTATIONS:
        first, last = place(mutation, (ROOT / mutation.file).read_text())  # raises ValueError
        assert first < last, mutation.name
        path, _, name = mutation.test.partition("::")
        assert f"def {name.partition('[')[0]}(" in (ROOT / path).read_text(), mutation.name


def test_layout_does_not_matter():
    mutation = Mutation("", "", "Beam.bend", "a * (b + c)", "a * b", "")
    text = "class Beam:\n    def bend(self):\n        é = 1; return f(a * (\n            b + c))  # here\n"
    first, last = place(mutation, text)
    assert text[:first] + mutation.new + text[last:] == text.replace(
        "a * (\n            b + c)", "a * b"
    )


@pytest.mark.parametrize(
    "where, old", [("bend", "a + b"), ("other", "a * b"), ("bend", "a"), ("Beam.bend", "a * b")]
)
def test_what_is_not_there_exactly_once_is_refused(where, old):
    text = "def bend():\n    return a * b + a\n"
    with pytest.raises(ValueError):
        place(Mutation("", "", where, old, "", ""), text)


@pytest.mark.slow
@pytest.mark.parametrize("mutation", MUTATIONS, ids=IDS)
def test_mutation_is_caught(mutation):
    assert caught(mutation)


@pytest.mark.slow
def test_an_unchanged_copy_passes():
    assert healthy("tests/test_frames.py")
