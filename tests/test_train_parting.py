"""Linear mesh forces beside mean ones: from where on teeth part, in every command that tells both."""

import numpy as np
import pytest

import solidgear as sg
from solidgear.backlash.train import teeth_of, with_backlash
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.load.operation import Operating
from solidgear.trains.load.state import with_settled_bearings
from solidgear.trains.modes.parting import largest_relief, parting_frequency, teeth_relief
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.respond import respond
from tests.command import command, numbers

BEAMS = ("timoshenko", "timoshenko")
OVERHUNG = "geometry/axle_overhung.toml"


def axle(torque, orders=("10 um",), phases=()):
    train = sg.load_train(OVERHUNG)
    error = {"orders": orders, "phases": phases}
    mesh = train.mesh.with_changes(backlash="100 um", transmission_error=error)
    return train.with_changes(meshes=(mesh,), operation={"torque": torque, "of": "pinion"})


@pytest.mark.parametrize("phase, most", [(0.0, 9 / 8), (np.pi, 2.0)])
def test_two_orders_take_off_what_their_sum_over_the_cycle_is_at_its_least(phase, most):
    # cos x + cos 2x is least where cos x = -1/4, cos x - cos 2x where x is half a turn
    force = np.array([3.0 + 0.0j])
    assert largest_relief([force, force], (0.0, phase))[0] == pytest.approx(3 * most, rel=1e-3)


def test_teeth_part_between_the_points_where_the_force_passes_the_mean_one():
    hz, taken = np.array([10.0, 20.0, 30.0]), np.array([1.0, 2.0, 4.0])
    assert parting_frequency(hz, taken, 3.0) == pytest.approx(25.0)
    assert parting_frequency(hz, taken, 0.5) == 10.0 and parting_frequency(hz, taken, 4.5) is None


def test_the_linear_motion_of_backlash_takes_off_the_same_by_orders_and_phases():
    assembly = Assembly(axle("1 MN*m", ("10 um", "6 um"), (0.3, 1.7)))
    found = with_backlash(assembly, BEAMS, teeth_of(assembly), highest_hz=330.0, lowest_hz=300.0)
    hz, least = found.holding
    drive = Drive(assembly, *BEAMS)
    taken = teeth_relief(drive, drive.over_cycle(hz, 1e4))
    # modes above the range give way like springs there: the second order runs twice as fast
    np.testing.assert_allclose(taken, least, rtol=0.03)
    other = largest_relief(drive.over_cycle(hz, 1e4), drive.excitation.phases)
    assert np.abs(other / least - 1).min() > 0.04  # the other end of the swing is another number


def test_a_response_tells_where_its_force_passes_the_mean_one():
    assembly = Assembly(axle("100 N*m"))
    found = respond(assembly, *BEAMS, highest_hz=1000.0)
    (line,) = found.parting
    low = float(line.split("from ")[1].split(" Hz")[0])
    mean = 100.0 / abs(assembly.contact.pinion.lever)
    drive = Drive(assembly, *BEAMS)
    below, above = np.abs(drive.mesh(np.array([0.98, 1.02]) * low)[1])
    assert below < mean < above
    assert f"({60 * low / 14:.0f} rpm of the pinion)" in line and f"{mean:.0f} N" in line
    # ten times the torque holds them as far as the force is less than that
    quiet = respond(Assembly(axle("2 kN*m")), *BEAMS, highest_hz=0.9 * low)
    assert not quiet.parting and np.abs(quiet.force).max() < 20 * mean


def test_without_an_operating_point_no_mean_force_is_known_and_nothing_is_told():
    train = axle("100 N*m").with_changes(operation=())
    assert not respond(Assembly(train), *BEAMS, highest_hz=1000.0).parting


def test_rows_of_a_sweep_tell_where_teeth_part_and_how_many_do(tmp_path):
    vary = "operation.full.torque=0.5 N*m,1 kN*m"
    beams = ("--pinion", BEAMS[0], "--gear", BEAMS[1], "--max-frequency", "400")
    out = tmp_path / "rows.csv"
    words = ("sweep", "geometry/gearbox_train.toml", "--vary", vary, *beams, "--ask", "response")
    done = command(*words, "--out", out)
    light, heavy = numbers(out)
    train = sg.load_train("geometry/gearbox_train.toml")
    point = train.operation[0].with_changes(torque=0.5)
    there = with_settled_bearings(train, Operating(Assembly(train), "timoshenko").at(point))
    hz = np.array([light["parts_from_hz"]])
    force = np.abs(Drive(Assembly(there), *BEAMS).mesh(hz)[1][0])
    # straight between points of a grid whose middles are foretold within 0.25 dB
    assert force == pytest.approx(light["mesh_force"], rel=0.03)
    assert heavy["parts_from_hz"] == ""
    assert (
        f"in 1 row of 2 the dynamic mesh force passes the mean one, from {hz[0]:.0f} Hz"
        in done.stdout
    )
