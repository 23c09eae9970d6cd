"""A scene made in Python by the words of a file is that of the file."""

import math
import tomllib

import pytest

import solidgear as sg
from solidgear.core.scene import Chamfer

FILE = """
material = "42CrMo4"
segment = [
    { kind = "cylinder", name = "left", length = "60 mm", diameter = "30 mm" },
    { kind = "cylinder", name = "middle", length = "120 mm", diameter = "50 mm", bore = "10 mm" },
    { kind = "cone", name = "tip", length = 0.06, start_diameter = 0.03, end_diameter = 0.025 },
]
bearing = [
    { name = "A", position = "30 mm", seat_width = "16 mm", catalogue = { designation = "6206" } },
    { name = "B", on = "tip", stiffness = { kxx = 1e8, kzz = "1e8 N/m" } },
]
mass = [
    { name = "disc", mass = "2 kg", position = "-10 mm", from = "middle.end", seat_width = "8 mm" },
]
feature = [
    { kind = "chamfer", name = "edge", at = "middle.start", length = "1 mm" },
]
port = [
    { name = "gear", at = "middle.middle", attach_to = "middle", attachment = "rigid" },
    { name = "hub", position = "5 mm", from = "bearing.A", span = ["40 mm", "50 mm"] },
]
load = { z = "2 kN" }
"""


def parts():
    """Segments and all else of the file, in Python."""
    segments = [
        sg.Segment.cylinder("left", length="60 mm", diameter="30 mm"),
        sg.Segment.cylinder("middle", length="120 mm", diameter="50 mm", bore="10 mm"),
        sg.Segment.cone("tip", length="60 mm", start_diameter="3 cm", end_diameter="25 mm"),
    ]
    seat = {"position": "-10 mm", "from": "middle.end", "seat_width": "8 mm"}
    hub = {"position": "5 mm", "from": "bearing.A", "span": ["40 mm", "50 mm"]}
    return segments, {
        "bearings": [
            sg.Bearing(name="A", position="30 mm", seat_width="16 mm", designation="6206"),
            sg.Bearing(name="B", on="tip", stiffness={"kxx": 1e8, "kzz": "1e8 N/m"}),
        ],
        "masses": [sg.PointMass(name="disc", mass="2 kg", **seat)],
        "blends": [Chamfer(name="edge", at="middle.start", length="1 mm")],
        "port": sg.Port(name="gear", at="middle.middle", attach_to="middle", attachment="rigid"),
        "further_ports": [sg.Port(name="hub", **hub)],
        "load": {"z": "2 kN"},
    }


def test_words_of_a_file_make_the_same_scene_in_python():
    segments, things = parts()
    scene = sg.Scene.from_parts(segments, "42CrMo4", **things)
    of_file = sg.Scene.from_dict(tomllib.loads(FILE))
    assert scene != of_file and scene.settled == of_file
    assert scene.as_dict() == of_file.as_dict()
    # a study asks for the stiffness of bearings, which then settle
    body = sg.build(scene, "euler")
    (first, *_), (same, *_) = (sg.modes(body, s, n=2).frequency_hz for s in (scene, of_file))
    assert first == same


def test_segments_chain_where_no_place_is_given():
    rod = sg.Segment.cylinder("rod", length=0.1, diameter=0.03)
    far = sg.Segment.cylinder("far", length=0.1, diameter=0.03, y0=0.1)
    tip = sg.Segment.cylinder("tip", length=0.1, diameter=0.03).with_changes(name="end piece")
    scene = sg.Scene.from_parts([rod, far, tip], "aluminium")
    assert [s.y1 for s in scene.segments] == pytest.approx([0.1, 0.2, 0.3])
    assert {s.material.name for s in scene.segments} == {"aluminium"}
    with pytest.raises(sg.SceneError, match="must be 0.1"):
        sg.Scene.from_parts([rod, far.with_changes(y0=0.0, y1=0.1)])


