"""Lives of the bearings of a train over its operating points."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from command import command

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.load.lives import train_lives
from solidgear.trains.load.operation import Operating

GEOMETRY = Path(__file__).parent.parent / "geometry"
GEARBOX = GEOMETRY / "gearbox_train.toml"


@pytest.fixture(scope="module")
def train():
    return sg.load_train(GEARBOX)


def operated(train, *points):
    common = {"speed": "1500 rpm"}
    return train.with_changes(operation=tuple(common | point for point in points))


def test_lives_belong_to_the_loads_of_the_equilibrium(train):
    one = operated(train, {"torque": 115.0})
    found = {bearing.name: bearing for bearing in train_lives(one)}
    assert list(found) == ["pinion.A", "pinion.B", "gear.C", "gear.D"]
    carried = Operating(Assembly(one)).at(one.operation[0]).equilibrium.load
    for end, bearing in found.items():
        own = bearing.points[0].life
        six = carried[end]
        assert own.life.equivalent.radial == pytest.approx(np.hypot(six[0], six[2]), rel=1e-9)
        low, high = own.range("reference")
        assert low < own.life.reference < high
        assert bearing.duty.revolutions == pytest.approx(
            own.life.modified.life if own.life.modified else own.life.reference
        )
    # the pinion's scene has oil, the wheel's has none
    assert found["pinion.A"].kind == "modified" and found["gear.D"].kind == "reference"
    turns = {end: bearing.points[0].life.speed for end, bearing in found.items()}
    assert turns["pinion.A"] == pytest.approx(50 * math.pi)
    assert turns["gear.D"] == pytest.approx(50 * math.pi * 20 / 57)


def test_duty_adds_the_damage_of_points_up(train):
    points = ({"torque": 60.0, "share": 0.9}, {"torque": 200.0, "share": 0.1})
    for bearing in train_lives(operated(train, *points)):
        light, heavy = (point.life.life for point in bearing.points)
        assert heavy.reference < light.reference
        lives = [
            one.modified.life if bearing.kind == "modified" else one.reference
            for one in (light, heavy)
        ]
        expected = 1 / (0.9 / lives[0] + 0.1 / lives[1])
        assert bearing.duty.revolutions == pytest.approx(expected)
    # points without shares are no duty table
    (first, *_) = train_lives(operated(train, {"torque": 60.0}, {"torque": 200.0}))
    assert first.duty is None and len(first.points) == 2


def test_a_train_without_a_torque_or_without_catalogue_bearings_has_no_lives():
    plain = sg.load_train(GEOMETRY / "axle_straddle.toml")
    with pytest.raises(SolidgearError, match="no operating point"):
        train_lives(plain)
    with pytest.raises(SolidgearError, match="no bearing is described by catalogue data"):
        train_lives(operated(plain, {"torque": 100.0}))


@pytest.mark.long
def test_the_command_tells_lives_of_a_train_over_its_duty_table():
    words = " ".join(command("bearing", GEARBOX).output.split())
    assert "most damage at" in words and "115 N m on the" in words
    (one,) = json.loads(command("bearing", GEARBOX, "--bearing", "gear.D", "--json").stdout)[
        "bearings"
    ]
    assert one["duty"]["worst"] == 0 and sum(one["duty"]["damage"]) == pytest.approx(1)
    assert "shaft and name" in str(command("bearing", GEARBOX, "--bearing", "A").exception)
    out = command("bearing", GEARBOX, "--out", "a.png")
    assert "--out belongs to a scene" in str(out.exception)
