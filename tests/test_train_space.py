"""Shafts of a train that take the same space are told, and no shipped train is said to."""

from math import cos, pi, radians, sin
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.space import Piece, angled_overlap, overlaps, parallel_overlap
from tests.test_train_many import written
from tests.test_train_power import looped

GEOMETRY = Path(__file__).parent.parent / "geometry"
TRAINS = sorted(p for p in GEOMETRY.glob("*.toml") if "[mesh]" in p.read_text(encoding="utf-8"))


def found(train):
    assembly = Assembly(train)
    told = overlaps(assembly.train, assembly.scenes, assembly.places)
    assert [str(one) for one in told] == [
        line for line in assembly.cautions() if "same space" in line
    ]
    return told


@pytest.mark.parametrize("path", TRAINS, ids=lambda p: p.stem)
def test_no_shipped_train_takes_space_twice(path):
    assert found(sg.load_train(path)) == ()


def test_a_wheel_turned_into_the_first_shaft_is_told_by_how_much(tmp_path):
    """The second stage laid back over the first: distances and tips by hand.  Output and input are
    apart by what is left of both centre distances, and lie side by side along the axis.
    """
    path = written(tmp_path, (f"azimuth = {pi / 2}", f"azimuth = {pi}"))
    (one,) = found(sg.load_train(path))
    first, second = 0.03 * 77 / 20, 0.036 * 73 / 18
    assert second > first
    # teeth of the output over its pitch circle: a normal module, 2 r cos(helix) / z
    tip = 0.036 * 55 / 18 + 2 * 0.036 / 18 * cos(radians(12))
    assert one.shafts == ("input", "output")
    # the input's shaft, 40 mm thick, or its gear where that is: 0.045 to 0.075 from its start
    depth = {'"s0"': 0.02 + tip - (second - first)}
    assert one.pieces[0] in depth and one.pieces[1] == 'the gear at "gear"'
    assert one.depth == pytest.approx(depth[one.pieces[0]], rel=1e-9)
    # the wheel's middle is 0.06 + (0.14 - 0.075) from the input's start, 30 mm wide
    (low, high), (begin, end) = one.places
    assert (low, high) == pytest.approx((0.11, 0.14)) and (begin, end) == pytest.approx(
        (0.135, 0.165)
    )
    assert "110.0 to 140.0 mm along the input" in str(one)


def test_a_blank_up_to_the_tips_is_that_of_its_teeth_and_one_beyond_them_is_not(tmp_path):
    """Wheels of module 3 mm, 76.5 and 106.5 mm apart: a collar between the teeth of an idler,
    whose profile shift the file does not tell.
    """
    for radius, told in ((0.0495, ()), (0.051, ()), (0.055, ("input", "output"))):
        looped(tmp_path, [1e8] * 4 + [0.0, 1e8])
        text = (tmp_path / "left.toml").read_text()
        cylinder = text[text.index("[[segment]]") : text.index("[[bearing]]")]
        three = [
            cylinder.replace("0.16", str(length)).replace("0.04", str(size)).replace("s0", name)
            for name, length, size in (
                ("a", 0.05, 0.04),
                ("b", 0.02, 2 * radius),
                ("c", 0.09, 0.04),
            )
        ]
        (tmp_path / "left.toml").write_text(text.replace(cylinder, "".join(three)))
        own = found(sg.load_train(tmp_path / "train.toml"))
        assert {side for one in own for side in one.shafts} - {"left"} == {*told}
        for one in own:
            tip = {"input": 0.033, "output": 0.063}[next(s for s in one.shafts if s != "left")]
            assert one.depth == pytest.approx(radius + tip - (0.0435 + tip), rel=1e-9)
            assert '"b"' in one.pieces


def test_a_pilot_that_reaches_under_the_ring_is_told(tmp_path):
    """The ring's front face is 46 mm from the pinion's axis, where its lumped point lies."""
    for name in ("axle_straddle", "pinion_straddle", "gear_shaft"):
        text = (GEOMETRY / f"{name}.toml").read_text(encoding="utf-8")
        text = text.replace('length = "56.75 mm"', 'length = "160 mm"')
        text = text.replace('diameter = "53.4 mm"', 'diameter = "120 mm"')
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    train = sg.load_train(tmp_path / "axle_straddle.toml")
    (one,) = found(train)
    place = Assembly(train).places["gear"][1]
    assert {*one.pieces} <= {'"pilot"', '"ring"', 'the gear at "gear"'} and '"pilot"' in one.pieces
    # its teeth stand 3 mm before the ring
    assert one.depth == pytest.approx(0.06 + place[0] + 0.003, abs=1e-3)


def piece(radius, bore=0.0, length=0.2):
    return Piece("rod", (0.0, length), (radius, radius), (bore, bore))


def test_a_shaft_through_a_hollow_one_has_its_place_until_it_touches_the_wall():
    hollow, shaft = piece(0.05, 0.03), piece(0.02)
    for aside, deep in ((0.0, None), (0.009, None), (0.012, 0.002), (0.04, 0.03), (0.071, None)):
        told = [
            *parallel_overlap(("a", "b"), hollow, shaft, -1.0, np.array([aside, 0.25, 0.0]), 0.0)
        ]
        assert [one.depth for one in told] == ([] if deep is None else [pytest.approx(deep)])
        # begins 0.25 along the hollow one and runs back
        assert all(sum(one.places, ()) == pytest.approx((0.05, 0.2) * 2) for one in told)
    away = [*parallel_overlap(("a", "b"), hollow, shaft, 1.0, np.array([0.0, 0.2, 0.0]), 0.0)]
    assert away == []  # end to end


@pytest.mark.parametrize("angle", [30.0, 90.0])
def test_two_rods_across_each_other_overlap_by_what_their_radii_lack(angle):
    c, s = cos(radians(angle)), sin(radians(angle))
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])  # in the plane of both axes
    middle = np.array([0.0, 0.1, 0.0]) - turn @ np.array([0.0, 0.1, 0.0])
    for apart, deep in ((0.051, 0.0), (0.045, 0.005), (0.04, 0.01)):
        rods = piece(0.02), piece(0.03)
        told = [*angled_overlap(("a", "b"), *rods, turn, middle + [0.0, 0.0, apart])]
        most = max((one.depth for one in told), default=0.0)
        # points between circles lie deeper: a few per cent with circles a sixth of a radius apart
        assert 0.95 * deep <= most <= deep
