"""The mutation check of the suite: its list still fits the source (fast), and every mutation is caught (slow)."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "validation"))

from mutations import MUTATIONS, caught, healthy  # noqa: E402

IDS = [m.name.replace(" ", "_") for m in MUTATIONS]


def test_there_are_enough_and_each_has_its_own_line():
    assert len(MUTATIONS) >= 20
    assert len({(m.file, m.old, m.new) for m in MUTATIONS}) == len(MUTATIONS)


@pytest.mark.parametrize("mutation", MUTATIONS, ids=IDS)
def test_mutation_still_applies(mutation):
    """A mutation whose text has gone from the source would be reported as caught by nobody."""
    assert (ROOT / mutation.file).read_text().count(mutation.old) == 1
    path, _, name = mutation.test.partition("::")
    assert f"def {name.partition('[')[0]}(" in (ROOT / path).read_text()


@pytest.mark.slow
@pytest.mark.parametrize("mutation", MUTATIONS, ids=IDS)
def test_mutation_is_caught(mutation):
    assert caught(mutation)


@pytest.mark.slow
def test_an_unchanged_copy_passes():
    assert healthy("tests/test_frames.py")
