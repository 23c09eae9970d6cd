"""Tests of one room: `--room NAME` keeps the files that import it, and the house."""

import pytest
from by_room import TESTS, belongs, is_room


@pytest.mark.parametrize(
    "name, room, kept",
    [
        ("test_measured.py", "measured", True),
        ("test_beam.py", "measured", False),
        ("test_beam.py", "core.models", True),
        ("test_house.py", "petsc", True),
        # `load_train` is handed out by the package
        ("test_gear_bodies.py", "trains", True),
        # by a helper beside it, tests/command.py
        ("test_cli_help.py", "app", True),
        ("test_measured.py", "meas", False),
    ],
)
def test_a_file_belongs_to_the_rooms_that_it_imports(name, room, kept):
    assert (TESTS / name).exists()
    assert belongs(TESTS / name, room) is kept


def test_every_room_of_features_has_tests():
    from validation.house.floors import BASE, ROOMS

    files = [path for path in TESTS.glob("test_*.py") if path.name != "test_house.py"]
    assert [room for room in (*BASE, *ROOMS) if not any(belongs(f, room) for f in files)] == []


@pytest.mark.long
def test_a_run_of_one_room_reads_its_files_alone(listing):
    listed = listing("--room", "petsc")
    assert {line.partition("::")[0] for line in listed.splitlines() if "::" in line} == {
        "tests/test_house.py",
        "tests/test_petsc.py",
    }
    assert "solidgear has no such room" in listing("--room", "petrol")
    assert is_room("core.judge") and not is_room("petrol")


@pytest.fixture
def listing():
    import subprocess
    import sys

    def run(*words):
        line = [sys.executable, "-m", "pytest", "-n", "0", "--collect-only", *words]
        done = subprocess.run(line, capture_output=True, text=True, timeout=120, cwd=TESTS.parent)
        return done.stdout + done.stderr

    return run
