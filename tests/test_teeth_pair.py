"""Teeth in contact, and a train that takes its mesh from them, beside two whole gears as finite
elements with a resolved pressure (kept results of validation/teeth_pair.py, checked by CalculiX).
"""

import numpy as np
import pytest

import solidgear as sg
from validation.common import read_result
from validation.teeth_pair import BY_CALCULIX, CASES, HOLDS, Case, figures
from validation.teeth_pair_train import compared
from validation.whole_gears import COARSE, FINE, WholePair

KEPT = read_result("teeth_pair")
PLAIN = [Case(load, relief) for load, relief in CASES if not relief]
RELIEVED = [Case(load, relief) for load, relief in CASES if relief]


def whole_gears(case):
    return 1e-6 * np.array(KEPT["cases"][case.name]["whole gears"])


@pytest.mark.parametrize("case", PLAIN, ids=lambda case: case.name)
def test_transmission_error_is_that_of_whole_gears(case):
    """Meshes leave 0.2 %; corners of tips, which make the orders, are no better known than 1 %."""
    reference, teeth = figures(whole_gears(case)), figures(case.cycle().error)
    assert teeth["mean"] == pytest.approx(reference["mean"], rel=4e-3)
    for name in ("peak to peak", "order 1", "order 2", "order 3"):
        assert teeth[name] == pytest.approx(reference[name], rel=1e-2), name


@pytest.mark.parametrize("case", RELIEVED, ids=lambda case: case.name)
def test_transmission_error_of_relieved_gears_is_that_of_whole_gears(case):
    """Where relief begins, a contact lies on both sides of the kink; ours on one: 3 % of the swing."""
    reference, teeth = figures(whole_gears(case)), figures(case.cycle().error)
    assert teeth["mean"] == pytest.approx(reference["mean"], rel=4e-3)
    for name in ("peak to peak", "order 1"):
        assert teeth[name] == pytest.approx(reference[name], rel=3e-2), name
    for name in ("order 2", "order 3"):
        assert teeth[name] == pytest.approx(
            reference[name], abs=0.03 * reference["peak to peak"]
        ), name


def test_bodies_are_a_constant_part_of_the_error():
    """The total force keeps its line, so that bodies on their bores give way alike at all times."""
    case = PLAIN[1]
    bodies = case.cycle().error - case.cycle(body=False).error
    assert bodies.mean() > 0.1 * case.cycle().error.mean()
    assert np.ptp(bodies) < 1e-4 * bodies.mean()


@pytest.mark.parametrize("case", [PLAIN[1], RELIEVED[1]], ids=lambda case: case.name)
def test_a_slow_train_moves_as_whole_gears_do(case):
    """At a tenth of the resonance of two inertias an order moves by 1 % more than at rest."""
    row = compared(case, whole_gears(case))
    assert row["excess peak to peak"] == pytest.approx(0, abs=3e-2)
    assert row["excess"][:2] == pytest.approx([0, 0], abs=3e-2)


def test_calculix_has_the_torque_of_the_whole_gears():
    rows = KEPT["calculix"]
    places = [(Case(load, relief).name, phase) for load, relief, phase in BY_CALCULIX]
    assert [(row["case"], row["phase"]) for row in rows] == places
    for row in rows:
        assert row["torque"] == pytest.approx(1, abs=3e-3)
        assert row["second"] == pytest.approx(1, abs=3e-3)


@pytest.mark.slow
def test_whole_gears_are_solved_as_kept():
    case = PLAIN[1]
    pair = WholePair.of(case.wheels, HOLDS, case.shapes, (FINE, COARSE))
    for number in (0, 3, 12):
        error = case.wheels.first.base * pair.rotation(number / 32, case.torque)
        assert error == pytest.approx(whole_gears(case)[number], rel=1e-6)


def test_wheels_whose_tips_cut_have_no_contact():
    long = sg.Wheel(12, 4e-3, face_width=20e-3, tip_radius=32e-3)
    mate = sg.Wheel(57, 4e-3, face_width=20e-3)
    with pytest.raises(sg.SolidgearError, match="first wheel, 64 mm across, cut .* fits"):
        sg.pair_contact(sg.WheelPair(long, mate), [2e5])
