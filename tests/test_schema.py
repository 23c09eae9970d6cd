"""Schemas of files: every shipped file is valid, what readers refuse by shape the schema refuses too."""

import copy
import inspect
import json
import math
import re
import tomllib
from importlib import import_module
from pathlib import Path

import pytest
from command import against_schema, command
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from jsonschema import Draft7Validator
from test_bad_scenes import BRG2, CASES, GOOD

from solidgear.app.application import COMMANDS
from solidgear.app.starts import SHAFTS, STARTS
from solidgear.core.errors import SceneError
from solidgear.core.registry import registered
from solidgear.core.scene.file import load, scene_of
from solidgear.core.scene.toml_file import describes_train
from solidgear.core.scene.units import DIMENSIONS, quantity
from solidgear.show.printed import Printed
from solidgear.show.schema.files import KINDS, made, path_of, text_of
from solidgear.show.schema.results import of
from solidgear.show.schema.units import text_of as text_of_quantity
from solidgear.trains.file.reading import train_of

ROOT = Path(__file__).parents[1]
SHIPPED = [
    path
    for folder in ("geometry", "solidgear/app/starts", "tests/scenes", "validation/experiments")
    for path in sorted((ROOT / folder).glob("*.toml"))
]
#: refused cases of `test_bad_scenes` that no schema sees, by what it would have to know
UNSEEN = {
    "other entries": (
        "bore as wide as the shaft, bore through the small end, face past the apex, foil of a wall, "
        "2: seat past the end, 2: seats overlap, seat across the shoulder, port off the shaft, "
        "span across the shoulder, span backwards, 2: coupling too strong, 2: coupling to nothing, "
        "stiffness that vanishes when squared, hair of a shaft, segment of a micrometre fraction, "
        "seat of an atom, metres for millimetres, radius above 10 m"
    ),
    "names": (
        "2: bearings of one name, segments of one name, name of a datum, unknown datum, "
        "later bearing as datum, unknown port datum, unknown segment"
    ),
    "size of a text with a unit": (
        "flat pitch cone, stiffness that overflows when squared, modulus that vanishes, "
        "density that is next to nothing"
    ),
}
VALIDATORS = {kind: Draft7Validator(json.loads(path_of(kind).read_text("utf-8"))) for kind in KINDS}


