"""The verdict on a train: mixes of models against both shafts solid, on coarse solids."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import solidgear as sg
from solidgear.app import app
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.meshes import mesh_bars
from solidgear.trains.assembly.shaft import LUMPED
from solidgear.trains.file.train import SIDES
from solidgear.trains.judge import judge as judging
from solidgear.trains.judge.judge import JUDGE, judge_train
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.response.drive import Drive

TRAIN = sg.load_train("geometry/axle_overhung.toml")
COARSE = {"harmonic": {"order": 2, "layers": 0}}


@pytest.fixture(scope="module")
def verdict():
    assembly = Assembly(TRAIN, kept=12, settings=COARSE)
    return assembly, judge_train(assembly, 3000.0)


@pytest.mark.long
def test_the_ring_gear_decides_and_not_the_pinion(verdict):
    _, found = verdict
    gear, pinion = found.departure(JUDGE, "timoshenko"), found.departure("timoshenko", JUDGE)
    # the flat ring bends like a plate: its first bending mode rises by more than a tenth
    assert gear.mode == "gear bending 1" and 0.1 < gear.error < 0.2
    assert gear.to_hz < 600 and pinion.to_hz > 2000
    assert (
        found.departure("euler", "euler").cause
        == found.departure("timoshenko", "timoshenko").cause
        == "gear"
    )


def test_the_departures_are_where_the_numbers_say(verdict):
    assembly, found = verdict
    mix = found.departure(JUDGE, "timoshenko")
    mine, own = Drive(assembly, JUDGE, "timoshenko"), Drive(assembly, JUDGE, JUDGE)
    hz = np.linspace(5, 3000, 60_001)
    ratio = np.abs(mine.mesh(hz)[1] / own.mesh(hz)[1])
    off = np.abs(20 * np.log10(ratio)) > 3
    # the first place beyond them is told, and places stand up to 2 % apart
    assert hz[off][0] <= mix.force_to_hz < 1.02 * hz[off][0]
    apart = np.abs(ratio - 1) > 0.02
    assert hz[apart][0] <= mix.close_to_hz < 1.02 * hz[apart][0]


def test_total_mass_along_the_shaft_is_the_largest_error_left_in_the_lumped_model(verdict):
    _, found = verdict
    bending, whole = (found.departure(n, n) for n in ("lumped-bending", "lumped"))
    assert bending.mode == "gear axial 1" and bending.error == pytest.approx(-0.10, abs=0.01)
    assert bending.cause == "axial mass"
    assert whole.to_hz > bending.to_hz
    assert found.departure("lumped-old", "lumped-old").cause == "bending mass"


def test_what_has_as_many_unknowns_stands_in_the_sequence_of_the_ladder(verdict):
    """Lumped models have one body beneath; how long each took changes from run to run."""
    _, found = verdict
    assert [m.mix[0] for m in found.mixes if m.mix[0] in LUMPED] == [*LUMPED]


def test_the_cheapest_mix_holds_up_to_the_frequency_asked(verdict):
    _, found = verdict
    assert found.cheapest is found.mixes[-1]  # to 3 kHz both shafts must be solid
    assert any("gear needs the solid from" in text for text in found.sentences())
    # up to 500 Hz a beam will do, and the cheapest that does is chosen
    low = judging.Verdict(**{**vars(found), "highest_hz": 500.0})
    assert low.cheapest.mix == ("euler", "euler")
    middle = judging.Verdict(**{**vars(found), "highest_hz": 2000.0})
    assert middle.cheapest.models["gear"] == JUDGE and middle.cheapest.models["pinion"] in (
        "euler",
        "timoshenko",
    )


@pytest.mark.long
def test_the_judge_tells_how_sure_its_own_meshes_are(verdict):
    """Against meshes of order 4, which are good to 1e-5: the bar holds what each frequency errs by,
    and is no more than three times as wide. Measured: 1.4 to 2.1.
    """
    found = verdict[1]
    assembly = Assembly(TRAIN, kept=6, settings={"harmonic": {"order": 3, "layers": 0}})
    fine = Assembly(TRAIN, kept=6, settings={"harmonic": {"order": 5, "layers": 1}})
    n = 8
    one, two = (w.system(JUDGE, JUDGE).modes(n) for w in (assembly, fine))
    error = 1 - two.frequency_hz[two.rigid :] / one.frequency_hz[one.rigid :]
    bars = mesh_bars(assembly, assembly.system(JUDGE, JUDGE), dict.fromkeys(SIDES, JUDGE), n)
    assert (0 < error).all() and (error <= bars).all()
    assert (bars < 3 * error).all()
    # the coarser meshes of the verdict are told as such
    assert bars.max() < found.judge_bar < 0.1


def test_a_mode_above_the_list_that_may_lie_in_it_is_told(verdict):
    """Its lower end is what counts: 1/4 of its bar above the limit is within, twice the bar is not."""
    assembly, n = verdict[0], 8
    system = assembly.system(JUDGE, JUDGE)
    bars = mesh_bars(assembly, system, dict.fromkeys(SIDES, JUDGE), n)
    hz, bar = system.elastic[0][n - 1] / (2 * np.pi), bars[-1]
    within, without = (
        train_modes(assembly, JUDGE, JUDGE, max_frequency=hz * (1 - share * bar)).hidden
        for share in (0.25, 2.0)
    )
    assert f"it is at {hz:.2f} Hz" in within and without == ""


@pytest.mark.slow
def test_the_command_writes_the_verdict(tmp_path):
    args = ["judge-system", "geometry/axle_overhung.toml", "--kept", "12", "--max-frequency", "900"]
    done = CliRunner().invoke(app, [*args, "--json", "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    data = json.loads(done.stdout)
    assert data["verdict"]["cheapest"]["gear"] == "harmonic"
    assert (tmp_path / "response.png").stat().st_size > 1000
