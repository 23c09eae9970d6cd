"""Files that scenes and trains write: what has not changed stays as a person wrote it."""

import tomllib
from difflib import ndiff
from pathlib import Path

import pytest
import strategies
from hypothesis import given, settings

import solidgear as sg

GEOMETRY = Path(__file__).parents[1] / "geometry"
SHIPPED = sorted(path.stem for path in GEOMETRY.glob("*.toml"))
LISTED = """bearings = "own.csv"
material = "steel"
segment = [{ name = "rod", kind = "cylinder", length = "200 mm", diameter = "42 mm" }]
bearing = [
    { name = "A", position = "20 mm", catalogue = { designation = "MX-4711" } },
    { name = "B", position = "180 mm", catalogue = { designation = "MX-4711" } },
]
port = { at = "rod.middle", attach_to = "rod" }
load = { z = "1 kN" }
"""


def changed_lines(before: str, after: str) -> list[str]:
    """Lines that went and lines that came."""
    lines = ndiff(before.splitlines(), after.splitlines())
    return [line for line in lines if line[:1] in "+-"]


@pytest.mark.parametrize("name", ["pinion_overhung", "pinion_filleted", "gearbox_catalogue"])
def test_a_scene_that_was_read_writes_its_text(name, tmp_path):
    path = GEOMETRY / f"{name}.toml"
    scene = sg.load(path)
    text = scene.to_toml(tmp_path / f"{name}.toml")
    assert text == path.read_text(encoding="utf-8")
    assert changed_lines(text, scene.to_toml()) == [f'+ name = "{name}"']
    for copy in (tmp_path / f"{name}.toml", tmp_path / "other.toml"):
        scene.to_toml(copy)
        assert sg.load(copy) == scene
    made = sg.Scene.from_dict(scene.to_dict())  # remembers no text
    made.to_toml(copy)
    assert sg.load(copy) == scene


def test_changed_entries_alone_are_written_in_their_units():
    path = GEOMETRY / "pinion_overhung.toml"
    scene = sg.load(path)
    bearing = scene.bearings[0].with_changes(y=scene.bearings[0].y + 2e-3, scale=2.0)
    changed = scene.with_changes(
        bearings=(bearing, *scene.bearings[1:]),
        material=scene.material.with_changes(E="205 GPa"),
        title="Softer",
    )
    after = changed.to_toml()
    assert changed_lines(scene.to_toml(), after) == [
        '- title = "Overhung pinion on two bearings"',
        '+ title = "Softer"',
        '- E = "207 GPa"                   # Table 1: 2.07e11',
        '+ E = "205 GPa"                   # Table 1: 2.07e11',
        '- position = "28 mm"              # Table 1: D = 0.028 behind the pinion\'s back face',
        '+ position = "30 mm"              # Table 1: D = 0.028 behind the pinion\'s back face',
        "+ scale = 2.0",
        '- position = "150 mm"             # Table 1: L = 0.150 behind bearing 1',
        '+ position = "148 mm"             # Table 1: L = 0.150 behind bearing 1',
    ]
    assert sg.Scene.from_dict(tomllib.loads(after), GEOMETRY, "pinion_overhung") == changed


@pytest.mark.parametrize(
    "change",
    [
        lambda s: s.with_attachment("rigid"),
        lambda s: s.with_changes(bearings=s.bearings[1:]),
        lambda s: s.with_bearing_scale(3.0),
        lambda s: s.with_seat_width("15 mm"),
        lambda s: s.with_port(y=0.03, lo=0.0, hi=0.02),
        lambda s: s.with_changes(segments=[s.segments[0].with_changes(name="x"), *s.segments[1:]]),
        lambda s: s.with_material(density=7000),
    ],
)
@pytest.mark.parametrize("name", ["shaft_stepped", "pinion_filleted"])
def test_what_a_file_cannot_say_in_its_words_is_written_anew(name, change):
    path = GEOMETRY / f"{name}.toml"
    changed = change(sg.load(path))
    tables = tomllib.loads(changed.to_toml())
    assert sg.Scene.from_dict(tables, GEOMETRY, name) == changed


@settings(max_examples=10, deadline=None)
@given(strategies.scenes())
def test_the_file_of_any_scene_reads_back_equal(scene):
    assert sg.Scene.from_dict(tomllib.loads(scene.to_toml())) == scene


