"""Lives of the bearings of a train over its operating points."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from command import command

import solidgear as sg
from solidgear.errors import SolidgearError
from solidgear.studies.train.life import train_lives
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.operation import Operating

GEOMETRY = Path(__file__).parent.parent / "geometry"
WHEEL = """
[material]
E = "206 GPa"
nu = 0.29
density = "7830 kg/m^3"
[[segment]]
kind = "cylinder"
name = "whole"
length = "250 mm"
diameter = "50 mm"
[[bearing]]
name = "g1"
position = "18 mm"
seat_width = "20 mm"
stiffness = {kxx = "3e8 N/m", kyy = "1.2e8 N/m", kzz = "3e8 N/m"}
[[bearing]]
name = "g2"
position = "-20 mm"
from = "end"
seat_width = "30 mm"
[bearing.catalogue]
designation = "6210"
load_rating = "35.1 kN"
[port]
name = "wheel"
position = "95 mm"
attach_to = "whole"
"""
TRAIN = """
[pinion]
scene = "{pinion}"
scene_load = "replaced"
teeth = 20
hand = "right"
loaded_side = "concave"
pitch_radius = "30 mm"
pitch_angle = 0.0
spiral_angle = "15 deg"
face_width = "50 mm"
[gear]
scene = "wheel.toml"
teeth = 57
hand = "left"
loaded_side = "convex"
pitch_radius = "85.5 mm"
pitch_angle = 0.0
spiral_angle = "15 deg"
[gear.head]
mass = "6.4 kg"
torsional = "0.0195 kg*m^2"
bending = "0.0104 kg*m^2"
[mesh]
shaft_angle = 0
stiffness = "3.2e8 N/m"
pressure_angle = "20 deg"
transmission_error = "1 um"
[engine]
inertia = "0.03 kg*m^2"
[engine.spring]
stiffness = "4e3 N*m/rad"
at = "B"
[load]
inertia = "0.3 kg*m^2"
[load.spring]
stiffness = "9e3 N*m/rad"
at = "g1"
[operation]
torque = "60 N*m"
"""


@pytest.fixture(scope="module")
def train(tmp_path_factory):
    folder = tmp_path_factory.mktemp("train")
    (folder / "wheel.toml").write_text(WHEEL)
    pinion = (GEOMETRY / "gearbox_catalogue.toml").as_posix()
    (folder / "train.toml").write_text(TRAIN.format(pinion=pinion))
    return sg.load_train(folder / "train.toml")


def operated(train, *points):
    common = {"speed": "1500 rpm"}
    return train.with_changes(operation=tuple(common | point for point in points))


def test_lives_belong_to_the_loads_of_the_equilibrium(train):
    one = operated(train, {"torque": 115.0})
    found = {bearing.end: bearing for bearing in train_lives(one)}
    assert list(found) == ["pinion.A", "pinion.B", "gear.g2"]
    carried = Operating(Workshop(one)).at(one.operation[0]).equilibrium.load
    for end, bearing in found.items():
        (own,) = bearing.lives
        six = carried[end]
        assert own.life.equivalent.radial == pytest.approx(np.hypot(six[0], six[2]), rel=1e-9)
        low, high = own.range("reference")
        assert low < own.life.reference < high
        assert bearing.duty.revolutions == pytest.approx(
            own.life.modified.life if own.life.modified else own.life.reference
        )
    # the pinion's scene has oil, the wheel's has none
    assert found["pinion.A"].kind == "modified" and found["gear.g2"].kind == "reference"
    turns = {end: bearing.lives[0].speed for end, bearing in found.items()}
    assert turns["pinion.A"] == pytest.approx(50 * math.pi)
    assert turns["gear.g2"] == pytest.approx(50 * math.pi * 20 / 57)


def test_duty_adds_the_damage_of_points_up(train):
    points = ({"torque": 60.0, "share": 0.9}, {"torque": 200.0, "share": 0.1})
    for bearing in train_lives(operated(train, *points)):
        light, heavy = (one.life for one in bearing.lives)
        assert heavy.reference < light.reference
        lives = [
            one.modified.life if bearing.kind == "modified" else one.reference
            for one in (light, heavy)
        ]
        expected = 1 / (0.9 / lives[0] + 0.1 / lives[1])
        assert bearing.duty.revolutions == pytest.approx(expected)
    # points without shares are no duty table
    (first, *_) = train_lives(operated(train, {"torque": 60.0}, {"torque": 200.0}))
    assert first.duty is None and len(first.lives) == 2


def test_a_train_without_a_torque_or_without_catalogue_bearings_has_no_lives():
    plain = sg.load_train(GEOMETRY / "axle_straddle.toml")
    with pytest.raises(SolidgearError, match="no operating point"):
        train_lives(plain)
    with pytest.raises(SolidgearError, match="no bearing is described by catalogue data"):
        train_lives(operated(plain, {"torque": 100.0}))


def test_the_command_tells_lives_of_a_train_over_its_duty_table(train, tmp_path):
    (tmp_path / "wheel.toml").write_text(WHEEL)
    pinion = (GEOMETRY / "gearbox_catalogue.toml").as_posix()
    duty = "".join(
        f'[[operation]]\ntorque = {torque}\nspeed = "1500 rpm"\nshare = {share}\n'
        for torque, share in ((60.0, 0.9), (200.0, 0.1))
    )
    path = tmp_path / "train.toml"
    text = TRAIN.format(pinion=pinion)
    path.write_text(text[: text.index("[operation]")] + duty)
    words = " ".join(command("bearing", path).output.split())
    assert "most damage at" in words and "200 N m on the" in words
    (one,) = json.loads(command("bearing", path, "--bearing", "gear.g2", "--json").stdout)[
        "bearings"
    ]
    assert one["duty"]["worst"] == 1 and sum(one["duty"]["damage"]) == pytest.approx(1)
    assert "shaft and name" in str(command("bearing", path, "--bearing", "A").exception)
    out = command("bearing", path, "--out", "a.png")
    assert "--out belongs to a scene" in str(out.exception)
