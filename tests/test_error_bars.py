"""Bands of solids from their last meshes: what sets them, piece by piece.  Whether they hold the
truth is asked by validation/campaign.
"""

import pytest

import solidgear as sg
from solidgear.core.bounds.safety import REFINEMENT, Safety
from solidgear.core.judge.bars import moves_freely, step_bars
from solidgear.core.judge.sequence_bars import feature_effect, sequence_bars
from solidgear.core.judge.solving import solve
from solidgear.core.ladder.meshes import Sequence
from solidgear.core.ladder.registry import LADDER
from solidgear.core.quantity import ACROSS, QUANTITIES, Quantity
from solidgear.core.scene import Fillet
from solidgear.cuts.features import Spline

FINEST = {
    Quantity(name): value
    for name, value in (("C_zz", 2.0), ("C_thx", 8.0), ("C_z,thx", 1.0), ("bending 1", 100.0))
}
SAFETY = Safety((2.0, 1.5))


def levels(*steps):
    """Values that approach `FINEST` from so far (relative; couplings relative to the mean of their
    diagonal entries, here 4).
    """
    size = FINEST | {"C_z,thx": 4.0}
    return [{q: v - s * size[q] for q, v in FINEST.items()} for s in (*steps, 0.0)]


def test_a_third_mesh_makes_a_change_tell_more():
    two, three = (step_bars(levels(*steps, 0.01), {}, SAFETY) for steps in ((), (0.1,)))
    assert two["C_zz"].width == pytest.approx(0.02) and three["C_zz"].width == pytest.approx(0.015)
    assert three["C_zz"].reduction == pytest.approx(0.01 / 0.09, rel=0.02)


def test_bars_of_a_corrected_solid_hold_a_share_of_what_features_change():
    """Random parts (docs/validation/random.md): meshes that agree by chance say nothing, three say
    more than two.
    """
    safety = LADDER["corrected"].safety
    effect = {"bending 1": 0.05, "C_zz": 0.05, "axial 1": 0.05}
    for steps, left in (((0.0,), 1.0), ((0.0, 0.0), safety.shrinks)):
        same = [level | {Quantity("axial 1"): 10.0} for level in levels(*steps)]
        found = step_bars(same, {}, safety, effect=effect)
        for name in effect:
            share = safety.share_of_free_modes if name == "axial 1" else safety.share
            assert found[name].width == pytest.approx(left * share * 0.05, rel=1e-6)
    assert safety.shrinks < 1.0 and safety.share_of_free_modes > safety.share > 0.0
    large = step_bars(levels(0.1), {}, safety, effect=effect)
    assert large["bending 1"].width == step_bars(levels(0.1), {}, safety)["bending 1"].width


def test_shares_are_of_every_number_in_both_planes_and_larger_where_a_motion_is_free():
    assert {q for q in (*QUANTITIES, *ACROSS) if moves_freely(q)} == {"axial 1", "torsion 1"}
    assert not moves_freely(Quantity("C_yy@tip")) and not moves_freely(Quantity("bending 2"))


@pytest.mark.long
def test_what_features_change_is_told_by_the_nearest_bending_mode_of_the_plain_part():
    scene = sg.load("geometry/pinion_keyed.toml")
    plain = solve(scene.plain, "harmonic", order=4).quantities
    values = {q: 1.01 * v for q, v in plain.items()}
    effect = feature_effect(scene, LADDER["corrected"].safety, values)
    assert set(effect) == set(values)
    # a mesh of order 3 holds frequencies to some 1e-3
    assert effect["axial 1"] == pytest.approx(0.01 / 1.01, abs=1e-3)
    assert effect["C_zz"] == pytest.approx(0.01 / 1.01, abs=1e-3)
    assert effect["bending 1"] <= 0.01 / 1.01 + 1e-3
    assert feature_effect(scene, REFINEMENT, values) == {}


def test_a_coupling_is_no_surer_than_its_diagonal_entries():
    before = [level | {"C_z,thx": 1.0} for level in levels(0.01)]  # it happens not to move
    found = step_bars(before, {}, SAFETY)
    assert found["C_z,thx"].change == 0.0
    assert found["C_z,thx"].width == pytest.approx(found["C_zz"].width, rel=1e-6)


def test_cells_around_and_the_solver_are_added():
    plain = step_bars(levels(0.05, 0.01), {}, SAFETY)
    full = step_bars(
        levels(0.05, 0.01),
        {"C_zz": 1e-4},
        SAFETY,
        around={"C_zz": 1e-3, "C_thx": 4e-3, "C_z,thx": 0.0},
    )
    added = {q: full[q].width - plain[q].width for q in FINEST}
    assert added["C_zz"] == pytest.approx(2.0 * 1e-3 + 1e-4)
    assert added["C_z,thx"] == pytest.approx(2.0 * 2e-3)  # as much as in the diagonal entries
    # not measured: as much as in the worst
    assert added["bending 1"] == pytest.approx(2.0 * 4e-3)


