"""A scene, its tables and its file are one thing: what one gives the others read back equal."""

import json
import math
from pathlib import Path

import pytest
import strategies
from hypothesis import given, settings

import solidgear as sg
from solidgear.core.scene import BearingLoad, Elastic, Housing, Strength
from solidgear.core.scene.materials import by_name

GEOMETRY = Path(__file__).parents[1] / "geometry"
SCENES = ["pinion_spiral", "pinion_keyed", "pinion_filleted", "rotor_disc", "gearbox_middle"]


def reads_back(scene: sg.Scene) -> None:
    """Assert that the tables of a scene read back equal, to the bit."""
    tables = json.loads(json.dumps(scene.to_dict()))
    again = sg.Scene.from_dict(tables)
    assert again == scene
    assert json.dumps(again.as_dict()) == json.dumps(scene.as_dict())


@pytest.mark.parametrize("name", SCENES)
def test_tables_of_a_shipped_scene_read_back_equal(name):
    """Bevel heads, cuts, blends, masses, arrangements, housings, ranges."""
    reads_back(sg.load(GEOMETRY / f"{name}.toml"))


@settings(max_examples=15, deadline=None)
@given(strategies.scenes())
def test_tables_of_any_scene_read_back_equal(scene):
    reads_back(scene)


def test_tables_hold_what_no_shipped_scene_has():
    """Conical bores, strengths, held faces, a housing of each bearing and of all."""
    steel = sg.Material(
        E=2.1e11, nu=0.3, density=7850, strength=Strength(yield_point=4e8, ultimate=6e8)
    )
    segments = [
        sg.Segment(name="a", y0=0, y1=0.1, outer0=0.03, outer1=0.03, inner0=0.01, inner1=0.012),
        sg.Segment(name="b", y0=0.1, y1=0.3, outer0=0.03, outer1=0.02, inner0=0.01, inner1=0.01),
    ]
    segments[0] = segments[0].with_changes(material=steel)
    segments[1] = segments[1].with_changes(material=sg.Material(**by_name("aluminium")))
    wall = Elastic(stiffness={"kxx": 2e8, "kzz": 2e8, "kyy": 0.0})
    scene = sg.Scene.from_parts(
        segments,
        steel,
        bearings=[
            sg.Bearing(
                name="wall", y=0.0, seat_width=0.01, hold="clamped", face="start", housing=wall
            ),
            sg.Bearing(
                name="A",
                y=1 / 3 * 0.2,
                seat_width=0.02,
                stiffness={"kxx": 1 / 3 * 1e9, "kyy": 1e8},
                axial_series=[1e7],
                scale=0.7,
                status="measured",
                note="bench",
            ),
        ],
        masses=[
            sg.PointMass(mass=2, inertia=[0.01, 0.02, 0.01], on="A"),
            sg.PointMass(name="hub", mass=1, y=0.03, seat_width=0.01),
        ],
        housing=Housing(stiffness={"kthx": 1e6, "kxx": 1e8, "kx_thx": 1e3}, y=0.1),
        load=BearingLoad(z=-1e3, thx=math.pi),
        lubrication=sg.Lubrication(viscosity=68e-6, cleanliness="normal", speed=100.0),
        ask=sg.Ask(modes=4, max_frequency=1e4, quantities=["C_zz", "bending 1"]),
    )
    reads_back(scene)
    reads_back(scene.with_attachment("rigid"))


def test_a_stiffness_at_load_stands_in_the_tables_for_that_load_alone():
    scene = sg.load(GEOMETRY / "gearbox_catalogue.toml")
    tables = scene.to_dict()
    reads_back(scene)
    reads_back(scene.with_bearing_scale(2.0))  # no load gives this one
    reads_back(scene.with_changes(load=scene.load.with_changes(z=500.0)))  # none is solved yet
    tables["load"]["z"] *= 2
    heavier = scene.load.with_changes(z=2 * scene.load.z)
    assert sg.Scene.from_dict(tables) == scene.with_changes(load=heavier).settled != scene


def test_errors_of_tables_name_them_as_a_file():
    tables = sg.load(GEOMETRY / "shaft_stepped.toml").to_dict()
    tables["segment"][1]["diameter"] = "-3 mm"
    with pytest.raises(sg.SceneError) as error:
        sg.Scene.from_dict(tables, name="neck")
    assert str(error.value).startswith('neck: segment[2] "middle".diameter = "-3 mm": must be')
