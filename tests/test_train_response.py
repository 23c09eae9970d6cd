"""Response of a train: against the full matrices solved one frequency at a time, energy, and peaks."""

import numpy as np
import pytest
from test_train_models import COARSE, OVERHUNG, assembled

import solidgear as sg
from solidgear.core.system.steady import SteadyState, peaks
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.tables import ErrorTable
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.respond import respond
from tests.command import command, table

TRAIN = sg.load_train(OVERHUNG)
MIX = ("timoshenko", "timoshenko")


@pytest.fixture(scope="module")
def assembly():
    return Assembly(TRAIN, settings=COARSE)


@pytest.fixture(scope="module")
def drive(assembly):
    return Drive(assembly, *MIX)


def test_the_reduced_response_is_that_of_the_full_matrices(assembly, drive):
    k, m, motion, row = assembled(assembly, dict(zip(("pinion", "gear"), MIX)), TRAIN.losses)
    eta = 1 + 1j * TRAIN.losses.mesh
    error = 2e-6
    hz = np.array([40.0, 300.0, 661.0, 1458.0, 2500.0, 3900.0])
    dte, force = drive.mesh(hz)
    reactions = drive.reactions(hz)
    scene = assembly.scenes["pinion"]
    for i, f in enumerate(hz):
        load = eta * assembly.contact.stiffness * error * row
        u = np.linalg.solve(k - (2 * np.pi * f) ** 2 * m, load)
        # 1e-6: what a reduction to 4 kHz with residuals leaves, and rounding of the full matrices
        assert dte[i] == pytest.approx(row @ u, rel=1e-6)
        whole = eta * assembly.contact.stiffness * (row @ u - error)
        assert abs(force[i] / whole - 1) < 1e-5
        for bearing in scene.bearings:
            seat = motion(f"pinion.{bearing.name}") @ u
            pushed = -(1 + 1j * TRAIN.losses.bearings) * (bearing.stiffness @ seat)
            found = reactions[f"pinion bearing {bearing.name}"][i]
            assert np.allclose(found, pushed, rtol=1e-5, atol=1e-7 * np.abs(pushed).max())


@pytest.mark.parametrize(("damping", "at"), [("hysteretic", 0.0), ("viscous", 700.0)])
def test_power_that_goes_in_is_lost_in_parts_and_links(assembly, damping, at):
    drive = Drive(assembly, *MIX, damping=damping, matched_hz=at)
    g, where = drive.system.strains
    hz = np.array([16.3, 55.0, 400.0, 661.0, 879.0, 3100.0])
    error = drive.excitation.amplitude(hz)
    _, force = drive.mesh(hz)
    w = 2 * np.pi * hz
    entering = 0.5 * np.real(np.conj(1j * w * error) * -force)
    stretch = drive.motion(hz, g)
    stretch[:, where["mesh"]] -= (np.sqrt(drive.stiffness) * error)[:, None]
    left = np.zeros(len(hz))
    for name, rows in where.items():
        lost = drive.steady.factor(name, hz).imag
        left += 0.5 * w * lost * (np.abs(stretch[:, rows]) ** 2).sum(axis=1)
    assert np.allclose(entering, left, rtol=1e-8)


def test_viscous_losses_are_hysteretic_where_they_are_matched(assembly, drive):
    hz = np.array([661.0])
    viscous = Drive(assembly, *MIX, damping="viscous", matched_hz=661.0)
    assert abs(viscous.mesh(hz)[1] / drive.mesh(hz)[1] - 1)[0] < 1e-9
    assert abs(viscous.mesh(hz / 2)[1] / drive.mesh(hz / 2)[1] - 1)[0] > 1e-4


@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_no_peak_is_missed_between_two_grid_points(assembly, scale):
    """With a thousandth of the losses a peak is a hertz wide at most, down to milliherz."""
    drive = Drive(assembly, *MIX)
    loss = {name: scale * eta for name, eta in drive.steady.loss.items()}
    drive.steady = SteadyState(drive.system, loss)
    grid = drive.grid(4000.0, 4.0)
    found = grid[peaks(np.abs(drive.mesh(grid)[1]))]
    # brute force: around every undamped frequency finely enough for its own width
    omega = drive.system.elastic[0]
    hz = omega[omega < 2 * np.pi * 4000] / (2 * np.pi)
    fine = (hz[:, None] * (1 + 0.1 * scale * np.linspace(-1, 1, 4001))).ravel()
    brute = np.unique(np.r_[fine, np.linspace(4, 4000, 40_001)])
    brute = brute[(brute > 4) & (brute < 4000)]
    size = np.abs(drive.mesh(brute)[1])
    for top in peaks(size):
        off = np.abs(found / brute[top] - 1).min()
        assert off < 0.01 * max(scale, 1e-2), brute[top]
    assert len(grid) < 6000
    if scale < 1:  # and a plain grid of as many points does miss some
        plain = np.linspace(4, 4000, len(grid))
        lower = np.abs(drive.mesh(plain)[1]).max()
        assert lower < 0.8 * size.max()


