"""Notch factors of DIN 743 by hand, size of steels, and Miner's rule."""

import math

import numpy as np
import pytest

from solidgear.core.scene.parts import Strength
from solidgear.strength.stress import din743
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.din743 import LOADS
from solidgear.strength.stress.norm import forms, steels, tested
from solidgear.strength.stress.norm.life import (
    elementary_repetitions,
    equivalent_share,
    repetitions,
)
from solidgear.strength.stress.norm_notch import NotchByForm, NotchByTests, Section
from solidgear.strength.stress.rated_notch import Steel
from solidgear.strength.stress.rating import rated

LOG20 = math.log10(20)


def beta(notch, ultimate, yields=1e9, hard=False):
    """Factors of tension, bending and torsion in a steel, MPa."""
    factors = notch.factors(Steel(1e6 * ultimate, 1e6 * yields, hard)).notch
    return [factors[load] for load in LOADS]


def by_tests(diameter, factors, at, rough=0.0, revolved=False):
    """A notch of the norm's tests; lengths in mm."""
    return NotchByTests(Section(1e-3 * diameter), "", factors, 1e-3 * at, rough, revolved=revolved)


def by_form(diameter, form, gradient, revolved=True, hole=0.0):
    """A notch by form factors; lengths in mm."""
    section = Section(1e-3 * diameter, 0.0, 1e-3 * hole)
    forms_, slopes = ({k: f(k) for k in LOADS} for f in (form, gradient))
    return NotchByForm(section, "", forms_, slopes, revolved=revolved)


def keyed(diameter, count=1):
    return by_tests(diameter, lambda steel: tested.keyway(steel.ultimate, count), 40)


def holed(diameter, hole):
    d, h = 1e-3 * diameter, 1e-3 * hole
    return by_form(
        diameter,
        lambda load: forms.cross_hole(load, h, d),
        lambda load: forms.hole_gradient(load, h, d),
        revolved=False,
        hole=hole,
    )


def stepped(large, small, radius):
    sizes = [1e-3 * length for length in (large, small, radius)]
    return by_form(
        small,
        lambda load: din743.form_factor(load, *sizes),
        lambda load: din743.gradient(load, *sizes),
    )


# ----------------------------------------------------------------------- factors by hand
# each row: a notch, its strength and yield point in MPa, and the factors of bending and torsion, with
# lengths in mm by a pocket calculator
TABLE = {
    # 3 0.6^0.38 = 2.4706, 0.56 of it and 0.1: 1.4836; tested at 40 mm: nothing to turn
    "keyway, 40 mm": (keyed(40), 600, 400, 2.4706, 1.4836),
    # K_3(40) = 1 - 0.2 lg 2.4706 lg(40/7.5)/lg 20 = 0.9561, K_3(80) = 0.9379: 2.4706 0.9561/0.9379; torsion 1.4836 0.9809/0.9729
    "keyway, 80 mm": (keyed(80), 600, 400, 2.5185, 1.4957),
    # 1.15 times both
    "two keyways, 40 mm": (keyed(40, 2), 600, 400, 2.8412, 1.7061),
    # 2.7 0.9^0.43 = 2.5804 and 0.65 of it
    "press fit, 40 mm": (
        by_tests(40, lambda steel: tested.press_fit(steel.ultimate), 40),
        900,
        700,
        2.5804,
        1.6773,
    ),
    # exp(4.2e-7 800^2) = 1.3084; 1 + 0.49 0.3084, 1 + 0.75 0.3084
    "involute spline, 29 mm": (
        by_tests(29, lambda steel: tested.profile("involute", steel.ultimate), 29),
        800,
        600,
        1.1511,
        1.2313,
    ),
    "serration, 29 mm": (
        by_tests(29, lambda steel: tested.profile("serration", steel.ultimate), 29),
        800,
        600,
        1.2005,
        1.3084,
    ),
    # rho* = 10^-(0.514 + 0.00152 400) = 0.07551 mm; sqrt(1.25/(0.1 + 2.9 0.07551)) = 1.9795;
    # 0.9 (1.14 + 1.08 1.9795); sqrt(1.25/0.17551) = 2.6687; 1.48 + 0.45 2.6687 = 2.68, at most 2.5
    "ring groove, 30 mm": (
        by_tests(
            30,
            lambda steel: tested.rectangular_groove(1.25e-3, 1.85e-3, 0.1e-3, steel.yield_point),
            30,
        ),
        700,
        400,
        2.9501,
        2.5,
    ),
    # m/t = 0.8: 1.08 0.8^-0.2 = 1.1293 times the one above
    "narrow ring groove, 30 mm": (
        by_tests(
            30,
            lambda steel: tested.rectangular_groove(1.25e-3, 1e-3, 0.1e-3, steel.yield_point),
            30,
        ),
        700,
        400,
        3.3316,
        2.5,
    ),
    # 0.0923 8 + 0.985, 0.8 of it
    "V groove, 15 mm": (
        by_tests(15, lambda steel: tested.v_groove(steel.ultimate), 15),
        800,
        600,
        1.7234,
        1.3787,
    ),
    # bending: 3 + 1.4 0.08 - 2.8 sqrt 0.08 = 2.3200, G' = 2.3/2 + 2/50 = 1.19,
    # n = 1 + sqrt 1.19 10^-(0.33 + 356/712) = 1.1614; torsion: 1.7048, G' = 0.615, n = 1.1160
    "cross hole 4 in 50 mm": (holed(50, 4), 600, 356, 1.9977, 1.5276),
    # r/d 0.1, t/r 2.5: 1 + 1/sqrt(0.62 0.4 + 1.16 1.44 + 0.2 0.064 2/3) = 1.7202, of the norm's
    # shoulder; phi = 0 at d/D 0.667: G' = 2.3/4; n = 1 + sqrt 0.575 10^-0.83 = 1.1122; torsion 1.3796, 1.0793
    "shoulder 60 to 40 mm": (stepped(60, 40, 4), 600, 356, 1.5468, 1.2783),
    # 1 + 1/sqrt(0.2 + 0.275 1.21) = 2.3700; phi = 1/6: G' = 2.3333/2 = 1.1667, n = 1.1598
    "round groove 44 to 40 mm": (
        by_form(
            40,
            lambda load: forms.round_groove(load, 0.04, 0.002, 0.002),
            lambda load: forms.round_gradient(load, 0.04, 0.002, 0.002),
        ),
        600,
        356,
        2.0435,
        1.5542,
    ),
}


