"""The base with no room beside it, and each room with those that it stands on: equal numbers and files,
and a sentence that names the room which is not there.
"""

import functools
import json
import operator
import re
import shutil
import subprocess
import sys

import pytest

from tests.by_room import PACKAGE
from tests.test_house import read_graph
from validation.house.floors import BASE, ROOMS, room_of

ROOT = PACKAGE.parent
SHAFT, OVERHUNG = "geometry/shaft_stepped.toml", "geometry/pinion_overhung.toml"
#: runs commands one after the other in one process; an installation of the package is kept out
RUN = """
import contextlib, io, json, sys
sys.meta_path[:] = [f for f in sys.meta_path if "editable" not in repr(f).lower()]
sys.path.insert(0, sys.argv[1])
import solidgear.app
from solidgear.app.application import app
from solidgear.core import SolidgearError
told = []
for words in json.loads(sys.argv[2]):
    out, err, code = io.StringIO(), io.StringIO(), 0
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = app(words, standalone_mode=False) or 0
        except SolidgearError as error:
            print(f"solidgear: {error}", file=sys.stderr)
            code = 1
        except SystemExit as end:
            code = end.code or 0
    told.append([code, out.getvalue(), err.getvalue()])
print(json.dumps(told))
"""
#: what differs from run to run
OF_A_RUN = ("seconds", "_mb", "date", "environment", "cost", "time")


def copied(folder, rooms):
    """Copy the base with some rooms and the scenes into a folder."""
    kept = {"core", *BASE, *rooms}
    package = folder / "solidgear"
    package.mkdir(parents=True)
    for path in PACKAGE.iterdir():
        if path.is_file():
            shutil.copy(path, package)
        elif path.name in kept:
            shutil.copytree(path, package / path.name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "geometry", folder / "geometry")
    return folder


def told_by(folder, commands):
    """Return exit code, output and errors of commands that are run in a folder."""
    line = [sys.executable, "-c", RUN, str(folder), json.dumps(commands)]
    run = subprocess.run(line, capture_output=True, text=True, timeout=900, cwd=folder)
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def without_cost(data):
    """Return plain data without times, memory and dates."""
    if isinstance(data, dict):
        return {
            key: without_cost(value)
            for key, value in data.items()
            if not any(word in key for word in OF_A_RUN)
        }
    if isinstance(data, str):
        return re.sub(r"\d+(\.\d+)? (ms|s|MB)\b", "", data)
    return [without_cost(value) for value in data] if isinstance(data, list) else data


def same_words(text):
    """Return what a command prints without times and memory."""
    try:
        return without_cost(json.loads(text))
    except ValueError:
        return without_cost(text)


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The base alone."""
    return copied(tmp_path_factory.mktemp("alone"), ())


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The base with all rooms."""
    return copied(tmp_path_factory.mktemp("whole"), ROOMS)


#: of the base, on shafts that need no room
COMMANDS = [
    ["new", "mine.toml"],
    ["scenes"],
    ["check", SHAFT, "--json"],
    ["answer", SHAFT, "--json"],
    ["stiffness", OVERHUNG, "-f", "timoshenko", "--json"],
    ["stiffness", SHAFT, "--json"],
    ["modes", SHAFT, "--json"],
    [*"compare --out out --models lumped,timoshenko,harmonic --no-renders --json".split(), SHAFT],
    ["options", "harmonic"],
    ["schema", "scene"],
    ["schema", "--help"],
    ["--help"],
]
WITH_PICTURES = [
    ["compare", OVERHUNG, "--out", "out"],
    ["render", OVERHUNG, "--out", "mode.png"],
    ["chart", SHAFT, "--out", "chart", "--budget", "1", "--runs", "1"],
]


def equal_files(alone, whole):
    """Whether two folders hold the same files, pages and times apart."""
    names = [
        sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
        for folder in (alone, whole)
    ]
    # a chart is of times
    names = [[n for n in of if not n.startswith(("solidgear/", "chart/"))] for of in names]
    assert names[0] == names[1]
    for name in names[0]:
        one, other = (folder / name for folder in (alone, whole))
        if name.endswith(".json"):
            assert without_cost(json.loads(one.read_text())) == without_cost(
                json.loads(other.read_text())
            ), name
        elif name.endswith((".png", ".vtu", ".toml", ".step")):
            # a new scene names the schema that lies beside the program
            contents = (
                path.read_bytes().replace(str(folder).encode(), b"")
                for path, folder in ((one, alone), (other, whole))
            )
            assert operator.eq(*contents), name
    return names[0]


def test_the_base_alone_tells_what_the_whole_tells(alone, whole):
    for words, one, other in zip(COMMANDS, told_by(alone, COMMANDS), told_by(whole, COMMANDS)):
        one, other = ([code, same_words(out), same_words(err)] for code, out, err in (one, other))
        assert one == other, words
        assert one[0] == 0, (words, one)
    assert "out/report.html" in equal_files(alone, whole)


