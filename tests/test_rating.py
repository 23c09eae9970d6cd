"""Rating by DIN 743: formulas against hand calculations, and what is assumed is said."""

import math
from dataclasses import replace

import numpy as np
import pytest
from filleted import STRONG, shoulder

from solidgear import SceneError, SolidgearError
from solidgear.core.scene import Material, Strength
from solidgear.strength.stress import din743
from solidgear.strength.stress.conditions import Conditions
from solidgear.strength.stress.fillet_rating import FilletNotch
from solidgear.strength.stress.nominal import CrossSection, NominalStress
from solidgear.strength.stress.notch import Factor, FilletFactors
from solidgear.strength.stress.rated_notch import Steel
from solidgear.strength.stress.rating import rated

SCENE = shoulder(1.5, 0.1, d=0.04)
LARGE = 0.06
BENDING = NominalStress(0.0, 100e6, 0.0, 0.0)


def notch(bar=0.0):
    """A fillet of made-up factors: Kt 2, 1.8 and 1.4, gradients 500, 500 and 250 /m."""
    values = {"tension": (2.0, 500.0), "bending": (1.8, 500.0), "torsion": (1.4, 250.0)}
    factors = {load: Factor(k, bar, 0.2, g, 0.0) for load, (k, g) in values.items()}
    return FilletFactors("fillet", SCENE.corners[0], CrossSection(0.02, 0.0), 0.02, factors, {}, ())


def rate(fillet, nominal, conditions):
    """Rating of that fillet in the strong steel."""
    plain, raised = (FilletNotch(fillet, LARGE, bars) for bars in (0.0, 1.0))
    return rated(plain, conditions.levels(nominal), STRONG, conditions, LARGE, "", raised)


def entry(rating, symbol):
    return next(one for one in rating.entries if one.symbol == symbol)


def test_bending_alone_is_as_by_hand():
    """n = 1 + sqrt(0.5) 10^-(0.33 + 700/712), K_2 = 1 - 0.2 lg(40/7.5)/lg 20, Rz 10 um."""
    rating = rate(notch(), BENDING, Conditions(roughness=10e-6))
    n = 1 + math.sqrt(0.5) * 10 ** -(0.33 + 700 / 712)
    k2 = 1 - 0.2 * math.log10(40 / 7.5) / math.log10(20)
    kf = 1 - 0.22 * math.log10(10) * (math.log10(1000 / 20) - 1)
    assert (n, k2, kf) == pytest.approx((1.0344, 0.88824, 0.84623), rel=1e-4)
    limit = 0.5 * 1000e6 / (1.8 / n / k2 + 1 / kf - 1)
    assert rating.fatigue == pytest.approx(limit / 100e6, rel=1e-12)
    # gamma_F = 1.05 at a notch factor of 1.74, K_2F = 1.2 of a solid shaft
    assert rating.yielding == pytest.approx(1.2 * 1.05 * 700 / 100, rel=1e-12)


def test_stresses_add_as_the_norm_says():
    """Tension and bending side by side, torsion across: 1 / S^2 = (a + b)^2 + c^2."""
    steady = Conditions(force_share=1.0, torque_share=1.0)
    alone = [
        1 / rate(notch(), NominalStress(*s, 0.0), steady).yielding
        for s in ((50e6, 0.0, 0.0), (0.0, 100e6, 0.0), (0.0, 0.0, 40e6))
    ]
    together = rate(notch(), NominalStress(50e6, 100e6, 40e6, 0.0), steady)
    expected = 1 / math.hypot(alone[0] + alone[1], alone[2])
    assert together.yielding == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("constant_mean", [False, True])
def test_a_mean_stress_costs_amplitude(constant_mean):
    given = Conditions(constant_mean=constant_mean)
    twisted = NominalStress(0.0, 100e6, 80e6, 0.0)
    bare, mean = (rate(notch(), s, given) for s in (BENDING, twisted))
    assert mean.fatigue < bare.fatigue
    limit, psi = (entry(mean, name).values[1] for name in ("sigma_WK", "psi_sigmaK"))
    equivalent = math.sqrt(3) * 80e6
    borne = limit - psi * equivalent if constant_mean else limit / (1 + psi * equivalent / 100e6)
    assert entry(mean, "sigma_ADK").values[1] == pytest.approx(borne, rel=1e-12)


