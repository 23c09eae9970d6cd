"""check on a train: the guards of both shafts, and what concerns the system."""

import json
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.guards.check import Check, Verdict
from solidgear.guards.probe import Probe
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.slips import mesh_unit_slips, unit_slips
from solidgear.trains.judge import check as checked
from solidgear.trains.judge.check import check_train
from tests.command import command

AXLE = "geometry/axle_overhung.toml"
TRAIN = sg.load_train(AXLE)


@pytest.fixture(scope="module")
def found():
    return check_train(Assembly(TRAIN))


def said(lines, *words):
    return [line for line in lines if all(word in line for word in words)]


@pytest.mark.long
def test_both_shafts_are_heard_up_to_what_the_train_asks(found):
    assert said(found.shafts["pinion"].facts, "15.91 kg")
    assert said(found.shafts["gear"].facts, "79.82 kg")
    # the pinion's own file asks 10 kHz and 5 %
    assert said(found.shafts["pinion"].cautions, "4000 Hz asked for")
    assert said(found.shafts["pinion"].cautions, "more than the 2 % asked for")


def test_the_worse_of_both_shafts_is_told(found):
    verdicts = found.verdicts
    assert verdicts["harmonic"] == Verdict("holds")
    assert verdicts["solid"] == Verdict("holds with caution", ("gear",))
    assert verdicts["timoshenko"].reasons == ("pinion", "gear")


def test_what_concerns_the_system(found):
    assert said(found.cautions, "pitch angle of 0.391 rad does not match 14 and 45 teeth")
    assert said(found.cautions, "the gear has modes with nodal diameters", "n = 2 at 18")
    assert said(found.facts, "12 elastic modes up to 4000 Hz", "within 0.001")
    assert said(found.facts, "the whole train turns freely")
    assert said(found.facts, "twice a damping ratio", "mesh 0.12")
    assert said(found.facts, "Assumed, not published: mesh.transmission_error")
    assert not said(found.cautions, "loss factor is below")


@pytest.fixture
def no_shafts(monkeypatch):
    """Only what is said of the system, of light shafts whose meshes need no bars."""
    quiet = Check("quiet", (), {})
    monkeypatch.setattr(checked, "check_scene", lambda *_: quiet)
    monkeypatch.setattr(checked, "build", lambda *what, **_: sg.build(*what, order=2, layers=0))
    monkeypatch.setattr(Probe, "solution", lambda probe, *_: probe)


def test_little_loss_and_a_short_table_are_told(no_shafts):
    table = {"frequency": [10.0, 900.0], "amplitude": [1e-6, 1e-6]}
    mesh = type(TRAIN.mesh)(**TRAIN.mesh.model_dump() | {"transmission_error": table})
    odd = TRAIN.with_changes(mesh=mesh, losses=TRAIN.losses.with_changes(springs=1e-4))
    cautions = check_train(Assembly(odd)).cautions
    assert said(cautions, "springs 0.0001", "depend on this number alone")
    assert said(cautions, "given up to 900 Hz", "constant from there to the 4000 Hz")


@pytest.mark.parametrize(
    "key, factor",
    [("stiffness", 1e-3), ("stiffness", 1e3), ("transmission_error", 1e3)],
)
def test_a_slip_of_a_thousand_in_the_mesh_is_told(no_shafts, key, factor):
    """Of the stiffness either way, of the transmission error upward; ten times is no slip."""
    for size, slip in ((factor, True), (factor ** (1 / 3), False)):
        value = {"stiffness": 2.5e8, "transmission_error": 2e-6}[key] * size
        mesh = type(TRAIN.mesh)(**TRAIN.mesh.model_dump() | {key: value})
        told = check_train(Assembly(TRAIN.with_changes(mesh=mesh))).cautions
        assert bool(said(told, "probably a wrong unit", key.replace("_", " "))) == slip


