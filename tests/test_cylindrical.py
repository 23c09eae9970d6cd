"""Parallel shafts in the words of cylindrical gears come to the same train as in those of bevel gears."""

from math import acos, atan, cos, degrees, radians, tan
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SceneError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.layout import contacts
from solidgear.trains.file.cylindrical import working_cylinders
from solidgear.trains.load.operation import at_point
from solidgear.trains.modes.modes import train_modes

GEOMETRY = Path(__file__).parent.parent / "geometry"
PLAIN = {"pitch_radius": None, "spiral_angle": None, "pitch_angle": None, "scene_load": "replaced"}


def test_helical_gears_of_a_published_table():
    """Kohara, Gear Technical Reference (2015), table 4.20: normal module 3, 12 and 60 teeth, 30
    degrees; 23.1126 degrees across the axis at a centre distance of 125 mm.
    """
    found = working_cylinders((12, 60), 3e-3, radians(30), radians(20), shift=(0.09809, 0.0))
    assert 1e3 * sum(found.radii) == pytest.approx(125.0, abs=5e-4)
    across = degrees(atan(tan(found.pressure_angle) / cos(found.helix_angle)))
    assert across == pytest.approx(23.1126, abs=5e-5)


@pytest.mark.parametrize("centre", [106.5e-3, 108.5e-3, 115e-3])
def test_base_circles_and_base_helix_are_those_of_the_teeth_at_any_distance(centre):
    """Involutes know their base circle alone: neither it nor its helix moves with the axes."""
    module, helix, pressure = 2.5e-3, radians(18), radians(20)
    found = working_cylinders((23, 57), module, helix, pressure, centre_distance=centre)
    across = atan(tan(pressure) / cos(helix))
    base = module * 23 / 2 / cos(helix) * cos(across)
    at_work = atan(tan(found.pressure_angle) / cos(found.helix_angle))
    assert found.radii[0] * cos(at_work) == pytest.approx(base, rel=1e-12)
    assert tan(found.helix_angle) * cos(at_work) == pytest.approx(
        tan(helix) * cos(across), rel=1e-12
    )
    assert sum(found.radii) == pytest.approx(centre, rel=1e-14)
    assert at_work == pytest.approx(acos(base * 80 / 23 / centre), rel=1e-12)


@pytest.fixture(scope="module")
def gearbox():
    return sg.load_train(GEOMETRY / "gearbox_train.toml").with_changes(operation=())


def in_own_words(train, **mesh):
    """The gearbox by normal module and helix angle: 60 mm over 20 teeth at 15 degrees."""
    members = {
        side: train.member(side).with_changes(**PLAIN, module=3e-3 * cos(radians(15)))
        for side in ("pinion", "gear")
    }
    members["pinion"] = members["pinion"].with_changes(helix_angle=radians(15))
    return train.with_changes(**members, mesh=train.mesh.with_changes(**mesh))


@pytest.mark.parametrize("mesh", [{}, {"centre_distance": 115.5e-3}])
def test_module_and_helix_give_the_contact_of_radius_and_spiral(gearbox, mesh):
    here, there = contacts(in_own_words(gearbox, **mesh))["mesh"], contacts(gearbox)["mesh"]
    for side in ("pinion", "gear"):
        one, two = getattr(here, side), getattr(there, side)
        assert one.normal == pytest.approx(two.normal, abs=1e-12)
        assert one.point == pytest.approx(two.point, abs=1e-14)


def test_straight_teeth_need_neither_hand_nor_helix(gearbox):
    pinion = gearbox.pinion.with_changes(**PLAIN, module=3e-3, hand=None)
    spur = gearbox.with_changes(
        pinion=pinion, gear=gearbox.gear.with_changes(**PLAIN, module=None, hand=None)
    )
    normal = contacts(spur)["mesh"].pinion.normal
    assert normal[1] == pytest.approx(0.0, abs=1e-15)
    assert abs(normal[0] / normal[2]) == pytest.approx(tan(radians(20)), rel=1e-12)


def test_a_hand_without_a_helix_is_an_omission(gearbox):
    pinion = gearbox.pinion.with_changes(**PLAIN, module=3e-3)
    with pytest.raises(SceneError, match="is missing") as error:
        contacts(gearbox.with_changes(pinion=pinion, gear=gearbox.gear.with_changes(**PLAIN)))[
            "mesh"
        ]
    assert error.value.problems[0].path == ("pinion", "helix_angle")


@pytest.mark.parametrize(
    ("pinion", "mesh", "words"),
    [
        ({"pitch_radius": 0.03}, {}, "write module alone"),
        ({"spiral_angle": 0.2}, {}, "write helix_angle alone"),
        ({}, {"shaft_angle": 1.0}, "is for parallel shafts"),
        ({"module": 2e-3}, {}, "write one value for both wheels"),
    ],
)
def test_words_that_contradict_are_refused(gearbox, pinion, mesh, words):
    train = in_own_words(gearbox)
    with pytest.raises(SceneError) as error:
        train.with_changes(
            pinion=train.pinion.with_changes(**pinion), mesh=train.mesh.with_changes(**mesh)
        )
    assert any(words in problem.reason for problem in error.value.problems)


def test_axes_too_near_for_the_teeth_are_refused_with_the_least_distance(gearbox):
    with pytest.raises(SceneError, match=r"below 10\d\.\d+ mm, the sum of the base radii"):
        contacts(in_own_words(gearbox, centre_distance=100e-3))["mesh"]


def test_names_belong_to_their_shaft(gearbox):
    """Bearings of both shafts may be called alike: a train calls them by shaft and name."""
    names = {"C": "A", "D": "B"}
    scene = gearbox.gear.scene
    bearings = tuple(b.with_changes(name=names[b.name]) for b in scene.bearings)
    spring = gearbox.load.spring.with_changes(at="B")
    alike = gearbox.with_changes(
        gear=gearbox.gear.with_changes(scene=scene.with_changes(bearings=bearings)),
        load=gearbox.load.with_changes(spring=spring),
    )
    both = [
        train_modes(Assembly(settled(train)), "timoshenko", "timoshenko", max_frequency=2000.0)
        for train in (gearbox, alike)
    ]
    one, two = ([(m.frequency_hz, m.name) for m in found.modes] for found in both)
    assert [name for _, name in one] == [name for _, name in two]
    assert np.array([hz for hz, _ in one]) == pytest.approx([hz for hz, _ in two], rel=1e-9)


def settled(train):
    """At 50 N m: its bearings have no stiffness before."""
    return at_point(train.with_changes(operation=({"torque": 50.0},)))
