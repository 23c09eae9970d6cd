"""CONTRIBUTING names what is there, in two screens."""

import re
from pathlib import Path

import pytest

from validation.house.floors import BASE, ROOMS

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
PATHS = sorted({p for p in re.findall(r"`([^`\s]+)[^`]*`", TEXT) if "/" in p})


@pytest.mark.parametrize("path", PATHS)
def test_a_path_is_there(path):
    assert (ROOT / path).exists()


def test_names_of_tables_stand_in_the_files_named_beside_them():
    named = re.findall(r"`([A-Z_]{4,})`[^`]* of\s+`([^`]+\.py)`", TEXT)
    assert ("SHARES", "solidgear/bearings/kinds.py") in named
    missing = [(name, path) for name, path in named if name not in (ROOT / path).read_text()]
    assert missing == []


def test_modules_that_it_runs_are_there():
    for module in re.findall(r"python -m (validation\.\w+)", TEXT):
        place = ROOT.joinpath(*module.split("."))
        assert place.with_suffix(".py").exists() or (place / "__main__.py").exists(), module


def test_the_picture_has_every_room_in_its_order():
    picture = re.search(r"```\n(.*?)```", TEXT, re.S)[1]
    rooms = re.findall(r"^ +(\w+)/  ", picture, re.M)
    assert rooms == [*reversed((*BASE, *ROOMS)), "core"]


def test_it_fits_on_two_screens():
    assert len(TEXT.splitlines()) <= 110 and len(TEXT.split()) < 1100