def test_a_frequency_beyond_the_reduction_is_a_fault(no_shafts):
    faults = check_train(Assembly(TRAIN, kept=4), 9000.0).faults
    assert said(faults, "9000 Hz is beyond the reduction")


def test_local_harmonics_are_not_called_undriven(no_shafts):
    local = TRAIN.with_changes(mesh=TRAIN.mesh.with_changes(local_harmonics=(2,)))
    (line,) = said(check_train(Assembly(local)).cautions, "nodal diameters")
    assert "n = 3" in line and "n = 2" not in line


def test_the_command_on_a_train(monkeypatch, found):
    monkeypatch.setattr(checked, "check_train", lambda assembly: found)
    done = command("check", AXLE)
    assert done.exit_code == 0
    assert done.output.index("== pinion") < done.output.index("== gear")
    assert "Holds with caution: solid (gear)." in done.output.split("== train")[1]
    told = json.loads(command("check", AXLE, "--json").output)
    assert told["verdicts"]["solid"]["shafts"] == ["gear"]


def test_options_of_one_shaft_are_refused():
    done = command("check", AXLE, "--set", "order=3")
    assert done.exit_code != 0
    assert "--set is for one shaft" in str(done.exception) + done.output


@pytest.mark.long
def test_commands_tell_a_slip_above_their_table_in_the_words_of_check(tmp_path):
    text = open(AXLE, encoding="utf-8").read().replace('"2.5e8 N/m"', '"2.5e8 N/mm"')
    for name in ("pinion_overhung", "gear_shaft"):
        text = text.replace(f'"{name}.toml"', f'"{Path("geometry", name).absolute()}.toml"')
    file = tmp_path / "slip.toml"
    file.write_text(text)
    (sentence,) = mesh_unit_slips(Assembly(sg.load_train(file))) or ("",)
    assert sentence.startswith("probably a wrong unit: mesh stiffness")
    beams = [file, "--pinion", "euler", "--gear", "euler", "--max-frequency", "600"]
    for words in (["system-modes", *beams], ["response", *beams, "--out", tmp_path / "out"]):
        done = command(*words)
        assert done.exit_code == 0, done.output
        lines = done.output.splitlines()
        said = lines.index(f"caution: {sentence}")
        assert said < next(k for k, line in enumerate(lines) if "━" in line)
        assert lines.count(f"caution: {sentence}") == 1
    assert sentence in json.loads((tmp_path / "out" / "response.json").read_text())["cautions"]


def test_a_slip_in_the_data_of_a_shaft_is_told_with_its_side():
    gear = TRAIN.gear.scene
    soft = [
        b.with_changes(matrix=[[v / 1e6 for v in row] for row in b.matrix]) for b in gear.bearings
    ]
    scene = gear.with_changes(bearings=tuple(soft))
    odd = TRAIN.with_changes(gear=TRAIN.gear.with_changes(scene=scene))
    (sentence,) = unit_slips(Assembly(odd))
    assert sentence.startswith("gear: probably a wrong unit: ")


def test_a_shaft_takes_options_of_its_model():
    words = ["system-modes", AXLE, "--pinion", "euler", "--gear", "lumped/euler", "--json"]
    words += ["--max-frequency", "500"]
    usual = json.loads(command(*words).output)["unknowns"]
    fine = json.loads(command(*words, "--set", "gear.elements=200").output)["unknowns"]
    assert fine["pinion"] == usual["pinion"] and fine["gear"] > 2 * usual["gear"]
    for wrong, said in (
        ("elements=3", "write SIDE.key=value, such as --set pinion.order=3; sides: pinion, gear"),
        ("pinion.order=3", "euler: there is no such option"),
        ("pinion.stiffness=3", "an entry of a file varies by --vary of sweep"),
        ("pinion.bearing.A.scale=3", "an entry of a file varies by --vary of sweep"),
    ):
        done = command(*words, "--set", wrong)
        assert done.exit_code != 0 and said in str(done.exception) + done.output
