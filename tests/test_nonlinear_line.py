"""A line of action that turns over the cycle, and edges that are a circle: harmonic balance, motion
in time and Floquet against each other and against the equations written out.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from test_nonlinear_varying import rotor

from solidgear.backlash.solver.balance import Balance
from solidgear.backlash.solver.continuation import follow
from solidgear.backlash.solver.integrated import Integrated
from solidgear.backlash.solver.model import remainder
from solidgear.backlash.solver.motion import steady_motion
from solidgear.backlash.solver.stability import multipliers
from solidgear.backlash.solver.varying import edges, growth
from solidgear.core.system import BearingSpring, RigidBody, RowSpring, System
from solidgear.core.system.law import Gap

#: springs to ground and their losses, along x and z; of the teeth that touch
GROUND, LOSS = np.array([0.3, 0.5]), 0.1
MEAN, ERROR = np.array([0.6, 0.1]), 0.05


def disc(first=0.3, second=0.1, damper=0.0, error=ERROR, varies=0.1, loss=LOSS):
    """A unit mass with two motions, whose teeth act along (1, a(t))."""
    body = RigidBody(np.diag([1.0, 1.0, 1.0, 0.1, 0.1, 0.1]), {"hub": (0, 0, 0)})
    law = Gap(1.0, 1.0, damper=damper)
    seat = np.diag([GROUND[0], 1.0, GROUND[1], 1.0, 1.0, 1.0])
    links = {
        "seat": BearingSpring("disc.hub", seat),
        "teeth": RowSpring("disc.hub", np.eye(6)[0], law.stiffness(1.0), law=law),
    }
    system = System({"disc": body}, links)
    turn = np.array([[first * np.exp(0.3j)], [second]])
    return remainder(
        system,
        load=system.load({"disc.hub": [MEAN[0], 0, MEAN[1], 0, 0, 0]}),
        errors={"teeth": [error, 0.4j * error]},
        cycles={"teeth": [varies]},
        sways={"teeth": (RowSpring("disc.hub", np.eye(6)[2]), turn)} if first else {},
        loss={"seat": loss},
        kind="viscous",
        matched_hz=1 / (2 * np.pi),
    )


def written_out(w, damper):
    """Slope of (x, z, x', z') under the equations of the disc."""

    def slope(t, y):
        a = 0.3 * np.cos(w * t + 0.3) + 0.1 * np.cos(2 * w * t)
        turning = -0.3 * w * np.sin(w * t + 0.3) - 0.2 * w * np.sin(2 * w * t)
        e, faster = ERROR * np.cos(w * t), 0.4 * ERROR * np.sin(2 * w * t)
        rate = -ERROR * w * np.sin(w * t) - 0.8 * ERROR * w * np.cos(2 * w * t)
        s = y[0] + a * y[1] - e + faster
        v = y[2] + a * y[3] + turning * y[1] - rate
        depth = np.sign(s) * max(abs(s) - 1, 0.0)
        force = (depth + damper * v * (abs(s) > 1)) * (1 + 0.1 * np.cos(w * t))
        push = MEAN - LOSS * GROUND * y[2:] - GROUND * y[:2] - force * np.array([1.0, a])
        return np.concatenate([y[2:], push])

    return slope


@pytest.fixture(scope="module")
def loose():
    """A motion that loses contact."""
    point = follow(disc(), 0.55, 0.62).at(0.6)[-1]
    assert point.along().min() < 1.0
    return point


@pytest.mark.long
def test_teeth_whose_line_turns_move_as_the_equations_written_out(loose):
    moves_as_written_out(loose, 0.0)


@pytest.mark.long
def test_teeth_that_lose_in_contact_alone_move_as_the_equations_written_out():
    balance = Balance(disc(damper=0.1), 15)
    moves_as_written_out(follow(balance.remainder, 0.52, 0.56).at(0.54)[-1], 0.1)


def moves_as_written_out(point, damper):
    own, w = point.balance.remainder, point.omega
    s, v = point.waves()
    # the stretch of the first row is less the transmission error
    begin = [s[0, 0] + ERROR, s[0, 1], v[0, 0] - 0.8 * ERROR * w, v[0, 1]]
    period = 2 * np.pi / w
    times = period * np.arange(len(s)) / len(s)
    there = solve_ivp(
        written_out(w, damper),
        (0.0, period),
        begin,
        rtol=1e-7,
        atol=1e-9,
        t_eval=times,
        max_step=period / 50,
    ).y
    e = ERROR * np.cos(w * times) - 0.4 * ERROR * np.sin(2 * w * times)
    # harmonics are followed to 1e-4 of the largest
    for one, other in ((there[0] - e, s[:, 0]), (there[1], s[:, 1])):
        np.testing.assert_allclose(one, other, atol=3e-4 * np.ptp(other))
    found = steady_motion(own, w, point.state(), steady=1e-4)
    assert found.cycle == 1
    np.testing.assert_allclose(found.rms, point.rms, rtol=3e-4)


def test_the_balance_of_a_turning_line_has_an_exact_jacobian():
    balance, w, h = Balance(disc(damper=0.2, error=0.4), 4), 0.8, 1e-6
    motion = balance.start(w) + 0.02 * np.sin(np.arange(balance.start(w).size))
    motion[0] -= 0.5
    found = balance.residual(motion, w)
    along = balance.line(w).along(slice(0, 2), balance.stretch(motion, w)[0])
    assert along.min() < 1.0 < along.max(), "contact is to be lost, or the edge is not tried"
    columns = [
        (balance.residual(motion + h * d, w).value - balance.residual(motion - h * d, w).value)
        for d in np.eye(len(motion))
    ]
    np.testing.assert_allclose(np.column_stack(columns) / (2 * h), found.jacobian, atol=1e-7)
    ahead, behind = (balance.residual(motion, w + d).value for d in (h, -h))
    np.testing.assert_allclose((ahead - behind) / (2 * h), found.by_omega, atol=1e-7)


def test_a_turning_line_alone_makes_motions_grow_where_hill_says():
    own = disc(first=0.8, second=0.0, varies=0.0, loss=0.0)
    low, high = edges(own, 0.7, 0.95, half=False)
    assert abs(growth(own, (low + high) / 2)) > 1.05
    # asked: the same edges to 1e-4
    inside, outside = (low + 1e-4, high - 1e-4), (low - 1e-4, high + 1e-4)
    assert all(abs(growth(own, w)) > 1 + 1e-3 for w in inside)
    assert all(abs(growth(own, w)) < 1 + 1e-6 for w in outside)


@pytest.mark.slow
def test_multipliers_of_a_turning_line_are_how_motions_beside_it_fade(loose):
    own, size = loose.balance.remainder, 1e-6
    run = Integrated(own, loose.omega, 1, 1e-11)
    begin = steady_motion(own, loose.omega, loose.state(), steady=1e-6).state
    ends = [run.period(begin + size * d)[0] for d in np.eye(len(begin))]
    found = np.linalg.eigvals((np.array(ends) - run.period(begin)[0]).T / size)
    # the midpoint rule over 400 intervals of the cycle, and where in one of them contact is lost
    assert np.abs(found).max() == pytest.approx(abs(multipliers(loose)[0]), rel=2e-2)


def test_instants_beside_the_edge_of_a_circle_leave_an_error_of_second_order():
    own = rotor(20e-6)
    point = follow(own, 1080.0, 1000.0, step=0.1).points[0]
    away = np.linalg.norm(point.waves()[0], axis=1)
    assert away.min() < 20e-6 < away.max()
    motion = point.balance.resized(point.motion, 25)[1]
    few, half, many = (Balance(own, 25, n).solve(motion, point.omega) for n in (11, 22, 88))
    # regular, as that of a smooth force: (1 - 1/64) / (1/4 - 1/64); it jumps with every instant that
    # crosses the edge where that is not told
    expected = 4.2 * (half - many)
    np.testing.assert_allclose(few - many, expected, atol=0.1 * np.abs(expected).max())
