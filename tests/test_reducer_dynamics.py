"""The reducer as bodies in contact: impacts, steps in time, two base frequencies, claims."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import beta

from solidgear.backlash.solver.balance import Balance, as_complex
from solidgear.backlash.solver.model import remainder
from solidgear.backlash.solver.two_tone import TwoTone
from solidgear.core.errors import SolidgearError
from solidgear.core.system import Inertia, RowSpring, System, torsion_spring
from solidgear.core.system.law import Gap
from validation.reducer.design import Design
from validation.reducer.dynamics import amplitudes
from validation.reducer.independent import envelope
from validation.reducer.multibody import Reducer
from validation.reducer.sidebands import Stage
from validation.reducer.spectra import measured
from validation.reducer.stepping import run
from validation.reducer.study import SETS

ALONG = [0, 0, 1, 0, 0, 0]
MASS, SPEED = 0.1, 0.3


def rebound(law, speed=SPEED):
    """Speed at which a mass leaves a contact that it meets at a speed, over that speed."""

    def slope(_, y):
        return [y[1], -law.force(y[None, :1], y[None, 1:]).value[0, 0] / MASS]

    def gone(t, y):
        return y[0] if t else 1.0

    gone.terminal = True
    found = solve_ivp(slope, (0, 1e-2), [0.0, speed], "DOP853", events=gone, rtol=1e-10, atol=1e-14)
    return -found.y_events[0][0][1] / speed


def test_an_impact_loses_what_its_closed_form_says():
    # little damping: the loss is the work of c(d) d' along the undamped path, a beta function each
    law = replace(Gap.impact(6e-3, 12e-3, share=1e-6), pulls=True)
    depth = (1.25 * MASS * SPEED**2 / law.drive) ** 0.4
    u = depth / law.ramp
    parts = 3 * u**2 * beta(1.2, 1.5) / 2.5 - 2 * u**3 * beta(1.6, 1.5) / 2.5
    loss = 2 * law.damper * SPEED * depth * parts
    # the next term is the square of the loss
    assert 1 - rebound(law) ** 2 == pytest.approx(loss / (MASS * SPEED**2 / 2), rel=2e-2)


def test_an_impact_rebounds_as_its_path_over_depth_says():
    # v dv/dd = -F/m once in and once out, without time; the share of the source
    law = Gap.impact(6e-3, 12e-3)

    def force(d, v):
        u = min(max(d, 0.0) / 1e-4, 1.0)
        return max(0.0, law.drive * max(d, 0.0) ** 1.5 + law.damper * u**2 * (3 - 2 * u) * v)

    def over_energy(s, y):  # along an arc s with dd = v ds, dv = -F/m ds
        return [y[1], -force(*y) / MASS]

    d, v, h = 0.0, SPEED, 2e-8
    while d >= 0:
        one = over_energy(0, (d, v))
        two = over_energy(0, (d + h / 2 * one[0], v + h / 2 * one[1]))
        d, v = d + h * two[0], v + h * two[1]
    assert rebound(law) == pytest.approx(-v / SPEED, rel=1e-4)
    assert 0 < rebound(law) < rebound(Gap.impact(6e-3, 12e-3, share=1e-3)) < 1


def test_what_leaves_is_never_held_back():
    law = Gap.impact(6e-3, 12e-3, half_gap=2e-6)
    depth = np.linspace(-2e-5, 2e-5, 81)[:, None]
    for rate in (-1.0, 0.0, 1.0):
        own = law.force(depth, np.full_like(depth, rate)).value[:, 0]
        assert (own * np.sign(depth[:, 0]) >= 0).all()
    # 0.01 mm deep at 1 mm/s, in N, mm and s
    stiff = 4 / 3 * 206e3 / (2 * 0.91) * np.sqrt(4)
    u = 0.1
    known = stiff * (0.01**1.5 + 0.01 * (3 * u**2 - 2 * u**3))
    found = law.force(np.array([[12e-6]]), np.array([[1e-3]])).value[0, 0]
    assert found == pytest.approx(known, rel=1e-12)
    with pytest.raises(SolidgearError, match="does not fit into one of 0.006 m"):
        Gap.impact(12e-3, 6e-3, internal=True)


def chain(law, cycle=0.0, fast=0.0, slow=0.0, stiffness=None):
    """Two masses, the second on teeth, pushed on the first."""
    parts = {"first": Inertia(1.0, "z"), "second": Inertia(0.5, "z")}
    links = {
        "shaft": torsion_spring("first", 2.0, "second", "z"),
        "teeth": RowSpring("second", ALONG, stiffness or law.stiffness(1.0), law=law),
    }
    known = {"loss": {"shaft": 0.2}, "kind": "viscous", "matched_hz": 0.5, "load": np.ones(2) / 2}
    push = np.array([1.0, 0.0])
    system = System(parts, links)
    return system, *(
        remainder(system, forces=[size * push], cycles={"teeth": [own]}, **known)
        for size, own in ((fast, cycle), (slow, 0.0))
    )


HERTZ = Gap(1.0, 0.0, exponent=1.5, damper=0.3, ramp=3.0, pulls=False)
TONES = (2.0, 0.13)


def test_two_tones_on_a_linear_system_are_its_response_at_either():
    law = Gap(1.0, 0.0, rounding=1e-9, damper=0.1)
    # half as stiff as its link: what the law leaves over goes through the balance at every pair
    system, fast, slow = chain(law, fast=0.3, slow=0.2, stiffness=2.0)
    stiffness = system.stiffness - np.diag([0.0, 1.0])
    lines = TwoTone(fast, slow, TONES, (2, 2), (8, 8)).lines()
    damping = 0.2 * 2.0 / np.pi * np.array([[1, -1], [-1, 1]]) + np.diag([0, 0.1])
    for pair, w, size in (((1, 0), TONES[0], 0.3), ((0, 1), TONES[1], 0.2)):
        dynamic = stiffness + 1j * w * damping - w**2 * system.mass
        known = np.linalg.solve(dynamic, [size, 0])[1]
        assert lines[pair][0] == pytest.approx(known, rel=1e-8)
    rest = [abs(line[0]) for pair, line in lines.items() if pair not in ((0, 0), (1, 0), (0, 1))]
    assert max(rest) < 1e-8 * abs(lines[1, 0][0])


def test_one_tone_alone_is_the_balance_of_one_frequency():
    _, fast, none = chain(HERTZ, cycle=0.3, fast=0.4)
    balance = Balance(fast, 6)
    known = as_complex(balance.solve(balance.start(TONES[0]), TONES[0]).reshape(-1, 1))
    lines = TwoTone(fast, none, TONES, (6, 2), (balance.samples, 6)).lines()
    found = np.array([lines[j, 0] for j in range(7)])
    np.testing.assert_allclose(found, known, atol=1e-8 * abs(known).max())
    _, none, slow = chain(HERTZ, slow=0.4)
    balance = Balance(slow, 6)
    known = as_complex(balance.solve(balance.start(TONES[1]), TONES[1]).reshape(-1, 1))
    lines = TwoTone(none, slow, TONES, (2, 6), (6, balance.samples)).lines()
    found = np.array([lines[0, k] for k in range(7)])
    np.testing.assert_allclose(found, known, atol=1e-8 * abs(known).max())


def test_the_jacobian_of_two_tones_is_the_slope_of_their_balance():
    _, fast, slow = chain(HERTZ, cycle=0.3, fast=0.4, slow=0.3)
    both = TwoTone(fast, slow, TONES, (3, 2), (16, 12))
    motion = both.start
    away = 1e-6 * np.random.default_rng(0).normal(size=motion.size)
    change = both.residual(motion + away).value - both.residual(motion - away).value
    np.testing.assert_allclose(
        2 * both.residual(motion).jacobian @ away, change, atol=1e-6 * abs(change).max()
    )


def test_a_law_with_corners_has_no_balance_of_two_tones():
    _, fast, slow = chain(Gap(1.0, 1.0))
    with pytest.raises(SolidgearError, match="give its edge a rounding"):
        TwoTone(fast, slow, TONES, (2, 2))


@pytest.mark.slow
def test_sidebands_by_two_tones_are_those_in_time():
    # twice the speed of the source: half as many steps a turn
    stage = Stage(Reducer(Design(), rpm=16000.0))
    both = stage.balance((6, 2))
    lines = both.force_lines(both.solve())
    motion = run(stage.bodies, 4096, settling=1, every=4)
    mesh = stage.reducer.orders["planetary"]
    main = abs(lines[1, 0])
    for pair, line in lines.items():
        if pair[1]:
            found = motion.line(pair[0] * mesh + pair[1])[0]
            # one per cent of the main line is asked of the steps
            np.testing.assert_allclose(found, abs(line), atol=1e-2 * main.min())
    assert max(abs(lines[1, 1]) / main) > 0.02


@pytest.fixture(scope="module")
def turned():
    """A reducer over two turns of its carrier, from rest."""
    # twice the speed of the source: half as many steps a turn
    reducer = Reducer(Design(), 2, 16000.0, runout=5e-6)
    return reducer, run(reducer.bodies, 4096, turns=2, settling=0, every=4)


@pytest.mark.slow
def test_steps_and_an_adaptive_integrator_have_one_envelope(turned):
    reducer, motion = turned
    there = 64  # a sixteenth of a turn: directions of the planets have turned by 22 degrees
    force, known = motion.force[:there, 0], envelope(reducer.bodies, there / 1024, there, 1e-5)
    # one per cent is asked
    for side in (np.max, np.min):
        np.testing.assert_allclose(side(force, axis=0), side(known, axis=0), rtol=1e-2)
    np.testing.assert_allclose(force[-1], known[-1], rtol=1e-2)


@pytest.mark.long
def test_energy_is_stored_or_lost(turned):
    # second order in the step: 6e-4 at the speed of the source, with the same steps a turn
    assert abs(turned[1].unbalanced[0]) < 2e-3
    assert turned[1].energy["lost"][0] > 0.1 * turned[1].energy["passed"][0]


def test_a_step_that_is_too_coarse_for_the_contact_is_refused():
    ideal = Reducer(Design(), 0, 16000.0).bodies
    with pytest.raises(SolidgearError, match=r"a step of 73\.2 us is too coarse .* takes 108 us"):
        run(ideal, 512)


@pytest.mark.long
def test_in_time_the_modulation_is_the_closed_form_within_a_few_per_cent(turned):
    reducer, motion = turned
    settled = motion.force[1024:, 0]
    # contacts are curved and their dampers press too
    closed = reducer.design.modulation(False)
    assert amplitudes(settled)[1, 1:] == pytest.approx(closed, rel=0.05)
    # each planet is pressed where the turn at rest presses it; dampers are a few degrees late
    turn = reducer.design.settled_turn(False)
    for found, known in ((settled[:, 1:4], turn.sun_mesh), (settled[:, 4:], turn.ring_mesh)):
        wave, rest = (np.fft.rfft(one, axis=0)[1] / len(one) for one in (found, known))
        assert np.abs(wave / rest - 1).max() < 0.15
    assert settled.mean(axis=0) == pytest.approx(reducer.mean, rel=1e-3)


def test_planets_mesh_together_or_one_after_the_other_by_their_teeth():
    together, in_turn = (Reducer(Design(teeth=teeth)).cycle[0, 1:] for teeth in SETS[::-1])
    for mate in (slice(3), slice(3, 6)):
        assert together[mate] == pytest.approx(together[mate][0], rel=1e-12)
        assert abs(in_turn[mate].sum()) < 1e-12
    # 17 and 85 teeth leave two thirds and one third of a tooth to the next planet: the same way round
    assert in_turn[1] / in_turn[0] == pytest.approx(in_turn[4] / in_turn[3], rel=1e-12)


def test_measured_lines_are_orders_or_the_bench_and_one_is_neither():
    lines = {(line.rpm, line.hertz): line.name for line in measured(Design())}
    assert lines[8000, 1598] == lines[8000, 1868] == "bench"
    assert lines[8000, 137] == lines[6000, 100] == "shaft"
    assert (lines[8000, 1113], lines[8000, 2008]) == ("planets", "bevel")
    assert [pair for pair, name in lines.items() if name == "none"] == [(8000, 876)]


def test_what_planets_push_on_is_the_carrier_and_not_the_housing():
    own = Reducer(Design(), 3)
    aloft = own.basis[own.system.place("planet 2")].any(axis=0)
    held = own.basis[own.system.place("shaft")].any(axis=0)
    assert not own.on_housing[aloft].any() and own.on_housing[held].any()
