"""Order lines over speed: where they cross natural frequencies, and what the mesh force is there."""

import numpy as np
import pytest
from test_train_models import COARSE, OVERHUNG

import solidgear as sg
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.orders import order_map
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.order_chart import spread

TRAIN = sg.load_train(OVERHUNG)
MIX = ("timoshenko", "timoshenko")


@pytest.fixture(scope="module")
def assembly():
    error = {"orders": ("2 um", "1 um")}
    mesh = TRAIN.mesh.with_changes(transmission_error=error)
    return Assembly(TRAIN.with_changes(mesh=mesh), settings=COARSE)


@pytest.fixture(scope="module")
def found(assembly):
    return order_map(assembly, *MIX, highest_hz=3000.0)


def test_an_order_meets_a_mode_where_teeth_and_speed_say(found):
    turns = {"mesh": 14.0, "pinion": 1.0, "gear": 14 / 45}
    assert len({c.line for c in found.crossings}) >= 5
    for c in found.crossings:
        kind, order = c.line.split()
        assert int(order) * turns[kind] * c.rpm / 60 == pytest.approx(c.frequency_hz, rel=1e-12)


def test_every_mode_is_met_by_every_order_that_reaches_it(assembly, found):
    hz = [
        m.frequency_hz
        for m in train_modes(assembly, *MIX, max_frequency=3000.0).modes
        if m.frequency_hz > 0
    ]
    for order in (1, 2, 3):
        met = [c.frequency_hz for c in found.crossings if c.line == f"mesh {order}"]
        assert met == hz  # order n runs out of the chart at the top, never at its end
    shaft = [c.frequency_hz for c in found.crossings if c.line == "pinion 1"]
    assert shaft == [f for f in hz if 60 * f <= found.highest_rpm]


def test_below_the_first_mode_nothing_is_met(assembly):
    assert order_map(assembly, *MIX, highest_hz=10.0).crossings == ()


def test_the_force_on_a_crossing_is_that_of_the_order(assembly, found):
    drive = Drive(assembly, *MIX)
    by = {(c.line, c.mode): c for c in found.crossings}
    for (line, mode), c in by.items():
        if line == "mesh 1":
            force = abs(drive.mesh(np.array([c.frequency_hz]))[1][0])
            assert c.force == pytest.approx(force, rel=1e-9)
            # half the error at the same frequency: half the force, at half the speed
            second = by["mesh 2", mode]
            assert second.force == pytest.approx(force / 2, rel=1e-9)
            assert second.rpm == pytest.approx(c.rpm / 2)
            assert by["mesh 3", mode].force is None  # the transmission error has no third order


def test_the_line_carries_the_response(found, assembly):
    line = found.lines[1]
    hz = line.rpm * 28 / 60
    assert np.allclose(line.force, np.abs(Drive(assembly, *MIX).mesh(hz, 2)[1]), rtol=1e-9)


def test_orders_of_the_mesh_can_be_asked_for(assembly):
    five = order_map(assembly, *MIX, highest_hz=1000.0, mesh_orders=5)
    assert [line.name for line in five.lines if line.name.startswith("mesh")][-1] == "mesh 5"
    with pytest.raises(sg.SolidgearError, match="ask for 1 to 20"):
        order_map(assembly, *MIX, highest_hz=1000.0, mesh_orders=0)


def test_names_are_moved_apart_and_stay_in_order():
    places = np.array([0.1, 0.101, 0.102, 0.5, 0.99, 0.995])
    shown = spread(places, 0.02)
    assert np.diff(shown).min() > 0.02 - 1e-12 and shown.max() <= 1
    assert shown[3] == 0.5 and shown[1] == pytest.approx(0.101)
