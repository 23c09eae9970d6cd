"""A train, its tables and its file are one thing, with the scenes of its shafts inside."""

import json
import tomllib
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.trains.file.operation import OperatingPoint

GEOMETRY = Path(__file__).parents[1] / "geometry"
#: with catalogue bearings at an operating point; a housing; several gears on a shaft; a planetary
#: stage beside contact cells stands in tests of these
TRAINS = ["axle_thesis", "gearbox_housed", "gearbox_two_stage", "reducer", "gearbox_train"]


@pytest.mark.parametrize("name", TRAINS)
def test_tables_of_a_train_read_back_equal(name):
    train = sg.load_train(GEOMETRY / f"{name}.toml")
    tables = json.loads(json.dumps(train.to_dict()))
    assert sg.Train.from_dict(tables) == train


def test_a_scene_inside_a_train_is_that_of_a_file():
    path = GEOMETRY / "axle_straddle.toml"
    train, tables = sg.load_train(path), tomllib.loads(path.read_text(encoding="utf-8"))
    for side in ("pinion", "gear"):
        file = GEOMETRY / tables[side]["scene"]
        tables[side]["scene"] = tomllib.loads(file.read_text(encoding="utf-8"))
        tables[side]["scene"]["name"] = file.stem
    assert sg.Train.from_dict(tables, name="axle_straddle") == train
    tables["gear"]["scene"]["segment"][0]["diameter"] = "4 kg"
    with pytest.raises(sg.SceneError, match='^axle: gear.scene.segment.1. ".*".diameter = "4 kg"'):
        sg.Train.from_dict(tables, name="axle")


def test_the_table_of_an_operating_point_reads_back_equal():
    point = OperatingPoint(
        torque="115 N*m", speed="3000 rpm", weight="-z", force=[{"at": "gear.A", "x": "1 kN"}]
    )
    assert OperatingPoint.from_dict(json.loads(json.dumps(point.to_dict()))) == point


def test_an_operating_point_of_a_train_keeps_its_forces_and_its_shaft():
    train = sg.load_train(GEOMETRY / "gearbox_train.toml")
    first, last = [*train.shafts][0], [*train.shafts][-1]
    bearing = train.shafts[first].scene.bearings[0].name
    point = OperatingPoint(torque=50.0, of=last, force=[{"at": f"{first}.{bearing}", "z": 300.0}])
    changed = train.with_changes(operation=(point,))
    assert sg.Train.from_dict(changed.to_dict()).operation == changed.operation == (point,)
