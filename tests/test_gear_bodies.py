"""Gears of a train as bodies: what stands below their teeth, what they weigh, and what they bear."""

from pathlib import Path

import pytest

from solidgear.core.errors import SceneError
from solidgear.trains.assembly.gear_bodies import gear_cautions
from solidgear.trains.assembly.layout import contacts
from solidgear.trains.file.reading import load_train

GEOMETRY = Path(__file__).parent.parent / "geometry"


def train_of(name):
    return load_train(GEOMETRY / f"{name}.toml")


BOX, REDUCER = train_of("gearbox_train"), train_of("reducer")


def said(train):
    return [*gear_cautions(train, contacts(train))]


@pytest.mark.parametrize(
    "name", ["axle_overhung", "gearbox_train", "gearbox_two_stage", "gearbox_housed", "reducer"]
)
def test_shipped_gears_are_sound(name):
    assert said(train_of(name)) == []


def exchanged(train):
    """Teeth and pitch radii of pinion and gear exchanged, all else as it was."""
    pinion, gear = train.pinion, train.gear
    return train.with_changes(
        pinion=pinion.with_changes(teeth=gear.teeth, pitch_radius=gear.pitch_radius),
        gear=gear.with_changes(teeth=pinion.teeth, pitch_radius=pinion.pitch_radius),
        operation=(),
    )


def test_exchanged_teeth_stand_on_no_body_and_in_a_head_too_large_for_them():
    """57 teeth roll at 85.5 mm on a shaft of 30 mm; 6.4 kg and 0.0195 kg m2 are of 55 mm of radius."""
    body, head = said(exchanged(BOX))
    assert "roll at 85.5 mm from the axis, but the shaft ends at 30 mm" in body
    assert "radius of gyration of 55.2 mm, and its pitch radius is 30 mm" in head


def test_a_disc_below_the_teeth_is_their_body():
    train = exchanged(BOX)
    disc = {"name": "blank", "mass": 4.0, "on": train.pinion.scene.port.name}
    scene = train.pinion.scene.with_changes(masses=(disc,))
    assert len(said(train.with_changes(pinion=train.pinion.with_changes(scene=scene)))) == 1


def test_teeth_within_the_shaft_are_told():
    thick = tuple(
        s.with_changes(outer0=2 * s.outer0, outer1=2 * s.outer1) if s.name == "pinion" else s
        for s in BOX.pinion.scene.segments
    )
    scene = BOX.pinion.scene.with_changes(segments=thick)
    (text,) = said(BOX.with_changes(pinion=BOX.pinion.with_changes(scene=scene)))
    assert "within the shaft there, whose radius is 60 mm" in text


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"torsional": 0.0195e-3}, "radius of gyration of 1.746 mm"),
        ({"mass": 6.4e-3}, "radius of gyration of 1746 mm"),
        ({"mass": 6.4e3}, "radius of gyration of 1.746 mm"),
        ({"bending": 10.4}, "across"),
        ({"mass": 6.4e3, "torsional": 19.5, "bending": 10.4}, "times a steel disc"),
    ],
)
def test_a_slip_of_a_thousand_in_the_inertia_of_a_gear_is_told(changes, words):
    head = BOX.gear.head.with_changes(**changes)
    (text,) = said(BOX.with_changes(gear=BOX.gear.with_changes(head=head)))
    assert words in text and "units" in text


def with_planet(train, **changes):
    table = train.planetary["stage"]
    planet = table.planet.with_changes(**changes)
    return train.with_changes(planetary={"stage": table.with_changes(planet=planet)})


@pytest.mark.parametrize("changes", [{"torsional": 2.6e-8}, {"mass": 1.1e-4}, {"mass": 110.0}])
def test_a_slip_of_a_thousand_in_the_inertia_of_planets_is_told(changes):
    (text,) = said(with_planet(REDUCER, **changes))
    assert "of the planet of stage are a radius of gyration" in text
    assert "its pitch radius is 21.25 mm" in text


def test_a_slip_in_the_inertia_of_a_ring_is_told():
    table = REDUCER.planetary["stage"]
    springs = {"radial": 1e9, "axial": 1e9, "tilting": 1e6, "turning": 1e6}
    ring = {"mass": 1.2, "torsional": 4.5e-3, "bending": 2.3e-3, "support": springs}
    for factor, count in ((1.0, 0), (1e-3, 1)):
        own = table.with_changes(ring=ring | {"torsional": factor * ring["torsional"]})
        assert len(said(REDUCER.with_changes(planetary={"stage": own}))) == count


def test_no_body_has_half_of_its_torsional_inertia_across():
    with pytest.raises(SceneError, match="less than half of torsional"):
        BOX.gear.head.with_changes(bending=0.005)


@pytest.mark.parametrize("train", [BOX, REDUCER], ids=["pair", "stage"])
def test_a_torque_that_no_teeth_bear_is_told(train):
    """A thousand times what the gears are made for; ten times is no slip."""
    for factor, told in ((10.0, False), (1000.0, True)):
        (point, *_) = train.operation
        loads = {"torque": factor * point.torque, "output_torque": None, "share": None}
        out = [
            t
            for t in said(train.with_changes(operation=(point.with_changes(**loads),)))
            if "MPa" in t
        ]
        assert bool(out) == told
    assert all("check the torque and its unit" in text for text in out)


def test_two_operating_points_of_one_name_are_refused():
    point, other = BOX.operation
    twice = (point, other.with_changes(name=point.name))
    with pytest.raises(SceneError, match="another operating point has this name") as error:
        BOX.with_changes(operation=twice)
    assert error.value.problems[0].path == ("operation", 1, "name")