def test_a_mean_beyond_yielding_leaves_no_amplitude():
    assert din743.amplitude_limit(200e6, 0.2, 500e6, 600e6, 10e6, constant_mean=True) == 0.0
    pulled = NominalStress(2000e6, 100e6, 0.0, 0.0)
    rating = rate(notch(), pulled, Conditions(constant_mean=True))
    assert rating.fatigue == 0.0 and rating.yielding < 1


def test_both_cases_meet_where_the_part_yields():
    """At the knee of the diagram static + fatigue limits give one amplitude."""
    limit, psi, static = 200e6, 0.2, 500e6
    knee = (static - limit) / (1 - psi)
    amplitude = limit - psi * knee
    for constant in (True, False):
        for nudge in (0.999999, 1.000001):
            found = din743.amplitude_limit(limit, psi, static, knee * nudge, amplitude, constant)
            assert found == pytest.approx(amplitude, rel=1e-5)


def test_what_nobody_gave_is_said_and_what_is_given_is_not():
    bare = rate(notch(), BENDING, Conditions())
    assert bare.assumed == (
        "K_1 (sigma_B)",
        "K_1 (sigma_S)",
        "K_F",
        "K_V",
        "sigma_a",
        "overload",
    )
    told = Conditions(
        roughness="5 um",
        ultimate_at_size=0.9,
        yield_at_size=0.85,
        hardening=1.1,
        overload=1.5,
        force_share=0.0,
        torque_share=0.0,
    )
    full = rate(notch(), BENDING, told)
    assert full.assumed == ()
    assert entry(full, "K_1 (sigma_B)").values == (0.9,) * 3
    assert all(one.source for one in full.entries)


def test_a_bar_of_the_form_factor_is_one_of_the_safety():
    sure, unsure = (rate(notch(bar), BENDING, Conditions()) for bar in (0, 0.018))
    assert sure.fatigue_bar == 0 and unsure.fatigue == sure.fatigue
    assert 0.005 < unsure.fatigue_bar / unsure.fatigue < 0.011  # 1 % of Kt, a little less of S


def test_a_notch_factor_is_never_below_one():
    mild = notch()
    mild = replace(mild, factors={k: replace(v, value=1.01) for k, v in mild.factors.items()})
    soft = Steel(600e6, 300e6, hard=False)
    assert all(one.notch == 1.0 for one in FilletNotch(mild, LARGE).by_load(soft).values())


@pytest.mark.parametrize(
    "given, words",
    [
        ({"roughness": 0.0}, "roughness = 0.0: must be greater than zero"),
        ({"roughness": 6.3}, "roughness = 6.3: must be"),
        ({"hardening": 110}, "hardening = 110: must be"),
        ({"force_share": -1}, "force_share = -1"),
    ],
)
def test_conditions_that_are_none_are_refused(given, words):
    with pytest.raises(SolidgearError, match=words):
        Conditions(**given)


def test_strength_is_part_of_a_material_where_it_is_given():
    given = {"yield_point": "650 MPa", "ultimate": "900 MPa"}
    steel = Material(E="207 GPa", nu=0.3, density=7850, strength=given)
    assert steel.strength == Strength(yield_point=650e6, ultimate=900e6)
    assert steel.model_dump()["strength"]["ultimate"] == 900e6
    assert "strength" not in Material(E="207 GPa", nu=0.3, density=7850).model_dump()
    scene = shoulder(strength=STRONG)
    assert scene.as_dict()["material"]["strength"] == {"yield_point": 700e6, "ultimate": 1000e6}


@pytest.mark.parametrize(
    "given, words",
    [
        ({"yield_point": "900 MPa", "ultimate": "650 MPa"}, "lies above the ultimate strength"),
        ({"yield_point": 650, "ultimate": "900 MPa"}, "below 1 MPa"),
        ({"yield_point": "650 MPa"}, "ultimate"),
    ],
)
def test_strength_that_is_none_is_refused(given, words):
    with pytest.raises(SceneError, match=words):
        Material(E="207 GPa", nu=0.3, density=7850, strength=given)


def test_norm_and_solid_give_gradients_of_one_size():
    """2.3 / r by formula, 2.3 to 2.8 by solids; of torsion 1.15 and 1.0 to 1.6."""
    for load, low, high in (("bending", 2.2, 2.9), ("torsion", 1.0, 1.6)):
        assert low < din743.gradient(load, 0.06, 0.04, 0.004) * 0.004 < high
    assert np.isclose(din743.gradient("bending", 0.08, 0.04, 0.004), 2.3 / 0.004)
