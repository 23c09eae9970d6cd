"""Bands of solids from their last meshes: what sets them, piece by piece.  Whether they hold the
truth is asked by validation/attack.
"""

import numpy as np
import pytest

import solidgear as sg
from solidgear.evidence.answer import solve
from solidgear.evidence.bands import DIAGONAL, LEAST, SURE_AROUND, layered_bands, rough_bands
from solidgear.evidence.quantities import ACROSS, QUANTITIES
from solidgear.evidence.sequence_bands import feature_effect, sequence_bands
from solidgear.fidelity.edges import beside_a_step, sharpest_edge
from solidgear.fidelity.ladder import LADDER
from solidgear.fidelity.rung import (
    HELD,
    HELD_AT_A_STEP,
    HELD_PLANE,
    PLANE,
    SMOOTH,
    STEPPED,
    STEPPED_PLANE,
)

FINEST = {"C_zz": 2.0, "C_thx": 8.0, "C_z,thx": 1.0, "bending 1": 100.0}


def levels(*steps):
    """Values that approach `FINEST` from so far (relative; couplings relative to the mean of their
    diagonal entries, here 4).
    """
    size = FINEST | {"C_z,thx": 4.0}
    return [{q: v - s * size[q] for q, v in FINEST.items()} for s in (*steps, 0.0)]


def test_a_band_is_a_factor_times_the_last_change():
    one, two = (layered_bands(levels(0.1, s), {}, LADDER["harmonic"].factors) for s in (0.01, 0.02))
    for name in FINEST:
        assert one[name].change == pytest.approx(0.01)
        assert two[name].gci - LEAST == pytest.approx(2 * (one[name].gci - LEAST))


def test_a_step_that_is_small_by_accident_is_not_believed():
    lucky = layered_bands(levels(0.1, 0.0), {}, LADDER["harmonic"].factors)
    assert all(band.gci > 1e-3 * 0.1 for band in lucky.values())


@pytest.mark.parametrize("edge", [SMOOTH, PLANE, STEPPED, STEPPED_PLANE, HELD, HELD_AT_A_STEP])
def test_after_two_levels_of_hexahedra_larger_steps_give_larger_bands_and_lesser_shares(edge):
    steps = np.geomspace(1e-5, 0.3, 60)
    bands = np.array(
        [
            layered_bands(levels(s), {}, LADDER["solid"].factors, edge=edge)["C_zz"].gci
            for s in steps
        ]
    )
    assert (np.diff(bands) > -1e-15).all()
    shares = bands / steps
    assert (np.diff(shares) < 1e-4).all() and shares[0] > 2 * shares[-1]


def test_a_rigid_seat_costs_more():
    free, rigid = (
        layered_bands(levels(0.05, 0.02), {}, LADDER[model].factors, edge=edge)["C_zz"].gci
        for model, edge in (("solid", STEPPED), ("solid", HELD))
    )
    assert rigid > free


def test_bands_of_a_corrected_solid_hold_a_share_of_what_features_change():
    """Random parts (docs/validation/random.md): meshes that agree by chance say nothing, three say
    more than two.
    """
    factors = LADDER["corrected"].factors
    effect = {"bending 1": 0.05, "C_zz": 0.05}
    for steps, left in (((0.0,), 1.0), ((0.0, 0.0), 0.5)):
        found = layered_bands(levels(*steps), {}, factors, effect=effect)
        for name, share in effect.items():
            assert found[name].gci == pytest.approx(left * share * factors.effect[name], rel=1e-6)
    large = layered_bands(levels(0.1), {}, factors, effect=effect)
    assert large["bending 1"].gci == layered_bands(levels(0.1), {}, factors)["bending 1"].gci


def test_what_features_change_is_told_by_the_nearest_bending_mode_of_the_plain_part():
    scene = sg.load("geometry/pinion_keyed.toml")
    factors = LADDER["corrected"].factors
    plain = solve(scene.plain, "harmonic", order=4).quantities
    values = {q: 1.01 * v for q, v in plain.items()}
    effect = feature_effect(scene, factors, values)
    assert set(effect) == set(factors.effect) & set(values)
    # a mesh of order 3 holds frequencies to some 1e-3
    assert effect["axial 1"] == pytest.approx(0.01 / 1.01, abs=1e-3)
    assert effect["C_zz"] == pytest.approx(0.01 / 1.01, abs=1e-3)
    assert effect["bending 1"] <= 0.01 / 1.01 + 1e-3
    assert feature_effect(scene, LADDER["harmonic"].factors, values) == {}


