"""The largest dynamic mesh force of a train, said first, and the speeds at which it is met."""

import json

import numpy as np
import pytest

import solidgear as sg
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.loudest import loudest
from solidgear.trains.response.respond import respond
from tests.command import command

BEAMS = ("timoshenko", "timoshenko")
AXLE = sg.load_train("geometry/axle_overhung.toml")
GEARBOX = sg.load_train("geometry/gearbox_train.toml")


def top_of(train, highest_hz=None, mix=BEAMS):
    assembly = Assembly(train)
    modes = train_modes(assembly, *mix, max_frequency=highest_hz).modes
    return loudest(respond(assembly, *mix, highest_hz=highest_hz), modes, train, assembly.scenes)


def at_speed(hz, orders=("1 um",)):
    """The axle at a speed at which its 14 teeth pass at a frequency, Hz."""
    point = {"torque": "1 kN*m", "speed": f"{60 * hz / 14} rpm", "name": "run"}
    mesh = AXLE.mesh.with_changes(transmission_error={"orders": orders})
    return AXLE.with_changes(operation=point, meshes=(mesh,))


@pytest.fixture(scope="module")
def gearbox():
    return top_of(GEARBOX)


@pytest.fixture(scope="module")
def largest():
    """The largest peak of the axle in all its range."""
    return top_of(AXLE.with_changes(meshes=at_speed(0.0).meshes)).top


def test_the_peak_told_first_is_one_that_teeth_meet_at_the_speeds_given(gearbox):
    # 2200 rpm of 20 teeth; the largest peak of the range lies at four times that
    assert gearbox.rpm == pytest.approx(2200)
    assert gearbox.top.frequency_hz < 2200 * 20 / 60 < gearbox.beyond.frequency_hz
    assert gearbox.top.force < gearbox.beyond.force and gearbox.peak is None
    first, second = gearbox.sentences()
    rpm = f"pinion at {60 * gearbox.top.frequency_hz / 20:.0f} rpm"
    assert rpm in first and gearbox.top.mode in first and "without error bar" in first
    assert "lies beyond the highest speed" in second and "733 Hz" in second


def test_where_the_highest_speed_stands_on_a_flank_the_curve_there_is_the_largest(largest):
    limit = 0.98 * largest.frequency_hz
    train = at_speed(limit)
    found = top_of(train)
    there = abs(Drive(Assembly(train), *BEAMS).mesh(np.array([limit]))[1][0])
    # one point of the grid stands at the very speed
    assert found.top.frequency_hz == pytest.approx(limit, rel=1e-9)
    assert found.top.force == pytest.approx(there, rel=1e-9)
    assert found.top.force > found.peak.force and not found.top.mode
    first, second, third = found.sentences()
    assert "the highest speed, still rising towards " + found.beyond.mode in first
    assert f"{found.peak.force:.0f} N" in second and largest.mode in third


def test_an_order_of_the_teeth_that_reaches_a_mode_at_half_the_speed_is_told(largest):
    # 0.6 of the frequency of the largest peak: the first order stays below, the second passes it
    found = top_of(at_speed(0.6 * largest.frequency_hz, ("1 um", "1 um")))
    assert found.top.order == 2
    assert found.top.mode == largest.mode
    assert found.top.force == pytest.approx(largest.force, rel=1e-3)
    rpm = 60 * found.top.frequency_hz / 2 / 14
    assert f"order 2 of the teeth, pinion at {rpm:.0f} rpm" in found.sentences()[0]


def test_a_range_that_ends_below_an_order_of_the_teeth_is_told():
    lines = top_of(at_speed(700.0, ("1 um", "1 um")), 1000.0).sentences()
    assert "teeth's 700 Hz at 3000 rpm, their order 2 at 1400 Hz" in lines[-1]


def test_a_train_that_stands_still_is_told_of_all_its_range(largest):
    found = top_of(at_speed(0.0))
    assert found.top.force == pytest.approx(largest.force, rel=1e-3)
    first, second = found.sentences()
    assert first.startswith("Largest dynamic mesh force up to 4000 Hz: ")
    assert second.startswith("At 0 rpm (operation 'run') nothing drives the train")


def test_a_curve_that_still_rises_where_the_range_ends_is_largest_there(largest):
    highest = 0.98 * largest.frequency_hz
    found = top_of(AXLE.with_changes(meshes=at_speed(0.0).meshes), highest)
    assert found.top.frequency_hz == pytest.approx(highest) and found.beyond is None
    assert (
        "Hz, pinion at " in found.sentences()[0]
        and "the end of the range (" in found.sentences()[0]
    )


def test_a_range_that_ends_below_the_speeds_is_told():
    told = top_of(GEARBOX, 500.0).sentences()
    assert "ends below the teeth's" in told[-1] and "733 Hz" in told[-1]


@pytest.mark.long
def test_without_speeds_the_largest_peak_of_the_range_is_told(tmp_path):
    words = ("--pinion", "timoshenko", "--gear", "timoshenko", "--out", tmp_path)
    done = command("response", "geometry/axle_overhung.toml", *words)
    peaks = json.loads((tmp_path / "response.json").read_text())["responses"][0]["peaks"]
    largest = max(peaks, key=lambda peak: peak["force"])
    line = done.stdout.split("losses", 1)[1].splitlines()[1]
    assert line.startswith("Largest dynamic mesh force up to 4000 Hz: ")
    assert f"{largest['force']:.0f} N" in line and largest["mode"] in line
    assert line in (tmp_path / "response.html").read_text().replace("&#39;", "'")