# --------------------------------------------------------------------------- lists of meshes
SIZES = ((1.96,), (1.4,), (1.0,))
SECTOR = LADDER["sector"]
PLAN = SECTOR.meshes({})


def rod(features=(), blends=()):
    segment = sg.Segment.cylinder("rod", length=0.1, diameter=0.06)
    scene = sg.Scene.from_parts(
        [segment], bearings=[], port=sg.Port(y=0.05, lo=0.04, hi=0.06), blends=blends
    )
    return scene.with_changes(features=features) if features else scene


def stepped():
    parts = [
        sg.Segment.cylinder("a", length=0.1, diameter=0.05),
        sg.Segment.cylinder("b", y0=0.1, length=0.1, diameter=0.06),
    ]
    return sg.Scene.from_parts(parts, port=sg.Port(y=0.05, lo=0.04, hi=0.06))


def test_solids_on_a_list_have_a_bar_from_two_meshes_on():
    """Of what converges at the order of a right-angled shoulder, 2 x 0.5445, a change tells the
    error: bars are their factors of safety over that, whatever the sizes.
    """
    order = 2 * 0.5445
    for sizes, factor in ((SIZES[1:], REFINEMENT.steps[0]), (SIZES, REFINEMENT.steps[1])):
        errors = [1e-3 * h**order for (h,) in sizes]
        values = [{q: v * (1 - e) for q, v in FINEST.items()} for e in errors]
        bars = sequence_bars(stepped(), PLAN, SECTOR, values, {}, sizes)
        # the change before the last one is larger, and counts
        earlier = 1.4**order if len(sizes) > 2 else 1.0
        found = {q: bars[q].width for q in ("C_zz", "C_thx", "bending 1")}
        assert found == {q: pytest.approx(factor * earlier * 1e-3, rel=1e-2) for q in found}
        assert bars["C_zz"].extrapolated > values[-1]["C_zz"]


def test_one_mesh_and_meshes_that_are_not_ever_finer_say_nothing():
    values = levels(1e-3, 1e-4)
    for kept, sizes in (
        (values[-1:], SIZES[-1:]),
        (values, (*SIZES[1:], SIZES[-1])),
        (values[1:], SIZES[:0:-1]),
        # nor cells that are as long as before, however thin
        (values[1:], ((50.0, 20.0, 4.0), (50.0, 10.0, 2.0))),
    ):
        assert sequence_bars(stepped(), PLAN, SECTOR, kept, {}, sizes) == {}
    # nor layered hexahedra beside a fillet, to which no layers lead
    filleted = rod(blends=[Fillet(name="f", y=0.0, edge="rim", radius=0.004)])
    layered = Sequence(PLAN.levels, False, True, turned={})
    for scene, said in ((rod(), True), (filleted, False)):
        found = sequence_bars(scene, layered, LADDER["solid"], values, {}, SIZES)
        assert bool(found) == said


def test_a_place_that_keeps_its_error_over_a_step_is_not_forgotten():
    """One cell across the lands of teeth on two meshes: the last change is small, the error is not
    (random part 16: K_z,thx changed by 1.0e-3, then 2e-4, then 1.6e-3).
    """
    stalled, coupled = levels(1.2e-3, 2e-4), levels(1.2e-3, 2e-4)
    bars = sequence_bars(stepped(), PLAN, SECTOR, stalled, {"C_zz": 1e-5}, SIZES)
    assert bars["C_zz"].width > 4e-3
    assert bars["C_zz"].width - bars["C_thx"].width == pytest.approx(1e-5, rel=1e-3)
    # nor a coupling that happens not to move
    for level in coupled:
        level["C_z,thx"] = 1.0
    still = sequence_bars(stepped(), PLAN, SECTOR, coupled, {}, SIZES)["C_z,thx"]
    assert still.change == 0.0
    assert still.width == pytest.approx(bars["C_thx"].width, rel=1e-3)


def test_the_ends_of_teeth_are_corners_where_the_meridian_has_none():
    """A spline along all of a bar: its meridian is a rectangle, its bars are those of a shoulder."""
    plain = rod()
    spline = Spline(name="s", segment="rod", count=12, addendum=0.6, dedendum=0.5)
    bars = [
        sequence_bars(s, PLAN, SECTOR, levels(1e-3), {}, SIZES[1:])["C_zz"].width
        for s in (plain, rod(features=(spline,)))
    ]
    # 1.4^2 - 1 over 1.4^1.089 - 1
    assert bars[1] / bars[0] == pytest.approx(2.17, abs=0.02)
