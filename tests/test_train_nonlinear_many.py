"""Teeth with backlash in trains of any shafts, held against linear answers and motion in time."""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.backlash.solver.balance import Balance
from solidgear.backlash.solver.continuation import follow
from solidgear.backlash.solver.model import remainder
from solidgear.backlash.solver.motion import steady_motion
from solidgear.backlash.study import BacklashStudy
from solidgear.backlash.train import backlash_model, parting, teeth_of, with_backlash
from solidgear.core.errors import SolidgearError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.load.contact import axes_of
from solidgear.trains.response.drive import Drive

GEOMETRY = Path(__file__).parent.parent / "geometry"
BEAMS = ["timoshenko"]


@pytest.fixture(scope="module")
def assembly():
    return Assembly(sg.load_train(GEOMETRY / "gearbox_two_stage.toml"))


def toothed(assembly, first=None, second=None):
    """The gearbox with other teeth."""
    meshes = zip(assembly.train.meshes, (first or {}, second or {}))
    changed = tuple(mesh.with_changes(**changes) for mesh, changes in meshes)
    return assembly.with_train(assembly.train.with_changes(meshes=changed))


@pytest.mark.long
def test_shafts_of_any_names_part_like_pinion_and_gear(run, tmp_path):
    text = (GEOMETRY / "axle_overhung.toml").read_text(encoding="utf-8")
    for side, name in (("pinion", "small"), ("gear", "ring")):
        text = text.replace(f"\n[{side}]", f"\n[shaft.{name}]")
    for scene in ("pinion_overhung", "gear_shaft"):
        text = text.replace(f'"{scene}.toml"', f'"{GEOMETRY.as_posix()}/{scene}.toml"')
    text = text.replace("\n[mesh]", '\n[[mesh]]\nbetween = ["small", "ring"]')
    text = text.replace("\n[engine]", '\n[engine]\nshaft = "small"')
    (tmp_path / "long.toml").write_text(text.replace("\n[load]", '\n[load]\nshaft = "ring"'))
    asked = ["--backlash", "100 um", "--mean-force", "5 kN", "--error", "10 um"]
    asked += ["--against", "timoshenko+timoshenko", "--min-frequency", "590"]
    asked += ["--shaft", "small=timoshenko", "--shaft", "ring=timoshenko", "--max-frequency", "630"]
    asked += ["--apart", "0"]
    code, out, _ = run("nonlinear", "long.toml", *asked)
    # the same jump as of the file with [pinion] and [gear]
    assert code == 0 and "The motion jumps at 615.7 Hz (2639 rpm) as the speed rises" in out
    assert "N m on the small" in out


def test_each_mesh_carries_its_own_mean_force(assembly):
    gap = {"backlash": "20 um"}
    teeth = teeth_of(toothed(assembly, gap, gap), mesh="middle-output")
    levers = {name: abs(met.pinion.lever) for name, met in assembly.contacts.items()}
    # 115 N m on the input, 57 over 20 times as much on the middle
    assert teeth.mean_force == pytest.approx(115 * 57 / 20 / levers["mesh middle-output"])
    assert teeth.others[0].mean_force == pytest.approx(115 / levers["mesh input-middle"])
    own = backlash_model(toothed(assembly, gap, gap), BEAMS, teeth, 3000.0)
    # that the torques of engine and load bring about at rest
    carried = own.mean * np.diag(own.stiffness)
    np.testing.assert_allclose(carried, [one.mean_force for one in teeth.meshes], rtol=1e-9)


@pytest.mark.parametrize("driver", ["input-middle", "middle-output"])
def test_without_backlash_every_mesh_answers_as_the_response_does(assembly, driver):
    own = toothed(assembly, {"backlash": 0.0}, {"backlash": 0.0})
    teeth = teeth_of(own, mesh=driver)
    drive = Drive(own, *BEAMS, damping="viscous", matched_hz=800.0, mesh=driver)
    made = remainder(
        parting(drive.system, teeth),
        loss=own.loss_factors(),
        kind="viscous",
        matched_hz=800.0,
        errors={teeth.mesh: teeth.errors},
    )
    hz = np.array([300.0, 812.0, 1500.0, 2176.0])
    rows = np.vstack([drive.rows[one.mesh] for one in teeth.meshes])
    expected = drive.motion(hz, rows)
    expected[:, 0] -= drive.excitation.amplitude(hz)
    balance = Balance(made, 3)
    found = [balance.solve(balance.linear(w), w) for w in 2 * np.pi * hz]
    size = [np.hypot(*m.reshape(-1, 2)[[1, 4]]) for m in found]
    np.testing.assert_allclose(size, np.abs(expected), rtol=1e-8)


