"""A caution belongs to a number: whoever shows the number says it."""

from pathlib import Path

import pytest

import solidgear as sg
from validation.agree import cautions
from validation.agree.commands import Printed
from validation.agree.relation import failed

FOUND = Path(__file__).parent / "found"
JOINT, DISC = FOUND / "shafts/seat_to_joint.toml", FOUND / "spin/disc_at_speed.toml"
RIM = FOUND / "teeth/rim_1.4m/t.toml"
BEAMS = ("--pinion", "timoshenko", "--gear", "timoshenko")
ON_SEAT = "where exactly the seat end of B at a change of material lies"
AT_SPEED = "at 12000 rpm spin moves bending 1 by -27 %"


def said_by(run, tmp_path, *words):
    """What a command prints, in a line."""
    out = ("--out", tmp_path / "out.csv") if words[0] == "sweep" else ()
    out = ("--out", tmp_path / "out.npz") if words[0] == "export" else out
    code, shown, err = run(*words, *out)
    assert code in (0, 3)
    return " ".join((shown + err).split())


@pytest.mark.parametrize(
    "words",
    [
        ("stiffness", "-f", "harmonic", "--set", "order=3"),
        ("modes", "-f", "harmonic", "--set", "order=3"),
        ("deflect", "-f", "harmonic", "--load", "z=1 kN"),
        ("sensitivities", "-f", "harmonic", "--of", "C_zz", "--by", "material.E"),
        ("sweep", "-f", "harmonic", "--set", "order=3", "--vary", "segment.shaft.length=60 mm"),
        ("sweep", "-f", "harmonic", "--vary", "bearing.A.scale=1"),
        ("export", "--model", "harmonic"),
    ],
    ids=lambda words: " ".join(words[:1] + words[-1:]),
)
def test_a_seat_that_the_drawing_decides_is_said_wherever_a_solid_has_it(words, run, tmp_path):
    command, *options = words
    assert said_by(run, tmp_path, command, JOINT, *options).count(ON_SEAT) == 1


def test_a_beam_has_no_end_of_a_seat(run, tmp_path):
    beam = said_by(run, tmp_path, "deflect", JOINT, "-f", "timoshenko", "--load", "z=1 kN")
    assert ON_SEAT not in beam


@pytest.mark.parametrize(
    "words",
    [
        ("deflect", "-f", "timoshenko"),
        ("system-modes", *BEAMS),
        ("response", *BEAMS),
        ("sweep", *BEAMS, "--vary", "operation.torque=300", "--ask", "deflect"),
        ("export", "--model", "timoshenko"),
    ],
    ids=lambda words: words[0],
)
def test_teeth_on_a_thin_rim_are_said_wherever_their_stiffness_counts(words, run, tmp_path):
    command, *options = words
    rim = "a rim of 1.4 modules below the roots softens the teeth"
    assert said_by(run, tmp_path, command, RIM, *options).count(rim) == 1


def test_modes_and_their_page_say_what_spin_does():
    scene = sg.load(DISC)
    beam = sg.build(scene, "timoshenko")
    modes = sg.modes(beam, scene, n=4)
    assert AT_SPEED in modes.cautions[0]
    assert AT_SPEED in sg.turn(beam, modes).page()
    # of bearings alone nobody knows the speed
    assert sg.modes(beam, scene.bearings, n=4).cautions == ()


def test_a_finer_mesh_that_cannot_be_solved_leaves_the_state_on_its_own():
    # rounding refuses a mesh so fine at the end of the seat; the line of the shaft is of the mesh before
    shaft = sg.deflect(JOINT, load={"z": "1 kN"}).judge.shafts[0]
    assert shaft.bearings[1].load[2] == pytest.approx(1000.0, rel=1e-3)  # nearly all on the clamp


def test_a_command_that_is_silent_is_found():
    loud = Printed(0, {"cautions": ["where exactly it lies decides numbers"]}, "", "")
    silent = Printed(0, {"cautions": []}, "", "")
    printed = {"stiffness": loud, "deflect": silent, "modes": loud}
    (missing,) = failed(cautions.alike("shaft", printed))
    assert "deflect cautions as" in missing.name
    # frequencies are no concern of static numbers
    moving = Printed(0, {"cautions": ["natural frequencies are those at rest"]}, "", "")
    assert not failed(cautions.alike("shaft", {"modes": moving, "deflect": silent}))


def test_a_sweep_says_what_any_of_its_rows_has_and_which():
    """Spin moves no frequency at 60 rpm: the first row has no caution, the others have."""
    vary = "lubrication.speed=60 rpm,6000 rpm,12000 rpm"
    swept = sg.sweep(DISC, vary, model="timoshenko", n=2)
    first, slow, fast = swept["cautions"]
    assert first is None and "at 6000 rpm" in slow and AT_SPEED in fast
    (said,) = swept.cautions
    assert said == f"{slow} (variant 1; alike in 2 of 3 rows, column cautions)"


def test_an_optimum_says_what_its_best_design_has():
    vary, goal = "segment.shaft.diameter=38 mm,40 mm", "max bending 1"
    still = sg.load(DISC).with_changes(lubrication=None)
    assert not sg.optimise(still, vary, goal, model="timoshenko").cautions
    (said,) = sg.optimise(DISC, vary, goal, model="timoshenko").cautions
    assert "at 12000 rpm spin moves bending 1 by" in said
