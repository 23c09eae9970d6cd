"""What the command line makes of inputs: every problem of a scene, bounds before anything is
solved, and nothing that fills the screen.
"""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated

import pytest
import typer
from typer.main import get_command
from typer.testing import CliRunner

from solidgear.app import app
from solidgear.show.command import command
from solidgear.show.options import Run
from solidgear.trains.options import Reduced

SCENE = Path(__file__).parents[1] / "geometry" / "pinion_overhung.toml"


@pytest.mark.parametrize(
    "command",
    [
        ["stiffness"],
        ["modes"],
        ["check"],
        ["render"],
        ["compare", "--out", "out"],
        ["chart", "--out", "out"],
        ["sweep", "--vary", "bearing.1.scale=1,2"],
    ],
)
def test_every_problem_by_every_command(run, tmp_path, command):
    text = SCENE.read_text(encoding="utf-8")
    (tmp_path / "bad.toml").write_text(
        text.replace('diameter = "90 mm"', 'diameter = "-90 mm"')
        .replace("nu = 0.3 ", "nu = 3 ")
        .replace("modes = 10", "modes = 10000"),
        encoding="utf-8",
    )
    code, out, err = run(command[0], "bad.toml", *command[1:])
    lines = err.splitlines()
    assert (
        code == 1
        and out == ""
        and len(lines) == 4
        and lines[0] == "solidgear: 3 problems in bad.toml"
    )
    for field, line in zip(
        ("material.nu = 3: ", 'segment[2] "shaft".diameter = "-90 mm": ', "ask.modes = 10000: "),
        lines[1:],
    ):
        assert line.startswith(f"  bad.toml: {field}")
    assert [path.name for path in tmp_path.iterdir()] == ["bad.toml"]


REFUSED = {
    "modes without end": (["modes", SCENE, "-n", "1000000000"], "give 1 to 500"),
    "an argument for an option": (
        ["stiffness", SCENE, "-f", "harmonic", "--set", "scene=1"],
        'no such option as "scene"',
    ),
    "an option twice": (
        ["stiffness", SCENE, "--set", "order=2", "--set", "order=3"],
        "order is set twice",
    ),
    "a file name of a page": (["stiffness", "x" * 5000], "File name too long"),
    "an option of a page": (
        ["stiffness", SCENE, "--set", "element=" + "x" * 5000, "-f", "solid"],
        "element",
    ),
    "a model of a page": (["compare", SCENE, "--models", "x" * 5000], "models"),
    "a bell": (["stiffness", SCENE, "--attachment", "\x07\x1b[2J"], "\\u0007"),
    "an option that no sweep knows": (
        ["sweep", SCENE, "-f", "euler", "--vary", "bearing.1.scale=1,2", "--set", "order=3"],
        "no such option",
    ),
    "a sweep that will not fit": (
        ["sweep", SCENE, "-f", "solid", "--vary", "bearing.1.scale=1,2", "--set", "refinement=9"],
        "lower refinement",
    ),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_refused_in_a_line_that_fits_the_screen(run, tmp_path, monkeypatch, kind):
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "2000")
    arguments, says = REFUSED[kind]
    code, out, err = run(*arguments)
    assert code == 1 and out == "" and err.startswith("solidgear: ") and err.count("\n") == 1
    assert says in err and len(err) < 1100 and err[:-1].isprintable()
    assert list(tmp_path.iterdir()) == []


#: commands that tell no numbers of their own
SILENT = {"new", "scenes", "options", "render", "schema", "import"}
TRAINS = {"system-modes", "response", "receptance", "judge-system", "nonlinear"}


def test_what_commands_share_all_of_them_take():
    door = get_command(app)
    commands = {name: door.resolve_command(None, [name])[1] for name in door.commands}
    options = {
        name: {parameter.name for parameter in command.params} for name, command in commands.items()
    }
    for group, without in ((Run, SILENT), (Reduced, set(commands) - TRAINS)):
        shared = {field.name for field in fields(group)}
        assert shared and all(shared <= options[name] for name in set(commands) - without)


def test_a_field_more_is_an_option_more():
    @dataclass(frozen=True)
    class More(Run):
        colour: Annotated[str, typer.Option("--colour")] = "red"

    told = []

    def paint(scene: str, *, run: More) -> None:
        told.append((scene, run))

    alone = typer.Typer()
    alone.command()(command(paint))
    assert CliRunner().invoke(alone, ["one", "--colour", "blue", "--json"]).exit_code == 0
    assert told == [("one", More(as_json=True, colour="blue"))]