def test_a_coupling_is_no_surer_than_its_diagonal_entries():
    before = levels(0.05, 0.01)
    before[1] = before[1] | {"C_z,thx": 1.0}  # it happens not to move
    before[0] = before[0] | {"C_z,thx": 1.0}
    found = layered_bands(before, {}, LADDER["harmonic"].factors)
    assert found["C_z,thx"].change == 0.0
    assert found["C_z,thx"].gci == pytest.approx(DIAGONAL * found["C_zz"].gci, rel=1e-6)


def test_cells_around_and_the_solver_are_added():
    plain = layered_bands(levels(0.05, 0.01), {}, LADDER["solid"].factors)
    full = layered_bands(
        levels(0.05, 0.01),
        {"C_zz": 1e-4},
        LADDER["solid"].factors,
        around={"C_zz": 1e-3, "C_thx": 4e-3, "C_z,thx": 0.0},
    )
    added = {q: full[q].gci - plain[q].gci for q in FINEST}
    assert added["C_zz"] == pytest.approx(SURE_AROUND * 1e-3 + 1e-4)
    assert added["C_z,thx"] == pytest.approx(
        SURE_AROUND * 2e-3
    )  # as much as in the diagonal entries
    assert added["bending 1"] == pytest.approx(
        SURE_AROUND * 4e-3
    )  # not measured: as much as in the worst


SIZES = (1.96, 1.4, 1.0)
#: of a sector, after two meshes and after three
ROUGH = LADDER["sector"].factors.rough


def test_sectors_have_a_band_from_two_meshes_on():
    """Of what converges at the order of a right-angled shoulder, 2 x 0.5445, a change tells the
    error: bars are their factors of safety over that, whatever the sizes.
    """
    order = 2 * 0.5445
    for sizes, factor in ((SIZES[1:], ROUGH[0]), (SIZES, ROUGH[1])):
        errors = [1e-3 * h**order for h in sizes]
        values = [{q: v * (1 - e) for q, v in FINEST.items()} for e in errors]
        bands = rough_bands(values, {}, sizes, order / 2, ROUGH)
        # the change before the last one is larger, and counts
        earlier = 1.4**order if len(sizes) > 2 else 1.0
        found = {q: bands[q].gci for q in ("C_zz", "C_thx", "bending 1")}
        assert found == {q: pytest.approx(factor * earlier * 1e-3, rel=1e-2) for q in found}
        assert bands["C_zz"].extrapolated == pytest.approx(FINEST["C_zz"], rel=1e-6)


def test_a_place_that_keeps_its_error_over_a_step_of_a_sector_is_not_forgotten():
    """One cell across the lands of teeth on two meshes: the last change is small, the error is not
    (random part 16: K_z,thx changed by 1.0e-3, then 2e-4, then 1.6e-3).
    """
    stalled, coupled = levels(1.2e-3, 2e-4), levels(1.2e-3, 2e-4)
    bands = rough_bands(stalled, {"C_zz": 1e-5}, SIZES, 0.5445, ROUGH)
    assert bands["C_zz"].gci > 4e-3
    assert bands["C_zz"].gci - bands["C_thx"].gci == pytest.approx(1e-5, rel=1e-3)
    # nor a coupling that happens not to move
    for level in coupled:
        level["C_z,thx"] = 1.0
    still = rough_bands(coupled, {}, SIZES, 0.5445, ROUGH)["C_z,thx"]
    assert still.change == 0.0
    assert still.gci == pytest.approx(DIAGONAL * bands["C_thx"].gci, rel=1e-3)


def test_the_ends_of_teeth_are_corners_where_the_meridian_has_none():
    """A spline along all of a bar: its meridian is a rectangle, its bars are those of a shoulder."""
    from solidgear.scene import Spline

    rod = sg.Segment.cylinder("rod", length=0.1, diameter=0.06)
    port = sg.Port(y=0.05, lo=0.04, hi=0.06)
    plain = sg.Scene.from_parts([rod], bearings=[], port=port)
    toothed = plain.with_changes(
        features=(Spline(name="s", segment="rod", count=12, addendum=0.6, dedendum=0.5),)
    )
    rung = LADDER["sector"]
    bars = [
        sequence_bands(s, rung.meshes({}), rung.factors, levels(1e-3), {}, SIZES[1:])["C_zz"].gci
        for s in (plain, toothed)
    ]
    # 1.4^2 - 1 over 1.4^1.089 - 1
    assert bars[1] / bars[0] == pytest.approx(2.17, abs=0.02)


