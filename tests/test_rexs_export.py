"""Trains and scenes out as REXS, and in again equal."""

import json
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from command import command
from rexs_gearboxes import helical, planetary

import solidgear as sg
from solidgear.core import is_train
from solidgear.exchange.rexs.export.exporting import exported, read_source
from solidgear.exchange.rexs.importing import imported
from solidgear.exchange.rexs.reading import document_of, read
from solidgear.exchange.rexs.rest import REST
from solidgear.exchange.rexs.writing import xml_of

GEOMETRY = Path("geometry")
TRAINS = sorted(path.name for path in GEOMETRY.glob("*.toml") if is_train(path))
SCENES = ("gear_shaft", "gearbox_catalogue", "intermediate_shaft", "pinion_keyed", "rotor_disc")
#: keys of files for which REXS has attributes
IN_REXS = frozenset(
    "teeth length diameter E nu density position inertia torque azimuth module designation "
    "pressure_angle kxx kyy elements preload sun planets radial".split()
)
#: relative; two roundings in the units of a file, of degrees and of millimetres
ROUNDED = 1e-15


def again(document, folder, name="box"):
    """Return what is read from the files of an import, as they are written."""
    result = imported(document, name)
    folder.mkdir(exist_ok=True)
    for file, text in result.files.items():
        (folder / file).write_text(text)
    return read_source(folder / next(iter(result.files))), result.notes


def differences(first, second, path=""):
    """Yield the entries of two tables that differ, numbers by more than the digits of their units."""
    if isinstance(first, dict) and isinstance(second, dict):
        for key in first.keys() | second.keys():
            yield from differences(first.get(key), second.get(key), f"{path}/{key}")
    elif isinstance(first, list) and isinstance(second, list) and len(first) == len(second):
        for k, pair in enumerate(zip(first, second)):
            yield from differences(*pair, f"{path}/{k}")
    elif isinstance(first, float) and isinstance(second, float):
        if abs(first - second) > ROUNDED * abs(first):
            yield path, first, second
    elif first != second:
        yield path, first, second


def went_round(source, folder):
    """Return what differs after a source went out and in, with what its export said."""
    result = exported(source)
    document = document_of(xml_of(result.document).encode())
    assert document == result.document
    back, notes = again(document, folder)
    assert notes.groups == [] or [heading for heading, _ in notes.groups] == ["Left out"]
    return [*differences(source.to_dict(), back.to_dict())], result


@pytest.mark.parametrize("name", TRAINS)
def test_a_shipped_train_reads_back_equal(name, tmp_path):
    differing, result = went_round(read_source(GEOMETRY / name), tmp_path)
    assert differing == []
    listed = {key for _, entries in result.without_place for key in entries}
    assert not listed & IN_REXS
    assert not any("stiffness" in component for component, _ in result.without_place)


@pytest.mark.parametrize("name", SCENES)
def test_a_shaft_alone_reads_back_equal(name, tmp_path):
    differing, _ = went_round(read_source(GEOMETRY / f"{name}.toml"), tmp_path)
    assert differing == []


@pytest.mark.parametrize("name", ["NU 207", "MX-4711"])
def test_a_listed_bearing_reads_back_without_its_list(name, tmp_path):
    line = f"designation;kind;d [mm];D [mm];B [mm];C [kN]\n{name};cylindrical;35;72;17;55\n"
    (tmp_path / "list.csv").write_text(line)
    file = (GEOMETRY / "gearbox_catalogue.toml").read_text()
    file = 'bearings = "list.csv"\n' + file.replace('"NU 207"', f'"{name}"')
    (tmp_path / "shaft.toml").write_text(file)
    differing, _ = went_round(read_source(tmp_path / "shaft.toml"), tmp_path / "back")
    assert differing == []


