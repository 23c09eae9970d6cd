"""Lumped points and housings in scene files: what they mean, and every slip in a sentence."""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.errors import SceneError

GEOMETRY = Path(__file__).parent.parent / "geometry"
GOOD = (GEOMETRY / "intermediate_shaft.toml").read_text(encoding="utf-8")
STIFF = GOOD[GOOD.index("stiffness = { kxx") :].splitlines()[0]


def read(tmp_path, *changes):
    text = GOOD
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = tmp_path / "shaft.toml"
    path.write_text(text, encoding="utf-8")
    return sg.load(path)


def test_as_shipped():
    scene = sg.load(GEOMETRY / "intermediate_shaft.toml")
    assert [p.name for p in scene.ports] == ["wheel", "pinion"]
    assert scene.port.y == 0.065 and scene.further_ports[0].hi == 0.18
    assert scene.housing.y == 0.1125 and scene.housing.rigid == ("thy", "thz")
    assert scene.housing.entries == {
        "kxx": 1.5e9,
        "kyy": 5e8,
        "kzz": 8e8,
        "kz_thx": 1e7,
        "kthx": 1e7,
    }
    wall = 1 / (1 / 5e8 + 1 / 2e9)  # two springs in series
    assert scene.bearings[1].stiffness[2, 2] == pytest.approx(wall, rel=1e-14)
    assert scene.bearings[1].stiffness[1, 1] == 0.0
    plain = scene.as_dict()
    assert plain["housing"]["entries"] == scene.housing.entries
    assert plain["bearings"][1]["housing"] == {"kxx": 2e9, "kzz": 2e9}
    assert "housing" not in plain["bearings"][0] and plain["further_ports"][0]["name"] == "pinion"


def test_the_main_point_is_the_one_asked_for(tmp_path):
    scene = read(tmp_path, ('port = "wheel"', 'port = "pinion"'))
    assert [p.name for p in scene.ports] == ["pinion", "wheel"]
    first = read(tmp_path, ('port = "wheel"', "modes = 5"))
    assert [p.name for p in first.ports] == ["wheel", "pinion"] and first.ask.modes == 5


def test_a_list_of_one_is_one(tmp_path):
    shipped = (GEOMETRY / "gear_shaft.toml").read_text(encoding="utf-8")
    path = tmp_path / "gear_shaft.toml"
    path.write_text(shipped.replace("[port]", "[[port]]"), encoding="utf-8")
    assert sg.load(path) == sg.load(GEOMETRY / "gear_shaft.toml")


def test_other_ways_to_write_a_housing(tmp_path):
    rows = np.diag([1.5e9, 5e8, 8e8, 1e7, 0.0, 0.0])
    scene = read(tmp_path, (STIFF, f"matrix = {rows.tolist()}"))
    assert scene.housing.rigid == () and scene.housing.entries["kthz"] == 0.0
    axial = read(tmp_path, (STIFF, 'axial = "5e8 N/m"'), ('position = "112.5 mm"', ""))
    alone = read(tmp_path, (STIFF, 'stiffness = {kyy = "5e8 N/m"}'))
    assert axial.housing is None and axial.housing_axial == 5e8
    a, b = as_supports(axial).stiffness, as_supports(alone).stiffness
    assert np.abs(a - b).max() < 1e-13 * np.abs(a).max()
    behind = read(tmp_path, ('position = "112.5 mm"', 'position = "10 mm"\nfrom = "bearing.B"'))
    assert behind.housing.y == pytest.approx(0.215)


def test_a_mass_may_sit_on_a_further_point(tmp_path):
    mass = '[[mass]]\nname = "coupling"\nmass = "2 kg"\non = "pinion"\n\n[ask]'
    scene = read(tmp_path, ("[ask]", mass))
    heavy = sg.modes(sg.build(scene, "timoshenko"), scene, n=2).frequency_hz[1]
    assert (
        heavy
        < sg.modes(sg.build(scene, "timoshenko"), scene.with_changes(masses=()), n=2).frequency_hz[
            1
        ]
    )