def test_what_is_sharpest_on_a_shaft():
    def shaft(attachment, lo, second=0.08, first=0.05, width=0.04):
        return sg.Scene.from_parts(
            [
                sg.Segment.cylinder("a", length=0.2, diameter=first),
                sg.Segment.cylinder("b", y0=0.2, length=0.2, diameter=second),
            ],
            bearings=[
                sg.Bearing(
                    name="1",
                    y=lo + width / 2,
                    seat_width=width,
                    matrix=np.eye(6) * 1e8,
                    attachment=attachment,
                )
            ],
            port=sg.Port(y=0.3, lo=0.29, hi=0.31),
        )

    assert sharpest_edge(shaft("average", 0.05, second=0.05)) == SMOOTH
    assert sharpest_edge(shaft("average", 0.05)) == STEPPED
    assert sharpest_edge(shaft("section", 0.05)) == STEPPED_PLANE
    assert sharpest_edge(shaft("section", 0.05, second=0.05)) == PLANE
    assert sharpest_edge(shaft("rigid", 0.05)) == HELD
    assert sharpest_edge(shaft("rigid", 0.16)) == HELD_AT_A_STEP  # ends where the step is
    assert sharpest_edge(shaft("rigid", 0.20)) == HELD_AT_A_STEP
    assert sharpest_edge(shaft("rigid", 0.2 + 5e-8)) == HELD_AT_A_STEP  # but for rounding
    assert sharpest_edge(shaft("rigid", 0.21)) == HELD
    beside = shaft("rigid", 0.21).bearings[0].with_changes(name="2", y=0.05, attachment="section")
    both = shaft("rigid", 0.21)
    both = sg.Scene.from_parts(
        both.segments, bearings=[*both.bearings, beside], port=both.ports[0], name="both"
    )
    assert sharpest_edge(both) == HELD_PLANE
    # near a step, but not at it, is a class of its own: less than 0.5 mm here
    assert [beside_a_step(shaft("average", 0.2 + gap)) for gap in (0, 2e-5, 4e-4, 6e-4)] == [
        *(False, True, True, False)
    ]
    assert not beside_a_step(shaft("average", 0.2 + 2e-5, second=0.05))


def test_cells_in_a_steep_kink_widen_bars():
    def band(top, step=0.0):
        parts = [
            sg.Segment.cylinder("a", length=0.1, diameter=0.05),
            sg.Segment(name="b", y0=0.1, y1=0.12, outer0=0.025 + step, outer1=top),
        ]
        bearing = sg.Bearing(name="1", y=0.05, seat_width=0.02, matrix=np.eye(6) * 1e8)
        scene = sg.Scene.from_parts(parts, bearings=[bearing], port=sg.Port(y=0.1, lo=0.08, hi=0.1))
        rung = LADDER["harmonic"]
        args = (scene, rung.meshes({}), rung.factors, levels(0.05), {}, (None, None))
        return sequence_bands(*args)["C_zz"].gci

    gentle, steep, from_a_step = band(0.04), band(0.075), band(0.075, step=0.01)
    assert steep == pytest.approx(0.75 * 2.5 * gentle, rel=1e-9)  # a rise of 50 mm over 20
    assert from_a_step == pytest.approx(gentle, rel=1e-9)


def test_bars_of_plates_do_not_fall_below_what_rounding_takes():
    def band(length, step):
        disc = sg.Segment.cylinder("disc", length=length, diameter=0.2)
        port = sg.Port(y=length / 2, lo=0.0, hi=length)
        scene = sg.Scene.from_parts([disc], port=port)
        rung = LADDER["harmonic"]
        args = (scene, rung.meshes({}), rung.factors, levels(step, step / 10), {}, [None] * 3)
        return sequence_bands(*args)["C_zz"].gci

    assert band(0.009, 1e-8) == 2e-6 > band(0.011, 1e-8)
    assert band(0.009, 1e-2) == pytest.approx(band(0.011, 1e-2), rel=1e-9)


def test_a_seat_that_ends_beside_a_step_widens_bars():
    def band(y):
        bearing = sg.Bearing(name="1", y=y, seat_width=0.02, matrix=np.eye(6) * 1e8)
        parts = [
            sg.Segment.cylinder("a", length=0.1, diameter=0.05),
            sg.Segment.cylinder("b", y0=0.1, length=0.1, diameter=0.06),
        ]
        port = sg.Port(y=0.05, lo=0.04, hi=0.06)
        scene = sg.Scene.from_parts(parts, bearings=[bearing], port=port)
        rung = LADDER["harmonic"]
        args = (scene, rung.meshes({}), rung.factors, levels(0.05), {}, (None, None))
        return sequence_bands(*args)["C_zz"]

    assert band(0.1101).gci == pytest.approx(1.5 * band(0.11).gci, rel=1e-9)
    assert band(0.1101).factor == pytest.approx(1.5 * band(0.11).factor, rel=1e-9)


def test_what_features_change_floors_the_bands_of_both_planes():
    # meshes of a corrected solid may agree by accident in any entry
    assert set(LADDER["corrected"].factors.effect) == set(QUANTITIES) | set(ACROSS)
