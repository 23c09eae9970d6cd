"""Bearing reactions by the formula of a catalogue; other printed shafts are cases of the manual."""

import math

import pytest

import solidgear as sg
from solidgear.strength.deflection.at_rest import deflection
from solidgear.strength.load import AT_REST
from solidgear.trains.assembly.assembly import Assembly


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
