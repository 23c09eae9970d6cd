"""Seats narrower than cells: what one order more finds of their error."""

from dataclasses import replace

import numpy as np
import pytest

import solidgear as sg
from solidgear import Bearing, Port, Scene, Segment
from solidgear.core.bounds.narrow import narrow_share, share_of, share_of_gap
from solidgear.core.bounds.solid import solid_bounds
from solidgear.core.safety import LOCAL, SLOWER
from validation.mesh_files import write_boxes

#: exponents at the ends of seats on a smooth surface
AVERAGED, RIGID = 1.0, 1 / 2
COARSE = {"element": "tet10", "refinement": 0.2}


def bar(width, *, tie="average", beside=None):
    """A smooth bar of 30 mm with a port of some width, mm, and a rigid bearing beside it."""
    lo, hi = (45 - width / 2) * 1e-3, (45 + width / 2) * 1e-3
    port = Port(name="gear", y=45e-3, lo=lo, hi=hi, attachment=tie)
    held = {"seat_width": 12e-3, "stiffness": {"kxx": 1e9, "kyy": 5e8, "kzz": 1e9, "kthy": 2e4}}
    bearings = [Bearing(name=name, y=y * 1e-3, **held) for name, y in (("A", 10), ("B", 80))]
    if beside is not None:
        y = hi + beside * 1e-3 + 6e-3
        bearings[1] = Bearing(name="B", y=y, attachment="rigid", **held)
    segments = [Segment.cylinder("bar", length=0.09, diameter=0.03)]
    return Scene.from_parts(segments, bearings=bearings, port=port)


@pytest.mark.parametrize("exponent", [AVERAGED, RIGID])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_wide_seat_leaves_what_the_exponent_at_its_ends_leaves(order, exponent):
    theory = 1 / (1 - (order / (order + 1)) ** (4 * exponent))
    assert share_of(order, 1e-6, exponent) == pytest.approx(theory, rel=1e-2)
    # the narrower, the less is found
    shares = [share_of(order, slimness, exponent) for slimness in (1e-3, 0.1, 1, 10, 1e3)]
    assert shares == sorted(shares)
    wide = share_of_gap(order, 1e-6)
    assert wide == pytest.approx(share_of(order, 1e-6, RIGID), rel=1e-2)


def ends(scene, bounds, place):
    """The least and the most that a compliance of the port may be."""
    return [
        sg.condense(bounds.softer(more), scene, "gear").compliance[place, place]
        for more in (bounds.least, LOCAL * bounds.more)
    ]


@pytest.mark.slow
def test_bars_hold_at_a_seat_narrower_than_its_cells():
    scene = bar(1.5)
    places = {"C_thx": 3, "C_yy": 1}
    exact = {str(v.quantity): v.value for v in sg.answer(scene, 1e-3, ask=tuple(places)).values}
    bounds = solid_bounds(scene, sg.build(scene, "solid", **COARSE), statics=True)
    # the same by the ends of the seat alone, as if cells were small beside it
    short = replace(bounds, share=share_of(2, 1e-6, AVERAGED))
    for name, place in places.items():
        near, far = ends(scene, bounds, place)
        assert near < exact[name] < far
        assert ends(scene, short, place)[1] < exact[name]


def test_the_gap_between_two_rigid_seats_counts_as_a_seat():
    shares = []
    for gap in (0.05, 10.0):
        scene = bar(12.0, tie="rigid", beside=gap)
        body = sg.build(scene, "solid", **COARSE)
        shares.append(narrow_share(scene, body, 2))
    assert shares[0] > 10
    assert shares[1] < 2.5
    # two loads on average beside each other leave nothing held between them
    scene = bar(12.0, beside=0.05)
    assert narrow_share(scene, sg.build(scene, "solid", **COARSE), 2) < 2.5


def test_a_rigid_seat_that_ends_at_a_shoulder_is_sharper_than_one_on_a_smooth_surface():
    """Displacement goes with the root of the distance in a smooth surface, with the cube root where the
    seat meets the face of a shoulder, so that one order more finds less of the error."""
    thick = Segment.cylinder("thick", y0=0.04, length=0.05, diameter=0.05)
    thin = Segment.cylinder("thin", length=0.04, diameter=0.03)
    shares = []
    for lo, hi in ((0.028, 0.04), (0.02, 0.032)):
        port = Port(name="gear", y=(lo + hi) / 2, lo=lo, hi=hi, attachment="rigid")
        scene = Scene.from_parts([thin, thick], port=port)
        shares.append(narrow_share(scene, sg.build(scene, "solid", **COARSE), 2))
    sharp, smooth = (1 / (1 - (2 / 3) ** (4 * a)) for a in (1 / 3, 1 / 2))
    assert shares[0] > 1.1 * shares[1] and shares[0] > sharp and shares[1] > smooth


