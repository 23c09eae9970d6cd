"""Receptance between two ports of a train: against the full matrices, reciprocal, no peak missed."""

import json

import numpy as np
import pytest
from test_train_models import COARSE, OVERHUNG, assembled

import solidgear as sg
from solidgear.core.frames import DOF_NAMES
from solidgear.core.system.steady import peaks
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.modes.naming import mode_names
from solidgear.trains.response.drive import NO_MODE, Drive
from solidgear.trains.response.receptance import receptance
from tests.command import command, table

TRAIN = sg.load_train(OVERHUNG)
MIX = ("timoshenko", "timoshenko")
PAIRS = [
    (("gear.gear", "z"), ("pinion.pinion", "x")),
    (("pinion.2", "thx"), ("gear.4", "y")),
    (("engine", "thy"), ("load", "thy")),
    (("gear.3", "x"), ("gear.3", "x")),
]
HZ = np.array([40.0, 300.0, 661.0, 1458.0, 2500.0, 3900.0])


@pytest.fixture(scope="module")
def assembly():
    return Assembly(TRAIN, settings=COARSE)


def own_row(system, end):
    return system.motion(end[0])[DOF_NAMES.index(end[1])]


@pytest.mark.parametrize(("damping", "at"), [("hysteretic", 0.0), ("viscous", 700.0)])
@pytest.mark.parametrize(("here", "there"), PAIRS)
def test_modal_and_direct_agree(assembly, here, there, damping, at):
    found = receptance(
        assembly, *MIX, from_=here, to=there, damping=damping, matched_hz=at, frequency_hz=HZ
    ).value
    drive = Drive(assembly, *MIX, damping=damping, matched_hz=at)
    load, row = (own_row(drive.system, end) for end in (here, there))
    modal = drive.steady.motion(HZ, load, row[None])[:, 0]
    # engine to load is 1e-14 of the terms of its modal sum at 4 kHz: judged where digits are left
    there_are_digits = HZ < 1000 if here[0] == "engine" else HZ > 0
    assert np.abs(modal / found - 1)[there_are_digits].max() < 1e-6


@pytest.mark.parametrize(("here", "there"), PAIRS[:3])
def test_the_reduced_receptance_is_that_of_the_full_matrices(here, there):
    """Nothing of reduction/ or system/ is in the reference."""
    # bearings that lose more than the rest: sums over complex modes leave two digits at 4 kHz
    losses = TRAIN.losses.with_changes(bearings=0.1)
    assembly = Assembly(TRAIN.with_changes(losses=losses), settings=COARSE)
    found = receptance(assembly, *MIX, from_=here, to=there, frequency_hz=HZ).value
    k, m, motion, _ = assembled(assembly, dict(zip(("pinion", "gear"), MIX)), losses)
    force = motion(here[0])[DOF_NAMES.index(here[1])]
    row = motion(there[0])[DOF_NAMES.index(there[1])]
    for f, value in zip(HZ, found):
        whole = row @ np.linalg.solve(k - (2 * np.pi * f) ** 2 * m, force)
        # what the reduction leaves, and rounding of the full matrices; no sum over modes has
        # these digits from the engine to the load, 1e-14 of what moves in between
        assert abs(value / whole - 1) < 2e-5


@pytest.mark.parametrize("damping", ["hysteretic", "modal"])
@pytest.mark.parametrize(("here", "there"), PAIRS)
def test_ends_may_change_places(assembly, here, there, damping):
    forth = receptance(assembly, *MIX, from_=here, to=there, damping=damping, frequency_hz=HZ).value
    back = receptance(assembly, *MIX, from_=there, to=here, damping=damping, frequency_hz=HZ).value
    # modal losses are told in modes alone, whose sums cancel from the engine to the load
    slack = 1e-10 * np.abs(forth).max() if damping == "modal" else 0.0
    assert np.allclose(forth, back, rtol=1e-10, atol=slack)


