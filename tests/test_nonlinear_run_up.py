"""A speed that changes evenly: the linear oscillator in closed form, Lewis's late and low peaks, and
teeth with backlash beside their steady motions.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import wofz
from teeth import ALONG, mass_on_teeth

from solidgear.backlash.solver.continuation import follow
from solidgear.backlash.solver.model import remainder
from solidgear.backlash.solver.run_up import run_up
from solidgear.core.errors import SolidgearError
from solidgear.core.system import Inertia, RowSpring, System
from solidgear.core.system.law import Gap

ZETA, ERROR = 0.05, 0.05


def pair(mean, varying=0.0, gap=1.0):
    """A mass on teeth with a half gap."""
    return mass_on_teeth(Gap(1.0, gap), mean, ERROR, varying, ZETA)


def closed_form(t, begin, ramp):
    """Motion x of the linear mass from rest, x'' + 2 zeta x' + x = e + 2 zeta e'.

    Each mode is an integral of a Gaussian with complex coefficients (Lewis 1932), by Faddeeva's
    function.
    """
    damped, out = np.sqrt(1 - ZETA**2), 0.0
    for pole in (-ZETA + 1j * damped, -ZETA - 1j * damped):
        sides = [gaussian(t, side * 0.5j * ramp, side * 1j * begin - pole) for side in (1, -1)]
        error = ERROR * (np.cos(begin * t + ramp * t**2 / 2) - np.exp(pole * t))
        whole = ERROR / 2 * np.exp(pole * t) * sum(sides)
        out += ((1 + 2 * ZETA * pole) * whole + 2 * ZETA * error) / (2j * pole.imag)
    return out.real


def gaussian(t, p, q):
    """Integral of exp(p s^2 + q s) from 0 to t."""
    root, ends = np.sqrt(-p), []
    for at in (0.0, t):
        z = root * (at + q / (2 * p))
        side = 1 if z.real >= 0 else -1  # erfc(z) = 2 - erfc(-z)
        own = -side / 2 * wofz(1j * side * z) * np.exp(p * at**2 + q * at)
        ends.append(np.sqrt(np.pi) / root * (own - (side < 0) * np.exp(-(q**2) / (4 * p))))
    return ends[1] - ends[0]


@pytest.mark.parametrize("varying", [0.0, 1e-14], ids=["between contacts", "integrated"])
@pytest.mark.parametrize(("begin", "end"), [(0.6, 1.4), (1.4, 0.6)])
def test_a_linear_run_is_that_of_the_closed_form(begin, end, varying):
    own, ramp = pair(10.0, varying, gap=0.0), 4e-3
    found = run_up(own, begin, end, ramp, tolerance=1e-9)
    slope = np.sign(end - begin) * ramp
    angle = 2 * np.pi * len(found.omega)
    t = 2 * angle / (begin + np.sqrt(begin**2 + 2 * slope * angle))
    x = float(own.shapes[0, 0] * found.state[0] / own.omega[0])
    # what a step of constant speed leaves, or the tolerance asked
    assert x == pytest.approx(closed_form(t, begin, slope), abs=1e-6 * ERROR / (2 * ZETA))


@pytest.mark.parametrize(("begin", "end"), [(0.5, 1.6), (1.6, 0.5)])
def test_the_faster_the_ramp_the_later_and_lower_the_peak(begin, end):
    runs = [run_up(pair(10.0, gap=0.0), begin, end, ramp) for ramp in (1e-3, 4e-3, 16e-3)]
    peaks = [float(run.swing.max()) for run in runs]
    at = [float(run.omega[run.swing.argmax()]) for run in runs]
    later = 1 if end > begin else -1
    assert ERROR / (2 * ZETA) > peaks[0] > peaks[1] > peaks[2]
    assert all(later * (b - a) > 0 for a, b in zip(at, at[1:]))


@pytest.fixture(scope="module")
def branch():
    return follow(pair(0.1), 0.5, 1.3)


def test_a_slow_run_follows_the_branch_and_leaves_it_beyond_where_it_turns(branch):
    turn = max(branch.points[k].omega for k in branch.turning)
    found = run_up(pair(0.1), 0.75, 1.0, 2e-4, state=branch.at(0.75)[0].state())
    low, high = found.omega < turn, found.omega > 0.9
    for where, which in ((low, 0), (high, -1)):
        where = np.flatnonzero(where)[::4]
        steady = [np.ptp(branch.at(w)[which].forces()) / 2 for w in found.omega[where]]
        # the speed changes by 2e-3 over the 1/zeta in which motions fade: next to where the branch
        # turns upright that is a few per cent, elsewhere below one
        off = np.abs(found.swing[where] / steady - 1)
        assert off.max() < 0.05 and np.median(off) < 0.005
    assert found.swing[~low][0] < 0.11 and found.swing.max() > 0.15
    assert found.least[low][:-10].min() > 1.0 > found.least.min()


def test_a_run_through_contacts_is_the_same_by_exact_pieces_and_integrated(branch):
    begin = branch.at(0.95)[-1].state()
    exact, other = (
        run_up(pair(0.1, c), 0.95, 0.85, 1e-3, state=begin, tolerance=1e-10) for c in (0.0, 1e-14)
    )
    assert exact.least.min() < 1.0
    np.testing.assert_allclose(exact.state, other.state, atol=2e-7)
    np.testing.assert_allclose(exact.swing, other.swing, rtol=1e-3)  # looks at other instants


@pytest.mark.long
def test_a_run_of_two_links_is_that_of_the_equations_written_out():
    """Two masses in a row on teeth that both part, by a general integrator that knows none of this."""
    half, mean, begin, end, ramp = (1.0, 0.5), 0.06, 0.4, 1.8, 3e-3
    first = RowSpring("one", ALONG, 1.0, law=Gap(1.0, half[0]))
    second = RowSpring("two", ALONG, 1.0, to="one", law=Gap(1.0, half[1]))
    own = remainder(
        System({name: Inertia(1.0, "z") for name in ("one", "two")}, {"a": first, "b": second}),
        load=np.array([0.0, mean]),
        errors={"a": [ERROR]},
        loss=dict.fromkeys("ab", 2 * ZETA),
        kind="viscous",
        matched_hz=1 / (2 * np.pi),
    )
    found = run_up(own, begin, end, ramp)

    def teeth(s, b):
        return np.where(s > b, s - b, np.where(s < -b, s + b, 0.0))

    def stretches(t, y):
        angle = begin * t + ramp * t**2 / 2
        error, rate = ERROR * np.cos(angle), -ERROR * np.sin(angle) * (begin + ramp * t)
        return (y[0] - error, y[1] - y[0]), (y[2] - rate, y[3] - y[2])

    def slope(t, y):
        s, v = stretches(t, y)
        one, two = (teeth(a, b) + 2 * ZETA * c for a, b, c in zip(s, half, v))
        return [y[2], y[3], two - one, mean - two]

    turn = 2 * np.pi * np.arange(len(found.omega) + 1)
    times = 2 * turn / (begin + np.sqrt(begin**2 + 2 * ramp * turn))
    # at rest where springs without gaps would hold the mean: the teeth are apart
    still = [mean, 2 * mean, 0.0, 0.0]
    way = solve_ivp(slope, (0, times[-1]), still, "LSODA", dense_output=True, rtol=1e-9, atol=1e-11)
    assert found.least.min() < half[0] and found.other_links[0].least.min() < half[1]
    for k, one in enumerate((found, *found.other_links)):
        swing = []
        for a, b in zip(times, times[1:]):
            t = np.linspace(a, b, 300)
            force = teeth(stretches(t, way.sol(t))[0][k], half[k])
            swing.append(np.ptp(force) / 2)
        # looks at other instants of a cycle, fewer of which are near its ends
        np.testing.assert_allclose(one.swing, swing, rtol=5e-3, atol=1e-5)


@pytest.mark.parametrize(("begin", "end"), [(0.6, 1.4), (1.4, 0.6)])
def test_spectra_of_a_linear_run_have_the_first_order_at_its_swing_and_no_other(begin, end):
    found = run_up(pair(10.0, gap=0.0), begin, end, 4e-4)
    own = found.spectra
    (first,) = np.flatnonzero(own.order == 1.0)
    near = np.interp(own.omega, *zip(*sorted(zip(found.omega, found.swing))))
    # over the cycles of a spectrum, a twentieth of the speed, the peak is a bend of a few hundredths
    np.testing.assert_allclose(own.size[:, first], near, rtol=5e-2)
    assert np.median(abs(own.size[:, first] / near - 1)) < 5e-3
    # beside it rings the oscillator itself, at frequencies that are no multiples
    assert own.size[:, own.order > 1.8].max() < 1e-3 * near.max()


@pytest.mark.parametrize(
    ("ramp", "says"),
    [(0.0, "a ramp above zero"), (1.0, "in 0 cycles"), (1e-8, "give one that takes 10 to")],
)
def test_a_ramp_that_cannot_be_is_refused(ramp, says):
    with pytest.raises(SolidgearError, match=says):
        run_up(pair(0.1), 0.5, 1.3, ramp)