@pytest.mark.parametrize("name", TABLE)
def test_factors_are_those_by_hand(name):
    notch, ultimate, yields, bending, torsion = TABLE[name]
    _, found_bending, found_torsion = beta(notch, ultimate, yields)
    assert found_bending == pytest.approx(bending, rel=2e-4)
    assert found_torsion == pytest.approx(torsion, rel=2e-4)


def test_an_undercut_lies_between_a_shoulder_and_a_groove():
    """Without depth it is the shoulder, without a shoulder the groove."""
    sizes = 0.0005, 0.001  # depth and radius
    for load in LOADS:
        groove = forms.round_groove(load, 0.039, *sizes)
        assert forms.undercut(load, 0.04, 0.04, 0.039, 0.001) == pytest.approx(groove, rel=1e-12)
        shoulder = din743.form_factor(load, 0.06, 0.04, 0.001)
        thin = forms.undercut(load, 0.06, 0.04 + 1e-12, 0.04, 0.001)
        assert thin == pytest.approx(shoulder, rel=1e-4)


# ----------------------------------------------------------------------- ratings
# solved examinations are cases of the manual (validation/manual/cases/printed_notches.py); here
# moments are in N m, forces in N
def rate(notch, six, strength, largest, **conditions):
    nominal = notch.section.nominal(np.array(six, float))
    conditions = Conditions(**conditions)
    return rated(notch, conditions.levels(nominal), strength, conditions, largest, "")


def steel(ultimate, yields, group):
    return Strength(yield_point=1e6 * yields, ultimate=1e6 * ultimate, group=group)


# ----------------------------------------------------------------------- size
@pytest.mark.parametrize(
    "group, diameter, ultimate, yields",
    [
        ("construction", 0.03, 1.0, 1.0),
        ("construction", 0.2, 1 - 0.23 * math.log10(2), 1 - 0.26 * math.log10(200 / 32)),
        ("construction", 0.4, 0.89, 0.75),
        ("tempering", 0.08, 1 - 0.26 * math.log10(5), 1 - 0.34 * math.log10(5)),
        ("tempering", 0.3, 0.67, 0.57),
        ("case_hardening", 0.08, 1 - 0.41 * math.log10(5), 1 - 0.41 * math.log10(5)),
        ("case_hardening", 0.2, 0.6, 0.6),
        ("case_hardening_crnimo", 0.08, 1 - 0.26 * math.log10(5), 1 - 0.26 * math.log10(5)),
        ("nitriding", 0.2, 1 - 0.23 * math.log10(2), 1 - 0.23 * math.log10(2)),
    ],
)
def test_strength_falls_with_size_by_the_group_of_the_steel(group, diameter, ultimate, yields):
    assert steels.size_factors(group, diameter) == pytest.approx((ultimate, yields), rel=1e-9)


def test_without_a_group_the_least_of_all_steels_stands_beside():
    bare, known = (
        rate(keyed(40), [0, 0, 0, 300, 200, 0], steel(1000, 800, group), 0.08)
        for group in (None, "case_hardening")
    )
    assert "K_1 (sigma_B)" in bare.assumed and "K_1 (sigma_B)" not in known.assumed
    assert bare.least == pytest.approx((known.fatigue, known.yielding), rel=1e-12)
    assert known.least is None and bare.fatigue > 1.2 * known.fatigue


