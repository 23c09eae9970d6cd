"""Stiffness that varies over the mesh cycle, curved laws, and several links at once: tongues,
harmonic balance against integration in time, energy.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b
from teeth import ALONG, mass_on_teeth

from solidgear.backlash.solver.continuation import follow
from solidgear.backlash.solver.integrated import Integrated
from solidgear.backlash.solver.model import remainder
from solidgear.backlash.solver.motion import steady_motion
from solidgear.backlash.solver.stability import multipliers
from solidgear.backlash.solver.varying import edges, growth, hill
from solidgear.core.system import BearingSpring, Inertia, RigidBody, RowSpring, System
from solidgear.core.system.law import Gap, RadialGap


@pytest.mark.parametrize("depth", [0.1, 0.5])
@pytest.mark.parametrize(("tongue", "low", "high"), [(1, 1.5, 2.6), (2, 0.8, 1.2)])
def test_tongues_of_mathieu_by_hill_and_by_floquet(depth, tongue, low, high):
    own = mass_on_teeth(Gap(1.0, 0.0), varying=depth)

    def apart(w, number):  # y'' + (a - 2 q cos 2z) y = 0 with a = 4 / w^2, q = 2 depth / w^2
        return number(tongue, 2 * depth / w**2) - 4 / w**2

    true = sorted(brentq(apart, low, high, args=(f,)) for f in (mathieu_a, mathieu_b))
    np.testing.assert_allclose(edges(own, low, high, half=tongue == 1), true, rtol=1e-10)
    # Floquet: asked 1e-4 of the frequency, and the narrowest tongue is 25 times that wide
    inside, outside = np.array(true) + [1e-4, -1e-4], np.array(true) + [-1e-4, 1e-4]
    assert all(abs(growth(own, w)) > 1 + 1e-5 for w in inside)
    assert all(abs(growth(own, w)) < 1 + 1e-9 for w in outside)


def test_losses_close_a_tongue_where_hill_says():
    own = mass_on_teeth(Gap(1.0, 0.0), varying=0.3, damping=0.05)
    for w in edges(own, 1.5, 2.6, half=True):
        assert abs(growth(own, w)) == pytest.approx(1.0, abs=1e-4)
    # first tongue: open above a depth of four damping ratios (to first order)
    assert (
        edges(mass_on_teeth(Gap(1.0, 0.0), varying=0.19, damping=0.05), 1.5, 2.6, half=True) == ()
    )
    assert hill(replace(own, cycle=0 * own.cycle), 2.0, half=True) == pytest.approx(1.0)


LAWS = {
    "backlash and cycle": (Gap(1.0, 1.0), 0.2),
    "hertz and cycle": (Gap(1.0, 0.05, exponent=1.5), 0.1),
    "impact": (Gap(1.0, 1.0, damper=0.3, ramp=0.2), 0.0),
    "two stiffnesses": (Gap(1.0, 0.02, coast=0.3), 0.0),
}


LONG = {"hertz and cycle", "two stiffnesses"}


@pytest.mark.parametrize(
    "law", [pytest.param(n, marks=pytest.mark.long if n in LONG else ()) for n in LAWS]
)
def test_balance_and_time_agree_on_every_law(law):
    law, depth = LAWS[law]
    own = mass_on_teeth(law, mean=0.1, error=0.05, varying=depth, damping=0.05)
    slow = np.sqrt(own.stiffness[0, 0])
    point = follow(own, 0.45 * slow, 1.1 * slow).at(0.85 * slow)[-1]
    assert point.forces().min() < 0.02, "this is to be a motion that leaves its piece"
    found = steady_motion(replace(own), point.omega, point.state(), steady=1e-4)
    assert found.cycle == 1
    assert found.rms[0] == pytest.approx(point.rms[0], rel=1e-3)


def test_a_mass_gains_over_a_cycle_what_it_loses():
    own = mass_on_teeth(Gap(1.0, 1.0), mean=0.1, error=0.05, varying=0.2, damping=0.05)
    point = follow(own, 0.5, 0.9).points[-1]
    state = point.state()
    for _ in range(30):
        state, *_ = Integrated(own, point.omega, 1, 1e-9).period(state)
    run = Integrated(own, point.omega, 2048, 1e-9)
    _, s, v = run.period(state)
    angle = 2 * np.pi * np.arange(run.looks) / run.looks
    force = own.forces(s, v, own.factor(angle)).value[:, 0]
    # s'' + 2 zeta s' + f = F_m - e'': inertia and mean load give nothing back over a cycle
    given = 0.05 * point.omega**2 * np.cos(angle) * v[:, 0]
    lost = (2 * 0.05 * v[:, 0] + force) * v[:, 0]
    assert np.mean(given) > 0
    assert np.mean(lost) == pytest.approx(np.mean(given), rel=1e-6)


def rotor(clearance):
    """A disc of 10 kg on a shaft of 1e7 N/m, off its seat's middle, in a seat with clearance."""
    disc = RigidBody(np.diag([10.0, 10.0, 10.0, 0.1, 0.2, 0.1]), {"hub": (0, 0, 0)})
    law = RadialGap(3e7, clearance)
    across = np.eye(6)[[0, 2]]
    links = {
        "shaft": BearingSpring("disc.hub", np.diag([1e7, 1e8, 1e7, 1e5, 1e5, 1e5])),
        "seat": RowSpring("disc.hub", across, law.radial, law=law),
    }
    system = System({"disc": disc}, links)
    turning = system.load({"disc.hub": [1, 0, 0, 0, 0, 0]}) - 1j * system.load(
        {"disc.hub": [0, 0, 1, 0, 0, 0]}
    )
    return remainder(
        system,
        loss={"shaft": 0.1},
        kind="viscous",
        matched_hz=160.0,
        load=system.load({"disc.hub": [0, 0, -100.0, 0, 0, 0]}),
        forces=[10.0 * 2e-6 * turning],
        unbalance=True,
    )


