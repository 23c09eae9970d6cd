"""One geared pair with backlash, ``x'' + 2 zeta x' + f(x) = F_m + F_a w^2 cos w t``: harmonic
balance, continuation, stability and motion in time.
"""

import numpy as np
import pytest
from teeth import ALONG, mass_on_teeth

from solidgear.backlash.solver.apart import period_doubled_branches
from solidgear.backlash.solver.balance import Balance
from solidgear.backlash.solver.continuation import follow
from solidgear.backlash.solver.model import remainder
from solidgear.backlash.solver.motion import Run, steady_motion, sweep
from solidgear.backlash.solver.run_up import run_up
from solidgear.backlash.solver.stability import multipliers, stable
from solidgear.core.errors import SolidgearError
from solidgear.core.system import Inertia, RowSpring, System
from solidgear.core.system.law import Gap

ZETA, MEAN = 0.05, 0.1
TEETH = Gap(1.0, 1.0)


def pair(amplitude, law=TEETH):
    """A mass on teeth with a half gap of one."""
    return mass_on_teeth(law, MEAN, amplitude, damping=ZETA)


def linear_rms(amplitude, w):
    return amplitude * w**2 / abs(1 - w**2 + 2j * ZETA * w) / np.sqrt(2)


@pytest.fixture(scope="module")
def loud():
    return follow(pair(0.05), 0.5, 1.3)


def test_a_motion_that_keeps_contact_is_the_linear_one():
    # contact is lost where the amplitude F_a / (2 zeta) of the linear peak reaches the mean, 0.1
    branch = follow(pair(0.0099), 0.5, 1.3)
    assert not branch.turning
    found = np.array([point.rms[0] for point in branch.points])
    np.testing.assert_allclose(found, linear_rms(0.0099, branch.omega), rtol=1e-10)


@pytest.mark.parametrize(("amplitude", "down", "up"), [(0.02, 0.8878, 0.9265), (0.05, 0.7082, 0)])
def test_a_branch_turns_where_it_jumps(amplitude, down, up):
    # told to four digits from a branch of points that were not refined: half a step of 0.001
    branch = follow(pair(amplitude), 0.5, 1.3)
    first, second = (branch.points[k].omega for k in branch.turning)
    assert second == pytest.approx(down, abs=1e-3)
    assert first == pytest.approx(up or 0.8285, abs=1e-3)


def test_three_motions_live_at_one_speed(loud):
    lower, middle, upper = (point.rms[0] for point in loud.at(0.75))
    assert lower == pytest.approx(linear_rms(0.05, 0.75), rel=1e-9)
    assert middle == pytest.approx(0.1715, abs=5e-5)
    # sampled between the kinks: a part in ten thousand
    assert upper == pytest.approx(0.22472, abs=2e-5)


@pytest.mark.long
def test_sweeps_in_time_follow_the_branch_and_jump_where_it_turns(loud):
    up, down = (loud.points[k].omega for k in loud.turning)
    rising = sweep(pair(0.05), [0.7, 0.75, 0.8, up - 1e-3, up + 1e-3])
    falling = sweep(pair(0.05), [0.9, 0.8, 0.75, down + 1e-3, down - 1e-3])
    assert all(one.cycle == 1 for one in rising + falling)
    lower = [loud.at(one.omega)[0].rms[0] for one in rising[:-1]]
    upper = [loud.at(one.omega)[-1].rms[0] for one in falling[:-1]]
    # one part in a thousand is asked; both solve the same law, the balance with few harmonics
    np.testing.assert_allclose([one.rms[0] for one in rising[:-1]], lower, rtol=2e-4)
    np.testing.assert_allclose([one.rms[0] for one in falling[:-1]], upper, rtol=2e-4)
    assert rising[-1].rms[0] > 2 * rising[-2].rms[0]
    assert falling[-1].rms[0] < falling[-2].rms[0] / 5


def test_what_lies_between_the_turning_points_is_unstable_and_nothing_else(loud):
    first, second = loud.turning
    found = [bool(stable(point)) for point in loud.points]
    inner = [first < k < second for k in range(len(found))]
    edge = {first - 1, first, first + 1, second - 1, second, second + 1}
    assert [a for k, a in enumerate(found) if k not in edge] == [
        not b for k, b in enumerate(inner) if k not in edge
    ]
    # at a turning point one multiplier is one: within what few harmonics leave of it
    for k in loud.turning:
        assert abs(multipliers(loud.points[k])[0]) == pytest.approx(1.0, abs=0.02)


