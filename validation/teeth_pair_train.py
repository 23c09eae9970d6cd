"""A train whose mesh comes from its teeth, beside two whole gears as finite elements.

    python -m validation.teeth_pair_train

The gears of :mod:`validation.teeth_pair` are rigid wheels on stiff shafts, free to turn against each
other: the two inertias have one resonance on their teeth.  The train takes tangent stiffness and
transmission error from the teeth (``stiffness = "teeth"``) and runs at a thirtieth of that resonance, so
that the third order of the mesh is at a tenth: its dynamic transmission error is beside the quasi-static
one of the whole gears, order by order and, of the first five, from peak to peak.  A single mass on a
spring would move by up to 1 % more than at rest there.
Rows go to validation/results/teeth_pair.json; some 10 s of processor time.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.teeth.train_teeth import TeethOfTrain
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.response.drive import Drive
from validation.common import kept, read_result
from validation.teeth_pair import CASES, FACE, HOLDS, ORDERS, Case

#: moments of inertia of both wheels, kg m^2
INERTIAS = (2e-3, 30e-3)
#: part of the resonance that is the frequency of the mesh, and orders of a cycle from peak to peak
PART, CYCLE = 30.0, 5
SHAFT = """
[material]
E = "206 GPa"
nu = 0.3
density = "7850 kg/m^3"
[[segment]]
kind = "cylinder"
name = "body"
length = "60 mm"
diameter = "{diameter} mm"
[[bearing]]
name = "{first}"
position = "10 mm"
seat_width = "10 mm"
stiffness = {{ kxx = 1e12, kyy = 1e12, kzz = 1e12, kthx = 1e9, kthz = 1e9 }}
[[bearing]]
name = "{second}"
position = "-10 mm"
from = "end"
seat_width = "10 mm"
stiffness = {{ kxx = 1e12, kzz = 1e12, kthx = 1e9, kthz = 1e9 }}
[port]
name = "wheel"
position = "30 mm"
from = "start"
span = ["20 mm", "40 mm"]
"""
WHEEL = """
[{side}]
scene = "{side}.toml"
teeth = {teeth}
module = "4 mm"
face_width = "{face} mm"
{relief}
[{side}.head]
mass = "1 kg"
torsional = "{inertia} kg*m^2"
bending = "{inertia} kg*m^2"
[{end}]
inertia = "100 kg*m^2"
[{end}.spring]
stiffness = "1 N*m/rad"
at = "{bearing}"
"""
TRAIN = """
[mesh]
shaft_angle = 0
stiffness = "teeth"
pressure_angle = "20 deg"
[[operation]]
name = "full"
torque = "{torque} N*m"
speed = "100 rpm"
"""


def train_of(case: Case, folder: Path) -> sg.Train:
    """Write and load the train of both gears under the load of a case."""
    relief = f'relief = {{ tip = "{1e6 * case.relief} um" }}' if case.relief else ""
    sides = ("pinion", "engine", "A", "B"), ("gear", "load", "C", "D")
    wheels = case.wheels.first, case.wheels.second
    tables = []
    for (side, end, first, second), wheel, hold, inertia in zip(sides, wheels, HOLDS, INERTIAS):
        text = SHAFT.format(diameter=2e3 * hold, first=first, second=second)
        (folder / f"{side}.toml").write_text(text)
        table = WHEEL.format(
            side=side,
            teeth=wheel.teeth,
            face=1e3 * FACE,
            relief=relief,
            inertia=inertia,
            end=end,
            bearing=first,
        )
        tables.append(table)
    tables[0] = tables[0].replace("[pinion.head]", 'loaded_side = "left"\n[pinion.head]')
    path = folder / "train.toml"
    path.write_text("".join(tables) + TRAIN.format(torque=FACE * case.torque))
    return sg.load_train(path)


def dynamic_orders(case: Case) -> tuple[np.ndarray, float]:
    """Return the (CYCLE,) complex orders of the dynamic transmission error, m, and the resonance of
    both wheels on the teeth, Hz.
    """
    with tempfile.TemporaryDirectory() as name:
        asked = train_of(case, Path(name))
        train = TeethOfTrain(asked).at(asked.point)
        drive = Drive(Assembly(train), "timoshenko", "timoshenko")
        wheels = case.wheels.first, case.wheels.second
        lightness = sum(w.base**2 / inertia for w, inertia in zip(wheels, INERTIAS))
        resonance = float(np.sqrt(drive.stiffness * lightness)) / (2 * np.pi)
        orders = [
            drive.mesh(np.array([n * resonance / PART]), n)[0][0] for n in range(1, CYCLE + 1)
        ]
    return np.array(orders) * np.exp(1j * np.array(drive.excitation.error.phases)), resonance


def whole_orders(error: np.ndarray) -> np.ndarray:
    """Return the (CYCLE,) complex orders of a transmission error over a cycle."""
    return 2 * np.fft.rfft(error)[1 : CYCLE + 1] / len(error)


def swing(orders: np.ndarray) -> float:
    """Return what orders make from peak to peak."""
    angle = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    waves = np.exp(1j * np.outer(np.arange(1, len(orders) + 1), angle))
    return float(np.ptp((orders @ waves).real))


def compared(case: Case, whole: np.ndarray) -> dict[str, Any]:
    """Return the orders of the train beside those of the whole gears, um, and their ratios."""
    dynamic, resonance = dynamic_orders(case)
    static = whole_orders(1e6 * whole)
    return {
        "resonance_hz": resonance,
        "train": list(1e6 * np.abs(dynamic[:ORDERS])),
        "whole gears": list(np.abs(static[:ORDERS])),
        "excess": list(1e6 * np.abs(dynamic[:ORDERS]) / np.abs(static[:ORDERS]) - 1),
        "excess peak to peak": 1e6 * swing(dynamic) / swing(static) - 1,
    }


def main() -> None:
    """Compare the train with the kept cases, print and keep the rows."""
    cases = read_result("teeth_pair")["cases"]
    rows = {}
    for load, relief in CASES:
        case = Case(load, relief)
        rows[case.name] = compared(case, 1e-6 * np.array(cases[case.name]["whole gears"]))
        print(case.name, rows[case.name])
    kept("teeth_pair", {"train": rows})


if __name__ == "__main__":
    main()