@pytest.mark.long
def test_pictures_and_charts_of_the_base_alone_are_those_of_the_whole(tmp_path):
    alone, whole = copied(tmp_path / "alone", ()), copied(tmp_path / "whole", ROOMS)
    for words, *codes in zip(
        WITH_PICTURES,
        *([code for code, *_ in told_by(f, WITH_PICTURES)] for f in (alone, whole)),
    ):
        assert codes == [0, 0], words
    names = equal_files(alone, whole)
    assert "mode.png" in names and any(name.endswith(".vtu") for name in names)


#: commands and keys of rooms, and the room that the refusal names
REFUSED = {
    ("bearing", SHAFT): "trains",
    ("contact", "geometry/gearbox_train.toml"): "teeth",
    ("deflect", SHAFT): "strength",
    ("import", "a.rexs", "--out", "a"): "exchange",
    ("sweep", SHAFT, "--vary", "bearing.1.scale=0.5,1"): "variants",
    ("correlate", SHAFT): "measured",
    ("nonlinear", "geometry/gearbox_train.toml"): "backlash",
    ("sheet", SHAFT): "datasheet",
    ("compare", SHAFT, OVERHUNG): "two_designs",
    ("compare", "geometry/gearbox_train.toml"): "trains",
    ("check", "geometry/gearbox_train.toml"): "trains",
    ("compare", SHAFT, "--sheet", "en"): "datasheet",
    ("answer", "geometry/pinion_keyed.toml"): "cuts",
    ("answer", "geometry/gearbox_catalogue.toml"): "bearings",
    ("answer", "geometry/shaft_step.toml"): "parts",
    ("schema", "--json", "deflect"): "strength",
}


def test_what_needs_a_room_says_which(alone):
    commands = [list(words) for words in REFUSED]
    for (words, room), (code, _, errors) in zip(REFUSED.items(), told_by(alone, commands)):
        assert code == 1, (words, errors)
        assert f"needs the room '{room}'" in errors, (words, errors)


@functools.cache
def stands_on():
    """Return the rooms that a room imports, and those that they do."""
    below = {room: set() for room in ROOMS}
    for module, targets in read_graph().items():
        if (room := room_of(module)) in below:
            below[room] |= {room_of(target) for target in targets} & set(ROOMS) - {room}
    for room in ROOMS:  # from the ground up
        below[room] |= {lower for near in below[room] for lower in below[near]}
    return below


TRAIN = "geometry/gearbox_train.toml"
#: a command of a room
FIRST = {
    "petsc": ["options", "solid"],
    "parts": ["check", "geometry/shaft_step.toml"],
    "cuts": ["check", "geometry/pinion_keyed.toml"],
    "bearings": ["modes", "geometry/gearbox_catalogue.toml", "-f", "timoshenko"],
    "trains": ["system-modes", TRAIN, "--pinion", "timoshenko", "--gear", "timoshenko"],
    "strength": ["deflect", "geometry/countershaft.toml", "-f", "timoshenko"],
    "teeth": ["contact", TRAIN, "--no-curve"],
    "exchange": ["export", SHAFT, "-f", "timoshenko", "--out", "m.npz"],
    "variants": [
        "sweep",
        SHAFT,
        "-f",
        "timoshenko",
        "--vary",
        "bearing.1.scale=0.5,1",
        "--out",
        "s.csv",
    ],
    "measured": ["correlate", SHAFT, "measured.csv", "--out", "correlated"],
    "backlash": ["nonlinear", "--help"],
    "datasheet": ["sheet", SHAFT, "--out", "sheet.html"],
    "two_designs": ["compare", SHAFT, OVERHUNG, "--out", "two"],
}


@pytest.mark.long
@pytest.mark.parametrize("room", ROOMS)
def test_a_room_runs_beside_the_base_and_what_it_stands_on(tmp_path, room):
    folder = copied(tmp_path, {room, *stands_on()[room]})
    (folder / "measured.csv").write_text("frequency [Hz]\n1500\n")
    everything = [
        f"solidgear.{'.'.join(path.relative_to(folder / 'solidgear').with_suffix('').parts)}"
        for path in sorted((folder / "solidgear" / room).rglob("*.py"))
        if path.stem != "__init__" and room != "petsc"  # which needs another library
    ]
    imports = RUN.partition("import solidgear.app")[0] + "\n".join(
        f"import {m}" for m in everything
    )
    line = [sys.executable, "-c", imports, str(folder)]
    run = subprocess.run(line, capture_output=True, text=True, cwd=folder, timeout=300)
    assert run.returncode == 0, run.stderr
    ((code, _, errors),) = told_by(folder, [FIRST[room]])
    assert code in (0, 3), errors