def test_beyond_the_norm_size_is_assumed_and_said():
    strong = steel(1000, 800, "tempering")
    found = rate(keyed(40), [0, 0, 0, 300, 200, 0], strong, 0.6)
    assert "K_1 (sigma_B)" in found.assumed and found.least is not None
    entry = next(e for e in found.entries if e.symbol == "K_1 (sigma_B)")
    assert entry.values[0] == 1.0 and "ends at d_eff 500 mm" in entry.source


def test_roughness_of_tests_is_in_their_factors():
    fine, rough = (
        rate(keyed(40), [0, 0, 0, 300, 0, 0], steel(1000, 800, None), 0.04, roughness=rz)
        for rz in ("1 um", "100 um")
    )
    assert fine.fatigue == rough.fatigue
    groove = by_tests(30, lambda s: tested.v_groove(s.ultimate), 15, 20e-6, revolved=True)
    smooth, same, worse = (
        rate(groove, [0, 0, 0, 300, 0, 0], steel(1000, 800, None), 0.04, roughness=rz).fatigue
        for rz in ("1 um", "20 um", "100 um")
    )
    assert smooth == same > worse


def test_a_hard_surface_cracks_where_its_largest_principal_stress_meets_its_strength():
    six, strength = [0, 0, 0, 400, 600, 0], steel(1000, 700, "case_hardening")
    found = rate(
        stepped(60, 40, 4), six, strength, 0.06, hard_surface=True, surface_strength="1800 MPa"
    )
    bent, twisted = (1e-6 * k * t / (math.pi * 0.04**3) for k, t in ((32, 400), (16, 600)))
    bent, twisted = (bent * 1.7202, twisted * 1.3796)  # form factors of the norm by hand
    principal = bent / 2 + math.hypot(bent / 2, twisted)
    assert found.crack == pytest.approx(1800 / principal, rel=1e-3)
    assert rate(stepped(60, 40, 4), six, strength, 0.06, hard_surface=True).crack is None


# ----------------------------------------------------------------------- life
def simulated(shares, cycles, exponent, blocks):
    """Repetitions of a spectrum borne, in small steps: the limit falls as (1 - D)^(1/(q - 1))."""
    damage, done = 0.0, 0.0
    while damage < 1 and done < blocks:
        limit = (1 - damage) ** (1 / (exponent - 1))
        rate_ = sum(n * u**exponent for u, n in zip(shares, cycles) if u > limit) / 1e6
        if rate_ == 0:
            return math.inf
        step = min(2e-4 / rate_, 1.0)
        damage, done = damage + step * rate_, done + step
    return done


@pytest.mark.parametrize("exponent", [5.0, 8.0])
def test_the_consequent_rule_is_that_of_a_limit_that_falls_with_damage(exponent):
    shares, cycles = [1.3, 0.95, 0.7], [2e3, 5e4, 1e6]
    exact = repetitions(shares, cycles, exponent)
    steps = simulated(shares, cycles, exponent, 1e4)
    assert exact == pytest.approx(steps, rel=2e-3)
    # between the elementary rule, and none below the limit
    original = 1e6 / (cycles[0] * shares[0] ** exponent)
    assert elementary_repetitions(shares, cycles, exponent) < exact < original


def test_a_safety_scales_the_spectrum_until_it_is_borne_once():
    shares, cycles = [0.8, 0.6, 0.3], [2e4, 5e5, 1e7]
    share = equivalent_share(shares, cycles, 5.0, 0.3)
    raised = [u / share for u in shares]
    assert 0.3 * repetitions(raised, cycles, 5.0) == pytest.approx(1.0, rel=1e-6)
    # one level: (1e6 / n)^(1/5) above the limit, and the limit from 1e6 cycles on
    assert equivalent_share([0.8], [1e4], 5.0, 1.0) == pytest.approx(0.8 / 100**0.2, rel=1e-9)
    assert equivalent_share([0.8], [1e8], 5.0, 1.0) == pytest.approx(0.8, rel=1e-6)


def test_a_finite_life_and_a_spectrum_in_a_rating():
    six, strength = [0, 0, 0, 300, 0, 0], steel(1000, 800, "tempering")
    endless = rate(keyed(40), six, strength, 0.04)
    short = rate(keyed(40), six, strength, 0.04, cycles=1e4)
    assert short.fatigue == pytest.approx(endless.fatigue * 100**0.2, rel=1e-9)
    mixed = rate(keyed(40), six, strength, 0.04, spectrum="1:1e4, 0.8:1e5, 0.5:1e7")
    assert endless.fatigue < mixed.fatigue < short.fatigue
    assert mixed.elementary < mixed.fatigue and "D_M" in mixed.assumed
    sure = rate(keyed(40), six, strength, 0.04, spectrum="1:1e4, 0.8:1e5", damage_sum=1.0)
    assert "D_M" not in sure.assumed
