"""A train whose teeth have backlash, held against its linear answer and against motion in time."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.backlash.solver.balance import Balance
from solidgear.backlash.solver.continuation import follow
from solidgear.backlash.solver.integrated import Integrated
from solidgear.backlash.solver.model import remainder
from solidgear.backlash.solver.motion import sweep
from solidgear.backlash.study import BacklashStudy
from solidgear.backlash.train import backlash_model, over_force, parting, teeth_of, with_backlash
from solidgear.core.errors import SceneError
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.response.drive import Drive

OVERHUNG = Path(__file__).parent.parent / "geometry" / "axle_overhung.toml"
BEAMS = "timoshenko", "timoshenko"
SOLIDS = "harmonic", "harmonic"


@pytest.fixture(scope="module")
def assembly():
    train = sg.load_train(OVERHUNG)
    mesh = train.mesh.with_changes(backlash="100 um", transmission_error="10 um")
    return Assembly(train.with_changes(mesh=mesh))


@pytest.fixture(scope="module")
def teeth(assembly):
    return teeth_of(assembly, 5000.0)


@pytest.fixture(scope="module")
def solids(assembly, teeth):
    return with_backlash(assembly, SOLIDS, teeth, 1100.0, 300.0)


@pytest.mark.slow
def test_the_linear_peak_hides_where_teeth_part_and_jump(solids):
    first, second = solids.lost
    assert first.low == pytest.approx(572.0, abs=1.0)
    # frequencies of the shafts are within 2e-3
    assert second.high == pytest.approx(961.0, abs=2.0)
    up, down = solids.jumps
    assert up.rising and up.frequency_hz == pytest.approx(684.8, rel=1e-3)
    assert not down.rising and down.frequency_hz == pytest.approx(655.1, rel=1e-3)
    at, size = solids.loudest
    assert size == pytest.approx(7460.0, rel=5e-3)
    assert at == pytest.approx(720.0, abs=2.0)
    # a viscous ratio for each mode beside a loss factor: alike at resonance alone
    assert solids.linear_loudest[1] == pytest.approx(16_060.0, rel=5e-3)


@pytest.mark.slow
def test_lumped_shafts_are_enough_for_jumps_and_beams_are_not(assembly, teeth, solids):
    others = [with_backlash(assembly, [m], teeth, 1100.0, 300.0) for m in ("lumped", "timoshenko")]
    lumped, beams = BacklashStudy(assembly.train, (solids, *others), 0.044).sufficiency()
    assert lumped.enough and lumped.jumps < 0.01 and abs(lumped.force) < 0.015
    assert not beams.enough and beams.force == pytest.approx(0.30, abs=0.01)


def test_the_upper_motion_loses_its_stability_before_it_turns(solids):
    ((kind, where),) = solids.wandering
    assert kind == "a second frequency"
    assert where.low == pytest.approx(655.1, rel=1e-3) and 656.5 < where.high < 658.5


@pytest.mark.slow
def test_in_time_the_speed_rises_over_the_jump_that_the_branch_foretells(solids):
    hz = np.array([684.4, 685.0])
    begin = solids.branch.at(2 * np.pi * hz[0])[0]
    below, above = sweep(solids.remainder, 2 * np.pi * hz, state=begin.state(), steady=1e-4)
    force = np.ptp(begin.forces()) / 2
    # asked: a thousandth; both solve the same law, and what is left of transients is a tenth of it
    assert np.ptp(below.force) / 2 == pytest.approx(force, rel=1e-3)
    assert np.ptp(above.force) / 2 > 1.2 * force


def test_no_motion_jumps_at_a_torque_above_the_linear_peak(solids):
    low, high = over_force(solids, 2)
    assert high.mean_force == pytest.approx(solids.linear_loudest[1]) and not high.jumps_hz
    # at half of the linear peak teeth part, and where they do is where sweeps jump
    (up, _), (down, _) = low.jumps_hz
    assert [rising for _, rising in low.jumps_hz] == [True, False] and down < up
    assert low.largest > low.mean_force


def test_a_branch_takes_up_harmonics_beside_its_turning_point(assembly):
    # with more of them the branch turns a little sooner, and has no motion at the speed it is at
    own = backlash_model(assembly, ["lumped"], teeth_of(assembly, 8017.8), 4000.0)
    branch = follow(own, 2 * np.pi * 150.0, 2 * np.pi * 2000.0, step=0.02)
    up, down = (branch.points[k].omega / (2 * np.pi) for k in branch.turning)
    # both lie between those at 6.4 and 9.6 kN
    assert 704.4 < up < 727.0 and 671.8 < down < up


@pytest.mark.parametrize("highest", [np.inf, 4000.0])
def test_without_backlash_the_answer_is_the_linear_one(assembly, teeth, highest):
    drive = Drive(assembly, *BEAMS, damping="viscous", matched_hz=800.0)
    system = parting(drive.system, replace(teeth, half_gap=0.0))
    own = remainder(
        system,
        loss=assembly.loss_factors(),
        kind="viscous",
        matched_hz=800.0,
        errors={"mesh": teeth.errors},
        highest_hz=highest,
    )
    hz = np.array([300.0, 700.0, 812.0, 1500.0])
    dte = drive.motion(hz, drive.row[None])[:, 0]
    expected = np.abs(dte - drive.excitation.amplitude(hz))
    balance = Balance(own, 3)
    found = [balance.solve(balance.linear(w), w) for w in 2 * np.pi * hz]
    size = [abs(complex(m[1], -m[4])) for m in found]
    # modes above 4 kHz as flexibility: what their inertia and losses do at 1.5 kHz
    np.testing.assert_allclose(size, expected, rtol=1e-8 if highest == np.inf else 2e-2)


@pytest.mark.long
def test_the_command_tells_jumps_and_what_is_enough(run, tmp_path):
    arguments = ["nonlinear", str(OVERHUNG), "--pinion", "timoshenko", "--gear", "timoshenko"]
    arguments += ["--backlash", "100 um", "--mean-force", "5 kN", "--error", "10 um"]
    arguments += ["--against", "lumped/timoshenko+lumped/timoshenko", "--max-frequency", "700"]
    arguments += ["--min-frequency", "450", "--out", str(tmp_path / "out"), "--run-up", "-2000"]
    arguments += ["--apart", "2"]
    code, out, _ = run(*arguments)
    assert code == 0 and "Jumps" not in out.splitlines()[0]
    assert "The motion jumps at 615.7 Hz (2639 rpm) as the speed rises" in out
    told = json.loads((tmp_path / "out" / "nonlinear.json").read_text())
    assert told["teeth"]["half_gap"] == 50e-6
    assert {p.name for p in (tmp_path / "out").iterdir()} == {
        *(f"nonlinear.{kind}" for kind in ("html", "csv", "json", "png", "svg")),
        "run_down_2000.csv",
        *(f"waterfall_run_down_2000.{kind}" for kind in ("png", "svg")),
    }
    (ran,) = told["runs"]
    # a run down keeps the upper motion beyond where it jumps at rest, 523.4 Hz
    assert "Run down at 2000 rpm/s: largest dynamic mesh force" in out
    assert ran["parts"]["low"] < 520 and ran["largest"]["force"] < 1.01 * 9715


@pytest.mark.parametrize(
    ("more", "says"),
    [
        (["--backlash", "-1 um", "--mean-force", "5 kN"], "must not be negative"),
        (["--backlash", "100 um"], "no mean force: give [[operation]]"),
        (["--mean-force", "5 kN"], "no backlash: give backlash"),
        ([], "no backlash, no mean force: give backlash = "),
        (["--backlash", "100 um", "--mean-force", "5 kN", "--min-frequency", "-3"], "above 0"),
        (["--backlash", "1e-4 m", "--mean-force", "-5 kN"], "holds no teeth"),
        (["--backlash", "1e-4 m", "--mean-force", "5 kN", "--contact-loss", "0"], "above 0 Hz"),
        (["--backlash", "1e-4 m", "--mean-force", "5 kN", "--run-up", "0"], "--run-up 0: give 18"),
    ],
)
def test_teeth_that_cannot_be_are_refused(run, more, says):
    code, out, err = run("nonlinear", OVERHUNG, "--pinion", "euler", "--gear", "euler", *more)
    assert code == 1 and out == "" and says in err


PITCH = 2 * np.pi / 14


def cycle(assembly, depth=0.1, **changes):
    """The train with a stiffness that is largest at both ends of a tooth pitch of the pinion."""
    at = np.linspace(0.0, PITCH, 41)
    table = {"angle": at, "stiffness": 2.5e8 * (1 + depth * np.cos(14 * at))} | changes
    table = {key: np.asarray(values).tolist() for key, values in table.items()}
    mesh = assembly.train.mesh.with_changes(stiffness_cycle=table)
    return assembly.with_train(assembly.train.with_changes(mesh=mesh))


def test_a_stiffness_that_varies_drives_the_train_as_its_mean_deflection_does(assembly, teeth):
    varied = cycle(assembly, 1e-3)
    found = teeth_of(varied, 5000.0)
    assert found.cycle[0] == pytest.approx((1e-3, 0.0), rel=5e-3, abs=1e-12)
    # a small share c of k under the force F acts as a transmission error c F / k
    system = parting(varied.system(*BEAMS), found)
    own = backlash_model(varied, BEAMS, replace(found, errors=(0.0,)), 4000.0)
    other = backlash_model(assembly, BEAMS, replace(teeth, errors=(1e-3 * 5000.0 / 2.5e8,)), 4000.0)
    assert system.links["mesh"].stiffness == 2.5e8
    for hz in (400.0, 1000.0):
        w = 2 * np.pi * hz
        first, second = Balance(own, 3), Balance(other, 3)
        swing = [
            np.ptp(own.forces(*b.stretch(b.solve(b.start(w), w), w), b.factor).value)
            for b in (first, second)
        ]
        assert swing[0] == pytest.approx(swing[1], rel=0.01)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"stiffness": 2.5e8 * np.linspace(1.0, 1.1, 41)}, "is not periodic"),
        ({"stiffness": -2.5e8 * np.ones(41)}, "greater than zero"),
        ({"angle": np.linspace(0.0, 2 * np.pi / 15, 41)}, "one of its 14 teeth takes"),
        ({"angle": np.linspace(PITCH, 0.0, 41)}, "angles must ascend"),
        ({"stiffness": [2.5e8, 2.5e8]}, "2 stiffnesses for 41 angles"),
    ],
)
def test_a_stiffness_over_the_cycle_that_cannot_be_is_refused(assembly, changes, says):
    with pytest.raises(SceneError, match=says):
        cycle(assembly, **changes)


def lines(assembly, turn=0.0, **changes):
    """The train with its own mesh point and line of action over the cycle, turned about z."""
    at, met = np.linspace(0.0, PITCH, 41), assembly.contact.pinion
    c, s = np.cos(turn * np.cos(14 * at)), np.sin(turn * np.cos(14 * at))
    nx, ny, nz = met.normal
    normal = np.column_stack([c * nx - s * ny, s * nx + c * ny, np.full(41, nz)])
    table = {"angle": at, "point": np.tile(met.point, (41, 1)), "normal": normal} | changes
    table = {key: np.asarray(values).tolist() for key, values in table.items()}
    mesh = assembly.train.mesh.with_changes(line_cycle=table)
    return assembly.with_train(assembly.train.with_changes(mesh=mesh))


def test_a_line_of_action_that_stays_where_it_is_changes_nothing(assembly, teeth):
    first, other = (
        backlash_model(one, BEAMS, teeth_of(one, 5000.0), 4000.0)
        for one in (assembly, lines(assembly))
    )
    assert other.sway is None
    for name in ("omega", "shapes", "mean", "losses", "flexible", "stiffness", "error"):
        a, b = getattr(first, name), getattr(other, name)
        np.testing.assert_allclose(np.abs(b), np.abs(a), rtol=1e-10, atol=1e-10 * np.abs(a).max())


def test_a_line_of_action_that_turns_moves_the_train_alike_by_balance_and_in_time(assembly):
    turned = lines(assembly, 0.15)
    found = teeth_of(turned, 5000.0)
    own = backlash_model(turned, ["lumped/timoshenko"], found, 2000.0)
    assert own.rows > 1 and found.turns
    point = follow(own, 2 * np.pi * 690.0, 2 * np.pi * 670.0, step=0.2).points[-1]
    still = backlash_model(assembly, ["lumped/timoshenko"], found, 2000.0)
    other = follow(still, 2 * np.pi * 690.0, 2 * np.pi * 670.0, step=0.2).points[-1]
    force, straight = (np.ptp(one.forces()[:, 0]) for one in (point, other))
    assert abs(force / straight - 1) > 0.01, "the line is to matter"
    run, state = Integrated(own, point.omega), point.state()
    after, s, _ = run.period(state)
    line = own.line(2 * np.pi * np.arange(run.looks) / run.looks, 0.0)
    mesh = own.forces(s, np.zeros_like(s), np.ones_like(s), line).value[:, 0]
    # asked 0.1 %: a cycle from the motion of the balance brings it back
    assert np.ptp(mesh) == pytest.approx(force, rel=1e-3)
    np.testing.assert_allclose(after, state, atol=1e-3 * np.abs(state).max())


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"normal": np.tile([0.0, 0.0, 0.9], (41, 1))}, "normal 1 has length 0.9; give unit"),
        ({"point": np.linspace([-0.06, 0, 0], [-0.05, 0, 0], 41)}, "is not periodic"),
        ({"point": [[-0.06, 0, 0]] * 4}, "4 points for 41 angles"),
        ({"angle": np.linspace(0.0, 0.3, 41)}, "one of its 14 teeth takes"),
    ],
)
def test_a_line_of_action_over_the_cycle_that_cannot_be_is_refused(assembly, changes, says):
    with pytest.raises(SceneError, match=says):
        lines(assembly, **changes)


def test_tables_over_the_cycle_that_begin_apart_or_push_elsewhere_are_refused(assembly):
    with pytest.raises(SceneError, match="let both begin at one angle"):
        lines(cycle(assembly), angle=np.linspace(0.1, 0.1 + PITCH, 41))
    met = assembly.contact.pinion
    moved = lines(assembly, point=np.tile(met.point * [0.5, 1.0, 1.0], (41, 1)))
    with pytest.raises(SceneError, match="has lever arms of"):
        backlash_model(moved, BEAMS, teeth_of(moved, 5000.0), 4000.0)


def test_phases_of_the_transmission_error_shift_it_in_time_or_change_its_force(assembly):
    def force(phases):
        error = {"orders": ("10 um", "5 um"), "phases": phases}
        mesh = assembly.train.mesh.with_changes(transmission_error=error)
        one = assembly.with_train(assembly.train.with_changes(mesh=mesh))
        own = backlash_model(one, BEAMS, teeth_of(one, 5e5), 4000.0)
        balance = Balance(own, 3)
        motion = balance.linear(2 * np.pi * 300.0)
        return np.ptp(balance.stretch(motion, 2 * np.pi * 300.0)[0])

    assert force(("40 deg", "80 deg")) == pytest.approx(force(()), rel=1e-3)  # looks elsewhere
    assert abs(force(("0 deg", "90 deg")) / force(()) - 1) > 0.02
    with pytest.raises(SceneError, match="1 phases for 2 orders"):
        force(("90 deg",))