@pytest.mark.parametrize("box", [helical, planetary])
def test_a_gearbox_of_another_program_goes_in_out_and_in_again(box, tmp_path):
    train, _ = again(document_of(box().xml().encode()), tmp_path / "first")
    differing, _ = went_round(train, tmp_path / "second")
    assert differing == []


def test_what_has_no_place_is_listed_by_component():
    result = exported(read_source(GEOMETRY / "gearbox_two_stage.toml"))
    assert result.lines == [
        "input: title, source, load, uncertain",
        "input lubrication: speed",
        "input bearing A catalogue: shaft_interference",
        "middle: title, source, load",
        "middle bearing E catalogue: shaft_interference",
        "middle bearing F catalogue: shaft_interference",
        "output: title, source, load",
        "output bearing G catalogue: shaft_interference",
        "output bearing H catalogue: shaft_interference",
        "gearbox_two_stage: title, source, ask",
        "gearbox_two_stage shaft output gears wheel head: torsional, bending",
        "gearbox_two_stage mesh input-middle.wheel: transmission_error",
        "gearbox_two_stage mesh middle.pinion-output: transmission_error",
    ]


@pytest.mark.parametrize("name", ["gearbox_two_stage", "gearbox_train", "gearbox_housed"])
def test_flanks_and_ways_follow_from_the_torque(name):
    """The sign of a torque is that of the loaded flanks, and places are those of the meshes."""
    document = exported(read_source(GEOMETRY / f"{name}.toml")).document
    rests = " ".join(c.text(REST) for c in document.components.values())
    assert "pitch_radius" in rests
    for word in ("loaded_side", "torque", "hand", "azimuth", "gear_position", "kind", "bore"):
        assert f'"{word}"' not in rests


def numbers(root, kind):
    """Return the attributes of the components of a type in an XML file, as numbers where they are."""

    def value(element):
        cells = [float(cell.text) for cell in element.iter("c")]
        try:
            return cells or float(element.text)
        except ValueError:
            return element.text

    components = [c for c in root.find("components") if c.get("type") == kind]
    return [(c.get("name"), {a.get("id"): value(a) for a in c}) for c in components]


def test_the_file_says_what_the_train_is_to_whoever_reads_its_xml(tmp_path):
    """Read without a line of ours: sections, gears, places of shafts, torque and speed."""
    path = tmp_path / "box.rexs"
    assert sg.export(GEOMETRY / "gearbox_two_stage.toml", path) == [path]
    root = ElementTree.parse(path).getroot()
    assert root.get("version") == "1.4" and root.get("applicationId") == "solidgear"
    sections = dict(numbers(root, "shaft_section")[:3])
    assert [s["length"] for s in sections.values()] == [30, 50, 110]
    assert [s["outer_diameter_begin"] for s in sections.values()] == [35, 60, 40]
    assert sorted(g["number_of_teeth"] for _, g in numbers(root, "cylindrical_gear")) == [18, 20, 55, 57]  # fmt: skip
    # 20 teeth of 30 mm pitch radius at 15 degrees: mn = 60 cos 15 / 20
    module = 3 * np.cos(np.radians(15))
    helical_gears = [g for _, g in numbers(root, "cylindrical_gear") if g["number_of_teeth"] in (20, 57)]  # fmt: skip
    assert [g["normal_module"] for g in helical_gears] == pytest.approx([module, module])
    assert [g["helix_angle_reference_diameter"] for g in helical_gears] == pytest.approx(
        [15, -15], rel=1e-14
    )
    widths = [g["face_width"] for _, g in numbers(root, "cylindrical_gear")]
    assert widths == pytest.approx([50, 46, 65, 65])  # the last leaves its own to its mate
    shafts = {name: s["support_vector"] for name, s in numbers(root, "shaft")}
    apart = np.subtract(shafts["middle"], shafts["input"])
    assert np.hypot(*apart[1:]) == pytest.approx(30 + 85.5)
    second = np.subtract(shafts["output"], shafts["middle"])
    assert np.hypot(*second[1:]) == pytest.approx(4 * (18 + 55) / 2 / np.cos(np.radians(12)))
    # 30 degrees about the shaft from the side on which the first wheel lies
    assert np.degrees(np.arccos(apart[1:] @ second[1:] / np.hypot(*apart[1:]) / np.hypot(*second[1:]))) == pytest.approx(30)  # fmt: skip
    case = root.find("load_spectrum/load_case")
    words = {a.get("id"): float(a.text) for a in case.iter("attribute") if a.get("unit") != "none"}
    assert abs(words["torque_around_u_axis"]) == 115
    assert abs(words["rotational_speed"]) == pytest.approx(1500, rel=1e-14)
    couplings = dict(numbers(root, "coupling"))
    assert couplings["coupling of engine"]["rotational_stiffness"] == 4e6  # N mm/rad
    assert [m["moment_of_inertia_u_axis"] for _, m in numbers(root, "additional_mass")] == [0.03, 2.5]  # fmt: skip
    assert dict(numbers(root, "rolling_bearing_with_catalog_geometry"))["E"]["catalogue_designation"] == 6308  # fmt: skip


