"""Bars of the cheapest answer on shapes that coarse meshes see badly."""

import pytest

import solidgear as sg
from solidgear.judge.answer import answer
from solidgear.judge.solving import solve
from solidgear.scene import Bearing


def layered(order):
    """A mesh of some order with layers towards all corners, as they are built without a look at where
    bars come from.
    """
    return {
        "order": order,
        "layers": order - 2,
        "edge_layers": max(order - 3, 0),
        "relative_size": 4.0,
    }


def held(found, scene, order=5, left=5e-5):
    """Whether the numbers of a fine mesh, which leaves that much itself, are within bars that are worth
    having: no wider than asked for.
    """
    fine = solve(scene, "harmonic", **layered(order)).quantities
    assert found.reached
    return all(abs(v.value / fine[v.quantity] - 1) <= v.bar + left for v in found.values)


def springs(k, tilt=0.0):
    """Of a bearing, N/m and N m/rad."""
    turning = {"kthx": tilt, "kthz": tilt} if tilt else {}
    return {"kxx": k, "kyy": k, "kzz": k} | turning


def test_a_coarse_mesh_sees_what_a_narrow_seat_indents():
    # 6.9 % of C_zz, in cells ten times as long as the seat is wide
    port = sg.Port(name="gear", y=0.1, lo=0.099, hi=0.101)
    ends = [
        Bearing(name=n, y=y, seat_width=0.03, stiffness=springs(1e9))
        for n, y in (("A", 0.03), ("B", 0.17))
    ]
    shaft = sg.Segment.cylinder("shaft", length=0.2, diameter=0.1)
    scene = sg.Scene.from_parts([shaft], port=port, bearings=ends)
    assert held(answer(scene, 0.01, ["C_zz", "C_thx"]), scene)


@pytest.mark.parametrize("tol", [pytest.param(0.1, marks=pytest.mark.slow), 1e-3])
def test_bars_hold_for_seats_narrower_than_a_bar_is_thick(tol):
    # what the seat indents is a hundredth of C_zz, and most of the error
    bearing = Bearing(name="A", y=0.13, seat_width=0.005, stiffness=springs(1e10, 1e6))
    shaft = sg.Segment.cylinder("shaft", length=0.18, diameter=0.04)
    port = sg.Port(name="gear", y=0.04, lo=0.025, hi=0.055)
    scene = sg.Scene.from_parts([shaft], port=port, bearings=[bearing])
    assert held(answer(scene, tol, ["C_zz", "C_yy", "bending 1", "axial 1"]), scene)


@pytest.mark.slow
def test_bars_hold_for_seats_on_a_rotor_that_stands_out():
    # its surface is far from the shoulders of its shaft
    parts, y = [], 0.0
    for name, length, diameter in (
        ("a", 0.047, 0.013),
        ("rotor", 0.033, 0.056),
        ("b", 0.08, 0.013),
    ):
        parts.append(sg.Segment.cylinder(name, y0=y, length=length, diameter=diameter, bore=0.007))
        y += length
    bearing = Bearing(name="A", y=0.0695, seat_width=0.0195, stiffness=springs(1e11, 1e7))
    port = sg.Port(name="gear", y=0.0615, lo=0.05175, hi=0.07125)
    scene = sg.Scene.from_parts(parts, port=port, bearings=[bearing])
    assert held(answer(scene, 0.05, ["C_zz", "C_thx"]), scene, order=4, left=5e-4)


def test_modes_on_a_stiff_bearing_err_as_its_seat_does():
    # what a seat of 10 mm indents is most of axial 1
    bearing = Bearing(name="A", y=0.11, seat_width=0.01, stiffness=springs(1e10, 1e6))
    parts = [
        sg.Segment.cylinder("a", length=0.08, diameter=0.04),
        sg.Segment.cylinder("b", y0=0.08, length=0.08, diameter=0.05),
    ]
    port = sg.Port(name="gear", y=0.075, lo=0.07, hi=0.08)
    scene = sg.Scene.from_parts(parts, port=port, bearings=[bearing])
    assert held(answer(scene, 0.05, ["axial 1"]), scene)


def test_bars_hold_for_a_thin_ring():
    # of 0.006 diameters: it bends as a plate, of which one cell of low order knows little
    ring = sg.Segment.cylinder("ring", length=0.003, diameter=0.5, bore=0.4)
    port = sg.Port(name="gear", y=0.0015, lo=0.0, hi=0.003)
    bearing = Bearing(name="A", y=0.0015, seat_width=0.003, stiffness=springs(1e7))
    scene = sg.Scene.from_parts([ring], port=port, bearings=[bearing])
    assert held(answer(scene, 1e-3, ["bending 1"]), scene)


def test_bars_hold_for_a_thin_tube():
    # walls of 0.05 radii bend within a few of their decay lengths under the seats
    ends = [
        Bearing(name=n, y=y, seat_width=0.02, stiffness=springs(1e8))
        for n, y in (("A", 0.05), ("B", 0.25))
    ]
    port = sg.Port(name="gear", y=0.15, lo=0.14, hi=0.16)
    tube = sg.Segment.cylinder("tube", length=0.3, diameter=0.06, bore=0.057)
    scene = sg.Scene.from_parts([tube], port=port, bearings=ends)
    assert held(answer(scene, 1e-3, ["C_zz", "C_xx", "C_thx", "bending 1"]), scene)


