"""The largest dynamic mesh force of a train, said first, and the speeds at which it is met."""

import json

import pytest

import solidgear as sg
from solidgear.studies.train.loudest import loudest
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.modes import train_modes
from solidgear.studies.train.respond import respond
from tests.command import command

BEAMS = ("timoshenko", "timoshenko")
GEARBOX = sg.load_train("geometry/gearbox_train.toml")


def top_of(train, highest_hz=None):
    shop = Workshop(train)
    modes = train_modes(shop, *BEAMS, max_frequency=highest_hz).modes
    return loudest(respond(shop, *BEAMS, highest_hz=highest_hz), modes, train, shop.scenes)


@pytest.fixture(scope="module")
def gearbox():
    return top_of(GEARBOX)


def test_the_peak_told_first_is_one_that_teeth_meet_at_the_speeds_given(gearbox):
    # 2200 rpm of 20 teeth; the largest peak of the range lies at four times that
    assert gearbox.rpm == pytest.approx(2200)
    assert gearbox.peak.frequency_hz < 2200 * 20 / 60 < gearbox.beyond.frequency_hz
    assert gearbox.peak.force < gearbox.beyond.force
    first, second = gearbox.sentences()
    rpm = f"pinion at {60 * gearbox.peak.frequency_hz / 20:.0f} rpm"
    assert rpm in first and gearbox.peak.mode in first and "no bar" in first
    assert "cannot be reached" in second and "733 Hz" in second


def test_a_range_that_ends_below_the_speeds_is_told():
    told = top_of(GEARBOX, 500.0).sentences()
    assert "does not cover the speeds" in told[-1] and "733 Hz" in told[-1]


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
