"""Bars from two orders on one mesh."""

from pathlib import Path

import pytest

import solidgear as sg
from solidgear.evidence.answer import solve
from solidgear.evidence.bands import LEAST
from solidgear.evidence.quantities import size
from solidgear.evidence.sequence_bands import ACCIDENT, SHELL, pair_bands
from solidgear.fidelity.edges import HELD, HELD_AT_A_STEP, SMOOTH, crowded, thin_walled
from solidgear.fidelity.ladder import LADDER
from solidgear.fidelity.levels import PAIRS, TRIED_FROM, Sequence
from solidgear.studies.answering import answer

ROOT = Path(__file__).parents[1]
FACTORS = LADDER["harmonic"].factors


@pytest.fixture(scope="module")
def scene():
    return sg.load(ROOT / "geometry" / "pinion_overhung.toml")


def steps(one, pair, before, after=1.0):
    levels = [{"C_zz": before}, {"C_zz": after}]
    return pair_bands(one, FACTORS, pair, levels, {})["C_zz"].gci


def test_both_orders_stand_on_one_mesh_and_pairs_on_ever_finer_ones():
    for lower, higher in PAIRS:
        assert {**lower, "order": higher["order"]} == higher
        assert lower["order"] + 1 == higher["order"]
    assert [pair[1]["layers"] for pair in PAIRS] == list(range(len(PAIRS)))
    assert all(len(factors) == len(PAIRS) for factors in FACTORS.same_mesh.values())


def test_the_tolerance_says_with_which_pair_to_begin():
    plan = LADDER["harmonic"].meshes({})
    first = [min(plan.pairs_for(tol)) for tol in (1.0, TRIED_FROM[0], 0.01, 1e-3, 1e-4, 1e-9)]
    assert first == [0, 0, 0, 0, 1, 3]
    assert min(plan.pairs_for(1.0, least=1)) == 1
    assert Sequence(plan.levels, False, True).pairs_for(0.1) == {}


@pytest.mark.parametrize("edge, exponent", [(HELD, 1 / 2), (HELD_AT_A_STEP, 0.3)])
def test_factors_of_high_orders_are_what_an_edge_leaves(edge, exponent):
    # what an edge costs falls as p ** (-4 exponent), and the last cell at it is most of the error
    for place in (3, 4, 5):
        p = PAIRS[place][1]["order"]
        left = 1 / ((p / (p - 1)) ** (4 * exponent) - 1)
        # less by no more than two digits round off, and hardly more
        assert left - 0.05 <= FACTORS.same_mesh[edge][place] <= 1.05 * left


def test_errors_are_within_their_bars_and_bars_are_no_wider_than_they_must(scene):
    truth = solve(scene, "harmonic", **PAIRS[3][1]).quantities
    for place in (0, 1):
        orders = [solve(scene, "harmonic", **level).quantities for level in PAIRS[place]]
        bands = pair_bands(scene, FACTORS, place, orders, {})
        for name in ("C_zz", "C_thx", "C_yy", "K_zz", "bending 1", "axial 1"):
            # the space of the lower order is part of that of the higher one
            rise = orders[1][name] - orders[0][name]
            assert rise > 0 if name.startswith("C") else rise < 0
            error = abs(orders[1][name] - truth[name]) / size(truth, name)
            # an edge leaves from a third of the step on; that is what makes a bar narrow
            assert bands[name].gci / 8 < error < bands[name].gci, name


def test_a_step_as_small_as_an_accident_counts_twice(scene):
    for pair in range(len(PAIRS)):
        small = ACCIDENT[min(pair, len(ACCIDENT) - 1)]
        large, little = (steps(scene, pair, 1 + s) / s for s in (100 * small, small / 10))
        # bars hold 1e-10 of rounding, which is a hundredth of the least step
        assert little == pytest.approx(2 * large, abs=1.1 * LEAST / (small / 10))


def test_a_second_mesh_of_a_thin_tube_is_the_first():
    ends = [
        sg.scene.Bearing(
            name=n, y=y, seat_width=0.02, stiffness={"kxx": 1e8, "kyy": 1e8, "kzz": 1e8}
        )
        for n, y in (("A", 0.05), ("B", 0.25))
    ]
    port = sg.Port(name="gear", y=0.15, lo=0.14, hi=0.16)

    def tube(wall):
        bore = 0.06 - 2 * wall
        shaft = sg.Segment.cylinder("tube", length=0.3, diameter=0.06, bore=bore)
        return sg.Scene.from_parts([shaft], port=port, bearings=ends)

    thin, thick = tube(0.0015), tube(0.01)
    assert thin_walled(thin) and not thin_walled(thick)
    usual = FACTORS.same_mesh[SMOOTH][1]
    assert steps(thin, 1, 1.01) / steps(thick, 1, 1.01) == pytest.approx(SHELL[1] / usual, rel=1e-6)
    # 8.6e-5 of C_xx was left of a step of 9.8e-5 where walls are 0.02 radii
    orders = [solve(thin, "harmonic", **level).quantities for level in PAIRS[1]]
    truth = solve(thin, "harmonic", **PAIRS[2][1]).quantities
    for name, band in pair_bands(thin, FACTORS, 1, orders, {}).items():
        assert abs(orders[1][name] - truth[name]) / size(truth, name) < band.gci, name


def test_a_thin_disc_is_never_solved_without_layers():
    # ring of 0.006 diameters: bending 1 was 5.2e-3 off, bar 1.0e-3
    ring = sg.Segment.cylinder("ring", length=0.003, diameter=0.5, bore=0.4)
    port = sg.Port(name="gear", y=0.0015, lo=0.0, hi=0.003)
    springs = {"kxx": 1e7, "kyy": 1e7, "kzz": 1e7}
    held = sg.scene.Bearing(name="A", y=0.0015, seat_width=0.003, stiffness=springs)
    scene = sg.Scene.from_parts([ring], port=port, bearings=[held])
    found = answer(scene, 0.1, "bending 1")
    truth = solve(scene, "harmonic", **PAIRS[2][1]).quantities["bending 1"]
    assert [s.options["layers"] for s in found.steps if s.valid] == [1, 1]
    assert abs(found["bending 1"] / truth - 1) < found.bar


def test_rigid_seats_that_all_but_touch_are_never_solved_without_layers():
    # C_yy was 7.6e-4 off, bar 1.5e-4
    shaft = sg.Segment.cylinder("shaft", length=0.03, diameter=0.014, bore=0.0025)
    port = sg.Port(name="gear", y=0.008, lo=0.0066, hi=0.0094, attachment="rigid")
    springs = {"kxx": 4.6e6, "kyy": 8.5e6, "kzz": 4.6e6, "kthx": 88.0, "kthz": 88.0}
    held = sg.scene.Bearing(
        name="A", y=0.0103, seat_width=0.00172, stiffness=springs, attachment="rigid"
    )
    scene = sg.Scene.from_parts([shaft], port=port, bearings=[held])
    assert crowded(scene)
    (found,) = answer(scene, 0.1, "C_yy").values
    blunt, truth = (solve(scene, "harmonic", **PAIRS[k][1]).quantities["C_yy"] for k in (0, 2))
    # without layers a tenth of what the shaft itself yields is there, and no order tells
    bearing = 1 / springs["kyy"]
    assert blunt - bearing < 0.2 * (truth - bearing)
    assert abs(found.value / truth - 1) < found.bar
