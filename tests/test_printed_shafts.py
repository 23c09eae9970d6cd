"""Bearing reactions of shafts in books and catalogues, from what these give of gears and belts."""

import math

import pytest

import solidgear as sg
from solidgear.strength.deflection.at_rest import deflection
from solidgear.strength.load import AT_REST
from solidgear.trains.assembly.assembly import Assembly

INCH, POUND = 0.0254, 4.4482216152605


def reactions(length, supports, loads, **rest):
    """Reactions (6,) of two bearings on a rod, N and N m, the first of which locates it; by a rigid
    shaft, on which statics alone decides.
    """
    stiff = {"kxx": 1e12, "kzz": 1e12}
    bearings = [
        sg.Bearing(name=name, y=y, seat_width=0.01, stiffness=stiff | along)
        for (name, y), along in zip(supports.items(), ({"kyy": 1e12}, {}))
    ]
    scene = sg.Scene.from_parts(
        [sg.Segment.cylinder("rod", length=length, diameter=0.04)],
        bearings=bearings,
        loads=loads,
        **rest,
    )
    solved = deflection(Assembly.of(scene, kept=6), AT_REST, "rigid")
    assert solved.statics.imbalance < 1e-9
    return {b.name: -b.load for b in solved.shafts[0].bearings}, solved


def test_helical_pinion_beside_its_bearings():
    """Shigley's Mechanical Engineering Design, example 13-9: 1 hp at 1800 rev/min, 18 teeth, normal
    diametral pitch 12, normal pressure angle 20 degrees, helix angle 30 degrees, bearings at 0 and
    10 in, pinion at 13 in. The book's x, y and z are here y, z and x.
    """
    begin = 1.0 * INCH  # of the rod, before the first bearing
    diameter = 18 / (12 * math.cos(math.radians(30))) * INCH
    torque = 35.0 * INCH * POUND
    pinion = sg.ShaftLoad(
        name="pinion",
        position=begin + 13 * INCH,
        seat_width="0.5 in",
        pitch_diameter=diameter,
        torque=torque,
        pressure_angle="20 deg",
        helix_angle="30 deg",
        hand="right",
        towards="+z",
    )
    supports = {"A": begin, "B": begin + 10 * INCH}
    on_shaft, solved = reactions(
        15 * INCH, supports, [pinion], torque_at="port", port=sg.Port(y=0.2, lo=0.19, hi=0.21)
    )
    assert (pinion.six()[:3] / POUND).round(1).tolist() == [40.4, -23.3, -17.0]
    a, b = (on_shaft[name][:3] / POUND for name in "AB")
    # printed, of rounded forces: F_A = 23.3 i - 3.1 j + 12.1 k, F_B = 20.1 j - 52.5 k
    assert a == pytest.approx([12.1, 23.3, -3.1], abs=0.1)
    assert b == pytest.approx([-52.5, 0.0, 20.1], abs=0.1)
    (stretch,) = solved.statics.torque
    assert stretch.torque / (INCH * POUND) == pytest.approx(35.0)


def test_two_belts_across_each_other():
    """Shigley's Mechanical Engineering Design, 8th edition, problem 5-23 with its solution: pulleys of
    8 and 6 in at 8 and 16 in of 22, belts with 300 and 50 lbf down and 360 and 27 lbf aside. The
    torques are 1000 and 999 lbf in, which the book and the tolerance of typed numbers take as one.
    """
    first, second = ({"tight": f"{t} lbf", "slack": f"{s} lbf"} for t, s in ((300, 50), (360, 27)))
    belts = [
        sg.ShaftLoad(
            name="B", position="9 in", seat_width="1 in", diameter="8 in", towards="-z",
            sense="driven", **first,
        ),
        sg.ShaftLoad(
            name="C", position="17 in", seat_width="1 in", diameter="6 in", towards="+x",
            sense="driving", **second,
        ),
    ]  # fmt: skip
    on_shaft, solved = reactions(24 * INCH, {"A": INCH, "D": 23 * INCH}, belts, turns="-y")
    assert [round(float(on_shaft[name][2]) / POUND) for name in "AD"] == [223, 127]
    across = [on_shaft[name][0] / POUND for name in "AD"]
    assert across == pytest.approx([-387 * 6 / 22, -387 * 16 / 22])
    (stretch,) = solved.statics.torque
    assert stretch.torque / (INCH * POUND) == pytest.approx(999.0)


@pytest.mark.parametrize("ratio", [2.0, 5.0])
def test_belt_beside_and_gear_between_two_bearings(ratio):
    """NTN, Ball and Roller Bearings, equations 4.10 and 4.11: F1 at a before bearing A and F2 at c
    behind it, d before bearing B: F_A = (a + b) / b F1 + d / (c + d) F2 and F_B = -a / b F1 +
    c / (c + d) F2, with b = c + d.
    """
    a, c, d = 0.07, 0.12, 0.05
    b, start = c + d, 0.1
    torque, width = 60.0, 0.02
    belt = sg.ShaftLoad(
        name="belt",
        position=start - a,
        seat_width=width,
        torque=torque,
        diameter=0.15,
        pull_ratio=ratio,
        towards="-z",
    )
    gear = sg.ShaftLoad(
        name="gear",
        position=start + c,
        seat_width=width,
        torque=-torque,
        pitch_diameter=0.1,
        towards="+x",
    )
    on_shaft, _ = reactions(0.3, {"A": start, "B": start + b}, [belt, gear])
    pull = 2 * torque / 0.15 * (ratio + 1) / (ratio - 1)
    tangential = 2 * torque / 0.1
    radial = tangential * math.tan(math.pi / 9)
    # gear at +x: the torque about -y pushes along +z
    for k, f1, f2 in ((2, -pull, tangential), (0, 0.0, -radial)):
        assert on_shaft["A"][k] == pytest.approx(-((a + b) / b * f1 + d / b * f2))
        assert on_shaft["B"][k] == pytest.approx(-(-a / b * f1 + c / b * f2))
