"""A study is one room and one entry: its numbers, its table and its command.

The room is made up: it lies outside the package, in a folder that the package takes for its own.
"""

import json
import sys
import textwrap

import pytest
from command import command, strict

import solidgear
from solidgear.app.application import COMMANDS, GROUPS, Entry, add_command, app
from solidgear.core import registry
from solidgear.core.scene.closed_form import volume_of
from solidgear.core.scene.outline import Outline

SHAFT = "geometry/shaft_stepped.toml"
ROOM = {
    "__init__.py": '"""Mass of one shaft."""\n',
    "numbers.py": '''
        """Mass and its place along a shaft."""

        from dataclasses import dataclass

        from solidgear.core import Body, Scene, build


        @dataclass(frozen=True)
        class Mass:
            """Mass of a shaft."""

            mass: float  #: kg
            place: float  #: of its centre along the shaft, m


        def mass_of(scene: Scene, model: str) -> Mass:
            """Return the mass of a shaft by a model."""
            matrix = build(scene, model).mass_matrix()
            return Mass(float(matrix[0, 0]), float(matrix[2, 3] / matrix[0, 0]))


        def heavy(scene: Scene, body: Body) -> list[str]:
            """Return what is said beside the numbers of a shaft."""
            return [f"{scene.name} has {body.mass_matrix()[0, 0]:.4g} kg"]
        ''',
    "command.py": '''
        """The command mass."""

        from __future__ import annotations

        from pathlib import Path
        from typing import Annotated

        import typer

        from solidgear.core import Scene, load
        from solidgear.core.plain import plain
        from solidgear.mass.numbers import Mass, mass_of
        from solidgear.show.command import Progress, command
        from solidgear.show.options import SceneFile, Shown
        from solidgear.show.sheet import Sheet, present
        from solidgear.show.table import Table, quantity, word
        from solidgear.show.units import Units, units_named


        @command
        def mass(
            scene: SceneFile,
            *,
            model: Annotated[str, typer.Option("--model", help="Model of the shaft.")] = "euler",
            out: Annotated[Path | None, typer.Option("--out", help="Folder for a page.")] = None,
            run: Shown,
        ) -> None:
            shaft, units = load(scene), units_named(run.units)

            def study(progress: Progress) -> Sheet:
                return mass_sheet(shaft, mass_of(shaft, model), units)

            present(study, run, out)


        def mass_sheet(shaft: Scene, mass: Mass, units: Units) -> Sheet:
            """Return what is shown of the mass of a shaft."""
            columns = [
                word("shaft"),
                quantity("mass", "kg", units),
                quantity("centre", "m", units),
            ]
            table = Table("", columns, [[shaft.name, mass.mass, mass.place]])
            return Sheet(
                name="mass",
                title=f"Mass of {shaft.name}",
                lead="",
                tables=[table],
                data={"shaft": shaft.name, **plain(mass)},
                lines={"mass": table},
            )
        ''',
}


@pytest.fixture
def room(tmp_path, monkeypatch):
    folder = tmp_path / "mass"
    folder.mkdir()
    for name, text in ROOM.items():
        (folder / name).write_text(textwrap.dedent(text).lstrip(), encoding="utf-8")
    monkeypatch.setattr(solidgear, "__path__", [*solidgear.__path__, str(tmp_path)])
    entry = Entry("mass.command", "Mass of a shaft and where it is.")
    monkeypatch.setattr(app, "registered_commands", [*app.registered_commands])
    for table in (COMMANDS, GROUPS["One shaft"]):
        monkeypatch.setitem(table, "mass", entry)  # taken away with the test
    monkeypatch.setattr(registry, "_PLACES", {**registry._PLACES})
    add_command("One shaft", "mass", entry)
    yield tmp_path
    for name in [name for name in sys.modules if name.startswith("solidgear.mass")]:
        del sys.modules[name]


def test_its_command_prints_a_table_and_json(room):
    printed = command("mass", SHAFT).stdout
    assert "shaft_stepped" in printed and "mass, kg" in printed and "centre, mm" in printed
    told = strict(command("mass", SHAFT, "--json").stdout)
    shaft = solidgear.load(SHAFT)
    steel = shaft.material.density * volume_of(Outline(shaft.segments))
    assert told["mass"] == pytest.approx(steel, rel=1e-9)
    assert 0 < told["place"] < shaft.length
    assert "centre, in" in command("mass", SHAFT, "--units", "us").stdout


def test_its_page_needs_no_line_elsewhere(room):
    done = command("mass", SHAFT, "--out", room / "out")
    assert done.exit_code == 0, done.output
    assert {path.name for path in (room / "out").iterdir()} == {
        "mass.html",
        "mass.json",
        "mass.csv",
    }
    page = (room / "out" / "mass.html").read_text(encoding="utf-8")
    assert "Mass of shaft_stepped" in page and "http://" not in page.replace(
        "http://www.w3.org", ""
    )
    assert json.loads((room / "out" / "mass.json").read_text())["shaft"] == "shaft_stepped"


def test_it_stands_in_the_help(room):
    panel = command("--help").stdout.partition("─ One shaft ─")[2].partition("╭─")[0]
    assert "mass" in panel and "Mass of a shaft and where it is." in panel
    assert "Model of the shaft." in command("mass", "--help").stdout


def test_what_it_adds_to_the_core_is_asked_for_by_kind(room):
    registry.register("made-up remark", "mass", "solidgear.mass.numbers:heavy")
    shaft = solidgear.load(SHAFT)
    (sentence,) = registry.addition("made-up remark", "mass")(
        shaft, solidgear.build(shaft, "euler")
    )
    assert sentence.startswith("shaft_stepped has ")


def test_a_room_that_is_not_there_adds_nothing(room):
    registry.register("made-up remark", "gone", "solidgear.gone.numbers:heavy")
    assert registry.added("made-up remark") == {}