def test_teeth_with_a_damper_carry_what_the_mass_takes_up():
    # Newton's second law of the mass, on which nothing but the mean force and the teeth act
    law = Gap(1.0, 1.0, damper=0.2)
    system = System({"gear": Inertia(1.0, "z")}, {"mesh": RowSpring("gear", ALONG, 1.0, law=law)})
    own = remainder(system, load=np.array([MEAN]), errors={"mesh": [0.02]})
    w = 1.1
    point = follow(own, 1.0, w).points[-1]
    motion = point.harmonics[1, 0] + 0.02
    force = w**2 * abs(motion)
    assert 1.02 * abs(point.harmonics[1, 0]) < force < MEAN
    ran = run_up(own, w - 1e-6, w, 1e-8, state=point.state())
    for wave in (point.forces(), steady_motion(own, w, point.state()).force, 2 * ran.swing):
        # the largest of 128 looks at a cosine
        assert (np.ptp(wave) if wave.ndim > 1 else wave[-1]) / 2 == pytest.approx(force, rel=4e-4)


@pytest.mark.parametrize(
    "law", [Gap(1.0, 1.0), Gap(1.0, 1.0, damper=0.2)], ids=["elastic", "damped in contact"]
)
def test_multipliers_are_how_a_disturbed_motion_fades(law):
    own = pair(0.05, law)
    point = follow(own, 1.3, 0.5).at(0.9)[-1]
    found, period = multipliers(point)[0], 2 * np.pi / point.omega
    run = Run(own, point.omega)
    steady = steady_motion(own, point.omega, point.state(), steady=1e-10).state
    moved = steady + np.array([1e-5, 0.0])
    left = [moved - steady]
    for _ in range(6):
        moved = run.period(moved)[0]
        left.append(moved - steady)
    # differences obey d_(n+2) = trace d_(n+1) - det d_n, with the sum and product of a pair
    sums, product = 2 * found.real, abs(found) ** 2
    found = np.array(left)
    np.testing.assert_allclose(
        found[2:], sums * found[1:-1] - product * found[:-2], atol=2e-2 * np.abs(found).max()
    )
    assert product < np.exp(-2 * ZETA * period) * (1 + 1e-9)


@pytest.mark.long
def test_where_a_period_doubles_a_branch_of_two_periods_begins_that_time_confirms():
    own = pair(0.1)
    branch = follow(own, 1.0, 2.5)
    (two,) = period_doubled_branches(branch)
    begin, end = (2 * two.points[k].omega for k in (0, -1))
    flips = [point.omega for point in branch.points if not stable(point)]
    assert begin < min(flips) and max(flips) < end
    for w in (1.3, 1.9):
        (motion, *_), (single,) = two.at(w / 2), branch.at(w)
        found = steady_motion(own, w, 1.05 * single.state())
        assert stable(motion) and found.cycle == 2
        assert found.rms[0] == pytest.approx(motion.rms[0], rel=1e-3)
        assert abs(found.rms[0] / single.rms[0] - 1) > 0.02


def test_a_branch_does_not_depend_on_its_direction(loud):
    back = follow(pair(0.05), 1.3, 0.5)
    there = sorted(loud.points[k].omega for k in loud.turning)
    here = sorted(back.points[k].omega for k in back.turning)
    # harmonics are chosen on the way, to 1e-4 of the largest
    np.testing.assert_allclose(here, there, rtol=3e-4)


def test_one_harmonic_is_not_enough_and_three_nearly_are(loud):
    def upper(count):
        return follow(pair(0.05), 0.5, 1.3, harmonics=count).at(0.75)[-1].rms[0]

    true = loud.at(0.75)[-1].rms[0]
    assert abs(upper(1) / true - 1) > 0.02
    assert abs(upper(3) / true - 1) < 1e-3


@pytest.mark.parametrize(
    "law",
    [
        Gap(1.0, 1.0, coast=0.5),
        Gap(1.0, 0.05, exponent=1.5),
        Gap(1.0, 1.0, damper=0.3, ramp=0.2),
        Gap(1.0, 1.0, rounding=0.01),
    ],
    ids=["coast", "hertz", "impact", "rounded"],
)
def test_jacobians_are_those_of_the_sampled_law(law):
    balance = Balance(pair(0.05, law), 5)
    rng = np.random.default_rng(7)
    motion = np.zeros(11)
    motion[:3] = law.depth(MEAN), 0.5, 0.2
    motion += 0.05 * rng.standard_normal(11)
    found, along, h = balance.residual(motion, 0.8), rng.standard_normal(11), 1e-7
    ahead, behind = (balance.residual(motion + s * h * along, 0.8).value for s in (1, -1))
    np.testing.assert_allclose((ahead - behind) / (2 * h), found.jacobian @ along, atol=1e-6)
    ahead, behind = (balance.residual(motion, 0.8 + s * h).value for s in (1, -1))
    np.testing.assert_allclose((ahead - behind) / (2 * h), found.by_omega, atol=1e-6)


def test_a_range_through_zero_is_refused():
    with pytest.raises(SolidgearError, match="two different ones above zero"):
        follow(pair(0.05), -0.5, 1.0)


def test_a_negative_backlash_is_refused():
    with pytest.raises(SolidgearError, match="half gap of a contact is -1"):
        Gap(1.0, -1.0)
