"""What backlash is held against in validation/: two gears as ROSS has them, and pyHarm."""

import numpy as np
import pytest

from solidgear.backlash.solver.continuation import follow
from validation.backlash.gears import PARTING, ours, spur_pair, told
from validation.backlash.spur_pair import SpurPair
from validation.race import installed, pyharm_peer, ross_peer
from validation.race.backlash import branch_rms, pair, pair_for_pyharm, turning
from validation.race.installed import interpreter, missing, present


def gears(spread):
    return SpurPair(
        mass=6.57,
        polar=0.0365,
        base_radius=0.094,
        pressure_angle=np.radians(20.0),
        teeth=20,
        half_gap=5e-5,
        error=2e-6,
        bearing=1e8,
        damper=512.64,
        torque=300.0,
        swing=0.0,
        stiffness=np.full(64, 5e8),
        spread=spread,
    )


@pytest.mark.parametrize("spread", [1.0, 2.0])
def test_flanks_push_the_gears_apart_by_their_force_along_the_line_of_action(spread):
    found = gears(spread)
    turning = [0, 0, 0, 0, found.torque, 0]
    load = found.system.load({"first.hub": turning, "second.hub": turning})
    moved = [
        found.system.motion(f"{one}.hub") @ found.system.static(load) for one in ("first", "second")
    ]
    force = found.torque / found.base_radius
    apart = moved[1][0] - moved[0][0]
    assert apart == pytest.approx(2 * spread * force * np.sin(found.pressure_angle) / 1e8, rel=1e-9)


@pytest.mark.parametrize("spread", [1.0, 2.0])
def test_the_flank_that_carries_nothing_begins_where_the_gears_stand(spread):
    found = gears(spread)
    point = found.balanced(60 * 1000.0 / 20)
    drive, coast = point.balance.start(point.omega)[:2]
    # rigid gears that turn through the gap part the one flanks by as much as the others close up
    still = point.balance.linear(point.omega)[:2]
    assert [drive, coast] == pytest.approx(still + found.half_gap * np.array([1, -1]), rel=1e-9)


def test_gears_that_keep_contact_move_alike_by_balance_and_in_time():
    found = gears(2.0)
    point = found.balanced(60 * 1000.0 / 20)
    s, f = found.in_time(point)
    assert f[:, 0].min() > 0 and not f[:, 1].any()
    # integrated to 1e-7
    assert s[:, 0].std() == pytest.approx(point.rms[0], rel=1e-5)


def test_a_branch_of_points_turns_at_the_vertex_of_their_parabola():
    along = np.array([-1.5, -0.5, 0.5, 1.5])
    assert turning(3.0 - (along - 0.2) ** 2) == pytest.approx([3.0], rel=1e-12)


def test_a_python_is_found_by_the_package_it_has(monkeypatch):
    monkeypatch.setenv("PEERS", "")
    interpreter.cache_clear()
    assert interpreter("numpy") and not interpreter("no_such_package")
    interpreter.cache_clear()


def test_all_that_is_missing_is_named_at_once(monkeypatch):
    monkeypatch.setattr(installed, "interpreter", lambda module: "")
    monkeypatch.setattr(installed.shutil, "which", lambda command: None)
    text = missing("CalculiX", "ROSS", "pyHarm")
    assert text.startswith("CalculiX, ROSS and pyHarm are missing: apt-get install calculix-ccx; ")
    assert "pip install 'ross-rotordynamics>=2.3' 'plotly<6' 'pyharm-os>=1.2' (" in text
    assert missing("sfepy").startswith("sfepy is missing: pip install ")
    monkeypatch.setattr(installed, "interpreter", lambda module: "python")
    assert missing("ROSS", "sfepy") == ""


def test_a_package_that_cannot_be_imported_is_not_there(monkeypatch, tmp_path):
    (tmp_path / "broken_peer.py").write_text("raise AttributeError('plotly')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert not interpreter("broken_peer")


@pytest.mark.slow
@pytest.mark.skipif(not present("pyHarm"), reason="pyHarm is not installed")
def test_pyharm_agrees():
    branch = follow(pair(0.05), 0.5, 1.3)
    given = pair_for_pyharm(0.05)
    found = pyharm_peer.solve(harmonics=9, instants=1024, step=0.005, **given)
    omega = np.array(found["omega"])
    ours = branch.omega[list(branch.turning)]
    np.testing.assert_allclose(turning(omega), ours, rtol=1e-4)
    theirs = sorted(branch_rms(omega, np.array(found["stretch"]), 0.75))
    np.testing.assert_allclose(theirs, sorted(p.rms[0] for p in branch.at(0.75)), rtol=1e-3)


@pytest.mark.slow
@pytest.mark.skipif(not present("ROSS"), reason="ROSS is not installed")
def test_ross_agrees_on_gears_whose_teeth_part():
    given = PARTING | {"hz": [3110.0], "cycles": 300}
    found = ross_peer.in_time(**given)
    (run,) = found["runs"]
    stretch = np.array(run["approach"]) - np.array(run["gap"]) + 5e-5
    row = told(stretch, np.array(run["force"]))
    balance, _ = ours(spur_pair(found["pair"], run, given), 3110.0, row)
    # transients of the gears on their bearings fade over hundreds of mesh periods
    assert balance["swing"] == pytest.approx(row["swing"], rel=0.02)
    assert row["touching"] < 0.7