def test_bars_hold_at_a_gap_narrower_than_its_cells():
    scene = bar(12.0, tie="rigid", beside=0.2)
    exact = {str(v.quantity): v.value for v in sg.answer(scene, 1e-3, ask=("C_yy",)).values}
    bounds = solid_bounds(scene, sg.build(scene, "solid", **COARSE), statics=True)
    near, far = ends(scene, bounds, 1)
    assert near < exact["C_yy"] < far
    short = replace(bounds, share=share_of(2, 1e-6, RIGID))
    assert ends(scene, short, 1)[1] < exact["C_yy"]


def two_patches(folder, name, lines, bricks):
    """A block of 30 x 12 x 10 mm with two rigid patches 1 mm apart on its upper face, one clamped."""

    def upper(x, y):
        return y > 12e-3 - 1e-9

    write_boxes(
        folder / f"{name}.msh",
        [1e-3 * np.array(places) for places in lines],
        {
            "foot": lambda m: upper(*m[:2]) & (m[0] < 14.5e-3),
            "gear": lambda m: upper(*m[:2]) & (m[0] > 15.5e-3),
        },
        bricks=bricks,
    )
    rigid = 'patch = "{0}"\nname = "{0}"\nattachment = "rigid"\n'
    file = folder / f"{name}.toml"
    file.write_text(
        f'material = "steel"\nbody = {{ mesh = "{name}.msh", unit = "mm", axis = "none" }}\n'
        f"[[bearing]]\n{rigid.format('foot')}hold = 'clamped'\n[[port]]\n{rigid.format('gear')}"
    )
    scene = sg.load(file)
    return scene, sg.build(scene, "solid")


def test_bars_hold_at_a_gap_between_two_patches(tmp_path):
    """Of a body without an axis gaps were not seen: a half of what is due across this one."""
    coarse = [0, 7, 14.5, 15.5, 23, 30], [0, 6, 12], [0, 5, 10]
    fine = (
        [0, 7, 12, 13.7, 14.3, 14.5, 14.6, 15, 15.4, 15.5, 15.7, 16.3, 18, 23, 30],
        [0, 6, 10, 11.3, 11.8, 12],
        [0, 3, 7, 10],
    )
    scene, body = two_patches(tmp_path, "fine", fine, bricks=True)
    least = [ends(scene, solid_bounds(scene, body, statics=True), k)[0] for k in range(6)]
    scene, body = two_patches(tmp_path, "coarse", coarse, bricks=False)
    bounds = solid_bounds(scene, body, statics=True)
    assert bounds.share == pytest.approx(share_of_gap(2, 6.0))
    # more than the least of a fine mesh, which the truth is more than
    assert all(ends(scene, bounds, k)[1] > least[k] for k in range(6))
    short = replace(bounds, share=share_of(2, 1e-6, RIGID))
    assert ends(scene, short, 0)[1] < least[0]


def test_patches_that_end_at_edges_of_the_body_are_not_narrow():
    """All of two opposite faces of a thin block, deeper than wide: nothing lies beyond their ends."""
    scene = sg.load("tests/found/parts/rubber_pad_block.toml")
    assert narrow_share(scene, sg.build(scene, "solid", refinement=0.5), 2) == 1.0


def test_half_a_part_has_the_seats_of_the_whole():
    scene = sg.load("geometry/pinion_keyed.toml")
    half = sg.build(scene, "solid", refinement=0.2, half=True)
    assert narrow_share(scene, half, 2) > share_of(2, 1e-6, AVERAGED) + 0.01


@pytest.mark.long
def test_of_hexahedra_with_all_products_one_order_more_tells_less():
    scene = bar(12.0, tie="rigid")
    exact = {str(v.quantity): v.value for v in sg.answer(scene, 1e-3, ask=("C_yy",)).values}
    options = {"layers": 0, "radial_layers": 0, "edge_layers": 0, "relative_size": 2.0, "around": 8}
    ratios = []
    for element in ("hex20", "hex27"):
        body = sg.build(scene, "solid", element=element, **options)
        bounds = solid_bounds(scene, body, statics=True)
        value = sg.condense(body, scene, "gear").compliance[1, 1]
        near = sg.condense(bounds.softer(bounds.reached), scene, "gear").compliance[1, 1]
        theory = bounds.share / SLOWER.get(element, 1.0)
        ratios.append((exact["C_yy"] - value) / (near - value) / theory)
    assert ratios[0] < 1
    assert 1.1 * ratios[0] < ratios[1] < SLOWER["hex27"]