def test_xml_json_and_a_zip_hold_the_same(tmp_path):
    source = GEOMETRY / "reducer.toml"
    paths = [tmp_path / f"box.{ending}" for ending in ("rexs", "rexsj", "rexsz")]
    for path in paths:
        sg.export(source, path)
    trains = [again(read(path), tmp_path / path.suffix[1:])[0] for path in paths]
    assert trains[0].to_dict() == trains[1].to_dict() == trains[2].to_dict()
    again_bytes = paths[2].read_bytes()
    sg.export(source, paths[2])
    assert paths[2].read_bytes() == again_bytes
    model = json.loads(paths[1].read_text())["model"]
    teeth = [
        a for c in model["components"] for a in c["attributes"] if a["id"] == "number_of_teeth"
    ]
    assert all(isinstance(a["integer"], int) for a in teeth)


def test_the_points_of_a_duty_go_round_with_weight_and_forces(tmp_path):
    tables = read_source(GEOMETRY / "gearbox_train.toml").to_dict()
    scene = tables["shaft"]["gear"]["scene"]
    scene["port"].append({"name": "belt", "position": 0.2, "span": [0.19, 0.21]})
    tables["operation"][0] |= {
        "weight": "-z",
        "force": [{"at": "gear.belt", "x": 800.0, "thx": 5.0}],
    }
    train = sg.Train.from_dict(tables)
    differing, result = went_round(train, tmp_path)
    assert differing == []
    assert not any("operation" in name or "belt" in name for name, _ in result.without_place)


def test_a_number_that_another_program_has_changed_holds(tmp_path):
    """The rest of what REXS lacks stays where nothing of it was touched."""
    text = xml_of(exported(read_source(GEOMETRY / "gearbox_two_stage.toml")).document)
    # that program gives its own name, and another stiffness, place and diameter
    for old, new in (
        ('applicationId="solidgear"', 'applicationId="other"'),
        (">207000<", ">210000<"),
        (">36<", ">37<"),
        ('id="mass_of_component" unit="kg">12<', 'id="mass_of_component" unit="kg">13<'),
        ('id="rotational_stiffness" unit="N mm / rad">4000000<', 'id="rotational_stiffness" unit="N mm / rad">5000000<'),
    ):  # fmt: skip
        if old != ">36<":
            assert text.count(old) == 1, old
        text = text.replace(old, new)
    train, notes = again(document_of(text.encode()), tmp_path)
    assert train.shafts["input"].scene.material.E == 210e9
    assert train.rotors["engine"].spring.stiffness == 5000.0
    assert train.rotors["engine"].spring.at == "B"
    head = train.shafts["output"].gears["wheel"].head
    assert head.mass == 13.0 and head.torsional == pytest.approx(0.0825568 * 13 / 12, rel=1e-5)
    ((_, lines),) = notes.groups
    assert any("torsional has been changed" in line for line in lines)


