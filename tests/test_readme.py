"""The README and the page of the package: short, and nothing in them leads nowhere."""

import re
import tomllib
from pathlib import Path

import pytest
import typer.main

import solidgear as sg
from solidgear.core.scene.toml_file import describes_train
from validation.manual import CASES
from validation.mutations import MUTATIONS

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PAGE = (ROOT / PROJECT["readme"]).read_text(encoding="utf-8")
LINK = re.compile(r"\]\(([^)]+)\)")


def fenced(text, kind):
    return re.findall(rf"(?ms)^```{kind}\n(.*?)^```", text)


def test_it_is_read_in_two_minutes():
    assert len(README.splitlines()) <= 120


def test_every_link_and_picture_is_there():
    links = LINK.findall(README)
    assert len(links) > 15
    assert [link for link in links if not (ROOT / link).exists()] == []


def test_the_page_of_a_package_leads_nowhere_else():
    """Beside it there is no folder in which a relative link could be found."""
    assert LINK.findall(PAGE) == [] and "<img" not in PAGE


@pytest.mark.parametrize("text", [README, PAGE], ids=["README", "package"])
def test_commands_that_are_named_exist(text):
    from solidgear.app import app

    known = typer.main.get_command(app).commands
    named = set(re.findall(r"solidgear ([a-z-]+) (?=[\w.]*[A-Z_/\[-]|\w+\.toml)", text))
    assert len(named) >= 4 and named <= set(known)


def test_the_scene_of_the_readme_runs(tmp_path):
    (text,) = fenced(README, "toml")
    assert len(text.splitlines()) <= 12
    (tmp_path / "readme.toml").write_text(text, encoding="utf-8")
    scene = sg.load(tmp_path / "readme.toml")
    found = sg.modes(sg.build(scene, "timoshenko"), scene, n=2)
    # held at both ends against all but turning
    assert found.names[0] == "rigid torsion" and found.frequency_hz[1] > 100


def test_libraries_named_are_those_of_the_container():
    (asked,) = re.findall(r"`apt-get install -y (.*?)`", README)
    container = (ROOT / "Containerfile").read_text(encoding="utf-8").replace("\\\n", " ")
    assert set(asked.split()) <= set(container.split())
    assert f"apt-get install -y {asked}" in (ROOT / "docs/guide/install.md").read_text()


def test_python_of_the_readme_runs(monkeypatch):
    (code,) = fenced(README, "python")
    # the last line is a whole comparison, which other tests make
    light = "\n".join(line for line in code.splitlines() if "sg.compare" not in line)
    monkeypatch.chdir(ROOT)
    exec(compile(light, "README.md", "exec"), {})


@pytest.mark.parametrize("page", ["README.md", "docs/validation/index.md"])
def test_counts_in_prose_are_those_of_the_source(page):
    """A number that somebody typed is one of yesterday."""
    text = (ROOT / page).read_text(encoding="utf-8")
    scenes = [tomllib.loads(p.read_text()) for p in (ROOT / "geometry").glob("*.toml")]
    trains = sum(map(describes_train, scenes))
    counts = {
        r"(\d+) wrong expressions": len(MUTATIONS),
        r"(\d+) problems": len(CASES),
        r"(\d+) scenes and \d+ trains": len(scenes) - trains,
        r"\d+ scenes and (\d+) trains": trains,
    }
    said = {pattern: re.findall(pattern, text) for pattern in counts}
    assert any(said.values())
    assert {p: {str(counts[p])} for p in said if said[p]} == {
        p: set(s) for p, s in said.items() if s
    }
