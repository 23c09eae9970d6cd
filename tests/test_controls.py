"""Machines whose numbers programs written apart have as well, which share no code with this one."""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg

FOUND = Path(__file__).parent / "found"


def above_zero(frequencies):
    """Natural frequencies without those of free motions, Hz."""
    return np.array([f for f in frequencies if f > 1.0])


# --------------------------------------------------------------------------- trains
#: Hz, the three lowest, by own Timoshenko beams and own reduction of six machines
TRAINS = {
    "bevel_and_planets": (52.0396, 357.175, 719.184),
    "rigid_box": (37.9087, 180.185, 245.512),
    "two_inputs": (58.6085, 106.937, 558.148),
    "idler_three_gears": (42.1218, 86.1492, 557.647),
    "planets_in_series": (78.6299, 505.434, 799.680),
    "long_aluminium": (22.6389, 30.0194, 35.3471),
}
CHEAP = ("bevel_and_planets", "rigid_box", "two_inputs")


@pytest.mark.parametrize("folder", CHEAP)
def test_the_lowest_frequencies_of_trains(folder):
    due = TRAINS[folder]
    train = FOUND / "teeth/trains" / folder / "t.toml"
    modes = sg.system_modes(train, "harmonic", max_frequency=1.01 * due[-1])
    # the light mesh up to so low a frequency is within 5e-4
    assert above_zero(modes.frequency_hz) == pytest.approx(due, rel=5e-4)


@pytest.mark.slow
@pytest.mark.parametrize("folder", TRAINS)
def test_the_lowest_frequencies_of_trains_by_the_usual_models(folder):
    modes = sg.system_modes(FOUND / "teeth/trains" / folder / "t.toml")
    # the two programs agree to 2e-5, on long shafts to 1e-4
    assert above_zero(modes.frequency_hz)[:3] == pytest.approx(TRAINS[folder], rel=1.5e-4)


def test_a_train_from_an_exchange_file_has_the_frequencies_of_its_shafts(tmp_path):
    """Two shafts on springs, one with a wheel: each mode is that of one shaft, by own beams, Hz."""
    gearbox = sg.import_rexs(FOUND / "exchange/ok.rexs", tmp_path / "out")
    modes = sg.system_modes(gearbox.paths[0], "timoshenko", max_frequency=1.9e3)
    for due, rel in ((637.50, 1e-3), (1015.28, 1e-3), (1030.60, 1e-2), (1809.65, 1e-2)):
        # bearings of beams held over their widths or at points: axially less than in bending
        assert min(abs(modes.frequency_hz / due - 1)) < rel


# --------------------------------------------------------------------------- shafts
def test_a_shaft_with_three_discs():
    """Own Timoshenko beam with discs at points; discs of 50 mm that are rigid stiffen the shaft, most of
    all in torsion.
    """
    scene = sg.load(FOUND / "shafts/three_discs.toml")
    modes = above_zero(sg.modes(scene, n=6).frequency_hz)
    assert modes[:4] == pytest.approx([61.70, 64.26, 171.2, 187.8], rel=3e-3)
    assert 260.3 < modes[4] < 1.02 * 260.3


def test_a_rotor_with_two_discs_at_rest():
    """Own Timoshenko beam in two planes, at rest, Hz."""
    scene = sg.load(FOUND / "spin/rotor_two_discs.toml")
    modes = sg.modes(scene, n=8).modes
    bending = [mode.frequency_hz for mode in modes if mode.family == "bending"]
    due = [14.709, 15.440, 43.611, 47.135, 114.43, 121.06]
    assert bending == pytest.approx(due, rel=1e-3)