def test_the_literal_reading_has_no_peak_and_says_why(assembly):
    assert len(respond(assembly, *MIX).peaks) >= 8
    found = respond(assembly, *MIX, damping="literal")
    assert found.peaks == ()
    assert any("seconds" in text for text in found.cautions)


def test_peaks_are_named_after_the_mode_that_makes_them(assembly):
    names = [peak.mode for peak in respond(assembly, *MIX).peaks]
    assert names[0] == "load torsion 1"
    assert any(name.startswith("pinion bending") for name in names[-2:])


def test_a_table_and_harmonics_of_the_transmission_error(assembly):
    def with_error(error):
        mesh = TRAIN.mesh.with_changes(transmission_error=error)
        return Assembly(TRAIN.with_changes(mesh=mesh), settings=COARSE)

    hz = np.array([100.0, 150.0, 200.0, 2500.0])
    usual = Drive(assembly, *MIX).mesh(hz)[1]
    table = ErrorTable(frequency=(100, 200), amplitude=(2e-6, 4e-6))
    slope = Drive(with_error(table), *MIX).mesh(hz)[1]
    assert np.allclose(slope / usual, [1, 1.5, 2, 2])
    orders = ErrorTable(orders=("2 um", "1 um"))
    found = respond(with_error(orders), *MIX, highest_hz=4000.0, frequency_hz=hz)
    second = found.columns["mesh force, order 2 [N]"]
    assert second[0] == pytest.approx(usual[2] / 2)  # 100 Hz, second order: 200 Hz, half as large
    assert np.isnan(second[3])  # 5 kHz is beyond what was asked


def test_a_force_on_a_port_instead_of_the_transmission_error(assembly):
    load = {"gear.gear": np.array([0, 0, 100.0, 0, 0, 0])}
    drive = Drive(assembly, *MIX, forces=load)
    moved = drive.motion(np.array([300.0]), drive.system.motion("gear.gear"))[0, 2]
    k, m, motion, _ = assembled(assembly, dict(zip(("pinion", "gear"), MIX)), TRAIN.losses)
    row = motion("gear.gear")[2]
    u = np.linalg.solve(k - (2 * np.pi * 300.0) ** 2 * m, 100.0 * row)
    assert moved == pytest.approx(row @ u, rel=1e-5)


@pytest.mark.long
def test_a_force_of_rounding_alone_is_refused():
    mesh = TRAIN.mesh.with_changes(stiffness=1e24)
    stiff = Assembly(TRAIN.with_changes(mesh=mesh), kept=4, settings=COARSE)
    with pytest.raises(sg.SolidgearError, match="check their units"):
        respond(stiff, *MIX, damping="viscous", matched_hz=500.0)


def test_without_any_loss_a_peak_has_no_height():
    none = TRAIN.losses.with_changes(shafts=0, bearings=0, mesh=0, springs=0)
    bare = Assembly(TRAIN.with_changes(losses=none), settings=COARSE)
    with pytest.raises(sg.SolidgearError, match="give damping or a loss"):
        respond(bare, *MIX)


ARGS = ["response", str(OVERHUNG), "--pinion", "euler", "--gear", "timoshenko"]


@pytest.mark.long
def test_the_command_writes_a_table_and_charts(tmp_path):
    out = tmp_path / "out"
    done = command(*ARGS, "--out", str(out), "--against", "euler+euler")
    assert done.exit_code == 0, done.output
    kinds = {"response": ("csv", "html", "json", "png", "svg"), "orders": ("csv", "png", "svg")}
    assert {p.name for p in out.iterdir()} == {f"{n}.{k}" for n in kinds for k in kinds[n]}
    rows = table(out / "response.csv")
    assert len(rows) > 300
    size = [float(row["mesh force [N]"]) for row in rows]
    assert "gear bearing 4 thx [N m]" in rows[0]
    speed = float(rows[9]["pinion speed [rpm]"]) / float(rows[9]["frequency [Hz]"])
    assert speed == pytest.approx(60 / 14, rel=1e-6)
    assert max(size) > 1000


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (["--damping", "viscous"], "say at which one"),
        (["--damping", "structural"], "hysteretic, viscous, modal, literal"),
        (["--against", "euler"], "write PINION+GEAR"),
        (["--force", "gear.gear=1"], "gear.gear:z=100"),
        (["--force", "gear.7:z=1"], "gear.3"),
        (["--max-frequency", "1e6"], "is beyond the reduction, which leaves out modes from"),
        (["--kept", "0"], "give 1 to 200"),
    ],
)
def test_bad_options_are_told_and_nothing_is_written(more, words, tmp_path):
    done = command(*ARGS, "--out", str(tmp_path / "out"), *more)
    assert done.exit_code != 0
    assert words in str(done.exception)
    out = tmp_path / "out"
    assert not out.exists() or not list(out.iterdir())
