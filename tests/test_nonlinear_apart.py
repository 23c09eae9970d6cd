"""Branches apart: found from starts, closed, and what motion in time says of them."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from test_nonlinear_pair import pair

import solidgear as sg
from solidgear.backlash.solver.apart import search
from solidgear.backlash.solver.continuation import follow
from solidgear.backlash.solver.motion import steady_motion
from solidgear.backlash.solver.stability import stable
from solidgear.backlash.study import BacklashStudy
from solidgear.backlash.train import teeth_of, with_backlash
from solidgear.trains.assembly.assembly import Assembly

OVERHUNG = Path(__file__).parent.parent / "geometry" / "axle_overhung.toml"


def loudest(branch):
    """The stable motion of the largest force, and that force."""
    calm = [point for point in branch.points if stable(point)]
    return max(((point, np.ptp(point.forces()) / 2) for point in calm), key=lambda one: one[1])


@pytest.fixture(scope="module")
def axle():
    train = sg.load_train(OVERHUNG)
    mesh = train.mesh.with_changes(backlash="100 um", transmission_error="10 um")
    assembly = Assembly(train.with_changes(mesh=mesh))
    found = with_backlash(
        assembly, ["lumped"], teeth_of(assembly, 5000.0), 2000.0, 150.0, search_speeds=32
    )
    return assembly, found


@pytest.mark.slow
def test_the_largest_force_of_the_axle_is_on_branches_apart_that_time_bears_out(axle):
    _, found = axle
    one, two = found.branches_apart
    assert (one.periods, two.periods) == (1, 2) and one.end == two.end == "closed"
    # known from a smaller mean force, raised until the branch is apart
    assert one.frequency_hz.min() == pytest.approx(518.5, abs=0.1)
    assert one.loudest[1] == pytest.approx(9397, rel=1e-3)
    assert found.worst is two and found.loudest[1] < 0.72 * two.loudest[1]
    for other in found.branches_apart:
        point, force = loudest(other.branch)
        time = steady_motion(
            found.remainder, other.periods * point.omega, point.state(), steady=1e-4
        )
        assert time.cycle % other.periods == 0
        assert np.ptp(time.force) / 2 == pytest.approx(force, rel=1e-3)


@pytest.mark.slow
def test_what_is_told_of_the_axle_names_both_and_what_was_looked_for(axle):
    assembly, found = axle
    told = " ".join(BacklashStudy(assembly.train, (found,), 0.044).sentences())
    assert "A separate branch of two mesh periods from 100" in told
    assert "searched from 1024 starts at 32 speeds" in told and "there may be others" in told
    below = re.search(r"on a separate branch, (\d+) N", told)
    assert float(below.group(1)) == pytest.approx(7392, rel=2e-3)
    alone = " ".join(
        BacklashStudy(assembly.train, (replace(found, branches_apart=()),), 0.044).sentences()
    )
    assert "with 1 to 3 mesh periods: none was found, and there may be some." in alone


def test_a_pair_has_the_subharmonic_that_a_motion_in_time_keeps_and_nothing_else():
    own = pair(0.05)
    branch = follow(own, 0.3, 2.5, step=0.04)
    looked = search(branch, np.geomspace(0.35, 2.4, 6))
    (one,) = looked.branches
    assert one.periods == 2 and one.end == "closed" and not looked.lost
    low, high = 2 * one.branch.omega.min(), 2 * one.branch.omega.max()
    point = one.branch.at(0.8)[np.argmax([p.rms[0] for p in one.branch.at(0.8)])]
    time = steady_motion(own, 1.6, point.state())
    assert time.cycle == 2
    assert np.ptp(time.force) == pytest.approx(np.ptp(point.forces()), rel=1e-3)
    # beyond its ends such a motion falls back to that of one period
    for omega in (0.97 * low, 1.03 * high):
        assert steady_motion(own, omega, point.state()).cycle == 1


def test_a_branch_of_two_periods_that_comes_off_another_ends_there():
    own = pair(0.1)
    branch = follow(own, 0.3, 2.5, step=0.04)
    looked = search(branch, [1.2])
    (one,) = looked.branches
    assert one.end == "merged" and one.periods == 2
    # both ends are motions of one period, on the branch
    for point in (one.branch.points[0], one.branch.points[-1]):
        there = branch.at(2 * point.omega)
        assert min(abs(p.rms[0] / point.rms[0] - 1) for p in there) < 1e-3
