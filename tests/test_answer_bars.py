"""Bars of the cheapest answer on shapes that coarse meshes see badly."""

import pytest

import solidgear as sg
from solidgear.core.judge.answer import answer
from solidgear.core.judge.solving import solve
from solidgear.core.scene import Bearing


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


def springs(k, tilt=0.0):
    """Of a bearing, N/m and N m/rad."""
    turning = {"kthx": tilt, "kthz": tilt} if tilt else {}
    return {"kxx": k, "kyy": k, "kzz": k} | turning


def shaft(parts, port, seats, stiffness, tie="average"):
    """Parts of (length, diameter[, bore]), a lumped point from place to place, and seats of (middle,
    width), all alike, m.
    """
    segments, y = [], 0.0
    for k, (length, diameter, *bore) in enumerate(parts):
        size = {"length": length, "diameter": diameter, "bore": (bore or [0.0])[0]}
        segments.append(sg.Segment.cylinder(f"part {k}", y0=y, **size))
        y += length
    bearings = [
        Bearing(name=name, y=at, seat_width=width, stiffness=stiffness, attachment=tie)
        for name, (at, width) in zip("AB", seats)
    ]
    return sg.Scene.from_parts(segments, port=point(*port, tie), bearings=bearings)


def point(lo, hi, tie="average"):
    return sg.Port(name="gear", y=(lo + hi) / 2, lo=lo, hi=hi, attachment=tie)


#: 5 mm of seat on 40 mm: what it indents is a hundredth of C_zz, and most of the error
NARROW = shaft([(0.18, 0.04)], (0.025, 0.055), [(0.13, 0.005)], springs(1e10, 1e6))
#: shape, tolerance, what is asked; then order of a fine mesh and what that leaves itself
SHAPES = {
    # 6.9 % of C_zz, in cells ten times as long as the seat is wide
    "a point on 2 mm": (
        shaft([(0.2, 0.1)], (0.099, 0.101), [(0.03, 0.03), (0.17, 0.03)], springs(1e9)),
        0.01,
        ["C_zz", "C_thx"],
    ),
    "a seat narrower than a bar is thick, roughly": (
        NARROW,
        0.1,
        ["C_zz", "C_yy", "bending 1", "axial 1"],
    ),
    "a seat narrower than a bar is thick": (
        NARROW,
        1e-3,
        ["C_zz", "C_yy", "bending 1", "axial 1"],
    ),
    # its surface is far from the shoulders of its shaft
    "seats on a rotor that stands out": (
        shaft(
            [(0.047, 0.013, 0.007), (0.033, 0.056, 0.007), (0.08, 0.013, 0.007)],
            (0.05175, 0.07125),
            [(0.0695, 0.0195)],
            springs(1e11, 1e7),
        ),
        0.05,
        ["C_zz", "C_thx"],
        4,
        5e-4,
    ),
    # what a seat of 10 mm indents is most of axial 1
    "modes on a stiff bearing": (
        shaft([(0.08, 0.04), (0.08, 0.05)], (0.07, 0.08), [(0.11, 0.01)], springs(1e10, 1e6)),
        0.05,
        ["axial 1"],
    ),
    # it bends as a plate, of which one cell of low order knows little
    "a ring of 0.006 diameters": (
        shaft([(0.003, 0.5, 0.4)], (0.0, 0.003), [(0.0015, 0.003)], springs(1e7)),
        1e-3,
        ["bending 1"],
    ),
    # walls of 0.05 radii bend within a few of their decay lengths under the seats
    "a thin tube": (
        shaft([(0.3, 0.06, 0.057)], (0.14, 0.16), [(0.05, 0.02), (0.25, 0.02)], springs(1e8)),
        1e-3,
        ["C_zz", "C_xx", "C_thx", "bending 1"],
    ),
}
#: a lighter one of the same kind is in the default run
SLOW = ("a seat narrower than a bar is thick, roughly", "seats on a rotor that stands out")


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.slow if n in SLOW else ()) for n in SHAPES]
)
def test_bars_that_are_no_wider_than_asked_for_hold(name):
    scene, tol, ask, order, left, *_ = (*SHAPES[name], 5, 5e-5)
    found, fine = answer(scene, tol, ask), solve(scene, "harmonic", **layered(order)).quantities
    assert found.reached
    assert all(abs(v.value / fine[v.quantity] - 1) <= v.bar + left for v in found.values)


def test_bars_hold_between_rigid_seats_that_all_but_touch():
    # 40 micrometres of surface between them take a tenth of what the shaft gives
    springs = {"kxx": 4.6e6, "kyy": 8.5e6, "kzz": 4.6e6, "kthx": 88.0, "kthz": 88.0}
    parts, seat = [(0.03, 0.014, 0.0025)], (0.0103, 0.00172)
    scene = shaft(parts, (0.0066, 0.0094), [seat], springs, tie="rigid")
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
    parts, seat = [(0.02, 0.03, 0.007)], (0.009, 0.018)
    scene = shaft(parts, (0.003, 0.009), [seat], springs(1e9, 1e5), tie=tie)
    fine, finer = (
        solve(scene, "harmonic", **layered(p)).quantities[quantity] for p in (order, order + 1)
    )
    assert abs(finer / fine - 1) < before / 2


def test_the_other_plane_is_what_the_first_is_with_bearings_turned():
    def scene(along, across):
        stiffness = {f"k{along}{along}": 3e7, f"k{across}{across}": 3e8, "kyy": 1e8, "kthy": 1e4}
        return shaft([(0.3, 0.04)], (0.28, 0.3), [(0.02, 0.02), (0.2, 0.02)], stiffness)

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
    "ask",
    [
        pytest.param(["K_zz"], marks=pytest.mark.long),
        pytest.param(["bending 1", "axial 1"], marks=pytest.mark.slow),
    ],
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
    scene = sg.Scene.from_parts(parts, port=point(0.0014, 0.0022), bearings=[a, b])
    found = answer(scene, 0.05, ask)
    if ask == ["K_zz"]:  # no modes of a fine mesh for it
        body = sg.build(scene, "harmonic", **layered(5))
        fine = {"K_zz": sg.condense(body, scene, port="gear").stiffness[2, 2]}
    else:
        fine = solve(scene, "harmonic", **layered(5)).quantities
    for v in found.values:
        assert abs(v.value / fine[v.quantity] - 1) <= v.bar
