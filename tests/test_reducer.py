"""The reducer whose bearings give way: its teeth, and its modulation in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from validation.reducer import study
from validation.reducer.design import Design

# forces of springs of 1e20 N/m beside those of 1e8: held members give by 1e-12
ROUNDING = 1e-9


@pytest.fixture(scope="module")
def design():
    return Design()


@pytest.mark.parametrize(
    "teeth, planetary", [(study.SETS[0], (3400 / 3, 850)), (study.SETS[1], (1120, 840))]
)
def test_both_tooth_sets_give_ratio_ten_and_one_of_the_quoted_frequencies(teeth, planetary):
    fast, slow = study.speeds(teeth, 8000), study.speeds(teeth, 6000)
    assert fast["ratio"] == pytest.approx(10, rel=1e-14)
    assert (fast["bevel mesh"], slow["bevel mesh"]) == pytest.approx((2000, 1500), rel=1e-14)
    assert fast["carrier"] == pytest.approx(40 / 3, rel=1e-14)
    found = (fast["planetary mesh"], slow["planetary mesh"])
    assert found == pytest.approx(planetary, rel=1e-14)
    assert found != pytest.approx((1120, 850), rel=1e-3)


def closed_and_turned(design, model):
    shift, give = design.flexibility(False, model)
    turned = design.turn(shift, give).amplitude(1)
    return design.closed_form(shift, give), turned


@pytest.mark.parametrize(
    "model", ["rigid", "timoshenko", pytest.param("harmonic", marks=pytest.mark.slow)]
)
def test_a_turn_of_the_carrier_is_the_closed_form_whatever_the_shaft(design, model):
    closed, turned = closed_and_turned(design, model)
    assert turned == pytest.approx(closed, rel=ROUNDING)


def test_an_elastic_shaft_shifts_the_sun_less_than_a_rigid_one(design):
    # between its bearings it bends, so that the sun's end turns less than the wheel's
    rigid, beam = (closed_and_turned(design, model)[0] for model in ("rigid", "timoshenko"))
    assert 1.1 < rigid / beam < 1.3


def test_the_shaft_on_its_bearings_and_the_stage_agree_on_the_modulation(design):
    for third in (False, True):
        turn = design.settled_turn(third)
        # Newton's iterations end at 1e-9 of the loads
        assert turn.amplitude(1) == pytest.approx(design.modulation(third), rel=1e-6)
        assert turn.sun_mesh.mean(axis=0) == pytest.approx(design.mean_force, rel=ROUNDING)


def test_torques_balance_from_pinion_to_carrier(design):
    turn = design.settled_turn(False)
    assert turn.torque["carrier"] == pytest.approx(study.RATIO * design.torque, rel=1e-10)


def test_a_third_bearing_halves_it_unless_its_clearance_is_never_taken_up(design):
    two, three = design.modulation(False), design.modulation(True)
    assert three < study.MOST * two
    assert design.foretold() == pytest.approx(three, abs=0.1 * two)
    moved = np.linalg.norm(design.settled(False).motion["third"])
    loose = replace(design, clearance=1.1 * moved)
    assert loose.modulation(True) == pytest.approx(two, rel=1e-6)
    assert loose.foretold() == pytest.approx(two, rel=1e-6)


def test_an_overhung_wheel_and_sun_shift_more_than_a_pair_between_them(design):
    assert replace(design, overhung=True).modulation(False) > 2 * design.modulation(False)


def test_drawn_designs_are_those_of_their_seed():
    once, again = study.drawn(count=3), study.drawn(count=3)
    assert once == again
    found, refused = study.outcomes(once[:1])
    assert not refused
    assert found[0].balanced