SECOND = 'name = "pinion"\nat = '
SLIPS = {
    "one name twice": ((SECOND, 'name = "wheel"\nat = '), 'port[2] "wheel".name', "another port has this name"),
    "no names": ((SECOND, "at = "), None, None),
    "name of a bearing": ((SECOND, 'name = "B"\nat = '), 'bearing[2] "B".name', "the port or another bearing"),
    "unknown main point": (('port = "wheel"', 'port = "whel"'), "ask.port", 'did you mean "wheel"?; the scene has wheel, pinion'),
    "unknown point asked": (
        ('port = "wheel"', 'quantities = ["C_zz@gear"]'),
        "ask.quantities[1]",
        'no lumped point "gear"; the scene has wheel, pinion',
    ),
    "frequency of a point": (
        ('port = "wheel"', 'quantities = ["bending 1@wheel"]'),
        "ask.quantities[1]",
        "only compliances and stiffnesses belong to a point; write bending 1 without @",
    ),
    "unknown quantity of a point": (
        ('port = "wheel"', 'quantities = ["D_zz@wheel"]'),
        "ask.quantities[1]",
        "must be 'C_zz'",
    ),
    "unknown datum": (('at = "pinion.middle"', 'at = "pinin.middle"'), 'port[2] "pinion".at', 'did you mean "pinion.middle"'),
    "unknown segment": (('attach_to = "pinion"', 'attach_to = "gear"'), 'port[2] "pinion".attach_to', "unknown segment"),
    "off the shaft": (
        ('at = "pinion.middle"', 'position = "300 mm"'),
        'port[2] "pinion".position',
        "outside the shaft (0 to 0.225 m)",
    ),
    "across a step": (
        ('attach_to = "pinion"', 'span = ["100 mm", "150 mm"]'),
        'port[2] "pinion".span',
        "across the step of the outer radius at 0.12 m",
    ),
    "both rigid on one surface": (
        (
            'attach_to = "pinion"',
            'attach_to = "wheel"\nattachment = "rigid"\n\n[[port]]\nname = "third"\nat = "wheel.start"\nattach_to = "wheel"\nattachment = "rigid"',
        ),
        'port[3] "third".attach_to',
        'overlaps that of "pinion"',
    ),
    "a housing twice": ((STIFF, f'{STIFF}\naxial = "1e8 N/m"'), "housing.axial", "is the entry kyy"),
    "a housing of nothing": ((STIFF, ""), "housing.stiffness", "this key is missing"),
    "a housing nowhere": (('position = "112.5 mm"', ""), "housing.position", "this key is missing"),
    "a place of an axial spring": ((STIFF, 'axial = "1e8 N/m"'), "housing.position", "a spring has no place"),
    "unknown datum of a housing": (('position = "112.5 mm"', 'position = "1 mm"\nfrom = "bering.A"'), "housing.from", "unknown datum"),
    "a rigid motion coupled": ((STIFF, "stiffness = {kzz = 8e8, kz_thx = 1e7}"), "housing.stiffness.kz_thx", "couples thx, which is rigid unless kthx is given"),
    "an unknown entry": ((STIFF, 'stiffness = {kzx = "8e8 N/m"}'), "housing.stiffness.kzx", 'unknown stiffness entry; did you mean "kzz"'),
    "a word of catalogues": ((STIFF, 'stiffness = {radial = "8e8 N/m"}'), "housing.stiffness.radial", "radial is kxx and kzz"),
    "an entry of another dimension": ((STIFF, 'stiffness = {kzz = "8 mm"}'), "housing.stiffness.kzz", "is not a unit of force per length"),
    "an indefinite housing": (
        (STIFF, "stiffness = {kzz = 8e8, kthx = 1e5, kz_thx = 1e8}"),
        "housing.stiffness",
        "the stiffness is indefinite",
    ),
    "too few rows": ((STIFF, "matrix = [[1.0]]"), "housing.matrix", "must be 6 rows of 6 numbers"),
    "a wall of nothing": (
        ('[bearing.housing]\nkxx = "2e9 N/m"\nkzz = "2e9 N/m"', "[bearing.housing]"),
        'bearing[2] "B".housing',
        "is empty; write entries of its stiffness such as kxx",
    ),
    "a negative wall": (('kxx = "2e9 N/m"\nkzz', 'kxx = "-2e9 N/m"\nkzz'), 'bearing[2] "B".housing', "it must not be negative"),
}  # fmt: skip


@pytest.mark.parametrize("kind", SLIPS)
def test_slips(kind, tmp_path):
    change, field, says = SLIPS[kind]
    if field is None:  # a name is given to those without one: the first may be called port
        scene = read(tmp_path, change)
        assert [p.name for p in scene.ports] == ["wheel", "port"]
        return
    with pytest.raises(SceneError) as caught:
        read(tmp_path, change)
    (told,) = caught.value.problems
    assert told.field == field and says in told.reason
    assert "\n" not in str(caught.value) and str(tmp_path) in str(caught.value)


def test_a_scene_in_python():
    scene = sg.load(GEOMETRY / "intermediate_shaft.toml")
    with pytest.raises(SceneError, match="is the entry kyy of a housing's stiffness"):
        scene.with_changes(housing_axial=1e8)
    with pytest.raises(SceneError, match="another port has this name") as caught:
        scene.with_changes(further_ports=(scene.port,))
    assert caught.value.path == ("further_ports", 0, "name")
    section = scene.with_attachment("section")
    assert {s.attachment for s in section.stations} == {"section"}
    double = scene.with_bearing_scale(2.0).bearings[1].stiffness
    assert double == pytest.approx(2 * scene.bearings[1].stiffness, rel=1e-14)