def test_the_file_of_a_catalogue_bearing_made_in_python_settles_when_it_is_read(tmp_path):
    rod = sg.Segment.cylinder("rod", length=0.3, diameter=0.04)
    seats = [
        sg.Bearing(name=n, position=y, seat_width="18 mm", designation="6208")
        for n, y in (("A", 0.05), ("B", 0.25))
    ]
    scene = sg.Scene.from_parts([rod], bearings=seats, load={"z": "1 kN"}, name="rod")
    for made in (scene, scene.settled):
        assert "settled" not in made.to_toml(tmp_path / "rod.toml")
        assert sg.load(tmp_path / "rod.toml") == scene.settled
    by_hand = scene.settled.with_changes(bearings=[b.scaled(2) for b in scene.settled.bearings])
    assert sg.Scene.from_dict(tomllib.loads(by_hand.to_toml())) == by_hand


def test_a_changed_material_has_its_name_and_bearings_settle_anew():
    path = GEOMETRY / "gearbox_catalogue.toml"
    scene = sg.load(path)
    changed = scene.with_changes(material="42CrMo4")
    text = changed.to_toml()
    new = [line for line in changed_lines(scene.to_toml(), text) if line.startswith("+")]
    assert new == ['+ material = "42CrMo4"']
    read = sg.Scene.from_dict(tomllib.loads(text), GEOMETRY, path.name)
    assert read == changed.settled and read.bearings != scene.bearings


def test_a_train_writes_its_text_with_scenes_that_changed_inside(tmp_path):
    path = GEOMETRY / "axle_straddle.toml"
    text, train = path.read_text(encoding="utf-8"), sg.load_train(path)
    assert train.to_toml(tmp_path / path.name) != text  # its scenes lie elsewhere
    text = train.to_toml()
    softer = train.with_changes(losses=train.losses.with_changes(mesh=0.07))
    assert [line for line in changed_lines(text, softer.to_toml()) if line.startswith("+")] == [
        "+ mesh = 0.07                     # published as a damping ratio of 0.06"
    ]
    shaft = train.shafts["gear"].scene.with_material(E="200 GPa")
    other = train.with_changes(gear=train.shafts["gear"].with_changes(scene=shaft))
    other.to_toml(tmp_path / "axle_straddle.toml")
    assert sg.load_train(tmp_path / "axle_straddle.toml") == other


@pytest.mark.parametrize("name", SHIPPED)
def test_a_text_is_the_scene_wherever_it_is_read(name, tmp_path, monkeypatch):
    """A text lies in no file: it holds the name, and full paths of the files that it names."""
    path = GEOMETRY / f"{name}.toml"
    shaft = "segment" in (tables := tomllib.loads(path.read_text("utf-8"))) or "body" in tables
    thing = sg.load(path) if shaft else sg.load_train(path)
    text = thing.to_toml()
    monkeypatch.chdir(tmp_path)
    assert type(thing).from_dict(tomllib.loads(text)) == thing
    Path("elsewhere.toml").write_text(text, encoding="utf-8")
    assert (sg.load if shaft else sg.load_train)("elsewhere.toml") == thing


def test_a_text_finds_the_list_of_bearings_of_its_scene(tmp_path, monkeypatch):
    head = "designation;kind;d [mm];D [mm];B [mm];C [kN]\n"
    (tmp_path / "own.csv").write_text(head + "MX-4711;deep_groove;42;78;17,5;31,2\n", "utf-8")
    (tmp_path / "shaft.toml").write_text(LISTED, "utf-8")
    scene = sg.load(tmp_path / "shaft.toml")
    text = scene.to_toml()
    assert f'bearings = "{(tmp_path / "own.csv").as_posix()}"' in text and "MX-4711" in text
    monkeypatch.chdir("/")
    assert sg.Scene.from_dict(tomllib.loads(text)) == scene


def test_a_file_that_cannot_be_written_is_refused():
    scene = sg.load(GEOMETRY / "shaft_stepped.toml")
    with pytest.raises(sg.SolidgearError, match="cannot be written"):
        scene.to_toml("/proc/none/shaft_stepped.toml")