@pytest.mark.long
def test_a_rotor_that_rubs_moves_alike_by_balance_and_in_time():
    own = rotor(20e-6)
    branch = follow(own, 500.0, 1080.0, step=0.1)
    free, rubbing = branch.points[0], branch.points[-1]
    assert not free.forces().any() and rubbing.forces().any()
    # in the clearance it is the shaft alone: m e w^2 / (k - m w^2 + i w c)
    c = 0.1 * 1e7 / (2 * np.pi * 160.0)
    alone = 2e-5 * 500.0**2 / abs(1e7 - 10 * 500.0**2 + 500j * c)
    np.testing.assert_allclose(free.rms, alone / np.sqrt(2), rtol=1e-8)
    found = steady_motion(own, rubbing.omega, rubbing.state(), steady=1e-4)
    assert found.cycle == 1
    np.testing.assert_allclose(found.rms, rubbing.rms, rtol=1e-3)


def test_a_curved_law_has_multipliers_too():
    own = mass_on_teeth(Gap(1.0, 0.05, exponent=1.5), mean=0.1, error=0.005, damping=0.05)
    slow = np.sqrt(own.stiffness[0, 0])
    point = follow(own, 0.6 * slow, 0.5 * slow).points[0]
    left = np.exp(-own.losses[0, 0] * 2 * np.pi / point.omega)
    # the product is what damping leaves (Liouville), whatever the law: within the midpoint rule
    assert abs(np.prod(multipliers(point))) == pytest.approx(left, rel=1e-3)


def test_straight_laws_that_vary_are_told_in_one_go_as_law_by_law():
    # two links, one of them damped in contact; a stiff mode that only gives way; unbalance
    laws = Gap(1.0, 0.5, coast=0.7), Gap(2.0, 0.3, damper=0.2)
    parts = {name: Inertia(size, "z") for name, size in (("a", 1.0), ("b", 0.5), ("c", 0.1))}
    links = {
        "first": RowSpring("a", ALONG, 1.0, law=laws[0]),
        "second": RowSpring("b", ALONG, 2.0, "a", [-x for x in ALONG], law=laws[1]),
        "stiff": RowSpring("c", ALONG, 90.0, "b", [-x for x in ALONG]),
    }
    own = remainder(
        System(parts, links),
        load=np.array([0.1, 0.2, 0.0]),
        errors={"first": [0.2, 0.1j], "second": [0.05]},
        cycles={"first": [0.2, 0.0, 0.1j], "second": [0.1]},
        forces=[np.array([0.3, 0.2j, 0.1])],
        unbalance=True,
        loss={"first": 0.05, "stiff": 0.02},
        kind="viscous",
        matched_hz=1.0,
        highest_hz=1.0,
    )
    assert len(own.omega) == 2 and own.flexible.all()
    run, random = Integrated(own, 0.8, ramp=0.01), np.random.default_rng(3)
    for beyond in np.ndindex(2, 2, 2, 2):
        run._sides = [bool(on) for on in beyond]
        t, y = random.uniform(0, 9), random.normal(size=4)
        np.testing.assert_allclose(run._straight_slope(t, y), run._slope(t, y), rtol=1e-12)