def as_json(value):
    """TOML as JSON holds it: numbers that are none are null, as editors take them."""
    if isinstance(value, dict):
        return {key: as_json(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [as_json(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def refusals(tables, kind=None):
    kind = kind or ("train" if describes_train(tables) else "scene")
    return [error.message for error in VALIDATORS[kind].iter_errors(as_json(tables))]


@pytest.mark.parametrize("kind", KINDS)
def test_the_file_in_the_package_is_what_the_types_give(kind):
    assert path_of(kind).read_text("utf-8") == text_of(made(kind)), "run docs/tools/schemas.py"


def test_a_schema_is_one():
    # the smallest has all that the others are made of but kinds of tables
    Draft7Validator.check_schema(VALIDATORS["measured"].schema)


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_schemas_are_such(kind):
    Draft7Validator.check_schema(VALIDATORS[kind].schema)


def test_every_shipped_file_is_valid():
    assert len(SHIPPED) > 50
    bad = {path.name: refusals(tomllib.loads(path.read_text("utf-8"))) for path in SHIPPED}
    assert {name: messages[:3] for name, messages in bad.items() if messages} == {}


def test_what_is_refused_for_its_shape_is_refused_by_the_schema():
    unseen = {case for cases in UNSEEN.values() for case in cases.split(", ")}
    accepted = set()
    for case, (old, new, *_) in CASES.items():
        start = GOOD.index(old, BRG2 - 40 if case.startswith("2:") else 0)
        text = GOOD[:start] + new + GOOD[start + len(old) :]
        if not refusals(tomllib.loads(text), "scene"):
            accepted.add(case)
    assert accepted == unseen


def entries(table, path=()):
    """Paths of all entries of a table; of a list those of its first entry."""
    pairs = table.items() if isinstance(table, dict) else enumerate(table[:1])
    for key, value in pairs:
        if path[-1:] == ("stiffness",) and key not in ("kxx", "kx_thz"):
            continue  # the others are alike
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from entries(value, (*path, key))


def spoilt(tables, path, change):
    out = copy.deepcopy(tables)
    holder = out
    for key in path[:-1]:
        holder = holder[key]
    change(holder, path[-1])
    return out


def left_out(holder, key):
    del holder[key]


def misspelt(holder, key):
    holder[f"{key}x"] = holder.pop(key)


def replaced(value):
    def change(holder, key):
        holder[key] = value

    return change


CHANGES = {
    "left out": left_out,
    "misspelt": misspelt,
    "a truth value": replaced(True),
    "a list of nothing": replaced([[]]),
    "no quantity": replaced("90 mmm"),
    "huge": replaced(1e30),
}
#: reasons that are no matter of other entries of the file
OF_SHAPE = re.compile(
    r"unknown key|unknown unit|this key is missing(?!;)|must be (a text|a table|a list|a number|true)"
    r"|not physical|must be greater|(?<!it )must not be negative|is not a unit"
)


def read(tables, path):
    """The reason why the reader refuses tables; nothing where it takes them."""
    try:
        if describes_train(tables):
            train_of(tables, str(path), lambda side, file, alone: scene_at(file))
        else:
            scene_of(tables, str(path))
    except SceneError as error:
        return str(error)
    return ""


SCENES = {}


def scene_at(path):
    if path not in SCENES:
        SCENES[path] = load(path)
    return SCENES[path]


#: files that are spoilt
SPOILT = (
    "tests/scenes/motor_rotor",
    "geometry/pinion_keyed",
    "geometry/gearbox_catalogue",
    "geometry/axle_overhung",
    "geometry/pinion_filleted",
    "geometry/gearbox_housed",
    "geometry/reducer",
)


def kinds_of(tables):
    """Entries by what they are to reader and schema alike: the keys that lead there, those of the
    other shaft the same, the kind of the table, and the type of the value.
    """
    found = {}
    for entry in entries(tables):
        holder = tables
        for key in entry[:-1]:
            holder = holder[key]
        kind = holder.get("kind") if isinstance(holder, dict) else None
        keys = tuple("pinion" if key == "gear" else key for key in entry)
        found[(describes_train(tables), keys, kind, type(holder[entry[-1]]))] = entry
    return found


@pytest.mark.parametrize(
    "name", [SPOILT[0], *(pytest.param(name, marks=pytest.mark.long) for name in SPOILT[1:])]
)
def test_the_schema_marks_what_the_reader_refuses_and_no_more(name):
    """Entries that no file before it in the list has: the others are spoilt there."""
    texts = [(ROOT / f"{one}.toml").read_text("utf-8") for one in SPOILT]
    *before, own = map(kinds_of, map(tomllib.loads, texts[: SPOILT.index(name) + 1]))
    path = ROOT / f"{name}.toml"
    tables = tomllib.loads(path.read_text("utf-8"))
    overlooked, false = [], []
    fresh = own.keys() - {kind for found in before for kind in found}
    assert fresh
    for entry in [entry for kind, entry in own.items() if kind in fresh]:
        for what, change in CHANGES.items():
            if what == "misspelt" and not isinstance(entry[-1], str):
                continue
            changed = spoilt(tables, entry, change)
            reason, marks = read(changed, path), refusals(changed)
            if OF_SHAPE.search(reason) and not marks:
                overlooked.append((entry, what, reason))
            if marks and not reason and what != "a truth value":  # true is 1 to some readers
                false.append((entry, what, marks))
    assert overlooked == [] and false == []


def test_a_shaft_without_gears_is_a_carrier():
    tables = tomllib.loads((ROOT / "geometry/reducer.toml").read_text("utf-8"))
    assert refusals(tables) == []
    del tables["planetary"]
    assert refusals(tables) != []
    tables["shaft"]["output"]["teeth"] = 20
    assert refusals(tables) == []


@pytest.mark.parametrize("side", ["housing", "pinion"])
def test_points_of_matrices_are_nodes_with_or_without_a_place(side):
    tables = tomllib.loads((ROOT / "geometry/gearbox_housed.toml").read_text("utf-8"))
    tables["housing"] = {"matrices": "box.bdf"}

    def refused(point):
        return refusals({**tables, side: {**tables[side], "points": {"input.A": point}}}) != []

    place = ["0 mm", "120 mm", 0.0]
    nodes = [101, [5, 6], {"node": 101}, {"node": [5, 6], "position": place}]
    assert not any(map(refused, nodes))
    assert refused(place) == (side == "pinion")  # of a rigid housing points are places
    misspelt = {"node": 101, "positon": place}
    assert all(map(refused, ["101", 10.5, [5], [5, 6, 7, 8], {"position": place}, misspelt]))


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_units_that_the_schema_knows_are_read(dimension):
    @settings(
        max_examples=10,
        phases=[Phase.generate],
        deadline=None,
        database=None,
        derandomize=True,
        suppress_health_check=[*HealthCheck],
    )
    @given(st.from_regex(f"^{text_of_quantity(dimension)}$", fullmatch=True))
    def reads(text):
        try:
            assert math.isfinite(quantity(text, dimension))
        except SceneError as error:  # digits at random may make a number beyond all numbers
            assert "finite" in error.reason or "not physical" in error.reason

    reads()


def properties(node):
    if isinstance(node, dict):
        for key, entry in node.get("properties", {}).items():
            yield key, entry
        for key, part in node.items():
            if key not in ("if", "then"):
                yield from properties(part)
    elif isinstance(node, list):
        for part in node:
            yield from properties(part)


#: words of arrangements
NAMED = re.compile(r"O|X|D[BF]|back.to.back|face.to.face", re.I)


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_has_a_sentence(kind):
    silent = {
        key
        for key, node in properties(VALIDATORS[kind].schema)
        if isinstance(node, dict) and not node.get("description") and not NAMED.match(key)
    }
    assert silent == set()


def test_a_new_file_names_its_schema(tmp_path):
    for kind in STARTS:
        command("new", tmp_path / kind, "--kind", kind)
        names = [f"{kind}{more}.toml" for more in ("", *SHAFTS.get(kind, ()))]
        for name in names:
            text = (tmp_path / name).read_text("utf-8")
            first = text.splitlines()[0]
            tables = tomllib.loads(text)
            expected = path_of("train" if describes_train(tables) else "scene")
            assert first == f"#:schema {expected.as_uri()}" and refusals(tables) == []


def test_the_command_prints_writes_and_refuses(tmp_path):
    printed = command("schema", "train").stdout
    assert json.loads(printed)["title"].startswith("solidgear train")
    assert command("schema", "train", "--where").stdout.strip() == str(path_of("train"))
    command("schema", "train", "--out", tmp_path / "train.json")
    assert (tmp_path / "train.json").read_text("utf-8") == printed
    assert 'did you mean "train"' in str(command("schema", "trian").exception)


def test_every_command_that_prints_json_has_a_schema():
    printing = set()
    for name, entry in COMMANDS.items():
        function = getattr(
            import_module(f"solidgear.{entry.module}"), entry.function or name.replace("-", "_")
        )
        if "as_json" in inspect.signature(function).parameters:
            printing.add(name)
    assert printing == {*registered("printed")}
    for name in printing:
        schema = json.loads(command("schema", "--json", name).stdout)
        forms = schema.get("anyOf", [schema])
        assert all(form["type"] == "object" and form["properties"] for form in forms), name
    assert "prints JSON" in str(command("schema", "--json", "render").exception)


def test_what_is_printed_beside_other_keys_has_and_lacks_theirs():
    base = Printed(keys={"name": str, "models": str}, sometimes={"bar": float}, without=("models",))
    schema = Draft7Validator(of(Printed((base,), {"notes": list[str]})))
    assert schema.is_valid({"name": "a", "notes": []})
    assert schema.is_valid({"name": "a", "notes": [], "bar": 0.1})
    assert not schema.is_valid({"name": "a", "notes": [], "models": "b"})


SHAFT, TRAIN = ROOT / "geometry" / "shaft_stepped.toml", ROOT / "geometry" / "axle_overhung.toml"
CATALOGUE = ROOT / "geometry" / "gearbox_catalogue.toml"


@pytest.mark.parametrize(
    "words",
    [
        ("sensitivities", SHAFT, "-f", "timoshenko"),
        ("sweep", SHAFT, "--vary", "bearing.A.scale=1,2", "-f", "timoshenko", "--out", "a.csv"),
        ("sweep", SHAFT, "--vary", "material.nu=0.2,0.3", "-f", "timoshenko", "--out", "b.csv"),
        ("stiffness", SHAFT, "-f", "timoshenko"),
        ("bearing", CATALOGUE),
        ("deflect", TRAIN, "--torque", "100 N*m", "-f", "timoshenko"),
        ("deflect", CATALOGUE, "-f", "timoshenko"),
        ("export", SHAFT, "-f", "timoshenko", "--modes", 2, "--out", "a.npz"),
        ("export", SHAFT, "--to", "ross", "--out", "a.py"),
    ],
)
def test_what_a_command_prints_is_what_its_schema_says(words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    printed = command(*words, "--json").stdout  # which is held against the schema
    data = json.loads(printed)
    assert against_schema(words[0], printed) == []
    key = next(iter(data))
    renamed = json.dumps({f"{key}_x": data.pop(key), **data})
    assert against_schema(words[0], renamed) != []
