"""Many sets of bearings on the same reduced shafts, and losses told in real modes."""

import numpy as np
import pytest
from test_train_models import COARSE, OVERHUNG

import solidgear as sg
from solidgear.core.system.common_loss import common_loss
from solidgear.core.system.steady import SteadyState
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.response.drive import Drive

TRAIN = sg.load_train(OVERHUNG)
MIX = ("timoshenko", "timoshenko")
HZ = np.array([1.0, 16.28, 55.4, 300.0, 661.0, 1458.0, 2500.0, 3900.0])
NEW = {
    "pinion.1": np.diag([3e8, 1e9, 4e8, 2e6, 0.0, 1e6]),
    "gear.4": np.diag([2e9, 5e8, 1e9, 0.0, 0.0, 0.0]),
}


@pytest.fixture(scope="module")
def assembly():
    assembly = Assembly(TRAIN, settings=COARSE)
    Drive(assembly, *MIX)
    return assembly


def afresh(bearings):
    """The same train with other bearings in its scenes, everything built anew."""
    members = {}
    for side in ("pinion", "gear"):
        scene = TRAIN.member(side).scene
        own = [
            b.with_changes(matrix=bearings[f"{side}.{b.name}"].tolist(), axial_series=())
            if f"{side}.{b.name}" in bearings
            else b
            for b in scene.bearings
        ]
        scene = scene.with_changes(bearings=tuple(own))
        members[side] = TRAIN.member(side).with_changes(scene=scene)
    return Assembly(TRAIN.with_changes(**members), settings=COARSE)


def test_other_bearings_on_the_same_shafts_are_those_of_a_new_train(assembly):
    other = assembly.with_bearings(NEW)
    assert other.shaft_model("gear", MIX[1]) is assembly.shaft_model(
        "gear", MIX[1]
    )  # nothing was built again
    found, whole = Drive(other, *MIX).columns(HZ), Drive(afresh(NEW), *MIX).columns(HZ)
    usual = Drive(assembly, *MIX).columns(HZ)
    assert list(found) == list(whole)
    for name, value in whole.items():
        size = np.abs(value).max()
        assert np.allclose(found[name], value, rtol=1e-9, atol=1e-9 * size), name
    assert np.abs(found["mesh force [N]"] / usual["mesh force [N]"] - 1).max() > 0.1


def test_lumped_models_are_condensed_on_the_new_bearings(assembly):
    lumped = ("lumped/timoshenko",) * 2
    Drive(assembly, *lumped)
    found = Drive(assembly.with_bearings(NEW), *lumped).mesh(HZ)[1]
    assert np.allclose(found, Drive(afresh(NEW), *lumped).mesh(HZ)[1], rtol=1e-9)


def test_unknown_bearings_are_told(assembly):
    with pytest.raises(sg.SolidgearError, match=r"no bearing .*there are .*pinion\.1"):
        assembly.with_bearings({"pinion.7": np.eye(6)})


@pytest.mark.parametrize(
    ("changes", "rows"),
    [
        ({}, 1),  # the teeth alone differ
        ({"engine spring": 0.3, "load spring": 0.0}, 3),
        ({"mesh": 0.04}, 0),
        ({"pinion": 0.01}, None),  # a whole shaft differs: complex modes
    ],
)
def test_losses_in_real_modes_are_those_of_the_full_matrices(assembly, changes, rows):
    drive = Drive(assembly, *MIX)
    loss = drive.steady.loss | changes
    found = common_loss(drive.system, loss)
    assert (None if found is None else len(found.difference)) == rows
    steady = SteadyState(drive.system, loss)
    force = drive.system.load({"gear.gear": [0, 0, 1.0, 0, 0, 0]})
    for load in (drive.load, force, (1 + 2j) * force + drive.load):
        seen = np.vstack([drive.row, drive.system.motion("pinion.2"), drive.system.motion("load")])
        modal, direct = steady.motion(HZ, load, seen), steady.solved(HZ, load, seen)
        largest = np.abs(direct).max(axis=0)
        assert np.all(np.abs(modal - direct) <= 1e-9 * largest + 1e-30)


def test_the_series_of_far_modes_leaves_nothing(assembly):
    """Asked for alone, a low frequency has more far modes than among high ones."""
    drive = Drive(assembly, *MIX)
    together = drive.mesh(np.r_[HZ, 12_000.0])[0][:-1]
    alone = np.concatenate([drive.mesh(np.array([hz]))[0] for hz in HZ])
    assert np.allclose(together, alone, rtol=1e-10)