def test_frequencies_are_those_of_the_train(tmp_path):
    train = read_source(GEOMETRY / "axle_overhung.toml")
    back, _ = again(exported(train).document, tmp_path)
    first, second = (sg.system_modes(t, "euler").frequency_hz for t in (train, back))
    # numbers differ by 1e-15, and an eigenvalue by as much times the stiffest over the softest
    assert second == pytest.approx(first, rel=1e-9, abs=1e-3)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--out", "x.rexs", "--modes", "3"), "leave out modes"),
        (("--out", "x.rexs", "--units", "mm-t-N"), "leave out units"),
        (("--out", "x.npz", "--to", "rexs"), "is none of REXS; use .rexs, .rexsj, .rexsz"),
        (("--out", "x.rex"), "is of no format"),
        (("--out", "x.rexs", "--to", "rex"), 'did you mean "rexs"'),
    ],
)
def test_the_command_refuses_in_a_sentence_and_writes_nothing(tmp_path, monkeypatch, words, said):
    file = str((GEOMETRY / "gear_shaft.toml").resolve())
    monkeypatch.chdir(tmp_path)
    done = command("export", file, *words)
    assert done.exit_code == 1 and said in str(done.exception)
    assert not [*tmp_path.iterdir()]


def test_the_command_lists_what_has_no_place(tmp_path):
    out = tmp_path / "box.rexs"
    done = command("export", GEOMETRY / "gearbox_train.toml", "--out", out, "--json")
    data = json.loads(done.output)
    assert data["components"]["cylindrical_stage"] == 1 and data["files"] == [str(out)]
    assert data["without_place"]["gearbox_train mesh pinion-gear"] == ["transmission_error"]


@pytest.mark.parametrize("text", ["{", "[]", '{"set": 1}', '{"in": {"a": 2}}', '{"else": {}}'])
def test_a_spoiled_rest_ends_in_a_sentence(text):
    document = exported(read_source(GEOMETRY / "gear_shaft.toml")).document
    shaft = document.of_kind("shaft")[0]
    shaft = shaft.with_attributes({REST: type(shaft.attributes[REST])(REST, text)})
    document.components[shaft.id] = shaft
    with pytest.raises(sg.SolidgearError, match="leave (it|the attribute) out to go on"):
        imported(document, "box")


def test_names_of_a_file_lead_out_of_no_folder(tmp_path):
    text = xml_of(exported(read_source(GEOMETRY / "gear_shaft.toml")).document)
    text = text.replace('name="gear_shaft"', 'name="../gear_shaft"')
    assert [*imported(document_of(text.encode()), "box").files] == ["gear_shaft.toml"]
    scene = read_source(GEOMETRY / "gear_shaft.toml").with_changes(name="../x")
    with pytest.raises(sg.SolidgearError, match="its file is named after it"):
        exported(scene)


def test_what_is_no_shaft_of_sections_is_refused():
    with pytest.raises(sg.SolidgearError, match="is no gearbox"):
        sg.export(np.eye(3), "x.rexs")


def test_a_wheel_has_what_its_file_leaves_to_its_mate(tmp_path, monkeypatch):
    # the file that `new` writes gives module, helix and width once, for the pinion
    monkeypatch.chdir(tmp_path)
    assert command("new", "box", "--kind", "helical").exit_code == 0
    document = exported(read_source("box.toml")).document
    wheel, pinion = (
        next(c for c in document.components.values() if c.number("number_of_teeth") == teeth)
        for teeth in (57, 23)
    )
    for name in ("normal_module", "face_width"):
        assert wheel.number(name) == pinion.number(name)
    name = "helix_angle_reference_diameter"
    assert wheel.number(name) == -pinion.number(name)
    imported(document, "box")
