"""Notebooks run, and still show what is stored in them."""

import json
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "docs" / "tools"))

import notebooks  # noqa: E402

FOLDER = ROOT / "examples" / "notebooks"
#: compares all models, refined until the solid can judge: some ten seconds
MARKS = dict.fromkeys(("compare", "tutorial", "tap_test"), pytest.mark.slow)
MARKS["bearings_and_systems"] = pytest.mark.long
NAMES = sorted(p.stem for p in FOLDER.glob("*.ipynb"))


def test_there_are_four():
    assert NAMES == ["bearings_and_systems", "compare", "tap_test", "tutorial"]


@pytest.mark.parametrize("name", [pytest.param(n, marks=MARKS.get(n, ())) for n in NAMES])
def test_a_notebook_shows_what_it_computes(name):
    assert notebooks.check(FOLDER / f"{name}.ipynb") == []


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_is_executed_small_and_of_the_format(name):
    path = FOLDER / f"{name}.ipynb"
    book = notebooks.read(path)
    assert (book["nbformat"], book["nbformat_minor"]) == (4, 5)
    cells = notebooks.code_cells(book)
    # in order, each run once: what a reader sees comes from what stands above it
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1))
    assert len({cell["id"] for cell in book["cells"]}) == len(book["cells"])
    assert not any(o["output_type"] == "error" for cell in cells for o in cell["outputs"])
    assert sum(map(notebooks.pictures, (cell["outputs"] for cell in cells))) > 0
    assert path.stat().st_size < 100e3
    assert not any("from solidgear." in "".join(cell["source"]) for cell in cells)


def book(*sources):
    cells = [
        {"cell_type": "code", "source": [s], "outputs": [], "execution_count": None}
        for s in sources
    ]
    return {"cells": cells, "nbformat": 4, "nbformat_minor": 5}


@pytest.fixture
def stored(tmp_path):
    path = tmp_path / "small.ipynb"
    path.write_text(json.dumps(book("a = 2.0\nprint('first', a)", "a * 3")))
    notebooks.write(path)
    return path


def test_cells_share_names_print_and_show_their_last_value(stored):
    first, second = notebooks.code_cells(notebooks.read(stored))
    assert notebooks.shown(first["outputs"]) == "first 2.0\n"
    assert notebooks.shown(second["outputs"]) == "6.0"
    assert notebooks.check(stored) == []


@pytest.mark.parametrize(
    "old, new, told", [("* 3", "* 4", "cell 2"), ("'first'", "'other'", "cell 1")]
)
def test_what_is_no_longer_shown_is_told(stored, old, new, told):
    stored.write_text(stored.read_text().replace(old, new))
    (found,) = notebooks.check(stored)
    assert told in found


def test_a_cell_that_fails_is_named(stored):
    stored.write_text(stored.read_text().replace("a * 3", "a * b"))
    with pytest.raises(NameError) as caught:
        notebooks.check(stored)
    assert "cell 2" in caught.value.__notes__[0]