@pytest.mark.parametrize(("damping", "at"), [("hysteretic", 0.0), ("viscous", 700.0)])
@pytest.mark.parametrize("end", [("load", "thy"), ("pinion.1", "z")])
def test_a_clamped_shaft_is_one_whose_seat_does_not_move(end, damping, at):
    """Against the motions that the seat allows, with no spring of 1e22 N/m in any matrix."""
    scene = TRAIN.pinion.scene
    wall = scene.bearings[-1]
    wall = sg.Bearing(name=wall.name, y=wall.y, seat_width=wall.seat_width, hold="clamped")
    scene = scene.with_changes(bearings=(*scene.bearings[:-1], wall))
    train = TRAIN.with_changes(pinion=TRAIN.pinion.with_changes(scene=scene))
    drive = Drive(Assembly(train, settings=COARSE), *MIX, damping=damping, matched_hz=at)
    system = drive.system
    load, row = own_row(system, ("gear.gear", "z")), own_row(system, end)
    found = drive.steady.solved(HZ, load, row[None])[:, 0]

    held = system.motion(f"pinion.{wall.name}")
    q, r = np.linalg.qr(held.T, mode="complete")
    assert np.abs(np.diag(r)).min() > 0
    allowed = q[:, len(held) :]
    g, where = system.strains
    for hz, value in zip(HZ, found):
        left = -((2 * np.pi * hz) ** 2) * system.mass.astype(complex)
        for name in where.keys() - {f"pinion.{wall.name}"}:
            own = g[where[name]].T @ g[where[name]]
            left += drive.steady.factor(name, np.array([hz]))[0] * own
        whole = (row @ allowed) @ np.linalg.solve(allowed.T @ left @ allowed, allowed.T @ load)
        # 1e-9: what the shafts give over 1e22 N/m is far less; rounding of the reference
        assert abs(value / whole - 1) < 1e-9


def test_no_peak_is_missed(assembly):
    here, there = PAIRS[0]
    found = receptance(assembly, *MIX, from_=here, to=there)
    tops = found.frequency_hz[peaks(np.abs(found.value))]
    fine = np.linspace(4, 4000, 80_001)
    drive = Drive(assembly, *MIX)
    load, row = (own_row(drive.system, end) for end in (here, there))
    size = np.abs(drive.steady.motion(fine, load, row[None])[:, 0])
    for top in peaks(size):
        assert np.abs(tops / fine[top] - 1).min() < 2e-3, fine[top]
    assert {round(hz) for hz, *_ in found.peaks} <= {round(hz) for hz in tops}
    assert len(found.peaks) >= 5 and found.peaks[0][2] == "load torsion 1"


def test_a_top_far_from_all_natural_frequencies_has_the_name_of_none(assembly):
    """A resonance lies within its own width of the frequency it is called after; the rise between
    two is of neither.
    """
    drive = Drive(assembly, *MIX)
    omega, shapes = drive.system.elastic
    found = drive.system.modes(12)
    names = mode_names(assembly, drive.system, found)[found.rigid :]
    load, row = (own_row(drive.system, end) for end in PAIRS[3])
    drive.load = load
    hertz = omega[:2] / (2 * np.pi)
    near, far = hertz[1] * 1.005, np.sqrt(hertz[0] * hertz[1])
    size = np.array([1.0, 2.0, 1.0, 2.0, 1.0])
    tops = drive.tops(np.array([hertz[0], far, far * 1.1, near, near * 1.1]), size, row)
    assert [mode for *_, mode in tops] == [NO_MODE, names[1]]


ARGS = ["receptance", str(OVERHUNG), "--pinion", "euler", "--gear", "timoshenko"]


@pytest.mark.long
def test_the_command_writes_a_table_and_charts(tmp_path):
    out = tmp_path / "out"
    args = [*ARGS, "--from", "gear.gear:z", "--to", "pinion.pinion:thx", "--out", str(out)]
    done = command(*args, "--against", "euler+euler", "--json")
    assert done.exit_code == 0, done.output
    kinds = ("csv", "html", "json", "png", "svg")
    assert {p.name for p in out.iterdir()} == {f"receptance.{kind}" for kind in kinds}
    told = json.loads(done.stdout)
    assert told["unit"] == "rad/N" and len(told["models"]) == 2
    rows = table(out / "receptance.csv")
    for row in rows[:: len(rows) // 7]:
        whole = complex(float(row["real part [rad/N]"]), float(row["imaginary part [rad/N]"]))
        assert abs(whole) == pytest.approx(float(row["amplitude [rad/N]"]), rel=1e-7)
    assert "pinion speed [rpm]" in rows[0]


@pytest.mark.parametrize(
    ("from_", "to", "words"),
    [
        ("gear.gear", "pinion.pinion:x", '--from "gear.gear": write PORT:COMPONENT'),
        ("gear.gear:z", "pinion.pinion:q", "components are x y z"),
        ("gear.7:z", "pinion.pinion:x", "gear.3"),
        ("engine:x", "pinion.pinion:x", "engine does not move in x, only in thy"),
        ("gear.gear:z", "turbine:thy", "there is no part 'turbine'; there is engine, pinion"),
        ("gear.gear:z", "pinion:z", "'pinion' is no port; pinion has pinion."),
        ("1:z", "pinion.pinion:z", "there is no part '1'; did you mean pinion.1?"),
    ],
)
def test_bad_ends_are_told_and_nothing_is_written(from_, to, words, tmp_path):
    out = tmp_path / "out"
    done = command(*ARGS, "--from", from_, "--to", to, "--out", str(out))
    assert done.exit_code == 1
    assert words in str(done.exception)
    assert not out.exists() or not list(out.iterdir())