def scene_with(**things):
    rod = sg.Segment.cylinder("rod", length=0.3, diameter=0.03)
    return sg.Scene.from_parts([rod], **things)


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (
            lambda: sg.Segment.cylinder("a", length="-3 mm", diameter=1),
            'length = "-3 mm": must be greater than zero',
        ),
        (
            lambda: sg.Segment.cylinder("a", length=0.1, diameter="40 mm", bore="5 cm"),
            'bore = "5 cm": must be smaller than diameter (0.04 m)',
        ),
        (
            lambda: sg.Segment.cone("a", length=0.1, start_diameter=0.1, end_diameter="4 kg"),
            'end_diameter = "4 kg": "kg" is not a unit of length',
        ),
        (
            lambda: scene_with(port=sg.Port(at="rod.midle", attach_to="rod")),
            'port.at = "rod.midle": unknown datum; did you mean "rod.middle"?',
        ),
        (
            lambda: scene_with(bearings=[sg.Bearing(name="A", on="rud", hold="clamped")]),
            'bearings[1] "A".on = "rud": unknown segment; did you mean "rod"?',
        ),
        (
            lambda: sg.Bearing(name="A", seat_width=0.01, designation="6206"),
            "position: this key is missing",
        ),
        (
            lambda: sg.Bearing(
                name="A", position=0, seat_width=0.01, catalogue={}, designation="6206"
            ),
            'designation = "6206": belongs to catalogue',
        ),
        (
            lambda: (
                scene_with(
                    bearings=[
                        sg.Bearing(name="A", position=0.1, seat_width=0.01, designation="6206")
                    ]
                ).settled
            ),
            'bearings[1] "A".catalogue',
        ),
        (lambda: sg.Scene.from_parts([]), "segments: a scene needs at least one segment"),
        (lambda: sg.Scene.from_dict({"segment": {}}), "2 problems in scene"),
    ],
)
def test_errors_from_python_speak_of_its_arguments(make, error):
    with pytest.raises(sg.SceneError) as refused:
        make()
    assert str(refused.value).startswith(error)
    assert "[[" not in str(refused.value) and "[load]" not in str(refused.value)


def test_a_thing_that_waits_for_its_shaft_keeps_its_words():
    gear = sg.Port(at="rod.end", attach_to="rod")
    assert gear.words and "at='rod.end'" in repr(gear)
    renamed = gear.with_changes(name="gear")
    scene = scene_with(port=renamed)
    assert (scene.port.y, scene.port.name, scene.port.words) == (0.3, "gear", None)
    assert math.isclose(scene.with_port(y=0.1).port.y, 0.1)


ROD = sg.Segment.cylinder("rod", length="200 mm", diameter="40 mm")


def pair(**words):
    return [
        sg.Bearing(name=name, position=at, designation="7208 B", **words)
        for name, at in (("A", "20 mm"), ("B", "180 mm"))
    ]


@pytest.mark.parametrize(
    ("arrangement", "ways"), [("O", ["+y", "-y"]), ("X", ["-y", "+y"]), ({"X": ["B", "A"]}, "-+")]
)
def test_an_arrangement_turns_bearings_made_in_python(arrangement, ways):
    scene = sg.Scene.from_parts(
        [ROD],
        bearings=pair(),
        arrangement=arrangement,
        port=sg.Port(at="rod.middle", span=[0.06, 0.1]),
    )
    assert [bearing.catalogue.holds[0] for bearing in scene.bearings] == [way[0] for way in ways]
    assert [bearing.seat_width for bearing in scene.bearings] == [0.018, 0.018]
    tables = scene.to_dict()
    for table in tables["bearing"]:
        del table["seat_width"]
    assert sg.Scene.from_dict(tables) == scene


def test_bearings_without_a_direction_are_refused_by_the_scene_and_by_a_file():
    with pytest.raises(sg.SceneError, match="catalogue.holds: single angular contact"):
        sg.Scene.from_parts([ROD], bearings=pair())
    with pytest.raises(sg.SceneError, match="arrangement.*back to back"):
        sg.Scene.from_parts([ROD], bearings=pair(), arrangement="Q")
    with pytest.raises(sg.SceneError, match="this scene has 0"):
        sg.Scene.from_parts([ROD], bearings=pair(holds="+y"), arrangement="O")


def test_a_mass_on_a_segment_sits_on_all_of_it_unless_a_station_has_that_name():
    wheel = sg.Segment.cylinder("wheel", length="30 mm", diameter="90 mm")
    masses = [sg.PointMass(name="rim", mass=1.0, on="wheel")]
    scene = sg.Scene.from_parts([ROD, wheel], masses=masses)
    (mass,) = scene.masses
    assert (mass.on, mass.y, mass.seat_width) == (None, 0.215, pytest.approx(0.03))
    tables = scene.to_dict() | {"mass": [{"name": "rim", "mass": 1.0, "on": "wheel"}]}
    assert sg.Scene.from_dict(tables) == scene
    port = sg.Port(name="wheel", at="rod.middle", attach_to="rod")
    assert sg.Scene.from_parts([ROD, wheel], masses=masses, port=port).masses[0].on == "wheel"