def test_bars_hold_between_rigid_seats_that_all_but_touch():
    # 40 micrometres of surface between them take a tenth of what the shaft gives
    shaft = sg.Segment.cylinder("shaft", length=0.03, diameter=0.014, bore=0.0025)
    port = sg.Port(name="gear", y=0.008, lo=0.0066, hi=0.0094, attachment="rigid")
    bearing = Bearing(
        name="A",
        y=0.0103,
        seat_width=0.00172,
        stiffness={"kxx": 4.6e6, "kyy": 8.5e6, "kzz": 4.6e6, "kthx": 88.0, "kthz": 88.0},
        attachment="rigid",
    )
    scene = sg.Scene.from_parts([shaft], port=port, bearings=[bearing])
    found, sure = (answer(scene, tol, ["C_yy"]).values[0] for tol in (0.1, 1e-4))
    # of what the bearing gives there is no doubt
    shares = [v.value - 1 / 8.5e6 for v in (found, sure)]
    assert 0 < shares[1] - shares[0] <= found.bar * found.value
    assert sure.bar <= 1e-4


@pytest.mark.parametrize(
    ("tie", "quantity", "order", "before"),
    [
        pytest.param("average", "C_yy", 5, 7.5e-7, marks=pytest.mark.slow),
        ("section", "K_zz", 4, 3.6e-5),
    ],
)
def test_fine_meshes_stand_still(tie, quantity, order, before):
    # A seat that ends at a face, and the ring in the bore where a section tie's plane ends, had no
    # layers of their own: finer meshes then went on as slowly as their order lets them.
    shaft = sg.Segment.cylinder("shaft", length=0.02, diameter=0.03, bore=0.007)
    port = sg.Port(name="gear", y=0.006, lo=0.003, hi=0.009, attachment=tie)
    bearing = Bearing(
        name="A", y=0.009, seat_width=0.018, stiffness=springs(1e9, 1e5), attachment=tie
    )
    scene = sg.Scene.from_parts([shaft], port=port, bearings=[bearing])
    fine, finer = (
        solve(scene, "harmonic", **layered(p)).quantities[quantity] for p in (order, order + 1)
    )
    assert abs(finer / fine - 1) < before / 2


def test_the_other_plane_is_what_the_first_is_with_bearings_turned():
    def scene(along, across):
        shaft = sg.Segment.cylinder("shaft", length=0.3, diameter=0.04)
        stiffness = {f"k{along}{along}": 3e7, f"k{across}{across}": 3e8, "kyy": 1e8, "kthy": 1e4}
        ends = [
            Bearing(name=n, y=y, seat_width=0.02, stiffness=stiffness)
            for n, y in (("A", 0.02), ("B", 0.2))
        ]
        port = sg.Port(name="gear", y=0.29, lo=0.28, hi=0.3)
        return sg.Scene.from_parts([shaft], port=port, bearings=ends)

    one = answer(scene("x", "z"), 1e-3, "C_xx,C_x,thz,C_thz,K_xx,K_x,thz,K_thz,C_thy,C_zz")
    other = answer(scene("z", "x"), 1e-3, "C_zz,C_z,thx,C_thx,K_zz,K_z,thx,K_thx")
    # a quarter turn takes x to z and thz to -thx
    for x, z, sign in (
        ("C_xx", "C_zz", 1),
        ("C_x,thz", "C_z,thx", -1),
        ("C_thz", "C_thx", 1),
        ("K_xx", "K_zz", 1),
        ("K_x,thz", "K_z,thx", -1),
        ("K_thz", "K_thx", 1),
    ):
        assert one[x] == pytest.approx(sign * other[z], rel=1e-9)
    assert one["C_xx"] > 2 * one["C_zz"] and max(v.bar for v in one.values) <= 1e-3
    # two springs in parallel hold it against turning, and the shaft between twists a little
    assert 1 < one["C_thy"] * 2e4 < 1.2


@pytest.mark.parametrize(
    "ask", [["K_zz"], pytest.param(["bending 1", "axial 1"], marks=pytest.mark.slow)]
)
def test_bars_hold_in_a_narrow_notch(ask):
    # between a cone of 83 degrees and the face of a disc
    parts = [
        sg.Segment(name="cone", y0=0.0, y1=0.0026, outer0=0.0343, outer1=0.017),
        sg.Segment(name="disc", y0=0.0026, y1=0.0041, outer0=0.0899, outer1=0.0423),
    ]
    springs = {"kxx": 2e8, "kyy": 1e8, "kzz": 2e8}
    a = Bearing(name="A", y=0.0004, seat_width=0.0008, stiffness=springs)
    b = Bearing(name="B", y=0.0037, seat_width=0.0006, stiffness=springs)
    port = sg.Port(name="p", y=0.0018, lo=0.0014, hi=0.0022)
    scene = sg.Scene.from_parts(parts, port=port, bearings=[a, b])
    found = answer(scene, 0.05, ask)
    if ask == ["K_zz"]:  # no modes of a fine mesh for it
        body = sg.build(scene, "harmonic", **layered(5))
        fine = {"K_zz": sg.condense(body, scene, port="p").stiffness[2, 2]}
    else:
        fine = solve(scene, "harmonic", **layered(5)).quantities
    for v in found.values:
        assert abs(v.value / fine[v.quantity] - 1) <= v.bar
