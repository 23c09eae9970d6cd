"""Files to begin with, and what the command line says of itself."""

import io
import json
import os
import sys
import tomllib
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.app import files
from solidgear.app.starts import SHAFTS, STARTS, start
from solidgear.core.errors import SolidgearError
from solidgear.core.ladder.registry import LADDER
from solidgear.core.scene.file import load
from solidgear.strength.deflection.at_rest import deflection
from solidgear.trains.assembly.assembly import Assembly
from tests.command import command

ROOT = Path(__file__).parent.parent


@pytest.mark.parametrize("folder", [".", "..", "/"])
def test_a_folder_is_no_name_for_a_new_file(folder):
    done = command("new", folder)
    assert done.exit_code == 1 and "is a folder; give the name of a file" in str(done.exception)


@pytest.mark.parametrize("kind", [kind for kind in STARTS if kind not in SHAFTS])
def test_a_new_scene_runs(kind, tmp_path):
    done = command("new", tmp_path / "deep" / "my fan 2", "--kind", kind)
    assert done.exit_code == 0 and "solidgear check" in done.stdout
    scene = sg.load(tmp_path / "deep" / "my fan 2.toml")
    assert scene.title == "my fan 2"
    found = sg.answer(scene, ask="bending")
    assert found.reached and found.values[0].value > 100


@pytest.mark.parametrize("kind", SHAFTS)
def test_a_new_train_runs_and_its_shafts_do(kind, tmp_path):
    done = command("new", tmp_path / "my box", "--kind", kind)
    assert done.exit_code == 0 and len(list(tmp_path.iterdir())) == 3
    assert len(start(kind, "my box")) == 3
    train = sg.load_train(tmp_path / "my box.toml")
    assert train.title == "my box" and not Assembly(train).cautions()
    found = deflection(Assembly(train), train.operation[0], "timoshenko", "timoshenko")
    assert found.mesh_forces["mesh"] > 1000 and not found.notes
    again = command("new", tmp_path / "my box", "--kind", kind)
    assert "there is such a file already" in str(again.exception)


def test_a_new_scene_is_never_written_over_another(tmp_path):
    (tmp_path / "a.toml").write_text("mine")
    done = command("new", tmp_path / "a")
    assert isinstance(done.exception, SolidgearError)
    assert "there is such a file already" in str(done.exception)
    assert (tmp_path / "a.toml").read_text() == "mine"


@pytest.mark.parametrize(
    "kind, name, words",
    [
        ("overhang", "a", 'kind "overhang" is unknown; did you mean "overhung"?'),
        ("rotor", 'a"\nb', "use letters, digits"),
        ("rotor", " ", "use letters, digits"),
    ],
)
def test_no_scene_of_another_kind_or_name(kind, name, words):
    with pytest.raises(SolidgearError) as told:
        start(kind, name)
    assert words in str(told.value)


def test_shipped_scenes_are_copied_with_what_they_refer_to(tmp_path):
    listed = command("scenes")
    assert "pinion_overhung" in listed.stdout and "Overhung pinion on two" in listed.stdout
    done = command("scenes", "axle_overhung", "--to", tmp_path / "new")
    assert done.exit_code == 0
    assert sg.load_train(tmp_path / "new" / "axle_overhung.toml").pinion.teeth == 14
    again = command("scenes", "gear_shaft", "--to", tmp_path / "new")
    assert "there is such a file already" in str(again.exception)
    wrong = command("scenes", "gearshaft")
    assert 'did you mean "gear_shaft"?' in str(wrong.exception)


def test_the_wheel_holds_the_scenes():
    """The scenes of an installed wheel are found by its list of files; both lists are of one
    folder.
    """
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    target, patterns = next(iter(settings["data-files"].items()))
    assert f"{target}/" == files.SHARED
    packed = {path for pattern in patterns for path in ROOT.glob(pattern)}
    assert set(files.shipped().values()) <= packed
    assert all(set(files.needed(path)) <= packed for path in files.shipped().values())


def test_a_scene_from_standard_input(monkeypatch):
    text = (ROOT / "geometry" / "cylinder_free.toml").read_bytes()
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text)))
    assert load("-").name == "scene"
    spoilt = text.replace(b"nu = ", b"nu = 3")
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(spoilt)))
    with pytest.raises(SolidgearError, match="standard input: material.nu"):
        load("-")


def test_version_quiet_and_exit_codes(tmp_path):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert command("--version").stdout == f"solidgear {project['version']}\n"
    assert "3 the tolerance is not reached" in command("--help").stdout.replace("\n ", "")
    scene = ROOT / "geometry" / "cylinder_free.toml"
    loud = command("answer", scene, "--ask", "bending")
    still = command("--quiet", "answer", scene, "--ask", "bending", "--json")
    assert "harmonic solid" in loud.stderr and still.stderr == ""
    assert json.loads(still.stdout)["reached"]


def test_every_option_is_listed_with_its_default(monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    said = command("options").stdout
    for name in LADDER.bodies:
        assert f"{name}: {LADDER[name].title}" in said
        for key, option in LADDER[name].options.items():
            assert key in said and option.meaning[:40] in said
    assert "a whole number between 1 and 12" in command("options", "harmonic").stdout


def test_one_version_everywhere():
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert sg.__version__ == version
    assert f"version: {version}\n" in (ROOT / "CITATION.cff").read_text()
    assert f"\n## {version}" in (ROOT / "CHANGELOG.md").read_text()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes among files")
def test_what_is_no_file_is_not_replaced_by_one(tmp_path):
    pipe, folder, link = (tmp_path / name for name in ("pipe.json", "folder.json", "link.json"))
    os.mkfifo(pipe)
    folder.mkdir()
    link.symlink_to("real.json")
    assert "it is a pipe" in str(command("schema", "scene", "--out", pipe).exception)
    for out in (folder, ".", ""):
        assert "Is a directory" in str(command("schema", "scene", "--out", out).exception)
    assert pipe.is_fifo() and folder.is_dir()
    command("schema", "scene", "--out", link)
    assert link.is_symlink() and (tmp_path / "real.json").read_text("utf-8").startswith("{")
    assert not [path for path in tmp_path.iterdir() if path.name.endswith(".part")]