@pytest.mark.parametrize(
    ("gaps", "force", "hz", "parts"),
    [
        # the driven mesh has no gap, and what it drives parts
        ((0.0, "30 um"), 500.0, (1500.0, 1540.0), (False, True)),
        # the driven mesh alone parts
        (("20 um", "30 um"), 4223.0, (1572.0, 1580.0), (True, False)),
    ],
)
def test_balance_of_two_laws_is_motion_in_time(assembly, gaps, force, hz, parts):
    first, second = ({"backlash": gap} for gap in gaps)
    own = toothed(assembly, {**first, "transmission_error": "15 um"}, second)
    made = backlash_model(own, BEAMS, teeth_of(own, force), 3000.0)
    half = [law.half_gap for law, _ in made.laws]
    ends = 2 * np.pi * (hz[0] - 30), 2 * np.pi * (hz[1] + 10)
    branch = follow(made, *ends, step=0.05)
    for at in 2 * np.pi * np.array(hz):
        (point,) = branch.at(at)
        steady = steady_motion(made, at, steady=1e-4, state=point.state())
        apart = (steady.stretch.min(axis=0) < half) & (np.array(half) > 0)
        assert steady.cycle == 1 and tuple(apart) == parts
        # asked 0.1 %: only the law and the modes are shared
        np.testing.assert_allclose(
            np.ptp(steady.force, axis=0), np.ptp(point.forces(), axis=0), rtol=1e-3
        )


def test_what_parts_is_told_of_each_mesh(assembly):
    own = toothed(assembly, {"transmission_error": "15 um"}, {"backlash": "30 um"})
    found = with_backlash(own, BEAMS, teeth_of(own, 500.0), 1600.0, 1520.0)
    told = BacklashStudy(own.train, (found,), abs(own.contacts[found.teeth.mesh].pinion.lever))
    lines = told.sentences()
    (parting_line,) = [line for line in lines if line.startswith("The teeth of")]
    assert parting_line.startswith("The teeth of the mesh middle-output part from 1520 to 15")
    # 20 teeth pass in one turn of the input
    assert f"({60 * 1520 / 20:.0f} to" in parting_line
    other = told.as_dict()["mixes"][0]["other_meshes"][0]
    assert other["mesh"] == "mesh middle-output" and other["parts"]
    # the torque above which nothing parts is that at which the linear force is the mean one
    driven, second = found.meshes
    hz, most = second.linear_loudest
    drive = Drive(own, *BEAMS, damping="modal")
    stretch = drive.motion(np.array([hz]), drive.rows[second.teeth.mesh][None])
    # modes above 3 kHz that give way without inertia take 2 %, the loss of the excitation 1 %
    assert most == pytest.approx(float(np.abs(stretch[0, 0])) * 4.5e8, rel=0.05)
    share = most / second.teeth.mean_force
    assert found.holding[1].max() == pytest.approx(500.0 * share)


def test_a_line_of_action_of_the_second_stage_that_stays_changes_nothing(assembly):
    pair = assembly.train.named_mesh("middle-output")
    met, turn = assembly.contacts[pair.name].pinion, axes_of(pair, "pinion")
    at = np.linspace(0.0, 2 * np.pi / 18, 5)
    table = {"angle": at.tolist(), "normal": [(turn.T @ met.normal).tolist()] * 5}
    table["point"] = [(turn.T @ met.point).tolist()] * 5
    gap = {"backlash": "20 um"}
    made = []
    for more in ({}, {"line_cycle": table}):
        own = toothed(assembly, {}, {**gap, **more})
        made.append(backlash_model(own, BEAMS, teeth_of(own, mesh="middle-output"), 3000.0))
    for name in ("omega", "shapes", "mean", "losses", "error"):
        a, b = (getattr(one, name) for one in made)
        np.testing.assert_allclose(np.abs(b), np.abs(a), rtol=1e-9, atol=1e-9 * np.abs(a).max())


def test_what_several_meshes_cannot_have_is_refused(assembly):
    at = np.linspace(0.0, 2 * np.pi / 18, 5)
    table = {"angle": at.tolist(), "stiffness": [4.5e8] * 5}
    varied = toothed(assembly, {"backlash": "20 um"}, {"stiffness_cycle": table})
    with pytest.raises(SolidgearError, match="give `mesh` middle-output, or leave its table out"):
        teeth_of(varied)
    assert teeth_of(varied, mesh="middle-output").half_gap == 0.0
    with pytest.raises(SolidgearError, match="no backlash: give"):
        teeth_of(assembly)
